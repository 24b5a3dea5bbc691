/**
 * @file sdo_list.h
 * The dictionary that a slave tells of itself, for `cm1e sdo list`.
 */
#ifndef CM1E_TOOLS_SDO_LIST_H
#define CM1E_TOOLS_SDO_LIST_H

#include <stdbool.h>

#include "cm1e/bus.h"
#include "device/device.h"

/** The device tables' row of an object of this slave; NULL: they have none. */
const cm1e_entry_t *find_entry(const cm1e_slave_info_t *slave, uint16_t index, uint8_t subindex);
/** How the guide marks what is of no use: "N/A", "-"; "": it is of use, or not known. NULL is allowed. */
const char *availability_mark(const cm1e_entry_t *entry);

/** Prints all objects with their sub-indexes, with `values` what they hold now. Returns the exit status. */
int list_dictionary(cm1e_bus_t *bus, const cm1e_slave_info_t *slave, bool values, bool json);

#endif
