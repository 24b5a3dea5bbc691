/**
 * @file stream_bus.h
 * The bus of a control: it starts the network of a bus file, and runs its cycle in the calling thread. Every axis
 * follows the positions that come through the link (stream_link.h).
 */
#ifndef CM1E_STREAM_BUS_H
#define CM1E_STREAM_BUS_H

#include <cm1e/error.h>

#include "stream_link.h"

/** A zero in any field selects the default. */
typedef struct stream_options {
    const char *bus_file;
    const char *interface_name; /**< NULL: that of the bus file */
    double delay_periods;       /**< periods of the control that the axes are behind it, 3 ... 100; 0 selects 4 */
    double tolerance;           /**< u; so far may the control be from an axis that is enabled; 0: 1,000 counts of it */
    int64_t timeout_ns;         /**< silence of the control that stops all axes; 0 selects 20 ms, or 10 periods */
    int realtime_priority;      /**< as cm1e_scheduler_config_t */
    int cpu;                    /**< as cm1e_scheduler_config_t */
    /** Gets what happens, a sentence at a time, in a thread of its own. NULL: the standard error output. */
    void (*say)(void *context, const char *sentence);
    void *context;
} stream_options_t;

/** Runs until link->quit, a signal (`stop_on_signals`), or an error. At the end all axes are ramped down and disabled,
 *  link->phase is STREAM_ENDED, and link->text says why. Only one run per process may stop on signals. */
cm1e_error_t stream_bus_run(stream_link_t *link, const stream_options_t *options, bool stop_on_signals);

#endif
