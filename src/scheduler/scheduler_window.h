/**
 * @file scheduler_window.h
 * A window into a running scheduler: a guest that looks at it beside the cycle, as the control socket does. A guest
 * registers its table of functions; every run opens one window of each for each of its buses.
 */
#ifndef CM1E_SCHEDULER_SCHEDULER_WINDOW_H
#define CM1E_SCHEDULER_SCHEDULER_WINDOW_H

#include "axis/axis_watch.h"
#include "bus/bus_image.h"
#include "cm1e/log.h"
#include "cm1e/scheduler.h"

/** What a window says of itself, for the statistics. */
typedef struct cm1e_window_told {
    char *socket, *advice;
    size_t socket_size, advice_size;
} cm1e_window_told_t;

typedef struct cm1e_window {
    /** Opens a window on the bus number `bus` (0 = first) before the first cycle. NULL: this run has none. `told` says
     *  where it is, or why there is none: a run goes on without its window. @rt init */
    void *(*open)(cm1e_scheduler_t *scheduler, uint32_t bus, cm1e_window_told_t *told);
    /** Runs after the work of every cycle. @rt cycle */
    void (*cycle)(void *window);
    /** After the last cycle and the stop of the bus. @rt init */
    void (*close)(void *window);
} cm1e_window_t;

enum { CM1E_WINDOWS = 2 };

/** Makes a kind of window known; again: nothing changes. false: CM1E_WINDOWS are registered. Not while a scheduler
 *  runs.
 *  @rt init */
CM1E_GUEST_API bool cm1e_scheduler_register_window(const cm1e_window_t *window);

/** @rt any */
CM1E_GUEST_API cm1e_axis_t *const *cm1e_scheduler_axes(const cm1e_scheduler_t *scheduler, uint32_t *count);
/** Those of the bus number `bus` (0 = first), which the scheduler has; `first`: the number of its first one among all.
 *  @rt any */
CM1E_GUEST_API cm1e_axis_t *const *cm1e_scheduler_axes_at(const cm1e_scheduler_t *scheduler, uint32_t bus,
                                                          uint32_t *first, uint32_t *count);
/** 0: the bus that the scheduler was made for; then those that were added, NULL behind the last. */
CM1E_GUEST_API cm1e_bus_t *cm1e_scheduler_bus_at(const cm1e_scheduler_t *scheduler, uint32_t index);
/** What the bus number `bus` (0 = first), which the scheduler has, counted in this run; returns how often the clock of
 *  one of its slaves, or its reference, was lost. @rt any */
CM1E_GUEST_API uint64_t cm1e_scheduler_counted(const cm1e_scheduler_t *scheduler, uint32_t bus,
                                               cm1e_bus_counters_t *counters);
/** The name of a task, in the order in which they run (0 = first); "": there is none. @rt any */
CM1E_GUEST_API const char *cm1e_scheduler_task_name(const cm1e_scheduler_t *scheduler, uint32_t index);
/** The programs do not run any more, and the axes are shut down. @rt cycle */
CM1E_GUEST_API bool cm1e_scheduler_is_ending(const cm1e_scheduler_t *scheduler);
/** After a run: its programs ran for the whole duration; false: it had none, or something ended it before. */
CM1E_GUEST_API bool cm1e_scheduler_ran_its_time(const cm1e_scheduler_t *scheduler);
/** Time passes only in the cycle. @rt any */
CM1E_GUEST_API bool cm1e_scheduler_is_virtual(const cm1e_scheduler_t *scheduler);

#endif
