#include "drive/drive_cml.h"

#include <string.h>

#include "core/clock.h"
#include "device/bridge_facts.h"
#include "device/bridge_status.h"

enum { DRAIN_MOST = 64 };

static const int64_t look_ns = 2 * MS_IN_NS;  /* "more than 1 msec" (BR appendix 2.1) */
static const int64_t line_ns = 10 * MS_IN_NS; /* between the lines of a list (2.5) */
static const int64_t unknown_ns = 50 * MS_IN_NS; /* a motor that has not answered an unknown command then never will */
static const int64_t prepare_ns = 2000 * MS_IN_NS;
static const int64_t answer_ns = 1000 * MS_IN_NS, search_ns = 70000 * MS_IN_NS;

static cm1e_drive_cml_request_t *request_of(cm1e_drive_cml_t *cml, uint32_t ticket)
{
    return &cml->requests[ticket % CM1E_DRIVE_CML_QUEUE];
}

/* No request has the ticket 0. */
static uint32_t ticket_after(uint32_t ticket) { return ticket == UINT32_MAX ? 1 : ticket + 1; }

void cm1e_drive_cml_init(cm1e_drive_cml_t *cml, uint16_t position, uint8_t channel,
                         cm1e_error_t (*submit)(void *context, cm1e_sdo_t *sdo), void *context)
{
    memset(cml, 0, sizeof *cml);
    cml->position = position;
    cml->channel = channel;
    cml->submit = submit;
    cml->context = context;
    cml->head = cml->next = ticket_after(0);
}

/* ---- requests ---------------------------------------------------------------------------------------------------- */

static bool is_search(const char *text)
{
    do
        if (cm1e_cml_next(&text).reply == CM1E_CML_SEARCH)
            return true;
    while (text);
    return false;
}

cm1e_error_t cm1e_drive_cml_send(cm1e_drive_cml_t *cml, const char *text, int64_t timeout_ns, uint32_t *ticket)
{
    *ticket = 0;
    if (timeout_ns < 0 || timeout_ns > CM1E_DRIVE_LONGEST_NS)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (cm1e_cml_check(text, cml->channel))
        return CM1E_ERROR_CML_STRING;
    if (cml->next - cml->head >= CM1E_DRIVE_CML_QUEUE)
        return CM1E_ERROR_FULL;
    cm1e_drive_cml_request_t *request = request_of(cml, cml->next);
    *request = (cm1e_drive_cml_request_t){.ticket = cml->next, .state = CM1E_DRIVE_CML_WAITING};
    request->timeout_ns = timeout_ns ? timeout_ns : is_search(text) ? search_ns : answer_ns;
    memcpy(request->text, text, strlen(text) + 1);
    *ticket = cml->next;
    cml->next = ticket_after(cml->next);
    return CM1E_OK;
}

const cm1e_drive_cml_request_t *cm1e_drive_cml_request(const cm1e_drive_cml_t *cml, uint32_t ticket)
{
    const cm1e_drive_cml_request_t *request = &cml->requests[ticket % CM1E_DRIVE_CML_QUEUE];
    return ticket != 0 && request->ticket == ticket ? request : NULL;
}

const char *cm1e_drive_cml_line(const cm1e_drive_cml_t *cml, uint32_t ticket, unsigned line)
{
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(cml, ticket);
    if (!request || line >= request->lines)
        return NULL;
    return line == 0 ? request->first : cml->lines_of == ticket ? cml->lines[line] : NULL;
}

static void finish(cm1e_drive_cml_t *cml, cm1e_error_t error)
{
    cm1e_drive_cml_request_t *request = request_of(cml, cml->head);
    request->state = error != CM1E_OK ? CM1E_DRIVE_CML_ERROR : CM1E_DRIVE_CML_DONE;
    request->error = error;
    request->abort_code = error == CM1E_ERROR_SDO_ABORT ? cml->sdo.abort_code : 0;
    cml->head = ticket_after(cml->head);
    cml->phase = CML_IDLE;
}

void cm1e_drive_cml_cancel(cm1e_drive_cml_t *cml, uint32_t ticket, cm1e_error_t error)
{
    cm1e_drive_cml_request_t *request = request_of(cml, ticket);
    if (ticket == 0 || request->ticket != ticket)
        return;
    if (request->state == CM1E_DRIVE_CML_ACTIVE) {
        finish(cml, error); /* a transfer under way comes to its end, and is not looked at */
    } else if (request->state == CM1E_DRIVE_CML_WAITING) {
        request->state = CM1E_DRIVE_CML_ERROR;
        request->error = error;
    }
}

void cm1e_drive_cml_cancel_all(cm1e_drive_cml_t *cml, cm1e_error_t error)
{
    const uint32_t end = cml->next;
    for (uint32_t ticket = cml->head; ticket != end; ticket = ticket_after(ticket))
        cm1e_drive_cml_cancel(cml, ticket, error);
}

const char *cm1e_drive_cml_motor_free(const cm1e_drive_cml_t *cml, char text[8])
{
    memcpy(text, ").1", 4);
    text[2] = (char)('0' + cml->channel);
    return text;
}

/* ---- what comes back --------------------------------------------------------------------------------------------- */

static void copy_line(char to[CM1E_CML_BYTES + 1], const char *line, size_t size)
{
    const size_t most = size < CM1E_CML_BYTES ? size : CM1E_CML_BYTES;
    for (size_t i = 0; i < most; i++)
        to[i] = line[i] >= ' ' && line[i] <= '~' ? line[i] : '?';
    to[most] = '\0';
}

static void keep_line(cm1e_drive_cml_t *cml, const char *line, size_t size)
{
    cm1e_drive_cml_request_t *request = request_of(cml, cml->head);
    if (request->lines == CM1E_CML_LINES) {
        request->lost++;
        return;
    }
    if (request->lines == 0)
        copy_line(request->first, line, size);
    copy_line(cml->lines[request->lines++], line, size);
}

static void set_aside(cm1e_drive_cml_t *cml, const char *line, size_t size)
{
    request_of(cml, cml->head)->strays++;
    copy_line(cml->stray, line, size);
}

/* Returns the index of the command that this line answers, among those whose answer is missing; -1: none. A motor may
 * be set to report its state by itself: the state "it moves" does not end a search. */
static int answered(const cm1e_drive_cml_t *cml, const cm1e_cml_answer_t *answer)
{
    for (unsigned i = 0; i < cml->command_count; i++) {
        const cm1e_cml_command_t *command = &cml->commands[i];
        const bool moving = command->reply == CM1E_CML_SEARCH && answer->what == CM1E_CML_STATUS &&
                            cm1e_bridge_status_is_moving(CM1E_BRIDGE_CM1, (uint32_t)answer->value);
        if (cml->open >> i & 1 && cm1e_cml_answers(command, answer) && !moving &&
            (answer->what == CM1E_CML_TEXT || answer->id == cml->channel))
            return (int)i;
    }
    return -1;
}

/* Takes one line, with the characters that end it. Returns false if the request has ended. */
static bool take_line(cm1e_drive_cml_t *cml, const char *line, size_t size)
{
    cm1e_drive_cml_request_t *request = request_of(cml, cml->head);
    cm1e_cml_answer_t answer;
    const size_t length = strcspn(line, "\r\n");
    if (cm1e_cml_parse(&answer, line, size) != CM1E_OK) {
        copy_line(request->first, line, length);
        finish(cml, CM1E_ERROR_CML_ANSWER);
        return false;
    }
    if (answer.what == CM1E_CML_NOTHING)
        return true;
    if (strlen(request->text) == length && memcmp(request->text, line, length) == 0)
        return true; /* a motor that echoes (K23) */
    const int index = answered(cml, &answer);
    if (index < 0) {
        set_aside(cml, line, length);
        return true;
    }
    const cm1e_cml_reply_t reply = cml->commands[index].reply;
    if (reply != CM1E_CML_LIST && reply != CM1E_CML_UNKNOWN)
        cml->open &= ~(1u << index);
    keep_line(cml, line, length);
    cml->deadline_ns = cml->now_ns + request->timeout_ns;
    if (reply == CM1E_CML_SEARCH && answer.what == CM1E_CML_STATUS) {
        finish(cml, CM1E_ERROR_CM_SEARCH);
        return false;
    }
    return true;
}

/* Whether the answer of one line to a command is still missing. */
static bool incomplete(const cm1e_drive_cml_t *cml)
{
    for (unsigned i = 0; i < cml->command_count; i++)
        if (cml->open >> i & 1 && cml->commands[i].reply != CM1E_CML_LIST &&
            cml->commands[i].reply != CM1E_CML_UNKNOWN)
            return true;
    return false;
}

static void look_again(cm1e_drive_cml_t *cml, int64_t wait_ns)
{
    cml->phase = CML_WAIT;
    cml->due_ns = cml->now_ns + wait_ns;
}

/* Ends what was read with a 0. true: the bridge had nothing. */
static bool end_data(cm1e_drive_cml_t *cml)
{
    const size_t size = strnlen(cml->data, cml->sdo.size);
    cm1e_cml_answer_t answer;
    const bool nothing = cm1e_cml_parse(&answer, cml->data, size) == CM1E_OK && answer.what == CM1E_CML_NOTHING;
    cml->data[size] = '\0';
    return nothing;
}

static void received(cm1e_drive_cml_t *cml)
{
    const bool nothing = end_data(cml);
    for (const char *line = cml->data; !nothing && *line;) {
        size_t whole = strcspn(line, "\r\n");
        whole += strspn(line + whole, "\r\n");
        if (!take_line(cml, line, whole))
            return;
        line += whole;
    }
    const bool answered_so_far = request_of(cml, cml->head)->lines > 0 || !cml->list;
    if (!incomplete(cml) && !cml->list && !cml->unknown)
        finish(cml, CM1E_OK);
    else if (nothing && !incomplete(cml) && answered_so_far)
        finish(cml, CM1E_OK);
    else if (cml->now_ns >= cml->deadline_ns)
        finish(cml, is_search(request_of(cml, cml->head)->text) ? CM1E_ERROR_CM_SEARCH_TIMEOUT
                                                                : CM1E_ERROR_CML_TIMEOUT);
    else
        look_again(cml, !nothing && (cml->list || cml->unknown) ? line_ns : look_ns);
}

/* ---- what goes out ----------------------------------------------------------------------------------------------- */

/* A full queue is tried again in the next step, until it is too late. */
static void submit(cm1e_drive_cml_t *cml, bool write, cm1e_drive_cml_phase_t phase)
{
    const uint16_t first = write ? OBJ_F581_CML_COMMAND_AXIS_1 : OBJ_F591_CML_RESPONSE_AXIS_1;
    cm1e_drive_cml_request_t *request = request_of(cml, cml->head);
    cml->sdo = (cm1e_sdo_t){.position = cml->position, .index = (uint16_t)(first + cml->channel - 1), .write = write,
                            .data = cml->data, .size = write ? strlen(request->text) : sizeof cml->data - 1};
    if (write)
        memcpy(cml->data, request->text, cml->sdo.size);
    const cm1e_error_t error = cml->submit(cml->context, &cml->sdo);
    if (error == CM1E_OK) {
        cml->phase = phase;
        cml->submitted = true;
        request->sent = request->sent || write;
    } else if (error != CM1E_ERROR_FULL || cml->now_ns >= cml->deadline_ns) {
        finish(cml, error);
    }
}

static void begin(cm1e_drive_cml_t *cml)
{
    cm1e_drive_cml_request_t *request = request_of(cml, cml->head);
    if (request->state != CM1E_DRIVE_CML_WAITING) { /* cancelled meanwhile */
        cml->head = ticket_after(cml->head);
        return;
    }
    request->state = CM1E_DRIVE_CML_ACTIVE;
    cml->phase = CML_PREPARE;
    cml->deadline_ns = cml->now_ns + prepare_ns;
    cml->lines_of = request->ticket;
    cml->stray[0] = '\0';
    cml->open = cml->command_count = cml->drained = 0;
    cml->list = cml->unknown = false;
    for (const char *text = request->text; text && cml->command_count < CM1E_CML_COMMANDS; cml->command_count++) {
        const cm1e_cml_command_t command = cm1e_cml_next(&text);
        cml->commands[cml->command_count] = command;
        cml->open |= (uint32_t)(command.reply != CM1E_CML_SILENT) << cml->command_count;
        cml->list = cml->list || command.reply == CM1E_CML_LIST;
        cml->unknown = cml->unknown || command.reply == CM1E_CML_UNKNOWN;
    }
}

static void drained(cm1e_drive_cml_t *cml)
{
    const bool nothing = end_data(cml);
    if (!nothing)
        set_aside(cml, cml->data, strcspn(cml->data, "\r\n"));
    cml->phase = nothing || ++cml->drained == DRAIN_MOST ? CML_SEND : CML_PREPARE;
}

static void sent(cm1e_drive_cml_t *cml)
{
    const cm1e_drive_cml_request_t *request = request_of(cml, cml->head);
    const int64_t pace_ns = strlen(request->text) < CM1E_BRIDGE_CML_LONG_BYTES ? CM1E_BRIDGE_CML_SHORT_NS
                                                                                     : CM1E_BRIDGE_CML_LONG_NS;
    cml->free_ns = cml->now_ns + pace_ns;
    cml->deadline_ns = cml->now_ns + request->timeout_ns;
    if (cml->open == 0)
        finish(cml, CM1E_OK);
    else
        look_again(cml, cml->unknown ? unknown_ns : look_ns);
}

/* Called when a transfer has ended. */
static void transferred(cm1e_drive_cml_t *cml)
{
    const bool failed = cm1e_sdo_state(&cml->sdo) == CM1E_SDO_ERROR;
    cml->submitted = false;
    if (cml->phase == CML_IDLE) { /* cancelled meanwhile */
        cml->free_ns = cml->sdo.write ? cml->now_ns + CM1E_BRIDGE_CML_LONG_NS : cml->free_ns;
        return;
    }
    if (failed)
        finish(cml, cml->sdo.error);
    else if (cml->phase == CML_DRAIN)
        drained(cml);
    else if (cml->phase == CML_SEND)
        sent(cml);
    else
        received(cml);
}

static void advance(cm1e_drive_cml_t *cml, bool ready)
{
    switch (cml->phase) {
    case CML_PREPARE:
        if (ready)
            submit(cml, false, CML_DRAIN);
        else if (cml->now_ns >= cml->deadline_ns)
            finish(cml, CM1E_ERROR_DRIVE_MODE_TIMEOUT);
        break;
    case CML_SEND:
        if (cml->now_ns >= cml->free_ns)
            submit(cml, true, CML_SEND);
        break;
    case CML_WAIT:
        if (cml->now_ns >= cml->due_ns)
            submit(cml, false, CML_RECEIVE);
        break;
    default: break;
    }
}

void cm1e_drive_cml_step(cm1e_drive_cml_t *cml, int64_t now_ns, bool ready)
{
    cml->now_ns = now_ns;
    if (cml->submitted) {
        if (cm1e_sdo_state(&cml->sdo) == CM1E_SDO_BUSY)
            return;
        transferred(cml);
    }
    if (cml->phase == CML_IDLE && cml->head != cml->next)
        begin(cml);
    if (cml->phase > CML_PREPARE && !ready)
        finish(cml, CM1E_ERROR_DRIVE_MODE_LOST);
    else
        advance(cml, ready);
}
