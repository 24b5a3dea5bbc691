/**
 * @file esc.h
 * The registers of one slave controller (ETG.1000.4) and its EtherCAT state, requested as they are: for commissioning
 * and for the acceptance of a device. Nothing here is needed to run motors. The thread that owns the bus calls these
 * functions after a scan, before the cycle runs. What they change is undone by the next cm1e_bus_scan(), except what
 * the slave itself keeps.
 */
#ifndef CM1E_ESC_H
#define CM1E_ESC_H

#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CM1E_ESC_BYTES 512 /**< maximum number of bytes of one access */

/** Reads `size` bytes from `address` on. Position 0 asks all slaves at once, also before a scan: the bits of all are
 *  OR-ed together. Of a network that another program runs (cm1e_bus_open_attached()) the registers below 0x0900 of one
 *  slave can be read. Returns CM1E_ERROR_TIMEOUT if the slave does not answer, CM1E_ERROR_STATE while the cycle runs.
 *  @rt block */
CM1E_API cm1e_error_t cm1e_esc_read(cm1e_bus_t *bus, uint16_t position, uint16_t address, void *data, uint16_t size,
                                    cm1e_diag_t *diag);
/** Writes `size` bytes from `address` on; errors as for cm1e_esc_read(). Position 0 is refused. @rt block */
CM1E_API cm1e_error_t cm1e_esc_write(cm1e_bus_t *bus, uint16_t position, uint16_t address, const void *data,
                                     uint16_t size, cm1e_diag_t *diag);

/** AL status and AL status code, as the slave shows them. */
typedef struct cm1e_al_answer {
    uint16_t state; /**< cm1e_al_state_t, with CM1E_AL_ERROR if it refuses */
    uint16_t code;  /**< 0: no error */
} cm1e_al_answer_t;

/** Acknowledges an error that the slave shows, then requests a state as it is: without the states between, and also one
 *  that does not exist (1 ... 15). A refusal is no error: `*answer` has it. Returns CM1E_ERROR_TIMEOUT if the slave
 *  neither goes nor refuses within `timeout_ns`, which is above 0; `*answer` then has its present state. @rt block */
CM1E_API cm1e_error_t cm1e_esc_request_state(cm1e_bus_t *bus, uint16_t position, uint8_t state, int64_t timeout_ns,
                                             cm1e_al_answer_t *answer, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
