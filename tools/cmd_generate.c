/** cm1e generate: files for other masters and tools, written from the device tables or from another file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "command.h"
#include "core/bytes.h"
#include "core/near.h"
#include "description/sii_image.h"
#include "device/devices.h"
#include "files.h"

enum {
    KEY_FIRMWARE = 0x400, KEY_ORDER, KEY_ALIAS, KEY_LAYOUT, KEY_MAPPING, KEY_DEVICE, KEY_VENDOR, KEY_PRODUCT,
    KEY_REVISION, KEY_AXES, KEY_SERIAL, KEY_DC, KEY_COMPLETE, KEY_CONFIG, KEY_FROM, KEY_NUMBER, KEY_PROGRAM,
    KEY_DC_MODE, KEY_MAILBOX_RATE,
};
enum { MAX_DEVICES = 16 };

typedef struct generate_options {
    common_options_t common;
    cm1e_generate_options_t what;
    cm1e_device_options_t devices[MAX_DEVICES];
    const char *file, *from, *program;
    size_t number;     /**< of the device in the file read, 0 = first */
    bool mapping_given;
    uint32_t given;    /**< bit n: restricted[n] */
    uint32_t once;     /**< bit n: option KEY_FIRMWARE + n of the present device, or of the file */
    struct {
        const char *path;
        uint32_t vendor_id, product_code;
    } config_of[MAX_DEVICES]; /**< image with the configuration words of a device; NULL: none */
} generate_options_t;

/* Options that only some formats have; for other formats they are refused. */
static const struct {
    int key;
    const char *name;
    const char *formats;
    unsigned mask;
    bool beside_from;
} restricted[] = {
    {KEY_LAYOUT, "--layout", "esi", 1u << CM1E_FILE_ESI, false},
    {KEY_PROGRAM, "--program", "ec-extend", 1u << CM1E_FILE_EC_EXTEND, false},
    {KEY_DC_MODE, "--dc-mode", "ec-extend", 1u << CM1E_FILE_EC_EXTEND, false},
    {KEY_MAILBOX_RATE, "--mailbox-rate", "ec-extend", 1u << CM1E_FILE_EC_EXTEND, false},
    {KEY_SERIAL, "--serial", "sii", 1u << CM1E_FILE_SII, false},
    {KEY_ALIAS, "--alias", "sii", 1u << CM1E_FILE_SII, false},
    {KEY_CONFIG, "--config-data", "esi and sii", 1u << CM1E_FILE_ESI | 1u << CM1E_FILE_SII, false},
    {KEY_DC, "--dc", "esi and sii", 1u << CM1E_FILE_ESI | 1u << CM1E_FILE_SII, false},
    {KEY_COMPLETE, "--complete-access", "esi and sii", 1u << CM1E_FILE_ESI | 1u << CM1E_FILE_SII, false},
    {KEY_NUMBER, "--number", "sii", 1u << CM1E_FILE_SII, true},
};
enum { RESTRICTED = sizeof restricted / sizeof restricted[0] };

/* Selects a word of a list; otherwise EINVAL and a complaint that shows the list. */
typedef struct choice {
    const char *word;
    int value;
} choice_t;
static const choice_t formats[] = {{"esi", CM1E_FILE_ESI}, {"ec-extend", CM1E_FILE_EC_EXTEND}, {"sii", CM1E_FILE_SII},
                                   {"eni", CM1E_FILE_ENI}, {0}};
static const choice_t layouts[] = {{"flat", CM1E_ESI_FLAT}, {"mdp", CM1E_ESI_MDP}, {0}};
static const choice_t mappings[] = {{"dynamic", CM1E_MAPPING_DYNAMIC}, {"csp", CM1E_MAPPING_CSP},
                                    {"csv", CM1E_MAPPING_CSV}, {"profile", CM1E_MAPPING_PROFILE}, {0}};
static const choice_t orders[] = {{"ug-4.4", CM1E_PDO_ORDER_UG_4_4}, {"ug-7.2", CM1E_PDO_ORDER_UG_7_2}, {0}};
static const choice_t models[] = {{"cm1-e", CM1E_DEVICE_CM1E}, {"eb01", CM1E_DEVICE_EB01}, {"eb02", CM1E_DEVICE_EB02},
                                  {"eb12", CM1E_DEVICE_EB12}, {0}};

static bool choose(const char *what, const char *word, const choice_t *choices, int *value)
{
    char list[128] = "";
    for (const choice_t *choice = choices; choice->word; choice++) {
        if (strcasecmp(choice->word, word) == 0) {
            *value = choice->value;
            return true;
        }
        snprintf(list + strlen(list), sizeof list - strlen(list), " %s", choice->word);
    }
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = word};
    for (const choice_t *choice = choices; choice->word; choice++)
        cm1e_near_look(&near, choice->word);
    complain("there is no %s \"%s\"; there are%s%s", what, word, list, cm1e_near_text(&near, text, sizeof text));
    return false;
}

static cm1e_device_options_t *device_of(generate_options_t *options)
{
    return &options->devices[options->what.device_count - 1];
}

/* --device begins the next device, and the options after it belong to it. The first device needs no --device. */
static error_t begin_device(generate_options_t *options, const char *word)
{
    int model;
    if (!choose("device", word, models, &model))
        return EINVAL;
    if (options->what.devices) {
        if (options->what.device_count == MAX_DEVICES) {
            complain("more than %d devices", MAX_DEVICES);
            return EINVAL;
        }
        options->what.device_count++;
    }
    options->what.devices = options->devices;
    device_of(options)->model = (cm1e_device_model_t)model;
    return 0;
}

/* Configuration words of another device can make this one unreachable, so the file must be a complete image. Its device
 * is checked when all options are read. */
static bool parse_config_data(const char *path, generate_options_t *options)
{
    input_t input;
    if (!read_input(path, &input))
        return false;
    cm1e_device_options_t *device = device_of(options);
    const bool is_image = cm1e_file_recognise(input.bytes, input.size) == CM1E_FILE_SII;
    const bool whole =
        is_image && cm1e_sii_crc8(input.bytes, CM1E_SII_CONFIG_BYTES) == input.bytes[CM1E_SII_CHECKSUM];
    if (whole) {
        memcpy(device->config_data, input.bytes, CM1E_SII_CONFIG_BYTES);
        device->config_data_size = CM1E_SII_CONFIG_BYTES;
        const size_t n = options->what.device_count - 1;
        options->config_of[n].path = path;
        options->config_of[n].vendor_id = cm1e_get_u32(input.bytes + CM1E_SII_VENDOR);
        options->config_of[n].product_code = cm1e_get_u32(input.bytes + CM1E_SII_PRODUCT);
    } else if (is_image) {
        complain("%s: the checksum of words 0 to 6 is wrong; read the image from the device again", path);
    } else {
        complain("%s is not an SII image, which `cm1e sii read` makes from a real device", path);
    }
    free(input.bytes);
    return whole;
}

static error_t parse_device(int key, char *arg, generate_options_t *options)
{
    cm1e_device_options_t *device = device_of(options);
    long long number = 0;
    int value = 0;
    switch (key) {
    case KEY_FIRMWARE:
        snprintf(device->firmware, sizeof device->firmware, "%s", arg[0] == 'V' || arg[0] == 'v' ? arg + 1 : arg);
        return 0;
    case KEY_MAPPING:
        if (!choose("mapping", arg, mappings, &value))
            return EINVAL;
        device->mapping = (cm1e_mapping_t)value;
        return 0;
    case KEY_ORDER:
        if (!choose("PDO order", arg, orders, &value))
            return EINVAL;
        device->order = (cm1e_pdo_order_t)value;
        return 0;
    case KEY_VENDOR: case KEY_PRODUCT: case KEY_REVISION: case KEY_SERIAL:
        if (!parse_number(arg, key == KEY_VENDOR     ? "the vendor ID"
                               : key == KEY_PRODUCT  ? "the product code"
                               : key == KEY_REVISION ? "the revision"
                                                     : "the serial number", 0, 0xFFFFFFFFLL, &number))
            return EINVAL;
        *(key == KEY_VENDOR ? &device->vendor_id : key == KEY_PRODUCT ? &device->product_code
          : key == KEY_REVISION ? &device->revision : &device->serial_number) = (uint32_t)number;
        return 0;
    case KEY_AXES:
        if (!parse_number(arg, "the number of axes", 1, 4, &number))
            return EINVAL;
        device->axes = (uint32_t)number;
        return 0;
    case KEY_ALIAS:
        if (!parse_number(arg, "the alias", 0, 0xFFFF, &number))
            return EINVAL;
        device->alias = (uint16_t)number;
        return 0;
    case KEY_DC: device->distributed_clocks = true; return 0;
    case KEY_COMPLETE: device->complete_access = true; return 0;
    case KEY_CONFIG: return parse_config_data(arg, options) ? 0 : EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static error_t parse_file(int key, char *arg, generate_options_t *options)
{
    long long number = 0;
    int value = 0;
    switch (key) {
    case 'o': options->file = arg; return 0;
    case KEY_FROM: options->from = arg; return 0;
    case KEY_PROGRAM: options->program = arg; return 0;
    case KEY_DEVICE: return begin_device(options, arg);
    case KEY_LAYOUT:
        if (!choose("layout", arg, layouts, &value))
            return EINVAL;
        options->what.layout = (cm1e_esi_layout_t)value;
        return 0;
    case KEY_NUMBER:
        if (!parse_number(arg, "the number of the device", 1, 100000, &number))
            return EINVAL;
        options->number = (size_t)number - 1;
        return 0;
    case KEY_DC_MODE: case KEY_MAILBOX_RATE:
        if (!parse_number(arg, key == KEY_DC_MODE ? "the DC mode" : "the mailbox rate", 1, 0xFFFF, &number))
            return EINVAL;
        *(key == KEY_DC_MODE ? &options->what.dc_mode : &options->what.mailbox_rate) = (uint16_t)number;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static void check_restricted(const generate_options_t *options, struct argp_state *state)
{
    for (int i = 0; i < RESTRICTED; i++) {
        if (!(options->given & 1u << i))
            continue;
        if (!(restricted[i].mask & 1u << options->what.format))
            argp_error(state, "%s is only for %s", restricted[i].name, restricted[i].formats);
        if (options->from && !restricted[i].beside_from)
            argp_error(state, "%s cannot be used with --from, which takes everything from "
                              "the file", restricted[i].name);
        if (!options->from && restricted[i].beside_from)
            argp_error(state, "%s is only for --from: it selects a device of that file", restricted[i].name);
    }
}

/* Checks that the configuration words belong to the described device. */
static void check_config_data(const generate_options_t *options, struct argp_state *state)
{
    for (size_t i = 0; i < options->what.device_count; i++) {
        const cm1e_device_options_t *device = &options->devices[i];
        const cm1e_device_t *tables = cm1e_device_of_model(device->model);
        const bool has_identity = tables->recognised == CM1E_BY_IDENTITY;
        const uint32_t vendor = has_identity ? tables->vendor_id : device->vendor_id;
        const uint32_t product = has_identity ? tables->product_code : device->product_code;
        if (options->config_of[i].path &&
            (options->config_of[i].vendor_id != vendor || options->config_of[i].product_code != product))
            argp_error(state, "%s is an image of vendor 0x%08X, product 0x%08X; the file describes vendor 0x%08X, "
                       "product 0x%08X, which has other configuration words", options->config_of[i].path,
                       (unsigned)options->config_of[i].vendor_id, (unsigned)options->config_of[i].product_code,
                       (unsigned)vendor, (unsigned)product);
    }
}

static void check_words(const generate_options_t *options, struct argp_state *state)
{
    const cm1e_file_format_t format = options->what.format;
    if (format == CM1E_FILE_UNKNOWN)
        argp_error(state, "the format is missing: esi, ec-extend, sii or eni");
    if (!options->file || !options->file[0])
        argp_error(state, "the output is missing: -o FILE, or -o - for standard output");
    if (options->program && same_file(options->program, options->file))
        argp_error(state, "-o and --program name the same file, \"%s\": each needs its own", options->file);
    if (options->common.json)
        argp_error(state, "generate prints nothing but the file: leave out --json");
    if (options->from && (options->what.devices || options->common.interface_name || options->common.bus_file))
        argp_error(state, "--from takes everything from the file: leave out the options of devices and of the network");
    check_restricted(options, state);
    check_config_data(options, state);
    const bool network = options->common.interface_name || options->common.bus_file;
    if (format == CM1E_FILE_ENI && !network && !options->from)
        argp_error(state, "an ENI describes a network: give -b BUS-FILE for a configured one, or -i INTERFACE to scan "
                          "one");
    if (format != CM1E_FILE_ENI && network)
        argp_error(state, "only an ENI describes a network; leave out -i and -b");
    if (format == CM1E_FILE_ENI && options->mapping_given && !options->common.interface_name)
        argp_error(state, "the bus file states the mapping of a configured axis: leave out --mapping");
    for (size_t i = 0; format == CM1E_FILE_ENI && options->what.devices && i < options->what.device_count; i++)
        if (cm1e_device_of_model(options->devices[i].model)->recognised == CM1E_BY_IDENTITY ||
            options->common.interface_name)
            argp_error(state, "the devices of an ENI come from the network; with a bus file alone, --device eb01 "
                       "(eb02, eb12) states the identity of its bridges");
}

static const struct argp_option table[] = {
    {"output", 'o', "FILE", 0, "Output file; - is standard output", 1},
    {"from", KEY_FROM, "FILE", 0,
     "Convert FILE: to its own format, or from ESI to SII and back. Elements of an XML file that the new one does not have, "
     "such as pictures, are named", 1},
    {"number", KEY_NUMBER, "N", 0, "With --from: the device of the ESI for which the SII is written; 1 = first", 1},
    {"layout", KEY_LAYOUT, "flat|mdp", 0, "ESI: how it is laid out; default flat", 2},
    {"program", KEY_PROGRAM, "FILE", 0, "ec-extend: also write a TrioBASIC start program", 2},
    {"dc-mode", KEY_DC_MODE, "NUMBER", 0, "ec-extend: Dc/Mode; default 0x0300", 2},
    {"mailbox-rate", KEY_MAILBOX_RATE, "NUMBER", 0, "ec-extend: MbxRate; default 100", 2},
    {"device", KEY_DEVICE, "cm1-e|eb01|eb02|eb12", 0,
     "The device; default cm1-e; repeat it for a further device in one file. The options below belong to the "
     "device before them", 3},
    {"firmware", KEY_FIRMWARE, "VERSION", 0, "1.2.0 ... 1.3.5 (default)", 3},
    {"mapping", KEY_MAPPING, "dynamic|csp|csv|profile", 0, "The PDOs that the file chooses; default dynamic", 3},
    {"pdo-order", KEY_ORDER, "ug-4.4|ug-7.2", 0, "The order of objects in the PDO mappings; default ug-4.4", 3},
    {"vendor", KEY_VENDOR, "NUMBER", 0,
     "Bridge: vendor ID, mandatory, for an ENI of a bus file too; the guide does not state it", 3},
    {"product", KEY_PRODUCT, "NUMBER", 0, "Bridge: product code, mandatory", 3},
    {"revision", KEY_REVISION, "NUMBER", 0, "Bridge: revision, mandatory", 3},
    {"axes", KEY_AXES, "N", 0, "Bridge: 1 ... 4 (default)", 3},
    {"serial", KEY_SERIAL, "NUMBER", 0, "SII: serial number", 3},
    {"alias", KEY_ALIAS, "NUMBER", 0, "SII: configured station alias", 3},
    {"config-data", KEY_CONFIG, "FILE", 0, "Take the configuration words from this image of a real device's SII", 3},
    {"dc", KEY_DC, NULL, 0, "Also offer DC Synchronous, which the guide does not mention", 3},
    {"complete-access", KEY_COMPLETE, NULL, 0, "Announce SDO complete access, which the guide does not mention", 3},
    {0}};

/** The last one of two would count, which nobody sees. --device begins another device. */
static void check_once(int key, generate_options_t *options, struct argp_state *state)
{
    static const int of_file[] = {KEY_LAYOUT, KEY_FROM, KEY_NUMBER, KEY_PROGRAM, KEY_DC_MODE, KEY_MAILBOX_RATE};
    uint32_t kept = 0;
    for (size_t i = 0; i < sizeof of_file / sizeof *of_file; i++)
        kept |= options->once & 1u << (of_file[i] - KEY_FIRMWARE);
    if (key == KEY_DEVICE)
        options->once = kept;
    if (key < KEY_FIRMWARE || key > KEY_MAILBOX_RATE || key == KEY_DEVICE)
        return;
    const uint32_t bit = 1u << (key - KEY_FIRMWARE);
    for (const struct argp_option *option = table; options->once & bit; option++)
        if (option->key == key)
            argp_error(state, "--%s is there twice", option->name);
    options->once |= bit;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    generate_options_t *options = state->input;
    int format;
    check_once(key, options, state);
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case ARGP_KEY_ARG:
        if (options->what.format != CM1E_FILE_UNKNOWN)
            argp_error(state, "one format at a time; \"%s\" is too many", arg);
        if (!choose("format", arg, formats, &format))
            return EINVAL;
        options->what.format = (cm1e_file_format_t)format;
        return 0;
    case ARGP_KEY_END: check_words(options, state); return 0;
    default: break;
    }
    for (int i = 0; i < RESTRICTED; i++)
        if (restricted[i].key == key)
            options->given |= 1u << i;
    if (key == KEY_FROM || key == KEY_PROGRAM)
        need_name(state, key == KEY_FROM ? "--from" : "--program", arg);
    const error_t result = parse_file(key, arg, options);
    if (result != ARGP_ERR_UNKNOWN)
        return result;
    const error_t device = parse_device(key, arg, options);
    if (device == 0 && !options->what.devices && key != KEY_MAPPING)
        options->what.devices = options->devices;
    if (key == KEY_MAPPING)
        options->mapping_given = true;
    return device;
}

/* ---- what to do ------------------------------------------------------------------------------------------------- */

static cm1e_error_t generate_from_file(cm1e_file_t *file, const generate_options_t *options, cm1e_diag_t *diag)
{
    input_t input;
    if (!read_input(options->from, &input))
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "%s", "");
    const cm1e_error_t error =
        cm1e_generate_from(file, input.bytes, input.size, options->what.format, options->number, diag);
    free(input.bytes);
    return error;
}

/* With an interface the network is scanned; otherwise it is taken from the bus file. */
static cm1e_error_t generate_network(cm1e_file_t *file, generate_options_t *options, cm1e_diag_t *diag)
{
    static cm1e_bus_config_t config;
    if (!load_configuration(&options->common, &config))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s", "");
    if (!options->common.interface_name) {
        options->what.network = &config;
        return cm1e_generate(file, &options->what, diag);
    }
    cm1e_bus_t *bus = NULL;
    cm1e_error_t error = cm1e_bus_open(&bus, &config, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_scan(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_generate_eni_of_bus(file, bus, options->devices[0].mapping, diag);
    const cm1e_error_t closed = cm1e_bus_close(bus);
    if (error == CM1E_OK && closed != CM1E_OK)
        return cm1e_diag_set(diag, closed, 0, "not every frame could be written to the pcap file %s",
                             options->common.pcap_file);
    return error;
}

/* EXIT_WRONG_USE if the options contradict each other or a file cannot be read, but not for the contents of a file. */
static int refuse(const generate_options_t *options, cm1e_error_t error, const cm1e_diag_t *diag)
{
    if (diag->text[0])
        fail(diag);
    return (error == CM1E_ERROR_CONFIG && !options->from) || (error == CM1E_ERROR_NOT_FOUND && options->from)
        ? EXIT_WRONG_USE : EXIT_FAILED;
}

/* Writes both files, or none if one of them is refused. */
static int write_files(const generate_options_t *options, const cm1e_file_t *file)
{
    cm1e_file_t program = {0};
    cm1e_diag_t diag = {0};
    if (options->program) {
        const cm1e_error_t error = cm1e_generate_trio_program(&program, &options->what, &diag);
        if (error != CM1E_OK)
            return refuse(options, error, &diag);
    }
    const bool written = write_output(options->file, file->bytes, file->size) &&
                         (!options->program || write_output(options->program, program.bytes, program.size));
    cm1e_file_free(&program);
    return written ? EXIT_OK : EXIT_FAILED;
}

static const struct argp_child children[] = {{&common_argp, 0, NULL, 4}, {0}};
const struct argp argp_generate = {
    table, parse, "esi|ec-extend|sii|eni",
    "Writes a file for other masters: ESI for TwinCAT and others, EC_EXTEND.txt for Trio controllers, an SII "
    "image, or an ENI of a network (-b BUS-FILE for a configured one, -i INTERFACE to scan one).", children, NULL,
    NULL};

int command_generate(int argc, char **argv)
{
    static generate_options_t options;
    options.what.device_count = 1;
    if (parse_options(&argp_generate, argc, argv, &options))
        return EXIT_WRONG_USE;
    cm1e_file_t file = {0};
    cm1e_diag_t diag = {0};
    if (options.mapping_given && !options.what.devices && options.what.format != CM1E_FILE_ENI)
        options.what.devices = options.devices;
    const cm1e_error_t error = options.from                              ? generate_from_file(&file, &options, &diag)
                               : options.what.format == CM1E_FILE_ENI ? generate_network(&file, &options, &diag)
                                                                      : cm1e_generate(&file, &options.what, &diag);
    if (error != CM1E_OK)
        return refuse(&options, error, &diag);
    if (file.warning[0])
        complain("%s", file.warning);
    const int status = write_files(&options, &file);
    cm1e_file_free(&file);
    return status;
}
