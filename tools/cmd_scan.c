/** cm1e scan: lists the slaves of the network. */
#include <stdio.h>
#include <string.h>

#include "attach.h"
#include "command.h"
#include "config/places.h"
#include "core/text.h"
#include "device/devices.h"
#include "pdo_list.h"

enum { KEY_PDOS = 0xE00 };

typedef struct scan_options {
    common_options_t common;
    bool pdos;
} scan_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    scan_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_PDOS: options->pdos = true; return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const char *model_name(const cm1e_slave_info_t *slave)
{
    const char *model = cm1e_bridge_name(slave->model);
    return model ? model : "of an unknown model";
}

static const char *motor_name(uint8_t motor)
{
    return motor ? cm1e_bridge_motor_name((cm1e_bridge_motor_t)motor) : "unknown";
}

/* ---- what the bus file has there --------------------------------------------------------------------------------- */

enum { NAMES_BYTES = 256 };

/** Calls `add` for the name of each axis, or of the slave, that `named` has at this slave. */
static void for_each_name(const cm1e_bus_t *bus, const cm1e_bus_config_t *named, const cm1e_slave_info_t *slave,
                          void (*add)(const char *name, void *context), void *context)
{
    const cm1e_places_t places = {named, bus, cm1e_bus_slave};
    const uint16_t place = cm1e_place_of(&places, slave);
    for (uint32_t i = 0; i < named->axis_count; i++)
        if (cm1e_place_is_of_axis(&places, i, slave, place))
            add(named->axes[i].name, context);
    for (uint32_t i = 0; i < named->slave_count; i++)
        if (cm1e_place_is_of_slave(&places, &named->slaves[i], slave, place))
            add(named->slaves[i].name, context);
}

static void add_text(const char *name, void *context)
{
    char *text = context;
    const size_t used = strlen(text);
    snprintf(text + used, NAMES_BYTES - used, "%s%s", used ? ", " : "", name);
}

static void add_json(const char *name, void *context) { json_array_append_new(context, json_string(name)); }

/* ---- as JSON ------------------------------------------------------------------------------------------------------ */

static json_t *bridge_as_json(const cm1e_slave_info_t *slave)
{
    json_t *motors = json_array();
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        json_array_append_new(motors, json_string(motor_name(slave->motors[i])));
    return json_pack("{s:s, s:o}", "model", model_name(slave), "motors", motors);
}

static json_t *slave_as_json(const cm1e_bus_t *bus, const cm1e_bus_config_t *named, const cm1e_slave_info_t *slave)
{
    char state[48];
    json_t *names = json_array();
    for_each_name(bus, named, slave, add_json, names);
    return json_pack("{s:i, s:s, s:I, s:I, s:I, s:I, s:i, s:i, s:s, s:b, s:o, s:s, s:o}", "position", slave->position,
                     "name", slave->name, "vendor_id", (json_int_t)slave->vendor_id, "product_code",
                     (json_int_t)slave->product_code, "revision", (json_int_t)slave->revision, "serial_number",
                     (json_int_t)slave->serial_number, "alias", slave->alias, "explicit_id", slave->explicit_id,
                     "al_state", al_state_name(slave->al_state, state, sizeof state), "is_cm1e",
                     slave->device == &cm1e_device_cm1e, "bridge",
                     slave->device && slave->device->channels ? bridge_as_json(slave) : json_null(), "software_version",
                     slave->software_version, "configured", names);
}

/** Width of a column: its widest text, but not below a minimum. */
static int wider(int width, const char *text)
{
    const int wanted = (int)cm1e_text_width(text);
    return wanted > width ? wanted : width;
}

/* ---- process data ------------------------------------------------------------------------------------------------ */

static void print_pdos(cm1e_bus_t *bus, uint16_t position)
{
    pdo_list_t list;
    if (!pdo_list_read(bus, position, &list)) {
        complain("out of memory");
        return;
    }
    if (list.count == 0)
        printf("     %s\n", list.unknown ? "its process data could not be read" : "no process data");
    unsigned pdo = 0;
    for (size_t i = 0; i < list.count; i++) {
        const listed_entry_t *entry = &list.entries[i];
        if (entry->pdo != pdo)
            printf("     %s 0x%04X %s\n", entry->output ? "outputs" : "inputs ", entry->pdo, entry->pdo_name);
        pdo = entry->pdo;
        if (entry->index)
            printf("       bit %4u  0x%04X:%02X  %3u %-8s %s\n", entry->bit, entry->index, entry->subindex, entry->bits,
                   entry->type, entry->name);
        else
            printf("       bit %4u  gap        %3u\n", entry->bit, entry->bits);
    }
    pdo_list_free(&list);
}

static json_t *pdos_as_json(cm1e_bus_t *bus, uint16_t position)
{
    pdo_list_t list;
    json_t *entries = json_array();
    if (!pdo_list_read(bus, position, &list))
        complain("out of memory");
    if (list.unknown) {
        json_decref(entries);
        return json_null();
    }
    for (size_t i = 0; i < list.count; i++) {
        const listed_entry_t *entry = &list.entries[i];
        json_array_append_new(entries, json_pack("{s:b, s:i, s:s, s:i, s:i, s:i, s:i, s:s, s:s}", "output",
                                                 entry->output, "pdo", entry->pdo, "pdo_name", entry->pdo_name, "index",
                                                 entry->index, "subindex", entry->subindex, "bit", (int)entry->bit,
                                                 "bits", (int)entry->bits, "type", entry->type, "name", entry->name));
    }
    pdo_list_free(&list);
    return entries;
}

/* ---- the table --------------------------------------------------------------------------------------------------- */

static void print_table(cm1e_bus_t *bus, const cm1e_bus_config_t *named, bool pdos)
{
    const bool any = named->axis_count + named->slave_count > 0;
    char state[48];
    int name_width = 20, state_width = 18;
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        name_width = wider(name_width, slave->name);
        state_width = wider(state_width, al_state_name(slave->al_state, state, sizeof state));
    }
    printf("%3s  %-*s %-10s %-10s %-10s %6s %4s  %-*s %s%s\n", "pos", name_width, "name", "vendor", "product", "revision",
           "alias", "ID", state_width, "state", "firmware", any ? "   configured" : "");
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        const char *firmware = slave->software_version[0] ? slave->software_version : "-";
        char names[NAMES_BYTES] = "";
        for_each_name(bus, named, slave, add_text, names);
        printf("%3u  %-*s 0x%08X 0x%08X 0x%08X %6u %4u  %-*s %-*s%s\n", slave->position,
               in_bytes(name_width, slave->name), slave->name, slave->vendor_id, slave->product_code, slave->revision,
               slave->alias, slave->explicit_id, state_width, al_state_name(slave->al_state, state, sizeof state),
               names[0] ? in_bytes(11, firmware) : 0, firmware, names);
        if (slave->device && slave->device->channels)
            printf("     bridge %s, motors %s, %s, %s, %s\n", model_name(slave), motor_name(slave->motors[0]),
                   motor_name(slave->motors[1]), motor_name(slave->motors[2]), motor_name(slave->motors[3]));
        if (pdos)
            print_pdos(bus, slave->position);
    }
}

static const struct argp_option table[] = {
    {"pdos", KEY_PDOS, NULL, 0, "Show the process data of each slave, as it has them assigned now", 0}, {0}};
const struct argp argp_scan = {
    table, parse, NULL,
    "Lists the slaves of a network, and what a bus file, or the program that runs the network, calls them. "
    "Exit status 1: a slave is not there, or not the one that the bus file says. What is written into the slaves at the "
    "start is not looked at, nor the signals, which depend on it: `cm1e io -b` does the start, and lists them.",
    attach_children, NULL, NULL};

/** Not on standard output: a program that reads the table gets rows only. */
static void tell_next(const char *interface_name)
{
    fflush(stdout);
    fprintf(stderr, "Next: `cm1e init -i %s -o machine.yaml` writes a bus file of what is there\n", interface_name);
}

static int show(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const scan_options_t *scan = context;
    const cm1e_bus_config_t *named = axes_to_name(&scan->common, config);
    cm1e_diag_t diag = {0};
    (void)position;
    if (scan->common.json) {
        json_t *slaves = json_array();
        for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
            json_t *slave = slave_as_json(bus, named, cm1e_bus_slave(bus, i));
            if (scan->pdos)
                json_object_set_new(slave, "pdos", pdos_as_json(bus, (uint16_t)i));
            json_array_append_new(slaves, slave);
        }
        print_json(slaves);
    } else {
        print_table(bus, named, scan->pdos);
        if (named->axis_count + named->slave_count == 0)
            tell_next(cm1e_bus_configuration(bus)->interface_name);
        tell_simulated(cm1e_bus_configuration(bus));
    }
    /* A bus file states the expected slaves: compare. */
    const bool as_expected = config->axis_count + config->slave_count == 0 || cm1e_bus_identify(bus, &diag) == CM1E_OK;
    return as_expected ? EXIT_OK : fail(&diag);
}

int command_scan(int argc, char **argv)
{
    scan_options_t options = {0};
    if (parse_options(&argp_scan, argc, argv, &options))
        return EXIT_WRONG_USE;
    return look_at_network(&options.common, NULL, show, &options);
}
