/**
 * @file xorshift.h
 * Numbers by chance in a row that its first state, which is not 0, repeats (Marsaglia 2003, "Xorshift RNGs"). Who needs a
 * state for the whole program takes chance.h.
 */
#ifndef CM1E_TESTS_XORSHIFT_H
#define CM1E_TESTS_XORSHIFT_H

#include <stdint.h>

/** The next number; its upper bits are the better ones. */
static inline uint64_t xorshift(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return *state;
}

/** The next number, from `low` to below `high`. */
static inline double xorshift_between(uint64_t *state, double low, double high)
{
    return low + (high - low) * (double)(xorshift(state) >> 11) * 0x1p-53;
}

#endif
