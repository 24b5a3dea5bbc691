#include "block_bench.h"

#include "ordinary_witness.h"

struct bench bench;

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

/* The drive's own homing: the bits of UG 6.2.4 one after the other; the counts are renamed at the end. */
static void fake_homing(cm1e_bus_t *bus)
{
    const bool start = bus->state == OPERATION_ENABLED && (bus->controlword & CONTROLWORD_HOMING_START);
    if (!start || (bus->controlword & CONTROLWORD_HALT)) {
        if (bench.homing_cycle >= 0 || bus->mode_status == 0)
            bus->mode_status = STATUSWORD_TARGET_REACHED;
        bench.homing_cycle = start ? -2 : -1;
        return;
    }
    if (bench.homing_cycle == -2)
        return;
    const int n = ++bench.homing_cycle;
    bus->mode_status = (uint16_t)(n < bench.homing_cycles ? 0 : n < bench.homing_cycles + 5
                                                                    ? STATUSWORD_HOMING_ATTAINED
                                                                    : STATUSWORD_HOMING_ATTAINED |
                                                                          STATUSWORD_TARGET_REACHED);
    if (n < bench.homing_cycles)
        bus->position -= 20;
    else if (n == bench.homing_cycles + 5)
        bus->position = 2;
}

/* In CSV the shaft turns as it is told. */
static void turn_shaft(void)
{
    cm1e_bus_t *bus = &bench.bus;
    if (bus->state == OPERATION_ENABLED && bus->mode == CM1E_MODE_CSV && !bus->blocked)
        bus->position += (int32_t)lround((int32_t)fake_output(bus, OBJ_60FF_TARGET_VELOCITY, 0) *
                                         (double)judged.axis->drive.range.velocity_unit *
                                         (double)judged.cycle_ns * 1e-9);
}

/* Inputs of the master, like those of the axis. */
static void master_begins(void)
{
    ordinary_inputs(bench.master, bench.received, bench.health, bench.bus.clock.virtual_now_ns);
    judged_at = 1;
    judge_cycle();
    MC_Power(&bench.master_power);
    judged.state = judged.axis->state;
    judged_at = 0;
}

void cycle_begin(void)
{
    judged_at = 0;
    turn_shaft();
    fake_bus_cycle(&bench.bus, judged.cycle_ns);
    ordinary_inputs(judged.axis, bench.received, bench.health, bench.bus.clock.virtual_now_ns);
    judge_cycle();
    MC_Power(&bench.power);
    if (bench.master)
        master_begins();
    judged.state = judged.axis->state; /* what MC_Power may do is judged where it is tested */
}

void cycle_end(void)
{
    judged_at = 0;
    ordinary_outputs(judged.axis);
    if (bench.master)
        ordinary_outputs(bench.master);
    for (judged_at = bench.master ? 1 : 0; judged_at >= 0; judged_at--) {
        judge_cycle();
        watch_set_point();
    }
    judged_at = 0;
    cm1e_axis_get(judged.axis, &bench.info);
    judged.number++;
}

void cycle(void)
{
    cycle_begin();
    for (int i = 0; i < called_count; i++)
        call(called[i]);
    cycle_end();
}

void cycles(int count)
{
    while (count-- > 0)
        cycle();
}

#define CYCLE_UNTIL(condition)                                                                                       \
    do {                                                                                                             \
        int left = 20000;                                                                                            \
        do                                                                                                           \
            cycle();                                                                                                 \
        while (!(condition) && --left);                                                                              \
        MUST(left > 0, "line %d: never " #condition ", state %s", __LINE__,                                          \
             cm1e_axis_state_name(judged.axis->state));                                                               \
    } while (0)

/* ---- beginnings ----------------------------------------------------------------------------------------- */

static void bench_end(void)
{
    if (judged.axis)
        cm1e_axis_destroy(judged.axis);
    if (bench.master)
        cm1e_axis_destroy(bench.master);
    judged.axis = bench.master = judged_axes[1].axis = NULL;
}

static void make_master(void)
{
    cm1e_diag_t diag = {0};
    MUST(cm1e_axis_create(&bench.master, &bench.bus, 1, &diag) == CM1E_OK, "%s", diag.text);
    judged.master = cm1e_axis_reference(bench.master);
    judged_axes[1] = (struct judged_axis){.axis = bench.master, .reference = judged.master,
                                          .state = CM1E_AXIS_DISABLED, .cycle_ns = judged.cycle_ns};
    snprintf(judged_axes[1].scene, sizeof judged_axes[1].scene, "the master");
    watched_axes[1].ours = false;
    bench.master_power = (MC_Power_t){.Axis = &judged.master, .EnablePositive = TRUE, .EnableNegative = TRUE};
}

/* Axis of 1 u = 50000 counts, 50 u/s, 100 u/s2, as the caller changed bench.bus.config.axes[0]; so is the master. */
static void bench_make_axis(void)
{
    cm1e_diag_t diag = {0};
    bench_end();
    bench.received = bench.health = CM1E_OK;
    bench.bus.homing = fake_homing;
    bench.homing_cycle = -1;
    bench.bus.mode_status = STATUSWORD_TARGET_REACHED;
    MUST(cm1e_axis_create(&judged.axis, &bench.bus, 0, &diag) == CM1E_OK, "%s", diag.text);
    judged.reference = cm1e_axis_reference(judged.axis);
    judged.master = (AXIS_REF_t){.Handle = 0};
    if (bench.with_master)
        make_master();
    begin_blocks();
    bench.power = (MC_Power_t){.Axis = &judged.reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
    judged.state = CM1E_AXIS_DISABLED;
    judged.reset_asked = false;
    judged.number = 0;
    watched.ours = false;
    fake_bus_show(&bench.bus);
    cycles(2);
}

static void bench_describe(void)
{
    bench_end();
    fake_bus_init(&bench.bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    if (bench.with_master) {
        fake_bus_init(&bench.master_bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        fake_bus_add(&bench.bus, &bench.master_bus);
    }
    bench.bus.config.axes[0].homing.method = -1;
    bench.bus.config.cycle_time_ns = judged.cycle_ns = 1000000;
    bench.bus.config.axes[0].inputs = (cm1e_input_config_t){.limit_positive = 1, .limit_negative = 2, .home = 3};
    bench.bus.config.axes[0].table_profiles = true;
    bench.homing_cycles = 60;
}

/* The master turns, if there is one. */
static void bench_turn_master(double velocity)
{
    cm1e_command_id_t id;
    MUST(cm1e_axis_start(bench.master,
                         &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = velocity},
                         &id) == CM1E_OK, "the master does not turn");
    judged_axes[1].state = bench.master->state;
}

static void bench_power_up(void)
{
    bench.power.Enable = bench.master_power.Enable = TRUE;
    CYCLE_UNTIL(bench.power.Status && (!bench.master || bench.master_power.Status));
    if (bench.master) {
        bench_turn_master(4);
        CYCLE_UNTIL(bench.master->setpoint.reached);
    }
    MUST(judged.axis->state == CM1E_AXIS_STANDSTILL, "not in Standstill");
}

void into_by(cm1e_axis_state_t state, instance_t *mover, const char *name)
{
    bench_describe();
    bench_make_axis();
    if (state != CM1E_AXIS_DISABLED)
        bench_power_up();
    if (name) {
        make(mover, name);
        put(mover, "TimeLimit", 1e10);
        trigger(mover, true);
        cycles(40);
    }
    if (state == CM1E_AXIS_ERROR_STOP) {
        fake_bus_fault(&bench.bus, 0x2310);
        cycles(40);
    }
    MUST(judged.axis->state == state, "the axis is in %s instead of %s", cm1e_axis_state_name(judged.axis->state),
         cm1e_axis_state_name(state));
}

void into(cm1e_axis_state_t state, instance_t *mover)
{
    static const char *const movers[CM1E_AXIS_STATE_COUNT] = {
        [CM1E_AXIS_HOMING] = "MC_Home", [CM1E_AXIS_DISCRETE_MOTION] = "MC_MoveAbsolute",
        [CM1E_AXIS_CONTINUOUS_MOTION] = "MC_MoveVelocity", [CM1E_AXIS_SYNCHRONIZED_MOTION] = "MC_GearIn",
        [CM1E_AXIS_STOPPING] = "MC_Stop"};
    into_by(state, mover, movers[state]);
}
