/** cm1e sii read|write|decode: the EEPROM with the identity of a slave. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "attach.h"
#include "cm1e/sii.h"
#include "command.h"
#include "core/json_text.h"
#include "description/sii_image.h"
#include "files.h"
#include "sii_device.h"
#include "sii_text.h"
#include "which_slave.h"

enum { KEY_BACKUP = 0x500, KEY_FORCE_CHECKSUM, KEY_FORCE_IDENTITY, KEY_FORCE_CONFIGURATION, KEY_OWN };

typedef struct sii_options {
    common_options_t common;
    const char *words[3]; /* read|write, position, file; decode, file or position */
    int word_count;
    const char *backup;
    cm1e_sii_write_options_t write;
} sii_options_t;

static bool is_verb(const sii_options_t *options, const char *verb, int words)
{
    return options->word_count == words && strcmp(options->words[0], verb) == 0;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    sii_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_BACKUP:
        need_name(state, "--backup", arg);
        options->backup = arg;
        return 0;
    case KEY_FORCE_CHECKSUM: options->write.force_checksum = true; return 0;
    case KEY_FORCE_IDENTITY: options->write.force_identity = true; return 0;
    case KEY_FORCE_CONFIGURATION: options->write.force_configuration = true; return 0;
    case KEY_OWN: options->write.own_alias_and_serial = true; return 0;
    case ARGP_KEY_ARG:
        if (options->word_count >= 3)
            argp_error(state, "too many arguments from \"%s\" on", arg);
        if (options->word_count == 0 && choose_word("action", arg, "read|write|decode") < 0)
            return EINVAL;
        options->words[options->word_count++] = arg;
        return 0;
    case ARGP_KEY_END:
        if (!is_verb(options, "read", 3) && !is_verb(options, "write", 3) && !is_verb(options, "decode", 2))
            argp_error(state, "expected: read POSITION|AXIS FILE, write POSITION|AXIS FILE, or decode FILE|POSITION|AXIS");
        need_name(state, "the file", options->words[options->word_count - 1]);
        if (is_verb(options, "write", 3) && !options->backup)
            argp_error(state, "writing needs a backup of the present contents of the slave: --backup FILE");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/** Opens the bus of the options, or attaches to the program that has it, unless an SII is to be written;
 *  NULL, a complaint and the exit status after an error. It does not scan, because a damaged SII stops a scan. */
static cm1e_bus_t *open_bus(const sii_options_t *options, cm1e_bus_config_t *config, int *status)
{
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    *status = EXIT_WRONG_USE;
    if (!load_network(&options->common, config))
        return NULL;
    const bool writes = is_verb(options, "write", 3);
    if ((writes ? own_network(&options->common, config, "Writing an SII",
                                "while it is written, the application of the slave has no access to it", &bus, &diag)
                : open_unscanned(&options->common, config, &bus, &diag)) != CM1E_OK)
        *status = fail(&diag);
    return bus;
}

/* ---- read ------------------------------------------------------------------------------------------------------- */

static int run_read(cm1e_bus_t *bus, const sii_options_t *options, uint16_t position)
{
    cm1e_diag_t diag = {0};
    input_t image;
    if (!read_device(bus, position, &image, &diag))
        return fail(&diag);
    const bool written = write_output(options->words[2], image.bytes, image.size);
    if (written && options->common.json)
        print_json(json_pack("{s:o, s:I}", "file", cm1e_json_text(options->words[2]), "bytes", (json_int_t)image.size));
    else if (written && strcmp(options->words[2], "-") != 0)
        printf("%s: %zu bytes, the SII of slave %u\n", options->words[2], image.size, position);
    free(image.bytes);
    return written ? EXIT_OK : EXIT_FAILED;
}

/* ---- write ------------------------------------------------------------------------------------------------------ */

static int write_and_tell(cm1e_bus_t *bus, const sii_options_t *options, uint16_t position, const input_t *image,
                          const input_t *present)
{
    const int status = write_device(bus, position, image, present, options->backup, &options->write);
    if (status != EXIT_OK)
        return status;
    if (options->common.json)
        print_json(json_pack("{s:b, s:o}", "written", true, "backup", cm1e_json_text(options->backup)));
    else
        printf("The SII of slave %u is written, and reading it back gave the same data; the earlier contents are in "
               "%s.\nSwitch the slave off and on: it then uses the new SII.\n", position, options->backup);
    return EXIT_OK;
}

static int run_write(cm1e_bus_t *bus, const sii_options_t *options, uint16_t position)
{
    cm1e_diag_t diag = {0};
    input_t image, present;
    if (!read_input(options->words[2], &image))
        return EXIT_WRONG_USE;
    int status = EXIT_FAILED;
    if (read_device(bus, position, &present, &diag)) {
        status = write_and_tell(bus, options, position, &image, &present);
        free(present.bytes);
    } else {
        fail(&diag);
    }
    free(image.bytes);
    return status;
}

/* ---- decode ----------------------------------------------------------------------------------------------------- */

static int decode(const input_t *image, bool json)
{
    cm1e_diag_t diag = {0};
    cm1e_description_file_t file = {0};
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_error_t error = findings ? cm1e_sii_read(&file, image->bytes, image->size, findings, &diag)
                                  : cm1e_diag_set(&diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    if (error == CM1E_OK && json)
        print_json(sii_as_json(&file.devices.at[0], image->size, findings));
    else if (error == CM1E_OK)
        print_sii(&file.devices.at[0], image->size, findings);
    cm1e_description_file_free(&file);
    cm1e_findings_free(findings);
    return error == CM1E_OK ? EXIT_OK : fail(&diag);
}

/* ---- the command ------------------------------------------------------------------------------------------------ */

static int run_on_bus(const sii_options_t *options)
{
    static cm1e_bus_config_t config;
    uint16_t position;
    int status;
    cm1e_bus_t *bus = open_bus(options, &config, &status);
    if (!bus)
        return status;
    status = find_slave_unscanned(bus, axes_to_name(&options->common, &config), options->words[1], &position);
    if (status != EXIT_OK)
        return close_bus(bus, &options->common, status);
    if (is_verb(options, "read", 3)) {
        status = run_read(bus, options, position);
    } else if (is_verb(options, "write", 3)) {
        status = run_write(bus, options, position);
    } else {
        cm1e_diag_t diag = {0};
        input_t image;
        status = read_device(bus, position, &image, &diag) ? decode(&image, options->common.json) : fail(&diag);
        free(image.bytes);
    }
    return close_bus(bus, &options->common, status);
}

static const struct argp_option table[] = {
    {"backup", KEY_BACKUP, "FILE", 0, "write: file for the present contents of the slave; it must not exist", 0},
    {"force-checksum", KEY_FORCE_CHECKSUM, NULL, 0, "write: allow an image whose checksum is wrong", 0},
    {"force-identity", KEY_FORCE_IDENTITY, NULL, 0,
     "write: allow a slave that is not a CM1-E, or not the product of the image", 0},
    {"force-configuration", KEY_FORCE_CONFIGURATION, NULL, 0,
     "write: allow words 0-6 that differ from the slave's; a wrong word can make the slave unreachable", 0},
    {"own-alias-and-serial", KEY_OWN, NULL, 0,
     "write: also write alias and serial number of the image; by default those of the slave stay", 0},
    {0}};
const struct argp argp_sii = {
    table, parse, "read POSITION|AXIS FILE\nwrite POSITION|AXIS FILE --backup FILE\ndecode FILE|POSITION|AXIS",
    "Reads, writes or shows the SII, the EEPROM with the identity of a slave. Writing changes only the words that "
    "differ, reads all data back, and names the word at which it stopped; Ctrl-C does not break it off. To undo it, "
    "write the backup with `cm1e sii write`. AXIS is the name of an axis or a slave in the bus file; `decode` takes a "
    "file where neither a network nor a bus file is stated.",
    attach_children, NULL, NULL};

/** `decode` takes a file, too: a word that is no position names a slave where a network is stated. */
static bool is_of_slave(const sii_options_t *options)
{
    const common_options_t *common = &options->common;
    return !is_verb(options, "decode", 2) || is_position(options->words[1]) || common->interface_name ||
           common->bus_file || common->attach;
}

int command_sii(int argc, char **argv)
{
    sii_options_t options = {0};
    if (parse_options(&argp_sii, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (is_of_slave(&options))
        return run_on_bus(&options);
    input_t image;
    if (!read_input(options.words[1], &image))
        return EXIT_WRONG_USE;
    int status = EXIT_FAILED;
    if (cm1e_file_recognise(image.bytes, image.size) == CM1E_FILE_SII)
        status = decode(&image, options.common.json);
    else
        complain("%s is not an SII image", options.words[1]);
    free(image.bytes);
    return status;
}
