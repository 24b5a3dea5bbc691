/* Texts in JSON: out of a reply, and into a result. */
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "core/text.h"

const char *text_of(const json_t *object, const char *name)
{
    const char *text = json_string_value(json_object_get(object, name));
    return text ? text : "";
}

json_t *text_as_json(const char *text)
{
    char *copy = strdup(text ? text : "");
    if (copy)
        cm1e_text_clean(copy);
    json_t *value = json_string(copy ? copy : "");
    free(copy);
    return value;
}
