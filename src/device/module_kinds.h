/**
 * @file module_kinds.h
 * The kinds of modules that are described without a file of their maker, which simulated modular devices have: their
 * idents, and what the process data of each are.
 */
#ifndef CM1E_DEVICE_MODULE_KINDS_H
#define CM1E_DEVICE_MODULE_KINDS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct cm1e_module_kind {
    uint32_t ident;
    const char *name;
    bool output;
    uint8_t channels, bits; /**< bits of a channel */
    uint8_t padding;        /**< bits behind the last channel, which fill up a byte */
} cm1e_module_kind_t;

/** NULL: there is none with this ident. */
const cm1e_module_kind_t *cm1e_module_kind(uint32_t ident);

#endif
