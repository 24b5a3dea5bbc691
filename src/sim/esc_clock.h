/**
 * @file esc_clock.h
 * The distributed clock of a simulated slave controller: a crystal that drifts, the control loop that makes the local
 * copy of the system time follow the reference clock, and the pulses SYNC0 and SYNC1. Registers follow ETG.1000.4 and
 * the public register description of the controllers; what these leave open is said at its place in esc_dc.c.
 */
#ifndef CM1E_SIM_ESC_CLOCK_H
#define CM1E_SIM_ESC_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

/** The crystal against simulated time. Its drift is what is stated, and what the temperature makes of it. */
typedef struct esc_crystal {
    double drift;           /**< of the crystal, as a ratio: 50e-6 is 50 ppm too fast */
    double warm, warming;   /**< drift by temperature: at its end, and how far it is still away from that */
    uint32_t jitter_ns;     /**< of the time stamps of a frame, to both sides */
    uint32_t random;
} esc_crystal_t;

/** Why a clock does not follow, or gives no pulses. */
typedef struct esc_clock_troubles {
    bool free;              /**< its control loop takes nothing from the reference clock */
    bool no_pulses;         /**< SYNC0 and SYNC1 are silent */
    bool absent;            /**< the controller has no distributed clocks */
} esc_clock_troubles_t;

/** The pulses of one activation. */
typedef struct esc_pulses {
    bool running;
    uint64_t next_ns;       /**< system time of the next SYNC0 */
    uint64_t next_sync1_ns;
    uint64_t count, count_sync1; /**< pulses since the activation */
    uint64_t without_outputs;    /**< SYNC0 pulses since outputs arrived last */
} esc_pulses_t;

typedef struct esc_clock {
    esc_crystal_t crystal;
    esc_clock_troubles_t troubles;
    int64_t now_ns;         /**< simulated time up to which the clock has run */
    double crystal_ns;      /**< what the crystal is ahead of simulated time since power-on */
    double loop_ns;         /**< what the control loop has added to that */
    double mean_ns;         /**< mean difference, 0x092C */
    double interval_ns, gained_ns; /**< mean time between two received times, and what the crystal gains in it */
    double deviation;       /**< of the clock period: the ratio of these */
    bool measuring;         /**< the two below are known */
    int64_t last_crystal_ns; /**< when the last system time was received, without what the loop has added */
    uint32_t last_received_ns;
    int32_t jitter_ns;      /**< of the frame that passes */
    esc_pulses_t pulses;
} esc_clock_t;

#endif
