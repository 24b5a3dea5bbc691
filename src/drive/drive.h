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
 * CM1E_ERROR_BUS_WORKING_COUNTER the drive stays enabled while `enable` stays true, so that the caller can stop a drive
 * that may still listen. A reset that succeeds while `enable` is true enables again: a caller that does not want that
 * sets `enable` to false first.
 *
 * What the drive holds is known as long as every frame comes back with every slave's part in it. After a cycle without
 * that, the drive may hold the target of any frame sent since then. A target position (CSP) is therefore repeated
 * until a frame has come back: whichever frame is heard next, it carries at most the step that was planned for one
 * cycle. A target velocity (CSV) may still be reduced.
 */
#ifndef CM1E_DRIVE_DRIVE_H
#define CM1E_DRIVE_DRIVE_H

#include "drive/drive_parts.h"

/** Resolves the objects of the mapping. A mapping that lacks an object the configured use needs is
 *  CM1E_ERROR_PDO_MAPPING naming the object; an unreadable firmware version with no unit stated is CM1E_ERROR_CONFIG,
 *  as is a motor behind a bridge without its K37. CM1E_ERROR_STATE: it is found in a mode without a way back to csp.
 *  @rt init */
cm1e_error_t cm1e_drive_init(cm1e_drive_t *drive, cm1e_bus_t *bus, uint32_t axis, cm1e_diag_t *diag);
/** Frees what cm1e_drive_init() made, also if that failed. Call it after cm1e_bus_stop(), which ends the transfers of
 *  the drive that wait: they would end in this memory. @rt init */
void cm1e_drive_free(cm1e_drive_t *drive);
/** Decodes the inputs of this cycle; `bus_ok` false: they are old. Latches faults. @rt cycle */
void cm1e_drive_read(cm1e_drive_t *drive, bool bus_ok, int64_t now_ns);
/** Encodes the outputs from `command` under the rules above. @rt cycle */
void cm1e_drive_write(cm1e_drive_t *drive);
/** The short ways of these two in an ordinary cycle, after a good frame (drive_ordinary.c); false, and nothing has
 *  changed: it is none. After an ordinary read the drive is enabled and has no fault. @rt cycle */
bool cm1e_drive_read_ordinary(cm1e_drive_t *drive, int64_t now_ns);
bool cm1e_drive_write_ordinary(cm1e_drive_t *drive);
/** Latches a fault that the caller saw (the bus is lost ...); an earlier one stays. @rt cycle */
void cm1e_drive_fail(cm1e_drive_t *drive, cm1e_error_t error);
/** Whether the actual position has moved for some cycles by another distance than the actual velocity says: one of them
 *  is wrong. @rt cycle */
static inline bool cm1e_drive_contradicts_itself(const cm1e_drive_t *drive)
{
    return drive->actual.contradictions >= 3;
}
/** Time of the last frame, by which a motor that shows the same position has stood there. @rt cycle */
int64_t cm1e_drive_sent_ns(const cm1e_drive_t *drive);
/** Called when frames were not sent in time: what goes into the next one was decided by inputs that are cycles old. The
 *  drive does not get its torque by it. @rt cycle */
static inline void cm1e_drive_note_late(cm1e_drive_t *drive)
{
    drive->target.late = drive->feedback.state != OPERATION_ENABLED;
}
/** Whether the target velocity (CSV) is on its way back to the commanded one, by command.velocity_step per cycle. @rt
 *  cycle */
static inline void cm1e_drive_slew(cm1e_drive_t *drive) { drive->target.slewing = true; }
/** true while a commanded reset is under way. @rt cycle */
bool cm1e_drive_resetting(const cm1e_drive_t *drive);
/** Sets what 0x6081 or 0x6083 (`index`) carries from now on; false: it is not in the process data. @rt cycle */
bool cm1e_drive_carry(cm1e_drive_t *drive, uint16_t index, uint32_t raw);
/** Whether the slave answers and is in Operational, as far as the supervision has seen. @rt cycle */
static inline bool cm1e_drive_operational(const cm1e_drive_t *drive)
{
    return !drive->watch.lost && (drive->watch.al_state == CM1E_AL_NONE || drive->watch.al_state == CM1E_AL_OP);
}
/** Whether a reset has to bring the slave back: it is out of Operational, or does not answer, as a slave that was
 *  switched off and on does until then. An optional slave that is absent does not wait. @rt cycle */
static inline bool cm1e_drive_waits(const cm1e_drive_t *drive)
{
    return drive->position != 0 && !drive->watch.absent && !cm1e_drive_operational(drive);
}
/** Whether the drive shows a state in which its motor has torque, also one that nobody commanded. @rt cycle */
static inline bool cm1e_drive_shows_torque(const cm1e_drive_t *drive)
{
    return drive->feedback.state == OPERATION_ENABLED || drive->feedback.state == QUICK_STOP_ACTIVE;
}
/** Whether there is no device: the axis is virtual, or an encoder. @rt any */
static inline bool cm1e_drive_is_virtual(const cm1e_drive_t *drive) { return drive->position == 0; }
/** The index on the wire of an object that has `index` for the first axis of the device. Objects of the device itself
 *  keep their index. @rt any */
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
/** Whether the device can be switched to `mode` from its present one. CM1E_ERROR_UNSUPPORTED: it has no such mode;
 *  CM1E_ERROR_STATE: no way leads there. `*why` (may be NULL) is a sentence then. A command for a mode to which no way
 *  leads is ignored, so the caller checks it here first. @rt cycle */
cm1e_error_t cm1e_drive_mode_check(const cm1e_drive_t *drive, cm1e_mode_t mode, bool insist, const char **why);

/** "CSP", "HM", "CML" ...; NULL: none of its modes. @rt any */
const char *cm1e_drive_mode_name(const cm1e_drive_t *drive, int8_t mode);
/** The motor behind the bridge. @rt any */
cm1e_bridge_motor_t cm1e_drive_bridge_motor(const cm1e_drive_t *drive);

/** Behind a bridge digital signals go by SDO, in csp, while the motor is enabled (BR 6.5). A caller calls this at every
 *  read of an input: the inputs are polled for a second from then on, and `feedback.digital_known` tells whether they
 *  are fresh. It does nothing with other drives. @rt cycle */
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
/** The inputs and the outputs that can be reached from the bus, bit 0: number 1. They are those of the mapping, or
 *  those that the motor behind a bridge leaves to its user (BR 6.5). 0: none. @rt cycle */
uint16_t cm1e_drive_input_mask(const cm1e_drive_t *drive);
uint16_t cm1e_drive_output_mask(const cm1e_drive_t *drive);
/** How far a motor can have gone in this time, by the age of its positions; counts. Farther away than that its counts
 *  have another origin. Not for a drive without a device. @rt cycle */
int64_t cm1e_drive_farthest(const cm1e_drive_t *drive, int64_t elapsed_ns);
/** The drive itself latches the position at this edge of input 1 or 2 (its touch probe 1 or 2), and the objects for it
 *  are mapped. @rt cycle */
bool cm1e_drive_has_probe(const cm1e_drive_t *drive, int input, bool falling);
/** Waits for the next edge; an edge of the same input that is waited for already is armed anew too. @rt cycle */
void cm1e_drive_probe_arm(cm1e_drive_t *drive, int input, bool falling);
void cm1e_drive_probe_disarm(cm1e_drive_t *drive, int input, bool falling);
/** Whether the edge came since it was armed; `*position` is where, in counts. @rt cycle */
bool cm1e_drive_probe_taken(const cm1e_drive_t *drive, int input, bool falling, int32_t *position);
/** The latched fault as sentences: cause, numbers, cure. @rt block */
void cm1e_drive_fault_text(const cm1e_drive_t *drive, char *text, size_t size);

#endif
