/**
 * @file coupling_private.h
 * Followers (Part 1, chapter 4) as the sources of this room see them. Everything here runs in the cycle unless marked
 * otherwise.
 *
 *     set-point = coupling function(views of the masters) + catch-up + what is superimposed
 *
 * The masters are advanced first, so that a slave follows them within the same cycle, whatever their order on the bus.
 * There are a few coupling functions (`coupling_function_t`), each an object of its own source:
 *   gear, combine     gear.c
 *   cam               cam_function.c
 *   an approach over the master's position (MC_GearInPos, MC_CamIn), then one of these   coupling_approach.c
 * The catch-up is what is not in step yet: a profile over time in the frame that moves with the coupling function. It
 * leads from the difference of the two, when the coupling begins, to nothing. So the slave is in step at a definite
 * time, without a step of position, velocity or acceleration, and whatever the masters do meanwhile.
 *
 * Seams:
 *   - A new coupling function fills the spare `follow_t` (cm1e_coupling_spare()), takes its masters in
 *     (cm1e_coupling_link()) and calls cm1e_coupling_follow(). Nothing has changed before that, so a refusal changes
 *     nothing.
 *   - The view of a master is made in one place, cm1e_coupling_see() (master.c): by its set value, by its actual value,
 *     and with the phase shift, which is a state of motion of its own (`phase`, phasing.c).
 *   - The axis knows of all this a table of functions only (follower.c, axis/axis_hooks.h).
 */
#ifndef CM1E_COUPLING_COUPLING_PRIVATE_H
#define CM1E_COUPLING_COUPLING_PRIVATE_H

#include "coupling/coupling_cam.h"
#include "motion/observer.h"

/** A master as its slave sees it in this cycle, phase shift included. */
typedef struct master_view {
    double counts;                 /**< of the master, since the slave began to follow it */
    double velocity, acceleration; /**< of the master: u/s, u/s2 */
    uint32_t jumps;                /**< of its set-point, so far */
} master_view_t;

/** The link of a slave to its master. */
typedef struct link {
    cm1e_axis_t *master;           /**< NULL: there is none, or it has been destroyed */
    cm1e_axis_t *slave;
    struct link *next;             /**< of the same master; in force while `listed` */
    bool listed;
    MC_SOURCE source;
    position_t origin;             /**< of the master, as seen, when the slave began to follow it */
    double ratio;                  /**< u of the slave on a u of the master: of gears and combinations */
    double counts_ratio;           /**< the ratio in counts */
    double half_cycle;             /**< counts of the master in half a cycle at 1 u/s */
    double most_unexplained;       /**< counts; of its way in a cycle, by its velocities */
    master_view_t seen;
} link_t;

enum { LINKS = 2, FOLLOWS = 3, COUPLINGS_WAITING = 3, PHASINGS_WAITING = 3 };

struct coupling_function;

/** What a slave follows, and by which function. */
typedef struct follow {
    const struct coupling_function *function; /**< NULL: nothing */
    link_t links[LINKS];
    int count;                     /**< of them */
    position_t anchor;             /**< of the slave, where the coupling function counts from */
    bool to_position;              /**< the catch-up is brought to 0 in its position too (mcRampIn); else lost distance
                                        is not made up, and the anchor takes it in at the end */
    bool in_step;                  /**< the coupling function itself is what was commanded: the approach is over */
    bool by_actual;                /**< of one master at least: what is seen has no limit of jerk */
    bool waits_for_end;            /**< commands that wait do so until EndOfProfile (cams) instead of InSync */
    bool linear;                   /**< the acceleration jumps by its nature: no limit of jerk holds */
    cam_place_t cam;
    approach_t approach;
} follow_t;

/** A coupling function. */
typedef struct coupling_function {
    /** The slave's set-point for the masters as seen in this cycle. It may come over a change within the function (the
     *  end of an approach, the end of a single-shot cam) and says so in the coupling. */
    void (*evaluate)(cm1e_axis_t *axis, follow_t *follow, from_t *point);
    /** The largest |u of the slave on a u of that master| that it may come to. */
    double (*steepest)(const cm1e_axis_t *axis, const follow_t *follow, int link);
} coupling_function_t;

/** The catch-up: difference to the coupling function, in the frame that moves with it; u. */
typedef struct catch_up {
    bool on;
    bool made_up;                  /**< its position is brought to 0 too: lost distance is made up */
    bool to_place;                 /**< the profile makes up distance, while the velocity of the function is constant */
    bool held_back;                /**< the function needs more of the limits than was thought when it was planned */
    cm1e_motion_limits_t asked;    /**< of the command */
    cm1e_profile_t profile;
    int64_t cycles;
    cm1e_motion_state_t now;
} catch_up_t;

/** Why a master cannot be followed; for the text. */
typedef enum master_trouble {
    MASTER_GOOD = 0,
    MASTER_DESTROYED,
    MASTER_ERROR_STOP,
    MASTER_STOPPING,               /**< the master is in ErrorStop, but still on its ramp, which can be seen */
    MASTER_FREE,                   /**< the master has no torque, so it has no set value */
    MASTER_HOMING,                 /**< by its drive */
    MASTER_UNSEEN,                 /**< the actual position of the master is unknown */
    MASTER_JUMPED,
} master_trouble_t;

/** A command that waits, with what it needs beside a move. */
typedef struct waiting_coupling {
    cm1e_command_id_t id;
    cm1e_axis_coupling_t coupling;
} waiting_coupling_t;

/** MC_PhasingAbsolute, MC_PhasingRelative: what changes the phase shift; u of the master. */
typedef struct phasing {
    cm1e_command_id_t id;          /**< 0: none, or what moves on belongs to no command any more */
    bool moving;
    double origin;                 /**< of what is covered */
    cm1e_profile_t profile;
    int64_t cycles;
    move_t waiting[PHASINGS_WAITING];
    int count;
    cm1e_command_id_t ended;       /**< the last one, and what it had covered */
    double covered;
} phasing_t;

/** Of this axis, for slaves that follow its actual value. */
typedef struct observed {
    bool begun;
    cm1e_observer_t filter;
    from_t now, before;            /**< in this cycle, and in the one before */
    uint32_t lost;                 /**< cycles in a row without a position */
} observed_t;

/** Made with the axis. */
typedef struct coupling {
    follow_t follows[FOLLOWS];     /**< links are in lists: they keep their place */
    follow_t *now;                 /**< what is followed; NULL: nothing ever was */
    follow_t *awaited;             /**< of the first waiting command: it begins at a place of its master (StartSync),
                                        until when what runs goes on; NULL: none does (cm1e_axis_t.awaits) */
    link_t *slaves;                /**< who follows this axis */
    cams_t *cams;                  /**< that it may follow */
    catch_up_t catch_up;
    cm1e_motion_state_t phase;     /**< u of the master: shift of links[0], while that one is followed */
    phasing_t phasing;             /**< the motion that changes the phase */
    observed_t own;
    double f_velocity, f_acceleration; /**< u/s, u/s2; of the coupling function, in the last cycle */
    bool due;                      /**< the awaited command begins in this cycle */
    cm1e_error_t due_error;        /**< error with which it fails instead */
    bool end_of_profile;           /**< CAM_IN: the cam came over it in this cycle */
    bool at_end;                   /**< what is being prepared waited for that */
    uint64_t mark;                 /**< of the last search that came here */
    uint32_t searches;
    cm1e_axis_coupling_t inputs;   /**< of the active command, for ContinuousUpdate */
    waiting_coupling_t waiting[COUPLINGS_WAITING];
    master_trouble_t trouble;      /**< the reason why a master was lost */
    cm1e_error_t master_error;     /**< error of that master */
    char other_name[CM1E_NAME_LENGTH]; /**< name of that master, or of the axis because of which this one stops */
    int32_t numerator;             /**< a ratio that was refused */
    uint32_t denominator;
    bool stopping;                 /**< in ErrorStop, but the coupling goes on until the masters stand (keep_ratio) */
} coupling_t;

/* master.c */
/** Advances the masters of what is followed, and of what waits to be, where that has not been done in this cycle. */
void cm1e_coupling_advance_masters(cm1e_axis_t *axis);
/** Lets them begin anew before their slave (axis_pause.c); 0: after silence. */
void cm1e_coupling_resume_masters(cm1e_axis_t *axis, int64_t pause_ns);
/** Lets the slaves that follow this axis begin anew after silence. */
void cm1e_coupling_resume_slaves(cm1e_axis_t *axis);
/** One of its masters began anew in this cycle, or what is seen of it is its actual value. */
bool cm1e_coupling_begins_anew(const cm1e_axis_t *axis);
/** Fills in a master of a `follow` that is not in force yet: origin and view as of the slave's present set-point.
 *  CM1E_ERROR_AXIS_MASTER, _COUPLING_CYCLE, _MASTER_LOST, CM1E_ERROR_INVALID_ARGUMENT: nothing follows it. */
cm1e_error_t cm1e_coupling_link(cm1e_axis_t *slave, follow_t *follow, const cm1e_coupling_master_t *master);
/** Makes the slave's view of all its masters in this cycle. */
master_trouble_t cm1e_coupling_see(cm1e_axis_t *slave, follow_t *follow);
/** Makes that view without advancing the masters. */
master_trouble_t cm1e_coupling_look(cm1e_axis_t *slave, follow_t *follow);
void cm1e_coupling_list_links(follow_t *follow);
void cm1e_coupling_unlist_links(follow_t *follow);
/** Removes the axis from all couplings, as a master and as a slave. @rt init */
void cm1e_coupling_unlink(cm1e_axis_t *axis);
/** An empty place for a coupling that is being prepared. */
follow_t *cm1e_coupling_spare(cm1e_axis_t *axis);
/** The coupling of the first waiting command now waits for its master. */
void cm1e_coupling_await(cm1e_axis_t *axis, follow_t *follow);
/** No coupling waits for its master any more. */
void cm1e_coupling_await_nothing(cm1e_axis_t *axis);

/* coupled_step.c */
extern const source_t cm1e_source_coupling; /**< what the axis follows gives its set-points */
/** The limit of jerk holds for it. A ramp of ErrorStop has none, nor has who follows it. */
static inline bool coupling_keeps_jerk(const coupling_t *c)
{
    return !c->now->linear && !c->now->by_actual && !c->stopping;
}
/** Makes `follow` what the axis follows from now on. The difference to the state `from` becomes the catch-up. The
 *  caller changes the active command. */
void cm1e_coupling_follow(cm1e_axis_t *axis, follow_t *follow, const from_t *from, const cm1e_motion_limits_t *asked);
/** Makes the superimposed distance a part of the base motion; u. */
void cm1e_coupling_shift(cm1e_axis_t *axis, double way);
/** The set-point of a coupling in the cycle in which it began, without advancing. */
void cm1e_coupling_first_set_point(cm1e_axis_t *axis);

/* coupling_command.c */
cm1e_error_t cm1e_coupling_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_coupling_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
/** A waiting one begins; `from` is where the command before it ended, `late_s` before the present set-point. */
cm1e_error_t cm1e_coupling_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
/** Whether the first waiting command, a coupling that could begin there, waits for its master. */
bool cm1e_coupling_awaits(cm1e_axis_t *axis, const from_t *from, double late_s);
/** ContinuousUpdate. */
cm1e_error_t cm1e_coupling_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);

/* observe.c */
/** In every cycle in which somebody may follow its actual value: with the inputs. */
void cm1e_coupling_observe(cm1e_axis_t *axis);
/** The place of the axis in this cycle, or in the previous one if the set-point is still of that. MASTER_UNSEEN:
 *  nothing was heard of it for too long. */
master_trouble_t cm1e_coupling_see_actual(cm1e_axis_t *master, bool of_this_cycle, from_t *seen);

/* phasing.c */
cm1e_error_t cm1e_phasing_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
/** Advances the shift, before anything is seen of the masters. */
void cm1e_phasing_step(cm1e_axis_t *axis);
/** Running and waiting phasings end. If the axis still follows, the shift comes to rest. */
void cm1e_phasing_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** Phasings end with CommandAborted, and the shift stays as it is. */
void cm1e_phasing_stand(cm1e_axis_t *axis);
/** Ends the shift, because the axis leaves that master. */
void cm1e_phasing_forget(cm1e_axis_t *axis);
/** FALSE: `id` is not one that runs or waits. */
bool cm1e_phasing_status(const cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_status_t *status);
/** Of one that has ended; 0: it was not the last one. */
double cm1e_phasing_covered(const cm1e_axis_t *axis, cm1e_command_id_t id);
/** Of one that was refused for its numbers; FALSE: none was. */
bool cm1e_phasing_text(const cm1e_axis_t *axis, char *text, size_t size);

/* gear.c */
/** Prepares a gear or a combination that begins there, in the spare place. */
cm1e_error_t cm1e_gear_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                               const from_t *from);
/** MC_GearOut, MC_CamOut: leaves the masters and keeps the velocity. */
cm1e_error_t cm1e_gear_out(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);

/* coupling_approach.c */
/** Prepares a gear that is in step from a place of both axes on. */
cm1e_error_t cm1e_gear_in_pos_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                                      const from_t *from);
/** Puts an approach before a coupling that is prepared: begun (`approach.awaited` nothing), or to be awaited. */
cm1e_error_t cm1e_coupling_approach_prepare(cm1e_axis_t *axis, follow_t *follow, const move_t *move,
                                            const from_t *from);
/** Begins the approach with the master as seen. CM1E_ERROR_AXIS_SYNC_WAY: not within these limits. */
cm1e_error_t cm1e_coupling_approach_begin(cm1e_axis_t *axis, follow_t *follow, const move_t *move,
                                          const from_t *from);
/** Called after the set-point of every cycle while a coupling waits for its master. */
void cm1e_coupling_await_step(cm1e_axis_t *axis);

/* cam_function.c */
/** Prepares a cam, as cm1e_gear_prepare() does a gear. */
cm1e_error_t cm1e_cam_in_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                                 const from_t *from);
/** Takes other offsets and scalings from the present set-point on. Other changed inputs wait for the next edge. On an
 *  approach they wait for its end. CM1E_ERROR_AXIS_RATIO, _POSITION_RANGE: nothing has changed. */
cm1e_error_t cm1e_cam_in_update(cm1e_axis_t *axis, const cm1e_axis_coupling_t *coupling);
/** Where the cam has the slave when the master is there (counts of the link), and how it goes on: but for the place. */
void cm1e_cam_in_enter(follow_t *follow, double counts);
void cm1e_cam_in_point(const cm1e_axis_t *axis, const follow_t *follow, double counts, position_t *position,
                       cm1e_curve_point_t *point);
/** What the cam leaves of the axis's limits for the way onto it, with the master's present velocity. */
cm1e_motion_limits_t cm1e_cam_leaves(const cm1e_axis_t *axis, const follow_t *follow,
                                     const cm1e_motion_limits_t *asked);

/* coupling_stop.c */
/** Stops what else has to stop when a follower has failed. */
void cm1e_coupling_failed(cm1e_axis_t *axis);
/** Stops because a master cannot be followed any more. true: the axis follows it to its standstill, in ErrorStop. */
bool cm1e_coupling_follows_to_the_end(cm1e_axis_t *axis, master_trouble_t trouble);
/** After the set-point: it may be the last one from which the axis can still be braked together with its master. */
void cm1e_coupling_keep_ratio(cm1e_axis_t *axis);

/* coupling_text.c */
/** FALSE: this error is not one of couplings. `refused`: a command was; else the axis has failed by it. */
bool cm1e_coupling_text(const cm1e_axis_t *axis, cm1e_error_t error, bool refused, char *text, size_t size);

#endif
