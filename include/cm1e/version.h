/**
 * @file version.h
 * The version of the library: of these headers as macros, of the library that the program runs with as functions.
 * Versions are numbered by semantic versioning. Below 1.0 a new minor version may change interfaces.
 * CMake reads the three numbers from here; they stand nowhere else.
 */
#ifndef CM1E_VERSION_H
#define CM1E_VERSION_H

#include <stdint.h>

#include "cm1e/api.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The version of these headers. */
#define CM1E_VERSION_MAJOR 0
#define CM1E_VERSION_MINOR 1
#define CM1E_VERSION_PATCH 0

/** One number for comparisons: 1.2.3 is 10203. */
#define CM1E_VERSION_NUMBER (CM1E_VERSION_MAJOR * 10000 + CM1E_VERSION_MINOR * 100 + CM1E_VERSION_PATCH)

/** CM1E_VERSION_NUMBER of the library that the program runs with. It differs from the macro where the shared library
 *  is not the one that the program was compiled for. @rt any */
CM1E_API uint32_t cm1e_version_number(void);
/** That version as text, "0.1.0". Static storage. @rt any */
CM1E_API const char *cm1e_version(void);

#ifdef __cplusplus
}
#endif
#endif
