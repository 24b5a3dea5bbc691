/* What two functions of an axis do together: overrides, superimposed motions, lowered maxima, software limits, disabled
 * directions and buffered commands. Each of these combinations has once led to a wrong place, or to an error. */
#include "unity.h"

#include "axis/axis_parameters.h"

#include "../support/axes_bench.h"
#include "../support/chance.h"

enum { A, WAITS = 30000 };

void setUp(void) {}
void tearDown(void) { axes_end(); }

static cm1e_axis_t *axis(void) { return axes_axis(A); }
static double place(void) { return axes_info(A).set_position; }

static void make_within(double lower, double upper)
{
    axes_describe(1);
    axes_config(A)->software_limit_negative = lower;
    axes_config(A)->software_limit_positive = upper;
    axes_make();
    axes_enable_all();
}

static cm1e_command_id_t on_top(double distance, double velocity)
{
    return axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = distance,
                                                  .velocity = velocity});
}

static cm1e_command_id_t blended(double position, double velocity)
{
    return axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = position,
                                                  .velocity = velocity, .buffer_mode = mcBlendingHigh});
}

static void override(double velocity, double acceleration, double jerk)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis(), velocity, acceleration, jerk));
}

static void rest(void)
{
    for (int n = 0; n < WAITS && axes_state(A) != CM1E_AXIS_STANDSTILL; n++)
        axes_cycles(1);
    axes_must_be(A, CM1E_AXIS_STANDSTILL);
}

/* ---- a pause by VelFactor 0 -------------------------------------------------------------------------------------- */

/* The command cannot go on, because its direction was disabled meanwhile, or a maximum is below its inputs. What is
 * superimposed ends with it, where the axis is: the witness of the bench sees a step of the set position. */
static void test_a_paused_command_that_cannot_go_on_leaves_the_axis_where_it_is(void)
{
    for (int how = 0; how < 2; how++)
        for (double covered = 0.2; covered < 2.0; covered += 0.3) {
            axes_begin(1);
            const cm1e_command_id_t base = axes_move_to(A, -10.0, 10.0), top = (axes_cycles(100), on_top(2.0, 5.0));
            AXES_UNTIL(axes_status(A, top).covered >= covered);
            override(0.0, 1.0, 1.0);
            axes_cycles(800);
            const double at = place();
            if (how == 0)
                axes_bench.negative[A] = false;
            else
                TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis(), CM1E_PARAMETER_MAX_VELOCITY_APPL, 4.0));
            axes_cycles(10);
            override(1.0, 1.0, 1.0);
            rest();
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, at, place());
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, axes_status(A, base).state);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, axes_status(A, top).state);
            axes_end();
        }
}

/* MC_SetOverride: a reduced jerk acts only as far as the axis then keeps the software limits. */
static void test_a_small_factor_before_a_software_limit_is_no_error(void)
{
    for (int when = 100; when < 800; when += sweep_stride(20, 140))
        for (int pause = 1; pause < 60; pause += sweep_stride(2, 14)) {
            axes_describe(1);
            axes_config(A)->software_limit_negative = -1.0;
            axes_config(A)->software_limit_positive = 10.5;
            axes_config(A)->max_jerk = 500.0;
            axes_config(A)->max_acceleration = 100.0;
            axes_make();
            axes_enable_all();
            const cm1e_command_id_t move = axes_move_to(A, 10.0, 20.0);
            axes_cycles(when);
            override(0.0, 1.0, 1.0);
            axes_cycles(pause);
            override(1.0, 1.0, 0.03);
            rest();
            TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_DONE, axes_status(A, move).state, axes_text(A));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, place());
            axes_end();
        }
}

/* An axis that turns round in its motion needs a little way back to come to rest; else the factor would be ignored. */
static void test_a_motion_that_turns_round_pauses_at_every_moment(void)
{
    for (int when = 0; when < 700; when += sweep_stride(3, 21)) {
        axes_begin(1);
        axes_move_velocity(A, -3.0);
        axes_cycles(1000);
        const double begin = place();
        const cm1e_command_id_t move = axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE,
                                                                              .position = 20.0, .velocity = 20.0});
        axes_cycles(when);
        override(0.0, 1.0, 0.4);
        axes_cycles(1200);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(A, move).state);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, axis()->setpoint.velocity);
        override(1.0, 1.0, 1.0);
        rest();
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, begin + 20.0, place());
        axes_end();
    }
}

/* ---- a modulo axis ----------------------------------------------------------------------------------------------- */

/* Moves one way that pass their targets: each ends in the turn in which the look-ahead has seen it. */
static void test_moves_that_blend_make_no_turn_too_many(void)
{
    for (int run = 0; run < seed_count(1500); run++) {
        chance_seed(seed_of(run));
        const double sign = one_in(2) ? 1.0 : -1.0;
        const int count = 2 + pick(3), lowered = one_in(3) ? pick(300) : -1;
        axes_describe(1);
        axes_config(A)->counts_per_unit = 0;
        axes_config(A)->units_per_revolution = axes_config(A)->modulo_range = 360.0;
        axes_make();
        axes_bench.witness[A].strictness = AXES_UNWATCHED;
        axes_enable_all();
        const position_t first = axis()->setpoint.position;
        double way = 0.0;
        cm1e_command_id_t last = 0;
        for (int n = 0; n < count; n++) {
            way += sign * (one_in(3) ? uniform(1.0, 20.0) : uniform(20.0, 340.0));
            last = axes_command(A, &(cm1e_axis_command_t){
                .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = way - 360.0 * floor(way / 360.0),
                .velocity = uniform(300.0, 3600.0), .direction = sign > 0.0 ? mcPositiveDirection : mcNegativeDirection,
                .buffer_mode = n ? (MC_BUFFER_MODE)(mcBuffered + pick(5)) : mcAborting});
        }
        for (int n = 0; n < WAITS && axes_status(A, last).state != CM1E_COMMAND_DONE; n++) {
            if (n == lowered && one_in(2))
                override(1.0, uniform(0.05, 1.0), uniform(0.05, 1.0));
            else if (n == lowered)
                (void)cm1e_axis_write_parameter(axis(), CM1E_PARAMETER_MAX_DECELERATION_APPL,
                                                uniform(0.05, 1.0) * axis()->limits.system.acceleration);
            axes_cycles(1);
        }
        const double turned = cm1e_position_minus(axis()->setpoint.position, first) / axis()->position.scale;
        AXES_MUST(fabs(turned - way) < 1e-6, "seed %u: turned by %.9g in place of %.9g", seed_of(run), turned, way);
        axes_end();
    }
}

/* From rest, mcCurrentDirection is the direction of the last motion. */
static void test_the_current_direction_of_a_move_that_waits_is_that_of_the_one_before(void)
{
    static const MC_BUFFER_MODE modes[] = {mcBuffered, mcBlendingLow, mcBlendingHigh};
    for (int i = 0; i < 3; i++) {
        axes_describe(1);
        axes_config(A)->modulo_range = 360.0;
        axes_make();
        axes_enable_all();
        const position_t first = axis()->setpoint.position;
        axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = -50.0, .velocity = 20.0});
        axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 300.0, .velocity = 20.0,
                                               .direction = mcCurrentDirection, .buffer_mode = modes[i]});
        rest();
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, -60.0, cm1e_position_minus(axis()->setpoint.position, first) / axis()->position.scale);
        axes_end();
    }
}

/* ---- directions -------------------------------------------------------------------------------------------------- */

/* -20 u/s, and a target 0.5 u ahead: the axis could only pass it and come back in the disabled direction. */
static void test_no_move_comes_back_in_a_disabled_direction(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_MOVE_ABSOLUTE};
    for (int i = 0; i < 2; i++) {
        axes_begin(1);
        axes_move_velocity(A, -20.0);
        axes_cycles(1000);
        axes_bench.positive[A] = false;
        axes_cycles(100);
        const double target = kinds[i] == CM1E_COMMAND_MOVE_ABSOLUTE ? place() - 0.5 : -0.5;
        axes_refused(A, &(cm1e_axis_command_t){.kind = kinds[i], .position = target, .velocity = 20.0},
                     CM1E_ERROR_AXIS_DIRECTION_DISABLED);
        const double far = kinds[i] == CM1E_COMMAND_MOVE_ABSOLUTE ? place() - 5.0 : -5.0;
        const cm1e_command_id_t move =
            axes_command(A, &(cm1e_axis_command_t){.kind = kinds[i], .position = far, .velocity = 20.0});
        const double highest = axes_bench.witness[A].highest;
        rest();
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(A, move).state);
        TEST_ASSERT_EQUAL_DOUBLE(highest, axes_bench.witness[A].highest);
        axes_end();
    }
}

/* ---- superimposed motions ---------------------------------------------------------------------------------------- */

/* MC_MoveAdditive counts from the most recently commanded position, which has the superimposed distance whether that
 * motion has begun or waits for room, and nothing of one before it. */
static void test_an_additive_move_counts_what_is_superimposed_now(void)
{
    static const double before[] = {0.0, 5.0, -4.0};
    for (int i = 0; i < 3; i++)
        for (int when = 850; when < 1010; when += 10) {
            axes_begin(1);
            axes_move_to(A, 3.0, 20.0);
            if (before[i] != 0.0)
                on_top(before[i], 10.0);
            rest();
            axes_move_to(A, 20.0, 20.0);
            axes_cycles(when);
            on_top(1.0, 5.0);
            axes_cycles(1);
            axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ADDITIVE, .position = 2.0, .velocity = 10.0});
            rest();
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 23.0, place());
            axes_end();
        }
}

static void test_what_a_replaced_motion_has_covered_counts_for_the_limit(void)
{
    make_within(-1.0, 12.0);
    axes_move_to(A, 10.0, 5.0);
    axes_cycles(100);
    const cm1e_command_id_t first = on_top(1.5, 5.0);
    AXES_UNTIL(axes_status(A, first).covered >= 1.4);
    axes_refused(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 1.5, .velocity = 5.0},
                 CM1E_ERROR_AXIS_POSITION_RANGE);
    on_top(0.5, 5.0);
    rest();
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 11.95, place());
}

/* Other inputs of the same motion count the distance once. */
static void test_changed_inputs_of_a_superimposed_motion_count_its_distance_once(void)
{
    make_within(-1.0, 12.0);
    axes_move_to(A, 10.0, 5.0);
    axes_cycles(100);
    cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = 1.5, .velocity = 5.0};
    const cm1e_command_id_t top = axes_command(A, &command);
    AXES_UNTIL(axes_status(A, top).covered >= 1.0);
    command.velocity = 3.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axis(), top, &command));
    rest();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 11.5, place());
}

/* A superimposed motion goes on as it was commanded when the maxima are lowered; a command that waits begins. */
static void test_lowered_maxima_under_a_superimposed_motion_end_no_command(void)
{
    static const struct {
        int number;
        double value;
    } lowered[] = {{CM1E_PARAMETER_MAX_VELOCITY_APPL, 6.0}, {CM1E_PARAMETER_MAX_ACCELERATION_APPL, 20.0},
                   {CM1E_PARAMETER_MAX_JERK_APPL, 500.0}};
    for (int i = 0; i < 3; i++) {
        axes_begin(1);
        axes_move_to(A, 5.0, 3.0);
        axes_cycles(200);
        const cm1e_command_id_t top = on_top(40.0, 10.0);
        axes_cycles(300);
        const cm1e_command_id_t waits = blended(20.0, 3.0);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis(), lowered[i].number, lowered[i].value));
        axes_bench.witness[A].strictness = AXES_UNWATCHED; /* the sum is within the maxima of before */
        rest();
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_DONE, axes_status(A, waits).state, axes_text(A));
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(A, top).state);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 60.0, place());
        axes_end();
    }
}

/* ---- lowered maxima ---------------------------------------------------------------------------------------------- */

/* The first move passes its target with the velocity that was planned before: the second one brakes from it. */
static void test_a_deceleration_lowered_before_a_junction_leads_beyond_no_target(void)
{
    for (int limited = 0; limited < 2; limited++)
        for (int when = 0; when < 900; when += sweep_stride(10, 90)) {
            if (limited)
                make_within(-1.0, 14.0);
            else
                axes_begin(1);
            axes_bench.witness[A].strictness = AXES_UNWATCHED; /* it may need more than is allowed from then on */
            axes_move_to(A, 10.0, 20.0);
            const cm1e_command_id_t second = blended(12.5, 20.0);
            axes_cycles(when);
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis(), CM1E_PARAMETER_MAX_DECELERATION_APPL, 20.0));
            rest();
            TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_DONE, axes_status(A, second).state, axes_text(A));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 12.5, place());
            TEST_ASSERT_TRUE(axes_bench.witness[A].highest <= 12.5 + 1e-6);
            axes_end();
        }
}

/* Only what brakes from a velocity of before needs more than the lowered deceleration: the moves that are commanded then
 * keep it, but for the first ones. */
static void test_a_chain_keeps_lowered_maxima_from_the_next_move_on(void)
{
    enum { MOVES = 8 };
    static const double ways[] = {1.16, 1.97, 3.34};
    for (int i = 0; i < 3; i++) {
        cm1e_command_id_t ids[MOVES];
        axes_begin(1);
        axes_bench.witness[A].strictness = AXES_UNWATCHED;
        axes_move_to(A, 10.0, 20.0);
        axes_cycles(300);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis(), CM1E_PARAMETER_MAX_DECELERATION_APPL, 20.0));
        for (int n = 0; n < MOVES; n++)
            ids[n] = axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = ways[i],
                                                            .velocity = 20.0, .buffer_mode = mcBlendingHigh});
        while (axes_state(A) != CM1E_AXIS_STANDSTILL) {
            axes_cycles(1);
            if (axes_status(A, ids[3]).state == CM1E_COMMAND_DONE)
                AXES_MUST(axis()->setpoint.acceleration >= -20.0 - 1e-6, "moves of %g u: %.9g u/s2", ways[i],
                          axis()->setpoint.acceleration);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0 + MOVES * ways[i], place());
        axes_end();
    }
}

/* ---- a table over time ------------------------------------------------------------------------------------------- */

static void point_of(const void *reference, int i, TIME *delta, LREAL *value)
{
    static const double values[] = {5.0, 10.0, 5.0, 0.0};
    (void)reference;
    *delta = 1000000000;
    *value = values[i];
}

/* 0 -> 10 -> 0: a limit or coordinates that its path would not keep are refused, as of a move. */
static void test_a_running_table_keeps_its_path_within_the_limits(void)
{
    const cm1e_axis_table_t table = {.read = point_of, .count = 4};
    axes_describe(1);
    axes_config(A)->table_profiles = true;
    axes_config(A)->software_limit_negative = -20.0;
    axes_config(A)->software_limit_positive = 12.0;
    axes_make();
    axes_enable_all();
    const cm1e_command_id_t run = axes_command(A, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_POSITION_PROFILE,
                                                                         .table = &table});
    axes_cycles(200);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_write_parameter(axis(), CM1E_PARAMETER_SW_LIMIT_POS, 7.0));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis(), 4.0, true));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis(), CM1E_PARAMETER_SW_LIMIT_POS, 10.5));
    rest();
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_DONE, axes_status(A, run).state, axes_text(A));
}

/* A stop with a small jerk, at every moment of the braking and of the acceleration of a move: where the maximum jerk is
 * enough, the axis does not turn round where that direction is disabled. */
static void test_a_stop_with_a_small_jerk_does_not_turn_round(void)
{
    static const cm1e_command_kind_t stops[] = {CM1E_COMMAND_HALT, CM1E_COMMAND_STOP};
    for (int kind = 0; kind < 2; kind++)
        for (double sign = -1.0; sign <= 1.0; sign += 2.0)
            for (int at = 1;; at++) {
                axes_begin(1);
                const cm1e_command_id_t move = axes_move_to(A, sign * 1.5, 10.0);
                (sign > 0.0 ? axes_bench.negative : axes_bench.positive)[A] = false;
                axes_cycles(at);
                if (axes_status(A, move).state != CM1E_COMMAND_ACTIVE)
                    break;
                const double deceleration = axis()->limits.maximum.deceleration, jerk = axis()->limits.maximum.jerk;
                axes_command(A, &(cm1e_axis_command_t){.kind = stops[kind], .deceleration = deceleration, .jerk = jerk / 200.0});
                for (double last = place(), n = 0; n < WAITS && axis()->setpoint.velocity != 0.0; n++, last = place()) {
                    axes_cycles(1);
                    AXES_MUST((place() - last) * sign >= -1e-9, "stop in cycle %d: back by %g u", at, last - place());
                }
                TEST_ASSERT_EQUAL_DOUBLE(0.0, axis()->setpoint.velocity);
                axes_end();
            }
}

/* What takes over from a braking with a small jerk, at every moment: it does not lead through standstill into a disabled
 * direction, or beyond a software limit behind the axis. It is refused there, but a halt is not. */
static void test_a_small_jerk_leads_into_no_disabled_direction(void)
{
    static const struct {
        cm1e_command_kind_t kind;
        double position, velocity, end_velocity;
        cm1e_error_t refusal;
    } commands[] = {
        {CM1E_COMMAND_MOVE_VELOCITY, 0.0, 10.0, 0.0, CM1E_ERROR_AXIS_DIRECTION_DISABLED},
        {CM1E_COMMAND_MOVE_VELOCITY, 0.0, 10.0, 0.0, CM1E_ERROR_AXIS_POSITION_RANGE},
        {CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, 3.0, 10.0, 5.0, CM1E_ERROR_AXIS_DIRECTION_DISABLED},
        {CM1E_COMMAND_MOVE_SUPERIMPOSED, 0.3, 5.0, 0.0, CM1E_ERROR_AXIS_DIRECTION_DISABLED},
        {CM1E_COMMAND_HALT_SUPERIMPOSED, 0.0, 0.0, 0.0, CM1E_OK},
    };
    for (int i = 0; i < 5; i++) {
        const bool superimposed = kind_row(commands[i].kind)->plan == PLAN_ON_TOP;
        const bool limited = commands[i].refusal == CM1E_ERROR_AXIS_POSITION_RANGE;
        int refused = 0;
        for (int at = 1;; at += sweep_stride(1, 7)) {
            if (limited)
                make_within(-1.0, 1000.0);
            else
                axes_begin(1);
            axes_bench.negative[A] = limited;
            const cm1e_command_id_t move = axes_move_to(A, 1.5, 10.0);
            if (superimposed)
                on_top(0.5, 5.0);
            axes_cycles(at);
            if (axes_status(A, move).state != CM1E_COMMAND_ACTIVE)
                break;
            cm1e_command_id_t id;
            const cm1e_error_t error = cm1e_axis_start(axis(), &(cm1e_axis_command_t){
                .kind = commands[i].kind, .position = commands[i].position, .velocity = commands[i].velocity,
                .end_velocity = commands[i].end_velocity, .jerk = axis()->limits.maximum.jerk / 200.0}, &id);
            AXES_MUST(error == CM1E_OK || error == commands[i].refusal, "command %d in cycle %d: %s", i, at, axes_text(A));
            if (error == CM1E_ERROR_AXIS_DIRECTION_DISABLED)
                axes_told(A, "its EnableNegative is FALSE. Every part of the way counts");
            refused += error != CM1E_OK;
            for (double last = place(), n = 0; n < 2500; n++, last = place()) {
                axes_cycles(1);
                if (!limited)
                    AXES_MUST(place() - last >= -1e-9, "command %d in cycle %d: back by %g u", i, at, last - place());
            }
            AXES_MUST(axes_state(A) != CM1E_AXIS_ERROR_STOP, "command %d in cycle %d: %s", i, at, axes_text(A));
            axes_end();
        }
        TEST_ASSERT_EQUAL_INT(commands[i].refusal != CM1E_OK, refused > 0);
        axes_end();
    }
}

/* ---- followers --------------------------------------------------------------------------------------------------- */

/* A master up and down: at every moment, no maximum is accepted that is smaller than what the follower has. */
static void test_a_maximum_below_what_a_follower_has_is_refused(void)
{
    static const int numbers[] = {CM1E_PARAMETER_MAX_VELOCITY_APPL, CM1E_PARAMETER_MAX_ACCELERATION_APPL,
                                  CM1E_PARAMETER_MAX_DECELERATION_APPL};
    for (int i = 0; i < 3; i++)
        for (int at = 1; at < 900; at += sweep_stride(7, 49)) {
            axes_begin(2);
            const cm1e_command_id_t gear = axes_gear_in(1, 0, 1, 1);
            axes_move_velocity(0, 5.0);
            axes_cycles(at);
            axes_move_velocity(0, 0.5);
            axes_cycles(20);
            const double before[] = {axes_axis(1)->limits.maximum.velocity, axes_axis(1)->limits.maximum.acceleration,
                                     axes_axis(1)->limits.maximum.deceleration};
            double refused = 0.0, taken = before[i];
            for (int n = 0; n < 40; n++) {
                const double value = (refused + taken) / 2.0;
                const cm1e_error_t error = cm1e_axis_write_parameter(axes_axis(1), numbers[i], value);
                TEST_ASSERT_TRUE(error == CM1E_OK || error == CM1E_ERROR_AXIS_PARAMETER_RANGE);
                if (error != CM1E_OK && value > 0.1)
                    axes_told(1, "needed then to follow its master");
                *(error == CM1E_OK ? &taken : &refused) = value;
            }
            const double v = axes_axis(1)->setpoint.velocity, a = axes_axis(1)->setpoint.acceleration;
            if (i == 0)
                axes_cycles(1);
            else
                TEST_ASSERT_DOUBLE_WITHIN(1e-6, (a * v > 0.0) == (i == 1) ? fmax(fabs(a), 0.02) : taken, taken);
            axes_must_be(1, CM1E_AXIS_SYNCHRONIZED_MOTION);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, axes_status(1, gear).state);
            axes_end();
        }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_paused_command_that_cannot_go_on_leaves_the_axis_where_it_is);
    RUN_TEST(test_a_small_factor_before_a_software_limit_is_no_error);
    RUN_TEST(test_a_motion_that_turns_round_pauses_at_every_moment);
    RUN_TEST(test_the_current_direction_of_a_move_that_waits_is_that_of_the_one_before);
    RUN_TEST(test_changed_inputs_of_a_superimposed_motion_count_its_distance_once);
    RUN_TEST(test_a_chain_keeps_lowered_maxima_from_the_next_move_on);
    RUN_TEST(test_moves_that_blend_make_no_turn_too_many);
    RUN_TEST(test_no_move_comes_back_in_a_disabled_direction);
    RUN_TEST(test_an_additive_move_counts_what_is_superimposed_now);
    RUN_TEST(test_what_a_replaced_motion_has_covered_counts_for_the_limit);
    RUN_TEST(test_lowered_maxima_under_a_superimposed_motion_end_no_command);
    RUN_TEST(test_a_deceleration_lowered_before_a_junction_leads_beyond_no_target);
    RUN_TEST(test_a_running_table_keeps_its_path_within_the_limits);
    RUN_TEST(test_a_stop_with_a_small_jerk_does_not_turn_round);
    RUN_TEST(test_a_small_jerk_leads_into_no_disabled_direction);
    RUN_TEST(test_a_maximum_below_what_a_follower_has_is_refused);
    return UNITY_END();
}
