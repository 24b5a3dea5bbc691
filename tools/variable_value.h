/**
 * @file variable_value.h
 * Values of variables as a user writes them: `cm1e var set NAME=VALUE`.
 */
#ifndef CM1E_TOOLS_VARIABLE_VALUE_H
#define CM1E_TOOLS_VARIABLE_VALUE_H

#include <jansson.h>

/** A truth value as in a program, a finite number, or a text in quotes ('text' or "text"); NULL and a complaint: it is none of these. */
json_t *variable_value(const char *text);

#endif
