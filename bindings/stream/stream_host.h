/**
 * @file stream_host.h
 * The bus of a control in a thread of the same process, for C and C++. The control opens it, then writes a command and
 * reads the state in each of its periods. One thread calls all of these functions at a time; reading and writing never
 * wait.
 */
#ifndef CM1E_STREAM_HOST_H
#define CM1E_STREAM_HOST_H

#include <stddef.h>

#include "stream_types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct stream_host stream_host_t;

/** A zero in any field selects the default; see stream_options_t. Texts are copied. */
typedef struct stream_host_config {
    const char *bus_file, *interface_name;
    double delay_periods, tolerance;
    int64_t timeout_ns;
    int64_t period_ns;          /**< of the control; 0: the cycle of the bus */
    int realtime_priority, cpu;
    /** Called in the thread of the bus. It must return, and call nothing of this header: stream_host_close() waits for
     *  that thread. */
    void (*say)(void *context, const char *sentence);
    void *context;
} stream_host_config_t;

/** Starts the bus, and returns when it runs. NULL: `why` says what is wrong. Free it with stream_host_close(). */
stream_host_t *stream_host_open(const stream_host_config_t *config, char *why, size_t size);
/** Ramps all axes down, disables them and stops the bus. NULL is allowed. */
void stream_host_close(stream_host_t *host);
/** Whether the bus still runs. */
bool stream_host_runs(const stream_host_t *host);
uint32_t stream_host_axis_count(const stream_host_t *host);
/** Name of an axis in lower case; "": there is none with this number. */
const char *stream_host_axis_name(const stream_host_t *host, uint32_t axis);
/** Commands a period. false: the bus does not take commands. */
bool stream_host_write(stream_host_t *host, const stream_command_t *command);
/** Reads the newest state. false: there is no newer one, and `state` stays. */
bool stream_host_read(stream_host_t *host, stream_state_t *state);

#ifdef __cplusplus
}
#endif
#endif
