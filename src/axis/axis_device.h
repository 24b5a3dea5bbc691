/**
 * @file axis_device.h
 * What an axis has of its motor beside motion: touch probes, digital signals, objects.
 */
#ifndef CM1E_AXIS_AXIS_DEVICE_H
#define CM1E_AXIS_AXIS_DEVICE_H

#include "axis/axis.h"
#include "axis/axis_place.h"

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

/** Digital signals and touch probes. */
typedef struct signals {
    uint32_t probes_armed, probe_count;
    probe_t probes[PROBES];
    probe_sample_t probe_sample;    /**< the last one, while probes are armed */
    int64_t output_until_ns;        /**< the digital output goes off then unless it is written again */
    int64_t inputs_asked_ns, inputs_since_ns; /**< where SDOs bring them: last, and without an answer since */
} signals_t;

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

/* axis_probe.c */
void cm1e_axis_probe_step(cm1e_axis_t *axis); /* with fresh inputs, while probes are armed */

/* axis_digital.c */
/** CM1E_ERROR_AXIS_SIGNAL, CM1E_ERROR_PDO_MAPPING as cm1e_axis_read_input(). */
cm1e_error_t cm1e_axis_check_input(const cm1e_axis_t *axis, int number);
void cm1e_axis_outputs_off(cm1e_axis_t *axis);
/** Behind a bridge: a sentence on what it has to do with such an error of a signal, after a space; "" elsewhere. */
const char *cm1e_axis_signals_advice(const cm1e_axis_t *axis, cm1e_error_t error);
/** Behind a bridge outputs are reached while there is torque only. TRUE: they are off, or have had their time. */
bool cm1e_axis_outputs_off_first(cm1e_axis_t *axis);

/* axis_keep.c */
/** What was not renewed goes off or halts, before the set-point of the cycle. Called while there is something. */
void cm1e_axis_signals_step(cm1e_axis_t *axis);

/* axis_object.c */
int cm1e_axis_number_of_object(uint16_t index, uint8_t subindex);
void cm1e_axis_object_text(const cm1e_axis_t *axis, char *text, size_t size);
/** While one waits or is under way. */
void cm1e_axis_objects_step(cm1e_axis_t *axis);

#endif
