/**
 * @file text.h
 * Cleans texts of files and devices before they are shown.
 */
#ifndef CM1E_CORE_TEXT_H
#define CM1E_CORE_TEXT_H

#include <stddef.h>

/** Replaces by "?" everything that could act on a terminal or is not UTF-8: control characters (C0, DEL, C1),
 *  incomplete characters, code points that are no characters (U+FFFE), and marks that change the direction of writing.
 *  The text never gets longer. */
void cm1e_text_clean(char *text);

/** Copies a text of a device, up to its end or a zero, as clean UTF-8 with a final zero. Text that is not UTF-8 is read
 *  as ISO 8859-1, which older devices use. A text that is too long ends with its last whole character. */
void cm1e_text_of_device(char *text, size_t room, const void *told, size_t size);

/** Width of a UTF-8 text in characters of fixed width. */
size_t cm1e_text_width(const char *text);

#endif
