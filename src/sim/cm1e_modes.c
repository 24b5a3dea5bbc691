#include <math.h>

#include "sim/cm1e_app.h"

#define DEFAULT_CYCLE_S 1e-3        /* until the cycle time is detected */
#define FOLLOWING_WINDOW 5000.0     /* counts; PP, statusword bit 13 */
#define POSITION_WINDOW 10.0        /* counts; target reached */
#define VELOCITY_WINDOW 500.0       /* counts/s; target reached */
#define REACHED_TIME_S 0.005        /* so long within it */

/* 0x607A on the scale of the mechanics. It has 32 bits and wraps: the nearest turn of the wheel is meant. */
static double target_position(const cm1e_sim_cm1e_t *drive)
{
    const int64_t actual = cm1e_sim_actual_counts(drive);
    const int32_t distance = (int32_t)((uint32_t)drive->objects.target_position - (uint32_t)actual);
    return (double)(drive->zero + actual + distance);
}

/* Kept in units of 1000 counts/s2, at least one (UG 6.2.2), whatever came over the process data. */
static double acceleration(const cm1e_sim_cm1e_t *drive, int32_t object)
{
    const double unit = drive->config.acceleration_in_kpulses ? 1 : 1000;
    const double thousands = floor((uint32_t)object / unit + 0.5);
    return fmin(fmax(thousands, 1), 32767) * 1000;
}

static double motor_limited(const cm1e_sim_cm1e_t *drive, double velocity)
{
    const double most = drive->motor->max_velocity_counts_per_s;
    return fmax(fmin(velocity, most), -most);
}

/* 0x60FF, counts/s; its greatest values are the motor's peak speeds (UG 6.2.6, 6.3). */
static double target_velocity(const cm1e_sim_cm1e_t *drive)
{
    return motor_limited(drive, (double)drive->objects.target_velocity * cm1e_sim_velocity_unit(drive));
}

static bool halt_bit(const cm1e_sim_cm1e_t *drive) { return (drive->objects.controlword & CONTROLWORD_HALT) != 0; }

/* ---- cyclic synchronous position -------------------------------------------------------------------------------- */

static void csp_enter(cm1e_sim_cm1e_t *drive)
{
    cm1e_sim_line_begin(&drive->motion.line, &drive->servo, target_position(drive));
}

static double cycle_s(const cm1e_sim_cm1e_t *drive)
{
    return drive->period.ns ? drive->period.ns * 1e-9 : DEFAULT_CYCLE_S;
}

static void csp_outputs(cm1e_sim_cm1e_t *drive, uint16_t rising_bits)
{
    (void)rising_bits;
    cm1e_sim_line_target(&drive->motion.line, target_position(drive), cycle_s(drive));
}

static void csp_step(cm1e_sim_cm1e_t *drive, double step_s)
{
    cm1e_sim_line_step(&drive->motion.line, &drive->servo, cycle_s(drive), step_s);
}

static uint16_t cyclic_status_bits(const cm1e_sim_cm1e_t *drive)
{
    return drive->firmware->following_bit && drive->watch.following ? STATUSWORD_BIT12 : 0;
}

/* ---- cyclic synchronous velocity -------------------------------------------------------------------------------- */

static void csv_outputs(cm1e_sim_cm1e_t *drive, uint16_t rising_bits)
{
    (void)rising_bits;
    drive->motion.goal_velocity = target_velocity(drive);
}

static void csv_enter(cm1e_sim_cm1e_t *drive)
{
    cm1e_servo_forget_distance(&drive->servo, &drive->mechanics);
    drive->servo.own_profile = false;
    csv_outputs(drive, 0);
}

static void csv_step(cm1e_sim_cm1e_t *drive, double step_s)
{
    drive->servo.reference_velocity = drive->motion.goal_velocity;
    cm1e_servo_run(&drive->servo, &drive->mechanics, step_s);
}

/* ---- profile velocity ------------------------------------------------------------------------------------------- */

static void pv_outputs(cm1e_sim_cm1e_t *drive, uint16_t rising_bits)
{
    (void)rising_bits;
    drive->motion.goal_velocity = target_velocity(drive);
    drive->motion.profile_acceleration = acceleration(drive, drive->objects.profile_acceleration);
    drive->motion.profile_deceleration = acceleration(drive, drive->objects.profile_deceleration);
}

static void pv_enter(cm1e_sim_cm1e_t *drive)
{
    cm1e_servo_forget_distance(&drive->servo, &drive->mechanics);
    drive->servo.own_profile = true;
    pv_outputs(drive, 0);
}

static bool at_velocity(const cm1e_sim_cm1e_t *drive, double wanted)
{
    return fabs(drive->mechanics.velocity - wanted) < VELOCITY_WINDOW;
}

/* "The deceleration value is only used when the target velocity is set to 0 or the halt bit is set" (UG 6.2.3). */
static void pv_step(cm1e_sim_cm1e_t *drive, double step_s)
{
    const double wanted = halt_bit(drive) ? 0 : drive->motion.goal_velocity;
    cm1e_sim_ramp(&drive->servo.reference_velocity, wanted,
                  wanted == 0 ? drive->motion.profile_deceleration : drive->motion.profile_acceleration, step_s);
    cm1e_servo_run(&drive->servo, &drive->mechanics, step_s);
    drive->motion.reached_s = at_velocity(drive, wanted) ? drive->motion.reached_s + step_s : 0;
    cm1e_servo_rest(&drive->servo, &drive->mechanics);
}

static uint16_t pv_status_bits(const cm1e_sim_cm1e_t *drive)
{
    const double wanted = drive->fsa.state == OPERATION_ENABLED && !halt_bit(drive) ? drive->motion.goal_velocity : 0;
    const bool stands = cm1e_sim_stands(drive);
    const bool reached = wanted == 0 ? stands : at_velocity(drive, wanted) && drive->motion.reached_s >= REACHED_TIME_S;
    return (uint16_t)((reached ? STATUSWORD_TARGET_REACHED : 0) | (stands ? STATUSWORD_BIT12 : 0));
}

/* ---- profile position ------------------------------------------------------------------------------------------- */

/* Before the first set-point, the target is its place, or the place where it can stop. */
static void pp_enter(cm1e_sim_cm1e_t *drive)
{
    cm1e_servo_t *servo = &drive->servo;
    servo->own_profile = true;
    drive->motion.profile_acceleration = acceleration(drive, drive->objects.profile_acceleration);
    drive->motion.profile_velocity = fabs(servo->reference_velocity);
    drive->motion.goal = cm1e_sim_stopping_place(servo, drive->motion.profile_acceleration);
    drive->motion.set_point_acknowledge = false;
}

/* Always absolute, immediate, single set-point (UG 6.2.2). */
static void pp_outputs(cm1e_sim_cm1e_t *drive, uint16_t rising_bits)
{
    if (rising_bits & CONTROLWORD_NEW_SET_POINT) {
        drive->motion.goal = target_position(drive);
        drive->motion.profile_velocity = motor_limited(drive, (uint32_t)drive->objects.profile_velocity);
        drive->motion.profile_acceleration = acceleration(drive, drive->objects.profile_acceleration);
        drive->motion.set_point_acknowledge = true;
    } else if (!(drive->objects.controlword & CONTROLWORD_NEW_SET_POINT)) {
        drive->motion.set_point_acknowledge = false;
    }
}

static void pp_step(cm1e_sim_cm1e_t *drive, double step_s)
{
    const cm1e_sim_motion_t *m = &drive->motion;
    cm1e_servo_t *servo = &drive->servo;
    if (halt_bit(drive))
        cm1e_sim_halt_step(servo, m->profile_acceleration, step_s);
    else
        cm1e_sim_move_step(servo, m->goal, m->profile_velocity, m->profile_acceleration, step_s);
}

static bool pp_target_reached(const cm1e_sim_cm1e_t *drive)
{
    if (drive->fsa.state != OPERATION_ENABLED)
        return false;
    if (halt_bit(drive))
        return cm1e_sim_stands(drive);
    return drive->servo.reference == drive->motion.goal && drive->servo.reference_velocity == 0 &&
           fabs(drive->motion.goal - drive->mechanics.position) <= POSITION_WINDOW;
}

static uint16_t pp_status_bits(const cm1e_sim_cm1e_t *drive)
{
    const bool enabled = drive->fsa.state == OPERATION_ENABLED;
    const double lag = fabs(drive->servo.reference - drive->mechanics.position);
    return (uint16_t)((pp_target_reached(drive) ? STATUSWORD_TARGET_REACHED : 0) |
                      (enabled && drive->motion.set_point_acknowledge ? STATUSWORD_SET_POINT_ACKNOWLEDGE : 0) |
                      (enabled && lag > FOLLOWING_WINDOW ? STATUSWORD_FOLLOWING_ERROR : 0));
}

const cm1e_sim_mode_t *cm1e_sim_mode(int8_t mode)
{
    static const cm1e_sim_mode_t modes[] = {
        {CM1E_MODE_PP, pp_enter, pp_outputs, pp_step, pp_status_bits},
        {CM1E_MODE_PV, pv_enter, pv_outputs, pv_step, pv_status_bits},
        {CM1E_MODE_CSP, csp_enter, csp_outputs, csp_step, cyclic_status_bits},
        {CM1E_MODE_CSV, csv_enter, csv_outputs, csv_step, cyclic_status_bits},
    };
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++)
        if (modes[i].mode == mode)
            return &modes[i];
    return mode == CM1E_MODE_HM ? &cm1e_sim_homing_mode : NULL;
}
