/**
 * @file axis/axis_signals.h
 * What an axis has besides its motion: the digital inputs and the output of its motor, the switches that the
 * configuration assigns to inputs, touch probes, and what goes off when nobody asks for it any more. None of it changes
 * the state of the axis, but cm1e_axis_keep(). In the cycle thread, between cm1e_axis_inputs() and cm1e_axis_outputs().
 */
#ifndef CM1E_AXIS_AXIS_SIGNALS_H
#define CM1E_AXIS_AXIS_SIGNALS_H

#include "axis/axis.h"

/** The greatest numbers. Of a CM1-E the bus reaches inputs 1 ... 4 and output 1, output 2 is the motor's own (UG
 *  7.3.24, 7.3.25, K34); behind a bridge of a CM1 inputs 2 ... 4 and output 2, of a CM2 inputs 1 ... 6 and outputs
 *  1 ... 4 (BR 6.5), by SDO and only while the motor is enabled in csp, in CPIO in every cycle without inputs 5, 6. */
enum { CM1E_AXIS_INPUTS = 6, CM1E_AXIS_OUTPUTS = 4 };

/** Planned time of this cycle, ns; the clock of what follows. @rt cycle */
int64_t cm1e_axis_time(const cm1e_axis_t *axis);

/** An input as last seen. CM1E_ERROR_AXIS_SIGNAL: no such number; CM1E_ERROR_PDO_MAPPING: inputs are not mapped;
 *  CM1E_ERROR_AXIS_OFFLINE: the value is old (and returned). Where SDOs bring it: CM1E_ERROR_BUSY: asked for, ask again
 *  in the next cycle; CM1E_ERROR_AXIS_NOT_POWERED, CM1E_ERROR_AXIS_HOMING: it cannot be read now; CM1E_ERROR_TIMEOUT:
 *  it should have come. @rt cycle */
cm1e_error_t cm1e_axis_read_input(cm1e_axis_t *axis, int number, bool *value);
/** An output, of 0x60FE. It keeps its value over modes, MC_Power and ErrorStop, and is switched off when the slave
 *  leaves Operational (it must not come on again by itself) and by cm1e_axis_shut_down(). Errors as above, then nothing
 *  has changed. @rt cycle */
cm1e_error_t cm1e_axis_write_output(cm1e_axis_t *axis, int number, bool value);
/** Whether what was written is with the motor: ACTIVE while an SDO brings it, DONE, ERROR, then the text of the axis
 *  says of which output. @rt cycle */
cm1e_command_state_t cm1e_axis_output_state(cm1e_axis_t *axis, int number, cm1e_error_t *error);
/** As cm1e_axis_write_output(), for a value that goes off by itself unless it is written again within `keep_ns`.
 *  CM1E_ERROR_PDO_MAPPING also where it would go by SDO, too late for what follows a position. @rt cycle */
cm1e_error_t cm1e_axis_hold_output(cm1e_axis_t *axis, int number, bool value, int64_t keep_ns);
/** What is commanded. @rt cycle */
cm1e_error_t cm1e_axis_read_output(const cm1e_axis_t *axis, int number, bool *value);
/** The inputs are in the process data: what happens at them is seen in the cycle. @rt cycle */
bool cm1e_axis_sees_inputs(const cm1e_axis_t *axis);
/** Actual torque, % of rated torque. CM1E_ERROR_PDO_MAPPING: it is not in the process data; CM1E_ERROR_AXIS_OFFLINE.
 *  @rt cycle */
cm1e_error_t cm1e_axis_read_torque(const cm1e_axis_t *axis, double *percent);

typedef enum cm1e_axis_switch {
    CM1E_SWITCH_LIMIT_POSITIVE = 0, CM1E_SWITCH_LIMIT_NEGATIVE, CM1E_SWITCH_HOME, CM1E_SWITCH_COUNT,
} cm1e_axis_switch_t;
/** Whether the configuration names an input for it that the bus reaches. @rt cycle */
bool cm1e_axis_has_switch(const cm1e_axis_t *axis, cm1e_axis_switch_t which);
/** Who shows the switches calls it in every cycle: behind a bridge they are asked for by SDO then. @rt cycle */
void cm1e_axis_want_switches(cm1e_axis_t *axis);
/** As last seen; FALSE without one, or where SDOs bring it and none has, lately. @rt cycle */
bool cm1e_axis_switch_active(const cm1e_axis_t *axis, cm1e_axis_switch_t which);

/** The rest of what MC_ReadAxisInfo shows (3.29). */
typedef struct cm1e_axis_condition {
    bool simulation;         /**< on the simulated segment */
    bool communication;      /**< it takes part in the cycle */
    bool ready_for_power_on; /**< Disabled, and nothing stands against enabling: motor power, no fault */
    bool warning;            /**< the drive tells of something that is no fault */
} cm1e_axis_condition_t;
cm1e_axis_condition_t cm1e_axis_condition(const cm1e_axis_t *axis);

/** What blocks have to know of an axis that they do not move by one command. */
typedef struct cm1e_axis_measures {
    double resolution;           /**< u per count of the motor */
    double modulo_range;         /**< u; 0: a linear axis */
    double max_velocity;         /**< u/s */
    double lower, upper;         /**< u, the limits in force; infinite: none, or a modulo axis */
    double jog_slow, jog_fast;   /**< u/s */
} cm1e_axis_measures_t;
cm1e_axis_measures_t cm1e_axis_measures(const cm1e_axis_t *axis);

/* ---- touch probes (3.33, 3.34) ---------------------------------------------------------------------------------- */

/** A trigger is an input and an edge of it; each has at most one probe. */
typedef struct cm1e_axis_trigger {
    int input;     /**< 1 ... CM1E_AXIS_INPUTS */
    bool falling;  /**< the edge from on to off instead of from off to on */
} cm1e_axis_trigger_t;

typedef struct cm1e_probe_status {
    cm1e_command_state_t state; /**< UNKNOWN: another probe was armed on the same trigger since */
    cm1e_error_t error;
    double position;            /**< u, where the trigger came: in the middle of the two positions around it */
    double uncertainty;         /**< u, half their distance */
} cm1e_probe_status_t;

/** Arms a probe for the next edge after the present inputs; an armed one on the same trigger is aborted. It goes on
 *  without being asked. `window`: only within first ... last (u, both included; on a modulo axis first > last is the
 *  window over the end of the range). CM1E_ERROR_AXIS_POSITION_RANGE: no such window. @rt cycle */
cm1e_error_t cm1e_axis_probe(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger, bool window, double first, double last,
                             uint32_t *id);
cm1e_probe_status_t cm1e_axis_probe_status(const cm1e_axis_t *axis, uint32_t id);
/** Aborts what is armed on the trigger; nothing is fine too. @rt cycle */
cm1e_error_t cm1e_axis_probe_abort(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger);

/* ---- a motion that somebody has to want ------------------------------------------------------------------------- */

/** MC_Jog: unless called again within `keep_ns`, the axis is halted with `deceleration` and `jerk` (0: the axis's) as
 *  by MC_Halt, if command `id` moves it then. id 0: nothing is kept any more. @rt cycle */
void cm1e_axis_keep(cm1e_axis_t *axis, cm1e_command_id_t id, int64_t keep_ns, double deceleration, double jerk);

#endif
