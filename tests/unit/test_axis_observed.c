/* Slaves of an actual value: encoders that a program writes, and motors. Against where the master truly is, in counts;
 * the bench watches that every set-point follows from the one before within the limits of the slave. */
#include "unity.h"

#include "../support/axes_bench.h"
#include "coupling/coupling_private.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

enum { MASTER = 0, SLAVE = 1, LOST_LIMIT = 3 };

/* The encoder: where it truly is at a time, and what is read of that. */
static struct encoder {
    double (*at)(double time_s);
    int64_t first;                 /* its counter at 0 */
    double noise;                  /* counts, to either side */
    uint64_t seed;
    int silent;                    /* cycles left in which nothing is read of it */
    bool invalid;                  /* the program says that the counts are not valid */
} encoder;

static double time_s(void) { return (double)axes_bench.cycle * 1e-3; }

static double noise(void)
{
    encoder.seed = encoder.seed * 6364136223846793005u + 1442695040888963407u;
    return encoder.noise * ((double)(encoder.seed >> 33) / (double)(1u << 30) - 1.0);
}

static void read_encoder(void)
{
    if (encoder.silent > 0 && encoder.silent--) {
        if (encoder.invalid)
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_write_encoder(axes_reference(MASTER), 12345, false));
        return;
    }
    const int64_t counts = encoder.first + llround(encoder.at(time_s()) + noise());
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_write_encoder(axes_reference(MASTER), (uint32_t)(uint64_t)counts, true));
}

static void begin_with(double (*at)(double time_s), double filter_s)
{
    axes_describe(2);
    axes_config(MASTER)->type = CM1E_AXIS_ENCODER;
    axes_config(MASTER)->counts_per_unit = 1000.0;
    axes_config(MASTER)->encoder_filter_s = filter_s;
    axes_bench.bus.config.lost_cycles_limit = LOST_LIMIT;
    encoder = (struct encoder){.at = at, .first = INT64_C(0xFFFFF000), .seed = 1};
    axes_make();
    axes_bench.program = read_encoder;
    axes_bench.witness[SLAVE].strictness = AXES_STEEP;
    axes_enable(SLAVE);
    axes_cycles(200);
}

/* Counts of the slave on one of the encoder, and both when the slave was in step. */
static double counts_ratio, zero_true;
static position_t zero_slave;

static cm1e_command_id_t follow(int32_t numerator, uint32_t denominator, MC_SOURCE source)
{
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .source = source,
                                                       .numerator = numerator, .denominator = denominator}}};
    const cm1e_command_id_t id =
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling});
    axes_wait_reached(SLAVE, id, 3000);
    counts_ratio = (double)numerator / denominator * axes_axis(SLAVE)->position.scale /
                   axes_axis(MASTER)->position.scale;
    return id;
}

/* The set-point of the last cycle is for its time. */
static double true_now(void) { return encoder.at(time_s() - 1e-3); }

static void take_zero(void)
{
    zero_true = true_now();
    zero_slave = axes_axis(SLAVE)->setpoint.position;
}

/* Counts of the encoder. */
static double off(void)
{
    return cm1e_position_minus(axes_axis(SLAVE)->setpoint.position, zero_slave) / counts_ratio -
           (true_now() - zero_true);
}

static double still(double t)
{
    (void)t;
    return 0.0;
}
static double steady(double t) { return 12345.6 * t; }
static double backwards(double t) { return -300000.0 * t; }
static double swinging(double t) { return 3000.0 * sin(2.0 * t); }
static double starting(double t)
{
    return t < 1.0 ? 0.0 : t < 2.0 ? 5000.0 * (t - 1.0) * (t - 1.0) : 10000.0 * t - 15000.0;
}
/* From 1 s on, for 4 s. */
static double going_and_resting(double t)
{
    const double u = t - 1.0, w = u - 3.0;
    return u < 0.0 ? 0.0 : u < 1.0 ? 35000.0 * u * u : u < 3.0 ? 70000.0 * u - 35000.0
           : u < 4.0 ? 175000.0 + 70000.0 * w - 35000.0 * w * w : 210000.0;
}

/* ---- encoders ---------------------------------------------------------------------------------------------------- */

/* From its first sample on there is no lag: the estimate is off by what rounding makes, and so is the zero. */
static void test_slave_is_where_the_encoder_is(void)
{
    static const struct {
        double (*at)(double);
        double counts;
    } ways[] = {{still, 0.01}, {steady, 5.0}, {backwards, 5.0}, {swinging, 6.0}, {starting, 6.0}};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        begin_with(ways[i].at, 0.0);
        follow(1, 50, i % 2 ? mcActualValue : mcSetValue);
        take_zero();
        double worst = 0.0;
        for (int n = 0; n < 5000; n++) {
            axes_cycles(1);
            worst = fmax(worst, fabs(off()));
        }
        char said[64];
        snprintf(said, sizeof said, "way %d: %.3f counts", (int)i, worst);
        TEST_ASSERT_TRUE_MESSAGE(worst <= ways[i].counts, said);
    }
}

/* Over the end of its counter, and however long: what is left at rest is not a count. */
/* What is shown as acceleration is the change of the velocity, as the drives and the next coupling expect it. */
static void test_the_acceleration_of_the_slave_is_the_change_of_its_velocity(void)
{
    begin_with(swinging, 0.05);
    follow(1, 50, mcActualValue);
    double largest = 0.0;
    for (int n = 0; n < 4000; n++) {
        const double before = axes_info(SLAVE).set_velocity;
        axes_cycles(1);
        const cm1e_axis_info_t now = axes_info(SLAVE);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, (now.set_velocity - before) / 1e-3, now.set_acceleration);
        largest = fmax(largest, fabs(now.set_acceleration));
    }
    TEST_ASSERT_TRUE(largest > 12.0 / 50.0); /* 3 u, 2 rad/s, and the noise of whole counts */
}

static void test_nothing_is_lost_on_a_long_way(void)
{
    begin_with(going_and_resting, 0.0);
    follow(1, 40, mcActualValue);
    const position_t before = axes_axis(SLAVE)->setpoint.position;
    axes_cycles(6000);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 210000.0 * counts_ratio,
                              cm1e_position_minus(axes_axis(SLAVE)->setpoint.position, before));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(SLAVE).set_velocity);
}

static void test_noise_of_the_encoder_is_smoothed(void)
{
    double worst[2] = {0};
    for (int slow = 0; slow < 2; slow++) {
        begin_with(steady, slow ? 0.03 : 0.004);
        encoder.noise = 2.0;
        axes_cycles(500);
        follow(1, 50, mcActualValue);
        axes_cycles(200);
        for (int n = 0; n < 4000; n++) {
            axes_cycles(1);
            worst[slow] = fmax(worst[slow], fabs(axes_info(SLAVE).set_velocity - 12.3456 / 50.0));
        }
    }
    TEST_ASSERT_TRUE(worst[1] < worst[0] / 5.0);
}

/* A few cycles without a value: it is taken to go on as it did. */
static void test_short_silence_is_ridden_out(void)
{
    for (int lost = 1; lost <= LOST_LIMIT; lost++)
        for (int invalid = 0; invalid < 2; invalid++) {
            begin_with(swinging, 0.0);
            follow(-1, 50, mcActualValue);
            take_zero();
            for (int n = 0; n < 40; n++) {
                encoder.silent = lost;
                encoder.invalid = invalid;
                axes_cycles(97);
                axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
                TEST_ASSERT_DOUBLE_WITHIN(6.0, 0.0, off());
            }
        }
}

static void test_long_silence_stops_the_slave(void)
{
    begin_with(steady, 0.0);
    const cm1e_command_id_t gear = follow(1, 50, mcActualValue);
    encoder.silent = LOST_LIMIT + 1;
    axes_cycles(LOST_LIMIT + 1);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    axes_cycles(1); /* what was not written is seen in the next one */
    axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_MASTER_LOST, axes_info(SLAVE).error);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_ERROR, axes_status(SLAVE, gear).state);
    axes_cycles(2000);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(SLAVE).set_velocity);
    cm1e_axis_reset(axes_axis(SLAVE));
    axes_cycles(100);
    axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
    follow(1, 50, mcActualValue);
    axes_cycles(100);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

/* No set-point goes with it. */
static double jumping(double t) { return t < 2.0 ? 1000.0 * t : 1000.0 * t + 500000.0; }

static void test_an_encoder_that_jumps_stops_the_slave(void)
{
    begin_with(jumping, 0.0);
    follow(1, 50, mcActualValue);
    AXES_UNTIL(axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_COUPLING_LIMIT, axes_info(SLAVE).error);
    axes_told(SLAVE, "encoder_filter_s");
    TEST_ASSERT_EQUAL_INT64(2001, (int64_t)axes_bench.cycle - 1);
}

static void test_an_encoder_that_was_never_read_is_no_master(void)
{
    begin_with(steady, 0.0);
    axes_make();
    axes_bench.program = NULL;
    axes_enable(SLAVE);
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .source = mcActualValue,
                                                       .numerator = 1, .denominator = 1}}};
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling};
    axes_refused(SLAVE, &c, CM1E_ERROR_AXIS_MASTER_LOST);
    axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
    axes_bench.program = read_encoder;
    axes_cycles(200);
    axes_command(SLAVE, &c);
}

/* docs/BUS-FILE.md: encoder_filter_s is 10 cycles where nothing is given. */
static void test_the_filter_has_ten_cycles_by_default(void)
{
    begin_with(steady, 0.0);
    const cm1e_observer_t by_default = axes_axis(MASTER)->followed->own.filter;
    begin_with(steady, 0.010);
    TEST_ASSERT_EQUAL_DOUBLE(axes_axis(MASTER)->followed->own.filter.velocity_gain, by_default.velocity_gain);
}

/* A shift against it is as against any master. */
static void test_an_encoder_is_shifted(void)
{
    begin_with(steady, 0.0);
    follow(1, 50, mcActualValue);
    take_zero();
    const cm1e_axis_coupling_t master = {.master = {{.axis = axes_reference(MASTER)}}};
    const cm1e_command_id_t id =
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_PHASING_ABSOLUTE, .position = 5.0,
                                                   .velocity = 10.0, .coupling = &master});
    axes_wait(SLAVE, id, 3000);
    TEST_ASSERT_EQUAL(CM1E_COMMAND_DONE, axes_status(SLAVE, id).state);
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 5000.0, off());
}

/* From a program, between inputs and set-points: what is seen is a cycle ahead of the slave's set-point then. */
static bool coupled;
static void couple_in_the_program(void)
{
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(MASTER), .source = mcActualValue,
                                                       .numerator = 1, .denominator = 10}}};
    if (encoder.at)
        read_encoder();
    if (!coupled)
        axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling});
    coupled = true;
}

static double fast(double t) { return 40000.0 * t; }

static void test_a_coupling_from_a_program_begins_without_a_step(void)
{
    begin_with(fast, 0.05);
    axes_cycles(2000);
    coupled = false;
    axes_bench.program = couple_in_the_program;
    axes_cycles(500);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    axes_bench.program = read_encoder;
    TEST_ASSERT_DOUBLE_WITHIN(0.2, 4.0, axes_info(SLAVE).set_velocity);
}

/* It has gone elsewhere meanwhile. */
static void test_after_a_long_silence_an_encoder_is_where_it_says(void)
{
    begin_with(going_and_resting, 0.0);
    axes_cycles(1000);
    encoder.silent = 4500;
    axes_cycles(4502);
    follow(1, 50, mcActualValue);
    axes_cycles(100);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(SLAVE).set_position);
}

/* It would be farther and farther away, in the end than numbers are. */
static void test_an_estimate_does_not_go_on_through_a_long_silence(void)
{
    begin_with(steady, 0.0);
    axes_cycles(500);
    encoder.silent = 10000;
    axes_cycles(100);
    const observed_t before = axes_axis(MASTER)->followed->own;
    TEST_ASSERT_TRUE(before.filter.velocity != 0.0);
    axes_cycles(9000);
    TEST_ASSERT_EQUAL_INT64(before.filter.counts, axes_axis(MASTER)->followed->own.filter.counts);
}

/* ---- motors ------------------------------------------------------------------------------------------------------ */

static void begin_motors(void)
{
    axes_begin(2);
    axes_bench.witness[SLAVE].strictness = AXES_STEEP;
    counts_ratio = 1.0;
}

/* One that goes exactly where it is told, a cycle late, is seen where its set-point is. */
static void test_actual_value_of_a_motor_that_moves(void)
{
    begin_motors();
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5.0, .jerk = 100.0,
                                                .acceleration = 20.0});
    axes_cycles(50); /* it accelerates */
    follow(1, 1, mcActualValue);
    axes_cycles(1000);
    const double apart = axes_info(SLAVE).set_position - axes_info(MASTER).set_position;
    for (int n = 0; n < 1000; n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(4.0 / 50000.0, apart, axes_info(SLAVE).set_position - axes_info(MASTER).set_position);
    }
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT, .jerk = 200.0});
    axes_cycles(3000);
    TEST_ASSERT_DOUBLE_WITHIN(4.0 / 50000.0, apart, axes_info(SLAVE).set_position - axes_info(MASTER).set_position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(SLAVE).set_velocity);
}

/* The slave moves with the master already. To follow its actual value from now on changes no step of its set-point. */
static void test_from_the_set_value_to_the_actual_value_without_a_step(void)
{
    encoder.at = NULL;
    for (int in_program = 0; in_program < 2; in_program++) {
        begin_motors();
        axes_gear_in(SLAVE, MASTER, 1, 10);
        axes_move_velocity(MASTER, 5.0);
        axes_cycles(2000);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.5, axes_info(SLAVE).set_velocity);
        coupled = false;
        if (in_program)
            axes_bench.program = couple_in_the_program;
        else
            couple_in_the_program();
        for (int n = 0; n < 100; n++) {
            const double before = axes_info(SLAVE).set_position;
            axes_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(1.0 / 50000.0, 0.0005, axes_info(SLAVE).set_position - before);
        }
        axes_end();
    }
}

static const cm1e_axis_coupling_t by_actual = {.master = {{.source = mcActualValue, .numerator = 1,
                                                           .denominator = 100}}};

/* Of a motor that moves as it is told the velocity and the acceleration are known: its estimate has no run-in. */
static void test_the_estimate_of_a_motor_begins_with_its_set_point(void)
{
    begin_motors();
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 10.0, .jerk = 1000.0,
                                                .acceleration = 40.0});
    axes_cycles(100);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 40.0, axes_info(MASTER).set_acceleration);
    cm1e_axis_coupling_t coupling = by_actual;
    coupling.master[0].axis = axes_reference(MASTER);
    axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling});
    for (int n = 0; n < 30; n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(0.05, axes_info(MASTER).set_velocity, axes_axis(MASTER)->followed->own.now.velocity);
    }
}

/* Without torque the set-point says nothing: the estimate begins with the velocity that the drive reports. */
static void test_the_estimate_of_a_motor_without_torque_begins_with_its_actual_velocity(void)
{
    begin_motors();
    axes_power(MASTER, false);
    axes_cycles(20);
    axes_must_be(MASTER, CM1E_AXIS_DISABLED);
    for (int n = 0; n < 50; n++) {
        axes_motor(MASTER)->position += 100;
        axes_motor(MASTER)->velocity_raw = 100000; /* 2 u/s */
        axes_cycles(1);
    }
    cm1e_axis_coupling_t coupling = by_actual;
    coupling.master[0].axis = axes_reference(MASTER);
    axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling});
    for (int n = 0; n < 30; n++) {
        axes_motor(MASTER)->position += 100;
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 2.0, axes_axis(MASTER)->followed->own.now.velocity);
    }
}

/* Without torque, turned by hand. */
static double turned_by;
static int turning;
static void turn_by_hand(void)
{
    if (turning < 3142)
        turned_by += 40.0 * (1.0 - cos(turning++ * 2e-3)) / 2.0;
    axes_motor(MASTER)->position = (int32_t)lround(turned_by);
}

static void test_a_master_by_its_actual_value_may_be_disabled(void)
{
    begin_motors();
    axes_power(MASTER, false);
    axes_cycles(20);
    axes_must_be(MASTER, CM1E_AXIS_DISABLED);
    follow(-2, 1, mcActualValue);
    turned_by = axes_motor(MASTER)->position;
    const double begin = turned_by, slave = axes_info(SLAVE).set_position;
    turning = 0;
    axes_bench.program = turn_by_hand;
    axes_cycles(6000);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    TEST_ASSERT_DOUBLE_WITHIN(2.0 / 50000.0, slave - 2.0 * (axes_motor(MASTER)->position - begin) / 50000.0,
                              axes_info(SLAVE).set_position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(SLAVE).set_velocity);
}

static void test_a_virtual_master_by_its_actual_value(void)
{
    axes_describe(2);
    axes_config(MASTER)->type = CM1E_AXIS_VIRTUAL;
    axes_make();
    axes_enable_all();
    axes_bench.witness[SLAVE].strictness = AXES_STEEP;
    counts_ratio = 1.0;
    follow(1, 1, mcActualValue);
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 20.0, .velocity = 10.0,
                                                .acceleration = 40.0, .deceleration = 40.0, .jerk = 400.0});
    axes_cycles(4000);
    TEST_ASSERT_DOUBLE_WITHIN(1.0 / 50000.0, 20.0, axes_info(SLAVE).set_position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_info(SLAVE).set_velocity);
}

static void test_a_master_that_fails_is_lost_by_its_actual_value_too(void)
{
    begin_motors();
    axes_move_velocity(MASTER, 3.0);
    axes_cycles(500);
    follow(1, 1, mcActualValue);
    fake_bus_fault(axes_motor(MASTER), 0x2310);
    axes_cycles(2);
    axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_MASTER_LOST, axes_info(SLAVE).error);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_slave_is_where_the_encoder_is);
    RUN_TEST(test_the_acceleration_of_the_slave_is_the_change_of_its_velocity);
    RUN_TEST(test_nothing_is_lost_on_a_long_way);
    RUN_TEST(test_noise_of_the_encoder_is_smoothed);
    RUN_TEST(test_short_silence_is_ridden_out);
    RUN_TEST(test_long_silence_stops_the_slave);
    RUN_TEST(test_an_encoder_that_jumps_stops_the_slave);
    RUN_TEST(test_an_encoder_that_was_never_read_is_no_master);
    RUN_TEST(test_the_filter_has_ten_cycles_by_default);
    RUN_TEST(test_an_encoder_is_shifted);
    RUN_TEST(test_a_coupling_from_a_program_begins_without_a_step);
    RUN_TEST(test_after_a_long_silence_an_encoder_is_where_it_says);
    RUN_TEST(test_an_estimate_does_not_go_on_through_a_long_silence);
    RUN_TEST(test_actual_value_of_a_motor_that_moves);
    RUN_TEST(test_from_the_set_value_to_the_actual_value_without_a_step);
    RUN_TEST(test_the_estimate_of_a_motor_begins_with_its_set_point);
    RUN_TEST(test_the_estimate_of_a_motor_without_torque_begins_with_its_actual_velocity);
    RUN_TEST(test_a_master_by_its_actual_value_may_be_disabled);
    RUN_TEST(test_a_virtual_master_by_its_actual_value);
    RUN_TEST(test_a_master_that_fails_is_lost_by_its_actual_value_too);
    return UNITY_END();
}
