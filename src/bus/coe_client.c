#include "bus/coe_client.h"

#include <string.h>

#include "core/bytes.h"

enum { DEFAULT_TIMEOUT_NS = 1000000000 };
/** For all fragments of an answer together. */
#define INFO_TIMEOUT_NS INT64_C(3000000000)
/** A transfer is given up if the slave sends only other messages for this time. */
enum { DISCARD_LIMIT = 64 };
/** Messages at one look, so that a slave that always sends does not keep transfers waiting. */
enum { LISTEN_LIMIT = 4 };
#define LISTEN_NS INT64_C(100000000)

/* CoE services and SDO command specifiers (ETG.1000.6 sections 5.6.1 and 5.6.2). */
enum { SERVICE_EMERGENCY = 1, SERVICE_SDO_REQUEST = 2, SERVICE_SDO_RESPONSE = 3, SERVICE_SDO_INFORMATION = 8 };
enum {
    REQUEST_DOWNLOAD_SEGMENT = 0x00, REQUEST_DOWNLOAD = 0x20, REQUEST_UPLOAD = 0x40, REQUEST_UPLOAD_SEGMENT = 0x60,
    RESPONSE_UPLOAD_SEGMENT = 0x00, RESPONSE_DOWNLOAD_SEGMENT = 0x20, RESPONSE_UPLOAD = 0x40, RESPONSE_DOWNLOAD = 0x60,
    SDO_ABORT = 0x80, SPECIFIER_MASK = 0xE0,
    BIT_COMPLETE_ACCESS = 0x10, BIT_TOGGLE = 0x10, BIT_EXPEDITED = 0x02, BIT_SIZE_GIVEN = 0x01, BIT_LAST = 0x01,
};
/** Abort code for a transfer that is given up (ETG.1000.6 table 41). */
#define ABORT_TOGGLE 0x05030000u
#define ABORT_TIMEOUT 0x05040000u
#define ABORT_COMMAND 0x05040001u
#define ABORT_NO_MEMORY 0x05040005u
#define ABORT_GENERAL 0x08000000u
/** CoE header, command byte, index, sub-index, four bytes of data: the shortest SDO message. */
enum { COE_HEADER = 2, SDO_BYTES = 10, SEGMENT_HEADER = 3, SEGMENT_MIN_DATA = 7 };
/** SDO information: CoE header, opcode, reserved, fragments left (ETG.1000.6 section 5.6.3). */
enum { INFO_HEADER = 6, INFO_ERROR = 7, INFO_OPCODE = 0x7F, INFO_INCOMPLETE = 0x80 };

cm1e_sdo_state_t cm1e_sdo_state(const cm1e_sdo_t *sdo)
{
    return sdo ? (cm1e_sdo_state_t)__atomic_load_n(&sdo->state, __ATOMIC_ACQUIRE) : CM1E_SDO_IDLE;
}

void cm1e_sdo_finish(cm1e_sdo_t *sdo, cm1e_error_t error, uint32_t abort_code)
{
    sdo->error = error;
    sdo->abort_code = abort_code;
    __atomic_store_n(&sdo->state, error == CM1E_OK ? CM1E_SDO_DONE : CM1E_SDO_ERROR, __ATOMIC_RELEASE);
}

static void finish(cm1e_coe_client_t *client, cm1e_error_t error, uint32_t abort_code)
{
    cm1e_sdo_t *sdo = client->sdo;
    cm1e_info_request_t *info = client->info;
    client->sdo = NULL;
    client->info = NULL;
    client->phase = COE_IDLE;
    cm1e_mailbox_stop(&client->mailbox);
    if (sdo) {
        cm1e_sdo_finish(sdo, error, abort_code);
        return;
    }
    if (!info) /* it listened */
        return;
    info->size = error == CM1E_OK ? info->taken : 0;
    info->error = error;
    info->abort_code = abort_code;
    info->done = true;
}

static bool is_transfer(const cm1e_coe_client_t *client)
{
    return client->phase >= COE_UPLOAD && client->phase <= COE_DOWNLOAD_SEGMENT;
}

static bool is_segmented(const cm1e_coe_client_t *client)
{
    return client->phase == COE_UPLOAD_SEGMENT || client->phase == COE_DOWNLOAD_SEGMENT;
}

/** What comes is none of its business: nothing was asked, or the answer does not matter. */
static bool awaits_nothing(const cm1e_coe_client_t *client)
{
    return client->phase == COE_ABORT || client->phase == COE_DRAIN || client->phase == COE_LISTEN;
}

/** Later answers to this transfer must not be taken as answers to the next one. */
static void distrust(cm1e_coe_client_t *client)
{
    client->doubtful = true;
    client->last_index = client->sdo ? client->sdo->index : 0;
}

/** The slave may hold the transfer open, so it gets an abort. */
static void owe_abort(cm1e_coe_client_t *client, uint32_t code)
{
    client->abort = (cm1e_owed_abort_t){true, client->awaited_index, client->awaited_subindex, code};
}

/** Ends the transfer from our side, without another datagram. */
static void give_up(cm1e_coe_client_t *client, cm1e_error_t error)
{
    if (client->phase == COE_LISTEN) { /* nothing was asked, so no answer can come late */
        finish(client, error, 0);
        return;
    }
    distrust(client);
    if (is_transfer(client))
        owe_abort(client, error == CM1E_ERROR_TIMEOUT ? ABORT_TIMEOUT : ABORT_GENERAL);
    finish(client, client->phase == COE_ABORT && client->failure != CM1E_OK ? client->failure : error, 0);
}

void cm1e_coe_reset(cm1e_coe_client_t *client, cm1e_error_t error)
{
    if (!cm1e_coe_idle(client))
        finish(client, error, 0);
    client->phase = COE_IDLE;
    client->doubtful = client->abort.owed = client->abort_sent = false; /* the transition empties the slave's mailbox */
    cm1e_mailbox_reset(&client->mailbox);
}

void cm1e_coe_cancel(cm1e_coe_client_t *client, cm1e_error_t error)
{
    if (!cm1e_coe_idle(client))
        give_up(client, error);
}

/* ---- requests -------------------------------------------------------------------------------------------------- */

static uint8_t *start_message(cm1e_coe_client_t *client)
{
    uint8_t *body = cm1e_mailbox_body(&client->mailbox);
    memset(body, 0, SDO_BYTES);
    cm1e_put_u16(body, SERVICE_SDO_REQUEST << 12);
    return body;
}

static void send_message(cm1e_coe_client_t *client, size_t size)
{
    cm1e_mailbox_send(&client->mailbox, MAILBOX_TYPE_COE, (uint16_t)size);
}

static uint8_t *start_initiate(cm1e_coe_client_t *client, uint8_t command, uint16_t index, uint8_t subindex)
{
    uint8_t *body = start_message(client);
    body[2] = command;
    cm1e_put_u16(body + 3, index);
    body[5] = subindex;
    client->awaited_index = index;
    client->awaited_subindex = subindex;
    return body;
}

static void request_fence(cm1e_coe_client_t *client)
{
    /* Entries that every CoE device has (ETG.1000.6 table 67), each time another one, and not the one given up. */
    static const struct {
        uint16_t index;
        uint8_t subindex;
    } fences[] = {{0x1000, 0}, {0x1018, 0}, {0x1018, 1}, {0x1018, 2}, {0x1018, 3}};
    do
        client->fence = (uint8_t)((client->fence + 1) % (sizeof fences / sizeof fences[0]));
    while (fences[client->fence].index == client->last_index);
    client->phase = COE_FENCE;
    start_initiate(client, REQUEST_UPLOAD, fences[client->fence].index, fences[client->fence].subindex);
    send_message(client, SDO_BYTES);
}

/** Before the first request after a transfer that was given up. */
static void start_fence(cm1e_coe_client_t *client)
{
    client->phase = COE_DRAIN;
    cm1e_mailbox_drain(&client->mailbox);
}

static void request_upload(cm1e_coe_client_t *client)
{
    const cm1e_sdo_t *sdo = client->sdo;
    client->phase = COE_UPLOAD;
    const uint8_t access = sdo->complete_access ? BIT_COMPLETE_ACCESS : 0;
    start_initiate(client, REQUEST_UPLOAD | access, sdo->index, sdo->subindex);
    send_message(client, SDO_BYTES);
}

static void request_upload_segment(cm1e_coe_client_t *client)
{
    client->phase = COE_UPLOAD_SEGMENT;
    uint8_t *body = start_message(client);
    body[2] = (uint8_t)(REQUEST_UPLOAD_SEGMENT | (client->toggle ? BIT_TOGGLE : 0));
    send_message(client, SDO_BYTES);
}

static void request_download(cm1e_coe_client_t *client)
{
    const cm1e_sdo_t *sdo = client->sdo;
    const uint8_t access = sdo->complete_access ? BIT_COMPLETE_ACCESS : 0;
    client->phase = COE_DOWNLOAD;
    client->total = sdo->size;
    if (sdo->size >= 1 && sdo->size <= 4) {
        const uint8_t command =
            (uint8_t)(REQUEST_DOWNLOAD | access | (4 - sdo->size) << 2 | BIT_EXPEDITED | BIT_SIZE_GIVEN);
        uint8_t *body = start_initiate(client, command, sdo->index, sdo->subindex);
        memcpy(body + 6, sdo->data, sdo->size);
        client->done = sdo->size;
        send_message(client, SDO_BYTES);
        return;
    }
    uint8_t *body = start_initiate(client, REQUEST_DOWNLOAD | access | BIT_SIZE_GIVEN, sdo->index, sdo->subindex);
    cm1e_put_u32(body + 6, (uint32_t)sdo->size);
    const size_t room = (size_t)(cm1e_mailbox_room(&client->mailbox) - SDO_BYTES);
    client->done = sdo->size < room ? sdo->size : room;
    if (client->done)
        memcpy(body + SDO_BYTES, sdo->data, client->done);
    send_message(client, SDO_BYTES + client->done);
}

static void request_download_segment(cm1e_coe_client_t *client)
{
    const size_t room = (size_t)(cm1e_mailbox_room(&client->mailbox) - SEGMENT_HEADER);
    const size_t rest = client->total - client->done;
    const size_t bytes = rest < room ? rest : room;
    const size_t unused = bytes < SEGMENT_MIN_DATA ? SEGMENT_MIN_DATA - bytes : 0;
    client->phase = COE_DOWNLOAD_SEGMENT;
    uint8_t *body = start_message(client);
    body[2] = (uint8_t)(REQUEST_DOWNLOAD_SEGMENT | (client->toggle ? BIT_TOGGLE : 0) | unused << 1 |
                        (bytes == rest ? BIT_LAST : 0));
    memcpy(body + SEGMENT_HEADER, (const uint8_t *)client->sdo->data + client->done, bytes);
    client->done += bytes;
    send_message(client, SEGMENT_HEADER + bytes + unused);
}

static void request_information(cm1e_coe_client_t *client)
{
    const cm1e_info_request_t *info = client->info;
    client->phase = COE_INFORMATION;
    uint8_t *body = start_message(client);
    cm1e_put_u16(body, SERVICE_SDO_INFORMATION << 12);
    body[2] = (uint8_t)info->kind;
    cm1e_put_u16(body + INFO_HEADER, info->index);
    body[INFO_HEADER + 2] = info->subindex;
    body[INFO_HEADER + 3] = info->values;
    send_message(client, INFO_HEADER + (info->kind == INFO_ENTRY ? 4u : 2u));
}

static void request_abort(cm1e_coe_client_t *client, cm1e_error_t failure)
{
    client->phase = COE_ABORT;
    client->failure = failure;
    uint8_t *body = start_message(client);
    body[2] = SDO_ABORT;
    cm1e_put_u16(body + 3, client->abort.index);
    body[5] = client->abort.subindex;
    cm1e_put_u32(body + 6, client->abort.code);
    send_message(client, SDO_BYTES);
}

/** Gives the transfer up while there is time to tell the slave: it ends when the abort is delivered. */
static void abandon(cm1e_coe_client_t *client, cm1e_error_t error, uint32_t abort_code)
{
    if (!is_transfer(client)) {
        give_up(client, error);
        return;
    }
    distrust(client);
    owe_abort(client, abort_code);
    request_abort(client, error);
}

static bool has_mailbox(const cm1e_coe_client_t *client)
{
    const cm1e_mailbox_t *mailbox = &client->mailbox;
    return mailbox->in_length >= CM1E_MAILBOX_HEADER + SDO_BYTES && mailbox->in_length <= CM1E_DATAGRAM_MAX &&
           mailbox->out_length >= CM1E_MAILBOX_HEADER + SDO_BYTES && mailbox->out_length <= CM1E_DATAGRAM_MAX;
}

static void start_transfer(cm1e_coe_client_t *client)
{
    if (client->info)
        request_information(client);
    else if (client->sdo->write)
        request_download(client);
    else
        request_upload(client);
}

static void begin(cm1e_coe_client_t *client, int64_t timeout_ns, int64_t now_ns)
{
    client->deadline_ns = timeout_ns < INT64_MAX - now_ns ? now_ns + timeout_ns : INT64_MAX;
    client->done = client->total = 0;
    client->toggle = false;
    client->discarded = 0;
    client->mailbox_error = 0;
    if (!has_mailbox(client))
        finish(client, CM1E_ERROR_UNSUPPORTED, 0);
    else if (client->abort.owed)
        request_abort(client, CM1E_OK);
    else if (client->doubtful)
        start_fence(client);
    else
        start_transfer(client);
}

/** An abort has no answer; the next message may be the link layer's refusal of the abort. */
static void after_abort(cm1e_coe_client_t *client)
{
    client->abort.owed = false;
    client->abort_sent = true;
    if (client->failure != CM1E_OK)
        finish(client, client->failure, 0);
    else
        start_fence(client);
}

void cm1e_coe_begin(cm1e_coe_client_t *client, cm1e_sdo_t *sdo, int64_t now_ns)
{
    client->sdo = sdo;
    begin(client, sdo->timeout_ns > 0 ? sdo->timeout_ns : DEFAULT_TIMEOUT_NS, now_ns);
}

void cm1e_coe_begin_info(cm1e_coe_client_t *client, cm1e_info_request_t *info, int64_t now_ns)
{
    info->taken = 0;
    info->fragments_left = 0;
    info->done = false;
    client->info = info;
    begin(client, INFO_TIMEOUT_NS, now_ns);
}

void cm1e_coe_listen(cm1e_coe_client_t *client, int64_t now_ns)
{
    if (!has_mailbox(client))
        return;
    client->deadline_ns = now_ns + LISTEN_NS;
    client->discarded = 0;
    client->phase = COE_LISTEN;
    cm1e_mailbox_listen(&client->mailbox);
}

/* ---- answers --------------------------------------------------------------------------------------------------- */

static void discard(cm1e_coe_client_t *client)
{
    if (++client->discarded >= DISCARD_LIMIT)
        give_up(client, CM1E_ERROR_BUS_MAILBOX);
}

/** Whether index and sub-index of an answer are the requested ones. */
static bool addressed(const cm1e_coe_client_t *client, const uint8_t *body)
{
    return cm1e_get_u16(body + 3) == client->awaited_index && body[5] == client->awaited_subindex;
}

static void take_expedited(cm1e_coe_client_t *client, const uint8_t *body)
{
    cm1e_sdo_t *sdo = client->sdo;
    const bool size_given = body[2] & BIT_SIZE_GIVEN;
    size_t bytes = size_given ? 4u - (body[2] >> 2 & 3u) : 4u;
    if (!size_given && bytes > sdo->size)
        bytes = sdo->size; /* the slave does not say how many of the four bytes are valid */
    if (bytes > sdo->size) {
        finish(client, CM1E_ERROR_INVALID_ARGUMENT, 0);
        return;
    }
    if (bytes)
        memcpy(sdo->data, body + 6, bytes);
    sdo->size = bytes;
    finish(client, CM1E_OK, 0);
}

static void on_upload(cm1e_coe_client_t *client, const uint8_t *body, size_t size)
{
    cm1e_sdo_t *sdo = client->sdo;
    if ((body[2] & SPECIFIER_MASK) != RESPONSE_UPLOAD) {
        abandon(client, CM1E_ERROR_BUS_MAILBOX, ABORT_COMMAND);
        return;
    }
    if (body[2] & BIT_EXPEDITED) {
        take_expedited(client, body);
        return;
    }
    client->total = cm1e_get_u32(body + 6);
    if (client->total > sdo->size) {
        abandon(client, CM1E_ERROR_INVALID_ARGUMENT, ABORT_NO_MEMORY); /* the caller's buffer is too small */
        return;
    }
    const size_t given = size - SDO_BYTES;
    client->done = given < client->total ? given : client->total;
    if (client->done)
        memcpy(sdo->data, body + SDO_BYTES, client->done);
    if (client->done < client->total) {
        request_upload_segment(client);
        return;
    }
    sdo->size = client->total;
    finish(client, CM1E_OK, 0);
}

static void on_upload_segment(cm1e_coe_client_t *client, const uint8_t *body, size_t size)
{
    const bool toggle = body[2] & BIT_TOGGLE, last = body[2] & BIT_LAST;
    const size_t bytes = size == SDO_BYTES ? SEGMENT_MIN_DATA - (body[2] >> 1 & 7u) : size - SEGMENT_HEADER;
    if ((body[2] & SPECIFIER_MASK) != RESPONSE_UPLOAD_SEGMENT || toggle != client->toggle ||
        bytes > client->total - client->done || (bytes == 0 && !last)) {
        abandon(client, CM1E_ERROR_BUS_MAILBOX, toggle != client->toggle ? ABORT_TOGGLE : ABORT_COMMAND);
        return;
    }
    memcpy((uint8_t *)client->sdo->data + client->done, body + SEGMENT_HEADER, bytes);
    client->done += bytes;
    client->toggle = !client->toggle;
    if (!last) {
        request_upload_segment(client);
    } else if (client->done != client->total) {
        abandon(client, CM1E_ERROR_BUS_MAILBOX, ABORT_GENERAL); /* less data than announced is an error */
    } else {
        client->sdo->size = client->total;
        finish(client, CM1E_OK, 0);
    }
}

static void after_download(cm1e_coe_client_t *client)
{
    if (client->done < client->total)
        request_download_segment(client);
    else
        finish(client, CM1E_OK, 0);
}

static void on_download(cm1e_coe_client_t *client, const uint8_t *body)
{
    if ((body[2] & SPECIFIER_MASK) != RESPONSE_DOWNLOAD)
        abandon(client, CM1E_ERROR_BUS_MAILBOX, ABORT_COMMAND);
    else
        after_download(client);
}

static void on_download_segment(cm1e_coe_client_t *client, const uint8_t *body)
{
    const bool toggle = body[2] & BIT_TOGGLE;
    if ((body[2] & SPECIFIER_MASK) != RESPONSE_DOWNLOAD_SEGMENT || toggle != client->toggle) {
        abandon(client, CM1E_ERROR_BUS_MAILBOX, toggle != client->toggle ? ABORT_TOGGLE : ABORT_COMMAND);
        return;
    }
    client->toggle = !client->toggle;
    after_download(client);
}

static void on_emergency(cm1e_coe_client_t *client, const uint8_t *body, size_t size)
{
    if (size < COE_HEADER + 8)
        return;
    client->emergency.code = cm1e_get_u16(body + 2);
    client->emergency.error_register = body[4];
    memcpy(client->emergency.data, body + 5, sizeof client->emergency.data);
    client->emergency.number++;
}

bool cm1e_coe_take_emergency(cm1e_coe_client_t *client, const uint8_t *message)
{
    const size_t size = cm1e_get_u16(message);
    const uint8_t *body = message + CM1E_MAILBOX_HEADER;
    const bool is_one = (message[5] & 0x0F) == MAILBOX_TYPE_COE && size >= COE_HEADER &&
                        cm1e_get_u16(body) >> 12 == SERVICE_EMERGENCY;
    if (is_one)
        on_emergency(client, body, size);
    return is_one;
}

/** Nothing of an earlier transfer can follow. */
static void on_fence(cm1e_coe_client_t *client)
{
    client->doubtful = client->abort_sent = false;
    start_transfer(client);
}

static void on_abort(cm1e_coe_client_t *client, const uint8_t *body)
{
    if (!addressed(client, body))
        discard(client);
    else if (client->phase == COE_FENCE)
        on_fence(client); /* an abort is an answer, too */
    else
        finish(client, CM1E_ERROR_SDO_ABORT, cm1e_get_u32(body + 6));
}

/** An SDO answer of at least SDO_BYTES. */
static void on_sdo(cm1e_coe_client_t *client, const uint8_t *body, size_t size)
{
    if (!is_segmented(client) && !addressed(client, body))
        discard(client); /* of an earlier transfer */
    else if (client->phase == COE_FENCE)
        on_fence(client);
    else if (client->phase == COE_UPLOAD)
        on_upload(client, body, size);
    else if (client->phase == COE_UPLOAD_SEGMENT)
        on_upload_segment(client, body, size);
    else if (client->phase == COE_DOWNLOAD)
        on_download(client, body);
    else if (client->phase == COE_DOWNLOAD_SEGMENT)
        on_download_segment(client, body);
}

/** The first fragment says what it is about: the list, the object, the object with its sub-index. */
static bool is_answer(const cm1e_info_request_t *info, const uint8_t *data, size_t size)
{
    return size >= (info->kind == INFO_ENTRY ? 3u : 2u) && cm1e_get_u16(data) == info->index &&
           (info->kind != INFO_ENTRY || data[2] == info->subindex);
}

/** The count of the slave says how many fragments follow; not all slaves set the corresponding bit. */
static void on_fragment(cm1e_coe_client_t *client, const uint8_t *data, size_t size, uint16_t left, bool incomplete)
{
    cm1e_info_request_t *info = client->info;
    const bool first = info->taken == 0;
    if (first && !is_answer(info, data, size)) {
        discard(client);
    } else if ((!first && left + 1 != info->fragments_left) || (left == 0 && incomplete) || size == 0) {
        give_up(client, CM1E_ERROR_BUS_MAILBOX);
    } else if (size > info->size - info->taken) {
        give_up(client, CM1E_ERROR_INVALID_ARGUMENT); /* more than there is room for */
    } else {
        memcpy(info->answer + info->taken, data, size);
        info->taken += size;
        info->fragments_left = left;
        if (left == 0)
            finish(client, CM1E_OK, 0);
    }
}

static void on_information(cm1e_coe_client_t *client, const uint8_t *body, size_t size)
{
    if (size < INFO_HEADER) {
        give_up(client, CM1E_ERROR_BUS_MAILBOX);
        return;
    }
    const unsigned opcode = body[2] & INFO_OPCODE;
    if (opcode == client->info->kind + 1u)
        on_fragment(client, body + INFO_HEADER, size - INFO_HEADER, cm1e_get_u16(body + 4), body[2] & INFO_INCOMPLETE);
    else if (opcode != INFO_ERROR)
        discard(client);
    else if (size < INFO_HEADER + 4)
        give_up(client, CM1E_ERROR_BUS_MAILBOX);
    else
        finish(client, CM1E_ERROR_SDO_ABORT, cm1e_get_u32(body + INFO_HEADER));
}

static void on_coe(cm1e_coe_client_t *client, const uint8_t *body, size_t size)
{
    const unsigned service = size >= COE_HEADER ? cm1e_get_u16(body) >> 12 : 0;
    if (service == SERVICE_EMERGENCY) {
        on_emergency(client, body, size);
        discard(client);
    } else if (awaits_nothing(client)) {
        discard(client);
    } else if (client->phase == COE_INFORMATION) {
        if (service == SERVICE_SDO_INFORMATION)
            on_information(client, body, size);
        else
            discard(client); /* of an earlier transfer */
    } else if (service != SERVICE_SDO_REQUEST && service != SERVICE_SDO_RESPONSE) {
        discard(client);
    } else if (size < SDO_BYTES) {
        abandon(client, CM1E_ERROR_BUS_MAILBOX, ABORT_COMMAND);
    } else if ((body[2] & SPECIFIER_MASK) == SDO_ABORT) {
        on_abort(client, body);
    } else if (service == SERVICE_SDO_REQUEST) {
        discard(client); /* the only request of a slave is an abort */
    } else {
        on_sdo(client, body, size);
    }
}

/** The link layer of the slave refused a message: the request, or an abort that it does not accept. */
static void on_mailbox_error(cm1e_coe_client_t *client, const uint8_t *body, size_t size)
{
    if (awaits_nothing(client) || (client->phase == COE_FENCE && client->abort_sent)) {
        client->abort_sent = false;
        discard(client);
        return;
    }
    client->mailbox_error = size >= 4 ? cm1e_get_u16(body + 2) : 0;
    if (is_segmented(client)) {
        abandon(client, CM1E_ERROR_BUS_MAILBOX, ABORT_GENERAL);
    } else {
        distrust(client);
        finish(client, CM1E_ERROR_BUS_MAILBOX, 0);
    }
}

static void on_message(cm1e_coe_client_t *client, const uint8_t *message)
{
    const size_t size = cm1e_get_u16(message);
    const uint8_t *body = message + CM1E_MAILBOX_HEADER;
    const uint8_t type = message[5] & 0x0F;
    if (size > (size_t)(client->mailbox.in_length - CM1E_MAILBOX_HEADER)) {
        abandon(client, CM1E_ERROR_BUS_MAILBOX, ABORT_COMMAND);
    } else if (type == MAILBOX_TYPE_COE) {
        on_coe(client, body, size);
    } else if (type == MAILBOX_TYPE_ERROR) {
        on_mailbox_error(client, body, size);
    } else {
        discard(client);
    }
}

/* ---- one datagram at a time ------------------------------------------------------------------------------------ */

void cm1e_coe_expire(cm1e_coe_client_t *client, int64_t now_ns)
{
    if (!cm1e_coe_idle(client) && now_ns >= client->deadline_ns)
        give_up(client, CM1E_ERROR_TIMEOUT);
}

bool cm1e_coe_next(cm1e_coe_client_t *client, cm1e_datagram_t *datagram, int64_t now_ns)
{
    cm1e_coe_expire(client, now_ns);
    return !cm1e_coe_idle(client) && cm1e_mailbox_next(&client->mailbox, datagram);
}

/** After a look that found the mailbox empty, or was lost. */
static bool has_listened(const cm1e_coe_client_t *client, bool looked)
{
    return client->mailbox.state == MAILBOX_POLL && (looked || client->discarded >= LISTEN_LIMIT);
}

void cm1e_coe_result(cm1e_coe_client_t *client, const cm1e_datagram_t *datagram, int64_t now_ns)
{
    if (datagram->working_counter == DATAGRAM_LOST)
        client->lost_frames++;
    if (cm1e_coe_idle(client))
        return; /* ended while the datagram was on its way */
    const bool looked = client->mailbox.state == MAILBOX_POLL;
    if (cm1e_mailbox_result(&client->mailbox, datagram))
        on_message(client, datagram->data);
    if (client->phase == COE_ABORT && cm1e_mailbox_delivered(&client->mailbox))
        after_abort(client);
    else if (client->phase == COE_DRAIN && cm1e_mailbox_drained(&client->mailbox))
        request_fence(client);
    else if (client->phase == COE_LISTEN && has_listened(client, looked))
        finish(client, CM1E_OK, 0);
    cm1e_coe_expire(client, now_ns);
}

/* ---- a look beside the client ------------------------------------------------------------------------------------ */

bool cm1e_coe_look(const cm1e_coe_client_t *client, cm1e_datagram_t *datagram)
{
    if (!has_mailbox(client))
        return false;
    cm1e_mailbox_look(&client->mailbox, datagram);
    return true;
}

bool cm1e_coe_has_mail(const cm1e_datagram_t *datagram)
{
    return datagram->working_counter == 1 && cm1e_mailbox_is_full(datagram);
}

void cm1e_coe_fetch(cm1e_coe_client_t *client, const cm1e_datagram_t *datagram, int64_t now_ns)
{
    cm1e_coe_listen(client, now_ns);
    cm1e_coe_result(client, datagram, now_ns);
}
