/**
 * @file bridge_facts.h
 * The EtherCAT Cool MUSCLE Bridge, as device.h has the CM1-E: one slave, up to four Cool Muscle motors behind it, each
 * an axis. Source of the facts: EtherCAT Cool MUSCLE Bridge User's Guide 2016 (BR), and docs/DEVICE.md where it
 * contradicts itself. Axes count from 0 here; the guide's ID is one more.
 */
#ifndef CM1E_DEVICE_BRIDGE_FACTS_H
#define CM1E_DEVICE_BRIDGE_FACTS_H

#include "cm1e/bridge.h"
#include "device/device.h"

enum {
    OBJ_10F1_ERROR_SETTINGS = 0x10F1,
    OBJ_60E3_SUPPORTED_HOMING_METHODS = 0x60E3,
    OBJ_F000_MODULAR_DEVICE_PROFILE = 0xF000,
    OBJ_F010_MODULE_PROFILE_LIST = 0xF010,
    OBJ_F030_CONFIGURED_MODULE_IDENT_LIST = 0xF030,
    OBJ_F050_DETECTED_MODULE_IDENT_LIST = 0xF050,
    OBJ_F511_CONFIG_AXIS_1 = 0xF511,
    OBJ_F530_SYSTEM_INFO = 0xF530,
    OBJ_F540_CONFIG_SYSTEM = 0xF540,
    OBJ_F581_CML_COMMAND_AXIS_1 = 0xF581,
    OBJ_F591_CML_RESPONSE_AXIS_1 = 0xF591,
};

#define CM1E_BRIDGE_INDEX_INCREMENT 0x800 /**< from an object of one axis to that of the next (F000:1) */
#define CM1E_BRIDGE_PDO_INCREMENT 0x10    /**< from a mapping object of one axis to that of the next */
#define CM1E_BRIDGE_DEVICE_TYPE 0x00040192u /**< of the device and of each axis (F010) */
#define CM1E_BRIDGE_MODULE_IDENT 0x00219800u /**< of each axis, whatever motor is behind it (F030, F050) */
#define CM1E_BRIDGE_CYCLE_TIME_NS 1000000 /**< the only one (BR 6.3) */
#define CM1E_BRIDGE_MODE_INTERVAL_NS 5000000 /**< between writes of 0x6060: more than that (BR 6.2.2 note 2) */
#define CM1E_BRIDGE_STATUS_SUBINDEX(id) ((uint8_t)(4 + (id))) /**< of F530: what the motor at ID 1 ... 4 says */

/** Between one CML string and the next: the shorter time after one of less than so many bytes (BR 7.2.2). */
#define CM1E_BRIDGE_CML_LONG_BYTES 32
#define CM1E_BRIDGE_CML_SHORT_NS 4000000
#define CM1E_BRIDGE_CML_LONG_NS 8000000

/** What 1 in the objects of homing is: counts, counts/s, counts/s2 (BR 6.4.1; K48, K42, K43). The offset's is the
 *  coarsest: a CM2 may be set to finer ones by its K45. */
#define CM1E_BRIDGE_OFFSET_UNIT 100
#define CM1E_BRIDGE_SPEED_UNIT 100
#define CM1E_BRIDGE_ACCELERATION_UNIT 1000
/** Of the offset of a CM2, by the second digit of its K45 (BR 6.4.1, note 3); 0: the guide has no such digit. */
int cm1e_bridge_offset_unit(int32_t k45);

/** Bits of the statusword in csp and hm that CiA 402 leaves to the manufacturer (BR 6.1.3). */
enum { CM1E_BRIDGE_STATUSWORD_ERROR = 0x4000, CM1E_BRIDGE_STATUSWORD_FREE = 0x8000 };

/** Values of 0x6060 and 0x6061 (BR 6). */
typedef enum cm1e_bridge_mode {
    CM1E_BRIDGE_MODE_HM = 6,
    CM1E_BRIDGE_MODE_CSP = 8,   /**< after power-on, and whenever something else than these is written */
    CM1E_BRIDGE_MODE_CML = 101,
    CM1E_BRIDGE_MODE_CMD = 120,
    CM1E_BRIDGE_MODE_CPIO = 121,
} cm1e_bridge_mode_t;

/** "csp", "hm", "CML", "CMD", "CPIO"; NULL: it is none of these. */
const char *cm1e_bridge_mode_name(int8_t mode);

/** "EB01"; NULL: the model is no bridge. */
const char *cm1e_bridge_name(cm1e_device_model_t model);
/** EB01: four CM1, EB02: four CM2, EB12: CM1 on axes 0 and 1, CM2 on axes 2 and 3 (BR 1.4). */
cm1e_bridge_motor_t cm1e_bridge_motor(cm1e_device_model_t model, unsigned axis);

/** The dictionary of a model, all four axes, in order of index: its object number `n`; NULL: no more. Identity (0x1018)
 *  is not stated in the guide and 0 here. */
const cm1e_object_t *cm1e_bridge_object(cm1e_device_model_t model, size_t n);
/** The part of it that is one axis, by the motor: 0x603F ... 0x67FE + 0x800 * axis, in order; `*count` objects. */
const cm1e_object_t *cm1e_bridge_axis_objects(cm1e_bridge_motor_t motor, unsigned axis, size_t *count);
/** NULL: no such object or sub-index. See `availability` of what is there. */
const cm1e_entry_t *cm1e_bridge_entry(cm1e_device_model_t model, uint16_t index, uint8_t subindex);
/** The axis whose object, or whose mapping object, this is; -1: the device's own. */
int cm1e_bridge_axis_of(uint16_t index);

/** The one mapping of an axis in each direction: 0x1601, 0x1A01 and those of the other axes. Sync managers are those of
 *  cm1e_device_sync_managers. */
void cm1e_bridge_pdo(cm1e_pdo_t *pdo, unsigned axis, bool transmit);

/** The greatest position, in either direction, by K37 (resolution and unit of speed) of the motor (BR appendix 5).
 *  0: the motor knows no such value of K37. */
int32_t cm1e_bridge_position_limit(cm1e_bridge_motor_t motor, int32_t k37);
/** Counts in one revolution by K37; 0: no motor knows such a value. */
int32_t cm1e_bridge_counts_per_revolution(int32_t k37);

/** Digital outputs that the motor leaves to its user, bit 0: output 1. A CM1 has its serial line there (BR 6.5.2). */
uint8_t cm1e_bridge_output_mask(cm1e_bridge_motor_t motor);
/** Digital inputs, bit 0: input 1. A CM1 has its serial line there, and four (BR 6.5.1). */
uint8_t cm1e_bridge_input_mask(cm1e_bridge_motor_t motor);

/** "CM1", "CM2". */
const char *cm1e_bridge_motor_name(cm1e_bridge_motor_t motor);
/** The model that has them; EB12 where all may be any. false: there is no such bridge. */
bool cm1e_bridge_model_with(const char *const motors[CM1E_BRIDGE_AXES], cm1e_device_model_t *model);

#endif
