/*
 * An axis that follows masters has short ways through a cycle too. The same random program runs twice with the same
 * axes: once as it is, once with every axis in the long way. All set-points must have the same bits, in every cycle.
 * CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_SEEDS=<count> as many from there on.
 */
#include "unity.h"

#include "axis/axis_parameters.h"
#include "coupling/coupling_private.h"

#include "../support/axes_bench.h"
#include "../support/chance.h"
#include "../support/ordinary_witness.h"

enum { AXES = 4, RUNS = 120, CYCLES = 2500 };

/* No function knows this bit of cm1e_axis_t.extras, but an axis that has one takes the long way. */
static const uint8_t always_something = 0x80;

typedef struct seen {
    position_t position;
    double velocity, acceleration;
    cm1e_axis_state_t state;
    bool reached, brakes_hard, in_position;
} seen_t;

static seen_t seen[2][CYCLES][AXES];
static unsigned long long led_cycles;

void setUp(void) {}
void tearDown(void) { axes_end(); }

static void begin(unsigned seed, bool long_way)
{
    chance_seed(seed);
    axes_describe(AXES);
    for (int n = 0; n < AXES; n++) {
        axes_config(n)->max_jerk = one_in(3) ? 0.0 : uniform(2000.0, 20000.0);
        axes_config(n)->invert = one_in(3);
        if (n > 0 && one_in(2)) { /* limits near what they follow */
            axes_config(n)->max_velocity = uniform(1.0, 10.0);
            axes_config(n)->max_acceleration = uniform(10.0, 50.0);
            axes_config(n)->max_deceleration = uniform(10.0, 50.0);
        }
        if (n > 0 && one_in(3)) {
            axes_config(n)->software_limit_negative = uniform(-10.0, -2.0);
            axes_config(n)->software_limit_positive = uniform(2.0, 10.0);
        }
    }
    axes_make();
    for (int n = 0; n < AXES; n++)
        axes_axis(n)->extras |= long_way ? always_something : 0;
    axes_enable_all();
    for (int n = 0; n < AXES; n++) /* programs without order break limits of slaves */
        axes_bench.witness[n].strictness = AXES_UNWATCHED;
}

/* A cam of any curve over 1 ... 8 u of the master, mostly up and down. */
static MC_CAM_ID select_cam(int n)
{
    MC_CAM_POINT points[9] = {{.Master = 0.0}};
    const int count = 3 + pick(7);
    for (int i = 1; i < count; i++)
        points[i] = (MC_CAM_POINT){.Master = points[i - 1].Master + uniform(0.3, 1.0), .Slave = uniform(-0.5, 0.5)};
    if (!one_in(3))
        points[count - 1].Slave = 0.0;
    if (one_in(4)) /* a corner at the ends */
        points[0].Velocity = uniform(-0.2, 0.2);
    const MC_CAM_REF table = {.Points = points, .NumberOfPoints = count,
                              .Curve = one_in(4) ? mcCamLinear : one_in(2) ? mcCamCubicSpline : mcCamPolynomial5};
    MC_CAM_ID id;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_cam_select(axes_axis(n), &table, !one_in(4), one_in(2), one_in(2), &id));
    return id;
}

static void follow_by_cam(int n)
{
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(pick(n)), .source = mcSetValue, .numerator = 1, .denominator = 1}},
        .cam = select_cam(n), .start_mode = mcRampIn, .slave_offset = one_in(2) ? uniform(-0.5, 0.5) : 0.0,
        .master_scaling = one_in(2) ? uniform(0.5, 2.0) : 0.0, .slave_scaling = one_in(2) ? uniform(-2.0, 2.0) : 0.0};
    cm1e_command_id_t id;
    (void)cm1e_axis_start(axes_axis(n), &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling,
                          .buffer_mode = one_in(4) ? mcBuffered : mcAborting}, &id);
}

static void follow(int n)
{
    const int master = pick(n), other = pick(n);
    const cm1e_axis_coupling_t coupling = {
        .master = {{.axis = axes_reference(master), .source = one_in(5) ? mcActualValue : mcSetValue,
                    .numerator = 1 + pick(3), .denominator = 2 + (uint32_t)pick(4)},
                   {.axis = axes_reference(other), .source = mcSetValue, .numerator = 1, .denominator = 4}},
        .master_sync_position = uniform(-3.0, 3.0), .slave_sync_position = uniform(-3.0, 3.0)};
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_GEAR_IN, CM1E_COMMAND_GEAR_IN, CM1E_COMMAND_COMBINE_AXES,
                                                CM1E_COMMAND_GEAR_IN_POS};
    cm1e_command_id_t id;
    (void)cm1e_axis_start(axes_axis(n), &(cm1e_axis_command_t){.kind = kinds[pick(4)], .coupling = &coupling,
                          .buffer_mode = one_in(4) ? mcBuffered : mcAborting}, &id);
}

static void move(int n)
{
    static const cm1e_command_kind_t kinds[] = {
        CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_HALT,
        CM1E_COMMAND_MOVE_SUPERIMPOSED, CM1E_COMMAND_GEAR_OUT, CM1E_COMMAND_PHASING_RELATIVE};
    const cm1e_axis_coupling_t coupling = {.master = {{.axis = axes_reference(n ? pick(n) : 1)}}};
    cm1e_command_id_t id;
    (void)cm1e_axis_start(axes_axis(n), &(cm1e_axis_command_t){
        .kind = kinds[pick(n ? 7 : 3)], .position = uniform(-10.0, 10.0), .velocity = uniform(0.5, 10.0),
        .acceleration = uniform(5.0, 50.0), .coupling = &coupling,
        .buffer_mode = n && one_in(3) ? mcBuffered : mcAborting}, &id);
}

/* A limit that the application may change. */
static void set_limit(int n)
{
    static const int numbers[] = {CM1E_PARAMETER_SW_LIMIT_POS, CM1E_PARAMETER_MAX_VELOCITY_APPL,
                                  CM1E_PARAMETER_MAX_ACCELERATION_APPL};
    (void)cm1e_axis_write_parameter(axes_axis(n), numbers[pick(3)], uniform(1.0, 50.0));
}

static void anything(void)
{
    const int n = pick(AXES);
    axes_bench.received = one_in(30) ? CM1E_ERROR_BUS_LOST : CM1E_OK;
    if (one_in(40))
        set_limit(n);
    if (one_in(40))
        axes_power(n, !axes_bench.on[n]);
    else if (one_in(10))
        (void)cm1e_axis_reset(axes_axis(n));
    else if (n > 0 && one_in(2))
        one_in(3) ? follow_by_cam(n) : follow(n);
    else
        move(n);
}

static void run(unsigned seed, int side)
{
    begin(seed, side == 1);
    for (int i = 0; i < CYCLES; i++) {
        axes_inputs();
        axes_bench.received = CM1E_OK;
        if (one_in(60))
            anything();
        axes_outputs();
        for (int n = 0; n < AXES; n++) {
            const setpoint_t *s = &axes_axis(n)->setpoint;
            seen_t *now = &seen[side][i][n];
            memset(now, 0, sizeof *now);
            now->position = s->position;
            now->velocity = s->velocity;
            now->acceleration = s->acceleration;
            now->state = axes_state(n);
            now->reached = s->reached;
            now->brakes_hard = s->brakes_hard;
            now->in_position = axes_axis(n)->in_position.inside;
            led_cycles += axes_state(n) == CM1E_AXIS_SYNCHRONIZED_MOTION;
        }
    }
}

static void test_slaves_side_by_side(void)
{
    const int runs = seed_count(RUNS);
    for (int i = 0; i < runs; i++) {
        run(seed_of(i), 0);
        run(seed_of(i), 1);
        for (int k = 0; k < CYCLES; k++)
            for (int n = 0; n < AXES; n++)
                AXES_MUST(memcmp(&seen[0][k][n], &seen[1][k][n], sizeof seen[0][k][n]) == 0,
                          "seed %u: axis %d in cycle %d is at %.17g u/s instead of %.17g", seed_of(i), n, k,
                          seen[0][k][n].velocity, seen[1][k][n].velocity);
    }
    printf("%llu cycles of slaves; %llu of %llu that follow are ordinary\n", led_cycles, cycles_followed_ordinary,
           cycles_followed);
    TEST_ASSERT_TRUE(seeds_given() || cycles_followed_ordinary > cycles_followed / 20);
    TEST_ASSERT_TRUE(seeds_given() || led_cycles > (unsigned long long)runs * CYCLES / 4);
}

/* ---- what changes in the middle of a course ---------------------------------------------------------------------- */

static bool decided_ahead(int n)
{
    const coupling_t *c = axes_axis(n)->coupling;
    return c->ordinary && c->course == axes_axis(n)->setpoint.course &&
           c->masters_course == c->now->links[0].master->setpoint.course;
}

static const cm1e_axis_coupling_t *one_to_one(void)
{
    static cm1e_axis_coupling_t coupling;
    coupling = (cm1e_axis_coupling_t){.master = {{.axis = axes_reference(0), .numerator = 1, .denominator = 1}}};
    return &coupling;
}

/* Axis 1 follows axis 0, which turns at 5 u/s for ever, and all its next cycles are decided. */
static void begin_course(void)
{
    axes_describe(2);
    axes_make();
    axes_enable_all();
    axes_command(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5.0, .acceleration = 50.0,
                                           .direction = mcPositiveDirection});
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = one_to_one()});
    axes_cycles(600);
    TEST_ASSERT_TRUE(axes_axis(1)->setpoint.reached && decided_ahead(1));
}

static void test_lower_limit_in_the_middle(void)
{
    begin_course();
    axes_bench.witness[1].strictness = AXES_UNWATCHED;
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_PARAMETER_RANGE,
                      cm1e_axis_write_parameter(axes_axis(1), CM1E_PARAMETER_MAX_VELOCITY_APPL, 4.0));
    const double now = fabs(axes_axis(1)->setpoint.velocity);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_write_parameter(axes_axis(1), CM1E_PARAMETER_MAX_VELOCITY_APPL, now));
    axes_cycles(1);
    TEST_ASSERT_EQUAL(CM1E_AXIS_SYNCHRONIZED_MOTION, axes_state(1));
    axes_command(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = now + 1.0,
                                           .direction = mcPositiveDirection});
    axes_cycles(100);
    TEST_ASSERT_EQUAL(CM1E_AXIS_ERROR_STOP, axes_state(1));
}

static void test_master_stops_in_the_middle(void)
{
    begin_course();
    axes_command(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT, .deceleration = 50.0});
    axes_cycles(400);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, axes_axis(1)->setpoint.velocity);
    TEST_ASSERT_EQUAL(CM1E_AXIS_SYNCHRONIZED_MOTION, axes_state(1));
}

/* A command that waits for the end of the cam begins there. */
static void test_command_waits_in_the_middle(void)
{
    MC_CAM_POINT points[] = {{.Master = 0.0}, {.Master = 0.5, .Slave = 0.01}, {.Master = 1.0}};
    const MC_CAM_REF table = {.Points = points, .NumberOfPoints = 3, .Curve = mcCamCubicSpline};
    axes_describe(2);
    axes_make();
    cm1e_axis_coupling_t coupling = *one_to_one();
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_cam_select(axes_axis(1), &table, true, false, false, &coupling.cam));
    axes_enable_all();
    axes_command(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5.0, .acceleration = 50.0,
                                           .direction = mcPositiveDirection});
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling});
    axes_cycles(900);
    TEST_ASSERT_TRUE(axes_axis(1)->setpoint.reached && decided_ahead(1));
    axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = one_to_one(),
                                           .buffer_mode = mcBuffered});
    axes_cycles(201); /* a turn of the cam, and less than a course */
    TEST_ASSERT_EQUAL(CM1E_COMMAND_GEAR_IN, axes_axis(1)->commands.kind);
}

/* Where the slave came to the corner at `at`, or a multiple of it, and stopped. The master comes from `from`. */
static void stops_at_a_corner(MC_CAM_CURVE curve, double slope, double from, double at)
{
    const MC_CAM_POINT points[] = {{0.0, 0.0, slope, 0.0}, {5.0, 0.1, 0.0, 0.0}, {10.0, 0.0, -slope, 0.0}};
    const MC_CAM_REF table = {points, 3, curve};
    axes_describe(2);
    axes_make();
    cm1e_axis_coupling_t coupling = *one_to_one();
    coupling.start_mode = mcRampIn;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_axis_cam_select(axes_axis(1), &table, true, true, true, &coupling.cam));
    axes_enable_all();
    axes_bench.witness[1].strictness = AXES_UNWATCHED;
    axes_wait(0, axes_move_to(0, from, 20.0), 5000);
    axes_wait_reached(1, axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &coupling}),
                      5000);
    axes_command(0, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 5.0, .acceleration = 50.0,
                                           .direction = mcPositiveDirection});
    AXES_UNTIL(axes_state(1) == CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL(CM1E_ERROR_AXIS_COUPLING_LIMIT, axes_info(1).error);
    axes_told(1, "an acceleration of");
    TEST_ASSERT_DOUBLE_WITHIN(0.011, 0.0, remainder(axes_info(0).set_position, at));
}

/* Straight lines have a corner at every point, and the end of a cam may be one: no course leads over it unseen. */
static void test_corner_in_the_middle(void)
{
    for (double from = -9.0; from < 10.0; from += 1.25) {
        stops_at_a_corner(mcCamLinear, 0.0, from, 5.0);
        stops_at_a_corner(mcCamPolynomial5, 0.05, from, 10.0);
    }
}

int main(void)
{
    followers_compared_every = 1;
    UNITY_BEGIN();
    RUN_TEST(test_lower_limit_in_the_middle);
    RUN_TEST(test_master_stops_in_the_middle);
    RUN_TEST(test_command_waits_in_the_middle);
    RUN_TEST(test_corner_in_the_middle);
    RUN_TEST(test_slaves_side_by_side);
    return UNITY_END();
}
