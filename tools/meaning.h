/**
 * @file meaning.h
 * What numbers and names mean that the library, its devices and EtherCAT show: a list that is made from the tables of
 * src/device and src/core.
 */
#ifndef CM1E_TOOLS_MEANING_H
#define CM1E_TOOLS_MEANING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { MEANING_TEXT = 200 };

typedef struct meaning {
    char whose[80];            /**< "error code of a CM1-E (object 0x603F)" */
    uint32_t code;
    int digits;                /**< of the code in hexadecimal */
    int error;                 /**< cm1e_error_t, which is negative; 0: it is none */
    const char *name;          /**< "ERROR_AXIS_LAG"; NULL: none */
    char text[MEANING_TEXT];
    /* Of an ErrorID the cause is when it comes. */
    const char *cause, *effect, *cure; /**< NULL or "": none */
    const char *clause;        /**< NULL: none */
    char page[2 * MEANING_TEXT]; /**< pages of docs/ */
} meaning_t;

/** All meanings, in the order of their tables. The caller frees the list. NULL: out of memory. */
meaning_t *all_meanings(size_t *count);

#endif
