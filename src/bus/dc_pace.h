/**
 * @file dc_pace.h
 * The controller that makes the cycle of the master follow the reference clock: its frames pass the reference clock at
 * whole multiples of the cycle time. A PI controller with limits, without frames and clock.
 */
#ifndef CM1E_BUS_DC_PACE_H
#define CM1E_BUS_DC_PACE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct cm1e_dc_pace {
    int64_t cycle_ns;
    double rate_ns;       /**< integral part: what the cycle is corrected by, ns */
    double remainder_ns;  /**< part of a nanosecond that is still to be given */
    double mean_ns;       /**< filtered phase error */
    int64_t error_ns;     /**< last phase error; positive: the frame was late */
    uint32_t settled;     /**< cycles in a row with a small mean */
} cm1e_dc_pace_t;

/** What the controller may do, as parts of the cycle time. */
enum {
    CM1E_PACE_STEP = 1000,     /**< a cycle is at most this part longer or shorter: 1000 ppm */
    CM1E_PACE_RATE = 2000,     /**< limit of the integral part: crystals differ by 500 ppm at most */
    CM1E_PACE_LINEAR = 16,     /**< a larger phase error counts as this part, and is not integrated */
    CM1E_PACE_SETTLED = 20,    /**< tolerance of the mean phase error for cm1e_dc_pace_settled() */
};

void cm1e_dc_pace_begin(cm1e_dc_pace_t *pace, int64_t cycle_ns);
/** Takes the reference time at which the last frame passed the reference clock. Returns by how many ns the next cycle
 *  begins later. @rt cycle */
int64_t cm1e_dc_pace_step(cm1e_dc_pace_t *pace, int64_t reference_ns);
/** Does what cm1e_dc_pace_step() does when the frame was lost and no new time is known. @rt cycle */
int64_t cm1e_dc_pace_coast(cm1e_dc_pace_t *pace);
/** Distance of a time from the next whole multiple of the cycle time: -cycle/2 ... cycle/2. */
int64_t cm1e_dc_phase(int64_t reference_ns, int64_t cycle_ns);
/** Whether the phase has been within its tolerance for a while. */
static inline bool cm1e_dc_pace_settled(const cm1e_dc_pace_t *pace) { return pace->settled >= 64; }

#endif
