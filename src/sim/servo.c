#include "sim/servo.h"

/* Bandwidth of the position loop; damping ratio 1. */
#define BANDWIDTH_RAD_PER_S 500.0
/* The integral acts a few times slower than the loop, which keeps it stable (Routh). */
#define INTEGRAL_RATE_PER_S (BANDWIDTH_RAD_PER_S / 6)
/* Of the velocity fed forward: targets are whole counts, a step of one is no velocity to follow. */
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
    servo->reference_velocity = servo->feed_forward = mechanics->velocity;
    servo->integral = 0;
    servo->torque = 0;
    servo->saturated = false;
}

static double limited(double value, double limit) { return value > limit ? limit : value < -limit ? -limit : value; }

/* The torque is that of a spring and damper at the end of the step (implicit Euler), so the loop is stable for any step
 * length. The integral only works while the reference stands: friction makes a moving motor lag by a few counts. */
double cm1e_servo_step(cm1e_servo_t *s, const cm1e_mechanics_t *mechanics, double step_s)
{
    if (step_s != s->step_s) {
        s->step_s = step_s;
        s->response = 1 / (1 + (s->damping + s->stiffness * step_s) * step_s * mechanics->gain);
    }
    s->feed_forward += (s->reference_velocity - s->feed_forward) * step_s / (SMOOTHING_S + step_s);
    const double error = s->reference - mechanics->position;
    const double wanted = (s->stiffness * (error - mechanics->velocity * step_s) +
                           s->damping * (s->feed_forward - mechanics->velocity) + s->integral) * s->response;
    s->torque = limited(wanted, s->torque_limit);
    s->saturated = s->torque != wanted;
    if (s->reference_velocity == 0 && !s->saturated && (error > DEAD_BAND_COUNTS || error < -DEAD_BAND_COUNTS))
        s->integral = limited(s->integral + s->stiffness * error * INTEGRAL_RATE_PER_S * step_s, s->torque_limit);
    return s->torque;
}
