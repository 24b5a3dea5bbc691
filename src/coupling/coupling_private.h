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

#include "axis/axis_course.h"
#include "axis/axis_setpoint.h"
#include "core/cache_line.h"
#include "coupling/coupling_cam.h"
#include "motion/observer.h"

/** A master as its slave sees it in this cycle, phase shift included. */
typedef struct master_view {
    double counts;                 /**< of the master, since the slave began to follow it */
    double velocity, acceleration; /**< of the master: u/s, u/s2 */
    uint32_t jumps;                /**< number of jumps of its set-point so far */
} master_view_t;

/** What a slave assumes of the motor of a master, by the frames of the master's bus. */
typedef enum assumption {
    SEEN = 0,                      /**< the frames come: the motor follows its set value */
    RUNS_ON,                       /**< the other bus is silent: the motor still runs to its last target */
    STOPS,                         /**< the other bus has been silent for so long that the motor stops */
} assumption_t;

/** The link of a slave to its master. What every cycle looks at comes first. */
typedef struct link {
    cm1e_axis_t *master;           /**< NULL: no master, or it was destroyed */
    MC_SOURCE source;
    bool listed;
    bool apart;                    /**< the master may be silent while the slave is not: it is on another bus, or one
                                        of the two is optional */
    uint8_t assumed;               /**< assumption_t */
    position_t origin;             /**< position of the master, as seen, when the slave began to follow it */
    double ratio;                  /**< u of the slave per u of the master; of gears and combinations */
    double counts_ratio;           /**< the ratio in counts */
    double half_cycle;             /**< counts of the master in half a cycle at 1 u/s */
    double most_unexplained;       /**< counts; largest way in a cycle beyond what the velocities explain */
    master_view_t seen;
    /* not in every cycle */
    double ran_on;                 /**< counts beyond the last set-point that the motor is assumed to have run */
    cm1e_axis_t *slave;
    struct link *next;             /**< next link to this master; valid while `listed` */
} link_t;

enum { LINKS = 2, FOLLOWS = 3, COUPLINGS_WAITING = 3, PHASINGS_WAITING = 3 };

struct coupling_function;

/** What a slave follows, and by which function. This and the first link fill two cache lines. */
typedef struct follow {
    _Alignas(CM1E_CACHE_LINE) const struct coupling_function *function; /**< NULL: nothing */
    position_t anchor;             /**< position of the slave from which the coupling function counts */
    uint8_t count;                 /**< of its links */
    bool to_position;              /**< the catch-up ends with position 0 (mcRampIn). Otherwise the distance that was
                                        lost is not made up: at the end it becomes a part of the anchor */
    bool in_step;                  /**< the coupling function itself is what was commanded: the approach is over */
    bool by_actual;                /**< the slave follows the actual value of a master, which has no limit of jerk */
    bool waits_for_end;            /**< waiting commands begin at EndOfProfile (cams), not at InSync */
    bool linear;                   /**< the acceleration of the cam jumps, so no limit of jerk applies */
    link_t links[LINKS];
    cam_place_t cam;
    approach_t approach;
} follow_t;

/** How hard a master may brake; u/s2. */
typedef struct coupling_braking {
    double own;          /**< of the slave: what it can do, and all that follow it in turn */
    double gentle, hard; /**< of the master */
    int *steps;          /**< cm1e_cam_braking_t */
} coupling_braking_t;

/** A coupling function. */
typedef struct coupling_function {
    /** Computes the slave's set-point for the masters as seen in this cycle. At the end of an approach or of a
     *  single-shot cam it also changes the coupling. */
    void (*evaluate)(cm1e_axis_t *axis, follow_t *follow, from_t *point);
    /** The maximum of |u of the slave per u of the master of this link|. */
    double (*steepest)(const cm1e_axis_t *axis, const follow_t *follow, int link);
    /** evaluate() in an ordinary cycle: it ends with cm1e_coupling_put(), and returns true. It is a function of its
     *  own, so that the set-point stays in registers. */
    bool (*ordinary)(cm1e_axis_t *axis, follow_t *follow);
    /** The bounds of the slave's motion while its only master is on this course; no bound of jerk: infinite. false:
     *  they are not known ahead. */
    bool (*bounds)(const cm1e_axis_t *axis, const follow_t *follow, const course_t *master, cm1e_motion_bounds_t *most);
    /** u/s2: the deceleration of the only master, from `gentle` to `hard`, that lets the slave brake no harder than
     *  `own` until the master stands. NULL: all places are as steep as the steepest one. */
    double (*braking)(const cm1e_axis_t *axis, const follow_t *follow, const coupling_braking_t *asked);
} coupling_function_t;

/** The catch-up: difference to the coupling function, in the frame that moves with it; u. */
typedef struct catch_up {
    bool on;
    bool made_up;                  /**< its position is brought to 0 too: lost distance is made up */
    bool to_place;                 /**< the profile makes up distance, while the velocity of the function is constant */
    bool momentary;                /**< made up is the velocity first, with the limits that the cam leaves here */
    bool held_back;                /**< the function needs more of the limits than when this was planned */
    int64_t cycles;
    cm1e_motion_state_t now;
    cm1e_motion_limits_t asked;    /**< limits of the command */
} catch_up_t;

/** Why a master cannot be followed; for the text. */
typedef enum master_trouble {
    MASTER_GOOD = 0,
    MASTER_DESTROYED,
    MASTER_ERROR_STOP,
    MASTER_STOPPING,               /**< the master is in ErrorStop, but still on its ramp, which can be seen */
    MASTER_FREE,                   /**< the master has no torque, so it has no set value */
    MASTER_HOMING,                 /**< the master is homed by its drive */
    MASTER_UNSEEN,                 /**< the actual position of the master is unknown */
    MASTER_JUMPED,
} master_trouble_t;

/** The data of a waiting coupling in addition to its move. */
typedef struct waiting_coupling {
    cm1e_command_id_t id;
    cm1e_axis_coupling_t coupling;
} waiting_coupling_t;

/** MC_PhasingAbsolute, MC_PhasingRelative: the motion that changes the phase shift; u of the master. */
typedef struct phasing {
    double origin;                 /**< where the covered distance counts from */
    cm1e_profile_t profile;
    int64_t cycles;
    move_t waiting[PHASINGS_WAITING];
    int count;
    double covered;
    cm1e_command_id_t ended;       /**< the phasing that ended last; it covered the distance `covered` */
    cm1e_command_id_t id;          /**< 0: no phasing runs; a shift that still moves belongs to no command */
    bool moving;
} phasing_t;

/** The actual value of an axis, as slaves that follow it see it. */
typedef struct observed {
    bool begun;
    cm1e_observer_t filter;
    from_t now, before;            /**< in this cycle, and in the previous one */
    uint32_t lost;                 /**< cycles in a row without a position */
    bool counted;                  /**< the counts are those of a slave */
    uint32_t sync0_ns;             /**< period of its SYNC0, with which it takes them; 0: a frame does */
    int32_t shift_ns;              /**< cm1e_slave_clock_t.shift_ns */
    int64_t taken_ns, planned_ns;  /**< when the last counts were taken; the start of the last cycle */
} observed_t;

/** What an axis needs to be followed. Every axis has it, also one that follows nothing. */
typedef struct followed {
    link_t *slaves;                /**< the slaves of this axis */
    uint64_t mark;                 /**< the last search that visited this axis */
    observed_t own;
    char other_name[CM1E_NAME_LENGTH]; /**< name of a master that was lost, or of the axis because of which this one
                                            stops */
} followed_t;

/** The couplings of an axis, made with it unless the configuration says that it follows nothing. The first cache line
 *  has what every cycle needs. The end of `phasing`, the beginning of `catch_up` and the present `follow_t` have the
 *  rest of it. */
typedef struct coupling {
    follow_t *now;                 /**< the present coupling, or the last one; NULL: there was none */
    cm1e_motion_state_t phase;     /**< u of the master: phase shift of links[0], while it is followed */
    double f_velocity, f_acceleration; /**< u/s, u/s2; of the coupling function, in the last cycle */
    bool end_of_profile;           /**< the cam passed an end of its profile in this cycle */
    bool stopping;                 /**< in ErrorStop; the coupling goes on until the masters stand (keep_ratio) */
    bool keeps_ratio;              /**< CM1E_COUPLING_STOP_KEEP_RATIO, of the configuration */
    bool due;                      /**< the awaited command begins in this cycle */
    bool at_end;                   /**< the coupling in preparation waited for that end of the profile */
    bool left_behind;              /**< a master on another bus went on while the slave was silent */
    bool was_in_step;              /**< it was in step at least once since this coupling began */
    bool ordinary;                 /**< all cycles are decided ahead on these courses of the slave and of its master */
    uint32_t course, masters_course;
    follow_t *awaited;             /**< coupling of the first waiting command, if it begins at a place of its master
                                        (StartSync) and the active command goes on until then (cm1e_axis_t.awaits) */
    phasing_t phasing;             /**< the motion that changes the phase */
    catch_up_t catch_up;
    cm1e_profile_t plan;           /**< of the catch-up; beside it, so that a copy of the catch-up is short */
    follow_t follows[FOLLOWS];     /**< places in turn, because links are in lists and must not move */
    cams_t *cams;                  /**< the cams of this axis; NULL: it follows no cams */
    cm1e_error_t due_error;        /**< the error with which the awaited command fails; CM1E_OK: it begins */
    uint32_t searches;             /**< for loops of followers, that began at this axis */
    cm1e_axis_coupling_t inputs;   /**< of the active command, for ContinuousUpdate */
    waiting_coupling_t waiting[COUPLINGS_WAITING];
    master_trouble_t trouble;      /**< the reason why a master was lost */
    cm1e_error_t master_error;     /**< error of that master */
    approach_refused_t approach_refused;
    int32_t numerator;             /**< numerator and denominator of a ratio that was refused */
    uint32_t denominator;
    uint32_t settling;             /**< cycles left in which lost frames or a pause disturb the estimate of an actual
                                        value, so that the slave follows only its velocity */
} coupling_t;

/** Whether memory was set aside for a command that makes the axis follow (cm1e_axis_config_t.follows). */
static inline bool coupling_can(const cm1e_axis_t *slave, cm1e_command_kind_t kind)
{
    return slave->coupling && (kind != CM1E_COMMAND_CAM_IN || slave->coupling->cams);
}

/* cam_memory.c */
/** Explains that the axis has no memory for a coupling. `what`: what was refused. */
void cm1e_no_couplings_text(const cm1e_axis_t *axis, const char *what, char *text, size_t size);

/* master.c */
/** Whether the frames of all masters come. The slave is not in step with a master whose position is only assumed. */
static inline bool coupling_sees_all(const follow_t *follow)
{
    for (int i = 0; i < follow->count; i++)
        if (follow->links[i].assumed != SEEN)
            return false;
    return true;
}
/** Advances the masters of the present and of the awaited coupling, unless they have advanced in this cycle. */
void cm1e_coupling_advance_masters(cm1e_axis_t *axis);
/** Lets the masters begin anew before their slave (axis_pause.c). `pause_ns` 0: after silence. */
void cm1e_coupling_resume_masters(cm1e_axis_t *axis, int64_t pause_ns);
/** Lets the slaves that follow this axis begin anew after silence. */
void cm1e_coupling_resume_slaves(cm1e_axis_t *axis);
/** Lets the slaves catch up with this axis, whose velocity has changed by a step. */
void cm1e_coupling_begin_slaves_anew(cm1e_axis_t *axis);
/** The bus of the slave is silent. Remembers whether a master on another bus goes on meanwhile. */
void cm1e_coupling_fall_behind(cm1e_axis_t *axis);
/** Renews what the slave assumes of masters on other buses. true: an assumption has changed, or a master went on while
 *  the slave was silent. */
bool cm1e_coupling_settle(cm1e_axis_t *axis);
/** The bus of the slave is silent, and its masters have advanced. The slave is not in step with a master on another bus
 *  that moves. */
void cm1e_coupling_held(cm1e_axis_t *axis);
/** Whether a master began anew in this cycle, or is followed by its actual value. */
bool cm1e_coupling_begins_anew(const cm1e_axis_t *axis);
bool cm1e_coupling_sees_trouble(cm1e_axis_t *axis); /* coupled_step.c */
/** Fills in a master of a `follow` that is not in force yet: its origin and its view, for the slave's present
 *  set-point. After the errors CM1E_ERROR_AXIS_MASTER, _COUPLING_CYCLE, _MASTER_LOST and CM1E_ERROR_INVALID_ARGUMENT
 *  nothing has changed. */
cm1e_error_t cm1e_coupling_link(cm1e_axis_t *slave, follow_t *follow, const cm1e_coupling_master_t *master);
/** Makes the slave's view of all its masters in this cycle. */
master_trouble_t cm1e_coupling_see(cm1e_axis_t *slave, follow_t *follow);
/** Makes that view without advancing the masters. */
master_trouble_t cm1e_coupling_look(cm1e_axis_t *slave, follow_t *follow);
/** The same where the slave begins anew, but for a master that has gone on in this cycle already. */
master_trouble_t cm1e_coupling_look_anew(cm1e_axis_t *slave);
void cm1e_coupling_list_links(follow_t *follow);
void cm1e_coupling_unlist_links(follow_t *follow);
/** Removes the axis from all couplings, as a master and as a slave. @rt init */
void cm1e_coupling_unlink(cm1e_axis_t *axis);
/** The spare place, for a coupling in preparation. */
follow_t *cm1e_coupling_spare(cm1e_axis_t *axis);
/** The coupling of the first waiting command now waits for its master. */
void cm1e_coupling_await(cm1e_axis_t *axis, follow_t *follow);
/** No coupling waits for its master any more. */
void cm1e_coupling_await_nothing(cm1e_axis_t *axis);

/* coupled_step.c */
extern const source_t cm1e_source_coupling; /**< set-points from a coupling */
/** Whether the limit of jerk applies. A ramp of ErrorStop has no such limit, so neither has an axis that follows it. */
static inline bool coupling_keeps_jerk(const coupling_t *c)
{
    return !c->now->linear && !c->now->by_actual && !c->stopping;
}
/** Whether what moves beside the function ends the acceleration before the maximum velocity with the jerk of the
 *  axis. The actual value of a master has no limit of jerk, but the catch-up and a superimposed motion are plans of
 *  the axis. */
static inline bool coupling_eases(const coupling_t *c) { return !c->now->linear && !c->stopping; }
/** Whether the slave was not in step yet since its approach began, or ends its approach in this cycle. Where the master
 *  asks for too much on the curve of the approach, the slave leaves the curve and makes up what it lags: it may be late
 *  then. */
static inline bool coupling_approaches(const cm1e_axis_t *follower)
{
    return follower->setpoint.synchronizing && !follower->coupling->stopping;
}
/** Whether the slave gives way to its maximum velocity, acceleration and jerk: it has something to make up, or
 *  approaches. In step it follows exactly or not at all. */
static inline bool coupling_gives_way(const cm1e_axis_t *follower)
{
    return follower->coupling->catch_up.on || coupling_approaches(follower);
}
/** Puts the coupling `follow` in force. The difference to the state `from` becomes the catch-up. The caller changes the
 *  active command. */
void cm1e_coupling_follow(cm1e_axis_t *axis, follow_t *follow, const from_t *from, const cm1e_motion_limits_t *asked);
/** Notices that the frames of another bus stop or come back. The slave goes on without a step of its set-point. */
void cm1e_coupling_look_across(cm1e_axis_t *axis);
/** Makes the set-point of the cycle in which a coupling began, without advancing its masters. */
void cm1e_coupling_first_set_point(cm1e_axis_t *axis);

/* coupled_sum.c */
/** The set-point of the axis: the coupling function at `f`, the present catch-up, and what is superimposed. */
from_t cm1e_coupled_sum(const cm1e_axis_t *axis, const from_t *f);
/** Makes the set-point of a rare cycle: with a catch-up or a superimposed motion, or close to a limit. Both advance by
 *  a cycle, so that the sum keeps the limits if possible; else the result tells the limit that it breaks. */
guard_t cm1e_coupled_judge(cm1e_axis_t *axis, const from_t *f, from_t *next);

/* coupling_catch_up.c */
/** How the catch-up may go on in a cycle, in the order in which it is tried: by its plan; by a new plan with the whole
 *  jerk, which may act against the jerk of the coupling function; by a new plan with the jerk that the function leaves,
 *  and with parts of it, because the function may have begun its jerk within the cycle; without jerk, but for giving
 *  way where the function takes all of a limit. */
typedef enum attempt {
    AS_PLANNED = 0, WITH_ALL_JERK, WITH_JERK_LEFT, WITH_HALF_OF_IT, WITH_QUARTER_OF_IT, WITHOUT_JERK, ATTEMPTS
} attempt_t;
/** What becomes of the distance between axis and coupling function at the beginning of a catch-up. */
typedef enum distance_rule {
    DISTANCE_IS_LOST = 0,          /**< it is not made up: the coupling function begins at the position of the axis */
    DISTANCE_IS_MADE_UP,
} distance_rule_t;
/** What the catch-up of a cam brings to 0 first. */
typedef enum catch_up_order {
    ALL_TOGETHER = 0,              /**< position and velocity, within what the whole cam leaves of the limits */
    VELOCITY_FIRST,                /**< with all that the cam leaves at this place: a master on another bus may have
                                        changed its velocity anywhere in the cam */
} catch_up_order_t;
/** Begins the catch-up from the state `from`. */
void cm1e_catch_up_begin(cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *asked,
                         distance_rule_t rule, catch_up_order_t order);
/** Advances the catch-up by a cycle in which the coupling function comes to `f`. */
void cm1e_catch_up_step(cm1e_axis_t *axis, const from_t *f, attempt_t attempt);
/** Called after the set-point of a cycle with a catch-up: ends it, or plans it anew, if its profile has ended. */
void cm1e_catch_up_after(cm1e_axis_t *axis, const from_t *f);
/** u/s3; the smallest jerk that explains what the coupling function did in this cycle, if the jerk changes at most once
 *  within it. */
double cm1e_coupling_jerk(const cm1e_axis_t *axis, const from_t *f);

/* coupling_ordinary.c */
/** Writes the set-point of an ordinary cycle: that of the coupling function. */
static inline void cm1e_coupling_put(cm1e_axis_t *follower, const from_t *f)
{
    follower->coupling->f_velocity = f->velocity;
    follower->coupling->f_acceleration = f->acceleration;
    cm1e_axis_put_set_point(follower, f);
}
/** source_t.ordinary of followers. */
bool cm1e_coupling_ordinary_step(cm1e_axis_t *axis, axis_otherwise_t otherwise);
/** Called after a step that was not ordinary: decides whether the next ones are, if that can be told anew. */
void cm1e_coupling_look_ahead(cm1e_axis_t *axis);

/* coupling_command.c */
cm1e_error_t cm1e_coupling_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_coupling_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
/** Begins a waiting coupling. `from` is the state at the end of the command before it, `late_s` before the present
 *  set-point. */
cm1e_error_t cm1e_coupling_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double late_s);
/** Whether the first waiting command, a coupling that could begin at `from`, waits for its master. */
bool cm1e_coupling_awaits(cm1e_axis_t *axis, const from_t *from, double late_s);
/** Takes changed inputs over (ContinuousUpdate). */
cm1e_error_t cm1e_coupling_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);

/* observe.c */
/** Updates the actual value that slaves see. Called with the inputs of every cycle. */
void cm1e_coupling_observe(cm1e_axis_t *axis);
/** Cycles after which the estimates of the masters show no more of a disturbance. */
uint32_t cm1e_coupling_settles_in(const cm1e_axis_t *axis);
double cm1e_coupling_observed_velocity(const cm1e_axis_t *axis);
/** The actual state of a master in this cycle, or in the previous one. MASTER_UNSEEN: no value has arrived for too
 *  long. */
master_trouble_t cm1e_coupling_see_actual(cm1e_axis_t *master, bool of_this_cycle, from_t *seen);

/* phasing.c */
cm1e_error_t cm1e_phasing_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
/** Advances the phase shift. Called before the masters are looked at. */
void cm1e_phasing_step(cm1e_axis_t *axis);
/** Ends running and waiting phasings. If the axis still follows, the shift is braked to rest. */
void cm1e_phasing_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** Phasings end with CommandAborted, and the shift stays as it is. */
void cm1e_phasing_stand(cm1e_axis_t *axis);
/** Ends the shift, because the axis leaves that master. */
void cm1e_phasing_forget(cm1e_axis_t *axis);
/** The status of a phasing; false: `id` neither runs nor waits. */
bool cm1e_phasing_status(const cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_status_t *status);
/** The distance that an ended phasing covered; 0: it was not the last one that ended. */
double cm1e_phasing_covered(const cm1e_axis_t *axis, cm1e_command_id_t id);
/** Explains the phasing that was refused for its numbers; false: none was. */
bool cm1e_phasing_text(const cm1e_axis_t *axis, char *text, size_t size);

/* gear.c */
/** Prepares a gear or a combination that begins at `from`, in the spare place. */
cm1e_error_t cm1e_gear_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                               const from_t *from);
/** MC_GearOut, MC_CamOut: leaves the masters and keeps the velocity. */
cm1e_error_t cm1e_gear_out(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);

/* coupling_approach.c */
/** Prepares a gear that is in step from a given position of both axes on. */
cm1e_error_t cm1e_gear_in_pos_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                                      const from_t *from);
/** Puts an approach before a prepared coupling. The approach begins at once (`approach.awaited` is AWAIT_NOTHING), or
 *  it is awaited. */
cm1e_error_t cm1e_coupling_approach_prepare(cm1e_axis_t *axis, follow_t *follow, const move_t *move,
                                            const from_t *from);
/** Begins the approach at the present view of the master. CM1E_ERROR_AXIS_SYNC_WAY: it would break a limit. */
cm1e_error_t cm1e_coupling_approach_begin(cm1e_axis_t *axis, follow_t *follow, const move_t *move,
                                          const from_t *from);
/** Called after the set-point of every cycle while a coupling waits for its master. */
void cm1e_coupling_await_step(cm1e_axis_t *axis);

/* cam_function.c */
/** Prepares a cam, as cm1e_gear_prepare() does a gear. */
cm1e_error_t cm1e_cam_in_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                                 const from_t *from);
/** Takes new offsets and scalings from the present set-point on; during an approach, from its end on. Other changed
 *  inputs wait for the next edge of Execute. CM1E_ERROR_AXIS_RATIO, _POSITION_RANGE: nothing has changed. */
cm1e_error_t cm1e_cam_in_update(cm1e_axis_t *axis, const cm1e_axis_coupling_t *coupling);
/** Where the cam has the slave when the master is there (counts of the link), and how it goes on: but for the place. */
void cm1e_cam_in_enter(follow_t *follow, double counts);
void cm1e_cam_in_point(const cm1e_axis_t *axis, const follow_t *follow, double counts, position_t *position,
                       cm1e_curve_point_t *point);

/* coupling_stop.c */
/** Stops the other axes that have to stop when this follower has failed. */
void cm1e_coupling_failed(cm1e_axis_t *axis);
/** Whether the axis, now in ErrorStop, follows a master that stops to its standstill. false: it has to stop alone. */
bool cm1e_coupling_follows_to_the_end(cm1e_axis_t *axis, master_trouble_t trouble);
/** Whether a slave in step that would break this limit brakes with its master instead, from the next cycle on. */
bool cm1e_coupling_brakes_with_master(const cm1e_axis_t *axis, guard_t guard);
/** Makes the set-point of the cycle before that, as near to the function as the velocity allows. */
guard_t cm1e_coupling_before_braking(const cm1e_axis_t *axis, const from_t *f, from_t *next);
/** Called after every set-point: brakes master and slave together because of the limit `broken`, or if this is the last
 *  set-point from which they can stop before a software limit. */
void cm1e_coupling_keep_ratio(cm1e_axis_t *axis, guard_t broken);

/* coupling_text.c */
/** coupling_hooks_t.text. */
bool cm1e_coupling_text(const cm1e_axis_t *axis, cm1e_error_t error, bool refused, char *text, size_t size);

#endif
