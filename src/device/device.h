/**
 * @file device.h
 * What the devices are, as const tables: identity, object dictionary, PDO mappings, sync managers, motors, error codes,
 * firmware differences. The one source for driver, simulator and generators; source of the facts: CM1-E User Guide
 * 2025-03 (UG) and docs/DEVICE.md where the manual contradicts itself. Nothing here is written after start-up.
 */
#ifndef CM1E_DEVICE_DEVICE_H
#define CM1E_DEVICE_DEVICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/config.h"

/* ---- objects by name: OBJ_<index>_<NAME> ------------------------------------------------------------------------- */
enum {
    OBJ_1000_DEVICE_TYPE = 0x1000,
    OBJ_1001_ERROR_REGISTER = 0x1001,
    OBJ_1008_DEVICE_NAME = 0x1008,
    OBJ_1009_HARDWARE_VERSION = 0x1009,
    OBJ_100A_SOFTWARE_VERSION = 0x100A,
    OBJ_1018_IDENTITY = 0x1018,
    OBJ_1C00_SM_TYPES = 0x1C00,
    OBJ_1C12_RXPDO_ASSIGN = 0x1C12,
    OBJ_1C13_TXPDO_ASSIGN = 0x1C13,
    OBJ_1C32_SM_OUTPUT_PARAMETER = 0x1C32,
    OBJ_1C33_SM_INPUT_PARAMETER = 0x1C33,
    OBJ_2201_USER_VARIABLES = 0x2201,
    OBJ_2301_TEMPERATURE = 0x2301,
    OBJ_603F_ERROR_CODE = 0x603F,
    OBJ_6040_CONTROLWORD = 0x6040,
    OBJ_6041_STATUSWORD = 0x6041,
    OBJ_6060_MODES_OF_OPERATION = 0x6060,
    OBJ_6061_MODES_OF_OPERATION_DISPLAY = 0x6061,
    OBJ_6064_POSITION_ACTUAL_VALUE = 0x6064,
    OBJ_606C_VELOCITY_ACTUAL_VALUE = 0x606C,
    OBJ_6077_TORQUE_ACTUAL_VALUE = 0x6077,
    OBJ_6079_DC_LINK_VOLTAGE = 0x6079,
    OBJ_607A_TARGET_POSITION = 0x607A,
    OBJ_607C_HOME_OFFSET = 0x607C,
    OBJ_6081_PROFILE_VELOCITY = 0x6081,
    OBJ_6083_PROFILE_ACCELERATION = 0x6083,
    OBJ_6084_PROFILE_DECELERATION = 0x6084,
    OBJ_6098_HOMING_METHOD = 0x6098,
    OBJ_6099_HOMING_SPEEDS = 0x6099,
    OBJ_609A_HOMING_ACCELERATION = 0x609A,
    OBJ_60F6_K_PARAMETERS = 0x60F6,
    OBJ_60FB_H_PARAMETERS = 0x60FB,
    OBJ_60FD_DIGITAL_INPUTS = 0x60FD,
    OBJ_60FE_DIGITAL_OUTPUTS = 0x60FE,
    OBJ_60FF_TARGET_VELOCITY = 0x60FF,
    OBJ_6502_SUPPORTED_DRIVE_MODES = 0x6502,
    OBJ_FE00_PDO_TIMING = 0xFE00,
    OBJ_FF00_LED_BRIGHTNESS = 0xFF00,
    OBJ_FF01_LED_OVERRIDE = 0xFF01,
};
#define CM1E_K_PARAMETER_HOMING_OFFSET_UNIT 0x19 /**< K45, behind a bridge (BR 6.4.1) */
#define CM1E_K_PARAMETER_HOMING_TORQUE 0x1B /**< sub-index of 0x60F6: K47, % of rated torque (UG 6.2.4) */

/* ---- firmware ---------------------------------------------------------------------------------------------------- */

/** Firmware versions with documented differences (UG 10.1), oldest first. */
typedef enum cm1e_firmware {
    CM1E_FIRMWARE_1_2_0 = 0,
    CM1E_FIRMWARE_1_3_0,
    CM1E_FIRMWARE_1_3_2,
    CM1E_FIRMWARE_1_3_3,
    CM1E_FIRMWARE_1_3_4,
    CM1E_FIRMWARE_1_3_5,
    CM1E_FIRMWARE_COUNT,
} cm1e_firmware_t;

typedef struct cm1e_firmware_info {
    cm1e_firmware_t firmware;
    const char *version;              /**< as object 0x100A shows it, "1.3.5" */
    uint32_t revision;                /**< 0x1018:3 and SII */
    bool velocity_in_counts_per_ms;   /**< 0x60FF, 0x606C; counts/s from V1.3.3 on */
    bool velocity_quarter_in_hm_pp;   /**< below V1.3.0 0x606C shows a quarter in HM and PP */
    bool watchdog;                    /**< process data watchdog disables the motor (V1.3.0) */
    bool mode_in_profile_pdo;         /**< 0x6060/0x6061 in 0x1603/0x1A03 (V1.3.0) */
    bool following_bit;               /**< statusword bit 12 in CSP and CSV (V1.3.0) */
    bool all_cycle_times;             /**< 200/250/500/1000 us; before V1.3.2 only 1000 us */
    uint32_t shortest_cycle_ns;       /**< of these; 0x1C32:5, 0x1C33:5 */
    bool user_variables;              /**< 0x2201 (V1.3.4) */
    bool communication_fault_resets;  /**< clearing a power-up fault 0x7510 resets the device (V1.3.5) */
    bool fault_bit_on_7510;           /**< statusword fault bit on a 0x7510 at power-up (V1.3.5) */
} cm1e_firmware_info_t;

/** Never NULL for a valid enumerator. */
const cm1e_firmware_info_t *cm1e_firmware_info(cm1e_firmware_t firmware);
/** The newest known firmware not newer than `version` ("1.3.5", "V1.3.5", "1.3.7"), the oldest known one for any older
 *  version; NULL where it cannot be parsed. */
const cm1e_firmware_info_t *cm1e_firmware_from_version(const char *version);

/* ---- object dictionary ------------------------------------------------------------------------------------------- */

/** CoE data types (ETG.1020): the numbers go over the wire in SDO information. */
typedef enum cm1e_data_type {
    CM1E_TYPE_BOOL = 0x01,
    CM1E_TYPE_SINT = 0x02, CM1E_TYPE_INT = 0x03, CM1E_TYPE_DINT = 0x04,
    CM1E_TYPE_USINT = 0x05, CM1E_TYPE_UINT = 0x06, CM1E_TYPE_UDINT = 0x07,
    CM1E_TYPE_STRING = 0x09,
} cm1e_data_type_t;

enum cm1e_object_code { CM1E_OBJECT_VAR = 7, CM1E_OBJECT_ARRAY = 8, CM1E_OBJECT_RECORD = 9 };

enum cm1e_access_flags {
    CM1E_ACCESS_READ = 0x01, CM1E_ACCESS_WRITE = 0x02,
    CM1E_ACCESS_WRITE_PREOP_ONLY = 0x04, /**< writing needs Pre-Operational (PDO assignment) */
    CM1E_ACCESS_RXPDO = 0x08, CM1E_ACCESS_TXPDO = 0x10,
};

/** Whether an object does something. Everything of the CM1-E does; of the bridge see bridge_facts.h. */
typedef enum cm1e_availability {
    CM1E_AVAILABLE = 0,
    CM1E_NOT_AVAILABLE, /**< "N/A": in the dictionary, but access is answered with an abort */
    CM1E_NO_PARAMETER,  /**< "-": the motor behind it has no such parameter; access is answered with an abort */
} cm1e_availability_t;

/** What an object that can be written is for. */
typedef enum cm1e_use {
    CM1E_USE_COMMAND = 0, /**< commands, process data, communication: not a parameter of the motor */
    CM1E_USE_SETTING,     /**< a parameter; the guide does not say that it is kept without power */
    CM1E_USE_KEPT,        /**< a parameter that is kept without power, as the guide says */
} cm1e_use_t;

/** One sub-index. `round_to` > 1: the device keeps multiples of it (UG: "rounded to the closest"). */
typedef struct cm1e_entry {
    uint16_t index;
    uint8_t subindex;
    uint8_t access;        /**< cm1e_access_flags */
    cm1e_data_type_t type;
    uint16_t bits;
    uint8_t availability;  /**< cm1e_availability_t */
    const char *name;
    const char *unit;      /**< "" where there is none */
    int64_t default_value, minimum, maximum;
    uint32_t round_to;
    int64_t kept_minimum;  /**< a smaller value is accepted and kept as this one (UG 6.2.2: 0x6083, 0x6084); 0: none */
    uint8_t use;           /**< cm1e_use_t */
    const char *meaning;   /**< one line with its clause, of every entry of the CM1-E that can be written, and of the
                                parameters of a motor behind a bridge; else NULL */
    const char *default_string; /**< CM1E_TYPE_STRING only; "": not known */
    cm1e_firmware_t since;
} cm1e_entry_t;

typedef struct cm1e_object {
    uint16_t index;
    uint8_t object_code;   /**< cm1e_object_code */
    uint8_t highest_subindex;
    const char *name;
    const cm1e_entry_t *entries; /**< in order of sub-index, possibly with gaps */
    uint16_t entry_count;
    cm1e_firmware_t since;
} cm1e_object_t;

/** The CM1-E's dictionary in order of index; `*count` objects. PDO mapping objects are included in the order UG 4.4;
 *  cm1e_device_pdo() gives either order. */
const cm1e_object_t *cm1e_device_objects(size_t *count);
/** NULL: no such object or sub-index in any firmware. */
const cm1e_entry_t *cm1e_device_entry(uint16_t index, uint8_t subindex);
/** In a table in order of index; NULL: no such object. */
const cm1e_object_t *cm1e_object_find(const cm1e_object_t *objects, size_t count, uint16_t index);
/** NULL: it has no such sub-index. */
const cm1e_entry_t *cm1e_object_entry(const cm1e_object_t *object, uint8_t subindex);

/* ---- process data ------------------------------------------------------------------------------------------------ */

/** One entry of a PDO mapping object: index, sub-index, length in bits. */
typedef struct cm1e_pdo_entry {
    uint16_t index;
    uint8_t subindex;
    uint8_t bits;
} cm1e_pdo_entry_t;
#define CM1E_PDO_MAX_ENTRIES 12

typedef struct cm1e_pdo {
    uint16_t index; /**< 0x1600 ... 0x1603, 0x1A00 ... 0x1A03 */
    const char *name;
    uint8_t entry_count;
    cm1e_pdo_entry_t entries[CM1E_PDO_MAX_ENTRIES];
} cm1e_pdo_t;

/** The mapping as `firmware` has it, in the given order; `transmit` selects 0x1A0x. */
void cm1e_device_pdo(cm1e_pdo_t *pdo, cm1e_mapping_t mapping, bool transmit, cm1e_pdo_order_t order,
                     cm1e_firmware_t firmware);

typedef struct cm1e_sync_manager {
    uint16_t start;
    uint16_t length;     /**< mailbox: fixed; process data: of the default mapping */
    uint8_t control;
    uint8_t enable;
    uint8_t type;        /**< 1 mailbox out, 2 mailbox in, 3 outputs, 4 inputs (0x1C00) */
} cm1e_sync_manager_t;
extern const cm1e_sync_manager_t cm1e_device_sync_managers[4];

/* ---- identity, motors, errors ------------------------------------------------------------------------------------ */

#define CM1E_VENDOR_ID 0x00004441u
#define CM1E_VENDOR_NAME "Myostat Motion Control Inc."
#define CM1E_PRODUCT_CODE 0x44412002u
#define CM1E_COUNTS_PER_REVOLUTION 50000

extern const int64_t cm1e_device_cycle_times_ns[4]; /**< 200, 250, 500, 1000 us (UG 4.3) */

typedef struct cm1e_motor {
    const char *name;                 /**< "CM1-E-17S30D" */
    double peak_torque_nm;            /**< UG table 1 */
    double peak_current_a;
    int32_t max_velocity_counts_per_s; /**< UG 6.3 */
} cm1e_motor_t;
extern const cm1e_motor_t cm1e_device_motors[4];
/** NULL: no such motor. "" gives the first. */
const cm1e_motor_t *cm1e_device_motor(const char *name);

typedef struct cm1e_device_error {
    uint16_t code;               /**< 0x603F */
    uint8_t error_register;      /**< 0x1001 */
    bool fault;                  /**< raises statusword bit 3 */
    bool fault_only_when_enabled;/**< in Operation enabled only (0xFF05) */
    const char *text;            /**< UG 7.3.1 */
    const char *cause;           /**< how it comes to it; NULL: `text` says it */
    const char *cure;            /**< what the user does about it */
    bool motor_power;            /**< it says that motor power is missing */
    bool only_off;               /**< while the drive is not enabled it says no more than that */
    bool restarts;               /**< clearing it may restart the device (UG 10.1, V1.3.5) */
} cm1e_device_error_t;
extern const cm1e_device_error_t cm1e_device_errors[];
extern const size_t cm1e_device_error_count;
/** NULL: not a code of UG 7.3.1. */
const cm1e_device_error_t *cm1e_device_error(uint16_t code);

/** Homing parameter ranges and rounding as the dictionary has them are in cm1e_device_entry(); this rounds a value as
 *  the device does (nearest multiple of round_to, half away from zero, at least kept_minimum), without checking the
 *  range. */
int64_t cm1e_entry_round(const cm1e_entry_t *entry, int64_t value);

#endif
