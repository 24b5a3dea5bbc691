#include <string.h>

#include "cm1e/cml.h"
#include "device/bridge_tables.h"

/*
 * The bridge's own objects (BR appendix 6). They and the objects of the axes make the dictionary of a model. A value
 * that the guide does not state is 0. The identity of the bridge is not known, so the configuration states it. As with
 * the CM1-E, sub-index 0 has 8 bits and is read-only, although the appendix says otherwise of 60F6 and 60FB. Sub-index
 * 0 of 1C12 and 1C13 is writable, because the assignment could not be written otherwise.
 */

/* Every entry of a mapping is a number of 32 bits. For some entries the appendix states the size of the mapped object
 * instead. */
#define MAPPING_VALUE(axis, index, bits) ((int64_t)((index) + CM1E_BRIDGE_INDEX_INCREMENT * (axis)) << 16 | (bits))
#define PDO_INDEX(pdo, axis) ((pdo) + CM1E_BRIDGE_PDO_INCREMENT * (axis))
#define MAPPING_ROW(pdo, axis, place, index, bits, name, available)                                                 \
    ENTRY_RANGE(PDO_INDEX(pdo, axis), place, RO, UDINT, AXIS_NAME_##axis " " name, "",                              \
                MAPPING_VALUE(axis, index, bits), 0, UINT32_MAX, available),
#define ROW_1600(axis, place, index, bits, name) MAPPING_ROW(0x1600, axis, place, index, bits, name, NA)
#define ROW_1601(axis, place, index, bits, name) MAPPING_ROW(0x1601, axis, place, index, bits, name, YES)
#define ROW_1602(axis, place, index, bits, name) MAPPING_ROW(0x1602, axis, place, index, bits, name, NA)
#define ROW_1A00(axis, place, index, bits, name) MAPPING_ROW(0x1A00, axis, place, index, bits, name, NA)
#define ROW_1A01(axis, place, index, bits, name) MAPPING_ROW(0x1A01, axis, place, index, bits, name, YES)
#define ROW_1A02(axis, place, index, bits, name) MAPPING_ROW(0x1A02, axis, place, index, bits, name, NA)
#define MAPPING(pdo, axis, modes, count, available)                                                                 \
    RECORD(PDO_INDEX(0x##pdo, axis), AXIS_NAME_##axis " " modes " mapping", count,                                  \
           ENTRY_COUNT(PDO_INDEX(0x##pdo, axis), USINT, count, available), BRIDGE_PDO_##pdo(ROW_##pdo, axis))
#define RECEIVE_MAPPINGS(axis)                                                                                      \
    MAPPING(1600, axis, "csp/csv mode RxPDO", 4, NA), MAPPING(1601, axis, "csp mode RxPDO", 2, YES),                \
        MAPPING(1602, axis, "csv mode RxPDO", 2, NA)
#define TRANSMIT_MAPPINGS(axis)                                                                                     \
    MAPPING(1A00, axis, "csp/csv mode TxPDO", 4, NA), MAPPING(1A01, axis, "csp mode TxPDO", 2, YES),                \
        MAPPING(1A02, axis, "csv mode TxPDO", 2, NA)

/* The entries are writable while sub-index 0 is 0; else the bridge refuses (BR 5.4.1, abort 06010003h). */
#define ASSIGNED(assign, pdo, axis)                                                                                 \
    ENTRY(assign, (axis) + 1, RW_PREOP, UINT, AXIS_NAME_##axis " csp", "", PDO_INDEX(pdo, axis), )
#define ASSIGNMENT(index, name, pdo)                                                                                \
    ARRAY(index, name, 4, ENTRY_RANGE(index, 0, RW_PREOP, USINT, "Number of entries", "", 4, 0, 4, ),               \
          ASSIGNED(index, pdo, 0), ASSIGNED(index, pdo, 1), ASSIGNED(index, pdo, 2), ASSIGNED(index, pdo, 3))

/* The types "free run" and "synchronised by the sync manager" (BR 2.3), coded as in ETG.1020. */
#define SM_PARAMETER(index, name, sync_type)                                                                        \
    RECORD(index, name, 32, ENTRY_COUNT(index, USINT, 32, ),                                                        \
           ENTRY(index, 1, RW, UINT, "Synchronization Type", "", sync_type, ),                                      \
           ENTRY(index, 2, RO, UDINT, "Cycle Time", "ns", 0, ),                                                     \
           ENTRY(index, 4, RO, UINT, "Synchronization Types supported", "", 3, ),                                   \
           ENTRY(index, 5, RO, UDINT, "Minimum Cycle Time", "ns", CM1E_BRIDGE_CYCLE_TIME_NS, ),                     \
           ENTRY(index, 6, RO, UDINT, "Calc and Copy Time", "ns", 0, ),                                             \
           ENTRY(index, 8, RW, UINT, "Get Cycle Time", "", 0, NA),                                                  \
           ENTRY(index, 9, RO, UDINT, "Delay Time", "ns", 0, NA),                                                   \
           ENTRY(index, 10, RW, UDINT, "Sync0 Cycle Time", "ns", 0, NA),                                            \
           ENTRY(index, 11, RO, UINT, "SM-Event Missed", "", 0, NA),                                                \
           ENTRY(index, 12, RO, UINT, "Cycle Time Too Small", "", 0, NA),                                           \
           ENTRY(index, 32, RO, BOOL, "Sync error", "", 0, NA))

#define SM_TYPE(sub, name) ENTRY(0x1C00, sub, RO, USINT, name, "", sub, )
/* An array with a number for each axis. */
#define OF_AXES(index, name, list_name, value)                                                                      \
    ARRAY(index, list_name, 4, ENTRY_COUNT(index, USINT, 4, ),                                                      \
          ENTRY(index, 1, RO, UDINT, AXIS_NAME_0 " " name, "", value, ),                                            \
          ENTRY(index, 2, RO, UDINT, AXIS_NAME_1 " " name, "", value, ),                                            \
          ENTRY(index, 3, RO, UDINT, AXIS_NAME_2 " " name, "", value, ),                                            \
          ENTRY(index, 4, RO, UDINT, AXIS_NAME_3 " " name, "", value, ))

/* A text of at most `bytes_` bytes whose content is not known. */
#define TEXT(index_, name_, access_, bytes_, available)                                                             \
    {.index = (index_), .object_code = CM1E_OBJECT_VAR, .name = (name_), .entry_count = 1,                          \
     .entries = ENTRIES({.index = (index_), .access = (access_), .type = CM1E_TYPE_STRING, .bits = 8 * (bytes_),    \
                         .name = (name_), .unit = "", .default_string = "", available})}
#define CML_TEXT(index, name, access) TEXT(index, name, access, CM1E_CML_BYTES, YES)
/* The guide states no length for the following texts; this one is our choice. */
enum { TEXT_BYTES = 16 };

#define NAME(model) VAR_STRING(0x1008, "Manufacturer Device Name", model)
static const cm1e_object_t names[] = {NAME("EB01"), NAME("EB02"), NAME("EB12")};

static const cm1e_object_t device_type[] = {
    VAR(0x1000, "Device Type", RO, UDINT, "", CM1E_BRIDGE_DEVICE_TYPE),
    VAR(0x1001, "Error Register", RO, USINT, "", 0),
};

static const cm1e_object_t communication[] = {
    TEXT(0x1009, "Manufacturer Hardware Version", RO, TEXT_BYTES, YES),
    TEXT(0x100A, "Manufacturer Software Version", RO, TEXT_BYTES, YES),
    RECORD(0x1018, "Identity Object", 4, ENTRY_COUNT(0x1018, USINT, 4, ),
           ENTRY(0x1018, 1, RO, UDINT, "Vendor ID", "", 0, ), ENTRY(0x1018, 2, RO, UDINT, "Product code", "", 0, ),
           ENTRY(0x1018, 3, RO, UDINT, "Revision", "", 0, ), ENTRY(0x1018, 4, RO, UDINT, "Serial number", "", 0, )),
    RECORD(0x10F1, "Error settings", 2, ENTRY_COUNT(0x10F1, USINT, 2, ),
           ENTRY(0x10F1, 1, RW, UDINT, "Local Error Reaction", "", 0, ),
           ENTRY(0x10F1, 2, RW, UDINT, "Sync Error Counter Limit", "", 0, )),
    RECEIVE_MAPPINGS(0), RECEIVE_MAPPINGS(1), RECEIVE_MAPPINGS(2), RECEIVE_MAPPINGS(3),
    TRANSMIT_MAPPINGS(0), TRANSMIT_MAPPINGS(1), TRANSMIT_MAPPINGS(2), TRANSMIT_MAPPINGS(3),
    ARRAY(0x1C00, "Sync Manager Communication Type", 4, ENTRY_COUNT(0x1C00, USINT, 4, ), SM_TYPE(1, "Mailbox Out"),
          SM_TYPE(2, "Mailbox In"), SM_TYPE(3, "Process data Out"), SM_TYPE(4, "Process data In")),
    ASSIGNMENT(0x1C12, "Sync Manager 2 PDO Assignment", 0x1601),
    ASSIGNMENT(0x1C13, "Sync Manager 3 PDO Assignment", 0x1A01),
    SM_PARAMETER(0x1C32, "Sync Manager 2 Synchronization", 0x01),
    SM_PARAMETER(0x1C33, "Sync Manager 3 Synchronization", 0x22),
};

static const cm1e_object_t modules[] = {
    RECORD(0xF000, "Modular Device Profile", 2, ENTRY_COUNT(0xF000, USINT, 2, ),
           ENTRY(0xF000, 1, RO, UINT, "Module Index Distance", "", CM1E_BRIDGE_INDEX_INCREMENT, ),
           ENTRY(0xF000, 2, RO, UINT, "Maximum Number of Modules", "", CM1E_BRIDGE_AXES, )),
    OF_AXES(0xF010, "Device Profile Type", "Module Profile List", CM1E_BRIDGE_DEVICE_TYPE),
    OF_AXES(0xF030, "Configured Module Ident", "Configured Module Ident List", CM1E_BRIDGE_MODULE_IDENT),
    OF_AXES(0xF050, "Module Detected", "Module Detected List", CM1E_BRIDGE_MODULE_IDENT),
};

/* BR 7.3. The guide's 8 as the number of entries is an error. */
#define CONFIG(index, axis, motor)                                                                                  \
    RECORD(index, "Config Axis" #axis, 4, ENTRY_COUNT(index, USINT, 4, ),                                           \
           ENTRY_RANGE(index, 1, RO, UDINT, "Type", "", motor, 1, 2, ),                                             \
           ENTRY_RANGE(index, 2, RO, UDINT, "CommSpeed", "", 6, 1, 6, ),                                            \
           ENTRY_RANGE(index, 3, RO, UDINT, "CommTime", "", 1, 1, 1, ),                                             \
           ENTRY(index, 4, RO, UDINT, "Reserved", "", 0, NA))
static const cm1e_object_t configurations[CM1E_BRIDGE_AXES][2] = {
    {CONFIG(0xF511, 1, CM1E_BRIDGE_CM1), CONFIG(0xF511, 1, CM1E_BRIDGE_CM2)},
    {CONFIG(0xF512, 2, CM1E_BRIDGE_CM1), CONFIG(0xF512, 2, CM1E_BRIDGE_CM2)},
    {CONFIG(0xF513, 3, CM1E_BRIDGE_CM1), CONFIG(0xF513, 3, CM1E_BRIDGE_CM2)},
    {CONFIG(0xF514, 4, CM1E_BRIDGE_CM1), CONFIG(0xF514, 4, CM1E_BRIDGE_CM2)},
};

#define INFO(sub, name) ENTRY(0xF530, sub, RO, UDINT, name, "", 0, )
#define INFO_OF_AXES(sub, name)                                                                                     \
    INFO(sub, "Axis1 " name), INFO((sub) + 1, "Axis2 " name), INFO((sub) + 2, "Axis3 " name),                       \
        INFO((sub) + 3, "Axis4 " name)
#define SYSTEM(sub, name, available) ENTRY(0xF540, sub, RO, UDINT, name, "", 0, available)
#define TEST(sub, name) ENTRY(0xF550, sub, RO, UDINT, name, "", 0, )

static const cm1e_object_t manufacturer[] = {
    /* BR 7.4 */
    RECORD(0xF530, "SystemInfo", 24, ENTRY_COUNT(0xF530, USINT, 24, ), INFO_OF_AXES(1, "Receive Error"),
           INFO_OF_AXES(5, "Motor Error Code"), INFO_OF_AXES(9, "Serial Send Counter"),
           INFO_OF_AXES(13, "Serial Receive Counter"), INFO(17, "PDO MaxTime"), INFO(18, "PDO MinTime"),
           INFO(19, "PDO 1300uSec Time"), INFO(20, "PDO 700uSec Time"), INFO(21, "SystemInfo1"),
           INFO(22, "SystemInfo2"), INFO(23, "SystemInfo3"), INFO(24, "SystemInfo4")),
    RECORD(0xF540, "Config System", 12, ENTRY_COUNT(0xF540, USINT, 12, ), SYSTEM(1, "Musclecorp Mode", YES),
           SYSTEM(2, "Reserved", NA), SYSTEM(3, "Reserved", NA), SYSTEM(4, "Reserved", NA),
           SYSTEM(5, "Master Mode", YES),
           ENTRY(0xF540, 6, RO, UDINT, "CM Serial Cycle", "", 1, ), /* ms; fixed, like 0xF511:3 (BR 7.3) */
           SYSTEM(7, "Reserved", NA), SYSTEM(8, "Reserved", NA), SYSTEM(9, "Reserved", NA),
           SYSTEM(10, "Reserved", NA), SYSTEM(11, "CoolMuscle Device Config Code", YES),
           SYSTEM(12, "Serial Number", YES)),
    RECORD(0xF550, "Test Command", 6, ENTRY_COUNT(0xF550, USINT, 6, ), TEST(1, "TestCommand-X"),
           TEST(2, "TestCommand-Y"), TEST(3, "TestCommand-Z"), TEST(4, "TargetPositionFilter"),
           TEST(5, "TestCommand1"), TEST(6, "TestCommand2")),
    TEXT(0xF570, "SoftUpDateData", RW, TEXT_BYTES, NA),
    TEXT(0xF571, "SoftUpDateInfo", RO, TEXT_BYTES, NA),
    CML_TEXT(0xF581, "Axis1 CML Command", RW), CML_TEXT(0xF582, "Axis2 CML Command", RW),
    CML_TEXT(0xF583, "Axis3 CML Command", RW), CML_TEXT(0xF584, "Axis4 CML Command", RW),
    CML_TEXT(0xF591, "Axis1 CML Command Response", RO), CML_TEXT(0xF592, "Axis2 CML Command Response", RO),
    CML_TEXT(0xF593, "Axis3 CML Command Response", RO), CML_TEXT(0xF594, "Axis4 CML Command Response", RO),
};

#define COUNT(array) (sizeof(array) / sizeof *(array))
/* BR 1.3: the models, in the order of cm1e_device_model_t from EB01 on, and the motors behind them. */
static const cm1e_bridge_motor_t motors[][CM1E_BRIDGE_AXES] = {
    {CM1E_BRIDGE_CM1, CM1E_BRIDGE_CM1, CM1E_BRIDGE_CM1, CM1E_BRIDGE_CM1},
    {CM1E_BRIDGE_CM2, CM1E_BRIDGE_CM2, CM1E_BRIDGE_CM2, CM1E_BRIDGE_CM2},
    {CM1E_BRIDGE_CM1, CM1E_BRIDGE_CM1, CM1E_BRIDGE_CM2, CM1E_BRIDGE_CM2},
};

static bool is_bridge(cm1e_device_model_t model) { return model >= CM1E_DEVICE_EB01 && model <= CM1E_DEVICE_EB12; }

const char *cm1e_bridge_name(cm1e_device_model_t model)
{
    return is_bridge(model) ? names[model - CM1E_DEVICE_EB01].entries[0].default_string : NULL;
}

cm1e_bridge_motor_t cm1e_bridge_motor(cm1e_device_model_t model, unsigned axis)
{
    return motors[model - CM1E_DEVICE_EB01][axis];
}

uint8_t cm1e_bridge_output_mask(cm1e_bridge_motor_t motor) { return motor == CM1E_BRIDGE_CM1 ? 0x02 : 0x0F; }

uint8_t cm1e_bridge_input_mask(cm1e_bridge_motor_t motor) { return motor == CM1E_BRIDGE_CM1 ? 0x0E : 0x3F; }

const char *cm1e_bridge_motor_name(cm1e_bridge_motor_t motor) { return motor == CM1E_BRIDGE_CM1 ? "CM1" : "CM2"; }

/* "CM1", "CM2", or "" (or NULL) for any. */
static bool has_motors(cm1e_device_model_t model, const char *const asked[CM1E_BRIDGE_AXES])
{
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        if (asked[i] && asked[i][0] && strcmp(asked[i], cm1e_bridge_motor_name(cm1e_bridge_motor(model, i))) != 0)
            return false;
    return true;
}

bool cm1e_bridge_model_with(const char *const asked[CM1E_BRIDGE_AXES], cm1e_device_model_t *model)
{
    for (*model = CM1E_DEVICE_EB12; is_bridge(*model); (*model)--)
        if (has_motors(*model, asked))
            return true;
    return false;
}

/* The dictionary of a model is made of parts, in order of index. */
typedef struct part {
    const cm1e_object_t *objects;
    size_t count;
} part_t;
enum { PARTS = 5 + 2 * CM1E_BRIDGE_AXES };

static void parts_of(cm1e_device_model_t model, part_t parts[PARTS])
{
    part_t *part = parts;
    *part++ = (part_t){device_type, COUNT(device_type)};
    *part++ = (part_t){&names[model - CM1E_DEVICE_EB01], 1};
    *part++ = (part_t){communication, COUNT(communication)};
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++, part++)
        part->objects = cm1e_bridge_axis_objects(cm1e_bridge_motor(model, axis), axis, &part->count);
    *part++ = (part_t){modules, COUNT(modules)};
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        *part++ = (part_t){&configurations[axis][cm1e_bridge_motor(model, axis) == CM1E_BRIDGE_CM2], 1};
    *part = (part_t){manufacturer, COUNT(manufacturer)};
}

const cm1e_object_t *cm1e_bridge_object(cm1e_device_model_t model, size_t n)
{
    part_t parts[PARTS];
    if (!is_bridge(model))
        return NULL;
    parts_of(model, parts);
    for (int i = 0; i < PARTS; i++) {
        if (n < parts[i].count)
            return &parts[i].objects[n];
        n -= parts[i].count;
    }
    return NULL;
}

const cm1e_entry_t *cm1e_bridge_entry(cm1e_device_model_t model, uint16_t index, uint8_t subindex)
{
    part_t parts[PARTS];
    if (!is_bridge(model))
        return NULL;
    parts_of(model, parts);
    for (int i = 0; i < PARTS; i++)
        for (size_t n = 0; n < parts[i].count && index <= parts[i].objects[parts[i].count - 1].index; n++)
            if (parts[i].objects[n].index == index)
                return cm1e_object_entry(&parts[i].objects[n], subindex);
    return NULL;
}

int cm1e_bridge_axis_of(uint16_t index)
{
    const unsigned receive = 0x1600, transmit = 0x1A00, drive = 0x6000;
    const unsigned pdos = CM1E_BRIDGE_AXES * CM1E_BRIDGE_PDO_INCREMENT;
    if (index >= receive && index < receive + pdos)
        return (int)(index - receive) / CM1E_BRIDGE_PDO_INCREMENT;
    if (index >= transmit && index < transmit + pdos)
        return (int)(index - transmit) / CM1E_BRIDGE_PDO_INCREMENT;
    if (index >= drive && index < drive + CM1E_BRIDGE_AXES * CM1E_BRIDGE_INDEX_INCREMENT)
        return (int)(index - drive) / CM1E_BRIDGE_INDEX_INCREMENT;
    return -1;
}

#define PDO_ENTRY(axis, place, index, bits, name) {(index) + CM1E_BRIDGE_INDEX_INCREMENT * (axis), 0, bits},
#define PDO(pdo, axis, name)                                                                                        \
    {PDO_INDEX(0x##pdo, axis), AXIS_NAME_##axis " " name, 2, {BRIDGE_PDO_##pdo(PDO_ENTRY, axis)}}
#define PDO_PAIR(axis) {PDO(1601, axis, "csp RxPDO"), PDO(1A01, axis, "csp TxPDO")}

void cm1e_bridge_pdo(cm1e_pdo_t *pdo, unsigned axis, bool transmit)
{
    static const cm1e_pdo_t pdos[CM1E_BRIDGE_AXES][2] = {PDO_PAIR(0), PDO_PAIR(1), PDO_PAIR(2), PDO_PAIR(3)};
    *pdo = pdos[axis][transmit];
}
