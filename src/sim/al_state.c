#include "sim/esc_chip.h"

#include <string.h>

#include "cm1e/bus.h"
#include "core/bytes.h"

/* AL control and status bits beside the state. */
enum { STATE = 0x0F, ACKNOWLEDGE = 0x10, ERROR = 0x10, ID = 0x20 };
/* ESC configuration 0x0141, from the SII. */
enum { DEVICE_EMULATION = 0x01 };
/* Long enough that a master must poll. */
enum { DECISION_NS = 200000 };

static void show(cm1e_sim_slave_t *slave, uint16_t code)
{
    uint8_t *memory = slave->memory;
    const uint16_t status =
        (uint16_t)(slave->al_state | (slave->al_error ? ERROR : 0) | (slave->al_id ? ID : 0));
    if (status != cm1e_get_u16(memory + ESC_AL_STATUS))
        cm1e_sim_esc_event(slave, ESC_EVENT_AL_STATUS, true);
    cm1e_put_u16(memory + ESC_AL_STATUS, status);
    cm1e_put_u16(memory + ESC_AL_STATUS_CODE,
                 slave->al_id ? code : (uint16_t)cm1e_sim_slave_code(slave, CM1E_SIM_CODE_AL_STATUS, code));
}

static bool has_mailbox(cm1e_sim_slave_t *slave) { return cm1e_sim_esc_sm(slave, ESC_ROLE_MAILBOX_OUT) != NULL; }

static uint16_t check_mailbox(cm1e_sim_slave_t *slave)
{
    return !has_mailbox(slave) || cm1e_sim_esc_mailboxes_valid(slave) ? AL_CODE_NONE : AL_CODE_INVALID_MAILBOX_PREOP;
}

static uint16_t check_boot_mailbox(cm1e_sim_slave_t *slave)
{
    if (!slave->ops->file_begin || slave->ops->files_in_operation || !has_mailbox(slave))
        return AL_CODE_BOOT_NOT_SUPPORTED;
    return cm1e_sim_esc_mailboxes_valid(slave) ? AL_CODE_NONE : AL_CODE_INVALID_MAILBOX_BOOT;
}

static uint16_t check_process_data(cm1e_sim_slave_t *slave)
{
    uint16_t outputs = 0, inputs = 0;
    if (slave->ops->process_data_sizes)
        slave->ops->process_data_sizes(slave->app, &outputs, &inputs);
    if (!cm1e_sim_esc_process_data_valid(slave, ESC_ROLE_OUTPUTS, outputs))
        return AL_CODE_INVALID_OUTPUT_CONFIG;
    return cm1e_sim_esc_process_data_valid(slave, ESC_ROLE_INPUTS, inputs) ? AL_CODE_NONE
                                                                           : AL_CODE_INVALID_INPUT_CONFIG;
}

static uint16_t ask_application(cm1e_sim_slave_t *slave, uint8_t to)
{
    slave->changing_state = true;
    const uint16_t code = slave->ops->state_change ? slave->ops->state_change(slave->app, slave->al_state, to) : 0;
    slave->changing_state = false;
    return code;
}

/* The buffers that the new state does not use are not accessible: process data below Safe-Operational, mailboxes in
 * Init. */
static void enter(cm1e_sim_slave_t *slave, uint8_t state)
{
    const uint8_t before = slave->al_state;
    slave->al_state = state;
    cm1e_sim_esc_sm_lock(slave, ESC_ROLE_OUTPUTS, state < CM1E_AL_SAFE_OP);
    cm1e_sim_esc_sm_lock(slave, ESC_ROLE_INPUTS, state < CM1E_AL_SAFE_OP);
    if (has_mailbox(slave) && (before == CM1E_AL_INIT) != (state == CM1E_AL_INIT)) {
        cm1e_sim_esc_sm_lock(slave, ESC_ROLE_MAILBOX_OUT, state == CM1E_AL_INIT);
        cm1e_sim_esc_sm_lock(slave, ESC_ROLE_MAILBOX_IN, state == CM1E_AL_INIT);
        if (state == CM1E_AL_INIT)
            cm1e_sim_mailbox_stop(slave);
        else
            cm1e_sim_mailbox_start(slave);
    }
    /* A watchdog that has expired starts anew. */
    if (state == CM1E_AL_OP)
        cm1e_sim_al_watchdog_trigger(slave);
}

/* ETG.1000.6 table 9: the allowed transitions, and their conditions. */
static const struct transition {
    uint8_t from, to;
    uint16_t (*check)(cm1e_sim_slave_t *slave);
} transitions[] = {
    {CM1E_AL_INIT, CM1E_AL_PRE_OP, check_mailbox},
    {CM1E_AL_INIT, CM1E_AL_BOOT, check_boot_mailbox},
    {CM1E_AL_BOOT, CM1E_AL_INIT, NULL},
    {CM1E_AL_PRE_OP, CM1E_AL_INIT, NULL},
    {CM1E_AL_PRE_OP, CM1E_AL_SAFE_OP, check_process_data},
    {CM1E_AL_SAFE_OP, CM1E_AL_INIT, NULL},
    {CM1E_AL_SAFE_OP, CM1E_AL_PRE_OP, NULL},
    {CM1E_AL_SAFE_OP, CM1E_AL_OP, check_process_data},
    {CM1E_AL_OP, CM1E_AL_INIT, NULL},
    {CM1E_AL_OP, CM1E_AL_PRE_OP, NULL},
    {CM1E_AL_OP, CM1E_AL_SAFE_OP, NULL},
};
enum { TRANSITIONS = sizeof transitions / sizeof transitions[0] };

static const struct transition *find_transition(uint8_t from, uint8_t to)
{
    for (int i = 0; i < TRANSITIONS; i++)
        if (transitions[i].from == from && transitions[i].to == to)
            return &transitions[i];
    return NULL;
}

static bool state_known(uint8_t state)
{
    return state == CM1E_AL_INIT || state == CM1E_AL_PRE_OP || state == CM1E_AL_BOOT || state == CM1E_AL_SAFE_OP ||
           state == CM1E_AL_OP;
}

/* Whether the present state may be kept: the master may have changed a sync manager meanwhile. */
static uint16_t check_present(cm1e_sim_slave_t *slave)
{
    uint16_t code = AL_CODE_NONE;
    if (slave->al_state == CM1E_AL_BOOT)
        code = check_boot_mailbox(slave);
    else if (slave->al_state > CM1E_AL_INIT)
        code = check_mailbox(slave);
    if (code == AL_CODE_NONE && slave->al_state >= CM1E_AL_SAFE_OP)
        code = check_process_data(slave);
    return code;
}

static uint16_t decide(cm1e_sim_slave_t *slave, uint8_t to)
{
    const uint8_t from = slave->al_state;
    if (!state_known(to))
        return AL_CODE_UNKNOWN_STATE;
    if (to == from)
        return check_present(slave);
    const struct transition *transition = find_transition(from, to);
    if (!transition)
        return AL_CODE_INVALID_STATE_CHANGE;
    uint16_t code = transition->check ? transition->check(slave) : AL_CODE_NONE;
    if (code == AL_CODE_NONE && to > from && to >= CM1E_AL_SAFE_OP)
        code = cm1e_sim_esc_sync_check(slave, to);
    if (code == AL_CODE_NONE)
        code = ask_application(slave, to);
    if (code == AL_CODE_NONE || to < from)
        enter(slave, to);
    return code;
}

static bool emulates_device(const cm1e_sim_slave_t *slave)
{
    return slave->memory[ESC_PDI_CONTROL + 1] & DEVICE_EMULATION;
}

/* A slave without a processor: its controller copies AL control to AL status at once, also an acknowledgement (which
 * then reads as an error) and an unknown state. Nothing is checked, and there is no AL status code. */
static void emulate_device(cm1e_sim_slave_t *slave, uint16_t request)
{
    const uint8_t to = request & STATE;
    if (to != slave->al_state)
        ask_application(slave, to);
    slave->al_state = to;
    slave->al_error = request & ACKNOWLEDGE;
    slave->al_id = request & ID;
    show(slave, AL_CODE_NONE);
}

void cm1e_sim_al_power_on(cm1e_sim_slave_t *slave)
{
    slave->al_due_ns = ESC_NEVER;
    slave->watchdog_due_ns = ESC_NEVER;
    slave->al_error = slave->al_id = slave->changing_state = false;
    slave->al_state = CM1E_AL_INIT;
    slave->al_request = CM1E_AL_INIT;
    slave->memory[ESC_AL_CONTROL] = CM1E_AL_INIT;
    for (unsigned role = ESC_ROLE_MAILBOX_OUT; role < ESC_ROLES; role++)
        cm1e_sim_esc_sm_lock(slave, role, !emulates_device(slave)); /* a processor does that */
    show(slave, AL_CODE_NONE);
}

void cm1e_sim_al_control(cm1e_sim_slave_t *slave)
{
    const uint16_t request = cm1e_get_u16(slave->memory + ESC_AL_CONTROL);
    /* Without a valid SII the slave's processor does not run, so no one reads the request. */
    if (!slave->sii_valid || (slave->al_due_ns != ESC_NEVER && request == slave->al_request))
        return;
    if (emulates_device(slave)) {
        emulate_device(slave, request);
        return;
    }
    slave->al_request = request;
    slave->al_due_ns = slave->now_ns + DECISION_NS;
}

void cm1e_sim_al_due(cm1e_sim_slave_t *slave)
{
    const uint16_t request = slave->al_request;
    const uint8_t to = request & STATE;
    slave->al_due_ns = ESC_NEVER;
    /* An error must be acknowledged, unless the master starts again from Init. */
    if (slave->al_error && !(request & ACKNOWLEDGE) && to != CM1E_AL_INIT)
        return;
    slave->al_error = false;
    const uint16_t code = decide(slave, to);
    slave->al_error = code != AL_CODE_NONE;
    /* The explicit device ID takes the place of the status code where there is no error (ETG.1020 18.4). */
    const bool tells = slave->ops->explicit_device_id && !(slave->quirks.late_id && to == CM1E_AL_INIT);
    slave->al_id = (request & ID) && !slave->al_error && tells;
    show(slave, slave->al_id ? slave->ops->explicit_device_id(slave->app) : code);
}

void cm1e_sim_slave_fall_back(cm1e_sim_slave_t *slave, uint8_t al_state, uint16_t al_status_code)
{
    if (slave->changing_state || emulates_device(slave))
        return; /* the answer of the application decides; with device emulation only the master sets AL status */
    slave->al_due_ns = ESC_NEVER;
    if (al_state < slave->al_state && find_transition(slave->al_state, al_state)) {
        ask_application(slave, al_state);
        enter(slave, al_state);
    }
    slave->al_error = true;
    slave->al_id = false;
    slave->fell_back = true;
    if (slave->segment_fell_back)
        *slave->segment_fell_back = true;
    show(slave, al_status_code);
}
