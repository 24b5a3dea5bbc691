#include "bus/dc_pace.h"

#include <math.h>

/* Each cycle a 64th of the phase error is removed, and a 16384th of it is added to the rate: critically damped with a
 * time constant of 128 cycles. That is long enough for the wake-up latency of an ordinary kernel to average out, and
 * short against the seconds in which the temperature of a crystal changes. */
#define PROPORTIONAL (1.0 / 64)
#define INTEGRAL (1.0 / 16384)
#define MEAN (1.0 / 32)

void cm1e_dc_pace_begin(cm1e_dc_pace_t *pace, int64_t cycle_ns)
{
    const double rate_ns = pace->cycle_ns == cycle_ns ? pace->rate_ns : 0; /* crystals stay as they are */
    *pace = (cm1e_dc_pace_t){.cycle_ns = cycle_ns, .rate_ns = rate_ns};
}

int64_t cm1e_dc_phase(int64_t reference_ns, int64_t cycle_ns)
{
    const int64_t phase = reference_ns % cycle_ns;
    return phase > cycle_ns / 2 ? phase - cycle_ns : phase < -cycle_ns / 2 ? phase + cycle_ns : phase;
}

static double limited(double value, double limit) { return fmin(fmax(value, -limit), limit); }

static int64_t give(cm1e_dc_pace_t *pace, double correction_ns)
{
    const double wanted = limited(correction_ns, (double)pace->cycle_ns / CM1E_PACE_STEP) + pace->remainder_ns;
    const double whole = floor(wanted + 0.5);
    pace->remainder_ns = wanted - whole;
    return (int64_t)whole;
}

int64_t cm1e_dc_pace_coast(cm1e_dc_pace_t *pace) { return give(pace, pace->rate_ns); }

int64_t cm1e_dc_pace_step(cm1e_dc_pace_t *pace, int64_t reference_ns)
{
    const double cycle_ns = (double)pace->cycle_ns, linear_ns = cycle_ns / CM1E_PACE_LINEAR;
    pace->error_ns = cm1e_dc_phase(reference_ns, pace->cycle_ns);
    const double error_ns = limited((double)pace->error_ns, linear_ns);
    const bool outlier = fabs((double)pace->error_ns) >= linear_ns;
    pace->mean_ns += ((double)pace->error_ns - pace->mean_ns) * MEAN;
    const bool is_small = fabs(pace->mean_ns) < cycle_ns / CM1E_PACE_SETTLED;
    pace->settled = is_small ? pace->settled + (pace->settled < UINT32_MAX) : 0;
    /* A frame that the machine sent much too late, behind a lost one or a pause, says nothing of the clocks. */
    if (outlier && cm1e_dc_pace_settled(pace))
        return cm1e_dc_pace_coast(pace);
    if (!outlier)
        pace->rate_ns = limited(pace->rate_ns - error_ns * INTEGRAL, cycle_ns / CM1E_PACE_RATE);
    return give(pace, pace->rate_ns - error_ns * PROPORTIONAL);
}
