#include "stream_curve.h"

#include <math.h>

static const double most_rate = 1e-3;   /* the part by which the time of the positions may run faster or slower */
static const double gain = 2e-4;        /* per period of distance */
static const double smoothing = 1e-3;   /* of the distance, per cycle */
enum { BEFORE = 1, BEHIND = 2 };        /* positions that the spline needs around a place */

void curve_init(curve_t *curve, uint32_t axes, double per_cycle, double delay)
{
    curve->axes = axes;
    curve->per_cycle = per_cycle;
    curve->delay = delay;
    curve->newest = -1;
    curve->place = 0.0;
    curve->behind = 0.0;
}

static const double *sample(const curve_t *curve, int64_t number) { return curve->samples[number % CURVE_SAMPLES]; }

void curve_add(curve_t *curve, const double *positions)
{
    curve->newest++;
    for (uint32_t i = 0; i < curve->axes; i++)
        curve->samples[curve->newest % CURVE_SAMPLES][i] = positions[i];
}

bool curve_rests(const curve_t *curve, uint32_t axis)
{
    const int64_t from = (int64_t)floor(curve->place) - BEFORE;
    for (int64_t n = from; n < curve->newest; n++)
        if (!(sample(curve, n)[axis] == sample(curve, n + 1)[axis]))
            return false;
    return true;
}

static bool all_rest(const curve_t *curve)
{
    for (uint32_t i = 0; i < curve->axes; i++)
        if (!curve_rests(curve, i))
            return false;
    return true;
}

/* While nothing moves, the place may go forward at once. */
static void begin_anew(curve_t *curve)
{
    curve->place = (double)curve->newest - curve->delay;
    curve->behind = curve->delay;
}

static double rate(const curve_t *curve)
{
    return 1.0 + fmax(-most_rate, fmin(gain * (curve->behind - curve->delay), most_rate));
}

curve_step_t curve_step(curve_t *curve)
{
    const double least = ceil(curve->delay) + BEFORE + BEHIND;
    if ((double)curve->newest < least)
        return CURVE_EMPTY;
    if (curve->behind == 0.0)
        begin_anew(curve);
    if ((double)curve->newest - curve->place > CURVE_SAMPLES - BEFORE - 2) {
        begin_anew(curve);
        return CURVE_BROKEN;
    }
    const bool rests = all_rest(curve);
    if (rests && (double)curve->newest - curve->place > curve->delay + 1.0)
        begin_anew(curve);
    const bool waits = rests && (double)curve->newest - curve->place < curve->delay - 1.0;
    const double next = curve->place + (waits ? 0.0 : curve->per_cycle * rate(curve));
    if ((int64_t)floor(next) + BEHIND > curve->newest)
        return rests ? CURVE_GOES_ON : CURVE_BROKEN;
    curve->place = next;
    curve->behind += ((double)curve->newest - next - curve->behind) * smoothing;
    return CURVE_GOES_ON;
}

double curve_at(const curve_t *curve, uint32_t axis)
{
    const int64_t middle = (int64_t)floor(curve->place);
    const double t = curve->place - (double)middle, u = 1.0 - t;
    const double p = sample(curve, middle)[axis];
    const double before = sample(curve, middle - 1)[axis] - p, after = sample(curve, middle + 1)[axis] - p,
                 last = sample(curve, middle + 2)[axis] - p;
    return p + (u * u * u * before + (((-3.0 * t + 3.0) * t + 3.0) * t + 1.0) * after + t * t * t * last) / 6.0;
}
