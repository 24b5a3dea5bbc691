/**
 * @file unit.h
 * Encoder counts of the motor and the unit u of an axis, as its configuration defines it: counts_per_unit, or the
 * revolutions of a load behind a gear. Pure functions of the configuration; nothing here is checked that
 * cm1e_bus_config_check() checks.
 */
#ifndef CM1E_DEVICE_UNIT_H
#define CM1E_DEVICE_UNIT_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/config.h"

/** `counts` counts are `units` u. Two numbers instead of their quotient, which doubles cannot hold for a third: three
 *  revolutions of a load behind 7:3 are 350,000 counts and 1080 degrees exactly. */
typedef struct cm1e_unit {
    double counts, units;
} cm1e_unit_t;

typedef struct cm1e_fraction {
    int64_t numerator, denominator; /**< denominator > 0, no common divisor */
} cm1e_fraction_t;

/* Bounds that hold in the bus file and for parameters written later: below them a stop would take minutes. Those of
 * motion are counts of a CM1-E, of any motor that part of a revolution: times cm1e_unit_count(). */
#define CM1E_LEAST_VELOCITY_COUNTS 1.0     /**< counts/s: 0.00002 revolutions/s */
#define CM1E_LEAST_ACCELERATION_COUNTS 1e3 /**< counts/s2: 0.02 revolutions/s2 */
#define CM1E_LEAST_JERK_COUNTS 1e3         /**< counts/s3: 0.02 revolutions/s3 */
#define CM1E_LEAST_LAG_COUNTS 1.0          /**< counts of the motor: one is what it sees */
#define CM1E_LARGEST_LAG_COUNTS 2147483647.0
/* Defaults of in_position: so long in the window, and an error after so long. */
#define CM1E_IN_POSITION_TIME_S 0.02
#define CM1E_IN_POSITION_TIMEOUT_S 2.0
#define CM1E_LEAST_IN_POSITION_TIME_S 1e-3
#define CM1E_LARGEST_IN_POSITION_TIME_S 10.0
#define CM1E_LEAST_IN_POSITION_TIMEOUT_S 0.01
#define CM1E_LARGEST_IN_POSITION_TIMEOUT_S 3600.0
/** counts/s, of a virtual axis: at most a million counts a cycle, far from where 32 bits wrap around. */
#define CM1E_VIRTUAL_MOST_VELOCITY_COUNTS 1e9

/** Shortest turn of a modulo axis, in counts of a CM1-E like those above: 0.02 revolutions; longest, in counts. */
#define CM1E_LEAST_MODULO_COUNTS 1000.0
#define CM1E_LARGEST_MODULO_COUNTS 1e12

/** Counts in one revolution of the motor: of a CM1-E always the same, behind a bridge by its K37 (50,000 where that is
 *  not stated). */
double cm1e_unit_counts_per_revolution(const cm1e_axis_config_t *config);

/** Counts of this motor on the way of one count of a CM1-E. */
double cm1e_unit_count(const cm1e_axis_config_t *config);

/** The motor's peak speed, counts/s: of a CM1-E by its size (UG 6.3), 3000 1/min behind a bridge, whose guide does not
 *  state it. Without a motor what the configuration states, 3000 1/min where it does not. 0: there is no such motor. */
double cm1e_unit_peak_velocity(const cm1e_axis_config_t *config);

/** Default velocity of the backlash compensation, counts/s: a revolution/s. */
double cm1e_unit_backlash_velocity(const cm1e_axis_config_t *config);

cm1e_unit_t cm1e_unit_of(const cm1e_axis_config_t *config);
/** Counts per u. */
double cm1e_unit_scale(const cm1e_axis_config_t *config);

/** modulo_range in counts, exactly: decimal fractions and quotients of the configuration count as what is written there
 *  (25.4 is 127/5), not as the double next to it. false: no two 62-bit numbers make this fraction. */
bool cm1e_unit_modulo(const cm1e_axis_config_t *config, cm1e_fraction_t *turn);

#endif
