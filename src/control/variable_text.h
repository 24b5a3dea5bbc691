/**
 * @file variable_text.h
 * Texts of a program in JSON: a STRING has bytes, a WSTRING characters of 16 bits (UTF-16 in the order of this
 * machine).
 */
#ifndef CM1E_CONTROL_VARIABLE_TEXT_H
#define CM1E_CONTROL_VARIABLE_TEXT_H

#include <jansson.h>

#include "scheduler/variables.h"

json_t *cm1e_variable_text_show(const variable_t *variable, const uint8_t *bytes);
/** The bytes of a text, all behind its end 0; false: it is too long, or has a character 0. */
bool cm1e_variable_text_take(const variable_t *variable, const json_t *text, uint8_t bytes[VARIABLE_BYTES]);

#endif
