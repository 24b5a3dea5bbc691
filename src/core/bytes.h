/**
 * @file bytes.h
 * Little-endian access to unaligned bytes: frames, SII images, SDO data, process images.
 */
#ifndef CM1E_CORE_BYTES_H
#define CM1E_CORE_BYTES_H

#include <stdint.h>

static inline uint16_t cm1e_get_u16(const uint8_t *p) { return (uint16_t)(p[0] | p[1] << 8); }
static inline uint32_t cm1e_get_u32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}
static inline uint64_t cm1e_get_u64(const uint8_t *p)
{
    return (uint64_t)cm1e_get_u32(p) | (uint64_t)cm1e_get_u32(p + 4) << 32;
}
static inline void cm1e_put_u16(uint8_t *p, uint16_t v)
{
    p[0] = (uint8_t)v;
    p[1] = (uint8_t)(v >> 8);
}
static inline void cm1e_put_u32(uint8_t *p, uint32_t v)
{
    cm1e_put_u16(p, (uint16_t)v);
    cm1e_put_u16(p + 2, (uint16_t)(v >> 16));
}
static inline void cm1e_put_u64(uint8_t *p, uint64_t v)
{
    cm1e_put_u32(p, (uint32_t)v);
    cm1e_put_u32(p + 4, (uint32_t)(v >> 32));
}
/** An unsigned little-endian number of 1 ... 8 bytes; a larger count is taken as 8. */
static inline uint64_t cm1e_get_uint(const uint8_t *p, unsigned bytes)
{
    uint64_t v = 0;
    for (unsigned i = 0; i < bytes && i < sizeof v; i++)
        v |= (uint64_t)p[i] << (8 * i);
    return v;
}
static inline void cm1e_put_uint(uint8_t *p, unsigned bytes, uint64_t v)
{
    for (unsigned i = 0; i < bytes && i < sizeof v; i++)
        p[i] = (uint8_t)(v >> (8 * i));
}

#endif
