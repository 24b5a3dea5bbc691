/**
 * @file io_types.h
 * What the types of signals are.
 */
#ifndef CM1E_BUS_IO_TYPES_H
#define CM1E_BUS_IO_TYPES_H

#include "cm1e/io.h"

typedef struct cm1e_io_type_row {
    const char *name;
    uint8_t bits; /**< maximum; 0: any number */
    bool is_signed, is_real;
} cm1e_io_type_row_t;

enum { CM1E_IO_TYPE_COUNT = CM1E_IO_BYTES + 1 };
/** By cm1e_io_type_t. */
extern const cm1e_io_type_row_t cm1e_io_types[CM1E_IO_TYPE_COUNT];

#endif
