#include "config/io_types.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <strings.h>

const cm1e_io_type_row_t cm1e_io_types[CM1E_IO_TYPE_COUNT] = {
    [CM1E_IO_BOOL] = {"BOOL", 1, false, false},   [CM1E_IO_SINT] = {"SINT", 8, true, false},
    [CM1E_IO_USINT] = {"USINT", 8, false, false}, [CM1E_IO_INT] = {"INT", 16, true, false},
    [CM1E_IO_UINT] = {"UINT", 16, false, false},  [CM1E_IO_DINT] = {"DINT", 32, true, false},
    [CM1E_IO_UDINT] = {"UDINT", 32, false, false}, [CM1E_IO_LINT] = {"LINT", 64, true, false},
    [CM1E_IO_ULINT] = {"ULINT", 64, false, false}, [CM1E_IO_REAL] = {"REAL", 32, false, true},
    [CM1E_IO_LREAL] = {"LREAL", 64, false, true}, [CM1E_IO_BYTES] = {"BYTES", 0, false, false},
};

const char *cm1e_io_type_name(cm1e_io_type_t type)
{
    return (unsigned)type < CM1E_IO_TYPE_COUNT ? cm1e_io_types[type].name : "?";
}

cm1e_io_type_t cm1e_io_type_of_bits(uint32_t bits)
{
    return bits == 1 ? CM1E_IO_BOOL : bits <= 8 ? CM1E_IO_USINT : bits <= 16 ? CM1E_IO_UINT :
           bits <= 32 ? CM1E_IO_UDINT : bits <= 64 ? CM1E_IO_ULINT : CM1E_IO_BYTES;
}

bool cm1e_io_fits(cm1e_io_type_t type, unsigned bits, double value)
{
    const cm1e_io_type_row_t *row = &cm1e_io_types[type];
    if (row->is_real)
        return isfinite(value) && (type != CM1E_IO_REAL || fabs(value) <= (double)FLT_MAX);
    const double least = row->is_signed ? -ldexp(1, (int)bits - 1) : 0, end = ldexp(1, (int)bits - row->is_signed);
    return type != CM1E_IO_BYTES && value == floor(value) && value >= least && value < end;
}

void cm1e_io_say_refusal(const cm1e_io_t *io, double value, char *text, size_t size)
{
    const cm1e_io_type_row_t *row = &cm1e_io_types[io->type];
    const int magnitude = io->bits - row->is_signed;
    if (!io->output)
        snprintf(text, size, "it is an input");
    else if (io->type == CM1E_IO_BYTES)
        snprintf(text, size, "it has %u bits, which are no number", io->bits);
    else if (cm1e_io_fits((cm1e_io_type_t)io->type, io->bits, value))
        snprintf(text, size, "it belongs to a motor (MC_WriteDigitalOutput)");
    else if (row->is_real)
        snprintf(text, size, "its type has no such value: %s, a finite number%s", row->name,
                 io->type == CM1E_IO_REAL ? " up to 3.402823e+38" : "");
    else if (io->bits == 1)
        snprintf(text, size, "its type has no such value: %s, 0 or 1", row->name);
    else
        snprintf(text, size, "its type has no such value: %s, %.15g ... %.15g", row->name,
                 row->is_signed ? -ldexp(1, magnitude) : 0, ldexp(1, magnitude) - 1);
}

unsigned cm1e_io_type_of_name(const char *name)
{
    unsigned type = 0;
    while (type < CM1E_IO_TYPE_COUNT && strcasecmp(cm1e_io_types[type].name, name) != 0)
        type++;
    return type;
}
