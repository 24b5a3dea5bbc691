/* The EtherCAT Cool MUSCLE Bridge as rows of the device interface: a model for each set of motors, a drive for each
 * kind of motor. Its dictionary has sources of its own (bridge_objects.c, bridge_axes.c). */
#include <stdio.h>
#include <string.h>

#include "core/clock.h"
#include "device/bridge_tables.h"
#include "device/device_rows.h"

/* BR 6.3.1; appendix 6 gives the words 32 bits, which nothing else does. */
static const cm1e_device_object_t process_data[] = {
    PROCESS_DATA(OUT_CONTROLWORD, OBJ_6040_CONTROLWORD, 2, 2, MAPPED_ALL, "Controlword", ),
    PROCESS_DATA(OUT_POSITION, OBJ_607A_TARGET_POSITION, 4, 4, MAPPED_ALL, "Target position", ),
    PROCESS_DATA(IN_STATUSWORD, OBJ_6041_STATUSWORD, 2, 2, MAPPED_ALL, "Statusword", ),
    PROCESS_DATA(IN_POSITION, OBJ_6064_POSITION_ACTUAL_VALUE, 4, 4, MAPPED_ALL, "Position actual value", ),
};

/* BR 6.1.2, 6.1.3: an error shows as bit 14, and as a state with bit 3. */
#define PROFILE_STATUSWORD                                                                                          \
    .states = cm1e_fsa_bridge_table, .fault = CM1E_BRIDGE_STATUSWORD_ERROR | STATUSWORD_FAULT,                      \
    .motor_free = CM1E_BRIDGE_STATUSWORD_FREE, .rests_disabled = true,                                              \
    .target_reached = STATUSWORD_TARGET_REACHED, .bit12 = STATUSWORD_BIT12, .bit13 = STATUSWORD_BIT13
static const cm1e_device_words_t profile_words = {PROFILE_STATUSWORD, .no_torque = 0x0006, .fault_reset = 0x0086};
/* Strings go over the serial line only while no controlword does (BR appendix 2). */
static const cm1e_device_words_t cml_words = {PROFILE_STATUSWORD, .no_torque = 0x0000};
/* BR 7.1.3: no state. */
static const cm1e_device_words_t cmd_words = {.commands = true, .own_coding = true, .rests_disabled = true};
/* BR 7.1.2, 7.1.3: the state in four bits, what the motor says in bits 8 to 11: 1, 2, 4 and 1111b are errors, 1000b is
 * in position. Bit 7 is an output here: there is no fault reset. */
static const cm1e_device_words_t cpio_words = {
    .states = cm1e_fsa_cpio_table, .fault = 0x0700 | STATUSWORD_FAULT, .target_reached = 0x0800,
    .inputs = 0x00F0, .outputs = 0x00F0, .mark = 0xC000, .no_torque = 0x0006, .fault_reset = 0x0006,
    .own_coding = true, .rests_disabled = true,
};

/* The drawing of BR 6: three arrows lead into each of CMD, CML and CPIO, two into csp, one into hm. */
enum { CSP = 0, HM, CML, CMD, CPIO };
static const cm1e_device_mode_t modes[] = {
    [CSP] = {.mode = CM1E_BRIDGE_MODE_CSP, .abbreviation = "CSP", .words = &profile_words,
             .target = CM1E_OUT_POSITION, .torque = true, .holds_position = true, .rest = true,
             .ways = 1 << HM | 1 << CML},
    [HM] = {.mode = CM1E_BRIDGE_MODE_HM, .abbreviation = "HM", .words = &profile_words, .target = CM1E_NO_ROLE,
            .torque = true, .rest = true, .ways = 1 << CSP},
    [CML] = {.mode = CM1E_BRIDGE_MODE_CML, .abbreviation = "CML", .words = &cml_words, .target = CM1E_NO_ROLE,
             .rest = true, .ways = 1 << CSP | 1 << CMD | 1 << CPIO,
             .cure = "In CML the bridge takes no controlword: end the error with a CML string (\"(\") or switch the "
                     "bridge off and on"},
    [CMD] = {.mode = CM1E_BRIDGE_MODE_CMD, .abbreviation = "CMD", .words = &cmd_words, .target = CM1E_NO_ROLE,
             .ways = 1 << CSP | 1 << CML | 1 << CPIO, .leaves_abnormal = true,
             .cure = "In CMD an error is ended by the command Motor enable, or by switching the bridge off and on"},
    [CPIO] = {.mode = CM1E_BRIDGE_MODE_CPIO, .abbreviation = "CPIO", .words = &cpio_words,
              .target = CM1E_OUT_POSITION, .torque = true, .holds_position = true, .rest = true,
              .ways = 1 << CSP | 1 << CML | 1 << CMD, .leaves_abnormal = true,
              .cure = "In CPIO the bridge has no fault reset: switch it off and on"},
};

/* BR 6.4. The guide has no range of K47: that of a CM1-E holds. */
#define HOMING                                                                                                      \
    .first_method = 1, .last_method = 4, .first_by_switch = 3, .last_by_switch = 4, .positive_stop = 1,             \
    .negative_stop = 2, .attained_is_enough = true, .subindex_by_stop = 2, .place = " behind a bridge",             \
    .objects = {                                                                                                    \
        [CM1E_HOMING_OFFSET] = {OBJ_607C_HOME_OFFSET, 0, CM1E_BRIDGE_OFFSET_UNIT, NULL},                            \
        [CM1E_HOMING_METHOD] = {OBJ_6098_HOMING_METHOD, 0, 1.0, NULL},                                              \
        [CM1E_HOMING_SPEED] = {OBJ_6099_HOMING_SPEEDS, 1, CM1E_BRIDGE_SPEED_UNIT, NULL},                            \
        [CM1E_HOMING_ACCELERATION] = {OBJ_609A_HOMING_ACCELERATION, 0, CM1E_BRIDGE_ACCELERATION_UNIT, NULL},        \
        [CM1E_HOMING_TORQUE] = {OBJ_60F6_K_PARAMETERS, CM1E_K_PARAMETER_HOMING_TORQUE, 1.0,                         \
                                &cm1e_device_k_parameters[CM1E_K_PARAMETER_HOMING_TORQUE]},                         \
    }
#define STEPS HOME_REST, HOME_SWITCH, HOME_WRITE, HOME_TAKEN, HOME_START, HOME_RUN, HOME_SETTLE, HOME_RETURN
static const cm1e_device_homing_t cm1_homing = {HOMING, .steps = {STEPS}};
/* Its K45 says what K48 counts in (BR 6.4.1, note 3). */
static const cm1e_device_homing_t cm2_homing = {HOMING, .steps = {HOME_READ, STEPS}};

/* A motor that does not answer is detected after some exchanges only. Until then 0x6064 is its last position. */
#define DRIVE                                                                                                       \
    .name = "motor behind an EtherCAT Cool MUSCLE Bridge", .place = "behind the bridge ",                           \
    .objects = process_data, .object_count = COUNT(process_data),                                                   \
    .mappings = {[CM1E_MAPPING_DYNAMIC] = {"csp (0x1601/0x1A01 ...)", CM1E_MODE_CSP}},                              \
    .modes = modes, .mode_count = COUNT(modes),                                                                     \
    .no_way = "HM is reached from CSP only, CSP from HM and CML only, the other modes from each other and from CSP " \
              "(BR 6): from CMD and CPIO the way back to CSP is switching the bridge off and on",                   \
    .refusal = "The bridge switches while the motor is at standstill and shows no error, and not from every mode to "  \
               "every other one. cm1e status shows its state. The only way back from CMD and CPIO is to switch it " \
               "off and on",                                                                                        \
    .asks_mode_first = true, .mode_supervised = true, .position_limited = true, .reset_settle_ns = 100 * MS_IN_NS,  \
    .error = cm1e_device_error

#define ADVICE_MAPPING                                                                                              \
    " Behind a bridge torque is not known, and digital signals go by SDO, too late for what follows a position: only " \
    "in CPIO mode they are in the process data."
#define ADVICE_POWER " Behind a bridge digital signals are reached while the motor is enabled in csp."
static const cm1e_device_drive_t cm1_drive = {
    DRIVE, .short_name = "CM1", .homing = &cm1_homing,
    .signals = {0x0E, 0x02, true, 1, 0,
                {" Of a CM1 behind a bridge these can be reached: inputs 2 ... 4, output 2.", ADVICE_MAPPING,
                 ADVICE_POWER}},
};
static const cm1e_device_drive_t cm2_drive = {
    DRIVE, .short_name = "CM2", .homing = &cm2_homing,
    .signals = {0x3F, 0x0F, true, 1, 0,
                {" Of a CM2 behind a bridge these can be reached: inputs 1 ... 6 (in CPIO 1 ... 4), outputs 1 ... 4.",
                 ADVICE_MAPPING, ADVICE_POWER}},
};

/* BR appendix 6. */
static const cm1e_question_t questions[] = {
    {OBJ_1000_DEVICE_TYPE, 0, CM1E_BRIDGE_DEVICE_TYPE},
    {OBJ_F000_MODULAR_DEVICE_PROFILE, 1, CM1E_BRIDGE_INDEX_INCREMENT},
    {OBJ_F010_MODULE_PROFILE_LIST, 1, CM1E_BRIDGE_DEVICE_TYPE},
    {OBJ_F010_MODULE_PROFILE_LIST, 2, CM1E_BRIDGE_DEVICE_TYPE},
    {OBJ_F010_MODULE_PROFILE_LIST, 3, CM1E_BRIDGE_DEVICE_TYPE},
    {OBJ_F010_MODULE_PROFILE_LIST, 4, CM1E_BRIDGE_DEVICE_TYPE},
    {OBJ_F050_DETECTED_MODULE_IDENT_LIST, 1, CM1E_BRIDGE_MODULE_IDENT},
    {OBJ_F050_DETECTED_MODULE_IDENT_LIST, 2, CM1E_BRIDGE_MODULE_IDENT},
    {OBJ_F050_DETECTED_MODULE_IDENT_LIST, 3, CM1E_BRIDGE_MODULE_IDENT},
    {OBJ_F050_DETECTED_MODULE_IDENT_LIST, 4, CM1E_BRIDGE_MODULE_IDENT},
    {OBJ_F511_CONFIG_AXIS_1 + 0, 1, 0},
    {OBJ_F511_CONFIG_AXIS_1 + 1, 1, 0},
    {OBJ_F511_CONFIG_AXIS_1 + 2, 1, 0},
    {OBJ_F511_CONFIG_AXIS_1 + 3, 1, 0},
    {OBJ_1018_IDENTITY, 3, 0},
};

static const cm1e_object_t *object(const cm1e_device_t *device, size_t n)
{
    return cm1e_bridge_object(device->model, n);
}

static const cm1e_entry_t *entry(const cm1e_device_t *device, uint16_t index, uint8_t subindex)
{
    return cm1e_bridge_entry(device->model, index, subindex);
}

/* The PDOs of all its axes, configured or not: the guide does not say whether the bridge accepts fewer. */
static cm1e_pdo_choice_t pdos(const cm1e_axis_config_t *axis)
{
    (void)axis;
    cm1e_pdo_choice_t choice = {.count = CM1E_BRIDGE_AXES};
    for (unsigned i = 0; i < 2 * CM1E_BRIDGE_AXES; i++) {
        const bool transmit = i >= CM1E_BRIDGE_AXES;
        cm1e_pdo_t pdo;
        cm1e_bridge_pdo(&pdo, i % CM1E_BRIDGE_AXES, transmit);
        choice.pdos[transmit][i % CM1E_BRIDGE_AXES] = pdo.index;
    }
    return choice;
}

static double counts_per_revolution(const cm1e_axis_config_t *axis)
{
    const int32_t counts = axis->k37_stated ? cm1e_bridge_counts_per_revolution(axis->k37) : 0;
    return counts > 0 ? counts : CM1E_COUNTS_PER_REVOLUTION;
}

/* 3000 1/min: the guide does not state it. */
static double peak_velocity(const cm1e_axis_config_t *axis) { return 50.0 * counts_per_revolution(axis); }

static const char *motor(size_t n)
{
    return n == 0 ? cm1_drive.short_name : n == 1 ? cm2_drive.short_name : NULL;
}

static cm1e_bridge_motor_t motor_of(const cm1e_axis_config_t *axis)
{
    return strcmp(axis->motor, cm1_drive.short_name) == 0 ? CM1E_BRIDGE_CM1 : CM1E_BRIDGE_CM2;
}

/* BR appendix 5. */
static double position_limit(const cm1e_axis_config_t *axis)
{
    return cm1e_bridge_position_limit(motor_of(axis), axis->k37);
}

static bool check_axis(const cm1e_axis_config_t *axis, cm1e_wrong_key_t *wrong)
{
    wrong->key = "k37";
    if (!axis->k37_stated)
        snprintf(wrong->text, sizeof wrong->text,
                 "is missing; expected the K37 of the motor, which defines counts and speeds: send it \"K37.%u\" with "
                 "cm1e cml", axis->channel);
    else if (cm1e_bridge_counts_per_revolution(axis->k37) > 0 && position_limit(axis) > 0)
        return true;
    else
        snprintf(wrong->text, sizeof wrong->text,
                 "is %u; expected 0 ... 8 or 10, 40 ... 50, or each of these plus 20%s",
                 axis->k37, motor_of(axis) == CM1E_BRIDGE_CM2 ? ", or 80 ... 88 or 90" : "");
    return false;
}

#define LACKS(key, reason)                                                                                          \
    {key, "is given, but the axis has a channel of a bridge: " reason "; expected no such key"}
static const cm1e_absent_key_t absent[] = {
    LACKS("explicit_id", "it has no rotary switches"),
    LACKS("firmware", "its firmware makes no difference"),
    LACKS("mapping", "it has one mapping only"),
    LACKS("motion", "it makes no moves of its own"),
    LACKS("wire.velocity_unit", "no velocities go over the wire"),
    LACKS("wire.acceleration_unit", "no accelerations of a profile go over the wire"),
    LACKS("dc", "it takes its cycle from the process data (BR 6.3)"),
    {NULL, NULL},
};

static const cm1e_device_t *with_motors(const char *const motors[CM1E_BRIDGE_AXES])
{
    static const cm1e_device_t *const models[] = {&cm1e_device_eb01, &cm1e_device_eb02, &cm1e_device_eb12};
    cm1e_device_model_t model;
    return cm1e_bridge_model_with(motors, &model) ? models[model - CM1E_DEVICE_EB01] : NULL;
}

static const int64_t cycle_times_ns[] = {CM1E_BRIDGE_CYCLE_TIME_NS};

#define BRIDGE                                                                                                      \
    .kind = "bridge", .label = "Cool MUSCLE Bridge", .family = "bridge", .recognised = CM1E_BY_OBJECTS,             \
    .questions = questions, .question_count = COUNT(questions), .channels = CM1E_BRIDGE_AXES,                       \
    .described = true, .extra_is_error = true, .cycle_times_ns = cycle_times_ns, .cycle_time_count = 1,             \
    .object = object, .entry = entry, .pdos = pdos, .counts_per_revolution = counts_per_revolution,                 \
    .peak_velocity = peak_velocity, .motor = motor, .motors_note = ", which are behind a bridge", .absent = absent, \
    .check_axis = check_axis, .position_limit = position_limit, .with_motors = with_motors,                         \
    .models_note = "CM1 at all channels (EB01), CM2 at all (EB02), or CM1 at 1 and 2 and CM2 at 3 and 4 (EB12)"

const cm1e_device_t cm1e_device_eb01 = {
    BRIDGE, .name = "EB01", .model = CM1E_DEVICE_EB01, .drives = {&cm1_drive, &cm1_drive, &cm1_drive, &cm1_drive},
};
const cm1e_device_t cm1e_device_eb02 = {
    BRIDGE, .name = "EB02", .model = CM1E_DEVICE_EB02, .drives = {&cm2_drive, &cm2_drive, &cm2_drive, &cm2_drive},
};
const cm1e_device_t cm1e_device_eb12 = {
    BRIDGE, .name = "EB12", .model = CM1E_DEVICE_EB12, .drives = {&cm1_drive, &cm1_drive, &cm2_drive, &cm2_drive},
};
const cm1e_device_t cm1e_device_unknown_bridge = {BRIDGE};
