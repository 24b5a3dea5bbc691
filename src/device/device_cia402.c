/* A servo drive by CiA 402 and ETG.6010 as a row of the device interface; see cia402_drive.h. */
#include "device/cia402_drive.h"
#include "device/device_rows.h"

#include <stdio.h>

/* The sizes of the standard. Which objects are mapped is decided by the drive or the bus file. A mode whose target is
 * not mapped is not used. */
static const cm1e_device_object_t process_data[] = {
    PROCESS_DATA(OUT_CONTROLWORD, OBJ_6040_CONTROLWORD, 2, 2, MAPPED_ALL, "Controlword", ),
    PROCESS_DATA(OUT_POSITION, OBJ_607A_TARGET_POSITION, 4, 4, 0, "Target position", ),
    PROCESS_DATA(OUT_VELOCITY, OBJ_60FF_TARGET_VELOCITY, 4, 4, 0, "Target velocity", ),
    PROCESS_DATA(OUT_MODE, OBJ_6060_MODES_OF_OPERATION, 1, 1, 0, "Modes of operation", ),
    PROCESS_DATA(OUT_DIGITAL, OBJ_60FE_DIGITAL_OUTPUTS, 4, 4, 0, "Physical outputs", .subindex = 1),
    PROCESS_DATA(OUT_PROFILE_VELOCITY, OBJ_6081_PROFILE_VELOCITY, 4, 4, 0, "Profile velocity", ),
    PROCESS_DATA(OUT_PROFILE_ACCELERATION, OBJ_6083_PROFILE_ACCELERATION, 4, 4, 0, "Profile acceleration", ),
    PROCESS_DATA(OUT_PROBE, OBJ_60B8_TOUCH_PROBE_FUNCTION, 2, 2, 0, "Touch probe function", ),
    PROCESS_DATA(IN_STATUSWORD, OBJ_6041_STATUSWORD, 2, 2, MAPPED_ALL, "Statusword", ),
    PROCESS_DATA(IN_ERROR, OBJ_603F_ERROR_CODE, 2, 2, 0, "Error code", ),
    PROCESS_DATA(IN_POSITION, OBJ_6064_POSITION_ACTUAL_VALUE, 4, 4, MAPPED_ALL, "Position actual value", ),
    PROCESS_DATA(IN_VELOCITY, OBJ_606C_VELOCITY_ACTUAL_VALUE, 4, 4, 0, "Velocity actual value", ),
    PROCESS_DATA(IN_TORQUE, OBJ_6077_TORQUE_ACTUAL_VALUE, 2, 2, 0, "Torque actual value", ),
    PROCESS_DATA(IN_DIGITAL, OBJ_60FD_DIGITAL_INPUTS, 4, 4, 0, "Digital inputs", ),
    PROCESS_DATA(IN_DC_LINK, OBJ_6079_DC_LINK_VOLTAGE, 4, 4, 0, "DC link voltage", ),
    PROCESS_DATA(IN_MODE, OBJ_6061_MODES_OF_OPERATION_DISPLAY, 1, 1, 0, "Modes of operation display", ),
    PROCESS_DATA(IN_PROBE, OBJ_60B9_TOUCH_PROBE_STATUS, 2, 2, 0, "Touch probe status", ),
    PROCESS_DATA(IN_PROBE_1_RISING, OBJ_60BA_TOUCH_PROBE_1_POSITIVE, 4, 4, 0, "Touch probe 1 positive edge", ),
    PROCESS_DATA(IN_PROBE_1_FALLING, OBJ_60BB_TOUCH_PROBE_1_NEGATIVE, 4, 4, 0, "Touch probe 1 negative edge", ),
    PROCESS_DATA(IN_PROBE_2_RISING, OBJ_60BC_TOUCH_PROBE_2_POSITIVE, 4, 4, 0, "Touch probe 2 positive edge", ),
    PROCESS_DATA(IN_PROBE_2_FALLING, OBJ_60BD_TOUCH_PROBE_2_NEGATIVE, 4, 4, 0, "Touch probe 2 negative edge", ),
};

/* Bit 4 (voltage enabled) is optional by ETG.6010, so it is not waited for. */
static const cm1e_device_words_t words = {
    .states = cm1e_fsa_cia402_table, .fault = STATUSWORD_FAULT, .warning = STATUSWORD_WARNING,
    .target_reached = STATUSWORD_TARGET_REACHED, .bit12 = STATUSWORD_BIT12, .bit13 = STATUSWORD_BIT13,
    .no_torque = 0x0006, .fault_reset = 0x0086, .rests_disabled = true,
};

/* pp takes a set-point at once (bit 5), as the driver gives one after the other. */
static const cm1e_device_mode_t modes[] = {MODES_OF_CIA402(&words, CONTROLWORD_CHANGE_IMMEDIATELY)};

/* Methods of the standard (1 ... 37) and of makers (below 0); the drive refuses those that it does not have. Makers
 * differ in the sign of 0x607C, so it is 0, and the axis reckons with its own offset. 0x6099:02, the speed of the
 * search for zero, is a parameter of the commissioned drive. */
static const cm1e_device_homing_t homing = {
    .first_method = -128, .last_method = 37, .first_by_switch = -128, .last_by_switch = 37, .halts = true,
    .offset_by_axis = true, .place = "",
    .objects = {HOMING_OBJECTS_OF_CIA402},
    .steps = {HOME_WRITE, HOME_SWITCH, HOME_START, HOME_RUN, HOME_SETTLE, HOME_RETURN},
};

static const cm1e_device_drive_t drive = {
    .name = "CiA 402 servo drive", .short_name = "CiA 402 servo drive", .place = "",
    .objects = process_data, .object_count = COUNT(process_data),
    .mappings = {[CM1E_MAPPING_DYNAMIC] = {"of the device (0x1C12/0x1C13)", CM1E_MODE_CSP}},
    .modes = modes, .mode_count = COUNT(modes),
    .refusal = "Check the mapping and which modes the drive has (0x6502)",
    .hardware_probe = true,
    .homing = &homing,
    .signals = {.inputs = 0x000F, .outputs = CM1E_CIA402_OUTPUTS, .output_subindex = 1,
                .output_shift = CM1E_CIA402_OUTPUT_SHIFT},
    .error = cm1e_cia402_error, .error_clause = "CiA 301, CiA 402 (IEC 61800-7-201)",
};

/* The PDOs that the device has assigned, unless the bus file names others. */
static cm1e_pdo_choice_t pdos(const cm1e_axis_config_t *axis)
{
    if (!axis || !axis->outputs_pdo)
        return (cm1e_pdo_choice_t){0};
    return (cm1e_pdo_choice_t){1, {{axis->outputs_pdo}, {axis->inputs_pdo}}};
}

static double counts_per_revolution(const cm1e_axis_config_t *axis)
{
    return axis->counts_per_revolution ? axis->counts_per_revolution : CM1E_COUNTS_PER_REVOLUTION;
}

static double peak_velocity(const cm1e_axis_config_t *axis)
{
    return axis->max_speed_rpm / 60.0 * counts_per_revolution(axis);
}

static const char *motor(size_t n)
{
    (void)n;
    return NULL;
}

static bool check_axis(const cm1e_axis_config_t *axis, cm1e_wrong_key_t *wrong)
{
    wrong->key = "drive.max_speed_rpm";
    if (axis->counts_per_revolution < 100 || axis->counts_per_revolution > 1 << 30) {
        wrong->key = "drive.counts_per_revolution";
        snprintf(wrong->text, sizeof wrong->text, "is %u; expected 100 ... %d", axis->counts_per_revolution, 1 << 30);
    } else if (!(axis->max_speed_rpm >= 1 && axis->max_speed_rpm <= 100000)) {
        snprintf(wrong->text, sizeof wrong->text, "is %g; expected 1 ... 100000", axis->max_speed_rpm);
    } else if (peak_velocity(axis) > INT32_MAX) {
        snprintf(wrong->text, sizeof wrong->text,
                 "is %g, at which the motor makes %.0f counts/s; expected at most %d counts/s", axis->max_speed_rpm,
                 peak_velocity(axis), INT32_MAX);
    } else {
        return true;
    }
    return false;
}

#define LACKS(key, reason)                                                                                          \
    {key, "is given, but the axis is a generic CiA 402 drive: " reason "; expected no such key"}
static const cm1e_absent_key_t absent[] = {
    LACKS("explicit_id", "its switches are not read; position or alias find it"),
    LACKS("k37", "drive.counts_per_revolution states its resolution"),
    LACKS("firmware", "no difference between its versions is known"),
    LACKS("mapping", "drive.outputs_pdo and drive.inputs_pdo choose its process data"),
    LACKS("wire.velocity_unit", "it is counts/s"),
    LACKS("wire.acceleration_unit", "it is counts/s2"),
    {NULL, NULL},
};

/* The standard leaves them to the maker. These are usual, and 0x60C2 can state them: a byte times a power of ten. */
static const int64_t cycle_times_ns[] = {200000, 250000, 500000, 1000000, 2000000, 4000000};

const cm1e_device_t cm1e_device_cia402 = {
    .kind = "cia402", .label = "CiA 402 servo drive", .name = "CiA 402 servo drive", .model = CM1E_DEVICE_CIA402,
    .recognised = CM1E_BY_PROFILE, .profile = CM1E_PROFILE_402, .motor_stated = true,
    .cycle_times_ns = cycle_times_ns, .cycle_time_count = COUNT(cycle_times_ns),
    ONE_TABLE(cm1e_cia402_objects), .pdos = pdos,
    .counts_per_revolution = counts_per_revolution, .peak_velocity = peak_velocity,
    .motor = motor, .motors_note = "no such key: drive.counts_per_revolution and drive.max_speed_rpm state its motor",
    .absent = absent, .check_axis = check_axis,
    .drives = {&drive},
};
