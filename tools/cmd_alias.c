/** cm1e alias: shows or writes the configured station alias of a slave: word 4 of its SII. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "core/bytes.h"
#include "core/json_text.h"
#include "description/sii_image.h"
#include "sii_device.h"
#include "which_slave.h"

enum { KEY_BACKUP = 0x600 };

typedef struct alias_options {
    common_options_t common;
    const char *where, *backup;
    long long alias; /* -1: show it */
} alias_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    alias_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_BACKUP: options->backup = arg; return 0;
    case ARGP_KEY_ARG:
        if (!options->where) {
            options->where = arg;
            return 0;
        }
        if (options->alias >= 0)
            argp_error(state, "too many arguments from \"%s\" on", arg);
        return parse_number(arg, "the alias", 0, 0xFFFF, &options->alias) ? 0 : EINVAL;
    case ARGP_KEY_END:
        if (!options->where)
            argp_error(state, "expected: POSITION|AXIS to show the alias, or POSITION|AXIS ALIAS --backup FILE to write it");
        if (options->alias >= 0 && !options->backup)
            argp_error(state, "writing needs a backup of the present EEPROM of the slave: --backup FILE");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/** Two slaves with one alias cannot be told apart. */
static bool is_free(cm1e_bus_t *bus, uint16_t position, long long alias)
{
    for (uint32_t i = 1; alias != 0 && i <= cm1e_bus_slave_count(bus); i++)
        if (i != position && cm1e_bus_slave(bus, i)->alias == alias) {
            complain("slave %u has the alias %lld already; nothing was written", (unsigned)i, alias);
            return false;
        }
    return true;
}

static int write_alias(cm1e_bus_t *bus, const alias_options_t *options, uint16_t position)
{
    cm1e_diag_t diag = {0};
    input_t present, image;
    if (!read_device(bus, position, &present, &diag))
        return fail(&diag);
    const unsigned before = cm1e_get_u16(present.bytes + CM1E_SII_ALIAS);
    image = (input_t){.bytes = malloc(present.size), .size = present.size};
    int status = EXIT_FAILED;
    if (image.bytes) {
        memcpy(image.bytes, present.bytes, present.size);
        cm1e_put_uint(image.bytes + CM1E_SII_ALIAS, 2, (uint64_t)options->alias);
        image.bytes[CM1E_SII_CHECKSUM] = cm1e_sii_crc8(image.bytes, CM1E_SII_CONFIG_BYTES);
        const cm1e_sii_write_options_t write = {.own_alias_and_serial = true, .force_identity = true};
        status = write_device(bus, position, &image, &present, options->backup, &write);
    }
    if (status == EXIT_OK && options->common.json)
        print_json(json_pack("{s:i, s:i, s:I, s:o}", "position", position, "before", (int)before, "alias",
                             (json_int_t)options->alias, "backup", cm1e_json_text(options->backup)));
    else if (status == EXIT_OK)
        printf("slave %u: the alias was %u; it is %lld when the slave has been switched off and on. The earlier "
               "EEPROM is in %s; "
               "`cm1e sii write %u %s --own-alias-and-serial` writes it back.\n", position, before, options->alias,
               options->backup, position, options->backup);
    free(image.bytes);
    free(present.bytes);
    return status;
}

static int show_or_write(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const alias_options_t *options = context;
    (void)config;
    if (options->alias >= 0)
        return is_free(bus, position, options->alias) ? write_alias(bus, options, position) : EXIT_FAILED;
    const unsigned alias = cm1e_bus_slave(bus, position)->alias;
    if (options->common.json)
        print_json(json_pack("{s:i, s:i}", "position", position, "alias", (int)alias));
    else
        printf("slave %u: alias %u%s\n", position, alias, alias ? "" : " (none)");
    return EXIT_OK;
}

static const struct argp_option table[] = {
    {"backup", KEY_BACKUP, "FILE", 0, "File for the present EEPROM of the slave; it must not exist", 0},
    {0}};
const struct argp argp_alias = {
    table, parse, "POSITION|AXIS [ALIAS]",
    "Shows or writes the alias of a slave, by which a bus file can address it wherever it is wired (`alias:`). 0 is "
    "none. "
    "Only the alias and its checksum change in the EEPROM, and are read back. The slave uses the alias from its next "
    "power-on.", common_children, NULL, NULL};

int command_alias(int argc, char **argv)
{
    alias_options_t options = {.alias = -1};
    if (parse_options(&argp_alias, argc, argv, &options))
        return EXIT_WRONG_USE;
    return run_on_slave(&options.common, options.where, show_or_write, &options);
}
