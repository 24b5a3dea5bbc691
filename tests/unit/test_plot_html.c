/**
 * The data of a page, read back from it without a browser: every value of every kind of column, in as few bytes as keep it,
 * errors, marks, texts; and what a live page asks for.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plot/plot_files.h"
#include "unity.h"

extern const char cm1e_plot_dygraphs_js[]; /* "": this build has no library for pages */

enum { MOST = 64, OVERRUNS = TRACE_AXIS_COLUMNS + 3, ERRORS = TRACE_AXIS_COLUMNS + 4, VARIABLES, BIG = VARIABLES, EXACT, SINGLE, LAMP,
       FAR, COLUMNS };

static trace_t trace;
static char *page;
static size_t size;

static void start(void)
{
    static const char *const names[] = {"a \"b\" <c> & \\d"};
    static const double variable;
    static const struct {
        const char *name, *unit;
        cm1e_trace_type_t type;
        trace_kind_t kind;
    } rows[] = {{"big", "", CM1E_TRACE_LINT, TRACE_KIND_NUMBER}, {"exact", "mm", CM1E_TRACE_LREAL, TRACE_KIND_NUMBER},
                {"single", "%", CM1E_TRACE_REAL, TRACE_KIND_NUMBER}, {"lamp", "", CM1E_TRACE_BOOL, TRACE_KIND_FLAG},
                {"far", "", CM1E_TRACE_LREAL, TRACE_KIND_NUMBER}};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_init(&trace, names, 1, MOST, 1, NULL));
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        trace_column_t column = {.type = rows[i].type, .kind = rows[i].kind, .value = &variable};
        strcpy(column.name, rows[i].name);
        strcpy(column.unit, rows[i].unit);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_add(&trace, &column, NULL));
    }
    TEST_ASSERT_EQUAL(COLUMNS, trace.column_count);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_begin(&trace, NULL));
}

void setUp(void)
{
    page = NULL;
    start();
}

void tearDown(void)
{
    cm1e_trace_free(&trace);
    free(page);
}

static void add_samples(uint32_t from, uint32_t to)
{
    for (uint32_t n = from; n < to; n++) {
        double *sample = cm1e_trace_next_sample(&trace, (1000 + n) * INT64_C(1000000));
        for (uint32_t i = 0; i < TRACE_AXIS_COLUMNS; i++)
            sample[i] = i == TRACE_STATE ? n % CM1E_AXIS_STATE_COUNT : 1e6 + 1.001 * n * i;
        sample[OVERRUNS] = 3.0 * n;
        sample[BIG] = 16777217.0 * (n % 2); /* one bit more than four bytes hold */
        sample[EXACT] = 0.1 * n;
        sample[SINGLE] = (double)(0.1f * (float)n);
        sample[LAMP] = n % 2;
        sample[FAR] = n == 3 ? NAN : 1e18 + 256 * n; /* four bytes hold the differences */
    }
}

static void print(void)
{
    free(page);
    page = NULL;
    FILE *file = open_memstream(&page, &size);
    cm1e_plot_print_html(&trace, file);
    fclose(file);
}

/* ---- read back --------------------------------------------------------------------------------------------------- */

/** Of RFC 4648, up to a quotation mark; the number of bytes. */
static size_t decode(const char *text, uint8_t *bytes, size_t room)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const size_t length = strcspn(text, "\""), signs = strcspn(text, "=\"");
    size_t used = 0;
    TEST_ASSERT_EQUAL_size_t(0, length % 4);
    TEST_ASSERT_LESS_OR_EQUAL(2, length - signs);
    for (size_t i = 0, bits = 0; i < signs; i++) {
        const char *digit = strchr(digits, text[i]);
        TEST_ASSERT_NOT_NULL(digit);
        bits = bits << 6 | (size_t)(digit - digits);
        if (i % 4 == 0)
            continue;
        TEST_ASSERT_LESS_THAN(room, used);
        bytes[used++] = (uint8_t)(bits >> (6 - i % 4 * 2));
    }
    TEST_ASSERT_EQUAL_size_t(length / 4 * 3 - (length - signs), used);
    return used;
}

static const char *behind(const char *from, const char *words)
{
    const char *at = strstr(from, words);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, words);
    return at + strlen(words);
}

static unsigned count(const char *text, const char *word)
{
    unsigned n = 0;
    for (const char *c = strstr(text, word); c; c = strstr(c + 1, word))
        n++;
    return n;
}

/** The values of a column, as the script of the page makes them; the bytes of each. */
static int read_column(const char *name, double *values)
{
    static uint8_t bytes[8 * MOST];
    char words[80];
    int wide;
    double base;
    snprintf(words, sizeof words, "{\"name\": \"%s\", ", name);
    const char *column = behind(page, words);
    TEST_ASSERT_EQUAL_INT(2, sscanf(behind(column, "\"bytes\": "), "%d, \"base\": %lf", &wide, &base));
    TEST_ASSERT_EQUAL_size_t((size_t)wide * trace.used, decode(behind(column, "\"data\": \""), bytes, sizeof bytes));
    for (uint32_t n = 0; n < trace.used; n++) {
        float narrow;
        memcpy(&narrow, bytes + 4 * n, sizeof narrow);
        values[n] = base + narrow;
        if (wide == 8)
            memcpy(&values[n], bytes + 8 * n, sizeof values[n]);
    }
    return wide;
}

/** The tolerance of a value of an axis is 1e-6. */
static void expect_column(uint32_t i, int wide, double tolerance)
{
    double values[MOST];
    const char *name = i < TRACE_AXIS_COLUMNS ? strrchr(trace.columns[i].name, 'd') + 1 : trace.columns[i].name;
    char words[160];
    snprintf(words, sizeof words, "%s%s", i < TRACE_AXIS_COLUMNS ? "a \\u0022b\\u0022 \\u003cc\\u003e \\u0026 \\u005cd" : "", name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(wide, read_column(words, values), words);
    for (uint32_t n = 0; n < trace.used; n++) {
        const double value = cm1e_trace_sample(&trace, n)[i];
        TEST_ASSERT_TRUE_MESSAGE(fabs(values[n] - value) <= tolerance || (isnan(value) && isnan(values[n])), words);
    }
}

static void test_every_value_of_every_column_comes_back(void)
{
    for (uint32_t n = 0; n < 7; n++) { /* all ends of Base64 */
        add_samples(n, n + 1);
        print();
        for (uint32_t i = TRACE_SET_POSITION; i < TRACE_AXIS_COLUMNS; i++)
            expect_column(i, 4, 1e-6);
        expect_column(OVERRUNS, 4, 0);
        expect_column(BIG, n > 0 ? 8 : 4, 0);
        expect_column(EXACT, n > 0 ? 8 : 4, 0);
        expect_column(SINGLE, 4, 0);
        expect_column(LAMP, 4, 0);
        expect_column(FAR, n > 2 ? 8 : 4, 0);
        double times[MOST];
        TEST_ASSERT_EQUAL_size_t(8 * trace.used, decode(behind(page, "\"times\": \""), (uint8_t *)times, sizeof times));
        TEST_ASSERT_EQUAL_DOUBLE(1.0 + n * 1e-3, times[n]);
    }
}

static void test_a_column_says_what_it_is(void)
{
    static const char *const wanted[] = {
        "set position\", \"unit\": \"u\", \"kind\": \"number\", \"integer\": false, \"program\": false, \"single\": false",
        "state\", \"unit\": \"\", \"kind\": \"state\"", "error\", \"unit\": \"\", \"kind\": \"error\"",
        "{\"name\": \"overruns\", \"unit\": \"\", \"kind\": \"count\", \"integer\": true, \"program\": false, \"single\": false",
        "{\"name\": \"big\", \"unit\": \"\", \"kind\": \"number\", \"integer\": true, \"program\": true, \"single\": false",
        "{\"name\": \"exact\", \"unit\": \"mm\", \"kind\": \"number\", \"integer\": false, \"program\": true, \"single\": false",
        "{\"name\": \"single\", \"unit\": \"%\", \"kind\": \"number\", \"integer\": false, \"program\": true, \"single\": true",
        "{\"name\": \"lamp\", \"unit\": \"\", \"kind\": \"flag\", \"integer\": true, \"program\": true, \"single\": false",
        "\"axes\": [{\"name\": \"a \\u0022b\\u0022 \\u003cc\\u003e \\u0026 \\u005cd\", \"first\": 0, \"count\": 6}],",
        "{\"name\": \"ErrorStop\", \"colour\": \"#d5343b\"}",
    };
    add_samples(0, 1);
    print();
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++)
        TEST_ASSERT_EQUAL_UINT_MESSAGE(1, count(page, wanted[i]), wanted[i]);
}

static void test_errors_have_their_text_where_they_begin(void)
{
    static const int errors[] = {0, CM1E_ERROR_BUS_LOST, CM1E_ERROR_BUS_LOST, CM1E_ERROR_DRIVE_FAULT, 0, 0};
    char row[200];
    for (uint32_t n = 0; n < 6; n++) {
        add_samples(n, n + 1);
        trace.values[n * COLUMNS + ERRORS] = errors[n];
    }
    print();
    snprintf(row, sizeof row, "\"errors\": {\"%d\": \"%s\", \"%d\": \"%s\"},\n", CM1E_ERROR_BUS_LOST,
             cm1e_strerror(CM1E_ERROR_BUS_LOST), CM1E_ERROR_DRIVE_FAULT, cm1e_strerror(CM1E_ERROR_DRIVE_FAULT));
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, count(page, row), row);
}

static void test_marks_of_the_time_that_is_shown(void)
{
    static const int at_ms[] = {999, 1000, 1002, 1003, 1004};
    for (int i = 0; i < 5; i++)
        cm1e_trace_mark(&trace, i % 2 ? "<odd>" : "even", at_ms[i] * INT64_C(1000000));
    print();
    TEST_ASSERT_EQUAL_UINT(1, count(page, "\"marks\": [], "));
    add_samples(0, 4);
    print();
    TEST_ASSERT_EQUAL_UINT(1, count(page, "\"marks\": [{\"t\": 1.000000000, \"text\": \"\\u003codd\\u003e\"}, {\"t\": "
                                    "1.002000000, \"text\": \"even\"}, {\"t\": 1.003000000, \"text\": \"\\u003codd\\u003e\"}], "));
}

/* ---- live -------------------------------------------------------------------------------------------------------- */

static void test_a_live_page_asks_where_it_comes_from(void)
{
    char row[200];
    cm1e_diag_t diag = {0};
    FILE *file = open_memstream(&page, &size);
    const cm1e_error_t error = cm1e_plot_print_live_page(&trace, "/trace?<x>", file, &diag);
    fclose(file);
    if (!cm1e_plot_dygraphs_js[0]) {
        TEST_ASSERT_EQUAL(CM1E_ERROR_UNSUPPORTED, error);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "libjs-dygraphs"), diag.text);
        TEST_ASSERT_EQUAL_size_t(0, size);
        return;
    }
    TEST_ASSERT_EQUAL_UINT(1, count(page, "\"marks\": [], \"live\": \"/trace?\\u003cx\\u003e\"};\n</script>"));
    TEST_ASSERT_EQUAL_UINT(0, count(page, "\"data\": \""));
    TEST_ASSERT_EQUAL_UINT(1, count(page, "{\"name\": \"far\", \"unit\": \"\", \"kind\": \"number\", \"integer\": false, "
                                    "\"program\": true, \"single\": false}],\n"));
    snprintf(row, sizeof row, "\"%d\": \"%s\"", CM1E_ERROR_BUS_LOST, cm1e_strerror(CM1E_ERROR_BUS_LOST));
    TEST_ASSERT_EQUAL_UINT(1, count(page, row));
    TEST_ASSERT_EQUAL_UINT(0, count(page, ", \"bytes\": "));
}

static void test_the_newest_samples_and_marks_are_given_to_a_live_page(void)
{
    enum { NEWEST = 3 };
    static double values[(1 + COLUMNS) * NEWEST];
    add_samples(0, 10);
    for (int i = 0; i < 3; i++)
        cm1e_trace_mark(&trace, "mark", (1005 + i) * INT64_C(1000000));
    FILE *file = open_memstream(&page, &size);
    cm1e_plot_print_live_samples(&trace, NEWEST, UINT64_MAX, 1005 * INT64_C(1000000), file);
    fclose(file);
    TEST_ASSERT_EQUAL_UINT(1, count(page, "{\"number\": 18446744073709551615, \"marks\": [{\"t\": 1.006000000, \"text\": "
                                    "\"mark\"}, {\"t\": 1.007000000, \"text\": \"mark\"}], \"samples\": \""));
    TEST_ASSERT_EQUAL_STRING("\"}", page + size - 2);
    TEST_ASSERT_EQUAL_size_t(sizeof values, decode(behind(page, "\"samples\": \""), (uint8_t *)values, sizeof values));
    for (uint32_t n = 0; n < NEWEST; n++) {
        const double *sample = cm1e_trace_sample(&trace, 10 - NEWEST + n), *row = values + n * (1 + COLUMNS);
        TEST_ASSERT_EQUAL_DOUBLE(1.007 + n * 1e-3, row[0]);
        TEST_ASSERT_EQUAL_MEMORY(sample, row + 1, COLUMNS * sizeof *sample);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_value_of_every_column_comes_back);
    RUN_TEST(test_a_column_says_what_it_is);
    RUN_TEST(test_errors_have_their_text_where_they_begin);
    RUN_TEST(test_marks_of_the_time_that_is_shown);
    RUN_TEST(test_a_live_page_asks_where_it_comes_from);
    RUN_TEST(test_the_newest_samples_and_marks_are_given_to_a_live_page);
    return UNITY_END();
}
