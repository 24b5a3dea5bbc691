/**
 * @file variable_value.h
 * Values of variables as a user sees them, and writes them: `cm1e var set NAME=VALUE`.
 */
#ifndef CM1E_TOOLS_VARIABLE_VALUE_H
#define CM1E_TOOLS_VARIABLE_VALUE_H

#include <jansson.h>

enum { VARIABLE_TEXT_BYTES = 2100 }; /**< for any value: a character of a text takes up to 3 */

/** The value of a row of `variables` (docs/CONTROL.md) in one line: 3.5, 20 ns, FAST, 'text'. */
void variable_text(const json_t *row, char *text, size_t size);

/** What a word means for the variable of a row: a number, a truth value, a text in quotes, a literal as in a program (T#1m5s,
 *  16#FF), or the name of an enumerator. Whether it is in its range, the program decides. NULL and a complaint: it means
 *  nothing. */
json_t *variable_value(const json_t *row, const char *word);

#endif
