/**
 * @file moved_drives.h
 * Any number of simulated motors on one network, on virtual time: all are enabled, and moved to places of their own. The
 * frames of the process data are counted meanwhile, so that their time on the wire can be computed.
 */
#ifndef CM1E_TESTS_MOVED_DRIVES_H
#define CM1E_TESTS_MOVED_DRIVES_H

#include "cm1e/bus.h"

typedef struct moved_drives {
    uint32_t moved;             /**< motors that stand where they were sent, and went there without a jump */
    uint64_t cycles;
    uint64_t bad_cycles;        /**< frames lost, or a wrong working counter */
    unsigned frames;            /**< of process data in each cycle */
    unsigned bytes;             /**< of these frames in each cycle, with preamble, headers, check sequence and gap */
    cm1e_diag_t diag;           /**< of the result */
} moved_drives_t;

/** Starts the bus of this configuration, with one motor for each axis, and runs it until all motors have moved, or for
 *  so many cycles. An error is diagnosed. */
cm1e_error_t moved_drives_run(const cm1e_bus_config_t *config, unsigned cycles_at_most, moved_drives_t *result);

/** How long they are on the wire in a cycle, where each slave takes this time there and back. */
double moved_drives_wire_us(const moved_drives_t *result, uint32_t slaves, double us_per_slave);

#endif
