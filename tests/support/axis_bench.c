#include "axis_bench.h"

#include "ordinary_witness.h"

const int64_t cycle_ns = 1000000;
cm1e_bus_t bus;
cm1e_axis_t *axis;
cm1e_error_t received, health;
int owner;

int64_t worst_step, worst_change;
static bool targets_seen;
static int32_t target_before;
static int64_t step_before;

void bench_forget_steps(void)
{
    worst_step = worst_change = step_before = 0;
    targets_seen = false;
}

static void bench_watch(void)
{
    if (bus.state != OPERATION_ENABLED || bus.mode != CM1E_MODE_CSP) {
        targets_seen = false;
        return;
    }
    const int32_t target = (int32_t)fake_output(&bus, OBJ_607A_TARGET_POSITION, 0);
    const int64_t step = targets_seen ? (int32_t)((uint32_t)target - (uint32_t)target_before) : 0;
    const int64_t change = step - step_before;
    const int64_t size = step < 0 ? -step : step, change_size = change < 0 ? -change : change;
    worst_step = size > worst_step ? size : worst_step;
    worst_change = change_size > worst_change ? change_size : worst_change;
    target_before = target;
    step_before = step;
    targets_seen = true;
}

void bench_inputs(void)
{
    fake_bus_cycle(&bus, cycle_ns);
    ordinary_inputs(axis, received, health, bus.clock.virtual_now_ns);
}

void bench_outputs(void)
{
    ordinary_outputs(axis);
    bench_watch();
}

void bench_cycles(int n)
{
    while (n-- > 0) {
        bench_inputs();
        bench_outputs();
    }
}

void bench_end(void)
{
    cm1e_axis_destroy(axis);
    axis = NULL;
}

void bench_create(void)
{
    cm1e_diag_t diag = {0};
    bench_end();
    received = health = CM1E_OK;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_axis_create(&axis, &bus, 0, &diag), diag.text);
    fake_bus_show(&bus);
    bench_forget_steps();
    bench_cycles(3);
}

void bench_start(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].table_profiles = true;
    bench_create();
}

cm1e_axis_info_t bench_info(void)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    return info;
}

void bench_told(const char *words)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, words), text);
}

void bench_power(bool enable)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, enable, true, true));
}

void bench_enable(void)
{
    bench_power(true);
    bench_cycles(20);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_TRUE(cm1e_axis_powered(axis));
}

void bench_enable_within(double negative, double positive)
{
    bus.config.axes[0].software_limit_negative = negative;
    bus.config.axes[0].software_limit_positive = positive;
    bench_create();
    bench_enable();
}

cm1e_command_id_t bench_start_command(const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_start(axis, command, &id));
    TEST_ASSERT_NOT_EQUAL_UINT32(0, id);
    return id;
}

cm1e_error_t bench_try_command(const cm1e_axis_command_t *command)
{
    cm1e_command_id_t id;
    return cm1e_axis_start(axis, command, &id);
}

cm1e_command_id_t bench_move_to(double position, double velocity)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = position,
                                                      .velocity = velocity});
}

cm1e_command_id_t bench_move_by(double distance, double velocity)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = distance,
                                                      .velocity = velocity});
}

cm1e_command_id_t bench_move_velocity(double velocity)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity});
}

cm1e_command_state_t bench_state_of(cm1e_command_id_t id)
{
    return cm1e_axis_command_status(axis, id).state;
}

int bench_wait(cm1e_command_id_t id, int at_most)
{
    int n = 0;
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE && n++ < at_most)
        bench_cycles(1);
    return n;
}
