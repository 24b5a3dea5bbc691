#include <math.h>

#include "sim/cm1e_app.h"

#define ENCODER_TOOTH_COUNTS 1000.0 /* 50 teeth a revolution */
#define ENCODER_TOOTH_PHASE 500.0   /* where the teeth lie on the scale of the mechanics */
#define STALL_VELOCITY 200.0        /* counts/s; slower than this at the torque limit is no motion */
#define STALL_TIME_S 0.03           /* so long at the torque limit means a hard stop */
#define IN_POSITION 0.3             /* counts */
#define SETTLED_VELOCITY 20.0       /* counts/s */
#define SETTLE_TIME_S 0.5           /* a move ends after this, in position or not */
#define STANDSTILL_WINDOW 100.0     /* counts/s */
enum { INPUT_2 = 0x0002, INPUT_3 = 0x0004 };

/* UG 6.2.4 */
static const struct {
    int8_t method, direction;
    uint8_t input;
} methods[] = {
    {-1, +1, 0}, {-2, -1, 0}, {-3, +1, INPUT_2}, {-4, -1, INPUT_2}, {-5, +1, INPUT_3}, {-6, -1, INPUT_3},
};
enum { METHOD_COUNT = sizeof methods / sizeof methods[0] };

static bool beyond(double position, double edge) { return edge < 0 ? position <= edge : position >= edge; }

uint16_t cm1e_sim_digital_inputs(const cm1e_sim_cm1e_t *drive)
{
    unsigned inputs = 0;
    if (!drive->config.sim.no_sensors) {
        const double position = drive->mechanics.position;
        inputs = (beyond(position, drive->sensor_edge[0]) ? INPUT_2 : 0u) |
                 (beyond(position, drive->sensor_edge[1]) ? INPUT_3 : 0u);
    }
    return (uint16_t)((inputs & ~(unsigned)drive->forced_inputs) | drive->forced_values);
}

static bool sensor(const cm1e_sim_cm1e_t *drive)
{
    return (cm1e_sim_digital_inputs(drive) & drive->homing.input) != 0;
}

bool cm1e_sim_homing_running(const cm1e_sim_cm1e_t *drive)
{
    return drive->homing.phase != HOMING_IDLE && drive->homing.phase != HOMING_DONE;
}

void cm1e_sim_homing_reset(cm1e_sim_cm1e_t *drive) { drive->homing = (cm1e_sim_homing_t){0}; }

void cm1e_sim_homing_abort(cm1e_sim_cm1e_t *drive)
{
    drive->homing.halted = drive->homing.abandoned = false;
    if (cm1e_sim_homing_running(drive))
        drive->homing.phase = HOMING_IDLE;
}

/* ---- the phases: each moves the reference and returns the next -------------------------------------------------- */

static void run(cm1e_sim_cm1e_t *drive, double velocity, double step_s)
{
    cm1e_servo_t *servo = &drive->servo;
    cm1e_sim_ramp(&servo->reference_velocity, velocity, drive->homing.acceleration, step_s);
    servo->reference += servo->reference_velocity * step_s;
}

/* "If the sensor is detected when the home routine is first initiated the motor will move off the sensor first in the
 * opposite direction." */
static cm1e_sim_homing_phase_t leave_sensor(cm1e_sim_cm1e_t *drive, double step_s)
{
    if (!sensor(drive))
        return HOMING_TURN_ROUND;
    run(drive, -drive->homing.direction * drive->homing.speed, step_s);
    return HOMING_LEAVE_SENSOR;
}

static cm1e_sim_homing_phase_t turn_round(cm1e_sim_cm1e_t *drive, double step_s)
{
    run(drive, 0, step_s);
    return drive->servo.reference_velocity == 0 ? HOMING_SEARCH_SENSOR : HOMING_TURN_ROUND;
}

/* "The driver interrupt captures the motor position": exactly where the sensor switched, not where the step ended. */
static double captured_position(const cm1e_sim_cm1e_t *drive, double step_s)
{
    const double position = drive->mechanics.position;
    if (drive->forced_inputs & drive->homing.input)
        return position;
    const double edge = drive->sensor_edge[drive->homing.input == INPUT_2 ? 0 : 1];
    return fabs(position - edge) <= fabs(drive->mechanics.velocity) * 2 * step_s + 1 ? edge : position;
}

static cm1e_sim_homing_phase_t search_sensor(cm1e_sim_cm1e_t *drive, double step_s)
{
    if (sensor(drive)) {
        drive->homing.target = floor(captured_position(drive, step_s) + 0.5);
        return HOMING_APPROACH;
    }
    run(drive, drive->homing.direction * drive->homing.speed, step_s);
    return HOMING_SEARCH_SENSOR;
}

/* "Moves back 2 teeth of the encoder gear to set the absolute position." */
static double second_previous_tooth(double position, int8_t direction)
{
    const double tooth = (position - ENCODER_TOOTH_PHASE) / ENCODER_TOOTH_COUNTS;
    const double previous = direction > 0 ? floor(tooth) : ceil(tooth);
    return (previous - direction) * ENCODER_TOOTH_COUNTS + ENCODER_TOOTH_PHASE;
}

static cm1e_sim_homing_phase_t search_stop(cm1e_sim_cm1e_t *drive, double step_s)
{
    cm1e_sim_homing_t *homing = &drive->homing;
    const bool stalled = drive->servo.saturated && fabs(drive->mechanics.velocity) < STALL_VELOCITY;
    homing->stalled_s = stalled ? homing->stalled_s + step_s : 0;
    if (homing->stalled_s < STALL_TIME_S) {
        run(drive, homing->direction * homing->speed, step_s);
        return HOMING_SEARCH_STOP;
    }
    homing->stalled_s = 0;
    cm1e_servo_catch(&drive->servo, &drive->mechanics);
    homing->target = second_previous_tooth(drive->mechanics.position, homing->direction);
    return HOMING_APPROACH;
}

/* TRUE: there, and standing; this place is 0 now, to the count. */
static bool move(cm1e_sim_cm1e_t *drive, double step_s)
{
    cm1e_sim_homing_t *homing = &drive->homing;
    if (!cm1e_sim_move_step(&drive->servo, homing->target, homing->speed, homing->acceleration, step_s)) {
        homing->stalled_s = 0;
        return false;
    }
    homing->stalled_s += step_s;
    const bool there = fabs(homing->target - drive->mechanics.position) < IN_POSITION &&
                       fabs(drive->mechanics.velocity) < SETTLED_VELOCITY;
    if (!there && homing->stalled_s < SETTLE_TIME_S)
        return false;
    homing->stalled_s = 0;
    drive->zero += cm1e_sim_actual_counts(drive);
    drive->servo.reference = homing->target = (double)drive->zero;
    return true;
}

static cm1e_sim_homing_phase_t finish(cm1e_sim_cm1e_t *drive)
{
    drive->servo.torque_limit = drive->motor->peak_torque_nm;
    return HOMING_DONE;
}

static cm1e_sim_homing_phase_t approach(cm1e_sim_cm1e_t *drive, double step_s)
{
    if (!move(drive, step_s))
        return HOMING_APPROACH;
    if (drive->objects.home_offset == 0)
        return finish(drive);
    drive->homing.target += drive->objects.home_offset;
    return HOMING_OFFSET;
}

static cm1e_sim_homing_phase_t offset(cm1e_sim_cm1e_t *drive, double step_s)
{
    return move(drive, step_s) ? finish(drive) : HOMING_OFFSET;
}

static cm1e_sim_homing_phase_t stand(cm1e_sim_cm1e_t *drive, double step_s)
{
    run(drive, 0, step_s);
    return drive->homing.phase;
}

/* ---- the mode --------------------------------------------------------------------------------------------------- */

static void homing_step(cm1e_sim_cm1e_t *drive, double step_s)
{
    static cm1e_sim_homing_phase_t (*const phases[HOMING_PHASE_COUNT])(cm1e_sim_cm1e_t *, double) = {
        [HOMING_IDLE] = stand,
        [HOMING_LEAVE_SENSOR] = leave_sensor,
        [HOMING_TURN_ROUND] = turn_round,
        [HOMING_SEARCH_SENSOR] = search_sensor,
        [HOMING_SEARCH_STOP] = search_stop,
        [HOMING_APPROACH] = approach,
        [HOMING_OFFSET] = offset,
        [HOMING_DONE] = stand,
    };
    cm1e_sim_homing_t *homing = &drive->homing;
    if (homing->halted || homing->abandoned) {
        stand(drive, step_s);
        if (homing->abandoned && drive->servo.reference_velocity == 0)
            cm1e_sim_homing_abort(drive);
        return;
    }
    homing->phase = phases[homing->phase](drive, step_s);
}

static void start(cm1e_sim_cm1e_t *drive)
{
    const cm1e_sim_objects_t *objects = &drive->objects;
    for (size_t i = 0; i < METHOD_COUNT; i++) {
        if (methods[i].method != objects->homing_method)
            continue;
        drive->homing = (cm1e_sim_homing_t){
            .direction = methods[i].direction,
            .input = methods[i].input,
            .speed = objects->homing_speed,
            .acceleration = objects->homing_acceleration,
        };
        drive->homing.phase = methods[i].input == 0 ? HOMING_SEARCH_STOP
                              : sensor(drive)       ? HOMING_LEAVE_SENSOR
                                                    : HOMING_SEARCH_SENSOR;
        drive->servo.torque_limit = drive->rated_torque * objects->homing_torque / 100;
        return;
    }
}

static void homing_outputs(cm1e_sim_cm1e_t *drive, uint16_t rising_bits)
{
    cm1e_sim_homing_t *homing = &drive->homing;
    const bool halt = (drive->objects.controlword & CONTROLWORD_HALT) != 0;
    const bool leaving = drive->next_mode != CM1E_MODE_HM;
    /* UG 10.1, V1.3.0: before it the halt bit had no effect together with a switch of mode. */
    if (halt && cm1e_sim_homing_running(drive) && !(leaving && drive->firmware->firmware < CM1E_FIRMWARE_1_3_0))
        homing->halted = true;
    if (!(rising_bits & CONTROLWORD_HOMING_START) || halt)
        return;
    if (homing->halted)
        homing->halted = false; /* "start or continue" */
    else if (!cm1e_sim_homing_running(drive))
        start(drive);
}

static void homing_enter(cm1e_sim_cm1e_t *drive)
{
    drive->homing.acceleration = drive->objects.homing_acceleration;
    if (!cm1e_sim_homing_running(drive))
        drive->homing.halted = false;
}

/* The table of bits 13, 12 and 10 in UG 6.2.4. */
static uint16_t homing_status_bits(const cm1e_sim_cm1e_t *drive)
{
    const cm1e_sim_homing_t *homing = &drive->homing;
    const bool running = cm1e_sim_homing_running(drive);
    const bool error = drive->state == FAULT || drive->state == FAULT_REACTION_ACTIVE;
    const bool stands = fabs(drive->mechanics.velocity) < STANDSTILL_WINDOW;
    const bool attained = homing->phase == HOMING_DONE || (homing->phase >= HOMING_APPROACH && !homing->halted);
    const bool reached = running ? homing->halted && stands : !error || stands;
    return (uint16_t)((error ? STATUSWORD_HOMING_ERROR : 0) | (attained ? STATUSWORD_HOMING_ATTAINED : 0) |
                      (reached ? STATUSWORD_TARGET_REACHED : 0));
}

const cm1e_sim_mode_t cm1e_sim_homing_mode = {CM1E_MODE_HM, homing_enter, homing_outputs, homing_step,
                                              homing_status_bits};
