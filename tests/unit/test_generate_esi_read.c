/* What the ESI reader makes of a file, element by element. */
#include <locale.h>

#include "device/device.h"
#include "esi_read_bench.h"
#include "generate/esi_read.h"

static const cm1e_description_t *device(size_t n)
{
    TEST_ASSERT_LESS_THAN(parsed.devices.count, n);
    return &parsed.devices.at[n];
}

static const cm1e_described_object_t *object(uint16_t index)
{
    const cm1e_described_object_t *found = cm1e_description_object(device(0), index);
    TEST_ASSERT_NOT_NULL(found);
    return found;
}

/* Of the first device. */
static const cm1e_described_entry_t *entry(uint16_t index, uint8_t subindex)
{
    const cm1e_described_entry_t *found = cm1e_description_entry(device(0), index, subindex);
    TEST_ASSERT_NOT_NULL(found);
    return found;
}

static void expect_bytes(const char *hexadecimal, cm1e_bytes_t bytes)
{
    char text[256] = "";
    for (size_t i = 0; i < bytes.size && i < 100; i++)
        sprintf(text + 2 * i, "%02X", bytes.data[i]);
    TEST_ASSERT_EQUAL_STRING(hexadecimal, text);
    TEST_ASSERT_EQUAL(*hexadecimal != '\0', bytes.data != NULL);
}

static void expect_entry(uint16_t index, uint8_t subindex, const char *name, const char *type, uint32_t bits,
                         uint8_t access, const char *data)
{
    const cm1e_described_entry_t *found = entry(index, subindex);
    TEST_ASSERT_EQUAL_STRING(name, found->name);
    TEST_ASSERT_EQUAL_STRING(type, found->type);
    TEST_ASSERT_EQUAL(bits, found->bits);
    TEST_ASSERT_EQUAL_HEX8(access, found->access);
    expect_bytes(data, found->default_data);
}

enum { RO = CM1E_ACCESS_READ, WO = CM1E_ACCESS_WRITE, RW = CM1E_ACCESS_READ | CM1E_ACCESS_WRITE };

/* ---- every element ---------------------------------------------------------------------------------------------- */

static void test_identity(void)
{
    good(every);
    TEST_ASSERT_EQUAL_STRING("every element that is read", parsed.comment);
    TEST_ASSERT_EQUAL_HEX32(0x4441, parsed.vendor_id);
    TEST_ASSERT_EQUAL_STRING("Works", parsed.vendor_name);
    TEST_ASSERT_EQUAL(line_of("<Vendor>"), parsed.vendor_place);
    TEST_ASSERT_EQUAL(2, parsed.devices.count);
    TEST_ASSERT_EQUAL(2, parsed.modules.count);
    const cm1e_description_t *d = device(0);
    TEST_ASSERT_EQUAL(line_of("<Device Physics"), d->place);
    TEST_ASSERT_EQUAL(line_of("<Type ProductCode"), d->identity_place);
    TEST_ASSERT_EQUAL_HEX32(0x4441, d->vendor_id);
    TEST_ASSERT_EQUAL_STRING("Works", d->vendor_name);
    TEST_ASSERT_TRUE(d->product_given && d->revision_given);
    TEST_ASSERT_EQUAL_HEX32(1, d->product_code);
    TEST_ASSERT_EQUAL_HEX32(0x20, d->revision);
    TEST_ASSERT_EQUAL_STRING("D1", d->type);
    TEST_ASSERT_EQUAL_STRING("Device <1>", d->name);
    TEST_ASSERT_EQUAL_STRING("c", d->comment);
    TEST_ASSERT_EQUAL_STRING("http://localhost/", d->url);
    TEST_ASSERT_EQUAL_STRING("YY", d->physics);
    TEST_ASSERT_EQUAL_STRING("G", d->group);
    TEST_ASSERT_EQUAL_STRING("Group", d->group_name);
}

static void test_info(void)
{
    good(every);
    const cm1e_description_t *d = device(0);
    TEST_ASSERT_EQUAL(2000, d->timeouts.preop);
    TEST_ASSERT_EQUAL(9000, d->timeouts.safeop_op);
    TEST_ASSERT_EQUAL(5000, d->timeouts.back_to_init);
    TEST_ASSERT_EQUAL(200, d->timeouts.back_to_safeop);
    TEST_ASSERT_EQUAL(100, d->timeouts.mailbox_request);
    TEST_ASSERT_EQUAL(300, d->timeouts.mailbox_response);
    TEST_ASSERT_EQUAL(4096, d->dpram_bytes);
    TEST_ASSERT_EQUAL(4, d->sync_managers_available);
    TEST_ASSERT_EQUAL(3, d->fmmus_available);
    TEST_ASSERT_TRUE(d->identification_reg134 && d->identification_reg134_given);
    TEST_ASSERT_EQUAL(1, d->channels.count);
    TEST_ASSERT_EQUAL(402, d->channels.at[0].profile_no);
    TEST_ASSERT_EQUAL(4, d->channels.at[0].add_info);
    TEST_ASSERT_EQUAL(line_of("<ChannelInfo><ProfileNo>402</ProfileNo><AddInfo>"), d->channels.at[0].place);
}

static void test_what_older_files_say(void)
{
    good(every);
    const cm1e_description_t *d = device(1);
    TEST_ASSERT_FALSE(d->product_given || d->revision_given);
    TEST_ASSERT_TRUE(d->identification_reg134 && d->identification_reg134_given);
    TEST_ASSERT_EQUAL(1, d->channels.count);
    TEST_ASSERT_EQUAL(5001, d->channels.at[0].profile_no);
    TEST_ASSERT_EQUAL(100, d->channels.at[0].add_info);
    TEST_ASSERT_TRUE(d->eeprom.config_known);
    TEST_ASSERT_EQUAL(0, d->eeprom.byte_size);
    expect_bytes("0506034400000000000000000000", d->eeprom.config_data);
    expect_bytes("0010800080108000", d->eeprom.bootstrap);
    good(with("<IdentificationAdo>#x134<", "<IdentificationAdo>#x12<"));
    TEST_ASSERT_TRUE(!device(1)->identification_reg134 && device(1)->identification_reg134_given);
    good(with("<Slots SlotPdoIncrement=\"#x10\" SlotIndexIncrement=\"#x800\">\n          <Slot ",
              "<Slots>\n          <Slot SlotPdoIncrement=\"3\" SlotIndexIncrement=\"4\" "));
    TEST_ASSERT_EQUAL(3, device(0)->slot_pdo_increment);
    TEST_ASSERT_EQUAL(4, device(0)->slot_index_increment);
    good(with("<RxPdo><Index>#x1601</Index><Name/><Exclude DependOnSlot=\"1\">#x1600</Exclude></RxPdo>",
              "<RxPdo Ref=\"elsewhere\" Sm=\"0\"/>"));
    TEST_ASSERT_EQUAL(2, device(0)->pdos.count);
}

/* The size of the EEPROM stands in word 0x3E of an image. */
static void test_eeprom_as_an_image(void)
{
    char image[2 * 128 + 1], text[400];
    memset(image, '0', sizeof image - 1);
    image[sizeof image - 1] = '\0';
    memcpy(image + 2 * 0x7C, "0F00", 4);
    snprintf(text, sizeof text, "<Data>%s</Data>", image);
    good(with("<ByteSize>2048</ByteSize><ConfigData>050603440A00</ConfigData><BootStrap>0010800080108000</BootStrap>",
              text));
    TEST_ASSERT_EQUAL(2048, device(0)->eeprom.byte_size);
    TEST_ASSERT_EQUAL(14, device(0)->eeprom.config_data.size);
    good(with("<ByteSize>2048</ByteSize><ConfigData>050603440A00</ConfigData><BootStrap>0010800080108000</BootStrap>",
              "<Data>00</Data>"));
    TEST_ASSERT_FALSE(device(0)->eeprom.config_known);
}

static void test_types_stay_as_they_are_written(void)
{
    good(every);
    const cm1e_type_list_t *types = &device(0)->types;
    TEST_ASSERT_EQUAL(8, types->count);
    const cm1e_type_definition_t *choice = &types->at[4], *record = &types->at[5], *array = &types->at[6];
    TEST_ASSERT_EQUAL_STRING("DT0800EN08", choice->name);
    TEST_ASSERT_EQUAL_STRING("USINT", choice->base_type);
    TEST_ASSERT_EQUAL_STRING("DT2000", record->name);
    TEST_ASSERT_NULL(record->base_type);
    TEST_ASSERT_EQUAL(40, record->bits);
    TEST_ASSERT_FALSE(record->is_array);
    TEST_ASSERT_EQUAL(3, record->items.count);
    TEST_ASSERT_TRUE(record->items.at[2].has_subindex);
    TEST_ASSERT_EQUAL(5, record->items.at[2].subindex);
    TEST_ASSERT_EQUAL_STRING("Level", record->items.at[2].name);
    TEST_ASSERT_EQUAL_STRING("UINT", record->items.at[2].type);
    TEST_ASSERT_EQUAL(16, record->items.at[2].bits);
    TEST_ASSERT_EQUAL(24, record->items.at[2].offset);
    TEST_ASSERT_EQUAL(0, record->items.at[2].access);
    TEST_ASSERT_EQUAL(line_of("<SubIdx>#x5") - 1, record->items.at[2].place);
    TEST_ASSERT_EQUAL_STRING("DT2001ARR", array->name);
    TEST_ASSERT_TRUE(array->is_array);
    TEST_ASSERT_EQUAL(1, array->lower_bound);
    TEST_ASSERT_EQUAL(3, array->elements);
    TEST_ASSERT_FALSE(types->at[7].items.at[1].has_subindex);
    TEST_ASSERT_EQUAL(line_of("<Name>DT2001ARR") - 1, array->place);
}

static void test_variables(void)
{
    good(every);
    const cm1e_described_object_t *type = object(0x1000);
    TEST_ASSERT_EQUAL(6, device(0)->objects.count);
    TEST_ASSERT_EQUAL(line_of("<Index>#x1000") - 1, type->place);
    TEST_ASSERT_EQUAL(CM1E_OBJECT_VAR, type->code);
    TEST_ASSERT_EQUAL_STRING("Device type", type->name);
    TEST_ASSERT_EQUAL_STRING("UINT", type->type);
    TEST_ASSERT_EQUAL(16, type->bits);
    TEST_ASSERT_FALSE(type->depends_on_slot);
    TEST_ASSERT_EQUAL(1, type->entries.count);
    expect_entry(0x1000, 0, "Device type", "UINT", 16, RO | CM1E_ACCESS_TXPDO, "9201");
    expect_bytes("0000", type->entries.at[0].minimum);
    expect_bytes("FFFF", type->entries.at[0].maximum);
    TEST_ASSERT_EQUAL_STRING("-", type->entries.at[0].unit);
    TEST_ASSERT_EQUAL_STRING("kind", type->entries.at[0].comment);
    expect_entry(0x1008, 0, "Name", "STRING(3)", 24, 0, "616263");
    expect_entry(0x1009, 0, "Factor", "REAL", 32, 0, "0000C03F");
}

static void test_records(void)
{
    good(every);
    const cm1e_described_object_t *record = object(0x2000);
    TEST_ASSERT_EQUAL(CM1E_OBJECT_RECORD, record->code);
    TEST_ASSERT_TRUE(record->depends_on_slot);
    TEST_ASSERT_EQUAL_STRING("DT2000", record->type);
    TEST_ASSERT_EQUAL(3, record->entries.count);
    expect_entry(0x2000, 0, "SubIndex 000", "USINT", 8, RO, "05");
    expect_entry(0x2000, 1, "Mode of it", "USINT", 8,
                 RW | CM1E_ACCESS_WRITE_PREOP_ONLY | CM1E_ACCESS_RXPDO | CM1E_ACCESS_TXPDO, "02");
    expect_bytes("01", entry(0x2000, 1)->minimum);
    expect_bytes("7F", entry(0x2000, 1)->maximum);
    TEST_ASSERT_EQUAL_STRING("V", entry(0x2000, 1)->unit);
    TEST_ASSERT_EQUAL_STRING("volts", entry(0x2000, 1)->comment);
    expect_entry(0x2000, 5, "Level", "UINT", 16, RW, "0102"); /* access of the object, value by name */
    TEST_ASSERT_EQUAL(line_of("<SubItem><Name>Level"), entry(0x2000, 5)->place);
    TEST_ASSERT_EQUAL(line_of("<Name>Mode</Name>") - 1, entry(0x2000, 1)->place);
}

static void test_arrays(void)
{
    good(every);
    TEST_ASSERT_EQUAL(CM1E_OBJECT_ARRAY, object(0x2001)->code);
    TEST_ASSERT_EQUAL(4, object(0x2001)->entries.count);
    expect_entry(0x2001, 0, "SubIndex 000", "USINT", 8, 0, "03");
    expect_entry(0x2001, 1, "First", "UINT", 16, WO, "0100");
    expect_entry(0x2001, 2, "Second", "UINT", 16, WO, "0200");
    expect_entry(0x2001, 3, "SubIndex 003", "UINT", 16, WO, "");
    expect_entry(0x2002, 0, "SubIndex 000", "USINT", 8, 0, "03"); /* out of the whole object's */
    expect_entry(0x2002, 1, "SubIndex 001", "UINT", 16, WO, "0100");
    expect_entry(0x2002, 3, "SubIndex 003", "UINT", 16, WO, "0300");
}

static void test_whole_default_that_is_too_short_says_what_it_can(void)
{
    good(with("<DefaultData>0300010002000300<", "<DefaultData>03000100<"));
    expect_entry(0x2002, 1, "SubIndex 001", "UINT", 16, WO, "0100");
    expect_entry(0x2002, 2, "SubIndex 002", "UINT", 16, WO, "");
}

static void test_array_bounds(void)
{
    good(with("<LBound>1</LBound><Elements>3</Elements>", "<LBound>0</LBound><Elements>3</Elements>"));
    TEST_ASSERT_EQUAL(1, object(0x2001)->entries.at[1].subindex);
    good(with("<LBound>1</LBound><Elements>3</Elements>", "<LBound>254</LBound><Elements>3</Elements>"));
    TEST_ASSERT_EQUAL(3, object(0x2001)->entries.count);
    TEST_ASSERT_EQUAL(255, object(0x2001)->entries.at[2].subindex);
    good(with("<LBound>1</LBound><Elements>3</Elements>", "<LBound>-7</LBound><Elements>0</Elements>"));
    TEST_ASSERT_EQUAL(1, object(0x2001)->entries.count);
    good(with("<LBound>1</LBound><Elements>3</Elements>", "<LBound>1</LBound><Elements>65535</Elements>"));
    TEST_ASSERT_EQUAL(256, object(0x2001)->entries.count);
    good(with("<ArrayInfo><LBound>1</LBound><Elements>3</Elements></ArrayInfo>",
              "<ArrayInfo><LBound>1</LBound><Elements>3</Elements></ArrayInfo>"
              "<ArrayInfo><LBound>1</LBound><Elements>2</Elements></ArrayInfo>"));
    TEST_ASSERT_EQUAL(7, object(0x2001)->entries.count);
}

/* Values of objects of a type: how each way to write them is read. */
static void test_values(void)
{
    static const struct {
        const char *type;
        int bits;
        const char *info, *data;
    } values[] = {
        {"USINT", 8, "<DefaultValue>255</DefaultValue>", "FF"},
        {"SINT", 8, "<DefaultValue>-2</DefaultValue>", "FE"},
        {"UINT", 16, "<DefaultValue>#x1A00</DefaultValue>", "001A"},
        {"DINT", 32, "<DefaultValue> -2147483648\n</DefaultValue>", "00000080"},
        {"UINT24", 24, "<DefaultValue>0x010203</DefaultValue>", "030201"},
        {"ULINT", 64, "<DefaultValue>18446744073709551615</DefaultValue>", "FFFFFFFFFFFFFFFF"},
        {"LINT", 64, "<DefaultValue>-9223372036854775808</DefaultValue>", "0000000000000080"},
        {"BOOL", 1, "<DefaultValue>1</DefaultValue>", "01"},
        {"REAL", 32, "<DefaultValue>-0.25</DefaultValue>", "000080BE"},
        {"LREAL", 64, "<DefaultValue>1.5e0</DefaultValue>", "000000000000F83F"},
        {"REAL", 32, "<DefaultValue>#x10</DefaultValue>", "10000000"},
        {"STRING(8)", 64, "<DefaultString>a b</DefaultString>", "612062"},
        {"USINT", 8, "<DefaultData>2</DefaultData>", "02"},
        {"UINT", 16, "<DefaultData/>", ""},
        {"UINT", 16, "<DefaultValue/>", ""},
        {"UINT", 16, "<DefaultString/>", ""},
        {"STRANGE", 0, "<DefaultValue>7</DefaultValue>", "07000000"},
        {"STRANGE", 128, "<DefaultValue>7</DefaultValue>", "0700000000000000"},
        {"UINT", 16, "<DefaultString>x</DefaultString><DefaultValue>1</DefaultValue><DefaultData>0200</DefaultData>",
         "0200"},
    };
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        char text[400];
        snprintf(text, sizeof text, "<Name>Factor</Name><Type>%s</Type><BitSize>%d</BitSize><Info>%s</Info>",
                 values[i].type, values[i].bits, values[i].info);
        good(with("<Name>Factor</Name><Type>REAL</Type><BitSize>32</BitSize>\n"
                  "                <Info><DefaultValue>1.5</DefaultValue></Info>", text));
        expect_bytes(values[i].data, entry(0x1009, 0)->default_data);
    }
}

static void test_numbers_do_not_depend_on_the_country(void)
{
    if (!setlocale(LC_ALL, "de_DE.UTF-8"))
        TEST_IGNORE_MESSAGE("there is no locale with a decimal comma on this machine");
    good(every);
    setlocale(LC_ALL, "C");
    expect_bytes("0000C03F", entry(0x1009, 0)->default_data);
}

static void test_types_of_single_values(void)
{
    static const struct {
        const char *type, *base;
        int code;
    } types[] = {{"BIT3", "BIT3", CM1E_OBJECT_VAR}, {"DT0800EN08", "USINT", CM1E_OBJECT_VAR}, {"nonsense", "", 0},
                 {"ARRAY [0..3] OF BYTE", "ARRAY [0..3] OF BYTE", CM1E_OBJECT_VAR}, {"DT2001ARR", "", 0}};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        char text[200];
        snprintf(text, sizeof text, "<Name>Factor</Name><Type>%s</Type><BitSize>0</BitSize><Info/>", types[i].type);
        good(with("<Name>Factor</Name><Type>REAL</Type><BitSize>32</BitSize>\n"
                  "                <Info><DefaultValue>1.5</DefaultValue></Info>", text));
        TEST_ASSERT_EQUAL_STRING(types[i].base, entry(0x1009, 0)->type);
        TEST_ASSERT_EQUAL_STRING(types[i].type, object(0x1009)->type);
        TEST_ASSERT_EQUAL(types[i].code, object(0x1009)->code);
        TEST_ASSERT_EQUAL(cm1e_type_bits(types[i].base), entry(0x1009, 0)->bits);
    }
}

/* A type that is its own base, by itself or by way of another. */
static void test_types_in_a_circle_have_no_base(void)
{
    good(with("<Name>DT0800EN08</Name><BaseType>USINT<", "<Name>DT0800EN08</Name><BaseType>DT0800EN08<"));
    TEST_ASSERT_EQUAL_STRING("", entry(0x2000, 1)->type);
}

static void test_items_of_info_find_their_entries(void)
{
    static const char *const was =
        "<SubItem><Name>SubIndex 000</Name><Info><DefaultValue>5</DefaultValue></Info></SubItem>\n"
        "                  <SubItem><Name>Level</Name><Info><DefaultData>0102</DefaultData></Info></SubItem>";
    good(with(was, "<SubItem><Name>Level</Name><Info><DefaultData>0102</DefaultData></Info></SubItem>"
                   "<SubItem><Name>SubIndex 000</Name><Info><DefaultData>09</DefaultData></Info></SubItem>"));
    expect_bytes("0102", entry(0x2000, 5)->default_data);
    expect_bytes("09", entry(0x2000, 0)->default_data);
    /* by their turn */
    good(with(was, "<SubItem><Name>number</Name><Info><DefaultData>0A</DefaultData></Info></SubItem>"
                   "<SubItem><Name>mode</Name><Info><DefaultData>0B</DefaultData></Info></SubItem>"));
    expect_bytes("0A", entry(0x2000, 0)->default_data);
    expect_bytes("0B", entry(0x2000, 1)->default_data);
    TEST_ASSERT_EQUAL_STRING("Mode of it", entry(0x2000, 1)->name);
    good(with(was, "<SubItem/><SubItem/><SubItem/><SubItem/><SubItem/>")); /* more than there are */
    TEST_ASSERT_EQUAL(3, object(0x2000)->entries.count);
}

static void test_process_data(void)
{
    good(every);
    const cm1e_description_t *d = device(0);
    TEST_ASSERT_EQUAL(3, d->pdos.count);
    const cm1e_described_pdo_t *out = &d->pdos.at[0], *other = &d->pdos.at[1], *in = &d->pdos.at[2];
    TEST_ASSERT_EQUAL(line_of("<RxPdo Fixed"), out->place);
    TEST_ASSERT_FALSE(out->transmit || out->depends_on_slot || out->is_virtual);
    TEST_ASSERT_TRUE(out->fixed && out->mandatory);
    TEST_ASSERT_EQUAL_HEX16(0x1600, out->index);
    TEST_ASSERT_EQUAL_STRING("Out", out->name);
    TEST_ASSERT_EQUAL(2, out->sync_manager);
    TEST_ASSERT_EQUAL(1, out->excludes.count);
    TEST_ASSERT_EQUAL_HEX16(0x1601, out->excludes.at[0].index);
    TEST_ASSERT_FALSE(out->excludes.at[0].depends_on_slot);
    TEST_ASSERT_EQUAL(line_of("<Exclude>#x1601"), out->excludes.at[0].place);
    TEST_ASSERT_EQUAL(1, out->entries.count);
    const cm1e_described_pdo_entry_t *level = &out->entries.at[0];
    TEST_ASSERT_EQUAL(line_of("<Exclude>#x1601") + 1, level->place);
    TEST_ASSERT_EQUAL_HEX16(0x2000, level->index);
    TEST_ASSERT_EQUAL(5, level->subindex);
    TEST_ASSERT_TRUE(level->depends_on_slot);
    TEST_ASSERT_EQUAL(16, level->bits);
    TEST_ASSERT_EQUAL_STRING("Level", level->name);
    TEST_ASSERT_EQUAL_STRING("UINT", level->type);
    TEST_ASSERT_EQUAL_STRING("how high", level->comment);
    TEST_ASSERT_EQUAL(CM1E_NO_SYNC_MANAGER, other->sync_manager);
    TEST_ASSERT_FALSE(other->fixed || other->mandatory);
    TEST_ASSERT_TRUE(other->excludes.at[0].depends_on_slot);
    TEST_ASSERT_TRUE(in->transmit && in->depends_on_slot);
    TEST_ASSERT_EQUAL(3, in->entries.count);
    TEST_ASSERT_EQUAL(0, in->entries.at[1].index);
    TEST_ASSERT_NULL(in->entries.at[1].name);
    TEST_ASSERT_EQUAL_STRING("", in->entries.at[1].type);
    TEST_ASSERT_NULL(in->entries.at[1].comment);
}

static void test_fmmus_and_sync_managers(void)
{
    good(every);
    const cm1e_description_t *d = device(0);
    TEST_ASSERT_EQUAL(3, d->fmmus.count);
    TEST_ASSERT_EQUAL(CM1E_FMMU_OUTPUTS, d->fmmus.at[0].use);
    TEST_ASSERT_EQUAL(CM1E_FMMU_INPUTS, d->fmmus.at[1].use);
    TEST_ASSERT_EQUAL(CM1E_FMMU_MAILBOX_STATE, d->fmmus.at[2].use);
    TEST_ASSERT_EQUAL(line_of("<Fmmu>MBoxState"), d->fmmus.at[2].place);
    TEST_ASSERT_EQUAL(4, d->sync_managers.count);
    const cm1e_described_sync_manager_t *out = &d->sync_managers.at[0];
    TEST_ASSERT_EQUAL(line_of("<Sm MinSize"), out->place);
    TEST_ASSERT_EQUAL_HEX16(0x1000, out->start);
    TEST_ASSERT_EQUAL(128, out->length);
    TEST_ASSERT_TRUE(out->length_given);
    TEST_ASSERT_EQUAL(34, out->minimum_length);
    TEST_ASSERT_EQUAL(192, out->maximum_length);
    TEST_ASSERT_EQUAL_HEX8(0x26, out->control);
    TEST_ASSERT_EQUAL(1, out->enable);
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL(CM1E_SM_MAILBOX_OUT + i, d->sync_managers.at[i].use);
    good(with("<Fmmu>MBoxState</Fmmu>", "<Fmmu/>"));
    TEST_ASSERT_EQUAL(CM1E_FMMU_UNUSED, device(0)->fmmus.at[2].use);
    good(with("<Sm DefaultSize=\"3\" StartAddress=\"#x1400\" ControlByte=\"#x20\" Enable=\"1\">Inputs</Sm>", "<Sm/>"));
    TEST_ASSERT_EQUAL(CM1E_SM_UNUSED, device(0)->sync_managers.at[3].use);
    TEST_ASSERT_FALSE(device(0)->sync_managers.at[3].length_given);
}

/** A number that is 0 is given all the same, and one that is left out is not. */
static void test_numbers_of_the_identity_that_are_0_or_left_out(void)
{
    static const char whole[] = "<Type ProductCode=\"#x1\" RevisionNo=\"#x20\">D1</Type>";
    for (int product = 0; product < 2; product++)
        for (int revision = 0; revision < 2; revision++) {
            char type[80];
            snprintf(type, sizeof type, "<Type%s%s>D1</Type>", product ? " ProductCode=\"0\"" : "",
                     revision ? " RevisionNo=\"#x0\"" : "");
            good(with(whole, type));
            TEST_ASSERT_EQUAL(product, device(0)->product_given);
            TEST_ASSERT_EQUAL(revision, device(0)->revision_given);
            TEST_ASSERT_EQUAL_HEX32(0, device(0)->product_code | device(0)->revision);
        }
}

/** Of equal names the one with the smallest number is found, in whatever order they came. */
static void test_names_are_found_in_whatever_order_they_came(void)
{
    static const char *const given[] = {"b", "a", "c", "a", "ab", "b", "B"};
    enum { NAMES = sizeof given / sizeof given[0] };
    static const size_t expected[NAMES] = {0, 1, 2, 1, 4, 0, 6};
    for (size_t first = 0; first < NAMES; first++) {
        cm1e_arena_t arena = {0};
        cm1e_xml_reader_t reader = {.arena = &arena};
        cm1e_esi_names_t names = {0};
        for (size_t i = 0; i < NAMES; i++)
            cm1e_esi_names_add(&reader, &names, given[(first + i) % NAMES], (first + i) % NAMES);
        cm1e_esi_names_sort(&names);
        for (size_t i = 0; i < NAMES; i++) {
            const size_t found = cm1e_esi_names_find(&names, given[i]);
            TEST_ASSERT_LESS_THAN_size_t(NAMES, found);
            TEST_ASSERT_EQUAL_STRING(given[i], names.at[found].name);
            TEST_ASSERT_EQUAL_size_t(expected[i], names.at[found].number);
        }
        TEST_ASSERT_EQUAL_size_t(NAMES, cm1e_esi_names_find(&names, "d"));
        TEST_ASSERT_EQUAL_size_t(NAMES, cm1e_esi_names_find(&names, ""));
        cm1e_arena_free(&arena);
    }
}

/** Other writers have brackets too: only "[unit] comment" is a unit, as our writer puts it. */
static void test_which_comments_begin_with_a_unit(void)
{
    static const struct {
        const char *text, *unit, *comment; /* comment NULL: none */
    } rows[] = {
        {"[V] volts", "V", "volts"}, {"[V] v", "V", "v"}, {"[V] a b", "V", "a b"}, {"[V]", "V", NULL}, {"[V] [x] y", "V", "[x] y"},
        {"[V]  volts", "", "[V]  volts"}, {"[V]volts", "", "[V]volts"}, {"[] volts", "", "[] volts"}, {"[V volts", "", "[V volts"},
        {"volts [V]", "", "volts [V]"}, {"x[V] y", "", "x[V] y"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char element[60];
        snprintf(element, sizeof element, "<Comment>%s</Comment>", rows[i].text);
        good(with("<Comment>[V] volts</Comment>", element));
        TEST_ASSERT_EQUAL_STRING_MESSAGE(rows[i].unit, entry(0x2000, 1)->unit, rows[i].text);
        if (rows[i].comment)
            TEST_ASSERT_EQUAL_STRING_MESSAGE(rows[i].comment, entry(0x2000, 1)->comment, rows[i].text);
        else
            TEST_ASSERT_NULL_MESSAGE(entry(0x2000, 1)->comment, rows[i].text);
    }
}

/** A finding about an entry names a line: that of its object, or of its item in a data type. */
static void test_every_entry_of_a_dictionary_has_a_place(void)
{
    unsigned entries = 0;
    good(every);
    const cm1e_object_list_t *objects = &device(0)->objects;
    for (size_t i = 0; i < objects->count; i++)
        for (size_t k = 0; k < objects->at[i].entries.count; k++, entries++)
            TEST_ASSERT_TRUE(objects->at[i].code == CM1E_OBJECT_VAR
                                 ? objects->at[i].entries.at[k].place == objects->at[i].place
                                 : objects->at[i].entries.at[k].place > 0);
    TEST_ASSERT_GREATER_THAN_UINT(3, entries);
}

static void test_mailbox(void)
{
    good(every);
    const cm1e_mailbox_protocols_t *m = &device(0)->mailbox;
    TEST_ASSERT_EQUAL(line_of("<Mailbox Data"), m->place);
    TEST_ASSERT_TRUE(m->present && m->coe && m->foe && m->eoe && m->soe && m->voe && m->aoe && m->data_link_layer);
    TEST_ASSERT_TRUE(m->sdo_info && m->pdo_assign && !m->pdo_config && m->pdo_upload && !m->complete_access &&
                     m->segmented_sdo);
    TEST_ASSERT_FALSE(device(1)->mailbox.present);
    TEST_ASSERT_EQUAL(1, device(0)->init_commands.count);
    const cm1e_init_command_t *command = &device(0)->init_commands.at[0];
    TEST_ASSERT_EQUAL(line_of("<InitCmd Fixed"), command->place);
    TEST_ASSERT_EQUAL_HEX8(CM1E_TRANSITION_PS | CM1E_TRANSITION_SO, command->transitions);
    TEST_ASSERT_EQUAL_HEX16(0x1C12, command->index);
    TEST_ASSERT_EQUAL(0, command->subindex);
    TEST_ASSERT_TRUE(command->fixed && command->complete_access && command->adapts && !command->depends_on_slot);
    expect_bytes("0100", command->data);
    TEST_ASSERT_EQUAL_STRING("x", command->comment);
    good(with("<AoE/><EoE/>", ""));
    TEST_ASSERT_FALSE(device(0)->mailbox.aoe || device(0)->mailbox.eoe);
}

static void test_clocks(void)
{
    good(every);
    TEST_ASSERT_EQUAL(1, device(0)->dc_modes.count);
    const cm1e_dc_mode_t *mode = &device(0)->dc_modes.at[0];
    TEST_ASSERT_EQUAL(line_of("<OpMode>"), mode->place);
    TEST_ASSERT_EQUAL_STRING("DC", mode->name);
    TEST_ASSERT_EQUAL_STRING("clock", mode->text);
    TEST_ASSERT_EQUAL_HEX16(0x730, mode->assign_activate);
    TEST_ASSERT_TRUE(mode->sync0_given && mode->sync1_given);
    TEST_ASSERT_EQUAL(0, mode->sync0_cycle_ns);
    TEST_ASSERT_EQUAL(1, mode->sync0_factor);
    TEST_ASSERT_EQUAL(1000, mode->sync0_shift_ns);
    TEST_ASSERT_EQUAL(500, mode->sync1_cycle_ns);
    TEST_ASSERT_EQUAL(-2, mode->sync1_factor);
    TEST_ASSERT_EQUAL(-7, mode->sync1_shift_ns);
}

static void test_slots_and_modules(void)
{
    good(every);
    const cm1e_description_t *d = device(0);
    TEST_ASSERT_EQUAL_HEX16(0x10, d->slot_pdo_increment);
    TEST_ASSERT_EQUAL_HEX16(0x800, d->slot_index_increment);
    TEST_ASSERT_EQUAL(2, d->slots.count);
    const cm1e_slot_t *axis = &d->slots.at[0], *any = &d->slots.at[1];
    TEST_ASSERT_EQUAL(line_of("<Slot MinInstances=\"0\""), axis->place);
    TEST_ASSERT_EQUAL_STRING("Axis", axis->name);
    TEST_ASSERT_EQUAL(0, axis->minimum_instances);
    TEST_ASSERT_EQUAL(2, axis->maximum_instances);
    TEST_ASSERT_EQUAL(2, axis->choices.count);
    TEST_ASSERT_TRUE(axis->choices.at[0].is_default && !axis->choices.at[1].is_default);
    TEST_ASSERT_EQUAL_HEX32(0x219800, axis->choices.at[1].ident);
    TEST_ASSERT_EQUAL(1, any->choices.count); /* by its class */
    TEST_ASSERT_EQUAL_HEX32(0x119800, any->choices.at[0].ident);
    const cm1e_module_t *module = &parsed.modules.at[0];
    TEST_ASSERT_EQUAL(line_of("<Type ModuleIdent=\"#x119800\"") - 1, module->place);
    TEST_ASSERT_EQUAL_HEX32(0x119800, module->ident);
    TEST_ASSERT_EQUAL_STRING("M1", module->type);
    TEST_ASSERT_EQUAL_STRING("csp", module->name);
    TEST_ASSERT_EQUAL(402, module->profile_no);
    TEST_ASSERT_EQUAL(2, module->profile_info);
    TEST_ASSERT_EQUAL(1, module->types.count);
    TEST_ASSERT_EQUAL(1, module->objects.count);
    TEST_ASSERT_EQUAL(1, module->pdos.count);
    TEST_ASSERT_EQUAL(1, module->init_commands.count);
    TEST_ASSERT_TRUE(module->init_commands.at[0].depends_on_slot);
    expect_bytes("FF", module->objects.at[0].entries.at[0].minimum);
    TEST_ASSERT_EQUAL(402, parsed.modules.at[1].profile_no);
    TEST_ASSERT_EQUAL(-1, parsed.modules.at[1].profile_info);
    TEST_ASSERT_EQUAL_STRING("x", parsed.modules.at[1].name); /* no English one */
}

/* ---- what is not stated ----------------------------------------------------------------------------------------- */

static void test_what_is_not_there_is_not_stated(void)
{
    cm1e_description_t expected;
    good("<EtherCATInfo><Vendor><Id>1</Id></Vendor><Descriptions><Devices><Device><Type/></Device></Devices>"
         "</Descriptions></EtherCATInfo>");
    cm1e_description_init(&expected);
    const cm1e_description_t *d = device(0);
    TEST_ASSERT_NULL(parsed.vendor_name);
    TEST_ASSERT_NULL(parsed.comment);
    TEST_ASSERT_FALSE(d->product_given || d->revision_given || d->identification_reg134_given || d->mailbox.present);
    TEST_ASSERT_EQUAL_STRING("", d->type);
    TEST_ASSERT_EQUAL_STRING("", d->name);
    TEST_ASSERT_EQUAL_STRING("", d->group);
    TEST_ASSERT_TRUE(!d->comment && !d->url && !d->group_name && !d->physics);
    TEST_ASSERT_EQUAL(-1, d->dpram_bytes);
    TEST_ASSERT_EQUAL_MEMORY(&expected.timeouts, &d->timeouts, sizeof expected.timeouts);
    TEST_ASSERT_EQUAL_MEMORY(&expected.eeprom, &d->eeprom, sizeof expected.eeprom);
    TEST_ASSERT_EQUAL(0, d->objects.count + d->pdos.count + d->channels.count + d->slots.count + d->dc_modes.count);
}

static void test_file_of_modules_alone(void)
{
    good("<EtherCATModule><Vendor><Id>1</Id></Vendor><Modules><Module><Type ModuleIdent='7'>m</Type></Module></Modules>"
         "</EtherCATModule>");
    TEST_ASSERT_EQUAL(1, parsed.modules.count);
    TEST_ASSERT_EQUAL(7, parsed.modules.at[0].ident);
    TEST_ASSERT_EQUAL(-1, parsed.modules.at[0].profile_no);
}

/* ---- a real file ------------------------------------------------------------------------------------------------ */

static void test_reference_file_of_two_axes(void)
{
    const char *schemas = getenv("CM1E_ESI_SCHEMAS");
    char path[1024];
    snprintf(path, sizeof path, "%s/../reference/ssc-cia402-two-axis-esi.xml",
             schemas ? schemas : CM1E_SOURCE_DIR "/../shared/schemas");
    char *text = load(path);
    if (!text)
        TEST_IGNORE_MESSAGE("the ESI of SSC's two-axis sample is not on this machine");
    const cm1e_error_t error = read_text(text);
    free(text);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, error, diag.text);
    TEST_ASSERT_EQUAL_HEX32(0x0048504D, parsed.vendor_id);
    TEST_ASSERT_EQUAL(1, parsed.devices.count);
    TEST_ASSERT_EQUAL(3, parsed.modules.count);
    const cm1e_description_t *d = device(0);
    TEST_ASSERT_EQUAL(17, d->place);
    TEST_ASSERT_EQUAL(18, d->identity_place);
    TEST_ASSERT_EQUAL(61440, d->dpram_bytes);
    TEST_ASSERT_EQUAL(2, d->channels.count);
    TEST_ASSERT_EQUAL(0, d->channels.at[1].add_info);
    TEST_ASSERT_EQUAL(17, d->objects.count);
    TEST_ASSERT_EQUAL(727 - 1, object(0x1018)->place);
    expect_entry(0x1018, 1, "Vendor ID", "UDINT", 32, RO, "4D504800");
    expect_entry(0x1C12, 2, "SubIndex 002", "UINT", 16, RW | CM1E_ACCESS_WRITE_PREOP_ONLY, "0000");
    TEST_ASSERT_EQUAL(855 + 1, entry(0x1C12, 2)->place);
    TEST_ASSERT_EQUAL(CM1E_OBJECT_ARRAY, object(0xF050)->code);
    expect_entry(0x1C32, 32, "Sync Error", "BOOL", 1, RO, "");
    TEST_ASSERT_EQUAL(13, object(0x1C32)->entries.count);
    TEST_ASSERT_EQUAL(4, d->sync_managers.count);
    TEST_ASSERT_EQUAL(1067, d->sync_managers.at[2].place);
    TEST_ASSERT_EQUAL(0x10C, d->sync_managers.at[0].maximum_length);
    TEST_ASSERT_EQUAL(2, d->dc_modes.count);
    TEST_ASSERT_EQUAL(2, d->slots.count);
    TEST_ASSERT_TRUE(d->slots.at[0].choices.at[2].is_default);
    expect_bytes("800C8166000000001234", d->eeprom.config_data);
    const cm1e_module_t *csp = &parsed.modules.at[1];
    TEST_ASSERT_EQUAL(1465, csp->place);
    TEST_ASSERT_EQUAL(1468, csp->pdos.at[0].place);
    TEST_ASSERT_EQUAL(64, cm1e_pdo_bits(&csp->pdos.at[0]));
    TEST_ASSERT_TRUE(csp->pdos.at[1].entries.at[0].depends_on_slot);
    TEST_ASSERT_EQUAL(18, csp->objects.count);
    expect_bytes("08", csp->init_commands.at[0].data);
    TEST_ASSERT_EQUAL(1522, csp->init_commands.at[0].place);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_identity);
    RUN_TEST(test_info);
    RUN_TEST(test_what_older_files_say);
    RUN_TEST(test_eeprom_as_an_image);
    RUN_TEST(test_types_stay_as_they_are_written);
    RUN_TEST(test_variables);
    RUN_TEST(test_records);
    RUN_TEST(test_arrays);
    RUN_TEST(test_whole_default_that_is_too_short_says_what_it_can);
    RUN_TEST(test_array_bounds);
    RUN_TEST(test_values);
    RUN_TEST(test_numbers_do_not_depend_on_the_country);
    RUN_TEST(test_types_of_single_values);
    RUN_TEST(test_types_in_a_circle_have_no_base);
    RUN_TEST(test_items_of_info_find_their_entries);
    RUN_TEST(test_process_data);
    RUN_TEST(test_fmmus_and_sync_managers);
    RUN_TEST(test_numbers_of_the_identity_that_are_0_or_left_out);
    RUN_TEST(test_names_are_found_in_whatever_order_they_came);
    RUN_TEST(test_which_comments_begin_with_a_unit);
    RUN_TEST(test_every_entry_of_a_dictionary_has_a_place);
    RUN_TEST(test_mailbox);
    RUN_TEST(test_clocks);
    RUN_TEST(test_slots_and_modules);
    RUN_TEST(test_what_is_not_there_is_not_stated);
    RUN_TEST(test_file_of_modules_alone);
    RUN_TEST(test_reference_file_of_two_axes);
    return UNITY_END();
}
