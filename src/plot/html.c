/* The trace as one page that needs no other file: its data, the chart library and page.js, which uses both. A live page
 * has no data: it asks for samples where it comes from. */
#include <math.h>
#include <string.h>

#include "cm1e/plot.h"
#include "core/in_task.h"
#include "core/text.h"
#include "plot/plot_files.h"

/* page_parts.S */
extern const char cm1e_plot_page_html[], cm1e_plot_page_css[], cm1e_plot_page_js[];
extern const char cm1e_plot_dygraphs_js[], cm1e_plot_dygraphs_css[];

/* ---- texts and bytes ------------------------------------------------------------------------------------------- */

/** A text as a JSON string that also may stand in a script of HTML. Bytes that are not UTF-8 become "?". */
static void print_text(FILE *file, const char *text)
{
    char clean[512];
    snprintf(clean, sizeof clean, "%s", text);
    cm1e_text_clean(clean);
    fputc('"', file);
    for (const char *c = clean; *c; c++)
        if (*c == '"' || *c == '\\' || *c == '<' || *c == '>' || *c == '&')
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*c);
        else
            fputc(*c, file);
    fputc('"', file);
}

/** Base64 (RFC 4648), byte by byte. */
typedef struct base64 {
    FILE *file;
    uint32_t bits;
    int bytes; /**< in `bits` */
} base64_t;

static void put_quartet(base64_t *base64)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    base64->bits <<= 8 * (3 - base64->bytes);
    for (int i = 0; i < 4; i++)
        fputc(i <= base64->bytes ? digits[base64->bits >> (18 - 6 * i) & 0x3F] : '=', base64->file);
    base64->bits = 0;
    base64->bytes = 0;
}

static void put_bytes(base64_t *base64, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++) { /* little-endian, as typed arrays are in every browser */
        base64->bits = base64->bits << 8 | (value >> (8 * i) & 0xFF);
        if (++base64->bytes == 3)
            put_quartet(base64);
    }
}

static void put_double(base64_t *base64, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bytes(base64, bits, sizeof bits);
}

static void put_float(base64_t *base64, double value)
{
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    put_bytes(base64, bits, sizeof bits);
}

static void end_base64(base64_t *base64)
{
    if (base64->bytes > 0)
        put_quartet(base64);
}

/* ---- data ------------------------------------------------------------------------------------------------------ */

static double value_of(const trace_t *trace, uint32_t n, uint32_t column)
{
    return cm1e_trace_sample(trace, n)[column];
}

static bool is_real(const trace_column_t *column)
{
    return column->type == CM1E_TRACE_LREAL || column->type == CM1E_TRACE_REAL;
}

/** What a value of an axis may be off: the page shows five decimals. */
static const double tolerance = 1e-6;

/** Four bytes are enough for a difference that they keep exactly, and for a value of an axis that they keep closely
 *  enough. Variables of the program are kept exactly. */
static bool needs_eight_bytes(const trace_t *trace, uint32_t column, double base)
{
    const bool of_axis = trace->columns[column].kind == TRACE_KIND_NUMBER && is_real(&trace->columns[column]) &&
                         !cm1e_trace_is_variable(trace, column);
    const double allowed = of_axis ? tolerance : 0.0;
    for (uint32_t n = 0; n < trace->used; n++) {
        const double difference = value_of(trace, n, column) - base;
        if (!(fabs((double)(float)difference - difference) <= allowed)) /* also of what is no number */
            return true;
    }
    return false;
}

static void print_values(const trace_t *trace, uint32_t column, FILE *file)
{
    const double first = trace->used ? value_of(trace, 0, column) : 0;
    const bool single = trace->columns[column].type == CM1E_TRACE_REAL; /* which has four bytes itself */
    const double base = isfinite(first) && !single ? first : 0;
    const bool wide = needs_eight_bytes(trace, column, base);
    base64_t base64 = {.file = file};
    fprintf(file, ", \"bytes\": %d, \"base\": %.17g, \"data\": \"", wide ? 8 : 4, base);
    for (uint32_t n = 0; n < trace->used; n++) {
        const double value = value_of(trace, n, column);
        if (wide)
            put_double(&base64, value);
        else
            put_float(&base64, value - base);
    }
    end_base64(&base64);
    fputs("\"}", file);
}

static void print_columns(const trace_t *trace, bool with_values, FILE *file)
{
    static const char *const kinds[] = {
        [TRACE_KIND_NUMBER] = "number", [TRACE_KIND_FLAG] = "flag",   [TRACE_KIND_STATE] = "state",
        [TRACE_KIND_ERROR] = "error",   [TRACE_KIND_COUNT] = "count",
    };
    fputs("\"columns\": [", file);
    for (uint32_t i = 0; i < trace->column_count; i++) {
        const trace_column_t *column = &trace->columns[i];
        fputs(i ? ",\n{\"name\": " : "\n{\"name\": ", file);
        print_text(file, column->name);
        fputs(", \"unit\": ", file);
        print_text(file, column->unit);
        fprintf(file, ", \"kind\": \"%s\", \"integer\": %s, \"program\": %s, \"single\": %s", kinds[column->kind],
                is_real(column) ? "false" : "true", cm1e_trace_is_variable(trace, i) ? "true" : "false",
                column->type == CM1E_TRACE_REAL ? "true" : "false");
        if (with_values)
            print_values(trace, i, file);
        else
            fputc('}', file);
    }
    fputs("],\n", file);
}

static void print_axes(const trace_t *trace, FILE *file)
{
    fputs("\"axes\": [", file);
    for (uint32_t i = 0; i < trace->axes; i++) {
        fputs(i ? ", {\"name\": " : "{\"name\": ", file);
        print_text(file, trace->names[i]);
        fprintf(file, ", \"first\": %u, \"count\": %d}", i * TRACE_AXIS_COLUMNS, TRACE_AXIS_COLUMNS);
    }
    fputs("],\n\"states\": [", file);
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++) {
        fputs(state ? ", {\"name\": " : "{\"name\": ", file);
        print_text(file, cm1e_axis_state_name((cm1e_axis_state_t)state));
        fprintf(file, ", \"colour\": \"%s\"}", cm1e_plot_states[state].colour);
    }
    fputs("],\n", file);
}

/** The texts of the errors that occurred. */
static void print_errors(const trace_t *trace, FILE *file)
{
    bool some = false;
    fputs("\"errors\": {", file);
    for (uint32_t i = 0; i < trace->column_count; i++) {
        if (trace->columns[i].kind != TRACE_KIND_ERROR)
            continue;
        double before = 0;
        for (uint32_t n = 0; n < trace->used; n++) {
            const double error = value_of(trace, n, i);
            if (error != 0 && error != before) {
                fprintf(file, "%s\"%.0f\": ", some ? ", " : "", error);
                print_text(file, cm1e_strerror((cm1e_error_t)error));
                some = true;
            }
            before = error;
        }
    }
    fputs("},\n", file);
}

/** Those from `from_ns` to the last sample. */
static void print_marks(const trace_t *trace, int64_t from_ns, FILE *file)
{
    bool some = false;
    fputs("\"marks\": [", file);
    for (uint32_t i = 0; i < trace->mark_count && trace->used; i++) {
        const trace_mark_t *mark = cm1e_trace_mark_at(trace, i);
        if (mark->time_ns < from_ns || mark->time_ns > cm1e_trace_time_ns(trace, trace->used - 1))
            continue;
        fprintf(file, "%s{\"t\": %.9f, \"text\": ", some ? ", " : "", (double)mark->time_ns * 1e-9);
        print_text(file, mark->text);
        fputc('}', file);
        some = true;
    }
    fputs("], ", file);
}

static void print_times(const trace_t *trace, FILE *file)
{
    base64_t base64 = {.file = file};
    fputs("\"times\": \"", file);
    for (uint32_t n = 0; n < trace->used; n++)
        put_double(&base64, (double)cm1e_trace_time_ns(trace, n) * 1e-9);
    end_base64(&base64);
    fputs("\"", file);
}

/* ---- the page -------------------------------------------------------------------------------------------------- */

static void print_head(FILE *file)
{
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>cm1e trace</title>\n<style>\n",
          file);
    fprintf(file, "%s\n%s</style>\n</head>\n<body>\n%s", cm1e_plot_dygraphs_css, cm1e_plot_page_css,
            cm1e_plot_page_html);
    fprintf(file, "<script>\n%s\n</script>\n<script>\nconst trace = {\n", cm1e_plot_dygraphs_js);
}

static void print_tail(FILE *file)
{
    fprintf(file, "};\n</script>\n<script>\n%s</script>\n</body>\n</html>\n", cm1e_plot_page_js);
}

void cm1e_plot_print_html(const trace_t *trace, FILE *file)
{
    print_head(file);
    print_axes(trace, file);
    print_errors(trace, file);
    print_marks(trace, trace->used ? cm1e_trace_time_ns(trace, 0) : 0, file);
    print_columns(trace, true, file);
    print_times(trace, file);
    print_tail(file);
}

static cm1e_error_t check_library(const char *instead, cm1e_diag_t *diag)
{
    if (cm1e_plot_dygraphs_js[0])
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0,
                         "This build of cm1e draws no pages: it was configured without the chart library dygraphs "
                         "(Debian package libjs-dygraphs). Install it and build again, or %s.", instead);
}

cm1e_error_t cm1e_plot_write_html(const trace_t *trace, const char *path, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check_library("write an SVG image", diag);
    return error == CM1E_OK ? cm1e_trace_write_file(trace, path, cm1e_plot_print_html, diag) : error;
}

cm1e_error_t cm1e_scheduler_write_html(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_write_html()", "", diag);
    return cm1e_plot_write_html(cm1e_scheduler_trace(scheduler), path, diag);
}

/* ---- live ------------------------------------------------------------------------------------------------------ */

/** The texts of all errors, because any of them may come. */
static void print_all_errors(FILE *file)
{
#define ROW(name, value, text) CM1E_##name,
    static const cm1e_error_t errors[] = {CM1E_ERRORS(ROW)};
#undef ROW
    bool some = false;
    fputs("\"errors\": {", file);
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        if (errors[i] == CM1E_OK)
            continue;
        fprintf(file, "%s\"%d\": ", some ? ", " : "", (int)errors[i]);
        print_text(file, cm1e_strerror(errors[i]));
        some = true;
    }
    fputs("},\n", file);
}

cm1e_error_t cm1e_plot_print_live_page(const trace_t *trace, const char *source, FILE *file, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check_library("record into a file", diag);
    if (error != CM1E_OK)
        return error;
    print_head(file);
    print_axes(trace, file);
    print_all_errors(file);
    print_columns(trace, false, file);
    fputs("\"marks\": [], \"live\": ", file);
    print_text(file, source);
    print_tail(file);
    return CM1E_OK;
}

void cm1e_plot_print_live_samples(const trace_t *trace, uint32_t count, uint64_t number, int64_t marks_after_ns,
                                  FILE *file)
{
    base64_t base64 = {.file = file};
    fprintf(file, "{\"number\": %llu, ", (unsigned long long)number);
    print_marks(trace, marks_after_ns + 1, file);
    fputs("\"samples\": \"", file);
    for (uint32_t n = trace->used - count; n < trace->used; n++) {
        put_double(&base64, (double)cm1e_trace_time_ns(trace, n) * 1e-9);
        for (uint32_t i = 0; i < trace->column_count; i++)
            put_double(&base64, value_of(trace, n, i));
    }
    end_base64(&base64);
    fputs("\"}", file);
}
