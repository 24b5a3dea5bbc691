/* The bench of several axes (axes_bench.h): they move side by side, each by its own configuration, and the witness sees
 * what an axis does beyond its limits. */
#include "unity.h"

#include "../support/axes_bench.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

static void describe_four(void)
{
    axes_describe(4);
    axes_config(1)->counts_per_unit = 50000.0 / 360.0;
    axes_config(1)->modulo_range = 360;
    axes_config(2)->invert = true;
    axes_config(2)->counts_per_unit = 1234.5;
    axes_config(2)->max_jerk = 20000;
    fake_bus_init(axes_motor(3), CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_7_2, CM1E_FIRMWARE_1_3_5);
    axes_config(3)->mapping = CM1E_MAPPING_CSP;
}

static void test_four_axes_move_each_by_its_own_units_in_any_order(void)
{
    static const int orders[3][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}};
    for (int order = 0; order < 3; order++) {
        describe_four();
        memcpy(axes_bench.order, orders[order], sizeof axes_bench.order);
        axes_make();
        axes_enable_all();
        const double targets[4] = {3, 270, -40, 0.5};
        cm1e_command_id_t ids[4];
        for (int n = 0; n < 4; n++)
            ids[n] = axes_move_to(n, targets[n], n == 1 ? 360 : n == 2 ? 100 : 5);
        for (int n = 0; n < 4; n++) {
            axes_wait(n, ids[n], 5000);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(n, ids[n]).state);
        }
        axes_cycles(3);
        const int32_t counts[4] = {150000, -12500, 49380, 25000}; /* the shortest way; 40 x 1234.5, inverted */
        for (int n = 0; n < 4; n++)
            TEST_ASSERT_EQUAL_INT32(counts[n], axes_motor(n)->position);
    }
}

static void test_fault_and_power_of_one_axis_leave_the_others_alone(void)
{
    axes_begin(3);
    for (int n = 0; n < 3; n++)
        (void)axes_move_velocity(n, 4);
    axes_cycles(300);
    fake_bus_fault(axes_motor(1), 0x2310);
    axes_power(2, false);
    axes_cycles(300);
    axes_must_be(0, CM1E_AXIS_CONTINUOUS_MOTION);
    axes_must_be(1, CM1E_AXIS_ERROR_STOP);
    axes_must_be(2, CM1E_AXIS_DISABLED);
    axes_told(1, "axis1");
}

static void test_axis_that_has_turned_for_years_counts_from_there(void)
{
    axes_describe(2);
    axes_make();
    axes_start_far(1, 200000); /* 2^49 counts: 8.6e14 */
    axes_enable_all();
    const double from = axes_info(1).set_position;
    const cm1e_command_id_t id = axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE,
                                                                        .position = 2, .velocity = 5});
    axes_wait(1, id, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, axes_status(1, id).state);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, from + 2, axes_info(1).set_position);
    axes_cycles(2);
    TEST_ASSERT_EQUAL_INT32(100000, axes_motor(1)->position);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_four_axes_move_each_by_its_own_units_in_any_order);
    RUN_TEST(test_fault_and_power_of_one_axis_leave_the_others_alone);
    RUN_TEST(test_axis_that_has_turned_for_years_counts_from_there);
    return UNITY_END();
}
