/**
 * Random programs on one to four axes, millions of cycles: every block of the table with random inputs, nonsense among
 * them, at any time and in any order; power, directions, faults of the drives, lost frames; axes that follow each other,
 * up to two axes groups whose members come and go. What must hold after every cycle:
 *
 *  - position, velocity, acceleration and jerk of the set-point keep the axis's limits, and fit together;
 *  - the motor follows: the drive is sent the set-point, and only under torque;
 *  - outputs of every block as PLCopen 2.4.1 says, one block Active at most (superimposed motions beside it);
 *  - the state goes only the ways of figure 2; a refused command changes nothing;
 *  - a move that is Done has arrived where it was to; nothing stands still for ever that should move;
 *  - a slave that is InGear is where its master and the ratio say;
 *  - a group goes only the ways of its diagram, has a command while it moves, comes to rest without, and leads exactly
 *    those axes that are in SynchronizedMotion for it; a line that is Done has arrived;
 *  - in Standstill nothing moves, and without MC_Power or in ErrorStop the torque ends in time.
 *
 * Seeds: seeds.h.
 */
#include "random_program.h"
#include "fake_bus.h"
#include "ordinary_witness.h"

enum { CYCLES = 20000, RUNS = 256, BATCHES = 8 };

/** The axes and their drives without frames. */
static struct bench {
    cm1e_bus_t bus, others[JUDGED_MOST - 1];
    int order[JUDGED_MOST];         /**< of the outputs */
    cm1e_error_t received, health;
    int homing_cycles;              /**< what the drive's own homing takes */
    int homing_cycle[JUDGED_MOST];  /**< -1: none runs; -2: it is over */
    /** A load that turns the shaft: counts in a cycle, and how many cycles more when the motor has torque. */
    struct coasting {
        int32_t position, speed;
        int cycles;
    } coasting[JUDGED_MOST];
    uint32_t encoder;               /**< what all encoders count, and how fast they do */
    int encoder_speed;
} bench;

static cm1e_bus_t *motor_of(int n) { return n == 0 ? &bench.bus : &bench.others[n - 1]; }

static int number_of(const cm1e_bus_t *bus) { return bus == &bench.bus ? 0 : (int)(bus - bench.others) + 1; }

static cm1e_axis_type_t type_of(int n) { return cm1e_axis_configuration(judged_axes[n].axis)->type; }

/* ---- the drives -------------------------------------------------------------------------------------------------- */

/** The drive's own homing: the bits of UG 6.2.4 one after the other; the counts are renamed at the end. */
static void fake_homing(cm1e_bus_t *bus)
{
    int *cycle = &bench.homing_cycle[number_of(bus)];
    const bool start = bus->state == OPERATION_ENABLED && (bus->controlword & CONTROLWORD_HOMING_START);
    if (!start || (bus->controlword & CONTROLWORD_HALT)) {
        if (*cycle >= 0 || bus->mode_status == 0)
            bus->mode_status = STATUSWORD_TARGET_REACHED;
        *cycle = start ? -2 : -1;
        return;
    }
    if (*cycle == -2)
        return;
    const int n = ++*cycle;
    bus->mode_status = (uint16_t)(n < bench.homing_cycles ? 0 : n < bench.homing_cycles + 5
                                                                    ? STATUSWORD_HOMING_ATTAINED
                                                                    : STATUSWORD_HOMING_ATTAINED |
                                                                          STATUSWORD_TARGET_REACHED);
    if (n < bench.homing_cycles)
        bus->position -= 20;
    else if (n == bench.homing_cycles + 5)
        bus->position = 2;
}

/** The motor has torque, and its load still turns it for some cycles; then it follows, at once. */
static void coast(cm1e_bus_t *bus)
{
    struct coasting *load = &bench.coasting[number_of(bus)];
    if (load->cycles == 0)
        return;
    load->cycles -= bus->state == OPERATION_ENABLED;
    load->position = bus->position = (int32_t)((uint32_t)load->position + (uint32_t)load->speed);
    const double per_s = 1e9 / (double)judged.cycle_ns;
    const int unit = cm1e_firmware_info(bus->firmware)->velocity_in_counts_per_ms ? 1000 : 1;
    bus->velocity_raw = load->cycles > 0 ? (int32_t)lround(load->speed * per_s / unit) : 0;
}

/** Somebody shoves the load of a motor without torque. */
static void shove(cm1e_bus_t *bus)
{
    const int n = number_of(bus);
    const cm1e_axis_t *axis = judged_axes[n].axis;
    const double most = axis->limits.system.velocity * fabs(axis->position.scale) * (double)judged.cycle_ns * 1e-9;
    bench.coasting[n] = (struct coasting){
        .position = bus->position, .speed = (int32_t)uniform(-1.2 * most, 1.2 * most), .cycles = 1 + pick(8)};
}

/** In CSV the shaft turns as it is told. */
static void turn_shafts(void)
{
    for (int n = 0; n < axis_count; n++) {
        cm1e_bus_t *bus = motor_of(n);
        if (bus->state == OPERATION_ENABLED && bus->mode == CM1E_MODE_CSV && !bus->blocked)
            bus->position += (int32_t)lround((int32_t)fake_output(bus, OBJ_60FF_TARGET_VELOCITY, 0) *
                                             (double)judged_axes[n].axis->drive.range.velocity_unit *
                                             (double)judged.cycle_ns * 1e-9);
    }
}

/** Hand wheels, that somebody turns; now and then nobody reads them. */
static void turn_encoders(void)
{
    if (one_in(300))
        bench.encoder_speed = one_in(3) ? 0 : (int)uniform(-300, 300);
    bench.encoder += (uint32_t)bench.encoder_speed;
    for (int n = 0; n < axis_count; n++)
        if (type_of(n) == CM1E_AXIS_ENCODER && !one_in(3000))
            (void)cm1e_axis_write_encoder(judged_axes[n].reference, bench.encoder, !one_in(3000));
}

void cycle_begin(void)
{
    turn_shafts();
    turn_encoders();
    fake_bus_cycle(&bench.bus, judged_axes[0].cycle_ns);
    for (int n = 0; n < axis_count; n++)
        ordinary_inputs(judged_axes[n].axis, bench.received, bench.health, bench.bus.clock.virtual_now_ns);
    for (int n = 0; n < axis_count; n++) {
        judged_at = n;
        judge_cycle();
    }
    for (int n = 0; n < axis_count; n++)
        MC_Power(&powers[n]);
    for (int n = 0; n < axis_count; n++)
        judged_axes[n].state = judged_axes[n].axis->state; /* what MC_Power may do is judged where it is tested */
}

void cycle_end(void)
{
    for (int n = 0; n < axis_count; n++)
        ordinary_outputs(judged_axes[bench.order[n]].axis);
    for (int n = 0; n < axis_count; n++) {
        judged_at = n;
        judge_cycle();
        watch_set_point();
        judged.number++;
    }
}

/* ---- a run ------------------------------------------------------------------------------------------------------- */

static void describe_motor(int n)
{
    cm1e_axis_config_t axis = {0};
    random_axis(&axis);
    axis.mapping = one_in(4) ? (cm1e_mapping_t)pick(4) : CM1E_MAPPING_DYNAMIC;
    axis.coupling_stop = (cm1e_coupling_stop_t)pick(3);
    axis.cam_points = one_in(2) ? 0 : 8;
    if (n > 0 && one_in(3)) {
        axis.type = one_in(4) ? CM1E_AXIS_ENCODER : CM1E_AXIS_VIRTUAL;
        axis.mapping = CM1E_MAPPING_DYNAMIC;
    }
    fake_bus_init(motor_of(n), axis.mapping, (cm1e_pdo_order_t)pick(2), (cm1e_firmware_t)pick(CM1E_FIRMWARE_COUNT));
    snprintf(axis.name, sizeof axis.name, "axis%d", n);
    motor_of(n)->config.axes[0] = axis;
    motor_of(n)->homing = fake_homing;
    motor_of(n)->world = coast;
    motor_of(n)->mode_status = STATUSWORD_TARGET_REACHED;
    bench.homing_cycle[n] = -1;
    if (n > 0)
        fake_bus_add(&bench.bus, motor_of(n));
}

static void make_axis(int n)
{
    cm1e_diag_t diag = {0};
    judged_at = n;
    MUST(cm1e_axis_create(&judged.axis, &bench.bus, (uint32_t)n, &diag) == CM1E_OK, "%s", diag.text);
    judged.reference = cm1e_axis_reference(judged.axis);
    judged.state = CM1E_AXIS_DISABLED;
    judged.reset_asked = false;
    judged.number = 0;
    judged.cycle_ns = bench.bus.config.cycle_time_ns;
    watched.ours = false;
    powers[n] = (MC_Power_t){.Axis = &judged.reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
}

static void prepare(unsigned seed, int axes)
{
    for (int n = 0; n < JUDGED_MOST; n++) {
        cm1e_axis_destroy(judged_axes[n].axis);
        judged_axes[n].axis = NULL;
        snprintf(judged_axes[n].scene, sizeof judged_axes[n].scene, "seed %u", seed);
    }
    end_groups();
    chance_seed(seed);
    memset(&bench, 0, sizeof bench);
    axis_count = axes;
    for (int n = 0; n < axes; n++)
        describe_motor(n);
    bench.bus.config.cycle_time_ns = one_in(3) ? cm1e_device_cycle_times_ns[pick(4)] : 1000000;
    bench.homing_cycles = 1 + pick(200);
    for (int n = 0; n < axes; n++) {
        const int place = pick(n + 1); /* shuffled as it grows */
        bench.order[n] = bench.order[place];
        bench.order[place] = n;
        make_axis(n);
    }
    judged_at = 0;
    begin_blocks();
    fake_bus_show(&bench.bus);
    for (int i = 0; i < 2; i++) {
        cycle_begin();
        cycle_end();
    }
    begin_program();
}

/* ---- faults -------------------------------------------------------------------------------------------------- */

static void act_on_motor(cm1e_bus_t *bus)
{
    if (one_in(12000))
        fake_bus_fault(bus, cm1e_device_errors[(size_t)pick((int)cm1e_device_error_count)].code);
    if (bus->power ? one_in(15000) : one_in(60))
        bus->power = !bus->power;
    if (bus->blocked ? one_in(50) : one_in(15000))
        bus->blocked = !bus->blocked;
    if (one_in(300))
        bus->digital_inputs = (uint16_t)pick(16);
    if (bus->state != OPERATION_ENABLED && one_in(1000))
        bus->position += pick(20001) - 10000; /* somebody turns the shaft */
    if (bus->state != OPERATION_ENABLED && one_in(300))
        shove(bus);
}

void act_on_device(void)
{
    bench.received = one_in(200) ? CM1E_ERROR_BUS_LOST : CM1E_OK;
    if (bench.health ? one_in(30) : one_in(15000))
        bench.health = bench.health ? CM1E_OK : CM1E_ERROR_BUS_LOST;
    if (bench.health)
        bench.received = bench.health;
    for (int n = 0; n < axis_count; n++)
        act_on_motor(motor_of(n));
}

/* ---- what must hold after every cycle ---------------------------------------------------------------------------- */

void time_passes(int64_t time_ns)
{
    for (int64_t left = time_ns; left > 0; left -= judged.cycle_ns)
        turn_shafts();
}

bool has_torque(void)
{
    return type_of(judged_at) == CM1E_AXIS_MOTOR && motor_of(judged_at)->state == OPERATION_ENABLED;
}
bool is_deaf(void) { return bench.health != CM1E_OK; }

/** Under torque in its own mode the drive has what the axis wants; without, it has its own position. */
void judge_motor(void)
{
    const cm1e_bus_t *bus = motor_of(judged_at);
    const cm1e_image_slot_t slot =
        cm1e_bus_find_output(&bench.bus, (uint16_t)(judged_at + 1), OBJ_607A_TARGET_POSITION, 0);
    const bool holding = bus->state == OPERATION_ENABLED && bus->mode == CM1E_MODE_CSP && slot.bytes;
    if (!holding || bus->blocked || type_of(judged_at) != CM1E_AXIS_MOTOR)
        return;
    const double fastest = judged.axis->limits.maximum.velocity * fabs(judged.axis->position.scale) *
                           (double)judged.cycle_ns * 1e-9;
    const uint32_t target = (uint32_t)cm1e_get_uint(bench.bus.outputs + slot.offset, slot.bytes);
    const double off = (double)(int32_t)(target - (uint32_t)bus->position);
    MUST(fabs(off) <= fastest + 1.01 + judged.axis->limits.max_lag * fabs(judged.axis->position.scale),
         "the target is %.0f counts from the motor", off);
}

static unsigned long long moving_of_all(void)
{
    unsigned long long cycles = 0;
    for (int n = 0; n < JUDGED_MOST; n++)
        cycles += watched_axes[n].moving;
    return cycles;
}

static unsigned long long ramps_of_all(void)
{
    unsigned long long ramps = 0;
    for (int n = 0; n < JUDGED_MOST; n++)
        ramps += watched_axes[n].ramps;
    return ramps;
}

/** Every other program has several axes. */
static void run(unsigned seed)
{
    const int axes = seed % 2 ? 1 : 2 + (int)(seed / 2 % 3);
    prepare(seed, axes);
    const int length = CYCLES / 2 + pick(CYCLES);
    for (int i = 0; i < length; i++)
        one_cycle();
    cycles_total += (unsigned long long)length * (unsigned)axes;
}

static int batches(void) { return seeds_given() ? 1 : BATCHES; }

START_TEST(test_random_programs_keep_every_rule)
{
    const int runs = seed_count(RUNS);
    for (int i = _i; i < runs; i += batches())
        run(seed_of(i));

    printf("batch %d: %llu axis-cycles, %llu of them moving, %llu in gear, %llu led by a group, %llu edges, "
           "%llu times Done, %llu of groups, %llu motors braked when they got their torque\n", _i, cycles_total,
           moving_of_all(), synchronised_total, led_total, edges_total, done_total, group_done_total, ramps_of_all());
    if (seeds_given() || runs < RUNS)
        return;
    MUST(moving_of_all() > cycles_total / 8, "too wild to test anything");
    MUST(ramps_of_all() > 5, "only %llu motors were braked when they got their torque", ramps_of_all());
    MUST(led_total > cycles_total / 200 && group_done_total > 0, "groups have moved nothing");
    for (int state = 0; state < CM1E_GROUP_STATE_COUNT; state++)
        MUST(group_seen[state] > 0, "never in %s", cm1e_group_state_name((cm1e_group_state_t)state));
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++)
        MUST(seen[state] > 0 || state == CM1E_AXIS_SYNCHRONIZED_MOTION, "never in %s",
             cm1e_axis_state_name((cm1e_axis_state_t)state));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("random programs");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 250);
    tcase_add_loop_test(all, test_random_programs_keep_every_rule, 0, batches());
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
