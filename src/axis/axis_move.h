/**
 * @file axis_move.h
 * Commands as the axis keeps them, and where motions begin. What can be done with them is in axis_commands.h.
 */
#ifndef CM1E_AXIS_AXIS_MOVE_H
#define CM1E_AXIS_AXIS_MOVE_H

#include "axis/axis_kind.h"
#include "axis/axis_place.h"
#include "axis/axis_source.h"
#include "motion/profile.h"
#include "motion/table_profile.h"

enum { COMMANDS_REMEMBERED = 32 };

/** How a command ended. */
typedef struct command_record {
    cm1e_command_id_t id;
    int16_t error;      /**< cm1e_error_t */
    uint8_t state;      /**< cm1e_command_state_t */
} command_record_t;

/** A command as it is kept: what it asks for, and what is known of its way. */
typedef struct move {
    cm1e_command_id_t id;
    uint8_t kind, buffer_mode, direction; /**< cm1e_command_kind_t, MC_BUFFER_MODE, MC_DIRECTION */
    bool passing : 1;       /**< MOVE_CONTINUOUS_*: only its end velocity is left to be reached, not its position */
    bool paused : 1;        /**< an override of velocity 0: it brakes to a standstill and waits */
    double position, velocity, end_velocity, acceleration, deceleration, jerk;
    double shift;           /**< u; how far MC_SetPosition has moved the coordinates since the position was given */
    position_t origin;      /**< what a relative position counts from */
    position_t target;      /**< where it ends */
    double exit_velocity;   /**< u/s, signed: with which it passes its target, because another one goes on from there */
} move_t;

/** Commands that wait behind the active one, in their order: a ring. */
typedef struct buffer {
    move_t moves[CM1E_AXIS_BUFFER_DEPTH];
    uint8_t first, count;
} buffer_t;

/** The points of a table profile as the axis keeps them until the motion begins. */
typedef struct table_points {
    int count;
    bool absolute;
    cm1e_table_point_t points[CM1E_TABLE_POINTS_MAX];
} table_points_t;

/** Room for table profiles, made with the axis. */
typedef struct tables {
    cm1e_table_profile_t running;
    cm1e_command_id_t waiting_id;
    table_points_t waiting;
} tables_t;

/** Factors of MC_SetOverride; acceleration: also for the deceleration. Written by axis.c, axis_override.c and, while it
 *  tries a plan without them, axis_plan.c. */
typedef struct override {
    double velocity, acceleration, jerk;
} override_t;

/** Where a motion begins. */
typedef struct from {
    position_t position;
    double velocity, acceleration; /**< u/s, u/s2 */
    bool shared;                   /**< a superimposed motion goes on above it and needs its part of the limits */
} from_t;

/** A motion on top of the commanded one (3.8), which is called the base of it. Written by axis_superimpose.c. */
typedef struct superimposed {
    cm1e_command_id_t id;          /**< MC_MoveSuperimposed, or MC_HaltSuperimposed; 0: none */
    bool moving;                   /**< FALSE: it waits until the base has room for it */
    bool paused;                   /**< an override of velocity 0 */
    bool alone;                    /**< began in Standstill: there is no base to share with */
    cm1e_motion_limits_t share;    /**< what of the axis's maxima is its own; acceleration = deceleration */
    cm1e_profile_t profile;        /**< from where the command began, in u */
    int64_t cycles;
    cm1e_motion_state_t now;       /**< its part of the present set-point */
    double lowest, highest;        /**< u; of all its way */
    cm1e_command_id_t ended;       /**< the last one, and what it had covered, u */
    double covered;
    move_t move;
} superimposed_t;

/** The commands of an axis. Written by axis_commands.h, axis_command.c, axis_record.c, axis_buffer.c, axis_replan.c and
 *  axis_keep.c. */
typedef struct commands {
    cm1e_command_id_t active;       /**< 0: none */
    cm1e_command_kind_t kind;       /**< of the active one */
    cm1e_command_id_t last_id;      /**< of the last command that was taken */
    cm1e_command_id_t kept;         /**< a command that halts unless it is renewed; 0: none */
    cm1e_command_id_t stop;         /**< whose MC_Stop holds the axis in Stopping */
    bool stop_held;
    bool awaits;                    /**< the first waiting command begins at a place of its master (StartSync), until
                                         when what runs goes on */
    move_t move;                    /**< the active one, unless it is a homing */
    buffer_t waiting;
    command_record_t records[COMMANDS_REMEMBERED];
    int64_t kept_until_ns;
    double kept_deceleration, kept_jerk; /**< of that halt */
    cm1e_axis_command_t refused;    /**< what it asked for */
    cm1e_error_t refusal;           /**< why the last command was refused, for the text; CM1E_OK: it was not */
} commands_t;

/** What is done with a command, by how it is planned (command_plan_t). A NULL is never called. */
typedef struct command_method {
    /** Begins at once, or refuses: then nothing has changed. */
    cm1e_error_t (*start)(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
    /** Waits behind others from now on; the same of a refusal. */
    cm1e_error_t (*buffer)(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
    /** The first of those that wait goes on waiting although its turn has come. NULL: it does not. */
    bool (*awaits)(cm1e_axis_t *axis, const from_t *from, double late_s);
    /** One that waited begins where the command before it ended, `late_s` before the present set-point. */
    cm1e_error_t (*begin)(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
    /** ContinuousUpdate. NULL: it has no inputs to change. */
    cm1e_error_t (*update)(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);
} command_method_t;

#endif
