/* Every number of a bus file at its bounds: each bound is accepted, and the next number beyond it refused, with its
 * place and the range. The numbers are those of docs/BUS-FILE.md, and no key with a number is left out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "busfile/busfile.h"
#include "cm1e/config.h"
#include "unity.h"

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_bounds.yaml";
static char documentation[1 << 16];

void setUp(void) {}
void tearDown(void) {}

/* ---- the table --------------------------------------------------------------------------------------------------- */

/* What is beyond a bound by so much is the next number. */
#define NEXT_DOUBLE 0.0
#define HALF_A_COUNT 0.5 /* what is sent are whole counts, so numbers that round to the bound are accepted */

typedef enum ends { BOTH, LOWEST, LARGEST } ends_t;

typedef struct row {
    const char *path;       /* of the key in the schema; entries of lists have no number */
    const char *documented; /* words in the row of this key, from the smallest number to the largest one */
    const char *file;       /* '@' is the number */
    const char *numbers;    /* where the documentation has none: it names another key, or the motor */
    double step;
    ends_t ends;
    const char *below, *above; /* words of the diagnosis; NULL: "<smallest> ... <largest>" */
} row_t;

#define AXIS(keys) "\naxes: [{" keys "}]\n"
#define COUNTS(keys) AXIS("unit: {counts_per_unit: 1}, " keys) /* u is a count */
#define OTHER_DRIVE "device: cia402, drive: {counts_per_revolution: 10000, max_speed_rpm: 3000}"
#define CM1(keys) COUNTS("channel: 1, k37: 10, motor: CM1, " keys)
#define CM2(keys) COUNTS("channel: 1, k37: 10, motor: CM2, " keys)
#define SLAVE(keys) "\nslaves:\n  - {position: 1, " keys "}\n"
#define BESIDE_THE_PDO "\naxes:\n  - device: cia402\n    drive: {counts_per_revolution: 100, max_speed_rpm: 1, "

static const row_t rows[] = {
    {"bus.cycle_time_us", "200, 250, 500, 1000, 2000 or 4000", "bus: {cycle_time_us: @}" AXIS(OTHER_DRIVE),
     .step = 1},
    {"bus.frame_timeout_us", "at most the cycle time",
     "bus: {cycle_time_us: 4000, frame_timeout_us: @}" AXIS(OTHER_DRIVE), .numbers = "1 ... 4000", .step = 1},
    {"bus.frame_timeout_us", "at most the cycle time", "bus: {frame_timeout_us: @}" AXIS(), .numbers = "1 ... 1000",
     .step = 1, .ends = LARGEST, .above = "at most the cycle time, 1000"},
    {"bus.lost_cycles_limit", "250 at 200 us", "bus: {cycle_time_us: 200, lost_cycles_limit: @}" AXIS(),
     .numbers = "1 ... 250", .step = 1},
    {"bus.lost_cycles_limit", "50 at 1 ms", "bus: {lost_cycles_limit: @}" AXIS(), .numbers = "1 ... 50", .step = 1,
     .ends = LARGEST},
    {"axes.position", "1 ... 512", AXIS("position: @"), .step = 1},
    {"axes.alias", "1 ... 65535", AXIS("alias: @"), .step = 1},
    {"axes.explicit_id", "1 ... 254", AXIS("explicit_id: @"), .step = 1},
    {"axes.channel", "1 ... 4", AXIS("channel: @, k37: 10"), .step = 1},
    {"axes.k37", "0 ... 8, 10, 40 ... 50, and each of these plus 20; of a CM2 also 80 ... 88 and 90",
     AXIS("channel: 1, motor: CM2, k37: @"), .step = 1, .below = "0 ... 99", .above = "or 80 ... 88 or 90"},
    {"axes.k37", "40 ... 50, and each of these plus 20", AXIS("channel: 1, motor: CM1, k37: @"),
     .numbers = "40 ... 70", .step = 1, .below = "each of these plus 20", .above = "each of these plus 20"},
    {"axes.cam_points", "2 ... 4096", AXIS("cam_points: @"), .step = 1},
    {"axes.encoder_filter_s", "0.0001 ... 10", AXIS("encoder_filter_s: @"), .step = NEXT_DOUBLE},
    {"axes.unit.counts_per_unit", "0.001 ... 1e12", AXIS("unit: {counts_per_unit: @}"), .step = NEXT_DOUBLE},
    {"axes.unit.gear_numerator", "1 ... 1,000,000", AXIS("unit: {gear_numerator: @}"), .step = 1},
    {"axes.unit.gear_denominator", "1 ... 1,000,000", AXIS("unit: {gear_denominator: @}"), .step = 1},
    {"axes.unit.units_per_revolution", "0.000001 ... 1e9",
     AXIS("unit: {units_per_revolution: @, gear_denominator: 1000}"), .step = NEXT_DOUBLE, .ends = LOWEST},
    {"axes.unit.units_per_revolution", "0.000001 ... 1e9",
     AXIS("unit: {units_per_revolution: @, gear_numerator: 1000}"), .step = NEXT_DOUBLE, .ends = LARGEST},
    {"axes.unit.modulo_range", "1,000 counts of 50,000) and at most 1e12",
     AXIS("unit: {counts_per_unit: 1, modulo_range: @}"), .step = HALF_A_COUNT},
    {"axes.limits.velocity", "up to the peak speed of the motor", COUNTS("limits: {velocity: @}"),
     .numbers = "1 ... 2500000", .step = HALF_A_COUNT},
    {"axes.limits.velocity", "(1e9 counts/s)", COUNTS("type: virtual, limits: {velocity: @}"),
     .numbers = "1 ... 1e9", .step = HALF_A_COUNT},
    {"axes.limits.acceleration", "1,000 counts/s² of 50,000), up to 1e11", COUNTS("limits: {acceleration: @}"),
     .step = HALF_A_COUNT},
    {"axes.limits.deceleration", "same range as `acceleration`", COUNTS("limits: {deceleration: @}"),
     .numbers = "1000 ... 1e11", .step = HALF_A_COUNT},
    {"axes.limits.jerk", "1,000 counts/s³ of 50,000), up to 1e15", COUNTS("limits: {jerk: @}"),
     .step = HALF_A_COUNT},
    {"axes.limits.position_lag", "1 ... 2,147,483,647", COUNTS("limits: {position_lag: @}"), .step = HALF_A_COUNT},
    {"axes.in_position.window", "At least 1 count, at most `limits.position_lag`",
     COUNTS("limits: {position_lag: 2147483647}, in_position: {window: @}"), .numbers = "1 ... 2147483647",
     .step = HALF_A_COUNT, .ends = LOWEST},
    {"axes.in_position.window", "At least 1 count, at most `limits.position_lag`",
     COUNTS("limits: {position_lag: 700}, in_position: {window: @}"), .numbers = "1 ... 700", .step = NEXT_DOUBLE,
     .ends = LARGEST, .above = "position_lag 700"},
    {"axes.in_position.time_s", "0.001 ... 10", AXIS("in_position: {timeout_s: 3600, time_s: @}"),
     .step = NEXT_DOUBLE},
    {"axes.in_position.timeout_s", "0.01 ... 3,600", AXIS("in_position: {time_s: 0.001, timeout_s: @}"),
     .step = NEXT_DOUBLE},
    {"axes.software_limits.negative", "±9e15", COUNTS("software_limits: {negative: @}"), .step = HALF_A_COUNT},
    {"axes.software_limits.positive", "±9e15", COUNTS("software_limits: {positive: @}"), .step = HALF_A_COUNT},
    {"axes.backlash.gap", "1 ... 500,000", COUNTS("backlash: {gap: @}"), .step = HALF_A_COUNT},
    {"axes.backlash.velocity", "up to half the motor's peak speed", COUNTS("backlash: {gap: 1, velocity: @}"),
     .numbers = "1 ... 1250000", .step = HALF_A_COUNT},
    {"axes.jog.slow", "at most `limits.velocity`", COUNTS("limits: {velocity: 700}, jog: {slow: @}"),
     .numbers = "1 ... 700", .step = HALF_A_COUNT},
    {"axes.jog.fast", "at most `limits.velocity`", COUNTS("limits: {velocity: 700}, jog: {fast: @}"),
     .numbers = "1 ... 700", .step = HALF_A_COUNT},
    {"axes.inputs.home", "1 ... 4", AXIS("inputs: {home: @}"), .step = 1},
    {"axes.inputs.limit_positive", "1 ... 4", AXIS("inputs: {limit_positive: @}"), .step = 1},
    {"axes.inputs.limit_negative", "1 ... 4", AXIS("inputs: {limit_negative: @}"), .step = 1},
    {"axes.inputs.limit_positive", "A CM1 behind a bridge has no input 1", CM1("inputs: {limit_positive: @}"),
     .numbers = "2 ... 4",
     .step = 1, .below = "expected 2 ... 4", .above = "1 ... 4"},
    {"axes.homing.method", "-5, -6 sensor at input 3", AXIS("homing: {method: @}"), .numbers = "-6 ... 0",
     .step = 1},
    {"axes.homing.method", "1, 2 hard stop CW, CCW; 3, 4", CM1("homing: {method: @}"), .numbers = "0 ... 4",
     .step = 1, .below = "0 (none) or 1 ... 4 behind a bridge", .above = "0 (none) or 1 ... 4 behind a bridge"},
    {"axes.homing.method", "-128 ... 37", AXIS(OTHER_DRIVE ", homing: {method: @}"), .step = 1},
    {"axes.homing.offset", "±3,276,700", COUNTS("homing: {offset: @}"), .step = HALF_A_COUNT},
    {"axes.homing.velocity", "1,000 ... 500,000", COUNTS("homing: {velocity: @}"), .step = HALF_A_COUNT},
    {"axes.homing.velocity", "100 ... 500,000", CM1("homing: {velocity: @}"), .step = HALF_A_COUNT},
    {"axes.homing.velocity", "100 ... 3,276,700", CM2("homing: {velocity: @}"), .step = HALF_A_COUNT},
    {"axes.homing.acceleration", "1,000 ... 5,000,000", COUNTS("homing: {acceleration: @}"), .step = HALF_A_COUNT},
    {"axes.homing.acceleration", "1,000 ... 5,000,000", CM1("homing: {acceleration: @}"), .step = HALF_A_COUNT},
    {"axes.homing.acceleration", "up to 32,767,000", CM2("homing: {acceleration: @}"),
     .numbers = "1000 ... 32767000", .step = HALF_A_COUNT},
    {"axes.homing.torque", "10 ... 100", AXIS("homing: {torque: @}"), .step = NEXT_DOUBLE},
    {"axes.homing.timeout_s", "0.1 ... 3,600", AXIS("homing: {timeout_s: @}"), .step = NEXT_DOUBLE},
    {"axes.drive.counts_per_revolution", "100 ... 2^30",
     AXIS("device: cia402, drive: {max_speed_rpm: 1, counts_per_revolution: @}"), .step = 1},
    {"axes.drive.max_speed_rpm", "1 ... 100,000",
     AXIS("device: cia402, drive: {counts_per_revolution: 100, max_speed_rpm: @}"), .step = NEXT_DOUBLE},
    {"axes.drive.outputs_pdo", "`0x1600` ... `0x17FF`", BESIDE_THE_PDO "inputs_pdo: 0x1A00, outputs_pdo: @}\n",
     .step = 1},
    {"axes.drive.inputs_pdo", "`0x1A00` ... `0x1BFF`", BESIDE_THE_PDO "outputs_pdo: 0x1600, inputs_pdo: @}\n",
     .step = 1},
    {"axes.dc.sync0_us", "62.5 ... 1,000,000", AXIS(OTHER_DRIVE ", dc: {sync0_us: @}"), .step = 12.5, .ends = LOWEST,
     .below = "a whole part of it from 62.5 us on"},
    {"axes.dc.sync0_us", "62.5 ... 1,000,000", AXIS(OTHER_DRIVE ", dc: {sync0_us: @}"), .step = 1000,
     .ends = LARGEST, .above = "or a multiple up to 1 s"},
    {"axes.dc.sync1_us", "up to 1,000,000", AXIS(OTHER_DRIVE ", dc: {sync0_us: 1000, sync1_us: @}"),
     .numbers = "0 ... 1000000", .step = NEXT_DOUBLE, .ends = LARGEST},
    {"axes.dc.shift_us", "less than a cycle time to both sides",
     AXIS(OTHER_DRIVE ", dc: {sync0_us: 1000, shift_us: @}"), .numbers = "-999.99 ... 999.99", .step = 0.01,
     .below = "less than the cycle time of 1000 us", .above = "less than the cycle time of 1000 us"},
    {"axes.sim.load_inertia_kgm2", "1e-9 ... 1", AXIS("sim: {load_inertia_kgm2: @}"), .step = NEXT_DOUBLE},
    {"axes.sim.friction_nm", "1e-9 ... 10", AXIS("sim: {friction_nm: @}"), .step = NEXT_DOUBLE},
    {"axes.sim.viscous_friction_nms", "1e-9 ... 1", AXIS("sim: {viscous_friction_nms: @}"), .step = NEXT_DOUBLE},
    {"axes.sim.stop_negative_counts", "-1e12 ... -1", AXIS("sim: {stop_negative_counts: @}"), .step = NEXT_DOUBLE},
    {"axes.sim.stop_positive_counts", "1 ... 1e12", AXIS("sim: {stop_positive_counts: @}"), .step = NEXT_DOUBLE},
    {"axes.sim.sensor_input2_counts", "±1e12", AXIS("sim: {sensor_input2_counts: @}"), .step = NEXT_DOUBLE},
    {"axes.sim.sensor_input3_counts", "±1e12", AXIS("sim: {sensor_input3_counts: @}"), .step = NEXT_DOUBLE},
    {"slaves.position", "1 ... 512", "\nslaves: [{position: @}]\n", .step = 1},
    {"slaves.alias", "1 ... 65535", "\nslaves: [{alias: @}]\n", .step = 1},
    {"slaves.explicit_id", "1 ... 254", "\nslaves: [{explicit_id: @}]\n", .step = 1},
    {"slaves.watchdog_ms", "1 ... 6000", SLAVE("watchdog_ms: @"), .step = 1},
    {"slaves.outputs_pdos", "`0x1600` ... `0x17FF`", SLAVE("outputs_pdos: [@]"), .step = 1},
    {"slaves.inputs_pdos", "`0x1A00` ... `0x1BFF`", SLAVE("inputs_pdos: [@]"), .step = 1},
    {"slaves.outputs.bit", "0 ... 11887", SLAVE("outputs: [{name: a, bit: @}]"), .step = 1},
    {"slaves.inputs.bit", "0 ... 11887", SLAVE("inputs: [{name: a, bit: @}]"), .step = 1},
    {"slaves.outputs.bits", "1 ... 11888", SLAVE("outputs: [{name: a, bit: 0, bits: @}]"), .step = 1},
    {"slaves.inputs.bits", "1 ... 11888", SLAVE("inputs: [{name: a, bit: 0, bits: @}]"), .step = 1},
    {"slaves.sim.inputs", "1 ... 8", SLAVE("sim: {device: digital, inputs: @}"), .step = 1},
    {"slaves.sim.outputs", "1 ... 8", SLAVE("sim: {device: analog, outputs: @}"), .step = 1},
    {"slaves.sim.counts_per_s", "up to 1e9 to both sides",
     SLAVE("sim: {device: encoder, inputs: 1, counts_per_s: @}"), .numbers = "±1e9", .step = NEXT_DOUBLE,
     .below = "up to 1e+09 to both sides", .above = "up to 1e+09 to both sides"},
    {"slaves.dc.sync0_us", "as of an axis", SLAVE("dc: {sync0_us: @}"), .numbers = "62.5 ... 1000000", .step = 12.5,
     .ends = LOWEST, .below = "a whole part of it from 62.5 us on"},
    {"slaves.dc.sync0_us", "as of an axis", SLAVE("dc: {sync0_us: @}"), .numbers = "62.5 ... 1000000", .step = 1000,
     .ends = LARGEST, .above = "or a multiple up to 1 s"},
    {"slaves.dc.sync1_us", "as of an axis", SLAVE("dc: {sync0_us: 1000, sync1_us: @}"), .numbers = "0 ... 1000000",
     .step = NEXT_DOUBLE, .ends = LARGEST},
    {"slaves.dc.shift_us", "as of an axis", SLAVE("dc: {sync0_us: 1000, shift_us: @}"),
     .numbers = "-999.99 ... 999.99", .step = 0.01, .below = "less than the cycle time of 1000 us",
     .above = "less than the cycle time of 1000 us"},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

/* ---- the documentation ------------------------------------------------------------------------------------------- */

static void read_documentation(void)
{
    FILE *file = fopen(CM1E_SOURCE_DIR "/docs/BUS-FILE.md", "rb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_GREATER_THAN(0, fread(documentation, 1, sizeof documentation - 1, file));
    TEST_ASSERT_TRUE(feof(file));
    fclose(file);
}

/* Whether the first cell of a row, from `row` on, has the key of this path: `limits.jerk`, `.jerk` or `jerk`; what an
 * entry of a list has stands in the row of the list. */
static bool is_of(const char *row, const char *path)
{
    const char *own = strchr(path, '.') + 1, *last = strrchr(path, '.') + 1, *end = strchr(row + 1, '|');
    const struct {
        const char *text;
        int length;
    } spellings[] = {{own, (int)strlen(own)}, {last - 1, (int)strlen(last) + 1}, {last, (int)strlen(last)},
                     {own, last > own ? (int)(last - own) - 1 : 0}};
    for (int i = 0; i < 4; i++) {
        char key[64];
        snprintf(key, sizeof key, "`%.*s`", spellings[i].length, spellings[i].text);
        const char *found = strstr(row, key);
        if (found && end && found < end)
            return true;
    }
    return false;
}

static bool is_documented(const char *path, const char *words)
{
    for (const char *row = strstr(documentation, "\n| `"); row; row = strstr(row + 1, "\n| `")) {
        const char *found = strstr(row + 1, words), *end = strchr(row + 1, '\n');
        if (is_of(row + 1, path) && found && end && found < end)
            return true;
    }
    return false;
}

/* ---- numbers ----------------------------------------------------------------------------------------------------- */

/* The number at the beginning of a text, as people write it: 1,000,000 or 2^30; `*end` is behind it. */
static double number_at(const char *text, const char **end)
{
    char digits[40];
    size_t length = 0, used = 0;
    for (; length < sizeof digits - 1 && text[length] != '\0' &&
           (text[length] != ',' || (text[length + 1] >= '0' && text[length + 1] <= '9')); length++)
        if (text[length] != ',')
            digits[used++] = text[length];
    digits[used] = '\0';
    char *behind;
    double value = strtod(digits, &behind);
    if (*behind == '^')
        value = ldexp(1, (int)strtol(behind + 1, &behind, 10));
    size_t taken = (size_t)(behind - digits);
    for (*end = text; taken > 0; (*end)++)
        taken -= **end != ',';
    return value;
}

/* The first number of a text, and the last one. */
static void take_range(const char *text, double *low, double *high)
{
    unsigned count = 0;
    for (const char *at = text; *at;) {
        const bool begins = (*at >= '0' && *at <= '9') || (*at == '-' && at[1] >= '0' && at[1] <= '9');
        const char *end = at + 1;
        if (begins)
            *high = number_at(at, &end);
        if (begins && count++ == 0)
            *low = *high;
        at = end;
    }
    if (strstr(text, "±"))
        *low = -*high;
    TEST_ASSERT_TRUE_MESSAGE(count > 0, text);
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

static cm1e_diag_t diag;

static bool loads(const row_t *row, const char *number)
{
    cm1e_bus_config_t config;
    const char *at = strchr(row->file, '@');
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    fprintf(file, "%.*s%s%s", (int)(at - row->file), row->file, number, at + 1);
    TEST_ASSERT_EQUAL(0, fclose(file));
    const bool good = cm1e_bus_config_load(&config, temporary, &diag) == CM1E_OK;
    if (good)
        cm1e_bus_config_free(&config);
    return good;
}

static void expect_good(const row_t *row, const char *number)
{
    char told[800];
    const bool good = loads(row, number);
    snprintf(told, sizeof told, "%s: %s is refused: %s", row->path, number, diag.text);
    TEST_ASSERT_TRUE_MESSAGE(good, told);
}

/* Refused at the place of the number, with these words behind the name of the key. */
static void expect_wrong(const row_t *row, const char *number, const char *words)
{
    char told[800], place[300];
    const char *at = strchr(row->file, '@'), *line = at;
    unsigned lines = 1;
    const bool good = loads(row, number);
    while (line > row->file && line[-1] != '\n')
        line--;
    for (const char *c = row->file; c < line; c++)
        lines += *c == '\n';
    snprintf(place, sizeof place, "%s:%u:%u: ", temporary, lines, (unsigned)(at - line) + 1);
    snprintf(told, sizeof told, "%s: %s, expected \"%s%s\": %s", row->path, number, place, words,
             good ? "accepted" : diag.text);
    TEST_ASSERT_FALSE_MESSAGE(good, told);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(place, diag.text, strlen(place), told);
    const char *key = strstr(diag.text + strlen(place), strrchr(row->path, '.') + 1);
    TEST_ASSERT_NOT_NULL_MESSAGE(key, told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(key, words), told);
}

static void write_number(char text[40], double number, bool hex)
{
    if (hex)
        snprintf(text, 40, "0x%04X", (unsigned)number);
    else
        snprintf(text, 40, "%.15g", number);
}

static void check_end(const row_t *row, double bound, int side, const char *words)
{
    const bool hex = strstr(row->numbers ? row->numbers : row->documented, "0x");
    char number[40];
    if (row->step == NEXT_DOUBLE) {
        snprintf(number, sizeof number, "%.17g", bound);
        expect_good(row, number);
        snprintf(number, sizeof number, "%.17g", nextafter(bound, side * INFINITY));
        expect_wrong(row, number, words);
        return;
    }
    write_number(number, bound, hex);
    expect_good(row, number);
    if (row->step == HALF_A_COUNT) {
        snprintf(number, sizeof number, "%.3f", bound + side * 0.375);
        expect_good(row, number);
        snprintf(number, sizeof number, "%.3f", bound + side * 0.625);
    } else {
        write_number(number, bound + side * row->step, hex);
    }
    expect_wrong(row, number, words);
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

static void test_each_bound_is_accepted_and_the_next_number_refused(void)
{
    for (int i = 0; i < ROWS; i++) {
        const char *numbers = rows[i].numbers ? rows[i].numbers : rows[i].documented;
        double low, high;
        char range[80];
        take_range(numbers, &low, &high);
        if (strstr(numbers, "0x"))
            snprintf(range, sizeof range, "0x%04X ... 0x%04X", (unsigned)low, (unsigned)high);
        else
            snprintf(range, sizeof range, "%.10g ... %.10g", low, high);
        if (rows[i].ends != LARGEST)
            check_end(&rows[i], low, -1, rows[i].below ? rows[i].below : range);
        if (rows[i].ends != LOWEST)
            check_end(&rows[i], high, 1, rows[i].above ? rows[i].above : range);
    }
}

static void test_the_documentation_has_these_numbers(void)
{
    for (int i = 0; i < ROWS; i++) {
        char told[200];
        snprintf(told, sizeof told, "%s: %s", rows[i].path, rows[i].documented);
        TEST_ASSERT_TRUE_MESSAGE(is_documented(rows[i].path, rows[i].documented), told);
    }
}

/* Each number of the schema has a row above. */
static void walk(const cyaml_schema_value_t *value, const char *path, unsigned *numbers)
{
    if (value->type == CYAML_SEQUENCE)
        walk(value->sequence.entry, path, numbers);
    const bool has_keys = value->type == CYAML_MAPPING;
    for (const cyaml_schema_field_t *field = value->mapping.fields; has_keys && field->key; field++) {
        char deeper[128];
        snprintf(deeper, sizeof deeper, "%s%s%s", path, path[0] ? "." : "", field->key);
        walk(&field->value, deeper, numbers);
    }
    if (value->type != CYAML_INT && value->type != CYAML_UINT && value->type != CYAML_FLOAT)
        return;
    (*numbers)++;
    for (int i = 0; i < ROWS; i++)
        if (strcmp(rows[i].path, path) == 0)
            return;
    TEST_FAIL_MESSAGE(path);
}

static void test_no_key_with_a_number_is_left_out(void)
{
    unsigned numbers = 0;
    walk(&cm1e_busfile_schema, "", &numbers);
    TEST_ASSERT_GREATER_THAN(60, numbers);
}

int main(void)
{
    read_documentation();
    UNITY_BEGIN();
    RUN_TEST(test_each_bound_is_accepted_and_the_next_number_refused);
    RUN_TEST(test_the_documentation_has_these_numbers);
    RUN_TEST(test_no_key_with_a_number_is_left_out);
    return UNITY_END();
}
