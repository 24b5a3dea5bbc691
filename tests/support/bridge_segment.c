#include "bridge_segment.h"

static cm1e_sim_slave_t *make_device(device_kind_t kind, uint16_t alias)
{
    static cm1e_axis_config_t motor;
    static const cm1e_axis_config_t *const channels[CM1E_BRIDGE_AXES];
    memset(&motor, 0, sizeof motor);
    strcpy(motor.firmware, tested_firmware());
    if (kind >= AN_EB01)
        return cm1e_sim_bridge_create((cm1e_device_model_t)(CM1E_DEVICE_EB01 + (kind - AN_EB01)), channels, alias);
    return kind == A_MOTOR ? cm1e_sim_cm1e_create(&motor, tested_order(), alias, 0) : cm1e_sim_io_module_create();
}

uint16_t alias_at(uint16_t position) { return (uint16_t)(100 + position); }

cm1e_sim_segment_t *make_segment(const device_kind_t *devices, size_t count)
{
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    for (size_t i = 0; i < count && devices[i] != NO_DEVICE; i++)
        ck_assert_int_eq(cm1e_sim_segment_add(segment, make_device(devices[i], alias_at((uint16_t)(i + 1)))), CM1E_OK);
    return segment;
}

cm1e_bus_t *open_bus_on_devices(const device_kind_t *devices, size_t count)
{
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), make_segment(devices, count));
    return bus;
}

void expect_bridged(uint32_t n, uint16_t position, uint8_t channel, const char *motor)
{
    cm1e_axis_config_t *axis = &config.axes[n];
    axis->address_kind = CM1E_ADDRESS_POSITION;
    axis->address = position;
    axis->channel = channel;
    axis->firmware[0] = 0;
    snprintf(axis->motor, sizeof axis->motor, "%s", motor);
    axis->k37 = 10;
    axis->k37_stated = true;
}

uint16_t on_channel(unsigned channel, uint16_t index)
{
    return (uint16_t)(index + (channel - 1) * CM1E_BRIDGE_INDEX_INCREMENT);
}

cm1e_sim_bridge_t *bridge_at(cm1e_bus_t *bus, uint32_t position)
{
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(segment_of(bus), position));
    ck_assert_ptr_nonnull(bridge);
    return bridge;
}

/** The CM1-E, three motors of the EB12, one of the EB01; in no order. */
static void expect_mixed(void)
{
    sim_config(5);
    expect_bridged(0, 2, 4, "CM2");
    expect_bridged(1, 4, 2, "");
    config.axes[2].address = 1;
    expect_bridged(3, 2, 1, "CM1");
    expect_bridged(4, 2, 2, "");
}

cm1e_bus_t *start_mixed(void)
{
    expect_mixed();
    cm1e_bus_t *bus = open_bus_on_devices(mixed, 4);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}
