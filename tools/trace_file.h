/**
 * @file trace_file.h
 * Files of commands that record what axes do: --csv and the like.
 */
#ifndef CM1E_TOOLS_TRACE_FILE_H
#define CM1E_TOOLS_TRACE_FILE_H

#include <argp.h>
#include <stdint.h>

#include "cm1e/scheduler.h"

/** The files in their order; a command may take the first ones only. */
enum { TRACE_CSV, TRACE_SVG, TRACE_HTML, TRACE_NPY, TRACE_FILES };

/** Each file (NULL: there is none) has a name that no other one has; else the command ends with a complaint. Returns how
 *  many there are. */
int need_trace_files(struct argp_state *state, const char *const *files, int count);

/** A trace can be written to each of these files. Returns the exit status, with a complaint. "-" is refused, because these
 *  commands print their result on standard output. */
int check_trace_files(const char *const *files, int count);

/** Says that the files do not have the whole run, where it was longer than what the scheduler keeps. */
void tell_missing_cycles(const cm1e_scheduler_t *scheduler, uint32_t kept);

#endif
