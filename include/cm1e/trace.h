/**
 * @file trace.h
 * What the trace of a scheduler records beside its axes: variables of the program, objects in the process data of a
 * drive. A trigger decides when it ends. `trace_capacity` and `trace_every` of the scheduler's configuration say how
 * many samples it keeps, and how far they are apart.
 *
 * Every sample has one value per signal. The signals are, by name:
 *
 *     "X state", "X set position" [u], "X actual position" [u], "X set velocity" [u/s], "X actual velocity" [u/s],
 *     "X torque" [%]                        of every axis, here "X"
 *     "X error"                             the error of the axis (error.h) as a number; 0: none
 *     "wake-up latency" [us]                of this cycle
 *     "execution time" [us]                 of the cycle before
 *     "lost frames", "overruns"             number since the start of the run
 *     the name that the program gave        a variable or an object
 *
 * All functions are called between the making of the scheduler and its run, in the thread that makes it.
 */
#ifndef CM1E_TRACE_H
#define CM1E_TRACE_H

#include "cm1e/api.h"
#include "cm1e/error.h"
#include "cm1e/scheduler.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Type of a variable. BOOL is a byte that is 0 or not; a sample keeps it as 0 or 1. Integers of 64 bits are kept
 *  exactly up to 2^53. */
typedef enum cm1e_trace_type {
    CM1E_TRACE_BOOL = 0, CM1E_TRACE_SINT, CM1E_TRACE_INT, CM1E_TRACE_DINT, CM1E_TRACE_LINT,
    CM1E_TRACE_USINT, CM1E_TRACE_UINT, CM1E_TRACE_UDINT, CM1E_TRACE_ULINT, CM1E_TRACE_REAL, CM1E_TRACE_LREAL,
} cm1e_trace_type_t;

enum {
    CM1E_TRACE_VARIABLES = 256, /**< maximum number of variables and objects */
    CM1E_TRACE_NAME_BYTES = 80, /**< of a name, with its final 0 */
    CM1E_TRACE_UNIT_BYTES = 16, /**< of a unit, with its final 0 */
};

/** Records a variable of the program from now on. It is read at the end of every recorded cycle, after the programs,
 *  and must live until the run has ended. With a trace_capacity of 0 the scheduler records nothing itself; others who
 *  attach do (`cm1e trace`), and see the variable too. `name` and `unit` are copied; unit "" or NULL: it has none.
 *  Errors:
 *  CM1E_ERROR_STATE: the scheduler has run.
 *  CM1E_ERROR_INVALID_ARGUMENT: no name, a name that is too long or is a signal already ("time" is one in every file),
 *  a name or unit that is not UTF-8 without control characters, no variable, or no such type.
 *  CM1E_ERROR_NO_MEMORY: more than CM1E_TRACE_VARIABLES. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_trace_variable(cm1e_scheduler_t *scheduler, const char *name, const char *unit,
                                                    cm1e_trace_type_t type, const void *variable, cm1e_diag_t *diag);

#if !defined __cplusplus && defined __STDC_VERSION__ && __STDC_VERSION__ >= 201112L
/** The cm1e_trace_type_t of a variable, in C. BOOL is the same C type as USINT: name CM1E_TRACE_BOOL yourself if the
 *  value can be other than 0 and 1. */
#define CM1E_TRACE_TYPE_OF(variable)                                                                                  \
    _Generic((variable), signed char: CM1E_TRACE_SINT, short: CM1E_TRACE_INT, int: CM1E_TRACE_DINT,                    \
             long: sizeof(long) == 8 ? CM1E_TRACE_LINT : CM1E_TRACE_DINT, long long: CM1E_TRACE_LINT,                  \
             _Bool: CM1E_TRACE_BOOL, unsigned char: CM1E_TRACE_USINT, unsigned short: CM1E_TRACE_UINT,                 \
             unsigned: CM1E_TRACE_UDINT, unsigned long: sizeof(long) == 8 ? CM1E_TRACE_ULINT : CM1E_TRACE_UDINT,       \
             unsigned long long: CM1E_TRACE_ULINT, float: CM1E_TRACE_REAL, double: CM1E_TRACE_LREAL)
#endif

/** Records an object in the process data of an axis, as "<axis> 0x6077:00 <name of the object>", in the unit and type
 *  of the device's dictionary. An object that the dictionary does not know is an unsigned integer. Of an optional drive
 *  that is absent the planned process data count until it comes, and then its own; an object that these do not have is
 *  not a number from then on. Errors as for cm1e_scheduler_trace_variable(), and CM1E_ERROR_PDO_MAPPING: the object is
 *  in neither direction of the process data. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_trace_object(cm1e_scheduler_t *scheduler, AXIS_REF_t axis, uint16_t index,
                                                  uint8_t subindex, cm1e_diag_t *diag);

/** What ends a recording. */
typedef enum cm1e_trace_trigger_kind {
    CM1E_TRACE_NO_TRIGGER = 0,  /**< the run ends it: the trace has the last cycles */
    CM1E_TRACE_ON_ERROR_STOP,   /**< an axis enters ErrorStop */
    CM1E_TRACE_ON_RISING,       /**< `signal` was below `level`, and is not any more */
    CM1E_TRACE_ON_FALLING,      /**< `signal` was above `level`, and is not any more */
    CM1E_TRACE_ON_CHANGE,       /**< `signal` changes */
} cm1e_trace_trigger_kind_t;

/** A trigger: what ends the recording, and how much is kept of the time before. */
typedef struct cm1e_trace_trigger {
    cm1e_trace_trigger_kind_t kind;
    const char *signal;         /**< name of a signal; not used by CM1E_TRACE_ON_ERROR_STOP */
    double level;               /**< in the unit of the signal */
    uint32_t samples_before;    /**< samples to keep of the time before the trigger; the rest of trace_capacity is
                                     recorded after it */
} cm1e_trace_trigger_t;

/** Sets the trigger. The trace records from the start of the run; when the trigger comes, it records
 *  trace_capacity - samples_before samples more, the one of the trigger included, and then no more. The trigger is a
 *  mark of the trace. Only its first occurrence counts. It looks at samples: with a trace_every of n, a change that
 *  comes and goes between two samples does not trigger. If the trigger does not come, the trace has the last cycles of
 *  the run. Errors:
 *  CM1E_ERROR_STATE: the scheduler has run, or its trace_capacity is 0.
 *  CM1E_ERROR_INVALID_ARGUMENT: no such kind or signal (register it before), `level` is not a number, or samples_before
 *  is not less than trace_capacity. @rt init */
CM1E_API cm1e_error_t cm1e_scheduler_trace_trigger(cm1e_scheduler_t *scheduler, const cm1e_trace_trigger_t *trigger,
                                                   cm1e_diag_t *diag);

/** Writes the trace as a NumPy file: numpy.load() reads it as a structured array with a float64 field per signal, the
 *  first one is "time" in s. States are the numbers of cm1e_axis_state_t. Conditions as for cm1e_scheduler_write_csv().
 *  @rt block */
CM1E_API cm1e_error_t cm1e_scheduler_write_npy(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
