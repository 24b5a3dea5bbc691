#include "sim/esc_chip.h"

#include "core/bytes.h"

/* Registers of a sync manager (0x0800 + 8 n). */
enum { SM_BYTES = 8, AT_START = 0, AT_LENGTH = 2, AT_CONTROL = 4, AT_STATUS = 5, AT_ACTIVATE = 6, AT_PDI = 7 };
enum {
    CONTROL_MODE = 0x03, MODE_MAILBOX = 0x02, CONTROL_DIRECTION = 0x0C, DIRECTION_WRITE = 0x04, CONTROL_WATCHDOG = 0x40,
};
enum {
    STATUS_WRITTEN = 0x01, STATUS_READ = 0x02, STATUS_FULL = 0x08, STATUS_BUFFER_SHIFT = 4, STATUS_BUFFER = 0x30,
    BUFFERS = 3, NO_BUFFER = 3,
};

static uint8_t *registers(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm)
{
    return slave->memory + ESC_SM + sm->number * SM_BYTES;
}

static void show_full(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm)
{
    uint8_t *status = registers(slave, sm) + AT_STATUS;
    *status = (uint8_t)(sm->full ? *status | STATUS_FULL : *status & ~STATUS_FULL);
    cm1e_sim_esc_event(slave, (uint16_t)(ESC_EVENT_SM0 << sm->number), sm->full);
}

void cm1e_sim_esc_sm_next_buffer(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm)
{
    uint8_t *status = registers(slave, sm) + AT_STATUS;
    const unsigned buffer = *status >> STATUS_BUFFER_SHIFT & NO_BUFFER;
    const unsigned next = buffer == NO_BUFFER ? 0 : (buffer + 1) % BUFFERS;
    *status = (uint8_t)((*status & ~(unsigned)STATUS_BUFFER) | next << STATUS_BUFFER_SHIFT);
}

void cm1e_sim_esc_sm_accessed(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm, bool written)
{
    uint8_t *status = registers(slave, sm) + AT_STATUS;
    *status = (uint8_t)((*status & ~(STATUS_WRITTEN | STATUS_READ)) | (written ? STATUS_WRITTEN : STATUS_READ));
}

static void reset_buffers(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm)
{
    sm->open = sm->full = false;
    registers(slave, sm)[AT_STATUS] = sm->active && !sm->mailbox ? STATUS_BUFFER : 0;
    show_full(slave, sm);
}

void cm1e_sim_esc_sm_decode(cm1e_sim_slave_t *slave, unsigned number)
{
    esc_sync_manager_t *sm = &slave->managers[number];
    const uint8_t *r = registers(slave, sm);
    const esc_sync_manager_t before = *sm;
    sm->start = cm1e_get_u16(r + AT_START);
    sm->length = cm1e_get_u16(r + AT_LENGTH);
    /* A sync manager outside the RAM has no effect. */
    sm->active = (r[AT_ACTIVATE] & 0x01) && sm->length > 0 && sm->start >= ESC_REGISTER_BYTES &&
                 (uint32_t)sm->start + sm->length <= ESC_MEMORY_BYTES;
    sm->mailbox = (r[AT_CONTROL] & CONTROL_MODE) == MODE_MAILBOX;
    sm->master_writes = (r[AT_CONTROL] & CONTROL_DIRECTION) == DIRECTION_WRITE;
    sm->triggers_watchdog = (r[AT_CONTROL] & CONTROL_WATCHDOG) != 0;
    sm->locked = (r[AT_PDI] & 0x01) != 0;
    /* Only the activate bit can change while the sync manager is on. */
    if (before.active != sm->active || before.locked != sm->locked)
        reset_buffers(slave, sm);
}

void cm1e_sim_esc_sm_lock(cm1e_sim_slave_t *slave, unsigned role, bool locked)
{
    esc_sync_manager_t *sm = cm1e_sim_esc_sm(slave, role);
    if (!sm)
        return;
    uint8_t *pdi = registers(slave, sm) + AT_PDI;
    *pdi = (uint8_t)(locked ? *pdi | 0x01 : *pdi & ~0x01);
    cm1e_sim_esc_sm_decode(slave, sm->number);
}

esc_sync_manager_t *cm1e_sim_esc_sm(cm1e_sim_slave_t *slave, unsigned role)
{
    const unsigned number = slave->role_manager[role];
    return number < ESC_SYNC_MANAGERS ? &slave->managers[number] : NULL;
}

size_t cm1e_sim_esc_sm_span(cm1e_sim_slave_t *slave, uint32_t address, uint32_t end, esc_sync_manager_t **manager)
{
    *manager = NULL;
    if (end > ESC_MEMORY_BYTES)
        end = ESC_MEMORY_BYTES;
    for (int i = 0; i < ESC_SYNC_MANAGERS; i++) {
        esc_sync_manager_t *sm = &slave->managers[i];
        if (!sm->active)
            continue;
        const uint32_t sm_end = (uint32_t)sm->start + sm->length;
        if (address >= sm->start && address < sm_end) {
            *manager = sm;
            return (end < sm_end ? end : sm_end) - address;
        }
        if (sm->start > address && sm->start < end)
            end = sm->start;
    }
    return end - address;
}

void cm1e_sim_esc_sm_set_full(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, bool full)
{
    sm->full = full;
    show_full(slave, sm);
}

static bool overlaps_another(const cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm)
{
    for (int i = 0; i < ESC_SYNC_MANAGERS; i++) {
        const esc_sync_manager_t *other = &slave->managers[i];
        if (other != sm && other->active && other->start < sm->start + sm->length &&
            sm->start < other->start + other->length)
            return true;
    }
    return false;
}

static bool mailbox_valid(cm1e_sim_slave_t *slave, unsigned role)
{
    const esc_sync_manager_t *sm = cm1e_sim_esc_sm(slave, role);
    return sm && sm->active && sm->mailbox && sm->master_writes == (role == ESC_ROLE_MAILBOX_OUT) &&
           sm->length >= MAILBOX_MIN_BYTES && sm->length <= MAILBOX_MAX_BYTES && !overlaps_another(slave, sm);
}

bool cm1e_sim_esc_process_data_valid(cm1e_sim_slave_t *slave, unsigned role, uint16_t bytes)
{
    const esc_sync_manager_t *sm = cm1e_sim_esc_sm(slave, role);
    if (bytes == 0)
        return !sm || !sm->active;
    return sm && sm->active && !sm->mailbox && sm->master_writes == (role == ESC_ROLE_OUTPUTS) && sm->length == bytes &&
           !overlaps_another(slave, sm);
}

bool cm1e_sim_esc_mailboxes_valid(cm1e_sim_slave_t *slave)
{
    return mailbox_valid(slave, ESC_ROLE_MAILBOX_OUT) && mailbox_valid(slave, ESC_ROLE_MAILBOX_IN);
}
