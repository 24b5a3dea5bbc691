/**
 * @file init_slaves.h
 * The slaves without a motor in a bus file that `cm1e init` writes.
 */
#ifndef CM1E_TOOLS_INIT_SLAVES_H
#define CM1E_TOOLS_INIT_SLAVES_H

#include <stdio.h>

#include "cm1e/bus.h"

/** Identity, signals and the simulated device of a slave, behind its name and address. */
void init_print_slave(FILE *file, cm1e_bus_t *bus, const cm1e_slave_info_t *slave);

#endif
