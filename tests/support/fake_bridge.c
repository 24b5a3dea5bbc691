#include "fake_bridge.h"

fake_bridge_t fake_bridge;

cm1e_sim_bridge_axis_t *fake_bridge_axis(void) { return &fake_bridge.app->axes[fake_bridge.axis]; }

static void fake_bridge_judge(void)
{
    const cm1e_sim_bridge_axis_t *axis = fake_bridge_axis();
    const bool follows = axis->mode == CM1E_BRIDGE_MODE_CSP || axis->mode == CM1E_BRIDGE_MODE_CPIO;
    const int64_t step = axis->target_position - cm1e_sim_bridge_position(axis);
    const int64_t size = step < 0 ? -step : step;
    if (axis->state == OPERATION_ENABLED && follows && size > fake_bridge.largest_step)
        fake_bridge.largest_step = size;
}

void fake_bridge_inputs(cm1e_bus_t *bus)
{
    cm1e_sim_bridge_ops.inputs(fake_bridge.app, bus->inputs, CM1E_BRIDGE_AXES * FAKE_BRIDGE_AXIS_BYTES);
    if (fake_bridge.statusword >= 0)
        cm1e_put_u16(bus->inputs + fake_bridge.axis * FAKE_BRIDGE_AXIS_BYTES, (uint16_t)fake_bridge.statusword);
}

void fake_bridge_cycle(cm1e_bus_t *bus)
{
    const int64_t now_ns = bus->clock.virtual_now_ns;
    cm1e_sim_bridge_ops.advance(fake_bridge.app, now_ns);
    if (fake_bridge.lost)
        return;
    cm1e_sim_bridge_ops.outputs(fake_bridge.app, bus->outputs, CM1E_BRIDGE_AXES * FAKE_BRIDGE_AXIS_BYTES, now_ns);
    fake_bridge_judge();
    fake_bridge_inputs(bus);
}

static void fake_bridge_sdo(cm1e_bus_t *bus, cm1e_sdo_t *sdo)
{
    const int64_t now_ns = bus->clock.virtual_now_ns;
    const uint16_t first = (uint16_t)(sdo->index - fake_bridge.axis * CM1E_BRIDGE_INDEX_INCREMENT);
    uint32_t code = SDO_ABORT_GENERAL;
    if (fake_bridge.broken_sdo > 0)
        fake_bridge.broken_sdo--;
    else if (sdo->write)
        code = cm1e_sim_bridge_sdo_write(fake_bridge.app, sdo->index, sdo->subindex, CM1E_AL_OP, sdo->data, sdo->size);
    else
        code = cm1e_sim_bridge_sdo_read(fake_bridge.app, sdo->index, sdo->subindex, CM1E_AL_OP, sdo->data, &sdo->size);
    if (sdo->write && first == OBJ_6060_MODES_OF_OPERATION) {
        const int64_t interval_ns = now_ns - fake_bridge.mode_written_ns;
        if (interval_ns < fake_bridge.shortest_mode_interval_ns)
            fake_bridge.shortest_mode_interval_ns = interval_ns;
        fake_bridge.mode_written_ns = now_ns;
    }
    if (!sdo->write && first == OBJ_6061_MODES_OF_OPERATION_DISPLAY && fake_bridge.mode_shown >= 0)
        *(uint8_t *)sdo->data = (uint8_t)fake_bridge.mode_shown;
    sdo->error = code ? CM1E_ERROR_SDO_ABORT : CM1E_OK;
    sdo->abort_code = code;
    sdo->state = code ? CM1E_SDO_ERROR : CM1E_SDO_DONE;
}

void fake_bridge_open(cm1e_bus_t *bus, cm1e_device_model_t model, unsigned channel)
{
    if (fake_bridge.app)
        cm1e_sim_bridge_ops.destroy(fake_bridge.app);
    fake_bridge = (fake_bridge_t){.app = cm1e_sim_bridge_create_app(model, NULL), .axis = channel - 1, .statusword = -1,
                                  .mode_shown = -1, .mode_written_ns = INT64_MIN / 2,
                                  .shortest_mode_interval_ns = INT64_MAX};
    fake_bus_init(bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus->config.axes[0].channel = (uint8_t)channel;
    bus->config.axes[0].k37 = FAKE_BRIDGE_K37;
    bus->config.axes[0].k37_stated = true;
    bus->info = (cm1e_slave_info_t){.position = 1, .device = cm1e_device_of_model(model), .model = model};
    bus->rx.entry_count = bus->tx.entry_count = 0;
    for (unsigned transmit = 0; transmit < 2; transmit++)
        for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++) {
            cm1e_pdo_t *all = transmit ? &bus->tx : &bus->rx, one;
            cm1e_bridge_pdo(&one, axis, transmit != 0);
            for (unsigned i = 0; i < one.entry_count; i++)
                all->entries[all->entry_count++] = one.entries[i];
        }
    bus->device_cycle = fake_bridge_cycle;
    bus->device_sdo = fake_bridge_sdo;
    const cm1e_sim_app_ops_t *ops = &cm1e_sim_bridge_ops;
    bus->clock.virtual_now_ns = 1000000000;
    ops->advance(fake_bridge.app, bus->clock.virtual_now_ns);
    bus->clock.virtual_now_ns += 100000000;
    ops->advance(fake_bridge.app, bus->clock.virtual_now_ns);
    ops->state_change(fake_bridge.app, CM1E_AL_SAFE_OP, CM1E_AL_OP);
    fake_bridge_inputs(bus);
}

void fake_bridge_close(void)
{
    if (fake_bridge.app)
        cm1e_sim_bridge_ops.destroy(fake_bridge.app);
    fake_bridge.app = NULL;
}
