#include "sim/io_device.h"

#include <stdlib.h>
#include <string.h>

#include "cm1e/bus.h"
#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/esc_chip.h"

int64_t cm1e_sim_io_terminal(const cm1e_sim_io_device_t *device, unsigned channel)
{
    if (device->is_held[channel])
        return device->held[channel];
    return device->source && channel < device->source->config.outputs ? device->source->outputs[channel] : 0;
}

/* ---- process data ------------------------------------------------------------------------------------------------ */

static void process_data_sizes(void *app, uint16_t *output_bytes, uint16_t *input_bytes)
{
    const cm1e_sim_io_device_t *device = app;
    *output_bytes = (uint16_t)((device->images[0].bits + 7) / 8);
    *input_bytes = (uint16_t)((device->images[1].bits + 7) / 8);
}

static void take_outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    (void)now_ns;
    cm1e_sim_io_device_t *device = app;
    const cm1e_sim_io_image_t *image = &device->images[0];
    for (unsigned i = 0; i < image->slot_count && size >= (image->bits + 7) / 8; i++) {
        const cm1e_sim_io_slot_t *slot = &image->slots[i];
        uint64_t value = 0;
        for (unsigned n = 0; n < slot->bits && n < 64; n++)
            value |= (uint64_t)(data[(slot->bit + n) / 8] >> (slot->bit + n) % 8 & 1) << n;
        if (slot->value)
            *slot->value = (int64_t)value;
    }
    if (device->objects)
        cm1e_sim_io_objects_take(device);
    else
        memcpy(device->outputs, device->digital[0], sizeof device->outputs);
}

static void give_inputs(void *app, uint8_t *data, uint16_t size)
{
    cm1e_sim_io_device_t *device = app;
    const cm1e_sim_io_image_t *image = &device->images[1];
    if (device->objects)
        cm1e_sim_io_objects_give(device);
    for (unsigned channel = 0; channel < device->config.inputs && !device->objects; channel++)
        device->digital[1][channel] = cm1e_sim_io_terminal(device, channel) & 1;
    memset(data, 0, size);
    for (unsigned i = 0; i < image->slot_count && size >= (image->bits + 7) / 8; i++) {
        const cm1e_sim_io_slot_t *slot = &image->slots[i];
        for (unsigned n = 0; slot->value && n < slot->bits && n < 64; n++)
            if ((uint64_t)*slot->value >> n & 1)
                data[(slot->bit + n) / 8] |= (uint8_t)(1u << (slot->bit + n) % 8);
    }
}

/* A bit per channel. */
static void map_channels(cm1e_sim_io_device_t *device)
{
    const unsigned counts[2] = {device->config.outputs, device->config.inputs};
    for (int direction = 0; direction < 2; direction++) {
        cm1e_sim_io_image_t *image = &device->images[direction];
        image->slot_count = counts[direction];
        image->bits = counts[direction];
        for (unsigned n = 0; n < counts[direction]; n++)
            image->slots[n] = (cm1e_sim_io_slot_t){&device->digital[direction][n], (uint16_t)n, 1};
    }
}

/* ---- life -------------------------------------------------------------------------------------------------------- */

static void release(void *app)
{
    cm1e_sim_io_device_t *device = app;
    memset(device->outputs, 0, sizeof device->outputs);
    if (device->module_count && device->objects)
        cm1e_sim_io_objects_release(device);
}

static uint16_t state_change(void *app, uint8_t from, uint8_t to)
{
    if (to != CM1E_AL_OP)
        release(app);
    if (from == CM1E_AL_PRE_OP && to == CM1E_AL_SAFE_OP && !cm1e_sim_io_objects_modules_agree(app))
        return AL_CODE_OTHER_MODULES;
    return AL_CODE_NONE;
}

static void power_on(void *app, int64_t now_ns)
{
    cm1e_sim_io_device_t *device = app;
    release(device);
    device->power_on_ns = device->now_ns = now_ns;
    device->sync0_ns = INT64_MAX;
    if (device->objects)
        cm1e_sim_io_objects_power_on(device);
}

static void advance(void *app, int64_t now_ns) { ((cm1e_sim_io_device_t *)app)->now_ns = now_ns; }

static void sync0(void *app, int64_t at_ns) { ((cm1e_sim_io_device_t *)app)->sync0_ns = at_ns; }

static uint16_t explicit_device_id(void *app) { return ((cm1e_sim_io_device_t *)app)->id; }

static void destroy(void *app)
{
    cm1e_sim_io_device_t *device = app;
    free(device->objects);
    free(device);
}

#define LIFE                                                                                                        \
    .state_change = state_change, .process_data_sizes = process_data_sizes, .outputs = take_outputs,                \
    .inputs = give_inputs, .watchdog_expired = release, .power_on = power_on, .destroy = destroy,                   \
    .explicit_device_id = explicit_device_id

static const cm1e_sim_app_ops_t ops = {LIFE};
static const cm1e_sim_app_ops_t ops_with_coe = {
    LIFE, .advance = advance, .sdo_read = cm1e_sim_io_objects_read, .sdo_write = cm1e_sim_io_objects_write,
    .object = cm1e_sim_io_objects_at, .entry = cm1e_sim_io_objects_entry, .sync0 = sync0, .runs_by_sync0 = true,
};

cm1e_sim_io_device_t *cm1e_sim_io_device_of(cm1e_sim_slave_t *slave)
{
    const cm1e_sim_app_ops_t *own = slave ? cm1e_sim_slave_ops(slave) : NULL;
    return own == &ops || own == &ops_with_coe ? cm1e_sim_slave_app(slave) : NULL;
}

static cm1e_sim_io_device_t *create_app(const cm1e_slave_config_t *slave)
{
    cm1e_sim_io_device_t *device = calloc(1, sizeof *device);
    if (!device)
        return NULL;
    device->config = slave->sim;
    device->id = slave->address_kind == CM1E_ADDRESS_EXPLICIT_ID ? slave->address : 0;
    if (device->config.outputs > 0 && !device->config.wired_to[0])
        device->source = device;
    for (unsigned n = 0; n < slave->module_count && n < IO_CHANNELS && slave->sim.kind == CM1E_SIM_SLAVE_MODULAR; n++)
        if (cm1e_module_kind(slave->modules[n]))
            device->modules[device->module_count++] = cm1e_module_kind(slave->modules[n]);
    map_channels(device);
    if (device->config.kind >= CM1E_SIM_SLAVE_ANALOG && !cm1e_sim_io_objects_create(device, slave)) {
        free(device);
        return NULL;
    }
    return device;
}

cm1e_sim_slave_t *cm1e_sim_io_device_create(const cm1e_slave_config_t *slave)
{
    uint8_t sii[CM1E_SII_SIZE];
    cm1e_sim_io_device_t *device = create_app(slave);
    if (!device)
        return NULL;
    cm1e_description_file_t file = {0};
    cm1e_describe_io_device(&file, slave);
    const size_t size = file.arena.failed ? 0 : cm1e_sii_write(sii, sizeof sii, &file.devices.at[0], NULL);
    cm1e_description_file_free(&file);
    cm1e_sim_slave_t *made =
        size > 0 ? cm1e_sim_slave_create(sii, size, device->objects ? &ops_with_coe : &ops, device) : NULL;
    if (!made) {
        destroy(device);
        return NULL;
    }
    made->sii_reads_8_bytes = false; /* as small controllers */
    cm1e_sim_esc_power_on(made, 0);
    return made;
}
