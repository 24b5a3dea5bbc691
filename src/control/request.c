#include "control/request.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cm1e/version.h"
#include "control/message.h"
#include "control/show.h"

enum { SDO_MAX = 1 << 15 };
#define PATIENCE_NS INT64_C(2000000000)
#define SDO_TIMEOUT_MAX_MS 60000

/* ---- replies ---------------------------------------------------------------------------------------------------- */

static json_t *with_id(json_t *reply, json_t *id)
{
    if (id)
        json_object_set(reply, "id", id);
    return reply;
}

json_t *cm1e_request_refuse(json_t *id, cm1e_error_t error, uint32_t foreign_code, const char *text)
{
    json_t *reply = json_pack("{s:b, s:{s:i, s:I, s:o}}", "ok", 0, "error", "code", (int)error, "foreign_code",
                              (json_int_t)foreign_code, "text", cm1e_show_text(text));
    return with_id(reply, id);
}

static json_t *accept(json_t *id, const char *name, json_t *value)
{
    return with_id(json_pack("{s:b, s:o}", "ok", 1, name, value), id);
}

static json_t *wrong(const control_request_t *request, const char *text)
{
    return cm1e_request_refuse(request->id, CM1E_ERROR_INVALID_ARGUMENT, 0, text);
}

/* ---- arguments -------------------------------------------------------------------------------------------------- */

/** A whole number; false: it is missing without a default, of another type or out of its range. */
static bool take_number(const json_t *message, const char *name, json_int_t minimum, json_int_t maximum,
                        json_int_t otherwise, json_int_t *value)
{
    const json_t *member = json_object_get(message, name);
    *value = member ? json_integer_value(member) : otherwise;
    return (!member || json_is_integer(member)) && *value >= minimum && *value <= maximum;
}

static int nibble(char c)
{
    static const char digits[] = "0123456789abcdef";
    const char *found = c ? strchr(digits, tolower((unsigned char)c)) : NULL;
    return found ? (int)(found - digits) : -1;
}

/** Bytes as hexadecimal digits; false: they are not. */
static bool take_bytes(const json_t *message, const char *name, uint8_t *bytes, size_t room, size_t *length)
{
    const char *text = json_string_value(json_object_get(message, name));
    const size_t digits = text ? strlen(text) : 1;
    if (digits % 2 != 0 || digits / 2 > room)
        return false;
    for (size_t i = 0; i < digits; i += 2) {
        const int high = nibble(text[i]), low = nibble(text[i + 1]);
        if (high < 0 || low < 0)
            return false;
        bytes[i / 2] = (uint8_t)(high << 4 | low);
    }
    *length = digits / 2;
    return true;
}

static json_t *show_bytes(const uint8_t *bytes, size_t length)
{
    char *text = malloc(2 * length + 1);
    for (size_t i = 0; text && i < length; i++)
        snprintf(text + 2 * i, 3, "%02x", bytes[i]);
    if (text)
        text[2 * length] = 0;
    json_t *value = json_string(text ? text : "");
    free(text);
    return value;
}

/* ---- the requests ----------------------------------------------------------------------------------------------- */

static json_t *hello(control_request_t *request, control_run_t *run, const json_t *message)
{
    static const char *const names[] = {
        [CM1E_CONTROL_OBSERVE] = "observe", [CM1E_CONTROL_NONE] = "none", [CM1E_CONTROL_MAINTAIN] = "maintain",
    };
    (void)message;
    const cm1e_bus_config_t *config = cm1e_bus_configuration(run->view.bus);
    json_t *told = json_pack("{s:i, s:s, s:o, s:i, s:I, s:o, s:s, s:I, s:i, s:i}", "protocol", CM1E_CONTROL_PROTOCOL,
                             "version", cm1e_version(), "program", cm1e_show_text(run->program), "pid", (int)getpid(),
                             "since", (json_int_t)run->since, "interface", cm1e_show_text(config->interface_name),
                             "control", names[run->control], "cycle_ns", (json_int_t)config->cycle_time_ns, "axes",
                             (int)run->view.axis_count, "slaves", (int)run->view.slave_count);
    return accept(request->id, "hello", told);
}

static json_t *want(control_request_t *request, const char *name, json_t *(*show)(const view_t *view))
{
    request->state = REQUEST_SNAPSHOT;
    request->name = name;
    request->show = show;
    request->wanted = false;
    return NULL;
}

static json_t *axes(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)run, (void)message;
    return want(request, "axes", cm1e_show_axes);
}

static json_t *slaves(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)run, (void)message;
    return want(request, "slaves", cm1e_show_slaves);
}

static json_t *statistics(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)message;
    return accept(request->id, "statistics", cm1e_show_statistics(run->view.scheduler));
}

static json_t *event_log(control_request_t *request, control_run_t *run, const json_t *message)
{
    json_int_t after;
    if (!take_number(message, "after", 0, INT64_MAX, 0, &after))
        return wrong(request, "\"after\" is expected to be the number of a record, or to be left out.");
    return accept(request->id, "log", cm1e_show_log(run->view.scheduler, (uint64_t)after));
}

/** What reading and writing have in common; NULL: good. */
static json_t *take_object(control_request_t *request, const json_t *message)
{
    json_int_t slave, index, subindex, timeout_ms;
    const json_t *complete = json_object_get(message, "complete_access");
    if (!take_number(message, "slave", 1, CM1E_MAX_SLAVES, 0, &slave))
        return wrong(request, "\"slave\" is expected to be the position of a slave, 1 = first.");
    if (!take_number(message, "index", 1, 0xFFFF, 0, &index) ||
        !take_number(message, "subindex", 0, 0xFF, 0, &subindex))
        return wrong(request, "\"index\" is expected to be 1 ... 65535 and \"subindex\" 0 ... 255.");
    if (!take_number(message, "timeout_ms", 1, SDO_TIMEOUT_MAX_MS, 1000, &timeout_ms))
        return wrong(request, "\"timeout_ms\" is expected to be 1 ... 60000, or to be left out.");
    if (complete && !json_is_boolean(complete))
        return wrong(request, "\"complete_access\" is expected to be true or false.");
    request->data = calloc(1, SDO_MAX);
    if (!request->data)
        return cm1e_request_refuse(request->id, CM1E_ERROR_NO_MEMORY, 0, "No memory for a transfer.");
    request->sdo = (cm1e_sdo_t){.position = (uint16_t)slave, .index = (uint16_t)index, .subindex = (uint8_t)subindex,
                                .complete_access = json_is_true(complete), .data = request->data, .size = SDO_MAX,
                                .timeout_ns = timeout_ms * 1000000};
    return NULL;
}

static json_t *end_transfer(control_request_t *request)
{
    const cm1e_sdo_t *sdo = &request->sdo;
    if (cm1e_sdo_state(sdo) == CM1E_SDO_ERROR)
        return cm1e_request_refuse(request->id, sdo->error, sdo->abort_code,
                                   sdo->error == CM1E_ERROR_SDO_ABORT ? cm1e_sdo_abort_text(sdo->abort_code)
                                                                      : cm1e_strerror(sdo->error));
    return accept(request->id, "data", sdo->write ? json_null() : show_bytes(request->data, sdo->size));
}

static json_t *submitted(control_request_t *request, cm1e_error_t error)
{
    request->state = REQUEST_SDO;
    return error == CM1E_OK ? NULL : cm1e_request_refuse(request->id, error, 0, cm1e_strerror(error));
}

static json_t *sdo_read(control_request_t *request, control_run_t *run, const json_t *message)
{
    json_int_t size;
    json_t *refused = take_object(request, message);
    if (refused)
        return refused;
    if (!take_number(message, "size", 1, SDO_MAX, SDO_MAX, &size))
        return wrong(request, "\"size\" is expected to be 1 ... 32768, or to be left out.");
    request->sdo.size = (size_t)size;
    return submitted(request, cm1e_sdo_submit(run->view.bus, &request->sdo));
}

static json_t *sdo_write(control_request_t *request, control_run_t *run, const json_t *message)
{
    if (run->control != CM1E_CONTROL_MAINTAIN)
        return cm1e_request_refuse(request->id, CM1E_ERROR_PERMISSION, 0,
                                   "The program lets others look only (control: observe). Writing needs `control: "
                                   "maintain` in its bus file.");
    json_t *refused = take_object(request, message);
    if (refused)
        return refused;
    if (!take_bytes(message, "data", request->data, SDO_MAX, &request->sdo.size))
        return wrong(request, "\"data\" is expected to be the bytes to write as hexadecimal digits, as on the wire.");
    request->sdo.write = true;
    request->write.sdo = &request->sdo;
    request->state = REQUEST_WRITE;
    request->wanted = false;
    return NULL;
}

static const struct {
    const char *name;
    json_t *(*begin)(control_request_t *request, control_run_t *run, const json_t *message);
} requests[] = {
    {"hello", hello},   {"axes", axes},         {"slaves", slaves},       {"statistics", statistics},
    {"log", event_log}, {"sdo_read", sdo_read}, {"sdo_write", sdo_write},
};

json_t *cm1e_request_begin(control_request_t *request, control_run_t *run, const json_t *message, int64_t now_ns)
{
    const char *name = json_string_value(json_object_get(message, "request"));
    json_int_t protocol;
    request->id = json_incref(json_object_get(message, "id"));
    request->begun_ns = now_ns;
    if (!take_number(message, "protocol", 1, CM1E_CONTROL_PROTOCOL, CM1E_CONTROL_PROTOCOL, &protocol))
        return cm1e_request_refuse(request->id, CM1E_ERROR_UNSUPPORTED, 0,
                                   "This program speaks version 1 of the protocol only.");
    for (size_t i = 0; name && i < sizeof requests / sizeof *requests; i++)
        if (strcmp(requests[i].name, name) == 0)
            return requests[i].begin(request, run, message);
    return wrong(request, "\"request\" is expected to be hello, axes, slaves, statistics, log, sdo_read or sdo_write.");
}

/* ---- those that go on ------------------------------------------------------------------------------------------- */

static json_t *no_cycle(const control_request_t *request)
{
    return cm1e_request_refuse(request->id, CM1E_ERROR_STATE, 0, "The cycle of the program does not run any more.");
}

/** A snapshot counts that was wanted after the request came. */
static json_t *continue_snapshot(control_request_t *request, control_run_t *run)
{
    if (!request->wanted) {
        request->wanted = true;
        cm1e_view_want(&run->view);
        return NULL;
    }
    return cm1e_view_filled(&run->view) ? accept(request->id, request->name, request->show(&run->view)) : NULL;
}

static json_t *continue_write(control_request_t *request, control_run_t *run)
{
    char text[160];
    view_write_t *write = &request->write;
    if (!request->wanted) {
        request->wanted = cm1e_view_submit(&run->view, write);
        return NULL;
    }
    if (!atomic_load_explicit(&write->decided, memory_order_acquire))
        return NULL;
    if (write->commanded < 0)
        return submitted(request, write->result);
    snprintf(text, sizeof text, "Axis \"%s\" is commanded by the program: nothing is written to slave %u until it "
             "stands without a command.", cm1e_axis_configuration(run->view.axes[write->commanded])->name,
             request->sdo.position);
    request->state = REQUEST_NONE;
    return cm1e_request_refuse(request->id, write->result, 0, text);
}

/** TRUE: the cycle cannot have it any more. */
static bool give_up(control_request_t *request, control_run_t *run)
{
    if (request->state == REQUEST_WRITE && request->wanted)
        return cm1e_view_withdraw(&run->view, &request->write);
    return request->state != REQUEST_SDO;
}

json_t *cm1e_request_continue(control_request_t *request, control_run_t *run, int64_t now_ns, bool stopping)
{
    json_t *reply = NULL;
    if (request->state == REQUEST_SNAPSHOT)
        reply = continue_snapshot(request, run);
    else if (request->state == REQUEST_WRITE)
        reply = continue_write(request, run);
    if (request->state == REQUEST_SDO && !reply && cm1e_sdo_state(&request->sdo) != CM1E_SDO_BUSY)
        reply = end_transfer(request);
    if (!reply && (stopping || now_ns - request->begun_ns > PATIENCE_NS) && give_up(request, run))
        reply = no_cycle(request);
    if (reply)
        request->state = REQUEST_NONE;
    return reply;
}

bool cm1e_request_must_end(const control_request_t *request)
{
    return request->state == REQUEST_SDO || (request->state == REQUEST_WRITE && request->wanted);
}

void cm1e_request_clear(control_request_t *request)
{
    json_decref(request->id);
    free(request->data);
    memset(request, 0, sizeof *request);
}
