#include "chance.h"
#include "xorshift.h"

uint64_t chance_state;

void chance_seed(uint64_t seed)
{
    chance_state = (seed + 1) * UINT64_C(0x9E3779B97F4A7C15);
    chance_state ^= chance_state >> 29;
}

uint64_t chance(void)
{
    return xorshift(&chance_state);
}

double uniform(double low, double high)
{
    return xorshift_between(&chance_state, low, high);
}

bool one_in(unsigned n) { return (chance() >> 11) % n == 0; }

int pick(int count) { return (int)((chance() >> 11) % (unsigned)count); }
