#include <math.h>

#include "tune.h"

#define PI 3.14159265358979323846
/** Of a steady sine; what the table has is 1.00, 1.06 and 1.35. The axis checks the table itself before it moves. */
#define SWELL_VELOCITY 1.05
#define SWELL_ACCELERATION 1.15
#define SWELL_JERK 1.6

/* ---- signals ----------------------------------------------------------------------------------------------------- */

double tune_amplitude(double frequency, const tune_limits_t *limits)
{
    const double w = 2 * PI * frequency;
    return fmin(fmin(limits->travel, limits->velocity / (SWELL_VELOCITY * w)),
                fmin(limits->acceleration / (SWELL_ACCELERATION * w * w), limits->jerk / (SWELL_JERK * w * w * w)));
}

/** 0 to 1 with a slope of 0 at both ends. */
static double swell(double x) { return x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x); }

void tune_table(MC_TP_REF *table, double frequency, double amplitude)
{
    const WORD points = TUNE_POINTS_PER_PERIOD * TUNE_PERIODS;
    table->NumberOfPairs = points;
    table->IsAbsolute = FALSE;
    for (int k = 1; k <= points; k++) {
        const double periods = (double)k / TUNE_POINTS_PER_PERIOD;
        const double window = swell(periods) * swell(TUNE_PERIODS - periods);
        table->MC_TP_Array[k - 1] = (MC_TP){
            .DeltaTime = (TIME)(1e9 / (frequency * TUNE_POINTS_PER_PERIOD) + 0.5),
            .Position = amplitude * window * sin(2 * PI * periods)};
    }
}

/* ---- measurements ------------------------------------------------------------------------------------------------ */

/** Time at which the actual position first has a part of the way behind it. */
static double time_of(const tune_part_t *part, const tune_record_t *record, double share)
{
    const double start = record->actual[part->begin];
    for (uint32_t i = part->begin + 1; i < part->end; i++) {
        const double way = (record->actual[i] - start) / part->distance;
        const double before = (record->actual[i - 1] - start) / part->distance;
        if (way >= share)
            return record->time_s[i - 1] + (way > before ? (share - before) / (way - before) : 0) *
                                               (record->time_s[i] - record->time_s[i - 1]);
    }
    return NAN;
}

static void measure_step(tune_result_t *result, const tune_part_t *part, const tune_record_t *record, double window)
{
    const double target = record->set[part->end - 1];
    uint32_t outside = part->begin;
    result->overshoot_percent = 0;
    for (uint32_t i = part->begin; i < part->end; i++) {
        const double beyond = (record->actual[i] - target) / part->distance;
        result->overshoot_percent = fmax(result->overshoot_percent, 100 * beyond);
        if (fabs(record->actual[i] - target) > window)
            outside = i;
    }
    result->rise_s = time_of(part, record, 0.9) - time_of(part, record, 0.1);
    if (outside + 1 < part->end)
        result->settling_s = fmax(0, record->time_s[outside + 1] - record->time_s[part->arrived]);
}

static double largest_lag(const tune_part_t *part, const tune_record_t *record)
{
    double lag = 0;
    for (uint32_t i = part->begin; i < part->end; i++)
        lag = fmax(lag, fabs(record->set[i] - record->actual[i]));
    return lag;
}

/** The mean over the time at constant velocity, without its first quarter: the motor is still settling then. */
static double steady_lag(const tune_part_t *part, const tune_record_t *record)
{
    const double step = part->velocity * record->cycle_s, tolerance = 0.001 * step;
    uint32_t first = 0, last = 0;
    for (uint32_t i = part->begin + 1; i < part->end; i++)
        if (fabs(fabs(record->set[i] - record->set[i - 1]) - step) < tolerance) {
            first = first ? first : i;
            last = i;
        }
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = first + (last - first) / 4; first && i <= last; i++, count++)
        sum += fabs(record->set[i] - record->actual[i]);
    return count > 1 ? sum / count : NAN;
}

typedef struct phasor {
    double re, im;
} phasor_t;

/** The part of a signal that has this frequency; `count` samples are whole periods. */
static phasor_t phasor_of(const double *samples, const double *time_s, uint32_t count, double frequency)
{
    phasor_t sum = {0, 0};
    double mean = 0;
    for (uint32_t i = 0; i < count; i++)
        mean += samples[i] / count;
    for (uint32_t i = 0; i < count; i++) {
        sum.re += (samples[i] - mean) * cos(2 * PI * frequency * time_s[i]);
        sum.im -= (samples[i] - mean) * sin(2 * PI * frequency * time_s[i]);
    }
    return sum;
}

/** Of the three periods in the middle. */
static void measure_sine(tune_result_t *result, const tune_part_t *part, const tune_record_t *record)
{
    const double period = 1 / (part->frequency * record->cycle_s);
    const uint32_t first = part->begin + (uint32_t)(period + 0.5), count = (uint32_t)(3 * period + 0.5);
    if (first + count > part->end || count < 12)
        return;
    const double *time_s = record->time_s + first;
    const phasor_t set = phasor_of(record->set + first, time_s, count, part->frequency),
                   actual = phasor_of(record->actual + first, time_s, count, part->frequency);
    const double of_set = hypot(set.re, set.im);
    if (of_set == 0)
        return;
    result->gain = hypot(actual.re, actual.im) / of_set;
    result->phase_degrees = remainder(atan2(actual.im, actual.re) - atan2(set.im, set.re), 2 * PI) * 180 / PI;
}

void tune_measure(tune_result_t *result, tune_kind_t kind, const tune_part_t *part, const tune_record_t *record,
                  double window)
{
    *result = (tune_result_t){NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    if (part->end <= part->begin + 1)
        return;
    result->largest_lag = largest_lag(part, record);
    if (kind == TUNE_STEP)
        measure_step(result, part, record, window);
    else if (kind == TUNE_RAMP)
        result->steady_lag = steady_lag(part, record);
    else
        measure_sine(result, part, record);
}
