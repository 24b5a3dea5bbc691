#include "seeds.h"

bool seeds_given(void) { return getenv("CM1E_TEST_SEED") || getenv("CM1E_TEST_SEEDS"); }

int seeds_of(int all)
{
    const char *count = getenv("CM1E_TEST_SEEDS");
    return count ? atoi(count) : getenv("CM1E_TEST_SEED") ? 1 : all;
}

int seed_count(int count)
{
    const int some = count / slowness();
    return seeds_of(some > 0 ? some : 1);
}

unsigned seed_of(int run)
{
    const char *word = getenv("CM1E_TEST_SEED");
    return (word ? (unsigned)strtoul(word, NULL, 0) : 1u) + (unsigned)run;
}
