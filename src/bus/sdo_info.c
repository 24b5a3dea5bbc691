#include "cm1e/sdo_info.h"

#include <stdio.h>
#include <stdlib.h>

#include "bus/bus_internal.h"
#include "bus/info_answer.h"
#include "bus/kept.h"
#include "core/in_task.h"

/* The list type and the maximum number of indexes. */
enum { LIST_TYPE_BYTES = 2, LIST_BYTES_MAX = LIST_TYPE_BYTES + 2 * 0x10000 };
enum { INFO_VALUES = INFO_VALUE_UNIT | INFO_VALUE_DEFAULT | INFO_VALUE_MINIMUM | INFO_VALUE_MAXIMUM };

static cm1e_error_t diagnose(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const cm1e_info_request_t *request,
                             cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH], what[48];
    cm1e_bus_label_first(bus, slave, label);
    if (request->kind == INFO_LIST)
        snprintf(what, sizeof what, "the list of its objects");
    else if (request->kind == INFO_OBJECT)
        snprintf(what, sizeof what, "object 0x%04X", request->index);
    else
        snprintf(what, sizeof what, "object 0x%04X:%02X", request->index, request->subindex);
    if (request->error == CM1E_ERROR_SDO_ABORT)
        return cm1e_diag_set(diag, request->error, request->abort_code,
                             "%s refuses to describe %s: SDO abort 0x%08X, %s.", label, what,
                             (unsigned)request->abort_code, cm1e_sdo_abort_text(request->abort_code));
    if (request->error == CM1E_ERROR_TIMEOUT)
        return cm1e_diag_set(diag, request->error, 0,
                             "%s did not describe %s in time: it may not support SDO information.", label, what);
    return cm1e_diag_set(diag, request->error, slave->coe.mailbox_error, "%s did not describe %s: %s.", label, what,
                         cm1e_strerror(request->error));
}

static cm1e_error_t ask_remote(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_info_request_t *request,
                               cm1e_diag_t *diag)
{
    cm1e_errand_t errand = {.kind = ERRAND_INFO, .position = slave->info.position, .info = *request};
    const cm1e_error_t error = cm1e_bus_errand_remote(bus, &errand, diag);
    *request = errand.info;
    request->error = errand.error;
    if (error != CM1E_OK)
        return error;
    return request->error == CM1E_OK ? CM1E_OK : diagnose(bus, slave, request, diag);
}

static cm1e_error_t ask(cm1e_bus_t *bus, uint16_t position, cm1e_info_request_t *request, cm1e_diag_t *diag)
{
    if (!bus)
        return cm1e_bus_missing("SDO information", diag);
    const cm1e_error_t driven = cm1e_bus_refuse_driven(bus, "SDO information", "", diag);
    if (driven != CM1E_OK)
        return driven;
    if (bus->phase < BUS_SCANNED)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Scan the bus before reading SDO information.");
    cm1e_bus_enter(bus);
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; %u were found.", position,
                             bus->slave_count);
    char label[CM1E_LABEL_LENGTH];
    if (!slave->facts.coe)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "%s has no object dictionary: its SII announces no CoE.",
                             cm1e_bus_label_first(bus, slave, label));
    if (bus->remote)
        return ask_remote(bus, slave, request, diag);
    /* Transfers of other threads end by themselves. */
    while (!cm1e_coe_idle(&slave->coe) || !cm1e_mapping_idle(&slave->mapping))
        cm1e_bus_pump(bus);
    cm1e_coe_begin_info(&slave->coe, request, cm1e_clock_now(bus->clock));
    while (!request->done)
        cm1e_bus_pump(bus);
    return request->error == CM1E_OK ? CM1E_OK : diagnose(bus, slave, request, diag);
}

static cm1e_error_t malformed(uint16_t position, const char *what, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, 0, "Slave %u: its description of %s is shorter than it says.",
                         position, what);
}

cm1e_error_t cm1e_sdo_info_list(cm1e_bus_t *bus, uint16_t position, cm1e_info_list_t list, uint16_t *indexes,
                                size_t *count, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_sdo_info_list()", "", diag);
    if (!count || (!indexes && *count > 0) || list < CM1E_OBJECTS_ALL || list > CM1E_OBJECTS_SETTINGS)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_sdo_info_list() needs a list and a buffer.");
    uint8_t *answer = malloc(LIST_BYTES_MAX);
    if (!answer)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory for a list of objects.");
    cm1e_info_request_t request = {.kind = INFO_LIST, .index = (uint16_t)list, .answer = answer,
                                   .size = LIST_BYTES_MAX};
    cm1e_error_t error = ask(bus, position, &request, diag);
    if (error == CM1E_OK && request.size < LIST_TYPE_BYTES)
        error = malformed(position, "its objects", diag);
    else if (error == CM1E_OK && (request.size - LIST_TYPE_BYTES) / 2 > *count)
        error = cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Slave %u has %zu objects, there is room for %zu.",
                              position, (request.size - LIST_TYPE_BYTES) / 2, *count);
    else if (error == CM1E_OK && !cm1e_info_take_list(indexes, *count, count, answer, request.size))
        error = malformed(position, "its objects", diag);
    free(answer);
    return error;
}

cm1e_error_t cm1e_sdo_info_object(cm1e_bus_t *bus, uint16_t position, uint16_t index, cm1e_object_info_t *info,
                                  cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_sdo_info_object()", "", diag);
    if (!info)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_sdo_info_object() needs a place for the object.");
    uint8_t answer[CM1E_DATAGRAM_MAX];
    cm1e_info_request_t request = {.kind = INFO_OBJECT, .index = index, .answer = answer, .size = sizeof answer};
    const cm1e_error_t error = ask(bus, position, &request, diag);
    if (error == CM1E_OK && !cm1e_info_take_object(info, answer, request.size))
        return malformed(position, "an object", diag);
    return error;
}

cm1e_error_t cm1e_sdo_info_entry(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex,
                                 cm1e_entry_info_t *info, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_sdo_info_entry()", "", diag);
    if (!info)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_sdo_info_entry() needs a place for the entry.");
    uint8_t answer[CM1E_DATAGRAM_MAX];
    /* If the values of a slave do not have the length that it states, only the description is requested. */
    static const uint8_t values[] = {INFO_VALUES, 0};
    for (unsigned i = 0; i < sizeof values; i++) {
        cm1e_info_request_t request = {.kind = INFO_ENTRY, .index = index, .subindex = subindex, .values = values[i],
                                       .answer = answer, .size = sizeof answer};
        const cm1e_error_t error = ask(bus, position, &request, diag);
        if (error != CM1E_OK)
            return error;
        if (cm1e_info_take_entry(info, answer, request.size))
            return CM1E_OK;
    }
    return malformed(position, "a sub-index", diag);
}
