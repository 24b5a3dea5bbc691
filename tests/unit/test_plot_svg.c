/**
 * What the picture of a trace shows, read back from it: with the numbers at its axes every curve goes through the samples.
 * And the picture of a small trace to the last digit, as somebody has looked at it.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "golden.h"
#include "plot/plot_files.h"
#include "unity.h"

enum { AXES = 2, SAMPLES = 60, PANELS = 3, FIRST_MS = 1000, TICKS = 20 };

static trace_t trace;

static double wave(uint32_t axis, uint32_t column, uint32_t n)
{
    static const double scales[] = {0, 3, 3.01, 250, 245, 40};
    return scales[column] * sin(0.15 * n + axis + column) - (axis ? 2 * scales[column] : 0);
}

/** A level stretch, a gap, negative numbers, every state. */
void setUp(void)
{
    static const char *const names[] = {"X", "a <b> & c"};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_init(&trace, names, AXES, SAMPLES, 1, NULL));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_begin(&trace, NULL));
    for (uint32_t n = 0; n < SAMPLES; n++) {
        double *sample = cm1e_trace_next_sample(&trace, (FIRST_MS + n) * INT64_C(1000000));
        for (uint32_t axis = 0; axis < AXES; axis++) {
            double *columns = sample + axis * TRACE_AXIS_COLUMNS;
            for (uint32_t column = TRACE_SET_POSITION; column < TRACE_AXIS_COLUMNS; column++)
                columns[column] = wave(axis, column, n < 20 || n > 30 ? n : 20);
            columns[TRACE_STATE] = n / 5 % CM1E_AXIS_STATE_COUNT;
        }
        sample[TRACE_TORQUE] = n == 33 ? NAN : sample[TRACE_TORQUE];
    }
}

void tearDown(void) { cm1e_trace_free(&trace); }

static char *draw(size_t *size)
{
    char *text = NULL;
    FILE *file = open_memstream(&text, size);
    cm1e_plot_print_svg(&trace, file);
    fclose(file);
    return text;
}

/* ---- read back --------------------------------------------------------------------------------------------------- */

/** A straight line through what the ticks say. */
typedef struct ruler {
    double place[TICKS], number[TICKS];
    int count;
} ruler_t;

static double place_of(const ruler_t *ruler, double number)
{
    const int last = ruler->count - 1;
    TEST_ASSERT_GREATER_THAN(1, ruler->count);
    const double scale = (ruler->place[last] - ruler->place[0]) / (ruler->number[last] - ruler->number[0]);
    for (int i = 0; i < ruler->count; i++) /* they are on that line themselves */
        TEST_ASSERT_DOUBLE_WITHIN(0.11, ruler->place[0] + (ruler->number[i] - ruler->number[0]) * scale, ruler->place[i]);
    return ruler->place[0] + (number - ruler->number[0]) * scale;
}

/** The ticks between `from` and `to` whose text begins with such an attribute. */
static ruler_t read_ruler(const char *from, const char *to, const char *anchor, bool of_time)
{
    ruler_t ruler = {0};
    for (const char *at = from; (at = strstr(at, anchor)) && at < to; at++) {
        double x, y, number;
        if (sscanf(at + strlen(anchor), " x=\"%lf\" y=\"%lf\">%lf", &x, &y, &number) != 3)
            continue; /* a text */
        TEST_ASSERT_LESS_THAN(TICKS, ruler.count);
        ruler.place[ruler.count] = of_time ? x : y - 3.5; /* a text stands a little lower than its line */
        ruler.number[ruler.count++] = number;
    }
    return ruler;
}

/** Where a curve is at `x`, between its points too. */
static double curve_at(const char *points, double x)
{
    double x0 = -1, y0 = 0;
    for (char *at = (char *)(uintptr_t)points; *at != '"';) {
        const double x1 = strtod(at, &at), y1 = strtod(at + 1, &at);
        if (x <= x1 + 0.06)
            return x1 - x0 > 0.06 && x0 >= 0 ? y0 + (y1 - y0) * fmin(1, (x - x0) / (x1 - x0)) : y1;
        x0 = x1;
        y0 = y1;
        at += *at == ' ';
    }
    return y0;
}

static void compare_curve(const char *points, const ruler_t *times, const ruler_t *values, uint32_t axis, uint32_t column)
{
    for (uint32_t n = 0; n < SAMPLES; n++) {
        const double value = cm1e_trace_sample(&trace, n)[axis * TRACE_AXIS_COLUMNS + column];
        char what[40];
        snprintf(what, sizeof what, "axis %u, column %u, sample %u", axis, column, n);
        if (isfinite(value))
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.3, place_of(values, value),
                                              curve_at(points, place_of(times, (FIRST_MS + n) * 1e-3)), what);
    }
}

static void test_every_curve_goes_through_the_samples(void)
{
    static const struct {
        const char *path;
        uint32_t column;
    } curves[PANELS][2] = {
        {{"class=\"actual\" d=\"M", TRACE_ACTUAL_POSITION}, {"class=\"set\" d=\"M", TRACE_SET_POSITION}},
        {{"class=\"actual\" d=\"M", TRACE_ACTUAL_VELOCITY}, {"class=\"set\" d=\"M", TRACE_SET_VELOCITY}},
        {{"class=\"torque\" d=\"M", TRACE_TORQUE}, {NULL, 0}},
    };
    size_t size;
    char *svg = draw(&size);
    const char *panel = strstr(svg, "class=\"name\"");
    for (uint32_t axis = 0; axis < AXES; axis++) {
        const char *name = strstr(panel, "class=\"name\""), *next = strstr(name + 1, "class=\"name\"");
        const ruler_t times = read_ruler(name, next ? next : svg + size, "class=\"tick\" text-anchor=\"middle\"", true);
        panel = name;
        for (int i = 0; i < PANELS; i++) {
            const char *frame = strstr(panel, "class=\"frame\"");
            const ruler_t values = read_ruler(panel, frame, "class=\"tick\" text-anchor=\"end\"", false);
            for (int c = 0; c < 2 && curves[i][c].path; c++) {
                const char *points = strstr(panel, curves[i][c].path);
                TEST_ASSERT_TRUE(points && points < frame);
                compare_curve(points + strlen(curves[i][c].path), &times, &values, axis, curves[i][c].column);
            }
            panel = frame + 1;
        }
    }
    free(svg);
}

/** Height of the picture with this mark only: each row of texts makes it higher. */
static double height_with(const char *text)
{
    size_t size;
    double height;
    tearDown();
    setUp();
    cm1e_trace_mark(&trace, text, (FIRST_MS + SAMPLES - 2) * INT64_C(1000000));
    char *svg = draw(&size);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(svg, "class=\"tick note\""), text);
    TEST_ASSERT_EQUAL_INT(1, sscanf(strstr(svg, " height=\""), " height=\"%lf\"", &height));
    free(svg);
    return height;
}

/** However long a text is, it takes one row if no other one is there. */
static void test_a_text_alone_takes_one_row(void)
{
    char text[200];
    const double height = height_with("short");
    for (size_t length = 1; length < sizeof text; length++) {
        memset(text, length % 2 ? 'n' : 'i', length);
        text[length] = '\0';
        TEST_ASSERT_EQUAL_DOUBLE(height, height_with(text));
    }
}

/* ---- to the last digit ------------------------------------------------------------------------------------------- */

static void test_the_picture_of_a_small_trace_is_the_one_that_was_looked_at(void)
{
    size_t size;
    cm1e_trace_mark(&trace, "here", (FIRST_MS + 3) * INT64_C(1000000));
    cm1e_trace_mark(&trace, "a second one at the same time", (FIRST_MS + 3) * INT64_C(1000000));
    cm1e_trace_mark(&trace, "a text to the left of its mark, because there is more room", (FIRST_MS + 50) * INT64_C(1000000));
    cm1e_trace_mark(&trace, "a text \xC3\xA4 that is longer than the whole of the picture, wherever it stands, and so goes on, "
                    "and on, and on, until it is cut off, with three points behind it, and this is not seen any more",
                    (FIRST_MS + 30) * INT64_C(1000000));
    char *svg = draw(&size);
    golden_compare("trace.svg", svg, size);
    free(svg);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_curve_goes_through_the_samples);
    RUN_TEST(test_a_text_alone_takes_one_row);
    RUN_TEST(test_the_picture_of_a_small_trace_is_the_one_that_was_looked_at);
    return UNITY_END();
}
