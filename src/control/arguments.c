#include "control/arguments.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/show.h"
#include "core/json_text.h"

bool cm1e_take_number(const json_t *message, const char *name, json_int_t minimum, json_int_t maximum,
                      json_int_t otherwise, json_int_t *value)
{
    const json_t *member = json_object_get(message, name);
    *value = member ? json_integer_value(member) : otherwise;
    return (!member || json_is_integer(member)) && *value >= minimum && *value <= maximum;
}

bool cm1e_take_keep(const json_t *message, int minimum_ms, int maximum_ms, int otherwise_ms, int64_t *keep_ns)
{
    json_int_t keep_ms;
    const bool good = cm1e_take_number(message, "keep_ms", minimum_ms, maximum_ms, otherwise_ms, &keep_ms);
    *keep_ns = good ? keep_ms * INT64_C(1000000) : 0;
    return good;
}

static int nibble(char c)
{
    static const char digits[] = "0123456789abcdef";
    const char *found = c ? strchr(digits, tolower((unsigned char)c)) : NULL;
    return found ? (int)(found - digits) : -1;
}

bool cm1e_take_bytes(const json_t *message, const char *name, uint8_t *bytes, size_t room, size_t *length)
{
    const char *text = json_string_value(json_object_get(message, name));
    const size_t digits = text ? strlen(text) : 1;
    if (digits % 2 != 0 || digits / 2 > room)
        return false;
    for (size_t i = 0; i < digits; i += 2) {
        const int high = nibble(text[i]), low = nibble(text[i + 1]);
        if (high < 0 || low < 0)
            return false;
        bytes[i / 2] = (uint8_t)(high << 4 | low);
    }
    *length = digits / 2;
    return true;
}

json_t *cm1e_show_bytes(const uint8_t *bytes, size_t length)
{
    char *text = malloc(2 * length + 1);
    for (size_t i = 0; text && i < length; i++)
        snprintf(text + 2 * i, 3, "%02x", bytes[i]);
    if (text)
        text[2 * length] = 0;
    json_t *value = text ? json_string(text) : NULL;
    free(text);
    return value;
}

/* ---- replies ---------------------------------------------------------------------------------------------------- */

static json_t *with_id(json_t *reply, json_t *id)
{
    if (id)
        json_object_set(reply, "id", id);
    return reply;
}

json_t *cm1e_request_refuse(json_t *id, cm1e_error_t error, uint32_t foreign_code, const char *text)
{
    json_t *reply = json_pack("{s:b, s:{s:i, s:I, s:o}}", "ok", 0, "error", "code", (int)error, "foreign_code",
                              (json_int_t)foreign_code, "text", cm1e_json_text(text));
    return with_id(reply, id);
}

json_t *cm1e_request_accept(json_t *id, const char *name, json_t *value)
{
    if (!value)
        return cm1e_request_refuse(id, CM1E_ERROR_NO_MEMORY, 0, "No memory for the reply.");
    return with_id(json_pack("{s:b, s:o}", "ok", 1, name, value), id);
}
