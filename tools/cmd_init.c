/** cm1e init: writes a bus file from the network as it is, or from several. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/bridge.h"
#include "cm1e/cml.h"
#include "command.h"
#include "core/bytes.h"
#include "core/text.h"
#include "device/devices.h"
#include "files.h"
#include "init_slaves.h"

enum { KEY_FORCE = 0x700 };

typedef struct init_options {
    const char *interfaces[CM1E_MAX_BUSES];
    unsigned networks;  /**< number of interfaces */
    const char *output; /**< "-": standard output */
    bool force;
} init_options_t;

typedef struct init {
    cm1e_bus_t *bus;
    FILE *file;
    unsigned axes, slaves; /**< written so far, in all networks */
    unsigned gaps;  /**< axes that could not be completed: they are comments */
    bool motors;    /**< one of the networks has motors */
    bool listed;    /**< the key for slaves without an axis has been written, of this network */
} init_t;

static bool read_number(const init_t *init, uint16_t position, uint16_t index, uint8_t subindex, uint32_t *value)
{
    uint8_t data[4] = {0};
    size_t size = sizeof data;
    const bool read = cm1e_sdo_read(init->bus, position, index, subindex, data, &size, NULL) == CM1E_OK;
    *value = (uint32_t)cm1e_get_uint(data, (unsigned)(read ? size : 0));
    return read;
}

/* ---- what every slave has ---------------------------------------------------------------------------------------- */

static bool is_alone(const init_t *init, const cm1e_slave_info_t *slave, bool by_id)
{
    unsigned same = 0;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(init->bus); position++) {
        const cm1e_slave_info_t *other = cm1e_bus_slave(init->bus, position);
        same += by_id ? other->explicit_id == slave->explicit_id : other->alias == slave->alias;
    }
    return same == 1;
}

/** How the slave is found again: by its switches or its alias, which stay with it, else by its place on the wire. */
static void print_address(const init_t *init, const cm1e_slave_info_t *slave)
{
    FILE *file = init->file;
    if (slave->explicit_id > 0 && slave->device && slave->device->explicit_id && is_alone(init, slave, true))
        fprintf(file, "    explicit_id: %u               # its rotary switches; it was at position %u\n",
                slave->explicit_id, slave->position);
    else if (slave->alias > 0 && is_alone(init, slave, false))
        fprintf(file, "    alias: %u                     # its configured station alias; it was at position %u\n",
                slave->alias, slave->position);
    else
        fprintf(file, "    position: %u                  # on the wire; 1 is the first\n", slave->position);
}

static void print_slave(const init_t *init, const cm1e_slave_info_t *slave)
{
    char name[sizeof slave->name], version[sizeof slave->software_version];
    snprintf(name, sizeof name, "%s", slave->name);
    snprintf(version, sizeof version, "%s", slave->software_version);
    cm1e_text_clean(name);
    cm1e_text_clean(version);
    fprintf(init->file,
            "\n  # Slave %u: %s, vendor 0x%08X, product 0x%08X, revision 0x%08X, serial number 0x%08X%s%s\n",
            slave->position, name, (unsigned)slave->vendor_id, (unsigned)slave->product_code,
            (unsigned)slave->revision, (unsigned)slave->serial_number, version[0] ? ", firmware " : "", version);
}

static void print_name(init_t *init) { fprintf(init->file, "  - name: axis%u\n", ++init->axes); }

/** The keys that a person changes first, as comments. */
static void print_choices(const init_t *init, double revolutions_per_s)
{
    fprintf(init->file,
            "    unit: {units_per_revolution: 1}   # 1: a unit is a revolution; 360: a degree; the lead of a spindle: "
            "mm\n"
            "    # limits: {velocity: %g, acceleration: 100}   # units/s, units/s2; by default the motor's maximum\n"
            "    # software_limits: {negative: -1, positive: 1}   # units\n",
            revolutions_per_s);
}

/* ---- a CM1-E ----------------------------------------------------------------------------------------------------- */

/** All four motors have one product code. They differ in their peak current, which is the product of 0x6073 (0.1 % of
 *  the rated current) and 0x6075 (mA): UG 3.2 table 1, UG 7.3.9, 7.3.10. NULL: it is that of none. */
static const cm1e_motor_t *motor_of(const init_t *init, uint16_t position)
{
    const double nearest = 0.05;
    uint32_t rated_ma, maximum;
    if (!read_number(init, position, 0x6075, 0, &rated_ma) || !read_number(init, position, 0x6073, 0, &maximum))
        return NULL;
    const double peak = (double)rated_ma * maximum * 1e-6;
    for (size_t i = 0; i < sizeof cm1e_device_motors / sizeof cm1e_device_motors[0]; i++)
        if (fabs(peak / cm1e_device_motors[i].peak_current_a - 1) < nearest)
            return &cm1e_device_motors[i];
    return NULL;
}

static void print_firmware(const init_t *init, const char *version)
{
    const cm1e_firmware_info_t *firmware = cm1e_firmware_from_version(version);
    if (firmware && strcmp(firmware->version, version) == 0)
        fprintf(init->file, "    # firmware: %s   # without the leading # another version is an error\n", version);
}

static void print_cm1e(init_t *init, const cm1e_slave_info_t *slave)
{
    const cm1e_motor_t *motor = motor_of(init, slave->position);
    print_name(init);
    print_address(init, slave);
    if (motor)
        fprintf(init->file, "    motor: %s         # by its peak current of %g A\n", motor->name,
                motor->peak_current_a);
    else
        fprintf(init->file, "    # motor: CM1-E-17S30D   # read its label; the network does not tell which one it "
                            "is\n");
    print_firmware(init, slave->software_version);
    print_choices(init, motor ? motor->max_velocity_counts_per_s / (double)CM1E_COUNTS_PER_REVOLUTION : 1);
}

/* ---- motors behind a bridge -------------------------------------------------------------------------------------- */

/** Asks a motor for K37, which no object shows (BR appendix 6: "N/A"). -1: it does not answer. */
static int k37_of(const init_t *init, const cm1e_slave_info_t *slave, uint8_t channel)
{
    static cm1e_cml_exchange_t exchange;
    char question[16];
    cm1e_cml_answer_t answer = {0};
    int k37 = -1;
    snprintf(question, sizeof question, "K37.%u", channel);
    exchange = (cm1e_cml_exchange_t){.position = slave->position, .channel = channel, .text = question};
    if (cm1e_cml_exchange(init->bus, &exchange, NULL) == CM1E_OK && exchange.count == 1) {
        char line[CM1E_CML_BYTES + 2];
        const int size = snprintf(line, sizeof line, "%.*s\n", CM1E_CML_BYTES, exchange.lines[0]);
        if (cm1e_cml_parse(&answer, line, (size_t)size) == CM1E_OK && answer.what == CM1E_CML_K)
            k37 = answer.value;
    }
    cm1e_cml_leave(init->bus, slave->position, channel, false, NULL);
    return k37;
}

static void print_channel(init_t *init, const cm1e_slave_info_t *slave, uint8_t channel)
{
    const char *kind = slave->motors[channel - 1] == CM1E_BRIDGE_CM2 ? "CM2" : "CM1";
    const int k37 = k37_of(init, slave, channel);
    if (k37 < 0 || cm1e_bridge_counts_per_revolution(k37) == 0) {
        fprintf(init->file, "  # No motor answered at connector %u (%s). With one: name, position: %u, channel: %u, "
                "k37: its answer to `cm1e cml K37.%u`\n", channel, kind, slave->position, channel, channel);
        init->gaps++;
        return;
    }
    print_name(init);
    print_address(init, slave);
    fprintf(init->file, "    channel: %u\n    motor: %s\n"
            "    k37: %-2d                      # its own answer: %d counts in a revolution\n", channel, kind, k37,
            (int)cm1e_bridge_counts_per_revolution(k37));
    print_choices(init, 1);
}

/* ---- servo drives of other makers -------------------------------------------------------------------------------- */

/** CiA 402: 0x608F counts of some revolutions, 0x6080 maximum speed in 1/min. */
static void print_servo(init_t *init, const cm1e_slave_info_t *slave)
{
    uint32_t counts = 0, revolutions = 0, speed = 0;
    read_number(init, slave->position, 0x608F, 1, &counts);
    read_number(init, slave->position, 0x608F, 2, &revolutions);
    read_number(init, slave->position, 0x6080, 0, &speed);
    if (counts == 0 || revolutions == 0 || speed == 0) {
        fprintf(init->file, "  # It does not tell the counts of a revolution (0x608F) and its maximum speed (0x6080). "
                "Complete this from its manual:\n"
                "  # - {name: axis, position: %u, device: %s, drive: {counts_per_revolution: COUNTS, max_speed_rpm: "
                "SPEED}}\n", slave->position, slave->device->kind);
        init->gaps++;
        return;
    }
    print_name(init);
    print_address(init, slave);
    fprintf(init->file,
            "    device: %s\n    drive: {counts_per_revolution: %u, max_speed_rpm: %u}   # 0x608F, 0x6080\n",
            slave->device->kind, (unsigned)(counts / revolutions), (unsigned)speed);
    print_choices(init, speed / 60.0);
}

/* ---- the file ---------------------------------------------------------------------------------------------------- */

static void print_axes(init_t *init, const cm1e_slave_info_t *slave)
{
    print_slave(init, slave);
    if (slave->device->channels > 0)
        for (uint8_t channel = 1; channel <= slave->device->channels; channel++)
            print_channel(init, slave, channel);
    else if (slave->device->motor_stated)
        print_servo(init, slave);
    else
        print_cm1e(init, slave);
}

/** It would run without an entry too, but then nobody notices that another device is there. */
static void print_without_axis(init_t *init, const cm1e_slave_info_t *slave)
{
    init->slaves++;
    if (!init->listed)
        fprintf(init->file, "\n# Slaves without an axis. The program finds their signals by name, as in \"io2.in1\".\n"
                "slaves:\n");
    init->listed = true;
    print_slave(init, slave);
    fprintf(init->file, "  - name: io%u\n", slave->position);
    print_address(init, slave);
    init_print_slave(init->file, init->bus, slave);
}

static bool has_motors(const init_t *init)
{
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(init->bus); position++)
        if (cm1e_bus_slave(init->bus, position)->device)
            return true;
    return false;
}

/** A text of YAML, in quotes where it would be read as something else without: the name of a file may be any. */
static void print_scalar(FILE *file, const char *text)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./,:-";
    const size_t length = strlen(text);
    if (strspn(text, plain) == length && strcspn(text, "./,:-") > 0 && text[length - 1] != ':') {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (const char *c = text; *c; c++)
        fprintf(file, *c == '"' || *c == '\\' ? "\\%c" : "%c", *c);
    fputc('"', file);
}

static void print_network(init_t *init, const char *interface_name)
{
    fprintf(init->file, "bus:\n  interface: ");
    print_scalar(init->file, interface_name);
    fprintf(init->file, "\n  # cycle_time_us: 1000   # 200, 250, 500 or 1000; with a bridge 1000\n");
    init->listed = false;
    init->motors |= has_motors(init);
    if (has_motors(init))
        fprintf(init->file, "\naxes:\n");
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(init->bus); position++)
        if (cm1e_bus_slave(init->bus, position)->device)
            print_axes(init, cm1e_bus_slave(init->bus, position));
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(init->bus); position++)
        if (!cm1e_bus_slave(init->bus, position)->device)
            print_without_axis(init, cm1e_bus_slave(init->bus, position));
}

/** What the file has of a network, as text; the caller frees it. NULL after a complaint. */
static char *make_network(init_t *init, const char *interface_name)
{
    char *text = NULL;
    size_t size;
    init->file = open_memstream(&text, &size);
    if (init->file)
        print_network(init, interface_name);
    const bool good = init->file && !ferror(init->file);
    if (init->file && fclose(init->file) == 0 && good)
        return text;
    complain("out of memory");
    free(text);
    return NULL;
}

/** The lines of a network, as an entry of `buses`. */
static void print_entry(FILE *file, unsigned number, const char *text)
{
    fprintf(file, "%s  - name: bus%u\n", number > 1 ? "\n" : "", number);
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): without an error every network has its text */
    for (const char *end; *text; text = end) {
        end = strchr(text, '\n') + 1;
        fprintf(file, "%s%.*s", *text == '\n' ? "" : "    ", (int)(end - text), text);
    }
}

static void print_file(FILE *file, const init_options_t *options, char *const networks[])
{
    fprintf(file, options->networks > 1 ? "# The networks on " : "# The network on ");
    for (unsigned i = 0; i < options->networks; i++) {
        fputs(i ? ", " : "", file);
        print_scalar(file, options->interfaces[i]);
    }
    fprintf(file, ", written by `cm1e init`. docs/BUS-FILE.md explains every key.\n"
            "# A comment has a fact, or a key with an example.\n%s", options->networks > 1 ? "buses:\n" : networks[0]);
    for (unsigned i = 0; i < options->networks && options->networks > 1; i++)
        print_entry(file, i + 1, networks[i]);
}

/** The file as text; the caller frees it. NULL after a complaint. */
static char *make_file(const init_options_t *options, char *const networks[], size_t *size)
{
    char *text = NULL;
    FILE *file = open_memstream(&text, size);
    if (file)
        print_file(file, options, networks);
    const bool good = file && !ferror(file);
    if (file && fclose(file) == 0 && good)
        return text;
    complain("out of memory");
    free(text);
    return NULL;
}

static void print_counts(const init_t *init, const char *path)
{
    printf("%s: %u %s", path, init->axes, init->axes == 1 ? "axis" : "axes");
    if (init->slaves > 0)
        printf(", %u %s without an axis", init->slaves, init->slaves == 1 ? "slave" : "slaves");
    printf(".\nNext: complete units and limits in it; `cm1e check %s` looks at it, `cm1e status -b %s` at the network\n",
           path, path);
}

static int write_file(const init_t *init, const init_options_t *options, char *const networks[])
{
    size_t size;
    char *text = make_file(options, networks, &size);
    if (!text)
        return EXIT_FAILED;
    const bool written = write_output(options->output, text, size);
    free(text);
    if (!written)
        return EXIT_FAILED;
    if (init->axes == 0 && init->motors)
        complain("none of the motors can be an axis before the keys in the comments are filled in");
    else if (strcmp(options->output, "-") != 0)
        print_counts(init, options->output);
    if (init->gaps > 0)
        complain("%u %s not complete, and a comment in the file", init->gaps, init->gaps == 1 ? "axis is" : "axes are");
    return init->axes > 0 || !init->motors ? EXIT_OK : EXIT_FAILED;
}

static void add_interface(init_options_t *options, const char *name, struct argp_state *state)
{
    if (!name[0] || strcmp(name, "sim:") == 0)
        argp_error(state, "-i needs a name; it is empty");
    const bool simulated = strcmp(name, "sim") == 0 || strncmp(name, "sim:", 4) == 0; /* each is a segment of its own */
    for (unsigned i = 0; i < options->networks && !simulated; i++)
        if (strcmp(options->interfaces[i], name) == 0)
            argp_error(state, "-i %s is there twice", name);
    json_t *text = json_string(name); /* NULL: it is not UTF-8 */
    if (!text)
        argp_error(state, "the name of the network is not UTF-8, and a bus file can have no other: give the file of the "
                   "simulated network another name");
    json_decref(text);
    if (options->networks == CM1E_MAX_BUSES)
        argp_error(state, "a program has at most %d networks", CM1E_MAX_BUSES);
    options->interfaces[options->networks++] = name;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    init_options_t *options = state->input;
    switch (key) {
    case 'i':
        add_interface(options, arg, state);
        return 0;
    case 'o':
        if (!arg[0])
            argp_error(state, "-o needs a name; it is empty");
        options->output = arg;
        return 0;
    case KEY_FORCE: options->force = true; return 0;
    case ARGP_KEY_ARG:
        argp_error(state, "\"%s\" is too many: a network is named as in -i eth1, the file as in -o machine.yaml", arg);
        return EINVAL;
    case ARGP_KEY_END:
        if (options->networks == 0)
            argp_error(state, "the network interface is missing: -i INTERFACE");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option table[] = {
    {"interface", 'i', "INTERFACE", 0, "Network interface, or sim, or sim:BUS-FILE; several times for a program with "
     "several networks", 0},
    {"output", 'o', "FILE", 0, "Write to this file; without it to standard output", 0},
    {"force", KEY_FORCE, NULL, 0, "Write over a file that exists", 0},
    {0}};
const struct argp argp_init = {
    table, parse, NULL,
    "Writes a bus file from the network as it is: every motor as an axis, with its address, its kind and its firmware; "
    "every other slave with its identity and names of its signals; and comments that say what else can be chosen. The "
    "file can be used at once. Nothing moves, and no parameter is written. A motor behind a bridge is asked for K37 in "
    "CML mode and then put back to csp.",
    NULL, NULL, NULL};

/** Writes what the file has of a network to `*text`. */
static int look_at(init_t *init, const char *interface_name, char **text)
{
    static cm1e_bus_config_t config;
    const common_options_t common = {.interface_name = interface_name};
    cm1e_diag_t diag = {0};
    int status = EXIT_OK;
    init->bus = NULL;
    if (!load_configuration(&common, &config))
        return EXIT_WRONG_USE;
    if (cm1e_bus_open(&init->bus, &config, &diag) != CM1E_OK || cm1e_bus_scan(init->bus, &diag) != CM1E_OK)
        status = fail(&diag);
    else if (!(*text = make_network(init, interface_name)))
        status = EXIT_FAILED;
    status = close_bus(init->bus, &common, status);
    cm1e_bus_config_free(&config);
    return status;
}

int command_init(int argc, char **argv)
{
    init_options_t options = {.output = "-"};
    if (parse_options(&argp_init, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (!may_overwrite(options.output, options.force))
        return EXIT_WRONG_USE;
    char *networks[CM1E_MAX_BUSES] = {NULL};
    init_t init = {0};
    int status = EXIT_OK;
    for (unsigned i = 0; i < options.networks && status == EXIT_OK; i++)
        status = look_at(&init, options.interfaces[i], &networks[i]);
    if (status == EXIT_OK)
        status = write_file(&init, &options, networks);
    for (unsigned i = 0; i < options.networks; i++)
        free(networks[i]);
    return status;
}
