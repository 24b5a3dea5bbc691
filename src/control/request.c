#include "control/request.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cm1e/version.h"
#include "control/arguments.h"
#include "control/file_request.h"
#include "control/maintain_request.h"
#include "control/message.h"
#include "control/record_request.h"
#include "control/recorder.h"
#include "control/recover_request.h"
#include "control/show.h"
#include "core/json_text.h"

enum { SDO_MAX = 1 << 15, INFO_MAX = 2 + 2 * 0x10000, SII_WORDS = 1 << 18 };
#define PATIENCE_NS INT64_C(2000000000)
#define SDO_TIMEOUT_MAX_MS 60000

static json_t *accept(const control_request_t *request, const char *name, json_t *value)
{
    return cm1e_request_accept(request->id, name, value);
}

/** The request waits until the cycle has decided on its order. */
static json_t *give_order(control_request_t *request, view_order_t *order,
                          json_t *(*decided)(control_request_t *request, control_run_t *run))
{
    request->state = REQUEST_ORDER;
    request->order = order;
    request->decided = decided;
    request->wanted = false;
    return NULL;
}

/* ---- the requests ----------------------------------------------------------------------------------------------- */

static json_t *hello(control_request_t *request, control_run_t *run, const json_t *message)
{
    static const char *const names[] = {
        [CM1E_CONTROL_OBSERVE] = "observe", [CM1E_CONTROL_NONE] = "none", [CM1E_CONTROL_MAINTAIN] = "maintain",
    };
    (void)message;
    const cm1e_bus_config_t *config = cm1e_bus_configuration(run->view.bus);
    json_t *told = json_pack("{s:i, s:s, s:o, s:i, s:I, s:o, s:o, s:s, s:I, s:i, s:i}", "protocol",
                             CM1E_CONTROL_PROTOCOL, "version", cm1e_version(), "program", cm1e_json_text(run->program),
                             "pid", (int)getpid(), "since", (json_int_t)run->since,
                             "interface", cm1e_json_text(config->interface_name),
                             "network", cm1e_json_text(config->name), "control", names[run->control],
                             "cycle_ns", (json_int_t)config->cycle_time_ns, "axes", (int)run->view.axis_count,
                             "slaves", (int)run->view.slave_count);
    return accept(request, "hello", told);
}

static json_t *want(control_request_t *request, json_t *(*show)(const view_t *view))
{
    request->state = REQUEST_SNAPSHOT;
    request->show = show;
    return NULL;
}

static json_t *axes(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)run, (void)message;
    return want(request, cm1e_show_axes);
}

static json_t *slaves(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)run, (void)message;
    return want(request, cm1e_show_slaves);
}

static json_t *statistics(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)message;
    return accept(request, "statistics", cm1e_show_statistics(run->view.scheduler));
}

static json_t *event_log(control_request_t *request, control_run_t *run, const json_t *message)
{
    json_int_t after;
    if (!cm1e_take_number(message, "after", 0, INT64_MAX, 0, &after))
        return wrong(request, "\"after\" is expected to be the number of a record, or to be left out.");
    return accept(request, "log", cm1e_show_log(&run->view, (uint64_t)after));
}

/** What reading and writing have in common; NULL: good. */
static json_t *take_object(control_request_t *request, const json_t *message)
{
    json_int_t slave, index, subindex, timeout_ms;
    const json_t *complete = json_object_get(message, "complete_access");
    if (!cm1e_take_number(message, "slave", 1, CM1E_MAX_SLAVES, 0, &slave))
        return wrong(request, "\"slave\" is expected to be the position of a slave, 1 = first.");
    if (!cm1e_take_number(message, "index", 1, 0xFFFF, 0, &index) ||
        !cm1e_take_number(message, "subindex", 0, 0xFF, 0, &subindex))
        return wrong(request, "\"index\" is expected to be 1 ... 65535 and \"subindex\" 0 ... 255.");
    if (!cm1e_take_number(message, "timeout_ms", 1, SDO_TIMEOUT_MAX_MS, 1000, &timeout_ms))
        return wrong(request, "\"timeout_ms\" is expected to be 1 ... 60000, or to be left out.");
    if (complete && !json_is_boolean(complete))
        return wrong(request, "\"complete_access\" is expected to be true or false.");
    request->data = calloc(1, SDO_MAX);
    if (!request->data)
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a transfer.");
    request->sdo = (cm1e_sdo_t){.position = (uint16_t)slave, .index = (uint16_t)index, .subindex = (uint8_t)subindex,
                                .complete_access = json_is_true(complete), .data = request->data, .size = SDO_MAX,
                                .timeout_ns = timeout_ms * 1000000};
    return NULL;
}

static json_t *refused_by_slave(const control_request_t *request, cm1e_error_t error, uint32_t abort_code)
{
    return cm1e_request_refuse(request->id, error, abort_code, error == CM1E_ERROR_SDO_ABORT
                                                                   ? cm1e_sdo_abort_text(abort_code)
                                                                   : cm1e_strerror(error));
}

static json_t *end_transfer(control_request_t *request)
{
    const cm1e_sdo_t *sdo = &request->sdo;
    if (cm1e_sdo_state(sdo) == CM1E_SDO_ERROR)
        return refused_by_slave(request, sdo->error, sdo->abort_code);
    return accept(request, "data", sdo->write ? json_null() : cm1e_show_bytes(request->data, sdo->size));
}

static json_t *submitted(control_request_t *request, cm1e_error_t error)
{
    request->state = REQUEST_SDO;
    return error == CM1E_OK ? NULL : refuse(request, error, cm1e_strerror(error));
}

static json_t *sdo_read(control_request_t *request, control_run_t *run, const json_t *message)
{
    json_int_t size;
    json_t *refused = take_object(request, message);
    if (refused)
        return refused;
    if (!cm1e_take_number(message, "size", 1, SDO_MAX, SDO_MAX, &size))
        return wrong(request, "\"size\" is expected to be 1 ... 32768, or to be left out.");
    request->sdo.size = (size_t)size;
    return submitted(request, cm1e_sdo_submit(run->view.bus, &request->sdo));
}

static json_t *sdo_write(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)run;
    json_t *refused = take_object(request, message);
    if (refused)
        return refused;
    if (!cm1e_take_bytes(message, "data", request->data, SDO_MAX, &request->sdo.size))
        return wrong(request, "\"data\" is expected to be the bytes to write as hexadecimal digits, as on the wire.");
    request->sdo.write = true;
    return cm1e_request_write(request, (view_write_t){.sdo = &request->sdo});
}

/* ---- errands ---------------------------------------------------------------------------------------------------- */

static json_t *start_errand(control_request_t *request, control_run_t *run)
{
    const cm1e_error_t error = cm1e_errand_submit(run->view.bus, &request->errand);
    request->state = REQUEST_ERRAND;
    request->wanted = error == CM1E_OK;
    if (error == CM1E_OK || error == CM1E_ERROR_BUSY)
        return NULL;
    return refuse(request, error, cm1e_strerror(error));
}

static json_t *continue_errand(control_request_t *request, control_run_t *run)
{
    const cm1e_errand_t *errand = &request->errand;
    const bool info = errand->kind == ERRAND_INFO;
    if (!request->wanted)
        return start_errand(request, run);
    if (!cm1e_errand_done(errand))
        return NULL;
    if (errand->error != CM1E_OK)
        return refused_by_slave(request, errand->error, errand->info.abort_code);
    return accept(request, "data", info ? cm1e_show_bytes(errand->info.answer, errand->info.size)
                                        : cm1e_show_bytes(errand->data, errand->size));
}

static json_t *errand_of(control_request_t *request, control_run_t *run, const json_t *message,
                         cm1e_errand_kind_t kind, const char *place, json_int_t place_max)
{
    json_int_t slave, start, size;
    if (!cm1e_take_number(message, "slave", 1, run->view.slave_count, 0, &slave))
        return wrong(request, "\"slave\" is expected to be the position of a slave, 1 = first.");
    if (!cm1e_take_number(message, place, 0, place_max, -1, &start))
        return wrong(request, kind == ERRAND_SII ? "\"word\" is expected to be 0 ... 262143."
                                                 : "\"address\" is expected to be 0 ... 2303 (0x08FF).");
    if (!cm1e_take_number(message, "size", 1, CM1E_ERRAND_BYTES, 2, &size) || (kind == ERRAND_SII && size % 2 != 0) ||
        (kind == ERRAND_REGISTERS && start + size > CM1E_ERRAND_REGISTERS_END))
        return wrong(request, "\"size\" is expected to be 1 ... 128, even for an SII, up to register 0x08FF.");
    request->errand = (cm1e_errand_t){.kind = kind, .position = (uint16_t)slave, .place = (uint32_t)start,
                                      .size = (size_t)size};
    return start_errand(request, run);
}

static json_t *registers(control_request_t *request, control_run_t *run, const json_t *message)
{
    return errand_of(request, run, message, ERRAND_REGISTERS, "address", CM1E_ERRAND_REGISTERS_END - 1);
}

static json_t *sii_read(control_request_t *request, control_run_t *run, const json_t *message)
{
    return errand_of(request, run, message, ERRAND_SII, "word", SII_WORDS - 1);
}

static json_t *sdo_info(control_request_t *request, control_run_t *run, const json_t *message)
{
    json_int_t slave, kind, index, subindex, values;
    if (!cm1e_take_number(message, "slave", 1, run->view.slave_count, 0, &slave))
        return wrong(request, "\"slave\" is expected to be the position of a slave, 1 = first.");
    if (!cm1e_take_number(message, "kind", INFO_LIST, INFO_ENTRY, 0, &kind) || kind % 2 == 0)
        return wrong(request, "\"kind\" is expected to be 1 (list), 3 (object) or 5 (entry).");
    if (!cm1e_take_number(message, "index", 0, 0xFFFF, -1, &index) ||
        !cm1e_take_number(message, "subindex", 0, 0xFF, 0, &subindex) ||
        !cm1e_take_number(message, "values", 0, 0xFF, 0, &values))
        return wrong(request, "\"index\" is expected to be 0 ... 65535, \"subindex\" and \"values\" 0 ... 255.");
    request->data = malloc(INFO_MAX);
    if (!request->data)
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a description.");
    request->errand = (cm1e_errand_t){
        .kind = ERRAND_INFO, .position = (uint16_t)slave,
        .info = {.kind = (cm1e_info_kind_t)kind, .index = (uint16_t)index, .subindex = (uint8_t)subindex,
                 .values = (uint8_t)values, .answer = request->data, .size = INFO_MAX}};
    return start_errand(request, run);
}

/* ---- motion ----------------------------------------------------------------------------------------------------- */

static json_t *maintain(control_request_t *request, control_run_t *run, const json_t *message)
{
    const char *bad = cm1e_maintain_take(request, run, message);
    return bad ? wrong(request, bad) : give_order(request, &request->maintain.order, cm1e_maintain_reply);
}

/* ---- signals ----------------------------------------------------------------------------------------------------- */

static json_t *continue_io(control_request_t *request, control_run_t *run);

/** The cycle reads some signals at a time; without a next one the list is complete. */
static json_t *next_io(control_request_t *request, control_run_t *run)
{
    return cm1e_io_list_next(request->io, &run->view)
               ? give_order(request, &request->io->values.order, continue_io)
               : accept(request, "io", json_incref(request->io->told));
}

static json_t *continue_io(control_request_t *request, control_run_t *run)
{
    cm1e_io_list_take(request->io, &run->view);
    return next_io(request, run);
}

static json_t *io(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)message;
    request->io = cm1e_io_list_begin();
    return request->io ? next_io(request, run)
                       : refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a list.");
}

static json_t *end_output(control_request_t *request, control_run_t *run)
{
    (void)run;
    char text[240];
    const char *refusal = cm1e_output_refusal(&request->output, text, sizeof text);
    const bool wrong = request->output.refusal == OUTPUT_BY_BUS; /* an input, or no value of its type */
    return refusal ? refuse(request, wrong ? CM1E_ERROR_INVALID_ARGUMENT : CM1E_ERROR_STATE, refusal)
                   : accept(request, "output", json_null());
}

static json_t *output(control_request_t *request, control_run_t *run, const json_t *message)
{
    cm1e_diag_t diag = {0};
    cm1e_error_t error = CM1E_OK;
    request->output.client = request->client;
    const char *bad = cm1e_output_take(&request->output, &run->view, message, &error, diag.text, sizeof diag.text);
    return bad ? refuse(request, error, bad)
               : give_order(request, &request->output.order, end_output);
}

/* ---- variables --------------------------------------------------------------------------------------------------- */

static json_t *end_variable(control_request_t *request, control_run_t *run)
{
    if (request->variable.values) {
        json_t *reply = accept(request, "variables", cm1e_variables_show(&request->variable, &run->view));
        const uint32_t next = cm1e_variables_next(&request->variable, &run->view);
        if (next > 0)
            json_object_set_new(reply, "next", json_integer(next));
        return reply;
    }
    const bool taken = request->variable.result == FORCING_TAKEN;
    const char *refusal = cm1e_variable_refusal(&request->variable);
    return refusal ? refuse(request, taken ? CM1E_ERROR_CANCELLED : CM1E_ERROR_STATE, refusal)
                   : accept(request, "variable", json_null());
}

static json_t *variables(control_request_t *request, control_run_t *run, const json_t *message)
{
    char text[500];
    json_int_t from;
    uint32_t row = 0;
    const json_t *only = json_object_get(message, "name");
    const char *name = json_string_value(only);
    if (only && !name)
        return wrong(request, "\"name\" is expected to be the name of a variable, or to be left out.");
    if (!cm1e_take_number(message, "from", 0, UINT32_MAX, 0, &from))
        return wrong(request, "\"from\" is expected to be the number of a variable, 0 = first, or to be left out.");
    if (name && json_is_true(json_object_get(message, "forced")))
        return wrong(request, "\"name\" and \"forced\" exclude each other.");
    if (name && !cm1e_variable_named(&run->view, name, &row, text, sizeof text))
        return refuse(request, CM1E_ERROR_NOT_FOUND, text);
    if (!cm1e_variables_begin(&request->variable, &run->view, name ? row : (uint32_t)from,
                              name ? 1 : VARIABLES_OF_REPLY, json_is_true(json_object_get(message, "forced"))))
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a list.");
    return give_order(request, &request->variable.order, end_variable);
}

static json_t *variable(control_request_t *request, control_run_t *run, const json_t *message)
{
    char text[600];
    cm1e_error_t error = CM1E_OK;
    request->variable.forced.client = request->client;
    const char *bad = cm1e_variable_take(&request->variable, &run->view, message, &error, text, sizeof text);
    return bad ? refuse(request, error, bad)
               : give_order(request, &request->variable.order, end_variable);
}

/* ---- the table --------------------------------------------------------------------------------------------------- */

#define MAINTAINING "To move, enable or reset an axis"
#define WITH_FILE "Transferring a file"

static const struct {
    const char *name;
    json_t *(*begin)(control_request_t *request, control_run_t *run, const json_t *message);
    const char *needs_consent; /**< it does more than look: the beginning of the sentence that refuses it */
} requests[] = {
    {"hello", hello, NULL},
    {"axes", axes, NULL},
    {"slaves", slaves, NULL},
    {"statistics", statistics, NULL},
    {"log", event_log, NULL},
    {"sdo_read", sdo_read, NULL},
    {"sdo_write", sdo_write, "Writing"},
    {"sdo_info", sdo_info, NULL},
    {"sii_read", sii_read, NULL},
    {"registers", registers, NULL},
    {"enable", maintain, MAINTAINING},
    {"disable", maintain, MAINTAINING},
    {"jog", maintain, MAINTAINING},
    {"home", maintain, MAINTAINING},
    {"stop", maintain, MAINTAINING},
    {"reset", maintain, MAINTAINING},
    {"keep", maintain, MAINTAINING},
    {"record", cm1e_record_begin, NULL},
    {"samples", cm1e_record_samples, NULL},
    {"io", io, NULL},
    {"output", output, "Writing an output"},
    {"file_data", cm1e_file_data, WITH_FILE},
    {"file_begin", cm1e_file_begin, WITH_FILE},
    {"file", cm1e_file_look, WITH_FILE},
    {"recover", cm1e_recover_slave, "Bringing back a slave"},
    {"variables", variables, NULL},
    {"variable", variable, "Writing or forcing a variable"},
};

static bool may_do_more(const control_request_t *request, const control_run_t *run)
{
    return run->control == CM1E_CONTROL_MAINTAIN || (run->serves_own && request->pid == (int)getpid());
}

static json_t *refuse_consent(const control_request_t *request, const char *what)
{
    char text[160];
    snprintf(text, sizeof text, "The program lets others look only (control: observe). %s needs `control: maintain` in "
             "its bus file.", what);
    return refuse(request, CM1E_ERROR_PERMISSION, text);
}

static json_t *unknown(const control_request_t *request)
{
    char text[300] = "\"request\" is expected to be one of";
    for (size_t i = 0, used = strlen(text); i < sizeof requests / sizeof *requests; i++, used = strlen(text))
        snprintf(text + used, sizeof text - used, "%s %s", i ? "," : "", requests[i].name);
    return wrong(request, text);
}

json_t *cm1e_request_begin(control_request_t *request, control_run_t *run, const json_t *message, int64_t now_ns)
{
    const char *name = json_string_value(json_object_get(message, "request"));
    json_int_t protocol;
    request->id = json_incref(json_object_get(message, "id"));
    request->begun_ns = now_ns;
    if (!cm1e_take_number(message, "protocol", 1, CM1E_CONTROL_PROTOCOL, CM1E_CONTROL_PROTOCOL, &protocol))
        return refuse(request, CM1E_ERROR_UNSUPPORTED,
                                   "This program speaks version 1 of the protocol only.");
    for (size_t i = 0; name && i < sizeof requests / sizeof *requests; i++) {
        if (strcmp(requests[i].name, name) != 0)
            continue;
        request->name = requests[i].name;
        if (requests[i].needs_consent && !may_do_more(request, run))
            return refuse_consent(request, requests[i].needs_consent);
        return requests[i].begin(request, run, message);
    }
    return unknown(request);
}

/* ---- those that go on ------------------------------------------------------------------------------------------- */

static json_t *no_cycle(const control_request_t *request, bool stopping)
{
    if (request->wanted || stopping)
        return refuse(request, CM1E_ERROR_STATE, "The cycle of the program does not run any more.");
    return refuse(request, CM1E_ERROR_BUSY, "Other connections ask the program for so much that this "
                               "request has not had its turn for 2 s.");
}

/** What is told beside the slaves. */
static void add_network(json_t *reply, const view_t *view)
{
    json_t *strangers = cm1e_show_strangers(view);
    if (view->ring.used)
        json_object_set_new(reply, "ring", cm1e_show_ring(view));
    if (json_array_size(strangers) > 0)
        json_object_set(reply, "strangers", strangers);
    json_decref(strangers);
}

/** A snapshot counts that begins after the request came. */
static json_t *continue_snapshot(control_request_t *request, control_run_t *run)
{
    if (!request->wanted) {
        request->wanted = true;
        request->snapshot = cm1e_view_want(&run->view);
        return NULL;
    }
    if (!cm1e_view_has(&run->view, request->snapshot))
        return NULL;
    json_t *reply = accept(request, request->name, request->show(&run->view));
    if (request->show == cm1e_show_slaves)
        add_network(reply, &run->view);
    return reply;
}

/** Hands it over as soon as no other one waits. */
static json_t *continue_order(control_request_t *request, control_run_t *run)
{
    if (!request->wanted) {
        request->wanted = cm1e_view_submit(&run->view, request->order);
        return NULL;
    }
    return atomic_load_explicit(&request->order->decided, memory_order_acquire) ? request->decided(request, run) : NULL;
}

static json_t *end_write(control_request_t *request, control_run_t *run)
{
    char text[160];
    view_write_t *write = &request->write;
    if (write->commanded < 0)
        return request->file ? cm1e_file_decided(request) : submitted(request, write->result);
    snprintf(text, sizeof text, "Axis \"%s\" is commanded by the program: nothing is written to slave %u until it "
             "is at standstill without a command.", cm1e_axis_configuration(run->view.axes[write->commanded])->name,
             write->file ? (unsigned)write->file->position : (unsigned)request->sdo.position);
    return refuse(request, write->result, text);
}

json_t *cm1e_request_write(control_request_t *request, view_write_t write)
{
    request->write = write;
    request->write.order.decide = cm1e_view_decide_write;
    return give_order(request, &request->write.order, end_write);
}

/** A transfer is still on its way: the request must live until it has ended. */
static bool must_end(const control_request_t *request)
{
    return request->state == REQUEST_SDO ||
           (request->wanted && (request->state == REQUEST_ORDER || request->state == REQUEST_ERRAND));
}

/** true: the cycle cannot have it any more. */
static bool give_up(control_request_t *request, control_run_t *run)
{
    if (request->state == REQUEST_ORDER && request->wanted)
        return cm1e_view_withdraw(&run->view, request->order);
    return !must_end(request);
}

json_t *cm1e_request_continue(control_request_t *request, control_run_t *run, int64_t now_ns, bool stopping)
{
    json_t *reply = NULL;
    if (request->state == REQUEST_SNAPSHOT)
        reply = continue_snapshot(request, run);
    else if (request->state == REQUEST_ERRAND)
        reply = continue_errand(request, run);
    else if (request->state == REQUEST_ORDER)
        reply = continue_order(request, run);
    if (request->state == REQUEST_SDO && !reply && cm1e_sdo_state(&request->sdo) != CM1E_SDO_BUSY)
        reply = end_transfer(request);
    if (!reply && (stopping || now_ns - request->begun_ns > PATIENCE_NS) && give_up(request, run))
        reply = no_cycle(request, stopping);
    if (reply)
        request->state = REQUEST_NONE;
    return reply;
}

void cm1e_request_clear(control_request_t *request)
{
    json_decref(request->id);
    cm1e_io_list_free(request->io);
    cm1e_variables_free(&request->variable);
    free(request->data);
    memset(request, 0, sizeof *request);
}

bool cm1e_request_leave(control_request_t *request, control_run_t *run, uint32_t client, bool stopping)
{
    cm1e_maintain_leave(&run->view, client);
    cm1e_guest_outputs_leave(&run->view.outputs, client);
    atomic_fetch_or_explicit(&run->view.gone, UINT32_C(1) << client, memory_order_release);
    const bool recorded = cm1e_recorder_end(&run->view, client, stopping);
    /* The file last: the cycle may have it for as long as the request has not ended. */
    if (!recorded || must_end(request) || !cm1e_file_leave(run, client))
        return false;
    cm1e_request_clear(request);
    return true;
}
