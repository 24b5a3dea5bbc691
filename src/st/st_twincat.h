/**
 * @file st_twincat.h
 * Sources that are files of a TwinCAT PLC project.
 */
#ifndef CM1E_ST_TWINCAT_H
#define CM1E_ST_TWINCAT_H

#include "st/st_state.h"

bool cm1e_st_is_twincat(const char *text, size_t size);
/** The source as Structured Text. `list` and `qualified` of the source are those of a list of global variables. */
void cm1e_st_twincat(st_t *st, source_t *source);

#endif
