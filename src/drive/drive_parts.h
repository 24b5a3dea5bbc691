/**
 * @file drive_parts.h
 * The data of a drive: a struct for each of its parts, and the drive, which is made of them. Any source may read a
 * part; only the sources that its comment names write it (test `structs`).
 */
#ifndef CM1E_DRIVE_DRIVE_PARTS_H
#define CM1E_DRIVE_DRIVE_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include "bus/bus_image.h"
#include "cia402/cia402.h"
#include "cm1e/bus.h"
#include "device/devices.h"
#include "drive/drive_command.h"

/** What the caller wants of the drive; written every cycle before cm1e_drive_write(). */
typedef struct cm1e_drive_command {
    bool enable;                    /**< Operation enabled, if possible */
    bool reset;                     /**< rising edge: one fault reset attempt */
    cm1e_mode_t mode;               /**< CSP, CSV, PP, PV or HM; behind a bridge CSP, HM, or one of the other values of
                                         cm1e_bridge_mode_t */
    int32_t target_position;        /**< counts; CSP, PP. Used only while `enabled` is true */
    int32_t target_velocity;        /**< counts/s; CSV, PV */
    int32_t position_step;          /**< counts; CSP: the target moves by no more in a cycle. 0: no limit */
    int32_t velocity_step;          /**< counts/s; CSV: after lost frames the target changes by no more in a cycle until
                                         it is the commanded one again. 0: no limit */
    bool homing_start;              /**< HM: rising edge starts, false ends (controlword bit 4) */
    bool halt;                      /**< PP, PV, HM: controlword bit 8; behind a bridge there is none */
    uint16_t digital_outputs;       /**< 0x60FE; behind a bridge by SDO, bit 0: output 1 */
    bool mode_insist;               /**< behind a bridge: csp by way of CML after CMD or CPIO, though it "will possibly
                                         result in operating abnormal" (BR 6 note 2) */
} cm1e_drive_command_t;

/** What the drive shows, fresh after cm1e_drive_read(). Written by drive.c, drive_digital.c, drive_io.c,
 *  drive_ordinary.c and drive_virtual.c. */
typedef struct cm1e_drive_feedback {
    bool online;                    /**< the inputs of this cycle are valid, and the bus is well */
    bool fresh;                     /**< the inputs are of this cycle, though something on the bus may be wrong; and
                                         the motor can have come to the position that they show */
    uint16_t statusword, error_code;
    cm1e_fsa_state_t state;
    int8_t mode;                    /**< 0x6061 */
    int32_t position;               /**< counts, wraps */
    int32_t velocity;               /**< counts/s, whatever the firmware's unit; where the mapping lacks it or the
                                         firmware shows it wrong: from the difference of two positions */
    int16_t torque;                 /**< 0.1 % of rated torque */
    uint16_t digital_inputs;        /**< bit 0: input 1 */
    bool digital_known;             /**< they are mapped, or were read a short time ago (behind a bridge) */
    int16_t temperature;            /**< degrees C */
    int32_t dc_link_decivolt;
    bool enabled;                   /**< Operation enabled and in the commanded mode: set-points act */
    bool voltage;                   /**< motor power is on (statusword bit 4), or the drive does not say */
    bool fault;
    bool motor_free;                /**< behind a bridge: no torque, whatever the state says (statusword bit 15) */
    bool target_reached, bit12, bit13; /**< per mode: UG 6.2 */
} cm1e_drive_feedback_t;

/** Why the drive stopped being enabled, or did not become so. Latched; cleared by a successful reset. Written by
 *  drive_bridge.c, drive_fault.c, drive_reset.c and drive_virtual.c. */
typedef struct cm1e_drive_fault {
    cm1e_error_t error;             /**< CM1E_OK: none */
    uint16_t device_code;           /**< 0x603F at that moment, 0: none */
    uint16_t statusword;
    int8_t mode_commanded, mode_shown;
    uint16_t al_state, al_status_code;
    uint16_t missing;               /**< position of another slave that took no part in the cycle, then or later; 0:
                                         none */
    uint8_t motor_status;           /**< behind a bridge: F530:5 ... 8, read when the motor showed an error */
    bool motor_status_known : 1;    /**< `motor_status` is valid */
    bool slave_lost : 1;            /**< the slave did not answer at its address, then or later */
    bool slave_absent : 1;          /**< the slave took no part in the cycle, then or later */
    bool keeps_torque : 1;          /**< the drive did not obey when it was told to have none, then or later */
    bool turned : 1;                /**< the mode was not written, because the motor was not at rest */
} cm1e_drive_fault_t;

typedef struct cm1e_drive_encoder {
    uint32_t counts;
    bool valid;
} cm1e_drive_encoder_t;

/** Where the objects lie in the process image, and what those carry there that no cycle commands. Written by
 *  drive_io.c. */
typedef struct cm1e_drive_image {
    cm1e_image_slot_t in_statusword, in_error, in_position, in_velocity, in_torque, in_digital, in_temperature, in_dc,
        in_mode;
    cm1e_image_slot_t out_controlword, out_position, out_velocity, out_mode, out_digital, out_profile_velocity,
        out_profile_acceleration;
    cm1e_image_slot_t out_probe, in_probe;
    uint32_t profile_velocity, profile_acceleration; /**< what 0x6081 and 0x6083 carry where they are mapped */
    cm1e_image_slot_t in_latched[4]; /**< touch probe of the drive: edges of probe 1, of probe 2 */
} cm1e_drive_image_t;

/** Offsets of the objects that a cycle needs, where the mapping has all of them, each with its usual size, and no
 *  others that a cycle writes. Written by drive_io.c. */
typedef struct cm1e_drive_wire {
    bool known;                     /**< the mapping is such a one */
    uint32_t in, out;               /**< of the statusword and the controlword, in the image */
    /** From `in`. */
    uint8_t in_error, in_position, in_velocity, in_torque, in_digital, in_temperature, in_dc, in_mode;
    uint8_t out_digital, out_position, out_velocity, out_mode; /**< from `out` */
} cm1e_drive_wire_t;

/** An ordinary cycle: the torque acts, and set positions are followed (drive_ordinary.c). Written by drive.c,
 *  drive_fault.c and drive_ordinary.c. */
typedef struct cm1e_drive_ordinary {
    bool calm;                      /**< the last cycle was one, and nothing has happened since */
    uint16_t controlword;           /**< of these cycles */
    int64_t elapsed_ns;             /**< for which the next two are computed */
    int64_t farthest, tolerance;    /**< counts: way that the motor can have gone in that time, tolerance of the way
                                         that its velocity makes in it */
} cm1e_drive_ordinary_t;

/** What this motor can do, in counts: known when the drive is made. Written by drive.c, drive_bridge.c, drive_cia402.c,
 *  drive_cm1e.c and drive_virtual.c. */
typedef struct cm1e_drive_range {
    int64_t velocity_possible;      /**< counts/s: no motor of this kind is faster */
    int64_t velocity_believed;      /**< counts/s: the largest that is measured from positions */
    int32_t velocity_most;          /**< of 0x60FF, in units of it */
    int32_t position_least, position_most; /**< what may be a target */
    int16_t velocity_unit;          /**< counts/s per unit of 0x60FF and 0x606C */
    bool velocity_quarter;          /**< 0x606C is wrong in HM and PP */
} cm1e_drive_range_t;

/** Whether the actual position can be believed. Written by drive_io.c, drive_ordinary.c and drive_virtual.c. */
typedef struct cm1e_drive_actual {
    int64_t read_ns;                /**< time of the cycle of the last good one */
    int64_t sent_ns;                /**< time of the frame that brought it */
    bool seen;                      /**< inputs were valid at least once */
    uint8_t rejected;               /**< in a row: positions that the motor cannot have reached */
    uint8_t contradictions;         /**< positions that contradicted the actual velocity, less those that agreed */
    uint8_t distrusted;             /**< good positions still to come before torque is requested */
} cm1e_drive_actual_t;

/** The set-point on the wire. Written by drive.h, drive.c, drive_io.c, drive_ordinary.c and drive_virtual.c. */
typedef struct cm1e_drive_target {
    int32_t position;               /**< last one written */
    int32_t velocity;               /**< last one written, counts/s */
    int32_t set_point;              /**< PP: the target position that bit 4 announced */
    bool set_point_bit;             /**< PP: controlword bit 4 */
    bool holds;                     /**< the position was the caller's, and the drive is still seen holding one */
    bool late;                      /**< without torque: the next target comes cycles after the inputs that it is
                                         made of */
    bool slewing;                   /**< CSV: the velocity is not yet the commanded one after lost frames */
} cm1e_drive_target_t;

/** The mode of operation, commanded and shown, and what follows from both. Written by drive_io.c and
 *  drive_virtual.c. */
typedef struct cm1e_drive_mode {
    const cm1e_device_words_t *words; /**< of the mode that is shown */
    const cm1e_device_mode_t *shown;  /**< NULL: 0x6061 is none of its modes, or not known */
    const cm1e_device_mode_t *wanted; /**< that of `commanded` */
    cm1e_mode_t commanded;          /**< on the wire; follows `command.mode` once the last switch is shown */
    bool may_hold, holds;           /**< of the mode shown: a target position may act, acts */
    bool takes_torque;              /**< the commanded mode has torque, and its words are those of the mode shown */
    bool marked;                    /**< the controlword carries more than the state: words->mark, outputs */
    bool operates;                  /**< Operation enabled, and the motor is not free */
} cm1e_drive_mode_t;

/** A switch of mode, and 0x6060 and 0x6061 over SDO where the mapping lacks them. Written by drive_mode.c. */
typedef struct cm1e_drive_change {
    uint8_t phase;
    int8_t data, shown;             /**< shown: stands for 0x6061 where that is not mapped */
    int8_t read;                    /**< the last value of 0x6061, also during a switch */
    int8_t wrote;                   /**< the last value of 0x6060 */
    bool known;                     /**< 0x6061 was read after the device may have been switched off */
    bool uncertain;                 /**< 0x6060 was written, and 0x6061 has not shown it yet */
    bool abnormal;                  /**< behind a bridge: was in CMD or CPIO since power-on, as far as is known */
    int64_t deadline_ns, retry_ns;
    int64_t from_ns;                /**< 0x6060 may be written from then on */
    int64_t write_ns;               /**< when the last 0x6060 was written */
    cm1e_sdo_t sdo;
} cm1e_drive_change_t;

/** The torque that is requested. Written by drive.c, drive_mode.c, drive_reset.c and drive_virtual.c. */
typedef struct cm1e_drive_torque {
    bool asked;                     /**< by the last write */
    bool was_enabled;               /**< Operation enabled was seen since torque was requested */
    bool confirmed : 1;             /**< the commanded mode was shown in Operation enabled */
    bool gives_up : 1;              /**< it was given torque, and has not shown since then that it has none */
} cm1e_drive_torque_t;

/** Times on the way to torque. Written by drive.c. */
typedef struct cm1e_drive_waits {
    int64_t enable_deadline_ns, torque_from_ns;
    int64_t blocked_ns;             /**< since when torque is requested in a mode that has none */
    int64_t kept_ns;                /**< since when it shows torque that it was told to give up, and does not brake;
                                         0: no */
} cm1e_drive_waits_t;

/** A fault reset. Written by drive_private.h and drive_reset.c. */
typedef struct cm1e_drive_reset {
    uint8_t phase;
    bool before;                    /**< `command.reset` of the cycle before */
    int64_t until_ns, deadline_ns, settle_ns, recovery_ns;
} cm1e_drive_reset_t;

/** A touch probe of the drive's own (0x60B8). Edges are bits: 1 rising, 2 falling. */
typedef struct cm1e_drive_probe {
    uint8_t wanted;                 /**< edges that are waited for */
    uint8_t taken;                  /**< edges that were seen since they were armed */
    bool on;                        /**< the enable bit is set. It is off after arming until the drive shows that: its
                                         next rise arms the probe anew */
    int32_t positions[2];           /**< counts: rising, falling */
} cm1e_drive_probe_t;

/** What only a drive of another maker has: its touch probes, and what it is told of the cycle, again after it was away.
 *  Written by drive_cia402.c. */
typedef struct cm1e_drive_foreign {
    uint16_t probe_function;        /**< 0x60B8 */
    cm1e_drive_probe_t probe[2];
    uint8_t told;                   /**< object that is told next */
    uint8_t data[4];
    cm1e_sdo_t sdo;
} cm1e_drive_foreign_t;

/** The order is that of the memory: what every cycle looks at comes first, and lies together. */
typedef struct cm1e_drive {
    cm1e_bus_t *bus;
    int64_t now_ns;
    const cm1e_device_drive_t *kind;
    void (*step)(struct cm1e_drive *drive); /**< of the kind; NULL: nothing */
    uint16_t position;              /**< slave; 0: there is no device */
    uint8_t offline;                /**< cycles, up to some */
    cm1e_slave_watch_t watch;
    uint32_t bound;                 /**< cm1e_slave_watch_t.bound that the image was resolved for */
    cm1e_error_t unbound;           /**< why the slave that came cannot be this drive; CM1E_OK: it can */
    bool answered;                  /**< the last frame came back, with every slave's part in it */
    cm1e_drive_torque_t torque;
    cm1e_drive_wire_t wire;
    cm1e_drive_ordinary_t ordinary;
    cm1e_drive_mode_t mode;
    cm1e_drive_actual_t actual;
    cm1e_drive_range_t range;
    cm1e_drive_command_t command;
    cm1e_drive_feedback_t feedback;
    cm1e_drive_target_t target;
    cm1e_drive_image_t image;
    cm1e_drive_fault_t fault;
    cm1e_drive_reset_t reset;
    /* not in every cycle */
    cm1e_drive_encoder_t encoder;   /**< of an encoder, as the program has written it since the last cycle */
    cm1e_drive_waits_t waits;
    cm1e_drive_change_t change;
    uint32_t looks;                 /**< cm1e_bus_slave_looks() when it was offline last, for more than some cycles */
    uint32_t axis;                  /**< index in the configuration */
    const cm1e_axis_config_t *config;
    const cm1e_device_t *device;    /**< NULL: there is none */
    const cm1e_motor_t *motor;      /**< NULL behind a bridge */
    const cm1e_firmware_info_t *firmware;
    struct cm1e_drive_bridge *behind; /**< what a motor behind a bridge has beside this; else NULL */
    cm1e_drive_foreign_t *foreign;  /**< what a drive of another maker has beside this; else NULL */
    struct cm1e_drive_wiring *wiring; /**< signals of other slaves (drive_wiring.h); NULL: none */
} cm1e_drive_t;

#endif
