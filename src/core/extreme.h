/**
 * @file extreme.h
 * The smaller and the larger of two numbers, as fmin() and fmax() say. Those are calls, and a plan makes dozens of
 * them.
 */
#ifndef CM1E_CORE_EXTREME_H
#define CM1E_CORE_EXTREME_H

/** If one of the two is no number, the other one. @rt cycle */
static inline double smaller(double a, double b) { return b < a || a != a ? b : a; }
static inline double larger(double a, double b) { return b > a || a != a ? b : a; }

#endif
