/**
 * @file homing_private.h
 * Homings as the sources of this room see them: of the drive (MC_Home), and in steps of the axis (Part 5). Everything
 * here runs in the cycle unless marked otherwise.
 */
#ifndef CM1E_HOMING_HOMING_PRIVATE_H
#define CM1E_HOMING_HOMING_PRIVATE_H

#include "axis/axis_parts.h"

extern const source_t cm1e_source_homing; /**< homing by the drive; drive_homing.c */

enum { HOMING_PARAMETERS = CM1E_HOMING_PARAMETERS };

typedef struct drive_homing {
    cm1e_home_step_t step;
    home_goal_t goal;
    double position;       /**< u, at the reference */
    double offset;         /**< counts, as commanded */
    int32_t raw[HOMING_PARAMETERS]; /**< values of the parameters, in the order of CM1E_HOMING_OFFSET ... */
    int32_t k45;           /**< K45 of a CM2: its second digit is the unit of the offset; < 0: not read */
    uint8_t next;          /**< parameter to write next */
    uint8_t place;         /**< number of the step in the order of its kind */
    uint8_t bits_before;   /**< statusword bits 13, 12, 10 before the start */
    uint8_t wrong;         /**< last parameter that was out of its range, and its value; for the text */
    bool submitted;
    bool away;             /**< the drive is not in the axis's own mode */
    bool unstoppable;      /**< the motor did not stop in time; for the text */
    bool unsettled;        /**< it did not come to rest after the end of the homing; for the text */
    bool late;             /**< the time of the homing was over before the parameters were written; for the text */
    uint8_t data[4];
    standstill_t standstill;
    cm1e_error_t refused;  /**< why the last homing could not start; `sdo` has the numbers for the text */
    cm1e_sdo_t sdo;
    int64_t timeout_ns, deadline_ns, step_ns; /**< step_ns: when the step began */
    int64_t told_ns;       /**< when the bits last said something else than "interrupted" */
    double wrong_value;
} drive_homing_t;

typedef enum stepping_phase {
    STEPPING_SEARCH = 0, /**< the axis moves, or presses against a stop */
    STEPPING_STOP,       /**< the outcome is decided; it brakes, or makes the move of MC_FinishHoming */
    STEPPING_SETTLE,     /**< the set-point stands, and the motor comes to it or is blocked */
    STEPPING_RELIEVE,    /**< the set-point goes back from the place where the motor is blocked */
    STEPPING_RELIEVED,
} stepping_phase_t;

/** A homing in steps (homing_steps.c), in force while CM1E_COMMAND_HOMING_STEP is the active command. */
typedef struct stepping {
    cm1e_homing_step_t step;
    cm1e_motion_limits_t limits;
    stepping_phase_t phase;
    cm1e_error_t outcome;           /**< valid from STEPPING_STOP on */
    double position;                /**< u, to set at the reference; NAN: none */
    position_t reference;           /**< where the event was */
    double search, way;             /**< +-1: direction of the search, and the present direction */
    double travel;                  /**< u */
    double pace;                    /**< u/s, of the set-point while the motor is pressed */
    double carried;                 /**< %: the torque at its beginning, or at that of the step that it has ended */
    int64_t deadline_ns, pressed_ns;
    int64_t settled_ns;             /**< a motor that is not at its set-point by then is blocked */
    position_t actual_before;       /**< at the last look */
    bool level, seen_on, pressed;
    bool after_push;                /**< it ended a step before the end of that: it may begin beyond a stop */
    bool turned_positive, turned_negative; /**< the search has turned at that limit switch */
    bool referenced;                /**< the last step set a position */
    bool finishing;                 /**< positions are valid again: software limits hold */
} stepping_t;

/** The parameters of a waiting MC_Home. */
typedef struct waiting_homing {
    cm1e_homing_config_t config;
    bool configured;    /**< the configuration of the axis applies instead */
} waiting_homing_t;

enum { STEPS_WAITING = 3 };

/** The parameters of a waiting step. */
typedef struct waiting_step {
    cm1e_command_id_t id;
    cm1e_homing_step_t step;
} waiting_step_t;

/** The input for which a step was refused, for the text; its words are constants. */
typedef struct wrong_input {
    const char *name, *right;
    bool valued;        /**< else `name` says what is wrong */
    double value;
} wrong_input_t;

/** Made with the axis. */
typedef struct homing {
    drive_homing_t drive;
    stepping_t stepping;
    wrong_input_t wrong_input;
    waiting_homing_t waiting;
    waiting_step_t waiting_steps[STEPS_WAITING];
} homing_t;

/* drive_homing.c */
/** Whether a method searches for a switch and not for a stop. */
bool cm1e_homing_by_switch(const cm1e_axis_t *axis, int method);
/** u/s; of the search, for the text. */
double cm1e_homing_velocity(const cm1e_axis_t *axis);
cm1e_error_t cm1e_homing_prepare(cm1e_axis_t *axis, const cm1e_axis_command_t *command);
/** Explains which parameter cm1e_homing_prepare() refused. */
void cm1e_homing_wrong_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_homing_run(cm1e_axis_t *axis);

static inline bool step_by_switch(cm1e_homing_step_kind_t kind)
{
    return kind == CM1E_STEP_ABSOLUTE_SWITCH || kind == CM1E_STEP_LIMIT_SWITCH;
}
/* homing_inputs.c: CM1E_OK, or which input is wrong, for the text */
cm1e_error_t cm1e_homing_step_inputs(const cm1e_axis_t *axis, const cm1e_homing_step_t *step);
/** Of the reference signal: the motor has no such input. */
cm1e_error_t cm1e_homing_wrong_signal(const cm1e_axis_t *axis, const cm1e_homing_step_t *step);

/* homing_steps.c */
/** Checks a step in every state of the axis. */
cm1e_error_t cm1e_homing_step_check(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, const move_t *move);
/** Decides how a step begins: fills in `*next` and `*profile`. cm1e_homing_step_run() puts them in force. */
cm1e_error_t cm1e_homing_step_prepare(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, const move_t *move,
                                    stepping_t *next, cm1e_profile_t *profile);
void cm1e_homing_step_run(cm1e_axis_t *axis, const stepping_t *next, const cm1e_profile_t *profile);
/** Called before every set-point: looks at inputs and motor, and decides the profile. */
void cm1e_homing_step_cycle(cm1e_axis_t *axis);
/** Called when the profile of a step, or of the MC_Stop that ended it, has ended. true: the step has decided what
 *  follows. */
bool cm1e_homing_step_ended(cm1e_axis_t *axis);

/** Continues the step after a pause. */
cm1e_error_t cm1e_homing_step_anew(cm1e_axis_t *axis);

/* homing_command.c: what is done with a command (command_method_t) */
cm1e_error_t cm1e_homing_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_homing_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_homing_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
cm1e_error_t cm1e_homing_step_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_homing_step_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_homing_step_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);

/* homing_text.c; false: this error is not one of homings */
bool cm1e_homing_failed_text(const cm1e_axis_t *axis, char *text, size_t size);
bool cm1e_homing_refused_text(const cm1e_axis_t *axis, char *text, size_t size);
bool cm1e_homing_not_finished_text(const cm1e_axis_t *axis, char *text, size_t size);

#endif
