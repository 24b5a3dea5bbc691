/**
 * @file core/sized.h
 * Structs of a program that was compiled with fewer or more members than the library. Members are added at the end
 * only, so a copy takes what both sides have. @rt cycle
 */
#ifndef CM1E_CORE_SIZED_H
#define CM1E_CORE_SIZED_H

#include <stddef.h>
#include <string.h>

/** Copies what both sides have; what `from` lacks is zero. Nothing is copied to NULL. */
static inline void cm1e_copy_sized(void *to, size_t to_size, const void *from, size_t from_size)
{
    if (!to)
        return;
    memset(to, 0, to_size);
    memcpy(to, from, to_size < from_size ? to_size : from_size);
}

#endif
