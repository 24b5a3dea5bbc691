/**
 * @file esc_clock_orders.h
 * What a person at the console can do to the distributed clock of a slave.
 */
#ifndef CM1E_SIM_ESC_CLOCK_ORDERS_H
#define CM1E_SIM_ESC_CLOCK_ORDERS_H

#include "cm1e/sim.h"
#include "sim/slave.h"

/** Carries out an order: a word, and its number where it has one. false: `text` says what is expected instead. */
bool cm1e_sim_clock_order(cm1e_sim_slave_t *slave, const char *word, const char *value, char *text, size_t size);

#endif
