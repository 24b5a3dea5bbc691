/* A bus whose slaves and transfers come through a control socket. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/remote.h"
#include "control/arguments.h"
#include "control/client.h"
#include "control/message.h"
#include "control/file_request.h"
#include "core/clock.h"
#include "core/text.h"

/** Between two looks at a file that is on its way. */
#define LOOK_NS INT64_C(20000000)

static json_int_t number(const json_t *object, const char *name)
{
    return json_integer_value(json_object_get(object, name));
}

static void copy_text(char *text, size_t size, const json_t *object, const char *name)
{
    const char *told = json_string_value(json_object_get(object, name));
    snprintf(text, size, "%s", told ? told : "");
    cm1e_text_clean(text);
}

static void take_emergencies(cm1e_remote_slave_t *slave, const json_t *told)
{
    const size_t count = json_array_size(told);
    for (size_t i = 0; i < count && i < CM1E_EMERGENCIES; i++) {
        const json_t *one = json_array_get(told, i);
        cm1e_emergency_t *emergency = &slave->emergencies[slave->emergency_count];
        *emergency = (cm1e_emergency_t){.number = (uint64_t)number(one, "number"), .time_ns = number(one, "time_ns"),
                                        .code = (uint16_t)number(one, "code"),
                                        .error_register = (uint8_t)number(one, "error_register")};
        for (size_t n = 0; n < sizeof emergency->data; n++)
            emergency->data[n] = (uint8_t)json_integer_value(json_array_get(json_object_get(one, "data"), n));
        if (number(one, "number") < 1)
            return;
        slave->emergency_count++;
    }
}

/* Without distributed clocks there is nothing told. */
static void take_clock(cm1e_remote_slave_t *slave, const json_t *told)
{
    slave->has_clock = json_is_object(told);
    slave->clock = (cm1e_slave_clock_t){
        .has_clock = slave->has_clock,
        .is_reference = json_is_true(json_object_get(told, "is_reference")),
        .lost = json_is_true(json_object_get(told, "lost")),
        .delay_ns = (uint32_t)number(told, "delay_ns"),
        .sync0_ns = (uint32_t)number(told, "sync0_ns"),
        .sync1_ns = (uint32_t)number(told, "sync1_ns"),
        .shift_ns = (int32_t)number(told, "shift_ns"),
        .deviation_ns = (int32_t)number(told, "deviation_ns"),
        .maximum_ns = (uint32_t)number(told, "maximum_ns"),
        .losses = (uint64_t)number(told, "losses"),
    };
}

/* What the other program says is judged like the answer of a slave: every number is cut to its range. */
static void take_slave(cm1e_remote_slave_t *slave, uint16_t position, const json_t *told)
{
    cm1e_slave_info_t *info = &slave->info;
    const json_t *motors = json_object_get(told, "motors");
    *slave = (cm1e_remote_slave_t){.coe = json_is_true(json_object_get(told, "coe"))};
    info->position = position;
    info->vendor_id = (uint32_t)number(told, "vendor_id");
    info->product_code = (uint32_t)number(told, "product_code");
    info->revision = (uint32_t)number(told, "revision");
    info->serial_number = (uint32_t)number(told, "serial_number");
    info->alias = (uint16_t)number(told, "alias");
    info->explicit_id = (uint16_t)number(told, "explicit_id");
    info->al_state = (uint16_t)number(told, "al_state");
    info->al_status_code = (uint16_t)number(told, "al_status_code");
    info->model = (cm1e_device_model_t)(uint8_t)number(told, "model");
    for (size_t i = 0; i < sizeof info->motors; i++)
        info->motors[i] = (uint8_t)json_integer_value(json_array_get(motors, i));
    copy_text(info->name, sizeof info->name, told, "name");
    copy_text(info->software_version, sizeof info->software_version, told, "software_version");
    copy_text(slave->kind, sizeof slave->kind, told, "kind");
    slave->presence = (cm1e_presence_t)(number(told, "presence") & 7);
    copy_text(slave->presence_text, sizeof slave->presence_text, told, "presence_text");
    slave->open_ports = (uint8_t)(number(told, "open_ports") & ((1 << CM1E_PORTS) - 1));
    take_emergencies(slave, json_object_get(told, "emergencies"));
    take_clock(slave, json_object_get(told, "clock"));
}

/* Without a second interface there is nothing told. */
static void take_ring(cm1e_bus_ring_t *ring, const json_t *told, uint32_t slaves)
{
    const json_int_t behind = number(told, "behind"), before = number(told, "before");
    const bool placed = behind >= 0 && before > behind && before <= (json_int_t)slaves + 1;
    *ring = (cm1e_bus_ring_t){.used = json_is_object(told), .breaks = (uint64_t)number(told, "breaks"),
                              .broken = json_is_true(json_object_get(told, "broken"))};
    ring->placed = placed && ring->broken;
    ring->behind = ring->placed ? (uint16_t)behind : 0;
    ring->before = ring->placed ? (uint16_t)before : 0;
}

/* Without strangers there is nothing told. */
static void take_strangers(cm1e_remote_network_t *network, const json_t *told)
{
    const size_t count = json_array_size(told);
    for (size_t i = 0; i < count && i < CM1E_STRANGERS; i++) {
        const json_t *one = json_array_get(told, i);
        network->strangers[network->stranger_count++] = (cm1e_stranger_t){
            .place = (uint16_t)number(one, "place"),
            .alias = (uint16_t)number(one, "alias"),
            .explicit_id = (uint16_t)number(one, "explicit_id"),
            .vendor_id = (uint32_t)number(one, "vendor_id"),
            .product_code = (uint32_t)number(one, "product_code"),
            .revision = (uint32_t)number(one, "revision"),
            .serial_number = (uint32_t)number(one, "serial_number"),
        };
    }
}

static cm1e_error_t scan(void *state, cm1e_remote_slave_t *slaves, uint32_t room, uint32_t *count,
                         cm1e_remote_network_t *network, cm1e_diag_t *diag)
{
    json_t *reply = NULL;
    const cm1e_error_t error = cm1e_control_call(state, json_pack("{s:s}", "request", "slaves"), &reply, diag);
    const json_t *told = json_object_get(reply, "slaves");
    const size_t found = json_array_size(told);
    *count = found < room ? (uint32_t)found : room;
    for (uint32_t i = 0; i < *count; i++)
        take_slave(&slaves[i], (uint16_t)(i + 1), json_array_get(told, i));
    take_ring(&network->ring, json_object_get(reply, "ring"), *count);
    take_strangers(network, json_object_get(reply, "strangers"));
    json_decref(reply);
    return error;
}

static int digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

/** The bytes that were read; false: they are more than there is room for, or no bytes. */
static bool take_data(void *data, size_t *size, const char *text)
{
    const size_t digits = text ? strlen(text) : 1;
    uint8_t *bytes = data;
    if (digits % 2 != 0 || digits / 2 > *size || strspn(text, "0123456789abcdef") != digits)
        return false;
    for (size_t i = 0; i < digits; i += 2)
        bytes[i / 2] = (uint8_t)(digit(text[i]) << 4 | digit(text[i + 1]));
    *size = digits / 2;
    return true;
}

/** A whole ms, not less than the time. */
static json_int_t milliseconds(int64_t ns) { return (json_int_t)((ns + 999999) / 1000000); }

/** Bytes that a request has room for beside its other members, in hexadecimal digits. */
enum { WRITE_MAX = (CM1E_REQUEST_MAX - 512) / 2 };

static json_t *request_of(const cm1e_sdo_t *sdo)
{
    json_t *request = json_pack("{s:s, s:i, s:i, s:i, s:b}", "request", sdo->write ? "sdo_write" : "sdo_read", "slave",
                                sdo->position, "index", sdo->index, "subindex", sdo->subindex, "complete_access",
                                sdo->complete_access);
    if (sdo->timeout_ns > 0)
        json_object_set_new(request, "timeout_ms", json_integer(milliseconds(sdo->timeout_ns)));
    if (!sdo->write) {
        json_object_set_new(request, "size", json_integer((json_int_t)(sdo->size < 32768 ? sdo->size : 32768)));
        return request;
    }
    json_object_set_new(request, "data", cm1e_show_bytes(sdo->data, sdo->size));
    return request;
}

/** An error of the transfer itself, which the slave or the bus gave; any other is the program's. */
static bool is_of_transfer(cm1e_error_t error)
{
    return error == CM1E_ERROR_SDO_ABORT || error == CM1E_ERROR_BUS_MAILBOX || error == CM1E_ERROR_BUS_LOST ||
           error == CM1E_ERROR_TIMEOUT || error == CM1E_ERROR_CANCELLED || error == CM1E_ERROR_UNSUPPORTED;
}

static cm1e_error_t transfer(void *state, cm1e_sdo_t *sdo, cm1e_diag_t *diag)
{
    json_t *reply = NULL;
    cm1e_diag_t told = {0};
    if (sdo->write && sdo->size > WRITE_MAX)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Through the program that has the network an object "
                             "of at most %d bytes is written; this one has %zu.", WRITE_MAX, sdo->size);
    cm1e_error_t error = cm1e_control_call(state, request_of(sdo), &reply, &told);
    const bool answered = reply != NULL;
    sdo->error = CM1E_OK;
    const char *data = json_string_value(json_object_get(reply, "data"));
    if (error == CM1E_OK && !sdo->write && !take_data(sdo->data, &sdo->size, data))
        error = cm1e_diag_set(&told, CM1E_ERROR_FILE, 0,
                              "The answer of the program has no data in hexadecimal digits.");
    json_decref(reply);
    if (error == CM1E_OK)
        return CM1E_OK;
    if (answered && is_of_transfer(error)) {
        sdo->error = error;
        sdo->abort_code = error == CM1E_ERROR_SDO_ABORT ? told.foreign_code : 0;
        return CM1E_OK;
    }
    return cm1e_diag_set(diag, error, told.foreign_code, "%s", told.text);
}

static json_t *request_of_errand(const cm1e_errand_t *errand)
{
    if (errand->kind == ERRAND_INFO)
        return json_pack("{s:s, s:i, s:i, s:i, s:i, s:i}", "request", "sdo_info", "slave", errand->position, "kind",
                         (int)errand->info.kind, "index", errand->info.index, "subindex", errand->info.subindex,
                         "values", errand->info.values);
    const bool sii = errand->kind == ERRAND_SII;
    return json_pack("{s:s, s:i, s:i, s:i}", "request", sii ? "sii_read" : "registers", "slave", errand->position,
                     sii ? "word" : "address", (int)errand->place, "size", (int)errand->size);
}

static cm1e_error_t run_errand(void *state, cm1e_errand_t *errand, cm1e_diag_t *diag)
{
    json_t *reply = NULL;
    cm1e_diag_t told = {0};
    const bool info = errand->kind == ERRAND_INFO;
    const size_t size = errand->size;
    cm1e_error_t error = cm1e_control_call(state, request_of_errand(errand), &reply, &told);
    const bool answered = reply != NULL;
    const char *data = json_string_value(json_object_get(reply, "data"));
    const bool good = error == CM1E_OK && (info ? take_data(errand->info.answer, &errand->info.size, data)
                                                : take_data(errand->data, &errand->size, data) && errand->size == size);
    json_decref(reply);
    if (error == CM1E_OK && !good)
        error = cm1e_diag_set(&told, CM1E_ERROR_FILE, 0,
                              "The answer of the program has no data in hexadecimal digits.");
    errand->error = CM1E_OK;
    if (answered && is_of_transfer(error)) {
        errand->error = error;
        errand->info.abort_code = error == CM1E_ERROR_SDO_ABORT ? told.foreign_code : 0;
        return CM1E_OK;
    }
    return error == CM1E_OK ? CM1E_OK : cm1e_diag_set(diag, error, told.foreign_code, "%s", told.text);
}

/* ---- files ------------------------------------------------------------------------------------------------------ */

/** A request whose reply says nothing but that it is accepted. */
static cm1e_error_t order(void *state, json_t *request, cm1e_diag_t *diag)
{
    json_t *reply = NULL;
    const cm1e_error_t error = cm1e_control_call(state, request, &reply, diag);
    json_decref(reply);
    return error;
}

static cm1e_error_t send_bytes(void *state, const cm1e_foe_t *foe, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (size_t at = 0; error == CM1E_OK && (at < foe->size || at == 0); at += CM1E_FILE_PIECE) {
        const size_t left = foe->size - at, piece = left < CM1E_FILE_PIECE ? left : CM1E_FILE_PIECE;
        error = order(state, json_pack("{s:s, s:I, s:o}", "request", "file_data", "offset", (json_int_t)at, "data",
                                       cm1e_show_bytes(foe->from + at, piece)), diag);
    }
    return error;
}

static cm1e_error_t fetch_bytes(void *state, cm1e_foe_t *foe, size_t size, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (foe->done = 0; error == CM1E_OK && foe->done < size;) {
        json_t *reply = NULL;
        size_t piece = size - foe->done;
        json_t *request = json_pack("{s:s, s:I}", "request", "file_data", "offset", (json_int_t)foe->done);
        error = cm1e_control_call(state, request, &reply, diag);
        if (error == CM1E_OK &&
            (!take_data(foe->to + foe->done, &piece, json_string_value(json_object_get(reply, "data"))) || piece == 0))
            error = cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "The answer of the program has no data of the file.");
        foe->done += error == CM1E_OK ? piece : 0;
        json_decref(reply);
    }
    return error;
}

/** Looks how far it is, until it has ended. `*done`: bytes. */
static cm1e_error_t follow(void *state, const cm1e_foe_t *foe, size_t *done, cm1e_diag_t *diag)
{
    bool stop = false, ended = false;
    cm1e_error_t error = CM1E_OK;
    while (error == CM1E_OK && !ended) {
        json_t *reply = NULL;
        error = cm1e_control_call(state, json_pack("{s:s, s:b}", "request", "file", "stop", stop), &reply, diag);
        const json_t *file = json_object_get(reply, "file");
        *done = (size_t)number(file, "done");
        ended = json_is_true(json_object_get(file, "ended"));
        json_decref(reply);
        if (error == CM1E_OK && foe->options.progress)
            stop |= !foe->options.progress(foe->options.context, *done, foe->size);
        if (!ended)
            cm1e_clock_sleep_until(cm1e_clock_monotonic(), cm1e_clock_now(cm1e_clock_monotonic()) + LOOK_NS);
    }
    return error;
}

static cm1e_error_t transfer_file(void *state, cm1e_foe_t *foe, cm1e_diag_t *diag)
{
    size_t done = 0;
    const json_int_t maximum = (json_int_t)(foe->room < CM1E_FILE_MAX ? foe->room : CM1E_FILE_MAX);
    cm1e_error_t error = foe->writing ? send_bytes(state, foe, diag) : CM1E_OK;
    if (error == CM1E_OK)
        error = order(state, json_pack("{s:s, s:i, s:s, s:b, s:I, s:I, s:I}", "request", "file_begin", "slave",
                                       foe->position, "name", foe->name, "write", foe->writing, "password",
                                       (json_int_t)foe->options.password, "timeout_ms",
                                       milliseconds(foe->options.answer_ns), "maximum",
                                       foe->writing ? 1 : maximum), diag);
    if (error == CM1E_OK)
        error = follow(state, foe, &done, diag);
    if (error == CM1E_OK && !foe->writing)
        error = fetch_bytes(state, foe, done < foe->room ? done : foe->room, diag);
    return error;
}

static void close_connection(void *state) { cm1e_control_close(state); }

static const cm1e_bus_remote_t through_control = {scan, transfer, run_errand, transfer_file, close_connection};

cm1e_error_t cm1e_bus_open_attached(cm1e_bus_t **bus, const cm1e_bus_config_t *config, cm1e_control_t *control,
                                    cm1e_diag_t *diag)
{
    if (!bus || !config || !control)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_bus_open_attached() needs a place for the "
                             "bus, a configuration and a connection.");
    return cm1e_bus_open_remote(bus, config, &through_control, control, diag);
}
