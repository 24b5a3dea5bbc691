/**
 * @file near.h
 * How far a word that somebody typed is from one that was meant.
 */
#ifndef CM1E_CORE_NEAR_H
#define CM1E_CORE_NEAR_H

#include <stddef.h>

/** Letters changed, left out, added, or swapped with their neighbour, that turn `a` into `b` (Damerau-Levenshtein with
 *  each letter edited once). Case of ASCII letters does not count. Words are compared up to 63 bytes. */
size_t cm1e_edit_distance(const char *a, const char *b);

/** The nearest word so far, for a loop over words that stand in any kind of table. */
typedef struct cm1e_near {
    const char *word;    /**< what was typed */
    const char *nearest; /**< NULL: none is near */
    size_t distance;
} cm1e_near_t;

/** Near is a third of the letters, at least one; a word that begins with all that was typed is near, too. Of paths
 *  (Main.parts[2].name) only what is behind the parts that both begin with is compared. */
void cm1e_near_look(cm1e_near_t *near, const char *candidate);

/** "; did you mean "scan"?", or "" if none is near, or if the nearest is longer than a text can hold: half a name is
 *  none. Returns `text`. */
const char *cm1e_near_text(const cm1e_near_t *near, char *text, size_t size);
enum { CM1E_NEAR_TEXT_BYTES = 240 };

#endif
