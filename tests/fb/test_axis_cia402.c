/**
 * A servo drive of another maker by CiA 402 (`device: cia402`), on the simulated segment: start, csp, csv, pp, pv,
 * homing by methods of the standard, faults and their reset, its own touch probes.
 */
#include "axis/axis_parts.h"
#include "axis/axis_signals.h"
#include "cm1e/generate.h"
#include "device/cia402_drive.h"
#include "sim/cia402_app.h"
#include "axis_segment.h"

enum { COUNTS = 131072, EDGE_COUNTS = 150000 };
#define SCALE (COUNTS / 50000.0) /* counts of this drive in those of the simulated mechanics */

static void describe_other(unsigned pdos)
{
    describe("", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    cm1e_axis_config_t *c = &config.axes[0];
    snprintf(c->device, sizeof c->device, "cia402");
    c->counts_per_revolution = COUNTS;
    c->max_speed_rpm = 3000;
    c->units_per_revolution = 10;
    c->outputs_pdo = pdos ? (uint16_t)(0x1600 + pdos - 1) : 0;
    c->inputs_pdo = pdos ? (uint16_t)(0x1A00 + pdos - 1) : 0;
    c->homing = (cm1e_homing_config_t){.method = 37, .velocity = 20, .acceleration = 400};
}

static void begin(unsigned pdos)
{
    describe_other(pdos);
    open_segment();
    enable();
}

/* u; where the shaft is, by the simulated mechanics. */
static double shaft(void) { return probe().position_counts / COUNTS * 10; }

/* ---- start ------------------------------------------------------------------------------------------------------- */

/* 0: the assignment of the device itself, 1 ... 3: of the bus file, all modes, csp, csv. */
START_TEST(it_starts_with_its_own_process_data_or_those_of_the_bus_file)
{
    static const int8_t modes[] = {CM1E_MODE_CSP, CM1E_MODE_CSP, CM1E_MODE_CSP, CM1E_MODE_CSV};
    static const uint16_t outputs_bytes[] = {18, 18, 6, 6};
    begin((unsigned)_i);
    const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, 1);
    ck_assert_str_eq(slave->kind, "cia402");
    ck_assert_uint_eq(slave->output_bytes, outputs_bytes[_i]);
    ck_assert_int_eq(info().mode, modes[_i]);
    ck_assert_int_eq(probe().mode, modes[_i]);
    ck_assert(probe().torque_on);
    cycles(500);
    ck_assert_double_eq_tol(shaft(), 0, 0.01);
    power(false);
    cycles(100);
    ck_assert(!probe().torque_on);
    ck_assert_int_eq(info().state, CM1E_AXIS_DISABLED);
    close_segment();
}
END_TEST

START_TEST(every_cycle_time_is_told_to_the_drive)
{
    static const int64_t cycles_ns[] = {200000, 250000, 500000, 1000000, 2000000, 4000000};
    describe_other(0);
    config.cycle_time_ns = cycles_ns[_i];
    open_segment();
    uint8_t value, index;
    size_t size = 1;
    ck_assert(cm1e_sdo_read(bus, 1, OBJ_60C2_INTERPOLATION_TIME, 1, &value, &size, &diag) == CM1E_OK);
    ck_assert(cm1e_sdo_read(bus, 1, OBJ_60C2_INTERPOLATION_TIME, 2, &index, &size, &diag) == CM1E_OK);
    ck_assert_double_eq_tol(value * pow(10, (int8_t)index), (double)cycles_ns[_i] * 1e-9, 1e-9);
    enable();
    move_to(20, 50);
    ck_assert_double_eq_tol(shaft(), 20, 0.01);
    close_segment();
}
END_TEST

static void expect_refused(const char *part)
{
    memset(&diag, 0, sizeof diag);
    cm1e_error_t error = cm1e_bus_open(&bus, &config, &diag);
    if (error == CM1E_OK)
        error = cm1e_bus_start(bus, &diag);
    ck_assert_msg(error != CM1E_OK && strstr(diag.text, part), "\"%s\" is not in: %s", part, diag.text);
    cm1e_bus_close(bus);
    bus = NULL;
}

START_TEST(what_cannot_work_is_said)
{
    describe_other(0);
    config.axes[0].counts_per_revolution = 0;
    expect_refused("drive.counts_per_revolution is missing");
    describe_other(0);
    config.axes[0].max_speed_rpm = 0;
    expect_refused("drive.max_speed_rpm is missing");
    describe_other(2);
    config.axes[0].inputs_pdo = 0;
    expect_refused("drive.inputs_pdo is missing");
    describe_other(0);
    snprintf(config.axes[0].device, sizeof config.axes[0].device, "cia403");
    expect_refused("expected cm1-e, bridge or cia402");
    describe_other(0);
    snprintf(config.axes[0].motor, sizeof config.axes[0].motor, "CM1-E-17S30D");
    expect_refused("state its motor");
    describe_other(0);
    config.axes[0].channel = 1;
    expect_refused("expected no channel");
    describe_other(0);
    config.axes[0].homing.torque = 30;
    expect_refused("homing.torque is given");
    describe_other(8);
    expect_refused("0x1C12");
    describe("", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].counts_per_revolution = COUNTS;
    expect_refused("with the device cia402 only");
}
END_TEST

START_TEST(no_file_is_made_of_a_drive_of_another_maker)
{
    static const cm1e_device_options_t drive = {.model = CM1E_DEVICE_CIA402};
    static const cm1e_file_format_t formats[] = {CM1E_FILE_ESI, CM1E_FILE_EC_EXTEND, CM1E_FILE_SII};
    for (int i = 0; i < 3; i++) {
        cm1e_file_t file;
        const cm1e_generate_options_t options = {.format = formats[i], .devices = &drive, .device_count = 1};
        ck_assert_int_eq(cm1e_generate(&file, &options, &diag), CM1E_ERROR_CONFIG);
        ck_assert_ptr_nonnull(strstr(diag.text, "by its maker"));
    }
}
END_TEST

/* ---- motion ------------------------------------------------------------------------------------------------------ */

START_TEST(moves_end_at_their_target_in_csp_and_csv)
{
    begin((unsigned)_i);
    move_to(40, 100);
    cycles(300);
    ck_assert_double_eq_tol(shaft(), 40, 0.02);
    move_to(-20, 300);
    cycles(300);
    ck_assert_double_eq_tol(shaft(), -20, 0.02);
    ck_assert_double_eq_tol(info().actual_position, -20, 0.02);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    const cm1e_command_id_t turning =
        command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 30});
    cycles(1000);
    ck_assert(cm1e_axis_command_status(axis, turning).state == CM1E_COMMAND_ACTIVE);
    ck_assert_double_eq_tol(probe().velocity_counts_per_s / COUNTS * 10, 30, 0.5);
    await(command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT, .deceleration = 1000}), 2);
    cycles(200);
    ck_assert_double_eq_tol(probe().velocity_counts_per_s, 0, 100);
    close_segment();
}
END_TEST

START_TEST(the_drive_makes_motions_itself_in_pp_and_pv)
{
    describe_other(0);
    config.axes[0].motion = CM1E_MOTION_DRIVE;
    open_segment();
    enable();
    cm1e_command_id_t id = command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = -40, .velocity = 100, .acceleration = 1000});
    bool pp = false, pv = false;
    for (int n = 0; n < 5000 && cm1e_axis_command_status(axis, id).state == CM1E_COMMAND_ACTIVE; n++) {
        cycles(1);
        pp |= probe().mode == CM1E_MODE_PP;
    }
    ck_assert_msg(cm1e_axis_command_status(axis, id).state == CM1E_COMMAND_DONE, "%s", text());
    cycles(300);
    ck_assert_double_eq_tol(shaft(), -40, 0.02);
    ck_assert_double_eq_tol(probe().peak_velocity_counts_per_s / COUNTS * 10, 100, 5);
    command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 40, .acceleration = 500});
    for (int n = 0; n < 1000; n++) {
        cycles(1);
        pv |= probe().mode == CM1E_MODE_PV;
    }
    ck_assert_double_eq_tol(probe().velocity_counts_per_s / COUNTS * 10, 40, 1);
    await(command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT}), 3);
    cycles(200);
    ck_assert(pp && pv);
    ck_assert_int_eq(info().mode, CM1E_MODE_CSP);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    close_segment();
}
END_TEST

/* ---- homing ------------------------------------------------------------------------------------------------------ */

static cm1e_command_id_t home(double position)
{
    return command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .position = position});
}

/* The switches of the simulated axis: positive limit at +150,000 counts of the mechanics, home at -150,000. */
static const struct {
    int8_t method;
    double home_switch, place; /* counts of the mechanics */
} homings[] = {{18, 0, EDGE_COUNTS},            {19, EDGE_COUNTS, EDGE_COUNTS}, {20, EDGE_COUNTS, EDGE_COUNTS},
               {21, -EDGE_COUNTS, -EDGE_COUNTS}, {22, 0, -EDGE_COUNTS},          {35, 0, 0},
               {37, 0, 0}};

START_TEST(homing_finds_the_place_and_reckons_the_offset)
{
    describe_other(_i % 2 ? 0 : 3); /* homing needs no target in the process data */
    config.axes[0].homing.method = homings[_i].method;
    config.axes[0].homing.offset = 7;
    config.axes[0].sim.sensor_input3 = homings[_i].home_switch;
    open_segment();
    enable();
    const double started = shaft();
    await(home(100), 30);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    cycles(300);
    /* What is 7 u beyond the switch is called 100. */
    const double place = homings[_i].place == 0 ? started : homings[_i].place / 50000 * 10;
    ck_assert_double_eq_tol(info().actual_position, 100 + shaft() - (place + 7), 0.005);
    ck_assert_double_eq_tol(shaft(), place, 0.1);
    move_to(100, 50);
    cycles(500);
    ck_assert_double_eq_tol(shaft(), place + 7, 0.02);
    await(home(0), 30); /* again, standing beside the switch or on it */
    ck_assert_double_eq_tol(info().actual_position,
                            shaft() - ((homings[_i].place == 0 ? place + 7 : place) + 7), 0.02);
    close_segment();
}
END_TEST

START_TEST(a_method_that_the_drive_lacks_fails_and_a_stop_ends_a_homing)
{
    describe_other(0);
    config.axes[0].homing.method = 33; /* index pulse: the simulated drive has none */
    open_segment();
    enable();
    cm1e_command_id_t id = home(0);
    cycles(1000);
    ck_assert_int_eq(cm1e_axis_command_status(axis, id).state, CM1E_COMMAND_ERROR);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(info().error, CM1E_ERROR_AXIS_HOMING_FAILED);
    close_segment();

    describe_other(0);
    config.axes[0].homing.method = 22;
    open_segment();
    enable();
    id = home(0);
    cycles(500);
    ck_assert_double_lt(probe().velocity_counts_per_s, -1000);
    await(command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP, .deceleration = 1000}), 3);
    cycles(200);
    ck_assert_double_eq_tol(probe().velocity_counts_per_s, 0, 100);
    ck_assert_int_eq(cm1e_axis_command_status(axis, id).state, CM1E_COMMAND_ABORTED);
    ck_assert(probe().torque_on);
    close_segment();
}
END_TEST

/* ---- faults ------------------------------------------------------------------------------------------------------ */

static void reset_axis(void)
{
    ck_assert_int_eq(cm1e_axis_reset(axis), CM1E_OK);
    for (int n = 0; n < 3000 && info().state == CM1E_AXIS_ERROR_STOP; n++)
        cycles(1);
    ck_assert_msg(info().state != CM1E_AXIS_ERROR_STOP, "%s", text());
}

START_TEST(a_fault_in_a_move_ends_it_and_a_reset_clears_it)
{
    static const struct {
        const char *raise, *clear;
        uint16_t code;
        cm1e_error_t error;
    } faults[] = {{"power 1 off", "power 1 on", 0x3220, CM1E_ERROR_DRIVE_POWER},
                  {"error 1 4310", NULL, 0x4310, CM1E_ERROR_DRIVE_FAULT},
                  {"error 1 7305 hold", "error 1 clear", 0x7305, CM1E_ERROR_DRIVE_FAULT},
                  {"load 1 1.25", "load 1 0", 0x8611, CM1E_ERROR_DRIVE_FAULT}};
    describe_other(0);
    config.axes[0].max_position_lag = 500;
    open_segment();
    enable();
    command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 20});
    cycles(500);
    simulate(faults[_i].raise);
    cycles(300);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(info().error, faults[_i].error);
    ck_assert_uint_eq(info().device_error, faults[_i].code);
    ck_assert(!probe().torque_on);
    ck_assert_ptr_nonnull(strstr(text(), "Cure"));
    if (faults[_i].clear)
        simulate(faults[_i].clear);
    cycles(200);
    reset_axis();
    enable();
    const double from = info().actual_position;
    move_to(from - 10, 50);
    ck_assert_double_eq_tol(info().actual_position, from - 10, 0.05);
    close_segment();
}
END_TEST

/* By its limit switch or an input of its own. 0x605A: with 2 it leaves the state after its ramp, with 6 it stays there
 * under torque until Disable voltage. */
START_TEST(a_quick_stop_of_the_drive_itself_ends_its_ramp_and_then_has_no_torque)
{
    static const int16_t options[] = {2, 6};
    describe_other(0);
    config.axes[0].sim.no_stops = true;
    open_segment();
    ck_assert(cm1e_sdo_write(bus, 1, OBJ_605A_QUICK_STOP_OPTION, 0, &options[_i], 2, &diag) == CM1E_OK);
    enable();
    command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 300});
    cycles(12000); /* longer than a quick stop may take */
    const double speed = probe().velocity_counts_per_s;
    ck_assert_double_gt(speed, 25 * COUNTS);
    cm1e_sim_cia402_of(cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1))->state = QUICK_STOP_ACTIVE;
    int braking = 0;
    for (int n = 0; n < 1000; n++) {
        cycles(1);
        const cm1e_sim_probe_t now = probe();
        braking += now.torque_on;
        ck_assert_msg(now.torque_on || fabs(now.velocity_counts_per_s) < 0.03 * speed, "torque off at %.0f counts/s",
                      now.velocity_counts_per_s);
    }
    ck_assert_int_gt(braking, 100);
    ck_assert(!probe().torque_on);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    ck_assert_int_eq(info().error, CM1E_ERROR_DRIVE_ENABLE_LOST);
    ck_assert_ptr_nonnull(strstr(text(), "quick stop by itself"));
    const double from = shaft();
    reset_axis();
    enable();
    cycles(200);
    ck_assert_double_eq_tol(shaft(), from, 0.01);
    move_to(info().actual_position - 10, 50);
    ck_assert_double_eq_tol(shaft(), from - 10, 0.02);
    close_segment();
}
END_TEST

/** At 30 revolutions a second the drive begins a quick stop by itself, and will stay in it. */
static void begin_quick_stop(void)
{
    const int16_t stays = 6;
    describe_other(0);
    config.axes[0].sim.no_stops = true;
    open_segment();
    ck_assert(cm1e_sdo_write(bus, 1, OBJ_605A_QUICK_STOP_OPTION, 0, &stays, 2, &diag) == CM1E_OK);
    enable();
    command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 300});
    cycles(600);
    cm1e_sim_cia402_of(cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1))->state = QUICK_STOP_ACTIVE;
    cycles(5);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
}

START_TEST(an_axis_that_is_enabled_again_within_a_quick_stop_of_its_drive_waits_for_its_end)
{
    begin_quick_stop();
    reset_axis();
    double slowest = INFINITY;
    bool off = false;
    for (int n = 0; n < 1000 && info().state != CM1E_AXIS_STANDSTILL; n++) {
        power(true);
        cycles(1);
        slowest = fmin(slowest, fabs(probe().velocity_counts_per_s));
        off |= !probe().torque_on;
        ck_assert_msg(!off || slowest < COUNTS, "torque off at %.0f counts/s", slowest);
    }
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    ck_assert(off && probe().torque_on);
    close_segment();
}
END_TEST

START_TEST(the_end_of_a_run_waits_for_the_quick_stop_of_a_drive)
{
    begin_quick_stop();
    int n = 0;
    while (!cm1e_axis_shut_down(axis) && ++n < 2000)
        cycles(1);
    ck_assert_int_lt(n, 2000);
    ck_assert(!probe().torque_on);
    ck_assert_double_lt(fabs(probe().velocity_counts_per_s), COUNTS);
    close_segment();
}
END_TEST

START_TEST(a_cause_that_stays_is_there_after_the_reset)
{
    begin(0);
    simulate("error 1 7305 hold");
    cycles(50);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    cm1e_axis_reset(axis);
    cycles(4000);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    simulate("error 1 clear");
    reset_axis();
    enable();
    close_segment();
}
END_TEST

/* The motor power goes at every n-th cycle of power-on, a move, a homing and a stop. */
START_TEST(wherever_the_power_goes_the_axis_ends_in_a_known_state)
{
    for (int moment = _i; moment < 2600; moment += 97) {
        describe_other(0);
        config.axes[0].homing.method = 22;
        open_segment();
        power(true);
        for (int n = 0; n < 2700; n++) {
            if (n == 200)
                cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 20,
                                                             .velocity = 50}, &(cm1e_command_id_t){0});
            if (n == 900)
                cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME}, &(cm1e_command_id_t){0});
            if (n == moment)
                simulate("power 1 off");
            cycles(1);
        }
        const cm1e_axis_state_t state = info().state;
        ck_assert_msg(!probe().torque_on, "moment %d", moment);
        ck_assert_msg(state == CM1E_AXIS_ERROR_STOP || state == CM1E_AXIS_DISABLED, "moment %d: %s", moment,
                      cm1e_axis_state_name(state));
        simulate("power 1 on");
        cycles(50);
        if (state == CM1E_AXIS_ERROR_STOP)
            reset_axis();
        enable();
        const double from = info().actual_position;
        move_to(from + 5, 50);
        close_segment();
    }
}
END_TEST

/* ---- touch probes ------------------------------------------------------------------------------------------------ */

static uint32_t arm(int input, bool falling)
{
    uint32_t id;
    const cm1e_axis_trigger_t trigger = {.input = input, .falling = falling};
    ck_assert_int_eq(cm1e_axis_probe(axis, trigger, false, 0, 0, &id), CM1E_OK);
    return id;
}

/* Object 0x60B9 of the drive. */
static unsigned probe_status(void)
{
    uint8_t data[2] = {0};
    cm1e_sdo_t sdo = {.position = 1, .index = OBJ_60B9_TOUCH_PROBE_STATUS, .data = data, .size = sizeof data};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    for (int i = 0; i < 100 && cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY; i++)
        cycles(1);
    ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
    return data[0] | (unsigned)data[1] << 8;
}

/* Bits 0, 1 and 2 of 0x60B9 are of touch probe 1, bits 8, 9 and 10 of touch probe 2. A "stored" bit goes with its
 * sampling bit in 0x60B8, which the driver takes away when it has the position. */
START_TEST(the_status_of_touch_probes_has_the_bits_of_the_standard)
{
    begin(0);
    ck_assert_uint_eq(probe_status(), 0);
    arm(1, false);
    arm(1, true);
    arm(2, false);
    cycles(10);
    ck_assert_uint_eq(probe_status(), 0x0101);
    move_to(-EDGE_COUNTS / 50000.0 * 10 - 5, 200);
    ck_assert_uint_eq(probe_status(), 0x0101); /* the rising edge was stored, and is taken */
    move_to(0, 200);
    ck_assert_uint_eq(probe_status(), 0x0100); /* nothing more is wanted of probe 1 */
    close_segment();
}
END_TEST

/* Probe 1 is at the home switch (-150,000), probe 2 at the positive limit switch (+150,000); the drive latches. */
START_TEST(touch_probes_of_the_drive_know_the_edge_to_the_count)
{
    begin(0);
    const double negative = -EDGE_COUNTS / 50000.0 * 10, positive = -negative;
    const uint32_t on1 = arm(1, false), off1 = arm(1, true), on2 = arm(2, false);
    move_to(negative - 5, 200);
    cm1e_probe_status_t status = cm1e_axis_probe_status(axis, on1);
    ck_assert_int_eq(status.state, CM1E_COMMAND_DONE);
    ck_assert_double_eq_tol(status.position, negative, 10.0 / COUNTS);
    ck_assert_double_le(status.uncertainty, 10.0 / COUNTS);
    ck_assert_int_eq(cm1e_axis_probe_status(axis, off1).state, CM1E_COMMAND_ACTIVE);
    move_to(positive + 5, 300);
    status = cm1e_axis_probe_status(axis, off1);
    ck_assert_int_eq(status.state, CM1E_COMMAND_DONE);
    ck_assert_double_eq_tol(status.position, negative, 10.0 / COUNTS);
    status = cm1e_axis_probe_status(axis, on2);
    ck_assert_int_eq(status.state, CM1E_COMMAND_DONE);
    ck_assert_double_eq_tol(status.position, positive, 10.0 / COUNTS);
    close_segment();
}
END_TEST

static uint16_t probe_function(void) { return axis->drive.foreign->probe_function; }

/* 0x60B8 wants the edges that are waited for, and no others. For another edge the enable bit goes off until the drive
 * shows that: the edges that it has stored until then are old. */
START_TEST(a_touch_probe_is_enabled_anew_for_each_edge)
{
    begin(0);
    arm(1, true);
    cycles(10);
    ck_assert_uint_eq(probe_function(), CM1E_PROBE_ENABLE | CM1E_PROBE_NEGATIVE);
    arm(1, false);
    cycles(1);
    ck_assert_uint_eq(probe_function(), 0);
    cycles(10);
    ck_assert_uint_eq(probe_function(), CM1E_PROBE_ENABLE | CM1E_PROBE_NEGATIVE | CM1E_PROBE_POSITIVE);
    uint32_t id = arm(1, false);
    const cm1e_command_id_t move = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = -40,
                                                                  .velocity = 200});
    while (cm1e_axis_probe_status(axis, id).state == CM1E_COMMAND_ACTIVE)
        cycles(1);
    ck_assert_int_eq(cm1e_axis_probe_status(axis, id).state, CM1E_COMMAND_DONE);
    id = arm(1, false); /* the drive still shows the edge before */
    await(move, 10);
    ck_assert_int_eq(cm1e_axis_probe_status(axis, id).state, CM1E_COMMAND_ACTIVE);
    close_segment();
}
END_TEST

START_TEST(an_edge_outside_the_window_is_waited_out_and_one_without_a_latch_is_sampled)
{
    begin(0);
    uint32_t id;
    const cm1e_axis_trigger_t trigger = {.input = 1};
    ck_assert_int_eq(cm1e_axis_probe(axis, trigger, true, 0, 10, &id), CM1E_OK);
    move_to(-40, 200);
    move_to(0, 200);
    ck_assert_int_eq(cm1e_axis_probe_status(axis, id).state, CM1E_COMMAND_ACTIVE);
    arm(2, false);
    cycles(10);
    ck_assert_uint_eq(probe_status(), 0x0101);
    ck_assert_int_eq(cm1e_axis_probe_abort(axis, trigger), CM1E_OK);
    ck_assert_int_eq(cm1e_axis_probe_status(axis, id).state, CM1E_COMMAND_ABORTED);
    cycles(10);
    ck_assert_uint_eq(probe_status(), 0x0100); /* the other probe goes on */
    ck_assert_int_eq(cm1e_axis_probe_abort(axis, (cm1e_axis_trigger_t){.input = 2}), CM1E_OK);
    cycles(10);
    ck_assert_uint_eq(probe_status(), 0);
    /* 0x60BD is not mapped: the falling edge of input 2 is seen in 0x60FD. */
    move_to(35, 200);
    id = arm(2, true);
    move_to(20, 100);
    const cm1e_probe_status_t status = cm1e_axis_probe_status(axis, id);
    ck_assert_int_eq(status.state, CM1E_COMMAND_DONE);
    ck_assert_double_eq_tol(status.position, 30, 0.2);
    ck_assert_double_gt(status.uncertainty, 0.01);
    close_segment();
}
END_TEST

/* ---- signals ----------------------------------------------------------------------------------------------------- */

START_TEST(outputs_are_the_makers_and_not_the_brake)
{
    begin(0);
    bool value;
    ck_assert_int_eq(cm1e_axis_read_input(axis, 2, &value), CM1E_OK);
    ck_assert(!value);
    simulate("sensor 1 2 on");
    cycles(3);
    ck_assert_int_eq(cm1e_axis_read_input(axis, 2, &value), CM1E_OK);
    ck_assert(value);
    uint32_t outputs;
    size_t size = sizeof outputs;
    ck_assert(cm1e_sdo_read(bus, 1, OBJ_60FE_DIGITAL_OUTPUTS, 2, &outputs, &size, &diag) == CM1E_OK);
    ck_assert_uint_eq(outputs, 0x000F0000);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("axis_cia402");
    TCase *tests = tcase_create("cia402");
    tcase_set_timeout(tests, 0);
    tcase_add_loop_test(tests, it_starts_with_its_own_process_data_or_those_of_the_bus_file, 0, 4);
    tcase_add_loop_test(tests, every_cycle_time_is_told_to_the_drive, 0, 6);
    tcase_add_test(tests, what_cannot_work_is_said);
    tcase_add_test(tests, no_file_is_made_of_a_drive_of_another_maker);
    tcase_add_loop_test(tests, moves_end_at_their_target_in_csp_and_csv, 0, 4);
    tcase_add_test(tests, the_drive_makes_motions_itself_in_pp_and_pv);
    tcase_add_loop_test(tests, homing_finds_the_place_and_reckons_the_offset, 0, sizeof homings / sizeof homings[0]);
    tcase_add_test(tests, a_method_that_the_drive_lacks_fails_and_a_stop_ends_a_homing);
    tcase_add_loop_test(tests, a_fault_in_a_move_ends_it_and_a_reset_clears_it, 0, 4);
    tcase_add_loop_test(tests, a_quick_stop_of_the_drive_itself_ends_its_ramp_and_then_has_no_torque, 0, 2);
    tcase_add_test(tests, an_axis_that_is_enabled_again_within_a_quick_stop_of_its_drive_waits_for_its_end);
    tcase_add_test(tests, the_end_of_a_run_waits_for_the_quick_stop_of_a_drive);
    tcase_add_test(tests, a_cause_that_stays_is_there_after_the_reset);
    tcase_add_loop_test(tests, wherever_the_power_goes_the_axis_ends_in_a_known_state, 0, 4);
    tcase_add_test(tests, the_status_of_touch_probes_has_the_bits_of_the_standard);
    tcase_add_test(tests, touch_probes_of_the_drive_know_the_edge_to_the_count);
    tcase_add_test(tests, a_touch_probe_is_enabled_anew_for_each_edge);
    tcase_add_test(tests, an_edge_outside_the_window_is_waited_out_and_one_without_a_latch_is_sampled);
    tcase_add_test(tests, outputs_are_the_makers_and_not_the_brake);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_set_fork_status(runner, CK_NOFORK);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
