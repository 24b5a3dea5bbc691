/**
 * @file axis_move.h
 * Commands as the axis keeps them, and the states in which motions begin. Their functions are in axis_commands.h.
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

/** A command as it is kept: its inputs, and what is known of its way. */
typedef struct move {
    cm1e_command_id_t id;
    uint8_t kind, buffer_mode, direction; /**< cm1e_command_kind_t, MC_BUFFER_MODE, MC_DIRECTION */
    bool passing : 1;       /**< MOVE_CONTINUOUS_*: it has passed its position; only its end velocity is left */
    bool paused : 1;        /**< an override of velocity 0: it brakes to standstill and waits */
    bool accepted : 1;      /**< it is under way: a maximum that was lowered since does not refuse it, but limits it */
    double position, velocity, end_velocity, acceleration, deceleration, jerk;
    double shift;           /**< u; how far MC_SetPosition has moved the coordinates since the position was given */
    position_t origin;      /**< the position from which a relative one counts */
    position_t target;      /**< its end position */
    double exit_velocity;   /**< u/s, signed: velocity at its target, from which another command goes on */
} move_t;

/** A command that waits: a move without what is known only when it begins. */
typedef struct waiting {
    cm1e_command_id_t id;
    uint8_t kind, buffer_mode, direction;
    double position, velocity, end_velocity, acceleration, deceleration, jerk;
    double shift;
    position_t target;      /**< as far as it is known: that of a relative move counts from the end of the one before */
} waiting_t;

/** The waiting commands, in their order, as a ring. */
typedef struct buffer {
    uint8_t first, count;
    waiting_t moves[CM1E_AXIS_BUFFER_DEPTH];
} buffer_t;

/** The points of a table profile, kept until the motion begins. */
typedef struct table_points {
    int count;
    bool absolute;
    cm1e_table_point_t points[CM1E_TABLE_POINTS_MAX];
} table_points_t;

/** What was wrong with the last refused table. */
typedef enum table_fault {
    TABLE_MISSING, TABLE_COUNT, TABLE_TIME_SCALE, TABLE_SCALE, TABLE_OFFSET, TABLE_TIME, TABLE_VALUE, TABLE_ONLY_NOW,
    TABLE_JUMP, TABLE_BEYOND_NUMBERS,
} table_fault_t;
typedef struct table_refusal {
    table_fault_t fault;
    int point;              /**< 1: the first */
    double given, right;    /**< of TABLE_TIME: s after the point before; of TABLE_JUMP: both */
} table_refusal_t;

/** Memory for table profiles, allocated with the axis. */
typedef struct tables {
    cm1e_table_profile_t running;
    double lowest, highest;     /**< u, from its begin; how far it goes */
    cm1e_command_id_t waiting_id;
    table_points_t waiting;
    table_refusal_t refused;
} tables_t;

/** Factors of MC_SetOverride. The factor of the acceleration applies to the deceleration too. Written by axis.c,
 *  axis_override.c and, while it tries a plan without them, axis_plan.c. */
typedef struct override {
    double velocity, acceleration, jerk;
} override_t;

/** The state in which a motion begins. */
typedef struct from {
    position_t position;
    double velocity, acceleration; /**< u/s, u/s2 */
    bool shared;                   /**< a superimposed motion goes on and needs its share of the limits */
} from_t;

/** The plan of a superimposed motion, in u from the begin of the command: from what it was made, and the stretch of the
 *  profile in which the motion is. At the next stretch the profile is made again, which gives the same one. */
typedef struct on_top_plan {
    cm1e_motion_state_t start;
    cm1e_motion_limits_t limits;
    double target;                 /**< NAN: it comes to rest somewhere */
    double duration_s, end;        /**< of the profile; end: its position */
    cm1e_profile_stretch_t stretch;
} on_top_plan_t;

/** A superimposed motion (3.8). The commanded motion is called its base. Written by axis_superimpose.c. */
typedef struct superimposed {
    bool moving;                   /**< false: it waits until the base has room for it */
    bool paused;                   /**< an override of velocity 0 */
    bool alone;                    /**< it began in Standstill: no base needs a share */
    cm1e_motion_limits_t share;    /**< its share of the maximum values; acceleration = deceleration */
    on_top_plan_t plan;
    int64_t cycles;                /**< since then */
    cm1e_motion_state_t now;       /**< its part of the present set-point */
    double lowest, highest;        /**< u; extremes of its way */
    cm1e_command_id_t ended;       /**< the last one that ended; below, what it covered (u) */
    double covered;
    move_t move;
    cm1e_command_id_t id;          /**< MC_MoveSuperimposed, or MC_HaltSuperimposed; 0: none. Every cycle looks at it */
} superimposed_t;

/** The commands of an axis. Written by axis_commands.h, axis_command.c, axis_record.c, axis_buffer.c, axis_replan.c and
 *  axis_keep.c. */
typedef struct commands {
    cm1e_command_id_t active;       /**< 0: none */
    cm1e_command_kind_t kind;       /**< of the active one */
    cm1e_command_id_t last_id;      /**< the last command that was accepted */
    cm1e_command_id_t kept;         /**< a command that halts unless it is renewed; 0: none */
    cm1e_command_id_t stop;         /**< the MC_Stop that holds the axis in Stopping */
    bool stop_held;
    bool lowered;                   /**< a maximum was lowered since the active one began */
    buffer_t waiting;
    move_t move;                    /**< the active one, unless it is a homing */
    command_record_t records[COMMANDS_REMEMBERED];
    int64_t kept_until_ns;
    double kept_deceleration, kept_jerk; /**< dynamics of the halt of `kept` */
    cm1e_axis_command_t refused;    /**< the inputs of the last refused command */
    cm1e_error_t refusal;           /**< why the last command was refused, for the text; CM1E_OK: it was not */
} commands_t;

/** The functions for a command, by how it is planned (command_plan_t). A NULL is never called. */
typedef struct command_method {
    /** Begins the command at once. After a refusal nothing has changed. */
    cm1e_error_t (*start)(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
    /** Buffers the command. After a refusal nothing has changed. */
    cm1e_error_t (*buffer)(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
    /** Whether the first waiting command, although it could begin, waits for its master. NULL: it does not. */
    bool (*awaits)(cm1e_axis_t *axis, const from_t *from, double late_s);
    /** Begins a waiting command. `from` is the end of the command before it, `late_s` before the present set-point. */
    cm1e_error_t (*begin)(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
    /** Takes changed inputs over (ContinuousUpdate). NULL: the command has none. */
    cm1e_error_t (*update)(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);
} command_method_t;

#endif
