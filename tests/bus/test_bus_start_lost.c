/* A slave of several that is lost at any frame of a start: the start ends soon, its words say which slave it is or which
 * ones are left, and the next start on the same bus brings all to Operational. */
#include "bus_support.h"
#include "effort.h"

enum { SLAVES = 3, SETTLE = 20 };
#define LONGEST_NS INT64_C(30000000000)

static const struct loss {
    const char *order, *cure;
} losses[] = {{"unplug 3", "replug 3"}, {"power-cycle 2 300", NULL}, {"detach 2 powered", "attach 2"}};
enum { LOSSES = sizeof losses / sizeof losses[0] };

typedef struct strike {
    cm1e_bus_t *bus;
    const char *order;
    unsigned at, seen;
} strike_t;

static cm1e_tap_verdict_t strike(void *context, cm1e_tap_frame_t *frame)
{
    strike_t *fault = context;
    if (frame->direction == CM1E_TAP_SENT && ++fault->seen == fault->at)
        simulate(fault->bus, fault->order);
    return CM1E_TAP_PASS;
}

/** And does not say of one that is gone that it stays in a state, or reports something. */
static bool names_what_is_lost(void)
{
    static const char *const words[] = {"lave 2", "lave 3", "axis2", "axis3", "working counter"};
    if (strstr(diag.text, "stays in") || strstr(diag.text, "reports"))
        return false;
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strstr(diag.text, words[i]))
            return true;
    return false;
}

START_TEST(a_slave_that_is_lost_at_any_frame_of_a_start_is_named)
{
    const struct loss *loss = &losses[_i];
    const int stride = sweep_stride(4, 40);
    strike_t fault = {.order = loss->order, .at = 1 + (unsigned)sweep_first(_i, stride)};
    unsigned failed = 0;
    for (bool struck = true; struck; fault.at += (unsigned)stride) {
        sim_config(SLAVES);
        cm1e_bus_t *bus = fault.bus = open_bus();
        fault.seen = 0;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), strike, &fault);
        const int64_t begun_ns = now_of(bus);
        const cm1e_error_t error = cm1e_bus_start(bus, &diag);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        struck = fault.seen >= fault.at;
        ck_assert_int_lt(now_of(bus) - begun_ns, LONGEST_NS);
        ck_assert_msg(error == CM1E_OK || (diag.error == error && names_what_is_lost()), "frame %u: %s: %s", fault.at,
                      cm1e_strerror(error), diag.text);
        failed += error != CM1E_OK;
        if (struck && loss->cure)
            simulate(bus, loss->cure);
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + INT64_C(1000000000));
        if (error == CM1E_OK)
            cm1e_bus_stop(bus);
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "frame %u: %s", fault.at, diag.text);
        cycles(bus, SETTLE);
        for (uint16_t position = 1; position <= SLAVES; position++)
            ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
        cm1e_bus_close(bus);
    }
    ck_assert_uint_gt(failed, 10);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_start_lost");
    TCase *tests = tcase_create("lost");
    tcase_add_loop_test(tests, a_slave_that_is_lost_at_any_frame_of_a_start_is_named, 0, LOSSES);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
