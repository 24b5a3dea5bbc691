/**
 * @file axis_text.h
 * Sentences about refusals (axis_record.c, axis_text.c, axis_text_not_set.c).
 */
#ifndef CM1E_AXIS_AXIS_TEXT_H
#define CM1E_AXIS_AXIS_TEXT_H

#include "axis/axis_limits.h"

/** Behind "... disabled by MC_Power": which inputs disable a direction now, for the text may be asked for later; "":
 *  none. */
const char *cm1e_axis_disabled_inputs(const cm1e_axis_t *axis);

/** Remembers the last refusal for the text. A success clears only a refusal of the same kind. */
void cm1e_axis_remember_not_set(cm1e_axis_t *axis, not_set_t what);
/** cm1e_axis_remember_not_set() for a block that is refused in every call: when that `begins`, and again if nothing
 *  else is there to be told. So it hides no later refusal, and is not hidden by one that is over. */
void cm1e_axis_remember_repeated(cm1e_axis_t *axis, not_set_t what, bool begins);   /* axis_record.c */
static inline void cm1e_axis_forget_not_set(cm1e_axis_t *axis) { axis->not_set.error = CM1E_OK; }
void cm1e_axis_parameter_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_axis_not_set_text(const cm1e_axis_t *axis, char *text, size_t size);      /* axis_text_not_set.c */
/** "SLAVE.SIGNAL" of an input or output on another slave; "": it is none of these. */
const char *cm1e_axis_wired_name(const cm1e_axis_t *axis, int number, bool output); /* axis_text_not_set.c */
/* axis_text.c */
void cm1e_axis_small_text(const cm1e_axis_t *axis, const small_input_t *small, char *text, size_t size);
void cm1e_axis_not_finished_text(const cm1e_axis_t *axis, char *text, size_t size); /* axis_text.c */

#endif
