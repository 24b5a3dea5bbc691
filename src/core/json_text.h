/**
 * @file json_text.h
 * A text of a file or device in JSON, which is UTF-8. Whoever includes this links jansson.
 */
#ifndef CM1E_CORE_JSON_TEXT_H
#define CM1E_CORE_JSON_TEXT_H

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "core/text.h"

/** The text, cleaned (text.h); NULL is "". */
static inline json_t *cm1e_json_text(const char *text)
{
    char *copy = strdup(text ? text : "");
    if (copy)
        cm1e_text_clean(copy);
    json_t *value = json_string(copy ? copy : "");
    free(copy);
    return value;
}

#endif
