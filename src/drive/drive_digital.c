/*
 * Digital inputs and outputs of a motor behind a bridge. In CPIO they are in its words. In csp they are transferred by
 * SDO, while the motor is enabled (BR 6.5). Inputs are polled while a caller reads them. Outputs are written when they
 * are to change, and once whenever they become reachable, because their state is unknown then.
 */
#include "core/bytes.h"
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

enum { OUTPUTS = 1, MASK = 2 }; /* sub-indexes of 0x60FE */
static const int64_t wanted_ns = 1000 * MS_IN_NS;
static const int64_t read_again_ns = 10 * MS_IN_NS;
static const int64_t error_again_ns = 100 * MS_IN_NS;
static const int64_t fresh_ns = 100 * MS_IN_NS;
static const int64_t timeout_ns = 300 * MS_IN_NS;

void cm1e_drive_want_inputs(cm1e_drive_t *drive)
{
    if (drive->behind)
        drive->behind->digital.wanted_until_ns = drive->now_ns + wanted_ns;
}

uint16_t cm1e_drive_input_mask(const cm1e_drive_t *drive)
{
    if (!drive->kind->signals.by_sdo)
        return drive->image.in_digital.bytes ? UINT16_MAX : 0;
    const uint16_t all = drive->kind->signals.inputs;
    const unsigned in_words = (unsigned)drive->mode.words->inputs >> CM1E_DEVICE_SIGNALS_AT;
    return in_words ? (uint16_t)(all & in_words) : all; /* inputs 5 and 6 "are not replied" (BR 7.1.3, note 2) */
}

uint16_t cm1e_drive_output_mask(const cm1e_drive_t *drive)
{
    if (!drive->kind->signals.by_sdo)
        return drive->image.out_digital.bytes ? UINT16_MAX : 0;
    return drive->kind->signals.outputs;
}

bool cm1e_drive_signals_in_cycle(const cm1e_drive_t *drive) { return !drive->behind || drive->mode.words->inputs != 0; }

static bool reachable(const cm1e_drive_t *drive)
{
    const cm1e_drive_feedback_t *f = &drive->feedback;
    return f->online && f->mode == CM1E_MODE_CSP && (f->state == SWITCHED_ON || f->state == OPERATION_ENABLED);
}

static bool submit(cm1e_drive_t *drive, cm1e_sdo_t *sdo, cm1e_sdo_t transfer)
{
    *sdo = transfer;
    sdo->position = drive->position;
    sdo->timeout_ns = timeout_ns;
    sdo->index = cm1e_drive_index(drive, transfer.index);
    return cm1e_sdo_submit(drive->bus, sdo) == CM1E_OK;
}

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

static void read_ended(cm1e_drive_t *drive, cm1e_sdo_state_t state)
{
    cm1e_drive_digital_t *d = &drive->behind->digital;
    d->reading = false;
    const bool good = state == CM1E_SDO_DONE && d->in_sdo.size > 0 && d->in_sdo.size <= sizeof d->in_data;
    d->read_next_ns = drive->now_ns + (good ? read_again_ns : error_again_ns);
    if (!good)
        return;
    d->inputs = (uint16_t)cm1e_get_uint(d->in_data, (unsigned)d->in_sdo.size) & cm1e_drive_input_mask(drive);
    d->fresh_until_ns = drive->now_ns + fresh_ns;
}

static void step_inputs(cm1e_drive_t *drive)
{
    cm1e_drive_digital_t *d = &drive->behind->digital;
    const bool reached = reachable(drive);
    if (d->reading && cm1e_sdo_state(&d->in_sdo) != CM1E_SDO_BUSY)
        read_ended(drive, cm1e_sdo_state(&d->in_sdo));
    if (!reached)
        d->fresh_until_ns = 0; /* what was read is stale */
    else if (!d->reading && drive->now_ns < d->wanted_until_ns && drive->now_ns >= d->read_next_ns)
        d->reading = submit(drive, &d->in_sdo, (cm1e_sdo_t){.index = OBJ_60FD_DIGITAL_INPUTS, .data = d->in_data,
                                                            .size = sizeof d->in_data});
}

static void show(cm1e_drive_t *drive)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    const cm1e_drive_digital_t *d = &drive->behind->digital;
    if (drive->mode.words->inputs) {
        const unsigned inputs = (unsigned)(f->statusword & drive->mode.words->inputs) >> CM1E_DEVICE_SIGNALS_AT;
        f->digital_inputs = (uint16_t)(inputs & cm1e_drive_input_mask(drive));
        f->digital_known = f->online && f->state != CM1E_FSA_UNKNOWN;
    } else {
        f->digital_inputs = d->inputs;
        f->digital_known = drive->now_ns < d->fresh_until_ns;
    }
}

/* ---- outputs ----------------------------------------------------------------------------------------------------- */

static uint16_t wanted(const cm1e_drive_t *drive)
{
    return drive->command.digital_outputs & cm1e_drive_output_mask(drive);
}

static void write_ended(cm1e_drive_t *drive, bool good)
{
    cm1e_drive_digital_t *d = &drive->behind->digital;
    d->writing = false;
    d->failed = !good;
    if (!good)
        d->write_next_ns = drive->now_ns + error_again_ns;
    else if (d->writing_mask)
        d->mask_written = true;
    else {
        d->outputs = d->writing_outputs;
        d->outputs_known = d->cleared = true;
    }
}

static void step_outputs(cm1e_drive_t *drive)
{
    cm1e_drive_digital_t *d = &drive->behind->digital;
    if (d->writing) {
        const cm1e_sdo_state_t state = cm1e_sdo_state(&d->out_sdo);
        if (state == CM1E_SDO_BUSY)
            return;
        write_ended(drive, state == CM1E_SDO_DONE);
    }
    if (!reachable(drive)) {
        d->outputs_known = false;
        return;
    }
    const uint16_t outputs = wanted(drive);
    if ((d->outputs_known && d->outputs == outputs) || drive->now_ns < d->write_next_ns)
        return;
    /* 60FE:1 may hold values of another master behind a mask of 0. They must not act when the mask opens. */
    d->writing_mask = outputs != 0 && d->cleared && !d->mask_written;
    d->writing_outputs = d->cleared ? outputs : 0;
    cm1e_put_u32(d->out_data, d->writing_mask ? cm1e_drive_output_mask(drive) : d->writing_outputs);
    d->writing = submit(drive, &d->out_sdo, (cm1e_sdo_t){.index = OBJ_60FE_DIGITAL_OUTPUTS,
                                                         .subindex = d->writing_mask ? MASK : OUTPUTS, .write = true,
                                                         .data = d->out_data, .size = sizeof d->out_data});
}

cm1e_drive_outputs_t cm1e_drive_outputs(const cm1e_drive_t *drive)
{
    if (drive->mode.words->outputs || !drive->behind)
        return drive->feedback.online ? CM1E_DRIVE_OUTPUTS_SET : CM1E_DRIVE_OUTPUTS_WAITING;
    const cm1e_drive_digital_t *d = &drive->behind->digital;
    if (d->outputs_known && d->outputs == wanted(drive))
        return CM1E_DRIVE_OUTPUTS_SET;
    if (!reachable(drive))
        return CM1E_DRIVE_OUTPUTS_WAITING;
    return d->failed ? CM1E_DRIVE_OUTPUTS_FAILED : CM1E_DRIVE_OUTPUTS_UNDER_WAY;
}

void cm1e_drive_digital_step(cm1e_drive_t *drive)
{
    step_inputs(drive);
    step_outputs(drive);
    show(drive);
}

void cm1e_drive_digital_forget(cm1e_drive_t *drive)
{
    if (drive->behind)
        drive->behind->digital.mask_written = drive->behind->digital.outputs_known = false;
}
