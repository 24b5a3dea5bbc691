/* An axis that somebody above leads: who may, what it does, and set-points that it does not follow. */
#include <math.h>

#include "../support/axis_bench.h"
#include "axis/axis_parameters.h"

/* A leader with a motion of constant jerk from where the axis stood: 100 u/s3 up to its velocity, and the same down. */
typedef struct lead_bench {
    cm1e_axis_leader_t leader;
    double start, position, velocity, acceleration; /* u ..., of the set-point that is given next */
    double jerk;
    cm1e_lead_t answer;
    unsigned asked, lost, paused;
    cm1e_error_t lost_error;
} lead_bench_t;

static lead_bench_t lead;

static cm1e_lead_t next(void *context, uint32_t index, double *position, double *velocity, double *acceleration)
{
    lead_bench_t *l = context;
    const double t = 1e-3, j = l->jerk, a = l->acceleration, v = l->velocity;
    TEST_ASSERT_EQUAL_UINT32(7, index);
    l->asked++;
    l->position += t * (v + t * (a / 2.0 + t * j / 6.0));
    l->velocity += t * (a + t * j / 2.0);
    l->acceleration += t * j;
    *position = l->position;
    *velocity = l->velocity;
    *acceleration = l->acceleration;
    return l->answer;
}

static void lost(void *context, uint32_t index, cm1e_error_t error)
{
    lead_bench_t *l = context;
    TEST_ASSERT_EQUAL_UINT32(7, index);
    l->lost++;
    l->lost_error = error;
}

static void paused(void *context, uint32_t index)
{
    lead_bench_t *l = context;
    TEST_ASSERT_EQUAL_UINT32(7, index);
    l->paused++;
    l->velocity = l->acceleration = 0.0;
}

static void prepare(void)
{
    lead = (lead_bench_t){.answer = CM1E_LEAD_ON};
    lead.leader = (cm1e_axis_leader_t){.next = next, .lost = lost, .paused = paused, .context = &lead, .index = 7};
    lead.start = lead.position = cm1e_axis_place(axis, false);
}

static void lead_axis(void)
{
    prepare();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_lead(axis, &lead.leader));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
}

/* To 2 u/s, in 200 ms. */
static void lead_up(void)
{
    lead.jerk = 200.0;
    bench_cycles(100);
    lead.jerk = -200.0;
    bench_cycles(100);
    lead.jerk = lead.acceleration = 0.0;
    bench_cycles(50);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0, bench_info().set_velocity);
}

static void lead_down(void)
{
    lead.jerk = -200.0;
    bench_cycles(100);
    lead.jerk = 200.0;
    bench_cycles(100);
    lead.jerk = lead.velocity = lead.acceleration = 0.0;
}

static void led_in_motion(void)
{
    bench_enable();
    lead_axis();
    lead_up();
    worst_step = worst_change = 0;
}

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

static void test_the_motor_goes_where_the_leader_says(void)
{
    led_in_motion();
    TEST_ASSERT_TRUE(axis->leader && axis->leader->context == &lead);
    for (int n = 0; n < 500; n++) {
        bench_cycles(1);
        const double counts = (lead.position - lead.start) * axis->position.scale;
        TEST_ASSERT_DOUBLE_WITHIN(0.5 + 1e-6, counts, (double)(int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, 0));
    }
    lead_down();
    lead.answer = CM1E_LEAD_LAST;
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, lead.position, bench_info().set_position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
    const unsigned asked = lead.asked;
    bench_cycles(10);
    TEST_ASSERT_EQUAL_UINT(asked, lead.asked); /* nobody leads any more */
    TEST_ASSERT_EQUAL_UINT(0, lead.lost);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(101, worst_step); /* 2 u/s */
    const cm1e_command_id_t id = bench_move_to(0.0, 1.0);
    bench_wait(id, 20000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
}

static void test_only_an_axis_that_stands_by_itself_is_led(void)
{
    prepare();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, cm1e_axis_lead(axis, &lead.leader)); /* Disabled */
    bench_enable();
    bench_move_velocity(1.0);
    bench_cycles(10);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, cm1e_axis_lead(axis, &lead.leader));
    const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    bench_cycles(500);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, cm1e_axis_lead(axis, &lead.leader)); /* Stopping */
    cm1e_axis_hold_stop(axis, stop, false);
    bench_cycles(2);
    lead_axis();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, cm1e_axis_lead(axis, &lead.leader)); /* led already */
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(5);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STATE, cm1e_axis_lead(axis, &lead.leader));
}

static void test_motions_of_the_drive_are_not_led(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].motion = CM1E_MOTION_DRIVE;
    bench_create();
    bench_enable();
    prepare();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, cm1e_axis_lead(axis, &lead.leader));
}

static void test_other_commands_are_refused_and_change_nothing(void)
{
    static const cm1e_homing_config_t homing = {.method = -1};
    static const cm1e_homing_step_t step = {.kind = CM1E_STEP_DIRECT};
    led_in_motion();
    for (int kind = 0; kind < CM1E_COMMAND_KIND_COUNT; kind++)
        for (int mode = mcAborting; mode <= mcBlendingHigh && kind != CM1E_COMMAND_STOP; mode++) {
            const cm1e_axis_command_t command = {.kind = (cm1e_command_kind_t)kind, .velocity = 1.0, .homing = &homing,
                                                 .step = &step, .buffer_mode = (MC_BUFFER_MODE)mode};
            cm1e_command_id_t id = 3;
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_IN_GROUP, cm1e_axis_start(axis, &command, &id));
            TEST_ASSERT_EQUAL_UINT32(0, id);
        }
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_IN_GROUP, cm1e_axis_set_position(axis, 0.0, false));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_write_parameter(axis, 4, 1.0)); /* a limit */
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, 0.5, 0.5, 0.5));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_reset(axis));
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
    TEST_ASSERT_EQUAL_INT64(100, worst_step);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(1, worst_change); /* the rounding of whole counts */
}

static void test_stop_takes_the_axis_away_and_ramps_down(void)
{
    led_in_motion();
    const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    TEST_ASSERT_EQUAL_UINT(1, lead.lost);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, lead.lost_error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
    bench_wait(stop, 2000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(stop));
    cm1e_axis_hold_stop(axis, stop, false);
    bench_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change); /* 100 u/s2 */
}

static void test_power_off_and_shut_down_ramp_down_before_the_torque_goes(void)
{
    for (int shut_down = 0; shut_down < 2; shut_down++) {
        bench_start();
        led_in_motion();
        if (shut_down)
            cm1e_axis_shut_down(axis);
        else
            bench_power(false);
        TEST_ASSERT_EQUAL_UINT(1, lead.lost);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, lead.lost_error);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
        TEST_ASSERT_TRUE(cm1e_axis_powered(axis));
        bench_cycles(500);
        TEST_ASSERT_FALSE(cm1e_axis_powered(axis));
        TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
    }
}

static void test_a_fault_ends_it(void)
{
    led_in_motion();
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(3);
    TEST_ASSERT_EQUAL_UINT(1, lead.lost);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_ERROR_STOP, lead.lost_error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    bench_cycles(300);
    bus.state = SWITCH_ON_DISABLED;
    cm1e_axis_reset(axis);
    bench_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_UINT(1, lead.lost);
}

static void test_a_bus_that_fails_holds_the_last_target(void)
{
    led_in_motion();
    const int32_t target = (int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, 0);
    received = health = CM1E_ERROR_BUS_WORKING_COUNTER;
    bench_cycles(1);
    received = health = CM1E_OK;
    TEST_ASSERT_EQUAL_UINT(1, lead.lost);
    TEST_ASSERT_EQUAL_INT32(target, bus.target_position);
    bench_forget_steps();
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT64(0, worst_step);
    TEST_ASSERT_EQUAL_INT32(target, bus.position);
}

static void test_lag_ends_it(void)
{
    led_in_motion();
    bus.blocked = true;
    bench_cycles(600); /* half a revolution at 2 u/s is 250 ms */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_LAG, bench_info().error);
    TEST_ASSERT_EQUAL_UINT(1, lead.lost);
}

static void test_a_leader_without_set_points_stops_the_axis(void)
{
    led_in_motion();
    lead.answer = CM1E_LEAD_NONE;
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLED, bench_info().error);
    TEST_ASSERT_EQUAL_UINT(1, lead.lost);
    bench_cycles(300);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
}

static void test_let_go_in_motion_it_ramps_down(void)
{
    led_in_motion();
    cm1e_axis_release(axis);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_UINT(0, lead.lost);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
    cm1e_axis_release(axis); /* nobody leads it */
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

/* ---- set-points that are not followed ---------------------------------------------------------------------------- */

static void jump(void) { lead.position += 0.1; }
static void jump_back(void) { lead.position -= 0.1; }
static void not_finite(void) { lead.position = NAN; }
static void too_far(void) { lead.position = 1e300; }
static void endless_velocity(void) { lead.velocity = INFINITY; }
static void no_acceleration(void) { lead.acceleration = NAN; }
static void too_fast(void) { lead.velocity = 60.0; }
static void velocity_step(void) { lead.velocity += 0.2; }
static void velocity_falls(void) { lead.velocity -= 0.2; }
static void acceleration_step(void) { lead.acceleration = 20.0; }
static void large_acceleration(void) { lead.acceleration = -150.0; }
static void reversed(void) { lead.velocity = -lead.velocity; }
static void no_direction(void) { TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true)); }
static void over_the_limit(void)
{
    axis->limits.positive = lead.position + 0.01;
    axis->limits.positive_enabled = true;
    cm1e_axis_apply_limits(axis);
}

static void test_what_it_cannot_follow_is_not_given_to_the_motor(void)
{
    static const struct {
        void (*spoil)(void);
        const char *said;
    } cases[] = {
        {jump, "a step of 0.102 u"},
        {jump_back, "a step of -0.098 u"},
        {not_finite, "not a finite number"},
        {too_far, "not a finite number"},
        {endless_velocity, "not a finite number"},
        {no_acceleration, "not a finite number"},
        {too_fast, "a velocity of 60 u/s; up to 50 u/s"},
        {velocity_step, "an acceleration of 200 u/s2; up to 100 u/s2"},
        {velocity_falls, "a deceleration of 200 u/s2; up to 100 u/s2"},
        {acceleration_step, "a jerk of 20000 u/s3; up to 2000 u/s3"},
        {large_acceleration, "of 150 u/s2; up to 100 u/s2"},
        {reversed, "an acceleration of 4000 u/s2"},
        {no_direction, "a direction that MC_Power does not enable"},
        {over_the_limit, "cannot stop before the software limit"},
    };
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].max_velocity = 50.0;
        bench_create();
        led_in_motion();
        cases[n].spoil();
        bench_cycles(1);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_AXIS_ERROR_STOP, bench_info().state, cases[n].said);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLING_LIMIT, bench_info().error);
        TEST_ASSERT_EQUAL_UINT(1, lead.lost);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_ERROR_STOP, lead.lost_error);
        bench_told(cases[n].said);
        bench_cycles(300);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
        TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE(101, worst_step, cases[n].said);
        TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE(7, worst_change, cases[n].said);
    }
}

/* With velocity and acceleration kept, a cycle can move the axis by a quarter of acceleration * time squared more or less
 * than its velocity says: 0.25 * 100 u/s2 * 1 ms2. */
static void test_a_step_is_within_what_the_acceleration_can_do_in_a_cycle(void)
{
    static const struct {
        double beside;
        bool kept;
    } cases[] = {{24e-6, true}, {-24e-6, true}, {26e-6, false}, {-26e-6, false}, {90e-6, false}, {-90e-6, false}};
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        bench_start();
        led_in_motion();
        TEST_ASSERT_EQUAL_DOUBLE(100.0, axis->limits.system.acceleration);
        TEST_ASSERT_EQUAL_DOUBLE(100.0, axis->limits.system.deceleration);
        lead.position += cases[n].beside;
        bench_cycles(1);
        TEST_ASSERT_EQUAL_INT(cases[n].kept ? CM1E_AXIS_SYNCHRONIZED_MOTION : CM1E_AXIS_ERROR_STOP, bench_info().state);
        if (!cases[n].kept)
            bench_told("in a cycle in which its velocity covers 0.002 u");
    }
}

static void test_standing_in_a_disabled_direction_is_no_error(void)
{
    bench_enable();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, false));
    lead_axis();
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
}

/* ---- pauses ------------------------------------------------------------------------------------------------------ */

static void test_after_a_pause_the_leader_begins_anew_from_rest(void)
{
    led_in_motion();
    bench_inputs();
    cm1e_axis_after_pause(axis, 5 * cycle_ns);
    TEST_ASSERT_EQUAL_UINT(1, lead.paused);
    bench_outputs();
    lead_up();
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, bench_info().state);
    TEST_ASSERT_EQUAL_UINT(0, lead.lost);
}

static void test_a_leader_that_goes_on_after_a_pause_as_if_nothing_was_is_not_followed(void)
{
    led_in_motion();
    bench_inputs();
    cm1e_axis_after_pause(axis, 5 * cycle_ns);
    lead.velocity = 2.0;
    bench_outputs();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLING_LIMIT, bench_info().error);
}

static void test_a_motor_that_ran_on_by_its_velocity_stops_with_an_error(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bench_create();
    bench_enable();
    lead_axis();
    lead_up();
    bench_inputs();
    cm1e_axis_after_pause(axis, 5 * cycle_ns);
    bench_outputs();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_COUPLING_LIMIT, bench_info().error);
    bench_told("after a pause of the cycle");
    TEST_ASSERT_EQUAL_UINT(1, lead.lost);
}

/* ---- coordinates ------------------------------------------------------------------------------------------------- */

static void test_inverted_and_modulo_axes_count_without_turns(void)
{
    for (int inverted = 0; inverted < 2; inverted++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].modulo_range = 0.7;
        bus.config.axes[0].invert = inverted;
        bench_create();
        led_in_motion();
        bench_cycles(1000);
        lead_down();
        lead.answer = CM1E_LEAD_LAST;
        bench_cycles(1);
        TEST_ASSERT_TRUE(lead.position > 2.0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, lead.position, cm1e_axis_place(axis, false));
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, lead.position, cm1e_axis_place(axis, true));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, fmod(lead.position, 0.7), bench_info().set_position);
        TEST_ASSERT_EQUAL_INT(0, bench_info().error);
    }
}

static void test_bounds_are_those_of_commands(void)
{
    cm1e_motion_limits_t limits;
    double lower, upper;
    bus.config.axes[0].software_limit_negative = -3.0;
    bus.config.axes[0].software_limit_positive = 4.0;
    bench_create();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, 9, 7.0)); /* MaxVelocityAppl */
    cm1e_axis_bounds(axis, &limits, &lower, &upper);
    TEST_ASSERT_EQUAL_DOUBLE(7.0, limits.velocity);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, limits.acceleration);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, limits.deceleration);
    TEST_ASSERT_EQUAL_DOUBLE(2000.0, limits.jerk);
    TEST_ASSERT_EQUAL_DOUBLE(-3.0, lower);
    TEST_ASSERT_EQUAL_DOUBLE(4.0, upper);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, 4, 0.0)); /* EnableLimitPos */
    cm1e_axis_bounds(axis, &limits, &lower, &upper);
    TEST_ASSERT_TRUE(isinf(upper));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_motor_goes_where_the_leader_says);
    RUN_TEST(test_only_an_axis_that_stands_by_itself_is_led);
    RUN_TEST(test_motions_of_the_drive_are_not_led);
    RUN_TEST(test_other_commands_are_refused_and_change_nothing);
    RUN_TEST(test_stop_takes_the_axis_away_and_ramps_down);
    RUN_TEST(test_power_off_and_shut_down_ramp_down_before_the_torque_goes);
    RUN_TEST(test_a_fault_ends_it);
    RUN_TEST(test_a_bus_that_fails_holds_the_last_target);
    RUN_TEST(test_lag_ends_it);
    RUN_TEST(test_a_leader_without_set_points_stops_the_axis);
    RUN_TEST(test_let_go_in_motion_it_ramps_down);
    RUN_TEST(test_what_it_cannot_follow_is_not_given_to_the_motor);
    RUN_TEST(test_a_step_is_within_what_the_acceleration_can_do_in_a_cycle);
    RUN_TEST(test_standing_in_a_disabled_direction_is_no_error);
    RUN_TEST(test_after_a_pause_the_leader_begins_anew_from_rest);
    RUN_TEST(test_a_leader_that_goes_on_after_a_pause_as_if_nothing_was_is_not_followed);
    RUN_TEST(test_a_motor_that_ran_on_by_its_velocity_stops_with_an_error);
    RUN_TEST(test_inverted_and_modulo_axes_count_without_turns);
    RUN_TEST(test_bounds_are_those_of_commands);
    return UNITY_END();
}
