/**
 * @file py_session.h
 * A bus with its scheduler for Python, owned by one thread of its own. Python's threads hand it jobs. Between the jobs
 * it waits, or runs the cycle: in real time it looks for one job per cycle, without a lock; on virtual time it waits in
 * its program until it is granted cycles. No function here touches Python, so the cycle never waits for its interpreter.
 *
 * Any thread may call these functions; they wait, and none of them is for a task.
 */
#ifndef CM1E_PY_SESSION_H
#define CM1E_PY_SESSION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/axis.h"
#include "cm1e/bus.h"
#include "cm1e/generate.h"
#include "cm1e/group.h"
#include "cm1e/io.h"
#include "cm1e/log.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"

typedef struct cm1e_py_session cm1e_py_session_t;

/** Opens a bus. `config` is copied. Free the session with cm1e_py_free(). */
cm1e_error_t cm1e_py_open(cm1e_py_session_t **session, const cm1e_bus_config_t *config, cm1e_diag_t *diag);
/** Opens another network, whose axes are behind those of the first one, before a scan and the run. */
cm1e_error_t cm1e_py_add(cm1e_py_session_t *session, const cm1e_bus_config_t *config, cm1e_diag_t *diag);
/** The network that calls of this thread concern from now on: 0 = first. */
void cm1e_py_select(uint32_t network);
/** Finds the slaves and brings them to Pre-Operational, without starting a run. */
cm1e_error_t cm1e_py_scan(cm1e_py_session_t *session, cm1e_diag_t *diag);
/** Brings the slaves to Operational and runs the cycle. On virtual time the first cycle waits for its grant. Returns
 *  CM1E_ERROR_STATE if the session has run before. */
cm1e_error_t cm1e_py_begin(cm1e_py_session_t *session, const cm1e_scheduler_config_t *config, cm1e_diag_t *diag);
/** Ends the run in order: axes ramp down, drives are disabled. Returns what the run ended with; CM1E_OK if there was
 *  none. */
cm1e_error_t cm1e_py_end(cm1e_py_session_t *session, cm1e_diag_t *diag);
/** Ends the run and closes the bus. Afterwards every function returns CM1E_ERROR_STATE. */
cm1e_error_t cm1e_py_close(cm1e_py_session_t *session, cm1e_diag_t *diag);
/** Closes and frees. NULL is allowed. */
void cm1e_py_free(cm1e_py_session_t *session);

/** Whether the cycle runs. */
bool cm1e_py_runs(cm1e_py_session_t *session);
/** Time of the present cycle since the first one, in ns. */
cm1e_error_t cm1e_py_time(cm1e_py_session_t *session, int64_t *time_ns);

/* ---- blocks ------------------------------------------------------------------------------------------------------ */

/** A function block that Python owns. */
typedef struct cm1e_py_block {
    void (*call)(void *fb);
    void *fb;
    const uint32_t *ends; /**< offsets of BOOL outputs that somebody waits for */
    uint32_t end_count;
    int ended;            /**< one of them is TRUE since the last call; read it with cm1e_py_block_ended() */
} cm1e_py_block_t;

/** A copy that the cycle makes: into a block, or out of it. */
typedef struct cm1e_py_copy {
    void *to;
    const void *from;
    size_t size;
} cm1e_py_copy_t;

/** The function of a block type, "MC_Power"; NULL: there is none. */
void (*cm1e_py_call_of(const char *type))(void *fb);
/** Blocks that a program attaches, and those beside them that execute commands. */
enum { CM1E_PY_BLOCKS = 512, CM1E_PY_COMMANDS = 1024 };
/** Lets the cycle call a block in every cycle from now on, behind those before. CM1E_ERROR_FULL: there is no room for more
 *  than CM1E_PY_BLOCKS + CM1E_PY_COMMANDS. */
cm1e_error_t cm1e_py_block_add(cm1e_py_session_t *session, cm1e_py_block_t *block);
/** Ends that. A block that is not called is no error. */
cm1e_error_t cm1e_py_block_remove(cm1e_py_session_t *session, cm1e_py_block_t *block);
/** Ends that with a last call, for which its BOOL at `input` (Execute or Enable) is FALSE. Then the block, which has `size`
 *  bytes, is as it was before that call; `saved` has room for it. */
cm1e_error_t cm1e_py_block_release(cm1e_py_session_t *session, cm1e_py_block_t *block, void *saved, size_t size,
                                   size_t input);
/** Copies between two calls of blocks; `block` may be NULL, otherwise it is not ended until its next call. */
cm1e_error_t cm1e_py_transfer(cm1e_py_session_t *session, const cm1e_py_copy_t *copies, size_t count,
                              cm1e_py_block_t *block);
/** Calls a block once, in the present cycle. */
cm1e_error_t cm1e_py_block_call(cm1e_py_session_t *session, cm1e_py_block_t *block);
bool cm1e_py_block_ended(const cm1e_py_block_t *block);
/** On virtual time: runs so many cycles, fewer if `block` (may be NULL) ends. Returns how many. CM1E_ERROR_STATE: no
 *  cycle runs, or not on virtual time. */
cm1e_error_t cm1e_py_advance(cm1e_py_session_t *session, uint64_t cycles, const cm1e_py_block_t *block,
                             uint64_t *advanced);
/** In real time: waits until a block ends (true) or for so long (false). */
bool cm1e_py_wait(cm1e_py_session_t *session, const cm1e_py_block_t *block, int64_t timeout_ns);

/* ---- axes, groups, signals --------------------------------------------------------------------------------------- */

/** References and values of the axes, in their order; `*count` is the room, then the number of axes. */
cm1e_error_t cm1e_py_axes(cm1e_py_session_t *session, AXIS_REF_t *references, cm1e_axis_info_t *infos, uint32_t *count);
/** Makes an axes group, before the run. It lives as long as the bus. */
cm1e_error_t cm1e_py_group(cm1e_py_session_t *session, AXES_GROUP_REF_t *group, const char *name, cm1e_diag_t *diag);
cm1e_error_t cm1e_py_group_read(cm1e_py_session_t *session, AXES_GROUP_REF_t group, cm1e_group_info_t *info);
/** As cm1e_axis_error_text() and cm1e_group_error_text(), between two cycles; "" after the bus was closed. In real time
 *  the cycle needs some microseconds for it. */
void cm1e_py_error_text(cm1e_py_session_t *session, AXIS_REF_t axis, AXES_GROUP_REF_t group, char *text, size_t size);

/** Lists signal `n` (0 = first) of all slaves; CM1E_ERROR_NOT_FOUND: there are not so many. */
cm1e_error_t cm1e_py_io_at(cm1e_py_session_t *session, uint32_t n, cm1e_io_info_t *info);
cm1e_error_t cm1e_py_io_find(cm1e_py_session_t *session, const char *name, cm1e_io_t *io, cm1e_diag_t *diag);
/** A value in all forms that cm1e/io.h has. */
typedef struct cm1e_py_io_value {
    int64_t integer;
    double real;
    cm1e_io_quality_t quality;
} cm1e_py_io_value_t;
cm1e_error_t cm1e_py_io_read(cm1e_py_session_t *session, const cm1e_io_t *io, cm1e_py_io_value_t *value);
cm1e_error_t cm1e_py_io_write_integer(cm1e_py_session_t *session, const cm1e_io_t *io, int64_t value);
cm1e_error_t cm1e_py_io_write_real(cm1e_py_session_t *session, const cm1e_io_t *io, double value);

/* ---- the rest ---------------------------------------------------------------------------------------------------- */

/** Copies what the scan found of a slave. CM1E_ERROR_NOT_FOUND: no such slave. */
cm1e_error_t cm1e_py_slave(cm1e_py_session_t *session, uint32_t position, cm1e_slave_info_t *info);
/** Executes an SDO transfer; on virtual time cycles pass meanwhile. `size` as of cm1e_sdo_read(). */
cm1e_error_t cm1e_py_sdo(cm1e_py_session_t *session, cm1e_sdo_t *sdo, cm1e_diag_t *diag);
/** A file in a slave (FoE). `size`: of what is written, or the room for what is read, then what came. */
typedef struct cm1e_py_file {
    uint16_t position;
    const char *name;
    void *data;
    size_t size;
    bool write, bootstrap;
    uint32_t password;
    int64_t answer_ns;    /**< longest time for one answer; 0: the library's */
} cm1e_py_file_t;
/** Transfers it, before, during and behind a run; on virtual time cycles pass meanwhile. Bootstrap only before a run. */
cm1e_error_t cm1e_py_file(cm1e_py_session_t *session, cm1e_py_file_t *file, cm1e_diag_t *diag);
/** As cm1e_diff_file(): after a scan, before the run. */
cm1e_error_t cm1e_py_compare(cm1e_py_session_t *session, cm1e_findings_t **findings, const void *bytes, size_t size,
                             uint16_t position, cm1e_diag_t *diag);
/** As cm1e_bus_simulate(). */
cm1e_error_t cm1e_py_simulate(cm1e_py_session_t *session, const char *line, char *answer, size_t size);
cm1e_error_t cm1e_py_probe(cm1e_py_session_t *session, uint32_t position, cm1e_sim_probe_t *probe);
cm1e_error_t cm1e_py_statistics(cm1e_py_session_t *session, cm1e_scheduler_statistics_t *statistics);
/** As cm1e_log_read() and cm1e_log_text(), one record: the one after `after`. CM1E_ERROR_NOT_FOUND: there is none. */
cm1e_error_t cm1e_py_log(cm1e_py_session_t *session, uint64_t after, cm1e_log_event_t *event, char *text, size_t size);
/** Writes the trace: "npy", "csv", "svg" or "html". In real time only after the run. */
cm1e_error_t cm1e_py_write_trace(cm1e_py_session_t *session, const char *format, const char *path, cm1e_diag_t *diag);
/** Before the run, which begins with it: an object in the process data of an axis is recorded too. */
cm1e_error_t cm1e_py_trace_object(cm1e_py_session_t *session, const char *axis, uint16_t index, uint8_t subindex,
                                  cm1e_diag_t *diag);

#endif
