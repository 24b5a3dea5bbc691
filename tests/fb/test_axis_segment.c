/*
 * The axis on the simulated segment, through the real bus and the real frames, on virtual time: enabling, homing by
 * every method, moves, random commands, on every mapping, both orders of objects, every firmware and cycle time.
 */
#include "axis_segment.h"
#include "../support/xorshift.h"

/* ---- the variants ------------------------------------------------------------------------------------------------ */

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
enum { FIRMWARES = 6, MAPPINGS = 4, ORDERS = 2, VARIANTS = FIRMWARES * MAPPINGS * ORDERS };

static void describe_variant(int variant)
{
    describe(firmwares[variant % FIRMWARES], (cm1e_mapping_t)(variant / FIRMWARES % MAPPINGS),
             (cm1e_pdo_order_t)(variant / FIRMWARES / MAPPINGS), 1000000);
}

/* Enable, stand, move, home, move, disable: the motor does what it was told and nothing else. */
START_TEST(test_every_mapping_order_and_firmware)
{
    describe_variant(_i);
    config.axes[0].homing = (cm1e_homing_config_t){.method = -3, .velocity = 2.0, .acceleration = 40.0};
    open_segment();
    cycles(20);
    cm1e_sim_probe_reset(cm1e_bus_segment(bus), 1);
    enable();
    cycles(200);
    ck_assert_msg(probe().travel_counts < 20.0, "moved %.1f counts when enabled", probe().travel_counts);
    ck_assert(probe().torque_on);
    move_to(1.0, 5.0);
    cycles(200);
    ck_assert_double_eq_tol(probe().position_counts, 50000.0, 60.0);
    await(command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .position = 7.0}), 30.0);
    ck_assert(info().homed);
    cycles(200);
    ck_assert_double_eq_tol(info().actual_position, 7.0, 0.01);
    ck_assert_double_eq_tol(probe().position_counts, 150000.0, 100.0); /* IN2 switches there */
    move_to(6.0, 5.0);
    cycles(200);
    ck_assert_double_eq_tol(probe().position_counts, 100000.0, 100.0);
    ck_assert_msg(info().error == CM1E_OK, "%s", text());
    power(false);
    cycles(50);
    ck_assert(!probe().torque_on);
    ck_assert_int_eq(info().state, CM1E_AXIS_DISABLED);
    close_segment();
}
END_TEST

static const int64_t cycle_times_ns[] = {200000, 250000, 500000, 1000000};

START_TEST(test_every_cycle_time)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, cycle_times_ns[_i]);
    open_segment();
    enable();
    move_to(2.0, 10.0);
    cycles(cycles_of(0.2));
    ck_assert_double_eq_tol(probe().position_counts, 100000.0, 60.0);
    move_to(-2.0, 30.0);
    cycles(cycles_of(0.2));
    ck_assert_double_eq_tol(probe().position_counts, -100000.0, 60.0);
    ck_assert_double_le(probe().peak_velocity_counts_per_s, 30.0 * 50000.0 * 1.1);
    close_segment();
}
END_TEST

/* Method, side and sensor of UG 6.2.4, with offset, inverted or not. The sim's stops and sensors: config.h. */
static const struct {
    int8_t method;
    double reference; /* counts of the shaft, before the offset */
    double tolerance; /* a hard stop is left by two teeth (UG 6.2.4) */
} methods[] = {
    {-1, 250000, 4000}, {-2, -250000, 4000}, {-3, 150000, 30}, {-4, 150000, 30}, {-5, -150000, 30}, {-6, -150000, 30},
};

START_TEST(test_every_homing_method)
{
    const int method = _i / 4;
    const bool invert = _i & 1, offset = _i & 2;
    describe(_i % 5 ? "1.3.5" : "1.2.0", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_7_2, 1000000);
    config.axes[0].invert = invert;
    config.axes[0].counts_per_unit = 1000.0;
    /* Method -4 looks for IN2 while it runs CCW, so it has to be beyond it; -5 the other way round. */
    if (methods[method].method == -4)
        config.axes[0].sim.sensor_input2 = -120000;
    if (methods[method].method == -5)
        config.axes[0].sim.sensor_input3 = 120000;
    const double moved[] = {[3] = -120000, [4] = 120000, [5] = 0};
    const double reference = method == 3 || method == 4 ? moved[method] : methods[method].reference;
    open_segment();
    enable();
    const double sign = methods[method].reference > 0 ? -1.0 : 1.0; /* away from the stop */
    const double offset_counts = offset ? sign * 20000.0 : 0.0;
    const cm1e_homing_config_t homing = {.method = methods[method].method, .velocity = 100.0, .acceleration = 2000.0,
                                         .offset = offset_counts / (invert ? -1000.0 : 1000.0), .torque = 40.0};
    for (int round = 0; round < 2; round++) { /* the second one begins at the reference */
        await(command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .position = 33.0, .homing = &homing}), 60.0);
        cycles(200);
        ck_assert_double_eq_tol(info().actual_position, 33.0, 0.05);
        ck_assert_double_eq_tol(info().set_position, info().actual_position, 0.05);
        ck_assert_msg(fabs(probe().position_counts - reference - offset_counts) < methods[method].tolerance,
                      "method %d: the shaft is at %.0f", homing.method, probe().position_counts);
        ck_assert_double_lt(fabs(probe().velocity_counts_per_s), 500.0);
    }
    const double there = probe().position_counts;
    move_to(33.0 + (invert ? -sign : sign) * 10.0, 50.0);
    cycles(200);
    ck_assert_double_eq_tol(probe().position_counts, there + sign * 10000.0, 100.0);
    close_segment();
}
END_TEST

START_TEST(test_stop_and_power_off_in_the_middle_of_homing)
{
    for (int cycle = 0; cycle < 1500; cycle += 37)
        for (int power_off = 0; power_off < 2; power_off++) {
            describe(cycle % 2 ? "1.3.5" : "1.2.0", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
            open_segment();
            enable();
            const cm1e_homing_config_t homing = {.method = -2, .velocity = 4.0, .acceleration = 80.0};
            const cm1e_command_id_t home = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME,
                                                                          .homing = &homing});
            cycles(cycle);
            const bool done = cm1e_axis_command_status(axis, home).state == CM1E_COMMAND_DONE;
            const double at = probe().position_counts;
            if (power_off) {
                power(false);
                cycles(1500);
                ck_assert(!probe().torque_on);
                ck_assert_int_eq(info().state, CM1E_AXIS_DISABLED);
            } else {
                const cm1e_command_id_t stop = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
                await(stop, 3.0);
                ck_assert_int_eq(info().state, CM1E_AXIS_STOPPING);
                cm1e_axis_hold_stop(axis, stop, false);
                cycles(2);
                ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
            }
            ck_assert_msg(info().error == CM1E_OK, "%s", text());
            /* 200,000 counts/s at 4,000,000 counts/s2: 5,000 counts, and a few cycles */
            ck_assert_msg(fabs(probe().position_counts - at) < 7500.0, "cycle %d: ran on for %.0f counts", cycle,
                          probe().position_counts - at);
            enable();
            const double position = info().set_position;
            move_to(position + 0.5, 5.0);
            close_segment();
            if (done)
                return;
        }
}
END_TEST

START_TEST(test_homing_on_a_stop_that_is_not_there_times_out)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].sim.no_stops = true;
    open_segment();
    enable();
    const cm1e_homing_config_t homing = {.method = -1, .velocity = 4.0, .acceleration = 80.0, .timeout_s = 2.0};
    const cm1e_command_id_t id = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .homing = &homing});
    cycles(2500);
    ck_assert_int_eq(cm1e_axis_command_status(axis, id).error, CM1E_ERROR_AXIS_HOMING_TIMEOUT);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    ck_assert_msg(strstr(text(), "hard stop"), "%s", text());
    cycles(500);
    ck_assert(!probe().torque_on);
    cm1e_axis_reset(axis);
    cycles(100);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    close_segment();
}
END_TEST

START_TEST(test_every_fault_code_reset_and_on)
{
    describe("1.3.3", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    open_segment();
    for (size_t i = 0; i < cm1e_device_error_count; i++) {
        const cm1e_device_error_t *error = &cm1e_device_errors[i];
        if (!error->fault || error->code == 0xFF05)
            continue;
        enable();
        const cm1e_command_id_t id = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY,
                                                                    .velocity = i % 2 ? 2.0 : -2.0});
        cycles(300);
        char line[32];
        snprintf(line, sizeof line, "error 1 0x%04X", error->code);
        simulate(line);
        cycles(10);
        ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
        ck_assert_int_eq(info().device_error, error->code);
        ck_assert_int_eq(cm1e_axis_command_status(axis, id).state, CM1E_COMMAND_ERROR);
        ck_assert_msg(strstr(text(), error->text), "%s", text());
        cycles(500);
        ck_assert(!probe().torque_on);
        const double at = probe().position_counts;
        cm1e_axis_reset(axis);
        cycles(300);
        ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "0x%04X: %s", error->code, text());
        ck_assert_double_eq_tol(probe().position_counts, at, 30.0);
    }
    close_segment();
}
END_TEST

/* From V1.3.5 on clearing a power-up 0x7510 restarts the device: it leaves the bus and comes back (UG 10.1). */
START_TEST(test_power_up_fault_is_cleared_by_one_restart)
{
    for (int again = 0; again < 2; again++) { /* the fault comes back after the restart, too */
        describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
        open_segment();
        enable();
        simulate(again ? "power-up-fault 1 always" : "power-up-fault 1 1");
        simulate("power-cycle 1 300");
        cycles(1000);
        ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
        cm1e_error_t error = CM1E_OK;
        int resets = 0;
        while (info().state != CM1E_AXIS_STANDSTILL && resets++ < 2) { /* one brings the slave back, one the motor */
            cm1e_axis_reset(axis);
            for (int i = 0; i < 25000 && cm1e_axis_reset_state(axis, &error) == CM1E_COMMAND_ACTIVE; i++)
                cycles(1);
            ck_assert_int_ne(cm1e_axis_reset_state(axis, NULL), CM1E_COMMAND_ACTIVE);
            cycles(100);
        }
        if (again) {
            ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
            ck_assert_msg(info().device_error == 0x7510, "%s", text());
            ck_assert(!probe().torque_on);
        } else {
            ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "%s", text());
        }
        close_segment();
    }
}
END_TEST

/* Somebody turns the shaft, ever faster, while the axis is enabled: it is caught where it is, not pulled back. */
START_TEST(test_enable_while_the_shaft_is_turned)
{
    describe("1.3.5", (cm1e_mapping_t)(_i % 2), (cm1e_pdo_order_t)(_i / 2 % 2), 1000000);
    config.axes[0].sim.no_stops = true;
    open_segment();
    simulate(_i & 4 ? "load 1 0.02" : "load 1 -0.02");
    cycles(20 + 5 * _i);
    power(true);
    double speed = 0.0, caught = 0.0, back = 0.0;
    const double sign = _i & 4 ? 1.0 : -1.0;
    for (int i = 0; i < 600; i++) {
        cycles(1);
        const cm1e_sim_probe_t p = probe();
        if (!p.torque_on) {
            speed = p.velocity_counts_per_s * sign;
            caught = p.position_counts * sign;
        } else {
            back = fmin(back, p.position_counts * sign - caught);
        }
    }
    ck_assert_double_gt(speed, 10000.0);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    ck_assert_msg(back > -speed * 0.006 - 20.0, "pulled back by %.0f counts from %.0f counts/s", -back, speed);
    ck_assert_msg(info().error == CM1E_OK, "%s", text());
    close_segment();
}
END_TEST

START_TEST(test_overloaded_axis_says_that_it_does_not_follow)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    config.axes[0].max_position_lag = 0.05;
    open_segment();
    enable();
    command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 2.0});
    cycles(300);
    simulate("load 1 -5");
    cycles(200);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    ck_assert(info().error == CM1E_ERROR_AXIS_LAG || info().error == CM1E_ERROR_DRIVE_FAULT);
    ck_assert_msg(strlen(text()) > 40, "%s", text());
    cycles(500);
    ck_assert(!probe().torque_on);
    close_segment();
}
END_TEST

START_TEST(test_motor_power_lost_and_back)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    open_segment();
    enable();
    command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 3.0});
    cycles(300);
    simulate("power 1 off");
    cycles(20);
    ck_assert_int_eq(info().error, CM1E_ERROR_DRIVE_POWER);
    cycles(500);
    cm1e_axis_reset(axis); /* with the power still off */
    cycles(5000);
    ck_assert_int_ne(info().state, CM1E_AXIS_STANDSTILL);
    simulate("power 1 on");
    cycles(100);
    ck_assert(!probe().torque_on || info().state == CM1E_AXIS_STANDSTILL);
    const double at = probe().position_counts;
    cm1e_axis_reset(axis);
    cycles(300);
    ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "%s", text());
    ck_assert_double_eq_tol(probe().position_counts, at, 30.0);
    close_segment();
}
END_TEST

START_TEST(test_slave_unplugged_and_back_is_brought_to_operational_by_reset)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    open_segment();
    enable();
    command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 3.0});
    cycles(300);
    simulate("unplug 1");
    cycles(1000);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    ck_assert_msg(strlen(text()) > 30, "%s", text());
    ck_assert(!probe().torque_on);
    simulate("replug 1");
    cycles(500);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    const double at = probe().position_counts;
    cm1e_axis_reset(axis);
    for (int i = 0; i < 12000 && info().state != CM1E_AXIS_STANDSTILL; i++)
        cycles(1);
    ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "%s", text());
    ck_assert_double_eq_tol(probe().position_counts, at, 30.0);
    move_to(info().set_position + 0.2, 2.0);
    close_segment();
}
END_TEST

/* The error of an axis whose own slave is well names the one that is missing: without power, unplugged, or in Init. */
START_TEST(test_error_of_an_axis_names_the_slave_that_takes_no_part)
{
    static const char *const ways[] = {"power-cycle 2 60000", "unplug 2", "power-cycle 2 5"};
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    describe_up_to(3);
    open_segment();
    enable();
    simulate(ways[_i]);
    cycles(100);
    ck_assert_int_eq(info().state, CM1E_AXIS_ERROR_STOP);
    const bool both = _i == 1; /* the last slave is behind the cable */
    ck_assert_msg(strstr(text(), "It is slave 2 (") || (both && strstr(text(), "It is slave 3 (")), "%s", text());
    ck_assert_ptr_null(strstr(text(), "This slave does not answer"));
    close_segment();
}
END_TEST

/* The frames come back some cycles before the supervision sees that the slave has left Operational meanwhile. A reset that
 * ended then was followed by another error. */
START_TEST(test_reset_around_the_moment_of_the_cable_ends_when_the_slave_is_operational)
{
    const int out[] = {60, 110, 150, 300, 1000};
    for (int after = -20; after <= 6; after += after < -6 ? 7 : 1) { /* cycles from the cable to the reset */
        describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
        describe_up_to(2);
        open_segment();
        enable();
        command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = 3.0});
        cycles(300);
        simulate("unplug 1");
        cycles(out[_i] + (after < 0 ? after : 0));
        if (after < 0) {
            cm1e_axis_reset(axis);
            cycles(-after);
        }
        simulate("replug 1");
        cycles(after < 0 ? 0 : after);
        if (after >= 0)
            cm1e_axis_reset(axis);
        for (int n = 0; n < 12000 && cm1e_axis_reset_state(axis, NULL) == CM1E_COMMAND_ACTIVE; n++)
            cycles(1);
        for (int n = 0; n < 300; n++) {
            ck_assert_msg(info().state != CM1E_AXIS_ERROR_STOP, "out for %d, reset after %d: %s", out[_i], after, text());
            cycles(1);
        }
        ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "out for %d, reset after %d", out[_i], after);
        close_segment();
    }
}
END_TEST

/* Nobody used the axis when its slave lost its power, so there is no error to be reset. Yet the slave keeps the working
 * counter of the whole bus wrong until it is brought back, and it answers to its address only then. */
START_TEST(test_reset_brings_back_the_slave_of_an_axis_that_was_disabled)
{
    const int when[] = {20, 100, 900}; /* ms after the slave has its power again */
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    open_segment();
    cycles(50);
    simulate("power-cycle 1 200");
    cycles(200 + when[_i]);
    ck_assert_int_eq(info().state, CM1E_AXIS_DISABLED);
    ck_assert(!info().online);
    cm1e_axis_reset(axis);
    ck_assert_int_eq(cm1e_axis_reset_state(axis, NULL), CM1E_COMMAND_ACTIVE);
    for (int i = 0; i < 12000 && cm1e_axis_reset_state(axis, NULL) == CM1E_COMMAND_ACTIVE; i++)
        cycles(1);
    ck_assert_int_eq(cm1e_axis_reset_state(axis, NULL), CM1E_COMMAND_DONE);
    ck_assert(info().online);
    ck_assert(!probe().torque_on);
    enable();
    move_to(0.2, 2.0);
    close_segment();
}
END_TEST

/* ---- random commands --------------------------------------------------------------------------------------------- */

static uint64_t seed;
static double uniform(double low, double high)
{
    return xorshift_between(&seed, low, high);
}

static void random_command(void)
{
    cm1e_axis_command_t c = {.kind = (cm1e_command_kind_t)(int)uniform(0, CM1E_COMMAND_HOME)};
    c.position = uniform(-4.0, 4.0);
    c.velocity = uniform(0.1, 20.0) * (c.kind == CM1E_COMMAND_MOVE_VELOCITY && uniform(0, 1) < 0.5 ? -1 : 1);
    c.acceleration = uniform(0, 1) < 0.3 ? 0 : uniform(1.0, 60.0);
    c.deceleration = uniform(0, 1) < 0.3 ? 0 : uniform(1.0, 60.0);
    c.jerk = uniform(0, 1) < 0.3 ? 0 : uniform(50.0, 2000.0);
    cm1e_command_id_t id;
    if (cm1e_axis_start(axis, &c, &id) == CM1E_OK && c.kind == CM1E_COMMAND_STOP)
        cm1e_axis_hold_stop(axis, id, false);
}

START_TEST(test_random_commands_move_the_motor_as_the_set_point_says)
{
    seed = UINT64_C(0x2545F4914F6CDD1D) * (uint64_t)(_i + 1);
    printf("seed %d\n", _i + 1);
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, (cm1e_pdo_order_t)(_i % 2), _i % 3 ? 1000000 : 500000);
    config.axes[0].max_acceleration = 60.0;
    config.axes[0].software_limit_negative = -4.5;
    config.axes[0].software_limit_positive = 4.5;
    open_segment();
    enable();
    double before = info().set_position, speed_before = 0.0;
    const double cycle_s = (double)config.cycle_time_ns * 1e-9;
    for (int cycle = 0; cycle < 15000; cycle++) {
        inputs();
        if (uniform(0, 1) < 0.004)
            random_command();
        if (uniform(0, 1) < 0.0004)
            power(false);
        if (uniform(0, 1) < 0.01)
            power(true);
        if (uniform(0, 1) < 0.01)
            cm1e_axis_reset(axis);
        outputs();
        const cm1e_axis_info_t now = info();
        ck_assert_msg(now.error == CM1E_OK || now.error == CM1E_ERROR_AXIS_POSITION_RANGE, "%s", text());
        const double speed = (now.set_position - before) / cycle_s;
        if (now.powered) {
            ck_assert_double_lt(fabs(speed), 50.0);
            ck_assert_double_lt(fabs(speed - speed_before), 60.0 * cycle_s * 1.01 + 0.03);
            ck_assert_double_lt(fabs(now.set_position), 4.5 + 0.002);
            ck_assert_double_lt(fabs(now.position_lag), 0.4);
            ck_assert_double_lt(fabs(probe().position_counts - now.set_position * 50000.0), 20000.0);
        }
        before = now.set_position;
        speed_before = now.powered ? speed : 0.0;
    }
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("axis on the segment");
    TCase *cases = tcase_create("axis");
    tcase_set_timeout(cases, 120);
    tcase_add_loop_test(cases, test_every_mapping_order_and_firmware, 0, VARIANTS);
    tcase_add_loop_test(cases, test_every_cycle_time, 0, 4);
    tcase_add_loop_test(cases, test_every_homing_method, 0, 24);
    tcase_add_test(cases, test_stop_and_power_off_in_the_middle_of_homing);
    tcase_add_test(cases, test_homing_on_a_stop_that_is_not_there_times_out);
    tcase_add_test(cases, test_every_fault_code_reset_and_on);
    tcase_add_test(cases, test_power_up_fault_is_cleared_by_one_restart);
    tcase_add_loop_test(cases, test_enable_while_the_shaft_is_turned, 0, 8);
    tcase_add_test(cases, test_overloaded_axis_says_that_it_does_not_follow);
    tcase_add_test(cases, test_motor_power_lost_and_back);
    tcase_add_test(cases, test_slave_unplugged_and_back_is_brought_to_operational_by_reset);
    tcase_add_loop_test(cases, test_error_of_an_axis_names_the_slave_that_takes_no_part, 0, 3);
    tcase_add_loop_test(cases, test_reset_around_the_moment_of_the_cable_ends_when_the_slave_is_operational, 0, 5);
    tcase_add_loop_test(cases, test_reset_brings_back_the_slave_of_an_axis_that_was_disabled, 0, 3);
    tcase_add_loop_test(cases, test_random_commands_move_the_motor_as_the_set_point_says, 0, 12);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
