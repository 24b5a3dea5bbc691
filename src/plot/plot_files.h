/**
 * @file plot_files.h
 * What the files of a plot contain, apart from the file itself.
 */
#ifndef CM1E_PLOT_PLOT_FILES_H
#define CM1E_PLOT_PLOT_FILES_H

#include <stdio.h>

#include "scheduler/trace_recorder.h"

/** How a state is shown. In a picture that has not a pixel for every sample, the state with the highest rank is. */
typedef struct plot_state {
    const char *colour;
    int rank;
} plot_state_t;
extern const plot_state_t cm1e_plot_states[CM1E_AXIS_STATE_COUNT];

/** Prints the trace as a page of HTML that needs no other file. */
void cm1e_plot_print_html(const trace_t *trace, FILE *file);

/** The files of these. CM1E_ERROR_UNSUPPORTED: there is no chart library for pages. @rt block */
cm1e_error_t cm1e_plot_write_html(const trace_t *trace, const char *path, cm1e_diag_t *diag);
cm1e_error_t cm1e_plot_write_svg(const trace_t *trace, const char *path, cm1e_diag_t *diag);

/** Prints a page of a trace whose samples are still to come. The page asks the address `source`, relative to its own,
 *  for server-sent events: a message has what cm1e_plot_print_live_samples() prints, an event "end" a text that says
 *  why there are no more. CM1E_ERROR_UNSUPPORTED as above. @rt block */
cm1e_error_t cm1e_plot_print_live_page(const trace_t *trace, const char *source, FILE *file, cm1e_diag_t *diag);

/** Prints the last `count` samples for a live page, in one line. `number` is that of the first of them since the
 *  recording began, from which the page knows samples that it did not get. With them go the marks that are later than
 *  `marks_after_ns`. @rt block */
void cm1e_plot_print_live_samples(const trace_t *trace, uint32_t count, uint64_t number, int64_t marks_after_ns,
                                  FILE *file);

/** Prints the trace as an SVG image. */
void cm1e_plot_print_svg(const trace_t *trace, FILE *file);

#endif
