/* What is wrong with an ESI is told with its line; nothing that a file holds makes the reader crash, hang or take
 * memory without bounds. */
#include <ctype.h>

#include "chance.h"
#include "esi_read_bench.h"

enum { DAMAGED_FILES = 3000 };

/* Elements that hold a number, and attributes: by name, wherever they are. */
static const char *const number_elements[] = {
    "Id", "PreopTimeout", "SafeopOpTimeout", "BackToInitTimeout", "BackToSafeopTimeout", "RequestTimeout",
    "ResponseTimeout", "DpramSize", "SmCount", "FmmuCount", "IdentificationAdo", "ProfileNo", "AddInfo", "BitSize",
    "SubIdx", "BitOffs",
    "MinValue", "MaxValue", "LBound", "Elements", "Index", "Exclude", "SubIndex", "BitLen", "AssignActivate",
    "CycleTimeSync0", "ShiftTimeSync0", "CycleTimeSync1", "ShiftTimeSync1", "ModuleIdent", "ByteSize"};
static const char *const number_attributes[] = {
    "ProductCode", "RevisionNo", "LcId", "MinSize", "MaxSize", "DefaultSize", "StartAddress", "ControlByte", "Enable",
    "Sm", "Factor", "SlotPdoIncrement", "SlotIndexIncrement", "MinInstances", "MaxInstances", "Default", "ModuleIdent"};
static const char *const flag_attributes[] = {
    "DependOnSlot", "Fixed", "Mandatory", "Virtual", "DataLinkLayer", "SdoInfo", "PdoAssign", "PdoConfig", "PdoUpload",
    "CompleteAccess", "SegmentedSdo", "AdaptAutomatically"};
static const char *const byte_elements[] = {"MinData", "MaxData", "DefaultData", "Data", "ConfigData", "BootStrap"};
#define COUNT(list) (sizeof(list) / sizeof(list)[0])

static unsigned line_at(const char *at)
{
    unsigned line = 1;
    for (const char *c = every; c < at; c++)
        line += *c == '\n';
    return line;
}

/* The file with `instead` from `value` to the next `end`; the error must name it, in the line where its tag ends. */
static void put_and_read(const char *name, const char *tag, const char *value, char end, const char *instead)
{
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(value - every), every, instead, strchr(value, end));
    bad(changed, line_at(strchr(tag, '>')), name);
}

/* Every element of these names, one file after the other. */
static void sweep_elements(const char *const *names, size_t count, const char *instead)
{
    for (size_t i = 0; i < count; i++) {
        char begin[64];
        unsigned found = 0;
        snprintf(begin, sizeof begin, "<%s", names[i]);
        for (const char *at = every; (at = strstr(at, begin)) != NULL; at++) {
            const char *end = strchr(at, '>');
            const bool is_whole_name = at[strlen(begin)] == '>' || at[strlen(begin)] == ' ';
            if (is_whole_name && end[-1] != '/' && end[1] != '<') {
                put_and_read(names[i], at, end + 1, '<', instead);
                found++;
            }
        }
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, found, names[i]);
    }
}

static void sweep_attributes(const char *const *names, size_t count, const char *instead)
{
    for (size_t i = 0; i < count; i++) {
        char begin[64];
        unsigned found = 0;
        snprintf(begin, sizeof begin, " %s=\"", names[i]);
        for (const char *at = every; (at = strstr(at, begin)) != NULL; at++, found++)
            put_and_read(names[i], at, at + strlen(begin), '"', instead);
        TEST_ASSERT_GREATER_THAN_MESSAGE(0, found, names[i]);
    }
}

static void test_every_element_that_is_no_number_is_told(void)
{
    sweep_elements(number_elements, COUNT(number_elements), "1z");
}

static void test_every_element_beyond_its_range_is_told(void)
{
    static const char *const unbounded[] = {"MinValue", "MaxValue"}; /* 64 bits of whatever sign */
    for (size_t i = 0; i < COUNT(number_elements); i++)
        if (strcmp(number_elements[i], unbounded[0]) != 0 && strcmp(number_elements[i], unbounded[1]) != 0)
            sweep_elements(&number_elements[i], 1, "99999999999999");
}

static void test_every_attribute_that_is_no_number_is_told(void)
{
    sweep_attributes(number_attributes, COUNT(number_attributes), "#x");
}

static void test_every_flag_that_is_none_is_told(void)
{
    sweep_attributes(flag_attributes, COUNT(flag_attributes), "2");
}

static void test_bytes_that_are_none_are_told(void)
{
    sweep_elements(byte_elements, COUNT(byte_elements), "0x12");
    sweep_elements(byte_elements, COUNT(byte_elements), "123");
}

static void test_what_has_to_be_there_is_told(void)
{
    static const struct {
        const char *without, *words, *line_of;
    } needed[] = {
        {"<Id>#x4441</Id>", "<Vendor> has no <Id>", "<Vendor>"},
        {"<Type ProductCode=\"#x1\" RevisionNo=\"#x20\">D1</Type>", "<Device> has no <Type>", "<Device Physics"},
        {"<Type ModuleIdent=\"#x219800\">M2</Type>", "<Module> has no <Type>",
         "<Module><Type ModuleIdent=\"#x219800\""},
        {" ModuleIdent=\"#x219800\"", "no attribute ModuleIdent", "<Module><Type ModuleIdent=\"#x219800\""},
        {"<Index>#x1600</Index>", "<RxPdo> has no <Index>", "<RxPdo Fixed"},
        {"<Index>0</Index>", "<Entry> has no <Index>", "<Index>0</Index>"},
        {"<Index>0</Index><BitLen>8</BitLen>", "<Entry> has no <Index>", "<Index>0</Index>"},
        {"<BitLen>8</BitLen></Entry>\n          <Entry><Index>#x2001", "<Entry> has no <BitLen>", "<Index>0</Index>"},
        {"<Index>#x1C12</Index>", "<InitCmd> has no <Index>", "<InitCmd Fixed"},
        {"<Index>#x1000</Index>", "<Object> has no <Index>", NULL},
        {"<Name>STRING(3)</Name>", "<DataType> has no <Name>", "<Name>STRING(3)</Name>"},
    };
    for (size_t i = 0; i < COUNT(needed); i++) {
        const char *instead = strstr(needed[i].without, "</Entry>") ? "</Entry>\n          <Entry><Index>#x2001" : "";
        bad(with(needed[i].without, instead),
            needed[i].line_of ? line_of(needed[i].line_of) : line_of("<Index>#x1000</Index>") - 1, needed[i].words);
    }
}

static void test_other_documents_are_refused(void)
{
    static const struct {
        const char *text, *words;
    } others[] = {
        {"<EtherCATConfig/>", "EtherCATInfo"},
        {"<EtherCATInfo/>", "no <"},
        {"<EtherCATInfo><Vendor><Id>1</Id></Vendor></EtherCATInfo>", "no <Descriptions>"},
        {"<EtherCATInfo><Vendor><Id>1</Id></Vendor><Descriptions/></EtherCATInfo>", "neither a device nor a module"},
        {"<EtherCATModule><Vendor><Id>1</Id></Vendor></EtherCATModule>", "neither a device nor a module"},
    };
    for (size_t i = 0; i < COUNT(others); i++)
        bad(others[i].text, 1, others[i].words);
    TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, read_text(""));
    TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, cm1e_esi_read(&parsed, "x", 1, NULL)); /* no diag */
}

static void test_the_first_error_is_told(void)
{
    with("<Id>#x4441", "<Id>none");
    char *second = strstr(changed, "<ByteSize>2048");
    second[strlen("<ByteSize>")] = 'x';
    bad(changed, line_of("<Id>#x4441"), "Id is \"none\"");
}

/* Whatever is not known may stand anywhere. */
static void test_unknown_elements_and_attributes_do_not_matter(void)
{
    cm1e_file_t expected = {0}, written = {0};
    good(every);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_esi_write(&expected, &parsed, &diag));
    char *text = malloc(16 * strlen(every)), *to = text;
    TEST_ASSERT_NOT_NULL(text);
    const char *const vendor = strstr(every, "<Vendor>"), *from = every;
    to = stpncpy(to, from, 5);
    from += 5;
    for (bool in_tag = false, in_data = false; *from; from++) {
        in_data |= strncmp(from, "<!", 2) == 0;
        const bool begins = !in_data && *from == '<' && isalpha((unsigned char)from[1]);
        if (begins && from >= vendor)
            to += sprintf(to, "<Unknown Index='x'><Index>x</Index><Unknown/></Unknown>");
        in_tag |= begins;
        if (in_tag && (*from == '>' || (*from == '/' && from[1] == '>'))) {
            to += sprintf(to, " Unknown='x'");
            in_tag = false;
        }
        in_data &= strncmp(from - 2, "]]>", 3) != 0 && strncmp(from - 2, "-->", 3) != 0;
        *to++ = *from;
    }
    *to = '\0';
    good(text);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_esi_write(&written, &parsed, &diag));
    TEST_ASSERT_EQUAL_STRING(expected.bytes, written.bytes);
    free(text);
    cm1e_file_free(&expected);
    cm1e_file_free(&written);
}

static void test_every_prefix_is_refused(void)
{
    const size_t size = strlen(strstr(every, "<EtherCATInfo")), skipped = strlen(every) - size;
    const size_t whole = size - strlen(strstr(every, "</EtherCATInfo>")) + strlen("</EtherCATInfo>") - 1;
    for (size_t length = 0; length <= whole; length++) {
        char *tight = malloc(skipped + length + 1);
        TEST_ASSERT_NOT_NULL(tight);
        memcpy(tight, every, skipped + length);
        char *exact = realloc(tight, skipped + length); /* a sanitizer sees what is read behind it */
        TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, read_bytes(exact, skipped + length));
        TEST_ASSERT_EQUAL_STRING_LEN("line ", diag.text, 5);
        free(exact);
    }
}

/* Read, or an error with a line: nothing else, and what was read can be written and read again to the same. */
static void damage_and_read(unsigned seed)
{
    char *text = strdup(every), name[64];
    cm1e_file_t first = {0}, second = {0};
    const size_t size = strlen(text);
    chance_seed(seed);
    for (int times = 1 + pick(4); times > 0; times--) {
        const size_t at = (size_t)pick((int)size), from = (size_t)pick((int)size), count = (size_t)pick(40);
        if (one_in(2))
            text[at] = (char)(one_in(3) ? chance() : (uint64_t)"0123456789#x<>/&\"' "[pick(19)]);
        else if (at + count < size && from + count < size)
            memmove(text + at, text + from, count);
    }
    snprintf(name, sizeof name, "CM1E_TEST_SEED=%u", seed);
    const cm1e_error_t error = read_bytes(text, size);
    free(text);
    if (error != CM1E_OK) {
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_FILE, error, name);
        TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE("line ", diag.text, 5, name);
        return;
    }
    if (cm1e_esi_write(&first, &parsed, &diag) == CM1E_OK) {
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, read_bytes(first.bytes, first.size), name);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_esi_write(&second, &parsed, &diag), name);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(first.bytes, second.bytes, name);
    }
    cm1e_file_free(&first);
    cm1e_file_free(&second);
}

static void test_damaged_files(void)
{
    for (int run = 0; run < seed_count(DAMAGED_FILES); run++)
        damage_and_read(seed_of(run));
}

/* What fuzzing found: read, written and read again these were not the same, or were refused. */
static void test_what_fuzzing_found(void)
{
    static const struct {
        const char *was, *is;
    } found[] = {
        {"<ChannelInfo><ProfileNo>402</ProfileNo><AddInfo>4</AddInfo></ChannelInfo>", "<ChannelInfo/>"},
        {"<BitSize>16</BitSize><BitOffs>24</BitOffs>", "<BitSize>4294967295</BitSize><BitOffs>24</BitOffs>"},
        {"Mode of it</DisplayName><Type>DT0800EN08<", "Mode of it</DisplayName><Type>DT2001ARR<"},
        {"<Mailbox><Timeout><RequestTimeout>100</RequestTimeout>", "<Mailbox><Timeout>"},
        {"<Elements>3</Elements>", "<Elements>0</Elements>"},
        {"</DataTypes>\n            <Objects>\n", /* an array without elements, a record like it */
         "<DataType><Name>X</Name><SubItem><SubIdx>0</SubIdx><Name>n</Name><Type>USINT</Type></SubItem></DataType>"
         "<DataType><Name>YARR</Name><ArrayInfo><Elements>0</Elements></ArrayInfo></DataType>"
         "<DataType><Name>Y</Name><SubItem><SubIdx>0</SubIdx><Name>n</Name><Type>USINT</Type></SubItem>"
         "<SubItem><Name>E</Name><Type>YARR</Type></SubItem></DataType></DataTypes><Objects>"
         "<Object><Index>1</Index><Type>X</Type></Object><Object><Index>2</Index><Type>Y</Type></Object>"},
        {"<Name>Mode</Name><DisplayName>Mode of it</DisplayName>", "<Name/>"},
    };
    for (size_t i = 0; i < COUNT(found); i++) {
        cm1e_file_t first = {0}, second = {0};
        good(with(found[i].was, found[i].is));
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_esi_write(&first, &parsed, &diag));
        good((const char *)first.bytes);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_esi_write(&second, &parsed, &diag));
        TEST_ASSERT_EQUAL_STRING(first.bytes, second.bytes);
        cm1e_file_free(&first);
        cm1e_file_free(&second);
    }
}

/* ---- few bytes that ask for much -------------------------------------------------------------------------------- */

static char *big, *big_end;

static void begin_big(size_t room)
{
    big = malloc(room);
    TEST_ASSERT_NOT_NULL(big);
    big_end = stpcpy(big, "<EtherCATInfo><Vendor><Id>1</Id></Vendor><Descriptions>");
}

static cm1e_error_t read_big(const char *end)
{
    big_end = stpcpy(big_end, end);
    const cm1e_error_t error = read_bytes(big, (size_t)(big_end - big));
    free(big);
    return error;
}

static void test_objects_of_many_elements_take_bounded_memory(void)
{
    enum { OBJECTS = 30000 };
    begin_big((size_t)100 * OBJECTS + 4096);
    big_end = stpcpy(big_end, "<Devices><Device><Type/><Profile><Dictionary><DataTypes>"
                              "<DataType><Name>A</Name><BaseType>USINT</BaseType><ArrayInfo><LBound>1</LBound>"
                              "<Elements>255</Elements></ArrayInfo></DataType>"
                              "<DataType><Name>T</Name><SubItem><Type>A</Type></SubItem></DataType></DataTypes>"
                              "<Objects>");
    for (int i = 0; i < OBJECTS; i++)
        big_end = stpcpy(big_end, "<Object><Index>1</Index><Type>T</Type></Object>");
    TEST_ASSERT_EQUAL(CM1E_ERROR_NO_MEMORY, read_big("</Objects></Dictionary></Profile></Device></Devices>"
                                                     "</Descriptions></EtherCATInfo>"));
    TEST_ASSERT_LESS_OR_EQUAL(CM1E_ARENA_LIMIT, parsed.arena.used);
}

static void test_names_are_found_among_many(void)
{
    enum { TYPES = 60000 };
    begin_big((size_t)200 * TYPES + 4096);
    big_end = stpcpy(big_end, "<Devices><Device><Type/><Profile><Dictionary><DataTypes>");
    for (int i = 0; i < TYPES; i++)
        big_end += sprintf(big_end, "<DataType><Name>%d</Name><BaseType>%d</BaseType></DataType>", i, TYPES - i);
    big_end = stpcpy(big_end, "</DataTypes><Objects>");
    for (int i = 0; i < TYPES; i++)
        big_end += sprintf(big_end, "<Object><Index>1</Index><Type>%d</Type></Object>", i);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, read_big("</Objects></Dictionary></Profile></Device></Devices></Descriptions>"
                                                "</EtherCATInfo>"), diag.text);
    TEST_ASSERT_EQUAL(TYPES, parsed.devices.at[0].objects.count);
}

static void test_slots_that_take_every_module_take_bounded_memory(void)
{
    enum { MODULES = 20000, SLOTS = 5000 };
    begin_big((size_t)100 * (MODULES + SLOTS) + 4096);
    big_end = stpcpy(big_end, "<Modules>");
    for (int i = 0; i < MODULES; i++)
        big_end = stpcpy(big_end, "<Module><Type ModuleIdent='1' ModuleClass='c'/></Module>");
    big_end = stpcpy(big_end, "</Modules><Devices><Device><Type/><Slots>");
    for (int i = 0; i < SLOTS; i++)
        big_end = stpcpy(big_end, "<Slot><ModuleClass><Class>c</Class></ModuleClass></Slot>");
    TEST_ASSERT_EQUAL(CM1E_ERROR_NO_MEMORY, read_big("</Slots></Device></Devices></Descriptions></EtherCATInfo>"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_element_that_is_no_number_is_told);
    RUN_TEST(test_every_element_beyond_its_range_is_told);
    RUN_TEST(test_every_attribute_that_is_no_number_is_told);
    RUN_TEST(test_every_flag_that_is_none_is_told);
    RUN_TEST(test_bytes_that_are_none_are_told);
    RUN_TEST(test_what_has_to_be_there_is_told);
    RUN_TEST(test_other_documents_are_refused);
    RUN_TEST(test_the_first_error_is_told);
    RUN_TEST(test_unknown_elements_and_attributes_do_not_matter);
    RUN_TEST(test_every_prefix_is_refused);
    RUN_TEST(test_damaged_files);
    RUN_TEST(test_what_fuzzing_found);
    RUN_TEST(test_objects_of_many_elements_take_bounded_memory);
    RUN_TEST(test_names_are_found_among_many);
    RUN_TEST(test_slots_that_take_every_module_take_bounded_memory);
    return UNITY_END();
}
