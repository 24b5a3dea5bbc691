/* Registers and state of one slave, read and written on request. */
#include "cm1e/esc.h"

#include <string.h>

#include "bus/bus_internal.h"
#include "core/in_task.h"

enum { HIGHEST_STATE = 15 };
/** Some centuries: a time limit that can be added to every time. */
#define LONGEST_NS (INT64_MAX / 4)

static cm1e_error_t silent(uint16_t position, uint16_t address, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "Slave %u does not answer at register 0x%04X.", position,
                         address);
}

/** Asks the program that runs the network, in pieces. `diag` has its words where it cannot be asked. */
static cm1e_error_t read_remote(cm1e_bus_t *bus, uint16_t position, uint16_t address, uint8_t *data, uint16_t size,
                                cm1e_diag_t *diag)
{
    for (uint16_t done = 0; done < size;) {
        const uint16_t left = (uint16_t)(size - done), part = left < CM1E_ERRAND_BYTES ? left : CM1E_ERRAND_BYTES;
        cm1e_errand_t errand = {.kind = ERRAND_REGISTERS, .position = position, .place = address + done, .size = part};
        const cm1e_error_t error = cm1e_bus_errand_remote(bus, &errand, diag);
        if (error != CM1E_OK)
            return error;
        if (errand.error != CM1E_OK)
            return silent(position, address, diag);
        memcpy(data + done, errand.data, part);
        done = (uint16_t)(done + part);
    }
    return CM1E_OK;
}

bool cm1e_bus_read_registers(cm1e_bus_t *bus, uint16_t position, uint16_t address, uint8_t *data, uint16_t size)
{
    const uint16_t station = cm1e_bus_at(bus, position)->facts.station;
    if (!bus->remote)
        return cm1e_soem_transfer(bus->soem, COMMAND_FPRD, station, address, data, size) == 1;
    return read_remote(bus, position, address, data, size, NULL) == CM1E_OK;
}

/** Reads registers of a network that another program runs: only those whose reading changes nothing. */
static cm1e_error_t read_attached(cm1e_bus_t *bus, uint16_t position, uint16_t address, uint8_t *data, uint16_t size,
                                  cm1e_diag_t *diag)
{
    if (!cm1e_bus_at(bus, position) || size == 0 || address + size > CM1E_ERRAND_REGISTERS_END)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Slave %u, %u bytes from register 0x%04X: another "
                             "program runs the network, so only slaves 1 ... %u and registers up to 0x%04X can be "
                             "read.", position, size, address, bus->slave_count, CM1E_ERRAND_REGISTERS_END - 1);
    return read_remote(bus, position, address, data, size, diag);
}

static cm1e_error_t check(cm1e_bus_t *bus, uint16_t position, const void *data, const char *function,
                          cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse(function, "", diag);
    if (!data)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "%s needs a place for the data.", function);
    if (!bus)
        return cm1e_bus_missing(function, diag);
    if (bus->phase >= BUS_OPERATING)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "%s needs an open bus that does not operate.", function);
    const cm1e_error_t attached = cm1e_bus_refuse_attached(bus, function, diag);
    if (attached != CM1E_OK)
        return attached;
    if (position > 0 && (bus->phase < BUS_SCANNED || !cm1e_bus_at(bus, position)))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; a scan found %u.", position,
                             bus->slave_count);
    cm1e_bus_enter(bus);
    return CM1E_OK;
}

static cm1e_error_t transfer(cm1e_bus_t *bus, cm1e_command_t command, uint16_t position, uint16_t address, void *data,
                             uint16_t size, cm1e_diag_t *diag)
{
    const uint16_t station = position > 0 ? cm1e_bus_at(bus, position)->facts.station : 0;
    if (size == 0 || size > CM1E_ESC_BYTES)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "%u bytes of registers; expected 1 ... %d.", size,
                             CM1E_ESC_BYTES);
    if (cm1e_soem_transfer(bus->soem, command, station, address, data, size) >= 1)
        return CM1E_OK;
    return silent(position, address, diag);
}

cm1e_error_t cm1e_esc_read(cm1e_bus_t *bus, uint16_t position, uint16_t address, void *data, uint16_t size,
                           cm1e_diag_t *diag)
{
    if (bus && bus->remote && data && !cm1e_in_task())
        return read_attached(bus, position, address, data, size, diag);
    const cm1e_error_t error = check(bus, position, data, "cm1e_esc_read()", diag);
    if (error != CM1E_OK)
        return error;
    memset(data, 0, size);
    return transfer(bus, position ? COMMAND_FPRD : COMMAND_BRD, position, address, data, size, diag);
}

cm1e_error_t cm1e_esc_write(cm1e_bus_t *bus, uint16_t position, uint16_t address, const void *data, uint16_t size,
                            cm1e_diag_t *diag)
{
    uint8_t copy[CM1E_ESC_BYTES];
    const cm1e_error_t error = check(bus, position, data, "cm1e_esc_write()", diag);
    if (error != CM1E_OK)
        return error;
    if (position == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_esc_write() needs one slave, not all.");
    memcpy(copy, data, size <= sizeof copy ? size : sizeof copy);
    return transfer(bus, COMMAND_FPWR, position, address, copy, size, diag);
}

cm1e_error_t cm1e_esc_request_state(cm1e_bus_t *bus, uint16_t position, uint8_t state, int64_t timeout_ns,
                                    cm1e_al_answer_t *answer, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check(bus, position, answer, "cm1e_esc_request_state()", diag);
    if (error != CM1E_OK)
        return error;
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave || state < 1 || state > HIGHEST_STATE)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "State %u of slave %u; expected 1 ... %d of one "
                             "slave.", state, position, HIGHEST_STATE);
    if (timeout_ns <= 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The time limit for a state is %lld ns; expected is "
                             "more than 0.", (long long)timeout_ns);
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + (timeout_ns < LONGEST_NS ? timeout_ns : LONGEST_NS);
    cm1e_al_request(&slave->al, state, deadline_ns);
    cm1e_bus_pump_until_idle(bus, deadline_ns + CM1E_STATE_TIMEOUT_NS);
    *answer = (cm1e_al_answer_t){.state = slave->al.state, .code = slave->al.code};
    slave->info.al_state = slave->al.state;
    slave->info.al_status_code = slave->al.code;
    if (slave->al.error == CM1E_OK || slave->al.state & AL_ERROR_FLAG)
        return CM1E_OK;
    cm1e_bus_diagnose_state(bus, slave, diag);
    return CM1E_ERROR_TIMEOUT;
}
