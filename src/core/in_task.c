#include "core/in_task.h"

#include <stddef.h>

static _Thread_local bool inside;
static _Thread_local const char *noted;
static _Thread_local in_task_leave_t *way_out;
_Atomic unsigned cm1e_in_task_over;

void cm1e_in_task_begin(void) { inside = true; }

void cm1e_in_task_end(void) { inside = false; }

bool cm1e_in_task(void) { return inside; }

void cm1e_in_task_watched(in_task_leave_t *leave) { way_out = leave; }

void cm1e_in_task_leave(void)
{
    if (!inside || !way_out)
        return;
    const uint64_t over = atomic_load(&way_out->over);
    if (over && over == atomic_load(&way_out->call))
        siglongjmp(way_out->place, 1);
}

cm1e_error_t cm1e_in_task_refuse(const char *function, const char *instead, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                         "%s waits, and is refused in a task: the motors would get no set-points meanwhile. Call it "
                         "before or after the run.%s%s", function, instead[0] ? " " : "", instead);
}

bool cm1e_in_task_note(const char *function)
{
    if (inside && !noted)
        noted = function;
    return inside;
}

const char *cm1e_in_task_noted(void)
{
    const char *function = noted;
    noted = NULL;
    return function;
}
