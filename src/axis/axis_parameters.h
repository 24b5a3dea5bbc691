/**
 * @file axis/axis_parameters.h
 * Parameters of an axis by number: those of PLCopen Part 1 v2.0, table 5, and from 1000 on those of this library:
 * objects of the drive over SDO, and what the axis has beside table 5. In the cycle thread, between cm1e_axis_inputs()
 * and cm1e_axis_outputs().
 */
#ifndef CM1E_AXIS_AXIS_PARAMETERS_H
#define CM1E_AXIS_AXIS_PARAMETERS_H

#include "axis/axis_api.h"

/** Table 5. */
enum {
    CM1E_PARAMETER_COMMANDED_POSITION = 1,
    CM1E_PARAMETER_SW_LIMIT_POS,
    CM1E_PARAMETER_SW_LIMIT_NEG,
    CM1E_PARAMETER_ENABLE_LIMIT_POS,
    CM1E_PARAMETER_ENABLE_LIMIT_NEG,
    CM1E_PARAMETER_ENABLE_POS_LAG_MONITORING,
    CM1E_PARAMETER_MAX_POSITION_LAG,
    CM1E_PARAMETER_MAX_VELOCITY_SYSTEM,
    CM1E_PARAMETER_MAX_VELOCITY_APPL,
    CM1E_PARAMETER_ACTUAL_VELOCITY,
    CM1E_PARAMETER_COMMANDED_VELOCITY,
    CM1E_PARAMETER_MAX_ACCELERATION_SYSTEM,
    CM1E_PARAMETER_MAX_ACCELERATION_APPL,
    CM1E_PARAMETER_MAX_DECELERATION_SYSTEM,
    CM1E_PARAMETER_MAX_DECELERATION_APPL,
    CM1E_PARAMETER_MAX_JERK_SYSTEM,
    CM1E_PARAMETER_MAX_JERK_APPL,
    CM1E_PARAMETER_END,
    CM1E_PARAMETER_VENDOR = 1000, /**< from here on objects of the drive, except the next five */
    CM1E_PARAMETER_IN_POSITION = 1800, /**< of the axis itself (axis_in_position.c) */
    CM1E_PARAMETER_IN_POSITION_WINDOW,
    CM1E_PARAMETER_IN_POSITION_TIME,
    CM1E_PARAMETER_IN_POSITION_TIMEOUT,
    CM1E_PARAMETER_IN_POSITION_DONE_WAITS,
    CM1E_PARAMETER_IN_POSITION_END,
};

/** Which numbers are right, for texts. */
#define CM1E_PARAMETER_NUMBERS                                                                                       \
    "1 ... 17, 1800 ... 1804, or from 1021 on that of an object of the drive (docs/DEVICE.md)"

/** Whether a parameter is an object of the drive, which is read and written by transfers. @rt any */
static inline bool cm1e_axis_parameter_is_object(int number)
{
    return number >= CM1E_PARAMETER_VENDOR &&
           !(number >= CM1E_PARAMETER_IN_POSITION && number < CM1E_PARAMETER_IN_POSITION_END);
}
/** Whether a parameter is a BOOL: 4, 5, 6, 1800 and 1804. @rt any */
bool cm1e_axis_parameter_is_bool(int number);
/** Reads a parameter; a BOOL is 0 or 1. CM1E_ERROR_AXIS_PARAMETER: the axis has none of this number.
 *  CM1E_ERROR_AXIS_OFFLINE: the actual value is not known now. @rt cycle */
cm1e_error_t cm1e_axis_read_parameter(const cm1e_axis_t *axis, int number, double *value);
/** Writes a parameter. It applies to motions that are planned from now on; the present motion goes on as planned. A
 *  software limit that the present motion would not keep is refused. Further errors are CM1E_ERROR_AXIS_PARAMETER,
 *  _READ_ONLY and _RANGE. After an error nothing has changed. @rt cycle */
cm1e_error_t cm1e_axis_write_parameter(cm1e_axis_t *axis, int number, double value);

/** Vendor parameters `first` ... `last` are consecutive sub-indexes of one object. */
typedef struct cm1e_axis_objects {
    int first, last;
    uint16_t index;
    uint8_t subindex; /**< of the first */
} cm1e_axis_objects_t;
/** The table; `*count` rows in order of their numbers. @rt any */
const cm1e_axis_objects_t *cm1e_axis_object_table(size_t *count);

/** Requests the transfer of a vendor parameter. The transfers of an axis are made one after the other. The value is the
 *  number of the object: a whole number in the range of the dictionary. CM1E_ERROR_FULL: 7 requests wait already.
 *  CM1E_ERROR_UNSUPPORTED: the drive, its firmware or the motor behind a bridge does not have the object. _PARAMETER,
 *  _READ_ONLY (also while the object is process data) and _RANGE as above. @rt cycle */
cm1e_error_t cm1e_axis_object_start(cm1e_axis_t *axis, int number, bool write, double value, uint32_t *ticket);
/** The same read, of a block whose last one was refused. @rt cycle */
cm1e_error_t cm1e_axis_object_read_again(cm1e_axis_t *axis, int number, uint32_t *ticket);
/** The state of a request: BUFFERED or ACTIVE, DONE with the value, or ERROR. UNKNOWN: there were 7 or more later
 *  requests. @rt cycle */
cm1e_command_state_t cm1e_axis_object_state(const cm1e_axis_t *axis, uint32_t ticket, double *value,
                                            cm1e_error_t *error);
/** The number of the parameter of a ticket. */
static inline int cm1e_axis_object_number(uint32_t ticket) { return (int)(ticket >> 16); }

#endif
