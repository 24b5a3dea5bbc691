/**
 * @file io_types.h
 * What the types of signals are.
 */
#ifndef CM1E_CONFIG_IO_TYPES_H
#define CM1E_CONFIG_IO_TYPES_H

#include "cm1e/io.h"

typedef struct cm1e_io_type_row {
    const char *name;
    uint8_t bits; /**< maximum; 0: any number */
    bool is_signed, is_real;
} cm1e_io_type_row_t;

enum { CM1E_IO_TYPE_COUNT = CM1E_IO_BYTES + 1 };
/** By cm1e_io_type_t. */
extern const cm1e_io_type_row_t cm1e_io_types[CM1E_IO_TYPE_COUNT];

/** Whether a signal of this type with so many bits can have a value; no BYTES can. */
bool cm1e_io_fits(cm1e_io_type_t type, unsigned bits, double value);
/** Why cm1e_io_set_real() has refused a value, as "it is an input". */
void cm1e_io_say_refusal(const cm1e_io_t *io, double value, char *text, size_t size);
/** The type of this name, without regard to upper and lower case; CM1E_IO_TYPE_COUNT: there is none. */
unsigned cm1e_io_type_of_name(const char *name);

#endif
