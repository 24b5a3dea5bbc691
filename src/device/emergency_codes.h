/**
 * @file emergency_codes.h
 * What the error codes of emergencies mean by their class, and the bits of the error register.
 */
#ifndef CM1E_DEVICE_EMERGENCY_CODES_H
#define CM1E_DEVICE_EMERGENCY_CODES_H

#include <stddef.h>
#include <stdint.h>

#include "device/cia402_drive.h"

enum { CM1E_ERROR_REGISTER_TEXT = 128 };

/** Never NULL: a code that no class has is said to be one of the maker. */
const char *cm1e_emergency_class(uint16_t code);
/** The bits of object 0x1001 in words, "" for 0. */
void cm1e_error_register_text(uint8_t error_register, char *text, size_t size);

#endif
