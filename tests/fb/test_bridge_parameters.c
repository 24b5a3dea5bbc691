/* What a program reads of a motor behind a bridge while the cycle runs: MC_ReadParameter 1530 ... 1537 (docs/DEVICE.md),
 * each axis its own part of F530. */
#include "axis_segment.h"
#undef axis /* there are four */

#include "cm1e/bridge.h"
#include "cm1e/plcopen.h"
#include "sim/bridge_app.h"

enum { MOTORS = CM1E_BRIDGE_AXES, STATUS = 1530, RECEIVE_ERRORS, SENT, RECEIVED, LONGEST, SHORTEST, LATE, EARLY };

static AXIS_REF_t references[MOTORS];

static void open_axes(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", MOTORS);
    config.virtual_time = true;
    config.cycle_time_ns = 1000000;
    for (int n = 0; n < MOTORS; n++) {
        config.axes[n].address = 1;
        config.axes[n].channel = (uint8_t)(MOTORS - n); /* the last connector is the first axis */
        config.axes[n].k37 = 10;
        config.axes[n].k37_stated = true;
    }
    open_segment();
    for (int n = 0; n < MOTORS; n++)
        references[n] = cm1e_axis_reference(axes[n]);
}

/* The value, or the block's error. */
static double read_parameter(int connector, int number, WORD *error_id)
{
    MC_ReadParameter_t read = {.Axis = &references[MOTORS - connector], .Enable = TRUE,
                               .ParameterNumber = (INT)number};
    for (int i = 0; i < 200 && !read.Valid && !read.Error; i++) {
        MC_ReadParameter(&read);
        cycles(1);
    }
    ck_assert_msg(read.Valid || read.Error, "parameter %d of motor %d: no answer", number, connector);
    *error_id = read.ErrorID;
    return read.Value;
}

static double value_of(int connector, int number)
{
    WORD error_id;
    const double value = read_parameter(connector, number, &error_id);
    ck_assert_uint_eq(error_id, 0);
    return value;
}

START_TEST(each_axis_shows_its_own_motor)
{
    static const double statuses[MOTORS] = {0x08, 0x0F, 0x10, 0x04};
    open_axes();
    cycles(20);
    simulate("motor 1 2 unplug");
    simulate("motor 1 4 error overload");
    cycles(50);
    for (int id = 1; id <= MOTORS; id++) {
            const double sent = value_of(id, SENT), received = value_of(id, RECEIVED);
        ck_assert_double_eq(value_of(id, STATUS), statuses[id - 1]);
        ck_assert_int_eq(value_of(id, RECEIVE_ERRORS) > 40, id == 2);
        ck_assert_int_eq(sent > received + 40, id == 2);
        ck_assert(sent > 50);
    }
    char words[CM1E_BRIDGE_STATUS_TEXT];
    ck_assert_str_eq(cm1e_bridge_status_text(CM1E_BRIDGE_CM1, (uint32_t)value_of(2, STATUS), words, sizeof words),
                     "serial communication error");
    close_segment();
}
END_TEST

START_TEST(all_axes_show_the_bridge)
{
    open_axes();
    cycles(200);
    for (int id = 1; id <= MOTORS; id++) {
        ck_assert_double_eq(value_of(id, LONGEST), 1000);
        ck_assert_double_eq(value_of(id, SHORTEST), 1000);
        ck_assert_double_eq(value_of(id, LATE), 0);
        ck_assert_double_eq(value_of(id, EARLY), 0);
    }
    close_segment();
}
END_TEST

START_TEST(they_cannot_be_written)
{
    open_axes();
    cycles(20);
    for (int number = STATUS; number <= EARLY; number++) {
        MC_WriteParameter_t write = {.Axis = &references[0], .Execute = TRUE, .ParameterNumber = (INT)number};
        for (int i = 0; i < 200 && !write.Done && !write.Error; i++) {
            MC_WriteParameter(&write);
            cycles(1);
        }
        ck_assert(write.Error);
        ck_assert_uint_eq(write.ErrorID, cm1e_error_id(CM1E_ERROR_AXIS_PARAMETER_READ_ONLY));
    }
    close_segment();
}
END_TEST

START_TEST(a_motor_without_bridge_has_none)
{
    describe("1.3.5", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    open_segment();
    references[0] = cm1e_axis_reference(axes[0]);
    cycles(20);
    MC_ReadParameter_t read = {.Axis = &references[0], .Enable = TRUE, .ParameterNumber = STATUS};
    for (int i = 0; i < 200 && !read.Valid && !read.Error; i++) {
        MC_ReadParameter(&read);
        cycles(1);
    }
    ck_assert_uint_eq(read.ErrorID, cm1e_error_id(CM1E_ERROR_UNSUPPORTED));
    ck_assert_msg(strstr(text_of(0), "a CM1-E has no object 0xF530:05"), "%s", text_of(0));
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bridge_parameters");
    TCase *tests = tcase_create("parameters");
    tcase_add_test(tests, each_axis_shows_its_own_motor);
    tcase_add_test(tests, all_axes_show_the_bridge);
    tcase_add_test(tests, they_cannot_be_written);
    tcase_add_test(tests, a_motor_without_bridge_has_none);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
