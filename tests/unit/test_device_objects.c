#include <stdio.h>
#include <string.h>

#include "device/device.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static char place[80];
static const char *at(const cm1e_entry_t *entry)
{
    snprintf(place, sizeof place, "object %04X:%02X", entry->index, entry->subindex);
    return place;
}

static void test_objects_are_sorted_without_doubles(void)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    TEST_ASSERT_GREATER_THAN(50, count);
    for (size_t i = 1; i < count; i++)
        TEST_ASSERT_GREATER_THAN_HEX16(objects[i - 1].index, objects[i].index);
}

static void test_entries_are_sorted_and_belong_to_their_object(void)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++) {
        const cm1e_object_t *object = &objects[i];
        TEST_ASSERT_GREATER_THAN(0, object->entry_count);
        TEST_ASSERT_NOT_NULL(object->name);
        TEST_ASSERT_EQUAL(0, object->entries[0].subindex);
        for (unsigned k = 0; k < object->entry_count; k++) {
            const cm1e_entry_t *entry = &object->entries[k];
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(object->index, entry->index, at(entry));
            TEST_ASSERT_TRUE_MESSAGE(entry->since >= object->since && entry->since < CM1E_FIRMWARE_COUNT, at(entry));
            if (k > 0)
                TEST_ASSERT_TRUE_MESSAGE(object->entries[k - 1].subindex < entry->subindex, at(entry));
        }
        const cm1e_entry_t *last = &object->entries[object->entry_count - 1];
        TEST_ASSERT_EQUAL_MESSAGE(object->highest_subindex, last->subindex, at(last));
    }
}

static void test_what_can_be_written_has_a_meaning_with_its_clause(void)
{
    size_t count;
    unsigned settings = 0;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++)
        for (unsigned k = 0; k < objects[i].entry_count; k++) {
            const cm1e_entry_t *entry = &objects[i].entries[k];
            const bool writable = entry->access & CM1E_ACCESS_WRITE;
            TEST_ASSERT_EQUAL_MESSAGE(writable, entry->meaning != NULL, at(entry));
            if (!writable)
                TEST_ASSERT_EQUAL_MESSAGE(CM1E_USE_COMMAND, entry->use, at(entry));
            else
                TEST_ASSERT_NOT_NULL_MESSAGE(strstr(entry->meaning, "(UG "), at(entry));
            settings += entry->use != CM1E_USE_COMMAND;
        }
    TEST_ASSERT_EQUAL(4 + 7 + 81 + 9 + 1, settings); /* option codes, motion and homing, K, H, LED */
}

static void test_object_code_fits_the_entries(void)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++) {
        const cm1e_object_t *object = &objects[i];
        const cm1e_entry_t *first = &object->entries[0];
        if (object->object_code == CM1E_OBJECT_VAR) {
            TEST_ASSERT_EQUAL_MESSAGE(1, object->entry_count, at(first));
            TEST_ASSERT_EQUAL_STRING_MESSAGE(object->name, first->name, at(first));
        } else {
            TEST_ASSERT_TRUE_MESSAGE(
                object->object_code == CM1E_OBJECT_ARRAY || object->object_code == CM1E_OBJECT_RECORD, at(first));
            TEST_ASSERT_GREATER_THAN_MESSAGE(1, object->entry_count, at(first));
            TEST_ASSERT_EQUAL_MESSAGE(object->highest_subindex, first->default_value, at(first));
        }
    }
}

static int64_t type_minimum(cm1e_data_type_t type)
{
    switch (type) {
    case CM1E_TYPE_SINT: return INT8_MIN;
    case CM1E_TYPE_INT: return INT16_MIN;
    case CM1E_TYPE_DINT: return INT32_MIN;
    default: return 0;
    }
}

static int64_t type_maximum(cm1e_data_type_t type)
{
    switch (type) {
    case CM1E_TYPE_SINT: return INT8_MAX;
    case CM1E_TYPE_INT: return INT16_MAX;
    case CM1E_TYPE_DINT: return INT32_MAX;
    case CM1E_TYPE_USINT: return UINT8_MAX;
    case CM1E_TYPE_UINT: return UINT16_MAX;
    case CM1E_TYPE_UDINT: return UINT32_MAX;
    default: return 0;
    }
}

static unsigned type_bits(cm1e_data_type_t type)
{
    switch (type) {
    case CM1E_TYPE_SINT: case CM1E_TYPE_USINT: return 8;
    case CM1E_TYPE_INT: case CM1E_TYPE_UINT: return 16;
    case CM1E_TYPE_DINT: case CM1E_TYPE_UDINT: return 32;
    default: return 0;
    }
}

static void test_every_entry_default_lies_in_range_and_range_in_type(void)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++)
        for (unsigned k = 0; k < objects[i].entry_count; k++) {
            const cm1e_entry_t *entry = &objects[i].entries[k];
            TEST_ASSERT_NOT_NULL_MESSAGE(entry->name, at(entry));
            TEST_ASSERT_NOT_NULL_MESSAGE(entry->unit, at(entry));
            TEST_ASSERT_TRUE_MESSAGE(entry->access & CM1E_ACCESS_READ, at(entry));
            if (entry->type == CM1E_TYPE_STRING) {
                TEST_ASSERT_NOT_NULL_MESSAGE(entry->default_string, at(entry));
                TEST_ASSERT_EQUAL_MESSAGE(8 * strlen(entry->default_string), entry->bits, at(entry));
                continue;
            }
            TEST_ASSERT_NULL_MESSAGE(entry->default_string, at(entry));
            TEST_ASSERT_EQUAL_MESSAGE(type_bits(entry->type), entry->bits, at(entry));
            TEST_ASSERT_TRUE_MESSAGE(type_minimum(entry->type) <= entry->minimum, at(entry));
            TEST_ASSERT_TRUE_MESSAGE(entry->maximum <= type_maximum(entry->type), at(entry));
            TEST_ASSERT_TRUE_MESSAGE(entry->minimum <= entry->default_value, at(entry));
            TEST_ASSERT_TRUE_MESSAGE(entry->default_value <= entry->maximum, at(entry));
        }
}

static void test_rounding_never_leaves_the_range(void)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++)
        for (unsigned k = 0; k < objects[i].entry_count; k++) {
            const cm1e_entry_t *entry = &objects[i].entries[k];
            if (entry->type == CM1E_TYPE_STRING)
                continue;
            TEST_ASSERT_TRUE_MESSAGE(cm1e_entry_round(entry, entry->maximum) <= entry->maximum, at(entry));
            TEST_ASSERT_TRUE_MESSAGE(cm1e_entry_round(entry, entry->minimum) >= entry->minimum, at(entry));
        }
}

static void test_every_entry_is_found_and_nothing_else(void)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    size_t entries = 0, found = 0;
    for (size_t i = 0; i < count; i++)
        entries += objects[i].entry_count;
    for (uint32_t index = 0; index <= 0xFFFF; index++)
        for (unsigned sub = 0; sub <= 0xFF; sub++) {
            const cm1e_entry_t *entry = cm1e_device_entry((uint16_t)index, (uint8_t)sub);
            if (!entry)
                continue;
            found++;
            TEST_ASSERT_EQUAL_HEX16(index, entry->index);
            TEST_ASSERT_EQUAL_HEX8(sub, entry->subindex);
        }
    TEST_ASSERT_EQUAL(entries, found);
}

/* The manual's tables, restated: UG 7.1, 7.3, 7.4, defaults of UG 7.5. */
static const struct {
    uint16_t index;
    uint8_t subindex;
    cm1e_data_type_t type;
    const char *access; /* as in the manual, P: PDO mapping */
    int64_t value;
} manual[] = {
    {0x1000, 0, CM1E_TYPE_UDINT, "ro", 0x00040192},
    {0x1001, 0, CM1E_TYPE_USINT, "ro", 0},
    {0x1018, 0, CM1E_TYPE_USINT, "ro", 4},
    {0x1018, 1, CM1E_TYPE_UDINT, "ro", 0x4441},
    {0x1018, 2, CM1E_TYPE_UDINT, "ro", 0x44412002},
    {0x1018, 3, CM1E_TYPE_UDINT, "ro", 0x20020103},
    {0x1018, 4, CM1E_TYPE_UDINT, "ro", 0},
    {0x1C12, 1, CM1E_TYPE_UINT, "rw", 0x1600},
    {0x1C13, 1, CM1E_TYPE_UINT, "rw", 0x1A00},
    {0x1C32, 0, CM1E_TYPE_USINT, "ro", 32},
    {0x1C33, 0, CM1E_TYPE_USINT, "ro", 32},
    {0x2201, 0, CM1E_TYPE_UINT, "ro", 4},
    {0x2201, 1, CM1E_TYPE_DINT, "rw", 0},
    {0x2201, 4, CM1E_TYPE_DINT, "rw", 0},
    {0x2301, 0, CM1E_TYPE_INT, "roP", 54},
    {0x603F, 0, CM1E_TYPE_UINT, "roP", 0},
    {0x6040, 0, CM1E_TYPE_UINT, "rwP", 0},
    {0x6041, 0, CM1E_TYPE_UINT, "roP", 0x0230},
    {0x605A, 0, CM1E_TYPE_INT, "rw", 2},
    {0x605B, 0, CM1E_TYPE_INT, "rw", 0},
    {0x605C, 0, CM1E_TYPE_INT, "rw", 1},
    {0x605E, 0, CM1E_TYPE_INT, "rw", 0},
    {0x6060, 0, CM1E_TYPE_SINT, "rwP", 0},
    {0x6061, 0, CM1E_TYPE_SINT, "roP", 0},
    {0x6064, 0, CM1E_TYPE_DINT, "roP", 0},
    {0x606C, 0, CM1E_TYPE_DINT, "roP", 0},
    {0x6072, 0, CM1E_TYPE_UINT, "roP", 0x04E2},
    {0x6073, 0, CM1E_TYPE_UINT, "ro", 0x04B0},
    {0x6075, 0, CM1E_TYPE_UDINT, "ro", 0x5DC},
    {0x6076, 0, CM1E_TYPE_UDINT, "roP", 0x168},
    {0x6077, 0, CM1E_TYPE_INT, "roP", 0},
    {0x6079, 0, CM1E_TYPE_DINT, "roP", 238},
    {0x607A, 0, CM1E_TYPE_DINT, "rwP", 0},
    {0x607C, 0, CM1E_TYPE_DINT, "rw", 0},
    {0x6081, 0, CM1E_TYPE_UDINT, "rwP", 0},
    {0x6083, 0, CM1E_TYPE_UDINT, "rwP", 0},
    {0x6084, 0, CM1E_TYPE_UDINT, "rw", 0x19},
    {0x6098, 0, CM1E_TYPE_SINT, "rw", 0},
    {0x6099, 0, CM1E_TYPE_SINT, "ro", 2},
    {0x6099, 1, CM1E_TYPE_UDINT, "rw", 50000},
    {0x6099, 2, CM1E_TYPE_UDINT, "rw", 0},
    {0x609A, 0, CM1E_TYPE_UDINT, "rw", 0x186A0},
    {0x60F6, 0, CM1E_TYPE_USINT, "ro", 0x51},
    {0x60F6, 0x01, CM1E_TYPE_UINT, "rw", 0},
    {0x60F6, 0x1B, CM1E_TYPE_UINT, "rw", 30},
    {0x60F6, 0x51, CM1E_TYPE_UINT, "rw", 0},
    {0x60FB, 0, CM1E_TYPE_UINT, "ro", 9},
    {0x60FB, 1, CM1E_TYPE_INT, "rw", 0},
    {0x60FB, 9, CM1E_TYPE_INT, "rw", 0},
    {0x60FD, 0, CM1E_TYPE_UINT, "roP", 0},
    {0x60FE, 0, CM1E_TYPE_UINT, "rwP", 0},
    {0x60FF, 0, CM1E_TYPE_DINT, "rwP", 0},
    {0x6502, 0, CM1E_TYPE_UDINT, "ro", 0x1A5},
    {0xFE00, 0, CM1E_TYPE_UINT, "ro", 4},
    {0xFE00, 1, CM1E_TYPE_UINT, "ro", 0},
    {0xFE00, 4, CM1E_TYPE_UINT, "ro", 0},
    {0xFF00, 0, CM1E_TYPE_SINT, "rw", 1},
    {0xFF01, 0, CM1E_TYPE_UDINT, "rw", 0},
};

static void test_types_access_and_defaults_are_the_manuals(void)
{
    for (size_t i = 0; i < sizeof manual / sizeof manual[0]; i++) {
        const cm1e_entry_t *entry = cm1e_device_entry(manual[i].index, manual[i].subindex);
        snprintf(place, sizeof place, "object %04X:%02X", manual[i].index, manual[i].subindex);
        TEST_ASSERT_NOT_NULL_MESSAGE(entry, place);
        TEST_ASSERT_EQUAL_MESSAGE(manual[i].type, entry->type, place);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(manual[i].value, entry->default_value, place);
        const bool writable = manual[i].access[1] == 'w', mappable = manual[i].access[2] == 'P';
        TEST_ASSERT_EQUAL_MESSAGE(writable, (entry->access & CM1E_ACCESS_WRITE) != 0, place);
        TEST_ASSERT_EQUAL_MESSAGE(mappable && writable, (entry->access & CM1E_ACCESS_RXPDO) != 0, place);
        TEST_ASSERT_EQUAL_MESSAGE(mappable && !writable, (entry->access & CM1E_ACCESS_TXPDO) != 0, place);
    }
}

static void test_names_of_the_device_are_the_manuals(void)
{
    TEST_ASSERT_EQUAL_STRING("CM1-E", cm1e_device_entry(0x1008, 0)->default_string);
    TEST_ASSERT_EQUAL_STRING("MYO28-02A", cm1e_device_entry(0x1009, 0)->default_string);
    TEST_ASSERT_EQUAL_STRING("1.3.5", cm1e_device_entry(0x100A, 0)->default_string);
}

static void test_k_parameters_number_is_subindex_plus_20(void)
{
    for (int sub = 1; sub <= 0x51; sub++) {
        char name[16];
        snprintf(name, sizeof name, "K%d", sub + 20);
        TEST_ASSERT_EQUAL_STRING(name, cm1e_device_entry(0x60F6, (uint8_t)sub)->name);
    }
    TEST_ASSERT_NULL(cm1e_device_entry(0x60F6, 0x52));
}

static void test_pdo_assignment_is_writable_before_safe_operational_only(void)
{
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++)
        for (unsigned k = 0; k < objects[i].entry_count; k++) {
            const cm1e_entry_t *entry = &objects[i].entries[k];
            const bool assignment = entry->index == 0x1C12 || entry->index == 0x1C13;
            TEST_ASSERT_EQUAL_MESSAGE(assignment, (entry->access & CM1E_ACCESS_WRITE_PREOP_ONLY) != 0, at(entry));
        }
}

/* UG 6.2.2, 6.2.4, 6.3, 7.4.4 */
static const struct {
    uint16_t index;
    uint8_t subindex;
    int64_t minimum, maximum;
} ranges[] = {
    {0x607C, 0, -3276700, 3276700}, {0x6098, 0, -6, 0},         {0x6099, 1, 1000, 500000},
    {0x609A, 0, 1000, 5000000},     {0x60F6, 0x1B, 10, 100},    {0x6081, 0, 0, 2500000},
    {0x6083, 0, 0, 32767000},       {0x6084, 0, 0, 32767000},   {0x60FF, 0, -2500000, 2500000},
    {0xFF00, 0, 0, 16},             {0x607A, 0, INT32_MIN, INT32_MAX}, {0x1C12, 1, 0x1600, 0x1603},
    {0x1C13, 1, 0x1A00, 0x1A03},
};

static void test_ranges_are_the_manuals(void)
{
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        const cm1e_entry_t *entry = cm1e_device_entry(ranges[i].index, ranges[i].subindex);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(ranges[i].minimum, entry->minimum, at(entry));
        TEST_ASSERT_EQUAL_INT64_MESSAGE(ranges[i].maximum, entry->maximum, at(entry));
    }
}

static const struct {
    uint16_t index;
    uint8_t subindex;
    int64_t value, kept;
} roundings[] = {
    {0x607C, 0, 0, 0},           {0x607C, 0, 49, 0},           {0x607C, 0, 50, 100},         {0x607C, 0, -49, 0},
    {0x607C, 0, -50, -100},      {0x607C, 0, -51, -100},       {0x607C, 0, 149, 100},        {0x607C, 0, -150, -200},
    {0x607C, 0, 3276700, 3276700}, {0x607C, 0, -3276700, -3276700}, {0x6099, 1, 1000, 1000}, {0x6099, 1, 1049, 1000},
    {0x6099, 1, 1050, 1100},     {0x6099, 1, 499999, 500000},  {0x609A, 0, 1499, 1000},      {0x609A, 0, 1500, 2000},
    {0x609A, 0, 5000000, 5000000}, {0x6083, 0, 0, 1000},       {0x6083, 0, 499, 1000},       {0x6083, 0, 999, 1000},
    {0x6083, 0, 1499, 1000},     {0x6083, 0, 1500, 2000},      {0x6083, 0, 32766500, 32767000}, {0x6084, 0, 25, 1000},
    {0x6084, 0, 25499, 25000},   {0x607A, 0, 12345, 12345},    {0x607A, 0, -12345, -12345},  {0x60F6, 0x1B, 33, 33},
};

static void test_rounding_is_to_the_closest_half_away_from_zero(void)
{
    for (size_t i = 0; i < sizeof roundings / sizeof roundings[0]; i++) {
        const cm1e_entry_t *entry = cm1e_device_entry(roundings[i].index, roundings[i].subindex);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(roundings[i].kept, cm1e_entry_round(entry, roundings[i].value), at(entry));
    }
}

static void test_rounding_of_all_home_offsets_is_closest_and_odd(void)
{
    const cm1e_entry_t *entry = cm1e_device_entry(0x607C, 0);
    for (int64_t value = -3276700; value <= 3276700; value += 7) {
        const int64_t kept = cm1e_entry_round(entry, value);
        const int64_t off = kept > value ? kept - value : value - kept;
        if (kept % 100 != 0 || off > 50 || cm1e_entry_round(entry, -value) != -kept)
            TEST_FAIL_MESSAGE("wrong rounding");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_objects_are_sorted_without_doubles);
    RUN_TEST(test_entries_are_sorted_and_belong_to_their_object);
    RUN_TEST(test_what_can_be_written_has_a_meaning_with_its_clause);
    RUN_TEST(test_object_code_fits_the_entries);
    RUN_TEST(test_every_entry_default_lies_in_range_and_range_in_type);
    RUN_TEST(test_rounding_never_leaves_the_range);
    RUN_TEST(test_every_entry_is_found_and_nothing_else);
    RUN_TEST(test_types_access_and_defaults_are_the_manuals);
    RUN_TEST(test_names_of_the_device_are_the_manuals);
    RUN_TEST(test_k_parameters_number_is_subindex_plus_20);
    RUN_TEST(test_pdo_assignment_is_writable_before_safe_operational_only);
    RUN_TEST(test_ranges_are_the_manuals);
    RUN_TEST(test_rounding_is_to_the_closest_half_away_from_zero);
    RUN_TEST(test_rounding_of_all_home_offsets_is_closest_and_odd);
    return UNITY_END();
}
