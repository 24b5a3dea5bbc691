/**
 * @file places.h
 * Which axis or slave of the configuration a slave is that a scan has found, by the rules of the bus (bus/identify.c),
 * for those who look at a network that need not fit the configuration.
 */
#ifndef CM1E_CONFIG_PLACES_H
#define CM1E_CONFIG_PLACES_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/bus.h"

/** What a scan has found, beside the configuration. */
typedef struct cm1e_places {
    const cm1e_bus_config_t *config;
    const cm1e_bus_t *bus;
    const cm1e_slave_info_t *(*slave_at)(const cm1e_bus_t *bus, uint32_t position); /**< cm1e_bus_slave() */
} cm1e_places_t;

/** The position of a slave as the configuration counts it: without the optional slaves before it; 0: it is optional,
 *  and is not found by a position. */
uint16_t cm1e_place_of(const cm1e_places_t *places, const cm1e_slave_info_t *slave);
/** Whether the slave, which has this place, is that of the axis with this index in the list. */
bool cm1e_place_is_of_axis(const cm1e_places_t *places, uint32_t index, const cm1e_slave_info_t *slave, uint16_t place);
/** Whether the slave, which has this place, is this one of the list of slaves. */
bool cm1e_place_is_of_slave(const cm1e_places_t *places, const cm1e_slave_config_t *config,
                            const cm1e_slave_info_t *slave, uint16_t place);

#endif
