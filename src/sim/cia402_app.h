/**
 * @file cia402_app.h
 * A servo drive by CiA 402 as the application behind a simulated slave controller; private to the simulator. Files:
 *   cia402_app.c     life, EtherCAT state changes, time, dictionary, process data
 *   cia402_states.c  power drive system, errors, statusword
 *   cia402_modes.c   csp, csv, pp, pv, hm, touch probes
 * It protects nobody: enabled with another target than its position, it jumps.
 */
#ifndef CM1E_SIM_CIA402_APP_H
#define CM1E_SIM_CIA402_APP_H

#include "device/cia402_drive.h"
#include "sim/file_store.h"
#include "sim/search.h"
#include "sim/segment.h"
#include "sim/sensors.h"
#include "sim/slave.h"
#include "sim/store.h"

/** Objects that the drive works with: the places of their values in the store, in the order of the table in
 *  cia402_app.c. */
typedef struct cm1e_sim_cia402_values {
    int64_t *error_register, *assigned[2], *pdo[2], *error_code, *controlword, *statusword, *quick_stop_option, *mode,
        *mode_display, *position, *following_window, *velocity, *torque, *target_position, *home_offset,
        *profile_velocity, *profile_acceleration, *profile_deceleration, *quick_stop_deceleration, *homing_method,
        *homing_speed, *homing_speed_zero, *homing_acceleration, *probe_function, *probe_status, *probe_positions[4],
        *interpolation_value, *interpolation_index, *inputs, *outputs, *target_velocity;
} cm1e_sim_cia402_values_t;

/** One entry of the process image; `value` NULL: a gap. */
typedef struct cm1e_sim_cia402_slot {
    int64_t *value;
    uint8_t bytes;
    bool is_signed;
} cm1e_sim_cia402_slot_t;

/** Process data of one direction as the assignment makes it. */
typedef struct cm1e_sim_cia402_image {
    uint8_t slot_count;
    uint16_t bytes;
    cm1e_sim_cia402_slot_t slots[CM1E_PDO_MAX_ENTRIES];
} cm1e_sim_cia402_image_t;

typedef struct cm1e_sim_cia402 cm1e_sim_cia402_t;

/** A mode of operation. All called in Operation enabled only, except status_bits. */
typedef struct cm1e_sim_cia402_mode {
    int8_t mode;
    void (*enter)(cm1e_sim_cia402_t *drive);
    void (*outputs)(cm1e_sim_cia402_t *drive, uint16_t rising_bits); /**< controlword bits that rose */
    void (*step)(cm1e_sim_cia402_t *drive, double step_s);
    uint16_t (*status_bits)(const cm1e_sim_cia402_t *drive);         /**< 10, 12, 13 */
} cm1e_sim_cia402_mode_t;

typedef struct cm1e_sim_cia402_homing {
    cm1e_sim_search_t search;
    uint8_t input;          /**< bit of 0x60FD; 0: none */
    bool started, halted, failed;
    double settle_s;        /**< of a method without a search */
} cm1e_sim_cia402_homing_t;

struct cm1e_sim_cia402 {
    cm1e_sim_slave_t *slave; /**< NULL: no slave controller below (unit tests) */
    cm1e_sim_store_t store;
    cm1e_sim_files_t files; /**< kept without power */
    cm1e_sim_cia402_values_t v;
    double counts_per_revolution, peak_velocity; /**< counts/s */
    double scale;           /**< counts of the drive in one of the mechanics */
    cm1e_sim_cia402_image_t images[2]; /**< outputs, inputs */
    uint8_t al_state;

    bool running;           /**< now_ns is known */
    int64_t now_ns;
    int64_t state_deadline_ns;

    cm1e_fsa_state_t state;
    uint16_t last_controlword;
    uint16_t reported_code;
    uint16_t held_code;     /**< cause of an error that the console keeps present; 0: none */
    bool motor_power;

    const cm1e_sim_cia402_mode_t *generator; /**< NULL: no mode */
    cm1e_servo_t servo;
    cm1e_mechanics_t mechanics;
    cm1e_sim_sensors_t sensors;
    int64_t zero;           /**< counts on the scale of the mechanics where 0x6064 is 0 */
    cm1e_sim_line_t line;
    double goal, goal_velocity; /**< on the scale of the mechanics */
    double still_s, lag_s, reached_s;
    bool acknowledge;       /**< pp: set-point taken */
    cm1e_sim_cia402_homing_t homing;
    uint8_t probe_inputs;   /**< levels at the last step */
    uint16_t probe_before;  /**< 0x60B8 at the last step */
};

/* ---- cia402_app.c ------------------------------------------------------------------------------------------------ */
/** The drive in a slave; NULL: it is something else. */
cm1e_sim_cia402_t *cm1e_sim_cia402_of(cm1e_sim_slave_t *slave);
/** Brings the objects that the drive shows up to date. */
void cm1e_sim_cia402_refresh(cm1e_sim_cia402_t *drive);
/** Whether the motor has been at rest for a while. */
bool cm1e_sim_cia402_stands(const cm1e_sim_cia402_t *drive);
/** 0x60FD */
uint32_t cm1e_sim_cia402_inputs(const cm1e_sim_cia402_t *drive);

/* ---- cia402_states.c --------------------------------------------------------------------------------------------- */
void cm1e_sim_cia402_reset(cm1e_sim_cia402_t *drive);
/** Carries out controlword and mode of new process data. */
void cm1e_sim_cia402_command(cm1e_sim_cia402_t *drive);
/** Ends a state whose time is over. */
void cm1e_sim_cia402_deadline(cm1e_sim_cia402_t *drive);
/** Takes the torque away, without an error. */
void cm1e_sim_cia402_disable(cm1e_sim_cia402_t *drive);
void cm1e_sim_cia402_fault(cm1e_sim_cia402_t *drive, uint16_t code);
void cm1e_sim_cia402_motor_power(cm1e_sim_cia402_t *drive, bool on);
uint16_t cm1e_sim_cia402_statusword(const cm1e_sim_cia402_t *drive);

/* ---- cia402_modes.c ---------------------------------------------------------------------------------------------- */
/** NULL: not a mode of the drive. */
const cm1e_sim_cia402_mode_t *cm1e_sim_cia402_mode(int8_t mode);
void cm1e_sim_cia402_probe_step(cm1e_sim_cia402_t *drive);
/** Brakes by the quick stop deceleration; true: it is at standstill. */
bool cm1e_sim_cia402_brake(cm1e_sim_cia402_t *drive, double step_s);

#endif
