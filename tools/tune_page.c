#include "tune_page.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plot/plot_files.h"

/** The lag has a unit, and so a chart, of its own. */
#define LAG_UNIT "0.001 u"
#define LAG_SCALE 1000

enum { COLUMNS_OF_RUN = 3, LAG = 2, COLUMNS_MAX = 2 * COLUMNS_OF_RUN };

void tune_label(char label[TUNE_LABEL_BYTES], const char *what, const params_t *params)
{
    size_t used = (size_t)snprintf(label, TUNE_LABEL_BYTES, "%s", what);
    for (size_t i = 0; i < params->count && used < TUNE_LABEL_BYTES; i++)
        used += (size_t)snprintf(label + used, TUNE_LABEL_BYTES - used, " %s=%" PRId64, params->at[i].entry->name,
                                 params->at[i].value);
}

static void name_columns(trace_column_t *columns, const char *run)
{
    static const char *const names[COLUMNS_OF_RUN] = {"set position", "actual position", "lag"};
    for (int i = 0; i < COLUMNS_OF_RUN; i++) {
        columns[i] = (trace_column_t){.kind = TRACE_KIND_NUMBER, .type = CM1E_TRACE_LREAL};
        snprintf(columns[i].unit, sizeof columns[i].unit, "%s", i == LAG ? LAG_UNIT : "u");
        snprintf(columns[i].name, sizeof columns[i].name, "%.47s: %s", run, names[i]);
    }
}

static void fill(double *values, uint32_t n, const tune_record_t *record)
{
    const bool there = n < record->count; /* one run may be some cycles longer */
    values[0] = there ? record->set[n] : NAN;
    values[1] = there ? record->actual[n] : NAN;
    values[LAG] = (values[0] - values[1]) * LAG_SCALE;
}

bool tune_write_page(const char *path, const tune_record_t *one, const char *one_name, const tune_record_t *other,
                     const char *other_name)
{
    trace_column_t columns[COLUMNS_MAX];
    cm1e_diag_t diag = {0};
    const uint32_t count = other && other->count > one->count ? other->count : one->count;
    trace_t trace = {.capacity = count, .used = count, .columns = columns,
                     .column_count = other ? COLUMNS_MAX : COLUMNS_OF_RUN};
    trace.variables = trace.column_count;
    trace.times_ns = calloc(count ? count : 1, sizeof *trace.times_ns);
    trace.values = calloc((size_t)(count ? count : 1) * COLUMNS_MAX, sizeof *trace.values);
    name_columns(columns, one_name);
    if (other)
        name_columns(columns + COLUMNS_OF_RUN, other_name);
    for (uint32_t n = 0; n < count && trace.times_ns && trace.values; n++) {
        trace.times_ns[n] = (int64_t)(n * one->cycle_s * 1e9 + 0.5);
        fill(trace.values + (size_t)n * trace.column_count, n, one);
        if (other)
            fill(trace.values + (size_t)n * trace.column_count + COLUMNS_OF_RUN, n, other);
    }
    cm1e_error_t error = trace.times_ns && trace.values ? CM1E_OK : CM1E_ERROR_NO_MEMORY;
    if (error == CM1E_OK)
        error = cm1e_trace_write_file(&trace, path, cm1e_plot_print_html, &diag);
    free(trace.times_ns);
    free(trace.values);
    return error == CM1E_OK || (fail(&diag), false);
}
