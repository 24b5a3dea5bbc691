#include "bus/io_types.h"

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

const char *cm1e_io_quality_name(cm1e_io_quality_t quality)
{
    static const char *const names[] = {"good", "stale", "offline", "invalid"};
    return (unsigned)quality < sizeof names / sizeof names[0] ? names[quality] : "?";
}
