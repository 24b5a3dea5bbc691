/**
 * @file live.h
 * A live device as a description: its SII, the dictionary that it tells, the mapping that it has. By the thread that
 * owns the bus, after a scan, before the cycle runs.
 */
#ifndef CM1E_GENERATE_LIVE_H
#define CM1E_GENERATE_LIVE_H

#include "cm1e/bus.h"
#include "description/check.h"
#include "description/description.h"

/** Appends the device at `position`. What it does not tell (it has no dictionary, or none that can be asked for) is a
 *  finding, no error. */
cm1e_error_t cm1e_live_describe(cm1e_description_file_t *file, cm1e_bus_t *bus, uint16_t position,
                                cm1e_findings_t *findings, cm1e_diag_t *diag);

#endif
