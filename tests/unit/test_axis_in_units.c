/* The same machine and the same program in other units of length, and inverted: the same counts in every cycle. A
 * constant that has a unit, and is not of counts, shows at once, and so does what is right in one direction only. */
#include "../support/axes_bench.h"
#include "../support/chance.h"
#include "../support/units_log.h"
#include "axis/axis_parameters.h"
#include "unity.h"

enum { LINEAR, SLAVE, TURNING, AXES, CYCLES = 3000, PROGRAMS = 120, IDS = 4 };

static bool mirrors; /* the program has only what is the same both ways */
static cm1e_command_id_t ids[AXES][IDS];
static unsigned long long taken, refused, seen[CM1E_AXIS_STATE_COUNT];

void setUp(void) {}
void tearDown(void) { axes_end(); }

/* What hangs on a motor: counts, counts a cycle, 1, 1. */
typedef struct load {
    double place, speed, stiffness, friction;
} load_t;
static load_t loads[AXES];

/* ---- the machine ------------------------------------------------------------------------------------------------- */

/** Until the next cycle: a servo with a heavy load swings about its target. Of counts and of time, so that it is the
 *  same in all units. */
static void swing(cm1e_bus_t *motor)
{
    load_t *load = &loads[motor == &axes_bench.bus ? 0 : motor - axes_bench.others + 1];
    const bool holds = motor->state == OPERATION_ENABLED;
    const double missing = !holds || motor->mode == CM1E_MODE_CSV ? 0 : motor->target_position - load->place;
    const double more = holds && motor->mode == CM1E_MODE_CSV ? 1e-3 * motor->target_velocity_raw : 0;
    load->speed += load->stiffness * missing - load->friction * (load->speed - more);
    load->place += motor->blocked ? 0 : load->speed;
    motor->position = (int32_t)lround(load->place);
    motor->velocity_raw = (int32_t)lround(1000 * load->speed);
}

static void describe_load(int n)
{
    loads[n] = (load_t){.stiffness = decade(0.005, 0.3), .friction = decade(0.02, 0.3)};
    axes_motor(n)->world = one_in(2) ? swing : NULL;
    if (n == LINEAR || !one_in(4))
        return;
    fake_bus_init(axes_motor(n), CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    axes_motor(n)->mode = axes_motor(n)->sdo_mode = CM1E_MODE_CSV;
    axes_config(n)->mapping = CM1E_MAPPING_CSV;
    axes_motor(n)->world = swing;
    loads[n].friction = 0.5;
}

static void describe_any(int n)
{
    cm1e_axis_config_t *c = axes_config(n);
    const double velocity = decade(2, 50), acceleration = decade(5, 100), jerk = decade(100, 2000);
    if (one_in(2))
        c->max_velocity = size(velocity), c->max_acceleration = size(acceleration), c->max_jerk = size(jerk);
    if (one_in(3))
        c->max_deceleration = size(acceleration * uniform(0.5, 1));
    const double gap = decade(0.001, 0.2);
    if (one_in(4) && !mirrors)
        c->backlash = size(gap), c->backlash_velocity = or_default(decade(0.1, 1));
    if (one_in(3))
        c->in_position_window = size(decade(0.0001, 0.01)), c->in_position_done_waits = true;
    if (one_in(3))
        c->max_position_lag = size(decade(0.05, 2));
    c->invert = one_in(3) != mirrored();
    c->table_profiles = true;
    c->coupling_stop = (cm1e_coupling_stop_t)pick(3);
    c->inputs = (cm1e_input_config_t){.limit_positive = mirrored() ? 2 : 1, .limit_negative = mirrored() ? 1 : 2,
                                      .home = 3};
    c->jog_slow = or_default(0.1);
}

static void make_machine(void)
{
    axes_describe(AXES);
    units_describe();
    for (int n = 0; n < AXES; n++) {
        describe_any(n);
        describe_load(n);
        axes_bench.witness[n].strictness = AXES_UNWATCHED;
    }
    if (one_in(2)) {
        const double one = in(uniform(2, 20)), other = in(-uniform(2, 20));
        axes_config(LINEAR)->software_limit_positive = fmax(one, other);
        axes_config(LINEAR)->software_limit_negative = fmin(one, other);
    }
    if (!mirrors)
        axes_config(TURNING)->modulo_range = in((20 + pick(180)) / 64.0); /* the same fraction in all units */
    axes_make();
    axes_enable_all();
}

/* ---- commands ---------------------------------------------------------------------------------------------------- */

static void base_pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    const double *values = reference;
    *delta_ns = index ? 20000000 + 7000000 * index : 0;
    *value = values[index];
}

static const cm1e_axis_table_t *any_table(void)
{
    static double values[10];
    static cm1e_axis_table_t table;
    const double size = decade(0.01, 2);
    for (int i = 0; i < 10; i++)
        values[i] = i ? in(uniform(-size, size)) : 0;
    table = (cm1e_axis_table_t){.read = base_pair, .reference = values, .count = 2 + pick(8),
                                .time_scale = one_in(2) ? 0 : uniform(0.5, 20),
                                .scale = one_in(2) ? 0 : uniform(0.5, 2)};
    return &table;
}

static const cm1e_homing_step_t *any_step(void)
{
    static cm1e_homing_step_t step;
    static const cm1e_homing_step_kind_t kinds[] = {CM1E_STEP_ABSOLUTE_SWITCH, CM1E_STEP_LIMIT_SWITCH, CM1E_STEP_BLOCK,
                                                    CM1E_STEP_DIRECT, CM1E_STEP_FINISH};
    step = (cm1e_homing_step_t){.kind = kinds[pick(5)], .direction = (MC_HOME_DIRECTION)pick(4),
                                .mode = (MC_SWITCH_MODE)pick(5), .torque_limit = one_in(2) ? 0 : 30,
                                .distance_limit = or_default(uniform(0.1, 5)), .time_limit_ns = 2000000000,
                                .detection_velocity = or_default(0.05)};
    return &step;
}

static MC_CAM_ID any_cam(int n)
{
    static MC_CAM_POINT points[6];
    const int count = 3 + pick(4);
    for (int i = 0; i < count; i++)
        points[i] = (MC_CAM_POINT){in(i * 1.25), i ? in(uniform(-1, 1)) : 0, 0, 0};
    const bool periodic = one_in(2);
    if (periodic)
        points[count - 1].Slave = points[0].Slave;
    const MC_CAM_REF cam = {points, (UINT)count, (MC_CAM_CURVE)pick(3)};
    const bool master = one_in(2), slave = one_in(2);
    MC_CAM_ID id = 0;
    units_note(cm1e_axis_cam_select(axes_axis(n), &cam, periodic, master, slave, &id));
    return id;
}

static const cm1e_axis_coupling_t *any_coupling(int n)
{
    static cm1e_axis_coupling_t coupling;
    static const int32_t ratios[] = {1, -1, 2, 3, -5};
    const int master = n == LINEAR || one_in(3) ? TURNING : LINEAR, other = master == LINEAR ? TURNING : LINEAR;
    coupling = (cm1e_axis_coupling_t){
        .master = {{axes_reference(master), one_in(4) ? mcActualValue : mcSetValue, ratios[pick(5)],
                    1 + (uint32_t)pick(3)},
                   {axes_reference(n == LINEAR ? master : other), mcSetValue, ratios[pick(5)], 1 + (uint32_t)pick(7)}},
        .combine = one_in(2) ? mcAddAxes : mcSubAxes,
        .master_sync_position = axes_info(master).set_position + in(uniform(-1, 5)),
        .slave_sync_position = axes_info(n).set_position + in(uniform(-2, 2)),
        .master_start_distance = one_in(2) ? 0 : in(uniform(0.1, 3)), .sync_mode = (MC_SYNC_MODE)pick(3),
        .start_mode = (MC_START_MODE)pick(3), .master_offset = one_in(2) ? 0 : in(uniform(-1, 1)),
        .slave_offset = one_in(2) ? 0 : in(uniform(-1, 1)), .master_scaling = one_in(2) ? 0 : uniform(0.3, 3),
        .slave_scaling = one_in(2) ? 0 : uniform(-2, 2),
    };
    return &coupling;
}

static cm1e_command_kind_t any_kind(int n)
{
    static const cm1e_command_kind_t ordinary[] = {
        CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE, CM1E_COMMAND_MOVE_ADDITIVE,
        CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE,
        CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, CM1E_COMMAND_HALT, CM1E_COMMAND_STOP, CM1E_COMMAND_MOVE_SUPERIMPOSED,
        CM1E_COMMAND_HALT_SUPERIMPOSED, CM1E_COMMAND_POSITION_PROFILE, CM1E_COMMAND_VELOCITY_PROFILE,
        CM1E_COMMAND_ACCELERATION_PROFILE, CM1E_COMMAND_HOMING_STEP};
    static const cm1e_command_kind_t coupled[] = {
        CM1E_COMMAND_GEAR_IN, CM1E_COMMAND_GEAR_IN_POS, CM1E_COMMAND_GEAR_IN_POS, CM1E_COMMAND_CAM_IN,
        CM1E_COMMAND_CAM_IN, CM1E_COMMAND_COMBINE_AXES, CM1E_COMMAND_GEAR_OUT, CM1E_COMMAND_CAM_OUT,
        CM1E_COMMAND_PHASING_ABSOLUTE, CM1E_COMMAND_PHASING_RELATIVE, CM1E_COMMAND_MOVE_SUPERIMPOSED};
    const cm1e_command_kind_t kind = n == SLAVE && !one_in(3) ? coupled[pick(11)] : ordinary[pick(16)];
    const bool one_sided = kind == CM1E_COMMAND_CAM_IN || kind == CM1E_COMMAND_HOMING_STEP;
    return one_sided && mirrors ? CM1E_COMMAND_MOVE_VELOCITY : kind;
}

static MC_DIRECTION any_direction(void)
{
    if (!mirrors)
        return (MC_DIRECTION)pick(5);
    return one_in(2) != mirrored() ? mcPositiveDirection : mcNegativeDirection;
}

static cm1e_axis_command_t any_command(int n)
{
    const cm1e_command_kind_t kind = any_kind(n);
    const double velocity = decade(0.01, 8), acceleration = decade(2, 50), jerk = decade(20, 2000);
    const double end_velocity = uniform(-3, 3);
    return (cm1e_axis_command_t){
        .kind = kind, .position = in(n == TURNING && one_in(2) ? uniform(0, 0.3) : uniform(-3, 3)),
        .velocity = size(velocity), .end_velocity = in(end_velocity), .acceleration = or_default(acceleration),
        .deceleration = or_default(acceleration * uniform(0.5, 2)), .jerk = or_default(jerk),
        .direction = any_direction(), .buffer_mode = one_in(2) ? mcAborting : (MC_BUFFER_MODE)pick(6),
        .step = any_step(), .table = any_table(), .coupling = any_coupling(n),
    };
}

static void start_any(int n)
{
    cm1e_axis_command_t command = any_command(n);
    cm1e_axis_coupling_t coupling = *command.coupling;
    if (command.kind == CM1E_COMMAND_CAM_IN)
        coupling.cam = any_cam(n);
    command.coupling = &coupling;
    if (command.kind == CM1E_COMMAND_HOMING_STEP && command.step->kind == CM1E_STEP_FINISH)
        command.position /= 4;
    cm1e_command_id_t id;
    const cm1e_error_t error = cm1e_axis_start(axes_axis(n), &command, &id);
    units_note(error);
    taken += error == CM1E_OK;
    refused += error != CM1E_OK;
    if (id)
        ids[n][id % IDS] = id;
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static void change_settings(int n)
{
    const double factor = one_in(4) ? 0 : one_in(3) ? 1 : uniform(0.05, 1);
    if (one_in(2))
        units_note(cm1e_axis_set_override(axes_axis(n), factor, one_in(2) ? 1 : uniform(0.1, 1), 1));
    else if (one_in(3))
        units_note(cm1e_axis_set_position(axes_axis(n), in(n == TURNING ? uniform(0, 0.3) : uniform(-3, 3)),
                                          one_in(2)));
    else
        units_note(cm1e_axis_write_parameter(axes_axis(n), one_in(2) ? CM1E_PARAMETER_MAX_VELOCITY_APPL
                                                                          : CM1E_PARAMETER_MAX_ACCELERATION_APPL,
                                             size(decade(5, 50))));
}

static void program(void)
{
    for (int n = 0; n < AXES; n++) {
        if (one_in(60))
            start_any(n);
        if (one_in(300))
            change_settings(n);
        if (axes_state(n) == CM1E_AXIS_ERROR_STOP && one_in(50))
            units_note(cm1e_axis_reset(axes_axis(n)));
        cm1e_axis_hold_stop(axes_axis(n), ids[n][pick(IDS)], false);
    }
}

/** Before a cycle: what the motors and the bus do to the program. */
static void world(void)
{
    for (int n = 0; n < AXES; n++) {
        cm1e_bus_t *motor = axes_motor(n);
        if (one_in(400))
            motor->digital_inputs ^= (uint16_t)(1 << pick(3));
        if (one_in(10))
            motor->digital_inputs &= 4;
        if (one_in(1500))
            fake_bus_fault(motor, 0x8611);
        motor->blocked = motor->blocked ? !one_in(20) : one_in(800);
        motor->torque = (int16_t)(motor->blocked ? 500 : 100);
    }
    if (axes_bench.received == CM1E_OK ? one_in(400) : one_in(3))
        axes_bench.received = axes_bench.received == CM1E_OK ? CM1E_ERROR_BUS_LOST : CM1E_OK;
}

static void pause_now(void)
{
    const int64_t pause_ns = (2 + pick(60)) * axes_bench.cycle_ns;
    for (int n = 0; n < AXES; n++)
        cm1e_axis_after_pause(axes_axis(n), pause_ns);
}

static void one_cycle(void)
{
    world();
    axes_inputs();
    program();
    if (one_in(1000))
        pause_now();
    axes_outputs();
    double sum = 0;
    for (int n = 0; n < AXES; n++) {
        seen[axes_state(n)]++;
        for (int i = 0; i < IDS; i++) {
            const cm1e_command_status_t status = axes_status(n, ids[n][i]);
            sum = sum * 17 + status.state + 6 * status.reached + 8 * status.synchronizing;
        }
    }
    units_note(sum);
    units_note(axes_status(SLAVE, ids[SLAVE][0]).covered / in_units);
    units_cycle();
}

static void begin(void)
{
    memset(ids, 0, sizeof ids);
    make_machine();
}

static const units_program_t random_program = {begin, one_cycle, CYCLES};

static void test_no_axis_depends_on_the_unit_of_length(void)
{
    for (int i = 0; i < seed_count(PROGRAMS); i++)
        units_compare(&random_program, (int)seed_of(i), false);
    printf("%llu commands taken, %llu refused\n", taken, refused);
    if (seeds_given() || slowness() > EFFORT_FULL)
        return; /* all of them together have to reach this */
    TEST_ASSERT_TRUE(taken > refused);
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++)
        TEST_ASSERT_GREATER_THAN_MESSAGE(100, seen[state], cm1e_axis_state_name((cm1e_axis_state_t)state));
}

/** What is inverted, and is told everything inverted, turns the same way. */
static void test_no_axis_depends_on_the_sign_of_the_unit(void)
{
    mirrors = true;
    for (int i = 0; i < seed_count(PROGRAMS); i++)
        units_compare(&random_program, (int)seed_of(i), true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_axis_depends_on_the_unit_of_length);
    RUN_TEST(test_no_axis_depends_on_the_sign_of_the_unit);
    return UNITY_END();
}
