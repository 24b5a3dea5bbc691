/**
 * @file sdo_list.h
 * Lists the dictionary of a slave, for `cm1e sdo list`.
 */
#ifndef CM1E_TOOLS_SDO_LIST_H
#define CM1E_TOOLS_SDO_LIST_H

#include <stdbool.h>

#include "cm1e/bus.h"
#include "device/device.h"

/** The row of an object of this slave in the device tables; NULL: none. */
const cm1e_entry_t *find_entry(const cm1e_slave_info_t *slave, uint16_t index, uint8_t subindex);
/** The mark of an object in the guide: "N/A" or "-" for one without use; "": usable, or not known. NULL is allowed. */
const char *availability_mark(const cm1e_entry_t *entry);

/** Prints all objects with their sub-indexes, and with `values` their present values. Returns the exit status. */
int list_dictionary(cm1e_bus_t *bus, const cm1e_slave_info_t *slave, bool values, bool json);

#endif
