/**
 * @file tune.h
 * What `cm1e tune` moves and measures: signals within limits, and numbers of what a motor made of them. Pure functions.
 */
#ifndef CM1E_TOOLS_TUNE_H
#define CM1E_TOOLS_TUNE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "cm1e/plcopen.h"

enum { TUNE_PARTS_MAX = 24, TUNE_SAMPLES_MAX = 200000, TUNE_POINTS_PER_PERIOD = 12, TUNE_PERIODS = 5 };

typedef enum tune_kind { TUNE_STEP = 0, TUNE_RAMP, TUNE_SINE, TUNE_CHIRP } tune_kind_t;

/** Limits of all that is moved; the travel is to either side of the start. */
typedef struct tune_limits {
    double travel, velocity, acceleration, jerk;
} tune_limits_t;

/** One motion, and which samples are of it. */
typedef struct tune_part {
    double distance, velocity;   /**< step, ramp */
    double frequency, amplitude; /**< sine, chirp; Hz, u */
    uint32_t begin, arrived, end; /**< samples: first, first at the end of the set-point, first behind */
} tune_part_t;

/** What was recorded in the cycle. */
typedef struct tune_record {
    uint32_t count;
    double cycle_s;
    double *time_s, *set, *actual; /**< TUNE_SAMPLES_MAX; a busy machine skips cycles, so times are kept */
} tune_record_t;

/** Measurements; NAN: could not be measured. */
typedef struct tune_result {
    double rise_s, overshoot_percent, settling_s, largest_lag; /**< step */
    double steady_lag;                                         /**< ramp: at constant velocity */
    double gain, phase_degrees;                                /**< sine, chirp: actual position beside set position */
} tune_result_t;

/** The largest amplitude of a sine that keeps all limits, with its ways in and out. */
double tune_amplitude(double frequency, const tune_limits_t *limits);
/** The table of such a sine: five periods, of which the first swells and the last fades. */
void tune_table(MC_TP_REF *table, double frequency, double amplitude);
/** `window`: distance from the target within which a motion counts as settled. */
void tune_measure(tune_result_t *result, tune_kind_t kind, const tune_part_t *part, const tune_record_t *record,
                  double window);

#endif
