/**
 * @file objects.h
 * How the dictionary's tables are written; private to this room.
 */
#ifndef CM1E_DEVICE_OBJECTS_H
#define CM1E_DEVICE_OBJECTS_H

#include "device/device.h"

enum {
    RO = CM1E_ACCESS_READ,
    RW = CM1E_ACCESS_READ | CM1E_ACCESS_WRITE,
    RW_PREOP = RW | CM1E_ACCESS_WRITE_PREOP_ONLY,
    RW_RXPDO = RW | CM1E_ACCESS_RXPDO,
    RO_TXPDO = RO | CM1E_ACCESS_TXPDO,
};

#define BITS_BOOL 1
#define BITS_SINT 8
#define BITS_INT 16
#define BITS_DINT 32
#define BITS_USINT 8
#define BITS_UINT 16
#define BITS_UDINT 32
#define MIN_BOOL 0
#define MIN_SINT INT8_MIN
#define MIN_INT INT16_MIN
#define MIN_DINT INT32_MIN
#define MIN_USINT 0
#define MIN_UINT 0
#define MIN_UDINT 0
#define MAX_BOOL 1
#define MAX_SINT INT8_MAX
#define MAX_INT INT16_MAX
#define MAX_DINT INT32_MAX
#define MAX_USINT UINT8_MAX
#define MAX_UINT UINT16_MAX
#define MAX_UDINT UINT32_MAX

/* One sub-index; further fields as designated initialisers at the end. */
#define ENTRY_RANGE(index_, sub_, access_, type_, name_, unit_, default_, minimum_, maximum_, ...)                  \
    {.index = (index_), .subindex = (sub_), .access = (access_), .type = CM1E_TYPE_##type_, .bits = BITS_##type_,   \
     .name = (name_), .unit = (unit_), .default_value = (default_), .minimum = (minimum_), .maximum = (maximum_),   \
     __VA_ARGS__}
/* A variable with the range of its type. */
#define ENTRY(index, sub, access, type, name, unit, value, ...)                                                     \
    ENTRY_RANGE(index, sub, access, type, name, unit, value, MIN_##type, MAX_##type, __VA_ARGS__)
#define ENTRY_STRING(index_, name_, value_)                                                                         \
    {.index = (index_), .access = RO, .type = CM1E_TYPE_STRING, .bits = 8 * (sizeof(value_) - 1), .name = (name_),  \
     .unit = "", .default_string = (value_)}
/* Sub-index 0 of arrays and records. */
#define ENTRY_COUNT(index, type, count, ...)                                                                        \
    ENTRY_RANGE(index, 0, RO, type, "Number of entries", "", count, count, count, __VA_ARGS__)

/* An object with sub-indexes: sub-index 0 with the number of entries in the given type, then the entries. */
#define ENTRIES(...) ((const cm1e_entry_t[]){__VA_ARGS__})
#define OBJECT_SINCE(index_, code_, name_, highest_, since_, ...)                                                   \
    {.index = (index_), .object_code = (code_), .highest_subindex = (highest_), .name = (name_),                    \
     .entries = ENTRIES(__VA_ARGS__), .entry_count = sizeof(ENTRIES(__VA_ARGS__)) / sizeof(cm1e_entry_t),           \
     .since = (since_)}
#define ARRAY(index, name, highest, ...)                                                                            \
    OBJECT_SINCE(index, CM1E_OBJECT_ARRAY, name, highest, CM1E_FIRMWARE_1_2_0, __VA_ARGS__)
#define RECORD(index, name, highest, ...)                                                                           \
    OBJECT_SINCE(index, CM1E_OBJECT_RECORD, name, highest, CM1E_FIRMWARE_1_2_0, __VA_ARGS__)
/* A variable: the whole range of its type, or a range of its own. */
#define VAR(index, name, access, type, unit, value)                                                                 \
    OBJECT_SINCE(index, CM1E_OBJECT_VAR, name, 0, CM1E_FIRMWARE_1_2_0,                                              \
                 ENTRY(index, 0, access, type, name, unit, value, ))
#define VAR_RANGE(index, name, access, type, unit, value, minimum, maximum, ...)                                    \
    OBJECT_SINCE(index, CM1E_OBJECT_VAR, name, 0, CM1E_FIRMWARE_1_2_0,                                              \
                 ENTRY_RANGE(index, 0, access, type, name, unit, value, minimum, maximum, __VA_ARGS__))
#define VAR_STRING(index, name, value)                                                                              \
    OBJECT_SINCE(index, CM1E_OBJECT_VAR, name, 0, CM1E_FIRMWARE_1_2_0, ENTRY_STRING(index, name, value))

#define K_PARAMETER_COUNT 81
/** Sub-indexes 0 ... 81 of 0x60F6 (UG 7.3.22). */
extern const cm1e_entry_t cm1e_device_k_parameters[1 + K_PARAMETER_COUNT];

#endif
