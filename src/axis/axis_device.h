/**
 * @file axis_device.h
 * Functions of the motor other than motion: touch probes, digital signals, objects.
 */
#ifndef CM1E_AXIS_AXIS_DEVICE_H
#define CM1E_AXIS_AXIS_DEVICE_H

#include "axis/axis_parts.h"

/* axis_probe.c */
void cm1e_axis_probe_step(cm1e_axis_t *axis); /* with fresh inputs, while probes are armed */
cm1e_error_t cm1e_axis_probe_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
void cm1e_axis_probe_free(cm1e_axis_t *axis);                            /* @rt init */

/* axis_digital.c */
/** CM1E_ERROR_AXIS_SIGNAL, CM1E_ERROR_PDO_MAPPING as cm1e_axis_read_input(). */
cm1e_error_t cm1e_axis_check_input(const cm1e_axis_t *axis, int number);
/** The last known level of an input that there is. */
bool cm1e_axis_input_level(const cm1e_axis_t *axis, int number);
/** Whether the level is of this exchange, as far as its slave is another one than the motor. */
bool cm1e_axis_input_fresh(const cm1e_axis_t *axis, int number);
/** Whether the input is on another slave that is away. */
bool cm1e_axis_input_away(const cm1e_axis_t *axis, int number);
void cm1e_axis_outputs_off(cm1e_axis_t *axis);
/** Behind a bridge: a sentence, after a space, on how the bridge causes such an error of a signal; else "". */
const char *cm1e_axis_signals_advice(const cm1e_axis_t *axis, cm1e_error_t error);
/** Switches the outputs off before the torque goes, because behind a bridge they can be written only with torque. true:
 *  they are off, or the time for that is over. */
bool cm1e_axis_outputs_off_first(cm1e_axis_t *axis);

/* axis_keep.c */
/** Switches off or halts what was not renewed. Called before the set-point, while there is something to renew. */
void cm1e_axis_signals_step(cm1e_axis_t *axis);

/* axis_object.c */
int cm1e_axis_number_of_object(uint16_t index, uint8_t subindex);
void cm1e_axis_object_text(const cm1e_axis_t *axis, char *text, size_t size);
/** Advances the requests for objects. Called while one waits or is under way. */
void cm1e_axis_objects_step(cm1e_axis_t *axis);

#endif
