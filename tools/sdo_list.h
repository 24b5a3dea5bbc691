/**
 * @file sdo_list.h
 * The dictionary that a slave tells of itself, for `cm1e sdo list`.
 */
#ifndef CM1E_TOOLS_SDO_LIST_H
#define CM1E_TOOLS_SDO_LIST_H

#include <stdbool.h>

#include "cm1e/bus.h"

/** Prints all objects with their sub-indexes, with `values` what they hold now. Returns the exit status. */
int list_dictionary(cm1e_bus_t *bus, uint16_t position, bool values, bool json);

#endif
