/**
 * @file py_owner.h
 * The thread that owns the bus of a session, and how it is given jobs.
 */
#ifndef CM1E_PY_OWNER_H
#define CM1E_PY_OWNER_H

#include <pthread.h>
#include <stdatomic.h>

#include "py_session.h"

enum { PY_GROUPS = 32, PY_TRACED = 64 };

/** What the owner is asked to do: act(session, argument), whose result comes back. */
typedef struct py_job {
    cm1e_error_t (*act)(cm1e_py_session_t *session, void *argument);
    void *argument;
    uint32_t network;                /**< that the caller has selected: its bus is that of the session meanwhile */
    cm1e_error_t result;
    atomic_bool done;
} py_job_t;

/** An object that is to be recorded. */
typedef struct py_traced {
    char axis[CM1E_NAME_LENGTH];
    uint16_t index;
    uint8_t subindex;
} py_traced_t;

struct cm1e_py_session {
    pthread_t owner;
    pthread_mutex_t callers;         /**< one job at a time */
    pthread_mutex_t mutex;           /**< of all below that is not atomic; the cycle in real time does not take it */
    pthread_cond_t changed;
    cm1e_bus_t *bus;                 /**< of the job that is done, else the first one; NULL: closed */
    cm1e_bus_t *buses[CM1E_MAX_BUSES]; /**< of all networks; their number is the owner's */
    uint32_t bus_count;
    cm1e_scheduler_t *scheduler;     /**< NULL: not begun, or closed */
    bool virtual_time, joined;
    bool waits;                      /**< the owner waits for jobs, on virtual time perhaps in its program */
    bool begin, quit, ran;           /**< what the owner does next; a run has been tried */
    atomic_bool running, in_cycle;   /**< a run has not ended; its program was called */
    atomic_bool stopping;
    uint32_t guests;                 /**< transfers that use the bus beside the owner */
    uint64_t granted, advanced;      /**< cycles, on virtual time */
    const cm1e_py_block_t *watched;  /**< ends the grant; NULL: nothing does */
    _Atomic(py_job_t *) job;
    cm1e_error_t result;             /**< of the run */
    cm1e_diag_t diag;
    cm1e_py_block_t *blocks[CM1E_PY_BLOCKS + CM1E_PY_COMMANDS]; /**< the owner's own, like all below */
    uint32_t block_count;
    AXES_GROUP_REF_t groups[PY_GROUPS];
    uint32_t group_count;
    py_traced_t traced[PY_TRACED];
    uint32_t traced_count;
};

/** Starts the owner, which waits for jobs. */
cm1e_error_t py_owner_begin(cm1e_py_session_t *session, cm1e_diag_t *diag);
/** Lets the owner do something, and waits for it. CM1E_ERROR_STATE: the session is closed. */
cm1e_error_t py_owner_do(cm1e_py_session_t *session, cm1e_error_t (*act)(cm1e_py_session_t *, void *), void *argument);
/** The network that the calling thread has selected, 0 = first. */
uint32_t py_owner_selected(void);
/** For a caller that waits for the cycle: on virtual time it makes a cycle, in real time it waits 0.5 ms. */
void py_owner_let_a_cycle_pass(cm1e_py_session_t *session);
/** Stops the run, if there is one, and waits for its end. */
void py_owner_end_run(cm1e_py_session_t *session);
/** Ends the owner; nothing runs any more. */
void py_owner_join(cm1e_py_session_t *session);

#endif
