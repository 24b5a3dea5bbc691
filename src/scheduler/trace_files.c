/* A trace as a file: CSV for tables, NumPy for programs. Its pictures are drawn in src/plot. */
#include <stdlib.h>
#include <string.h>

#include "core/c_locale.h"
#include "core/output.h"
#include "core/text.h"
#include "scheduler/trace_recorder.h"

/* ---- CSV ------------------------------------------------------------------------------------------------------- */

/** A field of a CSV file (RFC 4180): quoted, quotes doubled. */
static void print_quoted(FILE *file, const trace_column_t *column)
{
    fputs(",\"", file);
    for (const char *c = column->name; *c; c++) {
        if (*c == '"')
            fputc('"', file);
        fputc(*c, file);
    }
    if (column->unit[0])
        fprintf(file, " [%s]", column->unit);
    fputc('"', file);
}

/** A variable of the program, in digits that give this value back. */
static void print_exact(FILE *file, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.15g", value);
    if (strtod(text, NULL) == value)
        fprintf(file, ",%s", text);
    else
        fprintf(file, ",%.17g", value);
}

static void print_value(FILE *file, const trace_column_t *column, double value, bool is_variable)
{
    if (is_variable && column->type == CM1E_TRACE_LREAL)
        print_exact(file, value);
    else if (column->kind == TRACE_KIND_STATE)
        fprintf(file, ",%s", cm1e_axis_state_name((cm1e_axis_state_t)value));
    else
        fprintf(file, column->type == CM1E_TRACE_LREAL ? ",%.15g" : ",%.17g", value);
}

void cm1e_trace_print_csv(const trace_t *trace, FILE *file)
{
    fputs("\"time [s]\"", file);
    for (uint32_t i = 0; i < trace->column_count; i++)
        print_quoted(file, &trace->columns[i]);
    fputc('\n', file);
    for (uint32_t n = 0; n < trace->used; n++) {
        const double *sample = cm1e_trace_sample(trace, n);
        fprintf(file, "%.6f", (double)cm1e_trace_time_ns(trace, n) * 1e-9);
        for (uint32_t i = 0; i < trace->column_count; i++)
            print_value(file, &trace->columns[i], sample[i], cm1e_trace_is_variable(trace, i));
        fputc('\n', file);
    }
}

/* ---- NumPy ----------------------------------------------------------------------------------------------------- */

/** The name of a column as a text of a Python literal, in UTF-8 whatever it is. */
static void print_python_name(FILE *file, const trace_column_t *column)
{
    char name[sizeof column->name];
    snprintf(name, sizeof name, "%s", column->name);
    cm1e_text_clean(name);
    fputc('\'', file);
    for (const char *c = name; *c; c++)
        fprintf(file, *c == '\'' || *c == '\\' ? "\\%c" : "%c", *c);
    fputc('\'', file);
}

static void print_npy_dtype(const trace_t *trace, FILE *file)
{
    fputs("{'descr': [('time', '<f8')", file);
    for (uint32_t i = 0; i < trace->column_count; i++) {
        fputs(", (", file);
        print_python_name(file, &trace->columns[i]);
        fputs(", '<f8')", file);
    }
    fprintf(file, "], 'fortran_order': False, 'shape': (%u,), }", trace->used);
}

static void print_double(FILE *file, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int shift = 0; shift < 64; shift += 8)
        fputc((int)(bits >> shift & 0xFF), file);
}

/** Version 3.0 of the format: the header is UTF-8, and magic, length and header together fill multiples of 64 bytes. */
static void print_npy_header(const trace_t *trace, FILE *file)
{
    enum { FIXED = 12, ALIGNMENT = 64 };
    char *header = NULL;
    size_t length = 0;
    FILE *text = open_memstream(&header, &length);
    if (text) {
        print_npy_dtype(trace, text);
        fclose(text);
    }
    const size_t padded = (FIXED + length + 1 + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT - FIXED;
    fputs("\x93NUMPY\x03", file);
    fputc(0, file);
    for (int shift = 0; shift < 32; shift += 8)
        fputc((int)(padded >> shift & 0xFF), file);
    fprintf(file, "%s%*s\n", header ? header : "", (int)(padded - length - 1), "");
    free(header);
}

static void print_npy(const trace_t *trace, FILE *file)
{
    print_npy_header(trace, file);
    for (uint32_t n = 0; n < trace->used; n++) {
        const double *sample = cm1e_trace_sample(trace, n);
        print_double(file, (double)cm1e_trace_time_ns(trace, n) * 1e-9);
        for (uint32_t i = 0; i < trace->column_count; i++)
            print_double(file, sample[i]);
    }
}

/* ---- the file -------------------------------------------------------------------------------------------------- */

static void print_in_c_locale(const trace_t *trace, FILE *file, void (*print)(const trace_t *trace, FILE *file))
{
    c_locale_t locale = {0};
    const bool point = cm1e_c_locale_begin(&locale);
    print(trace, file);
    if (point)
        cm1e_c_locale_end(&locale);
}

cm1e_error_t cm1e_trace_write_file(const trace_t *trace, const char *path,
                                   void (*print)(const trace_t *trace, FILE *file), cm1e_diag_t *diag)
{
    cm1e_output_t output;
    if (!trace)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A scheduler is missing.");
    if (trace->capacity == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Nothing was recorded: the scheduler's trace_capacity is 0.");
    const cm1e_error_t error = cm1e_output_open(&output, path, diag);
    if (error != CM1E_OK)
        return error;
    print_in_c_locale(trace, output.file, print);
    return cm1e_output_close(&output, diag);
}

cm1e_error_t cm1e_trace_write_csv(const trace_t *trace, const char *path, cm1e_diag_t *diag)
{
    return cm1e_trace_write_file(trace, path, cm1e_trace_print_csv, diag);
}

cm1e_error_t cm1e_trace_write_npy(const trace_t *trace, const char *path, cm1e_diag_t *diag)
{
    return cm1e_trace_write_file(trace, path, print_npy, diag);
}
