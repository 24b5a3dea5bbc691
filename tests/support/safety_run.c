#include "safety_run.h"

void bench_free_axes(bench_t *bench, uint32_t axes, cm1e_mapping_t mapping, const char *firmware)
{
    cm1e_bus_config_free(&bench->config);
    memset(bench, 0, sizeof *bench);
    bench_describe(bench, axes);
    for (uint32_t n = 0; n < axes; n++) {
        cm1e_axis_config_t *axis = &bench->config.axes[n];
        axis->mapping = mapping;
        axis->homing = (cm1e_homing_config_t){0};
        axis->sim.no_stops = true;
        snprintf(axis->firmware, sizeof axis->firmware, "%s", firmware);
    }
}

void bench_limit_axes(bench_t *bench, double counts, double velocity, double acceleration, double jerk)
{
    for (uint32_t n = 0; n < bench->config.axis_count; n++) {
        cm1e_axis_config_t *axis = &bench->config.axes[n];
        axis->counts_per_unit = counts;
        axis->max_velocity = velocity;
        axis->max_acceleration = axis->max_deceleration = acceleration;
        axis->max_jerk = jerk;
    }
}

void bench_play(bench_t *bench)
{
    cm1e_diag_t diag = {0};
    bench_open(bench);
    bench_start(bench);
    if (bench->started)
        bench->started(bench);
    const cm1e_error_t error = bench_run(bench, &diag);
    MUST(bench, error == CM1E_OK, "%s", diag.text);
    bench_close(bench);
}

void bench_add(Suite *suite, const char *name, double limit_s, const TTest *test, int from, int to)
{
    TCase *tcase = tcase_create(name);
    tcase_set_timeout(tcase, stated_stride() > 0 ? 0 : limit_s);
    tcase_add_loop_test(tcase, test, from, to);
    suite_add_tcase(suite, tcase);
}

int bench_run_suite(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}

int bench_main(const char *about, double limit_s, const bench_test_t *tests)
{
    Suite *suite = suite_create(about);
    for (; tests->test; tests++)
        bench_add(suite, about, limit_s, tests->test, 0, tests->count);
    return bench_run_suite(suite);
}
