#include "device/objects.h"

#include "device/pdo_tables.h"

/*
 * The dictionary of UG chapter 7 in order of index. Where the text gives no default, it is the value that a drive shows
 * in the screenshot of UG 7.5. Type and access of sub-index 0 are those of the text, except that it is read-only
 * everywhere, as the screenshot has it (the text calls 6099:0 and 60F6:0 writable). Defaults that depend on the
 * firmware (100A, 1018:3, the last row of 1603 and 1A03) are those of the newest one: see cm1e_firmware_info() and
 * cm1e_device_pdo().
 */

#define MAPPING_VALUE(index, bits) ((int64_t)0x##index << 16 | (bits))
#define MAPPING_ROW(pdo, place, index, bits, name, ...)                                                             \
    ENTRY_RANGE(pdo, place, RO, UDINT, name, "", MAPPING_VALUE(index, bits), 0, UINT32_MAX, __VA_ARGS__),
#define ROW_1600(place, index, bits, name) MAPPING_ROW(0x1600, place, index, bits, name, )
#define ROW_1601(place, index, bits, name) MAPPING_ROW(0x1601, place, index, bits, name, )
#define ROW_1602(place, index, bits, name) MAPPING_ROW(0x1602, place, index, bits, name, )
#define ROW_1A00(place, index, bits, name) MAPPING_ROW(0x1A00, place, index, bits, name, )
#define ROW_1A01(place, index, bits, name) MAPPING_ROW(0x1A01, place, index, bits, name, )
#define ROW_1A02(place, index, bits, name) MAPPING_ROW(0x1A02, place, index, bits, name, )
/* Profile mode: the mode of operation came with V1.3.0 (UG 10.1). */
#define PROFILE_ROW(pdo, last, place, index, bits, name)                                                            \
    MAPPING_ROW(pdo, place, index, bits, name, .since = (place) == (last) ? CM1E_FIRMWARE_1_3_0 : CM1E_FIRMWARE_1_2_0)
#define ROW_1603(place, index, bits, name) PROFILE_ROW(0x1603, 7, place, index, bits, name)
#define ROW_1A03(place, index, bits, name) PROFILE_ROW(0x1A03, 9, place, index, bits, name)

#define SM_TYPE(sub, name, value) ENTRY(0x1C00, sub, RO, USINT, name, "", value, )

/* The guide lists 1C32 and 1C33 (UG 7.5) without their entries: these are ETG.1020's, for a device that takes the
 * process data with the frame and supports nothing else (UG 4.3). */
#define SM_PARAMETER(index, name, sync_type)                                                                        \
    RECORD(index, name, 32, ENTRY_COUNT(index, USINT, 32, ),                                                        \
           ENTRY(index, 1, RO, UINT, "Synchronization type", "", sync_type, ),                                      \
           ENTRY(index, 2, RO, UDINT, "Cycle time", "ns", 0, ),                                                     \
           ENTRY(index, 4, RO, UINT, "Synchronization types supported", "", 2, ),                                   \
           ENTRY(index, 5, RO, UDINT, "Minimum cycle time", "ns", 200000, ),                                        \
           ENTRY(index, 6, RO, UDINT, "Calc and copy time", "ns", 0, ),                                             \
           ENTRY(index, 11, RO, UINT, "SM event missed counter", "", 0, ),                                          \
           ENTRY(index, 12, RO, UINT, "Cycle exceeded counter", "", 0, ),                                           \
           ENTRY_RANGE(index, 32, RO, USINT, "Sync error", "", 0, 0, 1, ))

#define H(sub, name)                                                                                                \
    ENTRY(0x60FB, sub, RW, INT, name, "", 0, .use = CM1E_USE_KEPT,                                                  \
          .meaning = "H infinity gain, kept without power: see Motor Tuning in the RT3 manual (UG 7.3.23)")
#define USER_VARIABLE(sub, name, ...)                                                                               \
    ENTRY(0x2201, sub, RW, DINT, name, "", 0, .since = CM1E_FIRMWARE_1_3_4, .meaning = __VA_ARGS__)
#define VOLATILE_VARIABLE "variable of the user, lost without power (UG 7.4.1)"
/* A variable with the range of its type that can be written. */
#define VAR_MEANS(index, name, access, type, unit, value, ...)                                                      \
    VAR_RANGE(index, name, access, type, unit, value, MIN_##type, MAX_##type, __VA_ARGS__)
#define ASSIGNMENT .meaning = "mapping of the process data: 0, the mapping, 1 in Pre-Operational (UG 4.4, 11.2.1)"
#define SETTING(text) .use = CM1E_USE_SETTING, .meaning = text
/* UG 7.5 shows them, and no clause explains them. */
#define OPTION_CODE(what) SETTING("CiA 402 option code: " what "; the guide does not explain it (UG 7.5)")

/* UG 6.3: the fastest of the four motors. */
#define PEAK_SPEED 2500000
/* UG 6.2.3: 32767 kpulses/s2; the text of UG 7.3.17 gives the unit pulses/s2. */
#define PEAK_ACCELERATION 32767000
/* Kept in units of 1000 pulses/s2, at least one of them (UG 6.2.2). The screenshot's default of 6084 is no multiple. */
#define ACCELERATION_STEPS .round_to = 1000, .kept_minimum = 1000

static const cm1e_object_t objects[] = {
    VAR(0x1000, "Device Type", RO, UDINT, "", 0x00040192),
    VAR(0x1001, "Error Register", RO, USINT, "", 0),
    VAR_STRING(0x1008, "Manufacturer Device Name", "CM1-E"),
    VAR_STRING(0x1009, "Manufacturer Hardware Version", "MYO28-02A"),
    VAR_STRING(0x100A, "Manufacturer Software Version", "1.3.5"),
    RECORD(0x1018, "Identity Object", 4, ENTRY_COUNT(0x1018, USINT, 4, ),
           ENTRY(0x1018, 1, RO, UDINT, "Vendor ID", "", CM1E_VENDOR_ID, ),
           ENTRY(0x1018, 2, RO, UDINT, "Product Code", "", CM1E_PRODUCT_CODE, ),
           ENTRY(0x1018, 3, RO, UDINT, "Revision Number", "", 0x20020103, ),
           ENTRY(0x1018, 4, RO, UDINT, "Serial Number", "", 0, )),

    RECORD(0x1600, "Receive PDO mapping parameter - Dynamic switching of modes", 5,
           ENTRY_COUNT(0x1600, USINT, 5, ), PDO_1600_UG_4_4(ROW_1600)),
    RECORD(0x1601, "Receive PDO mapping parameter - CSP mode", 3,
           ENTRY_COUNT(0x1601, USINT, 3, ), PDO_1601_UG_4_4(ROW_1601)),
    RECORD(0x1602, "Receive PDO mapping parameter - CSV mode", 3,
           ENTRY_COUNT(0x1602, USINT, 3, ), PDO_1602_UG_4_4(ROW_1602)),
    RECORD(0x1603, "Receive PDO mapping parameter - Profile mode", 7,
           ENTRY_COUNT(0x1603, USINT, 7, ), PDO_1603_UG_4_4(ROW_1603)),
    RECORD(0x1A00, "Transmit PDO mapping parameter - Dynamic switching of modes", 9,
           ENTRY_COUNT(0x1A00, USINT, 9, ), PDO_1A00_UG_4_4(ROW_1A00)),
    RECORD(0x1A01, "Transmit PDO mapping parameter - CSP mode", 6,
           ENTRY_COUNT(0x1A01, USINT, 6, ), PDO_1A01_UG_4_4(ROW_1A01)),
    RECORD(0x1A02, "Transmit PDO mapping parameter - CSV mode", 6,
           ENTRY_COUNT(0x1A02, USINT, 6, ), PDO_1A02_UG_4_4(ROW_1A02)),
    RECORD(0x1A03, "Transmit PDO mapping parameter - Profile mode", 9,
           ENTRY_COUNT(0x1A03, USINT, 9, ), PDO_1A03_UG_4_4(ROW_1A03)),

    ARRAY(0x1C00, "Sync manager type", 4, ENTRY_COUNT(0x1C00, USINT, 4, ),
          SM_TYPE(1, "SM0 mailbox out", 1), SM_TYPE(2, "SM1 mailbox in", 2), SM_TYPE(3, "SM2 outputs", 3),
          SM_TYPE(4, "SM3 inputs", 4)),
    /* One fixed mapping each way (UG 4.4); written 0, mapping, 1 in Pre-Operational (UG 11.2.1). */
    ARRAY(0x1C12, "RxPDO assign", 1,
          ENTRY_RANGE(0x1C12, 0, RW_PREOP, USINT, "Number of entries", "", 1, 0, 1, ASSIGNMENT),
          ENTRY_RANGE(0x1C12, 1, RW_PREOP, UINT, "Assigned RxPDO", "", 0x1600, 0x1600, 0x1603, ASSIGNMENT)),
    ARRAY(0x1C13, "TxPDO assign", 1,
          ENTRY_RANGE(0x1C13, 0, RW_PREOP, USINT, "Number of entries", "", 1, 0, 1, ASSIGNMENT),
          ENTRY_RANGE(0x1C13, 1, RW_PREOP, UINT, "Assigned TxPDO", "", 0x1A00, 0x1A00, 0x1A03, ASSIGNMENT)),
    SM_PARAMETER(0x1C32, "SM Output Parameter", 0x01),
    SM_PARAMETER(0x1C33, "SM Input Parameter", 0x22),

    OBJECT_SINCE(0x2201, CM1E_OBJECT_ARRAY, "32bit User Variables", 4, CM1E_FIRMWARE_1_3_4,
                 ENTRY_COUNT(0x2201, UINT, 4, .since = CM1E_FIRMWARE_1_3_4), 
                 USER_VARIABLE(1, "Variable1", "variable of the user; bits 14, 15 show in 0x6041 (UG 7.4.1)"),
                 USER_VARIABLE(2, "Variable2", VOLATILE_VARIABLE),
                 USER_VARIABLE(3, "Variable3", VOLATILE_VARIABLE), USER_VARIABLE(4, "Variable4", VOLATILE_VARIABLE)),
    VAR(0x2301, "Drive temperature", RO_TXPDO, INT, "degC", 54),

    /* The manual's tables call 603F not mappable, and map it (UG 4.4, 7.2); the screenshot agrees with the mappings. */
    VAR(0x603F, "Error Code", RO_TXPDO, UINT, "", 0),
    VAR_MEANS(0x6040, "Controlword", RW_RXPDO, UINT, "", 0,
              .meaning = "commands the state machine of the drive (UG 6.1, 7.3.2)"),
    VAR(0x6041, "Statusword", RO_TXPDO, UINT, "", 0x0230),
    VAR_MEANS(0x605A, "Quickstop Option Code", RW, INT, "", 2, OPTION_CODE("how a quick stop ends")),
    VAR_MEANS(0x605B, "Shutdown Option Code", RW, INT, "", 0, OPTION_CODE("how a shutdown stops")),
    VAR_MEANS(0x605C, "Disable Operation Option Code", RW, INT, "", 1, OPTION_CODE("how disabling stops")),
    VAR_MEANS(0x605E, "Fault Reaction Code", RW, INT, "", 0, OPTION_CODE("how a fault stops")),
    VAR_RANGE(0x6060, "Modes of operation", RW_RXPDO, SINT, "", 0, 0, 9,
              .meaning = "mode: 1 PP, 3 PV, 6 homing, 8 CSP, 9 CSV, 0 none (UG 7.3.4)"),
    VAR_RANGE(0x6061, "Modes of operation display", RO_TXPDO, SINT, "", 0, 0, 9, ),
    VAR(0x6064, "Position actual value", RO_TXPDO, DINT, "counts", 0),
    VAR(0x606C, "Velocity actual value", RO_TXPDO, DINT, "counts/s", 0),
    VAR(0x6072, "Peak torque", RO_TXPDO, UINT, "0.1 % of rated torque", 1250),
    VAR(0x6073, "Motor max current", RO, UINT, "0.1 % of rated current", 1200),
    VAR(0x6075, "Motor rated current", RO, UDINT, "mA", 1500),
    VAR(0x6076, "Motor rated torque", RO_TXPDO, UDINT, "mNm", 360),
    VAR(0x6077, "Torque actual value", RO_TXPDO, INT, "0.1 % of rated torque", 0),
    VAR(0x6079, "DC link circuit voltage", RO_TXPDO, DINT, "0.1 V", 238),
    VAR_MEANS(0x607A, "Target position", RW_RXPDO, DINT, "counts", 0, .meaning = "target in CSP and PP (UG 7.3.14)"),
    VAR_RANGE(0x607C, "Home offset", RW, DINT, "counts", 0, -3276700, 3276700, .round_to = 100,
              SETTING("way from the switch or hard stop to the home position, rounded to 100 (UG 7.3.15)")),
    VAR_RANGE(0x6081, "Profile velocity", RW_RXPDO, UDINT, "counts/s", 0, 0, PEAK_SPEED,
              SETTING("velocity in profile position mode (UG 7.3.16)")),
    VAR_RANGE(0x6083, "Profile acceleration", RW_RXPDO, UDINT, "counts/s2", 0, 0, PEAK_ACCELERATION,
              ACCELERATION_STEPS, SETTING("acceleration in profile position and profile velocity mode (UG 7.3.17)")),
    VAR_RANGE(0x6084, "Profile deceleration", RW, UDINT, "counts/s2", 25, 0, PEAK_ACCELERATION, ACCELERATION_STEPS,
              SETTING("deceleration in profile velocity mode (UG 7.3.18)")),
    VAR_RANGE(0x6098, "Homing method", RW, SINT, "", 0, -6, 0,
              SETTING("-1, -2 hard stop CW, CCW; -3, -4 input 2; -5, -6 input 3; 0 none (UG 7.3.19)")),
    ARRAY(0x6099, "Homing speeds", 2,
          ENTRY_RANGE(0x6099, 0, RO, SINT, "Highest sub-index supported", "", 2, 2, 2, ),
          ENTRY_RANGE(0x6099, 1, RW, UDINT, "Speed during search for switch or hardstop", "counts/s", 50000, 1000,
                      500000, .round_to = 100, SETTING("speed of the search, rounded to 100 (UG 7.3.20)")),
          ENTRY(0x6099, 2, RW, UDINT, "Speed during search for zero (not used)", "counts/s", 0,
                .meaning = "not used: the search for zero has the speed of sub-index 1 (UG 7.3.20)")),
    VAR_RANGE(0x609A, "Homing acceleration", RW, UDINT, "counts/s2", 100000, 1000, 5000000, .round_to = 1000,
              SETTING("acceleration of a homing, rounded to 1000 (UG 7.3.21)")),
    {.index = 0x60F6, .object_code = CM1E_OBJECT_ARRAY, .highest_subindex = K_PARAMETER_COUNT,
     .name = "K Parameter Settings", .entries = cm1e_device_k_parameters, .entry_count = 1 + K_PARAMETER_COUNT},
    /* UG 7.3.23 lists H0 ... H8; the drive of the screenshot has 8 entries only. */
    ARRAY(0x60FB, "H Parameter Settings", 9, ENTRY_COUNT(0x60FB, UINT, 9, ), H(1, "H0"), H(2, "H1"), H(3, "H2"),
          H(4, "H3"), H(5, "H4"), H(6, "H5"), H(7, "H6"), H(8, "H7"), H(9, "H8")),
    /* 16 bits each, not CiA 402's 32. */
    VAR_RANGE(0x60FD, "Digital inputs", RO_TXPDO, UINT, "", 0, 0, 0x000F, ),
    VAR_MEANS(0x60FE, "Digital outputs", RW_RXPDO, UINT, "", 0, .meaning = "bit 0: output 1 (UG 7.3.25)"),
    VAR_RANGE(0x60FF, "Target velocity", RW_RXPDO, DINT, "counts/s", 0, -PEAK_SPEED, PEAK_SPEED,
              .meaning = "target in CSV and PV (UG 7.3.26)"),
    VAR(0x6502, "Supported drive modes", RO, UDINT, "", 0x1A5),

    ARRAY(0xFE00, "PDO Timing", 4, ENTRY_COUNT(0xFE00, UINT, 4, ),
          ENTRY_RANGE(0xFE00, 1, RO, UINT, "PDO Time", "us", 0, 0, 1000, ),
          ENTRY(0xFE00, 2, RO, UINT, "N/A", "", 0, ), ENTRY(0xFE00, 3, RO, UINT, "N/A", "", 0, ),
          ENTRY(0xFE00, 4, RO, UINT, "N/A", "", 0, )),
    VAR_RANGE(0xFF00, "Status LED brightness", RW, SINT, "", 1, 0, 16, .use = CM1E_USE_KEPT,
              .meaning = "0 off, 1 minimum, 16 maximum; kept without power (UG 7.4.4)"),
    VAR_RANGE(0xFF01, "Status LED Override", RW, UDINT, "", 0, 0, 0x01010103,
              .meaning = "bytes 3, 2, 1: red, green, blue; byte 0: 1 override, 3 flash (UG 7.4.5)"),
};
enum { OBJECT_COUNT = sizeof objects / sizeof objects[0] };

const cm1e_object_t *cm1e_device_objects(size_t *count)
{
    *count = OBJECT_COUNT;
    return objects;
}

const cm1e_entry_t *cm1e_device_entry(uint16_t index, uint8_t subindex)
{
    const cm1e_object_t *object = cm1e_object_find(objects, OBJECT_COUNT, index);
    return object ? cm1e_object_entry(object, subindex) : NULL;
}

int64_t cm1e_entry_round(const cm1e_entry_t *entry, int64_t value)
{
    if (entry->round_to > 1) {
        const int64_t step = entry->round_to;
        const int64_t rest = value % step; /* has the sign of value */
        value -= rest;
        if (2 * rest >= step)
            value += step;
        else if (2 * rest <= -step)
            value -= step;
    }
    if (entry->kept_minimum > 0 && value < entry->kept_minimum)
        value = entry->kept_minimum;
    return value;
}
