/**
 * @file view.h
 * What passes between the cycle and the thread of the control socket. The cycle allocates, locks and waits for nothing:
 * it fills in a snapshot where one is wanted, and starts a write where one is asked for. While nobody asks, it costs
 * two loads.
 */
#ifndef CM1E_CONTROL_VIEW_H
#define CM1E_CONTROL_VIEW_H

#include <stdatomic.h>

#include "scheduler/scheduler_window.h"

typedef enum view_state { VIEW_IDLE = 0, VIEW_WANTED, VIEW_FILLED } view_state_t;

/** A write that the cycle starts, if the slave is not commanded by the program. */
typedef struct view_write {
    cm1e_sdo_t *sdo;
    int32_t commanded;         /**< the axis that is commanded, 0 = first; -1: none */
    cm1e_error_t result;       /**< valid when decided: of cm1e_sdo_submit(), or CM1E_ERROR_AXIS_STATE */
    atomic_bool decided;
} view_write_t;

typedef struct view {
    cm1e_scheduler_t *scheduler;
    cm1e_bus_t *bus;
    cm1e_axis_t *const *axes;
    uint32_t axis_count, slave_count;

    _Atomic int state;         /**< view_state_t. WANTED: what follows belongs to the cycle; else to the thread */
    bool begun;
    uint32_t next;             /**< axis whose text is copied next: one in a cycle, because a copy is some kilobytes */
    int64_t run_ns;
    cm1e_axis_info_t infos[CM1E_MAX_AXES];
    cm1e_axis_news_t news[CM1E_MAX_AXES];
    bool has_text[CM1E_MAX_AXES];
    unsigned char *copies;     /**< of axes that have a text */
    struct {
        uint16_t al_state, al_status_code;
    } slaves[CM1E_MAX_SLAVES];

    _Atomic(view_write_t *) write;
} view_t;

/** CM1E_ERROR_NO_MEMORY. @rt init */
cm1e_error_t cm1e_view_init(view_t *view, cm1e_scheduler_t *scheduler);
void cm1e_view_free(view_t *view);
/** @rt cycle */
void cm1e_view_cycle(view_t *view);

/** Of the thread: wants a snapshot, unless one is wanted already. */
void cm1e_view_want(view_t *view);
/** A snapshot that was wanted is there. */
bool cm1e_view_filled(const view_t *view);
/** The text of an axis of the snapshot, "" if it has none. */
void cm1e_view_text(const view_t *view, uint32_t axis, char *text, size_t size);
/** Hands a write to the cycle; false: another one waits. */
bool cm1e_view_submit(view_t *view, view_write_t *write);
/** Takes it back from a cycle that does not run any more; false: it has been decided. */
bool cm1e_view_withdraw(view_t *view, view_write_t *write);

#endif
