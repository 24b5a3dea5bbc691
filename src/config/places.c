#include "config/places.h"

#include <string.h>

#include "device/place.h"

static uint16_t address_of(const cm1e_slave_info_t *slave, cm1e_address_kind_t kind, uint16_t place)
{
    return kind == CM1E_ADDRESS_ALIAS ? slave->alias : kind == CM1E_ADDRESS_EXPLICIT_ID ? slave->explicit_id : place;
}

/* Where the head of a Hot Connect group is; 0: it is absent. */
static uint32_t position_of_head(const cm1e_places_t *places, const char *group)
{
    const cm1e_slave_info_t *slave;
    for (uint32_t i = 0; i < places->config->slave_count; i++) {
        const cm1e_slave_config_t *head = &places->config->slaves[i];
        if (cm1e_slave_is_member(head) || strcmp(head->hot_connect, group) != 0)
            continue;
        for (uint32_t position = 1; (slave = places->slave_at(places->bus, position)) != NULL; position++)
            if (address_of(slave, head->address_kind, 0) == head->address)
                return position;
    }
    return 0;
}

/* A member of a group is behind its head, at its place in the group. */
static bool is_member(const cm1e_places_t *places, const cm1e_slave_config_t *config, const cm1e_slave_info_t *slave)
{
    const uint32_t head = position_of_head(places, config->hot_connect);
    return head && slave->position == head + config->address - 1u && slave->vendor_id == config->vendor &&
           slave->product_code == config->product;
}

bool cm1e_place_is_of_slave(const cm1e_places_t *places, const cm1e_slave_config_t *config,
                            const cm1e_slave_info_t *slave, uint16_t place)
{
    if (cm1e_slave_is_member(config))
        return is_member(places, config, slave);
    return config->address != 0 && config->address == address_of(slave, config->address_kind, place);
}

bool cm1e_place_is_of_axis(const cm1e_places_t *places, uint32_t index, const cm1e_slave_info_t *slave, uint16_t place)
{
    const cm1e_axis_config_t *axis = &places->config->axes[index];
    const uint16_t address = cm1e_axis_address(places->config, index);
    return cm1e_axis_has_motor(axis) && address != 0 && address == address_of(slave, axis->address_kind, place);
}

static bool is_optional(const cm1e_places_t *places, const cm1e_slave_info_t *slave)
{
    const cm1e_bus_config_t *config = places->config;
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (config->axes[i].optional && cm1e_place_is_of_axis(places, i, slave, 0))
            return true;
    for (uint32_t i = 0; i < config->slave_count; i++)
        if (cm1e_slave_is_optional(&config->slaves[i]) && cm1e_place_is_of_slave(places, &config->slaves[i], slave, 0))
            return true;
    return false;
}

uint16_t cm1e_place_of(const cm1e_places_t *places, const cm1e_slave_info_t *slave)
{
    const cm1e_slave_info_t *before;
    uint16_t place = slave->position;
    if (is_optional(places, slave))
        return 0;
    for (uint32_t position = 1;
         position < slave->position && (before = places->slave_at(places->bus, position)) != NULL; position++)
        place = (uint16_t)(place - is_optional(places, before));
    return place;
}
