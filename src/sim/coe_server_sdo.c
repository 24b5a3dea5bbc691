#include <string.h>

#include "core/bytes.h"
#include "sim/coe_server.h"
#include "sim/esc_chip.h"

/* Layout behind the CoE header, command specifiers and flags (ETG.1000.6 5.6.2). */
enum {
    AT_COMMAND = 2, AT_INDEX = 3, AT_SUBINDEX = 5, AT_DATA = 6, AT_NORMAL_DATA = 10, AT_SEGMENT_DATA = 3,
    MESSAGE_BYTES = 10, SEGMENT_MIN_BYTES = 7, EXPEDITED_BYTES = 4,
};
enum {
    COMMAND_SHIFT = 5,
    REQUEST_DOWNLOAD_SEGMENT = 0, REQUEST_DOWNLOAD = 1, REQUEST_UPLOAD = 2, REQUEST_UPLOAD_SEGMENT = 3,
    REQUEST_ABORT = 4,
    RESPONSE_UPLOAD_SEGMENT = 0x00, RESPONSE_DOWNLOAD_SEGMENT = 0x20, RESPONSE_UPLOAD = 0x40, RESPONSE_DOWNLOAD = 0x60,
    COMMAND_ABORT = 0x80,
};
enum {
    SIZE_INDICATED = 0x01, EXPEDITED = 0x02, UNUSED_SHIFT = 2, UNUSED_MASK = 0x03, COMPLETE_ACCESS = 0x10,
    LAST_SEGMENT = 0x01, SEGMENT_UNUSED_SHIFT = 1, SEGMENT_UNUSED_MASK = 0x07, TOGGLE = 0x10,
};
enum { SDO_REQUEST = 2 << 12, SDO_RESPONSE = 3 << 12 };

typedef struct sdo {
    cm1e_sim_slave_t *slave;
    coe_server_t *coe;
    const uint8_t *request;
    size_t length;
    uint8_t command;
    uint16_t index;
    uint8_t subindex;
    bool complete_access;
    mailbox_message_t *answer;
    size_t room;
} sdo_t;

static void answer_begin(sdo_t *sdo, uint8_t command)
{
    uint8_t *data = sdo->answer->data;
    memset(data, 0, MESSAGE_BYTES);
    cm1e_put_u16(data, SDO_RESPONSE);
    data[AT_COMMAND] = command;
    cm1e_put_u16(data + AT_INDEX, sdo->index);
    data[AT_SUBINDEX] = sdo->subindex;
    sdo->answer->length = MESSAGE_BYTES;
}

/* An abort is sent as a request, and its command byte is exactly 0x80, which masters expect. */
static void answer_abort(sdo_t *sdo, uint32_t code)
{
    sdo->coe->transfer = COE_TRANSFER_NONE;
    answer_begin(sdo, COMMAND_ABORT);
    cm1e_put_u16(sdo->answer->data, SDO_REQUEST);
    cm1e_put_u32(sdo->answer->data + AT_DATA, cm1e_sim_slave_code(sdo->slave, CM1E_SIM_CODE_ABORT, code));
}

static void transfer_begin(sdo_t *sdo, enum coe_transfer transfer, size_t size, size_t done)
{
    coe_server_t *coe = sdo->coe;
    coe->transfer = transfer;
    coe->index = sdo->index;
    coe->subindex = sdo->subindex;
    coe->complete_access = sdo->complete_access;
    coe->toggle = false;
    coe->size = size;
    coe->done = done;
}

/* ---- download -------------------------------------------------------------------------------------------------- */

static void download_finish(sdo_t *sdo, const uint8_t *data, size_t size)
{
    sdo->coe->transfer = COE_TRANSFER_NONE;
    const uint32_t abort =
        cm1e_sim_coe_write(sdo->slave, sdo->index, sdo->subindex, sdo->complete_access, data, size);
    if (abort)
        answer_abort(sdo, abort);
    else
        answer_begin(sdo, (uint8_t)(RESPONSE_DOWNLOAD | (sdo->complete_access ? COMPLETE_ACCESS : 0)));
}

static void download_expedited(sdo_t *sdo)
{
    size_t size = EXPEDITED_BYTES;
    if (sdo->command & SIZE_INDICATED) {
        size -= sdo->command >> UNUSED_SHIFT & UNUSED_MASK;
    } else {
        /* The size is not said: that of the entry. */
        const cm1e_entry_t *entry = cm1e_sim_coe_entry(sdo->slave, sdo->index, sdo->subindex);
        if (entry && entry->bits <= 8 * EXPEDITED_BYTES)
            size = (entry->bits + 7u) / 8u;
    }
    download_finish(sdo, sdo->request + AT_DATA, size);
}

static void download(sdo_t *sdo)
{
    if (sdo->command & EXPEDITED) {
        download_expedited(sdo);
        return;
    }
    const uint32_t size = cm1e_get_u32(sdo->request + AT_DATA);
    const size_t here = sdo->length - AT_NORMAL_DATA;
    if (size <= here) {
        download_finish(sdo, sdo->request + AT_NORMAL_DATA, size);
        return;
    }
    const uint32_t refused =
        cm1e_sim_coe_check_write(sdo->slave, sdo->index, sdo->subindex, sdo->complete_access, size);
    if (refused) {
        answer_abort(sdo, refused);
        return;
    }
    memcpy(sdo->coe->data, sdo->request + AT_NORMAL_DATA, here);
    transfer_begin(sdo, COE_TRANSFER_DOWNLOAD, size, here);
    answer_begin(sdo, (uint8_t)(RESPONSE_DOWNLOAD | (sdo->complete_access ? COMPLETE_ACCESS : 0)));
}

/* A segment belongs to the transfer under way: its index is not repeated in the request. */
static bool segment_expected(sdo_t *sdo, enum coe_transfer transfer)
{
    coe_server_t *coe = sdo->coe;
    const bool under_way = coe->transfer == transfer;
    sdo->index = under_way ? coe->index : 0;
    sdo->subindex = under_way ? coe->subindex : 0;
    sdo->complete_access = under_way && coe->complete_access;
    if (!under_way) {
        answer_abort(sdo, SDO_ABORT_COMMAND);
        return false;
    }
    if (((sdo->command & TOGGLE) != 0) != coe->toggle) {
        answer_abort(sdo, SDO_ABORT_TOGGLE);
        return false;
    }
    coe->toggle = !coe->toggle;
    return true;
}

static void segment_answer(sdo_t *sdo, uint8_t command)
{
    memset(sdo->answer->data, 0, MESSAGE_BYTES);
    cm1e_put_u16(sdo->answer->data, SDO_RESPONSE);
    sdo->answer->data[AT_COMMAND] = command;
    sdo->answer->length = MESSAGE_BYTES;
}

static void download_segment(sdo_t *sdo)
{
    if (!segment_expected(sdo, COE_TRANSFER_DOWNLOAD))
        return;
    coe_server_t *coe = sdo->coe;
    size_t here = sdo->length - AT_SEGMENT_DATA;
    if (here == SEGMENT_MIN_BYTES)
        here -= sdo->command >> SEGMENT_UNUSED_SHIFT & SEGMENT_UNUSED_MASK;
    if (here > coe->size - coe->done) {
        answer_abort(sdo, SDO_ABORT_TOO_LONG);
        return;
    }
    memcpy(coe->data + coe->done, sdo->request + AT_SEGMENT_DATA, here);
    coe->done += here;
    if (sdo->command & LAST_SEGMENT) {
        if (coe->done < coe->size) {
            answer_abort(sdo, SDO_ABORT_TOO_SHORT);
            return;
        }
        download_finish(sdo, coe->data, coe->size);
        if (sdo->answer->data[AT_COMMAND] == COMMAND_ABORT)
            return;
    }
    segment_answer(sdo, (uint8_t)(RESPONSE_DOWNLOAD_SEGMENT | (sdo->command & TOGGLE)));
}

/* ---- upload ---------------------------------------------------------------------------------------------------- */

static void upload(sdo_t *sdo)
{
    coe_server_t *coe = sdo->coe;
    size_t size = sizeof coe->data;
    const uint32_t abort =
        cm1e_sim_coe_read(sdo->slave, sdo->index, sdo->subindex, sdo->complete_access, coe->data, &size);
    if (abort) {
        answer_abort(sdo, abort);
        return;
    }
    const uint8_t flags = (uint8_t)(RESPONSE_UPLOAD | SIZE_INDICATED | (sdo->complete_access ? COMPLETE_ACCESS : 0));
    uint8_t *data = sdo->answer->data;
    if (size > 0 && size <= EXPEDITED_BYTES) {
        answer_begin(sdo, (uint8_t)(flags | EXPEDITED | (EXPEDITED_BYTES - size) << UNUSED_SHIFT));
        memcpy(data + AT_DATA, coe->data, size);
        return;
    }
    const size_t fits = sdo->room - AT_NORMAL_DATA, here = size < fits ? size : fits;
    answer_begin(sdo, flags);
    cm1e_put_u32(data + AT_DATA, (uint32_t)size);
    memcpy(data + AT_NORMAL_DATA, coe->data, here);
    sdo->answer->length = (uint16_t)(AT_NORMAL_DATA + here);
    if (here < size)
        transfer_begin(sdo, COE_TRANSFER_UPLOAD, size, here);
}

static void upload_segment(sdo_t *sdo)
{
    if (!segment_expected(sdo, COE_TRANSFER_UPLOAD))
        return;
    coe_server_t *coe = sdo->coe;
    const size_t fits = sdo->room - AT_SEGMENT_DATA, left = coe->size - coe->done, here = left < fits ? left : fits;
    uint8_t command = (uint8_t)(RESPONSE_UPLOAD_SEGMENT | (sdo->command & TOGGLE));
    if (here == left)
        command |= LAST_SEGMENT;
    /* A segment has room for 7 bytes at least. */
    if (here < SEGMENT_MIN_BYTES)
        command |= (uint8_t)((SEGMENT_MIN_BYTES - here) << SEGMENT_UNUSED_SHIFT);
    segment_answer(sdo, command);
    memcpy(sdo->answer->data + AT_SEGMENT_DATA, coe->data + coe->done, here);
    sdo->answer->length = (uint16_t)(AT_SEGMENT_DATA + (here < SEGMENT_MIN_BYTES ? SEGMENT_MIN_BYTES : here));
    coe->done += here;
    if (here == left)
        coe->transfer = COE_TRANSFER_NONE;
}

void cm1e_sim_coe_sdo(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                      size_t room)
{
    sdo_t sdo = {
        .slave = slave, .coe = &slave->coe, .request = request, .length = length, .command = request[AT_COMMAND],
        .index = cm1e_get_u16(request + AT_INDEX), .subindex = request[AT_SUBINDEX],
        .complete_access = (request[AT_COMMAND] & COMPLETE_ACCESS) != 0, .answer = answer, .room = room,
    };
    switch (sdo.command >> COMMAND_SHIFT) {
    case REQUEST_DOWNLOAD:
        sdo.coe->transfer = COE_TRANSFER_NONE;
        download(&sdo);
        break;
    case REQUEST_UPLOAD:
        sdo.coe->transfer = COE_TRANSFER_NONE;
        upload(&sdo);
        break;
    case REQUEST_DOWNLOAD_SEGMENT:
        download_segment(&sdo);
        break;
    case REQUEST_UPLOAD_SEGMENT:
        upload_segment(&sdo);
        break;
    case REQUEST_ABORT:
        sdo.coe->transfer = COE_TRANSFER_NONE;
        break;
    default: /* block transfer does not exist over EtherCAT */
        answer_abort(&sdo, SDO_ABORT_COMMAND);
        break;
    }
}
