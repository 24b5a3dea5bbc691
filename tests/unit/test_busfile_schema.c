/* What holds for every key of a bus file alike, by a walk over the schema: a value of the wrong kind, a text that is
 * too long, a word that is none of its list, and an unknown key are refused at their place, with what is expected.
 * And each list at its largest length. */
#include <stdio.h>
#include <string.h>

#include "busfile/busfile.h"
#include "cm1e/config.h"
#include "unity.h"

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_schema.yaml";
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) {}

static bool loads(const char *text)
{
    cm1e_bus_config_t configs[CM1E_MAX_BUSES] = {0};
    uint32_t count;
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    fputs(text, file);
    TEST_ASSERT_EQUAL(0, fclose(file));
    const bool good = cm1e_bus_config_load_all(configs, CM1E_MAX_BUSES, &count, temporary, &diag) == CM1E_OK;
    for (int i = 0; i < CM1E_MAX_BUSES; i++)
        cm1e_bus_config_free(&configs[i]);
    return good;
}

/* Refused in this line and column with these words. */
static void expect_wrong(const char *text, unsigned line, unsigned column, const char *words)
{
    static char told[1 << 12];
    char place[300];
    snprintf(place, sizeof place, "%s:%u:%u: ", temporary, line, column);
    const bool good = loads(text);
    snprintf(told, sizeof told, "%.800s: expected \"%s%s\": %s", text, place, words, good ? "accepted" : diag.text);
    TEST_ASSERT_FALSE_MESSAGE(good, told);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(place, diag.text, strlen(place), told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, words), told);
}

/* ---- the walk ---------------------------------------------------------------------------------------------------- */

/* A place in a file: what stands before it and behind it, in one line, and the name by which it is told. */
typedef struct at {
    char before[200], behind[20], name[64];
} at_t;

static unsigned groups, lists, values; /* that the walk has seen */

static void expect_wrong_at(const at_t *at, const char *value, unsigned farther, const char *format, const char *last)
{
    char text[800], words[300];
    snprintf(text, sizeof text, "# the second line\n%s%s%s\n", at->before, value, at->behind);
    snprintf(words, sizeof words, format, at->name, last);
    expect_wrong(text, 2, (unsigned)strlen(at->before) + 1 + farther, words);
}

static at_t deeper(const at_t *at, const char *begin, const char *key, const char *end, const char *name)
{
    at_t to;
    snprintf(to.before, sizeof to.before, "%s%s%s%s", at->before, begin, key, key[0] ? ": " : "");
    snprintf(to.behind, sizeof to.behind, "%s%s", end, at->behind);
    snprintf(to.name, sizeof to.name, "%s", name);
    return to;
}

static void try_words(const at_t *at, const cyaml_schema_value_t *value)
{
    char words[200] = "";
    for (uint32_t i = 0; i < value->enumeration.count; i++)
        snprintf(words + strlen(words), sizeof words - strlen(words), "%s%s", i ? ", " : "",
                 value->enumeration.strings[i].str);
    for (uint32_t i = 0; i < value->enumeration.count; i++) { /* beside an axis, which a file needs */
        char file[400];
        const bool of_bus = strncmp(at->before, "{bus: ", 6) == 0;
        snprintf(file, sizeof file, "%s%s%s%s\n", of_bus ? "{axes: [{}], " : "{", at->before + 1,
                 value->enumeration.strings[i].str, at->behind);
        if (!loads(file))
            TEST_ASSERT_NULL_MESSAGE(strstr(diag.text, "expected one of"), diag.text);
    }
    expect_wrong_at(at, "qqqqqqqqq", 0, "%s is 'qqqqqqqqq'; expected one of: %s", words);
    expect_wrong_at(at, "\"qqqqqqqqq\"", 0, "%s is text in quotes; expected the value without them%s", "");
}

static void try_text(const at_t *at, const cyaml_schema_value_t *value)
{
    char text[400], words[100];
    TEST_ASSERT_LESS_THAN(sizeof text - 1, value->string.max);
    memset(text, 'q', value->string.max + 1);
    text[value->string.max + 1] = '\0';
    snprintf(words, sizeof words, ", %u bytes long; expected at most %u bytes", value->string.max + 1,
             value->string.max);
    expect_wrong_at(at, text, 0, "%s is 'qqqq", "");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, words), diag.text);
    expect_wrong_at(at, "\"a\\0b\"", 0, "%s holds a null character; expected text without it%s", "");
    text[value->string.max] = '\0'; /* the longest one: what is wrong with it is something else */
    char file[800];
    snprintf(file, sizeof file, "%s%s%s\n", at->before, text, at->behind);
    if (!loads(file))
        TEST_ASSERT_NULL_MESSAGE(strstr(diag.text, "bytes long"), diag.text);
}

static void try_number(const at_t *at, const cyaml_schema_value_t *value)
{
    static const char *const none[] = {"qqq", "1x", "0x1", "1.2.3", "1e", ".", "+-1"};
    const bool whole = value->type != CYAML_FLOAT;
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
        expect_wrong_at(at, none[i], 0, whole ? "%s is '%s'; expected a whole number, "
                                              : "%s is '%s'; expected a number", none[i]);
    if (whole)
        expect_wrong_at(at, "007", 0, "%s is '%s'; expected a whole number, ", "007");
    expect_wrong_at(at, "\"1\"", 0, "%s is text in quotes; expected the value without them%s", "");
}

static void try_value(const at_t *at, const cyaml_schema_value_t *value)
{
    values++;
    expect_wrong_at(at, "[1]", 0, "%s is a list; expected a single value%s", "");
    expect_wrong_at(at, "{a: 1}", 0, "%s is a group of keys; expected a single value%s", "");
    expect_wrong_at(at, "''", 0, "%s is empty; expected a value (leave the key out for its default)%s", "");
    expect_wrong_at(at, "~", 0, "%s is empty; expected a value%s", "");
    expect_wrong_at(at, "Null", 0, "%s is empty; expected a value%s", "");
    switch (value->type) {
    case CYAML_ENUM: try_words(at, value); break;
    case CYAML_STRING: try_text(at, value); break;
    case CYAML_BOOL: expect_wrong_at(at, "maybe", 0, "%s is 'maybe'; expected true or false%s", ""); break;
    default: try_number(at, value); break;
    }
}

static void walk(const at_t *at, const cyaml_schema_value_t *value);

static void walk_group(const at_t *at, const cyaml_schema_value_t *value)
{
    char keys[400] = "";
    groups++;
    for (const cyaml_schema_field_t *field = value->mapping.fields; field->key; field++)
        snprintf(keys + strlen(keys), sizeof keys - strlen(keys), "%s%s", field == value->mapping.fields ? "" : ", ",
                 field->key);
    expect_wrong_at(at, "qqq", 0, "%s is 'qqq'; expected a group with the keys: %s", keys);
    expect_wrong_at(at, "{qqqqqqqqq: 1}", 1, "unknown key 'qqqqqqqqq' in %s; expected one of: %s", keys);
    for (const cyaml_schema_field_t *field = value->mapping.fields; field->key; field++) {
        const at_t to = deeper(at, "{", field->key, "}", field->key);
        walk(&to, &field->value);
    }
}

static void walk(const at_t *at, const cyaml_schema_value_t *value)
{
    char name[80];
    if (value->type == CYAML_MAPPING) {
        walk_group(at, value);
    } else if (value->type == CYAML_SEQUENCE) {
        lists++;
        expect_wrong_at(at, "7", 0, "%s is '7'; expected a list, each entry beginning with '-'%s", "");
        expect_wrong_at(at, "{a: 1}", 0, "%s is a group of keys; expected a list%s", "");
        expect_wrong_at(at, "[]", 0, "%s is an empty list; expected at least one entry%s", "");
        snprintf(name, sizeof name, "%s[0]", at->name);
        const at_t to = deeper(at, "[", "", "]", name);
        walk(&to, value->sequence.entry);
    } else {
        try_value(at, value);
    }
}

static void test_each_key_has_its_kind_of_value(void)
{
    static const at_t file = {"", "", "the file"};
    walk(&file, &cm1e_busfile_schema);
    TEST_ASSERT_GREATER_THAN(20, groups);
    TEST_ASSERT_GREATER_THAN(10, lists);
    TEST_ASSERT_GREATER_THAN(120, values);
}

/* ---- lists ------------------------------------------------------------------------------------------------------- */

#define SLAVE(keys) "slaves:\n  - {position: 1, " keys "}\n"
#define SWITCHES "slaves: [{name: switches, position: 2}]\n"
#define FOUR_GAPS "gap/1, gap/2, gap/3, gap/4"
#define SIXTEEN_GAPS FOUR_GAPS ", " FOUR_GAPS ", " FOUR_GAPS ", " FOUR_GAPS

/* '@' is a list of such entries, of which there may be so many, and how more of them are told: the last two rows are of
 * several lists together. */
static const struct {
    const char *file, *entry;
    unsigned most;
    const char *words;
} full[] = {
    {"axes:\n [@]\n", "{alias: %u}", 512, "axes has 513 entries; expected at most 512"},
    {"slaves:\n [@]\n", "{alias: %u}", 512, "slaves has 513 entries; expected at most 512"},
    {"axes: [{inputs: {signals: [@]}}]\n" SWITCHES, "switches.input %u", 8,
     "signals has 9 entries; expected at most 8"},
    {"axes: [{outputs: {signals: [@]}}]\n" SWITCHES, "switches.output %u", 8,
     "signals has 9 entries; expected at most 8"},
    {SLAVE("sdo: [@]"), "{object: 0x8000:01, type: INT, value: %u}", 32, "sdo has 33 entries; expected at most 32"},
    {SLAVE("mapping: [{pdo: 0x1A00, entries: [@]}]"), "gap/%u", 32, "entries has 33 entries; expected at most 32"},
    {SLAVE("mapping: [@]"), "{pdo: 0x1A%02X, entries: [gap/1]}", 16, "mapping has 17 entries; expected at most 16"},
    {SLAVE("outputs_pdos: [@]"), "0x16%02X", 16, "outputs_pdos has 17 entries; expected at most 16"},
    {SLAVE("inputs_pdos: [@]"), "0x1A%02X", 16, "inputs_pdos has 17 entries; expected at most 16"},
    {SLAVE("modules: [@]"), "0x%X", 16, "modules has 17 entries; expected at most 16"},
    {SLAVE("inputs: [@]"), "{name: signal %u, bit: 0}", 64, "inputs has 65 entries; expected at most 64"},
    {SLAVE("outputs: [@]"), "{name: signal %u, bit: 0}", 64, "outputs has 65 entries; expected at most 64"},
    {SLAVE("inputs: [{name: a, bit: 0}, {name: b, bit: 0}], outputs: [@]"), "{name: signal %u, bit: 0}", 62,
     "inputs and outputs of a slave have at most 64 names"},
    {SLAVE("mapping: [{pdo: 0x1A00, entries: [" SIXTEEN_GAPS ", " SIXTEEN_GAPS "]}, {pdo: 0x1A01, entries: "
           "[" SIXTEEN_GAPS "]}, {pdo: 0x1A02, entries: [@]}]"), "gap/%u", 16,
     "the mapping of a slave has at most 64 entries in all PDOs"},
};

/* The file with so many entries; gives the place of the last one. */
static size_t write_list(char *text, size_t size, size_t row, unsigned count)
{
    const char *at = strchr(full[row].file, '@');
    size_t used = (size_t)(at - full[row].file), last = used;
    memcpy(text, full[row].file, used);
    for (unsigned i = 1; i <= count; i++) {
        used += (size_t)snprintf(text + used, size - used, "%s", i > 1 ? ", " : "");
        last = used;
        used += (size_t)snprintf(text + used, size - used, full[row].entry, i);
    }
    snprintf(text + used, size - used, "%s", at + 1);
    return last;
}

static void expect_too_long(const char *text, size_t row, size_t last)
{
    const bool entries = strstr(full[row].words, "entries"); /* else told at the list itself */
    const size_t place = entries ? last : (size_t)(strchr(full[row].file, '@') - full[row].file) - 1;
    unsigned line = 1, column = 1;
    for (size_t i = 0; i < place; i++) {
        column = text[i] == '\n' ? 1 : column + 1;
        line += text[i] == '\n';
    }
    expect_wrong(text, line, column, full[row].words);
}

static void test_each_list_is_full_and_no_longer(void)
{
    static char text[1 << 15];
    for (size_t row = 0; row < sizeof full / sizeof full[0]; row++) {
        write_list(text, sizeof text, row, full[row].most);
        const bool good = loads(text);
        TEST_ASSERT_TRUE_MESSAGE(good, diag.text);
        const size_t last = write_list(text, sizeof text, row, full[row].most + 1);
        expect_too_long(text, row, last);
    }
    /* Each list of a file of one bus is there. */
    TEST_ASSERT_EQUAL(lists + 2, sizeof full / sizeof full[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_key_has_its_kind_of_value);
    RUN_TEST(test_each_list_is_full_and_no_longer);
    return UNITY_END();
}
