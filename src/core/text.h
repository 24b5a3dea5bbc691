/**
 * @file text.h
 * Texts of others: what a file or a device says of itself, before it is shown.
 */
#ifndef CM1E_CORE_TEXT_H
#define CM1E_CORE_TEXT_H

/** Puts a "?" in place of whatever could act on a terminal or is no UTF-8: the control characters (C0, DEL, C1), bytes
 *  that are no whole character, and marks that turn the direction of writing. Never longer than it was. */
void cm1e_text_clean(char *text);

#endif
