/* MC_MoveSuperimposed, MC_HaltSuperimposed (3.8, 3.9): a motion on top of another one. */
#include <string.h>

#include "axis/axis_parameters.h"

#include "../support/axis_bench.h"
#include "../support/axis_witness.h"
#include "../support/xorshift.h"

static uint64_t seed;

static double draw(double low, double high)
{
    return xorshift_between(&seed, low, high);
}

static void begin_with(double acceleration, double deceleration, double limit)
{
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_velocity = 30.0;
    bus.config.axes[0].max_acceleration = acceleration;
    bus.config.axes[0].max_deceleration = deceleration;
    bus.config.axes[0].max_jerk = 2000.0;
    bus.config.axes[0].software_limit_negative = -limit;
    bus.config.axes[0].software_limit_positive = limit;
    bench_create();
    bench_enable();
    watch_begin();
}

void setUp(void) { begin_with(100.0, 100.0, 0.0); }
void tearDown(void) { bench_end(); }

static cm1e_command_id_t superimpose(double distance, double velocity)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = distance,
                                                      .velocity = velocity});
}

static cm1e_command_id_t post(cm1e_command_kind_t kind, double position, double velocity, MC_BUFFER_MODE mode)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = kind, .position = position, .velocity = velocity,
                                                      .end_velocity = 2.0, .buffer_mode = mode});
}

static double covered(cm1e_command_id_t id) { return cm1e_axis_command_status(axis, id).covered; }

static void wait_for(cm1e_command_id_t id, cm1e_command_state_t state)
{
    for (int i = 0; i < 30000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++)
        watch_cycles(1);
    TEST_ASSERT_EQUAL_INT(state, bench_state_of(id));
}

static void test_the_distance_is_added_to_a_move_at_any_time(void)
{
    for (int wait = 0; wait < 2600; wait += 50)
        for (int sign = -1; sign <= 1; sign += 2) {
            setUp();
            const cm1e_command_id_t base = bench_move_to(20.0, 10.0);
            watch_cycles(wait);
            const bool over = bench_state_of(base) == CM1E_COMMAND_DONE;
            const cm1e_command_id_t id = superimpose(2.0 * sign, 5.0);
            TEST_ASSERT_EQUAL_INT(over ? CM1E_COMMAND_DONE : CM1E_COMMAND_ACTIVE, bench_state_of(base));
            TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
            wait_for(id, CM1E_COMMAND_DONE);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.0 * sign, covered(id));
            if (!over)
                wait_for(base, CM1E_COMMAND_DONE);
            watch_cycles(10);
            TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0 + 2.0 * sign, bench_info().set_position);
        }
}

static void test_a_base_that_needs_no_more_than_half_keeps_its_time(void)
{
    int took[2];
    for (int on_top = 0; on_top < 2; on_top++) {
        setUp();
        const cm1e_command_id_t base = bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 20.0, .velocity = 10.0, .acceleration = 50.0,
            .deceleration = 50.0, .jerk = 1000.0});
        watch_cycles(50);
        if (on_top)
            superimpose(3.0, 8.0);
        for (took[on_top] = 0; bench_state_of(base) == CM1E_COMMAND_ACTIVE; took[on_top]++)
            watch_cycles(1);
    }
    TEST_ASSERT_EQUAL_INT(took[0], took[1]);
}

static void test_in_standstill_it_acts_like_a_relative_move(void)
{
    const cm1e_command_id_t id = superimpose(3.0, 10.0);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    int n = 0;
    double before = 0.0;
    for (; bench_state_of(id) == CM1E_COMMAND_ACTIVE && n < 3000; n++) {
        watch_cycles(1);
        TEST_ASSERT_TRUE(covered(id) >= before);
        before = covered(id);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    setUp();
    const cm1e_command_id_t relative = post(CM1E_COMMAND_MOVE_RELATIVE, 3.0, 10.0, mcAborting);
    int m = 0;
    for (; bench_state_of(relative) == CM1E_COMMAND_ACTIVE; m++)
        watch_cycles(1);
    TEST_ASSERT_EQUAL_INT(m, n);
}

/* 3.10: InVelocity looks at its own part only. */
static void test_on_a_velocity(void)
{
    const cm1e_command_id_t base = bench_move_velocity(10.0);
    watch_cycles(500);
    const cm1e_command_id_t id = superimpose(4.0, 5.0);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    double fastest = 0.0;
    const double from = bench_info().set_position;
    int n = 0;
    for (; bench_state_of(id) == CM1E_COMMAND_ACTIVE; n++) {
        watch_cycles(1);
        fastest = fmax(fastest, axis->setpoint.velocity);
        TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, base).reached);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 15.0, fastest);
    TEST_ASSERT_DOUBLE_WITHIN(1e-8, from + 10.0 * n * 1e-3 + 4.0, bench_info().set_position);
    watch_cycles(2);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, axis->setpoint.velocity);
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, base).reached);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(base));
}

/* A base that begins later and is to be faster than what the superimposed motion leaves gets what is left, its end
 * velocity too; and what it was commanded when that is over. */
static void test_a_faster_base_that_begins_later_is_reduced_until_the_end(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE};
    for (int k = 0; k < 2; k++)
        for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++) {
            setUp();
            bench_move_to(3.0, 10.0);
            watch_cycles(100);
            const cm1e_command_id_t on_top = superimpose(20.0, 5.0);
            const cm1e_command_id_t base = bench_start_command(&(cm1e_axis_command_t){
                .kind = kinds[k], .position = 1.0, .velocity = 20.0 + 8.0 * (k == 0), .end_velocity = 28.0,
                .buffer_mode = (MC_BUFFER_MODE)mode});
            double fastest = 0.0;
            while (bench_state_of(on_top) == CM1E_COMMAND_ACTIVE) {
                watch_cycles(1);
                fastest = fmax(fastest, axis->setpoint.velocity);
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, 30.0, fastest);
            watch_cycles(500);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(base));
            TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, base).reached);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 28.0, axis->setpoint.velocity);
        }
}

/* In a turn the acceleration of the base will still make a velocity that what goes on top has to leave room for. */
static void test_on_a_base_that_turns(void)
{
    for (int wait = 0; wait < 150; wait++) {
        const double distance = wait % 2 ? -4.0 : 0.05;
        setUp();
        bench_move_to(-20.0, 3.0);
        watch_cycles(500);
        const cm1e_command_id_t base = bench_move_to(5.0, 3.0);
        watch_cycles(wait);
        const cm1e_command_id_t id = superimpose(distance, 27.0);
        wait_for(id, CM1E_COMMAND_DONE);
        wait_for(base, CM1E_COMMAND_DONE);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.0 + distance, bench_info().set_position);
    }
}

/* What is on top needs its share of the acceleration at once: that of the base falls as fast as the other one rises,
 * though it was asked to rise and fall softly. */
static void test_on_a_base_with_a_small_jerk(void)
{
    for (int wait = 20; wait < 600; wait += 20) {
        begin_with(100.0, 100.0, 0.0);
        bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 100.0,
                                                   .velocity = 20.0, .jerk = 250.0});
        watch_cycles(wait);
        const cm1e_command_id_t id = superimpose(5.0, 9.0);
        wait_for(id, CM1E_COMMAND_DONE);
    }
}

/* A halt that needs its whole deceleration before a software limit keeps it: what goes on top begins when it stands. */
static void test_on_a_halt_before_a_limit(void)
{
    for (int wait = 0; wait < 100; wait += 3) {
        begin_with(100.0, 100.0, 25.0);
        bench_move_velocity(10.0);
        while (bench_info().set_position < 24.0)
            watch_cycles(1);
        const cm1e_command_id_t halt = post(CM1E_COMMAND_HALT, 0.0, 0.0, mcAborting);
        watch_cycles(wait);
        const cm1e_command_id_t id = superimpose(-1.0, 5.0);
        wait_for(halt, CM1E_COMMAND_DONE);
        wait_for(id, CM1E_COMMAND_DONE);
        TEST_ASSERT_TRUE(watch.highest <= 25.0);
    }
}

static void test_another_one_replaces_the_first_only(void)
{
    const cm1e_command_id_t base = bench_move_velocity(10.0);
    watch_cycles(500);
    const cm1e_command_id_t first = superimpose(4.0, 5.0);
    watch_cycles(300);
    const double so_far = covered(first);
    TEST_ASSERT_TRUE(so_far > 0.1 && so_far < 3.9);
    const cm1e_command_id_t second = superimpose(-1.0, 5.0);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(first));
    TEST_ASSERT_EQUAL_DOUBLE(so_far, covered(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(base));
    wait_for(second, CM1E_COMMAND_DONE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -1.0, covered(second));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(base));
}

/* What it takes from the base: no more than it asks for, and at most half of what there is. */
static void test_its_share_of_the_limits_is_what_it_asks_for(void)
{
    static const cm1e_motion_limits_t asked[] = {{3.0, 20.0, 20.0, 100.0}, {3.0, 90.0, 90.0, 1900.0}};
    static const cm1e_motion_limits_t given[] = {{3.0, 20.0, 20.0, 100.0}, {3.0, 50.0, 50.0, 1000.0}};
    for (int i = 0; i < 2; i++) {
        setUp();
        bench_move_velocity(5.0);
        watch_cycles(500);
        bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 4.0, .velocity = asked[i].velocity,
            .acceleration = asked[i].acceleration, .deceleration = asked[i].deceleration, .jerk = asked[i].jerk});
        TEST_ASSERT_EQUAL_DOUBLE(given[i].velocity, axis->superimposed.share.velocity);
        TEST_ASSERT_EQUAL_DOUBLE(given[i].acceleration, axis->superimposed.share.acceleration);
        TEST_ASSERT_EQUAL_DOUBLE(given[i].deceleration, axis->superimposed.share.deceleration);
        TEST_ASSERT_EQUAL_DOUBLE(given[i].jerk, axis->superimposed.share.jerk);
    }
}

static void test_halt_superimposed_ends_it_and_leaves_the_base(void)
{
    const cm1e_command_id_t base = bench_move_to(20.0, 10.0);
    watch_cycles(300);
    const cm1e_command_id_t id = superimpose(4.0, 5.0);
    watch_cycles(300);
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_HALT_SUPERIMPOSED};
    const cm1e_command_id_t halt = bench_start_command(&command);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(id));
    const double before = covered(id);
    wait_for(halt, CM1E_COMMAND_DONE);
    const double extra = before + covered(halt);
    TEST_ASSERT_TRUE(extra > 0.1 && extra < 3.9);
    wait_for(base, CM1E_COMMAND_DONE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0 + extra, bench_info().set_position);
    const cm1e_command_id_t nothing = bench_start_command(&command); /* nothing to halt */
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(nothing));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_after_a_pause_the_base_ends_beyond_by_what_was_covered(void)
{
    for (int wait = 10; wait < 300; wait += 20) {
        setUp();
        const cm1e_command_id_t base = bench_move_to(20.0, 10.0);
        watch_cycles(200);
        const cm1e_command_id_t id = superimpose(2.0, 5.0);
        watch_cycles(wait);
        cm1e_axis_after_pause(axis, 5000000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(id));
        for (int i = 0; i < 10000 && bench_state_of(base) == CM1E_COMMAND_ACTIVE; i++)
            bench_cycles(1);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(base));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0 + covered(id), bench_info().set_position);
    }
}

static void test_an_aborting_command_ends_both_without_a_step(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_VELOCITY,
                                                CM1E_COMMAND_HALT, CM1E_COMMAND_STOP,
                                                CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE};
    for (int k = 0; k < 5; k++)
        for (int wait = 0; wait < 600; wait += 37) {
            setUp();
            const cm1e_command_id_t base = bench_move_to(20.0, 10.0);
            watch_cycles(200);
            const cm1e_command_id_t id = superimpose(4.0, 8.0);
            watch_cycles(wait);
            const cm1e_command_id_t next = post(kinds[k], 15.0, 10.0, mcAborting);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(base));
            TEST_ASSERT_TRUE(bench_state_of(id) == CM1E_COMMAND_ABORTED || bench_state_of(id) == CM1E_COMMAND_DONE);
            watch_cycles(4000);
            if (k == 0) {
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(next));
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, 15.0, bench_info().set_position); /* absolute again */
            }
        }
}

static void test_errors_and_power_end_it(void)
{
    for (int off = 0; off < 2; off++) {
        setUp();
        bench_move_velocity(5.0);
        watch_cycles(300);
        const cm1e_command_id_t id = superimpose(4.0, 8.0);
        watch_cycles(100);
        if (off)
            bench_power(false);
        else
            fake_bus_fault(&bus, 0x2310);
        bench_cycles(2);
        TEST_ASSERT_EQUAL_INT(off ? CM1E_COMMAND_ABORTED : CM1E_COMMAND_ERROR, bench_state_of(id));
        bench_cycles(500);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, axis->setpoint.velocity);
    }
}

static void test_a_disabled_direction_ends_what_goes_there(void)
{
    const cm1e_command_id_t base = bench_move_to(20.0, 10.0);
    watch_cycles(300);
    const cm1e_command_id_t id = superimpose(-2.0, 5.0);
    watch_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, false));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, cm1e_axis_command_status(axis, id).error);
    bench_told("MC_MoveSuperimposed, running or waiting, was ended");
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(base));
    wait_for(base, CM1E_COMMAND_DONE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0, bench_info().set_position);
}

static cm1e_error_t refusal(double distance, double velocity, double acceleration)
{
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = distance,
                                         .velocity = velocity, .acceleration = acceleration};
    cm1e_command_id_t id;
    return cm1e_axis_start(axis, &command, &id);
}

static void test_refusals(void)
{
    begin_with(100.0, 100.0, 25.0);
    bench_move_to(20.0, 10.0);
    watch_cycles(100);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, refusal(1.0, 20.1, 0.0)); /* 10 + 20.1 > 30 */
    char text[300];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "the sum may be up to 30 u/s"), text);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_VELOCITY_RANGE, refusal(1.0, 0.0, 0.0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(5.1, 5.0, 0.0));
    bench_told("the superimposed distance 5.1, added to a motion that is at ");
    bench_told(" and ends at 20, would leave the software limits");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(NAN, 5.0, 0.0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, refusal(1.0, 5.0, 101.0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, true, false));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, refusal(-1.0, 5.0, 0.0));
    watch_cycles(4000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0, bench_info().set_position);
}

/* A limit that only the sum would overrun is refused like one that the base would. */
static void test_a_limit_has_to_leave_room_for_both(void)
{
    (void)bench_move_to(20.0, 10.0);
    watch_cycles(100);
    (void)superimpose(5.0, 5.0);
    watch_cycles(100);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_SW_LIMIT_POS, 24.0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                          cm1e_axis_write_parameter(axis, CM1E_PARAMETER_ENABLE_LIMIT_POS, 1.0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_SW_LIMIT_POS, 25.0));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_ENABLE_LIMIT_POS, 1.0));
    watch_cycles(4000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 25.0, bench_info().set_position);
}

/* The same where the base is the later one: a move that waits, and begins while the other one goes on. */
static void test_a_base_has_to_leave_room_for_what_is_on_top(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        begin_with(100.0, 100.0, 25.0);
        bench_move_to(10.0 * sign, 10.0);
        watch_cycles(100);
        superimpose(10.0 * sign, 1.0);
        const cm1e_axis_command_t bad = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 15.1 * sign, .velocity = 5.0,
                                         .buffer_mode = mcBuffered};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_try_command(&bad));
        const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, 14.9 * sign, 5.0, mcBuffered);
        watch_cycles(12000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_DOUBLE_WITHIN(1e-3, 24.9 * sign, bench_info().set_position);
    }
}

/* A motion that replaces a faster one passes its own end and comes back. The base has to leave room for that way too. */
static void test_a_base_has_to_leave_room_for_what_is_on_top_and_passes_its_end(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        begin_with(100.0, 100.0, 25.0);
        bench_move_to(10.0 * sign, 2.0);
        watch_cycles(100);
        superimpose(10.0 * sign, 10.0);
        watch_cycles(500);
        superimpose(0.1 * sign, 10.0); /* half of the deceleration takes more than 1 u */
        const cm1e_axis_command_t bad = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 24.0 * sign, .velocity = 5.0,
                                         .buffer_mode = mcBuffered};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, bench_try_command(&bad));
        const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, 23.0 * sign, 5.0, mcBuffered);
        wait_for(id, CM1E_COMMAND_BUFFERED);
        watch_cycles(20000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_TRUE(watch.highest <= 25.0 && watch.lowest >= -25.0);
    }
}

static void test_continuous_update_and_override(void)
{
    bench_move_velocity(5.0);
    watch_cycles(300);
    const cm1e_command_id_t id = superimpose(4.0, 8.0);
    watch_cycles(200);
    cm1e_axis_command_t inputs = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 6.0, .velocity = 4.0};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axis, id, &inputs));
    watch_cycles(100);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.0, 1.0, 1.0));
    watch_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axis->setpoint.velocity);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.5, 0.5, 0.5));
    wait_for(id, CM1E_COMMAND_DONE);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 6.0, covered(id));
    inputs.velocity = -1.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axis, id, &inputs)); /* ended: nothing happens */
}

/* It would wait for ever for what cannot be computed. */
static void test_an_override_that_leaves_nothing_refuses_it_in_standstill(void)
{
    cm1e_command_id_t id;
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 1.0, .velocity = 1.0};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.75, 1e-300, 0.8));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, cm1e_axis_start(axis, &c, &id));
    bench_told("Acceleration 0 was commanded, which selects the maximum of");
    bench_told("and the factor 1e-300 of MC_SetOverride: together they are too small to compute with");
    watch_cycles(10);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, axis->state);
}

/* What goes on top cannot end on the spot for a command that nobody can compute: it goes on, and so does its base. */
static void test_dynamics_of_next_to_nothing_are_refused_and_change_nothing(void)
{
    static const cm1e_axis_command_t commands[] = {
        {.kind = CM1E_COMMAND_HALT_SUPERIMPOSED, .deceleration = 1e-300, .jerk = 1600.0},
        {.kind = CM1E_COMMAND_HALT_SUPERIMPOSED, .jerk = 1e-300},
        {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 2.0, .velocity = 5.0, .acceleration = 1e-300},
        {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 2.0, .velocity = 1e-300},
    };
    static const char *const told[] = {"Deceleration 1e-300", "Jerk 1e-300", "Acceleration 1e-300", "Velocity 1e-300"};
    for (int i = 0; i < 4; i++)
        for (int moves = 0; moves < 2; moves++) {
            setUp();
            const cm1e_command_id_t base = moves ? bench_move_to(20.0, 10.0) : 0;
            watch_cycles(300);
            const cm1e_command_id_t first = superimpose(4.0, 5.0);
            watch_cycles(300);
            cm1e_command_id_t id = 1;
            const cm1e_error_t expected = i == 3 ? CM1E_ERROR_AXIS_VELOCITY_RANGE : CM1E_ERROR_AXIS_DYNAMICS_RANGE;
            TEST_ASSERT_EQUAL_INT(expected, cm1e_axis_start(axis, &commands[i], &id));
            TEST_ASSERT_EQUAL_UINT32(0, id);
            bench_told(told[i]);
            if (commands[i].kind == CM1E_COMMAND_MOVE_SUPERIMPOSED)
                TEST_ASSERT_EQUAL_INT(expected, cm1e_axis_update(axis, first, &commands[i]));
            wait_for(first, CM1E_COMMAND_DONE);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.0, covered(first));
            if (moves)
                wait_for(base, CM1E_COMMAND_DONE);
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, moves ? 24.0 : 4.0, bench_info().set_position);
        }
}

/* On top of a move it would have waited until that stood, and then for ever. */
static void test_dynamics_of_next_to_nothing_do_not_wait(void)
{
    const cm1e_command_id_t base = bench_move_to(20.0, 10.0);
    watch_cycles(300);
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 2.0, .velocity = 5.0,
                                         .acceleration = 1e-300, .deceleration = 1e-300};
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DYNAMICS_RANGE, cm1e_axis_start(axis, &command, &id));
    wait_for(base, CM1E_COMMAND_DONE);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, axis->state);
}

/* Anything on top of anything: no limit is exceeded by the sum in any cycle, and the software limits hold. */
static void test_random_programs_keep_all_limits(void)
{
    unsigned on_top = 0;
    for (unsigned run = 0; run < 250; run++) {
        begin_with(run % 3 ? 100.0 : 60.0, run % 3 ? 100.0 : 90.0, 60.0);
        watch.stretch = run % 3 ? 1.0 : 1.5; /* of two directions the larger limit may hold for the sum */
        seed = 0x9E3779B97F4A7C15u * (run + 1);
        char name[32];
        snprintf(name, sizeof name, "of run %u", run);
        watch.run = name;
        for (int i = 0; i < 3000; i++) {
            const double what = draw(0.0, 1.0);
            static const cm1e_command_kind_t kinds[] = {
                CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_MOVE_ADDITIVE,
                CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_HALT,
                CM1E_COMMAND_MOVE_SUPERIMPOSED, CM1E_COMMAND_MOVE_SUPERIMPOSED, CM1E_COMMAND_HALT_SUPERIMPOSED};
            const cm1e_axis_command_t command = {
                .kind = kinds[(int)draw(0.0, 8.999)], .position = draw(-20.0, 20.0), .velocity = draw(0.5, 30.0),
                .end_velocity = draw(-30.0, 30.0), .acceleration = draw(0.0, 1.0) < 0.5 ? 0.0 : draw(5.0, 60.0),
                .deceleration = draw(0.0, 1.0) < 0.5 ? 0.0 : draw(5.0, 60.0),
                .jerk = draw(0.0, 1.0) < 0.5 ? 0.0 : draw(100.0, 2000.0),
                .direction = draw(0.0, 1.0) < 0.5 ? mcPositiveDirection : mcNegativeDirection,
                .buffer_mode = (MC_BUFFER_MODE)draw(0.0, 5.99)};
            cm1e_command_id_t id;
            if (what < 0.02)
                (void)cm1e_axis_start(axis, &command, &id);
            else if (what < 0.025)
                (void)cm1e_axis_set_override(axis, draw(0.0, 1.0) < 0.3 ? 0.0 : draw(0.1, 1.0), draw(0.1, 1.0),
                                             draw(0.1, 1.0));
            watch_cycles(1);
            on_top += axis->superimposed.moving && axis->commands.active;
            WATCH(watch.highest <= 60.0 + 1e-6 && watch.lowest >= -60.0 - 1e-6, "outside");
            if (axis->state == CM1E_AXIS_ERROR_STOP) /* a velocity met a limit */
                break;
            TEST_ASSERT_EQUAL_INT(axis->state == CM1E_AXIS_STANDSTILL, axis_holds(axis));
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(20000, on_top);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_distance_is_added_to_a_move_at_any_time);
    RUN_TEST(test_a_base_that_needs_no_more_than_half_keeps_its_time);
    RUN_TEST(test_in_standstill_it_acts_like_a_relative_move);
    RUN_TEST(test_on_a_velocity);
    RUN_TEST(test_a_faster_base_that_begins_later_is_reduced_until_the_end);
    RUN_TEST(test_on_a_base_that_turns);
    RUN_TEST(test_on_a_base_with_a_small_jerk);
    RUN_TEST(test_on_a_halt_before_a_limit);
    RUN_TEST(test_another_one_replaces_the_first_only);
    RUN_TEST(test_its_share_of_the_limits_is_what_it_asks_for);
    RUN_TEST(test_halt_superimposed_ends_it_and_leaves_the_base);
    RUN_TEST(test_after_a_pause_the_base_ends_beyond_by_what_was_covered);
    RUN_TEST(test_an_aborting_command_ends_both_without_a_step);
    RUN_TEST(test_errors_and_power_end_it);
    RUN_TEST(test_a_disabled_direction_ends_what_goes_there);
    RUN_TEST(test_refusals);
    RUN_TEST(test_a_limit_has_to_leave_room_for_both);
    RUN_TEST(test_a_base_has_to_leave_room_for_what_is_on_top);
    RUN_TEST(test_a_base_has_to_leave_room_for_what_is_on_top_and_passes_its_end);
    RUN_TEST(test_continuous_update_and_override);
    RUN_TEST(test_an_override_that_leaves_nothing_refuses_it_in_standstill);
    RUN_TEST(test_dynamics_of_next_to_nothing_are_refused_and_change_nothing);
    RUN_TEST(test_dynamics_of_next_to_nothing_do_not_wait);
    RUN_TEST(test_random_programs_keep_all_limits);
    return UNITY_END();
}
