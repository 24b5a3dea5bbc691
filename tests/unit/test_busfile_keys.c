/* Which keys an axis without a motor may have; where the file of an ESI is looked for; which entry of a list is told;
 * how large a file may be; and names and idents as they may be. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "busfile/busfile.h"
#include "config/esi_reader.h"
#include "unity.h"

static const char folder[] = CM1E_TEST_OUTPUT, name[] = "busfile_keys.yaml";
static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_keys.yaml";
static cm1e_bus_config_t config;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) { cm1e_bus_config_free(&config); }

static cm1e_error_t load_at(const char *path, const char *text)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    fputs(text, file);
    TEST_ASSERT_EQUAL(0, fclose(file));
    cm1e_bus_config_free(&config);
    return cm1e_bus_config_load(&config, path, &diag);
}

static cm1e_error_t load(const char *text) { return load_at(temporary, text); }

/* ---- axes without a motor ---------------------------------------------------------------------------------------- */

/* What docs/BUS-FILE.md allows, at `type`: of the first ones all that is in the group. */
static const char *const of_both[] = {"name", "type", "unit.", "encoder_filter_s", "encoder_signal", "inputs.signals",
                                      "outputs.signals", NULL};
static const char *const of_virtual[] = {"limits.velocity", "limits.acceleration", "limits.deceleration", "limits.jerk",
                                         "software_limits.", "jog.", "table_profiles", "follows", "cam_points",
                                         "coupling_stop", NULL};
/* Groups that are told as a whole. */
static const char *const wholes[] = {"inputs.", "homing.", "drive.", "dc.", "sim.", "software_limits.", NULL};

static bool is_one_of(const char *const *list, const char *path)
{
    for (; *list; list++) {
        const size_t length = strlen(*list);
        if ((*list)[length - 1] == '.' ? strncmp(path, *list, length) == 0 : strcmp(path, *list) == 0)
            return true;
    }
    return false;
}

/* A value of this key that is not its default. */
static const char *value_of(const char *path, const cyaml_schema_value_t *value)
{
    static const char *const texts[][2] = {
        {"name", "x"}, {"device", "cia402"}, {"motor", "CM1"}, {"firmware", "1.3.5"}, {"encoder_signal", "s.count"},
        {"inputs.signals", "[s.input 1]"}, {"outputs.signals", "[s.output 1]"}, {"inputs.home", "2"},
        {"inputs.limit_positive", "2"}, {"inputs.limit_negative", "2"}, {"drive.outputs_pdo", "0x1600"},
        {"drive.inputs_pdo", "0x1A00"}, {"dc.mode", "first"}};
    if (value->type == CYAML_ENUM)
        return value->enumeration.strings[value->enumeration.count - 1].str;
    if (value->type == CYAML_BOOL)
        return "true";
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        if (strcmp(texts[i][0], path) == 0)
            return texts[i][1];
    TEST_ASSERT_TRUE_MESSAGE(value->type != CYAML_STRING && value->type != CYAML_SEQUENCE, path);
    return strcmp(path, "drive.counts_per_revolution") == 0 ? "100" : strcmp(path, "cam_points") == 0 ? "9" : "1";
}

static void try_key(const char *type, const char *path, const cyaml_schema_value_t *value)
{
    char text[300], told[700], words[100];
    const char *dot = strchr(path, '.'), *last = dot ? dot + 1 : path;
    const bool is_virtual = strcmp(type, "virtual") == 0;
    const bool allowed = is_one_of(of_both, path) || (is_virtual && is_one_of(of_virtual, path));
    snprintf(text, sizeof text, "axes: [{type: %s, %.*s%s%s: %s%s}]\nslaves: [{name: s, position: 2}]\n", type,
             dot ? (int)(dot - path) : 0, path, dot ? ": {" : "", last, value_of(path, value), dot ? "}" : "");
    if (strcmp(path, "type") == 0)
        return;
    const cm1e_error_t error = load(text);
    snprintf(told, sizeof told, "%s=> %s", text, diag.text);
    if (allowed) {
        TEST_ASSERT_TRUE_MESSAGE(error == CM1E_OK || !strstr(diag.text, "no such key"), told);
        return;
    }
    const int shown = is_one_of(wholes, path) && strcmp(path, "sim.absent") != 0 ? (int)(dot - path) : 99;
    snprintf(words, sizeof words, "axis axis1: %.*s is given, and the axis is %s", shown, path,
             is_virtual ? "virtual" : "an encoder");
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, error, told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, words), told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "expected no such key"), told);
}

static const cyaml_schema_field_t *axis_keys(void)
{
    for (const cyaml_schema_field_t *field = cm1e_busfile_schema.mapping.fields; field->key; field++)
        if (strcmp(field->key, "axes") == 0)
            return field->value.sequence.entry->mapping.fields;
    TEST_FAIL_MESSAGE("axes");
    return NULL;
}

static void test_an_axis_without_a_motor_has_no_keys_of_one(void)
{
    static const char *const types[] = {"virtual", "encoder"};
    for (int i = 0; i < 2; i++)
        for (const cyaml_schema_field_t *field = axis_keys(); field->key; field++) {
            if (field->value.type != CYAML_MAPPING) {
                try_key(types[i], field->key, &field->value);
                continue;
            }
            for (const cyaml_schema_field_t *own = field->value.mapping.fields; own->key; own++) {
                char path[80];
                snprintf(path, sizeof path, "%s.%s", field->key, own->key);
                try_key(types[i], path, &own->value);
            }
        }
}

/* ---- the file of an ESI ------------------------------------------------------------------------------------------ */

static char read_path[600];
static cm1e_error_t answer;
static const char *words = "told by the reader";

static cm1e_error_t read_esi(cm1e_slave_config_t *slave, const char *path, const char *mode, int64_t cycle_time_ns,
                             cm1e_diag_t *told)
{
    (void)slave;
    (void)mode;
    (void)cycle_time_ns;
    snprintf(read_path, sizeof read_path, "%s", path);
    return cm1e_diag_set(told, answer, 0, "%s", answer == CM1E_OK ? "" : words);
}

static void test_an_esi_is_beside_the_bus_file(void)
{
    char before[400], expected[500], text[500];
    cm1e_esi_register_reader(read_esi);
    TEST_ASSERT_EQUAL(CM1E_OK, load("slaves: [{position: 1, esi: maker.xml}]\n"));
    snprintf(expected, sizeof expected, "%s/maker.xml", folder);
    TEST_ASSERT_EQUAL_STRING(expected, read_path);
    TEST_ASSERT_EQUAL_STRING(expected, config.slaves[0].esi);
    TEST_ASSERT_EQUAL(CM1E_OK, load("slaves: [{position: 1, esi: /opt/maker.xml}]\n"));
    TEST_ASSERT_EQUAL_STRING("/opt/maker.xml", read_path);
    TEST_ASSERT_NOT_NULL(getcwd(before, sizeof before));
    TEST_ASSERT_EQUAL(0, chdir(folder)); /* a path without a folder */
    const cm1e_error_t error = load_at(name, "slaves: [{position: 1, esi: maker.xml}]\n");
    TEST_ASSERT_EQUAL(0, chdir(before));
    TEST_ASSERT_EQUAL(CM1E_OK, error);
    TEST_ASSERT_EQUAL_STRING("maker.xml", read_path);
    /* The longest path, and one byte more. */
    for (int more = 0; more < 2; more++) {
        const int room = (int)sizeof config.slaves->esi - 1 - (int)strlen(folder) - 1 + more;
        snprintf(text, sizeof text, "slaves:\n  - {position: 1, esi: %0*d}\n", room, 0);
        TEST_ASSERT_EQUAL_MESSAGE(more ? CM1E_ERROR_CONFIG : CM1E_OK, load(text), diag.text);
    }
    snprintf(expected, sizeof expected, ":2:24: the path of the ESI is longer than %zu bytes",
             sizeof config.slaves->esi - 1);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, expected), diag.text);
}

static void test_what_the_reader_of_an_esi_tells(void)
{
    cm1e_esi_register_reader(read_esi);
    answer = CM1E_ERROR_CONFIG;
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, load("slaves:\n  - {position: 1, esi: maker.xml}\n"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, ":2:24: maker.xml: told by the reader"), diag.text);
    /* An OpMode that is not found is told at its own key. */
    static const struct {
        cm1e_error_t answer;
        const char *words, *place;
    } rows[] = {{CM1E_ERROR_NOT_FOUND, "has no OpMode", ":2:45: "}, {CM1E_ERROR_CONFIG, "has no OpMode", ":2:24: "},
                {CM1E_ERROR_NOT_FOUND, "cannot be read", ":2:24: "}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        answer = rows[i].answer;
        words = rows[i].words;
        TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, load("slaves:\n  - {position: 1, esi: maker.xml, esi_mode: DC}\n"));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, rows[i].place), diag.text);
    }
    answer = CM1E_ERROR_NO_MEMORY;
    TEST_ASSERT_EQUAL(CM1E_ERROR_NO_MEMORY, load("slaves:\n  - {position: 1, esi: maker.xml}\n"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, ".yaml: out of memory"), diag.text);
    answer = CM1E_OK;
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, load("slaves:\n  - {position: 1, esi_mode: DC}\n"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, ":2:29: esi_mode is given without esi"), diag.text);
}

/* ---- entries ----------------------------------------------------------------------------------------------------- */

/* In the twelfth entry, behind eleven good ones: its number in the file has two digits. */
static void test_an_entry_far_down_a_list_is_told_at_its_place(void)
{
    static const struct {
        const char *list, *before, *wrong, *words;
    } rows[] = {
        {"axes", "alias: 7, limits: {velocity: ", "-1}", "axis axis12: limits.velocity is -1"},
        {"axes", "position: 1, alias: ", "9", "entry 12 of the list is addressed twice"},
        {"axes", "alias: 7, name: ", "axis3", "axis axis3: name is also the name of entry 3 of the list"},
        {"axes", "alias: ", "105", "axis axis12: alias is 105, which entry 5 of the list has already"},
        {"slaves", "alias: 7, vendor: ", "7", "vendor is '7'"},
        {"slaves", "position: 1, alias: ", "9", "entry 12 of the list is addressed twice"},
        {"slaves", "alias: 7, name: ", "slave3", "slave slave3: name is also the name of entry 3 of the list"},
        {"slaves", "alias: ", "105", "slave slave12: alias is 105, which entry 5 of the list has already"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[1000], place[40];
        snprintf(text, sizeof text, "%s:\n", rows[i].list);
        for (unsigned n = 1; n < 12; n++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "  - {alias: %u}\n", 100 + n);
        snprintf(text + strlen(text), sizeof text - strlen(text), "  - {%s%s}\n", rows[i].before, rows[i].wrong);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, load(text), rows[i].words);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, rows[i].words), diag.text);
        snprintf(place, sizeof place, ".yaml:13:%u: ", 6 + (unsigned)strlen(rows[i].before));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, place), diag.text);
    }
}

static void test_a_file_of_the_largest_size(void)
{
    static char text[CM1E_BUSFILE_MAX_SIZE + 2];
    for (size_t size = CM1E_BUSFILE_MAX_SIZE; size <= CM1E_BUSFILE_MAX_SIZE + 1; size++) {
        memset(text, '#', size);
        memcpy(text, "axes: [{}]\n", 11);
        text[size] = '\0';
        TEST_ASSERT_EQUAL(size == CM1E_BUSFILE_MAX_SIZE ? CM1E_OK : CM1E_ERROR_CONFIG, load(text));
    }
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "is larger than 1048576 bytes; expected a bus file"), diag.text);
}

static void test_names_and_idents_as_they_may_be(void)
{
    static const struct {
        const char *keys, *wrong; /* wrong: of the text; NULL: none */
    } rows[] = {
        {"name: slave x", NULL}, {"name: slave seven", NULL}, {"name: slave 7x", NULL},
        {"name: seven", NULL}, {"name: 7x", NULL},
        {"name: slave", NULL}, {"name: Slave 12", "that is no position"}, {"name: \"slave \"", "that is no position"},
        {"sdo: [{object: 0x1000, type: INT, value: 1}]", NULL},
        {"sdo: [{object: 0x0FFF, type: INT, value: 1}]", "expected an object from 0x1000 on"},
        {"modules: [0x1, 0xFFFFFFFF]", NULL}, {"modules: [0x123456789]", "is no ident"},
        {"modules: [0x]", "is no ident"}, {"modules: [0x12g]", "is no ident"}, {"vendor: 0xFFFFFFFF", NULL},
        {"vendor: 0x12g", "expected it as in"},
        {"vendor: 0x", "expected it as in"}, {"revision: 0x100000000", "expected it as in"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[200];
        snprintf(text, sizeof text, "slaves: [{position: 1, %s}]\n", rows[i].keys);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].wrong ? CM1E_ERROR_CONFIG : CM1E_OK, load(text), rows[i].keys);
        TEST_ASSERT_TRUE_MESSAGE(!rows[i].wrong || strstr(diag.text, rows[i].wrong), diag.text);
    }
}

/* The velocity that no counter has is any number above 0. */
static void test_an_encoder_may_be_slow(void)
{
    static const char text[] = "axes: [{type: encoder, encoder_signal: s.count, limits: {velocity: 0.1}}]\n"
                               "slaves: [{name: s, position: 1}]\n";
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(text), diag.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_axis_without_a_motor_has_no_keys_of_one);
    RUN_TEST(test_an_esi_is_beside_the_bus_file);
    RUN_TEST(test_what_the_reader_of_an_esi_tells);
    RUN_TEST(test_an_entry_far_down_a_list_is_told_at_its_place);
    RUN_TEST(test_a_file_of_the_largest_size);
    RUN_TEST(test_names_and_idents_as_they_may_be);
    RUN_TEST(test_an_encoder_may_be_slow);
    return UNITY_END();
}
