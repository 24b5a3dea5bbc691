/* The ESI writer with descriptions that none of our devices has: shapes of objects, names, types, access, comments. */
#include "esi_judge.h"

static cm1e_arena_t *arena;

static cm1e_description_t *add_device(void)
{
    arena = &description.arena;
    cm1e_description_t *device = CM1E_APPEND(arena, &description.devices);
    cm1e_description_init(device);
    device->type = "T";
    device->name = "N";
    device->group = "G";
    return device;
}

static cm1e_described_object_t *add_object(cm1e_description_t *device, uint16_t index, uint8_t code)
{
    cm1e_described_object_t *object = CM1E_APPEND(arena, &device->objects);
    object->index = index;
    object->code = code;
    object->name = "object";
    object->type = "";
    return object;
}

static cm1e_described_entry_t *add_entry(cm1e_described_object_t *object, uint8_t subindex, const char *name,
                                         const char *type, uint32_t bits)
{
    cm1e_described_entry_t *entry = CM1E_APPEND(arena, &object->entries);
    entry->subindex = subindex;
    entry->name = name;
    entry->type = type;
    entry->bits = bits;
    entry->unit = "";
    entry->access = CM1E_ACCESS_READ;
    return entry;
}

/* Sub-index 0 and elements of type UINT with the names that elements have anyway. */
static cm1e_described_object_t *add_array(cm1e_description_t *device, uint16_t index, unsigned elements)
{
    cm1e_described_object_t *object = add_object(device, index, CM1E_OBJECT_ARRAY);
    add_entry(object, 0, "Number of entries", "USINT", 8);
    for (unsigned i = 1; i <= elements; i++)
        add_entry(object, (uint8_t)i, cm1e_arena_format(arena, "SubIndex %03u", i), "UINT", 16);
    return object;
}

/* Valid where there are schemas to say so. */
static void write_valid_file(void)
{
    write_file();
    if (schema)
        TEST_ASSERT_EQUAL_STRING("", schema_error());
}

#define TYPE DICTIONARY "/DataTypes/DataType"
#define OBJECT DICTIONARY "/Objects/Object"

/* ---- arrays and records ----------------------------------------------------------------------------------------- */

static void test_alike_elements_are_one_item_of_an_array_type(void)
{
    add_array(add_device(), 0x2000, 3);
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("DT2000", text(OBJECT "/Type"));
    TEST_ASSERT_EQUAL_STRING("64", text(OBJECT "/BitSize"));
    TEST_ASSERT_EQUAL_STRING("UINT", text(TYPE "[Name='DT2000ARR']/BaseType"));
    TEST_ASSERT_EQUAL_STRING("48", text(TYPE "[Name='DT2000ARR']/BitSize"));
    TEST_ASSERT_EQUAL_STRING("1", text(TYPE "[Name='DT2000ARR']/ArrayInfo/LBound"));
    TEST_ASSERT_EQUAL_STRING("3", text(TYPE "[Name='DT2000ARR']/ArrayInfo/Elements"));
    TEST_ASSERT_EQUAL_INT(2, count(TYPE "[Name='DT2000']/SubItem"));
    TEST_ASSERT_EQUAL_STRING("0", text(TYPE "[Name='DT2000']/SubItem[1]/SubIdx"));
    TEST_ASSERT_EQUAL_STRING("?", text(TYPE "[Name='DT2000']/SubItem[2]/SubIdx"));
    TEST_ASSERT_EQUAL_STRING("DT2000ARR", text(TYPE "[Name='DT2000']/SubItem[2]/Type"));
    TEST_ASSERT_EQUAL_STRING("16", text(TYPE "[Name='DT2000']/SubItem[2]/BitOffs"));
    TEST_ASSERT_EQUAL_STRING("48", text(TYPE "[Name='DT2000']/SubItem[2]/BitSize"));
}

static void test_a_count_of_16_bits_is_as_long_as_one_of_8(void)
{
    cm1e_described_object_t *object = add_array(add_device(), 0x2000, 3);
    object->entries.at[0].type = "UINT";
    object->entries.at[0].bits = 16;
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("16", text(TYPE "[Name='DT2000']/SubItem[1]/BitSize"));
    TEST_ASSERT_EQUAL_STRING("16", text(TYPE "[Name='DT2000']/SubItem[2]/BitOffs"));
    TEST_ASSERT_EQUAL_STRING("64", text(OBJECT "/BitSize"));
}

/* What only one element has: an array type has no place for it, so there is an item for each. */
static void test_unlike_elements_have_an_item_each(void)
{
    enum { NAME, UNIT, COMMENT, TYPE_OF_VALUE, ACCESS, GAP, CHANGES };
    for (int change = 0; change < CHANGES; change++) {
        cm1e_description_file_free(&description);
        cm1e_described_entry_t *third = &add_array(add_device(), 0x2000, 3)->entries.at[3];
        switch (change) {
        case NAME: third->name = "own name"; break;
        case UNIT: third->unit = "mA"; break;
        case COMMENT: third->comment = "own comment"; break;
        case TYPE_OF_VALUE: third->type = "INT"; break;
        case ACCESS: third->access |= CM1E_ACCESS_WRITE; break;
        default: third->subindex = 4, third->name = "SubIndex 004"; break;
        }
        write_valid_file();
        TEST_ASSERT_EQUAL_INT(0, count(TYPE "/ArrayInfo"));
        TEST_ASSERT_EQUAL_INT(4, count(TYPE "[Name='DT2000']/SubItem[SubIdx]"));
        TEST_ASSERT_EQUAL_STRING("64", text(OBJECT "/BitSize"));
    }
}

static void test_elements_share_unit_and_comment(void)
{
    cm1e_described_object_t *object = add_array(add_device(), 0x2000, 2);
    for (int i = 1; i <= 2; i++) {
        object->entries.at[i].unit = "mA";
        object->entries.at[i].comment = "0 ... 5";
    }
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("[mA] 0 ... 5", text(TYPE "[Name='DT2000']/SubItem[2]/Comment"));
}

static void test_elements_without_a_name_are_an_array_too(void)
{
    cm1e_described_object_t *object = add_array(add_device(), 0x2000, 2);
    object->entries.at[1].name = "";
    object->entries.at[2].name = NULL;
    object->entries.at[2].default_data = cm1e_bytes_of(arena, 0x1234, 2);
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(1, count(TYPE "/ArrayInfo"));
    TEST_ASSERT_EQUAL_STRING("3412", text(OBJECT "/Info/SubItem[Name='SubIndex 002']/Info/DefaultData"));
}

static void test_bits_follow_each_other_and_bytes_begin_at_a_byte(void)
{
    cm1e_described_object_t *object = add_object(add_device(), 0x2000, CM1E_OBJECT_RECORD);
    add_entry(object, 0, "Number of entries", "USINT", 8);
    add_entry(object, 1, "a", "BOOL", 1);
    add_entry(object, 2, "b", "BIT3", 3);
    add_entry(object, 5, "c", "UINT", 16);
    add_entry(object, 6, "d", "BOOL", 1);
    write_valid_file();
    static const char *const offsets[] = {"0", "16", "17", "24", "40"};
    for (int i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_STRING(offsets[i], text(TYPE "[Name='DT2000']/SubItem[%d]/BitOffs", i + 1));
    TEST_ASSERT_EQUAL_STRING("48", text(TYPE "[Name='DT2000']/BitSize"));
    TEST_ASSERT_EQUAL_STRING("48", text(OBJECT "/BitSize"));
}

static void test_the_same_shape_has_one_type(void)
{
    cm1e_description_t *device = add_device();
    for (uint16_t index = 0x2000; index < 0x2004; index++)
        add_array(device, index, 2);
    add_array(device, 0x2004, 3);
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(4, count(OBJECT "[Type='DT2000']"));
    TEST_ASSERT_EQUAL_STRING("DT2004", text(OBJECT "[5]/Type"));
    TEST_ASSERT_EQUAL_INT(2 + 2 * 2, count(TYPE));
}

static void test_every_difference_makes_a_type_of_its_own(void)
{
    enum { SUBINDEX, NAME, UNIT, COMMENT, TYPE_OF_VALUE, BITS, ACCESS, MORE, CODE, CHANGES };
    for (int change = 0; change < CHANGES; change++) {
        cm1e_description_file_free(&description);
        cm1e_description_t *device = add_device();
        cm1e_described_object_t *other = NULL;
        for (uint16_t index = 0x2000; index < 0x2002; index++) {
            other = add_object(device, index, CM1E_OBJECT_RECORD);
            add_entry(other, 0, "Number of entries", "USINT", 8);
            add_entry(other, 1, "SubIndex 001", "UINT", 16);
        }
        cm1e_described_entry_t *entry = &other->entries.at[1];
        switch (change) {
        case SUBINDEX: entry->subindex = 2; break;
        case NAME: entry->name = "another"; break;
        case UNIT: entry->unit = "mA"; break;
        case COMMENT: entry->comment = "comment"; break;
        case TYPE_OF_VALUE: entry->type = "INT"; break;
        case BITS: entry->bits = 8; break;
        case ACCESS: entry->access |= CM1E_ACCESS_TXPDO; break;
        case MORE: add_entry(other, 2, "more", "UINT", 16); break;
        default: other->code = CM1E_OBJECT_ARRAY; break;
        }
        write_valid_file();
        TEST_ASSERT_EQUAL_STRING("DT2000", text(OBJECT "[1]/Type"));
        TEST_ASSERT_EQUAL_STRING("DT2001", text(OBJECT "[2]/Type"));
    }
}

static void test_values_are_no_part_of_a_shape(void)
{
    cm1e_description_t *device = add_device();
    add_array(device, 0x2000, 1)->entries.at[1].default_data = cm1e_bytes_of(arena, 1, 2);
    add_array(device, 0x2001, 1)->entries.at[1].default_data = cm1e_bytes_of(arena, 2, 2);
    write_valid_file();
    TEST_ASSERT_EQUAL_INT(2, count(OBJECT "[Type='DT2000']"));
    TEST_ASSERT_EQUAL_STRING("0100", text(OBJECT "[1]/Info/SubItem/Info/DefaultData"));
    TEST_ASSERT_EQUAL_STRING("0200", text(OBJECT "[2]/Info/SubItem/Info/DefaultData"));
}

static void test_an_index_that_is_there_twice_keeps_both_shapes(void)
{
    cm1e_description_t *device = add_device();
    add_array(device, 0x2000, 1);
    add_array(device, 0x2000, 2);
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("DT2000", text(OBJECT "[1]/Type"));
    TEST_ASSERT_EQUAL_STRING("DT2000_2", text(OBJECT "[2]/Type"));
}

/* ---- names ------------------------------------------------------------------------------------------------------ */

static void test_a_name_that_comes_again_is_shown_but_does_not_identify(void)
{
    cm1e_described_object_t *object = add_object(add_device(), 0x2000, CM1E_OBJECT_RECORD);
    add_entry(object, 0, "Number of entries", "USINT", 8);
    add_entry(object, 1, "N/A", "UINT", 16);
    add_entry(object, 2, "N/A", "UINT", 16)->default_data = cm1e_bytes_of(arena, 7, 2);
    add_entry(object, 3, "", "UINT", 16);
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("N/A", text(TYPE "/SubItem[SubIdx='1']/Name"));
    TEST_ASSERT_EQUAL_STRING("SubIndex 002", text(TYPE "/SubItem[SubIdx='2']/Name"));
    TEST_ASSERT_EQUAL_STRING("N/A", text(TYPE "/SubItem[SubIdx='2']/DisplayName"));
    TEST_ASSERT_EQUAL_STRING("SubIndex 003", text(TYPE "/SubItem[SubIdx='3']/Name"));
    TEST_ASSERT_EQUAL_INT(1, count(TYPE "/SubItem/DisplayName"));
    TEST_ASSERT_EQUAL_STRING("0700", text(OBJECT "/Info/SubItem[Name='SubIndex 002']/Info/DefaultData"));
}

static void test_names_that_stand_in_each_others_way_are_made_unique(void)
{
    cm1e_described_object_t *object = add_object(add_device(), 0x2000, CM1E_OBJECT_RECORD);
    add_entry(object, 1, "SubIndex 002", "UINT", 16);
    add_entry(object, 2, "SubIndex 002", "UINT", 16);
    add_entry(object, 2, "SubIndex 002", "UINT", 16);
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("SubIndex 002 (2)", text(TYPE "/SubItem[2]/Name"));
    TEST_ASSERT_EQUAL_STRING("SubIndex 002 (3)", text(TYPE "/SubItem[3]/Name"));
}

static void test_texts_of_strangers_are_written_as_utf_8(void)
{
    cm1e_description_t *device = add_device();
    device->name = "Gr\xF6\xDF" "e <&> \x01";
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("Gr\xC3\xB6\xC3\x9F" "e <&> ", text(DEVICE "/Name"));
}

/* ---- types ------------------------------------------------------------------------------------------------------ */

static void test_a_size_without_a_type_gets_one(void)
{
    static const struct {
        uint32_t bits;
        const char *type;
    } rows[] = {{1, "BIT1"}, {5, "BIT5"}, {8, "USINT"}, {16, "UINT"}, {24, "OCTET_STRING(3)"}, {32, "UDINT"},
                {64, "ULINT"}, {0, "OCTET_STRING(0)"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        cm1e_description_file_free(&description);
        add_entry(add_object(add_device(), 0x2000, CM1E_OBJECT_VAR), 0, "v", i % 2 ? "" : NULL, rows[i].bits);
        write_valid_file();
        TEST_ASSERT_EQUAL_STRING(rows[i].type, text(OBJECT "/Type"));
        TEST_ASSERT_EQUAL_INT(rows[i].bits, number(text(TYPE "[Name='%s']/BitSize", rows[i].type)));
    }
}

/* What contradicts itself is for the checker: both sizes are still there. */
static void test_a_base_type_keeps_its_own_size(void)
{
    add_entry(add_object(add_device(), 0x2000, CM1E_OBJECT_VAR), 0, "v", "UINT", 8);
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("16", text(TYPE "[Name='UINT']/BitSize"));
    TEST_ASSERT_EQUAL_STRING("8", text(OBJECT "/BitSize"));
}

static void test_an_object_without_entries_is_kept(void)
{
    add_object(add_device(), 0x2000, 0)->bits = 16;
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("UINT", text(OBJECT "/Type"));
    TEST_ASSERT_EQUAL_STRING("16", text(OBJECT "/BitSize"));
    TEST_ASSERT_EQUAL_INT(0, count(OBJECT "/Flags|" OBJECT "/Info"));
}

static void test_only_sub_index_0_is_simple_unless_it_is_called_otherwise(void)
{
    static const uint8_t codes[] = {0, CM1E_OBJECT_VAR, CM1E_OBJECT_ARRAY, CM1E_OBJECT_RECORD};
    for (int i = 0; i < 4; i++) {
        cm1e_description_file_free(&description);
        add_entry(add_object(add_device(), 0x2000, codes[i]), 0, "v", "USINT", 8);
        write_valid_file();
        TEST_ASSERT_EQUAL_STRING(i < 2 ? "USINT" : "DT2000", text(OBJECT "/Type"));
        TEST_ASSERT_EQUAL_STRING("8", text(OBJECT "/BitSize"));
    }
}

static void test_a_type_of_a_stranger_is_kept_by_its_name(void)
{
    static const char *const types[] = {"DT2000EN08", "DT2000", "DT2000ARR"};
    for (int i = 0; i < 3; i++) {
        cm1e_description_file_free(&description);
        cm1e_described_object_t *object = add_object(add_device(), 0x2000, CM1E_OBJECT_RECORD);
        add_entry(object, 0, "Number of entries", "USINT", 8);
        add_entry(object, 1, "what", types[i], 8);
        write_valid_file();
        TEST_ASSERT_EQUAL_STRING("8", text(TYPE "[Name='%s']/BitSize", types[i]));
        TEST_ASSERT_EQUAL_STRING(i == 0 ? "DT2000" : "DT2000_1", text(OBJECT "/Type"));
    }
}

static void test_access_is_written_as_far_as_it_is_known(void)
{
    static const struct {
        uint8_t access;
        const char *word, *restrictions, *mapping;
    } rows[] = {
        {0, "?", "?", "?"},
        {CM1E_ACCESS_READ, "ro", "?", "?"},
        {CM1E_ACCESS_WRITE, "wo", "?", "?"},
        {CM1E_ACCESS_READ | CM1E_ACCESS_WRITE | CM1E_ACCESS_RXPDO, "rw", "?", "R"},
        {CM1E_ACCESS_READ | CM1E_ACCESS_TXPDO, "ro", "?", "T"},
        {CM1E_ACCESS_READ | CM1E_ACCESS_WRITE | CM1E_ACCESS_RXPDO | CM1E_ACCESS_TXPDO, "rw", "?", "RT"},
        {CM1E_ACCESS_READ | CM1E_ACCESS_WRITE | CM1E_ACCESS_WRITE_PREOP_ONLY, "rw", "PreOP", "?"},
        {CM1E_ACCESS_TXPDO, "?", "?", "T"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        cm1e_description_file_free(&description);
        add_entry(add_object(add_device(), 0x2000, CM1E_OBJECT_VAR), 0, "v", "UINT", 16)->access = rows[i].access;
        write_valid_file();
        TEST_ASSERT_EQUAL_STRING(rows[i].word, text(OBJECT "/Flags/Access"));
        TEST_ASSERT_EQUAL_STRING(rows[i].restrictions, text(OBJECT "/Flags/Access/@WriteRestrictions"));
        TEST_ASSERT_EQUAL_STRING(rows[i].mapping, text(OBJECT "/Flags/PdoMapping"));
        TEST_ASSERT_EQUAL_INT(rows[i].access ? 1 : 0, count(OBJECT "/Flags"));
    }
}

static void test_a_comment_is_of_the_entry_before_the_object(void)
{
    cm1e_description_t *device = add_device();
    cm1e_described_object_t *object = add_object(device, 0x2000, CM1E_OBJECT_VAR);
    cm1e_described_entry_t *entry = add_entry(object, 0, "v", "UINT", 16);
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("?", text(OBJECT "/Comment"));
    object->comment = "of the object";
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("of the object", text(OBJECT "/Comment"));
    entry->comment = "of the entry";
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("of the entry", text(OBJECT "/Comment"));
    entry->unit = "mA";
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("[mA] of the entry", text(OBJECT "/Comment"));
    entry->comment = NULL;
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("[mA]", text(OBJECT "/Comment"));
    cm1e_described_object_t *record = add_array(device, 0x2001, 1);
    record->comment = "of the record";
    write_valid_file();
    TEST_ASSERT_EQUAL_STRING("of the record", text(OBJECT "[2]/Comment"));
}

int main(void)
{
    load_schema();
    UNITY_BEGIN();
    RUN_TEST(test_alike_elements_are_one_item_of_an_array_type);
    RUN_TEST(test_a_count_of_16_bits_is_as_long_as_one_of_8);
    RUN_TEST(test_unlike_elements_have_an_item_each);
    RUN_TEST(test_elements_share_unit_and_comment);
    RUN_TEST(test_elements_without_a_name_are_an_array_too);
    RUN_TEST(test_bits_follow_each_other_and_bytes_begin_at_a_byte);
    RUN_TEST(test_the_same_shape_has_one_type);
    RUN_TEST(test_every_difference_makes_a_type_of_its_own);
    RUN_TEST(test_values_are_no_part_of_a_shape);
    RUN_TEST(test_an_index_that_is_there_twice_keeps_both_shapes);
    RUN_TEST(test_a_name_that_comes_again_is_shown_but_does_not_identify);
    RUN_TEST(test_names_that_stand_in_each_others_way_are_made_unique);
    RUN_TEST(test_texts_of_strangers_are_written_as_utf_8);
    RUN_TEST(test_a_size_without_a_type_gets_one);
    RUN_TEST(test_a_base_type_keeps_its_own_size);
    RUN_TEST(test_an_object_without_entries_is_kept);
    RUN_TEST(test_only_sub_index_0_is_simple_unless_it_is_called_otherwise);
    RUN_TEST(test_a_type_of_a_stranger_is_kept_by_its_name);
    RUN_TEST(test_access_is_written_as_far_as_it_is_known);
    RUN_TEST(test_a_comment_is_of_the_entry_before_the_object);
    const int failures = UNITY_END();
    free_schema();
    return failures;
}
