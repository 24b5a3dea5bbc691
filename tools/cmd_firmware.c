/** cm1e firmware update: writes a new firmware into a slave, by FoE in Bootstrap (UG 4.3, 10). */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "bus/firmware_update.h"
#include "cia402/cia402.h"
#include "cm1e/sii.h"
#include "core/bytes.h"
#include "core/clock.h"
#include "core/json_text.h"
#include "description/sii_image.h"
#include "device/devices.h"
#include "end_signals.h"
#include "files.h"
#include "sii_device.h"
#include "terminal.h"
#include "which_slave.h"

enum { KEY_NAME = 0x900, KEY_PASSWORD, KEY_OTHER_DEVICE, KEY_TIMEOUT, KEY_YES };
enum { FIRMWARE_MIN_BYTES = 1024, BACK_TRIES = 60 };
#define BACK_PAUSE_NS INT64_C(500000000)

typedef struct firmware_options {
    common_options_t common;
    const char *action, *file, *axis, *name;
    long long position, password;
    double timeout_s;
    bool other_device, yes;
} firmware_options_t;

static void check_words(const firmware_options_t *options, struct argp_state *state)
{
    if (!options->action || !options->file)
        argp_error(state, "expected: update FILE");
    if (!options->axis == !options->position)
        argp_error(state, "expected one motor: -a AXIS or -p POSITION");
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    firmware_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case 'a': options->axis = arg; return 0;
    case 'p': return parse_number(arg, "the position", 1, CM1E_MAX_SLAVES, &options->position) ? 0 : EINVAL;
    case KEY_NAME: options->name = arg; return 0;
    case KEY_PASSWORD: return parse_number(arg, "the password", 0, 0xFFFFFFFF, &options->password) ? 0 : EINVAL;
    case KEY_TIMEOUT: return parse_seconds(arg, 600, &options->timeout_s) ? 0 : EINVAL;
    case KEY_OTHER_DEVICE: options->other_device = true; return 0;
    case KEY_YES: options->yes = true; return 0;
    case ARGP_KEY_ARG:
        if (!options->action)
            return choose_word("action", options->action = arg, "update") < 0 ? EINVAL : 0;
        return parse_file_word(key, arg, state, &options->file);
    case ARGP_KEY_END: check_words(options, state); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- before ----------------------------------------------------------------------------------------------------- */

/** A motor is enabled in Operational only; a scan would throw it out of that state, so this is seen before. */
static bool is_at_rest(cm1e_bus_t *bus, const cm1e_bus_config_t *config)
{
    const uint8_t states = cm1e_firmware_all_states(bus);
    if (!(states & (CM1E_AL_OP | CM1E_AL_SAFE_OP)))
        return true;
    complain("a slave on %s is in Operational or Safe-Operational, so its motor may be enabled. Nothing was done. End "
             "the master that runs it; if there is none any more, switch the motor power off, then `cm1e scan`",
             config->interface_name);
    return false;
}

/** No drive says that it has torque. Those that do not answer have none: a drive needs a master for it. */
static bool is_without_torque(cm1e_bus_t *bus)
{
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, position);
        uint8_t data[2] = {0};
        size_t size = sizeof data;
        if (!slave->device || slave->device->channels > 0 ||
            cm1e_sdo_read(bus, (uint16_t)position, 0x6041, 0, data, &size, NULL) != CM1E_OK)
            continue;
        if (cm1e_fsa_decode(cm1e_get_u16(data)) == OPERATION_ENABLED) {
            complain("the motor of slave %u is enabled; nothing was done. Disable it first", (unsigned)position);
            return false;
        }
    }
    return true;
}

/** The slave by a scan; one whose firmware is broken cannot be scanned, and then only its position is known. */
static int find(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const firmware_options_t *options,
                uint16_t *position, char *version, size_t size)
{
    char word[16];
    cm1e_diag_t diag = {0};
    snprintf(word, sizeof word, "%lld", options->position);
    snprintf(version, size, "unknown");
    if (cm1e_bus_scan(bus, &diag) != CM1E_OK) {
        complain("%s", diag.text);
        *position = (uint16_t)options->position;
        if (options->axis)
            complain("a scan is needed to find the axis \"%s\"; name the motor by its position, -p", options->axis);
        return options->axis ? EXIT_FAILED : EXIT_OK;
    }
    const int status = find_slave(bus, config, options->axis ? options->axis : word, position);
    const cm1e_slave_info_t *slave = status == EXIT_OK ? cm1e_bus_slave(bus, *position) : NULL;
    if (slave && slave->software_version[0])
        snprintf(version, size, "%s", slave->software_version);
    return status != EXIT_OK ? status : is_without_torque(bus) ? EXIT_OK : EXIT_FAILED;
}

/** A firmware of one device in another one may make both useless. */
static bool is_the_device(cm1e_bus_t *bus, uint16_t position, bool any)
{
    input_t sii;
    cm1e_diag_t diag = {0};
    if (!read_device(bus, position, &sii, &diag)) {
        fail(&diag);
        return false;
    }
    const uint32_t vendor = cm1e_get_u32(sii.bytes + CM1E_SII_VENDOR);
    const uint32_t product = cm1e_get_u32(sii.bytes + CM1E_SII_PRODUCT);
    free(sii.bytes);
    if (any || cm1e_device_of_identity(vendor, product) == &cm1e_device_cm1e)
        return true;
    complain("slave %u is no CM1-E (vendor 0x%08X, product 0x%08X); nothing was done. --other-device allows it",
             position, (unsigned)vendor, (unsigned)product);
    return false;
}

static bool confirmed(const firmware_options_t *options, uint16_t position, const char *version, size_t size)
{
    if (options->yes)
        return true;
    if (!at_a_terminal()) {
        complain("nothing was written: this needs --yes where there is no terminal to ask");
        return false;
    }
    fprintf(stderr, "Slave %u has firmware %s. Write %s (%zu bytes) into it? Keep its power on until the end. [y/N] ",
            position, version, options->file, size);
    const int answer = getchar();
    if (answer != 'y' && answer != 'Y')
        complain("nothing was written");
    return answer == 'y' || answer == 'Y';
}

/* ---- during ----------------------------------------------------------------------------------------------------- */

typedef struct update_progress {
    int shown;    /* percent */
    size_t taken; /* bytes that the slave has acknowledged */
} update_progress_t;

static bool show_progress(void *context, size_t taken, size_t size)
{
    update_progress_t *progress = context;
    const int percent = (int)(100 * taken / size);
    if (percent != progress->shown && at_a_terminal())
        fprintf(stderr, "\r\033[K%zu of %zu bytes, %d %%%s", taken, size, percent, taken == size ? "\n" : "");
    *progress = (update_progress_t){percent, taken};
    return !told_to_end();
}

static void explain_recovery(cm1e_firmware_state_t state, size_t taken, uint16_t position)
{
    if (state == CM1E_FIRMWARE_PARTLY && taken == 0)
        complain("slave %u was about to take the file, and has acknowledged no part of it: it does not say whether it has "
                 "erased its firmware before", position);
    if (state == CM1E_FIRMWARE_UNTOUCHED)
        complain("nothing was written: slave %u keeps the firmware that it had", position);
    else if (state == CM1E_FIRMWARE_PARTLY)
        complain("the firmware of slave %u may be incomplete now. Leave its power on and run the same command again. "
                 "If it does not answer, switch its control power off and on, then run the command again: without a "
                 "firmware it still does Init and Bootstrap, so name it by its position (-p). If it does not even do "
                 "that, its maker can restore it by USB (UG 10)", position);
    else
        complain("slave %u has taken the whole file, but did not leave Bootstrap as expected: switch its control power "
                 "off and on, then look with `cm1e scan`", position);
}

/* ---- after ------------------------------------------------------------------------------------------------------ */

/** A slave that starts with its new firmware is away for a while. */
static bool read_back(cm1e_bus_t *bus, uint16_t position, char *version, size_t size, cm1e_diag_t *diag)
{
    for (int i = 0; i < BACK_TRIES && !told_to_end(); i++) {
        const cm1e_error_t error = cm1e_bus_scan(bus, diag);
        const cm1e_slave_info_t *slave = error == CM1E_OK ? cm1e_bus_slave(bus, position) : NULL;
        if (slave && slave->software_version[0]) {
            snprintf(version, size, "%s", slave->software_version);
            return true;
        }
        cm1e_clock_sleep_until(cm1e_clock_current(), cm1e_clock_now(cm1e_clock_current()) + BACK_PAUSE_NS);
    }
    return false;
}

static int tell(const firmware_options_t *options, uint16_t position, const char *before, const char *after)
{
    if (options->common.json)
        print_json(json_pack("{s:i, s:o, s:o, s:o}", "position", position, "file", cm1e_json_text(options->file),
                             "before", cm1e_json_text(before), "after", cm1e_json_text(after)));
    else
        printf("slave %u: firmware %s was %s and is %s\n", position, options->file, before, after);
    return EXIT_OK;
}

static int update(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const firmware_options_t *options,
                  const input_t *image)
{
    char before[sizeof ((cm1e_slave_info_t *)0)->software_version], after[sizeof before] = "";
    const char *slash = strrchr(options->file, '/');
    uint16_t position;
    update_progress_t progress = {.shown = -1};
    cm1e_diag_t diag = {0};
    cm1e_firmware_state_t state;
    const cm1e_firmware_file_t file = {
        .name = options->name ? options->name : slash ? slash + 1 : options->file, .bytes = image->bytes,
        .size = image->size,
        .options = {.password = (uint32_t)options->password, .answer_ns = (int64_t)(options->timeout_s * 1e9),
                    .progress = show_progress, .context = &progress}};
    if (!is_at_rest(bus, config))
        return EXIT_FAILED;
    int status = find(bus, config, options, &position, before, sizeof before);
    if (status != EXIT_OK)
        return status;
    if (!is_the_device(bus, position, options->other_device) ||
        !confirmed(options, position, before, image->size))
        return EXIT_FAILED;
    signal(SIGHUP, SIG_IGN); /* a terminal that is closed leaves no motor with half of a firmware */
    catch_signals();
    if (cm1e_firmware_update(bus, position, &file, &state, &diag) != CM1E_OK) {
        status = fail(&diag);
        explain_recovery(state, progress.taken, position);
        return status;
    }
    if (read_back(bus, position, after, sizeof after, &diag))
        return tell(options, position, before, after);
    status = fail(&diag);
    explain_recovery(state, progress.taken, position);
    return status;
}

static const struct argp_option table[] = {
    {"axis", 'a', "AXIS", 0, "The motor by its name in the bus file", 0},
    {"position", 'p', "POSITION", 0, "The motor by its position, 1 = first", 0},
    {"name", KEY_NAME, "NAME", 0, "Name by which the motor knows the file; default: that of FILE", 0},
    {"password", KEY_PASSWORD, "NUMBER", 0, "Password that the motor wants; default: 0", 0},
    {"timeout", KEY_TIMEOUT, "S", 0, "Longest time for one answer; default: 20", 0},
    {"other-device", KEY_OTHER_DEVICE, NULL, 0, "Allow a slave that is no CM1-E", 0},
    {"yes", KEY_YES, NULL, 0, "Do not ask", 0},
    {0}};
const struct argp argp_firmware = {
    table, parse, "update FILE",
    "Writes a new firmware into a motor (UG 4.3, 10): FoE in the state Bootstrap, then Init and Pre-Operational, and "
    "the version is read back. The file comes from the maker. Refused while a motor is enabled or a program has the "
    "network. If it breaks off, the command says what the motor has, and what to do.", attach_children, NULL, NULL};

static int open_and_update(const firmware_options_t *options, const input_t *image)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    if (image->size < FIRMWARE_MIN_BYTES) {
        complain("%s has %zu bytes: no firmware is that short. Nothing was done", options->file, image->size);
        return EXIT_FAILED;
    }
    if (!load_network(&options->common, &config))
        return EXIT_WRONG_USE;
    if (own_network(&options->common, &config, "An update of the firmware",
                    "the motor leaves the cycle for Init and Bootstrap, and the program would lose it", &bus, &diag) != CM1E_OK)
        return fail(&diag);
    return close_bus(bus, &options->common, update(bus, &config, options, image));
}

int command_firmware(int argc, char **argv)
{
    firmware_options_t options = {.timeout_s = 20};
    input_t image;
    if (parse_options(&argp_firmware, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (!read_input(options.file, &image))
        return EXIT_WRONG_USE;
    const int status = open_and_update(&options, &image);
    free(image.bytes);
    return status;
}
