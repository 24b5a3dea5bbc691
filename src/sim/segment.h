/**
 * @file segment.h
 * A simulated EtherCAT segment: a line (or ring) of slaves that takes an Ethernet frame and gives back what the wire
 * would. One thread at a time; the frame path allocates nothing. Time is passed in, so it may be virtual.
 */
#ifndef CM1E_SIM_SEGMENT_H
#define CM1E_SIM_SEGMENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/config.h"

typedef struct cm1e_sim_segment cm1e_sim_segment_t;
typedef struct cm1e_sim_slave cm1e_sim_slave_t;
typedef struct cm1e_sim_cm1e cm1e_sim_cm1e_t;
typedef struct cm1e_sim_bridge cm1e_sim_bridge_t;

/** The network that a configuration describes: one CM1-E per axis, or one bridge for all axes that have a channel at
 *  the same address, placed by position, alias or explicit ID (aliases and IDs are set in the simulated devices in the
 *  order of the list). NULL and a diagnosis on failure. */
cm1e_sim_segment_t *cm1e_sim_segment_create(const cm1e_bus_config_t *config, cm1e_diag_t *diag);
/** An empty segment, to which slaves are added in the order of the line; it owns them. */
cm1e_sim_segment_t *cm1e_sim_segment_create_empty(void);
cm1e_error_t cm1e_sim_segment_add(cm1e_sim_segment_t *segment, cm1e_sim_slave_t *slave);
void cm1e_sim_segment_destroy(cm1e_sim_segment_t *segment);

/** Before the first frame: slave `position` (1 = first) boots from an image of its SII, which may end behind its last
 *  category, in place of the one made from the tables. It takes whatever the image says, alias included, as long as the
 *  device can be that: the same identity, sync managers for the same uses, PDOs of the same content. CM1E_ERROR_FILE:
 *  the image is damaged or of another device, nothing has changed. */
cm1e_error_t cm1e_sim_segment_boot(cm1e_sim_segment_t *segment, uint32_t position, const uint8_t *image, size_t size,
                                   cm1e_diag_t *diag);

uint32_t cm1e_sim_segment_slave_count(const cm1e_sim_segment_t *segment);
/** 1 = first; NULL: none. */
cm1e_sim_slave_t *cm1e_sim_segment_slave(cm1e_sim_segment_t *segment, uint32_t position);

enum { CM1E_SIM_PORT_PRIMARY = 0, CM1E_SIM_PORT_SECONDARY = 1, CM1E_SIM_PORT_LOST = -1 };

/** Sends an Ethernet frame (from destination MAC on, without FCS) through the segment, in place; returns the port at
 *  which it comes out, or CM1E_SIM_PORT_LOST. A line gives it back at the entry port; a closed ring
 *  (cm1e_sim_segment_close_ring()) at the other one. Frames that are not EtherCAT are lost. */
int cm1e_sim_segment_process(cm1e_sim_segment_t *segment, int entry_port, uint8_t *frame, size_t length,
                             int64_t now_ns);
/** Lets simulated time pass without a frame (watchdogs, mechanics). */
void cm1e_sim_segment_advance(cm1e_sim_segment_t *segment, int64_t now_ns);

/** When cm1e_sim_segment_advance() has to be called next, though no frame comes: INT64_MIN: a motor moves, INT64_MAX:
 *  all is at rest. */
int64_t cm1e_sim_segment_due(const cm1e_sim_segment_t *segment);

/** The secondary network interface is connected behind the last slave. */
void cm1e_sim_segment_close_ring(cm1e_sim_segment_t *segment);
/** Cuts (or mends) the cable before slave `position` (1 = between master and first; count + 1 = the ring's last). */
void cm1e_sim_segment_cut(cm1e_sim_segment_t *segment, uint32_t position, bool cut);

/** Faults on the next frames as the console sets them; the backend asks before it delivers a frame. Consumes one. */
typedef enum cm1e_frame_fault {
    CM1E_FRAME_OK = 0, CM1E_FRAME_LOSE, CM1E_FRAME_CORRUPT, CM1E_FRAME_DELAY,
} cm1e_frame_fault_t;
cm1e_frame_fault_t cm1e_sim_segment_next_frame_fault(cm1e_sim_segment_t *segment, int64_t *delay_ns);
/** Sets that fault on the next `count` frames (`delay_ns`: CM1E_FRAME_DELAY only); replaces what was set before. */
void cm1e_sim_segment_set_frame_fault(cm1e_sim_segment_t *segment, cm1e_frame_fault_t kind, uint32_t count,
                                      int64_t delay_ns);

/** One console line ("help" lists them): acts on the segment and writes an answer without trailing newline. Lines come
 *  from `cm1e sim`, tests and cm1e_bus_simulate(). Returns CM1E_OK, or an error whose reason is the answer. */
cm1e_error_t cm1e_sim_console(cm1e_sim_segment_t *segment, const char *line, char *answer, size_t size);

/** What happened unasked since it was asked last: a slave fell back to a lower state by itself, and why, without
 *  trailing newline. false: nothing, `text` is not changed. */
bool cm1e_sim_segment_news(cm1e_sim_segment_t *segment, char *text, size_t size);
/** The place of a slave that fell back since it was asked last; 0: none. */
uint32_t cm1e_sim_segment_fallen_back(cm1e_sim_segment_t *segment);

/* ---- what tests measure behind a drive (NULL-safe; position 1 = first; no motor there: zeros) ------------------- */

/** Rules of the bridge's guide that a master broke. What a real bridge makes of it nobody knows, so a good master
 *  breaks none: tests look at it. */
enum cm1e_sim_broken_rule {
    CM1E_SIM_MODE_TOO_SOON = 0x001,   /**< 0x6060 within 5 ms of the last time (BR 6.2.2, note 2) */
    CM1E_SIM_MODE_IN_MOTION = 0x002,  /**< ... while the motor moved (note 1) */
    CM1E_SIM_MODE_IN_ERROR = 0x004,   /**< ... with an error of the motor (BR appendix 3) */
    CM1E_SIM_MODE_NO_WAY = 0x008,     /**< ... where the drawing of BR 6 has no way, or the motor has been in CMD or
                                           CPIO and is to follow targets in csp (note 2) */
    CM1E_SIM_QUICK_STOP = 0x010,      /**< "Do not send Quick Stop command" (BR 6.1.1) */
    CM1E_SIM_STEP_AT_START = 0x020,   /**< the target was not the actual position when the motor began to follow it */
    CM1E_SIM_STEP_IN_CYCLE = 0x040,   /**< further from one target to the next than the motor's peak speed carries */
    CM1E_SIM_CML_LINE_BUSY = 0x080,   /**< a string without 0000h for five cycles before it (BR appendix 2) */
    CM1E_SIM_CML_TOO_SOON = 0x100,    /**< a string less than 4 or 8 ms after the last (BR 7.2.2) */
    CM1E_SIM_CML_LINE_END = 0x200,    /**< a string with CR or LF (BR 7.2.2) */
    CM1E_SIM_OUTPUT_IN_VAIN = 0x400,  /**< 0x60FE where it does nothing: not in csp, or no power (BR 6.5) */
    CM1E_SIM_HOMING_TOO_SOON = 0x800, /**< homing within 100 ms of its last setting (BR appendix 4.1) */
};

typedef struct cm1e_sim_probe {
    double position_counts;   /**< of the shaft, exact, since the start (homing does not change it); behind a bridge
                                   pulses by the motor's K37 */
    double velocity_counts_per_s;
    double torque_nm;         /**< motor torque */
    bool torque_on;           /**< the output stage is on (Section C, UG 6.1.1); behind a bridge: not motor free */
    uint16_t statusword, controlword;
    uint16_t error_code;      /**< 0x603F; behind a bridge the motor's error as in F530:5 ... 8, 0: none */
    int8_t mode;
    uint16_t digital_inputs, digital_outputs;
    double peak_velocity_counts_per_s; /**< largest absolute value since the last cm1e_sim_probe_reset() */
    double travel_counts;     /**< sum of absolute movement since the last reset */
    unsigned broken_rules;    /**< behind a bridge: cm1e_sim_broken_rule since the last reset */
} cm1e_sim_probe_t;
/** Of a CM1-E. */
void cm1e_sim_probe(cm1e_sim_segment_t *segment, uint32_t position, cm1e_sim_probe_t *probe);
void cm1e_sim_probe_reset(cm1e_sim_segment_t *segment, uint32_t position);
/** Of the motor at channel 1 ... 4 of a bridge; channel 0: of a CM1-E. */
void cm1e_sim_probe_channel(cm1e_sim_segment_t *segment, uint32_t position, unsigned channel, cm1e_sim_probe_t *probe);
void cm1e_sim_probe_reset_channel(cm1e_sim_segment_t *segment, uint32_t position, unsigned channel);

#endif
