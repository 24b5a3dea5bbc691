/* A path driven cycle by cycle, and what every sample has to keep; for the tests of paths in the motion room. */
#ifndef PATH_CHECK_H
#define PATH_CHECK_H

#include <string.h>

#include "motion/path.h"
#include "motion_check.h"

enum { DRIVEN_MAX = 4096 };

/** A path that is driven, and the geometry that was asked for. */
typedef struct {
    cm1e_path_t path;
    cm1e_path_sample_t now, before;
    uint32_t next_tag, done_tag;
    double time_s;
    long steps, standing; /**< cycles; and how many of them at rest after it began to move and before the end */
    double fastest;       /**< along the path */
    double most_velocity, most_acceleration, most_jerk; /**< of any axis, in parts of its limit */
    double path_acceleration, path_jerk;                /**< the largest */
} driven_t;

static driven_t driven;

#define CHECK_PATH(condition)                                                                                       \
    do {                                                                                                            \
        if (!(condition)) {                                                                                         \
            printf("step %ld, tag %u\n", driven.steps, (unsigned)driven.now.active);                                \
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

static inline double larger_of(double a, double b) { return a > b ? a : b; }

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
        driven.most_velocity = larger_of(driven.most_velocity, fabs(v) / axis->velocity);
        driven.most_acceleration = larger_of(driven.most_acceleration, fabs(a) / axis->acceleration);
        driven.most_jerk = larger_of(driven.most_jerk, jerk / axis->jerk);
        CHECK_PATH(isfinite(driven.now.position[i]));
        CHECK_PATH(fabs(v) <= axis->velocity * (1 + 1e-6));
        CHECK_PATH(fabs(a) <= axis->acceleration * (1 + 1e-6));
        CHECK_PATH(jerk <= axis->jerk * (1 + 1e-6) + 1e-9 * axis->acceleration / dt);
    }
    driven.fastest = larger_of(driven.fastest, driven.now.path_velocity);
    driven.path_acceleration = larger_of(driven.path_acceleration, fabs(driven.now.path_acceleration));
    driven.path_jerk = larger_of(driven.path_jerk, fabs(driven.now.path_acceleration -
                                                        driven.before.path_acceleration) / dt);
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
