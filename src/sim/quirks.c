#include "sim/quirks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "description/sii_format.h"
#include "description/sii_image.h"
#include "device/device.h"
#include "sim/esc_chip.h"

unsigned cm1e_sim_quirk_fmmus(const cm1e_sim_slave_t *slave)
{
    return slave->quirks.fmmus ? slave->quirks.fmmus : ESC_FMMUS;
}

unsigned cm1e_sim_quirk_sync_managers(const cm1e_sim_slave_t *slave)
{
    return slave->quirks.sync_managers ? slave->quirks.sync_managers : ESC_SYNC_MANAGERS;
}

static void set_fmmus(cm1e_sim_slave_t *slave, long number) { slave->quirks.fmmus = (uint8_t)number; }
static void set_sync_managers(cm1e_sim_slave_t *slave, long number) { slave->quirks.sync_managers = (uint8_t)number; }
static void set_slow_eeprom(cm1e_sim_slave_t *slave, long us) { slave->quirks.sii_extra_ns = us * INT64_C(1000); }
static void set_slow_mailbox(cm1e_sim_slave_t *slave, long us) { slave->quirks.mailbox_extra_ns = us * INT64_C(1000); }
static void set_abort_info(cm1e_sim_slave_t *slave, long n) { slave->quirks.info_fragments = (unsigned)n; }
static void set_late_id(cm1e_sim_slave_t *slave, long on) { slave->quirks.late_id = on != 0; }
static void set_loop(cm1e_sim_slave_t *slave, long on) { slave->quirks.loops = on != 0; }

static void set_fixed_assignment(cm1e_sim_slave_t *slave, long number)
{
    (void)number;
    slave->quirks.fixed_assignment = true;
}

static void set_fixed_mapping(cm1e_sim_slave_t *slave, long number)
{
    (void)number;
    slave->quirks.fixed_mapping = true;
}

bool cm1e_sim_quirk_is_fixed(const cm1e_sim_slave_t *slave, uint16_t index)
{
    enum { FIRST_RXPDO = 0x1600, END_OF_PDOS = 0x1C00 };
    if (index == OBJ_1C12_RXPDO_ASSIGN || index == OBJ_1C13_TXPDO_ASSIGN)
        return slave->quirks.fixed_assignment;
    return index >= FIRST_RXPDO && index < END_OF_PDOS && slave->quirks.fixed_mapping;
}

/** It lasts as long as the EEPROM. The controller sees it when it loads the EEPROM. */
static void break_checksum(cm1e_sim_slave_t *slave, long number)
{
    (void)number;
    slave->sii[CM1E_SII_CHECKSUM] ^= 0xFF;
    cm1e_sim_esc_sii_power_on(slave);
}

/** A mailbox that carries other protocols only. */
static void hide_coe(cm1e_sim_slave_t *slave, long number)
{
    size_t bytes = 0;
    const size_t general = cm1e_sim_esc_sii_category(slave, SII_CATEGORY_GENERAL, &bytes);
    (void)number;
    slave->sii[CM1E_SII_PROTOCOLS] &= (uint8_t)~SII_PROTOCOL_COE;
    if (bytes > GENERAL_COE)
        slave->sii[general + GENERAL_COE] = 0;
}

/** Position of the other slave, and 1000 times its port: 2003 is port 2 of slave 3. */
static void set_branch(cm1e_sim_slave_t *slave, long number)
{
    slave->quirks.branch_of = (uint16_t)(number % 1000);
    slave->quirks.branch_port = (uint8_t)(number / 1000);
}

static const struct quirk {
    const char *name;
    long least, most; /* of its number; equal: it has none */
    void (*set)(cm1e_sim_slave_t *slave, long number);
} quirks[] = {
    {"fmmus", 1, ESC_FMMUS, set_fmmus},
    {"sync-managers", 1, ESC_SYNC_MANAGERS, set_sync_managers},
    {"slow-eeprom", 1, 1000000, set_slow_eeprom},
    {"slow-mailbox", 1, 10000000, set_slow_mailbox},
    {"abort-info", 1, 1000, set_abort_info},
    {"late-id", 0, 1, set_late_id},
    {"fixed-assignment", 0, 0, set_fixed_assignment},
    {"fixed-mapping", 0, 0, set_fixed_mapping},
    {"loop", 0, 1, set_loop},
    {"branch", 1001, 3999, set_branch},
    {"wrong-checksum", 0, 0, break_checksum},
    {"no-coe", 0, 0, hide_coe},
};
enum { QUIRKS = sizeof quirks / sizeof quirks[0] };

static void renew(cm1e_sim_slave_t *slave)
{
    slave->memory[ESC_FMMU_COUNT] = (uint8_t)cm1e_sim_quirk_fmmus(slave);
    slave->memory[ESC_SM_COUNT] = (uint8_t)cm1e_sim_quirk_sync_managers(slave);
    if (slave->topology_changed)
        *slave->topology_changed = true;
}

static bool list_names(char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "expected nothing or one of:");
    for (int i = 0; i < QUIRKS && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, " %s%s", quirks[i].name,
                                 quirks[i].least < quirks[i].most ? " <number>" : "");
    return false;
}

bool cm1e_sim_quirk(cm1e_sim_slave_t *slave, const char *name, const char *number, char *text, size_t size)
{
    char *end;
    const struct quirk *quirk = NULL;
    for (int i = 0; i < QUIRKS; i++)
        if (strcmp(quirks[i].name, name) == 0)
            quirk = &quirks[i];
    const long value = strtol(number, &end, 10);
    if (strcmp(name, "nothing") == 0)
        slave->quirks = (cm1e_sim_quirks_t){0};
    else if (!quirk)
        return list_names(text, size);
    else if (quirk->least < quirk->most && (end == number || *end || value < quirk->least || value > quirk->most))
        return snprintf(text, size, "%s: expected a number, %ld to %ld", name, quirk->least, quirk->most) < 0;
    else
        quirk->set(slave, value);
    renew(slave);
    snprintf(text, size, "quirk %s %s", name, number);
    return true;
}
