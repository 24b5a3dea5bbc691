/**
 * @file axis_device.h
 * What an axis has of its motor beside motion: touch probes, digital signals, objects.
 */
#ifndef CM1E_AXIS_AXIS_DEVICE_H
#define CM1E_AXIS_AXIS_DEVICE_H

#include "axis/axis_parts.h"

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
