/**
 * @file plot.h
 * The trace of a scheduler as pictures for people, library cm1e::plot. Call these functions after the run.
 */
#ifndef CM1E_PLOT_H
#define CM1E_PLOT_H

#include "cm1e/api.h"
#include "cm1e/error.h"
#include "cm1e/scheduler.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Writes the trace as an SVG image: panels of position, velocity and torque for each axis, the state of the axis as a
 *  band above them, and the marks of cm1e_scheduler_mark(). Conditions as for cm1e_scheduler_write_csv(). @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_write_svg(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag);

/** Writes the trace as one page of HTML that any browser opens, without a network: charts of all signals on one time
 *  scale, states as coloured bands, marks, errors, lost frames and overruns; one can zoom, read values, and measure
 *  between two cursors. Conditions as for cm1e_scheduler_write_csv(); CM1E_ERROR_UNSUPPORTED: the library was built
 *  without the chart library dygraphs. @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_write_html(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
