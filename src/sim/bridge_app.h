/**
 * @file bridge_app.h
 * The EtherCAT Cool MUSCLE Bridge as the application behind a simulated slave controller, with four CM1 or CM2 motors;
 * private to the simulator. Files:
 *   bridge.c             life, EtherCAT state changes, time, cycle time
 *   bridge_values.c      the values of the object dictionary
 *   bridge_dictionary.c  access by SDO
 *   bridge_image.c       PDO assignment, process data in and out
 *   bridge_motor.c       the motor of an axis: position, torque, targets
 *   bridge_states.c      the power drive system of an axis (BR 6.1), and errors of its motor (BR 7.4)
 *   bridge_axis.c        one axis in time: its process data, statusword, serial line
 *   bridge_modes.c       modes of operation and the ways between them (BR 6, appendix 3)
 *   bridge_homing.c      origin search: hm and CMD (BR 6.4)
 *   bridge_cml.c         CML strings (BR 7.2, appendix 2)
 *   bridge_command.c     CMD and CPIO (BR 7.1, appendix 1)
 *   store.c, servo.c, reference.c, search.c, mechanics.c  as with the CM1-E
 * What the guide (BR) leaves open is decided in docs/DEVICE.md. Like the simulated CM1-E it protects nobody.
 */
#ifndef CM1E_SIM_BRIDGE_APP_H
#define CM1E_SIM_BRIDGE_APP_H

#include "cia402/cia402.h"
#include "cm1e/cml.h"
#include "device/bridge_facts.h"
#include "device/bridge_status.h"
#include "sim/search.h"
#include "sim/segment.h"
#include "sim/sensors.h"
#include "sim/slave.h"
#include "sim/store.h"

/** Answers of the motor that wait in the mailbox. */
enum { CML_LINES = 8 };
typedef struct cml_line {
    int64_t due_ns;          /**< when it has come */
    char text[CM1E_CML_BYTES];
} cml_line_t;

typedef struct cm1e_sim_cml {
    int64_t free_ns;         /**< the next string may be sent */
    cml_line_t lines[CML_LINES];
    unsigned first, count;
    unsigned list_next;      /**< number of the K parameter to come; 0: no list under way */
    int64_t list_due_ns;
    bool searching;          /**< the end of an origin search is to be told */
} cm1e_sim_cml_t;

/** One motor and what the bridge does for it. */
typedef struct cm1e_sim_bridge_axis {
    uint8_t number;          /**< 0 ... 3 */
    cm1e_bridge_motor_t motor;

    /* process data, as it has come over the serial line */
    uint16_t controlword, last_controlword;
    int32_t target_position;

    /* power drive system */
    cm1e_fsa_state_t state;
    bool motor_free;
    uint8_t error;           /**< of the motor, as in F530; 0: none */
    uint8_t outputs;         /**< bit 0: output 1 */

    /* modes of operation */
    int8_t mode, next_mode;  /**< 0x6061, and what it will be at mode_due_ns */
    int64_t mode_request_ns, mode_due_ns;

    bool abnormal;           /**< was in CMD or CPIO: csp works no more (BR 6, note 2) */
    unsigned same_words;     /**< cycles with the present controlword */
    cm1e_sim_cml_t cml;

    /* CMD */
    bool armed;              /**< 0007h was there long enough */
    uint8_t answer;          /**< high byte of the statusword */

    /* motion; positions on the scale of the mechanics, which has CM1E_COUNTS_PER_REVOLUTION */
    double scale;            /**< pulses of the motor, by its K37, for one count of the mechanics */
    int32_t limit;           /**< greatest position, pulses (BR appendix 5) */
    cm1e_mechanics_t mechanics;
    cm1e_sim_sensors_t sensors;
    cm1e_servo_t servo;
    cm1e_sim_line_t line;
    cm1e_sim_search_t search;
    double search_s;         /**< since the search began */
    bool search_failed;      /**< it found nothing in time */
    int64_t settings_ns;     /**< when an object of homing was written last */
    int64_t zero;            /**< where 0x6064 is 0 */
    double lag_s, overload;  /**< how long the lag is too large; sum of the overload, s */

    unsigned broken_rules;   /**< by the master: cm1e_sim_broken_rule */

    bool unplugged;
    uint32_t broken_answers; /**< so many to come arrive broken */
    unsigned silent_ms;      /**< since the last good answer */
    int64_t known_position;  /**< 0x6064 while nothing is heard of the motor */
    uint32_t sent, received; /**< over the serial line (F530:9 ... F530:16) */
} cm1e_sim_bridge_axis_t;

/** Process data on its way over the serial lines: of every axis in the order of the IDs. */
enum { SERIAL_LINE_CYCLES = 8 };
typedef struct cm1e_sim_serial {
    struct {
        int64_t due_ns;
        uint8_t present;       /**< bit 0: ID1 is among the assigned PDOs */
        uint16_t controlwords[CM1E_BRIDGE_AXES];
        int32_t targets[CM1E_BRIDGE_AXES];
    } cycles[SERIAL_LINE_CYCLES];
    unsigned first, count;
} cm1e_sim_serial_t;

struct cm1e_sim_bridge {
    cm1e_sim_slave_t *slave; /**< NULL: no slave controller below (unit tests) */
    cm1e_device_model_t model;
    cm1e_sim_store_t store;
    uint8_t al_state;

    /* PDO assignment: 0x1C12, 0x1C13 */
    uint8_t assigned[2];                  /**< sub-index 0 */
    uint16_t pdos[2][CM1E_BRIDGE_AXES];   /**< sub-indexes 1 ... 4 */
    cm1e_sim_serial_t serial;

    /* time */
    bool running;            /**< now_ns is known */
    int64_t now_ns, ready_ns, exchange_ns;
    int64_t last_outputs_ns; /**< 0: none since Operational */
    uint32_t longest_us, shortest_us, late_cycles, early_cycles; /**< F530:17 ... F530:20 */
    int wrong_cycles;        /**< in a row; < 0: too short */
    uint32_t last_cycle_us;
    uint32_t sync_errors;    /**< counted against 0x10F1:2 */

    cm1e_sim_bridge_axis_t axes[CM1E_BRIDGE_AXES];
};

/* ---- bridge.c --------------------------------------------------------------------------------------------------- */
extern const cm1e_sim_app_ops_t cm1e_sim_bridge_ops;
/** The application alone; destroyed by its ops. NULL: no bridge, or no memory. */
cm1e_sim_bridge_t *cm1e_sim_bridge_create_app(cm1e_device_model_t model,
                                              const cm1e_axis_config_t *const axes[CM1E_BRIDGE_AXES]);
/** The bridge in a slave; NULL: it is something else. */
cm1e_sim_bridge_t *cm1e_sim_bridge_of(cm1e_sim_slave_t *slave);

/** Bounds of a cycle (BR 7.4, F530:19 and 20). */
enum { CM1E_SIM_BRIDGE_LATE_US = 1300, CM1E_SIM_BRIDGE_EARLY_US = 700 };
/** The number of cycles in a row that were all too long or all too short, if they are too many; else 0. */
int cm1e_sim_bridge_wrong_cycles(const cm1e_sim_bridge_t *bridge);

/* ---- bridge_values.c -------------------------------------------------------------------------------------------- */
bool cm1e_sim_bridge_dictionary_create(cm1e_sim_bridge_t *bridge);
/** Back to what it is after power-on; what the motors keep stays. */
void cm1e_sim_bridge_dictionary_reset(cm1e_sim_bridge_t *bridge);
/** The value of an object of an axis, by its index on the first axis. */
int64_t *cm1e_sim_bridge_value(const cm1e_sim_bridge_t *bridge, unsigned axis, uint16_t index, uint8_t subindex);
/** K21 ... K99 of a motor. */
int64_t *cm1e_sim_bridge_k(const cm1e_sim_bridge_t *bridge, unsigned axis, unsigned number);

/* ---- bridge_dictionary.c ---------------------------------------------------------------------------------------- */
const cm1e_object_t *cm1e_sim_bridge_object(void *app, size_t n);
const cm1e_entry_t *cm1e_sim_bridge_entry(void *app, uint16_t index, uint8_t subindex);
uint32_t cm1e_sim_bridge_sdo_read(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data,
                                  size_t *size);
uint32_t cm1e_sim_bridge_sdo_write(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                                   size_t size);

/* ---- bridge_image.c --------------------------------------------------------------------------------------------- */
/** Writing 0x1C12 or 0x1C13; 0 or an abort code. */
uint32_t cm1e_sim_bridge_assign_write(cm1e_sim_bridge_t *bridge, uint16_t index, uint8_t subindex, uint32_t value);
uint32_t cm1e_sim_bridge_assign_read(const cm1e_sim_bridge_t *bridge, uint16_t index, uint8_t subindex);
void cm1e_sim_bridge_assign_default(cm1e_sim_bridge_t *bridge);
void cm1e_sim_bridge_sizes(void *app, uint16_t *output_bytes, uint16_t *input_bytes);
void cm1e_sim_bridge_outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns);
/** When the next process data arrive over the serial lines; INT64_MAX: none are on their way. */
int64_t cm1e_sim_bridge_delivery_ns(const cm1e_sim_bridge_t *bridge);
/** Process data that has come over the serial lines by now. */
void cm1e_sim_bridge_deliver(cm1e_sim_bridge_t *bridge);
void cm1e_sim_bridge_inputs(void *app, uint8_t *data, uint16_t size);

/* ---- bridge_motor.c --------------------------------------------------------------------------------------------- */
#define CM1E_SIM_BRIDGE_CYCLE_S 1e-3 /* BR 6.3 */
/** Not in the guide: that of the CM1-E. */
#define CM1E_SIM_BRIDGE_PEAK_TO_RATED 1.25
void cm1e_sim_bridge_axis_power(cm1e_sim_bridge_axis_t *axis, bool on);
/** Limits the torque to so many % of the rated one; 0: to the peak torque. */
void cm1e_sim_bridge_axis_torque(cm1e_sim_bridge_axis_t *axis, double percent);
/** The guide states none: that of the smallest CM1-E. */
double cm1e_sim_bridge_peak_torque(void);
/** The reference stays where it is. */
void cm1e_sim_bridge_axis_hold(cm1e_sim_bridge_axis_t *axis);
bool cm1e_sim_bridge_axis_stands(const cm1e_sim_bridge_axis_t *axis);
/** Makes the present position the position 0. */
void cm1e_sim_bridge_axis_zero(cm1e_sim_bridge_axis_t *axis);
/** In pulses. */
int64_t cm1e_sim_bridge_position(const cm1e_sim_bridge_axis_t *axis);
/** 0x6064 */
int64_t cm1e_sim_bridge_shown_position(const cm1e_sim_bridge_axis_t *axis);
/** Bit 0: input 1. Those that the motor has: on a CM1 the first is its serial line. */
uint8_t cm1e_sim_bridge_inputs_of(const cm1e_sim_bridge_axis_t *axis);
/** F530:5 ... F530:8 */
uint8_t cm1e_sim_bridge_motor_status(const cm1e_sim_bridge_axis_t *axis);
/** The cable between bridge and motor. */
void cm1e_sim_bridge_axis_plug(cm1e_sim_bridge_axis_t *axis, bool plugged);
/** Whether the target of the process data counts in this mode. */
bool cm1e_sim_bridge_follows_targets(const cm1e_sim_bridge_axis_t *axis);
/** The target holds from now on. It is taken as it is: one that is not the actual position makes the motor jump. */
void cm1e_sim_bridge_axis_begin_csp(cm1e_sim_bridge_axis_t *axis);
/** The target of a further cycle. */
void cm1e_sim_bridge_axis_follow(cm1e_sim_bridge_axis_t *axis);

/* ---- bridge_states.c -------------------------------------------------------------------------------------------- */
/** Initialisation is over. */
void cm1e_sim_bridge_axis_ready(cm1e_sim_bridge_axis_t *axis);
/** Carries out what the low four bits of a controlword command (BR 6.1.2). */
void cm1e_sim_bridge_axis_obey(cm1e_sim_bridge_axis_t *axis, unsigned controlword);
/** No more process data comes: motor free, Switch on disabled. */
void cm1e_sim_bridge_axis_disable(cm1e_sim_bridge_axis_t *axis);
/** Takes the torque away and enters a state without torque. */
void cm1e_sim_bridge_axis_release(cm1e_sim_bridge_axis_t *axis, cm1e_fsa_state_t state);
/** An error of the motor, or of the serial line to it: one of BRIDGE_STATUS_... */
void cm1e_sim_bridge_axis_error(cm1e_sim_bridge_axis_t *axis, uint8_t status);
void cm1e_sim_bridge_axis_reset_fault(cm1e_sim_bridge_axis_t *axis);
/** 0x60FD, 0x60FE: in csp, in Switched on and Operation enabled only (BR 6.5). */
bool cm1e_sim_bridge_io_available(const cm1e_sim_bridge_axis_t *axis);
/** Bits 0 ... 3 and 6 of the statusword. */
uint16_t cm1e_sim_bridge_state_bits(const cm1e_sim_bridge_axis_t *axis);

/* ---- bridge_axis.c ---------------------------------------------------------------------------------------------- */
void cm1e_sim_bridge_axis_create(cm1e_sim_bridge_t *bridge, unsigned number, const cm1e_axis_config_t *config);
/** Control power comes on: the present place of the motor becomes 0. */
void cm1e_sim_bridge_axis_power_on(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis);
/** New process data has come over the serial line. */
void cm1e_sim_bridge_axis_outputs(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis);
void cm1e_sim_bridge_axis_step(cm1e_sim_bridge_axis_t *axis, double step_s);
/** Simulates a millisecond of the serial line. */
void cm1e_sim_bridge_axis_exchange(cm1e_sim_bridge_axis_t *axis);
uint16_t cm1e_sim_bridge_statusword(const cm1e_sim_bridge_axis_t *axis);

/* ---- bridge_modes.c --------------------------------------------------------------------------------------------- */
/** 0x6060 is written. */
void cm1e_sim_bridge_request_mode(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, int8_t value);
/** Time passes. */
void cm1e_sim_bridge_mode_due(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis);
void cm1e_sim_bridge_mode_reset(cm1e_sim_bridge_axis_t *axis);

/* ---- bridge_homing.c -------------------------------------------------------------------------------------------- */
void cm1e_sim_bridge_search_begin(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis);
/** Forgets the last search: it is neither done nor failed. */
void cm1e_sim_bridge_search_reset(cm1e_sim_bridge_axis_t *axis);
/** Does nothing if no search is under way. */
void cm1e_sim_bridge_search_abort(cm1e_sim_bridge_axis_t *axis);
void cm1e_sim_bridge_search_step(cm1e_sim_bridge_axis_t *axis, double step_s);

/* ---- bridge_cml.c ----------------------------------------------------------------------------------------------- */
/** F581 ... F584; 0 or an abort code. */
uint32_t cm1e_sim_bridge_cml_write(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis, const uint8_t *data,
                                   size_t size);
/** F591 ... F594: takes the next answer out. */
const char *cm1e_sim_bridge_cml_read(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis);
void cm1e_sim_bridge_cml_step(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis);

/* ---- bridge_command.c ------------------------------------------------------------------------------------------- */
/** The controlword has been 0000h for long enough: no controlwords go over the serial line. */
bool cm1e_sim_bridge_line_is_free(const cm1e_sim_bridge_axis_t *axis);
void cm1e_sim_bridge_command_outputs(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis);
void cm1e_sim_bridge_command_step(cm1e_sim_bridge_axis_t *axis);
uint16_t cm1e_sim_bridge_command_status(const cm1e_sim_bridge_axis_t *axis);
void cm1e_sim_bridge_cpio_outputs(cm1e_sim_bridge_axis_t *axis);
uint16_t cm1e_sim_bridge_cpio_status(const cm1e_sim_bridge_axis_t *axis);

#endif
