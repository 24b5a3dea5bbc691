#include "sim/mailbox.h"

#include <string.h>

#include "cm1e/bus.h"
#include "core/bytes.h"
#include "sim/esc_chip.h"

/* Mailbox header (ETG.1000.4 table 29). */
enum { AT_LENGTH = 0, AT_TYPE = 5, TYPE = 0x0F, COUNTER_SHIFT = 4, COUNTER = 0x07, LAST_COUNTER = 7 };
enum { REQUEST_NS = 200000, RELOAD_NS = 50000 };
enum { ERROR_COMMAND = 1, ERROR_BYTES = 4 };
enum { COE_SERVICE_EMERGENCY = 1, COE_SERVICE_SHIFT = 12 };
enum { REPEAT = 0x02, AT_ACTIVATE = 6, AT_PDI = 7, SM_BYTES = 8 };

static void wake(cm1e_sim_slave_t *slave, int64_t after_ns)
{
    const int64_t due = slave->now_ns + after_ns;
    if (due < slave->mailbox_due_ns)
        slave->mailbox_due_ns = due;
}

void cm1e_sim_mailbox_stop(cm1e_sim_slave_t *slave)
{
    mailbox_t *mailbox = &slave->mailbox;
    mailbox->running = false;
    mailbox->request_due_ns = slave->mailbox_due_ns = ESC_NEVER;
    mailbox->request_counter = mailbox->answer_counter = 0;
    mailbox->answer.length = mailbox->kept_length[0] = mailbox->kept_length[1] = mailbox->held_length = 0;
    mailbox->emergency_first = mailbox->emergency_count = 0;
    cm1e_sim_coe_reset(slave);
    cm1e_sim_foe_reset(slave);
}

/* Bits of the master's repeat request and of its acknowledgement. */
static uint8_t *repeat_registers(cm1e_sim_slave_t *slave)
{
    const esc_sync_manager_t *sm = cm1e_sim_esc_sm(slave, ESC_ROLE_MAILBOX_IN);
    return sm ? slave->memory + ESC_SM + sm->number * SM_BYTES : NULL;
}

static void acknowledge_repeat(cm1e_sim_slave_t *slave)
{
    uint8_t *r = repeat_registers(slave);
    r[AT_PDI] = (uint8_t)((r[AT_PDI] & ~REPEAT) | (r[AT_ACTIVATE] & REPEAT));
}

void cm1e_sim_mailbox_start(cm1e_sim_slave_t *slave)
{
    cm1e_sim_mailbox_stop(slave);
    slave->mailbox.running = true;
    acknowledge_repeat(slave);
}

void cm1e_sim_mailbox_written(cm1e_sim_slave_t *slave)
{
    const int64_t takes_ns = REQUEST_NS + slave->quirks.mailbox_extra_ns;
    slave->mailbox.request_due_ns = slave->now_ns + takes_ns;
    wake(slave, takes_ns);
}

void cm1e_sim_mailbox_read(cm1e_sim_slave_t *slave)
{
    wake(slave, RELOAD_NS);
}

void cm1e_sim_mailbox_repeat(cm1e_sim_slave_t *slave)
{
    const uint8_t *r = repeat_registers(slave);
    if (slave->mailbox.running && r && (r[AT_ACTIVATE] ^ r[AT_PDI]) & REPEAT)
        wake(slave, RELOAD_NS);
}

bool cm1e_sim_slave_emergency(cm1e_sim_slave_t *slave, uint16_t error_code, uint8_t error_register,
                              const uint8_t data[5])
{
    mailbox_t *mailbox = &slave->mailbox;
    if (!mailbox->running || mailbox->emergency_count == MAILBOX_EMERGENCIES)
        return false;
    uint8_t *place =
        mailbox->emergencies[(mailbox->emergency_first + mailbox->emergency_count++) % MAILBOX_EMERGENCIES];
    cm1e_put_u16(place, error_code);
    place[2] = error_register;
    memcpy(place + 3, data, 5);
    wake(slave, 0);
    return true;
}

/* ---- the read mailbox ------------------------------------------------------------------------------------------ */

/* Into the mailbox, and kept beside the one before it. */
static void load(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, const uint8_t *bytes, uint16_t length)
{
    mailbox_t *mailbox = &slave->mailbox;
    uint8_t *place = slave->memory + sm->start;
    const uint16_t n = length < sm->length ? length : sm->length;
    memset(place, 0, sm->length);
    memcpy(place, bytes, n);
    mailbox->loaded ^= 1;
    memcpy(mailbox->kept[mailbox->loaded], place, n);
    mailbox->kept_length[mailbox->loaded] = n;
    cm1e_sim_esc_sm_set_full(slave, sm, true);
}

static void load_message(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm, uint8_t type, const uint8_t *data,
                         uint16_t length)
{
    mailbox_t *mailbox = &slave->mailbox;
    uint8_t bytes[MAILBOX_MAX_BYTES] = {0};
    mailbox->answer_counter = (uint8_t)(mailbox->answer_counter % LAST_COUNTER + 1);
    cm1e_put_u16(bytes + AT_LENGTH, length);
    bytes[AT_TYPE] = (uint8_t)(type | mailbox->answer_counter << COUNTER_SHIFT);
    memcpy(bytes + MAILBOX_HEADER, data, length);
    load(slave, sm, bytes, (uint16_t)(MAILBOX_HEADER + length));
}

static void load_emergency(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm)
{
    mailbox_t *mailbox = &slave->mailbox;
    uint8_t data[2 + EMERGENCY_BYTES];
    cm1e_put_u16(data, COE_SERVICE_EMERGENCY << COE_SERVICE_SHIFT);
    memcpy(data + 2, mailbox->emergencies[mailbox->emergency_first], EMERGENCY_BYTES);
    mailbox->emergency_first = (mailbox->emergency_first + 1) % MAILBOX_EMERGENCIES;
    mailbox->emergency_count--;
    load_message(slave, sm, MAILBOX_TYPE_COE, data, sizeof data);
}

/* One message into the empty mailbox: what a repetition moved aside, an emergency, the answer. */
static void load_next(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm)
{
    mailbox_t *mailbox = &slave->mailbox;
    if (sm->full)
        return;
    if (mailbox->held_length) {
        const uint16_t length = mailbox->held_length;
        mailbox->held_length = 0;
        load(slave, sm, mailbox->held, length);
    } else if (mailbox->emergency_count) {
        load_emergency(slave, sm);
    } else if (mailbox->answer.length) {
        load_message(slave, sm, mailbox->answer.type, mailbox->answer.data, mailbox->answer.length);
        mailbox->answer.length = 0;
    }
}

/* The master lost the message it read last: it is put back, and one loaded meanwhile follows it. */
static void repeat_last(cm1e_sim_slave_t *slave, esc_sync_manager_t *sm)
{
    mailbox_t *mailbox = &slave->mailbox;
    const uint8_t *r = repeat_registers(slave);
    if (((r[AT_ACTIVATE] ^ r[AT_PDI]) & REPEAT) == 0)
        return;
    acknowledge_repeat(slave);
    const unsigned last_read = sm->full ? mailbox->loaded ^ 1u : mailbox->loaded;
    if (mailbox->kept_length[last_read] == 0)
        return;
    if (sm->full) {
        mailbox->held_length = mailbox->kept_length[mailbox->loaded];
        memcpy(mailbox->held, mailbox->kept[mailbox->loaded], mailbox->held_length);
    }
    uint8_t bytes[MAILBOX_MAX_BYTES];
    memcpy(bytes, mailbox->kept[last_read], mailbox->kept_length[last_read]);
    load(slave, sm, bytes, mailbox->kept_length[last_read]);
}

/* ---- the write mailbox ----------------------------------------------------------------------------------------- */

static void answer_error(mailbox_message_t *answer, uint16_t detail)
{
    answer->type = MAILBOX_TYPE_ERROR;
    answer->length = ERROR_BYTES;
    cm1e_put_u16(answer->data, ERROR_COMMAND);
    cm1e_put_u16(answer->data + 2, detail);
}

static void handle_request(cm1e_sim_slave_t *slave, const esc_sync_manager_t *sm, uint16_t room)
{
    mailbox_t *mailbox = &slave->mailbox;
    const uint8_t *request = slave->memory + sm->start;
    const uint16_t length = cm1e_get_u16(request + AT_LENGTH);
    const bool in_bootstrap = slave->al_state == CM1E_AL_BOOT;
    const uint8_t type = request[AT_TYPE] & TYPE, counter = request[AT_TYPE] >> COUNTER_SHIFT & COUNTER;
    /* A repeated counter: the master sent the message again because the answering frame was lost (ETG.1000.4 5.6). */
    if (counter && counter == mailbox->request_counter)
        return;
    mailbox->request_counter = counter;
    if (type == MAILBOX_TYPE_ERROR)
        return; /* an error is not answered by an error */
    if (length > sm->length - MAILBOX_HEADER) {
        answer_error(&mailbox->answer, MAILBOX_ERROR_INVALID_SIZE);
    } else if (type == MAILBOX_TYPE_FOE && in_bootstrap != slave->ops->files_in_operation) {
        cm1e_sim_foe_request(slave, request + MAILBOX_HEADER, length, &mailbox->answer,
                             (size_t)(sm->length - MAILBOX_HEADER), room);
    } else if (type == MAILBOX_TYPE_COE && !in_bootstrap) {
        const uint16_t detail =
            cm1e_sim_coe_request(slave, request + MAILBOX_HEADER, length, &mailbox->answer, room);
        if (detail)
            answer_error(&mailbox->answer, detail);
    } else if (type == MAILBOX_TYPE_FOE) {
        cm1e_sim_foe_refuse(&mailbox->answer);
    } else {
        answer_error(&mailbox->answer, MAILBOX_ERROR_UNSUPPORTED_PROTOCOL);
    }
}

void cm1e_sim_mailbox_due(cm1e_sim_slave_t *slave)
{
    mailbox_t *mailbox = &slave->mailbox;
    esc_sync_manager_t *out = cm1e_sim_esc_sm(slave, ESC_ROLE_MAILBOX_OUT);
    esc_sync_manager_t *in = cm1e_sim_esc_sm(slave, ESC_ROLE_MAILBOX_IN);
    slave->mailbox_due_ns = ESC_NEVER;
    /* The master may have changed the sync managers since Pre-Operational. */
    if (!mailbox->running || !cm1e_sim_esc_mailboxes_valid(slave))
        return;
    const uint16_t room = (uint16_t)(in->length - MAILBOX_HEADER);
    repeat_last(slave, in);
    load_next(slave, in);
    /* A request is taken when there is a place for its answer. */
    if (out->full && mailbox->answer.length == 0) {
        if (slave->now_ns >= mailbox->request_due_ns) {
            handle_request(slave, out, room);
            cm1e_sim_esc_sm_set_full(slave, out, false);
            load_next(slave, in);
        } else {
            slave->mailbox_due_ns = mailbox->request_due_ns;
        }
    }
    /* A list continues unless a new request ends it. */
    if (!in->full && !out->full && mailbox->answer.length == 0 &&
        cm1e_sim_coe_next_fragment(slave, &mailbox->answer, room))
        load_next(slave, in);
}
