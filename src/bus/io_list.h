/**
 * @file io_list.h
 * The signals of a slave, one after the other: those of its SII or PDO mapping, with the names that the configuration
 * gives them, then those that only the configuration names. Of a slave that the configuration names, the list is made
 * once, when its place in the process image is known.
 */
#ifndef CM1E_BUS_IO_LIST_H
#define CM1E_BUS_IO_LIST_H

#include "bus/bus_internal.h"
#include "cm1e/io.h"

typedef struct cm1e_listed_signal {
    cm1e_io_info_t info;
    const cm1e_signal_config_t *config; /**< that names it; NULL: none does */
} cm1e_listed_signal_t;

/** Inputs, then outputs. */
struct cm1e_signal_list {
    uint32_t count;
    cm1e_listed_signal_t at[];
};

/** Makes the list of a slave of the configuration. CM1E_ERROR_PDO_MAPPING: it does not have a signal that is named. */
cm1e_error_t cm1e_io_list_make(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_diag_t *diag);
/** The signal behind `info`, which is all zero before the first one; inputs before outputs. false: there are no
 *  more. */
bool cm1e_io_next(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_io_info_t *info);

#endif
