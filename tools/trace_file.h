/**
 * @file trace_file.h
 * Files of commands that record what axes do: --csv and the like.
 */
#ifndef CM1E_TOOLS_TRACE_FILE_H
#define CM1E_TOOLS_TRACE_FILE_H

/** A trace can be written to the file of this option; NULL: there is none. Returns the exit status, with a complaint. "-" is
 *  refused, because these commands print their result on standard output. */
int check_trace_file(const char *option, const char *path);

#endif
