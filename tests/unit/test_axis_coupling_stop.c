/* Followers that cannot go on: limits, directions, masters that fail in every way, and who stops with them. */
#include "unity.h"

#include "../support/axes_bench.h"
#include "axis/axis_parameters.h"
#include "axis/axis_watch.h"
#include "../support/random_master.h"
#include "../support/ordinary_witness.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

enum { MASTER = 0, SLAVE = 1, OTHER = 2 };

static void begin(cm1e_coupling_stop_t stop)
{
    axes_describe(3);
    axes_config(SLAVE)->coupling_stop = stop;
    axes_make();
    axes_enable_all();
}

static void failed(int n, cm1e_error_t error, const char *words)
{
    axes_must_be(n, CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT_MESSAGE(error, axes_info(n).error, axes_text(n));
    axes_told(n, words);
}

/* Every axis comes to rest within its limits (the bench watches) and loses its torque; the reset leads back. */
static void stands_and_can_be_reset(int n)
{
    axes_cycles(400);
    TEST_ASSERT_TRUE(axis_free(axes_axis(n)));
    (void)cm1e_axis_reset(axes_axis(n));
    axes_cycles(100);
    axes_must_be(n, CM1E_AXIS_STANDSTILL);
}

/* ---- the guard --------------------------------------------------------------------------------------------------- */

typedef struct limit_case {
    const char *words;
    double velocity, acceleration, jerk; /* of the master; the slave goes twice as fast */
} limit_case_t;

static void test_a_set_point_beyond_a_limit_is_not_given_out(void)
{
    static const limit_case_t cases[] = {
        {"a velocity of", 40.0, 20.0, 200.0},
        {"an acceleration of", 20.0, 80.0, 400.0},
        {"a jerk of", 1.0, 40.0, 1500.0},
    };
    for (int i = 0; i < 3; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            begin(CM1E_COUPLING_STOP_THIS);
            const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 2 * sign, 1);
            axes_cycles(1);
            axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                        .velocity = cases[i].velocity,
                                                        .acceleration = cases[i].acceleration, .jerk = cases[i].jerk});
            axes_cycles(3000);
            failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, cases[i].words);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, axes_status(SLAVE, gear).state);
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLING_LIMIT, axes_status(SLAVE, gear).error);
            TEST_ASSERT_EQUAL_DOUBLE(cases[i].velocity, axes_info(MASTER).set_velocity); /* nothing happens to it */
            stands_and_can_be_reset(SLAVE);
        }
}

static void test_it_stops_before_a_software_limit(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        axes_describe(2);
        axes_config(SLAVE)->software_limit_negative = -20.0;
        axes_config(SLAVE)->software_limit_positive = 20.0;
        axes_make();
        axes_enable_all();
        axes_gear_in(SLAVE, MASTER, sign, 1);
        axes_move_velocity(MASTER, 10.0);
        axes_cycles(4000);
        failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "the software limit at");
        TEST_ASSERT_TRUE(axes_bench.witness[SLAVE].highest <= 20.0 && axes_bench.witness[SLAVE].lowest >= -20.0);
        TEST_ASSERT_DOUBLE_WITHIN(0.05, 20.0 * sign, axes_info(SLAVE).set_position); /* not before it must */
    }
}

/* What its master will do is not known: it has to be able to stop. */
static void test_a_software_limit_that_it_can_no_longer_stop_before_is_refused(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        const int limit = sign > 0 ? CM1E_PARAMETER_SW_LIMIT_POS : CM1E_PARAMETER_SW_LIMIT_NEG;
        const int enable = sign > 0 ? CM1E_PARAMETER_ENABLE_LIMIT_POS : CM1E_PARAMETER_ENABLE_LIMIT_NEG;
        axes_begin(2);
        axes_move_velocity(MASTER, 5.0 * sign);
        axes_wait_reached(SLAVE, axes_gear_in(SLAVE, MASTER, 1, 1), 2000);
        axes_cycles(1000);
        const double at = axes_info(SLAVE).set_position, v = axes_info(SLAVE).set_velocity;
        const double way = v * fabs(v) * axes_axis(SLAVE)->limits.emergency_way;
        TEST_ASSERT_TRUE(way * sign > 0.01);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axes_axis(SLAVE), limit, at + 1.01 * way));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axes_axis(SLAVE), enable, 1.0));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                              cm1e_axis_write_parameter(axes_axis(SLAVE), limit, at + 0.99 * way));
        axes_end();
    }
}

/* At its limit already, by a master that is seen to creep: a velocity of none is no way out, but one back is. */
static void test_it_does_not_creep_over_a_software_limit(void)
{
    axes_describe(2);
    axes_config(SLAVE)->software_limit_negative = -1.0;
    axes_config(SLAVE)->software_limit_positive = 1.0;
    axes_make();
    axes_enable_all();
    axes_wait(SLAVE, axes_move_to(SLAVE, -1.0, 5.0), 2000);
    for (int sign = -1; sign <= 1; sign++) {
        const from_t next = {cm1e_position_plus(axes_axis(SLAVE)->setpoint.position, 0.05 * sign), 0.0, 0.0, false};
        TEST_ASSERT_EQUAL_INT(sign < 0 ? GUARD_SOFTWARE_LIMIT : GUARD_KEPT,
                              cm1e_axis_guard(axes_axis(SLAVE), &next, false).limit);
    }
}

/* Also slower than 1 u/s, in both directions. */
static void test_braking_has_a_limit_of_its_own_at_every_speed(void)
{
    static const double speeds[] = {0.5, 0.9, 5.0};
    for (int i = 0; i < 6; i++) {
        const double sign = i % 2 ? -1.0 : 1.0, v0 = sign * speeds[i / 2];
        axes_describe(2);
        axes_config(SLAVE)->max_acceleration = 100.0;
        axes_config(SLAVE)->max_deceleration = 20.0;
        axes_make();
        axes_enable_all();
        axes_wait_reached(SLAVE, axes_move_velocity(SLAVE, v0), 2000);
        axes_cycles(2);
        for (int brakes = 0; brakes < 2; brakes++) { /* 50 u/s2 */
            const double v = v0 + (brakes ? -0.05 : 0.05) * sign, way = (v0 + v) / 2.0 * 0.001;
            const from_t next = {cm1e_position_plus(axes_axis(SLAVE)->setpoint.position, way * 50000.0), v, 0.0, false};
            TEST_ASSERT_EQUAL_INT(brakes ? GUARD_DECELERATION : GUARD_KEPT,
                                  cm1e_axis_guard(axes_axis(SLAVE), &next, false).limit);
        }
        /* in its positions alone: it falls back by what 50 u/s2 brake in a cycle */
        const double way = v0 * 0.001 - sign * 50.0 * 1e-6 / 2.0;
        const from_t next = {cm1e_position_plus(axes_axis(SLAVE)->setpoint.position, way * 50000.0),
                             v0 * (1.0 - 1e-6), 0.0, false};
        TEST_ASSERT_EQUAL_INT(GUARD_DECELERATION, cm1e_axis_guard(axes_axis(SLAVE), &next, true).limit);
    }
}

static void test_a_direction_that_is_not_enabled_stops_it(void)
{
    begin(CM1E_COUPLING_STOP_THIS);
    axes_bench.positive[SLAVE] = false;
    axes_cycles(1);
    axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_move_velocity(MASTER, -2.0);
    axes_cycles(300);
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    axes_move_velocity(MASTER, 2.0);
    axes_cycles(300);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "in a direction that MC_Power does not enable");
}

static void test_a_direction_that_is_taken_away_stops_it(void)
{
    begin(CM1E_COUPLING_STOP_THIS);
    axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_move_velocity(MASTER, 5.0);
    axes_cycles(300);
    axes_bench.positive[SLAVE] = false;
    axes_cycles(2);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "in a direction that MC_Power does not enable");
    stands_and_can_be_reset(SLAVE);
}

/* ---- masters that fail ------------------------------------------------------------------------------------------- */

static void fault_of_drive(void) { fake_bus_fault(axes_motor(MASTER), 0x2310); }
static void blocked_shaft(void) { axes_motor(MASTER)->blocked = true; }
static void no_power(void) { axes_power(MASTER, false); }
static void lost_enable(void) { axes_motor(MASTER)->state = SWITCH_ON_DISABLED; }
static void away(void) { axes_motor(MASTER)->watch.lost = true; }

static void homing(void)
{
    static const cm1e_homing_config_t hard_stop = {.method = -1};
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT});
    axes_cycles(300);
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .homing = &hard_stop});
}

static const struct {
    void (*act)(void);
    const char *words;
} failures[] = {
    {fault_of_drive, "is in ErrorStop"}, {blocked_shaft, ""}, {no_power, "has no torque"},
    {lost_enable, "is in ErrorStop"}, {away, "is in ErrorStop"}, {homing, "is homed by its drive"},
};

/* Whatever happens, at whatever moment: never a step of the slave's set-point, one error with a sentence, a reset. */
static void test_every_failure_of_a_master_stops_the_slave_by_itself(void)
{
    for (size_t i = 0; i < sizeof failures / sizeof failures[0]; i++)
        for (int moment = 1; moment < 250; moment += 31)
            for (int mode = CM1E_COUPLING_STOP_THIS; mode <= CM1E_COUPLING_STOP_KEEP_RATIO; mode++) {
                begin((cm1e_coupling_stop_t)mode);
                axes_bench.witness[MASTER].strictness = AXES_UNWATCHED;
                axes_gear_in(SLAVE, MASTER, -1, 1);
                axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 8.0,
                                                            .jerk = 1500.0});
                axes_cycles(moment);
                failures[i].act();
                for (int n = 0; n < 2000 && axes_state(SLAVE) != CM1E_AXIS_ERROR_STOP; n++)
                    axes_cycles(1);
                failed(SLAVE, CM1E_ERROR_AXIS_MASTER_LOST, failures[i].words);
                axes_told(SLAVE, "\"axis0\"");
                stands_and_can_be_reset(SLAVE);
                axes_must_be(OTHER, CM1E_AXIS_STANDSTILL);
            }
}

static void test_the_master_that_fails_is_named(void)
{
    for (int failing = 0; failing < 2; failing++) {
        axes_begin(3);
        const cm1e_axis_coupling_t both = {.master = {{.axis = axes_reference(0), .numerator = 1, .denominator = 1},
                                                      {.axis = axes_reference(1), .numerator = 1, .denominator = 1}}};
        axes_command(2, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_COMBINE_AXES, .coupling = &both});
        axes_cycles(10);
        fake_bus_fault(axes_motor(failing), 0x2310);
        axes_cycles(10);
        failed(2, CM1E_ERROR_AXIS_MASTER_LOST, failing ? "\"axis1\"" : "\"axis0\"");
        axes_told(2, cm1e_strerror(CM1E_ERROR_DRIVE_FAULT)); /* why it fails */
    }
}

static void test_a_master_that_is_destroyed_is_lost(void)
{
    begin(CM1E_COUPLING_STOP_KEEP_RATIO);
    axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_move_velocity(MASTER, 5.0);
    axes_cycles(300);
    cm1e_axis_destroy(axes_bench.axes[MASTER]);
    axes_bench.axes[MASTER] = NULL;
    axes_bench.cycle = 0;
    ordinary_inputs(axes_axis(SLAVE), CM1E_OK, CM1E_OK, axes_bench.bus.clock.virtual_now_ns);
    ordinary_outputs(axes_axis(SLAVE));
    failed(SLAVE, CM1E_ERROR_AXIS_MASTER_LOST, "does not exist any more");
}

/* ---- coupling_stop ----------------------------------------------------------------------------------------------- */

static void test_coupled_axes_stop_together(void)
{
    begin(CM1E_COUPLING_STOP_COUPLED);
    axes_gear_in(SLAVE, MASTER, 2, 1);
    axes_gear_in(OTHER, MASTER, 1, 2);
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 40.0,
                                                .acceleration = 20.0, .jerk = 200.0});
    axes_cycles(3000);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "a velocity of");
    failed(MASTER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
    failed(OTHER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
    for (int n = 0; n < 3; n++)
        stands_and_can_be_reset(n);
}

/* Also for an error of the slave's own. */
static void test_coupled_axes_stop_with_a_slave_whose_drive_fails(void)
{
    for (int mode = CM1E_COUPLING_STOP_THIS; mode <= CM1E_COUPLING_STOP_COUPLED; mode++) {
        begin((cm1e_coupling_stop_t)mode);
        axes_gear_in(SLAVE, MASTER, 1, 1);
        axes_move_velocity(MASTER, 5.0);
        axes_cycles(300);
        fake_bus_fault(axes_motor(SLAVE), 0x2310);
        axes_cycles(5);
        axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
        axes_must_be(MASTER, mode == CM1E_COUPLING_STOP_COUPLED ? CM1E_AXIS_ERROR_STOP : CM1E_AXIS_CONTINUOUS_MOTION);
        axes_must_be(OTHER, CM1E_AXIS_STANDSTILL);
    }
}

/* The pair brakes so that the ratio holds to the standstill, before the slave's limit. */
static void keeps_ratio_before_a_limit(int32_t numerator, uint32_t denominator, double limit)
{
    axes_describe(2);
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(SLAVE)->software_limit_negative = -limit;
    axes_config(SLAVE)->software_limit_positive = limit;
    axes_make();
    axes_enable_all();
    axes_gear_in(SLAVE, MASTER, numerator, denominator);
    axes_cycles(1);
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5.0,
                                                .acceleration = 20.0, .jerk = 400.0});
    for (int n = 0; n < 20000 && !axis_free(axes_axis(SLAVE)); n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, axes_info(MASTER).set_position * numerator / denominator,
                                  axes_info(SLAVE).set_position);
    }
    char words[60];
    snprintf(words, sizeof words, "the software limit at %g u", numerator > 0 ? limit : -limit);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, words);
    failed(MASTER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
    TEST_ASSERT_TRUE(fabs(axes_info(SLAVE).set_position) <= limit);
    TEST_ASSERT_TRUE(fabs(axes_info(SLAVE).set_position) > limit - 0.1);
    stands_and_can_be_reset(MASTER);
}

static void test_the_ratio_is_kept_to_the_standstill_before_a_software_limit(void)
{
    keeps_ratio_before_a_limit(1, 1, 10.0);
    keeps_ratio_before_a_limit(-3, 1, 10.0);
    keeps_ratio_before_a_limit(1, 4, 3.0);
    keeps_ratio_before_a_limit(1, 10, 1.0);
    keeps_ratio_before_a_limit(-1, 10, 1.0);
}

/* Beyond a software limit a slave may stand, also while its master is held at 0 by an override, and it may go back. */
static void test_a_slave_beyond_a_software_limit_stands_and_is_led_back(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        axes_describe(2);
        axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
        axes_config(SLAVE)->software_limit_negative = -10.0;
        axes_config(SLAVE)->software_limit_positive = 10.0;
        axes_motor(SLAVE)->position = axes_motor(SLAVE)->target_position = 12 * 50000 * sign;
        axes_make();
        axes_enable_all();
        TEST_ASSERT_EQUAL_DOUBLE(12.0 * sign, axes_info(SLAVE).set_position);
        axes_gear_in(SLAVE, MASTER, 1, 1);
        axes_cycles(50);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(MASTER), 0.0, 1.0, 1.0));
        const cm1e_command_id_t back = axes_move_to(MASTER, -5.0 * sign, 4.0);
        axes_cycles(50);
        axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axes_axis(MASTER), 1.0, 1.0, 1.0));
        axes_wait(MASTER, back, 5000);
        axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, 7.0 * sign, axes_info(SLAVE).set_position);
    }
}

static void test_the_ratio_is_kept_where_the_master_becomes_too_fast(void)
{
    begin(CM1E_COUPLING_STOP_KEEP_RATIO);
    axes_gear_in(SLAVE, MASTER, 2, 1);
    axes_cycles(1);
    axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 40.0,
                                                .acceleration = 20.0, .jerk = 200.0});
    for (int n = 0; n < 5000 && !axis_free(axes_axis(SLAVE)); n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, axes_info(MASTER).set_position * 2.0, axes_info(SLAVE).set_position);
    }
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "a velocity of");
    failed(MASTER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
}

/* What a run with a random master and a slave that it may be too fast for came to. */
typedef struct fate {
    int stopped;      /* cycle; 0: it has not */
    bool with_master;
    double worst;     /* counts of the slave beside its gear, from InGear to the standstill */
} fate_t;

static double beside_gear(position_t slave, position_t master, double ratio)
{
    const cm1e_axis_t *axis = axes_axis(SLAVE);
    const double counts = cm1e_position_minus(axes_axis(MASTER)->setpoint.position, master);
    return cm1e_position_minus(axis->setpoint.position, slave) -
           counts / axes_axis(MASTER)->position.scale * ratio * axis->position.scale;
}

static fate_t random_run(cm1e_coupling_stop_t mode)
{
    fate_t fate = {0};
    axes_describe(2);
    for (int n = 0; n < 2; n++) {
        axes_config(n)->max_velocity = uniform(5.0, 40.0);
        axes_config(n)->max_acceleration = uniform(20.0, 200.0);
        axes_config(n)->max_deceleration = one_in(2) ? 0.0 : uniform(20.0, 200.0);
        axes_config(n)->max_jerk = uniform(300.0, 6000.0);
        axes_config(n)->invert = one_in(2);
    }
    axes_config(SLAVE)->coupling_stop = mode;
    axes_make();
    axes_enable_all();
    const int numerator = 1 + pick(3);
    const uint32_t denominator = 1 + (uint32_t)pick(3);
    const double ratio = (double)numerator / denominator;
    random_master_t master = random_master_for(MASTER, SLAVE, ratio, 1.0);
    if (one_in(2))
        master.most.velocity = fmin(axes_config(MASTER)->max_velocity, master.most.velocity * 1.2);
    position_t places[2] = {axes_axis(SLAVE)->setpoint.position, axes_axis(MASTER)->setpoint.position};
    axes_gear_in(SLAVE, MASTER, numerator, denominator);
    for (int n = 1; n < 5000; n++) {
        if (!fate.stopped)
            random_master_drive(&master);
        axes_cycles(1);
        if (!fate.stopped && axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP) {
            fate.stopped = n;
            fate.with_master = axes_state(MASTER) == CM1E_AXIS_ERROR_STOP;
        }
        if (!axis_free(axes_axis(SLAVE)) && !axis_free(axes_axis(MASTER))) /* else it is where its motor is */
            fate.worst = fmax(fate.worst, fabs(beside_gear(places[0], places[1], ratio)));
    }
    return fate;
}

/* A slave is as fast as it may be with any coupling_stop, and stops for the same reasons in the same cycle. */
static bool stops_alike(unsigned seed)
{
    char words[40];
    snprintf(words, sizeof words, "seed %u", seed);
    chance_seed(seed);
    const fate_t alone = random_run(CM1E_COUPLING_STOP_THIS);
    chance_seed(seed);
    const fate_t together = random_run(CM1E_COUPLING_STOP_KEEP_RATIO);
    TEST_ASSERT_EQUAL_INT_MESSAGE(alone.stopped, together.stopped, words);
    TEST_ASSERT_EQUAL_MESSAGE(together.stopped != 0, together.with_master, words);
    if (together.with_master)
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.2, 0.0, together.worst, words);
    return together.with_master;
}

static void test_keep_ratio_stops_no_slave_that_could_go_on(void)
{
    TEST_ASSERT_TRUE(stops_alike(520)); /* the master passes the velocity of the slave within a cycle */
    for (int run = 0; run < seed_count(100); run++)
        (void)stops_alike(seed_of(run));
}

static void test_equal_axes_reach_their_maximum_velocity_together(void)
{
    begin(CM1E_COUPLING_STOP_KEEP_RATIO);
    const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, 1);
    const double most = axes_axis(SLAVE)->limits.maximum.velocity;
    axes_move_velocity(MASTER, most);
    axes_cycles(5000);
    TEST_ASSERT_EQUAL_DOUBLE(most, axes_info(SLAVE).set_velocity);
    TEST_ASSERT_TRUE(axes_status(SLAVE, gear).reached);
}

/* A slave that still accelerates into its gear has no ratio to keep. The slave has a gentle deceleration, and the gear a
 * large ratio: what is right for the ratio would let the master go on for a minute. */
static void test_a_slave_that_is_not_in_gear_yet_does_not_keep_its_master_turning(void)
{
    axes_describe(2);
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(SLAVE)->max_deceleration = 5.0;
    axes_config(SLAVE)->software_limit_negative = -10.0;
    axes_config(SLAVE)->software_limit_positive = 10.0;
    axes_make();
    axes_enable_all();
    axes_move_velocity(MASTER, 20.0);
    axes_cycles(1000);
    TEST_ASSERT_EQUAL_DOUBLE(20.0, axes_info(MASTER).set_velocity);
    axes_gear_in(SLAVE, MASTER, 30, 1);
    for (int n = 0; n < 20000 && axes_state(MASTER) != CM1E_AXIS_ERROR_STOP; n++)
        axes_cycles(1);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "the software limit at 10 u");
    failed(MASTER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
    int braking = 0;
    for (; braking < 20000 && axes_info(MASTER).set_velocity != 0.0; braking++)
        axes_cycles(1);
    TEST_ASSERT_LESS_THAN_INT(2000, braking);
    axes_cycles(5000);
    TEST_ASSERT_TRUE(axes_info(SLAVE).set_position <= 10.0 && axes_info(SLAVE).set_position > 9.0);
}

/* Into gear at nearly the maximum velocity, behind a master that is too fast, and from a large velocity into a gear of a
 * small ratio, whose master would brake as gently as the ratio allows: no limit is broken, whatever coupling_stop says. */
static void test_a_slave_that_gives_way_on_its_way_into_gear_stops_nobody(void)
{
    static const struct { double own, masters; uint32_t denominator; bool gets_there; } runs[] = {
        {0.0, 7.99, 1, true}, {0.0, 12.0, 1, false}, {7.0, 0.5, 100, true},
    };
    for (int n = 0; n < 3; n++) {
        axes_describe(2);
        axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
        axes_config(SLAVE)->max_velocity = 8.0;
        axes_config(SLAVE)->software_limit_negative = -20.0;
        axes_config(SLAVE)->software_limit_positive = 20.0;
        axes_make();
        axes_enable_all();
        if (runs[n].own != 0.0)
            axes_move_velocity(SLAVE, runs[n].own);
        axes_move_velocity(MASTER, runs[n].masters);
        axes_cycles(1000);
        const cm1e_command_id_t gear = axes_gear_in(SLAVE, MASTER, 1, runs[n].denominator);
        axes_cycles(1000);
        axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
        axes_must_be(MASTER, CM1E_AXIS_CONTINUOUS_MOTION);
        TEST_ASSERT_EQUAL(runs[n].gets_there, axes_status(SLAVE, gear).reached);
        TEST_ASSERT_EQUAL(runs[n].gets_there, !cm1e_axis_has_text(axes_axis(SLAVE)));
        if (runs[n].gets_there)
            TEST_ASSERT_EQUAL_STRING("", axes_text(SLAVE));
        else
            axes_told(SLAVE, "its master asks it for 12 u/s, and its maximum is 8 u/s");
        if (runs[n].gets_there)
            continue;
        const cm1e_axis_command_t out = {.kind = CM1E_COMMAND_CAM_OUT}; /* what was refused does not hide it */
        axes_refused(SLAVE, &out, CM1E_ERROR_AXIS_NOT_COUPLED);
        axes_told(SLAVE, "needs an axis that follows a master by MC_CamIn; this one follows MC_GearIn. Axis \"axis1\" "
                         "is not in step: its master asks it for 12 u/s");
    }
}

/* A master that brakes by its own error is followed to its standstill. */
static void test_the_ratio_is_kept_on_the_ramp_of_a_master_that_fails(void)
{
    axes_describe(2);
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(MASTER)->software_limit_negative = -8.0;
    axes_config(MASTER)->software_limit_positive = 8.0;
    axes_make();
    axes_enable_all();
    axes_gear_in(SLAVE, MASTER, -1, 2);
    axes_move_velocity(MASTER, 8.0);
    for (int n = 0; n < 5000 && !axis_free(axes_axis(SLAVE)); n++) {
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, axes_info(MASTER).set_position / -2.0, axes_info(SLAVE).set_position);
    }
    failed(MASTER, CM1E_ERROR_AXIS_POSITION_RANGE, "limit");
    failed(SLAVE, CM1E_ERROR_AXIS_MASTER_LOST, "\"axis0\"");
    stands_and_can_be_reset(SLAVE);
}

/* The slave follows only as far as it can: it leaves a ramp that is too steep for it. */
static void test_a_ramp_that_is_too_steep_is_not_followed(void)
{
    axes_describe(2);
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(SLAVE)->max_deceleration = 30.0;
    axes_config(MASTER)->software_limit_negative = -8.0;
    axes_config(MASTER)->software_limit_positive = 8.0;
    axes_make();
    axes_enable_all();
    axes_gear_in(SLAVE, MASTER, 1, 1);
    axes_move_velocity(MASTER, 8.0);
    axes_cycles(3000);
    failed(SLAVE, CM1E_ERROR_AXIS_MASTER_LOST, "\"axis0\"");
    stands_and_can_be_reset(SLAVE);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_set_point_beyond_a_limit_is_not_given_out);
    RUN_TEST(test_it_stops_before_a_software_limit);
    RUN_TEST(test_it_does_not_creep_over_a_software_limit);
    RUN_TEST(test_a_software_limit_that_it_can_no_longer_stop_before_is_refused);
    RUN_TEST(test_braking_has_a_limit_of_its_own_at_every_speed);
    RUN_TEST(test_a_direction_that_is_not_enabled_stops_it);
    RUN_TEST(test_a_direction_that_is_taken_away_stops_it);
    RUN_TEST(test_every_failure_of_a_master_stops_the_slave_by_itself);
    RUN_TEST(test_the_master_that_fails_is_named);
    RUN_TEST(test_a_master_that_is_destroyed_is_lost);
    RUN_TEST(test_coupled_axes_stop_together);
    RUN_TEST(test_coupled_axes_stop_with_a_slave_whose_drive_fails);
    RUN_TEST(test_the_ratio_is_kept_to_the_standstill_before_a_software_limit);
    RUN_TEST(test_a_slave_beyond_a_software_limit_stands_and_is_led_back);
    RUN_TEST(test_the_ratio_is_kept_where_the_master_becomes_too_fast);
    RUN_TEST(test_keep_ratio_stops_no_slave_that_could_go_on);
    RUN_TEST(test_equal_axes_reach_their_maximum_velocity_together);
    RUN_TEST(test_a_slave_that_is_not_in_gear_yet_does_not_keep_its_master_turning);
    RUN_TEST(test_a_slave_that_gives_way_on_its_way_into_gear_stops_nobody);
    RUN_TEST(test_the_ratio_is_kept_on_the_ramp_of_a_master_that_fails);
    RUN_TEST(test_a_ramp_that_is_too_steep_is_not_followed);
    return UNITY_END();
}
