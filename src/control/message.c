#include "control/message.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Lists and objects within each other: a library that follows them down needs as much more stack. */
enum { DEPTH_MAX = 16 };

static bool is_too_deep(const uint8_t *text, size_t length)
{
    unsigned depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < length; i++) {
        if (quoted && text[i] == '\\')
            i++;
        else if (text[i] == '"')
            quoted = !quoted;
        else if (!quoted && (text[i] == '[' || text[i] == '{') && ++depth > DEPTH_MAX)
            return true;
        else if (!quoted && (text[i] == ']' || text[i] == '}') && depth > 0)
            depth--;
    }
    return false;
}

cm1e_message_state_t cm1e_message_read(const uint8_t *bytes, size_t length, size_t maximum, json_t **message,
                                       size_t *used, char why[JSON_ERROR_TEXT_LENGTH])
{
    json_error_t error;
    *message = NULL;
    if (length < CM1E_MESSAGE_HEADER)
        return CM1E_MESSAGE_PART;
    const uint32_t body = (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
    if (body > maximum)
        return CM1E_MESSAGE_TOO_LONG;
    if (length - CM1E_MESSAGE_HEADER < body)
        return CM1E_MESSAGE_PART;
    *used = CM1E_MESSAGE_HEADER + body;
    if (is_too_deep(bytes + CM1E_MESSAGE_HEADER, body)) {
        snprintf(why, JSON_ERROR_TEXT_LENGTH, "lists and objects are more than %d deep", DEPTH_MAX);
        return CM1E_MESSAGE_NOT_JSON;
    }
    *message = json_loadb((const char *)bytes + CM1E_MESSAGE_HEADER, body, JSON_REJECT_DUPLICATES, &error);
    if (!*message) {
        snprintf(why, JSON_ERROR_TEXT_LENGTH, "%.120s (byte %d)", error.text, error.position);
        return CM1E_MESSAGE_NOT_JSON;
    }
    if (json_is_object(*message))
        return CM1E_MESSAGE_WHOLE;
    json_decref(*message);
    *message = NULL;
    snprintf(why, JSON_ERROR_TEXT_LENGTH, "expected an object");
    return CM1E_MESSAGE_NOT_JSON;
}

uint8_t *cm1e_message_write(json_t *message, size_t *length)
{
    const size_t body = message ? json_dumpb(message, NULL, 0, JSON_COMPACT) : 0;
    uint8_t *bytes = body > 0 && body <= CM1E_REPLY_MAX ? malloc(CM1E_MESSAGE_HEADER + body) : NULL;
    if (bytes) {
        for (int i = 0; i < CM1E_MESSAGE_HEADER; i++)
            bytes[i] = (uint8_t)(body >> (8 * (CM1E_MESSAGE_HEADER - 1 - i)));
        json_dumpb(message, (char *)bytes + CM1E_MESSAGE_HEADER, body, JSON_COMPACT);
        *length = CM1E_MESSAGE_HEADER + body;
    }
    json_decref(message);
    return bytes;
}
