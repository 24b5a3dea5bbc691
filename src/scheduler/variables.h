/**
 * @file variables.h
 * All variables of a program by their whole paths (`Main.table[3].speed`): others see, write and force them, and choose
 * those that a trace records. The runner of the program owns the table; it is complete before the run.
 */
#ifndef CM1E_SCHEDULER_VARIABLES_H
#define CM1E_SCHEDULER_VARIABLES_H

#include "scheduler/trace_recorder.h"

/** Of a text the bytes with its final 0, at most VARIABLE_BYTES; the characters of a WSTRING have 16 bits. */
typedef enum variable_form { VARIABLE_NUMBER = 0, VARIABLE_STRING, VARIABLE_WSTRING } variable_form_t;

enum { VARIABLE_BYTES = 512 };

typedef struct variable {
    const char *name, *unit;
    const char *declared;     /**< its type as the program names it */
    variable_form_t form;
    cm1e_trace_type_t type;   /**< of a number */
    void *data;
    uint32_t bytes;
    uint8_t bit;              /**< of a BOOL that is one bit of a byte: 1 = bit 0; else 0 */
    bool ranged;              /**< `first` ... `last` are its values */
    int64_t first, last;
    const char *const *names; /**< of an enumeration: its enumerators, with their values */
    const int64_t *values;
    uint32_t name_count;
} variable_t;

typedef struct variables {
    const variable_t *rows;
    uint32_t count;
} variables_t;

/** A value as it lies in memory. Of a BOOL that is one bit, the byte is 0 or 1. */
typedef struct variable_value {
    uint8_t bytes[VARIABLE_BYTES];
} variable_value_t;

/** Gives a scheduler the table, which must live as long as it. @rt init */
CM1E_GUEST_API void cm1e_scheduler_set_variables(cm1e_scheduler_t *scheduler, const variable_t *rows, uint32_t count);
CM1E_GUEST_API const variables_t *cm1e_scheduler_variables(const cm1e_scheduler_t *scheduler);
/** The variable of this name, without regard to case; `count` of the table: none has it. @rt any */
CM1E_GUEST_API uint32_t cm1e_variables_find(const variables_t *variables, const char *name);
/** Whether `name` is `path`, or a member or element of it. @rt any */
CM1E_GUEST_API bool cm1e_variable_is_within(const char *name, const char *path);
/** @rt cycle */
CM1E_GUEST_API double cm1e_variable_number(const variable_t *variable);
/** The shortest decimal number of a REAL: 0.1 for 0.100000001490116. @rt any */
CM1E_GUEST_API double cm1e_variable_decimal(float value);
/** Such bytes as a number, of a text 0. Of 64 bits a double holds 53: `*rest` is what is missing. @rt cycle */
CM1E_GUEST_API double cm1e_variable_number_of(const variable_t *variable, const variable_value_t *value, double *rest);
/** The name of the enumerator with this value; NULL: it has none. @rt any */
CM1E_GUEST_API const char *cm1e_variable_enumerator(const variable_t *variable, int64_t value);
/** Copies the value, of a text up to its end. @rt cycle */
CM1E_GUEST_API void cm1e_variable_read(const variable_t *variable, variable_value_t *value);
/** @rt cycle */
void cm1e_variable_write(const variable_t *variable, const variable_value_t *value);
/** Adds it to a trace, where it is a number. CM1E_ERROR_INVALID_ARGUMENT: it is a text, or its name is too long; else
 *  as cm1e_trace_add(). @rt init */
CM1E_GUEST_API cm1e_error_t cm1e_variable_trace(const variable_t *variable, trace_t *trace, cm1e_diag_t *diag);

/** Adds it to the trace of a scheduler, in the same way. @rt init */
CM1E_GUEST_API cm1e_error_t cm1e_scheduler_trace_number(cm1e_scheduler_t *scheduler, const variable_t *variable,
                                                        cm1e_diag_t *diag);

#endif
