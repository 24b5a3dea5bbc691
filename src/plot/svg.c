/* The trace as a picture: the axes one under the other on one time scale, with panels of position, velocity and torque,
 * a band above them that shows the state of the axis in colour, and the marks of the program as dashed lines with their
 * text. Every curve is thinned to the smallest and the largest value of each of a few hundred slices of time, so that
 * no peak is lost and the file stays below half a megabyte. */
#include <math.h>
#include <string.h>

#include "cm1e/plot.h"
#include "core/in_task.h"
#include "core/text.h"
#include "plot/plot_files.h"

/* ---- layout, in pixels ----------------------------------------------------------------------------------------- */

enum {
    LEFT = 72, RIGHT = 18, PLOT_WIDTH = 810, /* as wide as the head */
    HEAD = 84, NAME = 24, MARK_ROW = 12, MARK_GAP = 3, ELLIPSIS = 15, BAND = 12, PANEL_GAP = 16, TIME_AXIS = 44,
    BYTES_FOR_CURVES = 380000, BYTES_PER_POINT = 13,
};

typedef struct box {
    double x, y, width, height;
} box_t;

typedef struct curve {
    uint32_t column; /**< of the axis */
    const char *css;
} curve_t;

static const struct panel {
    const char *title, *unit;
    double height, smallest_range;
    curve_t curves[2]; /**< the first one is drawn below */
} panels[] = {
    {"position", "u", 130, 1e-3,
     {{TRACE_ACTUAL_POSITION, "actual"}, {TRACE_SET_POSITION, "set"}}},
    {"velocity", "u/s", 120, 1e-2,
     {{TRACE_ACTUAL_VELOCITY, "actual"}, {TRACE_SET_VELOCITY, "set"}}},
    {"torque", "% of rated", 110, 1.0, {{TRACE_TORQUE, "torque"}, {0, NULL}}},
};
enum { PANELS = sizeof panels / sizeof panels[0] };

const plot_state_t cm1e_plot_states[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {"#b9bec6", 1},          [CM1E_AXIS_STANDSTILL] = {"#7cc68d", 0},
    [CM1E_AXIS_HOMING] = {"#f2c230", 5},            [CM1E_AXIS_DISCRETE_MOTION] = {"#4c8eda", 2},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {"#8a6fd1", 3}, [CM1E_AXIS_SYNCHRONIZED_MOTION] = {"#2fa8a0", 4},
    [CM1E_AXIS_STOPPING] = {"#ef8632", 6},          [CM1E_AXIS_ERROR_STOP] = {"#d5343b", 7},
};

/** Where the text of a mark stands, measured from the left edge of a panel. */
typedef struct label {
    double x;           /**< of the mark */
    double from, to;    /**< of the text */
    unsigned row;       /**< 0: the lowest */
    size_t bytes;       /**< of the text that there is room for */
    const char *text;
} label_t;

typedef struct plot {
    FILE *file;
    const trace_t *trace;
    double begin_s, end_s;
    uint32_t slices;
    double width; /**< of a panel */
    label_t labels[TRACE_MARKS]; /**< of the marks in the time shown; the same above every axis */
    uint32_t label_count;
    unsigned label_rows;
} plot_t;

static double time_s(const plot_t *plot, uint32_t n) { return (double)cm1e_trace_time_ns(plot->trace, n) * 1e-9; }

static uint32_t slice_of(const plot_t *plot, uint32_t n)
{
    const double share = (time_s(plot, n) - plot->begin_s) / (plot->end_s - plot->begin_s);
    const uint32_t slice = (uint32_t)(share * plot->slices);
    return slice < plot->slices ? slice : plot->slices - 1;
}

static double x_of(const plot_t *plot, const box_t *box, double seconds)
{
    return box->x + (seconds - plot->begin_s) / (plot->end_s - plot->begin_s) * box->width;
}

static double value_of(const plot_t *plot, uint32_t n, uint32_t axis, uint32_t column)
{
    return cm1e_trace_sample(plot->trace, n)[axis * TRACE_AXIS_COLUMNS + column];
}

/** Bytes that are not UTF-8 would make the whole file unreadable: they become "?". */
static void print_escaped(FILE *file, const char *text, size_t bytes)
{
    char clean[1024];
    snprintf(clean, sizeof clean, "%.*s", (int)bytes, text);
    cm1e_text_clean(clean);
    for (const char *c = clean; *c; c++)
        switch (*c) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '"': fputs("&quot;", file); break;
        default: fputc(*c, file);
        }
}

/* ---- scales ---------------------------------------------------------------------------------------------------- */

typedef struct scale {
    double low, high, step; /**< step: between two ticks, 1, 2 or 5 times a power of 10 */
} scale_t;

static double nice_step(double range, int ticks)
{
    const double raw = range / ticks, power = pow(10, floor(log10(raw))), share = raw / power;
    return power * (share <= 1.4 ? 1 : share <= 3 ? 2 : share <= 7 ? 5 : 10);
}

static scale_t scale_of_panel(const plot_t *plot, uint32_t axis, const struct panel *panel)
{
    double low = INFINITY, high = -INFINITY;
    for (int c = 0; c < 2 && panel->curves[c].css; c++)
        for (uint32_t n = 0; n < plot->trace->used; n++) {
            const double value = value_of(plot, n, axis, panel->curves[c].column);
            if (isfinite(value)) {
                low = fmin(low, value);
                high = fmax(high, value);
            }
        }
    if (low > high)
        low = high = 0;
    const double smallest = fmax(panel->smallest_range, 1e-9 * fmax(fabs(low), fabs(high)));
    const double margin = fmax(0.06 * (high - low), (smallest - (high - low)) / 2);
    return (scale_t){low - margin, high + margin, nice_step(high - low + 2 * margin, 5)};
}

/** As many decimals as the step between two ticks needs. */
static void print_tick(FILE *file, double value, double step)
{
    const int decimals = step >= 1 ? 0 : (int)ceil(-log10(step) - 1e-9);
    if (fabs(value) < step / 2)
        value = 0;
    if (decimals <= 6 && fabs(value) < 1e7)
        fprintf(file, "%.*f", decimals, value);
    else
        fprintf(file, "%.4g", value);
}

static double y_of(const box_t *box, const scale_t *scale, double value)
{
    return box->y + box->height - (value - scale->low) / (scale->high - scale->low) * box->height;
}

/* ---- a curve --------------------------------------------------------------------------------------------------- */

/** Draws a polyline and leaves out the inner points of level stretches. Coordinates in tenths of a pixel. */
typedef struct pen {
    FILE *file;
    bool started, pending;
    long last_y, x, y; /**< last_y: of the point drawn last; x, y: of the pending one */
} pen_t;

static void print_tenths(FILE *file, long tenths)
{
    if (tenths % 10)
        fprintf(file, "%.1f", (double)tenths / 10);
    else
        fprintf(file, "%ld", tenths / 10);
}

static void pen_flush(pen_t *pen)
{
    if (!pen->pending)
        return;
    fputs(pen->started ? " " : "M", pen->file);
    print_tenths(pen->file, pen->x);
    fputc(',', pen->file);
    print_tenths(pen->file, pen->y);
    pen->started = true;
    pen->pending = false;
    pen->last_y = pen->y;
}

static void pen_to(pen_t *pen, double x, double y)
{
    const long new_x = lround(x * 10), new_y = lround(y * 10);
    if (pen->pending && !(pen->started && pen->y == pen->last_y && new_y == pen->y))
        pen_flush(pen);
    pen->x = new_x;
    pen->y = new_y;
    pen->pending = true;
}

/** The extremes of one slice of time, by sample number. */
typedef struct extremes {
    uint32_t first, last; /**< the one that came first, the one that came last */
} extremes_t;

static extremes_t extremes_of_slice(const plot_t *plot, uint32_t axis, const curve_t *curve, uint32_t *n)
{
    const uint32_t slice = slice_of(plot, *n);
    uint32_t low = *n, high = *n;
    for (; *n < plot->trace->used && slice_of(plot, *n) == slice; ++*n) {
        const double value = value_of(plot, *n, axis, curve->column);
        if (value < value_of(plot, low, axis, curve->column))
            low = *n;
        if (value > value_of(plot, high, axis, curve->column))
            high = *n;
    }
    return low < high ? (extremes_t){low, high} : (extremes_t){high, low};
}

static void print_curve(const plot_t *plot, const box_t *box, const scale_t *scale, uint32_t axis, const curve_t *curve)
{
    pen_t pen = {.file = plot->file};
    fprintf(plot->file, "<path class=\"%s\" d=\"", curve->css);
    for (uint32_t n = 0; n < plot->trace->used;) {
        const extremes_t e = extremes_of_slice(plot, axis, curve, &n);
        const double first = value_of(plot, e.first, axis, curve->column);
        const double last = value_of(plot, e.last, axis, curve->column);
        if (isfinite(first))
            pen_to(&pen, x_of(plot, box, time_s(plot, e.first)), y_of(box, scale, first));
        if (e.last != e.first && isfinite(last))
            pen_to(&pen, x_of(plot, box, time_s(plot, e.last)), y_of(box, scale, last));
    }
    pen_flush(&pen);
    fputs("\"/>\n", plot->file);
}

/* ---- states ---------------------------------------------------------------------------------------------------- */

static cm1e_axis_state_t state_of_slice(const plot_t *plot, uint32_t axis, uint32_t *n)
{
    const uint32_t slice = slice_of(plot, *n);
    cm1e_axis_state_t state = (cm1e_axis_state_t)value_of(plot, *n, axis, TRACE_STATE);
    for (; *n < plot->trace->used && slice_of(plot, *n) == slice; ++*n) {
        const cm1e_axis_state_t other = (cm1e_axis_state_t)value_of(plot, *n, axis, TRACE_STATE);
        if (cm1e_plot_states[other].rank > cm1e_plot_states[state].rank)
            state = other;
    }
    return state;
}

static void print_state(const plot_t *plot, const box_t *band, double bottom, double from_s, double to_s,
                        cm1e_axis_state_t state)
{
    const double x = x_of(plot, band, from_s), width = x_of(plot, band, to_s) - x;
    fprintf(plot->file, "<g fill=\"%s\"><title>%s, %.3f to %.3f s</title>", cm1e_plot_states[state].colour,
            cm1e_axis_state_name(state), from_s, to_s);
    fprintf(plot->file, "<rect x=\"%.1f\" y=\"%.0f\" width=\"%.1f\" height=\"%.0f\"/>", x, band->y, width,
            band->height);
    fprintf(plot->file, "<rect x=\"%.1f\" y=\"%.0f\" width=\"%.1f\" height=\"%.0f\" opacity=\".13\"/></g>\n", x,
            band->y + band->height, width, bottom - band->y - band->height);
}

/** The band, and the same colours faintly behind the panels down to `bottom`. */
static void print_states(const plot_t *plot, const box_t *band, double bottom, uint32_t axis)
{
    uint32_t n = 0;
    double from_s = plot->begin_s;
    cm1e_axis_state_t shown = state_of_slice(plot, axis, &n);
    while (n < plot->trace->used) {
        const double at_s = time_s(plot, n);
        const cm1e_axis_state_t state = state_of_slice(plot, axis, &n);
        if (state == shown)
            continue;
        print_state(plot, band, bottom, from_s, at_s, shown);
        from_s = at_s;
        shown = state;
    }
    print_state(plot, band, bottom, from_s, plot->end_s, shown);
}

/* ---- panels ---------------------------------------------------------------------------------------------------- */

static void print_value_axis(const plot_t *plot, const box_t *box, const scale_t *scale, const struct panel *panel)
{
    FILE *file = plot->file;
    for (double value = ceil(scale->low / scale->step) * scale->step; value <= scale->high; value += scale->step) {
        const double y = y_of(box, scale, value);
        const bool zero = fabs(value) < scale->step / 2;
        fprintf(file, "<path class=\"%s\" d=\"M%.0f,%.1fh%.0f\"/>", zero ? "zero" : "grid", box->x, y, box->width);
        fprintf(file, "<text class=\"tick\" text-anchor=\"end\" x=\"%.0f\" y=\"%.1f\">", box->x - 6, y + 3.5);
        print_tick(file, value, scale->step);
        fputs("</text>\n", file);
    }
    const double middle = box->y + box->height / 2;
    fprintf(file, "<text class=\"unit\" text-anchor=\"middle\" transform=\"translate(%.0f,%.0f) rotate(-90)\">"
            "%s [%s]</text>\n", box->x - LEFT + 16, middle, panel->title, panel->unit);
}

static void print_time_grid(const plot_t *plot, const box_t *box, bool with_text)
{
    FILE *file = plot->file;
    const double step = nice_step(plot->end_s - plot->begin_s, 8);
    for (double t = ceil(plot->begin_s / step - 1e-9) * step; t <= plot->end_s + step * 1e-6; t += step) {
        const double x = x_of(plot, box, t);
        fprintf(file, "<path class=\"grid\" d=\"M%.1f,%.0fv%.0f\"/>", x, box->y, box->height);
        if (!with_text)
            continue;
        fprintf(file, "<text class=\"tick\" text-anchor=\"middle\" x=\"%.1f\" y=\"%.0f\">", x,
                box->y + box->height + 16);
        print_tick(file, t, step);
        fputs("</text>\n", file);
    }
    if (with_text)
        fprintf(file, "<text class=\"unit\" text-anchor=\"middle\" x=\"%.0f\" y=\"%.0f\">time [s]</text>\n",
                box->x + box->width / 2, box->y + box->height + 34);
}

static void print_panel(const plot_t *plot, const box_t *box, uint32_t axis, unsigned number)
{
    const struct panel *panel = &panels[number];
    const scale_t scale = scale_of_panel(plot, axis, panel);
    print_time_grid(plot, box, number == PANELS - 1);
    print_value_axis(plot, box, &scale, panel);
    for (int c = 0; c < 2 && panel->curves[c].css; c++)
        print_curve(plot, box, &scale, axis, &panel->curves[c]);
    fprintf(plot->file, "<rect class=\"frame\" x=\"%.0f\" y=\"%.0f\" width=\"%.0f\" height=\"%.0f\"/>\n", box->x,
            box->y, box->width, box->height);
}

static double marks_height(const plot_t *plot) { return plot->label_rows > 0 ? plot->label_rows * MARK_ROW + 2 : 0; }

static double axis_height(const plot_t *plot)
{
    double height = NAME + marks_height(plot) + BAND + TIME_AXIS + 20;
    for (unsigned i = 0; i < PANELS; i++)
        height += PANEL_GAP + panels[i].height;
    return height;
}

/* ---- marks ------------------------------------------------------------------------------------------------------ */

/** Estimated width in the font of the class tick, rather too wide than too narrow. Continuation bytes of a character
 *  have no width. */
static double letter_width(char c)
{
    if (((unsigned char)c & 0xC0) == 0x80)
        return 0;
    if (strchr("iljtfrI.,:;'|!()[] ", c))
        return 4.8;
    return strchr("mwMW@%&", c) || (unsigned char)c >= 0x80 ? 11 : 7.4;
}

/** How much of a text fits into `room`: its width, and in `bytes` its length. */
static double fit(const char *text, double room, size_t *bytes)
{
    double width = 0, fits = 0;
    *bytes = 0;
    for (size_t i = 0; text[i] && width <= room; i++) {
        width += letter_width(text[i]);
        if (width <= room && ((unsigned char)text[i + 1] & 0xC0) != 0x80) { /* a character is whole */
            *bytes = i + 1;
            fits = width;
        }
    }
    return fits;
}

static bool is_free(const plot_t *plot, const label_t *label)
{
    for (uint32_t n = 0; n < plot->label_count; n++) {
        const label_t *other = &plot->labels[n];
        if (other->row == label->row && label->from < other->to + MARK_GAP && other->from < label->to + MARK_GAP)
            return false;
    }
    return true;
}

/** Places a text to the right of its mark if there is room up to the next column, else to the left; in the lowest free
 *  row. */
static void place_label(plot_t *plot, const trace_mark_t *mark)
{
    label_t label = {.text = mark->text};
    label.x = x_of(plot, &(box_t){.width = plot->width}, (double)mark->time_ns * 1e-9);
    if (label.x < 0 || label.x > plot->width)
        return;
    const double right = plot->width + RIGHT - 2 * MARK_GAP - label.x, left = label.x - MARK_GAP;
    double width = fit(mark->text, right > left ? right : left, &label.bytes);
    if (mark->text[label.bytes])
        width = ELLIPSIS + fit(mark->text, (right > left ? right : left) - ELLIPSIS, &label.bytes);
    label.from = width <= right ? label.x + MARK_GAP : label.x - MARK_GAP - width;
    label.to = label.from + width;
    while (!is_free(plot, &label))
        label.row++;
    plot->labels[plot->label_count++] = label;
    plot->label_rows = label.row >= plot->label_rows ? label.row + 1 : plot->label_rows;
}

static void place_labels(plot_t *plot)
{
    for (uint32_t n = 0; n < plot->trace->mark_count; n++)
        place_label(plot, cm1e_trace_mark_at(plot->trace, n));
}

/** Draws the marks from the rows of their texts above `band` down to `bottom`; the texts last, so that no line crosses
 *  one. */
static void print_marks(const plot_t *plot, const box_t *band, double bottom)
{
    for (uint32_t n = 0; n < plot->label_count; n++) {
        const double top = band->y - 11 - plot->labels[n].row * MARK_ROW;
        fprintf(plot->file, "<path class=\"mark\" d=\"M%.1f,%.1fv%.1f\"/>", band->x + plot->labels[n].x, top,
                bottom - top);
    }
    for (uint32_t n = 0; n < plot->label_count; n++) {
        const label_t *label = &plot->labels[n];
        const bool to_the_left = label->from < label->x;
        fprintf(plot->file, "<text class=\"tick note\"%s x=\"%.1f\" y=\"%.0f\">",
                to_the_left ? " text-anchor=\"end\"" : "", band->x + (to_the_left ? label->to : label->from),
                band->y - 4 - label->row * MARK_ROW);
        print_escaped(plot->file, label->text, label->bytes);
        fputs(label->text[label->bytes] ? "...</text>\n" : "</text>\n", plot->file);
    }
}

static void print_axis(const plot_t *plot, double y, uint32_t axis)
{
    box_t box = {LEFT, y + NAME + marks_height(plot), plot->width, BAND};
    const double bottom = y + axis_height(plot) - TIME_AXIS - 20;
    fprintf(plot->file, "<text class=\"name\" x=\"%.0f\" y=\"%.0f\">", box.x, y + 16);
    print_escaped(plot->file, plot->trace->names[axis], strlen(plot->trace->names[axis]));
    fputs("</text>\n", plot->file);
    print_states(plot, &box, bottom, axis);
    print_marks(plot, &box, bottom);
    for (unsigned i = 0; i < PANELS; i++) {
        box.y += box.height + PANEL_GAP;
        box.height = panels[i].height;
        print_panel(plot, &box, axis, i);
    }
}

/* ---- the picture ----------------------------------------------------------------------------------------------- */

static const char style[] =
    "<style>\n"
    "text{font-family:'DejaVu Sans',Arial,Helvetica,sans-serif;fill:#22272e}\n"
    ".title{font-size:18px;font-weight:bold}.name{font-size:15px;font-weight:bold}\n"
    ".tick{font-size:10.5px;fill:#4a525c}.unit,.key{font-size:11.5px}\n"
    "path{fill:none;stroke-linejoin:round;stroke-linecap:round}\n"
    ".grid{stroke:#000;stroke-opacity:.09}.zero{stroke:#000;stroke-opacity:.35}\n"
    ".note{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}\n"
    ".frame{fill:none;stroke:#6b7480}\n"
    ".actual{stroke:#f08a24;stroke-width:3}.set{stroke:#12395f;stroke-width:1.3}\n"
    ".torque{stroke:#2b7a4b;stroke-width:1.1}.mark{stroke:#5b2a86;stroke-dasharray:4 3}\n"
    "</style>\n";

static void print_key_line(FILE *file, double x, const char *css, const char *text)
{
    fprintf(file, "<path class=\"%s\" d=\"M%.0f,46h22\"/><text class=\"key\" x=\"%.0f\" y=\"50\">%s</text>\n", css, x,
            x + 28, text);
}

static void print_head(const plot_t *plot)
{
    FILE *file = plot->file;
    fprintf(file, "<text class=\"title\" x=\"16\" y=\"26\">%u %s, %.3f s to %.3f s, %u samples</text>\n",
            plot->trace->axes, plot->trace->axes == 1 ? "axis" : "axes", plot->begin_s,
            time_s(plot, plot->trace->used - 1), plot->trace->used);
    print_key_line(file, 16, "set", "set value");
    print_key_line(file, 116, "actual", "actual value");
    print_key_line(file, 236, "torque", "actual torque");
    double x = 16;
    for (int i = 0; i < CM1E_AXIS_STATE_COUNT; i++) {
        const char *name = cm1e_axis_state_name((cm1e_axis_state_t)i);
        fprintf(file, "<rect x=\"%.0f\" y=\"62\" width=\"12\" height=\"12\" fill=\"%s\"/>", x,
                cm1e_plot_states[i].colour);
        fprintf(file, "<text class=\"tick\" x=\"%.0f\" y=\"72\">%s</text>\n", x + 16, name);
        x += 34 + 6.6 * (double)strlen(name);
    }
}

/** Slices of time per curve: one a pixel, fewer where many axes share the bytes. */
static uint32_t slices_for(uint32_t axes, uint32_t pixels)
{
    const uint32_t curves = axes * 5, affordable = BYTES_FOR_CURVES / (curves * 2 * BYTES_PER_POINT);
    return affordable > pixels ? pixels : affordable < 20 ? 20 : affordable;
}

void cm1e_plot_print_svg(const trace_t *trace, FILE *file)
{
    plot_t plot = {.file = file, .trace = trace, .width = PLOT_WIDTH};
    if (trace->used > 0) {
        plot.begin_s = time_s(&plot, 0);
        plot.end_s = fmax(time_s(&plot, trace->used - 1), plot.begin_s + 1e-6);
        place_labels(&plot);
    }
    const double width = LEFT + plot.width + RIGHT, height = HEAD + trace->axes * axis_height(&plot);
    fprintf(file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\">\n"
            "%s<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n", width, height, width, height, style);
    if (trace->used == 0 || trace->axes == 0) {
        fputs("<text class=\"title\" x=\"16\" y=\"26\">The trace is empty.</text>\n</svg>\n", file);
        return;
    }
    plot.slices = slices_for(trace->axes, (uint32_t)plot.width);
    print_head(&plot);
    for (uint32_t axis = 0; axis < trace->axes; axis++)
        print_axis(&plot, HEAD + axis * axis_height(&plot), axis);
    fputs("</svg>\n", file);
}

cm1e_error_t cm1e_plot_write_svg(const trace_t *trace, const char *path, cm1e_diag_t *diag)
{
    return cm1e_trace_write_file(trace, path, cm1e_plot_print_svg, diag);
}

cm1e_error_t cm1e_scheduler_write_svg(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_write_svg()", "", diag);
    return cm1e_plot_write_svg(cm1e_scheduler_trace(scheduler), path, diag);
}
