/**
 * The flow charts of appendix 4 of the bridge's guide, homing, on every motor of a bridge through the axis: each branch
 * of each chart is taken. What counts is what was on the wire: mode hm confirmed, the objects written, 100 ms, 0Fh,
 * 1Fh until bits 13 and 12 tell the end, 0Fh.
 */
#include "bridge_wire.h"

#include "axis_segment.h"
#undef axis /* there are four */

enum { DRIVES = CM1E_BRIDGE_AXES, ENABLED_WORD = 0x000F, START_WORD = 0x001F, SETTING_NS = 100000000 };
enum { REACHED = 0x0400, ATTAINED = 0x1000, HOMING_ERROR = 0x2000 };
enum { METHODS = 4, SPEED = 8 /* revolutions/s */ };

typedef enum way { COMPLETE, FAILED, ERROR_BIT, NO_ERROR_BIT, ATTAINED_BIT, NOT_ATTAINED } way_t;

static branch_t branches[] = {
    [COMPLETE] = {"4.1", "monitor homing progress", "completed: bit 4 = 0, homing complete", 0},
    [FAILED] = {"4.1", "monitor homing progress", "homing error", 0},
    [ERROR_BIT] = {"4.2", "bit 13 (he) = 1", "yes: proceeding homing error", 0},
    [NO_ERROR_BIT] = {"4.2", "bit 13 (he) = 1", "no", 0},
    [ATTAINED_BIT] = {"4.2", "bit 12 (ha) = 1", "yes: monitoring complete", 0},
    [NOT_ATTAINED] = {"4.2", "bit 12 (ha) = 1", "no: wait 5 ms, look again", 0},
};

/* ---- steps ------------------------------------------------------------------------------------------------------- */

static int owners[DRIVES];
static int victim;
static uint16_t forged_bits;

static void forge_bits(unsigned n, uint8_t *inputs)
{
    if ((int)n == victim)
        cm1e_put_u16(inputs, cm1e_get_u16(inputs) | forged_bits);
}

static cm1e_sim_bridge_axis_t *motor(int n)
{
    return &cm1e_sim_bridge_of(cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1))->axes[n];
}

static void open_axes(void)
{
    static const char *const motors[DRIVES] = {"CM1", "CM1", "CM2", "CM2"};
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", DRIVES);
    config.virtual_time = true;
    config.cycle_time_ns = 1000000;
    for (int n = 0; n < DRIVES; n++) {
        cm1e_axis_config_t *c = &config.axes[n];
        c->address = 1;
        c->channel = (uint8_t)(n + 1);
        c->k37 = 10;
        c->k37_stated = true;
        c->counts_per_unit = 50000;
        snprintf(c->motor, sizeof c->motor, "%s", motors[n]);
    }
    wire_forget();
    victim = -1;
    open_segment();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), wire_tap, NULL);
}

static void close_axes(void)
{
    for (int n = 0; n < DRIVES; n++)
        ck_assert_msg(motor(n)->broken_rules == 0, "ID%d: rules of the guide are broken: 0x%03X", n + 1,
                      motor(n)->broken_rules);
    close_segment();
}

static void enable_axis(int n)
{
    ck_assert_int_eq(cm1e_axis_power(axes[n], &owners[n], true, true, true), CM1E_OK);
    for (int i = 0; i < 3000 && info_of(n).state == CM1E_AXIS_DISABLED; i++)
        cycles(1);
    ck_assert_msg(info_of(n).state == CM1E_AXIS_STANDSTILL, "ID%d: %s", n + 1, text_of(n));
}

static cm1e_command_id_t home(int n, int method)
{
    cm1e_command_id_t id;
    const cm1e_homing_config_t homing = {.method = (int8_t)method, .velocity = SPEED, .acceleration = 90, .torque = 40};
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_HOME, .position = 2.5, .homing = &homing};
    const cm1e_error_t error = cm1e_axis_start(axes[n], &c, &id);
    ck_assert_msg(error == CM1E_OK, "ID%d: %s %s", n + 1, cm1e_strerror(error), text_of(n));
    return id;
}

static uint16_t on_wire(int n, uint16_t index) { return (uint16_t)(index + n * CM1E_BRIDGE_INDEX_INCREMENT); }

/** 0x6099: "speed during search for switch" is sub-index 1, "for stopper" 2; in 100 pulses/s. The other one keeps what
 *  it is. */
static void check_speed(int n, int method)
{
    int seen = 0;
    for (int i = 0; i < bridge_wire.sdo_count; i++) {
        const sdo_seen_t *sdo = &bridge_wire.sdos[i];
        if (!sdo->write || sdo->index != on_wire(n, 0x6099))
            continue;
        seen++;
        ck_assert_msg(sdo->subindex == (method <= 2 ? 2 : 1), "ID%d, method %d: %04Xh:%d is written", n + 1, method,
                      sdo->index, sdo->subindex);
        ck_assert_uint_eq(sdo->size, 4);
        ck_assert_uint_eq(cm1e_get_u32((const uint8_t *)sdo->data), SPEED * 50000 / 100);
    }
    ck_assert_msg(seen == 1, "ID%d, method %d: the speed is written %d times", n + 1, method, seen);
}

/** The boxes of chart 4.1 ahead of the monitoring, in their order. */
static void check_start(int n, int method)
{
    static const uint16_t objects[] = {0x6098, 0x6099, 0x609A, 0x607C};
    const int start = find_word((unsigned)n, 0, START_WORD);
    ck_assert_msg(start > 0, "ID%d: 001Fh is not seen:%s", n + 1, words_seen((unsigned)n));
    const word_run_t *run = &bridge_wire.words[n][start];
    ck_assert_msg(bridge_wire.words[n][start - 1].word == ENABLED_WORD, "ID%d: bit 4 does not rise alone:%s", n + 1,
                  words_seen((unsigned)n));
    const sdo_seen_t *mode = find_sdo(0, true, on_wire(n, 0x6060), NULL);
    ck_assert_msg(mode && mode->data[0] == CM1E_BRIDGE_MODE_HM && mode->answered_ns < run->from_ns,
                  "ID%d: hm is not written first", n + 1);
    for (size_t i = 0; i < sizeof objects / sizeof objects[0]; i++) {
        const sdo_seen_t *sdo = find_sdo(0, true, on_wire(n, objects[i]), NULL);
        ck_assert_msg(sdo && sdo->abort_code == 0, "ID%d: %04Xh is not written", n + 1, on_wire(n, objects[i]));
        ck_assert_msg(run->from_ns - sdo->answered_ns >= SETTING_NS, "ID%d: 001Fh comes %.1f ms behind %04Xh", n + 1,
                      (double)(run->from_ns - sdo->answered_ns) * 1e-6, on_wire(n, objects[i]));
    }
    ck_assert_int_eq(find_sdo(0, true, on_wire(n, 0x6098), NULL)->data[0], method);
    check_speed(n, method);
}

static cm1e_command_status_t run_home(int n, cm1e_command_id_t id, double seconds, int *waited)
{
    for (int i = cycles_of(seconds); i > 0 && cm1e_axis_command_status(axes[n], id).state == CM1E_COMMAND_ACTIVE; i--) {
        cycles(1);
        const int count = bridge_wire.word_count[n];
        const bool bit4 = count && bridge_wire.words[n][count - 1].word == START_WORD;
        *waited += bit4 && !(bridge_wire.status[n] & (ATTAINED | HOMING_ERROR));
    }
    return cm1e_axis_command_status(axes[n], id);
}

static bool searching(int n) { return cm1e_sim_search_running(&motor(n)->search); }

/* ---- tests ------------------------------------------------------------------------------------------------------- */

START_TEST(test_homing_completes)
{
    const int n = _i / METHODS, method = 1 + _i % METHODS;
    int waited = 0;
    open_axes();
    enable_axis(n);
    bridge_wire.sdo_count = bridge_wire.word_count[n] = 0;
    const cm1e_command_status_t status = run_home(n, home(n, method), 8.0, &waited);
    ck_assert_msg(status.state == CM1E_COMMAND_DONE, "ID%d, method %d: %d %s %s", n + 1, method, status.state,
                  cm1e_strerror(status.error), text_of(n));
    check_start(n, method);
    ck_assert_int_gt(waited, 100);
    branches[NO_ERROR_BIT].taken++;
    branches[NOT_ATTAINED].taken++;
    branches[ATTAINED_BIT].taken++;
    const int start = find_word((unsigned)n, 0, START_WORD);
    ck_assert_msg(find_word((unsigned)n, start, ENABLED_WORD) == start + 1, "ID%d: 0Fh does not end it:%s", n + 1,
                  words_seen((unsigned)n));
    branches[COMPLETE].taken++;
    ck_assert_int_eq(motor(n)->mode, CM1E_BRIDGE_MODE_CSP);
    ck_assert(info_of(n).state == CM1E_AXIS_STANDSTILL && info_of(n).homed);
    ck_assert_double_eq_tol(info_of(n).actual_position, 2.5, 0.002);
    cycles(100);
    ck_assert_msg(abs(bridge_wire.position[n]) < 30, "ID%d: at %d after homing", n + 1, bridge_wire.position[n]);
    close_axes();
}
END_TEST

/** The bit alone, without a word of what is wrong: the axis ends the search itself and takes the torque away. */
START_TEST(test_homing_error_ends_the_search)
{
    const int n = _i;
    int waited = 0;
    open_axes();
    enable_axis(n);
    const cm1e_command_id_t id = home(n, 2);
    bridge_wire.forge_inputs = forge_bits;
    for (int i = 0; i < 2000 && !searching(n); i++)
        cycles(1);
    cycles(150);
    ck_assert_msg(searching(n), "ID%d does not search", n + 1);
    victim = n;
    forged_bits = HOMING_ERROR;
    const cm1e_command_status_t status = run_home(n, id, 0.1, &waited);
    ck_assert_msg(status.state == CM1E_COMMAND_ERROR && status.error == CM1E_ERROR_AXIS_HOMING_FAILED, "ID%d: %d %s",
                  n + 1, status.state, cm1e_strerror(status.error));
    branches[ERROR_BIT].taken++;
    cycles(300);
    ck_assert_int_eq(info_of(n).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_msg(strstr(text_of(n), "oming"), "%s", text_of(n));
    ck_assert_msg(!searching(n) && motor(n)->motor_free, "ID%d goes on", n + 1);
    branches[FAILED].taken++;
    close_axes();
}
END_TEST

/** As the device does it: the motor has an error, and the others know nothing of it. */
START_TEST(test_error_of_the_motor_ends_the_search)
{
    const int n = _i, other = (n + 1) % DRIVES;
    char line[64];
    int waited = 0;
    open_axes();
    enable_axis(n);
    enable_axis(other);
    const cm1e_command_id_t id = home(n, 1);
    for (int i = 0; i < 2000 && !searching(n); i++)
        cycles(1);
    cycles(150);
    snprintf(line, sizeof line, "motor 1 %d error overload", n + 1);
    simulate(line);
    const cm1e_command_status_t status = run_home(n, id, 0.1, &waited);
    ck_assert_msg(status.state == CM1E_COMMAND_ERROR, "ID%d: %d", n + 1, status.state);
    branches[ERROR_BIT].taken++;
    cycles(300);
    ck_assert_int_eq(info_of(n).state, CM1E_AXIS_ERROR_STOP);
    ck_assert_msg(strstr(text_of(n), "verload"), "%s", text_of(n));
    ck_assert_msg(!searching(n) && motor(n)->motor_free, "ID%d goes on", n + 1);
    ck_assert_msg(info_of(other).state == CM1E_AXIS_STANDSTILL, "ID%d: %s", other + 1, text_of(other));
    branches[FAILED].taken++;
    close_axes();
}
END_TEST

/** Bit 12 never comes: the time-out of the axis ends what the guide's chart would wait for without end. */
START_TEST(test_homing_that_never_ends_is_given_up)
{
    const int n = _i;
    cm1e_command_id_t id;
    int waited = 0;
    open_axes();
    enable_axis(n);
    const cm1e_homing_config_t homing = {.method = 3, .velocity = 0.2, .acceleration = 90, .timeout_s = 1};
    const cm1e_axis_command_t c = {.kind = CM1E_COMMAND_HOME, .homing = &homing};
    ck_assert_int_eq(cm1e_axis_start(axes[n], &c, &id), CM1E_OK);
    const cm1e_command_status_t status = run_home(n, id, 4.0, &waited);
    ck_assert_msg(status.state == CM1E_COMMAND_ERROR && status.error == CM1E_ERROR_AXIS_HOMING_TIMEOUT, "ID%d: %d %s",
                  n + 1, status.state, cm1e_strerror(status.error));
    ck_assert_int_gt(waited, 500);
    branches[NOT_ATTAINED].taken++;
    cycles(500);
    ck_assert_msg(!searching(n), "ID%d searches on", n + 1);
    close_axes();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("flow charts of appendix 4");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_homing_completes, 0, DRIVES * METHODS);
    tcase_add_loop_test(all, test_homing_error_ends_the_search, 0, DRIVES);
    tcase_add_loop_test(all, test_error_of_the_motor_ends_the_search, 0, DRIVES);
    tcase_add_loop_test(all, test_homing_that_never_ends_is_given_up, 0, DRIVES);
    suite_add_tcase(suite, all);
    return run_flows(suite, branches, sizeof branches / sizeof branches[0]);
}
