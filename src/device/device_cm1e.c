/* The CM1-E as a row of the device interface. Its dictionary, mappings, motors, errors and firmware have sources of
 * their own (objects.c, pdo.c, motors.c, errors.c, firmware.c). */
#include "device/device_rows.h"
#include "device/objects.h"

#include <stddef.h>

/* Sizes: UG 4.4 and UG 7.2 disagree on 0x6077 (16 or 32 bits), and CiA 402 has digital I/O in 32 bits. */
static const cm1e_device_object_t process_data[] = {
    PROCESS_DATA(OUT_CONTROLWORD, OBJ_6040_CONTROLWORD, 2, 2, MAPPED_ALL, "Controlword", ),
    PROCESS_DATA(OUT_POSITION, OBJ_607A_TARGET_POSITION, 4, 4, MAPPED_DYNAMIC | MAPPED_CSP | MAPPED_PROFILE,
     "Target position", ),
    PROCESS_DATA(OUT_VELOCITY, OBJ_60FF_TARGET_VELOCITY, 4, 4, MAPPED_DYNAMIC | MAPPED_CSV | MAPPED_PROFILE,
     "Target velocity", ),
    PROCESS_DATA(OUT_MODE, OBJ_6060_MODES_OF_OPERATION, 1, 1, MAPPED_DYNAMIC, "Modes of operation", ),
    PROCESS_DATA(OUT_DIGITAL, OBJ_60FE_DIGITAL_OUTPUTS, 2, 4, 0, "Digital outputs", ),
    PROCESS_DATA(OUT_PROFILE_VELOCITY, OBJ_6081_PROFILE_VELOCITY, 4, 4, 0, "Profile velocity", ),
    PROCESS_DATA(OUT_PROFILE_ACCELERATION, OBJ_6083_PROFILE_ACCELERATION, 4, 4, 0, "Profile acceleration", ),
    PROCESS_DATA(IN_STATUSWORD, OBJ_6041_STATUSWORD, 2, 2, MAPPED_ALL, "Statusword", ),
    PROCESS_DATA(IN_ERROR, OBJ_603F_ERROR_CODE, 2, 2, 0, "Error code", ),
    PROCESS_DATA(IN_POSITION, OBJ_6064_POSITION_ACTUAL_VALUE, 4, 4, MAPPED_ALL, "Position actual value", ),
    PROCESS_DATA(IN_VELOCITY, OBJ_606C_VELOCITY_ACTUAL_VALUE, 4, 4, 0, "Velocity actual value", ),
    PROCESS_DATA(IN_TORQUE, OBJ_6077_TORQUE_ACTUAL_VALUE, 2, 4, 0, "Torque actual value", ),
    PROCESS_DATA(IN_DIGITAL, OBJ_60FD_DIGITAL_INPUTS, 2, 4, 0, "Digital inputs", ),
    PROCESS_DATA(IN_TEMPERATURE, OBJ_2301_TEMPERATURE, 2, 4, 0, "Drive temperature", ),
    PROCESS_DATA(IN_DC_LINK, OBJ_6079_DC_LINK_VOLTAGE, 2, 4, 0, "DC link voltage", ),
    PROCESS_DATA(IN_MODE, OBJ_6061_MODES_OF_OPERATION_DISPLAY, 1, 1, MAPPED_DYNAMIC, "Modes of operation display", ),
};

/* UG 6.1.2, 6.1.3 */
static const cm1e_device_words_t words = {
    .states = cm1e_fsa_table, .voltage = STATUSWORD_VOLTAGE_ENABLED, .fault = STATUSWORD_FAULT,
    .warning = STATUSWORD_WARNING, .target_reached = STATUSWORD_TARGET_REACHED, .bit12 = STATUSWORD_BIT12,
    .bit13 = STATUSWORD_BIT13, .no_torque = 0x0006, .fault_reset = 0x0086,
};

/* UG 6.2; homing needs no special mapping (UG 6.2.4). */
static const cm1e_device_mode_t modes[] = {MODES_OF_CIA402(&words, 0)};

/* UG 6.2.4 */
static const cm1e_device_homing_t homing = {
    .first_method = -6, .last_method = -1, .first_by_switch = -6, .last_by_switch = -3,
    .positive_stop = -1, .negative_stop = -2, .halts = true, .place = "",
    .objects = {
        HOMING_OBJECTS_OF_CIA402,
        [CM1E_HOMING_TORQUE] = {OBJ_60F6_K_PARAMETERS, CM1E_K_PARAMETER_HOMING_TORQUE, 1.0, NULL},
    },
    .steps = {HOME_WRITE, HOME_SWITCH, HOME_START, HOME_RUN, HOME_SETTLE, HOME_RETURN},
};

static const cm1e_device_drive_t drive = {
    .name = "CM1-E", .short_name = "CM1-E", .place = "",
    .objects = process_data, .object_count = COUNT(process_data),
    .mappings = {
        [CM1E_MAPPING_DYNAMIC] = {"dynamic (0x1600/0x1A00)", CM1E_MODE_CSP},
        [CM1E_MAPPING_CSP] = {"CSP (0x1601/0x1A01)", CM1E_MODE_CSP},
        [CM1E_MAPPING_CSV] = {"CSV (0x1602/0x1A02)", CM1E_MODE_CSV},
        [CM1E_MAPPING_PROFILE] = {"profile (0x1603/0x1A03)", CM1E_MODE_CSP},
    },
    .modes = modes, .mode_count = COUNT(modes),
    .refusal = "Check the mapping and the firmware",
    .homing = &homing,
    .signals = {.inputs = 0x000F, .outputs = 0x0001},
    .error = cm1e_device_error, .error_clause = "UG 7.3.1",
};

static cm1e_pdo_choice_t pdos(const cm1e_axis_config_t *axis)
{
    const unsigned mapping = axis ? axis->mapping : CM1E_MAPPING_DYNAMIC;
    return (cm1e_pdo_choice_t){1, {{(uint16_t)(0x1600 + mapping)}, {(uint16_t)(0x1A00 + mapping)}}};
}

static double counts_per_revolution(const cm1e_axis_config_t *axis)
{
    (void)axis;
    return CM1E_COUNTS_PER_REVOLUTION;
}

static double peak_velocity(const cm1e_axis_config_t *axis)
{
    const cm1e_motor_t *motor = cm1e_device_motor(axis->motor);
    return motor ? motor->max_velocity_counts_per_s : 0.0;
}

static const char *motor(size_t n)
{
    return n < sizeof cm1e_device_motors / sizeof cm1e_device_motors[0] ? cm1e_device_motors[n].name : NULL;
}

static bool revision_known(uint32_t revision)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++)
        if (cm1e_firmware_info((cm1e_firmware_t)firmware)->revision == revision)
            return true;
    return false;
}

static bool same_entries(const cm1e_pdo_t *a, const cm1e_pdo_t *b)
{
    if (a->entry_count != b->entry_count)
        return false;
    for (unsigned i = 0; i < a->entry_count; i++)
        if (a->entries[i].index != b->entries[i].index || a->entries[i].subindex != b->entries[i].subindex ||
            a->entries[i].bits != b->entries[i].bits)
            return false;
    return true;
}

/* By the tables of some firmware, in one of the two orders of the guide. */
static bool pdo_known(const cm1e_pdo_t *pdo, bool transmit)
{
    enum { MAPPINGS = CM1E_MAPPING_PROFILE + 1, PDO_ORDERS = 2 };
    for (unsigned n = 0; n < MAPPINGS * CM1E_FIRMWARE_COUNT * PDO_ORDERS; n++) {
        cm1e_pdo_t known;
        cm1e_device_pdo(&known, (cm1e_mapping_t)(n % MAPPINGS), transmit,
                        (cm1e_pdo_order_t)(n / MAPPINGS % PDO_ORDERS), (cm1e_firmware_t)(n / MAPPINGS / PDO_ORDERS));
        if (known.index == pdo->index && same_entries(pdo, &known))
            return true;
    }
    return false;
}

static const cm1e_absent_key_t absent[] = {
    {"k37", "is given without a channel; expected only behind a bridge: a CM1-E has 50000 counts in a revolution"},
    {"dc", "is given, and a CM1-E takes its cycle from the process data (UG 4.3), not from SYNC0; distributed_clocks "
           "of the bus lets its frames arrive at a constant phase"},
    {NULL, NULL},
};

const cm1e_device_t cm1e_device_cm1e = {
    .kind = "cm1-e", .label = "CM1-E", .name = "CM1-E", .model = CM1E_DEVICE_CM1E,
    .recognised = CM1E_BY_IDENTITY, .vendor_id = CM1E_VENDOR_ID, .product_code = CM1E_PRODUCT_CODE,
    .explicit_id = true, .described = true, .extra_is_error = true,
    .cycle_times_ns = cm1e_device_cycle_times_ns, .cycle_time_count = 4,
    .firmware = cm1e_firmware_from_version,
    ONE_TABLE(cm1e_device_objects), .pdos = pdos,
    .counts_per_revolution = counts_per_revolution, .peak_velocity = peak_velocity,
    .revision_known = revision_known,
    .revisions = "0x20020001 and, from firmware V1.3.0 on, 0x20020103", .pdo_known = pdo_known,
    .motor = motor, .motors_note = " (CM1 and CM2 have a channel of a bridge)", .absent = absent,
    .drives = {&drive},
};
