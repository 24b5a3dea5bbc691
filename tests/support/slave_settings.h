/**
 * @file slave_settings.h
 * What the registers of a simulated slave controller are set to: a slave that comes back, or comes later, is set as one that
 * was there at the start.
 */
#ifndef CM1E_TESTS_SLAVE_SETTINGS_H
#define CM1E_TESTS_SLAVE_SETTINGS_H

#include "bus_support.h"

typedef struct slave_settings {
    uint8_t bytes[512];
    size_t size;
} slave_settings_t;

/** Of `count` slaves from `place` on the wire on: addresses, watchdogs, who has the EEPROM, FMMUs, sync managers, filters
 *  and pulses of the clock. */
void take_settings(cm1e_bus_t *bus, uint32_t place, unsigned count, slave_settings_t *settings);
/** They are as before. `elsewhere`: station addresses and places in the process image may be others. */
void expect_settings(cm1e_bus_t *bus, uint32_t place, unsigned count, const slave_settings_t *before, bool elsewhere);

#endif
