/** cm1e status: state, error and measurements of every drive, read over SDO without acting on the motor; name and state
 *  of other slaves. status_drive.c reads a CM1-E, status_bridge.c a bridge. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "attach.h"
#include "cm1e/clocks.h"
#include "cm1e/emergency.h"
#include "cm1e/hot_connect.h"
#include "cm1e/topology.h"
#include "command.h"
#include "device/devices.h"
#include "device/unit.h"
#include "status_bridge.h"
#include "status_drive.h"
#include "which_slave.h"

static error_t parse(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    return key == ARGP_KEY_INIT ? give_options(state, state->input) : ARGP_ERR_UNKNOWN;
}

static void print_head(const cm1e_slave_info_t *slave, const char *axis, const char *what)
{
    char state[48];
    printf("slave %u%s%s: %s, %s, %s\n", slave->position, axis[0] ? ", axis " : "", axis,
           slave->name[0] ? slave->name : "without a name", what,
           al_state_name(slave->al_state, state, sizeof state));
}

/** The axis of a slave, where a bus file or the program that runs the network names it. */
typedef struct named_axis {
    const char *name;               /**< "": none has this slave */
    const cm1e_axis_config_t *axis; /**< of the bus file: its unit is known; NULL: it is not */
} named_axis_t;

/** The actual position in the unit of the axis, from the zero of the drive; NAN: not known. */
static double units_of(const cm1e_axis_config_t *axis, const drive_status_t *drive)
{
    if (!axis)
        return NAN;
    const double counts = drive_position(drive);
    const cm1e_unit_t unit = cm1e_unit_of(axis);
    return (axis->invert ? -counts : counts) * unit.units / unit.counts;
}

static void print_drive(const cm1e_slave_info_t *slave, const drive_status_t *drive, const named_axis_t *named)
{
    char text[DRIVE_TEXT_BYTES], firmware[48];
    const char *version = slave->software_version[0] ? slave->software_version : "unknown";
    snprintf(firmware, sizeof firmware, "firmware %s", version);
    print_head(slave, named->name, firmware);
    for (int i = 0; i < DRIVE_READINGS; i++) {
        printf("  %-18s %s", drive_label(drive, i), drive_text(drive, i, text, sizeof text));
        if (i == DRIVE_POSITION && !isnan(units_of(named->axis, drive)))
            printf(" = %.6g u", units_of(named->axis, drive));
        putchar('\n');
    }
}

/** Adds the axis: its name, and the position in its unit. */
static json_t *with_axis(json_t *object, const named_axis_t *named, const drive_status_t *drive)
{
    if (!named->name[0])
        return object;
    const double position = units_of(named->axis, drive);
    json_object_set_new(object, "axis", json_string(named->name));
    json_object_set_new(object, "position_units", isnan(position) ? json_null() : json_real(position));
    return object;
}

/** Appends to `all`, or prints if that is NULL. Returns false if the statusword cannot be read. */
static bool show_drive(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_bus_config_t *names,
                       const cm1e_slave_info_t *slave, json_t *all, cm1e_diag_t *diag)
{
    drive_status_t drive;
    const int number = find_axis_at(bus, names, slave, 0);
    const named_axis_t named = {number < 0 ? "" : names->axes[number].name,
                                number < 0 || names != config ? NULL : &names->axes[number]};
    const bool readable = read_drive(bus, slave->position, &drive, diag);
    if (all)
        json_array_append_new(all, with_axis(drive_status_as_json(slave, &drive), &named, &drive));
    else
        print_drive(slave, &drive, &named);
    return readable;
}

/** A slave that is not a motor: an I/O module, a coupler ... */
static void show_other(const cm1e_slave_info_t *slave, json_t *all)
{
    char state[48];
    if (all)
        json_array_append_new(all, json_pack("{s:i, s:s, s:s, s:s, s:b}", "position", slave->position, "name",
                                             slave->name, "firmware", slave->software_version, "al_state",
                                             al_state_name(slave->al_state, state, sizeof state), "is_motor", false));
    else
        print_head(slave, "", "no motor");
}

static bool show_bridge(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave, json_t *all,
                        cm1e_diag_t *diag)
{
    bridge_status_t bridge = {0};
    const bool readable = read_bridge(bus, slave->position, &bridge, diag);
    if (all)
        json_array_append_new(all, bridge_status_as_json(bus, config, slave, &bridge));
    else
        print_bridge(bus, config, slave, &bridge);
    return readable;
}

enum { EMERGENCIES_SHOWN = 4 };

/** The time of day; a virtual clock has seconds only. */
static void time_text(int64_t time_ns, char text[32])
{
    const time_t seconds = (time_t)(time_ns / 1000000000);
    const int ms = (int)(time_ns / 1000000 % 1000);
    struct tm local;
    char day[20];
    localtime_r(&seconds, &local);
    strftime(day, sizeof day, "%H:%M:%S", &local);
    snprintf(text, 32, "%s.%03d", day, ms);
}

/** The last emergencies of a slave, below its lines. */
static void print_emergencies(const cm1e_bus_t *bus, uint16_t position)
{
    cm1e_emergency_t all[CM1E_EMERGENCIES];
    char text[CM1E_EMERGENCY_TEXT_BYTES], when[32];
    const size_t count = cm1e_bus_emergencies(bus, position, 0, all, CM1E_EMERGENCIES, NULL);
    for (size_t i = count > EMERGENCIES_SHOWN ? count - EMERGENCIES_SHOWN : 0; i < count; i++) {
        cm1e_emergency_text(bus, position, &all[i], text, sizeof text);
        time_text(all[i].time_ns, when);
        printf("  %s       %s\n", when, text);
    }
}

static json_t *emergencies_as_json(const cm1e_bus_t *bus, uint16_t position)
{
    cm1e_emergency_t all[CM1E_EMERGENCIES];
    char text[CM1E_EMERGENCY_TEXT_BYTES];
    const size_t count = cm1e_bus_emergencies(bus, position, 0, all, CM1E_EMERGENCIES, NULL);
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) {
        cm1e_emergency_text(bus, position, &all[i], text, sizeof text);
        json_array_append_new(list, json_pack("{s:I, s:I, s:i, s:i, s:s}", "number", (json_int_t)all[i].number,
                                              "time_ns", (json_int_t)all[i].time_ns, "code", all[i].code,
                                              "error_register", all[i].error_register, "text", text));
    }
    return list;
}

/** As every slave ends, whatever it is. */
static void show_emergencies(const cm1e_bus_t *bus, uint16_t position, json_t *all)
{
    if (all)
        json_object_set_new(json_array_get(all, json_array_size(all) - 1), "emergencies",
                            emergencies_as_json(bus, position));
    else
        print_emergencies(bus, position);
}

/* ---- distributed clocks, of a program that uses them ------------------------------------------------------------ */

static void print_clock(const cm1e_slave_clock_t *clock)
{
    char pulses[64] = "";
    if (clock->sync0_ns)
        snprintf(pulses, sizeof pulses, ", SYNC0 every %g us", clock->sync0_ns * 1e-3);
    if (clock->is_reference)
        printf("  clock              reference of all others%s\n", pulses);
    else
        printf("  clock              %+d ns, at most %u ns%s%s\n", (int)clock->deviation_ns, clock->maximum_ns, pulses,
               clock->lost ? "; LOST: it does not follow the reference" : clock->losses ? "; it was lost before" : "");
}

static void show_clock(const cm1e_bus_t *bus, uint16_t position, json_t *all)
{
    cm1e_slave_clock_t clock;
    cm1e_bus_slave_clock(bus, position, &clock);
    if (!clock.has_clock)
        return;
    if (!all) {
        print_clock(&clock);
        return;
    }
    json_object_set_new(json_array_get(all, json_array_size(all) - 1), "clock",
                        json_pack("{s:b, s:b, s:i, s:i, s:i, s:I}", "is_reference", clock.is_reference, "lost",
                                  clock.lost, "deviation_ns", (int)clock.deviation_ns, "maximum_ns",
                                  (int)clock.maximum_ns, "sync0_ns", (int)clock.sync0_ns, "losses",
                                  (json_int_t)clock.losses));
}

/* ---- a redundant ring ------------------------------------------------------------------------------------------- */

/** Below the slaves; in JSON at both slaves that adjoin the break, because the list has slaves only. */
static void show_ring(const cm1e_bus_t *bus, json_t *all)
{
    cm1e_bus_ring_t ring;
    char text[512];
    cm1e_bus_ring(bus, &ring);
    if (!ring.used)
        return;
    cm1e_bus_ring_text(bus, &ring, text, sizeof text);
    if (!all)
        printf("%s\n", text);
    for (unsigned end = 0; all && ring.placed && end < 2; end++) {
        json_t *slave = json_array_get(all, (end ? ring.before : ring.behind) - 1u);
        if (slave)
            json_object_set_new(slave, "ring", json_string(text));
    }
}

/* ---- slaves that come and go ------------------------------------------------------------------------------------- */

static bool is_away(const cm1e_bus_t *bus, const cm1e_slave_info_t *slave)
{
    const cm1e_presence_t presence = cm1e_bus_presence(bus, slave->position);
    return presence == CM1E_PRESENCE_ABSENT || presence == CM1E_PRESENCE_REFUSED;
}

/** Which slaves of the bus file are absent is known when the others are identified. A network that is not as the file says
 *  is shown all the same. */
static void identify(cm1e_bus_t *bus, const cm1e_bus_config_t *config)
{
    cm1e_diag_t diag;
    if (config->axis_count + config->slave_count > 0 && cm1e_bus_identify(bus, &diag) != CM1E_OK)
        complain("the network is not as the bus file says: %s", diag.text);
}

/** An absent slave has nothing to be read; of another one that takes no part it is told below its lines. */
static void show_presence(const cm1e_bus_t *bus, const cm1e_slave_info_t *slave, json_t *all)
{
    char text[CM1E_PRESENCE_TEXT];
    const cm1e_presence_t presence = cm1e_bus_presence(bus, slave->position);
    const char *name = cm1e_presence_name(presence);
    cm1e_bus_presence_text(bus, slave->position, text, sizeof text);
    if (!text[0])
        return;
    if (!all)
        printf("%s%s\n", is_away(bus, slave) ? "" : "  ", text);
    else if (is_away(bus, slave))
        json_array_append_new(all, json_pack("{s:i, s:s, s:s, s:s}", "position", slave->position, "name", slave->name,
                                             "presence", name, "presence_text", text));
    else
        json_object_update_new(json_array_get(all, json_array_size(all) - 1),
                               json_pack("{s:s, s:s}", "presence", name, "presence_text", text));
}

/** Below the slaves, because they are none of them. */
static void show_strangers(const cm1e_bus_t *bus, json_t *all)
{
    cm1e_stranger_t strangers[CM1E_STRANGERS];
    char text[CM1E_PRESENCE_TEXT];
    const size_t count = cm1e_bus_strangers(bus, strangers, CM1E_STRANGERS);
    for (size_t i = 0; i < count; i++) {
        const cm1e_stranger_t *one = &strangers[i];
        cm1e_stranger_text(one, text, sizeof text);
        if (all)
            json_array_append_new(all, json_pack("{s:b, s:i, s:I, s:I, s:i, s:i, s:s}", "stranger", true, "place",
                                                 one->place, "vendor_id", (json_int_t)one->vendor_id, "product_code",
                                                 (json_int_t)one->product_code, "alias", one->alias, "explicit_id",
                                                 one->explicit_id, "text", text));
        else
            printf("stranger: %s\n", text);
    }
}

/* ---- errors of axes, of a program that runs ---------------------------------------------------------------------- */

/** An axis may have an error that its drive knows nothing of: a coupling that asked for too much, a lost slave elsewhere. */
static void show_axis_errors(const common_options_t *options, const cm1e_bus_config_t *config, json_t *all)
{
    cm1e_control_t *control;
    cm1e_diag_t diag = {0};
    if (connect_network(options, config, &control, &diag) != CM1E_OK)
        return; /* no program runs, or it has gone meanwhile */
    json_t *axes = ask_program(control, json_pack("{s:s}", "request", "axes"), "axes", &diag), *axis;
    size_t i;
    json_array_foreach (axes, i, axis) {
        const char *text = json_string_value(json_object_get(axis, "text"));
        const json_int_t position = json_integer_value(json_object_get(axis, "slave"));
        if (!json_is_object(json_object_get(axis, "error")) || !text)
            continue;
        if (!all)
            printf("%s\n", text);
        json_t *slave = position > 0 ? json_array_get(all, (size_t)position - 1) : NULL;
        json_t *errors = json_object_get(slave, "axis_errors");
        if (slave && !errors) /* of a bridge each motor may have one */
            json_object_set_new(slave, "axis_errors", errors = json_array());
        json_array_append_new(errors, json_string(text));
    }
    json_decref(axes);
    cm1e_control_close(control);
}

const struct argp argp_status = {NULL, parse, NULL,
                                 "Shows state, error, measurements and the last emergencies of every drive, and which "
                                 "slaves are not motors. Of a network that is not as the bus file says, it tells "
                                 "what differs. Where a program runs the network, it is asked, for errors of its axes "
                                 "too; else the network is brought to Pre-Operational.",
                                 attach_children, NULL, NULL};

static int show(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const common_options_t *options = context;
    cm1e_diag_t diag = {0};
    (void)position;
    identify(bus, config);
    const cm1e_bus_config_t *names = axes_to_name(options, config);
    json_t *all = options->json ? json_array() : NULL;
    bool readable = true;
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        if (is_away(bus, slave)) {
            show_presence(bus, slave, all);
            continue;
        }
        if (slave->device && slave->device->channels == 0)
            readable = show_drive(bus, config, names, slave, all, &diag) && readable;
        else if (slave->device)
            readable = show_bridge(bus, names, slave, all, &diag) && readable;
        else
            show_other(slave, all);
        show_presence(bus, slave, all);
        show_clock(bus, slave->position, all);
        show_emergencies(bus, slave->position, all);
    }
    show_strangers(bus, all);
    show_ring(bus, all);
    show_axis_errors(options, config, all);
    if (all)
        print_json(all);
    else
        tell_simulated(cm1e_bus_configuration(bus));
    return readable ? EXIT_OK : fail(&diag);
}

int command_status(int argc, char **argv)
{
    common_options_t options = {0};
    if (parse_options(&argp_status, argc, argv, &options))
        return EXIT_WRONG_USE;
    return look_at_network(&options, NULL, show, &options);
}
