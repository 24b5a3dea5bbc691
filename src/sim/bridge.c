#include <stdlib.h>

#include "cm1e/bus.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/app_time.h"
#include "sim/bridge_app.h"

enum {
    READY_NS = 50000000,       /* from power-on to Switch on disabled; the guide gives no time */
    EXCHANGE_NS = 1000000,     /* of the serial lines (F511:3 ... F514:3) */
};

/* 0x10F1:2 counts as ETG.1020 has it. It is 0 from the start: then so many cycles in a row, all too long or all too
 * short, are a wrong cycle time; a host that pauses now and then is let pass. */
enum { SYNC_ERROR = 3, WRONG_CYCLES = 100 };

/* ---- time ------------------------------------------------------------------------------------------------------- */

static void step(cm1e_sim_bridge_t *bridge, double step_s)
{
    const bool exchange = bridge->now_ns >= bridge->exchange_ns;
    if (exchange)
        bridge->exchange_ns = bridge->now_ns + EXCHANGE_NS;
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
        cm1e_sim_bridge_axis_t *axis = &bridge->axes[i];
        if (bridge->now_ns >= bridge->ready_ns)
            cm1e_sim_bridge_axis_ready(axis);
        if (exchange)
            cm1e_sim_bridge_axis_exchange(axis);
        cm1e_sim_bridge_mode_due(bridge, axis);
        cm1e_sim_bridge_axis_step(axis, step_s);
        cm1e_sim_bridge_command_step(axis);
        cm1e_sim_bridge_cml_step(bridge, axis);
    }
    cm1e_sim_bridge_deliver(bridge);
}

/* Up to where the next steps go: data that are on the serial lines end one of them, and are not late by the rest of
 * it. */
static int64_t steps_until(const cm1e_sim_bridge_t *bridge, int64_t now_ns)
{
    const int64_t due_ns = cm1e_sim_bridge_delivery_ns(bridge);
    return due_ns > bridge->now_ns && due_ns < now_ns ? due_ns : now_ns;
}

static void advance(void *app, int64_t now_ns)
{
    cm1e_sim_bridge_t *bridge = app;
    int64_t missed_ns;
    if (!cm1e_sim_time_passes(&bridge->running, &bridge->now_ns, now_ns, &missed_ns))
        return;
    bridge->ready_ns += missed_ns;
    if (missed_ns != 0)
        bridge->exchange_ns = bridge->now_ns;
    for (double step_s; (step_s = cm1e_sim_time_step(&bridge->now_ns, steps_until(bridge, now_ns))) > 0;)
        step(bridge, step_s);
}

/* What it does by itself while no motor moves is counted up when somebody asks: serial lines, modes, CML. */
static int64_t due(const void *app)
{
    const cm1e_sim_bridge_t *bridge = app;
    bool rests = true;
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        rests &= bridge->axes[i].motor_free && cm1e_mechanics_at_rest(&bridge->axes[i].mechanics);
    return rests ? INT64_MAX : INT64_MIN;
}

/* ---- cycle time (BR 6.3: 1 ms) ---------------------------------------------------------------------------------- */

int cm1e_sim_bridge_wrong_cycles(const cm1e_sim_bridge_t *bridge)
{
    return abs(bridge->wrong_cycles) >= WRONG_CYCLES ? abs(bridge->wrong_cycles) : 0;
}

static bool wrong_cycle_time(cm1e_sim_bridge_t *bridge, bool late, bool early)
{
    const bool same_side = late ? bridge->wrong_cycles > 0 : bridge->wrong_cycles < 0;
    bridge->wrong_cycles = !late && !early ? 0 : (same_side ? bridge->wrong_cycles : 0) + (late ? 1 : -1);
    if (late || early)
        bridge->sync_errors += SYNC_ERROR;
    else if (bridge->sync_errors > 0)
        bridge->sync_errors--;
    cm1e_sim_cell_t limit;
    cm1e_sim_store_find(&bridge->store, OBJ_10F1_ERROR_SETTINGS, 2, &limit);
    return *limit.value != 0 ? bridge->sync_errors > *limit.value
                             : cm1e_sim_bridge_wrong_cycles(bridge) != 0;
}

/* 0x1C32:1 = 0: free run, with any cycle time. */
static bool runs_free(cm1e_sim_bridge_t *bridge)
{
    cm1e_sim_cell_t type;
    return cm1e_sim_store_find(&bridge->store, OBJ_1C32_SM_OUTPUT_PARAMETER, 1, &type) == 0 && *type.value == 0;
}

static void watch_cycle(cm1e_sim_bridge_t *bridge, int64_t now_ns)
{
    const int64_t interval_us = (now_ns - bridge->last_outputs_ns + 500) / 1000;
    const bool first = bridge->last_outputs_ns == 0;
    bridge->last_outputs_ns = now_ns;
    if (first)
        return;
    const uint32_t us = interval_us < UINT32_MAX ? (uint32_t)interval_us : UINT32_MAX;
    const bool late = us > CM1E_SIM_BRIDGE_LATE_US, early = us < CM1E_SIM_BRIDGE_EARLY_US;
    bridge->last_cycle_us = us;
    if (us > bridge->longest_us)
        bridge->longest_us = us;
    if (us < bridge->shortest_us || bridge->shortest_us == 0)
        bridge->shortest_us = us;
    if (runs_free(bridge))
        return;
    bridge->late_cycles += late;
    bridge->early_cycles += early;
    if (wrong_cycle_time(bridge, late, early) && bridge->slave)
        cm1e_sim_slave_fall_back(bridge->slave, CM1E_AL_SAFE_OP, AL_CODE_SYNC_ERROR);
}

static void outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    cm1e_sim_bridge_outputs(app, data, size, now_ns);
    watch_cycle(app, now_ns);
}

/* ---- EtherCAT --------------------------------------------------------------------------------------------------- */

static void disable(void *app)
{
    cm1e_sim_bridge_t *bridge = app;
    bridge->serial.count = 0;
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        cm1e_sim_bridge_axis_disable(&bridge->axes[i]);
}

static uint16_t state_change(void *app, uint8_t from, uint8_t to)
{
    cm1e_sim_bridge_t *bridge = app;
    bridge->al_state = to;
    if (from == CM1E_AL_OP && to != CM1E_AL_OP)
        disable(bridge);
    if (to == CM1E_AL_OP) {
        bridge->last_outputs_ns = 0;
        bridge->wrong_cycles = 0;
        bridge->sync_errors = 0;
    }
    return AL_CODE_NONE;
}

/* ---- life ------------------------------------------------------------------------------------------------------- */

static void power_on(void *app, int64_t now_ns)
{
    cm1e_sim_bridge_t *bridge = app;
    disable(bridge); /* until now they ran out without torque */
    advance(bridge, now_ns);
    bridge->al_state = CM1E_AL_INIT;
    bridge->ready_ns = bridge->now_ns + READY_NS;
    bridge->last_outputs_ns = 0;
    bridge->longest_us = bridge->shortest_us = bridge->late_cycles = bridge->early_cycles = 0;
    cm1e_sim_bridge_dictionary_reset(bridge);
    cm1e_sim_bridge_assign_default(bridge);
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        cm1e_sim_bridge_axis_power_on(bridge, &bridge->axes[i]);
}

static void destroy(void *app)
{
    cm1e_sim_store_destroy(&((cm1e_sim_bridge_t *)app)->store);
    free(app);
}

static cm1e_error_t play(void *app, const cm1e_sim_profile_t *profile, int64_t now_ns, cm1e_diag_t *diag)
{
    cm1e_sim_bridge_t *bridge = app;
    const cm1e_error_t error = cm1e_sim_store_play(&bridge->store, profile, diag);
    if (error != CM1E_OK)
        return error;
    power_on(bridge, now_ns);
    return CM1E_OK;
}

const cm1e_sim_app_ops_t cm1e_sim_bridge_ops = {
    .advance = advance, .due = due, .state_change = state_change, .process_data_sizes = cm1e_sim_bridge_sizes,
    .outputs = outputs, .inputs = cm1e_sim_bridge_inputs, .watchdog_expired = disable,
    .sdo_read = cm1e_sim_bridge_sdo_read,
    .sdo_write = cm1e_sim_bridge_sdo_write, .object = cm1e_sim_bridge_object, .entry = cm1e_sim_bridge_entry,
    .power_on = power_on, .destroy = destroy, .play = play,
};

cm1e_sim_bridge_t *cm1e_sim_bridge_create_app(cm1e_device_model_t model,
                                              const cm1e_axis_config_t *const axes[CM1E_BRIDGE_AXES])
{
    cm1e_sim_bridge_t *bridge = cm1e_bridge_name(model) ? calloc(1, sizeof *bridge) : NULL;
    if (!bridge)
        return NULL;
    bridge->model = model;
    if (!cm1e_sim_bridge_dictionary_create(bridge)) {
        destroy(bridge);
        return NULL;
    }
    static const cm1e_axis_config_t standard = {0};
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        cm1e_sim_bridge_axis_create(bridge, i, axes && axes[i] ? axes[i] : &standard);
    power_on(bridge, 0);
    bridge->running = false; /* the first advance() tells the time */
    return bridge;
}

static size_t write_sii(uint8_t *sii, size_t room, const cm1e_sim_bridge_t *bridge, uint16_t alias)
{
    const cm1e_device_options_t options = {
        .model = bridge->model,
        .vendor_id = CM1E_SIM_BRIDGE_VENDOR_ID,
        .product_code = cm1e_sim_bridge_product_code(bridge->model),
        .revision = CM1E_SIM_BRIDGE_REVISION,
        .alias = alias,
    };
    cm1e_description_file_t file = {0};
    const size_t size = cm1e_describe(&file, &options, CM1E_ESI_FLAT, NULL) == CM1E_OK
                            ? cm1e_sii_write(sii, room, &file.devices.at[0], NULL)
                            : 0;
    cm1e_description_file_free(&file);
    return size;
}

cm1e_sim_slave_t *cm1e_sim_bridge_create(cm1e_device_model_t model,
                                         const cm1e_axis_config_t *const axes[CM1E_BRIDGE_AXES], uint16_t alias)
{
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_create_app(model, axes);
    if (!bridge)
        return NULL;
    uint8_t sii[CM1E_SII_SIZE];
    const size_t size = write_sii(sii, sizeof sii, bridge, alias);
    cm1e_sim_slave_t *slave = size > 0 ? cm1e_sim_slave_create(sii, size, &cm1e_sim_bridge_ops, bridge) : NULL;
    if (slave)
        bridge->slave = slave;
    else
        destroy(bridge);
    return slave;
}

cm1e_sim_bridge_t *cm1e_sim_bridge_of(cm1e_sim_slave_t *slave)
{
    return slave && cm1e_sim_slave_ops(slave) == &cm1e_sim_bridge_ops ? cm1e_sim_slave_app(slave) : NULL;
}
