/**
 * @file sim_modules.h
 * The modules that a simulated modular device can have: their idents, and what the process data of each are.
 */
#ifndef CM1E_DEVICE_SIM_MODULES_H
#define CM1E_DEVICE_SIM_MODULES_H

#include <stdbool.h>
#include <stdint.h>

typedef struct cm1e_sim_module {
    uint32_t ident;
    const char *name;
    bool output;
    uint8_t channels, bits; /**< bits of a channel */
    uint8_t padding;        /**< bits behind the last channel, which fill up a byte */
} cm1e_sim_module_t;

/** NULL: there is none with this ident. */
const cm1e_sim_module_t *cm1e_sim_module(uint32_t ident);

#endif
