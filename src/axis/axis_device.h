/**
 * @file axis_device.h
 * What an axis has of its motor beside motion: touch probes, digital signals, objects, and what is behind a bridge.
 */
#ifndef CM1E_AXIS_AXIS_DEVICE_H
#define CM1E_AXIS_AXIS_DEVICE_H

#include "axis/axis.h"
#include "axis/axis_place.h"
#include "cm1e/cml.h"

enum { PROBES = 2 * 6 }; /* every input, both edges */

/** A touch probe: what it waits for stands in its place in the list. */
typedef struct probe {
    uint32_t id;
    int16_t error;      /**< cm1e_error_t */
    uint8_t state;      /**< cm1e_command_state_t */
    bool window;
    union {
        struct { double first, last; };           /**< u; the window, while it waits */
        struct { double position, uncertainty; }; /**< u; when it is done */
    };
} probe_t;

typedef struct probe_sample {
    int64_t time_ns;
    position_t position;            /**< of the load */
    uint16_t inputs;
} probe_sample_t;

enum { OBJECT_REQUESTS = 8 };

/** A vendor parameter that is asked for (axis_object.c). */
typedef struct object_request {
    uint32_t ticket; /**< number << 16 | sequence; 0: none */
    int16_t error;   /**< cm1e_error_t */
    uint8_t state;   /**< cm1e_command_state_t */
    bool write;
    double value;
} object_request_t;

typedef struct objects {
    uint16_t head, next;                        /**< sequence of the one under way, and of the next to be asked for */
    bool submitted;
    object_request_t requests[OBJECT_REQUESTS]; /**< by sequence */
    uint8_t data[8];
    cm1e_sdo_t sdo;
} objects_t;

/** Something that a block asked for and polls. */
typedef struct asked {
    uint32_t ticket;            /**< of the last one; 0: none yet */
    cm1e_command_state_t state;
    cm1e_error_t error;
} asked_t;

/** What a motor behind a bridge does beside motion (axis_cool_muscle.c). */
typedef struct cool_muscle {
    int8_t mode, next;          /**< commanded while the axis is Disabled, and what is to be so as soon as it can */
    bool insist;
    bool moved;                 /**< since CML was entered, a string was taken that may have moved the motor */
    bool must_free;             /**< it is to lose its torque before anything else */
    bool failed;                /**< ErrorStop, as of the last cycle */
    bool away;                  /**< the slave was, and its mode is not known since */
    uint32_t freeing;           /**< ticket of the string that does that; 0: none is under way */
    uint32_t last;              /**< ticket of the last string that a block sent; its end is not told yet; 0: it is */
    int64_t release_ns;         /**< shut down is waited for since then; 0: it is not */
    asked_t switching, command;
    const char *why;            /**< of the last refusal, for the text: a sentence; NULL: none */
    char text[CM1E_CML_BYTES + 1]; /**< ... and the string */
} cool_muscle_t;

/* axis_probe.c */
void cm1e_axis_probe_step(cm1e_axis_t *axis); /* with fresh inputs, while probes are armed */

/* axis_digital.c */
/** CM1E_ERROR_AXIS_SIGNAL, CM1E_ERROR_PDO_MAPPING as cm1e_axis_read_input(). */
cm1e_error_t cm1e_axis_check_input(const cm1e_axis_t *axis, int number);
/** What was not renewed goes off or halts, before the set-point of the cycle. Called while there is something. */
void cm1e_axis_signals_step(cm1e_axis_t *axis);
void cm1e_axis_outputs_off(cm1e_axis_t *axis);
/** Behind a bridge: a sentence on what it has to do with such an error of a signal, after a space; "" elsewhere. */
const char *cm1e_axis_signals_advice(const cm1e_axis_t *axis, cm1e_error_t error);
/** Behind a bridge outputs are reached while there is torque only. TRUE: they are off, or have had their time. */
bool cm1e_axis_outputs_off_first(cm1e_axis_t *axis);

/* axis_object.c */
int cm1e_axis_number_of_object(uint16_t index, uint8_t subindex);
void cm1e_axis_object_text(const cm1e_axis_t *axis, char *text, size_t size);
/** While one waits or is under way. */
void cm1e_axis_objects_step(cm1e_axis_t *axis);

/* axis_cool_muscle.c; they do nothing where the motor is a CM1-E */
cm1e_error_t cm1e_axis_cool_muscle_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init; after its mode is set */
/** Between the programs and what is done about power. */
void cm1e_axis_cool_muscle_step(cm1e_axis_t *axis);
/** CM1E_OK, or why MC_Power cannot enable the motor, however long it waits. */
cm1e_error_t cm1e_axis_cool_muscle_refuses_power(cm1e_axis_t *axis);
/** CM1E_OK, or why MC_Home cannot be. */
cm1e_error_t cm1e_axis_cool_muscle_refuses_homing(cm1e_axis_t *axis);
/** At the end of a run: nothing of CML or CMD moves the motor any more; never later than 2 s after the first call. */
bool cm1e_axis_cool_muscle_released(cm1e_axis_t *axis);
/** What was refused or has failed; FALSE: this error is not one of those. */
bool cm1e_axis_cool_muscle_text(const cm1e_axis_t *axis, cm1e_error_t error, char *text, size_t size);

#endif
