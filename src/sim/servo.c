#include "sim/servo.h"

#include <math.h>

/* Bandwidth of the position loop; damping ratio 1. */
#define BANDWIDTH_RAD_PER_S 500.0
/* The integral acts a few times slower than the loop, which keeps it stable (Routh). */
#define INTEGRAL_RATE_PER_S (BANDWIDTH_RAD_PER_S / 6)
/* Filter of the velocity fed forward for set-points: they are whole counts, and a step of one count is no velocity. */
#define SMOOTHING_S 1e-3
/* The encoder's resolution: within half a count there is no error to correct. */
#define DEAD_BAND_COUNTS 0.25

void cm1e_servo_init(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics)
{
    *servo = (cm1e_servo_t){
        .stiffness = BANDWIDTH_RAD_PER_S * BANDWIDTH_RAD_PER_S / mechanics->gain,
        .damping = 2 * BANDWIDTH_RAD_PER_S / mechanics->gain,
        .response = 1,
    };
}

void cm1e_servo_catch(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics)
{
    servo->reference = mechanics->position;
    servo->reference_velocity = servo->feed_forward = servo->last_velocity = mechanics->velocity;
    servo->integral = 0;
    servo->torque = 0;
    servo->saturated = false;
}

void cm1e_servo_forget_distance(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics)
{
    if (servo->saturated)
        servo->reference = mechanics->position;
}

static double limited(double value, double limit) { return value > limit ? limit : value < -limit ? -limit : value; }

void cm1e_servo_rest(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics)
{
    if (servo->reference_velocity != 0 || mechanics->velocity != 0)
        return;
    servo->reference = mechanics->position;
    servo->integral = servo->torque;
}

void cm1e_servo_run(cm1e_servo_t *servo, const cm1e_mechanics_t *mechanics, double step_s)
{
    servo->reference += (servo->saturated ? mechanics->velocity : servo->reference_velocity) * step_s;
}

/* Velocity and acceleration of a profile of the drive are known exactly and fed forward. Set-points of the master are
 * smoothed. Returns the acceleration, counts/s2. */
static double feed_forward(cm1e_servo_t *s, double step_s)
{
    const double change = s->reference_velocity - s->last_velocity;
    const double share = s->own_profile ? 1 : step_s / (SMOOTHING_S + step_s);
    s->last_velocity = s->reference_velocity;
    s->feed_forward += (s->reference_velocity - s->feed_forward) * share;
    return s->own_profile ? change / step_s : 0;
}

/* Torque in Nm for such a motion, without the external load. */
static double torque_of_motion(const cm1e_servo_t *s, const cm1e_mechanics_t *mechanics, double acceleration)
{
    const double velocity = s->reference_velocity;
    const double friction = velocity > 0 ? mechanics->friction : velocity < 0 ? -mechanics->friction : 0;
    return s->own_profile ? (acceleration + mechanics->viscous_rate * velocity) / mechanics->gain + friction : 0;
}

/* The torque is that of a spring and damper at the end of the step (implicit Euler), so the loop is stable for any step
 * length. A profile of the drive ends exactly: friction is compensated, and the integral takes the load. A motor that
 * follows set-points lags by a few counts: there the integral acts only at standstill. */
double cm1e_servo_step(cm1e_servo_t *s, const cm1e_mechanics_t *mechanics, double step_s)
{
    if (step_s != s->step_s) {
        s->step_s = step_s;
        s->response = 1 / (1 + (s->damping + s->stiffness * step_s) * step_s * mechanics->gain);
    }
    const double acceleration = feed_forward(s, step_s);
    const double velocity = mechanics->velocity + acceleration * step_s; /* and error: at the end of the step */
    const double error = s->reference - mechanics->position - velocity * step_s;
    const double wanted = (s->stiffness * error + s->damping * (s->feed_forward - velocity)) * s->response +
                          torque_of_motion(s, mechanics, acceleration) + s->integral;
    s->torque = limited(wanted, s->torque_limit);
    s->saturated = s->torque != wanted;
    if ((s->own_profile || s->reference_velocity == 0) && !s->saturated && fabs(error) > DEAD_BAND_COUNTS)
        s->integral = limited(s->integral + s->response * s->stiffness * error * INTEGRAL_RATE_PER_S * step_s,
                              s->torque_limit);
    return s->torque;
}
