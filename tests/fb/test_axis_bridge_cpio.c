/* CPIO is csp with other words: a motor behind the simulated bridge is led, loses its frames, and is enabled while it turns
 * in the same way in both (docs/BRIDGE.md, step 6). */
#include <math.h>

#include "axis/axis_parts.h"
#include "cm1e/plcopen.h"
#include "sim/bridge_app.h"

#include "axis_segment.h"
#undef axis /* there are four */

enum { AXES = CM1E_BRIDGE_AXES, CM2 = 2, MODES = 2, LOST_LIMIT = 5, ASKED = 3, LOST_MOST = 60 };
static const CM_MODE modes[MODES] = {cmCSP, cmCPIO};
static const double velocity = 50000.0; /* counts/s */

static AXIS_REF_t reference;
static MC_Power_t switcher;
static MC_MoveVelocity_t turn;
static int n;

static cm1e_sim_bridge_axis_t *motor(void)
{
    return &cm1e_sim_bridge_of(cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1))->axes[n];
}

static double speed(void) { return fabs(motor()->mechanics.velocity); }

static void scan(int count)
{
    while (count-- > 0) {
        inputs();
        MC_Power(&switcher);
        MC_MoveVelocity(&turn);
        outputs();
    }
}

static bool lost_now;

static cm1e_tap_verdict_t lose(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    (void)frame;
    return lost_now ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

static void begin(int number, CM_MODE mode)
{
    n = number;
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", AXES);
    config.virtual_time = true;
    config.cycle_time_ns = CM1E_BRIDGE_CYCLE_TIME_NS;
    config.lost_cycles_limit = LOST_LIMIT;
    for (int i = 0; i < AXES; i++) {
        config.axes[i] = (cm1e_axis_config_t){.address = 1, .channel = (uint8_t)(i + 1), .k37 = 10, .k37_stated = true};
        config.axes[i].sim.no_stops = true;
    }
    open_segment();
    reference = cm1e_axis_reference(axes[n]);
    switcher = (MC_Power_t){.Axis = &reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
    turn = (MC_MoveVelocity_t){.Axis = &reference, .Velocity = velocity / fabs(axes[n]->position.scale)};
    scan(50);
    CM_SetMode_t set = {.Axis = &reference, .Mode = mode, .Execute = TRUE};
    do {
        CM_SetMode(&set);
        scan(1);
    } while (set.Busy);
    ck_assert_msg(set.Done, "%s", text_of(n));
}

static void switch_off(void)
{
    switcher.Enable = FALSE;
    scan(300);
    ck_assert_msg(!switcher.Status, "%s", text_of(n));
}

static void switch_on(void)
{
    switcher.Enable = TRUE;
    for (int i = 0; i < 3000 && !switcher.Status && !switcher.Error; i++)
        scan(1);
    ck_assert_msg(switcher.Status, "%s", text_of(n));
}

/* The motor holds the last target that it has heard. A set-point that went on unheard would make it leap when frames come
 * again. */
START_TEST(test_a_motor_whose_frames_are_lost_does_not_leap_when_they_come_again)
{
    const CM_MODE mode = modes[_i % MODES];
    for (int lost = 1; lost < LOST_MOST; lost += lost < 8 ? 1 : 9) {
        begin(_i / MODES ? CM2 : 0, mode);
        switch_on();
        turn.Execute = TRUE;
        scan(400);
        ck_assert_double_lt(fabs(speed() - velocity), 0.05 * velocity);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), lose, NULL);
        lost_now = true;
        scan(lost);
        lost_now = false;
        double fastest = 0.0;
        for (int i = 0; i < 200; i++) {
            scan(1);
            fastest = fmax(fastest, speed());
        }
        const bool failed = info_of(n).state == CM1E_AXIS_ERROR_STOP;
        ck_assert(failed ? lost >= ASKED : lost < LOST_LIMIT); /* it is the only slave, and asked in every cycle */
        const double most = failed ? 0.5 * velocity : 1.1 * velocity;
        ck_assert_msg(fastest < most, "mode %d, %d frames lost: %.0f counts/s", (int)mode, lost, fastest);
        close_segment();
    }
}
END_TEST

/* It is braked from where it is, and on when it rests. */
START_TEST(test_a_motor_that_turns_when_it_gets_its_torque_is_braked_first)
{
    begin(_i / MODES ? CM2 : 0, modes[_i % MODES]);
    const double thrown = 1200000.0; /* 24 revolutions a second */
    switch_on(); /* a CM1 holds its place until it was enabled once */
    switch_off();
    motor()->mechanics.velocity = thrown;
    switcher.Enable = TRUE;
    bool ramped = false;
    for (int i = 0; i < 1000 && !switcher.Status; i++) {
        scan(1);
        ramped |= info_of(n).state == CM1E_AXIS_DISABLED && info_of(n).set_velocity != 0.0;
        ck_assert_double_lt(speed(), 1.02 * thrown);
    }
    ck_assert_msg(switcher.Status && ramped, "Status %d, ramp %d: %s", switcher.Status, ramped, text_of(n));
    ck_assert_double_lt(speed(), 0.01 * thrown);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("a motor behind a bridge in csp and in CPIO");
    TCase *cases = tcase_create("cpio");
    tcase_set_timeout(cases, 60);
    tcase_add_loop_test(cases, test_a_motor_whose_frames_are_lost_does_not_leap_when_they_come_again, 0, 2 * MODES);
    tcase_add_loop_test(cases, test_a_motor_that_turns_when_it_gets_its_torque_is_braked_first, 0, 2 * MODES);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
