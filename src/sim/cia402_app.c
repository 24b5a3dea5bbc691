#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/app_time.h"
#include "sim/cia402_app.h"

enum { INIT = 1, OPERATIONAL = 8, DIRECTIONS = 2 };
enum { ERROR_FOLLOWING = 0x8611 };
enum { QUICK_STOP_STAYS = 5 }; /* 0x605A: from this code on the drive stays in Quick stop active */
#define LAG_TIME_S 0.01
#define STANDSTILL_COUNTS_PER_S 100.0
#define STANDSTILL_TIME_S 0.005
#define PEAK_TORQUE_NM 1.2
#define RATED_TORQUE_NM 0.4

/* ---- dictionary -------------------------------------------------------------------------------------------------- */

#define VALUE(index, subindex, member) {index, subindex, offsetof(cm1e_sim_cia402_values_t, member)}
static const struct {
    uint16_t index;
    uint8_t subindex;
    size_t offset;
} values[] = {
    VALUE(OBJ_1001_ERROR_REGISTER, 0, error_register),
    VALUE(OBJ_1C12_RXPDO_ASSIGN, 0, assigned[0]),
    VALUE(OBJ_1C13_TXPDO_ASSIGN, 0, assigned[1]),
    VALUE(OBJ_1C12_RXPDO_ASSIGN, 1, pdo[0]),
    VALUE(OBJ_1C13_TXPDO_ASSIGN, 1, pdo[1]),
    VALUE(OBJ_603F_ERROR_CODE, 0, error_code),
    VALUE(OBJ_6040_CONTROLWORD, 0, controlword),
    VALUE(OBJ_6041_STATUSWORD, 0, statusword),
    VALUE(OBJ_605A_QUICK_STOP_OPTION, 0, quick_stop_option),
    VALUE(OBJ_6060_MODES_OF_OPERATION, 0, mode),
    VALUE(OBJ_6061_MODES_OF_OPERATION_DISPLAY, 0, mode_display),
    VALUE(OBJ_6064_POSITION_ACTUAL_VALUE, 0, position),
    VALUE(OBJ_6065_FOLLOWING_ERROR_WINDOW, 0, following_window),
    VALUE(OBJ_606C_VELOCITY_ACTUAL_VALUE, 0, velocity),
    VALUE(OBJ_6077_TORQUE_ACTUAL_VALUE, 0, torque),
    VALUE(OBJ_607A_TARGET_POSITION, 0, target_position),
    VALUE(OBJ_607C_HOME_OFFSET, 0, home_offset),
    VALUE(OBJ_6081_PROFILE_VELOCITY, 0, profile_velocity),
    VALUE(OBJ_6083_PROFILE_ACCELERATION, 0, profile_acceleration),
    VALUE(OBJ_6084_PROFILE_DECELERATION, 0, profile_deceleration),
    VALUE(OBJ_6085_QUICK_STOP_DECELERATION, 0, quick_stop_deceleration),
    VALUE(OBJ_6098_HOMING_METHOD, 0, homing_method),
    VALUE(OBJ_6099_HOMING_SPEEDS, 1, homing_speed),
    VALUE(OBJ_6099_HOMING_SPEEDS, 2, homing_speed_zero),
    VALUE(OBJ_609A_HOMING_ACCELERATION, 0, homing_acceleration),
    VALUE(OBJ_60B8_TOUCH_PROBE_FUNCTION, 0, probe_function),
    VALUE(OBJ_60B9_TOUCH_PROBE_STATUS, 0, probe_status),
    VALUE(OBJ_60BA_TOUCH_PROBE_1_POSITIVE, 0, probe_positions[0]),
    VALUE(OBJ_60BB_TOUCH_PROBE_1_NEGATIVE, 0, probe_positions[1]),
    VALUE(OBJ_60BC_TOUCH_PROBE_2_POSITIVE, 0, probe_positions[2]),
    VALUE(OBJ_60BD_TOUCH_PROBE_2_NEGATIVE, 0, probe_positions[3]),
    VALUE(OBJ_60C2_INTERPOLATION_TIME, 1, interpolation_value),
    VALUE(OBJ_60C2_INTERPOLATION_TIME, 2, interpolation_index),
    VALUE(OBJ_60FD_DIGITAL_INPUTS, 0, inputs),
    VALUE(OBJ_60FE_DIGITAL_OUTPUTS, 1, outputs),
    VALUE(OBJ_60FF_TARGET_VELOCITY, 0, target_velocity),
};
enum { VALUES = sizeof values / sizeof values[0] };

static int64_t **place_of(cm1e_sim_cia402_t *drive, size_t n)
{
    return (int64_t **)(void *)((char *)&drive->v + values[n].offset);
}

static void find_places(cm1e_sim_cia402_t *drive)
{
    for (size_t n = 0; n < VALUES; n++) {
        cm1e_sim_cell_t cell;
        cm1e_sim_store_find(&drive->store, values[n].index, values[n].subindex, &cell);
        *place_of(drive, n) = cell.value;
    }
}

static bool create_dictionary(cm1e_sim_cia402_t *drive)
{
    if (!cm1e_sim_store_create(&drive->store, &cm1e_device_cia402, CM1E_FIRMWARE_1_2_0))
        return false;
    find_places(drive);
    return true;
}

/** Those of the tables, or of the profile that is played. */
static void set_defaults(cm1e_sim_cia402_t *drive)
{
    for (size_t n = 0; n < VALUES; n++) {
        cm1e_sim_cell_t cell;
        cm1e_sim_store_find(&drive->store, values[n].index, values[n].subindex, &cell);
        *cell.value = cell.entry->default_value;
    }
    cm1e_sim_store_set_profile_values(&drive->store);
}

/** A number of a mapping object; 0: the drive has no such entry. */
static uint32_t mapped(const cm1e_sim_cia402_t *drive, uint16_t index, uint8_t subindex)
{
    cm1e_sim_cell_t cell;
    return cm1e_sim_store_find(&drive->store, index, subindex, &cell) == 0 ? (uint32_t)*cell.value : 0;
}

/** A word of a mapping object: index, sub-index, bits. What the drive does not have, or has in more than 32 bits, is a
 *  gap. */
static cm1e_sim_cia402_slot_t slot_of(const cm1e_sim_cia402_t *drive, uint32_t word)
{
    cm1e_sim_cia402_slot_t slot = {.bytes = (uint8_t)((word & 0xFF) / 8)};
    cm1e_sim_cell_t cell;
    const bool known = word >> 16 &&
                       cm1e_sim_store_find(&drive->store, (uint16_t)(word >> 16), (uint8_t)(word >> 8), &cell) == 0;
    if (known && slot.bytes >= 1 && slot.bytes <= 4) {
        slot.value = cell.value;
        slot.is_signed = cm1e_sim_is_signed(cell.entry->type);
    }
    return slot;
}

/* Resolves the objects of the assigned PDO once, so that the cycle need not search. */
static void resolve(cm1e_sim_cia402_t *drive, int direction)
{
    cm1e_sim_cia402_image_t *image = &drive->images[direction];
    const uint16_t pdo = *drive->v.assigned[direction] ? (uint16_t)*drive->v.pdo[direction] : 0;
    const uint32_t count = mapped(drive, pdo, 0);
    *image = (cm1e_sim_cia402_image_t){.slot_count = (uint8_t)(count < CM1E_PDO_MAX_ENTRIES ? count
                                                                                            : CM1E_PDO_MAX_ENTRIES)};
    for (uint8_t i = 0; i < image->slot_count; i++) {
        image->slots[i] = slot_of(drive, mapped(drive, pdo, (uint8_t)(i + 1)));
        image->bytes = (uint16_t)(image->bytes + image->slots[i].bytes);
    }
}

static const cm1e_object_t *object(void *app, size_t n)
{
    return cm1e_sim_store_object(&((const cm1e_sim_cia402_t *)app)->store, n);
}

static const cm1e_entry_t *entry(void *app, uint16_t index, uint8_t subindex)
{
    cm1e_sim_cell_t cell;
    cm1e_sim_store_find(&((const cm1e_sim_cia402_t *)app)->store, index, subindex, &cell);
    return cell.entry;
}

static uint32_t sdo_read(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data, size_t *size)
{
    (void)al_state;
    cm1e_sim_cia402_t *drive = app;
    cm1e_sim_cell_t cell;
    const uint32_t missing = cm1e_sim_store_find_readable(&drive->store, index, subindex, &cell);
    if (missing)
        return missing;
    if (cell.entry->type == CM1E_TYPE_STRING)
        return cm1e_sim_give_text(cell.entry->default_string, data, size);
    cm1e_sim_cia402_refresh(drive);
    return cm1e_sim_give_number(cell.entry, *cell.value, data, size);
}

static uint32_t assign_write(cm1e_sim_cia402_t *drive, int direction, uint8_t subindex, int64_t value)
{
    if (subindex == 0)
        *drive->v.assigned[direction] = value;
    else if (*drive->v.assigned[direction])
        return SDO_ABORT_SUBINDEX_0_NOT_ZERO;
    else
        *drive->v.pdo[direction] = value;
    resolve(drive, direction);
    return 0;
}

static uint32_t sdo_write(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                          size_t size)
{
    cm1e_sim_cia402_t *drive = app;
    cm1e_sim_cell_t cell;
    uint32_t code = cm1e_sim_store_find(&drive->store, index, subindex, &cell);
    if (code == 0)
        code = cm1e_sim_check_write(cell.entry, al_state, size);
    if (code)
        return code;
    const int64_t value = cm1e_sim_take_number(cell.entry, data);
    code = cm1e_sim_check_range(cell.entry, value);
    if (code)
        return code;
    if (index == OBJ_6060_MODES_OF_OPERATION && value != 0 && !cm1e_sim_cia402_mode((int8_t)value))
        return SDO_ABORT_RANGE;
    if (index == OBJ_1C12_RXPDO_ASSIGN || index == OBJ_1C13_TXPDO_ASSIGN)
        return assign_write(drive, index == OBJ_1C13_TXPDO_ASSIGN, subindex, value);
    *cell.value = value;
    if (index == OBJ_6060_MODES_OF_OPERATION)
        cm1e_sim_cia402_command(drive);
    return 0;
}

/* ---- process data ------------------------------------------------------------------------------------------------ */

static void process_data_sizes(void *app, uint16_t *output_bytes, uint16_t *input_bytes)
{
    const cm1e_sim_cia402_t *drive = app;
    *output_bytes = drive->images[0].bytes;
    *input_bytes = drive->images[1].bytes;
}

static void outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    (void)now_ns;
    cm1e_sim_cia402_t *drive = app;
    const cm1e_sim_cia402_image_t *image = &drive->images[0];
    for (uint8_t i = 0; i < image->slot_count && size >= image->bytes; i++) {
        const cm1e_sim_cia402_slot_t *slot = &image->slots[i];
        if (slot->value) {
            /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): a slot has 1 byte or more */
            const uint64_t raw = cm1e_get_uint(data, slot->bytes), sign = UINT64_C(1) << (8 * slot->bytes - 1);
            *slot->value = slot->is_signed ? (int64_t)(raw ^ sign) - (int64_t)sign : (int64_t)raw;
        }
        data += slot->bytes;
    }
    cm1e_sim_cia402_command(drive);
}

static void inputs(void *app, uint8_t *data, uint16_t size)
{
    cm1e_sim_cia402_t *drive = app;
    const cm1e_sim_cia402_image_t *image = &drive->images[1];
    cm1e_sim_cia402_refresh(drive);
    for (uint8_t i = 0; i < image->slot_count && size >= image->bytes; i++) {
        const cm1e_sim_cia402_slot_t *slot = &image->slots[i];
        if (slot->value)
            cm1e_put_uint(data, slot->bytes, (uint32_t)*slot->value);
        else
            memset(data, 0, slot->bytes);
        data += slot->bytes;
    }
}

uint32_t cm1e_sim_cia402_inputs(const cm1e_sim_cia402_t *drive)
{
    return cm1e_sim_sensors_inputs(&drive->sensors, drive->mechanics.position);
}

void cm1e_sim_cia402_refresh(cm1e_sim_cia402_t *drive)
{
    const cm1e_mechanics_t *shaft = &drive->mechanics;
    const int64_t position = (int64_t)floor(shaft->position * drive->scale + 0.5) - drive->zero;
    *drive->v.position = (int32_t)(uint32_t)position;
    *drive->v.velocity = (int32_t)lround(shaft->velocity * drive->scale);
    *drive->v.torque = (int16_t)lround(drive->servo.torque * 1000 / RATED_TORQUE_NM);
    *drive->v.inputs = cm1e_sim_cia402_inputs(drive);
    *drive->v.statusword = cm1e_sim_cia402_statusword(drive);
}

/* ---- time -------------------------------------------------------------------------------------------------------- */

bool cm1e_sim_cia402_stands(const cm1e_sim_cia402_t *drive)
{
    return drive->servo.reference_velocity == 0 && drive->still_s >= STANDSTILL_TIME_S;
}

static void supervise(cm1e_sim_cia402_t *drive, double step_s)
{
    const double lag = fabs(drive->servo.reference - drive->mechanics.position) * drive->scale;
    drive->lag_s = lag > (double)*drive->v.following_window ? drive->lag_s + step_s : 0;
    if (drive->lag_s > LAG_TIME_S)
        cm1e_sim_cia402_fault(drive, ERROR_FOLLOWING);
}

static void move(cm1e_sim_cia402_t *drive, double step_s)
{
    double torque = 0;
    if (drive->state == OPERATION_ENABLED)
        drive->generator->step(drive, step_s);
    else if (drive->state == QUICK_STOP_ACTIVE && cm1e_sim_cia402_brake(drive, step_s) &&
             cm1e_sim_cia402_stands(drive) && *drive->v.quick_stop_option < QUICK_STOP_STAYS)
        cm1e_sim_cia402_disable(drive);
    if (drive->state == OPERATION_ENABLED || drive->state == QUICK_STOP_ACTIVE) {
        torque = cm1e_servo_step(&drive->servo, &drive->mechanics, step_s);
        supervise(drive, step_s);
    }
    if (torque != 0 || !cm1e_mechanics_at_rest(&drive->mechanics))
        cm1e_mechanics_step(&drive->mechanics, torque, step_s);
}

static void step(cm1e_sim_cia402_t *drive, double step_s)
{
    if (drive->state_deadline_ns <= drive->now_ns)
        cm1e_sim_cia402_deadline(drive);
    move(drive, step_s);
    drive->still_s = fabs(drive->mechanics.velocity) < STANDSTILL_COUNTS_PER_S ? drive->still_s + step_s : 0;
    cm1e_sim_cia402_probe_step(drive);
}

static void advance(void *app, int64_t now_ns)
{
    cm1e_sim_cia402_t *drive = app;
    int64_t missed_ns;
    if (!cm1e_sim_time_passes(&drive->running, &drive->now_ns, now_ns, &missed_ns))
        return;
    drive->state_deadline_ns += drive->state_deadline_ns == INT64_MAX ? 0 : missed_ns;
    for (double step_s; (step_s = cm1e_sim_time_step(&drive->now_ns, now_ns)) > 0;)
        step(drive, step_s);
}

static int64_t due(const void *app)
{
    const cm1e_sim_cia402_t *drive = app;
    const bool torque = drive->state == OPERATION_ENABLED || drive->state == QUICK_STOP_ACTIVE;
    return torque || !cm1e_mechanics_at_rest(&drive->mechanics) ? INT64_MIN : drive->state_deadline_ns;
}

/* ---- life -------------------------------------------------------------------------------------------------------- */

static uint16_t state_change(void *app, uint8_t from, uint8_t to)
{
    cm1e_sim_cia402_t *drive = app;
    drive->al_state = to;
    if (from == OPERATIONAL && to != OPERATIONAL)
        cm1e_sim_cia402_disable(drive);
    return 0;
}

static void watchdog_expired(void *app) { cm1e_sim_cia402_disable(app); }

static uint16_t explicit_device_id(void *app)
{
    (void)app;
    return 0;
}

/* The position counts from the place of the motor. */
static void power_on(void *app, int64_t now_ns)
{
    cm1e_sim_cia402_t *drive = app;
    advance(drive, now_ns);
    drive->al_state = INIT;
    drive->zero = (int64_t)floor(drive->mechanics.position * drive->scale + 0.5);
    drive->homing = (cm1e_sim_cia402_homing_t){0};
    cm1e_servo_catch(&drive->servo, &drive->mechanics);
    drive->servo.torque_limit = PEAK_TORQUE_NM;
    set_defaults(drive);
    for (int direction = 0; direction < DIRECTIONS; direction++)
        resolve(drive, direction);
    cm1e_sim_cia402_reset(drive);
}

static void destroy(void *app)
{
    cm1e_sim_cia402_t *drive = app;
    cm1e_sim_store_destroy(&drive->store);
    free(drive);
}

static uint32_t file_begin(void *app, const char *name, uint32_t password)
{
    (void)password; /* it has none */
    return cm1e_sim_files_begin(&((cm1e_sim_cia402_t *)app)->files, name);
}

static uint32_t file_data(void *app, size_t offset, const uint8_t *data, size_t size, bool last)
{
    return cm1e_sim_files_data(&((cm1e_sim_cia402_t *)app)->files, offset, data, size, last);
}

static uint32_t file_read(void *app, const char *name, uint32_t password, size_t offset, uint8_t *data, size_t *size)
{
    (void)password;
    return cm1e_sim_files_read(&((cm1e_sim_cia402_t *)app)->files, name, offset, data, size);
}

static cm1e_error_t play(void *app, const cm1e_sim_profile_t *profile, int64_t now_ns, cm1e_diag_t *diag)
{
    cm1e_sim_cia402_t *drive = app;
    const cm1e_error_t error = cm1e_sim_store_play(&drive->store, profile, diag);
    if (error != CM1E_OK)
        return error;
    find_places(drive);
    power_on(drive, now_ns);
    return CM1E_OK;
}

static const cm1e_sim_app_ops_t ops = {
    .advance = advance, .due = due, .state_change = state_change, .process_data_sizes = process_data_sizes,
    .outputs = outputs, .inputs = inputs, .watchdog_expired = watchdog_expired, .sdo_read = sdo_read,
    .sdo_write = sdo_write, .object = object, .entry = entry, .explicit_device_id = explicit_device_id,
    .file_begin = file_begin, .file_data = file_data, .file_read = file_read, .files_in_operation = true,
    .power_on = power_on, .destroy = destroy, .play = play, .runs_by_sync0 = true,
};

cm1e_sim_cia402_t *cm1e_sim_cia402_of(cm1e_sim_slave_t *slave)
{
    return slave && cm1e_sim_slave_ops(slave) == &ops ? cm1e_sim_slave_app(slave) : NULL;
}

static cm1e_sim_cia402_t *create_app(const cm1e_axis_config_t *config)
{
    cm1e_sim_cia402_t *drive = calloc(1, sizeof *drive);
    if (!drive)
        return NULL;
    drive->counts_per_revolution = cm1e_device_cia402.counts_per_revolution(config);
    drive->peak_velocity = cm1e_device_cia402.peak_velocity(config);
    drive->scale = drive->counts_per_revolution / CM1E_COUNTS_PER_REVOLUTION;
    drive->motor_power = true;
    drive->state_deadline_ns = INT64_MAX;
    cm1e_sim_sensors_init(&drive->sensors, &config->sim);
    if (!create_dictionary(drive)) {
        destroy(drive);
        return NULL;
    }
    cm1e_mechanics_init(&drive->mechanics, &config->sim, PEAK_TORQUE_NM * CM1E_ROTOR_INERTIA_PER_PEAK_TORQUE);
    cm1e_servo_init(&drive->servo, &drive->mechanics);
    power_on(drive, 0);
    drive->running = false; /* the first advance() tells the time */
    return drive;
}

cm1e_sim_slave_t *cm1e_sim_cia402_create(const cm1e_axis_config_t *config, uint16_t alias)
{
    uint8_t sii[CM1E_SII_SIZE];
    const cm1e_device_options_t options = {.model = CM1E_DEVICE_CIA402, .alias = alias};
    cm1e_description_file_t file = {0};
    const size_t size = cm1e_describe(&file, &options, CM1E_ESI_FLAT, NULL) == CM1E_OK
                            ? cm1e_sii_write(sii, sizeof sii, &file.devices.at[0], NULL)
                            : 0;
    cm1e_description_file_free(&file);
    cm1e_sim_cia402_t *drive = size > 0 ? create_app(config) : NULL;
    cm1e_sim_slave_t *slave = drive ? cm1e_sim_slave_create(sii, size, &ops, drive) : NULL;
    if (slave)
        drive->slave = slave;
    else if (drive)
        destroy(drive);
    return slave;
}
