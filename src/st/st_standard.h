/**
 * @file st_standard.h
 * The standard functions, as checker and emitter see them.
 */
#ifndef CM1E_ST_STANDARD_H
#define CM1E_ST_STANDARD_H

#include "st/st_state.h"

typedef struct standard standard_t;

const char *cm1e_st_standard_name(const standard_t *standard);
/** INT_TO_REAL and the like, TO_REAL: true: the name is one of these. The call becomes E_CONVERT. */
bool cm1e_st_conversion_call(st_t *st, expr_t *call, const char *name);
/** The type in which an operation on two operands is done; T_NONE: there is none. */
type_kind_t cm1e_st_type_for_both(const expr_t *a, const expr_t *b);

#endif
