/**
 * @file cm1e_app.h
 * The CM1-E as the application behind a simulated slave controller; private to the simulator. Files:
 *   cm1e.c             life, EtherCAT state changes, time
 *   cm1e_motor.c       the motor as the other parts see it
 *   cm1e_objects.c     the objects that the drive works with
 *   cm1e_dictionary.c  object dictionary: SDO access
 *   cm1e_image.c       PDO assignment, process data in and out, cycle time detection
 *   cm1e_fsa.c         power drive system: states, errors, modes of operation, statusword (UG 6.1)
 *   cm1e_modes.c       CSP, CSV, PP, PV (UG 6.2)
 *   cm1e_homing.c      HM (UG 6.2.4)
 *   cm1e_firmware.c    update of the firmware in Bootstrap (UG 4.3, 10)
 *   servo.c            position servo; reference.c and search.c move its reference
 *   store.c            dictionary and its values
 *   mechanics.c        the axis behind the motor
 * Unlike the driver it protects nobody: what the manual lets a master do wrong goes wrong here too.
 */
#ifndef CM1E_SIM_CM1E_APP_H
#define CM1E_SIM_CM1E_APP_H

#include "cia402/cia402.h"
#include "sim/search.h"
#include "sim/segment.h"
#include "sim/sensors.h"
#include "sim/slave.h"
#include "sim/store.h"

/** The objects that the drive works with, one int32_t each; the dictionary and the process image refer to them by
 *  offset. Unsigned ones keep their bits. */
typedef struct cm1e_sim_objects {
    int32_t error_register, error_code, controlword, statusword, mode, mode_display;
    int32_t position, velocity, torque, temperature, dc_link, digital_inputs, digital_outputs;
    int32_t target_position, target_velocity, profile_velocity, profile_acceleration, profile_deceleration;
    int32_t home_offset, homing_method, homing_speed, homing_acceleration, homing_torque;
    int32_t user_variable_1, cycle_time_us, output_cycle_ns, input_cycle_ns;
    int32_t none; /**< an object of a mapping that the drive does nothing with */
} cm1e_sim_objects_t;

/** One object in the process image. */
typedef struct cm1e_sim_slot {
    uint8_t object;    /**< which int32_t of cm1e_sim_objects_t */
    uint8_t bytes;
    uint8_t sign_shift; /**< 32 - bits where the object is signed, else 0 */
} cm1e_sim_slot_t;

/** Process data of one direction as the assignment makes it. */
typedef struct cm1e_sim_image {
    uint16_t pdo;      /**< the value of 0x1C12:1 or 0x1C13:1 */
    uint8_t assigned;  /**< 0x1C12:0 or 0x1C13:0 */
    uint8_t slot_count;
    uint16_t bytes;
    cm1e_sim_slot_t slots[CM1E_PDO_MAX_ENTRIES];
} cm1e_sim_image_t;

/** A mode of operation. All called in Operation enabled only, except status_bits. */
typedef struct cm1e_sim_mode {
    int8_t mode;
    void (*enter)(cm1e_sim_cm1e_t *drive);                         /**< the mode, or Operation enabled, begins */
    void (*outputs)(cm1e_sim_cm1e_t *drive, uint16_t rising_bits); /**< new process data; controlword bits that rose */
    void (*step)(cm1e_sim_cm1e_t *drive, double step_s);           /**< moves the servo's reference */
    uint16_t (*status_bits)(const cm1e_sim_cm1e_t *drive);         /**< 10, 12, 13 */
} cm1e_sim_mode_t;

/** A homing, or none. Written by cm1e_homing.c and, where its mode is left, cm1e_fsa.c. */
typedef struct cm1e_sim_homing {
    cm1e_sim_search_t search;
    bool halted;           /**< stopping or stopped by the halt bit */
    bool abandoned;        /**< the mode is left: stop, then let go */
    uint8_t input;         /**< bit of 0x60FD; hard stop: 0 */
} cm1e_sim_homing_t;

/** An object that the console has made fail. */
typedef struct cm1e_sim_refusal {
    bool writing;      /**< writing it fails, as with a broken memory */
    bool missing;      /**< it is not there at all */
    uint16_t index;
    uint8_t subindex;
} cm1e_sim_refusal_t;

/** What the console has made fail. Written by console.c and, where a power-up is counted, cm1e_fsa.c. */
typedef struct cm1e_sim_troubles {
    cm1e_sim_refusal_t refusal;
    uint16_t shown_code;     /**< non-error code that the console wants to see; 0: none */
    uint16_t held_code;      /**< cause of an error that the console keeps present; 0: none */
    uint32_t failing_power_ups; /**< the next so many times the motor controller does not answer; UINT32_MAX: always */
} cm1e_sim_troubles_t;

/** How far apart the outputs of the master come, as the device has detected it. Written by cm1e_image.c. */
typedef struct cm1e_sim_period {
    int64_t last_ns;           /**< when the last outputs came */
    uint32_t ns, candidate_ns; /**< 0: not known yet */
    uint8_t candidate_count;
} cm1e_sim_period_t;

/** An update of the firmware, and what the console makes of it. */
typedef struct cm1e_sim_update {
    enum { FIRMWARE_WHOLE = 0, FIRMWARE_BROKEN, FIRMWARE_NEW } memory; /**< NEW: whole, used from the next start */
    const cm1e_firmware_info_t *firmware; /**< that the file says it is */
    unsigned long bytes;                  /**< that the file says it has */
    uint32_t error;          /**< answered from `error_at` on; 0: none. FOE_RESULT_SILENT: no answer */
    size_t error_at;
    uint32_t busy;           /**< number of requests that are answered with busy */
    uint32_t password;       /**< 0: any */
    char name[64];           /**< "": any */
} cm1e_sim_update_t;

/** Power drive system and mode of operation. Written by cm1e_fsa.c. */
typedef struct cm1e_sim_fsa {
    cm1e_fsa_state_t state;
    uint16_t last_controlword;
    bool settled;            /**< the controlword has had all its effect in this state */
    bool was_enabled;        /**< since the last power-on or fault */
    bool power_up_fault;     /**< no connection to the motor controller since power-on (0x7510) */
    int8_t next_mode;
    uint16_t fault_code;     /**< latched */
    int64_t deadline_ns;     /**< of the state or of the mode switch, whichever comes first; INT64_MAX: none */
    int64_t state_deadline_ns, mode_deadline_ns;
    const cm1e_sim_mode_t *generator; /**< NULL: no mode */
} cm1e_sim_fsa_t;

/** What the device watches while it has torque. Written by cm1e.c and cm1e_fsa.c. */
typedef struct cm1e_sim_watch {
    double overload;         /**< i2t sum, s */
    double overspeed_s, lag_s;
    double still_s;          /**< how long the shaft has been at a velocity of 0, within the window */
    bool following;
} cm1e_sim_watch_t;

/** Where the modes lead the servo's reference. Written by cm1e_modes.c. */
typedef struct cm1e_sim_motion {
    cm1e_sim_line_t line;       /**< CSP */
    double goal, goal_velocity; /**< PP: set-point; CSV, PV: velocity */
    double profile_velocity, profile_acceleration, profile_deceleration;
    double reached_s;           /**< PV: how long it has been at the target velocity */
    bool set_point_acknowledge;
} cm1e_sim_motion_t;

struct cm1e_sim_cm1e {
    cm1e_sim_slave_t *slave; /**< NULL: no slave controller below (unit tests) */
    const cm1e_firmware_info_t *firmware;
    const cm1e_motor_t *motor;
    cm1e_axis_config_t config;
    cm1e_pdo_order_t order;
    uint16_t alias;
    uint8_t rotary_switches;
    double rated_torque;     /**< Nm */
    double overload_gain;    /**< 1 / rated_torque^2 */

    bool running;            /**< now_ns is known */
    int64_t now_ns;

    cm1e_sim_store_t store;  /**< dictionary, with the values of the entries that are not in `objects` */
    cm1e_sim_objects_t objects;
    cm1e_sim_image_t outputs, inputs; /**< process data */
    cm1e_sim_period_t period;
    cm1e_sim_troubles_t troubles;
    cm1e_sim_update_t update;

    uint8_t al_state;
    bool restarts;           /**< the device's processor was reset by the last outputs */
    bool motor_power;
    cm1e_sim_fsa_t fsa;

    cm1e_servo_t servo;
    cm1e_mechanics_t mechanics;
    int64_t zero;            /**< counts on the scale of the mechanics where 0x6064 is 0 */
    cm1e_sim_watch_t watch;
    cm1e_sim_motion_t motion;
    cm1e_sim_homing_t homing;
    cm1e_sim_sensors_t sensors;
};

/* ---- cm1e.c ----------------------------------------------------------------------------------------------------- */
const cm1e_sim_app_ops_t *cm1e_sim_cm1e_ops(const cm1e_sim_cm1e_t *drive);
/** The application alone; destroyed by its ops. NULL: unknown motor or firmware, or no memory. */
cm1e_sim_cm1e_t *cm1e_sim_cm1e_create_app(const cm1e_axis_config_t *config, cm1e_pdo_order_t order, uint16_t alias,
                                          uint8_t rotary_switches);
/** The CM1-E in a slave; NULL: it is something else. */
cm1e_sim_cm1e_t *cm1e_sim_cm1e_of(cm1e_sim_slave_t *slave);

/* ---- cm1e_firmware.c -------------------------------------------------------------------------------------------- */
uint32_t cm1e_sim_firmware_begin(void *app, const char *name, uint32_t password);
uint32_t cm1e_sim_firmware_data(void *app, size_t offset, const uint8_t *data, size_t size, bool last);
/** The device leaves Bootstrap, or starts: a new firmware is used from now on. */
void cm1e_sim_firmware_start(cm1e_sim_cm1e_t *drive);
/** The image of the EEPROM by the tables, without that of a file; 0: no memory. */
size_t cm1e_sim_write_sii(uint8_t *sii, size_t room, const cm1e_sim_cm1e_t *drive);

/* ---- cm1e_motor.c ----------------------------------------------------------------------------------------------- */
/** "Velocity of axis is 0": for a while, so that a shaft that only turns round does not stand. */
bool cm1e_sim_stands(const cm1e_sim_cm1e_t *drive);
/** 0x6064's view of the shaft. */
int64_t cm1e_sim_actual_counts(const cm1e_sim_cm1e_t *drive);
/** 0x60FD */
uint16_t cm1e_sim_digital_inputs(const cm1e_sim_cm1e_t *drive);
/** Rounded to whole counts, half away from zero. */
static inline int64_t cm1e_sim_rounded(double value) { return (int64_t)(value < 0 ? value - 0.5 : value + 0.5); }

/* ---- cm1e_objects.c --------------------------------------------------------------------------------------------- */
/** Which int32_t of cm1e_sim_objects_t an object is; -1: it is not among them. */
int cm1e_sim_object_place(uint16_t index, uint8_t subindex);
/** The drive alone says what such an object has, whatever a profile does; it is in the dictionary of the device. */
bool cm1e_sim_tells_itself(uint16_t index, uint8_t subindex);
/** An entry of the device tables as this drive has it. */
const cm1e_entry_t *cm1e_sim_own_entry(const cm1e_sim_cm1e_t *drive, const cm1e_entry_t *entry);
/** All to their defaults. */
void cm1e_sim_objects_reset(cm1e_sim_cm1e_t *drive);

/* ---- cm1e_dictionary.c ------------------------------------------------------------------------------------------ */
bool cm1e_sim_dictionary_create(cm1e_sim_cm1e_t *drive);
void cm1e_sim_dictionary_reset(cm1e_sim_cm1e_t *drive);
/** After a change of the firmware; what is kept without power stays. False: no memory, nothing is changed. */
bool cm1e_sim_dictionary_renew(cm1e_sim_cm1e_t *drive);
const cm1e_object_t *cm1e_sim_object(void *app, size_t n);
const cm1e_entry_t *cm1e_sim_entry(void *app, uint16_t index, uint8_t subindex);
uint32_t cm1e_sim_sdo_read(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data, size_t *size);
uint32_t cm1e_sim_sdo_write(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                            size_t size);

/* ---- cm1e_image.c ----------------------------------------------------------------------------------------------- */
/** Writing 0x1C12 or 0x1C13; 0 or an abort code. */
uint32_t cm1e_sim_assign_write(cm1e_sim_cm1e_t *drive, uint16_t index, uint8_t subindex, uint32_t value);
void cm1e_sim_assign_default(cm1e_sim_cm1e_t *drive);
void cm1e_sim_process_data_sizes(void *app, uint16_t *output_bytes, uint16_t *input_bytes);
void cm1e_sim_outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns);
void cm1e_sim_inputs(void *app, uint8_t *data, uint16_t size);
/** The cycle time is not known any more. */
void cm1e_sim_period_forget(cm1e_sim_cm1e_t *drive);
/** Brings the objects that the drive shows up to date. */
void cm1e_sim_refresh(cm1e_sim_cm1e_t *drive);

/* ---- cm1e_fsa.c ------------------------------------------------------------------------------------------------- */
void cm1e_sim_fsa_reset(cm1e_sim_cm1e_t *drive);
/** New process data has come: controlword and mode of operation take effect. */
void cm1e_sim_fsa_outputs(cm1e_sim_cm1e_t *drive);
/** A new 0x6060 takes effect after a while. */
void cm1e_sim_fsa_request_mode(cm1e_sim_cm1e_t *drive);
/** deadline_ns is reached. */
void cm1e_sim_fsa_deadline(cm1e_sim_cm1e_t *drive);
/** Torque off, without an error: Ready to switch on, or Not ready where no mode is chosen. */
void cm1e_sim_fsa_disable(cm1e_sim_cm1e_t *drive);
/** The control power goes: no torque, no state, until power_on(). */
void cm1e_sim_fsa_off(cm1e_sim_cm1e_t *drive);
/** An error of UG 7.3.1 occurs. */
void cm1e_sim_fsa_error(cm1e_sim_cm1e_t *drive, uint16_t code);
void cm1e_sim_fsa_motor_power(cm1e_sim_cm1e_t *drive, bool on);
/** Of the drive, degrees C. */
void cm1e_sim_fsa_temperature(cm1e_sim_cm1e_t *drive, int16_t degrees);
/** 0x603F and 0x1001 as shown now; queues an emergency on a change. */
void cm1e_sim_fsa_update_error(cm1e_sim_cm1e_t *drive);
uint16_t cm1e_sim_fsa_statusword(const cm1e_sim_cm1e_t *drive);

/* ---- cm1e_modes.c, cm1e_homing.c -------------------------------------------------------------------------------- */
extern const cm1e_sim_mode_t cm1e_sim_homing_mode;
/** NULL: not a mode of the device. */
const cm1e_sim_mode_t *cm1e_sim_mode(int8_t mode);
/** Counts/s that one unit of 0x60FF and 0x606C is. */
static inline int32_t cm1e_sim_velocity_unit(const cm1e_sim_cm1e_t *drive)
{
    return drive->firmware->velocity_in_counts_per_ms ? 1000 : 1;
}
void cm1e_sim_homing_reset(cm1e_sim_cm1e_t *drive);
/** Torque is gone: a procedure under way is lost. */
void cm1e_sim_homing_abort(cm1e_sim_cm1e_t *drive);
bool cm1e_sim_homing_running(const cm1e_sim_cm1e_t *drive);

#endif
