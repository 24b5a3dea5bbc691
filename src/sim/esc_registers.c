#include "sim/esc_chip.h"

#include <string.h>

#include "core/bytes.h"

typedef struct range {
    uint16_t first, last;
} range_t;

/* Registers that the master may write; all others are read-only or reserved. */
static const range_t writable_ranges[] = {
    {0x0010, 0x0011}, {0x0100, 0x0103}, {0x0120, 0x0121}, {0x0200, 0x0201}, {0x0300, 0x030D}, {0x0310, 0x0313},
    {0x0400, 0x0401}, {0x0410, 0x0411}, {0x0420, 0x0421}, {0x0442, 0x0443}, {0x0500, 0x0500}, {0x0502, 0x050F},
    {0x0600, 0x067F}, {0x0800, 0x081F}, {0x0900, 0x0903}, {0x0910, 0x0917}, {0x0920, 0x092B}, {0x0930, 0x0931},
    {0x0934, 0x0935}, {0x0980, 0x0981}, {0x0990, 0x0997}, {0x09A0, 0x09A9}, {0x0F80, 0x0FFF},
};
enum { WRITABLE_RANGES = sizeof writable_ranges / sizeof writable_ranges[0] };
enum { SM_BYTES = 8, SM_STATUS = 5, SM_ACTIVATE = 6, SM_PDI = 7 };

static bool range_writable(uint16_t address)
{
    for (int i = 0; i < WRITABLE_RANGES && writable_ranges[i].first <= address; i++)
        if (address <= writable_ranges[i].last)
            return true;
    return false;
}

/* Start, length and control of a sync manager can be written only while it is off (0x0806 bit 0). */
static bool sm_writable(const cm1e_sim_slave_t *slave, uint16_t address)
{
    const unsigned field = (unsigned)(address - ESC_SM) % SM_BYTES;
    const uint8_t activate = slave->memory[address - field + SM_ACTIVATE];
    return field == SM_ACTIVATE || (field < SM_STATUS && !(activate & 0x01));
}

static bool writable(const cm1e_sim_slave_t *slave, uint16_t address)
{
    if (!range_writable(address))
        return false;
    if (address >= ESC_SM && address < ESC_SM + ESC_SYNC_MANAGERS * SM_BYTES)
        return sm_writable(slave, address);
    if (address >= ESC_SII_CONTROL && address < ESC_SII_DATA + 8)
        return cm1e_sim_esc_sii_writable(slave);
    return true;
}

/* Error counters are cleared by writing any of their group, whatever the value. */
static void clear_receive_errors(cm1e_sim_slave_t *slave) { memset(slave->memory + ESC_RX_ERRORS, 0, 12); }
static void clear_unit_errors(cm1e_sim_slave_t *slave) { slave->memory[ESC_UNIT_ERRORS] = 0; }
static void clear_pdi_errors(cm1e_sim_slave_t *slave) { slave->memory[ESC_UNIT_ERRORS + 1] = 0; }
static void clear_lost_links(cm1e_sim_slave_t *slave) { memset(slave->memory + ESC_LOST_LINKS, 0, 4); }
static void clear_watchdog_counters(cm1e_sim_slave_t *slave) { memset(slave->memory + ESC_WATCHDOG_COUNTERS, 0, 2); }

static void dl_control_written(cm1e_sim_slave_t *slave)
{
    if (slave->topology_changed)
        *slave->topology_changed = true;
}

static void sync_managers_written(cm1e_sim_slave_t *slave)
{
    const unsigned count = cm1e_sim_quirk_sync_managers(slave);
    memset(slave->memory + ESC_SM + count * SM_BYTES, 0, (ESC_SYNC_MANAGERS - count) * SM_BYTES);
    for (unsigned i = 0; i < ESC_SYNC_MANAGERS; i++)
        cm1e_sim_esc_sm_decode(slave, i);
    cm1e_sim_mailbox_repeat(slave);
}

/* Actions of a write into a range, in the order of execution. */
static const struct effect {
    uint16_t first, last;
    void (*act)(cm1e_sim_slave_t *slave);
} effects[] = {
    {0x0100, 0x0103, dl_control_written},
    {0x0120, 0x0120, cm1e_sim_al_control},
    {0x0300, 0x030B, clear_receive_errors},
    {0x030C, 0x030C, clear_unit_errors},
    {0x030D, 0x030D, clear_pdi_errors},
    {0x0310, 0x0313, clear_lost_links},
    {0x0400, 0x0421, cm1e_sim_al_watchdog_changed},
    {0x0442, 0x0443, clear_watchdog_counters},
    {0x0500, 0x0500, cm1e_sim_esc_sii_config},
    {0x0502, 0x0503, cm1e_sim_esc_sii_command},
    {0x0600, 0x067F, cm1e_sim_esc_fmmu_decode},
    {0x0800, 0x081F, sync_managers_written},
    {0x0900, 0x0900, cm1e_sim_esc_dc_latch},
    {0x0930, 0x0931, cm1e_sim_esc_dc_restart},
    {0x0981, 0x0981, cm1e_sim_esc_dc_activated},
};
enum { EFFECTS = sizeof effects / sizeof effects[0] };

static bool touches(uint32_t address, size_t length, uint32_t first, uint32_t last)
{
    return address <= last && address + length > first;
}

bool cm1e_sim_esc_registers_write(cm1e_sim_slave_t *slave, uint16_t address, const uint8_t *data, size_t length)
{
    if (slave->clock.troubles.absent && address >= ESC_DC_PORT_TIMES && address < ESC_DC_END)
        return false;
    /* The frame of every cycle of a master that uses distributed clocks: keep it short. The write is compared with the
     * system time, not stored (0x0910). */
    if (address == ESC_DC_SYSTEM_TIME && length >= 4 && length <= 8) {
        cm1e_sim_esc_dc_received(slave, data);
        return true;
    }
    /* Bytes that the write itself would make writable are not written: the state before the frame counts. */
    bool any = false, sii_writable = cm1e_sim_esc_sii_writable(slave);
    uint8_t before[ESC_REGISTER_BYTES / 8] = {0};
    for (size_t i = 0; i < length; i++)
        if (writable(slave, (uint16_t)(address + i)))
            before[i / 8] |= (uint8_t)(1u << i % 8);
    for (size_t i = 0; i < length; i++)
        if (before[i / 8] & 1u << i % 8) {
            slave->memory[address + i] = data[i];
            any = true;
        }
    if (!any)
        return false;
    for (int i = 0; i < EFFECTS; i++)
        if (touches(address, length, effects[i].first, effects[i].last) &&
            (effects[i].act != cm1e_sim_esc_sii_command || sii_writable))
            effects[i].act(slave);
    return true;
}

bool cm1e_sim_esc_registers_read(cm1e_sim_slave_t *slave, uint16_t address, uint8_t *data, size_t length)
{
    if (touches(address, length, ESC_DC_SYSTEM_TIME, ESC_DC_SYSTEM_TIME + 7))
        cm1e_sim_esc_dc_refresh(slave);
    memcpy(data, slave->memory + address, length);
    if (touches(address, length, ESC_DL_STATUS, ESC_DL_STATUS + 1))
        cm1e_sim_esc_event(slave, ESC_EVENT_DL_STATUS, false);
    if (touches(address, length, ESC_AL_STATUS, ESC_AL_STATUS + 1))
        cm1e_sim_esc_event(slave, ESC_EVENT_AL_STATUS, false);
    return length > 0;
}

void cm1e_sim_esc_registers_power_on(cm1e_sim_slave_t *slave)
{
    uint8_t *memory = slave->memory;
    memory[ESC_TYPE] = 0x04; /* an IP core: the only type whose units are free in number */
    memory[ESC_TYPE + 1] = 0x03;
    memory[ESC_FMMU_COUNT] = (uint8_t)cm1e_sim_quirk_fmmus(slave);
    memory[ESC_SM_COUNT] = (uint8_t)cm1e_sim_quirk_sync_managers(slave);
    memory[ESC_RAM_SIZE] = (ESC_MEMORY_BYTES - ESC_REGISTER_BYTES) / 1024;
    memory[ESC_PORT_DESCRIPTOR] = 0x0F; /* ports 0 and 1: MII */
    /* FMMUs to the bit, distributed clocks with 64 bits. */
    cm1e_put_u16(memory + ESC_FEATURES, slave->clock.troubles.absent ? 0x0000 : 0x000C);
    cm1e_put_u32(memory + ESC_DL_CONTROL, 0x00070001);
    cm1e_put_u16(memory + ESC_WATCHDOG_DIVIDER, 0x09C2); /* 100 us */
    cm1e_put_u16(memory + ESC_WATCHDOG_PDI, 0x03E8);     /* 100 ms */
    cm1e_put_u16(memory + ESC_WATCHDOG_DATA, 0x03E8);
    cm1e_put_u16(memory + ESC_DC_SPEED_START, 0x1000);
    cm1e_put_u16(memory + 0x0934, 0x0C00); /* filter depths: 0x0C speed, 0 system time difference */
}
