/**
 * MC_SetPosition and the blocks for parameters on the simulated segment, call by call: what they show, what becomes of
 * the drive's objects, and who gets which answer.
 */
#include "axis_segment.h"

#include "cm1e/plcopen.h"

static AXIS_REF_t reference;
static MC_SetPosition_t set;
static MC_ReadParameter_t reader;
static MC_ReadBoolParameter_t bool_reader;
static MC_WriteParameter_t writer;
static MC_WriteBoolParameter_t bool_writer;

static void begin(const char *firmware, cm1e_pdo_order_t order, cm1e_mapping_t mapping)
{
    describe(firmware, mapping, order, 1000000);
    open_segment();
    reference = cm1e_axis_reference(axis);
    set = (MC_SetPosition_t){.Axis = &reference};
    reader = (MC_ReadParameter_t){.Axis = &reference};
    bool_reader = (MC_ReadBoolParameter_t){.Axis = &reference};
    writer = (MC_WriteParameter_t){.Axis = &reference};
    bool_writer = (MC_WriteBoolParameter_t){.Axis = &reference};
    cycles(5);
}

/* 2.4.1 and 2.2.3 for every call. */
static void scan(void)
{
    inputs();
    MC_SetPosition(&set);
    MC_ReadParameter(&reader);
    MC_ReadBoolParameter(&bool_reader);
    MC_WriteParameter(&writer);
    MC_WriteBoolParameter(&bool_writer);
    outputs();
    ck_assert_int_eq(set.Done + set.Busy + set.Error, set.Execute || set.Done || set.Busy || set.Error);
    ck_assert_int_eq(writer.Done + writer.Busy + writer.Error,
                     writer.Execute || writer.Done || writer.Busy || writer.Error);
    ck_assert(!(reader.Valid && reader.Error) && !(bool_reader.Valid && bool_reader.Error));
    ck_assert((reader.ErrorID != 0) == reader.Error && (writer.ErrorID != 0) == writer.Error);
    ck_assert(reader.Valid || reader.Value == 0);
    ck_assert(reader.Enable || !(reader.Valid || reader.Busy || reader.Error));
}

static void scans(int n)
{
    while (n-- > 0)
        scan();
}

static WORD id(cm1e_error_t error) { return cm1e_error_id(error); }

/** Until the block has ended: its ErrorID. */
static WORD write(INT number, LREAL value)
{
    writer.Execute = FALSE;
    scan();
    writer.ParameterNumber = number;
    writer.Value = value;
    writer.Execute = TRUE;
    scan();
    ck_assert(!writer.Done);
    for (int n = 0; n < 2000 && writer.Busy; n++)
        scan();
    ck_assert(writer.Done || writer.Error);
    return writer.ErrorID;
}

static LREAL read(INT number)
{
    reader.Enable = FALSE;
    scan();
    reader.ParameterNumber = number;
    reader.Enable = TRUE;
    int n = 0;
    do
        scan();
    while (!reader.Valid && !reader.Error && n++ < 2000);
    ck_assert_msg(reader.Valid, "%s", text());
    return reader.Value;
}

START_TEST(parameters_of_the_axis_answer_at_once)
{
    begin("1.3.5", CM1E_PDO_ORDER_UG_4_4, CM1E_MAPPING_DYNAMIC);
    reader.ParameterNumber = 8;
    reader.Enable = TRUE;
    scan();
    ck_assert(reader.Valid && reader.Busy);
    ck_assert_double_eq(reader.Value, 50);
    reader.ParameterNumber = 7; /* another number while enabled */
    scan();
    ck_assert_double_eq(reader.Value, 0.5);
    reader.ParameterNumber = 99; /* goes away by itself */
    scan();
    ck_assert(reader.Error && reader.Busy);
    ck_assert_uint_eq(reader.ErrorID, id(CM1E_ERROR_AXIS_PARAMETER));
    reader.ParameterNumber = 6;
    scan();
    ck_assert(reader.Valid);
    ck_assert_double_eq(reader.Value, 1);
    bool_reader.ParameterNumber = 6;
    bool_reader.Enable = TRUE;
    scan();
    ck_assert(bool_reader.Valid && bool_reader.Value);
    bool_reader.ParameterNumber = 7;
    scan();
    ck_assert_uint_eq(bool_reader.ErrorID, id(CM1E_ERROR_AXIS_PARAMETER));
    bool_reader.ParameterNumber = 1047;
    scan();
    ck_assert_uint_eq(bool_reader.ErrorID, id(CM1E_ERROR_AXIS_PARAMETER));
    close_segment();
}
END_TEST

START_TEST(writing_is_busy_then_done_and_shown_for_one_call)
{
    begin("1.3.5", CM1E_PDO_ORDER_UG_4_4, CM1E_MAPPING_DYNAMIC);
    writer.ParameterNumber = 9;
    writer.Value = 10;
    writer.Execute = TRUE;
    scan();
    ck_assert(writer.Busy);
    writer.Execute = FALSE;
    scan();
    ck_assert(writer.Done);
    scan();
    ck_assert(!writer.Done);
    ck_assert_double_eq(read(9), 10);
    ck_assert_uint_eq(write(9, 51), id(CM1E_ERROR_AXIS_PARAMETER_RANGE));
    ck_assert_uint_eq(write(8, 10), id(CM1E_ERROR_AXIS_PARAMETER_READ_ONLY));
    ck_assert_uint_eq(write(0, 10), id(CM1E_ERROR_AXIS_PARAMETER));
    ck_assert_double_eq(read(9), 10);
    writer.ExecutionMode = mcQueued;
    ck_assert_uint_eq(write(9, 20), id(CM1E_ERROR_UNSUPPORTED));
    ck_assert_double_eq(read(9), 10);
    bool_writer.ParameterNumber = 6;
    bool_writer.Execute = TRUE;
    scans(2);
    ck_assert(bool_writer.Done);
    ck_assert_double_eq(read(6), 0);
    bool_writer.Execute = FALSE;
    scan();
    bool_writer.ParameterNumber = 7;
    bool_writer.Execute = TRUE;
    scan();
    ck_assert_uint_eq(bool_writer.ErrorID, id(CM1E_ERROR_AXIS_PARAMETER));
    close_segment();
}
END_TEST

START_TEST(objects_of_the_drive_are_read_and_written_while_the_cycle_runs)
{
    static const char *const firmwares[] = {"1.3.5", "1.2.0"};
    for (int i = 0; i < 4; i++) {
        begin(firmwares[i & 1], i & 2 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4, CM1E_MAPPING_DYNAMIC);
        enable();
        const cm1e_command_id_t move = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE,
                                                                      .position = 2, .velocity = 3});
        ck_assert_double_eq(read(1047), 30);
        ck_assert_uint_eq(write(1047, 45), 0);
        ck_assert_double_eq(read(1047), 45);
        ck_assert_uint_eq(write(1200, -77), 0); /* signed */
        ck_assert_double_eq(read(1200), -77);
        ck_assert_double_eq(read(1701), 0x4441);
        ck_assert_uint_eq(write(1047, 101), id(CM1E_ERROR_AXIS_PARAMETER_RANGE));
        ck_assert_uint_eq(write(1510, 1), id(CM1E_ERROR_AXIS_PARAMETER_READ_ONLY)); /* process data */
        ck_assert_uint_eq(write(1411, 500000), 0);
        ck_assert_double_eq(read(1411), 500000);
        await(move, 3);
        ck_assert_int_eq(cm1e_axis_command_status(axis, move).state, CM1E_COMMAND_DONE);
        reader.ParameterNumber = 1301;
        reader.Enable = FALSE;
        scan();
        reader.Enable = TRUE;
        scans(50);
        ck_assert_int_eq(reader.Valid, !(i & 1));
        ck_assert_uint_eq(reader.ErrorID, i & 1 ? id(CM1E_ERROR_UNSUPPORTED) : 0);
        close_segment();
    }
}
END_TEST

/* The value of one number is never shown for another. */
START_TEST(number_may_change_while_a_transfer_is_under_way)
{
    begin("1.3.5", CM1E_PDO_ORDER_UG_4_4, CM1E_MAPPING_DYNAMIC);
    for (int n = 0; n < 5; n++)
        ck_assert_uint_eq(write((INT)(1021 + n), 1000 + n), 0);
    reader.Enable = TRUE;
    unsigned valid = 0;
    for (int n = 0; n < 3000; n++) {
        reader.ParameterNumber = (INT)(1021 + n / (1 + n % 37) % 5);
        scan();
        ck_assert(!reader.Error);
        if (reader.Valid)
            ck_assert_double_eq(reader.Value, 1000 + reader.ParameterNumber - 1021);
        valid += reader.Valid;
    }
    ck_assert_uint_gt(valid, 10);
    close_segment();
}
END_TEST

START_TEST(objects_that_the_mapping_carries_are_not_written)
{
    begin("1.3.5", CM1E_PDO_ORDER_UG_4_4, CM1E_MAPPING_PROFILE);
    ck_assert_uint_eq(write(1411, 500000), id(CM1E_ERROR_AXIS_PARAMETER_READ_ONLY));
    ck_assert_uint_eq(write(1412, 500000), 0);
    close_segment();
}
END_TEST

START_TEST(slave_that_is_gone_ends_a_transfer_with_an_error)
{
    begin("1.3.5", CM1E_PDO_ORDER_UG_4_4, CM1E_MAPPING_DYNAMIC);
    simulate("unplug 1");
    writer.ParameterNumber = 1047;
    writer.Value = 40;
    writer.Execute = TRUE;
    scan();
    ck_assert(writer.Busy);
    for (int n = 0; n < 5000 && writer.Busy; n++)
        scan();
    ck_assert(writer.Error);
    ck_assert_msg(strstr(text(), "parameter 1047") || info().error, "%s", text());
    close_segment();
}
END_TEST

START_TEST(position_is_set_at_the_edge)
{
    begin("1.3.5", CM1E_PDO_ORDER_UG_4_4, CM1E_MAPPING_DYNAMIC);
    enable();
    const cm1e_command_id_t move = command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 3,
                                                                  .velocity = 2});
    scans(300);
    const double before = info().actual_position;
    set.Position = 100;
    set.Relative = TRUE;
    set.Execute = TRUE;
    scan();
    ck_assert(set.Busy && !set.Done);
    set.Execute = FALSE;
    scan();
    ck_assert(set.Done);
    scan();
    ck_assert(!set.Done && !set.Busy);
    ck_assert_double_eq_tol(info().actual_position, before + 100, 0.05);
    ck_assert_int_eq(info().state, CM1E_AXIS_DISCRETE_MOTION);
    await(move, 5);
    ck_assert_double_eq_tol(info().set_position, 103, 1e-9);
    set.ExecutionMode = mcQueued;
    set.Execute = TRUE;
    scan();
    ck_assert_uint_eq(set.ErrorID, id(CM1E_ERROR_UNSUPPORTED));
    ck_assert_msg(strstr(text(), "ExecutionMode is 1; 0 (mcImmediately) is right") != NULL, "%s", text());
    set.Execute = FALSE;
    scan();
    set.ExecutionMode = mcImmediately;
    set.Relative = FALSE;
    set.Position = NAN;
    set.Execute = TRUE;
    scan();
    ck_assert_uint_eq(set.ErrorID, id(CM1E_ERROR_AXIS_POSITION_RANGE));
    ck_assert_double_eq_tol(info().set_position, 103, 1e-9);
    ck_assert(strstr(text(), "MC_SetPosition"));
    set.Execute = FALSE;
    scan();
    set.Position = 0;
    set.Execute = TRUE;
    scans(2);
    ck_assert(set.Done);
    ck_assert_double_eq_tol(info().actual_position, 0, 1e-3);
    ck_assert_int_eq(info().state, CM1E_AXIS_STANDSTILL);
    close_segment();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("parameter blocks");
    TCase *tests = tcase_create("parameters");
    tcase_add_test(tests, parameters_of_the_axis_answer_at_once);
    tcase_add_test(tests, writing_is_busy_then_done_and_shown_for_one_call);
    tcase_add_test(tests, objects_of_the_drive_are_read_and_written_while_the_cycle_runs);
    tcase_add_test(tests, number_may_change_while_a_transfer_is_under_way);
    tcase_add_test(tests, objects_that_the_mapping_carries_are_not_written);
    tcase_add_test(tests, slave_that_is_gone_ends_a_transfer_with_an_error);
    tcase_add_test(tests, position_is_set_at_the_edge);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? 1 : 0;
}
