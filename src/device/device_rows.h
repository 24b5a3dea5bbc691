/**
 * @file device_rows.h
 * What the rows of the device interface share; private to this room.
 */
#ifndef CM1E_DEVICE_DEVICE_ROWS_H
#define CM1E_DEVICE_DEVICE_ROWS_H

#include "device/devices.h"

/** The mappings that must have an object. */
enum { MAPPED_DYNAMIC = 1 << CM1E_MAPPING_DYNAMIC, MAPPED_CSP = 1 << CM1E_MAPPING_CSP,
       MAPPED_CSV = 1 << CM1E_MAPPING_CSV, MAPPED_PROFILE = 1 << CM1E_MAPPING_PROFILE,
       MAPPED_ALL = MAPPED_DYNAMIC | MAPPED_CSP | MAPPED_CSV | MAPPED_PROFILE };

/** A row of the process data: role, object, sizes, mappings that need it, name; further fields at the end. */
#define PROCESS_DATA(role_, index_, least_, most_, needed_, name_, ...)                                             \
    {.role = CM1E_##role_, .index = (index_), .least_bytes = (least_), .most_bytes = (most_), .needed_in = (needed_), \
     .name = (name_), __VA_ARGS__}

/** A row of error codes: code, error register, fault, from Operation enabled only, text, cure; further fields at the
 *  end. */
#define ERROR(code_, register_, fault_, when_enabled_, text_, cure_, ...)                                            \
    {.code = (code_), .error_register = (register_), .fault = (fault_), .fault_only_when_enabled = (when_enabled_), \
     .text = (text_), .cure = (cure_), __VA_ARGS__}

/** The modes of operation as the standard has them; further bits of the controlword in pp. */
#define MODES_OF_CIA402(words_, pp_bits_)                                                                           \
    {.mode = CM1E_MODE_PP, .abbreviation = "PP", .words = (words_), .target = CM1E_OUT_POSITION, .torque = true,    \
     .holds_position = true, .halts = true, .controlword = (pp_bits_), .ways = CM1E_DEVICE_WAYS_ALL},               \
    {.mode = CM1E_MODE_PV, .abbreviation = "PV", .words = (words_), .target = CM1E_OUT_VELOCITY, .torque = true,    \
     .halts = true, .ways = CM1E_DEVICE_WAYS_ALL},                                                                  \
    {.mode = CM1E_MODE_HM, .abbreviation = "HM", .words = (words_), .target = CM1E_NO_ROLE, .torque = true,         \
     .halts = true, .ways = CM1E_DEVICE_WAYS_ALL},                                                                  \
    {.mode = CM1E_MODE_CSP, .abbreviation = "CSP", .words = (words_), .target = CM1E_OUT_POSITION, .torque = true,  \
     .holds_position = true, .ways = CM1E_DEVICE_WAYS_ALL},                                                         \
    {.mode = CM1E_MODE_CSV, .abbreviation = "CSV", .words = (words_), .target = CM1E_OUT_VELOCITY, .torque = true,  \
     .ways = CM1E_DEVICE_WAYS_ALL}

/** The objects of a homing in counts; a drive may have more. */
#define HOMING_OBJECTS_OF_CIA402                                                                                    \
    [CM1E_HOMING_OFFSET] = {OBJ_607C_HOME_OFFSET, 0, 1.0, NULL},                                                    \
    [CM1E_HOMING_METHOD] = {OBJ_6098_HOMING_METHOD, 0, 1.0, NULL},                                                  \
    [CM1E_HOMING_SPEED] = {OBJ_6099_HOMING_SPEEDS, 1, 1.0, NULL},                                                   \
    [CM1E_HOMING_ACCELERATION] = {OBJ_609A_HOMING_ACCELERATION, 0, 1.0, NULL}

/** `object` and `entry` of a device whose dictionary is one table. */
const cm1e_object_t *cm1e_device_table_object(const cm1e_device_t *device, size_t n);
const cm1e_entry_t *cm1e_device_table_entry(const cm1e_device_t *device, uint16_t index, uint8_t subindex);
#define ONE_TABLE(objects_) .objects = objects_, .object = cm1e_device_table_object, .entry = cm1e_device_table_entry

#define COUNT(table) (sizeof(table) / sizeof(table)[0])

#endif
