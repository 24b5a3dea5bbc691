#include "sim/foe_server.h"

#include <string.h>

#include "core/bytes.h"
#include "sim/esc_chip.h"

enum { FOE_READ = 1, FOE_WRITE, FOE_DATA, FOE_ACK, FOE_ERROR, FOE_BUSY };
/* Opcode, reserved, then the password, the number of the packet or the error code. */
enum { HEADER_BYTES = 6, BUSY_BYTES = 6, NAME_BYTES = 64, BUSY_ENTIRE = 100 };

static void begin_answer(mailbox_message_t *answer, uint8_t opcode, uint32_t value)
{
    answer->type = MAILBOX_TYPE_FOE;
    answer->length = HEADER_BYTES;
    answer->data[0] = opcode;
    answer->data[1] = 0;
    cm1e_put_u32(answer->data + 2, value);
}

static void answer_error(mailbox_message_t *answer, uint32_t code, const char *text)
{
    begin_answer(answer, FOE_ERROR, code);
    memcpy(answer->data + HEADER_BYTES, text, strlen(text));
    answer->length = (uint16_t)(HEADER_BYTES + strlen(text));
}

static const char *text_of(uint32_t code)
{
    switch (code) {
    case FOE_CODE_NOT_FOUND: return "no such file";
    case FOE_CODE_DISK_FULL: return "no room for it";
    case FOE_CODE_ACCESS_DENIED: return "wrong password";
    case FOE_CODE_PACKET_NUMBER: return "wrong packet number";
    case FOE_CODE_BOOTSTRAP_ONLY: return "in Bootstrap only";
    case FOE_CODE_INVALID_FIRMWARE: return "not a firmware of this device";
    case FOE_CODE_FILE_INCOMPATIBLE: return "the file ends too early";
    default: return "";
    }
}

void cm1e_sim_foe_refuse(mailbox_message_t *answer)
{
    answer_error(answer, FOE_CODE_BOOTSTRAP_ONLY, text_of(FOE_CODE_BOOTSTRAP_ONLY));
}

void cm1e_sim_foe_reset(cm1e_sim_slave_t *slave) { slave->foe = (foe_server_t){0}; }

/** What the application has said of a request: goes on with the packet, wants it again later, or ends the file. */
static void answer_result(cm1e_sim_slave_t *slave, mailbox_message_t *answer, uint32_t result, uint32_t packet)
{
    foe_server_t *foe = &slave->foe;
    if (result == FOE_RESULT_SILENT)
        return;
    if (result == FOE_RESULT_BUSY) {
        begin_answer(answer, FOE_BUSY, BUSY_ENTIRE << 16);
        answer->length = BUSY_BYTES;
    } else if (result != 0) {
        foe->open = false;
        answer_error(answer, result, text_of(result));
    } else {
        foe->packet = packet;
        begin_answer(answer, FOE_ACK, packet);
    }
}

static void write_request(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer)
{
    char name[NAME_BYTES] = "";
    const size_t given = length - HEADER_BYTES, bytes = given < sizeof name - 1 ? given : sizeof name - 1;
    memcpy(name, request + HEADER_BYTES, bytes);
    const uint32_t result = slave->ops->file_begin(slave->app, name, cm1e_get_u32(request + 2));
    slave->foe = (foe_server_t){.open = result == 0};
    answer_result(slave, answer, result, 0);
}

static void data_request(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                         size_t room)
{
    foe_server_t *foe = &slave->foe;
    const uint32_t packet = cm1e_get_u32(request + 2);
    const size_t size = length - HEADER_BYTES;
    const bool last = length < room;
    if (!foe->open || packet != foe->packet + 1) {
        foe->open = false;
        answer_error(answer, FOE_CODE_PACKET_NUMBER, text_of(FOE_CODE_PACKET_NUMBER));
        return;
    }
    const uint32_t result =
        slave->ops->file_data(slave->app, foe->received, request + HEADER_BYTES, size, last);
    if (result == 0) {
        foe->received += size;
        foe->open = !last;
    }
    answer_result(slave, answer, result, packet);
}

/** The packet behind the last one that was acknowledged; a busy application is asked again with the next request. */
static void answer_packet(cm1e_sim_slave_t *slave, mailbox_message_t *answer, size_t room)
{
    foe_server_t *foe = &slave->foe;
    size_t size = room - HEADER_BYTES;
    begin_answer(answer, FOE_DATA, foe->packet + 1);
    const uint32_t result = slave->ops->file_read(slave->app, foe->name, foe->password, foe->received,
                                                  answer->data + HEADER_BYTES, &size);
    if (result != 0) {
        answer->length = 0;
        answer_result(slave, answer, result, 0);
        foe->reading = foe->reading && result == FOE_RESULT_BUSY;
        return;
    }
    foe->packet++;
    foe->received += size;
    foe->ended = size < room - HEADER_BYTES;
    answer->length = (uint16_t)(HEADER_BYTES + size);
}

static void read_request(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                         size_t room)
{
    foe_server_t *foe = &slave->foe;
    const size_t given = length - HEADER_BYTES, bytes = given < sizeof foe->name - 1 ? given : sizeof foe->name - 1;
    *foe = (foe_server_t){.reading = slave->ops->file_read != NULL, .password = cm1e_get_u32(request + 2)};
    memcpy(foe->name, request + HEADER_BYTES, bytes);
    if (foe->reading)
        answer_packet(slave, answer, room);
    else
        answer_error(answer, FOE_CODE_NOT_FOUND, text_of(FOE_CODE_NOT_FOUND));
}

static void acknowledged(cm1e_sim_slave_t *slave, const uint8_t *request, mailbox_message_t *answer, size_t room)
{
    foe_server_t *foe = &slave->foe;
    if (!foe->reading || cm1e_get_u32(request + 2) != foe->packet) {
        foe->reading = false;
        answer_error(answer, FOE_CODE_PACKET_NUMBER, text_of(FOE_CODE_PACKET_NUMBER));
    } else if (foe->ended) {
        foe->reading = false;
    } else {
        answer_packet(slave, answer, room);
    }
}

void cm1e_sim_foe_request(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                          size_t room, size_t answer_room)
{
    if (length < HEADER_BYTES) {
        answer_error(answer, FOE_CODE_ILLEGAL, "too short");
        return;
    }
    const bool asks = request[0] == FOE_READ || request[0] == FOE_WRITE;
    if (asks && (slave->foe.open || (slave->foe.reading && slave->foe.packet > 0))) { /* as SOES does */
        slave->foe.open = slave->foe.reading = false;
        answer_error(answer, FOE_CODE_ILLEGAL, "another file is open");
        return;
    }
    switch (request[0]) {
    case FOE_WRITE: write_request(slave, request, length, answer); break;
    case FOE_DATA: data_request(slave, request, length, answer, room); break;
    case FOE_READ: read_request(slave, request, length, answer, answer_room); break;
    case FOE_ACK: acknowledged(slave, request, answer, answer_room); break;
    case FOE_ERROR: slave->foe.open = slave->foe.reading = false; break; /* the master gives up: no answer */
    default: answer_error(answer, FOE_CODE_ILLEGAL, "unknown request"); break;
    }
}
