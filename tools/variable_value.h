/**
 * @file variable_value.h
 * Values of variables as a user sees them, and writes them: `cm1e var set NAME=VALUE`.
 */
#ifndef CM1E_TOOLS_VARIABLE_VALUE_H
#define CM1E_TOOLS_VARIABLE_VALUE_H

#include <jansson.h>

enum { VARIABLE_TEXT_BYTES = 2100 }; /**< for any value: a character of a text takes up to 3 */

/** The value of a row of `variables` (docs/CONTROL.md) in one line: 3.5, TRUE, 20 ns, 'text'. */
void variable_text(const json_t *row, char *text, size_t size);

/** A truth value as in a program, a finite number, or a text in quotes ('text' or "text"); NULL and a complaint: it is none of these. */
json_t *variable_value(const char *text);

#endif
