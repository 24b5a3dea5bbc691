#include "sim/mechanics.h"

#include <math.h>

/* cm1e_sim_axis_config_t's defaults. */
#define DEFAULT_LOAD_INERTIA 2e-6
#define DEFAULT_FRICTION 0.005
#define DEFAULT_VISCOUS_FRICTION 1e-5
#define DEFAULT_STOP 250000.0

static double positive_or(double value, double standard) { return value > 0 ? value : standard; }
static double nonzero_or(double value, double standard) { return value != 0 ? value : standard; }

void cm1e_mechanics_init(cm1e_mechanics_t *mechanics, const cm1e_sim_axis_config_t *config, double rotor_inertia)
{
    const double inertia = rotor_inertia + positive_or(config->load_inertia, DEFAULT_LOAD_INERTIA);
    *mechanics = (cm1e_mechanics_t){
        .gain = CM1E_COUNTS_PER_RADIAN / inertia,
        .friction = positive_or(config->friction, DEFAULT_FRICTION),
        .viscous_rate = positive_or(config->viscous_friction, DEFAULT_VISCOUS_FRICTION) / inertia,
        .stop_positive = config->no_stops ? INFINITY : nonzero_or(config->stop_positive, DEFAULT_STOP),
        .stop_negative = config->no_stops ? -INFINITY : nonzero_or(config->stop_negative, -DEFAULT_STOP),
        .damping = 1,
    };
}

/* Friction removes at most the present velocity: it stops and holds a shaft, but never reverses it. */
static double with_friction(double velocity, double most)
{
    if (velocity > most)
        return velocity - most;
    if (velocity < -most)
        return velocity + most;
    return 0;
}

void cm1e_mechanics_step(cm1e_mechanics_t *m, double torque, double step_s)
{
    if (step_s != m->step_s) {
        m->step_s = step_s;
        m->damping = 1 / (1 + m->viscous_rate * step_s);
    }
    const double impulse = step_s * m->gain;
    double velocity = (m->velocity + (torque + m->load_torque) * impulse) * m->damping;
    velocity = with_friction(velocity, m->friction * impulse);

    const double before = m->position;
    double position = before + velocity * step_s;
    /* A stop is rigid and absorbs the impact: the shaft stays there until a torque moves it away. */
    if (position > m->stop_positive) {
        position = m->stop_positive;
        velocity = velocity > 0 ? 0 : velocity;
    } else if (position < m->stop_negative) {
        position = m->stop_negative;
        velocity = velocity < 0 ? 0 : velocity;
    }
    m->position = position;
    m->velocity = velocity;
    m->travel += fabs(position - before);
    if (fabs(velocity) > m->peak_velocity)
        m->peak_velocity = fabs(velocity);
}

bool cm1e_mechanics_at_rest(const cm1e_mechanics_t *m)
{
    return m->velocity == 0 && fabs(m->load_torque) <= m->friction;
}

bool cm1e_mechanics_at_stop(const cm1e_mechanics_t *m)
{
    return m->position >= m->stop_positive || m->position <= m->stop_negative;
}
