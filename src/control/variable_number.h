/**
 * @file variable_number.h
 * Numbers of a program in JSON: whole ones to the last digit, and those of an enumeration by the names of its
 * enumerators.
 */
#ifndef CM1E_CONTROL_VARIABLE_NUMBER_H
#define CM1E_CONTROL_VARIABLE_NUMBER_H

#include <jansson.h>

#include "scheduler/variables.h"

/** "INT", "STRING" ...: what its bytes are. */
const char *cm1e_variable_type(const variable_t *variable);
json_t *cm1e_variable_number_show(const variable_t *variable, const variable_value_t *value);
/** The enumerator of this value; null: none has it. */
json_t *cm1e_variable_enumerator_show(const variable_t *variable, const variable_value_t *value);
/** The bytes of a number in its type; false: it is no value of the variable. */
bool cm1e_variable_number_take(const variable_t *variable, const json_t *value, variable_value_t *out);
/** "Main.n (INT) takes -32768 ... 32767." */
void cm1e_variable_expected(const variable_t *variable, char *text, size_t size);

#endif
