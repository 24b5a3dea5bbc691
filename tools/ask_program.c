#include <stdlib.h>

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
