/* Vendor parameters: objects of the drive by number. */
#include "axis/axis_parameters.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../support/axis_bench.h"

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

static cm1e_command_state_t transfer(int number, bool write, double *value, cm1e_error_t *error)
{
    uint32_t ticket;
    *error = cm1e_axis_object_start(axis, number, write, *value, &ticket);
    TEST_ASSERT_EQUAL_INT(*error == CM1E_OK, ticket != 0);
    if (*error)
        return CM1E_COMMAND_UNKNOWN;
    TEST_ASSERT_EQUAL_INT(number, cm1e_axis_object_number(ticket));
    cm1e_command_state_t state;
    int n = 0;
    while ((state = cm1e_axis_object_state(axis, ticket, value, error)) < CM1E_COMMAND_DONE && n++ < 100)
        bench_cycles(1);
    return state;
}

static void test_every_vendor_number_is_an_object_of_the_dictionary(void)
{
    size_t count;
    const cm1e_axis_objects_t *table = cm1e_axis_object_table(&count);
    int before = CM1E_PARAMETER_VENDOR;
    for (size_t i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(table[i].first > before && table[i].last >= table[i].first && table[i].last <= INT16_MAX);
        for (int number = table[i].first; number <= table[i].last; number++) {
            const uint8_t subindex = (uint8_t)(table[i].subindex + number - table[i].first);
            const cm1e_entry_t *entry = cm1e_device_entry(table[i].index, subindex);
            if (table[i].index == OBJ_F530_SYSTEM_INFO) { /* of a bridge alone */
                uint32_t ticket;
                TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED,
                                      cm1e_axis_object_start(axis, number, false, 0, &ticket));
                continue;
            }
            TEST_ASSERT_NOT_NULL(entry);
            TEST_ASSERT_TRUE(entry->type != CM1E_TYPE_STRING);
            double value = 0;
            cm1e_error_t error;
            bus.sdo_read_bytes = entry->bits / 8;
            bus.sdo_read_value = 100 + (number & 7);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, transfer(number, false, &value, &error));
            const double mode = (double)bus.mode;
            TEST_ASSERT_EQUAL_DOUBLE(table[i].index == 0x6061 ? mode : 100 + (number & 7), value);
        }
        before = table[i].last;
    }
}

static void test_table_stands_in_the_documentation(void)
{
    FILE *file = fopen(CM1E_SOURCE_DIR "/docs/DEVICE.md", "rb");
    TEST_ASSERT_NOT_NULL(file);
    static char text[1 << 16];
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    size_t count;
    const cm1e_axis_objects_t *table = cm1e_axis_object_table(&count);
    for (size_t i = 0; i < count; i++) {
        char row[60];
        if (table[i].first == table[i].last)
            snprintf(row, sizeof row, "\n| %d | 0x%04X:%02X |", table[i].first, table[i].index, table[i].subindex);
        else
            snprintf(row, sizeof row, "\n| %d ... %d | 0x%04X:%02X ... %02X |", table[i].first, table[i].last,
                     table[i].index, table[i].subindex, table[i].subindex + table[i].last - table[i].first);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, row), row);
    }
}

static void test_signs_and_widths_are_the_objects(void)
{
    double value = 0;
    cm1e_error_t error;
    bus.sdo_read_bytes = 2;
    bus.sdo_read_value = -5;
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, transfer(1500, false, &value, &error)); /* INT */
    TEST_ASSERT_EQUAL_DOUBLE(-5, value);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, transfer(1021, false, &value, &error)); /* UINT */
    TEST_ASSERT_EQUAL_DOUBLE(65531, value);
    value = -3276700;
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, transfer(1400, true, &value, &error));
    const fake_sdo_entry_t *last = &bus.sdo_log[bus.sdo_count - 1];
    TEST_ASSERT_EQUAL_HEX16(0x607C, last->index);
    TEST_ASSERT_TRUE(last->write);
    TEST_ASSERT_EQUAL_INT64(-3276700, last->value);
    bus.sdo_read_bytes = 5; /* no number of ours */
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, transfer(1021, false, &value, &error));
}

static void test_wrong_writes_never_reach_the_drive(void)
{
    static const struct {
        int number;
        double value;
        cm1e_error_t error;
    } rows[] = {
        {1000, 1, CM1E_ERROR_AXIS_PARAMETER}, {1020, 1, CM1E_ERROR_AXIS_PARAMETER},
        {1102, 1, CM1E_ERROR_AXIS_PARAMETER}, {32767, 1, CM1E_ERROR_AXIS_PARAMETER},
        {1500, 1, CM1E_ERROR_AXIS_PARAMETER_READ_ONLY}, {1510, 1, CM1E_ERROR_AXIS_PARAMETER_READ_ONLY},
        {1701, 1, CM1E_ERROR_AXIS_PARAMETER_READ_ONLY}, {1047, 9, CM1E_ERROR_AXIS_PARAMETER_RANGE},
        {1047, 101, CM1E_ERROR_AXIS_PARAMETER_RANGE}, {1047, 30.5, CM1E_ERROR_AXIS_PARAMETER_RANGE},
        {1021, NAN, CM1E_ERROR_AXIS_PARAMETER_RANGE}, {1021, INFINITY, CM1E_ERROR_AXIS_PARAMETER_RANGE},
        {1021, -1, CM1E_ERROR_AXIS_PARAMETER_RANGE}, {1401, -7, CM1E_ERROR_AXIS_PARAMETER_RANGE},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        double value = rows[i].value;
        cm1e_error_t error;
        (void)transfer(rows[i].number, true, &value, &error);
        TEST_ASSERT_EQUAL_INT(rows[i].error, error);
        char text[400];
        cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "parameter "), text);
    }
    bench_cycles(10);
    TEST_ASSERT_EQUAL_UINT(0, bus.sdo_count);
}

static void test_abort_of_the_drive_is_told(void)
{
    bus.sdo_abort_index = 0x60F6;
    double value = 30;
    cm1e_error_t error;
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, transfer(1047, true, &value, &error));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_SDO_ABORT, error);
    char text[400];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "parameter 1047, object 0x60F6:1B"), text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "0x06090030"), text);
}

static void test_objects_of_later_firmware_are_unsupported(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_3);
    bench_create();
    double value = 0;
    cm1e_error_t error;
    (void)transfer(1301, false, &value, &error);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, error);
}

/* More than fit are refused; the others come in their order, also while the queue of the bus is full for a time. */
static void test_requests_wait_for_each_other(void)
{
    uint32_t tickets[OBJECT_REQUESTS];
    double value;
    cm1e_error_t error;
    bus.sdo_delay = 5;
    bus.sdo_full = true;
    for (int i = 0; i < OBJECT_REQUESTS - 1; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_object_start(axis, 1021 + i, true, i, &tickets[i]));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FULL, cm1e_axis_object_start(axis, 1021, false, 0, &tickets[7]));
    bench_cycles(20);
    bus.sdo_full = false;
    bench_cycles(200);
    TEST_ASSERT_EQUAL_UINT(OBJECT_REQUESTS - 1, bus.sdo_count);
    for (int i = 0; i < OBJECT_REQUESTS - 1; i++) {
        TEST_ASSERT_EQUAL_INT(i + 1, bus.sdo_log[i].subindex);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_axis_object_state(axis, tickets[i], &value, &error));
    }
    for (int i = 0; i < 100000; i++) { /* beyond the end of the sequence */
        uint32_t ticket;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_object_start(axis, 1100, true, i & 0xFFF, &ticket));
        bus.sdo_delay = 0;
        for (int n = 0; n < 4 && cm1e_axis_object_state(axis, ticket, &value, &error) != CM1E_COMMAND_DONE; n++) {
            fake_bus_cycle(&bus, cycle_ns);
            cm1e_axis_objects_step(axis);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_axis_object_state(axis, ticket, &value, &error));
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, cm1e_axis_object_state(axis, tickets[0], &value, &error));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_vendor_number_is_an_object_of_the_dictionary);
    RUN_TEST(test_table_stands_in_the_documentation);
    RUN_TEST(test_signs_and_widths_are_the_objects);
    RUN_TEST(test_wrong_writes_never_reach_the_drive);
    RUN_TEST(test_abort_of_the_drive_is_told);
    RUN_TEST(test_objects_of_later_firmware_are_unsupported);
    RUN_TEST(test_requests_wait_for_each_other);
    return UNITY_END();
}
