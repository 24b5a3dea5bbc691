/**
 * @file drive.h
 * One CiA 402 drive in one slave: its process data by name, its state machine, mode switching, homing, fault reset, and
 * faults in words. Counts and counts/s; units and motion belong to the axis. The cycle thread owns it. A virtual axis
 * and an encoder have a drive too, without a device (drive_virtual.c), so that the axis above is the same.
 *
 * Rules kept here whatever the caller asks: the drive goes to Operation enabled only with target position = actual
 * position and target velocity = 0; a fault reset is one short edge; nothing is re-enabled by itself after a fault.
 *
 * A latched fault takes the torque away until a reset succeeded, with one exception: after CM1E_ERROR_BUS_LOST and
 * CM1E_ERROR_BUS_WORKING_COUNTER the drive stays enabled while `enable` stays TRUE, so that the caller can stop a drive
 * that may still listen. A reset that succeeds while `enable` is TRUE enables again: who does not want that takes
 * `enable` away first.
 *
 * What the drive holds is known as long as every frame comes back with every slave's part in it. After a cycle without
 * that, the drive may hold the target of any frame sent since then. A target position (CSP) is therefore repeated
 * until a frame has come back: whichever frame is heard next, it carries at most the step that was planned for one cycle.
 * A target velocity (CSV) may still be reduced.
 */
#ifndef CM1E_DRIVE_DRIVE_H
#define CM1E_DRIVE_DRIVE_H

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
    int32_t target_position;        /**< counts; CSP, PP. Used only while `enabled` is TRUE */
    int32_t target_velocity;        /**< counts/s; CSV, PV */
    int32_t position_step;          /**< counts; CSP: the target moves by no more in a cycle. 0: no limit */
    int32_t velocity_step;          /**< counts/s; CSV: after lost frames the target changes by no more in a cycle until
                                         it is the commanded one again. 0: no limit */
    bool homing_start;              /**< HM: rising edge starts, FALSE ends (controlword bit 4) */
    bool halt;                      /**< PP, PV, HM: controlword bit 8; behind a bridge there is none */
    uint16_t digital_outputs;       /**< 0x60FE; behind a bridge by SDO, bit 0: output 1 */
    bool mode_insist;               /**< behind a bridge: csp by way of CML after CMD or CPIO, though it "will possibly
                                         result in operating abnormal" (BR 6 note 2) */
} cm1e_drive_command_t;

/** What the drive shows, fresh after cm1e_drive_read(). */
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

/** Why the drive stopped being enabled, or did not become so. */
typedef struct cm1e_drive_fault {
    cm1e_error_t error;             /**< CM1E_OK: none */
    uint16_t device_code;           /**< 0x603F at that moment, 0: none */
    uint16_t statusword;
    int8_t mode_commanded, mode_shown;
    uint16_t al_state, al_status_code;
    bool slave_lost;                /**< the slave did not answer at its address, then or later */
    bool slave_deaf;                /**< the slave took no part in the cycle, then or later */
    uint8_t motor_status;           /**< behind a bridge: F530:5 ... 8, read when the motor showed an error */
    bool motor_status_known;        /**< `motor_status` is valid */
} cm1e_drive_fault_t;

typedef struct cm1e_drive_encoder {
    uint32_t counts;
    bool valid;
} cm1e_drive_encoder_t;

/** A touch probe of the drive's own (0x60B8). Edges are bits: 1 rising, 2 falling. */
typedef struct cm1e_drive_probe {
    uint8_t wanted;                 /**< edges that are waited for */
    uint8_t taken;                  /**< edges whose position was not fetched yet */
    bool on;                        /**< the enable bit is set */
    bool clearing;                  /**< the enable bit is off until the drive shows that: its next rise arms the
                                         probe anew */
    int32_t positions[2];           /**< counts: rising, falling */
} cm1e_drive_probe_t;

/** Members that every cycle uses come first. */
typedef struct cm1e_drive {
    cm1e_bus_t *bus;
    int64_t now_ns;
    uint16_t position;              /**< slave; 0: there is no device */
    cm1e_slave_watch_t watch;
    cm1e_drive_command_t command;
    cm1e_drive_feedback_t feedback;
    cm1e_drive_fault_t fault;       /**< latched; cleared by a successful reset */
    cm1e_drive_encoder_t encoder;   /**< of an encoder, as the program has written it since the last cycle */
    /* private: drive_io.c, drive.c, drive_mode.c, drive_reset.c */
    cm1e_image_slot_t in_statusword, in_error, in_position, in_velocity, in_torque, in_digital, in_temperature, in_dc,
        in_mode;
    cm1e_image_slot_t out_controlword, out_position, out_velocity, out_mode, out_digital, out_profile_velocity,
        out_profile_acceleration;
    int32_t velocity_unit;          /**< counts/s per unit of 0x60FF and 0x606C */
    int32_t velocity_most;          /**< of 0x60FF, in that unit */
    int64_t velocity_believed;      /**< counts/s: the largest that is measured from positions */
    int64_t velocity_possible;      /**< counts/s: no motor of this kind is faster */
    uint32_t profile_velocity, profile_acceleration; /**< what 0x6081 and 0x6083 carry where they are mapped */
    int64_t read_ns;
    int32_t target_position;        /**< last one written */
    int32_t target_velocity;        /**< last one written, counts/s */
    int32_t position_least, position_most; /**< what may be a target */
    void (*step)(struct cm1e_drive *drive); /**< of the kind; NULL: nothing */
    int32_t set_point;              /**< PP: the target position that bit 4 announced */
    cm1e_mode_t mode;               /**< commanded on the wire; follows `command.mode` once the last switch is shown */
    bool velocity_quarter;          /**< 0x606C is wrong in HM and PP */
    bool target_holds;              /**< the target was the caller's, and the drive is still seen holding a position */
    bool may_hold, holds;           /**< of the mode shown: a target position may act, acts */
    bool takes_torque;              /**< the commanded mode has torque, and its words are those of the mode shown */
    bool marked;                    /**< the controlword carries more than the state: words->mark, outputs */
    bool operates;                  /**< Operation enabled, and the motor is not free */
    bool seen;                      /**< inputs were valid at least once */
    bool torque;                    /**< the last write asked for torque */
    bool was_enabled;               /**< Operation enabled was seen since torque is asked for */
    bool mode_confirmed;
    uint8_t positions_rejected;     /**< in a row: actual positions that the motor cannot have come to */
    uint8_t contradictions;         /**< actual positions that contradicted the actual velocity, less those that
                                         agreed */
    uint8_t distrusted;             /**< good positions that are still to come before torque is asked for */
    bool answered;                  /**< the last frame came back, with every slave's part in it */
    bool slewing;                   /**< CSV: the target velocity is not yet the commanded one after lost frames */
    bool set_point_bit;             /**< PP: controlword bit 4 */
    bool reset_before;
    uint8_t reset_phase, mode_phase;
    int8_t mode_data, mode_shown;

    const cm1e_device_t *device;    /**< NULL: there is none */
    const cm1e_device_drive_t *kind;
    const cm1e_device_words_t *words; /**< of the mode that is shown */
    const cm1e_device_mode_t *shown;  /**< NULL: 0x6061 is none of its modes, or not known */
    const cm1e_device_mode_t *wanted; /**< that of `mode` */
    int64_t enable_deadline_ns, mode_deadline_ns, torque_from_ns;
    int64_t reset_until_ns, reset_deadline_ns, reset_settle_ns, recovery_ns, mode_retry_ns;
    cm1e_sdo_t mode_sdo;            /**< 0x6060 and 0x6061 where the mapping lacks them */
    int64_t mode_write_ns;          /**< when the last 0x6060 was written */
    int8_t mode_read;               /**< the last value of 0x6061, also during a switch */
    bool mode_known;                /**< 0x6061 was read after the device may have been switched off */
    bool mode_uncertain;            /**< 0x6060 was written, and 0x6061 has not shown it yet */
    bool abnormal;                  /**< behind a bridge: was in CMD or CPIO since power-on, as far as is known */
    int64_t mode_from_ns;           /**< 0x6060 may be written from then on */
    int64_t blocked_ns;             /**< since when torque is requested in a mode that has none */
    uint32_t axis;                  /**< index in the configuration */
    const cm1e_axis_config_t *config;
    const cm1e_motor_t *motor;      /**< NULL behind a bridge */
    const cm1e_firmware_info_t *firmware;
    cm1e_image_slot_t out_probe, in_probe, in_latched[4]; /**< touch probe of the drive: edges of probe 1, of probe 2 */
    uint16_t probe_function;        /**< 0x60B8 */
    cm1e_drive_probe_t probe[2];
    struct cm1e_drive_bridge *behind; /**< what a motor behind a bridge has beside this; else NULL */
} cm1e_drive_t;

/** Resolves the objects of the mapping. A mapping that lacks an object the configured use needs is
 *  CM1E_ERROR_PDO_MAPPING naming the object; an unreadable firmware version with no unit stated is CM1E_ERROR_CONFIG,
 *  as is a motor behind a bridge without its K37. CM1E_ERROR_STATE: it is found in a mode without a way back to csp.
 *  @rt init */
cm1e_error_t cm1e_drive_init(cm1e_drive_t *drive, cm1e_bus_t *bus, uint32_t axis, cm1e_diag_t *diag);
/** Frees what cm1e_drive_init() made, also where it failed. After cm1e_bus_stop(), which ends the transfers of the
 *  drive that wait: they would end in this memory. @rt init */
void cm1e_drive_free(cm1e_drive_t *drive);
/** Decodes the inputs of this cycle; `bus_ok` FALSE: they are old. Latches faults. @rt cycle */
void cm1e_drive_read(cm1e_drive_t *drive, bool bus_ok, int64_t now_ns);
/** Encodes the outputs from `command` under the rules above. @rt cycle */
void cm1e_drive_write(cm1e_drive_t *drive);
/** Latches a fault that the caller saw (the bus is lost ...); an earlier one stays. @rt cycle */
void cm1e_drive_fail(cm1e_drive_t *drive, cm1e_error_t error);
/** Whether the actual position has moved for some cycles by another distance than the actual velocity says: one of them
 *  is wrong. @rt cycle */
static inline bool cm1e_drive_contradicts_itself(const cm1e_drive_t *drive) { return drive->contradictions >= 3; }
/** Whether the target velocity (CSV) is on its way back to the commanded one, by command.velocity_step per cycle. @rt
 *  cycle */
static inline void cm1e_drive_slew(cm1e_drive_t *drive) { drive->slewing = true; }
/** TRUE while a commanded reset is under way. @rt cycle */
bool cm1e_drive_resetting(const cm1e_drive_t *drive);
/** Whether the slave answers and is in Operational, as far as the supervision has seen. @rt cycle */
static inline bool cm1e_drive_operational(const cm1e_drive_t *drive)
{
    return !drive->watch.lost && (drive->watch.al_state == CM1E_AL_NONE || drive->watch.al_state == CM1E_AL_OP);
}
/** Whether there is no device: the axis is virtual, or an encoder. @rt any */
static inline bool cm1e_drive_is_virtual(const cm1e_drive_t *drive) { return drive->position == 0; }
/** On the wire, the index of an object that the dictionary of a first axis has at `index`; what is the device's and no
 *  axis's stays where it is. @rt any */
static inline uint16_t cm1e_drive_index(const cm1e_drive_t *drive, uint16_t index)
{
    const unsigned channel = drive->config->channel;
    const bool of_axis = channel != 0 && index >= 0x6000 && index < 0x6000 + CM1E_BRIDGE_INDEX_INCREMENT;
    return (uint16_t)(index + (of_axis ? (channel - 1) * CM1E_BRIDGE_INDEX_INCREMENT : 0));
}
/** The dictionary's entry of an object of this drive, by the index that it has on a first axis; NULL: it has none, or
 *  one that is not available. @rt any */
const cm1e_entry_t *cm1e_drive_entry(const cm1e_drive_t *drive, uint16_t index, uint8_t subindex);

/** Whether the mapping allows a mode: its target is mapped. The mode itself goes over SDO where 0x6060 is not mapped.
 *  @rt cycle */
bool cm1e_drive_supports(const cm1e_drive_t *drive, cm1e_mode_t mode);
/** Whether the device can be switched to `mode` from the one it was last told. CM1E_ERROR_UNSUPPORTED: it has no such
 *  mode; CM1E_ERROR_STATE: no way leads there. `*why` (may be NULL) is a sentence then. A command for a mode that no
 *  way leads to is not carried out: the caller asks here first. @rt cycle */
cm1e_error_t cm1e_drive_mode_check(const cm1e_drive_t *drive, cm1e_mode_t mode, bool insist, const char **why);

/** "CSP", "HM", "CML" ...; NULL: none of its modes. @rt any */
const char *cm1e_drive_mode_name(const cm1e_drive_t *drive, int8_t mode);
/** The motor behind the bridge. @rt any */
cm1e_bridge_motor_t cm1e_drive_bridge_motor(const cm1e_drive_t *drive);

/** Behind a bridge digital signals go by SDO, in csp, while the motor is enabled (BR 6.5). Who reads inputs says so, as
 *  often as he reads: for a second from then on they are polled, and `feedback.digital_known` tells when they are
 *  fresh. Does nothing with other drives. @rt cycle */
void cm1e_drive_want_inputs(cm1e_drive_t *drive);
/** How `command.digital_outputs` stands with the motor. */
typedef enum cm1e_drive_outputs {
    CM1E_DRIVE_OUTPUTS_SET = 0,     /**< the outputs are as commanded (always, if they are process data) */
    CM1E_DRIVE_OUTPUTS_UNDER_WAY,
    CM1E_DRIVE_OUTPUTS_WAITING,     /**< the outputs cannot be written now: not enabled, not in csp, not on the bus */
    CM1E_DRIVE_OUTPUTS_FAILED,      /**< the last transfer ended with an error; it is repeated */
} cm1e_drive_outputs_t;
/** @rt cycle */
cm1e_drive_outputs_t cm1e_drive_outputs(const cm1e_drive_t *drive);
/** Whether digital signals are in the process data: in CPIO, and without a bridge. @rt cycle */
bool cm1e_drive_signals_in_cycle(const cm1e_drive_t *drive);
/** Bit 0: input 1, output 1. Those that can be reached from the bus: all of the mapping, or what the motor behind a
 *  bridge leaves to its user (BR 6.5). 0: none. @rt cycle */
uint16_t cm1e_drive_input_mask(const cm1e_drive_t *drive);
uint16_t cm1e_drive_output_mask(const cm1e_drive_t *drive);
/** The drive itself latches the position at this edge of input 1 or 2 (its touch probe 1 or 2), and the objects for it
 *  are mapped. @rt cycle */
bool cm1e_drive_has_probe(const cm1e_drive_t *drive, int input, bool falling);
/** Waits for the next edge; an edge of the same input that is waited for already is armed anew too. @rt cycle */
void cm1e_drive_probe_arm(cm1e_drive_t *drive, int input, bool falling);
void cm1e_drive_probe_disarm(cm1e_drive_t *drive, int input, bool falling);
/** true, once: the edge came, at `*position` counts. @rt cycle */
bool cm1e_drive_probe_taken(cm1e_drive_t *drive, int input, bool falling, int32_t *position);
/** The latched fault as sentences: cause, numbers, cure. @rt block */
void cm1e_drive_fault_text(const cm1e_drive_t *drive, char *text, size_t size);

#endif
