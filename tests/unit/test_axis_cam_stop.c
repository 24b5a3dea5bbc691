/* Slaves on a cam that cannot go on, with coupling_stop keep_ratio: how hard the master brakes, where the cam is flat and
 * where it is steep. */
#include "unity.h"

#include "../support/axes_cam.h"
#include "../support/chance.h"
#include "motion/cam.h"

enum { OTHER = 2 };

void setUp(void) {}
void tearDown(void) { axes_end(); }

static void failed(int n, cm1e_error_t error, const char *words)
{
    axes_must_be(n, CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT_MESSAGE(error, axes_info(n).error, axes_text(n));
    axes_told(n, words);
}

/* Cycles until its set-point stands. */
static int braking_of(int n)
{
    int cycles = 0;
    for (; cycles < 20000 && axes_info(n).set_velocity != 0.0; cycles++)
        axes_cycles(1);
    return cycles;
}

/* `deceleration`: of the slave; 0: the default. */
static void make_two(double deceleration, double software_limit)
{
    axes_describe(2);
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    if (deceleration > 0.0)
        axes_config(SLAVE)->max_deceleration = deceleration;
    axes_config(SLAVE)->software_limit_negative = -software_limit;
    axes_config(SLAVE)->software_limit_positive = software_limit;
    axes_make();
    axes_enable_all();
}

/* Flat at 0 up to 5 u of the master, then up by `height` within `way`, and flat up to 9 u; within 1 u it is back. */
static MC_CAM_ID select_step(double height, double way)
{
    points[0] = (MC_CAM_POINT){0.0, 0.0, 0, 0};
    points[1] = (MC_CAM_POINT){5.0, 0.0, 0, 0};
    points[2] = (MC_CAM_POINT){5.0 + way, height, 0, 0};
    points[3] = (MC_CAM_POINT){9.0, height, 0, 0};
    points[4] = (MC_CAM_POINT){10.0, 0.0, 0, 0};
    const MC_CAM_REF table = {points, 5, mcCamPolynomial5};
    return selected(SLAVE, &table, true, true);
}

/* A slave that still ramps into its cam, from a motion of its own, has no ratio to keep. The steepest place of the cam
 * would let the master go on for seconds. */
static void test_a_slave_that_ramps_into_its_cam_does_not_keep_its_master_turning(void)
{
    make_two(0.0, 2.0);
    const cm1e_axis_coupling_t coupling = by_cam(select_step(1.0, 0.05), mcRampIn);
    axes_move_velocity(MASTER, 10.0);
    axes_move_velocity(SLAVE, -10.0);
    AXES_UNTIL(axes_info(SLAVE).set_position < -1.4);
    cam_in(&coupling);
    for (int n = 0; n < 500 && axes_state(MASTER) != CM1E_AXIS_ERROR_STOP; n++)
        axes_cycles(1);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "the software limit at -2 u");
    failed(MASTER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
    TEST_ASSERT_LESS_THAN_INT(105, braking_of(MASTER)); /* 10 u/s at 100 u/s2 */
    axes_cycles(400);
    TEST_ASSERT_TRUE(axes_bench.witness[SLAVE].lowest >= -2.0);
}

/* ---- the way that is left --------------------------------------------------------------------------------------- */

/* The same cam as the slave's, to compare with. */
static cm1e_cam_t ideal;
static cm1e_cam_knot_t ideal_knots[200];

static MC_CAM_ID select_ideal(int count, MC_CAM_CURVE curve, bool periodic)
{
    const MC_CAM_REF table = {points, (UINT)count, curve};
    int at;
    TEST_ASSERT_EQUAL_INT(CM1E_CAM_GOOD, cm1e_cam_compile(&ideal, ideal_knots, 200, &table, periodic, &at));
    return selected(SLAVE, &table, periodic, true);
}

/* u of the slave beside its cam. */
static double beside_cam(void)
{
    cm1e_cam_place_t place = {0};
    cm1e_cam_sample_t here;
    cm1e_cam_sample(&ideal, &place, set_of(MASTER), &here);
    return set_of(SLAVE) - here.point.position - (ideal.periodic ? here.turn * ideal.advance : 0.0);
}

static double steepest(void) { return fmax(fabs(ideal.extremes.least_slope), fabs(ideal.extremes.most_slope)); }

/* What became of both after the slave could not go on. */
typedef struct fate {
    bool would_have;           /* kept the ratio by the steepest place of the cam */
    bool together;             /* both were stopped in step */
    double deceleration;       /* u/s2; of the master, just after that */
    double beside, hardest;    /* u beside the cam, u/s2 of the slave, at worst until both stood */
    int cycles;                /* until the master stood */
} fate_t;

/* From the cycle in which the slave has failed on. A slave that is stopped for its velocity lags in that cycle. */
static fate_t stop_of_both(void)
{
    fate_t fate = {.together = axes_state(MASTER) == CM1E_AXIS_ERROR_STOP};
    axes_told(SLAVE, "axis1");
    double before = axes_info(SLAVE).set_velocity;
    for (int n = 0; n < 20000 && !axis_free(axes_axis(SLAVE)) && !axis_free(axes_axis(MASTER)); n++) {
        axes_cycles(1);
        const double now = axes_info(SLAVE).set_velocity;
        if (n == 0)
            fate.deceleration = fabs(axes_axis(MASTER)->setpoint.acceleration);
        if (axes_info(MASTER).set_velocity != 0.0)
            fate.cycles = n + 1;
        if (fabs(now) < fabs(before) && now * before >= 0.0)
            fate.hardest = fmax(fate.hardest, (fabs(before) - fabs(now)) / 0.001);
        if (!axis_free(axes_axis(SLAVE)) && !axis_free(axes_axis(MASTER))) /* else it is where its motor is */
            fate.beside = fmax(fate.beside, fabs(beside_cam()));
        before = now;
    }
    return fate;
}

/* Slope 1 over 18 u of the master, then 0.5 u that are up to 18 times as steep, and on: a shaft with a cam that advances.
 * The slave meets its limit where the slope is 1. */
static void ride_shaft(void)
{
    points[0] = (MC_CAM_POINT){-9.0, -9.0, 1, 0};
    points[1] = (MC_CAM_POINT){9.0, 9.0, 1, 0};
    points[2] = (MC_CAM_POINT){9.5, 14.0, 1, 0};
    points[3] = (MC_CAM_POINT){10.0, 14.5, 1, 0};
    const cm1e_axis_coupling_t coupling = by_cam(select_ideal(4, mcCamPolynomial5, true), mcAbsolute);
    cam_in(&coupling);
}

static void meet_limit(double velocity)
{
    ride_shaft();
    axes_move_velocity(MASTER, velocity);
    AXES_UNTIL(axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "the software limit at");
    failed(MASTER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
}

static void kept_before_limit(const fate_t *fate, double deceleration)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, deceleration, fate->deceleration);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, 0.0, fate->beside);
    TEST_ASSERT_TRUE(fate->hardest <= 100.0 * (1.0 + 1e-6));
    TEST_ASSERT_TRUE(fabs(set_of(SLAVE)) <= 7.0);
}

static void test_where_the_cam_is_flat_the_master_brakes_as_hard_as_the_slave_can_there(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        make_two(0.0, 7.0);
        meet_limit(8.0 * sign);
        const fate_t fate = stop_of_both();
        kept_before_limit(&fate, 100.0);
        TEST_ASSERT_DOUBLE_WITHIN(3, 80, fate.cycles); /* by the steepest place of all it would be 1,400 */
        TEST_ASSERT_TRUE(fabs(set_of(SLAVE)) > 6.9);
        axes_end();
    }
}

/* A second slave follows the same master by a gear, and cannot brake as hard. */
static void test_the_master_brakes_no_harder_than_its_other_slave_can(void)
{
    axes_describe(3);
    for (int n = SLAVE; n <= OTHER; n++)
        axes_config(n)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(SLAVE)->software_limit_negative = -7.0;
    axes_config(SLAVE)->software_limit_positive = 7.0;
    axes_config(OTHER)->max_deceleration = 80.0;
    axes_make();
    axes_enable_all();
    axes_gear_in(OTHER, MASTER, 1, 1);
    meet_limit(8.0);
    fate_t fate = stop_of_both();
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 80.0, fate.deceleration);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, set_of(MASTER), set_of(OTHER));
}

/* What follows the slave cannot brake as hard as the slave itself. Braked by the steepest place of the cam, it can. */
static void test_the_master_brakes_no_harder_than_what_follows_its_slave_can(void)
{
    axes_describe(3);
    for (int n = SLAVE; n <= OTHER; n++)
        axes_config(n)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(SLAVE)->max_velocity = 2.0;
    axes_config(OTHER)->max_deceleration = 50.0;
    axes_make();
    axes_enable_all();
    axes_gear_in(OTHER, SLAVE, 1, 1);
    ride_shaft();
    axes_move_velocity(MASTER, 2.5);
    AXES_UNTIL(axes_state(SLAVE) == CM1E_AXIS_ERROR_STOP);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "velocity");
    const fate_t fate = stop_of_both();
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50.0, fate.deceleration);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, 0.0, fate.beside);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, set_of(SLAVE), set_of(OTHER));
}

static bool answers_miss;

/* A motor has lost a part of its velocity when the answers come again. */
static void slow_down(cm1e_bus_t *motor)
{
    static int32_t before[2];
    int32_t *of_motor = &before[motor == axes_motor(SLAVE)];
    if (answers_miss)
        motor->velocity_raw = *of_motor / 10 * 9;
    else
        *of_motor = motor->velocity_raw;
}

/* The ramp begins anew with the velocity that is left, and with the deceleration that it had. */
static void test_lost_answers_on_the_ramp_cost_no_ratio(void)
{
    for (int silent = 1; silent < 6; silent++) {
        make_two(20.0, 7.0);
        for (int n = MASTER; n <= SLAVE; n++) {
            axes_motor(n)->world = slow_down;
            axes_bench.witness[n].strictness = AXES_UNWATCHED; /* it loses velocity */
        }
        meet_limit(8.0);
        axes_cycles(50);
        answers_miss = true;
        axes_bench.received = CM1E_ERROR_TIMEOUT;
        axes_cycles(silent);
        axes_bench.received = CM1E_OK;
        axes_cycles(1);
        answers_miss = false;
        TEST_ASSERT_TRUE(axes_info(MASTER).set_velocity < 6.5);
        const fate_t fate = stop_of_both();
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 20.0, fate.deceleration);
        TEST_ASSERT_DOUBLE_WITHIN(2e-5, 0.0, fate.beside);
        axes_end();
    }
}

/* A program takes its power away because of the error: the ratio is what coupling_stop asks for then. */
static void test_power_that_is_taken_away_because_of_the_error_costs_no_ratio(void)
{
    make_two(50.0, 7.0);
    meet_limit(8.0);
    axes_power(MASTER, false);
    axes_power(SLAVE, false);
    const fate_t fate = stop_of_both();
    kept_before_limit(&fate, 50.0);
    axes_cycles(100);
    for (int n = MASTER; n <= SLAVE; n++)
        TEST_ASSERT_TRUE(axis_free(axes_axis(n)));
}

/* ---- random cams ------------------------------------------------------------------------------------------------- */

enum { POINTS = 8 };

/* Hills and rests; it begins at 0, at rest. */
static MC_CAM_ID random_cam(void)
{
    const int count = 2 + pick(POINTS - 1);
    double master = 0.0, slave = 0.0;
    for (int i = 0; i < count; i++) {
        points[i] = (MC_CAM_POINT){master, slave, 0.0, 0.0};
        const double way = one_in(3) ? uniform(0.3, 1.0) : uniform(1.0, 8.0);
        master += way;
        slave += one_in(3) ? 0.0 : way * uniform(-1.5, 1.5);
    }
    if (one_in(2))
        points[count - 1].Slave = 0.0;
    return select_ideal(count, one_in(3) ? mcCamCubicSpline : mcCamPolynomial5, one_in(4) ? false : true);
}

/* Whether a slave that follows its cam while the master brakes with `a` keeps its limits, and a little more. */
static bool would_keep(double a)
{
    const cm1e_motion_limits_t *most = &axes_axis(SLAVE)->limits.maximum;
    const double m = set_of(MASTER), v0 = axes_info(MASTER).set_velocity, sign = v0 > 0.0 ? 1.0 : -1.0, t = 0.001;
    double before = 0.0;
    for (int n = 0; n < 20000; n++) {
        cm1e_cam_place_t place = {0};
        cm1e_cam_sample_t here;
        const double braked = fmin(n * t, fabs(v0) / a), v = v0 - sign * a * braked;
        cm1e_cam_sample(&ideal, &place, m + (v0 + v) / 2.0 * braked, &here);
        const double now = here.point.slope * v, change = fabs(now - before) / t;
        const double line = here.point.position + (ideal.periodic ? here.turn * ideal.advance : 0.0);
        const double end = line + now * fabs(now) * axes_axis(SLAVE)->limits.emergency_way;
        const double bound = fabs(now) > fabs(before) ? most->acceleration : most->deceleration;
        const double of_point = here.point.curvature * v * v - here.point.slope * sign * a;
        if (n > 1 && (change > 0.99 * bound || fabs(of_point) > 0.99 * bound)) /* it may lag in the first cycle */
            return false;
        if (n > 0 && fabs(now) > most->velocity)
            return false;
        if (end > axes_axis(SLAVE)->limits.upper || end < axes_axis(SLAVE)->limits.lower)
            return false;
        if (v * sign <= 0.0)
            break;
        before = now;
    }
    return true;
}

/* The slave is a little slow for its cam, or comes to its software limit by a cam that advances. */
static bool random_stop(fate_t *fate)
{
    axes_describe(2);
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(SLAVE)->max_velocity = uniform(2.0, 15.0);
    axes_config(SLAVE)->max_acceleration = uniform(100.0, 400.0);
    axes_config(SLAVE)->max_deceleration = uniform(50.0, 400.0);
    axes_config(SLAVE)->max_jerk = 50000.0;
    axes_config(MASTER)->max_deceleration = uniform(50.0, 400.0);
    axes_config(SLAVE)->invert = one_in(2);
    axes_config(SLAVE)->software_limit_negative = -uniform(5.0, 40.0);
    axes_config(SLAVE)->software_limit_positive = uniform(5.0, 40.0);
    axes_make();
    axes_enable_all();
    const cm1e_axis_coupling_t coupling = by_cam(random_cam(), mcAbsolute);
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling};
    cm1e_command_id_t id;
    if (cm1e_axis_start(axes_axis(SLAVE), &command, &id) != CM1E_OK)
        return false; /* beyond its limits */
    for (int n = 0; n < 6000 && axes_state(SLAVE) != CM1E_AXIS_ERROR_STOP; n++) {
        if (n % 1500 == 0)
            axes_command(MASTER, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                        .velocity = uniform(-6.0, 6.0), .acceleration = 10.0,
                                                        .jerk = 300.0});
        axes_cycles(1);
    }
    if (axes_state(SLAVE) != CM1E_AXIS_ERROR_STOP)
        return false;
    const double own = axes_axis(SLAVE)->limits.emergency.deceleration;
    const bool would_have = would_keep(fmin(axes_axis(MASTER)->limits.emergency.deceleration, own / steepest()));
    *fate = stop_of_both();
    fate->would_have = would_have;
    return true;
}

/* Where the ratio is kept by a master that brakes as gently as the steepest place of the cam allows, it is kept by one that
 * brakes harder. */
static void test_on_any_cam_braking_harder_costs_no_ratio(void)
{
    int together = 0, harder = 0, would_have = 0, kept = 0;
    for (int run = 0; run < seed_count(2000); run++) {
        char words[120];
        fate_t fate;
        chance_seed(seed_of(run));
        if (random_stop(&fate) && fate.together) {
            const double own = axes_axis(SLAVE)->limits.emergency.deceleration;
            snprintf(words, sizeof words, "seed %u: master %g u/s2, slave %g of %g, %g u beside its cam", seed_of(run),
                     fate.deceleration, fate.hardest, own, fate.beside);
            TEST_ASSERT_TRUE_MESSAGE(fate.hardest <= own * (1.0 + 1e-6) + 1e-3, words);
            TEST_ASSERT_TRUE_MESSAGE(fate.beside < 1e-3 || !fate.would_have, words);
            together++;
            harder += fate.deceleration * steepest() > own * (1.0 + 1e-6);
            would_have += fate.would_have;
            kept += fate.beside < 1e-3;
        }
        axes_end();
    }
    printf("%d stopped together, %d harder than the steepest place allows; %d would have kept the ratio, %d did\n",
           together, harder, would_have, kept);
    TEST_ASSERT_TRUE(seeds_given() || (harder * 20 > together && kept >= would_have));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_slave_that_ramps_into_its_cam_does_not_keep_its_master_turning);
    RUN_TEST(test_where_the_cam_is_flat_the_master_brakes_as_hard_as_the_slave_can_there);
    RUN_TEST(test_the_master_brakes_no_harder_than_its_other_slave_can);
    RUN_TEST(test_the_master_brakes_no_harder_than_what_follows_its_slave_can);
    RUN_TEST(test_lost_answers_on_the_ramp_cost_no_ratio);
    RUN_TEST(test_power_that_is_taken_away_because_of_the_error_costs_no_ratio);
    RUN_TEST(test_on_any_cam_braking_harder_costs_no_ratio);
    return UNITY_END();
}
