/**
 * @file arguments.h
 * The members of a request, and what replies are made of.
 */
#ifndef CM1E_CONTROL_ARGUMENTS_H
#define CM1E_CONTROL_ARGUMENTS_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/error.h"

/** A whole number; false: it is missing without a default, of another type or out of its range. */
bool cm1e_take_number(const json_t *message, const char *name, json_int_t minimum, json_int_t maximum,
                      json_int_t otherwise, json_int_t *value);
/** "keep_ms" in ns; false as above. */
bool cm1e_take_keep(const json_t *message, int minimum_ms, int maximum_ms, int otherwise_ms, int64_t *keep_ns);
/** Bytes as hexadecimal digits; false: they are not, or more than `room`. */
bool cm1e_take_bytes(const json_t *message, const char *name, uint8_t *bytes, size_t room, size_t *length);
/** NULL: no memory. */
json_t *cm1e_show_bytes(const uint8_t *bytes, size_t length);

/** Replies. `id` is what the client calls its request; NULL: nothing. The value is taken over; NULL: no memory. */
json_t *cm1e_request_accept(json_t *id, const char *name, json_t *value);
json_t *cm1e_request_refuse(json_t *id, cm1e_error_t error, uint32_t foreign_code, const char *text);

#endif
