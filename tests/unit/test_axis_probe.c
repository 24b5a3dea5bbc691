/* Touch probes on a fake bus: which edge counts, where it was, and what happens when inputs are missing. */
#include "axis/axis_signals.h"

#include <math.h>

#include "../support/axis_bench.h"

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

static cm1e_axis_trigger_t on(int input) { return (cm1e_axis_trigger_t){.input = input}; }
static cm1e_axis_trigger_t off(int input) { return (cm1e_axis_trigger_t){.input = input, .falling = true}; }

static uint32_t arm(cm1e_axis_trigger_t trigger)
{
    uint32_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe(axis, trigger, false, 0.0, 0.0, &id));
    TEST_ASSERT_NOT_EQUAL_UINT32(0, id);
    return id;
}

static uint32_t arm_window(double first, double last)
{
    uint32_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe(axis, on(1), true, first, last, &id));
    return id;
}

static void expect(uint32_t id, cm1e_command_state_t state)
{
    TEST_ASSERT_EQUAL_INT(state, cm1e_axis_probe_status(axis, id).state);
}

static double units(double counts) { return counts / axis->position.scale; }

static void expect_recorded(uint32_t id, double middle_counts, double half_counts)
{
    const cm1e_probe_status_t status = cm1e_axis_probe_status(axis, id);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, status.state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, units(middle_counts), status.position);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, half_counts / 50000.0, status.uncertainty);
}

/* The next sample of the device, without torque: the shaft is where the test puts it. */
static void show(int32_t position, uint16_t inputs)
{
    bus.position = position;
    bus.digital_inputs = inputs;
    bench_cycles(1);
}

/* ---- the edge ---------------------------------------------------------------------------------------------------- */

static void test_the_first_edge_is_recorded_in_the_middle_of_its_cycle(void)
{
    show(1000, 0);
    const uint32_t id = arm(on(1));
    show(1100, 0);
    expect(id, CM1E_COMMAND_ACTIVE);
    show(1250, 1);
    expect_recorded(id, 1175.0, 75.0);
    show(1300, 0);
    show(1400, 1); /* one shot */
    expect_recorded(id, 1175.0, 75.0);
}

static void test_an_input_that_is_on_already_has_no_edge(void)
{
    show(0, 1);
    const uint32_t id = arm(on(1));
    show(100, 1);
    show(200, 0);
    expect(id, CM1E_COMMAND_ACTIVE);
    show(300, 1);
    expect_recorded(id, 250.0, 50.0);
}

static void test_falling_edges_and_backward_motion(void)
{
    show(-500, 2);
    const uint32_t rising = arm(on(2)), falling = arm(off(2));
    show(-701, 0);
    expect_recorded(falling, -600.5, 100.5);
    expect(rising, CM1E_COMMAND_ACTIVE);
    show(-800, 2);
    expect_recorded(rising, -750.5, 49.5);
}

static void test_a_probe_that_is_not_asked_keeps_its_result(void)
{
    const uint32_t id = arm(on(4));
    show(100, 8);
    for (int i = 0; i < 5000; i++)
        show(200 + i, (uint16_t)(i & 8));
    expect_recorded(id, 50.0, 50.0);
}

static void test_all_triggers_at_once(void)
{
    uint32_t ids[8];
    for (int i = 0; i < 8; i++)
        ids[i] = arm((cm1e_axis_trigger_t){.input = i / 2 + 1, .falling = i % 2});
    for (int i = 0; i < 4; i++) {
        show(1000 * (2 * i + 1), (uint16_t)(1u << i)); /* the one before goes off as this goes on */
        for (int k = 0; k < 8; k++)
            expect(ids[k], k <= 2 * i - 1 || k == 2 * i ? CM1E_COMMAND_DONE : CM1E_COMMAND_ACTIVE);
    }
    show(9000, 0);
    expect(ids[7], CM1E_COMMAND_DONE);
    expect_recorded(ids[1], 2000.0, 1000.0);
}

static void test_numbers_that_are_no_input_are_refused(void)
{
    static const int numbers[] = {0, 5, -1, INT32_MAX, INT32_MIN};
    for (int i = 0; i < 10; i++) {
        const cm1e_axis_trigger_t trigger = {.input = numbers[i / 2], .falling = i % 2};
        uint32_t id = 9;
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SIGNAL, cm1e_axis_probe(axis, trigger, false, 0.0, 0.0, &id));
        TEST_ASSERT_EQUAL_UINT32(0, id);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SIGNAL, cm1e_axis_probe_abort(axis, trigger));
    }
    /* A refused abort is told by itself, too. */
    uint32_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe(axis, on(1), false, 0.0, 0.0, &id));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SIGNAL, cm1e_axis_probe_abort(axis, on(7)));
    bench_told("no touch probe at input 7");
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe_abort(axis, on(1)));
    expect(0, CM1E_COMMAND_UNKNOWN);
    expect(12345, CM1E_COMMAND_UNKNOWN);
}

/* ---- second probes, abort ---------------------------------------------------------------------------------------- */

static void test_a_second_probe_takes_the_trigger_over(void)
{
    const uint32_t first = arm(on(1)), other = arm(off(1)), second = arm(on(1));
    expect(first, CM1E_COMMAND_UNKNOWN);
    expect(other, CM1E_COMMAND_ACTIVE);
    show(10, 1);
    expect_recorded(second, 5.0, 5.0);
    show(20, 0);
    expect_recorded(other, 15.0, 5.0);
    expect(arm(on(1)), CM1E_COMMAND_ACTIVE);
    expect(second, CM1E_COMMAND_UNKNOWN);
}

static void test_abort_ends_its_trigger_only(void)
{
    const uint32_t id = arm(on(3)), other = arm(off(3));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe_abort(axis, on(2)));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe_abort(axis, on(3)));
    expect(id, CM1E_COMMAND_ABORTED);
    expect(other, CM1E_COMMAND_ACTIVE);
    show(10, 4);
    expect(id, CM1E_COMMAND_ABORTED);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe_abort(axis, on(3)));
    show(20, 0);
    expect_recorded(other, 15.0, 5.0);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe_abort(axis, off(3)));
    expect_recorded(other, 15.0, 5.0); /* what is recorded stays */
}

/* ---- windows ----------------------------------------------------------------------------------------------------- */

static void test_window_ends_are_included_and_other_events_are_not_counted(void)
{
    static const struct {
        int32_t from, to;
        bool in;
    } events[] = {{49998, 50000, false}, {50000, 50000, true}, {49999, 50001, true}, {60000, 60000, true},
                  {59999, 60001, true},  {60000, 60002, false}, {0, 100, false},     {46000, 55000, true}};
    for (size_t i = 0; i < sizeof events / sizeof events[0]; i++) {
        show(events[i].from, 0);
        const uint32_t id = arm_window(1.0, 1.2);
        show(events[i].to, 1);
        expect(id, events[i].in ? CM1E_COMMAND_DONE : CM1E_COMMAND_ACTIVE);
        show(55000, 0);
        show(55000, 1);
        expect(id, CM1E_COMMAND_DONE);
    }
}

static void test_windows_that_are_none_are_refused_and_leave_the_armed_probe(void)
{
    const double nan = 0.0 / 0.0, inf = 1.0 / 0.0;
    const double windows[][2] = {{1.2, 1.0}, {nan, 1.0}, {0.0, nan}, {-inf, inf}, {0.0, 1e300}};
    const uint32_t armed = arm(on(1));
    for (size_t i = 0; i < sizeof windows / sizeof windows[0]; i++) {
        uint32_t id;
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE,
                              cm1e_axis_probe(axis, on(1), true, windows[i][0], windows[i][1], &id));
        bench_told("the window of the touch probe at input 1 is not valid: FirstPosition and LastPosition have to be inside");
        expect(armed, CM1E_COMMAND_ACTIVE);
    }
    show(500, 1);
    expect_recorded(armed, 250.0, 250.0);
}

static void test_inverted_axis_has_windows_in_its_own_units(void)
{
    bus.config.axes[0].invert = true;
    bench_create();
    show(-50000, 0);
    const uint32_t id = arm_window(1.0, 1.001);
    show(-50010, 1);
    expect_recorded(id, -50005.0, 5.0);
    TEST_ASSERT_TRUE(cm1e_axis_probe_status(axis, id).position > 1.0);
}

/* A modulo axis of 360 u, 50,000 counts: figure 41. */
static void test_windows_of_a_modulo_axis_may_go_over_its_end(void)
{
    static const struct {
        double first, last;
        bool in[4]; /* at 45, 135, 225, 315 u */
    } windows[] = {{90.0, 270.0, {false, true, true, false}}, {270.0, 90.0, {true, false, false, true}},
                   {0.0, 45.0, {true, false, false, false}},  {315.0, 0.0, {false, false, false, true}}};
    bus.config.axes[0].units_per_revolution = 360.0;
    bus.config.axes[0].modulo_range = 360.0;
    bench_create();
    for (int turn = -3; turn <= 3; turn++)
        for (int w = 0; w < 4; w++)
            for (int i = 0; i < 4; i++) {
                const int32_t at = turn * 50000 + 6250 + i * 12500;
                show(at - 10, 0);
                const uint32_t id = arm_window(windows[w].first, windows[w].last);
                show(at + 10, 1);
                expect(id, windows[w].in[i] ? CM1E_COMMAND_DONE : CM1E_COMMAND_ACTIVE);
                if (windows[w].in[i])
                    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 45.0 + 90.0 * i, cm1e_axis_probe_status(axis, id).position);
            }
    uint32_t id; /* ends are positions of the axis, 0 ... below 360 */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_probe(axis, on(1), true, 0.0, 360.0, &id));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_probe(axis, on(1), true, -1.0, 90.0, &id));
}

/* ---- missing inputs ---------------------------------------------------------------------------------------------- */

static void test_a_few_missing_inputs_only_widen_the_uncertainty(void)
{
    for (int missing = 1; missing <= 2; missing++) {
        show(0, 0);
        const uint32_t id = arm(on(1));
        received = CM1E_ERROR_BUS_LOST;
        bench_cycles(missing);
        expect(id, CM1E_COMMAND_ACTIVE);
        received = CM1E_OK;
        show(400, 1);
        expect_recorded(id, 200.0, 200.0);
    }
}

static void test_a_trigger_in_a_long_gap_is_an_error_and_no_position(void)
{
    static const int gaps[] = {3, 4, 50, 5000};
    for (size_t i = 0; i < sizeof gaps / sizeof gaps[0]; i++) {
        bench_start();
        show(0, 0);
        const uint32_t id = arm(on(1)), other = arm(on(2));
        received = CM1E_ERROR_BUS_LOST;
        bench_cycles(gaps[i]);
        received = CM1E_OK;
        show(400, 1);
        expect(id, CM1E_COMMAND_ERROR);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_PROBE, cm1e_axis_probe_status(axis, id).error);
        expect(other, CM1E_COMMAND_ACTIVE); /* nothing was seen of its trigger: it waits on */
        show(500, 3);
        expect_recorded(other, 450.0, 50.0);
    }
}

static void test_a_probe_armed_in_a_gap_counts_from_the_last_inputs(void)
{
    show(100, 0);
    received = CM1E_ERROR_BUS_LOST;
    bench_cycles(2);
    const uint32_t id = arm(on(1));
    received = CM1E_OK;
    show(200, 1);
    expect_recorded(id, 150.0, 50.0);
}

static void test_before_anything_was_seen_there_is_nothing_to_arm(void)
{
    cm1e_diag_t diag;
    uint32_t id;
    cm1e_axis_destroy(axis);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_create(&axis, &bus, 0, &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, cm1e_axis_probe(axis, on(1), false, 0.0, 0.0, &id));
}

static void test_while_the_motor_homes_its_counts_tell_nothing(void)
{
    bus.config.axes[0].homing.method = -3;
    bench_enable();
    const uint32_t id = arm(on(1)), other = arm(on(2));
    bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME});
    bench_cycles(50);
    bus.digital_inputs = 1;
    bench_cycles(2);
    expect(id, CM1E_COMMAND_ERROR);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_PROBE, cm1e_axis_probe_status(axis, id).error);
    expect(other, CM1E_COMMAND_ACTIVE);
}

/* A string may have homed the motor: between its positions before and after lies no place of the edge. */
static void test_between_two_origins_there_is_no_position(void)
{
    static const int32_t jumps[] = {12000, -30000, 1000000, INT32_MAX};
    for (size_t i = 0; i < sizeof jumps / sizeof jumps[0]; i++) {
        show(0, 0);
        bench_cycles(5);
        const uint32_t id = arm(on(1)), other = arm(on(2));
        show(jumps[i], 1);
        expect(id, CM1E_COMMAND_ERROR);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_PROBE, cm1e_axis_probe_status(axis, id).error);
        show(jumps[i] - 100, 3);
        expect(other, CM1E_COMMAND_DONE); /* of the new origin */
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 50.0 / 50000.0, cm1e_axis_probe_status(axis, other).uncertainty);
    }
}

/* ---- any state, any sequence ------------------------------------------------------------------------------------- */

static void test_probes_work_in_motion_and_change_no_state(void)
{
    bench_enable();
    const cm1e_command_id_t move = bench_move_velocity(10.0);
    bench_cycles(500);
    const uint32_t id = arm(on(1));
    const int32_t before = bus.position;
    bench_cycles(1);
    bus.digital_inputs = 1; /* with the position of the next sample */
    const int32_t last = bus.position;
    bench_cycles(1);
    TEST_ASSERT_NOT_EQUAL_INT32(before, last);
    expect_recorded(id, (last + bus.position) / 2.0, (bus.position - last) / 2.0);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_CONTINUOUS_MOTION, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(move));
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(5);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    const uint32_t other = arm(off(1));
    show(bus.position, 0);
    expect(other, CM1E_COMMAND_DONE);
}

static uint32_t random_state;
static uint32_t random_below(uint32_t n)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state % n;
}

typedef struct model {
    uint32_t id;
    cm1e_command_state_t state;
    double middle;
} model_t;

static void model_sample(model_t *models, uint16_t before, uint16_t now, double middle, bool long_gap)
{
    for (int i = 0; i < 8; i++) {
        const bool was = before >> (i / 2) & 1, is = now >> (i / 2) & 1;
        if (models[i].state != CM1E_COMMAND_ACTIVE || was == is || is == (i % 2))
            continue;
        models[i].state = long_gap ? CM1E_COMMAND_ERROR : CM1E_COMMAND_DONE;
        models[i].middle = middle;
    }
}

static void test_random_sequences_agree_with_a_model(void)
{
    const uint32_t seed = 20260729;
    printf("seed %u\n", seed);
    random_state = seed;
    model_t models[8] = {{0}};
    int32_t position = 0, seen_position = 0;
    uint16_t inputs = 0, seen = 0;
    int gap = 0;
    show(0, 0);
    for (int n = 0; n < 200000; n++) {
        const int i = (int)random_below(8);
        const cm1e_axis_trigger_t trigger = {.input = i / 2 + 1, .falling = i % 2};
        switch (random_below(8)) {
        case 0:
            models[i] = (model_t){.id = arm(trigger), .state = CM1E_COMMAND_ACTIVE};
            break;
        case 1:
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_probe_abort(axis, trigger));
            if (models[i].state == CM1E_COMMAND_ACTIVE)
                models[i].state = CM1E_COMMAND_ABORTED;
            break;
        default: break;
        }
        position += (int32_t)random_below(2001) - 1000;
        if (random_below(3) == 0)
            inputs ^= (uint16_t)(1u << random_below(4));
        const bool lost = random_below(gap ? 2 : 20) == 0;
        received = lost ? CM1E_ERROR_BUS_LOST : CM1E_OK;
        show(position, inputs);
        gap++;
        if (lost)
            continue;
        model_sample(models, seen, inputs, (position + seen_position) / 2.0, gap > 3);
        gap = 0;
        seen = inputs;
        seen_position = position;
        for (int k = 0; k < 8; k++) {
            const cm1e_probe_status_t status = cm1e_axis_probe_status(axis, models[k].id);
            if (status.state != models[k].state ||
                (status.state == CM1E_COMMAND_DONE && fabs(status.position - units(models[k].middle)) > 1e-9))
                TEST_FAIL_MESSAGE("the model disagrees");
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_first_edge_is_recorded_in_the_middle_of_its_cycle);
    RUN_TEST(test_an_input_that_is_on_already_has_no_edge);
    RUN_TEST(test_falling_edges_and_backward_motion);
    RUN_TEST(test_a_probe_that_is_not_asked_keeps_its_result);
    RUN_TEST(test_all_triggers_at_once);
    RUN_TEST(test_numbers_that_are_no_input_are_refused);
    RUN_TEST(test_a_second_probe_takes_the_trigger_over);
    RUN_TEST(test_abort_ends_its_trigger_only);
    RUN_TEST(test_window_ends_are_included_and_other_events_are_not_counted);
    RUN_TEST(test_windows_that_are_none_are_refused_and_leave_the_armed_probe);
    RUN_TEST(test_inverted_axis_has_windows_in_its_own_units);
    RUN_TEST(test_windows_of_a_modulo_axis_may_go_over_its_end);
    RUN_TEST(test_a_few_missing_inputs_only_widen_the_uncertainty);
    RUN_TEST(test_a_trigger_in_a_long_gap_is_an_error_and_no_position);
    RUN_TEST(test_a_probe_armed_in_a_gap_counts_from_the_last_inputs);
    RUN_TEST(test_before_anything_was_seen_there_is_nothing_to_arm);
    RUN_TEST(test_while_the_motor_homes_its_counts_tell_nothing);
    RUN_TEST(test_between_two_origins_there_is_no_position);
    RUN_TEST(test_probes_work_in_motion_and_change_no_state);
    RUN_TEST(test_random_sequences_agree_with_a_model);
    return UNITY_END();
}
