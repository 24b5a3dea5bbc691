/**
 * @file variable_request.h
 * The requests about variables of the program: `variables` lists them with their values, `variable` writes one or
 * forces it (scheduler/forcing.h).
 */
#ifndef CM1E_CONTROL_VARIABLE_REQUEST_H
#define CM1E_CONTROL_VARIABLE_REQUEST_H

#include <jansson.h>

#include "control/view.h"
#include "scheduler/forcing.h"

enum { VARIABLES_OF_REPLY = 256 };

/** What the cycle does for either request. */
typedef struct variable_order {
    view_order_t order;
    forced_t forced;            /**< client and variable; what is forced or written */
    bool force, release;
    bool check;                 /**< nothing is written: only whether it would be */
    int64_t keep_ns;
    forcing_result_t result;    /**< valid when decided */
    struct variable_values *values; /**< of the list; NULL: there is none. Owned */
} variable_order_t;

/** Begins a list: of at most `most` variables (VARIABLES_OF_REPLY) from number `from` on, or of those that are forced.
 *  false: no memory. */
bool cm1e_variables_begin(variable_order_t *order, const view_t *view, uint32_t from, uint32_t most, bool forced);
/** Finds the row of a variable by its name; false: there is none, which `text` says. */
bool cm1e_variable_named(const view_t *view, const char *name, uint32_t *row, char *text, size_t size);
/** That the program has no such variable, and which one may have been meant. */
void cm1e_variable_unknown(const variables_t *variables, const char *name, char *text, size_t size);
/** The list, when the cycle has read it. */
json_t *cm1e_variables_show(const variable_order_t *order, const view_t *view);
/** Number of the first variable behind the list; 0: there is none. */
uint32_t cm1e_variables_next(const variable_order_t *order, const view_t *view);
/** Takes the members of a message; NULL: the order is complete. Else `text`, which says what is wrong, with `error`. */
const char *cm1e_variable_take(variable_order_t *order, const view_t *view, const json_t *message, cm1e_error_t *error,
                               char *text, size_t size);
/** Why it was refused by the cycle; NULL: it was not. */
const char *cm1e_variable_refusal(const variable_order_t *order);
void cm1e_variables_free(variable_order_t *order);

#endif
