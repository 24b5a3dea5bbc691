/**
 * @file view.h
 * What passes between the cycle and the thread of the control socket. The cycle allocates, locks and waits for nothing:
 * it fills in a snapshot where one is wanted, and decides on an order where there is one. While nobody asks, it costs
 * ten loads.
 */
#ifndef CM1E_CONTROL_VIEW_H
#define CM1E_CONTROL_VIEW_H

#include <stdatomic.h>

#include "axis/axis_signals.h"
#include "bus/foe_job.h"
#include "cm1e/topology.h"
#include "control/guest_outputs.h"
#include "scheduler/forcing.h"
#include "scheduler/scheduler_window.h"

typedef enum view_state { VIEW_IDLE = 0, VIEW_WANTED, VIEW_FILLED } view_state_t;

struct view;

/** What the thread asks the cycle to do. The thread owns it again when it is decided. */
typedef struct view_order {
    void (*decide)(struct view *view, struct view_order *order); /**< @rt cycle */
    atomic_bool decided;
} view_order_t;

/** A write that the cycle starts, if the slave is not commanded by the program. */
typedef struct view_write {
    view_order_t order;
    cm1e_sdo_t *sdo;
    cm1e_foe_t *file;          /**< NULL: it is the object of `sdo` */
    int32_t commanded;         /**< the axis that is commanded, 0 = first; -1: none */
    cm1e_error_t result;       /**< valid when decided: of the submission, or CM1E_ERROR_AXIS_STATE */
} view_write_t;

typedef enum hold_motion { HOLD_NONE = 0, HOLD_JOG, HOLD_HOME, HOLD_END } hold_motion_t;

/** What a client moves or enables (maintain.h). The cycle's. */
typedef struct hold {
    bool held;
    uint32_t client;           /**< its place, 0 = first */
    hold_motion_t motion;      /**< END: what ends a motion */
    cm1e_command_id_t command;
    double velocity, acceleration, deceleration; /**< of a jog; u/s, u/s2; 0: the axis's */
    int64_t motion_until_ns, motion_keep_ns; /**< without renewal it ends then */
    int64_t power_until_ns, power_keep_ns;
} hold_t;

/** A jog that another client has stopped does not go on: its client has to let go of it first. The cycle's. */
typedef struct stopped {
    bool any;
    uint32_t client;           /**< that jogged */
    int64_t until_ns;          /**< unless it asks for the jog again before */
} stopped_t;

struct recorder;
enum { CM1E_CONTROL_CLIENTS = 32 };

typedef struct maintained {
    hold_t holds[CM1E_MAX_AXES];
    stopped_t stopped[CM1E_MAX_AXES];
    uint32_t count;            /**< of those that are held */
    _Atomic uint32_t gone;     /**< a bit for each client that is gone, and has left what it held */
} maintained_t;

typedef struct view {
    cm1e_scheduler_t *scheduler;
    cm1e_bus_t *bus;
    cm1e_axis_t *const *axes;
    uint32_t axis_count, slave_count;
    uint32_t first_axis;       /**< number of axes[0] in the scheduler, whose other axes are of other buses */

    uint32_t number;           /**< the thread's: of the snapshot that was wanted last */
    _Atomic int state;         /**< view_state_t. WANTED: what follows belongs to the cycle; else to the thread */
    bool begun;
    uint32_t next;             /**< axis whose text is copied next: one in a cycle, because a copy is some kilobytes */
    int64_t run_ns;
    cm1e_axis_info_t infos[CM1E_MAX_AXES];
    cm1e_axis_news_t news[CM1E_MAX_AXES];
    cm1e_axis_measures_t measures[CM1E_MAX_AXES];
    int32_t holders[CM1E_MAX_AXES]; /**< clients; -1: none */
    bool resetting[CM1E_MAX_AXES];
    bool has_text[CM1E_MAX_AXES];
    unsigned char *copies;     /**< of axes that have a text */
    size_t copy_at[CM1E_MAX_AXES]; /**< where in `copies` */
    struct {
        uint16_t al_state, al_status_code;
        cm1e_slave_clock_t clock;
    } slaves[CM1E_MAX_SLAVES];
    cm1e_bus_ring_t ring;

    maintained_t maintained;
    guest_outputs_t outputs;
    _Atomic uint32_t gone;     /**< a bit for each client that is gone, and has left variables that it forced */
    struct recorder *recorders[CM1E_CONTROL_CLIENTS]; /**< recorder.h; NULL: none */
    _Atomic uint32_t recording; /**< a bit for each of them that the cycle has */
    _Atomic(view_order_t *) order;
} view_t;

/** Of the bus number `bus`. CM1E_ERROR_NO_MEMORY. @rt init */
cm1e_error_t cm1e_view_init(view_t *view, cm1e_scheduler_t *scheduler, uint32_t bus);
void cm1e_view_free(view_t *view);
/** @rt cycle */
void cm1e_view_cycle(view_t *view);

/** Of the thread: wants a snapshot; returns the number of the first one that begins from now on. */
uint32_t cm1e_view_want(view_t *view);
/** The snapshot of this number, or a later one, is there. Whoever needs a later one than is there makes the cycle fill
 *  it in: so those that wait longest are asked first. */
bool cm1e_view_has(view_t *view, uint32_t number);
/** The text of an axis of the snapshot, "" if it has none. */
void cm1e_view_text(const view_t *view, uint32_t axis, char *text, size_t size);
/** Hands an order to the cycle; false: another one waits. */
bool cm1e_view_submit(view_t *view, view_order_t *order);
/** Takes it back from a cycle that does not run any more; false: it has been decided. */
bool cm1e_view_withdraw(view_t *view, view_order_t *order);
/** Decides on a view_write_t. @rt cycle */
void cm1e_view_decide_write(view_t *view, view_order_t *order);

#endif
