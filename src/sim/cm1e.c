#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/app_time.h"
#include "sim/cm1e_app.h"

enum {
    AL_CODE_UNSPECIFIED = 0x0001,
    ID_RESERVED = 0xFF,
};
enum { INIT = 1, PRE_OPERATIONAL = 2, BOOTSTRAP = 3, OPERATIONAL = 8 };
enum { ERROR_OVERLOAD = 0x2310, ERROR_OVER_SPEED = 0x7310, ERROR_POSITION = 0x7320 };

/* The limits of the supervision are not in the manual. */
#define OVER_SPEED_RATIO 1.1      /* of the motor's peak speed */
#define OVER_SPEED_TIME_S 0.002
#define LAG_LIMIT_COUNTS 50000.0  /* a revolution */
#define LAG_TIME_S 0.005
#define FOLLOWING_WINDOW_COUNTS 1000.0
#define STANDSTILL_COUNTS_PER_S 100.0
#define OVERLOAD_LIMIT_S 0.5      /* i2t: 0.9 s at peak torque */

/* ---- time ------------------------------------------------------------------------------------------------------- */

static double sum_while(bool condition, double sum, double step_s) { return condition ? sum + step_s : 0; }

static void supervise(cm1e_sim_cm1e_t *drive, double step_s)
{
    const double lag = fabs(drive->servo.reference - drive->mechanics.position);
    const double speed = fabs(drive->mechanics.velocity);
    const double torque = drive->servo.torque;
    cm1e_sim_watch_t *watch = &drive->watch;
    watch->following = lag <= FOLLOWING_WINDOW_COUNTS && !drive->servo.saturated;
    watch->lag_s = sum_while(lag > LAG_LIMIT_COUNTS, watch->lag_s, step_s);
    watch->overspeed_s = sum_while(speed > OVER_SPEED_RATIO * drive->motor->max_velocity_counts_per_s,
                                   watch->overspeed_s, step_s);
    watch->overload = fmax(0, watch->overload + step_s * (torque * torque * drive->overload_gain - 1));
    if (watch->overspeed_s > OVER_SPEED_TIME_S)
        cm1e_sim_fsa_error(drive, ERROR_OVER_SPEED);
    else if (watch->lag_s > LAG_TIME_S)
        cm1e_sim_fsa_error(drive, ERROR_POSITION);
    else if (watch->overload > OVERLOAD_LIMIT_S)
        cm1e_sim_fsa_error(drive, ERROR_OVERLOAD);
}

static void move(cm1e_sim_cm1e_t *drive, double step_s)
{
    if (drive->fsa.state != OPERATION_ENABLED) {
        if (!cm1e_mechanics_at_rest(&drive->mechanics))
            cm1e_mechanics_step(&drive->mechanics, 0, step_s);
        return;
    }
    drive->fsa.generator->step(drive, step_s);
    cm1e_mechanics_step(&drive->mechanics, cm1e_servo_step(&drive->servo, &drive->mechanics, step_s), step_s);
    supervise(drive, step_s);
}

static void step(cm1e_sim_cm1e_t *drive, double step_s)
{
    if (drive->fsa.deadline_ns <= drive->now_ns)
        cm1e_sim_fsa_deadline(drive);
    move(drive, step_s);
    const bool still = fabs(drive->mechanics.velocity) < STANDSTILL_COUNTS_PER_S;
    drive->watch.still_s = sum_while(still, drive->watch.still_s, step_s);
}

static void advance(void *app, int64_t now_ns)
{
    cm1e_sim_cm1e_t *drive = app;
    int64_t missed_ns;
    if (!cm1e_sim_time_passes(&drive->running, &drive->now_ns, now_ns, &missed_ns))
        return;
    for (double step_s; (step_s = cm1e_sim_time_step(&drive->now_ns, now_ns)) > 0;)
        step(drive, step_s);
}

static int64_t due(const void *app)
{
    const cm1e_sim_cm1e_t *drive = app;
    const bool rests = drive->fsa.state != OPERATION_ENABLED && cm1e_mechanics_at_rest(&drive->mechanics);
    return rests ? drive->fsa.deadline_ns : INT64_MIN;
}

/* ---- EtherCAT --------------------------------------------------------------------------------------------------- */

static uint16_t explicit_device_id(void *app)
{
    const cm1e_sim_cm1e_t *drive = app;
    return drive->rotary_switches == ID_RESERVED ? 0 : drive->rotary_switches; /* UG 4.2.3 */
}

static void station_alias(void *app, uint16_t alias) { ((cm1e_sim_cm1e_t *)app)->alias = alias; }

static uint16_t state_change(void *app, uint8_t from, uint8_t to)
{
    cm1e_sim_cm1e_t *drive = app;
    /* UG 4.2.4: with both kinds of identification set the device has an internal error. */
    if (from <= INIT && to == PRE_OPERATIONAL && drive->alias != 0 && explicit_device_id(drive) != 0)
        return AL_CODE_UNSPECIFIED;
    if (to == PRE_OPERATIONAL && drive->update.memory == FIRMWARE_BROKEN)
        return AL_CODE_NO_VALID_FIRMWARE;
    if (from == BOOTSTRAP)
        cm1e_sim_firmware_start(drive);
    drive->al_state = to;
    if (from == OPERATIONAL && to != OPERATIONAL)
        cm1e_sim_fsa_disable(drive);
    return 0;
}

static void watchdog_expired(void *app) { cm1e_sim_fsa_disable(app); }

/* ---- life ------------------------------------------------------------------------------------------------------- */

/* Until now the axis ran out without torque. The motor does not know its place: the position counts from 0. */
static void back_to_power_on(void *app, int64_t now_ns)
{
    cm1e_sim_cm1e_t *drive = app;
    cm1e_sim_fsa_off(drive);
    advance(drive, now_ns);
    cm1e_sim_period_forget(drive);
    drive->al_state = INIT;
    cm1e_sim_firmware_start(drive);
    drive->zero = 0;
    drive->zero = cm1e_sim_actual_counts(drive);
    drive->watch.overload = 0;
    cm1e_servo_catch(&drive->servo, &drive->mechanics);
    cm1e_sim_dictionary_reset(drive);
    cm1e_sim_assign_default(drive);
    cm1e_sim_homing_reset(drive);
    cm1e_sim_fsa_reset(drive);
}

/* Without a slave controller there is no bus to be absent from: a restart is over at once. */
static void outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    cm1e_sim_cm1e_t *drive = app;
    drive->restarts = false;
    cm1e_sim_outputs(drive, data, size, now_ns);
    if (drive->restarts && !drive->slave)
        back_to_power_on(drive, drive->now_ns);
}

static void destroy(void *app)
{
    cm1e_sim_cm1e_t *drive = app;
    cm1e_sim_store_destroy(&drive->store);
    free(drive);
}

/* The firmware is the one that the profile tells. */
static cm1e_error_t play(void *app, const cm1e_sim_profile_t *profile, int64_t now_ns, cm1e_diag_t *diag)
{
    cm1e_sim_cm1e_t *drive = app;
    cm1e_sim_store_t store = {0};
    const cm1e_firmware_info_t *firmware = NULL;
    for (size_t i = 0; i < profile->entry_count; i++)
        if (profile->entries[i].index == OBJ_100A_SOFTWARE_VERSION)
            firmware = cm1e_firmware_from_version(profile->entries[i].text);
    if (!firmware)
        firmware = drive->firmware;
    const cm1e_error_t error = cm1e_sim_store_create(&store, &cm1e_device_cm1e, firmware->firmware)
                                   ? cm1e_sim_store_play(&store, profile, diag)
                                   : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    if (error != CM1E_OK) {
        cm1e_sim_store_destroy(&store);
        return error;
    }
    cm1e_sim_store_destroy(&drive->store);
    drive->store = store;
    drive->firmware = firmware;
    back_to_power_on(drive, now_ns);
    return CM1E_OK;
}

#define COMMON_OPS                                                                                                  \
    .advance = advance, .due = due, .state_change = state_change,                                                   \
    .process_data_sizes = cm1e_sim_process_data_sizes, .outputs = outputs, .inputs = cm1e_sim_inputs,               \
    .sdo_read = cm1e_sim_sdo_read, .sdo_write = cm1e_sim_sdo_write, .object = cm1e_sim_object,                      \
    .entry = cm1e_sim_entry, .explicit_device_id = explicit_device_id, .station_alias = station_alias,              \
    .power_on = back_to_power_on,                                                                         \
    .file_begin = cm1e_sim_firmware_begin, .file_data = cm1e_sim_firmware_data, .destroy = destroy, .play = play

/* The watchdog came with V1.3.0 (UG 10.1): before it a drive goes on with the outputs that it had last. */
static const cm1e_sim_app_ops_t ops_without_watchdog = {COMMON_OPS};
static const cm1e_sim_app_ops_t ops_with_watchdog = {COMMON_OPS, .watchdog_expired = watchdog_expired};

const cm1e_sim_app_ops_t *cm1e_sim_cm1e_ops(const cm1e_sim_cm1e_t *drive)
{
    return drive->firmware->watchdog ? &ops_with_watchdog : &ops_without_watchdog;
}

cm1e_sim_cm1e_t *cm1e_sim_cm1e_create_app(const cm1e_axis_config_t *config, cm1e_pdo_order_t order, uint16_t alias,
                                          uint8_t rotary_switches)
{
    const cm1e_motor_t *motor = cm1e_device_motor(config->motor);
    const cm1e_firmware_info_t *firmware = config->firmware[0] ? cm1e_firmware_from_version(config->firmware)
                                                               : cm1e_firmware_info(CM1E_FIRMWARE_COUNT - 1);
    cm1e_sim_cm1e_t *drive = motor && firmware ? calloc(1, sizeof *drive) : NULL;
    if (!drive)
        return NULL;
    drive->motor = motor;
    drive->firmware = firmware;
    drive->config = *config;
    drive->order = order;
    drive->alias = alias;
    drive->rotary_switches = rotary_switches;
    drive->motor_power = true;
    cm1e_sim_sensors_init(&drive->sensors, &config->sim);
    if (!cm1e_sim_dictionary_create(drive)) {
        destroy(drive);
        return NULL;
    }
    cm1e_mechanics_init(&drive->mechanics, &config->sim, motor->peak_torque_nm * CM1E_ROTOR_INERTIA_PER_PEAK_TORQUE);
    cm1e_servo_init(&drive->servo, &drive->mechanics);
    back_to_power_on(drive, 0);
    drive->running = false; /* the first advance() tells the time */
    return drive;
}

size_t cm1e_sim_write_sii(uint8_t *sii, size_t room, const cm1e_sim_cm1e_t *drive)
{
    cm1e_device_options_t options = {.order = drive->order, .alias = drive->alias};
    cm1e_description_file_t file = {0};
    snprintf(options.firmware, sizeof options.firmware, "%s", drive->firmware->version);
    const size_t size = cm1e_describe(&file, &options, CM1E_ESI_FLAT, NULL) == CM1E_OK
                            ? cm1e_sii_write(sii, room, &file.devices.at[0], NULL)
                            : 0;
    cm1e_description_file_free(&file);
    return size;
}

cm1e_sim_slave_t *cm1e_sim_cm1e_create(const cm1e_axis_config_t *config, cm1e_pdo_order_t order, uint16_t alias,
                                       uint8_t rotary_switches)
{
    cm1e_sim_cm1e_t *drive = cm1e_sim_cm1e_create_app(config, order, alias, rotary_switches);
    if (!drive)
        return NULL;
    uint8_t sii[CM1E_SII_SIZE];
    const size_t size = cm1e_sim_write_sii(sii, sizeof sii, drive);
    cm1e_sim_slave_t *slave = size > 0 ? cm1e_sim_slave_create(sii, size, cm1e_sim_cm1e_ops(drive), drive) : NULL;
    if (slave)
        drive->slave = slave;
    else
        destroy(drive);
    return slave;
}

cm1e_sim_cm1e_t *cm1e_sim_cm1e_of(cm1e_sim_slave_t *slave)
{
    const cm1e_sim_app_ops_t *ops = slave ? cm1e_sim_slave_ops(slave) : NULL;
    return ops == &ops_with_watchdog || ops == &ops_without_watchdog ? cm1e_sim_slave_app(slave) : NULL;
}
