/**
 * @file axis_driving.h
 * Motions that a drive makes by itself.
 */
#ifndef CM1E_AXIS_AXIS_DRIVING_H
#define CM1E_AXIS_AXIS_DRIVING_H

#include "axis/axis_move.h"

typedef enum drive_step {
    DRIVE_WRITE = 0, /**< parameters; the axis still holds its position */
    DRIVE_SWITCH,    /**< to the mode of the motion */
    DRIVE_GO,        /**< the set-point is announced */
    DRIVE_MOVE,
    DRIVE_HALT,      /**< halt bit set, until the motor stands */
    DRIVE_RETURN,    /**< back to the axis's own mode */
} drive_step_t;

enum { DRIVE_PARAMETERS = 2 };

/** A motion that the drive does by itself. */
typedef struct driving {
    drive_step_t step;
    home_goal_t goal;
    bool velocity_mode;      /**< profile velocity instead of profile position */
    double way;              /**< sign of its direction, in u */
    int32_t target;          /**< counts of the drive */
    int32_t target_velocity; /**< counts/s */
    double speed, braking;   /**< counts/s, counts/s2 */
    uint32_t raw[DRIVE_PARAMETERS];
    uint8_t next;            /**< parameter to write next */
    bool submitted;
    uint8_t data[4];
    cm1e_sdo_t sdo;
    int64_t step_ns, quiet_ns; /**< when the step began; since when the motor stands */
    int32_t quiet_position;
} driving_t;

/* axis_drive_profile.c */
/** Checks a command that begins at standstill; nothing has changed then. */
cm1e_error_t cm1e_axis_drive_prepare(cm1e_axis_t *axis, const from_t *from, move_t *move, driving_t *d);
void cm1e_axis_drive_begin(cm1e_axis_t *axis, const driving_t *d);

#endif
