#include <stdlib.h>

#include "cm1e/bus.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/esc_chip.h"

/* A plain module with digital outputs and inputs, each input wired to the output of its number. */
typedef struct io_module {
    uint16_t bytes; /* of process data in each direction */
    uint8_t mask;   /* the outputs that there are */
    uint8_t outputs;
} io_module_t;

static const io_module_t models[] = {
    [CM1E_SIM_IO_MODULE] = {.bytes = 1, .mask = 0xFF},
    [CM1E_SIM_IO_TERMINAL] = {.bytes = 1, .mask = 0x0F},
    [CM1E_SIM_IO_COUPLER] = {.bytes = 0},
};

static void process_data_sizes(void *app, uint16_t *output_bytes, uint16_t *input_bytes)
{
    *output_bytes = *input_bytes = ((io_module_t *)app)->bytes;
}

static void take_outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    (void)now_ns;
    if (size)
        ((io_module_t *)app)->outputs = data[0] & ((io_module_t *)app)->mask;
}

static void give_inputs(void *app, uint8_t *data, uint16_t size)
{
    if (size)
        data[0] = ((io_module_t *)app)->outputs;
}

static uint16_t state_change(void *app, uint8_t from, uint8_t to)
{
    (void)from;
    if (to != CM1E_AL_OP)
        ((io_module_t *)app)->outputs = 0;
    return AL_CODE_NONE;
}

static void watchdog_expired(void *app) { ((io_module_t *)app)->outputs = 0; }

static void power_on(void *app, int64_t now_ns)
{
    (void)now_ns;
    ((io_module_t *)app)->outputs = 0;
}

static const cm1e_sim_app_ops_t ops = {
    .state_change = state_change,
    .process_data_sizes = process_data_sizes,
    .outputs = take_outputs,
    .inputs = give_inputs,
    .watchdog_expired = watchdog_expired,
    .power_on = power_on,
    .destroy = free,
};

cm1e_sim_slave_t *cm1e_sim_io_create_as(cm1e_sim_io_t kind, const cm1e_slave_config_t *slave_config)
{
    uint8_t sii[CM1E_SII_SIZE];
    cm1e_description_file_t file = {0};
    cm1e_describe_io(&file, kind);
    if (slave_config)
        cm1e_describe_io_identity(&file, slave_config);
    const size_t size = file.arena.failed ? 0 : cm1e_sii_write(sii, sizeof sii, &file.devices.at[0], NULL);
    cm1e_description_file_free(&file);
    io_module_t *module = size > 0 ? calloc(1, sizeof *module) : NULL;
    if (!module)
        return NULL;
    *module = models[kind];
    cm1e_sim_slave_t *slave = cm1e_sim_slave_create(sii, size, &ops, module);
    if (!slave) {
        free(module);
        return NULL;
    }
    /* Small controllers give four bytes of the SII at a time. */
    slave->sii_reads_8_bytes = false;
    cm1e_sim_esc_power_on(slave, 0);
    return slave;
}
