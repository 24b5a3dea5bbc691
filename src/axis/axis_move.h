/**
 * @file axis_move.h
 * Commands as the axis keeps them, where motions begin, and how one comes after the other.
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

/** Factors of MC_SetOverride; acceleration: also for the deceleration. */
typedef struct override {
    double velocity, acceleration, jerk;
} override_t;

/** Where a motion begins. */
typedef struct from {
    position_t position;
    double velocity, acceleration; /**< u/s, u/s2 */
    bool shared;                   /**< a superimposed motion goes on above it and needs its part of the limits */
} from_t;

/** A motion on top of the commanded one (3.8), which is called the base of it. */
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

/** The commands of an axis. */
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

/* axis_method.c */
extern const command_method_t cm1e_axis_methods[]; /**< by command_plan_t; of the axis itself */

/* axis_command.c, axis_record.c, axis_replan.c */
/** Of a command or an update, for the text: what was refused last is told. CM1E_OK: it was accepted. */
void cm1e_axis_remember_refusal(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error);
/** The active command ends; those that wait are for cm1e_axis_begin_waiting(). */
void cm1e_axis_command_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** All end, the waiting ones with CM1E_ERROR_AXIS_ERROR_STOP where `state` is an error. */
void cm1e_axis_waiting_end(cm1e_axis_t *axis, cm1e_command_state_t state);
void cm1e_axis_commands_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** For the text: one that was taken ended with this error. That of ErrorStop is told by the axis's own. */
void cm1e_axis_remember_end(cm1e_axis_t *axis, cm1e_command_kind_t kind, cm1e_error_t error);
void cm1e_axis_record(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error);
cm1e_command_id_t cm1e_axis_next_id(cm1e_axis_t *axis);
/** A command that has been planned becomes the active one; the one before, if any, is aborted. */
void cm1e_axis_take(cm1e_axis_t *axis, const move_t *move, const from_t *from, const cm1e_profile_t *profile,
                    double offset_s);
/** A command has begun: the state diagram follows it. */
void cm1e_axis_taken(cm1e_axis_t *axis, const command_kind_t *kind);
cm1e_error_t cm1e_axis_start_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_buffer_move(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);

/* axis_buffer.c, axis_look_ahead.c, axis_replan.c */
/** The waiting command of that number; NULL: none. */
move_t *cm1e_axis_find_waiting(cm1e_axis_t *axis, cm1e_command_id_t id);
/** Takes it in behind the others and gives it its number. */
cm1e_error_t cm1e_axis_buffer(cm1e_axis_t *axis, move_t *move);
/** A waiting command with this number, if there is one, gets these inputs. */
cm1e_error_t cm1e_axis_update_waiting(cm1e_axis_t *axis, const move_t *move);
/** MC_SetPosition: whether the targets of those that wait, as far as they are known, keep these software limits (u). */
bool cm1e_axis_waiting_hold(cm1e_axis_t *axis, double lower, double upper);
/** The coordinates have been shifted by so much: those that wait end where they were to. FALSE: their limits are such
 *  now that the motion that runs would have to come slower to its end, and cannot. Nothing has changed then. */
bool cm1e_axis_shift_waiting(cm1e_axis_t *axis, double shift);
/** The velocity with which a move that begins there shall pass its target, for the sake of those that wait. */
double cm1e_axis_exit_velocity(cm1e_axis_t *axis, const from_t *from, const move_t *move);
cm1e_error_t cm1e_axis_begin_move(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
/** The first waiting command that can begin there does; those before it fail. FALSE: none could. Motions call
 *  cm1e_axis_begin_waiting(). */
bool cm1e_axis_begin_next(cm1e_axis_t *axis, const from_t *from, double offset_s);
/** Whether the active command is one that is planned anew where something changes. */
bool cm1e_axis_can_replan(const cm1e_axis_t *axis);
/** Something that the active command's profile depends on has changed: it is planned anew from the present set-point.
 *  Where that is refused, it goes on as it was. */
cm1e_error_t cm1e_axis_replan(cm1e_axis_t *axis);
/** The same; FALSE, and nothing has changed: refused, or it would run over its target. */
bool cm1e_axis_replan_if(cm1e_axis_t *axis);
/** The same with other inputs, which are in force when it is not refused. */
cm1e_error_t cm1e_axis_replan_as(cm1e_axis_t *axis, const move_t *move);

/* axis_superimpose.c */
cm1e_error_t cm1e_axis_superimpose(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_superimpose_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);
/** Adds its part to the base's of this cycle. */
void cm1e_axis_superimposed_step(cm1e_axis_t *axis, cm1e_motion_state_t *next);
/** Instead of that: its part is what was `before`, without jerk, and it goes on from there. */
void cm1e_axis_superimposed_hold(cm1e_axis_t *axis, const cm1e_motion_state_t *before);
/** A command begins there (the present set-point), as the base. Where that is faster than what is left beside the
 *  superimposed motion, that one stops being one, waits, and its part of the velocity is the base's. */
void cm1e_axis_superimposed_give_way(cm1e_axis_t *axis, from_t *from);
/** After the set-point: where it has come to its end, the base has all the limits again. */
void cm1e_axis_superimposed_after(cm1e_axis_t *axis);
/** What is superimposed becomes part of the one motion that is then planned from the set-point. */
void cm1e_axis_superimposed_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** Aborted: the base goes on alone, and ends so much beyond as has been covered. */
void cm1e_axis_superimposed_abandon(cm1e_axis_t *axis);
void cm1e_axis_superimposed_replan(cm1e_axis_t *axis);
/** Whether it goes that way, now or later. */
bool cm1e_axis_superimposed_goes(const cm1e_axis_t *axis, double sign);

/* axis_record.c */
bool cm1e_axis_same_way(const move_t *a, const move_t *b);
bool cm1e_axis_same_inputs(const move_t *a, const move_t *b);
move_t cm1e_axis_move_of(const cm1e_axis_command_t *command);
cm1e_error_t cm1e_axis_update_move(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);

/* axis_table.c */
cm1e_error_t cm1e_axis_table_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
cm1e_error_t cm1e_axis_table_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_table_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_table_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double offset_s);
/** What a table that was refused would have needed, for the text. */
void cm1e_axis_table_needs(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_axis_command_t *needs);

#endif
