/**
 * @file chance.h
 * Random numbers that a seed repeats, with the seeds of seeds.h.
 */
#ifndef CM1E_TESTS_CHANCE_H
#define CM1E_TESTS_CHANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "seeds.h"

extern uint64_t chance_state;

void chance_seed(uint64_t seed);

uint64_t chance(void);

double uniform(double low, double high);

bool one_in(unsigned n);
int pick(int count);

#endif
