/* Counts and units: gear, direction inversion, the drive's wrap. What is rational is exact. */
#include <math.h>
#include <stdlib.h>

#include "../support/axis_bench.h"
#include "../support/xorshift.h"

static uint64_t seed;

static uint64_t draw(uint64_t below)
{
    return (xorshift(&seed) >> 11) % below;
}

static double uniform(double low, double high) { return low + (high - low) * (double)draw(1 << 30) / (1 << 30); }

void setUp(void)
{
    const char *given = getenv("CM1E_TEST_SEED");
    seed = given ? strtoull(given, NULL, 0) : 0x5EED0001;
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("CM1E_TEST_SEED=0x%llx\n", (unsigned long long)seed);
    bench_end();
}

static void configure(uint32_t numerator, uint32_t denominator, double units, bool invert)
{
    cm1e_axis_config_t *config = &bus.config.axes[0];
    config->gear_numerator = numerator;
    config->gear_denominator = denominator;
    config->units_per_revolution = units;
    config->invert = invert;
    bench_create();
}

/* The axis as if the motor had turned so far. */
static double units_at(int64_t counts)
{
    axis->position.actual_counts = counts;
    return bench_info().actual_position;
}

static void test_whole_revolutions_of_a_load_behind_a_gear_are_exact(void)
{
    static const struct {
        uint32_t numerator, denominator;
        double units;
    } rows[] = {{1, 1, 1}, {7, 3, 360}, {3, 7, 360}, {1000000, 999999, 10}, {17, 13, 0.1}, {1, 3, 25.4}, {11, 1, 1e9}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int invert = 0; invert < 2; invert++) {
            configure(rows[i].numerator, rows[i].denominator, rows[i].units, invert);
            for (int n = 0; n < 1000; n++) {
                const int64_t turns = (int64_t)draw(1u << 20) - (1 << 19); /* of denominator revolutions of the load */
                const int64_t counts = 50000 * (int64_t)rows[i].numerator * turns;
                const double expected = (double)turns * (rows[i].units * rows[i].denominator);
                TEST_ASSERT_EQUAL_DOUBLE(invert ? -expected : expected, units_at(counts));
            }
        }
}

static void test_quotient_of_the_gear_is_the_scale_of_velocity(void)
{
    configure(7, 3, 360, false);
    bus.velocity_raw = 350000 / 7; /* a revolution of the motor a second: 3/7 of the load */
    bench_cycles(2);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 360.0 * 3.0 / 7.0, bench_info().actual_velocity);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2500000.0 / 50000.0 * 360.0 * 3.0 / 7.0, axis->limits.maximum.velocity);
}

static void test_positions_come_back_within_half_a_count(void)
{
    for (int n = 0; n < 400; n++) {
        cm1e_axis_config_t *config = &bus.config.axes[0];
        *config = (cm1e_axis_config_t){.invert = draw(2)};
        if (draw(2))
            config->counts_per_unit = pow(10.0, uniform(-3, 12));
        else
            configure((uint32_t)draw(1000000) + 1, (uint32_t)draw(1000000) + 1, pow(10.0, uniform(-3, 3)), draw(2));
        bench_create();
        for (int k = 0; k < 100; k++) {
            const int64_t counts = (int64_t)((double)(INT64_C(1) << draw(51)) * uniform(-1, 1));
            position_t back;
            const double units = cm1e_axis_units(axis, (position_t){counts, 0.0});
            TEST_ASSERT_TRUE(cm1e_axis_position_from_units(axis, units, &back));
            TEST_ASSERT_DOUBLE_WITHIN(0.5, 0.0, cm1e_position_minus(back, (position_t){counts, 0.0}));
        }
    }
}

static void test_positions_grow_with_the_counts_over_the_drives_wrap(void)
{
    configure(7, 3, 360, false);
    double before = bench_info().actual_position;
    for (int n = 0; n < 50; n++) {
        bus.position = (int32_t)((uint32_t)bus.position + 2000000011u);
        bench_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-2, 2000000011.0 * 1080 / 350000, bench_info().actual_position - before);
        before = bench_info().actual_position;
    }
    TEST_ASSERT_EQUAL_INT64(INT64_C(50) * 2000000011, axis->position.actual_counts);
    TEST_ASSERT_EQUAL_DOUBLE(2000000011.0 * 50 * 1080 / 350000, before);
}

/* Sums of fractions of a count stay a count and a fraction. */
static void test_fractions_of_a_count_stay_below_one(void)
{
    static const double edges[] = {0.0, 1e-300, -1e-300, 1e-17, -1e-17, 0.5, -0.5, 1.0, -1.0, 0x1.fffffffffffffp-1,
                                   -0x1.fffffffffffffp-1, 1e-16, -1e-16};
    enum { EDGES = sizeof edges / sizeof edges[0] };
    for (int i = 0; i < 200000; i++) {
        position_t position = {(int64_t)draw(1000) - 500, 0.0};
        const position_t start = position;
        double total = 0.0;
        for (int k = 0; k < 4; k++) {
            const double way = draw(2) ? edges[draw(EDGES)] : uniform(-1000, 1000);
            position = cm1e_position_plus(position, way);
            total += way;
            if (!(position.fraction >= 0.0 && position.fraction < 1.0))
                TEST_FAIL_MESSAGE("a fraction out of its range");
        }
        if (!(fabs(cm1e_position_minus(position, start) - total) < 1e-11))
            TEST_FAIL_MESSAGE("a sum is wrong");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_whole_revolutions_of_a_load_behind_a_gear_are_exact);
    RUN_TEST(test_quotient_of_the_gear_is_the_scale_of_velocity);
    RUN_TEST(test_positions_come_back_within_half_a_count);
    RUN_TEST(test_positions_grow_with_the_counts_over_the_drives_wrap);
    RUN_TEST(test_fractions_of_a_count_stay_below_one);
    return UNITY_END();
}
