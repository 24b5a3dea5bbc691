/* The drawing: lanes of BOOL over time, the state of the axis as a band, numbers as curves. Everything in pixels. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "diagram.h"

enum {
    WIDTH = 836, LEFT = 184, RIGHT = 22, PLOT = WIDTH - LEFT - RIGHT,
    TOP = 14, LINE = 18, LANE = 22, HIGH = 4, LOW = 17, TITLE = 24, BAND = 22, PANEL = 92, PANEL_GAP = 14, TICKS = 34,
    MOST_POINTS = 2 * PLOT,
};

static const char *const state_colours[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = "#d9dce1",          [CM1E_AXIS_STANDSTILL] = "#bfe5c8",
    [CM1E_AXIS_HOMING] = "#f8e29a",            [CM1E_AXIS_DISCRETE_MOTION] = "#b4d2f5",
    [CM1E_AXIS_CONTINUOUS_MOTION] = "#d2c7ef", [CM1E_AXIS_SYNCHRONIZED_MOTION] = "#aee0dc",
    [CM1E_AXIS_STOPPING] = "#f9cfa4",          [CM1E_AXIS_ERROR_STOP] = "#f2aeb1",
};

static const char style[] =
    "text{font:12px 'DejaVu Sans',Verdana,sans-serif;fill:#24292f}"
    ".n{text-anchor:end}.t{font-weight:bold}.b{font-size:15px;font-weight:bold}.s{font-size:11px;fill:#57606a}"
    ".m{text-anchor:middle}.g{stroke:#e6e8eb}.z{stroke:#c4c9cf}.d{stroke:#b0b6bd;stroke-dasharray:3 3}"
    ".i{fill:#dbe9fb;stroke:#2f6fc4}.o{fill:#d9f0dd;stroke:#2c8a43}.e{fill:#fbdcdc;stroke:#c0343a}"
    ".c{fill:none;stroke:#b3261e;stroke-width:1.6;stroke-linejoin:round}";

typedef struct drawing {
    FILE *file;
    const trace_t *trace;
    int y;
} drawing_t;

static double x_of(const drawing_t *drawing, int scan) { return LEFT + (double)scan * PLOT / drawing->trace->count; }

static void text(const drawing_t *drawing, double x, double y, const char *class, const char *words)
{
    fprintf(drawing->file, "<text x=\"%.1f\" y=\"%.1f\" class=\"%s\">", x, y, class);
    for (; *words; words++) {
        switch (*words) {
        case '<': fputs("&lt;", drawing->file); break;
        case '&': fputs("&amp;", drawing->file); break;
        default: fputc(*words, drawing->file);
        }
    }
    fputs("</text>\n", drawing->file);
}

static void line(const drawing_t *drawing, double x1, double y1, double x2, double y2, const char *class)
{
    fprintf(drawing->file, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" class=\"%s\"/>\n", x1, y1, x2, y2,
            class);
}

/* ---- head ------------------------------------------------------------------------------------------------------ */

static int lines_of(const char *words)
{
    int lines = *words ? 1 : 0;
    for (; *words; words++)
        lines += *words == '\n';
    return lines;
}

static void draw_head(drawing_t *drawing)
{
    char words[512];
    snprintf(words, sizeof words, "%s", drawing->trace->about);
    text(drawing, LEFT, drawing->y + 12, "b", drawing->trace->block);
    drawing->y += LINE + 4;
    for (char *rest = words, *one; (one = strsep(&rest, "\n")) && *one; drawing->y += LINE)
        text(drawing, LEFT, drawing->y + 12, "s", one);
    drawing->y += 6;
}

/* ---- lanes ----------------------------------------------------------------------------------------------------- */

/** The next scan from `scan` on at which the lane has another value. */
static int next_change(const drawing_t *drawing, const trace_lane_t *lane, int scan)
{
    const BOOL value = lane->values[scan];
    while (scan < drawing->trace->count && lane->values[scan] == value)
        scan++;
    return scan;
}

static void draw_lane(drawing_t *drawing, const trace_lane_t *lane)
{
    const char *class = lane->is_input ? "i" : strncmp(lane->name, "Error", 5) == 0 ? "e" : "o";
    const int low = drawing->y + LOW, high = drawing->y + HIGH;
    text(drawing, LEFT - 10, low - 2, "n", lane->name);
    fprintf(drawing->file, "<path class=\"%s\" d=\"M%d %d", class, LEFT, low);
    for (int scan = 0, end; scan < drawing->trace->count; scan = end) {
        end = next_change(drawing, lane, scan);
        if (lane->values[scan])
            fprintf(drawing->file, "H%.1fV%dH%.1fV%d", x_of(drawing, scan), high,
                    fmax(x_of(drawing, end), x_of(drawing, scan) + 1.5), low);
    }
    fprintf(drawing->file, "H%d\"/>\n", WIDTH - RIGHT);
    drawing->y += LANE;
}

static void draw_lanes(drawing_t *drawing)
{
    const char *title = NULL;
    for (int i = 0; i < drawing->trace->lane_count; i++) {
        const trace_lane_t *lane = &drawing->trace->lanes[i];
        title = lane->title ? lane->title : title;
        if (!lane->ever)
            continue;
        if (title && *title) {
            text(drawing, LEFT - 10, drawing->y + TITLE - 7, "n t", title);
            drawing->y += TITLE;
        }
        title = NULL;
        draw_lane(drawing, lane);
    }
}

/* ---- the axis's state ------------------------------------------------------------------------------------------ */

static void draw_states(drawing_t *drawing)
{
    const trace_t *trace = drawing->trace;
    drawing->y += 6;
    text(drawing, LEFT - 10, drawing->y + 15, "n t", "axis");
    for (int scan = 0, end; scan < trace->count; scan = end) {
        for (end = scan; end < trace->count && trace->states[end] == trace->states[scan];)
            end++;
        const double x = x_of(drawing, scan), width = x_of(drawing, end) - x;
        const char *name = cm1e_axis_state_name((cm1e_axis_state_t)trace->states[scan]);
        fprintf(drawing->file, "<rect x=\"%.1f\" y=\"%d\" width=\"%.1f\" height=\"%d\" fill=\"%s\"/>\n", x, drawing->y,
                width, BAND, state_colours[trace->states[scan]]);
        if (width > 6.2 * (double)strlen(name))
            text(drawing, x + width / 2, drawing->y + 15, "s m", name);
    }
    drawing->y += BAND;
}

/* ---- curves ---------------------------------------------------------------------------------------------------- */

static void range_of(const trace_t *trace, const trace_curve_t *curve, double *lowest, double *highest)
{
    *lowest = *highest = 0; /* zero is always in the picture */
    for (int n = 0; n < trace->count; n++) {
        *lowest = fmin(*lowest, curve->values[n]);
        *highest = fmax(*highest, curve->values[n]);
    }
    if (*highest - *lowest < 1e-9)
        *highest = *lowest + 1;
}

/** A step of 1, 2 or 5 times a power of ten that divides a range into at most `parts`. */
static double nice_step(double range, int parts)
{
    const double raw = range / parts, power = pow(10, floor(log10(raw))), lead = raw / power;
    return power * (lead <= 1.0001 ? 1 : lead <= 2.0001 ? 2 : lead <= 5.0001 ? 5 : 10);
}

static void draw_scale(const drawing_t *drawing, double lowest, double highest, double bottom, double pixels_per_unit)
{
    const double step = nice_step(highest - lowest, 4);
    for (double n = ceil(lowest / step - 1e-6); n * step <= highest + 1e-6 * step; n++) {
        const double value = n * step, y = bottom - (value - lowest) * pixels_per_unit;
        char number[32];
        snprintf(number, sizeof number, "%.6g", fabs(value) < 1e-12 ? 0 : value);
        line(drawing, LEFT, y, WIDTH - RIGHT, y, fabs(n) < 0.5 ? "z" : "g");
        text(drawing, LEFT - 6, y + 4, "s n", number);
    }
}

/** Only the points that a straight line from the last one kept would miss by more than a tolerance. */
static void draw_points(const drawing_t *drawing, const double *values, double zero, double scale)
{
    const int count = drawing->trace->count, stride = count / MOST_POINTS + 1;
    const double tolerance = 0.15;
    int kept = 0;
    double steepest = -INFINITY, flattest = INFINITY; /* slopes of lines from the kept point that still fit */
    for (int n = 0; n < count; n += stride) {
        const double y = zero - values[n] * scale, from = zero - values[kept] * scale, slope = (y - from) / (n - kept);
        const bool fits = n == kept || (slope >= steepest && slope <= flattest);
        if (!fits) {
            kept = n - stride;
            fprintf(drawing->file, "%.1f,%.1f ", x_of(drawing, kept), zero - values[kept] * scale);
            steepest = -INFINITY;
            flattest = INFINITY;
        } else if (n == 0) {
            fprintf(drawing->file, "%.1f,%.1f ", x_of(drawing, 0), y);
            continue;
        }
        const double base = zero - values[kept] * scale;
        steepest = fmax(steepest, (y - tolerance - base) / (n - kept));
        flattest = fmin(flattest, (y + tolerance - base) / (n - kept));
    }
    const int last = (count - 1) / stride * stride;
    fprintf(drawing->file, "%.1f,%.1f", x_of(drawing, last), zero - values[last] * scale);
}

/** Whole numbers jump. */
static void draw_steps(const drawing_t *drawing, const double *values, double zero, double scale)
{
    const int count = drawing->trace->count;
    fprintf(drawing->file, "%.1f,%.1f ", x_of(drawing, 0), zero - values[0] * scale);
    for (int n = 1; n < count; n++)
        if (values[n] != values[n - 1])
            fprintf(drawing->file, "%.1f,%.1f %.1f,%.1f ", x_of(drawing, n), zero - values[n - 1] * scale,
                    x_of(drawing, n), zero - values[n] * scale);
    fprintf(drawing->file, "%.1f,%.1f", x_of(drawing, count), zero - values[count - 1] * scale);
}

/** An ErrorID as what it is, not as a height. */
static void draw_words(drawing_t *drawing, const trace_curve_t *curve)
{
    const int count = drawing->trace->count;
    drawing->y += 6;
    text(drawing, LEFT - 10, drawing->y + 15, "n", curve->name);
    for (int scan = 0, end; scan < count; scan = end) {
        for (end = scan; end < count && curve->values[end] == curve->values[scan];)
            end++;
        if (curve->values[scan] == 0)
            continue;
        const double x = x_of(drawing, scan), width = x_of(drawing, end) - x;
        char number[16];
        snprintf(number, sizeof number, "0x%04X", (unsigned)curve->values[scan]);
        fprintf(drawing->file, "<rect x=\"%.1f\" y=\"%d\" width=\"%.1f\" height=\"%d\" class=\"e\"/>\n", x, drawing->y,
                width, BAND);
        if (width > 48)
            text(drawing, x + width / 2, drawing->y + 15, "s m", number);
    }
    drawing->y += BAND;
}

static void draw_curve(drawing_t *drawing, const trace_curve_t *curve)
{
    const trace_t *trace = drawing->trace;
    if (curve->type == BLOCK_WORD) {
        draw_words(drawing, curve);
        return;
    }
    double lowest, highest;
    drawing->y += PANEL_GAP;
    range_of(trace, curve, &lowest, &highest);
    const double bottom = drawing->y + PANEL, scale = PANEL / (highest - lowest);
    draw_scale(drawing, lowest, highest, bottom, scale);
    char title[64];
    snprintf(title, sizeof title, "%s", curve->name);
    text(drawing, LEFT - 48, drawing->y + PANEL / 2.0, "n t", title);
    text(drawing, LEFT - 48, drawing->y + PANEL / 2.0 + 15, "s n", curve->unit);
    fputs("<polyline class=\"c\" points=\"", drawing->file);
    if (curve->type == BLOCK_LREAL || curve->type == BLOCK_TIME)
        draw_points(drawing, curve->values, bottom + lowest * scale, scale);
    else
        draw_steps(drawing, curve->values, bottom + lowest * scale, scale);
    fputs("\"/>\n", drawing->file);
    drawing->y += PANEL;
}

/* ---- time ------------------------------------------------------------------------------------------------------ */

static void draw_time(drawing_t *drawing, int top)
{
    const int count = drawing->trace->count;
    const double step = nice_step(count, 9);
    for (double ms = 0; ms <= count + 1e-6; ms += step) {
        char number[32];
        snprintf(number, sizeof number, "%g", ms);
        line(drawing, x_of(drawing, (int)ms), top, x_of(drawing, (int)ms), drawing->y + 4, "g");
        text(drawing, x_of(drawing, (int)ms), drawing->y + 18, "s m", number);
    }
    text(drawing, LEFT - 10, drawing->y + 18, "s n", "ms");
}

/** Where an input changes, so that the eye finds what follows from it. */
static void draw_edges(const drawing_t *drawing, int top)
{
    double last[TRACE_LANES * 8];
    int kept = 0;
    for (int i = 0; i < drawing->trace->lane_count; i++) {
        const trace_lane_t *lane = &drawing->trace->lanes[i];
        if (!lane->is_input || !lane->ever)
            continue;
        for (int scan = next_change(drawing, lane, 0); scan < drawing->trace->count;
             scan = next_change(drawing, lane, scan)) {
            const double x = x_of(drawing, scan);
            bool is_new = kept < (int)(sizeof last / sizeof *last);
            for (int k = 0; k < kept && is_new; k++)
                is_new = fabs(last[k] - x) > 2;
            if (!is_new)
                continue;
            last[kept++] = x;
            line(drawing, x, top, x, drawing->y, "d");
        }
    }
}

/* ---- all of it ------------------------------------------------------------------------------------------------- */

static int height_of(const trace_t *trace)
{
    const char *title = NULL;
    int height = TOP + LINE + 4 + lines_of(trace->about) * LINE + 6;
    for (int i = 0; i < trace->lane_count; i++) {
        title = trace->lanes[i].title ? trace->lanes[i].title : title;
        if (!trace->lanes[i].ever)
            continue;
        height += LANE + (title && *title ? TITLE : 0);
        title = NULL;
    }
    for (int i = 0; i < trace->curve_count; i++)
        height += trace->curves[i].type == BLOCK_WORD ? BAND + 6 : PANEL + PANEL_GAP;
    return height + (trace->has_axis ? BAND + 6 : 0);
}

bool trace_draw(const trace_t *trace, const char *folder)
{
    char path[1024], part[1040];
    snprintf(path, sizeof path, "%s/%s.svg", folder, trace->block);
    snprintf(part, sizeof part, "%s.part", path);
    drawing_t drawing = {.file = fopen(part, "w"), .trace = trace, .y = height_of(trace)};
    if (!drawing.file)
        return false;
    const int height = drawing.y + TICKS, top = TOP + LINE + 4 + lines_of(trace->about) * LINE + 6;
    fprintf(drawing.file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\">\n"
            "<title>%s</title>\n<style>%s</style>\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            WIDTH, height, WIDTH, height, trace->block, style);
    draw_time(&drawing, top);
    draw_edges(&drawing, top);
    drawing.y = TOP;
    draw_head(&drawing);
    draw_lanes(&drawing);
    if (trace->has_axis)
        draw_states(&drawing);
    for (int i = 0; i < trace->curve_count; i++)
        draw_curve(&drawing, &trace->curves[i]);
    fputs("</svg>\n", drawing.file);
    const bool written = fclose(drawing.file) == 0;
    return written && rename(part, path) == 0;
}
