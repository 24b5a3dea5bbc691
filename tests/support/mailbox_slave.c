#include "mailbox_slave.h"

/* ---- the server ------------------------------------------------------------------------------------------------ */

void put_in(slave_t *s, const uint8_t *message)
{
    if (s->in_full) {
        memcpy(s->queued, message, MAILBOX);
        s->queued_valid = true;
    } else {
        memcpy(s->in, message, MAILBOX);
        s->in_full = true;
    }
}

void send_answer(slave_t *s, uint8_t *answer, uint16_t body_bytes)
{
    cm1e_put_u16(answer, body_bytes);
    s->counter = (uint8_t)(s->counter % 7 + 1);
    answer[5] = (uint8_t)(3 | s->counter << 4);
    s->lies++;
    if (s->lie && s->lies >= s->lie_from && !s->lie(s, answer))
        return;
    put_in(s, answer);
}

static void send_emergency(slave_t *s)
{
    uint8_t message[MAILBOX] = {0};
    cm1e_put_u16(message, 10);
    s->counter = (uint8_t)(s->counter % 7 + 1);
    message[5] = (uint8_t)(3 | s->counter << 4);
    cm1e_put_u16(message + 6, 1 << 12);
    cm1e_put_u16(message + 8, 0xFF05);
    message[10] = 0x81;
    put_in(s, message);
}

static void answer_mailbox_error(slave_t *s, uint16_t detail)
{
    uint8_t message[MAILBOX] = {0};
    cm1e_put_u16(message, 4);
    s->counter = (uint8_t)(s->counter % 7 + 1);
    message[5] = (uint8_t)(s->counter << 4);
    cm1e_put_u16(message + 6, 1);
    cm1e_put_u16(message + 8, detail);
    put_in(s, message);
}

static void answer_abort(slave_t *s, const uint8_t *request, uint32_t code)
{
    uint8_t answer[MAILBOX] = {0};
    cm1e_put_u16(answer + 6, 2 << 12);
    answer[8] = 0x80;
    memcpy(answer + 9, request + 9, 3);
    cm1e_put_u32(answer + 12, code);
    send_answer(s, answer, 10);
}

static void serve_upload(slave_t *s, const uint8_t *request)
{
    uint8_t answer[MAILBOX] = {0};
    uint8_t fence[4] = {1, 2, 3, 4};
    const bool ours = cm1e_get_u16(request + 9) == 0x2000;
    const uint8_t *value = ours ? s->store : fence;
    const size_t size = ours ? s->size : sizeof fence;
    cm1e_put_u16(answer + 6, 3 << 12);
    memcpy(answer + 9, request + 9, 3);
    if (size >= 1 && size <= 4) {
        answer[8] = (uint8_t)(0x43 | (4 - size) << 2);
        memcpy(answer + 12, value, size);
        send_answer(s, answer, 10);
        return;
    }
    const size_t room = MAILBOX - 16, first = size < room ? size : room;
    answer[8] = 0x41;
    cm1e_put_u32(answer + 12, (uint32_t)size);
    memcpy(answer + 16, value, first);
    s->outgoing = first;
    s->open = first < size;
    send_answer(s, answer, (uint16_t)(10 + first));
}

static void serve_upload_segment(slave_t *s, const uint8_t *request)
{
    uint8_t answer[MAILBOX] = {0};
    const size_t room = MAILBOX - 9, rest = s->size - s->outgoing, bytes = rest < room ? rest : room;
    const size_t unused = bytes < 7 ? 7 - bytes : 0;
    cm1e_put_u16(answer + 6, 3 << 12);
    answer[8] = (uint8_t)((request[8] & 0x10) | unused << 1 | (bytes == rest));
    memcpy(answer + 9, s->store + s->outgoing, bytes);
    s->outgoing += bytes;
    s->open = s->outgoing < s->size;
    send_answer(s, answer, (uint16_t)(3 + bytes + unused));
}

static void take_bytes(slave_t *s, const uint8_t *bytes, size_t size, bool last)
{
    TEST_ASSERT_TRUE(s->incoming_size + size <= s->incoming_total);
    memcpy(s->incoming + s->incoming_size, bytes, size);
    s->incoming_size += size;
    if (!last)
        return;
    TEST_ASSERT_EQUAL_size_t(s->incoming_total, s->incoming_size);
    memcpy(s->store, s->incoming, s->incoming_size);
    s->size = s->incoming_size;
    s->writes++;
}

static void serve_download(slave_t *s, const uint8_t *request, uint16_t length)
{
    uint8_t answer[MAILBOX] = {0};
    s->incoming_size = 0;
    if (request[8] & 2) {
        s->incoming_total = 4u - (request[8] >> 2 & 3);
        take_bytes(s, request + 12, s->incoming_total, true);
    } else {
        s->incoming_total = cm1e_get_u32(request + 12);
        const size_t given = length - 10u;
        take_bytes(s, request + 16, given, given == s->incoming_total);
        s->open = given < s->incoming_total;
    }
    cm1e_put_u16(answer + 6, 3 << 12);
    answer[8] = 0x60;
    memcpy(answer + 9, request + 9, 3);
    send_answer(s, answer, 10);
}

static void serve_download_segment(slave_t *s, const uint8_t *request, uint16_t length)
{
    uint8_t answer[MAILBOX] = {0};
    const size_t bytes = length == 10 ? 7u - (request[8] >> 1 & 7) : length - 3u;
    take_bytes(s, request + 9, bytes, request[8] & 1);
    s->open = !(request[8] & 1);
    cm1e_put_u16(answer + 6, 3 << 12);
    answer[8] = (uint8_t)(0x20 | (request[8] & 0x10));
    send_answer(s, answer, 10);
}

static void take_abort(slave_t *s, const uint8_t *request)
{
    TEST_ASSERT_EQUAL_UINT16(10, cm1e_get_u16(request));
    TEST_ASSERT_EQUAL_HEX8(0x80, request[8]);
    s->open = false;
    s->aborts++;
    s->abort_index = cm1e_get_u16(request + 9);
    s->abort_code = cm1e_get_u32(request + 12);
    if (s->rejects_aborts)
        answer_mailbox_error(s, 2);
}

void serve(slave_t *s)
{
    const uint8_t *request = s->out;
    const uint16_t length = cm1e_get_u16(request), index = cm1e_get_u16(request + 9);
    const uint8_t counter = request[5] >> 4;
    s->out_full = false;
    TEST_ASSERT_TRUE(length <= MAILBOX - 6);
    const bool information = cm1e_get_u16(request + 6) == 8 << 12;
    TEST_ASSERT_TRUE(length >= (information ? 8 : 10));
    TEST_ASSERT_EQUAL_HEX8(3, request[5] & 0x0F);
    TEST_ASSERT_TRUE(counter >= 1 && counter <= 7);
    if (counter == s->seen_counter)
        return; /* a repeated message */
    s->seen_counter = counter;
    s->requests++;
    if (s->emergency_before && s->requests >= s->emergency_before)
        send_emergency(s);
    if (information) {
        if (s->serve_information)
            s->serve_information(s, request + 6, length);
        return;
    }
    const unsigned specifier = request[8] >> 5;
    const bool initiates = specifier == 1 || specifier == 2;
    if (specifier == 4)
        take_abort(s, request);
    else if (initiates && s->strict && s->open)
        answer_mailbox_error(s, 7);
    else if (initiates && index != 0x2000 && index != 0x1000 && index != 0x1018)
        answer_abort(s, request, 0x06020000);
    else if (specifier == 2)
        serve_upload(s, request);
    else if (specifier == 3)
        serve_upload_segment(s, request);
    else if (specifier == 1)
        serve_download(s, request, length);
    else
        serve_download_segment(s, request, length);
}

/* ---- the controller -------------------------------------------------------------------------------------------- */

static void repeat_last(slave_t *s, uint8_t activate)
{
    if ((activate ^ s->activate) & 2) {
        const bool there = s->in_full && !memcmp(s->in, s->last, MAILBOX);
        if (s->last_valid && !there) { /* what was read last comes again, before what waits */
            if (s->in_full) {
                memcpy(s->queued, s->in, MAILBOX);
                s->queued_valid = true;
            }
            memcpy(s->in, s->last, MAILBOX);
            s->in_full = true;
        }
        s->acknowledge = activate & 2;
    }
    s->activate = activate;
}

static void read_sm(const slave_t *s, uint8_t *out, uint8_t *in)
{
    if (out)
        out[5] = s->out_full ? 8 : 0;
    in[5] = s->in_full ? 8 : 0;
    in[6] = s->activate;
    in[7] = s->acknowledge ? 2 : 0;
}

void handle(slave_t *s, cm1e_datagram_t *d)
{
    TEST_ASSERT_EQUAL_HEX16(STATION, d->address);
    d->working_counter = 1;
    if (s->out_full && s->wait-- == 0)
        serve(s);
    if (!s->in_full && s->queued_valid) {
        memcpy(s->in, s->queued, MAILBOX);
        s->in_full = true;
        s->queued_valid = false;
    } else if (!s->in_full && s->send_more) {
        s->send_more(s);
    }
    if (d->command == COMMAND_FPWR && d->offset == OUT) {
        TEST_ASSERT_EQUAL_UINT16(MAILBOX, d->length);
        d->working_counter = s->out_full ? 0 : 1;
        if (!s->out_full) {
            memcpy(s->out, d->data, MAILBOX);
            s->wait = s->latency;
            s->out_full = true;
        }
    } else if (d->command == COMMAND_FPRD && d->offset == IN) {
        TEST_ASSERT_EQUAL_UINT16(MAILBOX, d->length);
        d->working_counter = s->in_full ? 1 : 0;
        if (s->in_full) {
            memcpy(d->data, s->in, MAILBOX);
            memcpy(s->last, s->in, MAILBOX);
            s->last_valid = true;
            s->in_full = false;
        }
    } else if (d->command == COMMAND_FPRD && d->offset == REG_SM0) {
        memset(d->data, 0, 16);
        read_sm(s, d->data, d->data + 8);
    } else if (d->command == COMMAND_FPRD && d->offset == REG_SM1) {
        memset(d->data, 0, 8);
        read_sm(s, NULL, d->data);
    } else if (d->command == COMMAND_FPWR && d->offset == REG_SM1 + 6) {
        repeat_last(s, d->data[0]);
    } else {
        TEST_FAIL_MESSAGE("a datagram that nobody should send");
    }
}
