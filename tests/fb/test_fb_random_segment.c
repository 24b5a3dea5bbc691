/**
 * The random programs of test_fb_random.c on the simulated segment, with real frames and a simulated drive behind them:
 * the same rules, and the simulated motor follows the set-point. Faults come from the simulator's console and are those
 * that test_safety_random.c makes, which judges what is sent to the drives. The axis is a CM1-E alone, a servo drive of
 * another maker alone (CiA 402), or a motor behind a bridge (EB01, EB02, EB12; any K37) among up to three others there
 * and a CM1-E, which move to and fro: what happens to one motor is nothing to them.
 *
 * Seeds: seeds.h.
 */
#include "random_program.h"
#include "bus/bus_image.h"
#include "device/unit.h"
#include "nic/nic.h"
#include "ordinary_witness.h"
#include "sim/bridge_app.h"

enum { MOST_OTHERS = 4, SDO_CYCLES = 5, SEEN_CYCLES = 2, SETTLING = 200 };
enum { STEP_AT_START = 100 }; /* counts, of the simulated bridge */

/** An axis that is not judged call by call, and moves to and fro. */
typedef struct other {
    cm1e_axis_t *axis;
    const cm1e_axis_config_t *config;
    AXIS_REF_t reference;
    MC_Power_t power;
    MC_Reset_t reset;
    MC_MoveRelative_t move;
} other_t;

static struct bench {
    cm1e_bus_t *bus;
    cm1e_sim_segment_t *segment;
    cm1e_axis_info_t info;
    int64_t start_ns, disturbed_until;
    bool faulty;                    /**< a fault has not been healed yet */
    bool insisted;                  /**< CM_SetMode with Insist */
    uint32_t position;              /**< of the slave of the judged axis */
    unsigned channel;               /**< 0: the slave is the axis */
    bool other_maker;               /**< a servo drive by CiA 402 */
    other_t others[MOST_OTHERS];
    int other_count;
    int64_t bus_disturbed_until;    /**< by what concerns all axes */
    int64_t gap_until;              /**< targets are missing */
    double speed[3][5];             /**< counts/s a cycle ago, by slave and channel */
    long long handed_in[3][5];      /**< the last cycle without a write of the mode on its way */
    long long sound[3][5];          /**< the last cycle without an error of this motor, by slave and channel */
} bench;

static void play_others(void);

void cycle_begin(void)
{
    const int64_t planned_ns = bench.start_ns + judged.number * judged.cycle_ns;
    cm1e_clock_sleep_until(cm1e_bus_clock(bench.bus), planned_ns);
    const cm1e_error_t received = cm1e_bus_receive(bench.bus);
    ordinary_inputs(judged.axis, received, cm1e_bus_health(bench.bus), planned_ns);
    for (int i = 0; i < bench.other_count; i++)
        ordinary_inputs(bench.others[i].axis, received, cm1e_bus_health(bench.bus), planned_ns);
    judge_cycle();
    MC_Power(&powers[0]);
    judged.state = judged.axis->state;
    play_others();
}

void cycle_end(void)
{
    ordinary_outputs(judged.axis);
    for (int i = 0; i < bench.other_count; i++)
        ordinary_outputs(bench.others[i].axis);
    cm1e_bus_send(bench.bus);
    judge_cycle();
    watch_set_point();
    cm1e_axis_get(judged.axis, &bench.info);
    judged.number++;
}

enum { CYCLES = 20000, RUNS = 32, BRIDGE_RUNS = 24, CIA402_RUNS = 24, BATCHES = 4 };

typedef enum kind { ALONE = 0, BEHIND_BRIDGE, OTHER_MAKER } kind_t;
static const char *const kinds[] = {[ALONE] = "CM1-E", [BEHIND_BRIDGE] = "bridge", [OTHER_MAKER] = "CiA 402"};

/** NULL: not behind a bridge. */
static cm1e_sim_bridge_axis_t *motor_at(uint32_t position, unsigned channel)
{
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(bench.segment, position));
    return bridge ? &bridge->axes[channel - 1] : NULL;
}
static cm1e_sim_bridge_axis_t *motor(void) { return motor_at(bench.position, bench.channel); }

static cm1e_sim_probe_t probe(void)
{
    cm1e_sim_probe_t now;
    cm1e_sim_probe_channel(bench.segment, bench.position, bench.channel, &now);
    return now;
}

/** A motor that runs overshoots the target that stands still all at once, and takes its time to settle. */
void time_passes(int64_t time_ns)
{
    cm1e_clock_t *clock = cm1e_bus_clock(bench.bus);
    if (bench.disturbed_until < judged.number + SETTLING)
        bench.disturbed_until = judged.number + SETTLING;
    bench.start_ns += time_ns;
    bench.gap_until = judged.number + 5;
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + time_ns);
    for (int i = 0; i < bench.other_count; i++)
        cm1e_axis_after_pause(bench.others[i].axis, time_ns);
}

/** A CM1 holds by itself until it was enabled once (BR 6.1.1): that is nobody's torque. */
bool has_torque(void)
{
    const cm1e_sim_bridge_axis_t *m = motor();
    return probe().torque_on && (!m || m->state == OPERATION_ENABLED || m->state == SWITCHED_ON);
}
bool is_deaf(void) { return cm1e_bus_health(bench.bus) != CM1E_OK; }

/* ---- faults ------------------------------------------------------------------------------------------------------ */

__attribute__((format(printf, 1, 2))) static void console(const char *format, ...)
{
    char line[96], answer[256] = "";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    MUST(cm1e_bus_simulate(bench.bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

static uint16_t random_code(void)
{
    static const uint16_t codes[] = {0x2310, 0x3220, 0x4310, 0x5441, 0x7121, 0x7305, 0x8611, 0x8612};
    return bench.other_maker ? codes[pick(sizeof codes / sizeof codes[0])]
                             : cm1e_device_errors[(size_t)pick((int)cm1e_device_error_count)].code;
}

static void make_fault_of_motor(void)
{
    switch (pick(bench.other_maker ? 4 : 5)) {
    case 0: console("power %u off", bench.position); break;
    case 1: console("error %u %04X", bench.position, random_code()); break;
    case 2: console("load %u %g", bench.position, uniform(-0.5, 0.5)); break;
    case 3: console("sensor %u %d on", bench.position, 1 + pick(4)); break;
    default: console("over-torque %u", bench.position); break;
    }
}

static void make_fault_behind_bridge(void)
{
    static const char *const errors[] = {"position", "over-speed", "overload", "temperature"};
    switch (pick(3)) {
    case 0: console("motor %u %u unplug", bench.position, bench.channel); break;
    case 1: console("motor %u %u error %s", bench.position, bench.channel, errors[pick(4)]); break;
    default: console("motor %u %u broken %d", bench.position, bench.channel, 1 + pick(40)); break;
    }
}

static void make_fault(void)
{
    const int which = pick(7 + (bench.channel != 0));
    if (which == 5)
        console("lose %d", 1 + pick(3));
    else if (which == 6)
        console("unplug %u", bench.position);
    else if (which == 7)
        console("power-cycle %u %d", bench.position, 1 + pick(1000));
    else if (bench.channel)
        make_fault_behind_bridge();
    else
        make_fault_of_motor();
    if (which >= 5)
        bench.bus_disturbed_until = INT64_MAX;
}

static void heal(void)
{
    console("replug %u", bench.position);
    if (bench.bus_disturbed_until == INT64_MAX)
        bench.bus_disturbed_until = judged.number + 8000;
    if (bench.channel) {
        console("motor %u %u replug", bench.position, bench.channel);
        return;
    }
    console("power %u on", bench.position);
    console("error %u clear", bench.position);
    console("load %u 0", bench.position);
    for (int input = 1; input <= 4; input++)
        console("sensor %u %d auto", bench.position, input);
}

void act_on_device(void)
{
    if (one_in(4000)) {
        make_fault();
        bench.faulty = true;
    }
    if (bench.faulty)
        bench.disturbed_until = judged.number + 1000;
    if (one_in(400)) {
        heal();
        bench.faulty = false;
    }
}

/* ---- what must hold ---------------------------------------------------------------------------------------------- */

/** Whether 0x6060 was handed in before the error could be seen, and is on its way only now: others are before it. */
static bool handed_in_before(const cm1e_axis_config_t *axis, long long sound)
{
    const cm1e_sdo_t *sdo = &judged.axis->drive.change.sdo;
    long long *since = &bench.handed_in[axis->address][axis->channel];
    if (!sdo->write || sdo->state != CM1E_SDO_BUSY)
        *since = judged.number;
    return *since <= sound + SEEN_CYCLES;
}

/** The motor may not follow targets: somebody brought it from CMD or CPIO to csp, with Insist (BR 6 note 2). */
static bool is_abnormal(const cm1e_sim_bridge_axis_t *m) { return bench.insisted && m && m->abnormal; }

/** Those of the bridge's guide. An SDO that is on its way when a motor fails cannot be held back; nor do targets come that
 *  were in lost frames, or in a pause. A motor that friction holds beside its target may creep the last counts just when
 *  hm is asked for: then the switch is asked for again. */
static void judge_rules(const cm1e_sim_probe_t *shaft, const cm1e_axis_config_t *axis)
{
    const cm1e_sim_bridge_axis_t *m = motor_at(axis->address, axis->channel);
    long long *sound = &bench.sound[axis->address][axis->channel];
    if (!m || m->error == 0)
        *sound = judged.number;
    const bool before = handed_in_before(axis, *sound), just_failed = before || judged.number - *sound <= SDO_CYCLES;
    const bool gap = judged.number < bench.gap_until || judged.number < bench.bus_disturbed_until;
    /* A motor that runs out while it is enabled is seen where it was two cycles ago. */
    double *speed = &bench.speed[axis->address][axis->channel];
    const double now = m ? fabs(m->mechanics.velocity) : 0, fastest = fmax(now, *speed);
    const bool runs = fastest * 2e-9 * (double)judged.cycle_ns > STEP_AT_START;
    *speed = now;
    bench.insisted |= judged.axis->drive.command.mode_insist;
    const unsigned allowed = CM1E_SIM_OUTPUT_IN_VAIN | CM1E_SIM_MODE_IN_MOTION |
                             (is_abnormal(m) ? CM1E_SIM_MODE_NO_WAY : 0u) |
                             (just_failed ? CM1E_SIM_MODE_IN_ERROR : 0u) |
                             (runs ? CM1E_SIM_STEP_AT_START : 0u) | (gap ? CM1E_SIM_STEP_IN_CYCLE : 0u);
    MUST((shaft->broken_rules & ~allowed) == 0, "ID%u: rules of the bridge's guide are broken: 0x%03X", axis->channel,
         shaft->broken_rules);
    cm1e_sim_probe_reset_channel(bench.segment, axis->address, axis->channel);
}

/** A motor that nobody disturbs follows closely: what the servo lags by at its acceleration, and two cycles of way. */
void judge_motor(void)
{
    const bool moved_by_us = set_point_is_ours() && cm1e_axis_powered(judged.axis) && bench.info.mode == CM1E_MODE_CSP;
    const int64_t soon = judged.number + SETTLING;
    const cm1e_sim_probe_t shaft = probe();
    const cm1e_axis_config_t *axis = cm1e_axis_configuration(judged.axis);
    judge_rules(&shaft, axis);
    if (is_abnormal(motor_at(axis->address, axis->channel)))
        return;
    if (fabs(shaft.velocity_counts_per_s) > 1.3 * judged.axis->limits.maximum.velocity *
        fabs(judged.axis->position.scale))
        bench.disturbed_until = judged.number + 1000; /* somebody has turned it; it is braked */
    if ((!moved_by_us || judged.axis->state == CM1E_AXIS_ERROR_STOP) && bench.disturbed_until < soon)
        bench.disturbed_until = soon;
    if (judged.number < bench.disturbed_until)
        return;
    const double counts = fabs(judged.axis->position.scale), cycle_s = (double)judged.cycle_ns * 1e-9;
    const double allowed = 300 * judged.axis->position.count + 4 * watched.most.velocity * counts * cycle_s;
    MUST(fabs(bench.info.position_lag) * counts <= allowed, "%s: the motor lags by %.0f counts, %.0f allowed",
         cm1e_axis_state_name(judged.axis->state), bench.info.position_lag * counts, allowed);
}

/* ---- the others -------------------------------------------------------------------------------------------------- */

static void play_other(other_t *o)
{
    MC_Power(&o->power);
    MC_Reset(&o->reset);
    MC_MoveRelative(&o->move);
    cm1e_axis_info_t info;
    cm1e_axis_get(o->axis, &info);
    const bool in_error = info.state == CM1E_AXIS_ERROR_STOP;
    if (in_error && judged.number >= bench.bus_disturbed_until) {
        char text[512];
        cm1e_axis_error_text(o->reference, text, sizeof text);
        MUST(false, "an axis that nothing happened to is in ErrorStop: %s", text);
    }
    cm1e_sim_probe_t shaft;
    cm1e_sim_probe_channel(bench.segment, o->config->address, o->config->channel, &shaft);
    judge_rules(&shaft, o->config);
    o->reset.Execute = in_error && !o->reset.Execute;
    if (o->move.Execute)
        o->move.Execute = o->move.Busy;
    else if (info.state == CM1E_AXIS_STANDSTILL) {
        o->move.Distance = -o->move.Distance;
        o->move.Execute = TRUE;
    }
}

static void play_others(void)
{
    for (int i = 0; i < bench.other_count; i++)
        play_other(&bench.others[i]);
}

static void make_other(uint32_t index)
{
    cm1e_diag_t diag = {0};
    other_t *o = &bench.others[bench.other_count++];
    MUST(cm1e_axis_create(&o->axis, bench.bus, index, &diag) == CM1E_OK, "%s", diag.text);
    o->config = cm1e_axis_configuration(o->axis);
    o->reference = cm1e_axis_reference(o->axis);
    o->power = (MC_Power_t){.Axis = &o->reference, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
    o->reset = (MC_Reset_t){.Axis = &o->reference};
    o->move = (MC_MoveRelative_t){.Axis = &o->reference, .Distance = 0.5, .Velocity = 2};
}

/* ---- a run ------------------------------------------------------------------------------------------------------- */

static cm1e_bus_config_t config;

static void choose_alone(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 1);
    config.sim_pdo_order = (cm1e_pdo_order_t)pick(2);
    config.cycle_time_ns = one_in(3) ? cm1e_device_cycle_times_ns[pick(4)] : 1000000;
    random_axis(&config.axes[0]);
    bench.position = 1;
}

/** With the drive's own PDOs, with those of all modes, or with those of csp alone, whose modes go by SDO. */
static void choose_other_maker(void)
{
    static const int8_t methods[] = {17, 18, 19, 20, 21, 22, 35, 37};
    static const uint32_t counts[] = {20000, 50000, 65536, 131072};
    choose_alone();
    cm1e_axis_config_t *axis = &config.axes[0];
    const int pdos = pick(3);
    bench.other_maker = true;
    strcpy(axis->device, "cia402");
    axis->counts_per_revolution = counts[pick(4)];
    axis->max_speed_rpm = 3000 + 1000 * pick(3);
    axis->outputs_pdo = (uint16_t)(pdos ? 0x15FF + pdos : 0);
    axis->inputs_pdo = (uint16_t)(pdos ? 0x19FF + pdos : 0);
    axis->homing.method = methods[pick(8)];
    axis->inputs = (cm1e_input_config_t){.limit_positive = 2, .limit_negative = 1, .home = 3};
}

static void choose_motor(cm1e_axis_config_t *axis, cm1e_device_model_t model, unsigned channel)
{
    const cm1e_bridge_motor_t kind = cm1e_bridge_motor(model, channel - 1);
    axis->address = (uint16_t)bench.position;
    axis->channel = (uint8_t)channel;
    snprintf(axis->motor, sizeof axis->motor, "%s", cm1e_bridge_motor_name(kind));
    do
        axis->k37 = (uint8_t)pick(91);
    while (cm1e_bridge_position_limit(kind, axis->k37) == 0 || cm1e_bridge_counts_per_revolution(axis->k37) < 10000);
    axis->k37_stated = true;
    axis->homing.method = (int8_t)(1 + pick(4));
    axis->inputs = (cm1e_input_config_t){.limit_positive = 4, .limit_negative = 2, .home = 3};
}

/** The judged axis is the first of the list; a CM1-E before or behind the bridge is the last, if there is one. */
static void choose_bridge(void)
{
    const cm1e_device_model_t model = (cm1e_device_model_t)(CM1E_DEVICE_EB01 + pick(3));
    const unsigned first = 1 + (unsigned)pick(4), motors = 1 + (unsigned)pick(4);
    const bool cm1e = one_in(2);
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", motors + cm1e);
    config.cycle_time_ns = 1000000;
    bench.position = cm1e && one_in(2) ? 2 : 1;
    bench.channel = first;
    for (unsigned i = 0; i < motors; i++)
        choose_motor(&config.axes[i], model, (first - 1 + i) % CM1E_BRIDGE_AXES + 1);
    if (cm1e)
        config.axes[motors].address = (uint16_t)(3 - bench.position);
    const int8_t method = config.axes[0].homing.method;
    const cm1e_input_config_t inputs = config.axes[0].inputs;
    random_axis(&config.axes[0]);
    config.axes[0].homing.method = method;
    config.axes[0].inputs = inputs;
}

static void prepare(unsigned seed, kind_t kind)
{
    cm1e_diag_t diag = {0};
    snprintf(judged.scene, sizeof judged.scene, "%s, seed %u", kinds[kind], seed);
    chance_seed(seed);
    memset(&bench, 0, sizeof bench);
    static void (*const choose[])(void) = {choose_alone, choose_bridge, choose_other_maker};
    choose[kind]();
    config.virtual_time = true;
    judged.cycle_ns = config.cycle_time_ns;
    cm1e_axis_config_t *axis = &config.axes[0];
    axis->max_velocity = 20 * cm1e_unit_counts_per_revolution(axis) / cm1e_unit_scale(axis);
    axis->max_acceleration = axis->max_deceleration = 0; /* 100 revolutions/s2, which every motor can do */
    axis->sim.no_stops = true;
    for (uint32_t i = 1; i < config.axis_count; i++)
        config.axes[i].sim.no_stops = true;
    MUST(cm1e_bus_open(&bench.bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    MUST(cm1e_bus_start(bench.bus, &diag) == CM1E_OK, "%s", diag.text);
    MUST(cm1e_axis_create(&judged.axis, bench.bus, 0, &diag) == CM1E_OK, "%s", diag.text);
    for (uint32_t i = 1; i < config.axis_count; i++)
        make_other(i);
    bench.segment = cm1e_bus_segment(bench.bus);
    judged.reference = cm1e_axis_reference(judged.axis);
    judged.state = CM1E_AXIS_DISABLED;
    judged.reset_asked = false;
    judged.number = 0;
    watched.ours = false;
    powers[0] = (MC_Power_t){.Axis = &judged.reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
    bench.start_ns = cm1e_clock_now(cm1e_bus_clock(bench.bus));
    begin_blocks();
    begin_program();
}

static void run(unsigned seed, kind_t kind)
{
    prepare(seed, kind);
    const int length = CYCLES / 2 + pick(CYCLES);
    for (int i = 0; i < length; i++)
        one_cycle();
    cycles_total += (unsigned long long)length;
    cm1e_bus_stop(bench.bus);
    MUST(!has_torque() || judged.number < bench.disturbed_until, "torque after the end");
    cm1e_axis_destroy(judged.axis);
    for (int i = 0; i < bench.other_count; i++)
        cm1e_axis_destroy(bench.others[i].axis);
    end_groups();
    cm1e_bus_close(bench.bus);
}

static int batches(void) { return seeds_given() ? 1 : BATCHES; }

static void run_seeds(int batch, int wanted, kind_t kind)
{
    const int runs = seed_count(wanted);
    for (int i = batch; i < runs; i += batches())
        run(seed_of(i), kind);
    printf("%s, batch %d: %llu cycles, %llu of them moving, %llu edges, %llu times Done\n",
           kinds[kind], batch, cycles_total, watched.moving, edges_total, done_total);
    if (!seeds_given() && runs >= wanted)
        MUST(watched.moving > cycles_total / 8, "too wild to test anything");
}

START_TEST(test_random_programs_on_the_segment_keep_every_rule) { run_seeds(_i, RUNS, ALONE); }
END_TEST

START_TEST(test_random_programs_behind_a_bridge_keep_every_rule) { run_seeds(_i, BRIDGE_RUNS, BEHIND_BRIDGE); }
END_TEST

START_TEST(test_random_programs_on_a_drive_of_another_maker_keep_every_rule)
{
    run_seeds(_i, CIA402_RUNS, OTHER_MAKER);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("random programs on the segment");
    TCase *all = tcase_create("CM1-E"), *bridge = tcase_create("bridge"), *other = tcase_create("CiA 402");
    tcase_set_timeout(all, 250);
    tcase_set_timeout(bridge, 250);
    tcase_set_timeout(other, 250);
    tcase_add_loop_test(all, test_random_programs_on_the_segment_keep_every_rule, 0, batches());
    tcase_add_loop_test(bridge, test_random_programs_behind_a_bridge_keep_every_rule, 0, batches());
    suite_add_tcase(suite, all);
    tcase_add_loop_test(other, test_random_programs_on_a_drive_of_another_maker_keep_every_rule, 0, batches());
    suite_add_tcase(suite, bridge);
    suite_add_tcase(suite, other);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
