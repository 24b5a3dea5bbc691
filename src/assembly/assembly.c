/* An axis is put together here: no room below knows all that an axis can do. */
#include "assembly/assembly.h"

#include "bridge/cool_muscle.h"
#include "coupling/coupling.h"
#include "homing/homing.h"

cm1e_error_t cm1e_axis_create(cm1e_axis_t **axis, cm1e_bus_t *bus, uint32_t index, cm1e_diag_t *diag)
{
    static cm1e_error_t (*const additions[])(cm1e_axis_t *axis, cm1e_diag_t *diag) = {
        cm1e_coupling_add,
        cm1e_homing_add,
        cm1e_cool_muscle_add,
    };
    cm1e_error_t error = cm1e_axis_make(axis, bus, index, diag);
    for (size_t i = 0; i < sizeof additions / sizeof additions[0] && error == CM1E_OK; i++)
        error = additions[i](*axis, diag);
    if (error == CM1E_OK)
        error = cm1e_axis_publish(*axis, diag);
    if (error != CM1E_OK) {
        cm1e_axis_destroy(*axis);
        *axis = NULL;
    }
    return error;
}
