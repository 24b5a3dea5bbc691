/** The trace's ring and its writers: CSV and SVG of whatever was recorded. */
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "plot/plot_files.h"
#include "scheduler/variables.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* ---- a trace made by hand -------------------------------------------------------------------------------------- */

static trace_t make_trace(uint32_t axes, uint32_t capacity)
{
    static const char *const names[] = {"X", "gripper", "<&\"'>\x01", "Achse \xC3\xA4"};
    const char *of_axes[128];
    trace_t trace;
    for (uint32_t i = 0; i < axes; i++)
        of_axes[i] = names[i % 4];
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_init(&trace, of_axes, axes, capacity, 1, NULL));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_begin(&trace, NULL));
    return trace;
}

/** Samples that move, n = 0, 1, 2 ...; returns the new one. */
static double *add_sample(trace_t *trace, uint32_t n, double scale)
{
    double *sample = cm1e_trace_next_sample(trace, n * INT64_C(1000000));
    for (uint32_t axis = 0; axis < trace->axes; axis++) {
        double *columns = sample + axis * TRACE_AXIS_COLUMNS;
        columns[TRACE_SET_POSITION] = scale * sin(n * 0.01 + axis);
        columns[TRACE_ACTUAL_POSITION] = scale * sin(n * 0.01 + axis - 0.02);
        columns[TRACE_SET_VELOCITY] = scale * cos(n * 0.01 + axis);
        columns[TRACE_ACTUAL_VELOCITY] = scale * cos(n * 0.01 + axis - 0.02) + (n % 3) * 0.01 * scale;
        columns[TRACE_TORQUE] = 40 * sin(n * 0.7);
        columns[TRACE_STATE] = n / 500 % CM1E_AXIS_STATE_COUNT;
    }
    return sample;
}

/** The whole file; the caller frees it. */
static char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*size + 1);
    TEST_ASSERT_EQUAL(*size, fread(text, 1, *size, file));
    text[*size] = '\0';
    fclose(file);
    return text;
}

static const char svg_path[] = CM1E_TEST_OUTPUT "/trace-unit.svg", csv_path[] = CM1E_TEST_OUTPUT "/trace-unit.csv";

static char *write_svg(const trace_t *trace, size_t *size)
{
    cm1e_diag_t diag = {0};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_trace_write_file(trace, svg_path, cm1e_plot_print_svg, &diag), diag.text);
    return read_file(svg_path, size);
}

/** Every element that is opened is closed, in order; no stray "<", ">" or "&"; no "nan", no "inf". */
static void check_well_formed(const char *svg)
{
    char open[16][24];
    int depth = 0;
    TEST_ASSERT_NULL(strstr(svg, "nan"));
    TEST_ASSERT_NULL(strstr(svg, "inf"));
    for (const char *c = svg; *c; c++) {
        TEST_ASSERT_TRUE((unsigned char)*c >= ' ' || *c == '\n');
        if (*c == '&')
            TEST_ASSERT_TRUE(!strncmp(c, "&lt;", 4) || !strncmp(c, "&gt;", 4) || !strncmp(c, "&amp;", 5)
                             || !strncmp(c, "&quot;", 6));
        if (*c != '<')
            continue;
        const char *end = strchr(c, '>');
        TEST_ASSERT_NOT_NULL(end);
        if (c[1] == '/') {
            TEST_ASSERT_TRUE(depth > 0);
            depth--;
            TEST_ASSERT_EQUAL_STRING_LEN(open[depth], c + 2, strlen(open[depth]));
        } else if (end[-1] != '/') {
            TEST_ASSERT_TRUE(depth < 16);
            snprintf(open[depth++], sizeof open[0], "%.*s", (int)strcspn(c + 1, " >"), c + 1);
        }
        c = end;
    }
    TEST_ASSERT_EQUAL(0, depth);
}

static unsigned count(const char *text, const char *word)
{
    unsigned n = 0;
    for (const char *c = strstr(text, word); c; c = strstr(c + 1, word))
        n++;
    return n;
}

/* ---- SVG ------------------------------------------------------------------------------------------------------- */

static void test_svg_of_few_and_many_axes_is_well_formed_and_below_half_a_megabyte(void)
{
    static const struct {
        uint32_t axes, samples;
    } cases[] = {{1, 1}, {1, 2}, {1, 10}, {2, 5000}, {3, 100000}, {8, 20000}, {16, 5000}, {128, 2000}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        trace_t trace = make_trace(cases[i].axes, cases[i].samples);
        size_t size;
        for (uint32_t n = 0; n < cases[i].samples; n++)
            add_sample(&trace, n, 12);
        char *svg = write_svg(&trace, &size);
        check_well_formed(svg);
        TEST_ASSERT_LESS_THAN(cases[i].axes <= 16 ? 500000 : 1500000, size);
        TEST_ASSERT_EQUAL(cases[i].axes, count(svg, ">position [u]<"));
        TEST_ASSERT_EQUAL(cases[i].axes, count(svg, ">torque [% of rated]<"));
        TEST_ASSERT_EQUAL(2 * cases[i].axes + 1, count(svg, "class=\"set\" d=\"M"));
        free(svg);
        cm1e_trace_free(&trace);
    }
}

static void test_svg_shows_the_marks_of_its_time(void)
{
    static const char *const names[] = {"<first> & oldest", "gr\xFC\xDF", "no \xEF\xBF\xBE character"};
    trace_t trace = make_trace(2, 100);
    size_t size;
    for (uint32_t n = 0; n < 300; n++) /* 200 ms ... 299 ms are kept */
        add_sample(&trace, n, 1);
    cm1e_trace_mark(&trace, "too old", 199 * INT64_C(1000000));
    for (int i = 0; i < 3; i++)
        cm1e_trace_mark(&trace, names[i], (200 + 49 * i) * INT64_C(1000000));
    cm1e_trace_mark(&trace, "too new", 300 * INT64_C(1000000));
    char *svg = write_svg(&trace, &size);
    check_well_formed(svg);
    TEST_ASSERT_EQUAL(2 * 3, count(svg, "class=\"mark\""));
    TEST_ASSERT_EQUAL(2, count(svg, ">&lt;first&gt; &amp; oldest<"));
    TEST_ASSERT_EQUAL(2, count(svg, ">gr\?\?<")); /* what is not UTF-8, or no character of XML, is no file for a reader */
    TEST_ASSERT_EQUAL(2, count(svg, ">no ? character<"));
    TEST_ASSERT_EQUAL(0, count(svg, ">too "));
    free(svg);
    for (int i = 0; i < TRACE_MARKS; i++) /* the ring goes round */
        cm1e_trace_mark(&trace, i == 0 ? "oldest" : "later", 250 * INT64_C(1000000));
    TEST_ASSERT_EQUAL(TRACE_MARKS, trace.mark_count);
    TEST_ASSERT_EQUAL_STRING("oldest", cm1e_trace_mark_at(&trace, 0)->text);
    TEST_ASSERT_EQUAL_STRING("later", cm1e_trace_mark_at(&trace, TRACE_MARKS - 1)->text);
    cm1e_trace_free(&trace);
}

/* A program that names every moment, the last ones at the end of the time: each text has a place of its own. */
static void test_svg_marks_are_never_printed_over_each_other(void)
{
    static const char *const names[] = {"a", "a longer one", "x\xC3\xA4\xC3\xB6",
                                        "a text that is longer than the whole plot is wide, and goes on and on and on "
                                        "and on and on and on and on and on and on and on and on and on"};
    static double placed[TRACE_MARKS][3]; /* y, from, to */
    trace_t trace = make_trace(2, 100);
    size_t size;
    for (uint32_t n = 0; n < 100; n++)
        add_sample(&trace, n, 1);
    for (int64_t i = 0; i < TRACE_MARKS; i++)
        cm1e_trace_mark(&trace, names[i % 4], (i < 60 ? i * i / 40 : 99) * INT64_C(1000000));
    char *svg = write_svg(&trace, &size);
    check_well_formed(svg);
    TEST_ASSERT_EQUAL(2 * TRACE_MARKS, count(svg, "class=\"tick note\""));
    const char *at = svg;
    for (int i = 0; i < TRACE_MARKS; i++) { /* those of the first column */
        double x, y;
        char anchor[40] = "", text[256] = "";
        at = strstr(at, "class=\"tick note\"") + strlen("class=\"tick note\"");
        TEST_ASSERT_TRUE(sscanf(at, " text-anchor=\"%39[a-z]\" x=\"%lf\" y=\"%lf\">%255[^<]", anchor, &x, &y, text) == 4
                         || sscanf(at, " x=\"%lf\" y=\"%lf\">%255[^<]", &x, &y, text) == 3);
        const double width = 5.5 * (double)(strlen(text) - (strstr(text, "\xC3") ? 2 : 0));
        const double from = anchor[0] ? x - width : x, to = from + width;
        TEST_ASSERT_TRUE_MESSAGE(from >= 72 && to <= 72 + 810 + 18, text);
        for (int k = 0; k < i; k++)
            TEST_ASSERT_TRUE_MESSAGE(fabs(placed[k][0] - y) >= 12 || from >= placed[k][2] || to <= placed[k][1], text);
        memcpy(placed[i], (double[]){y, from, to}, sizeof placed[i]);
    }
    free(svg);
    cm1e_trace_free(&trace);
}

static void test_svg_survives_any_values(void)
{
    static const double values[] = {0, -0.0, 1e-300, 1e300, -1e300, NAN, INFINITY, -INFINITY, 1e12, 1e-12, 123456.789};
    enum { VALUES = sizeof values / sizeof values[0] };
    for (int constant = 0; constant <= VALUES; constant++) {
        trace_t trace = make_trace(1, 50);
        size_t size;
        for (uint32_t n = 0; n < 50; n++) {
            double *sample = add_sample(&trace, n, 1);
            const double value = constant < VALUES ? values[constant] : values[n % VALUES];
            sample[TRACE_SET_POSITION] = sample[TRACE_ACTUAL_VELOCITY] = sample[TRACE_TORQUE] = value;
        }
        char *svg = write_svg(&trace, &size);
        TEST_ASSERT_LESS_THAN(100000, size);
        check_well_formed(svg);
        free(svg);
        cm1e_trace_free(&trace);
    }
}

static void test_svg_shows_a_state_of_one_sample_and_a_peak_of_one_sample(void)
{
    trace_t trace = make_trace(1, 100000);
    size_t size;
    for (uint32_t n = 0; n < 100000; n++) {
        double *sample = add_sample(&trace, n, 1);
        sample[TRACE_STATE] = n == 61234 ? CM1E_AXIS_ERROR_STOP : CM1E_AXIS_STANDSTILL;
        sample[TRACE_TORQUE] = n == 43210 ? 100 : 0;
    }
    char *svg = write_svg(&trace, &size);
    TEST_ASSERT_EQUAL(1, count(svg, "<title>ErrorStop,"));
    TEST_ASSERT_EQUAL(2, count(svg, "<title>Standstill,"));
    const char *torque = strstr(strstr(svg, "[% of rated]"), "class=\"torque\" d=\"M");
    char *next = svg + (torque - svg) + strlen("class=\"torque\" d=\"M");
    double top = 1e9, bottom = 0;
    while (*next != '"') {
        strtod(next, &next);
        next++;
        const double y = strtod(next, &next);
        top = fmin(top, y);
        bottom = fmax(bottom, y);
        next += *next == ' ';
    }
    TEST_ASSERT_TRUE(bottom - top > 80); /* of a panel 110 high */
    free(svg);
    cm1e_trace_free(&trace);
}

static void test_svg_of_an_empty_trace_says_so(void)
{
    trace_t empty = make_trace(2, 10);
    size_t size;
    char *svg = write_svg(&empty, &size);
    check_well_formed(svg);
    TEST_ASSERT_NOT_NULL(strstr(svg, "The trace is empty."));
    free(svg);
    cm1e_trace_free(&empty);
}

/* ---- recording ------------------------------------------------------------------------------------------------- */

static void test_one_of_so_many_cycles_is_recorded_from_the_first_one_on(void)
{
    enum { CYCLES = 60 };
    for (uint32_t every = 0; every <= 7; every++) {
        trace_t trace;
        const uint32_t step = every ? every : 1;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_init(&trace, NULL, 0, CYCLES, every, NULL));
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_begin(&trace, NULL));
        for (int64_t n = 0; n < CYCLES; n++)
            cm1e_trace_record(&trace, NULL, n);
        TEST_ASSERT_EQUAL_UINT32((CYCLES + step - 1) / step, trace.used);
        for (uint32_t i = 0; i < trace.used; i++)
            TEST_ASSERT_EQUAL_INT64(i * step, trace.times_ns[i]);
        cm1e_trace_free(&trace);
    }
}

/** A double holds 53 of 64 bits; with the rest there are all of them. */
static void test_a_number_of_64_bits_is_whole_with_its_rest(void)
{
    static const int64_t numbers[] = {0, 1, -1, INT64_C(1) << 53, -(INT64_C(1) << 53), (INT64_C(1) << 53) + 1,
                                      -(INT64_C(1) << 53) - 1, (INT64_C(1) << 62) + 1025, -(INT64_C(1) << 62) - 1025,
                                      INT64_MAX, INT64_MIN, INT64_MIN + 1};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        for (int is_signed = 0; is_signed < 2; is_signed++) {
            const variable_t variable = {.form = VARIABLE_NUMBER, .type = is_signed ? CM1E_TRACE_LINT : CM1E_TRACE_ULINT};
            variable_value_t value = {{0}};
            double rest;
            memcpy(value.bytes, &numbers[i], sizeof numbers[i]);
            const double number = cm1e_variable_number_of(&variable, &value, &rest);
            if (is_signed)
                TEST_ASSERT_EQUAL_INT64(numbers[i], (int64_t)number + (int64_t)rest);
            else
                TEST_ASSERT_EQUAL_UINT64((uint64_t)numbers[i], (uint64_t)number + (uint64_t)rest);
        }
}

/* ---- CSV ------------------------------------------------------------------------------------------------------- */

static void test_csv_has_a_row_a_sample_in_the_order_of_time_also_after_the_ring_went_round(void)
{
    trace_t trace = make_trace(3, 100);
    size_t size;
    cm1e_diag_t diag = {0};
    for (uint32_t n = 0; n < 250; n++) {
        double *sample = add_sample(&trace, n, 5);
        sample[TRACE_SET_POSITION] = 2147480000.25 + n; /* counts of 32 bits, and parts of them */
        sample[TRACE_SET_VELOCITY] = 0.1;
        sample[3 * TRACE_AXIS_COLUMNS + 3] = 9007199254740990; /* overruns */
    }
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_trace_write_file(&trace, csv_path, cm1e_trace_print_csv, &diag), diag.text);
    char *csv = read_file(csv_path, &size);
    TEST_ASSERT_NOT_NULL(strstr(csv, ",2147480249.25,"));
    TEST_ASSERT_NOT_NULL(strstr(csv, ",0.1,")); /* not 0.10000000000000001 */
    TEST_ASSERT_NOT_NULL(strstr(csv, ",9007199254740990,")); /* every digit of a number of events */
    TEST_ASSERT_EQUAL(101, count(csv, "\n"));
    TEST_ASSERT_NOT_NULL(strstr(csv, "\"gripper set position [u]\""));
    TEST_ASSERT_NOT_NULL(strstr(csv, "\"<&\"\"'>\x01 torque [%]\"")); /* RFC 4180: quotes doubled */
    char *line = strchr(csv, '\n') + 1;
    for (int n = 150; n < 250; n++) {
        TEST_ASSERT_EQUAL_DOUBLE(n * 0.001, strtod(line, NULL));
        unsigned commas = 0;
        for (; *line != '\n'; line++)
            commas += *line == ',';
        TEST_ASSERT_EQUAL(18 + 4 + 3, commas); /* the axes, the cycle, the errors of the axes */
        line++;
    }
    free(csv);
    cm1e_trace_free(&trace);
}

/** A variable has the digits that give its value back, and no more. */
static void test_csv_has_the_digits_of_a_variable(void)
{
    static const double values[] = {0.1, 1.0 / 3.0, 5e-324, -1e300, 4503599627370497.5};
    trace_t trace;
    const trace_column_t column = {.name = "v", .type = CM1E_TRACE_LREAL, .value = values};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_init(&trace, NULL, 0, 5, 1, NULL));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_add(&trace, &column, NULL));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_begin(&trace, NULL));
    for (uint32_t n = 0; n < 5; n++)
        cm1e_trace_next_sample(&trace, n * INT64_C(1000000))[trace.column_count - 1] = values[n];
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_write_file(&trace, csv_path, cm1e_trace_print_csv, NULL));
    size_t size;
    char *csv = read_file(csv_path, &size), *line = csv;
    for (int n = 0; n < 5; n++) {
        line = strchr(line, '\n') + 1;
        const char *last = strchr(line, '\n') - 1;
        while (*last != ',')
            last--;
        TEST_ASSERT_EQUAL_DOUBLE(values[n], strtod(last + 1, NULL));
        TEST_ASSERT_TRUE(values[n] == strtod(last + 1, NULL));
        TEST_ASSERT_TRUE(n > 0 || strncmp(last, ",0.1\n", 5) == 0);
    }
    free(csv);
    cm1e_trace_free(&trace);
}

static void test_a_sample_begins_with_zeros_also_after_the_ring_went_round(void)
{
    trace_t trace = make_trace(2, 3);
    for (uint32_t n = 0; n < 7; n++) {
        double *sample = cm1e_trace_next_sample(&trace, n);
        for (uint32_t i = 0; i < trace.column_count; i++) {
            TEST_ASSERT_EQUAL_DOUBLE(0.0, sample[i]);
            sample[i] = 7.0;
        }
    }
    cm1e_trace_free(&trace);
}

/* ---- files ----------------------------------------------------------------------------------------------------- */

static void test_numbers_have_a_point_in_every_locale(void)
{
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8"))
        TEST_IGNORE_MESSAGE("no locale with a decimal comma here");
    trace_t trace = make_trace(1, 10);
    size_t size;
    for (uint32_t n = 0; n < 10; n++)
        add_sample(&trace, n, 0.123);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_write_file(&trace, csv_path, cm1e_trace_print_csv, NULL));
    TEST_ASSERT_EQUAL_STRING("de_DE.UTF-8", setlocale(LC_NUMERIC, NULL));
    setlocale(LC_NUMERIC, "C");
    char *csv = read_file(csv_path, &size);
    TEST_ASSERT_NOT_NULL(strstr(csv, "\n0.001000,"));
    free(csv);
    cm1e_trace_free(&trace);
}

/* As a disk that fills in the middle. */
static void print_half(const trace_t *trace, FILE *file)
{
    cm1e_trace_print_csv(trace, file);
    fflush(file);
    close(fileno(file));
    fputs("the rest", file);
}

static void test_old_file_stays_until_the_new_one_is_whole(void)
{
    trace_t empty = make_trace(1, 1);
    size_t size;
    cm1e_diag_t diag = {0};
    FILE *file = fopen(csv_path, "w");
    fputs("old", file);
    fclose(file);
    TEST_ASSERT_EQUAL(CM1E_ERROR_IO, cm1e_trace_write_file(&empty, csv_path, print_half, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, csv_path));
    char *text = read_file(csv_path, &size);
    TEST_ASSERT_EQUAL_STRING("old", text);
    free(text);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_write_file(&empty, csv_path, cm1e_trace_print_csv, &diag));
    cm1e_trace_free(&empty);
}

static void test_a_link_beside_the_file_is_not_followed(void)
{
    static const char victim[] = CM1E_TEST_OUTPUT "/victim";
    trace_t empty = make_trace(1, 1);
    char part[sizeof csv_path + 8];
    size_t size;
    FILE *file = fopen(victim, "w");
    fputs("of somebody else", file);
    fclose(file);
    snprintf(part, sizeof part, "%s.part", csv_path);
    unlink(part);
    unlink(csv_path);
    TEST_ASSERT_EQUAL(0, symlink(victim, part));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_write_file(&empty, csv_path, cm1e_trace_print_csv, NULL));
    char *text = read_file(victim, &size);
    TEST_ASSERT_EQUAL_STRING("of somebody else", text);
    free(text);
    unlink(part);
    unlink(victim);
    cm1e_trace_free(&empty);
}

static void test_paths_that_cannot_be_written_are_named(void)
{
    trace_t empty = make_trace(1, 1);
    char long_path[5000];
    cm1e_diag_t diag = {0};
    memset(long_path, 'a', sizeof long_path);
    long_path[sizeof long_path - 1] = '\0';
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_trace_write_file(&empty, NULL, cm1e_trace_print_csv, &diag));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT,
                      cm1e_trace_write_file(&empty, long_path, cm1e_trace_print_csv, &diag));
    TEST_ASSERT_EQUAL(CM1E_ERROR_IO, cm1e_trace_write_file(&empty, "/nowhere/at/all.csv", cm1e_trace_print_csv, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "/nowhere/at/all.csv"));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_write_file(&empty, "/dev/null", cm1e_trace_print_csv, &diag));
    struct stat status;
    TEST_ASSERT_EQUAL(0, stat("/dev/null", &status));
    TEST_ASSERT_TRUE(S_ISCHR(status.st_mode)); /* a device is written to, not replaced */
    TEST_ASSERT_EQUAL(CM1E_ERROR_IO, cm1e_trace_write_file(&empty, "/dev/full", cm1e_plot_print_svg, &diag));
    cm1e_trace_free(&empty);
    const trace_t none = {.axes = 3, .capacity = 0};
    TEST_ASSERT_EQUAL(CM1E_ERROR_STATE, cm1e_trace_write_file(&none, csv_path, cm1e_trace_print_csv, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "trace_capacity"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_svg_of_few_and_many_axes_is_well_formed_and_below_half_a_megabyte);
    RUN_TEST(test_svg_shows_the_marks_of_its_time);
    RUN_TEST(test_svg_marks_are_never_printed_over_each_other);
    RUN_TEST(test_svg_survives_any_values);
    RUN_TEST(test_svg_shows_a_state_of_one_sample_and_a_peak_of_one_sample);
    RUN_TEST(test_svg_of_an_empty_trace_says_so);
    RUN_TEST(test_one_of_so_many_cycles_is_recorded_from_the_first_one_on);
    RUN_TEST(test_a_number_of_64_bits_is_whole_with_its_rest);
    RUN_TEST(test_csv_has_the_digits_of_a_variable);
    RUN_TEST(test_a_sample_begins_with_zeros_also_after_the_ring_went_round);
    RUN_TEST(test_csv_has_a_row_a_sample_in_the_order_of_time_also_after_the_ring_went_round);
    RUN_TEST(test_numbers_have_a_point_in_every_locale);
    RUN_TEST(test_old_file_stays_until_the_new_one_is_whole);
    RUN_TEST(test_a_link_beside_the_file_is_not_followed);
    RUN_TEST(test_paths_that_cannot_be_written_are_named);
    return UNITY_END();
}
