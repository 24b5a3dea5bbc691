/**
 * @file st_located.h
 * The located variables of a program in Structured Text: %IX3.0.5 is bit 5 of byte 0 of the inputs of slave 3.
 */
#ifndef CM1E_TOOLS_ST_LOCATED_H
#define CM1E_TOOLS_ST_LOCATED_H

#include "cm1e/io.h"
#include "st/st_program.h"

typedef struct st_located {
    const st_variable_t *variables;
    cm1e_io_t *signals; /**< owned; one for each */
    uint32_t count;
} st_located_t;

/** Finds the places of all variables. CM1E_ERROR_NOT_FOUND: a slave has no such bits. @rt init */
cm1e_error_t st_located_find(st_located_t *located, const st_list_t *variables, cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Before a task: the inputs; those of a slave that is away keep their values. @rt cycle */
void st_located_read(const st_located_t *located);
/** Behind a task: the outputs. @rt cycle */
void st_located_write(const st_located_t *located);
void st_located_free(st_located_t *located);

#endif
