/* A motor that has run ahead of its set-point in a pause, because its load is heavy (axis_pursuit.c). */
#include "unity.h"

#include "../support/axes_bench.h"

enum { AXIS = 0, PAUSE = 15, LOST = 9, LONGEST = 250 }; /* cycles */

static const double VELOCITY = 4.0, TARGET = 6.0; /* u/s, u */

void setUp(void) {}
void tearDown(void) { axes_end(); }

/** The load: the motor changes its velocity by no more than so much in a cycle. Counts, cycles. */
static double hardest, place, speed, fastest, slowest;
static double way; /* 1 or -1 */

/** A servo that corrects its error in three cycles, as far as its torque allows. */
static void turn(cm1e_bus_t *bus)
{
    const double wanted = ((double)bus->target_position - place) / 3.0;
    speed += fmax(-hardest, fmin(hardest, wanted - speed));
    place += speed;
    fastest = fmax(fastest, way * speed);
    slowest = fmin(slowest, way * speed);
    bus->position = (int32_t)lround(place);
    const int64_t unit = cm1e_firmware_info(bus->firmware)->velocity_in_counts_per_ms ? 1000 : 1;
    bus->velocity_raw = (int32_t)lround(speed * 1e9 / (double)axes_bench.cycle_ns / (double)unit);
}

static double counts_of_cycle(void) { return VELOCITY * axes_axis(AXIS)->cycle_s * axes_axis(AXIS)->position.scale; }
static bool under_way(void) { return axes_axis(AXIS)->setpoint.pursuit.under_way; }

/** Cycles of the motion before; by how much the motor is ahead of the set-point. */
static double ahead(void)
{
    return way * (place / axes_axis(AXIS)->position.scale - axes_info(AXIS).set_position) * 1e3 / VELOCITY;
}

/** In the middle of a motion, with a motor that has followed without a load so far. */
static cm1e_command_id_t begin_among(int axes, double direction, double load)
{
    axes_begin(axes);
    way = direction;
    hardest = 1e9;
    speed = 0.0;
    place = axes_motor(AXIS)->position;
    axes_motor(AXIS)->world = turn;
    axes_bench.witness[AXIS].strictness = AXES_UNWATCHED;
    const cm1e_command_id_t id = axes_move_to(AXIS, way * TARGET, VELOCITY);
    axes_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(way * VELOCITY, axes_info(AXIS).set_velocity);
    hardest = load;
    fastest = slowest = way * speed;
    return id;
}

static cm1e_command_id_t begin(double direction, double load) { return begin_among(1, direction, load); }

/** No frames for some cycles, and the program is late: the drive holds its last target. */
static void pause_for(int cycles)
{
    for (int n = 0; n < cycles; n++)
        turn(axes_motor(AXIS));
    axes_motor(AXIS)->clock.virtual_now_ns += cycles * axes_bench.cycle_ns;
    axes_inputs();
    cm1e_axis_after_pause(axes_axis(AXIS), cycles * axes_bench.cycle_ns);
    axes_outputs();
}

/** Frames are lost: the axis holds its set-point. */
static void lose_frames(int cycles)
{
    axes_bench.received = CM1E_ERROR_TIMEOUT;
    axes_cycles(cycles);
    axes_bench.received = CM1E_OK;
}

/** Until the set-point and the motor have met; returns the cycles. It never goes back, and never faster than before. */
static int pursue(void)
{
    int cycles = 0;
    double before = axes_info(AXIS).set_velocity;
    for (; under_way(); cycles++) {
        axes_cycles(1);
        if (!under_way())
            break;
        const double velocity = way * axes_info(AXIS).set_velocity;
        TEST_ASSERT_TRUE(velocity >= 0.0 && velocity <= fmin(VELOCITY, way * before) + 1e-9);
        before = way * velocity;
    }
    return cycles;
}

static void test_the_set_point_goes_after_a_motor_that_has_run_ahead(void)
{
    static void (*const unheard[])(int) = {pause_for, lose_frames};
    static const int cycles[] = {PAUSE, LOST};
    for (int run = 0; run < 4; run++)
        for (double load = 4.0; load < 10.0; load += 2.0) {
            const cm1e_command_id_t id = begin(run % 2 ? 1.0 : -1.0, load);
            unheard[run / 2](cycles[run / 2]);
            axes_cycles(1);
            TEST_ASSERT_TRUE(under_way() && ahead() > 3.0);
            TEST_ASSERT_EQUAL_DOUBLE(way * VELOCITY, axes_info(AXIS).set_velocity);
            TEST_ASSERT_LESS_THAN_INT(60, pursue());
            TEST_ASSERT_TRUE(fabs(ahead()) < 1.5);
            axes_wait(AXIS, id, 5000);
            TEST_ASSERT_EQUAL_DOUBLE(way * TARGET, axes_info(AXIS).set_position);
            TEST_ASSERT_TRUE(fastest <= counts_of_cycle() * 1.01); /* it does not catch up afterwards */
            TEST_ASSERT_TRUE(slowest >= counts_of_cycle() * -0.35); /* nor is it pulled back */
        }
}

/** The pause is so long that the drive has turned the motor round: the set-point meets it on its way back. With a set-point
 *  at rest, far behind it, it would swing, and be too fast where it comes to its speed again. */
static void test_a_motor_that_is_on_its_way_back_is_met(void)
{
    static const double load = 8.0;
    for (int run = 0; run < 2; run++)
        for (int tenths = 10; tenths <= 14; tenths++) { /* of the time in which it stops */
            const cm1e_command_id_t id = begin(run ? 1.0 : -1.0, load);
            pause_for((int)(counts_of_cycle() / load) * tenths / 10);
            TEST_ASSERT_TRUE(way * speed < 0.0);
            axes_cycles(1);
            TEST_ASSERT_TRUE(under_way() && ahead() > 5.0);
            TEST_ASSERT_LESS_THAN_INT(60, pursue());
            TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(AXIS).set_velocity); /* they do not pass each other */
            axes_wait(AXIS, id, 5000);
            TEST_ASSERT_EQUAL_DOUBLE(way * TARGET, axes_info(AXIS).set_position);
            TEST_ASSERT_TRUE(fastest <= counts_of_cycle() * 1.01);
        }
}

/** It stops within its last target: the motion begins anew at once. */
static void test_a_motor_without_a_load_is_not_gone_after(void)
{
    const cm1e_command_id_t id = begin(1.0, 1e9);
    pause_for(PAUSE);
    TEST_ASSERT_FALSE(under_way());
    axes_cycles(1);
    TEST_ASSERT_FALSE(under_way());
    TEST_ASSERT_TRUE(axes_info(AXIS).set_velocity < VELOCITY / 2.0);
    axes_wait(AXIS, id, 5000);
    TEST_ASSERT_EQUAL_DOUBLE(TARGET, axes_info(AXIS).set_position);
}

/** Its load moves it: the set-point does not go after it for ever. */
static void test_a_motor_that_does_not_slow_down_is_gone_after_for_a_while(void)
{
    begin(1.0, 0.0);
    pause_for(PAUSE);
    axes_cycles(1);
    TEST_ASSERT_TRUE(under_way());
    TEST_ASSERT_INT_WITHIN(3, LONGEST, pursue());
    TEST_ASSERT_TRUE(ahead() > PAUSE - 3);
}

/** MC_Stop does not wait for the motor, and is done at rest. */
static void test_a_stop_meanwhile_stops_the_axis(void)
{
    begin(1.0, 4.0);
    pause_for(PAUSE);
    axes_cycles(5);
    TEST_ASSERT_TRUE(under_way());
    const cm1e_axis_command_t stop = {.kind = CM1E_COMMAND_STOP, .deceleration = 100.0};
    const cm1e_command_id_t id = axes_command(AXIS, &stop);
    axes_wait(AXIS, id, 300);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(AXIS).set_velocity);
    TEST_ASSERT_TRUE(axes_info(AXIS).set_position < TARGET / 2.0);
    axes_cycles(200);
    TEST_ASSERT_TRUE(fabs(ahead()) < 1.0);
}

/** A stop under way begins anew at rest behind the pause, and would be done while the motor still turns. */
static void test_a_stop_is_not_done_before_its_motor(void)
{
    begin(1.0, 4.0);
    const cm1e_axis_command_t stop = {.kind = CM1E_COMMAND_STOP, .deceleration = 100.0};
    const cm1e_command_id_t id = axes_command(AXIS, &stop);
    axes_cycles(10);
    pause_for(PAUSE);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(AXIS, id).state);
    int cycles = 0;
    for (; axes_status(AXIS, id).state == CM1E_COMMAND_ACTIVE && cycles < 1000; cycles++)
        axes_cycles(1);
    TEST_ASSERT_LESS_THAN_INT(100, cycles);
    TEST_ASSERT_TRUE(fabs(speed) < counts_of_cycle() / 4.0 && fabs(ahead()) < 1.5);
}

/** The other master of a sum has gone on already in the cycle in which the set-point of this one goes after its motor:
 *  the slave sees both ways, whichever of them is the first, and makes up what it loses. */
static void test_a_sum_goes_on_where_one_of_its_masters_is_gone_after(void)
{
    enum { OTHER = 1, SUM = 2, RUNS = 4 };
    for (int run = 0; run < RUNS; run++) {
        const int first = run % 2 ? AXIS : OTHER;
        begin_among(3, 1.0, 1e9);
        axes_bench.order[0] = run / 2 ? AXIS : OTHER;
        axes_bench.order[1] = run / 2 ? OTHER : AXIS;
        axes_bench.witness[SUM].strictness = AXES_UNWATCHED;
        axes_move_velocity(OTHER, 1.0);
        const cm1e_axis_coupling_t coupling = {
            .master = {{.axis = axes_reference(first), .numerator = 1, .denominator = 1},
                       {.axis = axes_reference(OTHER - first), .numerator = 1, .denominator = 1}},
            .combine = mcAddAxes};
        const cm1e_axis_command_t combine = {.kind = CM1E_COMMAND_COMBINE_AXES, .coupling = &coupling};
        axes_wait_reached(SUM, axes_command(SUM, &combine), 500);
        const double before = axes_info(SUM).set_position - axes_info(AXIS).set_position - axes_info(OTHER).set_position;
        hardest = 4.0;
        lose_frames(LOST);
        axes_cycles(1);
        TEST_ASSERT_TRUE(under_way());
        axes_cycles(3000);
        axes_must_be(SUM, CM1E_AXIS_SYNCHRONIZED_MOTION);
        const double after = axes_info(SUM).set_position - axes_info(AXIS).set_position - axes_info(OTHER).set_position;
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, before, after);
        axes_end();
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_set_point_goes_after_a_motor_that_has_run_ahead);
    RUN_TEST(test_a_motor_that_is_on_its_way_back_is_met);
    RUN_TEST(test_a_motor_without_a_load_is_not_gone_after);
    RUN_TEST(test_a_motor_that_does_not_slow_down_is_gone_after_for_a_while);
    RUN_TEST(test_a_stop_meanwhile_stops_the_axis);
    RUN_TEST(test_a_stop_is_not_done_before_its_motor);
    RUN_TEST(test_a_sum_goes_on_where_one_of_its_masters_is_gone_after);
    return UNITY_END();
}
