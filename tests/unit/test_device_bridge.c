#include <stdio.h>
#include <string.h>

#include "bridge_appendix_6.h"
#include "device/bridge_facts.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

#define COUNT(array) (sizeof(array) / sizeof *(array))
static const cm1e_device_model_t models[] = {CM1E_DEVICE_EB01, CM1E_DEVICE_EB02, CM1E_DEVICE_EB12};
enum { MODELS = 3 };

static char place[80];
static const char *at(cm1e_device_model_t model, unsigned index, unsigned subindex)
{
    snprintf(place, sizeof place, "%s %04X:%02X", cm1e_bridge_name(model), index, subindex);
    return place;
}

/* ---- appendix 6 ------------------------------------------------------------------------------------------------- */

static bool is_mapping_object(uint16_t index) { return index >= 0x1600 && index < 0x1C00; }

/* What the tables decide where the appendix cannot be right (docs/DEVICE.md). */
static appendix_row_t corrected(appendix_row_t row)
{
    if (is_mapping_object(row.index) && row.subindex > 0)
        row.bits = 32;
    if (row.subindex == 0 && (row.index == 0x60F6 || row.index == 0x60FB))
        row.bits = 8, row.attribute = RO;
    if (row.subindex == 0 && (row.index == 0x1C12 || row.index == 0x1C13))
        row.attribute = RW;
    if (row.index == 0x60FB)
        row.cm1 = N; /* "CM2 Only" */
    return row;
}

static void check_row(cm1e_device_model_t model, const appendix_row_t *as_written, uint16_t index, bool cm2)
{
    static const cm1e_availability_t availability[] = {CM1E_AVAILABLE, CM1E_NOT_AVAILABLE, CM1E_NO_PARAMETER};
    const appendix_row_t row = corrected(*as_written);
    const cm1e_entry_t *entry = cm1e_bridge_entry(model, index, row.subindex);
    const char *where = at(model, index, row.subindex);
    TEST_ASSERT_NOT_NULL_MESSAGE(entry, where);
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(index, entry->index, where);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(row.subindex, entry->subindex, where);
    if (row.bits == TEXT)
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_TYPE_STRING, entry->type, where);
    else
        TEST_ASSERT_EQUAL_MESSAGE(row.bits, entry->bits, where);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(row.attribute, entry->access & (CM1E_ACCESS_READ | CM1E_ACCESS_WRITE), where);
    TEST_ASSERT_EQUAL_MESSAGE(availability[cm2 ? row.cm2 : row.cm1], entry->availability, where);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(row.name, entry->name, where);
}

static void test_every_row_of_the_appendix_is_in_every_model(void)
{
    for (int m = 0; m < MODELS; m++) {
        for (size_t i = 0; i < COUNT(appendix_of_device); i++)
            check_row(models[m], &appendix_of_device[i], appendix_of_device[i].index, false);
        for (unsigned axis = 0; axis < 4; axis++)
            for (size_t i = 0; i < COUNT(appendix_of_axis); i++)
                check_row(models[m], &appendix_of_axis[i], (uint16_t)(appendix_of_axis[i].index + 0x800 * axis),
                          cm1e_bridge_motor(models[m], axis) == CM1E_BRIDGE_CM2);
    }
}

static void test_no_model_has_more_than_the_appendix(void)
{
    for (int m = 0; m < MODELS; m++) {
        size_t entries = 0;
        const cm1e_object_t *object;
        for (size_t n = 0; (object = cm1e_bridge_object(models[m], n)) != NULL; n++)
            entries += object->entry_count;
        TEST_ASSERT_EQUAL(COUNT(appendix_of_device) + 4 * COUNT(appendix_of_axis), entries);
    }
}

/* ---- the tables themselves -------------------------------------------------------------------------------------- */

static void test_objects_are_sorted_and_hold_their_entries(void)
{
    for (int m = 0; m < MODELS; m++) {
        const cm1e_object_t *object, *before = NULL;
        for (size_t n = 0; (object = cm1e_bridge_object(models[m], n)) != NULL; before = object, n++) {
            const char *where = at(models[m], object->index, 0);
            if (before)
                TEST_ASSERT_GREATER_THAN_HEX16_MESSAGE(before->index, object->index, where);
            TEST_ASSERT_NOT_NULL_MESSAGE(object->name, where);
            const cm1e_entry_t *last = &object->entries[object->entry_count - 1];
            TEST_ASSERT_EQUAL_MESSAGE(object->highest_subindex, last->subindex, where);
            if (object->object_code == CM1E_OBJECT_VAR)
                TEST_ASSERT_EQUAL_MESSAGE(1, object->entry_count, where);
            else
                TEST_ASSERT_EQUAL_MESSAGE(object->highest_subindex, object->entries[0].default_value, where);
            for (unsigned k = 0; k < object->entry_count; k++) {
                const cm1e_entry_t *entry = &object->entries[k];
                TEST_ASSERT_EQUAL_HEX16_MESSAGE(object->index, entry->index, where);
                TEST_ASSERT_NOT_NULL_MESSAGE(entry->unit, where);
                if (k > 0)
                    TEST_ASSERT_TRUE_MESSAGE(entry[-1].subindex < entry->subindex, where);
                if (object->object_code == CM1E_OBJECT_ARRAY && k > 1)
                    TEST_ASSERT_EQUAL_MESSAGE(entry[-1].type, entry->type, where);
            }
        }
    }
}

static void test_defaults_lie_in_their_ranges(void)
{
    for (int m = 0; m < MODELS; m++) {
        const cm1e_object_t *object;
        for (size_t n = 0; (object = cm1e_bridge_object(models[m], n)) != NULL; n++)
            for (unsigned k = 0; k < object->entry_count; k++) {
                const cm1e_entry_t *entry = &object->entries[k];
                const char *where = at(models[m], entry->index, entry->subindex);
                if (entry->type == CM1E_TYPE_STRING) {
                    TEST_ASSERT_NOT_NULL_MESSAGE(entry->default_string, where);
                    continue;
                }
                TEST_ASSERT_TRUE_MESSAGE(entry->minimum <= entry->maximum, where);
                TEST_ASSERT_TRUE_MESSAGE(entry->default_value >= entry->minimum, where);
                TEST_ASSERT_TRUE_MESSAGE(entry->default_value <= entry->maximum, where);
            }
    }
}

static void test_only_what_the_process_data_carry_can_be_mapped(void)
{
    for (int m = 0; m < MODELS; m++) {
        const cm1e_object_t *object;
        for (size_t n = 0; (object = cm1e_bridge_object(models[m], n)) != NULL; n++)
            for (unsigned k = 0; k < object->entry_count; k++) {
                const unsigned of_axis_1 = object->index >= 0x6000 && object->index < 0x8000
                                               ? 0x6000 + object->index % 0x800 : 0;
                const unsigned wanted = of_axis_1 == 0x6040 || of_axis_1 == 0x607A   ? CM1E_ACCESS_RXPDO
                                        : of_axis_1 == 0x6041 || of_axis_1 == 0x6064 ? CM1E_ACCESS_TXPDO
                                                                                     : 0;
                TEST_ASSERT_EQUAL_HEX8_MESSAGE(wanted, object->entries[k].access &
                                                           (CM1E_ACCESS_RXPDO | CM1E_ACCESS_TXPDO),
                                               at(models[m], object->index, k));
            }
    }
}

/* ---- models and axes -------------------------------------------------------------------------------------------- */

static void test_models_have_their_motors(void)
{
    static const int motors[MODELS][4] = {{1, 1, 1, 1}, {2, 2, 2, 2}, {1, 1, 2, 2}}; /* BR 1.4 */
    static const char *const names[MODELS] = {"EB01", "EB02", "EB12"};
    for (int m = 0; m < MODELS; m++) {
        TEST_ASSERT_EQUAL_STRING(names[m], cm1e_bridge_name(models[m]));
        TEST_ASSERT_EQUAL_STRING(names[m], cm1e_bridge_entry(models[m], 0x1008, 0)->default_string);
        for (unsigned axis = 0; axis < 4; axis++) {
            TEST_ASSERT_EQUAL(motors[m][axis], cm1e_bridge_motor(models[m], axis));
            /* BR 7.3 */
            const uint16_t config = (uint16_t)(0xF511 + axis);
            TEST_ASSERT_EQUAL(motors[m][axis], cm1e_bridge_entry(models[m], config, 1)->default_value);
            TEST_ASSERT_EQUAL(6, cm1e_bridge_entry(models[m], config, 2)->default_value);
            TEST_ASSERT_EQUAL(1, cm1e_bridge_entry(models[m], config, 3)->default_value);
        }
    }
}

static void test_what_is_not_there_is_not_found(void)
{
    TEST_ASSERT_NULL(cm1e_bridge_name(CM1E_DEVICE_CM1E));
    TEST_ASSERT_NULL(cm1e_bridge_object(CM1E_DEVICE_CM1E, 0));
    TEST_ASSERT_NULL(cm1e_bridge_entry(CM1E_DEVICE_CM1E, 0x1000, 0));
    TEST_ASSERT_NULL(cm1e_bridge_name((cm1e_device_model_t)4));
    TEST_ASSERT_NULL(cm1e_bridge_object((cm1e_device_model_t)4, 0));
    TEST_ASSERT_NULL(cm1e_bridge_object(CM1E_DEVICE_EB01, 100000));
    TEST_ASSERT_NULL(cm1e_bridge_entry(CM1E_DEVICE_EB01, 0x1018, 5));
    TEST_ASSERT_NULL(cm1e_bridge_entry(CM1E_DEVICE_EB01, 0x60F6, 80));
    TEST_ASSERT_NULL(cm1e_bridge_entry(CM1E_DEVICE_EB01, 0x7080, 0)); /* BR 6.3.2 means 7840 */
    TEST_ASSERT_NULL(cm1e_bridge_entry(CM1E_DEVICE_EB01, 0xFFFF, 0));
    TEST_ASSERT_NULL(cm1e_bridge_entry(CM1E_DEVICE_EB01, 0, 0));
}

static void test_every_index_belongs_to_its_axis(void)
{
    for (unsigned index = 0; index <= 0xFFFF; index++) {
        int axis = -1;
        if ((index >= 0x1600 && index < 0x1640) || (index >= 0x1A00 && index < 0x1A40))
            axis = index >> 4 & 3;
        else if (index >= 0x6000 && index < 0x8000)
            axis = (int)(index - 0x6000) / 0x800;
        TEST_ASSERT_EQUAL_MESSAGE(axis, cm1e_bridge_axis_of((uint16_t)index), at(CM1E_DEVICE_EB01, index, 0));
    }
}

static void test_the_objects_of_an_axis_are_a_part_of_the_dictionary(void)
{
    for (int m = 0; m < MODELS; m++)
        for (unsigned axis = 0; axis < 4; axis++) {
            size_t count;
            const cm1e_object_t *objects =
                cm1e_bridge_axis_objects(cm1e_bridge_motor(models[m], axis), axis, &count);
            TEST_ASSERT_EQUAL(27 + 8, count); /* variables and objects with sub-indexes of appendix 6 */
            for (size_t i = 0; i < count; i++) {
                TEST_ASSERT_EQUAL((int)axis, cm1e_bridge_axis_of(objects[i].index));
                TEST_ASSERT_EQUAL_PTR(&objects[i].entries[0], cm1e_bridge_entry(models[m], objects[i].index, 0));
            }
        }
}

/* ---- values ----------------------------------------------------------------------------------------------------- */

static void test_values_that_the_guide_states(void)
{
    static const struct {
        uint16_t index;
        uint8_t subindex;
        int64_t value;
    } values[] = {
        {0x1000, 0, 0x40192}, {0x1601, 1, 0x60400010}, {0x1601, 2, 0x607A0020}, {0x1631, 2, 0x787A0020},
        {0x1A01, 1, 0x60410010}, {0x1A21, 2, 0x70640020}, {0x1600, 2, 0x60600008}, {0x1A30, 4, 0x786C0020},
        {0x1C00, 1, 1}, {0x1C00, 4, 4}, {0x1C12, 0, 4}, {0x1C12, 2, 0x1611}, {0x1C13, 4, 0x1A31},
        {0x1C32, 4, 3}, {0x1C32, 5, 1000000}, {0x6040, 0, 0}, {0x6860, 0, 8}, {0x7861, 0, 8}, {0x60E3, 1, 1},
        {0x60E3, 4, 4}, {0x6502, 0, 0xA0}, {0x7D02, 0, 0xA0}, {0xF000, 1, 0x800}, {0xF000, 2, 4},
        {0xF010, 1, 0x40192}, {0xF010, 4, 0x40192}, {0xF030, 1, 0x219800}, {0xF050, 4, 0x219800}, {0xF530, 0, 0x18},
    };
    for (size_t i = 0; i < COUNT(values); i++)
        TEST_ASSERT_EQUAL_HEX64_MESSAGE(
            values[i].value, cm1e_bridge_entry(CM1E_DEVICE_EB12, values[i].index, values[i].subindex)->default_value,
            at(CM1E_DEVICE_EB12, values[i].index, values[i].subindex));
    TEST_ASSERT_EQUAL(8 * 64, cm1e_bridge_entry(CM1E_DEVICE_EB12, 0xF581, 0)->bits); /* BR 7.2.2 */
    TEST_ASSERT_EQUAL(8 * 64, cm1e_bridge_entry(CM1E_DEVICE_EB12, 0xF594, 0)->bits);
    TEST_ASSERT_TRUE(cm1e_bridge_entry(CM1E_DEVICE_EB12, 0x1C12, 0)->access & CM1E_ACCESS_WRITE_PREOP_ONLY);
    TEST_ASSERT_TRUE(cm1e_bridge_entry(CM1E_DEVICE_EB12, 0x1C13, 4)->access & CM1E_ACCESS_WRITE_PREOP_ONLY);
}

/* BR 6.4.1 with its notes: default, least, greatest, of a CM1 and of a CM2. */
static void test_ranges_of_homing_by_motor(void)
{
    static const struct {
        uint16_t index;
        uint8_t subindex;
        cm1e_data_type_t type;
        int64_t cm1[3], cm2[3];
    } rows[] = {
        {0x6098, 0, CM1E_TYPE_USINT, {1, 1, 4}, {1, 1, 4}},
        {0x6099, 1, CM1E_TYPE_UDINT, {100, 1, 5000}, {10, 1, 32767}},
        {0x6099, 2, CM1E_TYPE_UDINT, {100, 1, 5000}, {10, 1, 32767}},
        {0x609A, 0, CM1E_TYPE_UDINT, {100, 1, 5000}, {100, 1, 32767}},
        {0x607C, 0, CM1E_TYPE_DINT, {0, -32767, 32767}, {0, -32767, 32767}},
        {0x60F6, 0x16, CM1E_TYPE_DINT, {100, 1, 5000}, {10, 1, 32767}},
        {0x60F6, 0x17, CM1E_TYPE_DINT, {100, 1, 5000}, {100, 1, 32767}},
        {0x60F6, 0x1C, CM1E_TYPE_DINT, {0, -32767, 32767}, {0, -32767, 32767}},
        {0x60FD, 0, CM1E_TYPE_UDINT, {0, 0, 0x0E}, {0, 0, 0x3F}}, /* BR 6.5.1 */
    };
    for (unsigned axis = 0; axis < 4; axis++)
        for (size_t i = 0; i < COUNT(rows); i++) {
            const bool cm2 = axis >= 2; /* EB12 */
            const int64_t *wanted = cm2 ? rows[i].cm2 : rows[i].cm1;
            const uint16_t index = (uint16_t)(rows[i].index + 0x800 * axis);
            const cm1e_entry_t *entry = cm1e_bridge_entry(CM1E_DEVICE_EB12, index, rows[i].subindex);
            const char *where = at(CM1E_DEVICE_EB12, index, rows[i].subindex);
            TEST_ASSERT_EQUAL_MESSAGE(rows[i].type, entry->type, where);
            TEST_ASSERT_EQUAL_INT64_MESSAGE(wanted[0], entry->default_value, where);
            TEST_ASSERT_EQUAL_INT64_MESSAGE(wanted[1], entry->minimum, where);
            TEST_ASSERT_EQUAL_INT64_MESSAGE(wanted[2], entry->maximum, where);
        }
}

static void test_signed_objects_are_signed(void)
{
    static const uint16_t are_signed[] = {0x6060, 0x6061, 0x6064, 0x606C, 0x6071, 0x6077, 0x607A,
                                          0x607C, 0x60B1, 0x60B2, 0x60F4, 0x60FF};
    static const uint16_t are_unsigned[] = {0x603F, 0x6040, 0x6041, 0x6065, 0x6066, 0x6085, 0x6098, 0x609A,
                                            0x60FD, 0x6502, 0x67FE};
    for (size_t i = 0; i < COUNT(are_signed); i++) {
        const cm1e_entry_t *entry = cm1e_bridge_entry(CM1E_DEVICE_EB01, are_signed[i], 0);
        TEST_ASSERT_TRUE_MESSAGE(entry->type <= CM1E_TYPE_DINT, at(CM1E_DEVICE_EB01, are_signed[i], 0));
    }
    for (size_t i = 0; i < COUNT(are_unsigned); i++) {
        const cm1e_entry_t *entry = cm1e_bridge_entry(CM1E_DEVICE_EB01, are_unsigned[i], 0);
        TEST_ASSERT_TRUE_MESSAGE(entry->type >= CM1E_TYPE_USINT, at(CM1E_DEVICE_EB01, are_unsigned[i], 0));
    }
}

/* ---- positions: BR appendix 5 ------------------------------------------------------------------------------------ */

static void test_position_limits_by_k37(void)
{
    static const struct {
        int k37[3]; /* -1: the column is empty */
        int32_t cm1, cm2;
    } rows[] = {
        {{0, 20, 80}, 8589934, 8589934}, {{1, 21, 81}, 17179869, 17179869}, {{2, 22, 82}, 21474836, 21474836},
        {{3, 23, 83}, 42949672, 42949672}, {{4, 24, 84}, 85899345, 85899345}, {{5, 25, 85}, 107374182, 107374182},
        {{6, 26, 86}, 214748364, 214748364}, {{7, 27, 87}, 429496729, 429496729}, {{8, 28, 88}, 999999999, 999999999},
        {{9, 29, 89}, 0, 0}, {{10, 30, 90}, 999999999, 999999999}, {{40, 60, -1}, 13421772, 12884901},
        {{41, 61, -1}, 17895697, 17179869}, {{42, 62, -1}, 26843545, 25769803}, {{43, 63, -1}, 35791394, 34359738},
        {{44, 64, -1}, 53687091, 51539607}, {{45, 65, -1}, 67108863, 64424509}, {{46, 66, -1}, 134217727, 128849018},
        {{47, 67, -1}, 178956970, 171798691}, {{48, 68, -1}, 268435455, 257698037},
        {{49, 69, -1}, 357913941, 343597383}, {{50, 70, -1}, 536870911, 515396075},
    };
    for (int k37 = -200; k37 < 200; k37++) {
        int32_t cm1 = 0, cm2 = 0;
        for (size_t i = 0; i < COUNT(rows); i++)
            for (int column = 0; column < 3; column++)
                if (k37 >= 0 && rows[i].k37[column] == k37) {
                    cm1 = column < 2 ? rows[i].cm1 : 0; /* 1 pps: CM2 only */
                    cm2 = rows[i].cm2;
                }
        TEST_ASSERT_EQUAL_MESSAGE(cm1, cm1e_bridge_position_limit(CM1E_BRIDGE_CM1, k37), "CM1");
        TEST_ASSERT_EQUAL_MESSAGE(cm2, cm1e_bridge_position_limit(CM1E_BRIDGE_CM2, k37), "CM2");
    }
}

/* ---- process data: BR 6.3.1 and 6.3.3 ---------------------------------------------------------------------------- */

static void test_process_data_are_24_bytes_each_way(void)
{
    static const struct {
        unsigned offset; /* bytes */
        uint16_t pdo, index;
        unsigned bytes;
    } rows[2][8] = {
        {{0, 0x1601, 0x6040, 2}, {2, 0x1601, 0x607A, 4}, {6, 0x1611, 0x6840, 2}, {8, 0x1611, 0x687A, 4},
         {12, 0x1621, 0x7040, 2}, {14, 0x1621, 0x707A, 4}, {18, 0x1631, 0x7840, 2}, {20, 0x1631, 0x787A, 4}},
        {{0, 0x1A01, 0x6041, 2}, {2, 0x1A01, 0x6064, 4}, {6, 0x1A11, 0x6841, 2}, {8, 0x1A11, 0x6864, 4},
         {12, 0x1A21, 0x7041, 2}, {14, 0x1A21, 0x7064, 4}, {18, 0x1A31, 0x7841, 2}, {20, 0x1A31, 0x7864, 4}},
    };
    for (int transmit = 0; transmit < 2; transmit++) {
        unsigned offset = 0, row = 0;
        for (unsigned axis = 0; axis < 4; axis++) {
            cm1e_pdo_t pdo;
            cm1e_bridge_pdo(&pdo, axis, transmit);
            TEST_ASSERT_EQUAL(2, pdo.entry_count);
            for (unsigned e = 0; e < pdo.entry_count; e++, row++) {
                const char *where = at(CM1E_DEVICE_EB01, pdo.index, e + 1);
                TEST_ASSERT_EQUAL_MESSAGE(rows[transmit][row].offset, offset, where);
                TEST_ASSERT_EQUAL_HEX16_MESSAGE(rows[transmit][row].pdo, pdo.index, where);
                TEST_ASSERT_EQUAL_HEX16_MESSAGE(rows[transmit][row].index, pdo.entries[e].index, where);
                TEST_ASSERT_EQUAL_MESSAGE(0, pdo.entries[e].subindex, where);
                TEST_ASSERT_EQUAL_MESSAGE(8 * rows[transmit][row].bytes, pdo.entries[e].bits, where);
                TEST_ASSERT_EQUAL_HEX64_MESSAGE(
                    (int64_t)pdo.entries[e].index << 16 | pdo.entries[e].bits,
                    cm1e_bridge_entry(CM1E_DEVICE_EB01, pdo.index, (uint8_t)(e + 1))->default_value, where);
                offset += pdo.entries[e].bits / 8;
            }
            char name[16];
            snprintf(name, sizeof name, "ID%u csp %s", axis + 1, transmit ? "TxPDO" : "RxPDO");
            TEST_ASSERT_EQUAL_STRING(name, pdo.name);
        }
        TEST_ASSERT_EQUAL(24, offset);
    }
}

/* BR 6.5: one fact for the dictionary and for who asks for the signals of a motor. */
static void test_digital_signals_are_those_of_the_dictionary(void)
{
    TEST_ASSERT_EQUAL_HEX(cm1e_bridge_entry(CM1E_DEVICE_EB01, 0x60FD, 0)->maximum,
                          cm1e_bridge_input_mask(CM1E_BRIDGE_CM1));
    TEST_ASSERT_EQUAL_HEX(cm1e_bridge_entry(CM1E_DEVICE_EB02, 0x60FD, 0)->maximum,
                          cm1e_bridge_input_mask(CM1E_BRIDGE_CM2));
}

/* BR 6.4.1, note 3 */
static void test_unit_of_the_offset_by_k45(void)
{
    static const int units[10] = {100, 10, 1};
    for (int32_t k45 = 0; k45 < 1000; k45++)
        TEST_ASSERT_EQUAL(units[k45 / 10 % 10], cm1e_bridge_offset_unit(k45));
    TEST_ASSERT_EQUAL(0, cm1e_bridge_offset_unit(INT32_MIN));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_row_of_the_appendix_is_in_every_model);
    RUN_TEST(test_no_model_has_more_than_the_appendix);
    RUN_TEST(test_objects_are_sorted_and_hold_their_entries);
    RUN_TEST(test_defaults_lie_in_their_ranges);
    RUN_TEST(test_only_what_the_process_data_carry_can_be_mapped);
    RUN_TEST(test_models_have_their_motors);
    RUN_TEST(test_what_is_not_there_is_not_found);
    RUN_TEST(test_every_index_belongs_to_its_axis);
    RUN_TEST(test_the_objects_of_an_axis_are_a_part_of_the_dictionary);
    RUN_TEST(test_values_that_the_guide_states);
    RUN_TEST(test_ranges_of_homing_by_motor);
    RUN_TEST(test_signed_objects_are_signed);
    RUN_TEST(test_position_limits_by_k37);
    RUN_TEST(test_process_data_are_24_bytes_each_way);
    RUN_TEST(test_digital_signals_are_those_of_the_dictionary);
    RUN_TEST(test_unit_of_the_offset_by_k45);
    return UNITY_END();
}
