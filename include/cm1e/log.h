/**
 * @file log.h
 * The event log of a scheduler: what happened to its axes and its bus, in the order in which it happened. The cycle
 * writes fixed records into a ring; their texts are made when they are read. A record stays when the error that it
 * tells of is reset. Any thread may read, during the run and after it.
 */
#ifndef CM1E_LOG_H
#define CM1E_LOG_H

#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/scheduler.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What happened. `code`, `detail`, `value` and `bound` of the record depend on it. */
typedef enum cm1e_log_kind {
    CM1E_LOG_RUN = 0,         /**< code 1: the run began; 0: it ended */
    CM1E_LOG_STATE,           /**< of an axis; code: the new cm1e_axis_state_t, detail: the one before */
    CM1E_LOG_ERROR,           /**< of an axis; code: cm1e_error_t, detail: 0x603F of the drive, value and bound: what
                                   was found and what is allowed, 0: the error has none */
    CM1E_LOG_COMMAND,         /**< of an axis: a command became the active one; value: its position, bound: its
                                   velocity, 0: it has none */
    CM1E_LOG_OVERRUN,         /**< code: number of cycles since the last such record, detail: the total of the run
                                   (32 bits) */
    CM1E_LOG_LOST_FRAMES,     /**< of a bus, as OVERRUN; value: the number of the bus (0 = first) */
    CM1E_LOG_WORKING_COUNTER, /**< as LOST_FRAMES: cycles with a wrong working counter */
    CM1E_LOG_UNSENT_FRAMES,   /**< as LOST_FRAMES: frames that the network interface did not take */
    CM1E_LOG_OTHER_MASTER,    /**< as LOST_FRAMES: frames of another master */
    CM1E_LOG_SYNC_LOST,       /**< as LOST_FRAMES: clocks that left the reference clock, or that reference was lost */
    CM1E_LOG_EMERGENCY,       /**< of a slave, with or without an axis; code: the error code, detail: the position of
                                   the slave + 65536 times the error register + 16777216 times the number of its bus
                                   (0 = first); value: the five bytes as a number, the first one is the lowest; bound:
                                   number of emergencies of this slave that were left out since its last record */
    CM1E_LOG_PORT,            /**< faults that a port of a slave has counted; code: their number since the last such
                                   record, detail: the position of the slave + 65536 times the port + 1048576 times the
                                   number of its bus + 16777216 times the kind of fault: 0 damaged frames, 1 receive
                                   errors, 2 frames damaged before, 3 lost links */
    CM1E_LOG_RING,            /**< of a redundant ring; code 1: it is broken, 0: it is whole again; detail: the number
                                   of the bus times 16777216; value: the last slave that the first interface reaches,
                                   bound: the first one of the second interface; both 0: not known */
    CM1E_LOG_SLAVE,           /**< a slave came, went, waits or was refused; code: the new cm1e_presence_t, detail: its
                                   position + 16777216 times the number of its bus; bound: number of its changes that
                                   were left out since its last record */
    CM1E_LOG_STRANGER,        /**< a device that is none of the configured slaves was refused; code: its product code,
                                   detail: its place on the wire + 16777216 times the number of the bus, value: its
                                   vendor, bound: 65536 times its explicit device ID + its alias */
    CM1E_LOG_VARIABLE,        /**< a variable of the program was released (code 0), forced (1) or written (2) from
                                   outside; detail: its number among all variables of the program (0 = first, as in
                                   `from` of `variables`: docs/CONTROL.md), value: the value. An integer of 64 bits is
                                   value + bound: value has its upper 53 bits, bound the lower 11 */
    CM1E_LOG_TASK,            /**< a task did not return in time and was ended; code: its place among the tasks in the
                                   order in which they run (0 = first), value: the time that it had, in ms */
    CM1E_LOG_KIND_COUNT,
} cm1e_log_kind_t;

/** A record. A counter gets at most one record in 100 ms, so that a lost bus does not push out everything else; what is
 *  not recorded yet is recorded at the end of the run. A slave that sends many emergencies, or that comes and goes
 *  often, is limited too: eight of each get a record, then only the newest one in each second, with the number of those
 *  that were left out. */
typedef struct cm1e_log_event {
    uint64_t number;          /**< counts from 1 without gaps */
    int64_t time_ns;          /**< since 1970 (UTC); on virtual time since its beginning */
    int64_t run_ns;           /**< since the first cycle */
    double value, bound;
    cm1e_log_kind_t kind;
    int32_t axis;             /**< 0 = first; -1: none */
    int32_t code;
    uint32_t detail;
} cm1e_log_event_t;

/** Number of records that the ring holds: the last ones. */
enum { CM1E_LOG_EVENTS = 1024 };

/** Copies the records after the one with number `after` (0: all that there are), oldest first, at most `room`. Returns
 *  how many there are in `events`. `*lost`, if not NULL, is the number of those after `after` that are no longer in the
 *  ring. @rt any */
CM1E_API size_t cm1e_log_read(const cm1e_scheduler_t *scheduler, uint64_t after, cm1e_log_event_t *events, size_t room,
                              uint64_t *lost);
/** Writes a record as a sentence, without its time: 'X: ErrorStop (was DiscreteMotion)'. Of several buses it names
 *  the one that a record is about: 'network left: Slave 1 ...'. A buffer that is too small gets the beginning. 512
 *  bytes are enough for every text. @rt block */
CM1E_API void cm1e_log_text(const cm1e_scheduler_t *scheduler, const cm1e_log_event_t *event, char *text, size_t size);
/** Name of a kind: "state", "error" ... Never NULL. @rt any */
CM1E_API const char *cm1e_log_kind_name(cm1e_log_kind_t kind);

#ifdef __cplusplus
}
#endif
#endif
