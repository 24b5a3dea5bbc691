/** cm1e status: every drive's state, error and measurements in words, read over SDO without touching the motor. Of
 *  bridges: status_bridge.c. */
#include <stdio.h>
#include <string.h>

#include "cia402/cia402.h"
#include "command.h"
#include "core/bytes.h"
#include "device/device.h"
#include "status_bridge.h"

/** What is read, in the order of the printed lines; values as the device has them. */
static const struct {
    uint16_t index;
    uint8_t bytes;
    bool is_signed;
    const char *key, *label, *unit;
    double scale;
} readings[] = {
    {OBJ_6041_STATUSWORD, 2, false, "statusword", "statusword", "", 1},
    {OBJ_603F_ERROR_CODE, 2, false, "error_code", "error code", "", 1},
    {OBJ_6061_MODES_OF_OPERATION_DISPLAY, 1, true, "mode", "mode", "", 1},
    {OBJ_6064_POSITION_ACTUAL_VALUE, 4, true, "position_counts", "position", "counts", 1},
    {OBJ_6077_TORQUE_ACTUAL_VALUE, 2, true, "torque_percent", "torque", "% of rated", 0.1},
    {OBJ_2301_TEMPERATURE, 2, true, "temperature_celsius", "temperature", "degrees C", 1},
    {OBJ_6079_DC_LINK_VOLTAGE, 4, true, "dc_link_volt", "motor supply", "V", 0.1},
    {OBJ_60FD_DIGITAL_INPUTS, 2, false, "digital_inputs", "inputs IN4...IN1", "", 1},
};
enum { READING_COUNT = sizeof readings / sizeof readings[0], STATUSWORD = 0, ERROR_CODE, MODE };

typedef struct drive_status {
    double values[READING_COUNT];
    bool valid[READING_COUNT];
} drive_status_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    if (key == ARGP_KEY_INIT) {
        state->child_inputs[0] = state->input;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static void read_drive(cm1e_bus_t *bus, uint16_t position, drive_status_t *drive, cm1e_diag_t *diag)
{
    for (int i = 0; i < READING_COUNT; i++) {
        uint8_t data[8] = {0};
        size_t size = sizeof data;
        drive->valid[i] = cm1e_sdo_read(bus, position, readings[i].index, 0, data, &size, diag) == CM1E_OK
                          && size == readings[i].bytes;
        if (!drive->valid[i])
            continue;
        const uint64_t bits = cm1e_get_uint(data, readings[i].bytes);
        const unsigned shift = 64 - 8 * readings[i].bytes;
        drive->values[i] = readings[i].scale
                           * (readings[i].is_signed ? (double)((int64_t)(bits << shift) >> shift) : (double)bits);
    }
}

static const char *mode_name(const drive_status_t *drive)
{
    const cm1e_mode_row_t *mode = cm1e_mode_find((int8_t)drive->values[MODE]);
    return mode ? mode->name : "no mode selected";
}

static void print_drive(const cm1e_slave_info_t *slave, const drive_status_t *drive)
{
    char state[48];
    printf("slave %u: %s, firmware %s, %s\n", slave->position, slave->name,
           slave->software_version[0] ? slave->software_version : "unknown",
           al_state_name(slave->al_state, state, sizeof state));
    const uint16_t statusword = (uint16_t)drive->values[STATUSWORD];
    const uint16_t code = (uint16_t)drive->values[ERROR_CODE];
    const cm1e_device_error_t *error = cm1e_device_error(code);
    printf("  %-18s %s (0x%04X), motor power %s\n", "state", cm1e_fsa_name(cm1e_fsa_decode(statusword)), statusword,
           statusword & STATUSWORD_VOLTAGE_ENABLED ? "on" : "off");
    printf("  %-18s 0x%04X %s%s%s\n", "error", code, error ? error->text : "not a code of the manual",
           error && error->cure && error->cure[0] ? ": " : "", error && error->cure ? error->cure : "");
    printf("  %-18s %s\n", "mode", mode_name(drive));
    for (int i = MODE + 1; i < READING_COUNT; i++) {
        if (!drive->valid[i])
            printf("  %-18s not readable\n", readings[i].label);
        else if (readings[i].index == OBJ_60FD_DIGITAL_INPUTS)
            printf("  %-18s %d %d %d %d\n", readings[i].label, (int)drive->values[i] >> 3 & 1,
                   (int)drive->values[i] >> 2 & 1, (int)drive->values[i] >> 1 & 1, (int)drive->values[i] & 1);
        else
            printf("  %-18s %.*f %s\n", readings[i].label, readings[i].scale < 1 ? 1 : 0, drive->values[i],
                   readings[i].unit);
    }
}

static json_t *drive_as_json(const cm1e_slave_info_t *slave, const drive_status_t *drive)
{
    const cm1e_device_error_t *error = cm1e_device_error((uint16_t)drive->values[ERROR_CODE]);
    json_t *object = json_pack("{s:i, s:s, s:s, s:s, s:s, s:s}", "position", slave->position, "name", slave->name,
                               "firmware", slave->software_version, "state",
                               cm1e_fsa_name(cm1e_fsa_decode((uint16_t)drive->values[STATUSWORD])), "error",
                               error ? error->text : "not a code of the manual", "mode_name", mode_name(drive));
    for (int i = 0; i < READING_COUNT; i++)
        json_object_set_new(object, readings[i].key, drive->valid[i] ? json_real(drive->values[i]) : json_null());
    return object;
}

/** Appends to `all`, or prints where that is NULL. FALSE: the statusword cannot be read. */
static bool show_drive(cm1e_bus_t *bus, const cm1e_slave_info_t *slave, json_t *all, cm1e_diag_t *diag)
{
    drive_status_t drive = {0};
    read_drive(bus, slave->position, &drive, diag);
    if (all)
        json_array_append_new(all, drive_as_json(slave, &drive));
    else
        print_drive(slave, &drive);
    return drive.valid[STATUSWORD];
}

static bool show_bridge(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave, json_t *all,
                        cm1e_diag_t *diag)
{
    bridge_status_t bridge = {0};
    const bool readable = read_bridge(bus, slave->position, &bridge, diag);
    if (all)
        json_array_append_new(all, bridge_status_as_json(config, slave, &bridge));
    else
        print_bridge(config, slave, &bridge);
    return readable;
}

int command_status(int argc, char **argv)
{
    static const struct argp_child children[] = {{&common_argp, 0, NULL, 0}, {0}};
    static const struct argp argp = {NULL, parse, NULL,
                                     "Shows every drive's state, error and measurements. The network goes to "
                                     "Pre-Operational: do not use it beside another master.",
                                     children, NULL, NULL};
    common_options_t options = {0};
    argp_parse(&argp, argc, argv, 0, NULL, &options);

    static cm1e_bus_config_t config;
    if (!load_configuration(&options, &config))
        return EXIT_WRONG_USE;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_scan(bus, &diag) != CM1E_OK) {
        cm1e_bus_close(bus);
        return fail(&diag);
    }
    json_t *all = options.json ? json_array() : NULL;
    bool readable = true;
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        if (slave->is_cm1e)
            readable = show_drive(bus, slave, all, &diag) && readable;
        else if (slave->is_bridge)
            readable = show_bridge(bus, &config, slave, all, &diag) && readable;
    }
    if (all)
        print_json(all);
    cm1e_bus_close(bus);
    return readable ? EXIT_OK : fail(&diag);
}
