/* Slaves that may be absent, and who brings a slave back: keys of axes and of slaves. */
#include <stdio.h>
#include <string.h>

#include "config/ranges.h"
#include "device/place.h"

static bool same_slave(const check_t *check, uint32_t other)
{
    const cm1e_axis_config_t *axis = &check->config->axes[other];
    return cm1e_axis_has_motor(axis) && cm1e_axis_has_motor(check->axis) &&
           axis->address_kind == check->axis->address_kind && check->addresses[other] == check->addresses[check->index];
}

bool cm1e_config_check_optional(const check_t *check)
{
    const cm1e_bus_config_t *config = check->config;
    const cm1e_axis_config_t *axis = check->axis;
    if ((unsigned)axis->recover > CM1E_RECOVER_AUTO)
        return axis_wrong(check, "recover", "is %d; expected one of the enumeration", (int)axis->recover);
    if (axis->optional && axis->address_kind == CM1E_ADDRESS_POSITION)
        return axis_wrong(check, "optional", "is true, and the axis has neither alias nor explicit_id: a slave that "
                          "comes and goes is not found by its position; expected one of the two");
    if (axis->optional && config->second_interface[0])
        return axis_wrong(check, "optional", "is true together with a second_interface: in a ring no slave may be "
                          "absent; expected one of the two");
    for (uint32_t i = 0; i < check->index; i++) {
        const cm1e_axis_config_t *other = &config->axes[i];
        if (!same_slave(check, i))
            continue;
        if (other->optional != axis->optional)
            return axis_wrong(check, "optional", "differs from that of entry %u of the list, which is on the same "
                              "bridge; expected the same for all its axes", i + 1);
        if (other->recover != axis->recover)
            return axis_wrong(check, "recover", "differs from that of entry %u of the list, which is on the same "
                              "bridge; expected the same for all its axes", i + 1);
    }
    return true;
}

/** The first of its group in the list; its own index if it is that one. */
static uint32_t head_of(const cm1e_bus_config_t *config, uint32_t index)
{
    uint32_t i = 0;
    while (strcmp(config->slaves[i].hot_connect, config->slaves[index].hot_connect) != 0)
        i++;
    return i;
}

static const char *wrong_member(const cm1e_bus_config_t *config, uint32_t index, char text[CM1E_WRONG_OPTIONAL])
{
    const cm1e_slave_config_t *slave = &config->slaves[index];
    const bool is_head = head_of(config, index) == index;
    if (is_head && cm1e_slave_is_member(slave)) {
        snprintf(text, CM1E_WRONG_OPTIONAL, "is '%s', whose first entry has a position; expected an alias or an "
                 "explicit_id of the first one, by which the group is found", slave->hot_connect);
        return "hot_connect";
    }
    if (!is_head && !cm1e_slave_is_member(slave)) {
        snprintf(text, CM1E_WRONG_OPTIONAL, "is '%s', whose first entry has an address already; expected a position, "
                 "which is the place in the group", slave->hot_connect);
        return "hot_connect";
    }
    if (!is_head && slave->address < 2) {
        snprintf(text, CM1E_WRONG_OPTIONAL, "is %u, the place of the first one of the group; expected 2 for the slave "
                 "behind it, and so on", slave->address);
        return "position";
    }
    return NULL;
}

const char *cm1e_config_wrong_optional(const cm1e_bus_config_t *config, uint32_t index, char text[CM1E_WRONG_OPTIONAL])
{
    const cm1e_slave_config_t *slave = &config->slaves[index];
    if ((unsigned)slave->recover > CM1E_RECOVER_AUTO) {
        snprintf(text, CM1E_WRONG_OPTIONAL, "is %d; expected one of the enumeration", (int)slave->recover);
        return "recover";
    }
    if (!IS_TEXT(slave->hot_connect)) {
        snprintf(text, CM1E_WRONG_OPTIONAL, NO_TEXT, sizeof slave->hot_connect);
        return "hot_connect";
    }
    if (!cm1e_slave_is_optional(slave))
        return NULL;
    if (!slave->hot_connect[0] && slave->address_kind == CM1E_ADDRESS_POSITION) {
        snprintf(text, CM1E_WRONG_OPTIONAL, "is true, and the slave has neither alias nor explicit_id: a slave that "
                 "comes and goes is not found by its position; expected one of the two, or a hot_connect group");
        return "optional";
    }
    if (!slave->vendor || !slave->product) {
        snprintf(text, CM1E_WRONG_OPTIONAL, "is missing; expected vendor and product of a slave that comes and goes, "
                 "which is identified before it is configured");
        return slave->vendor ? "product" : "vendor";
    }
    if (config->second_interface[0]) {
        snprintf(text, CM1E_WRONG_OPTIONAL, "is true together with a second_interface: in a ring no slave may be "
                 "absent; expected one of the two");
        return "optional";
    }
    return slave->hot_connect[0] ? wrong_member(config, index, text) : NULL;
}
