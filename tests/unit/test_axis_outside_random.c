/* Planners that do anything: whatever positions come, whenever they stay away, and whatever happens to the axis, the
 * target of the motor never steps, and it keeps the limits of the axis. */
#include <math.h>

#include "axis/axis_outside.h"

#include "../support/axis_bench.h"
#include "../support/seeds.h"
#include "../support/xorshift.h"

static const double cycle_s = 1e-3;
static uint64_t chance_state;
static double position, velocity, acceleration;
static cm1e_command_id_t follow;
static long followed;

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

static uint32_t chance(uint32_t below)
{
    return (uint32_t)(xorshift(&chance_state) >> 33) % below;
}

static double between(double least, double most) { return least + (most - least) * chance(100001) / 1e5; }

/* A planner mostly keeps the limits, and sometimes not at all. */
static void plan(void)
{
    static const double nonsense[] = {NAN, INFINITY, -INFINITY, 1e300, -1e9};
    if (chance(60) == 0)
        acceleration = between(-1.02, 1.02) * axis->limits.maximum.acceleration;
    if (fabs(velocity) > 0.9 * axis->limits.maximum.velocity && chance(20) > 0)
        acceleration = -acceleration;
    velocity += acceleration * cycle_s;
    position += velocity * cycle_s;
    if (chance(300) == 0)
        velocity = acceleration = 0.0;
    if (chance(1500) == 0)
        position += between(-1.0, 1.0) * pow(10.0, -(double)chance(7));
    if (chance(4000) == 0)
        position = nonsense[chance(sizeof nonsense / sizeof nonsense[0])];
}

static void begin(void)
{
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_FOLLOW_POSITION,
                                         .position = cm1e_axis_place(axis, false) + (chance(4) ? 0.0 : between(-1, 1))};
    if (cm1e_axis_start(axis, &command, &follow) == CM1E_OK) {
        position = command.position;
        velocity = acceleration = 0.0;
    }
}

static void happen(void)
{
    if (bench_state_of(follow) != CM1E_COMMAND_ACTIVE && chance(20) == 0) {
        cm1e_axis_reset(axis);
        bench_power(true);
        begin();
    }
    if (chance(700) == 0)
        (void)bench_try_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
    if (chance(1500) == 0)
        bench_power(false);
}

/* What the motor is told in this cycle, judged by the two cycles before. */
typedef struct judge {
    int64_t before, step_before;
    int known;
} judge_t;

static void look(judge_t *judge, unsigned seed, int cycle)
{
    char where[80];
    const int64_t now = (int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, 0), step = now - judge->before;
    const double scale = fabs(axis->position.scale);
    const double most = fmax(axis->limits.emergency.deceleration, axis->limits.maximum.acceleration);
    snprintf(where, sizeof where, "CM1E_TEST_SEED=%u, cycle %d, %s", seed, cycle, cm1e_axis_state_name(bench_info().state));
    if (bus.state != OPERATION_ENABLED || axis->silence.shaken > 0) {
        judge->known = 0; /* without torque it follows the motor; after silence test_axis_outside judges */
    } else {
        if (judge->known >= 1)
            TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE((int64_t)(axis->limits.maximum.velocity * scale * cycle_s) + 2,
                                                    llabs(step), where);
        if (judge->known >= 2)
            TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE((int64_t)(most * scale * cycle_s * cycle_s) + 2,
                                                    llabs(step - judge->step_before), where);
        judge->known++;
    }
    judge->before = now;
    judge->step_before = step;
}

static void run(unsigned seed)
{
    judge_t judge = {0};
    chance_state = seed * 2654435761u + 1;
    bench_start();
    bench_enable();
    begin();
    for (int cycle = 0; cycle < 4000; cycle++) {
        plan();
        received = chance(900) == 0 ? CM1E_ERROR_TIMEOUT : CM1E_OK;
        bench_inputs();
        happen();
        if (chance(1200) > 0)
            cm1e_axis_feed(cm1e_axis_reference(axis), follow, position);
        bench_outputs();
        followed += axis_from_outside(axis);
        look(&judge, seed, cycle);
    }
    received = CM1E_OK;
    bench_end();
}

static void test_no_planner_makes_the_motor_step(void)
{
    bench_end();
    for (int n = 0; n < seeds_of(60); n++)
        run(seed_of(n));
    TEST_ASSERT_TRUE(seeds_given() || followed > 50000); /* else it was too wild to test anything */
    bench_start();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_planner_makes_the_motor_step);
    return UNITY_END();
}
