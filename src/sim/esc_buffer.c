#include "sim/esc_chip.h"

#include <string.h>

#include "cm1e/bus.h"

/* The buffers of the sync managers as master and application access them. */

/* Fresh inputs are made once for a frame, and only when they are read. */
static void refresh_inputs(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm)
{
    if (sm->role != ESC_ROLE_INPUTS || !slave->inputs_stale || slave->al_state < CM1E_AL_SAFE_OP || !slave->ops->inputs)
        return;
    slave->inputs_stale = false;
    slave->ops->inputs(slave->app, slave->memory + sm->start, sm->length);
    cm1e_sim_esc_sm_next_buffer(slave, sm);
    cm1e_sim_esc_sm_accessed(slave, sm, true);
}

bool cm1e_sim_esc_sm_read(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, uint16_t offset, uint8_t *data,
                          size_t length)
{
    if (sm->locked || sm->master_writes)
        return false;
    /* A buffer is opened at its first byte and given back at its last. */
    if (offset == 0) {
        if (sm->mailbox && !sm->full)
            return false;
        sm->open = true;
        refresh_inputs(slave, sm);
    } else if (!sm->open) {
        return false;
    }
    memcpy(data, slave->memory + sm->start + offset, length);
    if (offset + length < sm->length)
        return true;
    sm->open = false;
    cm1e_sim_esc_sm_accessed(slave, sm, false);
    if (sm->mailbox) {
        cm1e_sim_esc_sm_set_full(slave, sm, false);
        if (sm->role == ESC_ROLE_MAILBOX_IN)
            cm1e_sim_mailbox_read(slave);
    }
    return true;
}

bool cm1e_sim_esc_sm_write(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, uint16_t offset, const uint8_t *data,
                           size_t length)
{
    if (sm->locked || !sm->master_writes)
        return false;
    if (offset == 0) {
        if (sm->mailbox && sm->full)
            return false;
        sm->open = true;
        /* The slave reads a complete buffer while the next one fills. */
        if (sm->role == ESC_ROLE_OUTPUTS)
            cm1e_sim_esc_deliver_outputs(slave);
    } else if (!sm->open) {
        return false;
    }
    memcpy(slave->memory + sm->start + offset, data, length);
    if (offset + length < sm->length)
        return true;
    sm->open = false;
    cm1e_sim_esc_sm_accessed(slave, sm, true);
    if (sm->triggers_watchdog)
        cm1e_sim_al_watchdog_trigger(slave);
    if (sm->mailbox) {
        cm1e_sim_esc_sm_set_full(slave, sm, true);
        if (sm->role == ESC_ROLE_MAILBOX_OUT)
            cm1e_sim_mailbox_written(slave);
    } else {
        cm1e_sim_esc_sm_next_buffer(slave, sm);
        slave->outputs_arrived |= sm->role == ESC_ROLE_OUTPUTS;
    }
    return true;
}

void cm1e_sim_esc_deliver_outputs(cm1e_sim_slave_t *slave)
{
    if (!slave->outputs_arrived)
        return;
    slave->outputs_arrived = false;
    slave->clock.pulses.without_outputs = 0;
    const esc_sync_manager_t *sm = cm1e_sim_esc_sm(slave, ESC_ROLE_OUTPUTS);
    if (sm && slave->al_state == CM1E_AL_OP && slave->ops->outputs)
        slave->ops->outputs(slave->app, slave->memory + sm->start, sm->length, slave->now_ns);
}
