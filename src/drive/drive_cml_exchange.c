/* CML while no cycle runs: the steps of drive_cml.c with transfers that block, and before and after them the flows of
 * appendix 3.2 and 3.3. */
#include <string.h>

#include "bus/bus_image.h"
#include "core/bytes.h"
#include "core/clock.h"
#include "core/in_task.h"
#include "device/bridge_status.h"
#include "device/devices.h"
#include "drive/drive_cml.h"

#define INSTEAD "In a task: the block CM_SendCML."

enum { OWN_MODE = CM1E_BRIDGE_MODE_CSP };
static const int64_t switch_ns = 1000 * MS_IN_NS;
static const int64_t step_ns = MS_IN_NS;

typedef struct place {
    cm1e_bus_t *bus;
    uint16_t position;
    uint8_t channel;
    cm1e_diag_t *diag;
} place_t;

static void sleep_for(cm1e_bus_t *bus, int64_t time_ns)
{
    cm1e_clock_t *clock = cm1e_bus_clock(bus);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + time_ns);
}

/* The transfer has ended when this returns. The code of an abort is in the diag. */
static cm1e_error_t transfer(void *context, cm1e_sdo_t *sdo)
{
    const place_t *at = context;
    if (sdo->write)
        sdo->error = cm1e_sdo_write(at->bus, sdo->position, sdo->index, 0, sdo->data, sdo->size, at->diag);
    else
        sdo->error = cm1e_sdo_read(at->bus, sdo->position, sdo->index, 0, sdo->data, &sdo->size, at->diag);
    sdo->state = sdo->error != CM1E_OK ? CM1E_SDO_ERROR : CM1E_SDO_DONE;
    return CM1E_OK;
}

static cm1e_error_t check_place(const place_t *at)
{
    const cm1e_slave_info_t *slave = cm1e_bus_slave(at->bus, at->position);
    if (!slave)
        return cm1e_diag_set(at->diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; %u were found.",
                             at->position, (unsigned)cm1e_bus_slave_count(at->bus));
    if (!slave->device || slave->device->channels == 0)
        return cm1e_diag_set(at->diag, CM1E_ERROR_CM_NO_BRIDGE, 0,
                             "Slave %u, \"%s\", is no EtherCAT Cool MUSCLE Bridge: CML goes to motors behind one only.",
                             at->position, slave->name);
    if (at->channel < 1 || at->channel > CM1E_BRIDGE_AXES)
        return cm1e_diag_set(at->diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "Slave %u has no connector %u; 1 ... %d is right.", at->position, at->channel,
                             CM1E_BRIDGE_AXES);
    return CM1E_OK;
}

/* ---- mode of operation ------------------------------------------------------------------------------------------- */

static uint16_t index_of(const place_t *at, uint16_t index)
{
    return (uint16_t)(index + (at->channel - 1) * CM1E_BRIDGE_INDEX_INCREMENT);
}

static cm1e_error_t read_mode(const place_t *at, int8_t *mode)
{
    size_t size = sizeof *mode;
    const uint16_t index = index_of(at, OBJ_6061_MODES_OF_OPERATION_DISPLAY);
    const cm1e_error_t error = cm1e_sdo_read(at->bus, at->position, index, 0, mode, &size, at->diag);
    if (error == CM1E_OK && size != sizeof *mode)
        return cm1e_diag_set(at->diag, CM1E_ERROR_BUS_MAILBOX, 0,
                             "Slave %u: object 0x%04X was read with %zu bytes instead of 1.", at->position, index,
                             size);
    return error;
}

/* Explains why a mode was not reached. A bridge refuses while the motor moves or has an error. */
static cm1e_error_t not_confirmed(const place_t *at, int8_t wanted, int8_t shown)
{
    char words[CM1E_BRIDGE_STATUS_TEXT] = "unknown";
    uint8_t status[4];
    size_t size = sizeof status;
    const cm1e_device_model_t model = cm1e_bus_slave(at->bus, at->position)->model;
    const cm1e_error_t error = cm1e_sdo_read(at->bus, at->position, OBJ_F530_SYSTEM_INFO,
                                             CM1E_BRIDGE_STATUS_SUBINDEX(at->channel), status, &size, NULL);
    if (error == CM1E_OK && size == sizeof status)
        cm1e_bridge_status_text(cm1e_bridge_motor(model, at->channel - 1u), cm1e_get_u32(status), words, sizeof words);
    return cm1e_diag_set(at->diag, CM1E_ERROR_DRIVE_MODE_TIMEOUT, 0,
                         "Slave %u, connector %u: mode of operation %d was commanded, but object 0x%04X shows %d. "
                         "The motor must be at standstill without an error for that; its status is: %s.",
                         at->position, at->channel,
                         wanted, index_of(at, OBJ_6061_MODES_OF_OPERATION_DISPLAY), shown, words);
}

static cm1e_error_t switch_mode(const place_t *at, int8_t wanted)
{
    cm1e_clock_t *clock = cm1e_bus_clock(at->bus);
    int8_t shown = 0;
    sleep_for(at->bus, CM1E_BRIDGE_MODE_INTERVAL_NS);
    cm1e_error_t error = cm1e_sdo_write(at->bus, at->position, index_of(at, OBJ_6060_MODES_OF_OPERATION), 0, &wanted, 1,
                                        at->diag);
    const int64_t deadline_ns = cm1e_clock_now(clock) + switch_ns;
    while (error == CM1E_OK && shown != wanted && cm1e_clock_now(clock) < deadline_ns) {
        sleep_for(at->bus, CM1E_BRIDGE_MODE_INTERVAL_NS);
        error = read_mode(at, &shown);
    }
    return error != CM1E_OK || shown == wanted ? error : not_confirmed(at, wanted, shown);
}

static cm1e_error_t enter(const place_t *at)
{
    int8_t mode = 0;
    cm1e_error_t error = read_mode(at, &mode);
    if (error != CM1E_OK || mode == CM1E_BRIDGE_MODE_CML)
        return error;
    if (mode == CM1E_BRIDGE_MODE_CMD || mode == CM1E_BRIDGE_MODE_CPIO)
        return cm1e_diag_set(at->diag, CM1E_ERROR_CM_MODE, 0,
                             "Slave %u, connector %u is in %s mode (%d). From there the way to CML and back ends in "
                             "abnormal operation (BR 6, note 2): switch the bridge off and on again.", at->position,
                             at->channel, cm1e_bridge_mode_name(mode), mode);
    if (mode != OWN_MODE)
        error = switch_mode(at, OWN_MODE);
    return error != CM1E_OK ? error : switch_mode(at, CM1E_BRIDGE_MODE_CML);
}

/* ---- strings ----------------------------------------------------------------------------------------------------- */

static cm1e_error_t run(place_t *at, cm1e_drive_cml_t *cml, const char *text, const cm1e_cml_exchange_t *exchange,
                        uint32_t *ticket)
{
    cm1e_clock_t *clock = cm1e_bus_clock(at->bus);
    cm1e_error_t error = cm1e_drive_cml_send(cml, text, exchange ? exchange->timeout_ns : 0, ticket);
    while (error == CM1E_OK && !cm1e_drive_cml_idle(cml)) {
        cm1e_drive_cml_step(cml, cm1e_clock_now(clock), true);
        if (exchange && exchange->cancelled && exchange->cancelled(exchange->context))
            cm1e_drive_cml_cancel(cml, *ticket, CM1E_ERROR_CANCELLED);
        if (!cm1e_drive_cml_idle(cml))
            sleep_for(at->bus, step_ns);
    }
    cm1e_clock_sleep_until(clock, cml->free_ns); /* the next string may have another cml, which does not know it */
    return error != CM1E_OK ? error : cm1e_drive_cml_request(cml, *ticket)->error;
}

static cm1e_error_t describe(const place_t *at, const cm1e_drive_cml_t *cml, const cm1e_drive_cml_request_t *request,
                             cm1e_error_t error)
{
    const char *said = request->first;
    switch (error) {
    case CM1E_OK: return CM1E_OK;
    case CM1E_ERROR_CML_TIMEOUT:
    case CM1E_ERROR_CM_SEARCH_TIMEOUT:
        return cm1e_diag_set(at->diag, error, 0,
                             "Slave %u, connector %u: %s came to \"%s\" within %lld ms%s%s%s. Is the motor switched "
                             "on, and does it know this command?", at->position, at->channel,
                             request->lines ? "not every answer" : "no answer", request->text,
                             (long long)(request->timeout_ns / MS_IN_NS),
                             request->strays ? "; another line came: \"" : "", cml->stray,
                             request->strays ? "\"" : "");
    case CM1E_ERROR_CML_ANSWER:
        return cm1e_diag_set(at->diag, error, 0,
                             "Slave %u, connector %u: the answer to \"%s\" is damaged: \"%s\". Check the cable between "
                             "bridge and motor.", at->position, at->channel, request->text, said);
    case CM1E_ERROR_CM_SEARCH:
        return cm1e_diag_set(at->diag, error, 0,
                             "Slave %u, connector %u: the origin search ended without an origin; the motor says "
                             "\"%s\".", at->position, at->channel, said);
    case CM1E_ERROR_CANCELLED:
        return cm1e_diag_set(at->diag, error, 0, "Slave %u, connector %u: \"%s\" was cancelled.", at->position,
                             at->channel, request->text);
    default: return error; /* the transfer has described it */
    }
}

static cm1e_error_t check_exchange(const place_t *at, const cm1e_cml_exchange_t *exchange)
{
    const char *text = exchange->text, *wrong = text ? cm1e_cml_check(text, at->channel) : "is missing";
    if (wrong)
        return cm1e_diag_set(at->diag, CM1E_ERROR_CML_STRING, 0,
                             "Slave %u, connector %u: the string \"%.80s\" %s.", at->position, at->channel,
                             text ? text : "", wrong);
    if (exchange->timeout_ns < 0 || exchange->timeout_ns > CM1E_DRIVE_LONGEST_NS)
        return cm1e_diag_set(at->diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "Slave %u, connector %u: a timeout of %lld ns; 0 (the default) ... %lld is right.",
                             at->position, at->channel, (long long)exchange->timeout_ns,
                             (long long)CM1E_DRIVE_LONGEST_NS);
    if (cm1e_cml_kind(text) == CM1E_CML_MOTION && !exchange->allow_motion)
        return cm1e_diag_set(at->diag, CM1E_ERROR_CML_MOTION, 0,
                             "Slave %u, connector %u: the string \"%s\" may move the motor, change its power or what "
                             "its positions mean, or is not known: it is sent only where that is allowed.",
                             at->position, at->channel, text);
    return CM1E_OK;
}

static void copy_answer(cm1e_cml_exchange_t *exchange, const cm1e_drive_cml_t *cml, uint32_t ticket)
{
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(cml, ticket);
    exchange->count = request->lines;
    exchange->lost = request->lost;
    exchange->strays = request->strays;
    for (unsigned i = 0; i < exchange->count; i++)
        memcpy(exchange->lines[i], cm1e_drive_cml_line(cml, ticket, i), sizeof exchange->lines[i]);
    memcpy(exchange->stray, cml->stray, sizeof exchange->stray);
}

/* Takes the torque from the motor. An error of that is not told: the caller has a better one, or goes on. */
static void free_motor(const place_t *at, cm1e_drive_cml_t *cml)
{
    char text[8];
    uint32_t ticket;
    place_t quiet = {at->bus, at->position, at->channel, NULL};
    cm1e_drive_cml_init(cml, at->position, at->channel, transfer, &quiet);
    run(&quiet, cml, cm1e_drive_cml_motor_free(cml, text), NULL, &ticket);
    sleep_for(at->bus, 2 * CM1E_BRIDGE_MODE_INTERVAL_NS); /* it has to arrive before the mode changes */
}

cm1e_error_t cm1e_cml_exchange(cm1e_bus_t *bus, cm1e_cml_exchange_t *exchange, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_cml_exchange()", INSTEAD, diag);
    uint32_t ticket;
    if (!exchange)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_cml_exchange() needs an exchange.");
    exchange->count = exchange->lost = exchange->strays = 0;
    if (!bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_cml_exchange() needs a bus.");
    place_t at = {bus, exchange->position, exchange->channel, diag};
    cm1e_error_t error = check_place(&at);
    if (error == CM1E_OK)
        error = check_exchange(&at, exchange);
    if (error == CM1E_OK)
        error = enter(&at);
    if (error != CM1E_OK)
        return error;
    cm1e_drive_cml_t cml;
    cm1e_drive_cml_init(&cml, at.position, at.channel, transfer, &at);
    error = run(&at, &cml, exchange->text, exchange, &ticket);
    const cm1e_drive_cml_request_t *request = cm1e_drive_cml_request(&cml, ticket);
    error = describe(&at, &cml, request, error);
    copy_answer(exchange, &cml, ticket);
    if (error != CM1E_OK && request->sent && cm1e_cml_kind(exchange->text) == CM1E_CML_MOTION)
        free_motor(&at, &cml);
    return error;
}

cm1e_error_t cm1e_cml_leave(cm1e_bus_t *bus, uint16_t position, uint8_t channel, bool free_it, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_cml_leave()", INSTEAD, diag);
    const place_t at = {bus, position, channel, diag};
    int8_t mode = 0;
    if (!bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_cml_leave() needs a bus.");
    cm1e_error_t error = check_place(&at);
    if (error == CM1E_OK)
        error = read_mode(&at, &mode);
    if (error != CM1E_OK || mode != CM1E_BRIDGE_MODE_CML)
        return error;
    if (free_it) {
        cm1e_drive_cml_t cml;
        free_motor(&at, &cml);
    }
    return switch_mode(&at, OWN_MODE);
}
