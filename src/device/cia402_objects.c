#include "device/cia402_drive.h"
#include "device/device_rows.h"
#include "device/objects.h"

/* X(place, index, sub-index, bits, name); index 0 is a gap. The gap behind the 8 bits of the mode is what many drives
 * have there. */
#define PDO_1600(X)                                                                                                 \
    X(1, 0x6040, 0, 16, "Controlword") X(2, 0x6060, 0, 8, "Modes of operation") X(3, 0, 0, 8, "Gap")                \
    X(4, 0x607A, 0, 32, "Target position") X(5, 0x60FF, 0, 32, "Target velocity")                                   \
    X(6, 0x60B8, 0, 16, "Touch probe function") X(7, 0x60FE, 1, 32, "Physical outputs")
#define PDO_1601(X) X(1, 0x6040, 0, 16, "Controlword") X(2, 0x607A, 0, 32, "Target position")
#define PDO_1602(X) X(1, 0x6040, 0, 16, "Controlword") X(2, 0x60FF, 0, 32, "Target velocity")
#define PDO_1A00(X)                                                                                                 \
    X(1, 0x6041, 0, 16, "Statusword") X(2, 0x6061, 0, 8, "Modes of operation display") X(3, 0, 0, 8, "Gap")         \
    X(4, 0x6064, 0, 32, "Position actual value") X(5, 0x606C, 0, 32, "Velocity actual value")                       \
    X(6, 0x6077, 0, 16, "Torque actual value") X(7, 0x603F, 0, 16, "Error code")                                    \
    X(8, 0x60FD, 0, 32, "Digital inputs") X(9, 0x60B9, 0, 16, "Touch probe status")                                 \
    X(10, 0x60BA, 0, 32, "Touch probe 1 positive edge") X(11, 0x60BB, 0, 32, "Touch probe 1 negative edge")         \
    X(12, 0x60BC, 0, 32, "Touch probe 2 positive edge")
#define PDO_1A01(X)                                                                                                 \
    X(1, 0x6041, 0, 16, "Statusword") X(2, 0x6064, 0, 32, "Position actual value")                                  \
    X(3, 0x603F, 0, 16, "Error code") X(4, 0x60FD, 0, 32, "Digital inputs")
#define PDO_1A02(X)                                                                                                 \
    X(1, 0x6041, 0, 16, "Statusword") X(2, 0x6064, 0, 32, "Position actual value")                                  \
    X(3, 0x606C, 0, 32, "Velocity actual value") X(4, 0x603F, 0, 16, "Error code")

#define ENTRY_OF(place, index, sub, bits, name) {index, sub, bits},
#define ONE_OF(place, index, sub, bits, name) +1
#define PDO(index, name, rows) {index, name, 0 rows(ONE_OF), {rows(ENTRY_OF)}}

void cm1e_cia402_pdo(cm1e_pdo_t *pdo, unsigned number, bool transmit)
{
    static const cm1e_pdo_t pdos[CM1E_CIA402_MAPPINGS][2] = {
        {PDO(0x1600, "RxPDO, all modes", PDO_1600), PDO(0x1A00, "TxPDO, all modes", PDO_1A00)},
        {PDO(0x1601, "RxPDO csp", PDO_1601), PDO(0x1A01, "TxPDO csp", PDO_1A01)},
        {PDO(0x1602, "RxPDO csv", PDO_1602), PDO(0x1A02, "TxPDO csv", PDO_1A02)},
    };
    *pdo = pdos[number][transmit];
}

#define ROW(pdo, place, index, sub, bits, name)                                                                     \
    ENTRY_RANGE(pdo, place, RO, UDINT, name, "", (int64_t)(index) << 16 | (sub) << 8 | (bits), 0, UINT32_MAX, ),
#define ROW_1600(...) ROW(0x1600, __VA_ARGS__)
#define ROW_1601(...) ROW(0x1601, __VA_ARGS__)
#define ROW_1602(...) ROW(0x1602, __VA_ARGS__)
#define ROW_1A00(...) ROW(0x1A00, __VA_ARGS__)
#define ROW_1A01(...) ROW(0x1A01, __VA_ARGS__)
#define ROW_1A02(...) ROW(0x1A02, __VA_ARGS__)
#define MAPPING(index, count, name, rows, row)                                                                      \
    RECORD(index, name, count, ENTRY_COUNT(index, USINT, count, ), rows(row))
#define ASSIGN(index, name, pdo)                                                                                    \
    ARRAY(index, name, 1, ENTRY_RANGE(index, 0, RW_PREOP, USINT, "Number of entries", "", 1, 0, 1, ),               \
          ENTRY_RANGE(index, 1, RW_PREOP, UINT, "Assigned PDO", "", pdo, pdo, (pdo) + CM1E_CIA402_MAPPINGS - 1, ))
#define SM_TYPE(sub, name, value) ENTRY(0x1C00, sub, RO, USINT, name, "", value, )
#define PROBE(index, name) VAR(index, name, RO_TXPDO, DINT, "counts", 0)
#define POSITIVE(index, name, unit, value) VAR_RANGE(index, name, RW, UDINT, unit, value, 0, INT32_MAX, )

/* In order of index. CiA 402 numbers; defaults are those of the simulated drive. */
static const cm1e_object_t objects[] = {
    VAR(0x1000, "Device type", RO, UDINT, "", 0x00020192),
    VAR(0x1001, "Error register", RO, USINT, "", 0),
    VAR_STRING(0x1008, "Manufacturer device name", "CiA 402 servo drive"),
    VAR_STRING(0x1009, "Manufacturer hardware version", "simulated"),
    VAR_STRING(0x100A, "Manufacturer software version", "1.0"),
    RECORD(0x1018, "Identity", 4, ENTRY_COUNT(0x1018, USINT, 4, ), ENTRY(0x1018, 1, RO, UDINT, "Vendor ID", "", 0, ),
           ENTRY(0x1018, 2, RO, UDINT, "Product code", "", CM1E_CIA402_SIM_PRODUCT_CODE, ),
           ENTRY(0x1018, 3, RO, UDINT, "Revision number", "", CM1E_CIA402_SIM_REVISION, ),
           ENTRY(0x1018, 4, RO, UDINT, "Serial number", "", 0, )),

    MAPPING(0x1600, 7, "RxPDO mapping, all modes", PDO_1600, ROW_1600),
    MAPPING(0x1601, 2, "RxPDO mapping csp", PDO_1601, ROW_1601),
    MAPPING(0x1602, 2, "RxPDO mapping csv", PDO_1602, ROW_1602),
    MAPPING(0x1A00, 12, "TxPDO mapping, all modes", PDO_1A00, ROW_1A00),
    MAPPING(0x1A01, 4, "TxPDO mapping csp", PDO_1A01, ROW_1A01),
    MAPPING(0x1A02, 4, "TxPDO mapping csv", PDO_1A02, ROW_1A02),
    ARRAY(0x1C00, "Sync manager type", 4, ENTRY_COUNT(0x1C00, USINT, 4, ), SM_TYPE(1, "SM0 mailbox out", 1),
          SM_TYPE(2, "SM1 mailbox in", 2), SM_TYPE(3, "SM2 outputs", 3), SM_TYPE(4, "SM3 inputs", 4)),
    ASSIGN(0x1C12, "RxPDO assign", 0x1600),
    ASSIGN(0x1C13, "TxPDO assign", 0x1A00),

    VAR(0x603F, "Error code", RO_TXPDO, UINT, "", 0),
    VAR(0x6040, "Controlword", RW_RXPDO, UINT, "", 0),
    VAR(0x6041, "Statusword", RO_TXPDO, UINT, "", 0),
    VAR_RANGE(0x605A, "Quick stop option code", RW, INT, "", 2, 0, 8, ),
    VAR(0x6060, "Modes of operation", RW_RXPDO, SINT, "", 0),
    VAR(0x6061, "Modes of operation display", RO_TXPDO, SINT, "", 0),
    VAR(0x6064, "Position actual value", RO_TXPDO, DINT, "counts", 0),
    POSITIVE(0x6065, "Following error window", "counts", 100000),
    VAR(0x606C, "Velocity actual value", RO_TXPDO, DINT, "counts/s", 0),
    VAR(0x6077, "Torque actual value", RO_TXPDO, INT, "0.1 % of rated torque", 0),
    VAR(0x607A, "Target position", RW_RXPDO, DINT, "counts", 0),
    VAR(0x607C, "Home offset", RW, DINT, "counts", 0),
    POSITIVE(0x6081, "Profile velocity", "counts/s", 0),
    POSITIVE(0x6083, "Profile acceleration", "counts/s2", 1000000),
    POSITIVE(0x6084, "Profile deceleration", "counts/s2", 1000000),
    POSITIVE(0x6085, "Quick stop deceleration", "counts/s2", 10000000),
    VAR(0x6098, "Homing method", RW, SINT, "", 0),
    ARRAY(0x6099, "Homing speeds", 2, ENTRY_COUNT(0x6099, USINT, 2, ),
          ENTRY_RANGE(0x6099, 1, RW, UDINT, "Speed during search for switch", "counts/s", 50000, 1, INT32_MAX, ),
          ENTRY_RANGE(0x6099, 2, RW, UDINT, "Speed during search for zero", "counts/s", 10000, 1, INT32_MAX, )),
    VAR_RANGE(0x609A, "Homing acceleration", RW, UDINT, "counts/s2", 500000, 1, INT32_MAX, ),
    VAR(0x60B8, "Touch probe function", RW_RXPDO, UINT, "", 0),
    VAR(0x60B9, "Touch probe status", RO_TXPDO, UINT, "", 0),
    PROBE(0x60BA, "Touch probe 1 positive edge"),
    PROBE(0x60BB, "Touch probe 1 negative edge"),
    PROBE(0x60BC, "Touch probe 2 positive edge"),
    PROBE(0x60BD, "Touch probe 2 negative edge"),
    RECORD(0x60C2, "Interpolation time period", 2, ENTRY_COUNT(0x60C2, USINT, 2, ),
           ENTRY(0x60C2, 1, RW, USINT, "Interpolation time period value", "", 1, ),
           ENTRY_RANGE(0x60C2, 2, RW, SINT, "Interpolation time index", "", -3, -6, 0, )),
    VAR(0x60FD, "Digital inputs", RO_TXPDO, UDINT, "", 0),
    RECORD(0x60FE, "Digital outputs", 2, ENTRY_COUNT(0x60FE, USINT, 2, ),
           ENTRY(0x60FE, 1, RW_RXPDO, UDINT, "Physical outputs", "", 0, ),
           ENTRY(0x60FE, 2, RW, UDINT, "Bit mask", "", 0, )),
    VAR(0x60FF, "Target velocity", RW_RXPDO, DINT, "counts/s", 0),
    VAR(0x6502, "Supported drive modes", RO, UDINT, "", 0x1A5),
};

const cm1e_object_t *cm1e_cia402_objects(size_t *count)
{
    *count = COUNT(objects);
    return objects;
}
