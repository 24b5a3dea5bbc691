#include "command.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "choose_bus.h"
#include "cm1e/bridge.h"
#include "config/interface.h"
#include "core/json_text.h"
#include "core/near.h"
#include "core/text.h"
#include "device/devices.h"
#include "device/place.h"

enum { KEY_PCAP = 0x100, KEY_JSON, KEY_NETWORK, COMPLAINTS_BYTES = 4096 };

static bool json_wanted, json_printed;
static char complaints[COMPLAINTS_BYTES]; /* all, in lines */

static const struct argp_option common_option_table[] = {
    {"interface", 'i', "INTERFACE", 0, "Network interface (eth1; eth1,xdp goes by AF_XDP), or sim, or sim:BUS-FILE", 1},
    {"bus", 'b', "BUS-FILE", 0, "Description of the network (YAML, see docs/BUS-FILE.md)", 1},
    {"network", KEY_NETWORK, "NAME", 0, "Of a bus file with several buses: this one, by its name or interface", 1},
    {"json", KEY_JSON, NULL, 0, "Write JSON", 1},
    {"pcap", KEY_PCAP, "FILE", 0, "Record every frame for Wireshark", 1},
    {0},
};

bool want_json(void) { return json_wanted = true; }

static error_t parse_common(int key, char *arg, struct argp_state *state)
{
    common_options_t *options = state->input;
    if ((key == 'i' || key == 'b' || key == KEY_PCAP || key == KEY_NETWORK) && !arg[0])
        argp_error(state, "%s needs a name; it is empty", key == 'i' ? "-i" : key == 'b' ? "-b"
                   : key == KEY_PCAP ? "--pcap" : "--network");
    if (key == 'i' && strcmp(arg, "sim:") == 0)
        argp_error(state, "-i sim: needs the name of a bus file behind the colon, as in sim:examples/three_axes.yaml");
    switch (key) {
    case 'i': options->interface_name = arg; return 0;
    case 'b': options->bus_file = arg; return 0;
    case KEY_NETWORK: options->network = arg; return 0;
    case KEY_JSON: options->json = want_json(); return 0;
    case KEY_PCAP: options->pcap_file = arg; return 0;
    case ARGP_KEY_ARG: /* that the command itself has no use for */
        argp_error(state, "\"%s\" is too many: a network is named as in -i eth1, a bus file as in -b machine.yaml", arg);
        return EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

const struct argp common_argp = {common_option_table, parse_common, NULL, NULL, NULL, NULL, NULL};
const struct argp_child common_children[] = {{&common_argp, 0, NULL, 0}, {0}};

error_t give_options(struct argp_state *state, common_options_t *options)
{
    state->child_inputs[0] = options;
    return 0;
}

void complain(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fprintf(stderr, "%s: ", program_invocation_name);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
    size_t used = strlen(complaints);
    if (used > 0)
        used += (size_t)snprintf(complaints + used, sizeof complaints - used, "; ");
    if (used >= sizeof complaints)
        return;
    va_start(args, format);
    vsnprintf(complaints + used, sizeof complaints - used, format, args);
    va_end(args);
}

void describe_error(char *line, size_t size, const char *name, const char *what, const char *details)
{
    char prefix[CM1E_NAME_LENGTH + 16];
    snprintf(prefix, sizeof prefix, "Axis \"%s\": ", name);
    const bool has_prefix = strncmp(details, prefix, strlen(prefix)) == 0;
    if (strstr(details, what))
        snprintf(line, size, "%s", details);
    else if (has_prefix)
        snprintf(line, size, "%s: %s: %s", name, what, details + strlen(prefix));
    else
        snprintf(line, size, "%s: %s%s%s", name, what, details[0] ? ". " : "", details);
}

void complain_of_axis(const char *name, const char *what, const char *details)
{
    char line[AXIS_LINE_BYTES];
    describe_error(line, sizeof line, name, what, details);
    complain("%s", line);
}

int fail(const cm1e_diag_t *diag)
{
    complain("%s", diag->text[0] ? diag->text : cm1e_strerror(diag->error));
    return EXIT_FAILED;
}

int fail_at_once(const cm1e_diag_t *diag)
{
    (void)fail(diag);
    switch (diag->error) {
    case CM1E_ERROR_INVALID_ARGUMENT:
    case CM1E_ERROR_NOT_FOUND:
    case CM1E_ERROR_PDO_MAPPING: return EXIT_WRONG_USE; /* PDO_MAPPING: an object that no cycle has */
    default: return EXIT_FAILED;
    }
}

/** Copies a word into a configuration field; false where it does not fit. */
static bool copy_word(char *field, size_t size, const char *word, const char *what)
{
    if (strlen(word) >= size) {
        complain("%s is too long: at most %zu characters", what, size - 1);
        return false;
    }
    strcpy(field, word);
    return true;
}

cm1e_error_t check_segment(const char *interface_name, cm1e_diag_t *diag)
{
    static const char prefix[] = CM1E_SIM_FILE_PREFIX;
    cm1e_bus_config_t segment = {0};
    if (strncmp(interface_name, prefix, sizeof prefix - 1) != 0)
        return CM1E_OK;
    const cm1e_error_t error = cm1e_bus_config_load(&segment, interface_name + sizeof prefix - 1, diag);
    cm1e_bus_config_free(&segment);
    return error;
}

bool load_configuration(const common_options_t *options, cm1e_bus_config_t *config)
{
    cm1e_diag_t diag = {0};
    if (!options->interface_name && !options->bus_file) {
        complain("the network is missing: -i INTERFACE (\"-i sim\" for a simulated one) or -b BUS-FILE");
        return false;
    }
    if (!options->bus_file)
        cm1e_bus_config_init(config, options->interface_name, 0);
    else if (!load_chosen_bus(options, config))
        return false;
    if (options->interface_name && !copy_word(config->interface_name, sizeof config->interface_name,
                                              options->interface_name, "the interface name"))
        return false;
    if (!options->attach && check_segment(config->interface_name, &diag) != CM1E_OK) {
        (void)fail(&diag); /* with --attach the program has its own, from its folder */
        return false;
    }
    return !options->pcap_file
           || copy_word(config->pcap_file, sizeof config->pcap_file, options->pcap_file, "the name of the pcap file");
}

/** Axes behind a slave that have a channel; 0: there are none, or it is one axis. */
static int channels_of(const cm1e_slave_info_t *slave) { return slave->device ? slave->device->channels : 0; }

static bool is_one_axis(const cm1e_slave_info_t *slave)
{
    return slave->device && slave->device->channels == 0 && slave->device->extra_is_error;
}

/** A drive whose motor only the configuration can state. */
static bool motor_is_unknown(const cm1e_slave_info_t *slave) { return slave->device && slave->device->motor_stated; }

static const cm1e_slave_info_t *first_bridge(const cm1e_bus_t *bus)
{
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        if (channels_of(cm1e_bus_slave(bus, position)) > 0)
            return cm1e_bus_slave(bus, position);
    return NULL;
}

/** The command that asks the motors of a bridge for K37. */
static void print_questions(const cm1e_bus_t *bus, const char *interface_name)
{
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        for (int id = 1; id <= channels_of(cm1e_bus_slave(bus, position)); id++)
            fprintf(stderr, "  cm1e cml -i %s --slave %u \"K37.%d\"\n", interface_name, (unsigned)position, id);
}

/** A bus file that can be loaded when the values in capitals are filled in. */
static void print_bus_file(const cm1e_bus_t *bus, const char *interface_name)
{
    unsigned axis = 0;
    fprintf(stderr, "bus:\n  interface: %s\naxes:\n", interface_name);
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, position);
        if (is_one_axis(slave))
            fprintf(stderr, "  - {name: axis%u, position: %u}\n", ++axis, (unsigned)position);
        else if (motor_is_unknown(slave))
            fprintf(stderr, "  - {name: axis%u, position: %u, device: %s, drive: {counts_per_revolution: COUNTS, "
                    "max_speed_rpm: SPEED}}\n", ++axis, (unsigned)position, slave->device->kind);
        for (int id = 1; id <= channels_of(slave); id++)
            fprintf(stderr, "  - {name: axis%u, position: %u, channel: %d, k37: ANSWER-TO-K37.%d}\n", ++axis,
                    (unsigned)position, id, id);
    }
}

static bool refuse_bridge(const cm1e_bus_t *bus, const char *interface_name)
{
    const cm1e_slave_info_t *bridge = first_bridge(bus);
    if (!bridge)
        return true;
    complain("slave %u is a bridge: K37 of each motor behind it says how far the motor turns per count, and no scan "
             "shows it. Ask each motor", bridge->position);
    print_questions(bus, interface_name);
    fprintf(stderr, "and put the answers into a bus file for the option -b:\n");
    print_bus_file(bus, interface_name);
    return false;
}

/** Says why a servo drive of another maker is none of the axes. Whether there is one. */
static bool tell_servo_drives(const cm1e_bus_t *bus, const char *interface_name)
{
    uint32_t found = 0;
    for (uint32_t position = cm1e_bus_slave_count(bus); position >= 1; position--)
        if (motor_is_unknown(cm1e_bus_slave(bus, position)))
            found = position;
    if (found == 0)
        return false;
    complain("slave %u is a %s: no scan shows the counts of a revolution and the maximum speed of "
             "its motor, so it is not moved without them. Put them into a bus file for the option -b:", found,
             cm1e_bus_slave(bus, (uint16_t)found)->device->label);
    print_bus_file(bus, interface_name);
    return true;
}

int open_scanned(const cm1e_bus_config_t *config, cm1e_bus_t **bus)
{
    cm1e_diag_t diag = {0};
    *bus = NULL;
    if (cm1e_bus_open(bus, config, &diag) == CM1E_OK && cm1e_bus_scan(*bus, &diag) == CM1E_OK)
        return EXIT_OK;
    cm1e_bus_close(*bus);
    *bus = NULL;
    return fail(&diag);
}

int load_axes(const common_options_t *options, cm1e_bus_config_t *config)
{
    if (!load_configuration(options, config))
        return EXIT_WRONG_USE;
    if (config->axis_count + config->slave_count > 0)
        return EXIT_OK;
    cm1e_bus_t *bus;
    cm1e_bus_config_t scanned = *config;
    scanned.pcap_file[0] = '\0';
    if (open_scanned(&scanned, &bus) != EXIT_OK)
        return EXIT_FAILED;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        if (is_one_axis(cm1e_bus_slave(bus, position))) {
            cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(config, NULL);
            if (axis)
                *axis = (cm1e_axis_config_t){.address = (uint16_t)position};
        }
    const bool known = refuse_bridge(bus, config->interface_name);
    const bool told = known && tell_servo_drives(bus, config->interface_name);
    cm1e_bus_close(bus);
    if (!known)
        return EXIT_FAILED;
    if (config->axis_count == 0 && !told)
        complain("there is no CM1-E on %s", config->interface_name);
    return config->axis_count > 0 ? EXIT_OK : EXIT_FAILED;
}

bool is_simulated(const cm1e_bus_config_t *config)
{
    return strcmp(config->interface_name, "sim") == 0 || strncmp(config->interface_name, "sim:", 4) == 0
           || config->interface_name[0] == '\0';
}

const char *simulated_mark(const cm1e_bus_config_t *config) { return is_simulated(config) ? " (simulated)" : ""; }

void tell_simulated(const cm1e_bus_config_t *config)
{
    if (is_simulated(config))
        puts("simulated network: no real device");
}

int close_bus(cm1e_bus_t *bus, const common_options_t *options, int status)
{
    if (cm1e_bus_close(bus) == CM1E_OK)
        return status;
    complain("not every frame could be written to the pcap file %s", options->pcap_file);
    return status == EXIT_OK ? EXIT_FAILED : status;
}

/** "X, Y": their names, or "1 ... 3" where they have none. */
static const char *axes_text(const cm1e_bus_config_t *config, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (uint32_t i = 0; i < config->axis_count && used < size; i++) {
        const int n = config->axes[i].name[0] ? snprintf(text + used, size - used, "%s%s", used ? ", " : "",
                                                         config->axes[i].name) : 0;
        used += n > 0 ? (size_t)n : 0;
    }
    if (!text[0] && config->axis_count > 1)
        snprintf(text, size, "1 ... %u", config->axis_count);
    return text[0] ? text : config->axis_count == 1 ? "1" : "none";
}

int find_axis(const cm1e_bus_config_t *config, const char *word)
{
    int axis = -1;
    for (uint32_t i = 0; i < config->axis_count && axis < 0; i++)
        if (config->axes[i].name[0] && strcmp(config->axes[i].name, word) == 0)
            axis = (int)i;
    char *end;
    const long number = strtol(word, &end, 10);
    if (axis < 0 && *word && *end == '\0' && number >= 1 && number <= (long)config->axis_count)
        axis = (int)number - 1;
    if (axis >= 0 && cm1e_axis_has_motor(&config->axes[axis]))
        return axis;
    if (axis >= 0) {
        complain("axis \"%s\" is %s in the bus file: there is no motor behind it", word,
                 config->axes[axis].type == CM1E_AXIS_ENCODER ? "an encoder" : "virtual");
        return -1;
    }
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = word};
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (config->axes[i].name[0])
            cm1e_near_look(&near, config->axes[i].name);
    char axes[256];
    complain("there is no axis \"%s\" among the axes of this network: %s%s", word,
             axes_text(config, axes, sizeof axes), cm1e_near_text(&near, text, sizeof text));
    return -1;
}

int shelter_negative_value(int argc, char **argv, char **sheltered)
{
    static char end_of_options[] = "--";
    if (argc >= MAX_WORDS) {
        complain("too many arguments");
        return -1;
    }
    int count = 0;
    char *value = NULL;
    bool options_end = false;
    for (int i = 0; i < argc; i++) {
        options_end = options_end || (i > 0 && strcmp(argv[i], "--") == 0);
        if (!value && !options_end && i > 0 && argv[i][0] == '-' && argv[i][1] >= '0' && argv[i][1] <= '9')
            value = argv[i];
        else
            sheltered[count++] = argv[i];
    }
    if (value && !options_end)
        sheltered[count++] = end_of_options;
    if (value)
        sheltered[count++] = value;
    sheltered[count] = NULL;
    return count;
}

int in_bytes(int width, const char *text) { return width + (int)(strlen(text) - cm1e_text_width(text)); }

void print_json(json_t *value)
{
    json_printed = true;
    json_dumpf(value, stdout, JSON_INDENT(2));
    putchar('\n');
    json_decref(value);
}

void print_json_of_failure(void)
{
    if (json_wanted && !json_printed)
        print_json(json_pack("{s:o}", "error", cm1e_json_text(complaints)));
}

const char *al_state_name(uint16_t al_state, char *buffer, size_t size)
{
    static const char *const names[] = {
        [CM1E_AL_INIT] = "Init", [CM1E_AL_PRE_OP] = "Pre-Operational", [CM1E_AL_BOOT] = "Bootstrap",
        [CM1E_AL_SAFE_OP] = "Safe-Operational", [CM1E_AL_OP] = "Operational",
    };
    const uint16_t state = al_state & 0x0F;
    const char *name = state < sizeof names / sizeof names[0] && names[state] ? names[state] : "unknown state";
    snprintf(buffer, size, "%s%s", name, al_state & CM1E_AL_ERROR ? " + error" : "");
    return buffer;
}
