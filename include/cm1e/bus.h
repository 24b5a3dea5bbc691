/**
 * @file bus.h
 * One EtherCAT network: open it, look at it, bring it to Operational, exchange its process image, stop it.
 * Threads: one thread owns the bus and calls everything here; in operation that is the scheduler's cycle. Other
 * threads talk to slaves only through cm1e_sdo_submit().
 */
#ifndef CM1E_BUS_H
#define CM1E_BUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/config.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cm1e_bus cm1e_bus_t;

/** EtherCAT states as the AL status register codes them (ETG.1000.6). */
typedef enum cm1e_al_state {
    CM1E_AL_NONE = 0,
    CM1E_AL_INIT = 1,
    CM1E_AL_PRE_OP = 2,
    CM1E_AL_BOOT = 3,
    CM1E_AL_SAFE_OP = 4,
    CM1E_AL_OP = 8,
    CM1E_AL_ERROR = 0x10, /**< flag beside the state */
} cm1e_al_state_t;

/** What a scan found at one position. */
typedef struct cm1e_slave_info {
    uint16_t position;    /**< 1 = first */
    char name[48];        /**< from SII */
    uint32_t vendor_id, product_code, revision, serial_number; /**< from SII */
    uint16_t alias;       /**< register 0x0012 */
    uint16_t explicit_id; /**< 0: none or not supported */
    uint16_t al_state, al_status_code;
    bool is_cm1e;
    bool is_bridge;             /**< an EtherCAT Cool MUSCLE Bridge, by its modular objects (0xF000, 0xF010, 0xF050) */
    cm1e_device_model_t model;  /**< which one, by its motors; CM1E_DEVICE_CM1E: no bridge, or none that is known */
    uint8_t motors[4];          /**< of a bridge, by connector (0xF511:1 ... 0xF514:1): 1 CM1, 2 CM2, 0 another */
    char software_version[16]; /**< object 0x100A, "" where it cannot be read */
    uint16_t output_bytes, input_bytes; /**< of the process image, once configured */
} cm1e_slave_info_t;

/** Counters of the cycle; they only grow. */
typedef struct cm1e_bus_counters {
    uint64_t cycles, lost_frames, working_counter_errors, late_frames, mailbox_retries;
    uint64_t unsent_frames; /**< the network interface did not take them: it is down, or its queue is full */
} cm1e_bus_counters_t;

/** Opens the interface (network interface or simulated segment); sends nothing yet. `config` is copied.
 *  The bus is freed with cm1e_bus_close(). @rt init */
CM1E_API cm1e_error_t cm1e_bus_open(cm1e_bus_t **bus, const cm1e_bus_config_t *config, cm1e_diag_t *diag);

/** Finds the slaves and brings them to Pre-Operational. Expects nothing: see cm1e_bus_identify(). @rt init */
CM1E_API cm1e_error_t cm1e_bus_scan(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Slaves that the last scan found; 0 before. @rt any */
CM1E_API uint32_t cm1e_bus_slave_count(const cm1e_bus_t *bus);
/** NULL where there is no such slave (1 = first). Valid until the next scan. While the cycle runs, it keeps `al_state`
 *  and `al_status_code` up to date: they are for its thread then. @rt any */
CM1E_API const cm1e_slave_info_t *cm1e_bus_slave(const cm1e_bus_t *bus, uint32_t position);

/** Matches the scan with the configured axes: a wrong, missing, doubled or extra slave is an error that names what was
 *  expected and what was found. Extra is a CM1-E, or a bridge, that no axis is configured for; a device of another kind
 *  may stand between the axes and runs with the process data of its SII. Not every motor behind a bridge needs an axis:
 *  the others get the controlword 0 and stay as they are from power-on, a CM1 holding its position (BR 6.1.1). Without
 *  any configured axis everything is accepted; a revision that is not known is no error. @rt init */
CM1E_API cm1e_error_t cm1e_bus_identify(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Position of an axis's slave (axis 0 = first configured); 0: none. @rt any */
CM1E_API uint16_t cm1e_bus_axis_position(const cm1e_bus_t *bus, uint32_t axis);

/** Writes the chosen mapping, reads it back, resolves every object, maps the process image, goes to Safe-Operational.
 *  CM1E_ERROR_CONFIG: the frames of so many slaves take too long for the cycle time. After an error scan again.
 *  @rt init */
CM1E_API cm1e_error_t cm1e_bus_configure(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** To Operational, exchanging the process image at the cycle time meanwhile. @rt init */
CM1E_API cm1e_error_t cm1e_bus_operate(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Scan, identify, configure, operate. @rt init */
CM1E_API cm1e_error_t cm1e_bus_start(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Safe-Operational, then Init. The drives must be disabled before. Never fails: does what it still can. Refused in a
 *  task of a scheduler, as cm1e_bus_close(): the run ends in order, with an error. @rt init */
CM1E_API void cm1e_bus_stop(cm1e_bus_t *bus);
/** Stops if need be, closes the interface, frees. NULL is allowed. CM1E_ERROR_IO: it is closed, but not every frame
 *  arrived in the pcap file; CM1E_ERROR_STATE: refused in a task. @rt init */
CM1E_API cm1e_error_t cm1e_bus_close(cm1e_bus_t *bus);

/** Takes in the frame(s) sent in the last cycle. CM1E_OK: all inputs are fresh; CM1E_ERROR_BUS_LOST or
 *  CM1E_ERROR_BUS_WORKING_COUNTER: the inputs are the previous ones (those of the slaves that did not take part).
 *  @rt cycle */
CM1E_API cm1e_error_t cm1e_bus_receive(cm1e_bus_t *bus);
/** Sends the outputs, and at most one datagram of mailbox work or supervision per slave in need. @rt cycle */
CM1E_API void cm1e_bus_send(cm1e_bus_t *bus);
/** CM1E_OK, or why the slaves of the bus cannot be trusted now: the last error after `lost_cycles_limit` bad cycles in
 *  a row. Returns to CM1E_OK by itself when the cycle is good again. @rt cycle */
CM1E_API cm1e_error_t cm1e_bus_health(const cm1e_bus_t *bus);
/** What went wrong so far. Lives as long as the bus. @rt cycle */
CM1E_API const cm1e_bus_counters_t *cm1e_bus_counters(const cm1e_bus_t *bus);
/** The bus's own copy, with defaults filled in. Lives as long as the bus. @rt any */
CM1E_API const cm1e_bus_config_t *cm1e_bus_configuration(const cm1e_bus_t *bus);

/* ---- SDO -------------------------------------------------------------------------------------------------------- */

typedef enum cm1e_sdo_state { CM1E_SDO_IDLE = 0, CM1E_SDO_BUSY, CM1E_SDO_DONE, CM1E_SDO_ERROR } cm1e_sdo_state_t;

/** One SDO transfer. The caller owns it and its data buffer and keeps both until the state is DONE or ERROR. */
typedef struct cm1e_sdo {
    uint16_t position;        /**< slave, 1 = first */
    uint16_t index;
    uint8_t subindex;
    bool write;
    bool complete_access;
    void *data;               /**< little endian, as on the wire */
    size_t size;              /**< write: bytes to write; read: size of the buffer, afterwards bytes read */
    int64_t timeout_ns;       /**< 0: 1 s */
    cm1e_error_t error;       /**< valid in state ERROR */
    uint32_t abort_code;      /**< valid with CM1E_ERROR_SDO_ABORT */
    int state;                /**< cm1e_sdo_state_t; read it with cm1e_sdo_state() */
} cm1e_sdo_t;

/** State of a transfer; everything else in it may be read once this says DONE or ERROR (acquire). @rt any */
CM1E_API cm1e_sdo_state_t cm1e_sdo_state(const cm1e_sdo_t *sdo);

/** Hands a transfer to the bus; it is worked on within the cycle, one datagram at a time, never blocking it.
 *  CM1E_ERROR_FULL when 64 transfers wait. Any thread may submit, several at a time. @rt cycle */
CM1E_API cm1e_error_t cm1e_sdo_submit(cm1e_bus_t *bus, cm1e_sdo_t *sdo);
/** Reads and waits, before the cycle runs (the caller owns the bus). `*size`: room, then bytes read. In a task of a
 *  scheduler CM1E_ERROR_STATE, as everything that waits: cm1e_sdo_submit() is for that. @rt block */
CM1E_API cm1e_error_t cm1e_sdo_read(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, void *data,
                                    size_t *size, cm1e_diag_t *diag);
/** Writes and waits, as cm1e_sdo_read(). @rt block */
CM1E_API cm1e_error_t cm1e_sdo_write(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex,
                                     const void *data, size_t size, cm1e_diag_t *diag);
/** Text of an SDO abort code (ETG.1000.6); never NULL. @rt any */
CM1E_API const char *cm1e_sdo_abort_text(uint32_t abort_code);
/** Text of an AL status code; never NULL. @rt any */
CM1E_API const char *cm1e_al_status_text(uint16_t al_status_code);

/* ---- the simulated segment behind interface "sim" ---------------------------------------------------------------- */

/** Acts on the simulated segment with one console line, e.g. "power 2 off" ("help" lists them), and writes the answer
 *  to `answer`. CM1E_ERROR_UNSUPPORTED on a network interface. @rt cycle */
CM1E_API cm1e_error_t cm1e_bus_simulate(cm1e_bus_t *bus, const char *line, char *answer, size_t size);

#ifdef __cplusplus
}
#endif
#endif
