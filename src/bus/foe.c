/* Files of a slave, in Pre-Operational and above, or in Bootstrap. */
#include <stdio.h>
#include <string.h>

#include "bus/bootstrap.h"
#include "bus/foe_client.h"
#include "core/in_task.h"
#include "core/sized.h"

#define ANSWER_NS INT64_C(5000000000)
enum { MAILBOX_MIN = 32 };

static cm1e_error_t check(cm1e_bus_t *bus, uint16_t position, const char *function, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse(function, "", diag);
    if (!bus || bus->phase < BUS_SCANNED || bus->phase >= BUS_OPERATING || bus->exchanging)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "%s needs a scanned bus that does not operate.", function);
    const cm1e_error_t attached = cm1e_bus_refuse_attached(bus, function, diag);
    if (attached != CM1E_OK)
        return attached;
    if (!cm1e_bus_at(bus, position))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; a scan found %u.", position,
                             bus->slave_count);
    cm1e_bus_enter(bus);
    return CM1E_OK;
}

/** The SII is not trusted. */
static bool fits(uint16_t length) { return length >= MAILBOX_MIN && length <= CM1E_DATAGRAM_MAX; }

/** The mailbox of Pre-Operational is that of the CoE client: both number their messages together. */
static cm1e_error_t use_mailbox(cm1e_foe_t *foe)
{
    cm1e_bus_slave_t *slave = cm1e_bus_at(foe->bus, foe->position);
    foe->slave = slave;
    foe->mailbox = &slave->coe.mailbox;
    if (!slave->facts.foe)
        return cm1e_diag_set(foe->diag, CM1E_ERROR_UNSUPPORTED, 0,
                             "Slave %u has no files: its SII announces no FoE.", foe->position);
    if (!fits(foe->mailbox->out_length) || !fits(foe->mailbox->in_length))
        return cm1e_diag_set(foe->diag, CM1E_ERROR_UNSUPPORTED, 0, "The mailbox of slave %u has %u bytes to it and %u "
                             "from it, as its SII states; expected are %d to %d.", foe->position,
                             foe->mailbox->out_length, foe->mailbox->in_length, MAILBOX_MIN, CM1E_DATAGRAM_MAX);
    cm1e_bus_pump_until_idle(foe->bus, cm1e_clock_now(foe->bus->clock) + CM1E_STATE_TIMEOUT_NS);
    return CM1E_OK;
}

typedef struct transfer {
    const char *name;
    const uint8_t *from; /**< NULL: the file is read */
    uint8_t *to;
    size_t *size;
} transfer_t;

static cm1e_error_t run(cm1e_foe_t *foe, const transfer_t *transfer)
{
    return transfer->from ? cm1e_foe_send(foe, transfer->name, transfer->from, *transfer->size)
                          : cm1e_foe_receive(foe, transfer->name, transfer->to, transfer->size);
}

/** The slave leaves Bootstrap also after an error, as far as it can; the first error counts. */
static cm1e_error_t in_bootstrap(cm1e_foe_t *foe, const transfer_t *transfer)
{
    cm1e_bootstrap_t bootstrap = {.bus = foe->bus, .position = foe->position, .diag = foe->diag};
    foe->mailbox = &bootstrap.mailbox;
    cm1e_error_t error = cm1e_bootstrap_enter(&bootstrap);
    if (error == CM1E_OK) {
        error = run(foe, transfer);
        bootstrap.diag = error == CM1E_OK ? foe->diag : NULL;
        if (error == CM1E_OK)
            error = cm1e_bootstrap_leave(&bootstrap);
        else if (error != CM1E_ERROR_BUS_LOST)
            (void)cm1e_bootstrap_leave(&bootstrap);
    }
    cm1e_bus_set_phase(foe->bus, BUS_OPEN); /* of the other slaves nothing is known any more */
    return error;
}

static cm1e_error_t execute(cm1e_bus_t *bus, uint16_t position, const transfer_t *transfer,
                            const cm1e_foe_options_t *options, size_t options_size, const char *function,
                            cm1e_diag_t *diag)
{
    static const cm1e_foe_options_t defaults;
    cm1e_foe_t foe = {.bus = bus, .position = position, .diag = diag};
    cm1e_error_t error = check(bus, position, function, diag);
    if (error != CM1E_OK)
        return error;
    if (!transfer->name || (!transfer->from && !transfer->to))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "%s needs a name and a buffer.", function);
    cm1e_copy_sized(&foe.options, sizeof foe.options, options ? options : &defaults,
                    options ? options_size : sizeof defaults);
    if (foe.options.answer_ns <= 0)
        foe.options.answer_ns = ANSWER_NS;
    if (foe.options.bootstrap)
        return in_bootstrap(&foe, transfer);
    error = use_mailbox(&foe);
    return error == CM1E_OK ? run(&foe, transfer) : error;
}

cm1e_error_t cm1e_foe_read_sized(cm1e_bus_t *bus, uint16_t position, const char *name, void *data, size_t *size,
                                 const cm1e_foe_options_t *options, size_t options_size, cm1e_diag_t *diag)
{
    const transfer_t transfer = {.name = name, .to = data, .size = size};
    return execute(bus, position, &transfer, options, options_size, "cm1e_foe_read()", diag);
}

cm1e_error_t cm1e_foe_write_sized(cm1e_bus_t *bus, uint16_t position, const char *name, const void *data, size_t size,
                                  const cm1e_foe_options_t *options, size_t options_size, cm1e_diag_t *diag)
{
    const transfer_t transfer = {.name = name, .from = data, .size = &size};
    return execute(bus, position, &transfer, options, options_size, "cm1e_foe_write()", diag);
}
