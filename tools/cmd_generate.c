/** cm1e generate: files for other masters and tools, written from the device tables. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "cm1e/generate.h"

enum { KEY_FIRMWARE = 0x400, KEY_ORDER, KEY_ALIAS };

typedef struct generate_options {
    const char *format, *file;
    cm1e_device_options_t device;
} generate_options_t;

static error_t parse_order(const char *word, cm1e_device_options_t *device)
{
    if (strcmp(word, "ug-4.4") != 0 && strcmp(word, "ug-7.2") != 0) {
        complain("there is no PDO order \"%s\"; there are ug-4.4 and ug-7.2", word);
        return EINVAL;
    }
    device->order = strcmp(word, "ug-7.2") == 0 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4;
    return 0;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    generate_options_t *options = state->input;
    long long number;
    switch (key) {
    case 'o': options->file = arg; return 0;
    case KEY_FIRMWARE:
        snprintf(options->device.firmware, sizeof options->device.firmware, "%s", arg);
        return 0;
    case KEY_ORDER: return parse_order(arg, &options->device);
    case KEY_ALIAS:
        if (!parse_number(arg, "the alias", 0, 0xFFFF, &number))
            return EINVAL;
        options->device.alias = (uint16_t)number;
        return 0;
    case ARGP_KEY_ARG:
        if (options->format)
            argp_error(state, "one format at a time; \"%s\" is too many", arg);
        options->format = arg;
        return 0;
    case ARGP_KEY_END:
        if (!options->format || strcmp(options->format, "sii") != 0)
            argp_error(state, "which format? This version writes: sii");
        if (!options->file)
            argp_error(state, "where to? -o FILE");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/** Writes to a temporary name beside the file, then renames: nobody sees half a file. */
static bool write_file(const char *path, const uint8_t *bytes, size_t size)
{
    char temporary[4096];
    if ((size_t)snprintf(temporary, sizeof temporary, "%s.part", path) >= sizeof temporary) {
        complain("the file name is too long");
        return false;
    }
    FILE *file = fopen(temporary, "wb");
    bool good = file && fwrite(bytes, 1, size, file) == size;
    good = file && fclose(file) == 0 && good && rename(temporary, path) == 0;
    if (!good) {
        complain("cannot write %s: %s", path, strerror(errno));
        remove(temporary);
    }
    return good;
}

int command_generate(int argc, char **argv)
{
    static const struct argp_option table[] = {
        {"output", 'o', "FILE", 0, "Where to write", 0},
        {"firmware", KEY_FIRMWARE, "VERSION", 0, "1.2.0 ... 1.3.5 (default)", 0},
        {"pdo-order", KEY_ORDER, "ORDER", 0, "ug-4.4 (default) or ug-7.2", 0},
        {"alias", KEY_ALIAS, "NUMBER", 0, "Configured station alias; default 0", 0},
        {0}};
    static const struct argp argp = {table, parse, "sii",
                                     "Writes the SII image of a CM1-E from the device tables, the one that the "
                                     "simulator boots from. Not for writing into a real device: its configuration "
                                     "area is not known.", NULL, NULL, NULL};
    generate_options_t options = {0};
    if (argp_parse(&argp, argc, argv, 0, NULL, &options))
        return EXIT_WRONG_USE;
    const cm1e_generate_options_t what = {.format = CM1E_FILE_SII, .devices = &options.device, .device_count = 1};
    cm1e_diag_t diag = {0};
    cm1e_file_t file;
    const cm1e_error_t error = cm1e_generate(&file, &what, &diag);
    if (error == CM1E_ERROR_CONFIG) {
        complain("%s", diag.text);
        return EXIT_WRONG_USE;
    }
    if (error != CM1E_OK)
        return fail(&diag);
    const bool written = write_file(options.file, file.bytes, file.size);
    cm1e_file_free(&file);
    return written ? EXIT_OK : EXIT_FAILED;
}
