/* Cams: the memory of a slave for them, what is refused, and what the guard of the slave does not let pass. */
#include "unity.h"

#include "../support/axes_cam.h"
#include "axis/axis_events.h"
#include "coupling/coupling_private.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

static void refused(const MC_CAM_REF *table, cm1e_error_t expected, const char *words)
{
    MC_CAM_ID id = 77;
    TEST_ASSERT_EQUAL_INT(expected, cm1e_axis_cam_select(axes_axis(0), table, true, true, true, &id));
    TEST_ASSERT_EQUAL_UINT32(0, id);
    axes_told(0, words);
}

static void test_the_last_four_cams_stay(void)
{
    axes_begin(1);
    MC_CAM_ID ids[9];
    for (int i = 0; i < 9; i++) {
        const MC_CAM_REF table = table_of(2 + i);
        ids[i] = selected(0, &table, i % 2, i % 3);
        for (int k = 0; k <= i; k++) {
            const cam_slot_t *slot = cm1e_cam_memory_find(axes_axis(0), ids[k]);
            if (k <= i - CM1E_AXIS_CAMS) {
                TEST_ASSERT_NULL(slot);
                continue;
            }
            TEST_ASSERT_NOT_NULL(slot);
            TEST_ASSERT_EQUAL_INT(2 + k, slot->cam.count);
            TEST_ASSERT_EQUAL(k % 2, slot->cam.periodic);
            TEST_ASSERT_EQUAL(k % 3 != 0, slot->master_absolute);
            for (int p = 0; p < 2 + k; p++)
                TEST_ASSERT_EQUAL_DOUBLE(p % 2, slot->knots[p].slave);
        }
    }
    TEST_ASSERT_NULL(cm1e_cam_memory_find(axes_axis(0), 0));
    TEST_ASSERT_NULL(cm1e_cam_memory_find(axes_axis(0), 12345));
}

static void test_a_bad_cam_costs_no_good_one_and_is_told(void)
{
    axes_describe(1);
    axes_config(0)->cam_points = 20;
    axes_make();
    axes_enable_all();
    MC_CAM_REF table = table_of(20);
    MC_CAM_ID ids[CM1E_AXIS_CAMS];
    for (int i = 0; i < CM1E_AXIS_CAMS; i++)
        ids[i] = selected(0, &table, false, false);
    const MC_CAM_REF none = {NULL, 5, mcCamLinear};
    refused(&none, CM1E_ERROR_AXIS_CAM_TABLE, "expected 2 ... 20");
    table.NumberOfPoints = 1;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "only one");
    table = table_of(21);
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "too many points");
    table = table_of(20);
    table.Curve = (MC_CAM_CURVE)9;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "Curve");
    table = table_of(20);
    points[7].Slave = NAN;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "point 8");
    table = table_of(20);
    points[19].Master = 1.9e171;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "point 20 of a cam is not finite or beyond 1e30; expected -1e30 ... 1e30");
    table = table_of(20);
    points[7].Master = 6;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "point 8 of a cam is not above that of point 7");
    table = table_of(20);
    points[6].Master = points[7].Master - 1e-100;
    points[7].Master = 7e-120;
    for (int i = 0; i < 7; i++)
        points[i].Master = i * 1e-120;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "close together");
    for (int i = 0; i < CM1E_AXIS_CAMS; i++)
        TEST_ASSERT_NOT_NULL(cm1e_cam_memory_find(axes_axis(0), ids[i]));
    table = table_of(3);
    (void)selected(0, &table, false, false);
    TEST_ASSERT_EQUAL_STRING("", axes_text(0));
}

/* The application's points may change, or go, once they are taken. */
static void test_a_cam_is_a_copy(void)
{
    axes_begin(1);
    const MC_CAM_REF table = table_of(4);
    const cam_slot_t *slot = cm1e_cam_memory_find(axes_axis(0), selected(0, &table, false, true));
    memset(points, 0xff, sizeof points);
    cm1e_cam_place_t place = {0};
    cm1e_cam_sample_t sample;
    cm1e_cam_sample(&slot->cam, &place, 1, &sample);
    TEST_ASSERT_EQUAL_DOUBLE(1, sample.point.position);
}

/* ---- memory that was not set aside ------------------------------------------------------------------------------- */

static void begin_with(cm1e_follows_t master, cm1e_follows_t slave)
{
    axes_describe(2);
    axes_config(MASTER)->follows = master;
    axes_config(SLAVE)->follows = slave;
    axes_make();
    axes_enable_all();
}

static cm1e_axis_coupling_t by_gear(void)
{
    return (cm1e_axis_coupling_t){.master[0] = {.axis = axes_reference(MASTER), .numerator = 1, .denominator = 2}};
}

static void refuses_all(cm1e_command_kind_t kind, MC_BUFFER_MODE mode, const char *words)
{
    const cm1e_axis_coupling_t coupling = kind == CM1E_COMMAND_CAM_IN ? by_cam(1, mcRampIn) : by_gear();
    axes_refused(SLAVE, &(cm1e_axis_command_t){.kind = kind, .coupling = &coupling, .buffer_mode = mode},
                 CM1E_ERROR_AXIS_NO_COUPLINGS);
    axes_told(SLAVE, words);
    axes_told(SLAVE, "was refused");
}

/* It moves by itself as ever, and others follow it. */
static void test_an_axis_that_follows_nothing_refuses_it_in_words(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_GEAR_IN, CM1E_COMMAND_GEAR_IN_POS, CM1E_COMMAND_CAM_IN,
                                                CM1E_COMMAND_COMBINE_AXES};
    begin_with(CM1E_FOLLOWS_ANY, CM1E_FOLLOWS_NOTHING);
    TEST_ASSERT_NULL(axes_axis(SLAVE)->coupling);
    for (int i = 0; i < 4; i++)
        refuses_all(kinds[i], mcAborting, "`follows: nothing`");
    const cm1e_command_id_t id = axes_move_to(SLAVE, 2, 5);
    for (int i = 0; i < 4; i++)
        refuses_all(kinds[i], mcBuffered, "`follows: nothing`");
    const MC_CAM_REF table = table_of(3);
    MC_CAM_ID cam = 5;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NO_COUPLINGS,
                          cm1e_axis_cam_select(axes_axis(SLAVE), &table, true, true, true, &cam));
    TEST_ASSERT_EQUAL_UINT32(0, cam);
    axes_told(SLAVE, "the cam was not selected");
    axes_refused(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_OUT}, CM1E_ERROR_AXIS_NOT_COUPLED);
    axes_refused(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_PHASING_RELATIVE, .position = 1, .velocity = 1},
                 CM1E_ERROR_AXIS_NOT_COUPLED);
    axes_wait(SLAVE, id, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(SLAVE, id).state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2, set_of(SLAVE));
}

static void test_an_axis_that_follows_nothing_is_followed(void)
{
    for (int source = mcSetValue; source <= mcActualValue; source++) {
        begin_with(CM1E_FOLLOWS_NOTHING, CM1E_FOLLOWS_GEARS);
        axes_bench.witness[SLAVE].strictness = source == mcSetValue ? AXES_SMOOTH : AXES_STEEP;
        cm1e_axis_coupling_t coupling = by_gear();
        coupling.master[0].source = (MC_SOURCE)source;
        (void)axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, .coupling = &coupling});
        axes_wait(MASTER, axes_move_to(MASTER, 4, 5), 5000);
        axes_cycles(200);
        TEST_ASSERT_DOUBLE_WITHIN(source == mcSetValue ? 1e-6 : 1e-2, 2, set_of(SLAVE));
        cm1e_axis_fail(axes_axis(MASTER), CM1E_ERROR_AXIS_LAG, 0, 0);
        axes_cycles(2);
        axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
        axes_told(SLAVE, "its master \"axis0\"");
    }
}

/* An error of a slave stops its master too, in whose text stands why. */
static void test_an_axis_that_follows_nothing_stops_with_its_slave(void)
{
    axes_describe(2);
    axes_config(MASTER)->follows = CM1E_FOLLOWS_NOTHING;
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_COUPLED;
    axes_make();
    axes_enable_all();
    (void)axes_gear_in(SLAVE, MASTER, 1, 2);
    axes_move_velocity(MASTER, 5);
    axes_cycles(500);
    cm1e_axis_fail(axes_axis(SLAVE), CM1E_ERROR_AXIS_LAG, 0, 0);
    axes_cycles(1);
    axes_must_be(MASTER, CM1E_AXIS_ERROR_STOP);
    axes_told(MASTER, "was braked because axis \"axis1\"");
}

static void test_an_axis_that_follows_gears_has_no_cams(void)
{
    begin_with(CM1E_FOLLOWS_NOTHING, CM1E_FOLLOWS_GEARS);
    refuses_all(CM1E_COMMAND_CAM_IN, mcAborting, "`follows: gears`");
    const MC_CAM_REF table = table_of(3);
    MC_CAM_ID cam = 5;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NO_COUPLINGS,
                          cm1e_axis_cam_select(axes_axis(SLAVE), &table, true, true, true, &cam));
    axes_move_velocity(MASTER, 10);
    axes_cycles(500);
    cm1e_axis_coupling_t meet = by_gear();
    meet.master_sync_position = set_of(MASTER) + 2;
    meet.slave_sync_position = 300;
    axes_refused(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN_POS, .velocity = 20, .coupling = &meet},
                 CM1E_ERROR_AXIS_SYNC_WAY);
    axes_told(SLAVE, "needs a velocity of");
    axes_wait_reached(SLAVE, axes_gear_in(SLAVE, MASTER, 1, 2), 5000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5, axes_info(SLAVE).set_velocity);
}

/* An encoder and a drive that moves by itself follow nothing, whatever the configuration says. */
static void test_an_axis_that_cannot_follow_has_no_memory_for_it(void)
{
    const MC_CAM_REF table = table_of(3);
    MC_CAM_ID cam;
    axes_describe(2);
    axes_config(MASTER)->type = CM1E_AXIS_ENCODER;
    axes_config(SLAVE)->motion = CM1E_MOTION_DRIVE;
    axes_make();
    for (int n = MASTER; n <= SLAVE; n++) {
        TEST_ASSERT_NULL(axes_axis(n)->coupling);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NO_COUPLINGS,
                              cm1e_axis_cam_select(axes_axis(n), &table, true, true, true, &cam));
        axes_told(n, n == MASTER ? "it is an encoder" : "its drive makes the motions");
    }
}

/* ---- following --------------------------------------------------------------------------------------------------- */

/* The whole range of the cam is looked at before it begins, also what lies between its points. */
static void test_a_cam_that_leaves_the_software_limits_is_refused(void)
{
    axes_describe(2);
    axes_config(SLAVE)->software_limit_negative = -1;
    axes_config(SLAVE)->software_limit_positive = 1.5;
    axes_make();
    axes_enable_all();
    cm1e_axis_coupling_t coupling = by_cam(select_hill(1.5, 0, true, true, true), mcAbsolute);
    (void)cam_in(&coupling);
    coupling.slave_scaling = 1.01;
    cam_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
    axes_told(SLAVE, "MC_CamIn: the cam at this place, or the way to it, would leave -1 ... 1.5 u (software limits)");
    coupling.slave_scaling = -0.7;
    cam_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
    points[1] = (MC_CAM_POINT){5, 0, 1, 0}; /* from 0 to 0, but not in between */
    const MC_CAM_REF table = {points, 3, mcCamPolynomial5};
    coupling = by_cam(selected(SLAVE, &table, false, true), mcRampIn);
    (void)cam_in(&coupling);
    coupling.slave_scaling = 3;
    cam_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
}

static void test_a_cam_that_is_needed_is_not_overwritten(void)
{
    axes_begin(2);
    const cm1e_axis_coupling_t first = by_cam(select_hill(1.5, 0, true, true, true), mcAbsolute);
    (void)cam_in(&first);
    for (int i = 0; i < 3; i++) {
        const cm1e_axis_coupling_t next = by_cam(select_hill(1, 0, true, true, true), mcRampIn);
        (void)axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = &next,
                                                         .buffer_mode = mcBuffered});
    }
    const MC_CAM_REF table = table_of(3);
    MC_CAM_ID id = 5;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FULL, cm1e_axis_cam_select(axes_axis(SLAVE), &table, true, true, true, &id));
    TEST_ASSERT_EQUAL_UINT32(0, id);
    axes_told(SLAVE, "commands that wait name them");
    axes_cycles(10);
    (void)axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    (void)selected(SLAVE, &table, true, true);
}

static void test_wrong_inputs_are_refused(void)
{
    axes_begin(2);
    const MC_CAM_ID id = select_hill(1.5, 0, true, true, true);
    cm1e_axis_coupling_t coupling = by_cam(0, mcAbsolute);
    cam_refused(&coupling, CM1E_ERROR_AXIS_CAM_ID);
    axes_told(SLAVE, "now: 1.");
    coupling.cam = id + 1;
    cam_refused(&coupling, CM1E_ERROR_AXIS_CAM_ID);
    coupling = by_cam(id, (MC_START_MODE)3);
    cam_refused(&coupling, CM1E_ERROR_INVALID_ARGUMENT);
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e10, 1e-10};
    for (int i = 0; i < 5; i++) {
        coupling = by_cam(id, mcAbsolute);
        coupling.master_scaling = bad[i];
        cam_refused(&coupling, CM1E_ERROR_AXIS_RATIO);
        axes_told(SLAVE, "1e-9 ... 1e9");
        coupling.master_scaling = 0;
        coupling.slave_scaling = bad[i];
        cam_refused(&coupling, CM1E_ERROR_AXIS_RATIO);
        coupling.slave_scaling = 0;
        coupling.master_offset = i < 3 ? bad[i] : 0;
        coupling.slave_offset = i < 3 ? 0 : bad[0];
        cam_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
    }
    points[0] = (MC_CAM_POINT){0, 1e29, 0, 0};
    points[1] = (MC_CAM_POINT){1, 2e29, 0, 0};
    const MC_CAM_REF far = {points, 2, mcCamPolynomial5};
    coupling = by_cam(selected(SLAVE, &far, true, false), mcRelative);
    cam_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
    coupling = by_cam(id, mcRampIn);
    coupling.slave_offset = 1e300;
    cam_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
    axes_must_be(SLAVE, CM1E_AXIS_STANDSTILL);
}

/* On a modulo axis a cam begins in the nearest turn. The way to its place in the table, and back to that turn, has to be
 * one that the axis can count. */
static void test_a_cam_many_turns_away_is_refused_on_a_modulo_axis(void)
{
    axes_describe(2);
    axes_config(SLAVE)->modulo_range = 1;
    axes_make();
    axes_enable_all();
    const double farthest = (double)CM1E_FARTHEST_COUNTS / fabs(axes_axis(SLAVE)->position.scale);
    for (int sign = -1; sign <= 1; sign += 2)
        for (int tenths = 1; tenths <= 13; tenths += 3) {
            for (int i = 0; i < 2; i++)
                points[i] = (MC_CAM_POINT){.Master = i, .Slave = floor(sign * tenths / 10.0 * farthest)};
            const MC_CAM_REF table = {points, 2, mcCamPolynomial5};
            const cm1e_axis_coupling_t coupling = by_cam(selected(SLAVE, &table, false, true), mcRampIn);
            if (tenths < 5)
                axes_wait_reached(SLAVE, cam_in(&coupling), 5000);
            else
                cam_refused(&coupling, CM1E_ERROR_AXIS_POSITION_RANGE);
        }
}

/* A cam that is flat before its first point and has a slope there: the velocity of the slave steps inside the cycle in
 * which the master passes that point. At the ends of that cycle the acceleration is 0. */
static void pass_a_kink(double step)
{
    const double velocity = 5;
    axes_begin(2);
    axes_bench.witness[SLAVE].strictness = AXES_UNWATCHED;
    axes_wait(MASTER, axes_move_to(MASTER, -3, 10), 5000);
    points[0] = (MC_CAM_POINT){.Master = 0, .Slave = 0, .Velocity = step / velocity};
    points[1] = (MC_CAM_POINT){.Master = 10, .Slave = 5 * step / velocity};
    const MC_CAM_REF table = {points, 2, mcCamPolynomial5};
    const cm1e_axis_coupling_t coupling = by_cam(selected(SLAVE, &table, false, true), mcAbsolute);
    (void)cam_in(&coupling);
    axes_move_velocity(MASTER, velocity);
    axes_cycles(1500);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, velocity, axes_info(MASTER).set_velocity);
    TEST_ASSERT_TRUE(set_of(MASTER) > 1);
}

static void test_a_kink_of_a_cam_inside_a_cycle_is_seen(void)
{
    axes_begin(2);
    const cm1e_motion_limits_t most = axes_axis(SLAVE)->limits.maximum;
    const double t = axes_axis(SLAVE)->cycle_s, hidden = most.jerk * t * t / 4, allowed = most.acceleration * t;
    TEST_ASSERT_TRUE(2 * hidden < allowed);
    pass_a_kink(0.9 * hidden); /* the jerk of the axis makes as much in a cycle */
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
    pass_a_kink(1.1 * hidden);
    axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
    axes_told(SLAVE, "a jerk of");
    pass_a_kink(0.9 * allowed);
    axes_must_be(SLAVE, CM1E_AXIS_ERROR_STOP);
    axes_told(SLAVE, "a jerk of");
}

/* The acceleration is beyond its limit at the beginning of a cycle and falls with the whole jerk in the second half of
 * it. The change of the velocity keeps the limit, the second difference of the positions does not. `sign`: the
 * direction of the motion. */
static guard_limit_t falls_from(double beyond, int sign)
{
    cm1e_axis_t *axis = axes_axis(SLAVE);
    const cm1e_motion_limits_t most = axis->limits.maximum;
    const double t = axis->cycle_s, v0 = 1, a0 = most.acceleration + beyond * most.jerk * t;
    const double step = v0 * t + a0 * t * t / 2 - most.jerk * t * t * t / 48, gain = a0 * t - most.jerk * t * t / 8;
    axis->setpoint.velocity = sign * v0;
    axis->setpoint.acceleration = sign * a0;
    const from_t next = {.position = cm1e_position_plus(axis->setpoint.position, sign * step * axis->position.scale),
                         .velocity = sign * (v0 + gain), .acceleration = sign * (a0 - most.jerk * t / 2)};
    TEST_ASSERT_TRUE(gain < most.acceleration * t);
    TEST_ASSERT_FALSE(beyond > 0.042 && cm1e_axis_well_within(axis, &next, true));
    return cm1e_axis_look_closely(axis, &next, true).limit;
}

static void test_the_second_difference_of_the_positions_is_judged(void)
{
    axes_begin(2);
    cm1e_axis_guard_renew(axes_axis(SLAVE));
    for (int sign = -1; sign <= 1; sign += 2) {
        TEST_ASSERT_EQUAL_INT(GUARD_KEPT, falls_from(0.9 / 24, sign));
        TEST_ASSERT_EQUAL_INT(GUARD_ACCELERATION, falls_from(1.1 / 24, sign));
        TEST_ASSERT_EQUAL_INT(GUARD_ACCELERATION, falls_from(2.9 / 24, sign)); /* from 3 on by the velocity too */
    }
}

/* The jerk has one value in the first part of a cycle and the opposite one in the rest: `share` of the limit. */
static guard_limit_t turns_jerk(double share, double part, int sign)
{
    cm1e_axis_t *axis = axes_axis(SLAVE);
    const double jerk = sign * share * axis->limits.maximum.jerk, v0 = 1;
    const double t1 = part * axis->cycle_s, t2 = (1 - part) * axis->cycle_s;
    const double a1 = jerk * t1, v1 = v0 + jerk * t1 * t1 / 2;
    const double step = v0 * t1 + jerk * t1 * t1 * t1 / 6 + v1 * t2 + a1 * t2 * t2 / 2 - jerk * t2 * t2 * t2 / 6;
    axis->setpoint.velocity = v0;
    axis->setpoint.acceleration = 0;
    const from_t next = {.position = cm1e_position_plus(axis->setpoint.position, step * axis->position.scale),
                         .velocity = v1 + a1 * t2 - jerk * t2 * t2 / 2, .acceleration = a1 - jerk * t2};
    return cm1e_axis_look_closely(axis, &next, true).limit;
}

static void test_a_jerk_that_turns_inside_a_cycle_is_judged(void)
{
    axes_begin(2);
    cm1e_axis_guard_renew(axes_axis(SLAVE));
    for (int sign = -1; sign <= 1; sign += 2)
        for (int tenths = 1; tenths <= 9; tenths++) {
            TEST_ASSERT_EQUAL_INT(GUARD_KEPT, turns_jerk(0.99, tenths / 10.0, sign));
            TEST_ASSERT_EQUAL_INT(GUARD_JERK, turns_jerk(1.01, tenths / 10.0, sign));
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_last_four_cams_stay);
    RUN_TEST(test_a_bad_cam_costs_no_good_one_and_is_told);
    RUN_TEST(test_an_axis_that_follows_nothing_refuses_it_in_words);
    RUN_TEST(test_an_axis_that_follows_nothing_is_followed);
    RUN_TEST(test_an_axis_that_follows_nothing_stops_with_its_slave);
    RUN_TEST(test_an_axis_that_follows_gears_has_no_cams);
    RUN_TEST(test_an_axis_that_cannot_follow_has_no_memory_for_it);
    RUN_TEST(test_a_cam_is_a_copy);
    RUN_TEST(test_a_cam_that_leaves_the_software_limits_is_refused);
    RUN_TEST(test_a_cam_that_is_needed_is_not_overwritten);
    RUN_TEST(test_wrong_inputs_are_refused);
    RUN_TEST(test_a_cam_many_turns_away_is_refused_on_a_modulo_axis);
    RUN_TEST(test_a_kink_of_a_cam_inside_a_cycle_is_seen);
    RUN_TEST(test_the_second_difference_of_the_positions_is_judged);
    RUN_TEST(test_a_jerk_that_turns_inside_a_cycle_is_judged);
    return UNITY_END();
}
