#include <stdlib.h>
#include <string.h>

#include "attach.h"

json_t *ask_program(cm1e_control_t *control, json_t *request, const char *member, cm1e_diag_t *diag)
{
    char *asked = json_dumps(request, JSON_COMPACT), *told = NULL;
    json_decref(request);
    const cm1e_error_t error = cm1e_control_ask(control, asked ? asked : "", &told, diag);
    json_t *reply = told ? json_loads(told, 0, NULL) : NULL;
    free(asked);
    free(told);
    json_t *value = error == CM1E_OK ? json_incref(json_object_get(reply, member)) : NULL;
    json_decref(reply);
    if (error == CM1E_OK && !value)
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "The answer of the program has no \"%s\": it is of another version.", member);
    return value;
}

size_t axis_of_program(const json_t *axes, const char *word)
{
    const size_t count = json_array_size(axes);
    char *end;
    for (size_t i = 0; i < count; i++) {
        const char *name = json_string_value(json_object_get(json_array_get(axes, i), "name"));
        if (name && strcmp(name, word) == 0)
            return i + 1;
    }
    const unsigned long number = strtoul(word, &end, 10);
    return word[0] >= '0' && word[0] <= '9' && *end == '\0' && number <= count ? number : 0;
}
