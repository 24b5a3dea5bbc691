/**
 * @file group_private.h
 * The axes group as the sources of its room see it.
 */
#ifndef CM1E_GROUP_GROUP_PRIVATE_H
#define CM1E_GROUP_GROUP_PRIVATE_H

#include <math.h>

#include "core/cache_line.h"
#include "group/group_api.h"
#include "motion/path.h"
#include "motion/profile.h"

enum { GROUP_HANDLES = 32, GROUP_RECORDS = 64 };

/** The triggers of the state diagram. */
typedef enum group_trigger {
    TRIGGER_CONFIGURE = 0, /**< MC_AddAxisToGroup, MC_RemoveAxisFromGroup */
    TRIGGER_ENABLE,
    TRIGGER_DISABLE,       /**< also MC_UngroupAllAxes */
    TRIGGER_RESET,
    TRIGGER_MOVE,
    TRIGGER_HALT,
    TRIGGER_INTERRUPT,     /**< also MC_GroupContinue */
    TRIGGER_STOP,
    TRIGGER_AT_REST,       /**< all commands are done, MC_GroupStop is no longer held */
    TRIGGER_FAIL,
    TRIGGER_COUNT,
} group_trigger_t;

typedef struct group_rule {
    cm1e_error_t refusal; /**< CM1E_OK: accepted */
    cm1e_group_state_t next;
} group_rule_t;

/** How a command ended. */
typedef struct group_record {
    cm1e_command_id_t id;
    cm1e_command_state_t state;
    cm1e_error_t error;
} group_record_t;

typedef struct group_queue {
    cm1e_command_id_t ids[CM1E_GROUP_COMMANDS]; /**< ring, in order */
    int first, count;
    cm1e_command_id_t active;       /**< the first of them; 0: there is none */
    bool in_a_row;                  /**< no number is missing between the first and the last one */
} group_queue_t;

/** MC_GroupInterrupt: the group comes to rest on its path, and keeps path and commands. */
typedef struct interruption {
    bool on;                        /**< until the group goes on, or its commands end */
    cm1e_command_id_t braking;      /**< the MC_GroupInterrupt that is not done yet; 0: none */
} interruption_t;

/** The last refusal, for the text. */
typedef struct group_refusal {
    cm1e_error_t error;   /**< CM1E_OK: nothing */
    uint32_t ident;       /**< IdentInGroup of the axis concerned; 0: none */
    cm1e_path_refusal_t path;
    double value;         /**< position that the axis would reach, or the value given */
    double lower, upper;
    const char *why;      /**< a sentence; NULL: the text of the error is enough */
} group_refusal_t;

/** Where an axis is that has left the path, because its bus was silent while those of other axes were not. */
typedef enum stray_step {
    STRAY_SILENT = 0,      /**< its set-point stays, or its ramp is about to begin */
    STRAY_RAMP,            /**< it comes to rest */
    STRAY_REST,            /**< it waits until the path is at rest */
    STRAY_BACK,            /**< it goes to its place on the path */
} stray_step_t;

typedef struct stray {
    stray_step_t step;
    int64_t cycles;
    double from, speed;    /**< u, where the profile begins; u/s, when the axis left the path */
    cm1e_profile_t profile;
    cm1e_motion_state_t now;
} stray_t;

/** Axes of a group that are not all heard together: group_apart.c. */
typedef struct apart {
    bool several;          /**< the axes of the path are on several buses, or some are optional */
    unsigned off, moving;  /**< bits of axes that are not on the path, and of those whose set-points are not at rest */
    cm1e_command_id_t passed[CM1E_GROUP_COMMANDS]; /**< done but for the axes that are not on the path */
    int passed_count;
    stray_t strays[CM1E_GROUP_AXES];
} apart_t;

/** What an axis of the path has of the group: what it reads in every cycle is in one cache line. */
typedef struct led_axis {
    _Alignas(CM1E_CACHE_LINE) cm1e_axis_leader_t leader;
} led_axis_t;

struct cm1e_group {
    uint16_t handle;
    cm1e_group_config_t config;
    cm1e_group_state_t state;
    AXIS_REF_t member[CM1E_GROUP_AXES]; /**< at the place IdentInGroup - 1; handle 0: no axis */
    bool ungroup;                       /**< the axes are released when nothing moves any more */

    /* the motion: axes of the path are members in their order, without the gaps */
    int axes;
    uint8_t ident[CM1E_GROUP_AXES];     /**< IdentInGroup of the axes of the path */
    unsigned led;                       /**< bits of axes of the path */
    bool told;                          /**< since the last step the path was told of a pause or silence */
    uint32_t asked;                     /**< bits of axes of the path that have had this sample; at first all of them */
    bool ending;                        /**< the present set-point is the last one */
    bool halting;                       /**< MC_GroupHalt brakes */
    interruption_t interruption;
    double rest_deceleration, rest_jerk; /**< with which the latest one of both comes to rest */
    double override;
    cm1e_path_sample_t sample;
    cm1e_path_t path, before;           /**< copy of the path, for commands that are refused later */
    apart_t apart;

    /* commands */
    cm1e_command_id_t last_id, stop;    /**< stop: the MC_GroupStop that holds the group in GroupStopping */
    bool stop_held;
    group_queue_t queue;
    group_record_t records[GROUP_RECORDS];

    /* what went wrong */
    cm1e_error_t error;
    uint32_t culprit;                   /**< IdentInGroup; 0: none */
    group_refusal_t refusal;
    cm1e_command_state_t reset_state;
    cm1e_error_t reset_error;

    led_axis_t leads[CM1E_GROUP_AXES];
};

/* group_state.c */
const group_rule_t *cm1e_group_rule(cm1e_group_state_t state, group_trigger_t trigger);

/* group_handle.c */
/** Gives the group a handle. false: all are in use. */
bool cm1e_group_take_handle(cm1e_group_t *group);
void cm1e_group_drop_handle(AXES_GROUP_REF_t reference);

/* group_member.c */
/** The member with this `ident`; NULL: no member, or the axis no longer exists. */
cm1e_axis_t *cm1e_group_axis(const cm1e_group_t *group, uint32_t ident);
/** Member number `i` (0 = first) if the path leads it; else NULL. */
static inline cm1e_axis_t *cm1e_group_led_axis(const cm1e_group_t *group, int i)
{
    return group->led & 1u << i ? cm1e_group_axis(group, group->ident[i]) : NULL;
}
int cm1e_group_count(const cm1e_group_t *group);
/** 0: there is no free place. */
uint32_t cm1e_group_free_ident(const cm1e_group_t *group);
/** Removes the member; the axis may no longer exist. */
void cm1e_group_leave(cm1e_group_t *group, uint32_t ident);

/* group_text.c */
/** Keeps a refusal for the text. Returns its error. */
cm1e_error_t cm1e_group_refuse(cm1e_group_t *group, group_refusal_t refusal);

/* group_record.c */
cm1e_command_id_t cm1e_group_next_id(cm1e_group_t *group);
void cm1e_group_record(cm1e_group_t *group, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error);
void cm1e_group_enqueue(cm1e_group_t *group, cm1e_command_id_t id);
/** Ends the first command of the queue. */
void cm1e_group_finish(cm1e_group_t *group, cm1e_command_id_t id);
/** From now on no command is active: all of them wait. */
void cm1e_group_suspend(cm1e_group_t *group);
/** The first command of the queue is active again. */
void cm1e_group_resume(cm1e_group_t *group);
/** Ends the MC_GroupInterrupt that brakes, if there is one. */
void cm1e_group_end_interrupt(cm1e_group_t *group, cm1e_command_state_t state, cm1e_error_t error);
/** Ends all commands of the queue, and an interruption of them. */
void cm1e_group_end_all(cm1e_group_t *group, cm1e_command_state_t state, cm1e_error_t error);

/* group.c */
/** Updates the group from the states of its axes while it is at rest. */
void cm1e_group_refresh(cm1e_group_t *group);

/* group_apart.c */
/** Called when the group begins to lead its axes. */
void cm1e_group_together(cm1e_group_t *group);
/** Whether all axes that it leads are silent: then time stands still for all of them. */
bool cm1e_group_all_held(const cm1e_group_t *group);
/** The axis leaves the path where it is, and the path comes to rest. */
void cm1e_group_stray(cm1e_group_t *group, uint32_t index);
/** Whether the axis has left the path, or does so because it was silent while others were not. */
bool cm1e_group_strays(const cm1e_group_t *group, uint32_t index);
/** The set-point of an axis that has left the path. */
void cm1e_group_stray_step(cm1e_group_t *group, uint32_t index, cm1e_motion_state_t *point);
/** The axis is no longer led. */
void cm1e_group_forget_stray(cm1e_group_t *group, uint32_t index);
/** The path has passed the end of a command. It is done when all axes are on the path. */
void cm1e_group_pass(cm1e_group_t *group, cm1e_command_id_t id);
/** Ends the commands that were passed, if all axes are on the path. */
void cm1e_group_finish_passed(cm1e_group_t *group);
/* group_motion.c */
/** Whether the set-points are at rest. */
bool cm1e_group_at_rest(const cm1e_group_t *group);
/** Begins a path without segments where the members are. */
cm1e_error_t cm1e_group_begin_path(cm1e_group_t *group);
/** Makes what the axes of the path will have of the group. @rt init */
void cm1e_group_make_leaders(cm1e_group_t *group);
/** Leads the axes of the path, which are all at rest. After a refusal nothing has changed. `some`: leads those axes
 *  that can be led. */
cm1e_error_t cm1e_group_lead(cm1e_group_t *group, bool some);
/** Releases the axes; moving axes ramp down by themselves. */
void cm1e_group_let_go(cm1e_group_t *group);
/** Brakes along the path, while an axis is off it with the limits of the axes. */
void cm1e_group_rest(cm1e_group_t *group, double deceleration, double jerk);
/** Does so, and drops what is behind it. */
void cm1e_group_brake(cm1e_group_t *group, double deceleration, double jerk);
/** Goes to GroupErrorStop: commands end with an error, and axes that are still led brake along the path. */
void cm1e_group_fail(cm1e_group_t *group, cm1e_error_t error, uint32_t culprit);

#endif
