/**
 * @file bus.h
 * One EtherCAT network: open it, scan it, bring it to Operational, exchange its process image, stop it.
 * One thread owns the bus and calls the functions of this header; in operation that is the thread of the scheduler.
 * Other threads call only those that are marked `@rt any`, and reach slaves through cm1e_sdo_submit().
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

/** One network, from cm1e_bus_open() to cm1e_bus_close(). */
typedef struct cm1e_bus cm1e_bus_t;

/** EtherCAT states as the AL status register codes them (ETG.1000.6). */
typedef enum cm1e_al_state {
    CM1E_AL_NONE = 0,
    CM1E_AL_INIT = 1,
    CM1E_AL_PRE_OP = 2,
    CM1E_AL_BOOT = 3,
    CM1E_AL_SAFE_OP = 4,
    CM1E_AL_OP = 8,
    CM1E_AL_ERROR = 0x10, /**< error flag, added to the state */
} cm1e_al_state_t;

/** A slave as the scan found it. */
typedef struct cm1e_slave_info {
    uint16_t position;    /**< 1 = first */
    char name[48];        /**< from SII */
    uint32_t vendor_id, product_code, revision, serial_number; /**< from SII */
    uint16_t alias;       /**< register 0x0012 */
    uint16_t explicit_id; /**< value of the rotary switches; 0: none or not supported */
    uint16_t al_state, al_status_code;
    const struct cm1e_device *device; /**< what the library knows of it; NULL: it is none of its devices */
    const char *kind;           /**< "cm1-e", "bridge" (by its modular objects 0xF000, 0xF010, 0xF050) ...: the name of
                                     its kind in a bus file; NULL: it is none of the library's devices */
    cm1e_device_model_t model;  /**< model of a bridge, by its motors; CM1E_DEVICE_CM1E: no bridge, or an unknown
                                     model */
    uint8_t motors[4];          /**< motors of a bridge by connector (0xF511:1 ... 0xF514:1): 1 CM1, 2 CM2, 0 another */
    char software_version[16]; /**< object 0x100A; "" if it cannot be read */
    uint16_t output_bytes, input_bytes; /**< bytes in the process image, once configured */
} cm1e_slave_info_t;

/** Counters of the cycle; they only grow. */
typedef struct cm1e_bus_counters_t {
    uint64_t cycles;
    uint64_t lost_frames;   /**< frames with process data that did not come back in time */
    uint64_t working_counter_errors; /**< cycles in which a slave did not take part */
    uint64_t late_frames;   /**< frames that came back after their time was over; they are not used */
    uint64_t mailbox_retries; /**< datagrams of mailbox work that were lost and are sent again */
    uint64_t unsent_frames; /**< frames that the network interface did not take: it is down, or its queue is full */
    uint64_t foreign_frames; /**< frames of another master, which sends on the same network without asking for it */
} cm1e_bus_counters_t;

/** Opens the interface (network interface or simulated segment); nothing is sent yet. `config` is copied. Free the bus
 *  with cm1e_bus_close(). @rt init */
CM1E_API cm1e_error_t cm1e_bus_open(cm1e_bus_t **bus, const cm1e_bus_config_t *config, cm1e_diag_t *diag);

/** Finds the slaves and brings them to Pre-Operational. It does not compare them with the configuration, see
 *  cm1e_bus_identify(). @rt init */
CM1E_API cm1e_error_t cm1e_bus_scan(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Number of slaves that the last scan found; 0 before the first scan. @rt any */
CM1E_API uint32_t cm1e_bus_slave_count(const cm1e_bus_t *bus);
/** The slave at `position` (1 = first); NULL if there is no such slave. Valid until the next scan. While the cycle
 *  runs, it updates `al_state` and `al_status_code`; then only its thread may read these two. @rt any */
CM1E_API const cm1e_slave_info_t *cm1e_bus_slave(const cm1e_bus_t *bus, uint32_t position);
/** The name that the configuration gives to a slave without an axis, from cm1e_bus_identify() on; "" if it names none
 *  there. @rt any */
CM1E_API const char *cm1e_bus_slave_name(const cm1e_bus_t *bus, uint32_t position);

/** Compares the scan with the configured axes. A wrong, missing, doubled or extra slave is an error; `diag` names what
 *  was expected and what was found. A CM1-E or a bridge without a configured axis is extra. A device of another kind
 *  may stand between the axes and runs with the process data of its SII. Not every motor behind a bridge needs an axis:
 *  the others get the controlword 0 and keep their state from power-on, in which a CM1 holds its position (BR 6.1.1).
 *  Without any configured axis everything is accepted. An unknown revision is not an error. @rt init */
CM1E_API cm1e_error_t cm1e_bus_identify(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Position of the slave of an axis (axis 0 = first configured); 0: none. @rt any */
CM1E_API uint16_t cm1e_bus_axis_position(const cm1e_bus_t *bus, uint32_t axis);

/** Writes the chosen mapping, reads it back, resolves every object, maps the process image, and brings the slaves to
 *  Safe-Operational. Returns CM1E_ERROR_CONFIG if the frames of all slaves take too long for the cycle time. After an
 *  error scan again. @rt init */
CM1E_API cm1e_error_t cm1e_bus_configure(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Brings the slaves to Operational, and exchanges the process image at the cycle time meanwhile. @rt init */
CM1E_API cm1e_error_t cm1e_bus_operate(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Does all four steps: scan, identify, configure, operate. @rt init */
CM1E_API cm1e_error_t cm1e_bus_start(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Brings the slaves to Safe-Operational, then to Init. The drives must be disabled before. It never fails: it does
 *  what is still possible. In a task of a scheduler, and in any other thread while a scheduler runs, it is refused,
 *  like cm1e_bus_close(); the run then ends in order, with an error. @rt init */
CM1E_API void cm1e_bus_stop(cm1e_bus_t *bus);
/** Stops the bus if necessary, closes the interface, and frees the bus. NULL is allowed. Returns CM1E_ERROR_IO if the
 *  bus is closed but not every frame arrived in the pcap file, CM1E_ERROR_STATE if it is refused, see cm1e_bus_stop().
 *  @rt init */
CM1E_API cm1e_error_t cm1e_bus_close(cm1e_bus_t *bus);

/** Receives the frame(s) sent in the last cycle. CM1E_OK: all inputs are fresh. CM1E_ERROR_BUS_LOST: all inputs are
 *  stale. CM1E_ERROR_BUS_WORKING_COUNTER: the inputs of the slaves that did not take part are stale. @rt cycle */
CM1E_API cm1e_error_t cm1e_bus_receive(cm1e_bus_t *bus);
/** Sends the outputs and the datagrams of supervision, and at most four datagrams of mailbox work, each for another
 *  slave. @rt cycle */
CM1E_API void cm1e_bus_send(cm1e_bus_t *bus);
/** CM1E_OK, or the last error of the cycle after `lost_cycles_limit` bad cycles in a row: the inputs of the bus are not
 *  valid then. It returns to CM1E_OK by itself with the next good cycle. @rt cycle */
CM1E_API cm1e_error_t cm1e_bus_health(const cm1e_bus_t *bus);

/** What one port of a slave controller has counted since its power-on; each counter stops at 255 (ETG.1000.4). Port 0
 *  is IN, port 1 OUT; ports 2 and 3 are branches. */
typedef struct cm1e_slave_port {
    bool link;                 /**< there is a link now */
    uint8_t invalid_frames, receive_errors; /**< damaged on the way to this port */
    uint8_t forwarded_errors;  /**< damaged before, at another slave */
    uint8_t lost_links;
} cm1e_slave_port_t;
enum { CM1E_PORTS = 4 };

/** Reads the counters of all ports of a slave, after cm1e_bus_scan() and while no cycle runs. Returns
 *  CM1E_ERROR_INVALID_ARGUMENT if there is no such slave, CM1E_ERROR_TIMEOUT if it does not answer, CM1E_ERROR_STATE
 *  while a scheduler runs. @rt block */
CM1E_API cm1e_error_t cm1e_bus_read_ports(cm1e_bus_t *bus, uint16_t position, cm1e_slave_port_t ports[CM1E_PORTS],
                                          cm1e_diag_t *diag);

/** The counters of the cycle. The pointer is valid as long as the bus. @rt cycle */
CM1E_API const cm1e_bus_counters_t *cm1e_bus_counters(const cm1e_bus_t *bus);
/** The bus's own copy of its configuration, with defaults filled in. The pointer is valid as long as the bus.
 *  @rt any */
CM1E_API const cm1e_bus_config_t *cm1e_bus_configuration(const cm1e_bus_t *bus);

/* ---- SDO -------------------------------------------------------------------------------------------------------- */

/** How far an SDO transfer is. */
typedef enum cm1e_sdo_state { CM1E_SDO_IDLE = 0, CM1E_SDO_BUSY, CM1E_SDO_DONE, CM1E_SDO_ERROR } cm1e_sdo_state_t;

/** One SDO transfer. The caller owns it and its data buffer, and must keep both until the state is DONE or ERROR. */
typedef struct cm1e_sdo {
    uint16_t position;        /**< slave, 1 = first */
    uint16_t index;
    uint8_t subindex;
    bool write;
    bool complete_access;
    void *data;               /**< little endian, as on the wire */
    size_t size;              /**< bytes to write; for a read the size of the buffer, afterwards the bytes read */
    int64_t timeout_ns;       /**< 0: 1 s */
    cm1e_error_t error;       /**< valid in state ERROR */
    uint32_t abort_code;      /**< valid with CM1E_ERROR_SDO_ABORT */
    int state;                /**< cm1e_sdo_state_t; read it with cm1e_sdo_state() */
} cm1e_sdo_t;

/** State of a transfer. The other members may be read when this returns DONE or ERROR (acquire). @rt any */
CM1E_API cm1e_sdo_state_t cm1e_sdo_state(const cm1e_sdo_t *sdo);

/** Hands a transfer to the bus. The cycle executes it, one datagram at a time, and is never blocked by it. Returns
 *  CM1E_ERROR_FULL if 64 transfers wait. Any thread may submit, several threads at a time. @rt cycle */
CM1E_API cm1e_error_t cm1e_sdo_submit(cm1e_bus_t *bus, cm1e_sdo_t *sdo);
/** Reads an object and waits for the answer, before the cycle runs (the caller owns the bus). `*size` is the size of
 *  the buffer, afterwards the number of bytes read. In a task of a scheduler it returns CM1E_ERROR_STATE, like every
 *  function that waits, and in any other thread while a scheduler runs; use cm1e_sdo_submit() there. @rt block */
CM1E_API cm1e_error_t cm1e_sdo_read(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, void *data,
                                    size_t *size, cm1e_diag_t *diag);
/** Writes an object and waits for the answer; conditions as for cm1e_sdo_read(). @rt block */
CM1E_API cm1e_error_t cm1e_sdo_write(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex,
                                     const void *data, size_t size, cm1e_diag_t *diag);
/** Text of an SDO abort code (ETG.1000.6); never NULL. @rt any */
CM1E_API const char *cm1e_sdo_abort_text(uint32_t abort_code);
/** Text of an AL status code; never NULL. @rt any */
CM1E_API const char *cm1e_al_status_text(uint16_t al_status_code);

#ifdef __cplusplus
}
#endif
#endif
