#include "sim/esc_chip.h"

#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"

static uint8_t sii_sync_manager_role(const cm1e_sim_slave_t *slave, unsigned number)
{
    enum { CATEGORY_SYNC_MANAGERS = 41, RECORD_BYTES = 8, ROLE_OFFSET = 7 };
    size_t bytes = 0;
    const size_t at = cm1e_sim_esc_sii_category(slave, CATEGORY_SYNC_MANAGERS, &bytes);
    if (at == 0 || bytes < (number + 1) * RECORD_BYTES)
        return ESC_ROLE_NONE;
    const uint8_t role = slave->sii[at + number * RECORD_BYTES + ROLE_OFFSET];
    return role < ESC_ROLES ? role : ESC_ROLE_NONE;
}

static void assign_roles(cm1e_sim_slave_t *slave)
{
    memset(slave->role_manager, ESC_SYNC_MANAGERS, sizeof slave->role_manager);
    for (unsigned i = 0; i < ESC_SYNC_MANAGERS; i++) {
        const uint8_t role = sii_sync_manager_role(slave, i);
        slave->managers[i] = (esc_sync_manager_t){.number = (uint8_t)i, .role = role};
        slave->role_manager[role] = (uint8_t)i;
    }
    slave->role_manager[ESC_ROLE_NONE] = ESC_SYNC_MANAGERS;
}

cm1e_sim_slave_t *cm1e_sim_slave_create(const uint8_t *sii, size_t sii_size, const cm1e_sim_app_ops_t *ops, void *app)
{
    cm1e_sim_slave_t *slave = calloc(1, sizeof *slave);
    uint8_t *copy = slave ? malloc(sii_size + 1) : NULL;
    if (!copy) {
        free(slave);
        return NULL;
    }
    memcpy(copy, sii, sii_size);
    slave->sii = copy;
    slave->sii_size = sii_size;
    slave->sii_reads_8_bytes = true;
    slave->ops = ops;
    slave->app = app;
    cm1e_sim_esc_power_on(slave, 0);
    return slave;
}

void cm1e_sim_slave_destroy(cm1e_sim_slave_t *slave)
{
    if (!slave)
        return;
    if (slave->ops->destroy)
        slave->ops->destroy(slave->app);
    cm1e_sim_profile_free(&slave->profile);
    free(slave->sii);
    free(slave);
}

void *cm1e_sim_slave_app(cm1e_sim_slave_t *slave) { return slave ? slave->app : NULL; }

const cm1e_sim_app_ops_t *cm1e_sim_slave_ops(const cm1e_sim_slave_t *slave) { return slave ? slave->ops : NULL; }

uint8_t cm1e_sim_slave_al_state(const cm1e_sim_slave_t *slave) { return slave->al_state; }

void cm1e_sim_slave_reset(cm1e_sim_slave_t *slave, int64_t until_ns)
{
    /* 0 means present: a device that resets is away for a moment at least. */
    slave->absent_until_ns = until_ns > slave->now_ns ? until_ns : slave->now_ns + 1;
    if (slave->topology_changed)
        *slave->topology_changed = true;
}

void cm1e_sim_esc_power_on(cm1e_sim_slave_t *slave, int64_t now_ns)
{
    memset(slave->memory, 0, sizeof slave->memory);
    slave->powered_on_ns = now_ns;
    slave->now_ns = now_ns;
    slave->absent_until_ns = 0;
    slave->detached = slave->detached && !slave->attaching;
    slave->attaching = false;
    cm1e_sim_esc_dc_power_on(slave, now_ns);
    slave->outputs_arrived = false;
    slave->inputs_stale = true;
    if (slave->topology_changed)
        *slave->topology_changed = true;
    cm1e_sim_esc_registers_power_on(slave);
    cm1e_sim_esc_sii_power_on(slave);
    assign_roles(slave);
    cm1e_sim_esc_fmmu_decode(slave);
    cm1e_sim_mailbox_stop(slave);
    cm1e_sim_al_power_on(slave);
}

void cm1e_sim_esc_advance(cm1e_sim_slave_t *slave, int64_t now_ns)
{
    slave->now_ns = now_ns;
    slave->inputs_stale = true;
    if (!cm1e_sim_esc_present(slave)) {
        if (now_ns < slave->absent_until_ns)
            return;
        cm1e_sim_esc_power_on(slave, now_ns);
        if (slave->ops->power_on)
            slave->ops->power_on(slave->app, now_ns);
    }
    cm1e_sim_esc_dc_advance(slave, now_ns);
    cm1e_sim_esc_sync_supervise(slave);
    if (now_ns >= slave->sii_due_ns)
        cm1e_sim_esc_sii_due(slave);
    if (now_ns >= slave->watchdog_due_ns)
        cm1e_sim_al_watchdog_due(slave);
    if (now_ns >= slave->al_due_ns)
        cm1e_sim_al_due(slave);
    if (slave->ops->advance)
        slave->ops->advance(slave->app, now_ns);
    if (now_ns >= slave->mailbox_due_ns)
        cm1e_sim_mailbox_due(slave);
}

int64_t cm1e_sim_esc_due(const cm1e_sim_slave_t *slave)
{
    if (!cm1e_sim_esc_present(slave))
        return slave->absent_until_ns;
    const int64_t times[] = {slave->sii_due_ns, slave->watchdog_due_ns, slave->al_due_ns, slave->mailbox_due_ns,
                             slave->ops->due ? slave->ops->due(slave->app) : ESC_NEVER};
    int64_t first = ESC_NEVER;
    for (size_t i = 0; i < sizeof times / sizeof times[0]; i++)
        first = times[i] < first ? times[i] : first;
    return first;
}

/* Reads into `read`, or writes `written` where that is not NULL: registers, memory behind sync managers, other
 * memory. */
static bool access_memory(cm1e_sim_slave_t *slave, uint32_t address, uint8_t *read, const uint8_t *written,
                          size_t length)
{
    const uint32_t begin = address, end = address + (uint32_t)length;
    bool any = false;
    for (size_t n; address < end && address < ESC_MEMORY_BYTES; address += (uint32_t)n) {
        uint8_t *to = read ? read + (address - begin) : NULL;
        const uint8_t *from = written ? written + (address - begin) : NULL;
        if (address < ESC_REGISTER_BYTES) {
            n = (end < ESC_REGISTER_BYTES ? end : ESC_REGISTER_BYTES) - address;
            any |= from ? cm1e_sim_esc_registers_write(slave, (uint16_t)address, from, n)
                        : cm1e_sim_esc_registers_read(slave, (uint16_t)address, to, n);
            continue;
        }
        esc_sync_manager_t *sm;
        n = cm1e_sim_esc_sm_span(slave, address, end, &sm);
        const uint16_t offset = sm ? (uint16_t)(address - sm->start) : 0;
        if (sm)
            any |= from ? cm1e_sim_esc_sm_write(slave, sm, offset, from, n)
                        : cm1e_sim_esc_sm_read(slave, sm, offset, to, n);
        else if (from)
            memcpy(slave->memory + address, from, n);
        else
            /* NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): what is not written is read */
            memcpy(to, slave->memory + address, n);
        any = any || !sm;
    }
    return any;
}

bool cm1e_sim_esc_read(cm1e_sim_slave_t *slave, uint32_t address, uint8_t *data, size_t length)
{
    return access_memory(slave, address, data, NULL, length);
}

bool cm1e_sim_esc_write(cm1e_sim_slave_t *slave, uint32_t address, const uint8_t *data, size_t length)
{
    return access_memory(slave, address, NULL, data, length);
}
