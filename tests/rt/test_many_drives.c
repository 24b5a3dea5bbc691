/* As many motors as one network carries: started, enabled and moved. */
#include "axes_described.h"
#include "moved_drives.h"
#include "quick_check.h"

enum { MOST_CYCLES = 2000 };

static cm1e_bus_config_t config;

static void check_moved(uint32_t motors, unsigned frames, unsigned bytes)
{
    moved_drives_t result;
    ck_assert_msg(moved_drives_run(&config, MOST_CYCLES, &result) == CM1E_OK, "%s", result.diag.text);
    ck_assert_uint_eq(result.moved, motors);
    ck_assert_uint_eq(result.bad_cycles, 0);
    ck_assert_uint_eq(result.frames, frames);
    ck_assert_uint_eq(result.bytes, bytes);
}

/** With the mapping csp (8 and 16 bytes) their process data fit into 1000 us. */
START_TEST(drives_271_on_one_network_are_enabled_and_moved)
{
    describe_axes(&config, 271);
    for (uint32_t i = 0; i < config.axis_count; i++)
        config.axes[i].mapping = CM1E_MAPPING_CSP;
    check_moved(271, 5, 271 * (8 + 16) + 5 * 52);
}
END_TEST

/** Overlapped, each takes the 21 bytes of its inputs, and each frame 4 more. At 1000 us these are 80 % of the wire. */
START_TEST(drives_with_overlapped_process_data_are_enabled_and_moved)
{
    static const struct {
        int64_t cycle_us;
        uint32_t motors;
        unsigned frames;
    } runs[] = {{200, 53, 1}, {250, 67, 1}, {500, 135, 2}, {1000, 271, 4}};
    describe_axes(&config, runs[_i].motors);
    config.cycle_time_ns = runs[_i].cycle_us * 1000;
    config.overlap = true;
    check_moved(runs[_i].motors, runs[_i].frames, runs[_i].motors * 21 + runs[_i].frames * (52 + 4));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("many_drives");
    TCase *tests = tcase_create("drives");
    tcase_add_test(tests, drives_271_on_one_network_are_enabled_and_moved);
    tcase_add_loop_test(tests, drives_with_overlapped_process_data_are_enabled_and_moved, 0, 4);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}
