#include "sim/app_time.h"

/* The longest step of an integration, and what a longer pause is cut to. */
enum { STEP_NS = 250000, CATCH_UP_NS = 1000000000 };

bool cm1e_sim_time_passes(bool *running, int64_t *now_ns, int64_t to_ns, int64_t *missed_ns)
{
    *missed_ns = 0;
    if (to_ns <= *now_ns && *running)
        return false;
    if (!*running || to_ns - *now_ns > CATCH_UP_NS)
        *missed_ns = (*running ? to_ns - CATCH_UP_NS : to_ns) - *now_ns;
    *now_ns += *missed_ns;
    *running = true;
    return true;
}

double cm1e_sim_time_step(int64_t *now_ns, int64_t to_ns)
{
    const int64_t left_ns = to_ns - *now_ns;
    const int64_t step_ns = left_ns < STEP_NS ? left_ns : STEP_NS;
    if (step_ns <= 0)
        return 0;
    *now_ns += step_ns;
    return (double)step_ns * 1e-9;
}
