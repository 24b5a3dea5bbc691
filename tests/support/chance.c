#include "chance.h"

uint64_t chance_state;

void chance_seed(uint64_t seed)
{
    chance_state = (seed + 1) * UINT64_C(0x9E3779B97F4A7C15);
    chance_state ^= chance_state >> 29;
}

uint64_t chance(void)
{
    chance_state ^= chance_state << 13;
    chance_state ^= chance_state >> 7;
    chance_state ^= chance_state << 17;
    return chance_state;
}

double uniform(double low, double high)
{
    return low + (high - low) * (double)(chance() >> 11) * 0x1p-53;
}

bool one_in(unsigned n) { return (chance() >> 11) % n == 0; }

int pick(int count) { return (int)((chance() >> 11) % (unsigned)count); }
