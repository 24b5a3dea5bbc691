/* A path driven cycle by cycle, and what every sample has to keep; for the tests of paths in the motion room. */
#ifndef PATH_CHECK_H
#define PATH_CHECK_H

#include <string.h>

#include "motion/path.h"
#include "motion_check.h"

/** A path that is driven, and the geometry that was asked for. */
typedef struct {
    cm1e_path_t path;
    cm1e_path_sample_t now, before;
    uint32_t next_tag, done_tag;
    double time_s;
    long steps;
    double fastest;                                     /**< along the path */
    double most_velocity, most_acceleration, most_jerk; /**< of any axis, in parts of its limit */
    /* what was told of the course */
    uint32_t course;
    unsigned long decided;
    bool known[CM1E_PATH_AXES];
    cm1e_motion_bounds_t bounds[CM1E_PATH_AXES];
    double begun_at[CM1E_PATH_AXES], left_s;
} driven_t;

static driven_t driven;

static inline void explain(void)
{
    const cm1e_path_t *p = &driven.path;
    const cm1e_path_element_t *e = &p->element[p->first_element];
    printf("step %ld, tag %u, %d axes, element kind %d, %g of %g, %d left; v %g (before %g), a %g (before %g)\n",
           driven.steps, (unsigned)driven.now.active, p->config.axes, e->piece ? (int)e->piece->kind : -1,
           p->along.position - p->begin, e->length, p->element_count, p->along.velocity, driven.before.path_velocity,
           p->along.acceleration, driven.before.path_acceleration);
    printf("limits %g %g %g %g, axes %g\n", e->limits.velocity, e->limits.acceleration, e->limits.deceleration,
           e->limits.jerk, e->highest);
    for (int i = 0; i < p->config.axes; i++)
        printf("axis %d: %g, %g, %g of %g, %g, %g\n", i, driven.now.velocity[i], driven.now.acceleration[i],
               (driven.now.acceleration[i] - driven.before.acceleration[i]) / p->config.cycle_s,
               p->config.axis[i].velocity, p->config.axis[i].acceleration, p->config.axis[i].jerk);
}

#define CHECK_PATH(condition)                                                                                       \
    do {                                                                                                            \
        if (!(condition)) {                                                                                         \
            explain();                                                                                              \
            TEST_FAIL_MESSAGE(#condition);                                                                          \
        }                                                                                                           \
    } while (0)

static inline cm1e_path_config_t plain_config(int axes, int space, double velocity, double acceleration, double jerk)
{
    cm1e_path_config_t config = {.axes = axes, .space = space, .cycle_s = 1e-3};
    for (int i = 0; i < axes; i++)
        config.axis[i] = (cm1e_path_axis_t){velocity, acceleration, jerk, -INFINITY, INFINITY};
    return config;
}

static inline void begin_path(const cm1e_path_config_t *config, const double *position)
{
    memset(&driven, 0, sizeof driven);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_path_begin(&driven.path, config, position));
    driven.next_tag = driven.done_tag = 1;
    memcpy(driven.before.position, position, (size_t)config->axes * sizeof *position);
}

/** While the number of the course stays, every step keeps the bounds that were told. */
static inline void check_bounds(int i, double v, double a, double jerk)
{
    const cm1e_motion_bounds_t *most = &driven.bounds[i];
    const double dt = driven.path.config.cycle_s, way = fabs(driven.now.position[i] - driven.begun_at[i]);
    const double noise = 1e-9 * driven.path.config.axis[i].acceleration / dt;
    if (driven.course == cm1e_path_course(&driven.path) && driven.known[i]) {
        CHECK_PATH(fabs(v) <= most->velocity * (1 + 1e-9) + 1e-12);
        CHECK_PATH(fabs(a) <= most->acceleration * (1 + 1e-9) + 1e-9);
        CHECK_PATH(jerk <= most->jerk * (1 + 1e-6) + noise);
        CHECK_PATH(way <= most->velocity * driven.left_s * (1 + 1e-9) + 1e-9 * (1 + fabs(driven.now.position[i])));
        driven.decided++;
    } else {
        driven.known[i] = cm1e_path_bounds(&driven.path, i, &driven.bounds[i], &driven.left_s);
        driven.begun_at[i] = driven.now.position[i];
    }
}

/** One cycle; limits of the axes and the order of the tags are checked. */
static inline void step_path(void)
{
    const cm1e_path_config_t *config = &driven.path.config;
    const double dt = config->cycle_s;
    driven.before = driven.now;
    cm1e_path_step(&driven.path, &driven.now);
    driven.steps++;
    driven.time_s += dt;
    for (int i = 0; i < driven.now.done; i++)
        CHECK_PATH(driven.now.done_tags[i] == driven.done_tag++);
    for (int i = 0; i < config->axes; i++) {
        const cm1e_path_axis_t *axis = &config->axis[i];
        const double v = driven.now.velocity[i], a = driven.now.acceleration[i];
        const double jerk = fabs(a - driven.before.acceleration[i]) / dt;
        driven.most_velocity = fmax(driven.most_velocity, fabs(v) / axis->velocity);
        driven.most_acceleration = fmax(driven.most_acceleration, fabs(a) / axis->acceleration);
        driven.most_jerk = fmax(driven.most_jerk, jerk / axis->jerk);
        const double way = (v + driven.before.velocity[i]) / 2 * dt, p = driven.now.position[i];
        CHECK_PATH(fabs(p - driven.before.position[i] - way) <= axis->jerk * dt * dt * dt + 1e-13 * fabs(p));
        CHECK_PATH(fabs(v) <= axis->velocity * (1 + 1e-6));
        CHECK_PATH(fabs(v - driven.before.velocity[i]) / dt <= axis->acceleration * (1 + 1e-6));
        CHECK_PATH(fabs(a) <= axis->acceleration * (1 + 1e-6));
        CHECK_PATH(jerk <= axis->jerk * (1 + 1e-6) + 1e-9 * axis->acceleration / dt);
        check_bounds(i, v, a, jerk);
    }
    driven.course = cm1e_path_course(&driven.path);
    driven.fastest = fmax(driven.fastest, driven.now.path_velocity);
    CHECK_PATH(driven.now.path_velocity >= -1e-9);
}

/** Steps until it is at rest at the end of everything; returns the time that took. */
static inline double run_path(void)
{
    const double start = driven.time_s;
    for (long i = 0; i < 10000000; i++) {
        step_path();
        if (driven.now.phase == CM1E_PATH_IDLE)
            return driven.time_s - start;
    }
    TEST_FAIL_MESSAGE("never ends");
    return 0;
}

static inline cm1e_path_command_t command_of(double velocity, double acceleration, double jerk,
                                             cm1e_path_junction_t junction, double parameter)
{
    return (cm1e_path_command_t){.limits = {velocity, acceleration, acceleration, jerk}, .junction = junction,
                                 .blend = CM1E_PATH_BLEND_LOW, .parameter = parameter, .tag = driven.next_tag++};
}

#endif
