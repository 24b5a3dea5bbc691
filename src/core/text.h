/**
 * @file text.h
 * Texts of others: what a file or a device says of itself, before it is shown.
 */
#ifndef CM1E_CORE_TEXT_H
#define CM1E_CORE_TEXT_H

#include <stddef.h>

/** Puts a "?" in place of whatever could act on a terminal or is no UTF-8: the control characters (C0, DEL, C1), bytes
 *  that are no whole character, and marks that turn the direction of writing. Never longer than it was. */
void cm1e_text_clean(char *text);

/** A text that a device tells, up to its end or a zero, as clean UTF-8 with a final zero: what is no UTF-8 is taken as
 *  ISO 8859-1, which older devices use. One that is too long ends with its last whole character. */
void cm1e_text_of_device(char *text, size_t room, const void *told, size_t size);

/** How many characters of a fixed width a UTF-8 text is wide. */
size_t cm1e_text_width(const char *text);

#endif
