#include "sim/search.h"

#include <math.h>

#define ENCODER_TOOTH_COUNTS 1000.0 /* 50 teeth a revolution */
#define ENCODER_TOOTH_PHASE 500.0   /* where the teeth lie on the scale of the mechanics */
#define STALL_VELOCITY 200.0        /* counts/s; slower than this at the torque limit is no motion */
#define STALL_TIME_S 0.03           /* so long at the torque limit means a hard stop */
#define IN_POSITION 0.3             /* counts */
#define SETTLED_VELOCITY 20.0       /* counts/s */
#define SETTLED_TIME_S 0.03         /* time since the reference arrived, so that every master sees that a search ran */
#define SETTLE_TIME_S 0.5           /* a move ends after this, in position or not */

typedef const cm1e_sim_searcher_t motor_t;

static void run(const cm1e_sim_search_t *search, motor_t *motor, double velocity, double step_s)
{
    cm1e_sim_ramp(&motor->servo->reference_velocity, velocity, search->acceleration, step_s);
    motor->servo->reference += motor->servo->reference_velocity * step_s;
}

/* ---- the phases: each moves the reference and returns the next -------------------------------------------------- */

/* "If the sensor is detected when the home routine is first initiated the motor will move off the sensor first in the
 * opposite direction" (UG 6.2.4). */
static cm1e_sim_search_phase_t leave_sensor(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    if (!search->sensor)
        return SEARCH_TURN_ROUND;
    run(search, motor, -search->direction * search->speed, step_s);
    return SEARCH_LEAVE_SENSOR;
}

static cm1e_sim_search_phase_t turn_round(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    run(search, motor, 0, step_s);
    return motor->servo->reference_velocity == 0 ? SEARCH_SENSOR : SEARCH_TURN_ROUND;
}

/* "The driver interrupt captures the motor position": exactly where the sensor switched, not where the step ended. */
static double captured_position(const cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    const double position = motor->mechanics->position;
    return fabs(position - search->edge) <= fabs(motor->mechanics->velocity) * 2 * step_s + 1 ? search->edge : position;
}

static cm1e_sim_search_phase_t search_sensor(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    if (search->sensor) {
        search->target = floor(captured_position(search, motor, step_s) + 0.5);
        return SEARCH_APPROACH;
    }
    run(search, motor, search->direction * search->speed, step_s);
    return SEARCH_SENSOR;
}

/* "Moves back 2 teeth of the encoder gear to set the absolute position" (UG 6.2.4). */
static double second_previous_tooth(double position, int8_t direction)
{
    const double tooth = (position - ENCODER_TOOTH_PHASE) / ENCODER_TOOTH_COUNTS;
    const double previous = direction > 0 ? floor(tooth) : ceil(tooth);
    return (previous - direction) * ENCODER_TOOTH_COUNTS + ENCODER_TOOTH_PHASE;
}

static cm1e_sim_search_phase_t search_stop(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    const bool stalled = motor->servo->saturated && fabs(motor->mechanics->velocity) < STALL_VELOCITY;
    search->stalled_s = stalled ? search->stalled_s + step_s : 0;
    if (search->stalled_s < STALL_TIME_S) {
        run(search, motor, search->direction * search->speed, step_s);
        return SEARCH_STOP;
    }
    search->stalled_s = 0;
    cm1e_servo_catch(motor->servo, motor->mechanics);
    search->target = second_previous_tooth(motor->mechanics->position, search->direction);
    return SEARCH_APPROACH;
}

/* Returns true when the motor is at rest there; this place is then exactly 0. */
static bool move(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    const cm1e_mechanics_t *mechanics = motor->mechanics;
    if (!cm1e_sim_move_step(motor->servo, search->target, search->speed, search->acceleration, step_s)) {
        search->stalled_s = 0;
        return false;
    }
    search->stalled_s += step_s;
    const bool there = fabs(search->target - mechanics->position) < IN_POSITION &&
                       fabs(mechanics->velocity) < SETTLED_VELOCITY && search->stalled_s >= SETTLED_TIME_S;
    if (!there && search->stalled_s < SETTLE_TIME_S)
        return false;
    search->stalled_s = 0;
    *motor->zero = (int64_t)(mechanics->position < 0 ? mechanics->position - 0.5 : mechanics->position + 0.5);
    motor->servo->reference = search->target = (double)*motor->zero;
    return true;
}

static cm1e_sim_search_phase_t approach(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    if (!move(search, motor, step_s))
        return SEARCH_APPROACH;
    search->target += search->offset;
    return search->offset == 0 ? SEARCH_DONE : SEARCH_OFFSET;
}

static cm1e_sim_search_phase_t offset(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    return move(search, motor, step_s) ? SEARCH_DONE : SEARCH_OFFSET;
}

static cm1e_sim_search_phase_t stand(cm1e_sim_search_t *search, motor_t *motor, double step_s)
{
    cm1e_sim_search_stand(search, motor, step_s);
    return search->phase;
}

void cm1e_sim_search_stand(const cm1e_sim_search_t *search, const cm1e_sim_searcher_t *motor, double step_s)
{
    run(search, motor, 0, step_s);
}

void cm1e_sim_search_begin(cm1e_sim_search_t *search, bool by_sensor)
{
    search->stalled_s = 0;
    search->phase = !by_sensor ? SEARCH_STOP : search->sensor ? SEARCH_LEAVE_SENSOR : SEARCH_SENSOR;
}

void cm1e_sim_search_step(cm1e_sim_search_t *search, const cm1e_sim_searcher_t *motor, double step_s)
{
    static cm1e_sim_search_phase_t (*const phases[SEARCH_PHASE_COUNT])(cm1e_sim_search_t *, motor_t *, double) = {
        [SEARCH_IDLE] = stand,
        [SEARCH_LEAVE_SENSOR] = leave_sensor,
        [SEARCH_TURN_ROUND] = turn_round,
        [SEARCH_SENSOR] = search_sensor,
        [SEARCH_STOP] = search_stop,
        [SEARCH_APPROACH] = approach,
        [SEARCH_OFFSET] = offset,
        [SEARCH_DONE] = stand,
    };
    search->phase = phases[search->phase](search, motor, step_s);
}
