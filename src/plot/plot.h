/**
 * @file plot.h
 * What the files of a plot contain, apart from the file itself.
 */
#ifndef CM1E_PLOT_PLOT_H
#define CM1E_PLOT_PLOT_H

#include <stdio.h>

#include "scheduler/trace.h"

/** Prints the trace as an SVG image. */
void cm1e_plot_print_svg(const trace_t *trace, FILE *file);

#endif
