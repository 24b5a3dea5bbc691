/* Stands in for the header of this name of MATIEC, in our own words: types, and the variable with its flags. */
#ifndef STAND_IN_IEC_STD_LIB_H
#define STAND_IN_IEC_STD_LIB_H

#include <stdint.h>

typedef uint8_t __strlen_t;
#define ELEMENTARY(type, of) typedef of type; typedef struct { of value; uint8_t flags; } __IEC_##type##_t;
struct stand_in_time { long tv_sec, tv_nsec; };
struct stand_in_string { __strlen_t len; uint8_t body[126]; };
ELEMENTARY(BOOL, uint8_t)
ELEMENTARY(SINT, int8_t)
ELEMENTARY(INT, int16_t)
ELEMENTARY(DINT, int32_t)
ELEMENTARY(UINT, uint16_t)
ELEMENTARY(UDINT, uint32_t)
ELEMENTARY(WORD, uint16_t)
ELEMENTARY(DWORD, uint32_t)
ELEMENTARY(LWORD, uint64_t)
ELEMENTARY(LREAL, double)
ELEMENTARY(TIME, struct stand_in_time)
ELEMENTARY(STRING, struct stand_in_string)

#endif
