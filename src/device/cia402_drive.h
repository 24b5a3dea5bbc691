/**
 * @file cia402_drive.h
 * A servo drive of any maker that keeps to CiA 402 and ETG.6010: the modes csp, csv, pp, pv and hm, and the touch probe
 * where it has one. Its objects are those of the standard. The ranges here are those of their types, as the makers'
 * differ. Its motor is stated by the configuration. The simulated drive plays this dictionary.
 */
#ifndef CM1E_DEVICE_CIA402_DRIVE_H
#define CM1E_DEVICE_CIA402_DRIVE_H

#include "device/devices.h"

enum {
    OBJ_605A_QUICK_STOP_OPTION = 0x605A,
    OBJ_6065_FOLLOWING_ERROR_WINDOW = 0x6065,
    OBJ_6085_QUICK_STOP_DECELERATION = 0x6085,
    OBJ_60B8_TOUCH_PROBE_FUNCTION = 0x60B8,
    OBJ_60B9_TOUCH_PROBE_STATUS = 0x60B9,
    OBJ_60BA_TOUCH_PROBE_1_POSITIVE = 0x60BA,
    OBJ_60BB_TOUCH_PROBE_1_NEGATIVE = 0x60BB,
    OBJ_60BC_TOUCH_PROBE_2_POSITIVE = 0x60BC,
    OBJ_60BD_TOUCH_PROBE_2_NEGATIVE = 0x60BD,
    OBJ_60C2_INTERPOLATION_TIME = 0x60C2,
};

/** Touch probes by IEC 61800-7-201 (CiA 402-2). Touch probe n (0 or 1) has its bits 8 * n further on. Object 60B8h,
 *  function: */
enum { CM1E_PROBE_ENABLE = 0x01, CM1E_PROBE_CONTINUOUS = 0x02, CM1E_PROBE_POSITIVE = 0x10, CM1E_PROBE_NEGATIVE = 0x20 };
/** Object 60B9h, status. A "stored" bit is reset with the enable bit or the sampling bit of its edge. */
enum { CM1E_PROBE_ENABLED = 0x01, CM1E_PROBE_POSITIVE_STORED = 0x02, CM1E_PROBE_NEGATIVE_STORED = 0x04 };

/** The profile in the low word of 0x1000. */
#define CM1E_PROFILE_402 402u
/** Digital outputs of the maker's in 0x60FE:1; bit 0 is the brake. */
enum { CM1E_CIA402_OUTPUT_SHIFT = 16, CM1E_CIA402_OUTPUTS = 0x000F };

/** The PDOs of the simulated drive: number 0 all modes, 1 csp, 2 csv; false: there are no more. */
enum { CM1E_CIA402_MAPPINGS = 3 };
void cm1e_cia402_pdo(cm1e_pdo_t *pdo, unsigned number, bool transmit);

const cm1e_object_t *cm1e_cia402_objects(size_t *count);
/** Error codes of CiA 301 and CiA 402 (0x603F); NULL: not one of theirs. */
const cm1e_device_error_t *cm1e_cia402_error(uint16_t code);

/** The identity of the simulated drive: vendor 0, which no maker has. */
#define CM1E_CIA402_SIM_PRODUCT_CODE 0x00000402u
#define CM1E_CIA402_SIM_REVISION 1u

#endif
