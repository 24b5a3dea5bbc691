/* The object dictionary of the simulated bridge: every row of BR appendix 6 with its availability, by SDO. */
#include "bridge_appendix_6.h"
#include "sim_bridge_bench.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
static const cm1e_device_model_t models[] = {CM1E_DEVICE_EB01, CM1E_DEVICE_EB02, CM1E_DEVICE_EB12};
enum { MODELS = 3 };
enum {
    UNSUPPORTED = 0x06010000, WRITE_TO_READ_ONLY = 0x06010002, SUBINDEX_0_NOT_0 = 0x06010003, NO_OBJECT = 0x06020000,
    NOT_MAPPABLE = 0x06040041, TOO_LONG = 0x06070012, TOO_SHORT = 0x06070013, NO_SUBINDEX = 0x06090011,
    TOO_HIGH = 0x06090031, TOO_LOW = 0x06090032, WRONG_STATE = 0x08000022,
};

static bench_t b;

void setUp(void) {}
void tearDown(void) { bench_close(&b); }

static void open_model(cm1e_device_model_t model)
{
    bench_open(&b, model);
    b.ops->state_change(b.bridge, BENCH_OP, BENCH_PREOP);
}

/* ---- appendix 6 ------------------------------------------------------------------------------------------------- */

static uint32_t expected_code(enum appendix_availability availability)
{
    return availability == A ? 0 : availability == N ? UNSUPPORTED : NO_SUBINDEX;
}

static void check_read(const appendix_row_t *row, uint16_t index, bool cm2)
{
    char where[64];
    snprintf(where, sizeof where, "%s %04X:%02X", cm1e_bridge_name(b.bridge->model), index, row->subindex);
    uint8_t data[128];
    size_t size = sizeof data;
    /* 0x60FB is "CM2 Only" (BR 7.5). */
    const uint32_t code = expected_code(row->index == 0x60FB && !cm2 ? N : cm2 ? row->cm2 : row->cm1);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(
        code, b.ops->sdo_read(b.bridge, index, row->subindex, BENCH_PREOP, data, &size), where);
    const bool mapping = index >= 0x1600 && index < 0x1C00;
    const bool count = row->subindex == 0 && (row->index == 0x60F6 || row->index == 0x60FB);
    if (code == 0 && row->bits != TEXT && !mapping && !count)
        TEST_ASSERT_EQUAL_size_t_MESSAGE((row->bits + 7u) / 8u, size, where);
    if (code != 0)
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(code, bench_try_write(&b, index, row->subindex, 1), where);
    else if (row->attribute == RO && !(row->index == 0x1C12 || row->index == 0x1C13))
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(WRITE_TO_READ_ONLY, bench_try_write(&b, index, row->subindex, 1), where);
}

static void test_every_row_of_the_appendix_answers_as_available_as_it_is(void)
{
    for (int m = 0; m < MODELS; m++) {
        open_model(models[m]);
        for (size_t i = 0; i < COUNT(appendix_of_device); i++)
            check_read(&appendix_of_device[i], appendix_of_device[i].index, false);
        for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
            for (size_t i = 0; i < COUNT(appendix_of_axis); i++)
                check_read(&appendix_of_axis[i], (uint16_t)(appendix_of_axis[i].index + 0x800 * axis),
                           cm1e_bridge_motor(models[m], axis) == CM1E_BRIDGE_CM2);
        bench_close(&b);
    }
}

static void test_what_is_not_in_the_appendix_is_not_there(void)
{
    int64_t value;
    open_model(CM1E_DEVICE_EB12);
    TEST_ASSERT_EQUAL_HEX32(NO_OBJECT, bench_try_read(&b, 0x2201, 1, &value));
    TEST_ASSERT_EQUAL_HEX32(NO_OBJECT, bench_try_read(&b, 0x8040, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(NO_SUBINDEX, bench_try_read(&b, 0xF530, 25, &value));
    TEST_ASSERT_EQUAL_HEX32(NO_SUBINDEX, bench_try_read(&b, 0x1C32, 3, &value));
    TEST_ASSERT_EQUAL_HEX32(NO_OBJECT, bench_try_write(&b, 0x2201, 1, 0));
}

static void test_every_object_of_the_tables_is_told(void)
{
    open_model(CM1E_DEVICE_EB12);
    size_t n = 0;
    for (const cm1e_object_t *object; (object = cm1e_bridge_object(CM1E_DEVICE_EB12, n)) != NULL; n++)
        TEST_ASSERT_EQUAL_PTR(object, b.ops->object(b.bridge, n));
    TEST_ASSERT_NULL(b.ops->object(b.bridge, n));
}

/* ---- values ----------------------------------------------------------------------------------------------------- */

static void test_identity_modules_and_motors(void)
{
    open_model(CM1E_DEVICE_EB12);
    uint8_t name[8];
    size_t size = sizeof name;
    TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_read(b.bridge, 0x1008, 0, BENCH_PREOP, name, &size));
    TEST_ASSERT_EQUAL_STRING_LEN("EB12", name, size);
    TEST_ASSERT_EQUAL_HEX32(0xAA77, bench_read(&b, 0x1018, 1));
    TEST_ASSERT_EQUAL_HEX32(0xEB12, bench_read(&b, 0x1018, 2));
    TEST_ASSERT_EQUAL_HEX32(0x40192, bench_read(&b, 0x1000, 0));
    TEST_ASSERT_EQUAL_HEX32(0x800, bench_read(&b, 0xF000, 1));
    TEST_ASSERT_EQUAL_HEX32(0x219800, bench_read(&b, 0xF050, 3));
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        TEST_ASSERT_EQUAL(axis < 2 ? 1 : 2, bench_read(&b, (uint16_t)(0xF511 + axis), 1));
    TEST_ASSERT_EQUAL(1, bench_read(&b, 0xF540, 6)); /* ms: "1 msec, not changeable" (BR 7.3) */
}

static void test_three_objects_are_k_parameters_by_another_name(void)
{
    static const struct {
        uint16_t index;
        uint8_t subindex, k;
        int64_t value;
    } rows[] = {{0x607C, 0, 48, -12}, {0x6099, 1, 42, 300}, {0x6099, 2, 42, 301}, {0x609A, 0, 43, 77}};
    open_model(CM1E_DEVICE_EB02);
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        for (size_t i = 0; i < COUNT(rows); i++) {
            const uint16_t offset = (uint16_t)(0x800 * axis), index = (uint16_t)(rows[i].index + offset);
            const uint16_t k = (uint16_t)(0x60F6 + offset);
            bench_write(&b, index, rows[i].subindex, rows[i].value);
            TEST_ASSERT_EQUAL_INT64(rows[i].value, bench_read(&b, k, (uint8_t)(rows[i].k - 20)));
            bench_write(&b, k, (uint8_t)(rows[i].k - 20), 5);
            TEST_ASSERT_EQUAL_INT64(5, bench_read(&b, index, rows[i].subindex));
        }
    TEST_ASSERT_EQUAL(2, bench_read(&b, 0x6099, 0));
}

static void test_ranges_are_those_of_the_motor(void)
{
    open_model(CM1E_DEVICE_EB12);
    TEST_ASSERT_EQUAL_HEX32(TOO_HIGH, bench_try_write(&b, 0x6099, 1, 5001));  /* CM1 */
    TEST_ASSERT_EQUAL_HEX32(0, bench_try_write(&b, 0x7099, 1, 32767));        /* CM2 */
    TEST_ASSERT_EQUAL_HEX32(TOO_HIGH, bench_try_write(&b, 0x7099, 1, 32768));
    TEST_ASSERT_EQUAL_HEX32(TOO_LOW, bench_try_write(&b, 0x7098, 0, 0));
    TEST_ASSERT_EQUAL_HEX32(TOO_HIGH, bench_try_write(&b, 0x7098, 0, 5));
    TEST_ASSERT_EQUAL(100, bench_read(&b, 0x6099, 1));
    TEST_ASSERT_EQUAL(10, bench_read(&b, 0x7899, 1));
}

static void test_a_number_must_have_its_size(void)
{
    const uint8_t zeros[8] = {0};
    open_model(CM1E_DEVICE_EB01);
    TEST_ASSERT_EQUAL_HEX32(TOO_LONG, b.ops->sdo_write(b.bridge, 0x609A, 0, BENCH_PREOP, zeros, 5));
    TEST_ASSERT_EQUAL_HEX32(TOO_SHORT, b.ops->sdo_write(b.bridge, 0x609A, 0, BENCH_PREOP, zeros, 2));
    TEST_ASSERT_EQUAL_size_t(1, (b.ops->entry(b.bridge, 0x1C32, 32)->bits + 7u) / 8u); /* a BOOL of one bit */
}

static void test_cml_strings_are_refused_outside_of_their_mode(void)
{
    uint8_t answer[64];
    open_model(CM1E_DEVICE_EB12);
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++) {
        const uint16_t command = (uint16_t)(0xF581 + axis), response = (uint16_t)(0xF591 + axis);
        size_t size = sizeof answer;
        TEST_ASSERT_EQUAL_HEX32(WRONG_STATE,
                                b.ops->sdo_write(b.bridge, command, 0, BENCH_OP, (const uint8_t *)"?99.1", 5));
        TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_read(b.bridge, response, 0, BENCH_OP, answer, &size));
        TEST_ASSERT_EQUAL_size_t(6, size);
        TEST_ASSERT_EQUAL_MEMORY("Null\r\n", answer, 6);
        TEST_ASSERT_EQUAL_HEX32(WRITE_TO_READ_ONLY, b.ops->sdo_write(b.bridge, response, 0, BENCH_OP, answer, 6));
    }
}

static void test_motors_keep_their_parameters_over_a_power_cycle_and_the_bridge_does_not(void)
{
    open_model(CM1E_DEVICE_EB02);
    bench_write(&b, 0x68F6, 0x1B, 45);
    bench_write(&b, 0x68FB, 1, 9);
    bench_write(&b, 0x6898, 0, 3);
    bench_write(&b, 0x10F1, 2, 4);
    b.ops->power_on(b.bridge, b.now_ns);
    TEST_ASSERT_EQUAL(45, bench_read(&b, 0x68F6, 0x1B));
    TEST_ASSERT_EQUAL(9, bench_read(&b, 0x68FB, 1));
    TEST_ASSERT_EQUAL(1, bench_read(&b, 0x6898, 0));
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0x10F1, 2));
    TEST_ASSERT_EQUAL_HEX32(0xEB02, bench_read(&b, 0x1018, 2));
}

/* ---- assignment ------------------------------------------------------------------------------------------------- */

static void test_the_default_assignment_is_four_axes(void)
{
    uint16_t outputs, inputs;
    open_model(CM1E_DEVICE_EB01);
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++) {
        TEST_ASSERT_EQUAL_HEX16(0x1601 + 0x10 * axis, bench_read(&b, 0x1C12, (uint8_t)(axis + 1)));
        TEST_ASSERT_EQUAL_HEX16(0x1A01 + 0x10 * axis, bench_read(&b, 0x1C13, (uint8_t)(axis + 1)));
        TEST_ASSERT_EQUAL_HEX32((0x6040 + 0x800 * axis) << 16 | 16,
                                bench_read(&b, (uint16_t)(0x1601 + 0x10 * axis), 1));
    }
    b.ops->process_data_sizes(b.bridge, &outputs, &inputs);
    TEST_ASSERT_EQUAL(24, outputs);
    TEST_ASSERT_EQUAL(24, inputs);
}

static void test_an_assignment_is_written_as_coe_has_it(void)
{
    uint16_t outputs, inputs;
    open_model(CM1E_DEVICE_EB01);
    TEST_ASSERT_EQUAL_HEX32(SUBINDEX_0_NOT_0, bench_try_write(&b, 0x1C12, 1, 0x1611));
    bench_write(&b, 0x1C12, 0, 0);
    TEST_ASSERT_EQUAL_HEX32(NOT_MAPPABLE, bench_try_write(&b, 0x1C12, 1, 0x1600)); /* N/A */
    TEST_ASSERT_EQUAL_HEX32(NOT_MAPPABLE, bench_try_write(&b, 0x1C12, 1, 0x1A01));
    TEST_ASSERT_EQUAL_HEX32(NOT_MAPPABLE, bench_try_write(&b, 0x1C12, 1, 0x6040));
    bench_write(&b, 0x1C12, 1, 0x1631);
    TEST_ASSERT_EQUAL_HEX32(NOT_MAPPABLE, bench_try_write(&b, 0x1C12, 0, 4)); /* 0x1631 twice */
    TEST_ASSERT_EQUAL_HEX32(TOO_HIGH, bench_try_write(&b, 0x1C12, 0, 5));
    bench_write(&b, 0x1C12, 0, 2); /* 1631, 1611 */
    b.ops->process_data_sizes(b.bridge, &outputs, &inputs);
    TEST_ASSERT_EQUAL(12, outputs);
    TEST_ASSERT_EQUAL(24, inputs);
    uint8_t out[12] = {0};
    cm1e_put_u32(out + 2, 4444);
    cm1e_put_u32(out + 8, 2222);
    b.ops->outputs(b.bridge, out, sizeof out, b.now_ns);
    bench_wait(&b, BENCH_MS);
    TEST_ASSERT_EQUAL(4444, bench_read(&b, 0x787A, 0));
    TEST_ASSERT_EQUAL(2222, bench_read(&b, 0x687A, 0));
    b.ops->state_change(b.bridge, BENCH_PREOP, BENCH_SAFEOP);
    TEST_ASSERT_EQUAL_HEX32(WRONG_STATE, bench_try_write(&b, 0x1C12, 0, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_row_of_the_appendix_answers_as_available_as_it_is);
    RUN_TEST(test_what_is_not_in_the_appendix_is_not_there);
    RUN_TEST(test_every_object_of_the_tables_is_told);
    RUN_TEST(test_identity_modules_and_motors);
    RUN_TEST(test_three_objects_are_k_parameters_by_another_name);
    RUN_TEST(test_ranges_are_those_of_the_motor);
    RUN_TEST(test_a_number_must_have_its_size);
    RUN_TEST(test_cml_strings_are_refused_outside_of_their_mode);
    RUN_TEST(test_motors_keep_their_parameters_over_a_power_cycle_and_the_bridge_does_not);
    RUN_TEST(test_the_default_assignment_is_four_axes);
    RUN_TEST(test_an_assignment_is_written_as_coe_has_it);
    return UNITY_END();
}
