/**
 * @file drive_private.h
 * What the sources of the drive room share. Everything here is called in the cycle unless marked otherwise.
 */
#ifndef CM1E_DRIVE_DRIVE_PRIVATE_H
#define CM1E_DRIVE_DRIVE_PRIVATE_H

#include <stdlib.h>

#include "core/clock.h"
#include "device/unit.h"
#include "drive/drive_bridge.h"

/** Phases of a fault reset (drive_reset.c). */
enum { RESET_IDLE = 0, RESET_WAIT_ONLINE, RESET_EDGE, RESET_RELEASED };

/** After this cause the drive may still have torque and receive targets, so a ramp makes sense. */
static inline bool drive_fault_allows_ramp(cm1e_error_t error)
{
    return error == CM1E_ERROR_BUS_LOST || error == CM1E_ERROR_BUS_WORKING_COUNTER ||
           error == CM1E_ERROR_DRIVE_POSITION;
}

/** The slave is optional and not there. */
static inline bool cm1e_drive_is_absent(const cm1e_drive_t *drive)
{
    return cm1e_bus_slave_watch(drive->bus, drive->position).absent;
}

/* drive_fault.c */
/** Latches what this cycle's inputs show. A latched fault only collects its details. */
void cm1e_drive_latch_faults(cm1e_drive_t *drive);

/* drive_cm1e.c */
cm1e_error_t cm1e_drive_init_cm1e(cm1e_drive_t *drive, cm1e_diag_t *diag);
cm1e_error_t cm1e_drive_bind_cm1e(cm1e_drive_t *drive);

/* drive_io.c */
/** Where the object of a role lies in the process image. */
const cm1e_image_slot_t *cm1e_drive_slot(const cm1e_drive_t *drive, cm1e_role_t role);
cm1e_error_t cm1e_drive_resolve(cm1e_drive_t *drive, cm1e_diag_t *diag);
void cm1e_drive_decode(cm1e_drive_t *drive);
/** Commands a mode on the wire. The drive keeps what every cycle needs of the tables. */
void cm1e_drive_want_mode(cm1e_drive_t *drive, const cm1e_device_mode_t *row);
void cm1e_drive_encode(cm1e_drive_t *drive, uint16_t controlword, int32_t position, int32_t velocity);
/** A target velocity in counts/s as 0x60FF has it. */
int32_t cm1e_drive_velocity_on_wire(const cm1e_drive_t *drive, int32_t counts_per_s);
/** How far position and velocity may differ after a time, by their ages; counts. */
int64_t cm1e_drive_tolerance(const cm1e_drive_t *drive, int64_t elapsed_ns);
/** Whether position and velocity contradict each other: the motor has gone `way` counts, and `told` by its velocity. */
static inline bool cm1e_drive_ways_differ(int64_t way, int64_t told, int64_t tolerance)
{
    return llabs(way - told) > llabs(told) / 2 + tolerance;
}
/** Whether a position may be a target. */
static inline bool cm1e_drive_in_range(const cm1e_drive_t *drive, int32_t position)
{
    return position >= drive->range.position_least && position <= drive->range.position_most;
}
/** From a position to another one, over the wrap-around of the counts. */
static inline int64_t cm1e_drive_way_between(int32_t from, int32_t to)
{
    return (int32_t)((uint32_t)to - (uint32_t)from);
}
static inline int32_t cm1e_drive_clamp(int64_t value)
{
    return (int32_t)(value > INT32_MAX ? INT32_MAX : value < INT32_MIN ? INT32_MIN : value);
}

/* drive_ordinary.c */
/** Whether the cycle that was written just now with this controlword is followed by ordinary ones, unless something
 *  happens. */
void cm1e_drive_note_calm(cm1e_drive_t *drive, uint16_t controlword);

/* drive_mode.c */
cm1e_error_t cm1e_drive_mode_init(cm1e_drive_t *drive, cm1e_diag_t *diag);
void cm1e_drive_mode_step(cm1e_drive_t *drive);
/** Takes over `command.mode` when the last switch is confirmed. */
void cm1e_drive_mode_choose(cm1e_drive_t *drive);
/** Requires the mode to be shown again, because the device may have been switched off. */
void cm1e_drive_mode_forget(cm1e_drive_t *drive);

/* drive_reset.c */
/** Rising edge of `command.reset`. */
static inline bool cm1e_drive_reset_asked(cm1e_drive_t *drive)
{
    const bool asked = drive->command.reset && !drive->reset.before;
    drive->reset.before = drive->command.reset;
    return asked;
}
void cm1e_drive_reset_start(cm1e_drive_t *drive);
void cm1e_drive_reset_step(cm1e_drive_t *drive);

/* drive_cia402.c: a servo drive of another maker */
cm1e_error_t cm1e_drive_init_cia402(cm1e_drive_t *drive, cm1e_diag_t *diag);
void cm1e_drive_cia402_step(cm1e_drive_t *drive);

/* drive_virtual.c: without a device */
cm1e_error_t cm1e_drive_init_virtual(cm1e_drive_t *drive);
void cm1e_drive_virtual_read(cm1e_drive_t *drive);
void cm1e_drive_virtual_write(cm1e_drive_t *drive);

/* drive_bridge.c: what a motor behind a bridge has beside this, in drive_command.c, drive_digital.c ... */
cm1e_error_t cm1e_drive_init_bridge(cm1e_drive_t *drive, cm1e_diag_t *diag);
void cm1e_drive_bridge_step(cm1e_drive_t *drive);
/** Whether the motor has been at rest for some time, as far as 0x6064 shows. */
bool cm1e_drive_rests(const cm1e_drive_t *drive);
/** Whether F530 says that the motor has no error. Asks for F530 and returns false until it is answered. An answer holds
 *  for some cycles. */
bool cm1e_drive_bridge_sound(cm1e_drive_t *drive);

/* drive_command.c */
void cm1e_drive_cmd_step(cm1e_drive_t *drive);
/** The controlword in CMD. */
uint16_t cm1e_drive_cmd_word(const cm1e_drive_t *drive);
/** Whether a command is under way, or its effect may still move the motor. */
static inline bool cm1e_drive_cmd_moves(const cm1e_drive_t *drive)
{
    return drive->behind && (drive->behind->cmd.may_search || cm1e_drive_cmd_busy(drive->behind->cmd.state));
}

/* drive_digital.c */
void cm1e_drive_digital_step(cm1e_drive_t *drive);
/** Forgets the outputs, because the device may have been switched off. */
void cm1e_drive_digital_forget(cm1e_drive_t *drive);

#endif
