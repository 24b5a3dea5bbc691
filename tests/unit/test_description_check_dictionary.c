/* The cross-checker: objects, their data, type definitions and identity, each broken in one way. */
#include "broken_description.h"

void setUp(void) {}
void tearDown(void) {}

#define DEVICE(file) (&(file)->devices.at[0])

static cm1e_type_definition_t *add_type(cm1e_description_file_t *file, const char *name, int64_t bits)
{
    cm1e_type_definition_t *type = CM1E_APPEND(&file->arena, &DEVICE(file)->types);
    type->name = name;
    type->bits = bits;
    return type;
}

static void add_item(cm1e_description_file_t *file, cm1e_type_definition_t *type, int subindex, const char *name,
                     const char *item_type, int64_t bits, int64_t offset)
{
    cm1e_type_item_t *item = CM1E_APPEND(&file->arena, &type->items);
    *item = (cm1e_type_item_t){.has_subindex = subindex >= 0, .subindex = subindex >= 0 ? (uint8_t)subindex : 0,
                               .name = name, .type = item_type, .bits = bits, .offset = offset};
}

/* As an ESI has them: base types, a record with a gap behind sub-index 0 and without sub-index 3, an array in a record,
 * an enumeration. */
static void add_types(cm1e_description_file_t *file)
{
    add_type(file, "USINT", 8);
    add_type(file, "UINT", 16);
    add_type(file, "STRING(5)", 40);
    cm1e_type_definition_t *type = add_type(file, "DT1C32", 112);
    add_item(file, type, 0, "SubIndex 000", "USINT", 8, 0);
    add_item(file, type, 1, "Synchronization Type", "UINT", 16, 16);
    add_item(file, type, 2, "Cycle Time", "UDINT", 32, 32);
    add_item(file, type, 4, "Types supported", "UINT", 16, 96);
    type = add_type(file, "DT1C12ARR", 32);
    type->base_type = "UINT";
    type->is_array = true;
    type->lower_bound = 1;
    type->elements = 2;
    type = add_type(file, "DT1C12", 48);
    add_item(file, type, 0, "SubIndex 000", "USINT", 8, 0);
    add_item(file, type, -1, "Elements", "DT1C12ARR", 32, 16);
    add_type(file, "DT0800EN08", 8)->base_type = "USINT";
}

static void make_good(cm1e_description_file_t *file)
{
    const cm1e_device_options_t options = {.mapping = CM1E_MAPPING_CSP};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(file, &options, CM1E_ESI_FLAT, NULL));
    add_types(file);
    number_places(file);
}

static cm1e_type_definition_t *type_of(cm1e_description_file_t *file, const char *name)
{
    for (size_t i = 0; i < DEVICE(file)->types.count; i++)
        if (strcmp(DEVICE(file)->types.at[i].name, name) == 0)
            return &DEVICE(file)->types.at[i];
    TEST_FAIL();
    return NULL;
}

/* ---- objects ----------------------------------------------------------------------------------------------------- */

static cm1e_described_entry_t *entry(cm1e_description_file_t *file, uint16_t index, uint8_t subindex)
{
    return entry_in(&DEVICE(file)->objects, index, subindex);
}

static cm1e_place_t add_object_again(cm1e_description_file_t *file)
{
    const cm1e_described_object_t again = *object_in(&DEVICE(file)->objects, 0x1001);
    cm1e_described_object_t *object = CM1E_APPEND(&file->arena, &DEVICE(file)->objects);
    *object = again;
    object->place = 8000;
    return 8000;
}
static cm1e_place_t repeat_subindex(cm1e_description_file_t *file)
{
    cm1e_described_entry_t *serial = entry(file, 0x1018, 4);
    serial->subindex = 3;
    return serial->place;
}
static cm1e_place_t other_type(cm1e_description_file_t *file)
{
    entry(file, 0x6502, 0)->type = "UINT";
    return entry(file, 0x6502, 0)->place;
}
static cm1e_place_t other_named_type(cm1e_description_file_t *file)
{
    cm1e_described_object_t *object = object_in(&DEVICE(file)->objects, 0x1C32);
    object->type = "DT1C32";
    object->bits = 100;
    return object->place;
}
static cm1e_place_t unknown_named_type(cm1e_description_file_t *file)
{
    object_in(&DEVICE(file)->objects, 0x1C32)->type = "DT9999";
    return object_in(&DEVICE(file)->objects, 0x1C32)->place;
}

/* ---- data -------------------------------------------------------------------------------------------------------- */

static cm1e_place_t short_default(cm1e_description_file_t *file)
{
    entry(file, 0x6502, 0)->default_data.size = 2;
    return entry(file, 0x6502, 0)->place;
}
static cm1e_place_t long_maximum(cm1e_description_file_t *file)
{
    entry(file, 0x6098, 0)->maximum = cm1e_bytes_of(&file->arena, 0, 2);
    return entry(file, 0x6098, 0)->place;
}
static cm1e_place_t long_text(cm1e_description_file_t *file)
{
    static const uint8_t text[] = "CM1-E2";
    entry(file, 0x1008, 0)->default_data = (cm1e_bytes_t){text, 6};
    return entry(file, 0x1008, 0)->place;
}
static cm1e_place_t reverse_range(cm1e_description_file_t *file)
{
    entry(file, 0x6098, 0)->minimum = cm1e_bytes_of(&file->arena, 1, 1);
    return entry(file, 0x6098, 0)->place;
}
static cm1e_place_t default_too_large(cm1e_description_file_t *file)
{
    set_default(file, entry(file, 0x6098, 0), 1);
    return entry(file, 0x6098, 0)->place;
}
static cm1e_place_t default_too_small(cm1e_description_file_t *file)
{
    set_default(file, entry(file, 0x6098, 0), -7);
    entry(file, 0x6098, 0)->maximum = (cm1e_bytes_t){0};
    return entry(file, 0x6098, 0)->place;
}
static cm1e_place_t real_too_large(cm1e_description_file_t *file)
{
    static const uint8_t minus_two[] = {0, 0, 0, 0xC0}, minus_one[] = {0, 0, 0x80, 0xBF};
    cm1e_described_entry_t *real = entry(file, 0x6502, 0);
    real->type = "REAL";
    real->maximum = (cm1e_bytes_t){minus_two, 4};
    real->default_data = (cm1e_bytes_t){minus_one, 4};
    return real->place;
}

/* ---- types ------------------------------------------------------------------------------------------------------- */

static cm1e_place_t resize_type(cm1e_description_file_t *file, const char *name, int64_t bits)
{
    type_of(file, name)->bits = bits;
    return type_of(file, name)->place;
}
static cm1e_place_t resize_base(cm1e_description_file_t *file) { return resize_type(file, "UINT", 32); }
static cm1e_place_t resize_text(cm1e_description_file_t *file) { return resize_type(file, "STRING(5)", 48); }
static cm1e_place_t resize_array(cm1e_description_file_t *file)
{
    type_of(file, "DT1C12ARR")->elements = 3;
    return type_of(file, "DT1C12ARR")->place;
}
static cm1e_place_t resize_enumeration(cm1e_description_file_t *file) { return resize_type(file, "DT0800EN08", 16); }
static cm1e_place_t shorten_record(cm1e_description_file_t *file)
{
    type_of(file, "DT1C32")->bits = 104;
    return type_of(file, "DT1C32")->items.at[3].place;
}
static cm1e_place_t overlap_items(cm1e_description_file_t *file)
{
    type_of(file, "DT1C32")->items.at[2].offset = 24;
    return type_of(file, "DT1C32")->items.at[2].place;
}
static cm1e_place_t absurd_offset(cm1e_description_file_t *file)
{
    type_of(file, "DT1C32")->items.at[3].offset = INT64_MAX;
    return type_of(file, "DT1C32")->items.at[3].place;
}
static cm1e_place_t shorten_item(cm1e_description_file_t *file)
{
    type_of(file, "DT1C32")->items.at[2].bits = 16;
    return type_of(file, "DT1C32")->items.at[2].place;
}
static cm1e_place_t repeat_item(cm1e_description_file_t *file)
{
    type_of(file, "DT1C32")->items.at[3].subindex = 2;
    return type_of(file, "DT1C32")->items.at[3].place;
}
static cm1e_place_t unknown_item(cm1e_description_file_t *file)
{
    type_of(file, "DT1C32")->items.at[2].type = "DT9999";
    return type_of(file, "DT1C32")->items.at[2].place;
}
static cm1e_place_t unknown_elements(cm1e_description_file_t *file)
{
    type_of(file, "DT1C12ARR")->base_type = "DT9999";
    return type_of(file, "DT1C12ARR")->place;
}
static cm1e_place_t define_again(cm1e_description_file_t *file)
{
    add_type(file, "DT0800EN08", 8)->base_type = "USINT";
    DEVICE(file)->types.at[DEVICE(file)->types.count - 1].place = 8000;
    return 8000;
}
static cm1e_place_t two_of_each_other(cm1e_description_file_t *file)
{
    cm1e_type_definition_t *type = add_type(file, "DTB", 8);
    type->base_type = "DTA";
    type->place = 8001;
    type = add_type(file, "DTA", 8);
    type->base_type = "DTB";
    type->place = 8000;
    return 8001;
}
static cm1e_place_t made_of_itself(cm1e_description_file_t *file)
{
    cm1e_type_definition_t *type = add_type(file, "DTA", 8);
    add_item(file, type, 1, "a", "DTA", 8, 0);
    type->items.at[0].place = 8000;
    return 8000;
}

/* ---- identity ---------------------------------------------------------------------------------------------------- */

static cm1e_place_t identity(cm1e_description_file_t *file, uint8_t subindex)
{
    set_default(file, entry(file, 0x1018, subindex), 0x12345678);
    return entry(file, 0x1018, subindex)->place;
}
static cm1e_place_t other_vendor(cm1e_description_file_t *file) { return identity(file, 1); }
static cm1e_place_t other_product(cm1e_description_file_t *file) { return identity(file, 2); }
static cm1e_place_t other_revision(cm1e_description_file_t *file) { return identity(file, 3); }
static cm1e_place_t other_profile_information(cm1e_description_file_t *file)
{
    DEVICE(file)->channels.at[0].add_info = 2;
    return entry(file, 0x1000, 0)->place;
}
static cm1e_place_t other_profile(cm1e_description_file_t *file)
{
    DEVICE(file)->channels.at[0] = (cm1e_channel_t){.profile_no = 401, .add_info = -1};
    return entry(file, 0x1000, 0)->place;
}
static cm1e_place_t profile_of_no_channel(cm1e_description_file_t *file)
{
    DEVICE(file)->channels.at[0].profile_no = 401;
    cm1e_channel_t *channel = CM1E_APPEND(&file->arena, &DEVICE(file)->channels);
    channel->profile_no = 403;
    return entry(file, 0x1000, 0)->place;
}

static const broken_t breaks[] = {
    BREAKS(OBJECT_TWICE, add_object_again, "the object 0x1001 (Error Register) is in the dictionary twice"),
    BREAKS(SUBINDEX_TWICE, repeat_subindex, "0x1018 has sub-index 3 twice"),
    BREAKS(SUBINDEX_TWICE, repeat_item, "the type DT1C32 has sub-index 2 twice"),
    BREAKS(OBJECT_SIZE, other_type, "0x6502:00 has 32 bits; its type UINT has 16"),
    BREAKS(OBJECT_SIZE, other_named_type, "0x1C32 has 100 bits; its type DT1C32 has 112"),
    BREAKS(DATA_SIZE, short_default, "the default value of 0x6502:00 has 2 bytes; the sub-index has 32 bits, 4 bytes"),
    BREAKS(DATA_SIZE, long_maximum, "the maximum of 0x6098:00 has 2 bytes; the sub-index has 8 bits, 1 byte"),
    BREAKS(DATA_SIZE, long_text, "the default value of 0x1008:00 has 6 bytes; the sub-index has 40 bits, 5 bytes"),
    BREAKS(RANGE_EMPTY, reverse_range, "0x6098:00: the minimum 1 is above the maximum 0"),
    BREAKS(DEFAULT_OUT_OF_RANGE, default_too_large,
           "the default value 1 of 0x6098:00 is outside its range, -6 to 0"),
    BREAKS(DEFAULT_OUT_OF_RANGE, default_too_small,
           "the default value -7 of 0x6098:00 is outside its range, -6 to any"),
    BREAKS(DEFAULT_OUT_OF_RANGE, real_too_large,
           "the default value -1 of 0x6502:00 is outside its range, any to -2"),
    BREAKS(TYPE_SIZE, resize_base, "the type UINT is defined with 32 bits; it has 16"),
    BREAKS(TYPE_SIZE, resize_text, "the type STRING(5) is defined with 48 bits; it has 40"),
    BREAKS(TYPE_SIZE, resize_array,
           "the array type DT1C12ARR has 32 bits; its 3 elements of type UINT with 16 bits make 48"),
    BREAKS(TYPE_SIZE, resize_enumeration, "the type DT0800EN08 has 16 bits; its base type USINT has only 8"),
    BREAKS(TYPE_ITEM_SIZE, shorten_item, "Cycle Time in the type DT1C32 has 16 bits; its type UDINT has 32"),
    BREAKS(TYPE_ITEM_OFFSET, shorten_record,
           "Types supported in the type DT1C32 begins at bit 96 and has 16 bits; the type ends behind 104 bits"),
    BREAKS(TYPE_ITEM_OFFSET, overlap_items,
           "Cycle Time in the type DT1C32 begins at bit 24, within Synchronization Type, which ends before bit 32"),
    BREAKS(TYPE_ITEM_OFFSET, absurd_offset,
           "Types supported in the type DT1C32 begins at bit 9223372036854775807 and has 16 bits; the type ends behind "
           "112 bits"),
    BREAKS(TYPE_UNKNOWN, unknown_named_type,
           "0x1C32 is of the type DT9999, which is neither defined in the dictionary nor a base type"),
    BREAKS(TYPE_UNKNOWN, unknown_item,
           "Cycle Time is of the type DT9999, which is neither defined in the dictionary nor a base type"),
    BREAKS(TYPE_UNKNOWN, unknown_elements,
           "DT1C12ARR is of the type DT9999, which is neither defined in the dictionary nor a base type"),
    BREAKS(TYPE_TWICE, define_again, "the type DT0800EN08 is defined twice"),
    BREAKS(TYPE_LOOP, two_of_each_other, "the type DTB is made of the type DTA, which is made of it"),
    BREAKS(TYPE_LOOP, made_of_itself, "the type DTA is made of the type DTA, which is made of it"),
    BREAKS(IDENTITY_OBJECT, other_vendor,
           "0x1018:01 gives the vendor 0x12345678; the device is described with 0x00004441"),
    BREAKS(IDENTITY_OBJECT, other_product,
           "0x1018:02 gives the product code 0x12345678; the device is described with 0x44412002"),
    BREAKS(IDENTITY_REVISION, other_revision,
           "0x1018:03 gives the revision 0x12345678; the device is described with 0x20020103"),
    BREAKS(DEVICE_TYPE, other_profile_information,
           "0x1000 is 0x00040192; profile 402 with the additional information 2 is 0x00020192"),
    BREAKS(DEVICE_TYPE, other_profile,
           "0x1000 is 0x00040192; profile 401 with the additional information 0 is 0x00000191"),
    BREAKS(DEVICE_TYPE, profile_of_no_channel, "0x1000 is 0x00040192, profile 402, which no channel has"),
};

static void test_each_mistake_is_found_once_and_where_it_is(void)
{
    for (size_t i = 0; i < sizeof breaks / sizeof breaks[0]; i++)
        assert_found(&breaks[i], make_good);
}

/* ---- what is no mistake ------------------------------------------------------------------------------------------ */

/* A default of 0 in 0x1018 and 0x1000 is filled in by the device; a modular device has 5001 in 0x1000; several channels
 * have their additional information in 0xF010, not in 0x1000. */
static void test_identity_that_the_device_fills_in_is_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    for (uint8_t subindex = 1; subindex <= 3; subindex++)
        set_default(&file, entry(&file, 0x1018, subindex), 0);
    set_default(&file, entry(&file, 0x1000, 0), 0);
    assert_no_finding(&file);
    set_default(&file, entry(&file, 0x1000, 0), 0x00000192);
    cm1e_channel_t *channel = CM1E_APPEND(&file.arena, &DEVICE(&file)->channels);
    channel->profile_no = 402;
    assert_no_finding(&file);
    set_default(&file, entry(&file, 0x1000, 0), 5001);
    assert_no_finding(&file);
    DEVICE(&file)->channels.count = 0;
    set_default(&file, entry(&file, 0x1000, 0), 77);
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* A text shorter than its room; data of a type of unknown shape; a type whose name says what it is. */
static void test_what_is_not_known_is_no_mistake(void)
{
    cm1e_description_file_t file = {0};
    make_good(&file);
    entry(&file, 0x1008, 0)->default_data.size = 3;
    entry(&file, 0x6502, 0)->type = "DT6502";
    entry(&file, 0x6502, 0)->default_data.size = 1;
    entry(&file, 0x6502, 0)->maximum = cm1e_bytes_of(&file.arena, 0, 4);
    type_of(&file, "DT1C32")->items.at[2].type = "ARRAY [0..3] OF BYTE";
    type_of(&file, "DT1C12ARR")->base_type = "ARRAY [0..1] OF BYTE";
    assert_no_finding(&file);
    /* A text without its length, everywhere that a type is named; an object without its size. */
    type_of(&file, "DT1C12ARR")->base_type = "STRING";
    type_of(&file, "DT0800EN08")->base_type = "STRING";
    type_of(&file, "DT1C32")->items.at[2].type = "STRING";
    object_in(&DEVICE(&file)->objects, 0x1C33)->type = "STRING";
    object_in(&DEVICE(&file)->objects, 0x1C33)->bits = 77;
    object_in(&DEVICE(&file)->objects, 0x1C32)->type = "DT1C32";
    object_in(&DEVICE(&file)->objects, 0x1C32)->bits = 0;
    assert_no_finding(&file);
    cm1e_description_file_free(&file);
}

/* An enumeration needs no more bits than its values; an array of bits may fill its last byte; LREAL has 64 bits; what
 * is on the edge of its range is within. */
static void test_what_just_fits_is_no_mistake(void)
{
    static const uint8_t one[] = {0, 0, 0, 0, 0, 0, 0xF0, 0x3F}, two[] = {0, 0, 0, 0, 0, 0, 0, 0x40};
    cm1e_description_file_t file = {0};
    make_good(&file);
    type_of(&file, "DT0800EN08")->bits = 3;
    cm1e_type_definition_t *bits = add_type(&file, "DTBITS", 8);
    bits->base_type = "BOOL";
    bits->is_array = true;
    bits->elements = 5;
    add_type(&file, "DTBYTES", 16)->base_type = "ARRAY[0..1] OF BYTE";
    cm1e_described_entry_t *tried = entry(&file, 0x6502, 0);
    tried->type = "LREAL";
    tried->bits = 64;
    tried->minimum = tried->default_data = (cm1e_bytes_t){one, 8};
    tried->maximum = (cm1e_bytes_t){two, 8};
    assert_no_finding(&file);
    tried->default_data = tried->maximum;
    assert_no_finding(&file);
    tried->maximum = tried->minimum;
    assert_one_finding(&file, CM1E_RULE_DEFAULT_OUT_OF_RANGE, tried->place,
                       "the default value 2 of 0x6502:00 is outside its range, 1 to 1");
    tried->default_data = tried->minimum;
    type_of(&file, "DTBITS")->bits = 16;
    assert_one_finding(&file, CM1E_RULE_TYPE_SIZE, 0,
                       "the array type DTBITS has 16 bits; its 5 elements of type BOOL with 1 bits make 5");
    cm1e_description_file_free(&file);
}

/* Unsigned numbers of which the highest bit is set are above those without, signed ones below. */
static void test_ranges_know_signs(void)
{
    static const struct { const char *type; int64_t minimum, maximum, value; bool right; } cases[] = {
        {"UDINT", 0, 0xFFFFFFFF, 0x80000000, true}, {"UDINT", 0, 0x7FFFFFFF, 0x80000000, false},
        {"DINT", -5, 5, -1, true},                  {"DINT", -5, 5, -6, false},
        {"DINT", INT32_MIN, INT32_MAX, -1, true},   {"DWORD", 0, 0x7FFFFFFF, 0xFFFFFFFF, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cm1e_description_file_t file = {0};
        cm1e_findings_t *findings = cm1e_findings_create();
        make_good(&file);
        cm1e_described_entry_t *tried = entry(&file, 0x6502, 0);
        tried->type = cases[i].type;
        tried->minimum = cm1e_bytes_of(&file.arena, cases[i].minimum, 4);
        tried->maximum = cm1e_bytes_of(&file.arena, cases[i].maximum, 4);
        tried->default_data = cm1e_bytes_of(&file.arena, cases[i].value, 4);
        cm1e_check_description(findings, &file);
        TEST_ASSERT_EQUAL_MESSAGE(cases[i].right ? 0 : 1, cm1e_findings_count(findings), cases[i].type);
        cm1e_findings_free(findings);
        cm1e_description_file_free(&file);
    }
}

/* A chain of types as deep as a file likes, its end leading back to the start: one finding, no recursion. */
static void test_deep_chain_of_types_ends(void)
{
    enum { DEPTH = 100000 };
    cm1e_description_file_t file = {0};
    make_good(&file);
    for (int i = 0; i < DEPTH; i++) {
        cm1e_type_definition_t *type = add_type(&file, cm1e_arena_format(&file.arena, "DT_%d", i), 8);
        type->base_type = cm1e_arena_format(&file.arena, "DT_%d", (i + 1) % DEPTH);
    }
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_check_description(findings, &file);
    TEST_ASSERT_EQUAL(1, cm1e_findings_count(findings));
    TEST_ASSERT_EQUAL_STRING("type-loop", cm1e_findings_at(findings, 0)->rule);
    cm1e_findings_free(findings);
    cm1e_description_file_free(&file);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_mistake_is_found_once_and_where_it_is);
    RUN_TEST(test_identity_that_the_device_fills_in_is_no_mistake);
    RUN_TEST(test_what_is_not_known_is_no_mistake);
    RUN_TEST(test_what_just_fits_is_no_mistake);
    RUN_TEST(test_ranges_know_signs);
    RUN_TEST(test_deep_chain_of_types_ends);
    return UNITY_END();
}
