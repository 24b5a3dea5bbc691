/**
 * @file foe.h
 * Files in a slave (FoE, ETG.1000.6 section 5.8): parameters, logs, firmware. The slave knows a file by its name; the
 * maker of the slave defines what is in it. The thread that owns the bus calls these functions after a scan. They wait;
 * the time of every answer and of the whole transfer is bounded. A slave that is busy is asked again. If a transfer is
 * given up, the slave is told, so that the next one begins anew.
 *
 * While the bus operates, the packets go beside the process data, one datagram of the mailbox in a cycle, in turn with
 * the SDO transfers of that slave. Until a scheduler runs, these functions make the cycles. While one runs, any other
 * thread may call them, but no task: they wait until the cycles of the scheduler have transferred the file, and
 * `progress` is called by the thread that waits. One file is on its way at a time for a bus. The end of the run ends
 * it (CM1E_ERROR_CANCELLED); the bus must not be closed before the call has returned. A transfer in Bootstrap is
 * refused while the bus operates, because a slave in Bootstrap takes no part in the process data.
 */
#ifndef CM1E_FOE_H
#define CM1E_FOE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A zeroed struct has the defaults. */
typedef struct cm1e_foe_options {
    uint32_t password;  /**< 0: none */
    bool bootstrap;     /**< in the state Bootstrap, with its mailbox; the bus needs a new scan afterwards */
    int64_t answer_ns;  /**< longest time for one answer, or for being busy; 0 selects 5 s */
    /** Called after each packet with the bytes so far, and the bytes of the file (0 while reading: not known). false:
     *  break off. NULL: none. */
    bool (*progress)(void *context, size_t done, size_t size);
    void *context;
} cm1e_foe_options_t;

/** Does the work of cm1e_foe_read(), for a program with this size of the options. @rt block */
CM1E_API cm1e_error_t cm1e_foe_read_sized(cm1e_bus_t *bus, uint16_t position, const char *name, void *data,
                                          size_t *size, const cm1e_foe_options_t *options, size_t options_size,
                                          cm1e_diag_t *diag);
/** Reads a file. `*size` is the room in `data`, afterwards the bytes of the file. `options` may be NULL. Returns
 *  CM1E_ERROR_BUS_MAILBOX if the slave refuses, with the error code of FoE in `diag->foreign_code` and its text;
 *  CM1E_ERROR_FULL if the file is larger than the room; CM1E_ERROR_TIMEOUT, CM1E_ERROR_BUS_LOST, CM1E_ERROR_CANCELLED
 *  (by `progress`); CM1E_ERROR_UNSUPPORTED if its SII announces no FoE; CM1E_ERROR_STATE before a scan, and for
 *  Bootstrap while the bus operates; CM1E_ERROR_BUSY if another file is on its way then.
 *  @rt block */
static inline cm1e_error_t cm1e_foe_read(cm1e_bus_t *bus, uint16_t position, const char *name, void *data,
                                         size_t *size, const cm1e_foe_options_t *options, cm1e_diag_t *diag)
{
    return cm1e_foe_read_sized(bus, position, name, data, size, options, sizeof(cm1e_foe_options_t), diag);
}
/** Does the work of cm1e_foe_write(), for a program with this size of the options. @rt block */
CM1E_API cm1e_error_t cm1e_foe_write_sized(cm1e_bus_t *bus, uint16_t position, const char *name, const void *data,
                                           size_t size, const cm1e_foe_options_t *options, size_t options_size,
                                           cm1e_diag_t *diag);
/** Writes a file; errors as for cm1e_foe_read(). If the transfer breaks off, it depends on the slave what it keeps.
 *  @rt block */
static inline cm1e_error_t cm1e_foe_write(cm1e_bus_t *bus, uint16_t position, const char *name, const void *data,
                                          size_t size, const cm1e_foe_options_t *options, cm1e_diag_t *diag)
{
    return cm1e_foe_write_sized(bus, position, name, data, size, options, sizeof(cm1e_foe_options_t), diag);
}
/** Text of an error code of FoE (0x8000 and above); never NULL. @rt any */
CM1E_API const char *cm1e_foe_error_text(uint32_t code);

#ifdef __cplusplus
}
#endif
#endif
