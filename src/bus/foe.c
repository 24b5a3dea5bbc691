/* Files of a slave, in Pre-Operational and above, or in Bootstrap. */
#include <stdio.h>
#include <string.h>

#include "bus/bootstrap.h"
#include "bus/bus_internal.h"
#include "bus/foe_client.h"
#include "bus/kept.h"
#include "core/in_task.h"
#include "core/sized.h"

#define LOOK_NS INT64_C(1000000) /* of a thread that waits beside the cycle */

static cm1e_error_t check(cm1e_bus_t *bus, uint16_t position, bool bootstrap, const char *function, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse(function, "", diag);
    if (!bus)
        return cm1e_bus_missing(function, diag);
    const int phase = __atomic_load_n(&bus->phase, __ATOMIC_SEQ_CST);
    if (cm1e_bus_is_driven(bus) && !bootstrap)
        return CM1E_OK; /* cm1e_foe_submit() looks at the rest */
    const bool operates = phase == BUS_OPERATING;
    if (phase < BUS_SCANNED || (phase > BUS_SCANNED && bootstrap) || (bus->exchanging && !operates))
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "%s needs a scanned bus%s.", function,
                             bootstrap ? " that does not operate, for Bootstrap" : "");
    const cm1e_error_t attached = bootstrap ? cm1e_bus_refuse_attached(bus, function, diag) : CM1E_OK;
    if (attached != CM1E_OK)
        return attached;
    if (!cm1e_bus_at(bus, position))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; a scan found %u.", position,
                             bus->slave_count);
    cm1e_bus_enter(bus);
    return CM1E_OK;
}

/** Uses the mailbox of the CoE client, because both number their messages together. */
static cm1e_error_t use_mailbox(cm1e_foe_t *foe)
{
    cm1e_bus_slave_t *slave = cm1e_bus_at(foe->bus, foe->position);
    foe->slave = slave;
    foe->mailbox = &slave->coe.mailbox;
    const cm1e_error_t error = cm1e_foe_check_mailbox(slave, foe->diag);
    if (error == CM1E_OK)
        cm1e_bus_pump_until_idle(foe->bus, cm1e_clock_now(foe->bus->clock) + CM1E_STATE_TIMEOUT_NS);
    return error;
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

/** Transfers the file in Bootstrap. The slave leaves Bootstrap also after an error, as far as it can. The first error
 *  is returned. */
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
    foe->mailbox = NULL;
    cm1e_bus_set_phase(foe->bus, BUS_OPEN); /* the states of the other slaves are no longer known */
    return error;
}

static void describe(cm1e_foe_t *foe, const transfer_t *transfer)
{
    foe->writing = transfer->from != NULL;
    foe->name = transfer->name;
    foe->from = transfer->from;
    foe->to = transfer->to;
    foe->size = foe->writing ? *transfer->size : 0;
    foe->room = *transfer->size;
}

/** Lets the program that runs the network transfer the file. */
static cm1e_error_t remotely(cm1e_foe_t *foe, const transfer_t *transfer)
{
    describe(foe, transfer);
    const cm1e_error_t error = foe->bus->remote->file(foe->bus->remote_state, foe, foe->diag);
    if (!foe->writing)
        *transfer->size = foe->done;
    return error;
}

/** Another thread makes the cycles. This one only looks, by the clock of the machine, and tells the progress. */
static void wait_beside(cm1e_foe_t *foe, const cm1e_foe_options_t *told)
{
    cm1e_clock_t *clock = cm1e_clock_monotonic();
    size_t before = 0;
    while (!cm1e_foe_done(foe)) {
        cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + LOOK_NS);
        const size_t done = __atomic_load_n(&foe->done, __ATOMIC_RELAXED);
        if (told->progress && done != before && !told->progress(told->context, done, foe->writing ? foe->size : 0))
            cm1e_foe_cancel(foe);
        before = done;
    }
}

/** Beside the process data. The transfer is on the stack, so it must end before this function returns; the bus ensures
 *  that. Where a scheduler runs, it makes the cycles meanwhile, else this thread does. */
static cm1e_error_t in_operation(cm1e_foe_t *foe, const transfer_t *transfer, bool driven)
{
    const cm1e_foe_options_t told = foe->options;
    describe(foe, transfer);
    foe->options.progress = driven ? NULL : told.progress; /* the cycle calls nothing of the user */
    cm1e_error_t error = cm1e_foe_submit(foe->bus, foe, foe->diag);
    if (error != CM1E_OK)
        return error;
    if (driven)
        wait_beside(foe, &told);
    while (!cm1e_foe_done(foe))
        cm1e_bus_pump(foe->bus);
    if (!foe->writing)
        *transfer->size = foe->done;
    return cm1e_foe_result_of(foe, foe->diag);
}

static cm1e_error_t execute(cm1e_bus_t *bus, uint16_t position, const transfer_t *transfer,
                            const cm1e_foe_options_t *options, size_t options_size, const char *function,
                            cm1e_diag_t *diag)
{
    static const cm1e_foe_options_t defaults;
    cm1e_foe_t foe = {.bus = bus, .position = position, .diag = diag};
    if (!transfer->name || (!transfer->from && !transfer->to) || !transfer->size)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "%s needs a name and a buffer.", function);
    cm1e_copy_sized(&foe.options, sizeof foe.options, options ? options : &defaults,
                    options ? options_size : sizeof defaults);
    const bool driven = bus && cm1e_bus_is_driven(bus);
    cm1e_error_t error = check(bus, position, foe.options.bootstrap, function, diag);
    if (error != CM1E_OK)
        return error;
    if (foe.options.answer_ns <= 0)
        foe.options.answer_ns = CM1E_FOE_ANSWER_NS;
    if (foe.options.bootstrap)
        return in_bootstrap(&foe, transfer);
    if (driven)
        return in_operation(&foe, transfer, true);
    if (bus->remote)
        return remotely(&foe, transfer);
    if (bus->phase == BUS_OPERATING)
        return in_operation(&foe, transfer, false);
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
