/**
 * @file iec_types.h
 * The elementary types of IEC 61131-3 for the function blocks. BOOL is one byte; TIME is 64-bit nanoseconds.
 */
#ifndef CM1E_IEC_TYPES_H
#define CM1E_IEC_TYPES_H

#include <stdint.h>

/** A type of IEC 61131-3 by its name there. */
typedef uint8_t BOOL;
typedef int8_t SINT;
typedef int16_t INT;
typedef uint16_t UINT;
typedef int32_t DINT;
typedef uint32_t UDINT;
typedef uint16_t WORD;
typedef uint32_t DWORD;
typedef double LREAL;
typedef int64_t TIME;
typedef char STRING80[81]; /**< STRING(80): up to 80 bytes and a 0 */

#ifndef TRUE
#define TRUE 1 /**< of a BOOL */
#endif
#ifndef FALSE
#define FALSE 0 /**< of a BOOL */
#endif

#endif
