#include "sim/esc_chip.h"

#include <string.h>

#include "core/bytes.h"
#include "description/sii_image.h"

/* SII control/status 0x0502. */
enum {
    WRITE_ENABLE = 0x0001, READS_8_BYTES = 0x0040, TWO_ADDRESS_BYTES = 0x0080, COMMAND = 0x0700, COMMAND_READ = 0x0100,
    COMMAND_WRITE = 0x0200, COMMAND_RELOAD = 0x0400, ERROR_CHECKSUM = 0x0800, ERROR_LOADING = 0x1000,
    ERROR_COMMAND = 0x2000, ERROR_WRITE_ENABLE = 0x4000, BUSY = 0x8000,
    ERRORS_OF_COMMANDS = ERROR_COMMAND | ERROR_WRITE_ENABLE,
};
/* Times of an I2C EEPROM, roughly. */
enum { READ_NS = 150000, WRITE_NS = 3000000, RELOAD_NS = 1000000 };
enum { CONFIG_OFFERED_TO_PDI = 0x01 };

static uint16_t control(const cm1e_sim_slave_t *slave) { return cm1e_get_u16(slave->memory + ESC_SII_CONTROL); }
static void set_control(cm1e_sim_slave_t *slave, unsigned set, unsigned clear)
{
    cm1e_put_u16(slave->memory + ESC_SII_CONTROL, (uint16_t)((control(slave) & ~clear) | set));
}

static bool checksum_valid(const cm1e_sim_slave_t *slave)
{
    return slave->sii_size >= CM1E_SII_HEADER_BYTES &&
           cm1e_sii_crc8(slave->sii, CM1E_SII_CONFIG_BYTES) == slave->sii[CM1E_SII_CHECKSUM];
}

static void load_configuration(cm1e_sim_slave_t *slave)
{
    slave->sii_valid = checksum_valid(slave);
    set_control(slave, slave->sii_valid ? 0 : ERROR_CHECKSUM | ERROR_LOADING, ERROR_CHECKSUM | ERROR_LOADING);
    if (!slave->sii_valid)
        return;
    slave->memory[ESC_PDI_CONTROL] = slave->sii[0];
    slave->memory[ESC_PDI_CONTROL + 1] = slave->sii[1];
}

void cm1e_sim_esc_sii_power_on(cm1e_sim_slave_t *slave)
{
    slave->sii_due_ns = ESC_NEVER;
    set_control(slave, TWO_ADDRESS_BYTES | (slave->sii_reads_8_bytes ? READS_8_BYTES : 0), 0xFFFF);
    load_configuration(slave);
    /* The alias is taken over by the first loading only: a reload does not change it (0x0012). */
    if (slave->sii_valid)
        memcpy(slave->memory + ESC_STATION_ALIAS, slave->sii + CM1E_SII_ALIAS, 2);
    if (slave->ops->station_alias)
        slave->ops->station_alias(slave->app, cm1e_get_u16(slave->memory + ESC_STATION_ALIAS));
}

bool cm1e_sim_esc_sii_writable(const cm1e_sim_slave_t *slave)
{
    return !(control(slave) & BUSY) && !(slave->memory[ESC_SII_CONFIG] & CONFIG_OFFERED_TO_PDI);
}

/* 0x0500: bit 0 offers the interface to the slave's processor, which has no use for it here; bit 1 takes it back. */
void cm1e_sim_esc_sii_config(cm1e_sim_slave_t *slave)
{
    slave->memory[ESC_SII_CONFIG] &= 0x03;
    slave->memory[ESC_SII_PDI_ACCESS] = 0;
}

/* The register holds what the master wrote: only command and write enable count, the rest is status of ours. */
void cm1e_sim_esc_sii_command(cm1e_sim_slave_t *slave)
{
    const uint16_t written = control(slave);
    const bool write_enabled = (written & WRITE_ENABLE) != 0;
    const unsigned fixed = TWO_ADDRESS_BYTES | (slave->sii_reads_8_bytes ? READS_8_BYTES : 0) |
                           (slave->sii_valid ? 0 : ERROR_CHECKSUM | ERROR_LOADING);
    cm1e_put_u16(slave->memory + ESC_SII_CONTROL, (uint16_t)(fixed | (written & (COMMAND | WRITE_ENABLE))));
    switch (written & COMMAND) {
    case 0: /* clears the errors of the last command */
        return;
    case COMMAND_READ:
        slave->sii_due_ns = slave->now_ns + READ_NS + slave->quirks.sii_extra_ns;
        break;
    case COMMAND_WRITE:
        if (!write_enabled) {
            set_control(slave, ERROR_WRITE_ENABLE, COMMAND);
            return;
        }
        slave->sii_due_ns = slave->now_ns + WRITE_NS;
        break;
    case COMMAND_RELOAD:
        slave->sii_due_ns = slave->now_ns + RELOAD_NS;
        break;
    default:
        set_control(slave, ERROR_COMMAND, COMMAND | WRITE_ENABLE);
        return;
    }
    set_control(slave, BUSY, WRITE_ENABLE);
}

/* false: behind the end of the EEPROM, which does not acknowledge. */
static bool read_words(cm1e_sim_slave_t *slave, uint32_t word)
{
    const size_t at = 2 * (size_t)word, bytes = slave->sii_reads_8_bytes ? 8 : 4;
    if (at >= slave->sii_size)
        return false;
    for (size_t i = 0; i < bytes; i++)
        slave->memory[ESC_SII_DATA + i] = at + i < slave->sii_size ? slave->sii[at + i] : 0xFF;
    return true;
}

static bool write_word(cm1e_sim_slave_t *slave, uint32_t word)
{
    const size_t at = 2 * (size_t)word;
    if (at + 2 > slave->sii_size)
        return false;
    memcpy(slave->sii + at, slave->memory + ESC_SII_DATA, 2);
    return true;
}

void cm1e_sim_esc_sii_due(cm1e_sim_slave_t *slave)
{
    const uint32_t word = cm1e_get_u32(slave->memory + ESC_SII_ADDRESS);
    bool done = true;
    slave->sii_due_ns = ESC_NEVER;
    switch (control(slave) & COMMAND) {
    case COMMAND_READ:
        done = read_words(slave, word);
        break;
    case COMMAND_WRITE:
        done = write_word(slave, word);
        break;
    default:
        load_configuration(slave);
        break;
    }
    set_control(slave, done ? 0 : ERROR_COMMAND, BUSY | COMMAND | ERRORS_OF_COMMANDS);
}

size_t cm1e_sim_esc_sii_category(const cm1e_sim_slave_t *slave, uint16_t type, size_t *bytes)
{
    cm1e_sii_category_t category;
    for (size_t at = CM1E_SII_HEADER_BYTES; cm1e_sii_category_at(&category, slave->sii, slave->sii_size, at) &&
                                            category.type != CM1E_SII_CATEGORY_END;
         at = category.start + category.bytes) {
        if (category.bytes > slave->sii_size - category.start)
            return 0;
        if (category.type == type) {
            *bytes = category.bytes;
            return category.start;
        }
    }
    return 0;
}
