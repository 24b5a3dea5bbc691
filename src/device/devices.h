/**
 * @file devices.h
 * The devices that the library can drive, one const table each. What the bus, the drive, the axis, the configuration,
 * the description, the simulator and the tools have to know of a device is here; they name no device. A device is
 * one slave. The motor of each axis on it is a cm1e_device_drive_t: a CM1-E has one, a bridge has four.
 *
 * A new device is a source beside device_cm1e.c and a row in devices.c; docs/DESIGN.md lists the few other places.
 */
#ifndef CM1E_DEVICE_DEVICES_H
#define CM1E_DEVICE_DEVICES_H

#include "cia402/cia402.h"
#include "device/bridge_facts.h"

/* ---- process data ------------------------------------------------------------------------------------------------ */

/** The objects that the driver exchanges in the cycle. */
typedef enum cm1e_role {
    CM1E_OUT_CONTROLWORD = 0, CM1E_OUT_POSITION, CM1E_OUT_VELOCITY, CM1E_OUT_MODE, CM1E_OUT_DIGITAL,
    CM1E_OUT_PROFILE_VELOCITY, CM1E_OUT_PROFILE_ACCELERATION, CM1E_OUT_PROFILE_DECELERATION, CM1E_OUT_PROBE,
    CM1E_IN_STATUSWORD, CM1E_IN_ERROR, CM1E_IN_POSITION, CM1E_IN_VELOCITY, CM1E_IN_TORQUE, CM1E_IN_DIGITAL,
    CM1E_IN_TEMPERATURE, CM1E_IN_DC_LINK, CM1E_IN_MODE, CM1E_IN_PROBE, CM1E_IN_PROBE_1_RISING,
    CM1E_IN_PROBE_1_FALLING, CM1E_IN_PROBE_2_RISING, CM1E_IN_PROBE_2_FALLING,
    CM1E_ROLE_COUNT,
    CM1E_NO_ROLE = CM1E_ROLE_COUNT,
} cm1e_role_t;
/** Roles before this one are outputs. */
#define CM1E_FIRST_INPUT CM1E_IN_STATUSWORD

/** One object that the driver uses: which sizes it understands, which mappings must have it. */
typedef struct cm1e_device_object {
    cm1e_role_t role;
    uint16_t index;                 /**< of the first axis */
    uint8_t least_bytes, most_bytes;
    uint8_t needed_in;              /**< 1 << cm1e_mapping_t */
    const char *name;
    uint8_t subindex;
} cm1e_device_object_t;

/** A choice of process data. `name` NULL: the device has no such mapping. */
typedef struct cm1e_device_mapping {
    const char *name;
    cm1e_mode_t first_mode;
} cm1e_device_mapping_t;

/** PDOs to assign to the sync managers, in order, as many in each direction. */
enum { CM1E_ASSIGNED_PDOS = 16 };
typedef struct cm1e_pdo_choice {
    uint8_t count;                       /**< 0: those that the device has assigned itself */
    uint16_t pdos[2][CM1E_ASSIGNED_PDOS]; /**< outputs, inputs */
} cm1e_pdo_choice_t;

/* ---- controlword, statusword, modes ------------------------------------------------------------------------------ */

/** How controlword and statusword are coded; masks of 0: the words have no such bits. */
typedef struct cm1e_device_words {
    const cm1e_fsa_row_t *states;   /**< of the statusword; NULL: it shows none */
    uint16_t voltage;               /**< motor power; 0: not shown, it counts as on */
    uint16_t fault;                 /**< any of these bits */
    uint16_t warning;
    uint16_t motor_free;            /**< no torque, whatever the state */
    uint16_t target_reached, bit12, bit13;
    uint16_t inputs, outputs;       /**< digital inputs in the statusword, outputs in the controlword: from bit 4 on */
    uint16_t mark;                  /**< always in the controlword */
    uint16_t no_torque, fault_reset; /**< controlwords; fault_reset as no_torque: there is no such command */
    bool commands;                  /**< the words are those of the drive room's drive_command.h */
    bool own_coding;                /**< in other modes they would be something else */
    bool rests_disabled;            /**< Switch on disabled is where it is ready to be switched on */
} cm1e_device_words_t;
enum { CM1E_DEVICE_SIGNALS_AT = 4 };

/** One mode of operation. */
typedef struct cm1e_device_mode {
    int8_t mode;                    /**< 0x6060, 0x6061 */
    const char *abbreviation;
    const cm1e_device_words_t *words;
    cm1e_role_t target;             /**< object without which the mode is of no use; CM1E_NO_ROLE: none */
    bool torque;                    /**< Operation enabled is for this mode, too */
    bool holds_position;            /**< the target position acts */
    bool halts;                     /**< by bit 8 of the controlword */
    uint16_t controlword;           /**< bits that are always set in Operation enabled */
    uint8_t ways;                   /**< rows of the table from which it can be reached: 1 << row; WAYS_ALL */
    bool rest;                      /**< reached at rest and without an error only (BR appendix 3) */
    bool leaves_abnormal;           /**< csp "will possibly result in operating abnormal" after it (BR 6 note 2) */
    const char *cure;               /**< of an error in this mode, where it is another one than a fault reset */
} cm1e_device_mode_t;
#define CM1E_DEVICE_WAYS_ALL 0xFF

/* ---- homing ------------------------------------------------------------------------------------------------------ */

/** The parameters of a homing that the drive makes. */
enum { CM1E_HOMING_OFFSET = 0, CM1E_HOMING_METHOD, CM1E_HOMING_SPEED, CM1E_HOMING_ACCELERATION, CM1E_HOMING_TORQUE,
       CM1E_HOMING_PARAMETERS };

typedef struct cm1e_homing_object {
    uint16_t index;                 /**< 0: the drive has no such parameter */
    uint8_t subindex;
    double unit;                    /**< counts, or what it is, in one of the object's */
    const cm1e_entry_t *range;      /**< NULL: that of the drive's dictionary */
} cm1e_homing_object_t;

/** The order in which the steps of a homing come is the device's. */
typedef enum cm1e_home_step {
    HOME_READ = 0,  /**< the unit of the offset over SDO; the axis holds its position */
    HOME_REST,      /**< it holds its position until the motor is at standstill */
    HOME_WRITE,     /**< parameters over SDO; the axis holds its position, or is at rest in homing mode */
    HOME_SWITCH,    /**< to homing mode */
    HOME_TAKEN,     /**< the drive takes the parameters over */
    HOME_START,     /**< start bit set; the status bits are still those of before */
    HOME_RUN,
    HOME_SETTLE,    /**< the drive has ended: until the motor is at standstill */
    HOME_HALT,      /**< halt bit set, or start bit cleared, until standstill */
    HOME_RETURN,    /**< back to the axis's own mode */
} cm1e_home_step_t;
enum { CM1E_HOME_STEPS_MAX = 10 };

typedef struct cm1e_device_homing {
    int8_t first_method, last_method;
    int8_t first_by_switch, last_by_switch; /**< those that look for a switch and not for a stop */
    int8_t positive_stop, negative_stop;    /**< methods that run against a hard stop; 0: none */
    bool halts;                /**< it has a halt bit */
    bool attained_is_enough;   /**< bit 12 alone and standstill (BR appendix 4.2) */
    bool offset_by_axis;       /**< the drive stays at the reference; where the axis's 0 is, the axis reckons */
    cm1e_homing_object_t objects[CM1E_HOMING_PARAMETERS];
    uint8_t subindex_by_stop;  /**< of SPEED, for the methods without a switch; 0: the same */
    const char *place;         /**< "" or " behind a bridge", in a text about methods */
    cm1e_home_step_t steps[CM1E_HOME_STEPS_MAX]; /**< up to HOME_RETURN */
} cm1e_device_homing_t;

/* ---- the drive of one axis --------------------------------------------------------------------------------------- */

/** Where digital signals go that are neither in the process data nor in the words. */
typedef struct cm1e_device_signals {
    uint16_t inputs, outputs;       /**< that the drive has, bit 0: input 1 */
    bool by_sdo;                    /**< reached by SDO only: others than those of the masks do not exist for anybody */
    uint8_t output_subindex;        /**< of 0x60FE */
    uint8_t output_shift;           /**< bit of the first output in it */
    const char *advice[3];          /**< further sentences: no such signal, not in the process data, no torque; NULL */
} cm1e_device_signals_t;
enum { CM1E_ADVICE_SIGNAL = 0, CM1E_ADVICE_MAPPING, CM1E_ADVICE_POWER };

typedef struct cm1e_device_drive {
    const char *name;               /**< "CM1-E" */
    const char *short_name;         /**< "CM1-E", "CM2"; in "a CM2 has no K25" */
    const char *place;              /**< "" or "behind the bridge " */
    const cm1e_device_object_t *objects;
    size_t object_count;
    cm1e_device_mapping_t mappings[CM1E_MAPPING_PROFILE + 1];
    const cm1e_device_mode_t *modes;
    size_t mode_count;
    const char *no_way;             /**< a sentence: why a mode is not reached from the present one */
    const char *refusal;            /**< a sentence: why a switch of mode is not confirmed */
    bool asks_mode_first;           /**< 0x6061 is read before 0x6060 is written: not every way can be gone back */
    bool mode_supervised;           /**< an unconfirmed switch is a fault without torque, too */
    bool position_limited;          /**< targets have a narrower range than 32 bits */
    bool hardware_probe;            /**< touch probe of its own (0x60B8), where it is mapped */
    int64_t reset_settle_ns;        /**< an error that a reset has cleared may come back by itself until then */
    const cm1e_device_homing_t *homing; /**< NULL: none */
    cm1e_device_signals_t signals;
    /** Error codes (0x603F); NULL: not one of the device. */
    const cm1e_device_error_t *(*error)(uint16_t code);
    const char *error_clause;       /**< where they are listed: "UG 7.3.1"; NULL: they are another drive's */
} cm1e_device_drive_t;

/** NULL: not a mode of this drive. */
const cm1e_device_mode_t *cm1e_device_mode(const cm1e_device_drive_t *drive, int8_t mode);

/* ---- the device -------------------------------------------------------------------------------------------------- */

typedef enum cm1e_recognition_kind {
    CM1E_BY_IDENTITY = 0,           /**< vendor and product code */
    CM1E_BY_OBJECTS,                /**< values of its objects, asked for in a scan (BR appendix 6) */
    CM1E_BY_PROFILE,                /**< the profile in 0x1000, where the configuration expects the device */
} cm1e_recognition_kind_t;

/** An object whose value a scan asks for. */
typedef struct cm1e_question {
    uint16_t index;
    uint8_t subindex;
    uint32_t wanted;                /**< the answer of the device; 0: whatever it is, it is kept */
} cm1e_question_t;

/** A key of the configuration whose value is wrong for a device, and why. */
typedef struct cm1e_wrong_key {
    const char *key;
    char text[200];
} cm1e_wrong_key_t;

/** A key of the configuration that means nothing for a device, and what is said where it is given. */
typedef struct cm1e_absent_key {
    const char *key, *text;
} cm1e_absent_key_t;

typedef struct cm1e_device cm1e_device_t;
struct cm1e_device {
    const char *kind;               /**< "cm1-e", "bridge"; all bridges are one kind */
    const char *label;              /**< of the kind, in sentences: "CM1-E", "Cool MUSCLE Bridge" */
    const char *name;               /**< "CM1-E", "EB12"; NULL: a model that is not known */
    const char *family;             /**< "bridge": diagnoses say "bridge EB12"; NULL: they say the name in the SII */
    cm1e_device_model_t model;

    cm1e_recognition_kind_t recognised;
    uint32_t vendor_id, product_code; /**< CM1E_BY_IDENTITY */
    uint16_t profile;               /**< CM1E_BY_PROFILE: the low word of 0x1000 */
    const cm1e_question_t *questions; /**< CM1E_BY_OBJECTS */
    size_t question_count;
    uint8_t channels;               /**< 0: the slave is one axis; else axes are behind it and have a channel */
    bool explicit_id;               /**< it tells the position of its rotary switches (register 0x0134) */
    bool described;                 /**< descriptions for other masters are made from its tables */
    bool extra_is_error;            /**< one that no axis is configured for is an error, and not just another slave */

    const int64_t *cycle_times_ns;  /**< all that it accepts */
    size_t cycle_time_count;
    /** NULL: no difference between versions is known. */
    const cm1e_firmware_info_t *(*firmware)(const char *version);
    /** The dictionary as one table in order of index; NULL: it is in parts. */
    const cm1e_object_t *(*objects)(size_t *count);
    /** Object number n of the dictionary, in order of index; NULL: no more. */
    const cm1e_object_t *(*object)(const cm1e_device_t *device, size_t n);
    const cm1e_entry_t *(*entry)(const cm1e_device_t *device, uint16_t index, uint8_t subindex);
    /** What the bus assigns; `axis` NULL: no axis is configured there. */
    cm1e_pdo_choice_t (*pdos)(const cm1e_axis_config_t *axis);

    /* Files of other masters; NULL: nothing is known that could be wrong. */
    bool (*revision_known)(uint32_t revision);
    const char *revisions;          /**< in a text: the revisions that are known */
    bool (*pdo_known)(const cm1e_pdo_t *pdo, bool transmit); /**< its mappings are fixed, and this is one of them */

    /* Of the configuration of an axis, before a slave is known. */
    bool motor_stated;              /**< the configuration has to state counts per revolution and maximum speed */
    double (*counts_per_revolution)(const cm1e_axis_config_t *axis);
    double (*peak_velocity)(const cm1e_axis_config_t *axis); /**< counts/s; 0: there is no such motor */
    const char *(*motor)(size_t n); /**< names for `motor`; NULL: no more. NULL: it takes none */
    const char *motors_note;        /**< behind their list in a text */
    const cm1e_absent_key_t *absent; /**< keys that mean nothing for it; ends with a key of NULL */
    /** Checks the keys that only this device has; NULL: there are none. */
    bool (*check_axis)(const cm1e_axis_config_t *axis, cm1e_wrong_key_t *wrong);
    /** The greatest position in either direction, counts; NULL: what a double counts exactly. */
    double (*position_limit)(const cm1e_axis_config_t *axis);
    /** The model of this kind that has these motors at its channels ("" or NULL: any); NULL: there is none. NULL where
     *  the device has no channels. */
    const cm1e_device_t *(*with_motors)(const char *const motors[CM1E_BRIDGE_AXES]);
    const char *models_note;        /**< in a text: the motors of each model */

    const cm1e_device_drive_t *drives[CM1E_BRIDGE_AXES]; /**< by channel - 1; without channels the first */
};

extern const cm1e_device_t cm1e_device_cm1e;
/** A servo drive of any maker (device/cia402_drive.h). */
extern const cm1e_device_t cm1e_device_cia402;
extern const cm1e_device_t cm1e_device_eb01, cm1e_device_eb02, cm1e_device_eb12;
/** A bridge whose motors no known model has together: no axis can be behind it. */
extern const cm1e_device_t cm1e_device_unknown_bridge;

/** Device number n; NULL: no more. Devices of unknown models are not among them. */
const cm1e_device_t *cm1e_device_number(size_t n);
/** NULL: there is no such model. */
const cm1e_device_t *cm1e_device_of_model(cm1e_device_model_t model);
/** NULL: no device is recognised by this identity. */
const cm1e_device_t *cm1e_device_of_identity(uint32_t vendor_id, uint32_t product_code);
/** The devices that are recognised in that way: the first one; NULL: there is none. */
const cm1e_device_t *cm1e_device_recognised(cm1e_recognition_kind_t recognised);
/** What the configuration says of the slave of an axis. Of several models of a kind that one which has the motor; where
 *  the motor is left open, the one that can do most. NULL: `device` is the name of none. */
const cm1e_device_t *cm1e_device_configured(const cm1e_axis_config_t *axis);
/** The drive that the configuration says; NULL: see cm1e_device_configured(). */
const cm1e_device_drive_t *cm1e_device_drive_configured(const cm1e_axis_config_t *axis);
/** The axis shares its slave with others, and has a channel there. */
bool cm1e_device_is_shared(const cm1e_axis_config_t *axis);
/** A model with channels, and with these motors at them ("" or NULL: any). */
bool cm1e_device_has_motors(const cm1e_device_t *device, const char *const motors[CM1E_BRIDGE_AXES]);
/** Its cycle times in us, with this word before the last one: "200, 250, 500 and 1000". */
enum { CM1E_CYCLE_TIMES_TEXT = 64 };
const char *cm1e_device_cycle_times(const cm1e_device_t *device, const char *word, char text[CM1E_CYCLE_TIMES_TEXT]);
/** A bus with this cycle time can have the device. */
bool cm1e_device_has_cycle_time(const cm1e_device_t *device, int64_t cycle_time_ns);
/** Models of one kind, whatever motors they have; false where one of them is NULL. */
bool cm1e_device_same_kind(const cm1e_device_t *a, const cm1e_device_t *b);
/** The drive of an axis by its channel; NULL: there is no such channel, or the model is not known. */
const cm1e_device_drive_t *cm1e_device_drive(const cm1e_device_t *device, unsigned channel);

#endif
