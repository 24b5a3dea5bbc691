/* The slaves: who is there, how they are connected, and whether the bus file fits. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cia402/cia402.h"
#include "cm1e/hot_connect.h"
#include "cm1e/topology.h"
#include "core/bytes.h"
#include "core/codes.h"
#include "device/devices.h"
#include "doctor/doctor.h"

static const char group[] = "network";

static void say_failure(doctor_t *doctor, const char *subject, const cm1e_diag_t *diag)
{
    const char *cure = cm1e_error_cure(diag->error);
    doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, subject, "%.390s", diag->text), NULL, cure ? cure : "",
                  "%s", "");
}

/* ---- connections ----------------------------------------------------------------------------------------------- */

static const char damaged[] = "Frames are damaged or lost there: a cable, a plug, its shield, or interference.";

/** Counters of one port; forwarded errors are those of another cable, so they are no finding. */
static void judge_port(doctor_t *doctor, uint32_t position, const char *place, const cm1e_slave_port_t *counters,
                       bool *clean)
{
    if (counters->invalid_frames > 0 || counters->receive_errors > 0)
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "frame errors",
                                  "%s: slave %u counts %u invalid frames, %u receive errors "
                                  "since power-on",
                                  place, position, counters->invalid_frames, counters->receive_errors),
                      damaged, "Replace the cable there, keep it away from motor cables, then look again.", "%s", "");
    if (counters->lost_links > 0)
        doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "lost links",
                                  "%s: the link was lost %u times since "
                                  "power-on, as slave %u counts",
                                  place, counters->lost_links, position),
                      damaged, "Check that both plugs have locked; replace the cable.", "%s", "");
    *clean &= counters->invalid_frames == 0 && counters->receive_errors == 0 && counters->lost_links == 0;
}

/** Frames turn back there: nothing behind that port is reached. */
static void judge_loop(doctor_t *doctor, const char *place, const cm1e_slave_place_t *at, int port, bool *clean)
{
    if (!at->link[port] || at->open[port])
        return;
    doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "loop", "%s: there is a link, but the port sends frames "
                              "back", place),
                  "A master has closed the port, or the device behind it is no EtherCAT slave or has just been plugged "
                  "in.", "Look what is plugged in there; switch the slave off and on.", "%s", "");
    *clean = false;
}

static bool is_away(const cm1e_bus_t *bus, uint32_t position)
{
    const cm1e_presence_t presence = cm1e_bus_presence(bus, position);
    return presence == CM1E_PRESENCE_ABSENT || presence == CM1E_PRESENCE_REFUSED;
}

static void look_at_ports(doctor_t *doctor, cm1e_bus_t *bus)
{
    static cm1e_slave_place_t places[CM1E_MAX_SLAVES];
    bool clean = true;
    memset(places, 0, sizeof places);
    (void)cm1e_bus_topology(bus, places, CM1E_MAX_SLAVES, NULL); /* without it ports are named by their slave only */
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++) {
        cm1e_slave_port_t ports[CM1E_PORTS];
        char text[96];
        cm1e_diag_t diag = {0};
        if (is_away(bus, position))
            continue;
        if (cm1e_bus_read_ports(bus, (uint16_t)position, ports, &diag) != CM1E_OK) {
            say_failure(doctor, "ports", &diag);
            return;
        }
        for (int port = 0; port < CM1E_PORTS; port++) {
            cm1e_cable_text(&places[position - 1], (uint16_t)position, port, text, sizeof text);
            judge_port(doctor, position, text, &ports[port], &clean);
            judge_loop(doctor, text, &places[position - 1], port, &clean);
        }
    }
    if (clean)
        doctor_find(doctor, FINDING_GOOD, group, "connections", "no damaged frame and no lost link since power-on");
}

/* ---- drives ---------------------------------------------------------------------------------------------------- */

static bool read_number(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint32_t *value)
{
    uint8_t data[4] = {0};
    size_t size = sizeof data;
    const bool read = cm1e_sdo_read(bus, position, index, 0, data, &size, NULL) == CM1E_OK && size <= sizeof data;
    *value = (uint32_t)cm1e_get_uint(data, (unsigned)size);
    return read;
}

/** Below this a CM1-E (24 V) has no motor power. */
enum { DECIVOLTS = 10, LOWEST_VOLTS = 18 };

static void look_at_motor_power(doctor_t *doctor, cm1e_bus_t *bus, const cm1e_slave_info_t *slave)
{
    uint32_t decivolts;
    if (!read_number(bus, slave->position, 0x6079, &decivolts))
        return;
    const double volts = (double)(int32_t)decivolts / DECIVOLTS;
    if (volts >= LOWEST_VOLTS)
        doctor_find(doctor, FINDING_GOOD, group, "motor power", "slave %u: %.1f V", slave->position, volts);
    else
        doctor_advise(
            doctor_find(doctor, FINDING_PROBLEM, group, "motor power", "slave %u: %.1f V", slave->position, volts),
            "The logic of the drive runs on its own supply: it answers, but the motor has no torque.",
            "Switch the 24 V motor power on; check its fuse, its wiring and the emergency stop.", "%s", "");
}

static void look_at_error(doctor_t *doctor, cm1e_bus_t *bus, const cm1e_slave_info_t *slave)
{
    uint32_t code;
    const cm1e_device_drive_t *drive = slave->device->drives[0];
    if (!read_number(bus, slave->position, 0x603F, &code) || code == 0)
        return;
    const cm1e_device_error_t *error = drive && drive->error ? drive->error((uint16_t)code) : NULL;
    if (error && !error->fault)
        return; /* a message, not an error */
    doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "error", "slave %u: 0x%04X, %s", slave->position,
                              (unsigned)code, error ? error->text : "not in the manual"),
                  "The drive does not move before its error is reset.", error && error->cure ? error->cure : "",
                  "cm1e explain 0x%04X", (unsigned)code);
}

static void look_at_slave(doctor_t *doctor, cm1e_bus_t *bus, const cm1e_slave_info_t *slave)
{
    if (!slave->device) {
        doctor_find(doctor, FINDING_NOTE, group, "slave", "%u: %s, a device that cm1e does not drive", slave->position,
                    slave->name);
        return;
    }
    doctor_find(doctor, FINDING_GOOD, group, "slave", "%u: %s, firmware %s", slave->position, slave->name,
                slave->software_version[0] ? slave->software_version : "unknown");
    if (slave->device->firmware && slave->software_version[0] && !slave->device->firmware(slave->software_version))
        doctor_advise(doctor_find(doctor, FINDING_NOTE, group, "firmware", "slave %u: version %s is not known here",
                                  slave->position, slave->software_version),
                      "It is treated as the newest known one.", "Compare docs/DEVICE.md with its manual.", "%s", "");
    if (slave->device->channels == 0) {
        look_at_motor_power(doctor, bus, slave);
        look_at_error(doctor, bus, slave);
    }
}

/* ---- another master --------------------------------------------------------------------------------------------- */

static void say_foreign_frames(doctor_t *doctor, unsigned long long foreign)
{
    doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "another master",
                              "%llu frames of another master were seen", foreign),
                  "Two masters command the same slaves: motors follow now one, now the other.",
                  "Stop the other master, or disconnect it.", "%s", "");
}

/* ---- distributed clocks ----------------------------------------------------------------------------------------- */

/** Of a program that uses them. */
static void look_at_clocks(doctor_t *doctor, cm1e_bus_t *bus)
{
    uint32_t worst_ns = 0, count = 0;
    /* NOLINTNEXTLINE(bugprone-too-small-loop-variable): CM1E_MAX_SLAVES at most */
    for (uint16_t position = 1; position <= cm1e_bus_slave_count(bus); position++) {
        cm1e_slave_clock_t clock;
        cm1e_bus_slave_clock(bus, position, &clock);
        count += clock.has_clock;
        worst_ns = clock.maximum_ns > worst_ns ? clock.maximum_ns : worst_ns;
        if (clock.lost || clock.losses)
            doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "clocks",
                                      "slave %u lost synchronism %llu times, its clock was up to %u ns away%s",
                                      position, (unsigned long long)clock.losses, clock.maximum_ns,
                                      clock.lost ? ", and it is lost now" : ""),
                          "Its SYNC0 comes at another time than those of the others, so axes are not in step.",
                          "Look at lost frames and at the connections below; if there are none, its controller may be "
                          "damaged.", "%s", "");
    }
    if (count > 0)
        doctor_find(doctor, FINDING_GOOD, group, "clocks", "%u, up to %u ns from the reference", count, worst_ns);
}

/* ---- a program that has the network ----------------------------------------------------------------------------- */

static json_int_t number(const json_t *object, const char *name)
{
    return json_integer_value(json_object_get(object, name));
}

/** One member of the reply to a request; NULL: the program cannot be asked. */
static json_t *ask(cm1e_control_t *control, const char *name)
{
    char request[64], *text = NULL;
    snprintf(request, sizeof request, "{\"request\": \"%s\"}", name);
    json_t *reply = cm1e_control_ask(control, request, &text, NULL) == CM1E_OK ? json_loads(text, 0, NULL) : NULL;
    json_t *member = json_incref(json_object_get(reply, name));
    json_decref(reply);
    free(text);
    return member;
}

static void look_at_run(doctor_t *doctor, const json_t *statistics)
{
    const json_t *bus = json_object_get(statistics, "bus");
    const json_int_t overruns = number(statistics, "overruns"), lost = number(bus, "lost_frames"),
                     foreign = number(bus, "foreign_frames");
    char networks[128];
    lost_by_network(statistics, networks, sizeof networks);
    finding_t *finding =
        doctor_find(doctor, overruns || lost ? FINDING_PROBLEM : FINDING_GOOD, group, "cycles of the program",
                    "%lld, %lld of them too long, %lld lost frames%s", (long long)number(statistics, "cycles"),
                    (long long)overruns, (long long)lost, networks);
    if (overruns || lost)
        doctor_advise(finding, "A cycle without an answer holds the set-points of all axes.",
                      "See the findings on machine and interface, and on the connections below.", "%s", "");
    if (foreign > 0)
        say_foreign_frames(doctor, (unsigned long long)foreign);
}

/** Says who has the network, and what the program itself knows of its run. Whether there is such a program. */
static bool look_at_owner(doctor_t *doctor, const common_options_t *options, const cm1e_bus_config_t *config)
{
    cm1e_control_t *control = NULL;
    if (connect_network(options, config, &control, NULL) != CM1E_OK)
        return false;
    json_t *hello = ask(control, "hello"), *statistics = ask(control, "statistics");
    const char *program = json_string_value(json_object_get(hello, "program"));
    doctor_find(doctor, FINDING_NOTE, group, "program",
                "%.60s (process %lld) has the network, so it was asked. Not done because of that: the states of the "
                "slaves were not changed, and no frame was sent to look for another master", program ? program : "?",
                (long long)number(hello, "pid"));
    if (statistics)
        look_at_run(doctor, statistics);
    json_decref(hello);
    json_decref(statistics);
    cm1e_control_close(control);
    return true;
}

/* ---- the whole -------------------------------------------------------------------------------------------------- */

/** Optional slaves that are absent are no fault. Returns their number. */
static unsigned look_at_absent(doctor_t *doctor, const cm1e_bus_t *bus)
{
    char text[CM1E_PRESENCE_TEXT];
    unsigned absent = 0;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++) {
        cm1e_bus_presence_text(bus, position, text, sizeof text);
        if (!text[0])
            continue;
        doctor_find(doctor, FINDING_NOTE, group, "optional slave", "%s", text);
        absent++;
    }
    return absent;
}

static void look_at_strangers(doctor_t *doctor, const cm1e_bus_t *bus)
{
    cm1e_stranger_t strangers[CM1E_STRANGERS];
    char text[CM1E_PRESENCE_TEXT];
    const size_t count = cm1e_bus_strangers(bus, strangers, CM1E_STRANGERS);
    for (size_t i = 0; i < count; i++) {
        cm1e_stranger_text(&strangers[i], text, sizeof text);
        doctor_find(doctor, FINDING_NOTE, group, "stranger", "%s", text);
    }
}

static void look_at_configuration(doctor_t *doctor, cm1e_bus_t *bus, const cm1e_bus_config_t *config)
{
    cm1e_diag_t diag = {0};
    if (config->axis_count + config->slave_count == 0)
        doctor_find(doctor, FINDING_NOTE, group, "bus file", "none given: -b FILE compares one with what is there");
    else if (cm1e_bus_identify(bus, &diag) != CM1E_OK)
        say_failure(doctor, "bus file", &diag);
    else if (look_at_absent(doctor, bus) == 0)
        doctor_find(doctor, FINDING_GOOD, group, "bus file", "its %u axes and %u other slaves are there",
                    config->axis_count, config->slave_count);
}

void doctor_look_at_bus(doctor_t *doctor, const common_options_t *options, const cm1e_bus_config_t *config)
{
    cm1e_bus_t *bus = NULL;
    cm1e_diag_t diag = {0};
    const bool attached = look_at_owner(doctor, options, config);
    if (open_network(options, config, &bus, &diag) != CM1E_OK) {
        say_failure(doctor, "slaves", &diag);
        return;
    }
    doctor_find(doctor, FINDING_GOOD, group, "slaves", "%u", cm1e_bus_slave_count(bus));
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        if (!is_away(bus, position))
            look_at_slave(doctor, bus, cm1e_bus_slave(bus, position));
    look_at_configuration(doctor, bus, config);
    look_at_strangers(doctor, bus);
    look_at_ports(doctor, bus);
    look_at_clocks(doctor, bus);
    if (!attached && cm1e_bus_counters(bus)->foreign_frames > 0)
        say_foreign_frames(doctor, (unsigned long long)cm1e_bus_counters(bus)->foreign_frames);
    cm1e_bus_close(bus);
}
