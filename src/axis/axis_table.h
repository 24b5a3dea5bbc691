/**
 * @file axis_table.h
 * Motions along a table of points over time (axis_table.c).
 */
#ifndef CM1E_AXIS_AXIS_TABLE_H
#define CM1E_AXIS_AXIS_TABLE_H

#include "axis/axis_parts.h"

cm1e_error_t cm1e_axis_table_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
cm1e_error_t cm1e_axis_table_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_table_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_table_begin(cm1e_axis_t *axis, move_t *move, const from_t *from, double offset_s);
/** What was wrong with the last table that was refused as such. */
void cm1e_axis_table_refused_text(const cm1e_axis_t *axis, char *text, size_t size);       /* axis_table_text.c */
/** Explains which limits a refused table would have needed. */
void cm1e_axis_table_needs(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_axis_command_t *needs);

#endif
