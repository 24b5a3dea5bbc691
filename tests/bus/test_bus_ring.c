/* A redundant ring: one cut anywhere costs nobody the bus, before and during operation. */
#include "bus_support.h"

enum { SLAVES = 4 };

static cm1e_bus_config_t *ring_config(void)
{
    sim_config(SLAVES);
    strcpy(config.second_interface, "sim-second");
    return &config;
}

START_TEST(closed_ring_starts_and_runs)
{
    ring_config();
    cm1e_bus_t *bus = start_bus();
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), SLAVES);
    cycles(bus, 300);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(ring_that_is_cut_starts_and_runs)
{
    ring_config();
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_cut(segment_of(bus), (uint32_t)_i, true);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), SLAVES);
    cycles(bus, 300);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(cut_and_mended_in_operation_no_slave_leaves_operational)
{
    ring_config();
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 50);
    for (int round = 0; round < 4; round++) {
        cm1e_sim_segment_cut(segment_of(bus), (uint32_t)_i, round % 2 == 0);
        unsigned bad = 0;
        for (int n = 0; n < 200; n++)
            bad += cycle(bus) != CM1E_OK;
        ck_assert_uint_le(bad, 2);
        ck_assert_int_eq(cm1e_bus_health(bus), CM1E_OK);
        for (uint16_t position = 1; position <= SLAVES; position++) {
            ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
            ck_assert(!cm1e_bus_slave_watch(bus, position).lost);
        }
    }
    uint8_t data[16];
    size_t size = sizeof data;
    ck_assert_int_eq(cm1e_sdo_read(bus, SLAVES, 0x1008, 0, data, &size, &diag), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_ring");
    TCase *tests = tcase_create("ring");
    tcase_add_test(tests, closed_ring_starts_and_runs);
    tcase_add_loop_test(tests, ring_that_is_cut_starts_and_runs, 1, SLAVES + 2);
    tcase_add_loop_test(tests, cut_and_mended_in_operation_no_slave_leaves_operational, 1, SLAVES + 2);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
