/**
 * @file axis/axis_signals.h
 * Functions of an axis other than motion: the digital inputs and outputs of its motor, the switches that the
 * configuration assigns to inputs, touch probes, and outputs and motions that end when no call renews them. Only
 * cm1e_axis_keep() can change the state of the axis. In the cycle thread, between cm1e_axis_inputs() and
 * cm1e_axis_outputs().
 */
#ifndef CM1E_AXIS_AXIS_SIGNALS_H
#define CM1E_AXIS_AXIS_SIGNALS_H

#include "axis/axis_api.h"

/** The largest numbers. A CM1-E has inputs 1 ... 4 and output 1 on the bus; output 2 belongs to the motor itself (UG
 *  7.3.24, 7.3.25, K34). Behind a bridge a CM1 has inputs 2 ... 4 and output 2, a CM2 has inputs 1 ... 6 and outputs 1
 *  ... 4 (BR 6.5). There they are reached by SDO, only while the motor is enabled in csp; in CPIO in every cycle, but
 *  without inputs 5 and 6. Numbers from CM1E_WIRED_FIRST on are signals of other slaves (drive_wiring.h), of any kind
 *  of axis. While such a slave is away they are errors (CM1E_ERROR_AXIS_SIGNAL_AWAY). */
enum { CM1E_AXIS_INPUTS = 6, CM1E_AXIS_OUTPUTS = 4 };

/** The planned time of this cycle in ns, which the times below use. @rt cycle */
int64_t cm1e_axis_time(const cm1e_axis_t *axis);

/** Reads an input. CM1E_ERROR_AXIS_SIGNAL: no such number. CM1E_ERROR_PDO_MAPPING: inputs are not mapped.
 *  CM1E_ERROR_AXIS_OFFLINE: the value is old (and returned). For inputs by SDO also: CM1E_ERROR_BUSY: requested, ask
 *  again in the next cycle; CM1E_ERROR_AXIS_NOT_POWERED, CM1E_ERROR_AXIS_HOMING: it cannot be read now;
 *  CM1E_ERROR_TIMEOUT: no answer came in time. @rt cycle */
cm1e_error_t cm1e_axis_read_input(cm1e_axis_t *axis, int number, bool *value);
/** Writes an output of 0x60FE. It keeps its value over modes, MC_Power and ErrorStop. It is switched off by
 *  cm1e_axis_shut_down(), and when the slave leaves Operational, so that it does not come on again by itself. Errors as
 *  above; after an error nothing has changed. @rt cycle */
cm1e_error_t cm1e_axis_write_output(cm1e_axis_t *axis, int number, bool value);
/** Whether the motor has the written value: ACTIVE while an SDO transfers it, DONE, or ERROR; then the text of the axis
 *  names the output. @rt cycle */
cm1e_command_state_t cm1e_axis_output_state(cm1e_axis_t *axis, int number, cm1e_error_t *error);
/** Like cm1e_axis_write_output(), but the output goes off by itself unless it is written again within `keep_ns`.
 *  CM1E_ERROR_PDO_MAPPING also if it is written by SDO, which is too late for outputs that follow a position.
 *  It does not change the text of the axis. @rt cycle */
cm1e_error_t cm1e_axis_hold_output(cm1e_axis_t *axis, int number, bool value, int64_t keep_ns);
/** Switches off an output that was held, if it can be written. It does not change the text of the axis. @rt cycle */
void cm1e_axis_output_off(cm1e_axis_t *axis, int number);
/** The text of the axis says why this output was not written. A block that holds an output in every cycle calls it when
 *  the error begins, and with CM1E_OK when it ends, so that no later refusal is hidden. @rt cycle */
void cm1e_axis_tell_output(cm1e_axis_t *axis, cm1e_error_t error, int number);
/** The commanded value of an output. @rt cycle */
cm1e_error_t cm1e_axis_read_output(const cm1e_axis_t *axis, int number, bool *value);
/** Like cm1e_axis_refuse_level(), for the number of an input or output that cannot be read. @rt cycle */
void cm1e_axis_refuse_signal(cm1e_axis_t *axis, cm1e_error_t error, bool output, int number, bool begins);
/** Inputs of MC_DigitalCamSwitch that have a range. */
typedef enum cm1e_cam_switch_input {
    CM1E_CAM_SWITCH_COUNT = 0, CM1E_CAM_SWITCH_TRACK, CM1E_CAM_SWITCH_FIRST_ON, CM1E_CAM_SWITCH_LAST_ON,
    CM1E_CAM_SWITCH_DIRECTION, CM1E_CAM_SWITCH_MODE, CM1E_CAM_SWITCH_DURATION, CM1E_CAM_SWITCH_ON_COMPENSATION,
    CM1E_CAM_SWITCH_OFF_COMPENSATION, CM1E_CAM_SWITCH_HYSTERESIS,
} cm1e_cam_switch_input_t;
/** Keeps for the text of the axis that this input of a switch (1 ...; times in ns) is refused. @rt cycle */
void cm1e_axis_refuse_cam_switch(cm1e_axis_t *axis, cm1e_cam_switch_input_t input, int number, double value);
/** They are right again: that text is forgotten. @rt cycle */
void cm1e_axis_cam_switches_right(cm1e_axis_t *axis);
/** The position of the slave whose counts are the position of this axis; 0: none is. @rt cycle */
uint16_t cm1e_axis_encoder_slave(const cm1e_axis_t *axis);
/** Whether an input is in the process data, so that it is seen in every cycle. @rt cycle */
bool cm1e_axis_sees_input(const cm1e_axis_t *axis, int number);
/** Reads the actual torque in % of rated torque. CM1E_ERROR_PDO_MAPPING: it is not in the process data.
 *  CM1E_ERROR_AXIS_OFFLINE: it is not known now. @rt cycle */
cm1e_error_t cm1e_axis_read_torque(const cm1e_axis_t *axis, double *percent);

typedef enum cm1e_axis_switch {
    CM1E_SWITCH_LIMIT_POSITIVE = 0, CM1E_SWITCH_LIMIT_NEGATIVE, CM1E_SWITCH_HOME, CM1E_SWITCH_COUNT,
} cm1e_axis_switch_t;
/** Whether the configuration assigns an input to this switch that the bus can read. @rt cycle */
bool cm1e_axis_has_switch(const cm1e_axis_t *axis, cm1e_axis_switch_t which);
/** Called in every cycle by a block that shows the switches. Behind a bridge it requests them by SDO. @rt cycle */
void cm1e_axis_want_switches(cm1e_axis_t *axis);
/** The last known state of a switch; false if there is none, or if an SDO has not brought it lately. A limit switch
 *  whose slave is away is active, a home switch is not. @rt cycle */
bool cm1e_axis_switch_active(const cm1e_axis_t *axis, cm1e_axis_switch_t which);
/** Whether a switch is on another slave that is away. @rt cycle */
bool cm1e_axis_switch_away(const cm1e_axis_t *axis, cm1e_axis_switch_t which);
/** The number of its input as configured; 0: none. @rt cycle */
int cm1e_axis_switch_input(const cm1e_axis_t *axis, cm1e_axis_switch_t which);

/** Further values of MC_ReadAxisInfo (3.29). */
typedef struct cm1e_axis_condition {
    bool simulation;         /**< on the simulated segment */
    bool communication;      /**< the slave takes part in the cycle */
    bool ready_for_power_on; /**< Disabled, with motor power and without a fault */
    bool warning;            /**< the drive reports something that is no fault */
} cm1e_axis_condition_t;
cm1e_axis_condition_t cm1e_axis_condition(const cm1e_axis_t *axis);

/** Values for blocks that move an axis with several commands, or only watch it. */
typedef struct cm1e_axis_measures {
    double resolution;           /**< u per count of the motor */
    double modulo_range;         /**< u; 0: a linear axis */
    double max_velocity;         /**< u/s */
    double max_lag;              /**< u */
    double lower, upper;         /**< u, the limits in force; infinite: none, or a modulo axis */
    double jog_slow, jog_fast;   /**< u/s */
} cm1e_axis_measures_t;
CM1E_GUEST_API cm1e_axis_measures_t cm1e_axis_measures(const cm1e_axis_t *axis);

/* ---- touch probes (3.33, 3.34) ---------------------------------------------------------------------------------- */

/** A trigger is an input and an edge of it; each has at most one probe. */
typedef struct cm1e_axis_trigger {
    int input;     /**< 1 ... CM1E_AXIS_INPUTS, or from CM1E_WIRED_FIRST on */
    bool falling;  /**< the edge from on to off instead of from off to on */
} cm1e_axis_trigger_t;

typedef struct cm1e_probe_status {
    cm1e_command_state_t state; /**< UNKNOWN: a later probe uses the same trigger */
    cm1e_error_t error;
    double position;            /**< u, of the edge: the middle of the positions before and after it */
    double uncertainty;         /**< u, half the distance of these positions */
} cm1e_probe_status_t;

/** Arms a probe for the next edge after the present inputs, and aborts a probe that is armed on the same trigger. The
 *  probe needs no further calls. `window`: only edges within first ... last count (u, both included; on a modulo axis
 *  first > last is a window over the end of the range). CM1E_ERROR_AXIS_POSITION_RANGE: no such window. @rt cycle */
cm1e_error_t cm1e_axis_probe(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger, bool window, double first, double last,
                             uint32_t *id);
cm1e_probe_status_t cm1e_axis_probe_status(const cm1e_axis_t *axis, uint32_t id);
/** Aborts the probe on a trigger, if one is armed. @rt cycle */
cm1e_error_t cm1e_axis_probe_abort(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger);

/* ---- a motion that somebody has to want ------------------------------------------------------------------------- */

/** For MC_Jog: grants the command `id` its motion for `keep_ns`. If it is not called again in that time, and the
 *  command still moves the axis, the axis is halted like by MC_Halt, with `deceleration` and `jerk` (0: the maximum of
 *  the axis). id 0: no motion is kept any more. @rt cycle */
void cm1e_axis_keep(cm1e_axis_t *axis, cm1e_command_id_t id, int64_t keep_ns, double deceleration, double jerk);

#endif
