/**
 * @file assembly/assembly.h
 * An axis as a whole: that of src/axis, and what the rooms above it add.
 */
#ifndef CM1E_ASSEMBLY_ASSEMBLY_H
#define CM1E_ASSEMBLY_ASSEMBLY_H

#include "axis/axis_api.h"

/** Makes the axis of drive `index`, with all that it can do, and registers its handle. cm1e_axis_destroy() ends it.
 *  @rt init */
cm1e_error_t cm1e_axis_create(cm1e_axis_t **axis, cm1e_bus_t *bus, uint32_t index, cm1e_diag_t *diag);

#endif
