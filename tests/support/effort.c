#include "effort.h"

int slowness(void)
{
    const char *effort = getenv("CM1E_TEST_EFFORT");
    if (effort && strcmp(effort, "full") == 0)
        return EFFORT_FULL;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return EFFORT_SANITIZED;
#else
    return EFFORT_EVERYDAY;
#endif
}

int stated_stride(void)
{
    const char *stride = getenv("CM1E_TEST_STRIDE");
    return stride ? atoi(stride) : 0;
}

int sweep_stride(int full, int sampled)
{
    const int stride = full * slowness();
    if (stated_stride() > 0)
        return stated_stride();
    return slowness() == EFFORT_SANITIZED || stride > sampled ? sampled : stride;
}

int sweep_stride_everyday(int full, int everyday, int sampled)
{
    return slowness() == EFFORT_EVERYDAY && stated_stride() <= 0 ? everyday : sweep_stride(full, sampled);
}

int sweep_first(int number, int stride)
{
    const int first = number % stride;
    if (stride > 1)
        printf("a sample: from %d on, every %d. (CM1E_TEST_EFFORT=full: all)\n", first, stride);
    return first;
}
