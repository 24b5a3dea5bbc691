/**
 * @file chance.h
 * Random numbers that a seed repeats, with the seeds of seeds.h. Include it once in a test program.
 */
#ifndef CM1E_TESTS_CHANCE_H
#define CM1E_TESTS_CHANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "seeds.h"

static uint64_t chance_state;

static inline void chance_seed(uint64_t seed)
{
    chance_state = (seed + 1) * UINT64_C(0x9E3779B97F4A7C15);
    chance_state ^= chance_state >> 29;
}

static inline uint64_t chance(void)
{
    chance_state ^= chance_state << 13;
    chance_state ^= chance_state >> 7;
    chance_state ^= chance_state << 17;
    return chance_state;
}

static inline double uniform(double low, double high)
{
    return low + (high - low) * (double)(chance() >> 11) * 0x1p-53;
}

static inline bool one_in(unsigned n) { return (chance() >> 11) % n == 0; }
static inline int pick(int count) { return (int)((chance() >> 11) % (unsigned)count); }

#endif
