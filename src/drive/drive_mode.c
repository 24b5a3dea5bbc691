/*
 * The mode of operation. It is in the process data if 0x6060 and 0x6061 are mapped. Otherwise 0x6060 is written by SDO,
 * and 0x6061 is read until it shows the mode (UG 6.2.1; BR 6.2.2 and appendix 3). Some switches of a motor behind a
 * bridge cannot be undone (`asks_mode_first`): its mode is read before the first write, and 0x6060 is written only at
 * rest and without an error.
 */
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

enum { PHASE_IDLE = 0, PHASE_WRITING, PHASE_READING, PHASE_WAIT, PHASE_GIVEN_UP };

static const int64_t mode_timeout_ns = 1000 * MS_IN_NS;
static const int64_t sdo_timeout_ns = 300 * MS_IN_NS;
static const int64_t write_again_ns = 50 * MS_IN_NS;
static const int64_t read_again_ns = CM1E_BRIDGE_MODE_INTERVAL_NS; /* BR appendix 3 */
static const int64_t interval_ns = CM1E_BRIDGE_MODE_INTERVAL_NS + MS_IN_NS;
static const int64_t silence_ns = 10 * MS_IN_NS;    /* 0000h for five cycles before words of another coding */

static const char abnormal[] = "Since power-on the motor was in CMD or CPIO: by way of CML, CSP \"will possibly result "
                               "in operating abnormal\" (BR 6 note 2). Switch the bridge off and on. In CML or CSP "
                               "that is not seen: use Insist then";

bool cm1e_drive_supports(const cm1e_drive_t *drive, cm1e_mode_t mode)
{
    const cm1e_device_mode_t *row = cm1e_device_mode(drive->kind, (int8_t)mode);
    return row && (row->target == CM1E_NO_ROLE || cm1e_drive_slot(drive, row->target)->bytes > 0);
}

const char *cm1e_drive_mode_name(const cm1e_drive_t *drive, int8_t mode)
{
    const cm1e_device_mode_t *row = cm1e_device_mode(drive->kind, mode);
    return row ? row->abbreviation : NULL;
}

/* The mode that the device is in, as far as it is known. */
static const cm1e_device_mode_t *place(const cm1e_drive_t *drive)
{
    const cm1e_device_mode_t *row = cm1e_device_mode(drive->kind, drive->change.read);
    return row && drive->kind->asks_mode_first ? row : drive->mode.wanted;
}

static bool leads(const cm1e_drive_t *drive, const cm1e_device_mode_t *from, const cm1e_device_mode_t *to)
{
    return from == to || to->ways >> (from - drive->kind->modes) & 1;
}

cm1e_error_t cm1e_drive_mode_check(const cm1e_drive_t *drive, cm1e_mode_t mode, bool insist, const char **why)
{
    const cm1e_device_mode_t *to = cm1e_device_mode(drive->kind, (int8_t)mode), *from = place(drive);
    const char *text = NULL;
    cm1e_error_t error = CM1E_OK;
    if (!cm1e_drive_supports(drive, mode)) {
        error = CM1E_ERROR_UNSUPPORTED;
        text = "The drive, or the mapping that it runs with, does not have this mode of operation";
    } else if (!leads(drive, from, to)) {
        error = CM1E_ERROR_STATE;
        text = drive->kind->no_way;
    } else if (drive->change.abnormal && !insist && !from->torque && to->torque && !to->leaves_abnormal) {
        error = CM1E_ERROR_STATE;
        text = abnormal;
    }
    if (why)
        *why = text;
    return error;
}

/* ---- start-up --------------------------------------------------------------------------------------------------- */

static cm1e_error_t read_first(cm1e_drive_t *drive, int8_t *shown, cm1e_diag_t *diag)
{
    size_t size = sizeof *shown;
    const uint16_t index = cm1e_drive_index(drive, OBJ_6061_MODES_OF_OPERATION_DISPLAY);
    const cm1e_error_t error = cm1e_sdo_read(drive->bus, drive->position, index, 0, shown, &size, diag);
    if (error == CM1E_OK && size != sizeof *shown)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, 0,
                             "Axis \"%s\" (slave %u): object 0x%04X was read with %zu bytes instead of 1.",
                             drive->config->name, drive->position, index, size);
    return error;
}

/* Further switches are made in the cycle, if a way leads to the first mode. */
static cm1e_error_t ask_first(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    const cm1e_error_t error = read_first(drive, &drive->change.read, diag);
    if (error != CM1E_OK)
        return error;
    const cm1e_device_mode_t *row = cm1e_device_mode(drive->kind, drive->change.read);
    if (!row || !leads(drive, row, drive->mode.wanted))
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "Axis \"%s\" (slave %u): object 0x%04X shows mode %d (%s), from which no way leads to %s. "
                             "%s.", drive->config->name, drive->position,
                             cm1e_drive_index(drive, OBJ_6061_MODES_OF_OPERATION_DISPLAY), drive->change.read,
                             row ? row->abbreviation : "unknown", drive->mode.wanted->abbreviation,
                             drive->kind->no_way);
    cm1e_drive_want_mode(drive, row);
    drive->change.shown = drive->change.read;
    drive->change.known = true;
    return CM1E_OK;
}

cm1e_error_t cm1e_drive_mode_init(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    const cm1e_mode_t of_mapping = drive->kind->mappings[drive->config->mapping].first_mode;
    const cm1e_mode_t first = cm1e_drive_supports(drive, of_mapping) ? of_mapping : CM1E_MODE_CSV;
    if (!cm1e_drive_supports(drive, first))
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, OBJ_607A_TARGET_POSITION,
                             "Axis \"%s\" (slave %u): the process data have neither object 0x607A, Target position, "
                             "nor 0x60FF, Target velocity. Choose other PDOs.", drive->config->name, drive->position);
    cm1e_drive_want_mode(drive, cm1e_device_mode(drive->kind, (int8_t)first));
    drive->command.mode = first;
    if (drive->image.out_mode.bytes)
        return CM1E_OK;
    if (cm1e_drive_is_absent(drive)) {
        cm1e_drive_mode_forget(drive);
        return CM1E_OK;
    }
    if (drive->kind->asks_mode_first)
        return ask_first(drive, diag);
    const int8_t mode = (int8_t)drive->mode.commanded;
    const uint16_t index = cm1e_drive_index(drive, OBJ_6060_MODES_OF_OPERATION);
    const cm1e_error_t error = cm1e_sdo_write(drive->bus, drive->position, index, 0, &mode, 1, diag);
    int8_t shown = 0;
    const cm1e_error_t read_error = error != CM1E_OK ? error : read_first(drive, &shown, diag);
    /* A slow device shows the mode later: the cycle asks again (cm1e_drive_mode_step). */
    drive->change.shown = shown == mode ? shown : CM1E_MODE_NONE;
    return read_error;
}

/* ---- the cycle -------------------------------------------------------------------------------------------------- */

static void submit(cm1e_drive_t *drive, bool write)
{
    drive->change.data = (int8_t)drive->mode.commanded;
    drive->change.sdo = (cm1e_sdo_t){
        .position = drive->position, .write = write, .data = &drive->change.data, .size = 1,
        .index = cm1e_drive_index(drive, write ? OBJ_6060_MODES_OF_OPERATION : OBJ_6061_MODES_OF_OPERATION_DISPLAY),
        .timeout_ns = sdo_timeout_ns,
    };
    if (cm1e_sdo_submit(drive->bus, &drive->change.sdo) != CM1E_OK) {
        drive->change.retry_ns = drive->now_ns + write_again_ns;
        return;
    }
    drive->change.phase = write ? PHASE_WRITING : PHASE_READING;
    if (!write)
        return;
    drive->change.wrote = drive->change.data;
    drive->change.uncertain = true;
    drive->change.shown = CM1E_MODE_NONE;
    drive->change.abnormal |= drive->mode.wanted->leaves_abnormal;
}

/* Another mode was commanded meanwhile than the one that is written. The display may still show the mode before, and
 * changes to the written one later: it proves nothing until the commanded mode is written too. */
static bool is_outdated(const cm1e_drive_t *drive)
{
    return drive->change.uncertain && drive->change.wrote != (int8_t)drive->mode.commanded;
}

/* Whether the device was away meanwhile, and may have forgotten its mode. */
static bool is_forgotten(const cm1e_drive_t *drive) { return drive->kind->asks_mode_first && !drive->change.known; }

static void read_done(cm1e_drive_t *drive)
{
    const cm1e_device_mode_t *before = cm1e_device_mode(drive->kind, drive->change.read);
    drive->change.read = drive->change.sdo.size == 1 ? drive->change.data : (int8_t)CM1E_MODE_NONE;
    const cm1e_device_mode_t *now = cm1e_device_mode(drive->kind, drive->change.read);
    /* The device is in a mode that no way leads to: it was switched off and on. */
    if (before && now && !drive->change.known && !leads(drive, before, now))
        drive->change.abnormal = false;
    drive->change.abnormal |= now && now->leaves_abnormal;
    /* The device may have been switched off and show a mode that was not commanded: that mode is the new starting
     * point. */
    if (now && is_forgotten(drive) && !drive->change.uncertain)
        cm1e_drive_want_mode(drive, now);
    drive->change.known = true;
    if (drive->change.read == (int8_t)drive->mode.commanded && !is_outdated(drive))
        drive->change.uncertain = false;
    drive->change.shown = drive->change.uncertain ? (int8_t)CM1E_MODE_NONE : drive->change.read;
    drive->change.phase = drive->change.uncertain ? PHASE_WAIT : PHASE_IDLE;
    drive->change.retry_ns = drive->now_ns + (drive->change.uncertain ? read_again_ns : 0);
}

static bool shows_fault(const cm1e_drive_t *drive, const cm1e_device_mode_t *mode)
{
    return mode->words->commands || drive->feedback.statusword & mode->words->fault;
}

/* BR appendix 3: "Confirm No Error Occurs". While a switch is under way the feedback shows no fault, because the
 * statusword may be of either mode: a fault is one in both. In CMD the statusword shows no fault (BR 7.1.3), so F530 is
 * read. */
static bool is_sound(cm1e_drive_t *drive)
{
    if (place(drive)->words->commands)
        return cm1e_drive_bridge_sound(drive);
    return !shows_fault(drive, place(drive)) || !shows_fault(drive, drive->mode.wanted);
}

static bool may_write(cm1e_drive_t *drive)
{
    const int64_t now_ns = drive->now_ns;
    if (!leads(drive, place(drive), drive->mode.wanted) || now_ns < drive->change.from_ns ||
        now_ns < drive->change.write_ns + interval_ns)
        return false;
    return !drive->mode.wanted->rest || (cm1e_drive_rests(drive) && drive->feedback.fresh && is_sound(drive));
}

static bool expired(cm1e_drive_t *drive)
{
    if (drive->change.deadline_ns == 0)
        drive->change.deadline_ns = drive->now_ns + mode_timeout_ns;
    return drive->kind->mode_supervised && drive->now_ns >= drive->change.deadline_ns;
}

static void give_up(cm1e_drive_t *drive)
{
    const bool kept_back = !drive->change.uncertain && drive->mode.wanted->rest && !cm1e_drive_rests(drive);
    cm1e_drive_fail(drive, CM1E_ERROR_DRIVE_MODE_TIMEOUT);
    drive->fault.turned |= kept_back;
    drive->change.phase = PHASE_GIVEN_UP;
    drive->change.shown = drive->change.read;
}

/* Called while no SDO transfer is under way. */
static void go_on(cm1e_drive_t *drive)
{
    if (drive->change.shown == (int8_t)drive->mode.commanded || drive->change.phase == PHASE_GIVEN_UP)
        return;
    if (expired(drive)) {
        give_up(drive);
        return;
    }
    if (drive->now_ns < drive->change.retry_ns)
        return;
    const bool fresh = !is_outdated(drive) && drive->now_ns - drive->change.write_ns < write_again_ns;
    if (drive->change.phase == PHASE_WAIT && fresh)
        submit(drive, false);
    else if (is_forgotten(drive))
        submit(drive, false);
    else if (may_write(drive))
        submit(drive, true);
    else if (drive->change.phase == PHASE_WAIT)
        submit(drive, false);
}

/* A transfer that ended in an error may have arrived. A transfer that the device has forgotten proves nothing. */
static void written(cm1e_drive_t *drive, bool good)
{
    drive->change.write_ns = drive->now_ns;
    drive->change.phase = good && !is_forgotten(drive) ? PHASE_WAIT : PHASE_IDLE;
    drive->change.uncertain &= !is_forgotten(drive);
    drive->change.retry_ns = drive->now_ns + (good ? 0 : write_again_ns);
}

/* A motor that moves keeps the next write back, but 0x6061 is read again. */
static void not_read(cm1e_drive_t *drive)
{
    drive->change.uncertain &= !is_forgotten(drive);
    drive->change.phase = drive->change.uncertain ? PHASE_WAIT : PHASE_IDLE;
    drive->change.retry_ns = drive->now_ns + write_again_ns;
}

void cm1e_drive_mode_step(cm1e_drive_t *drive)
{
    if (drive->image.out_mode.bytes)
        return;
    const bool away = drive->kind->asks_mode_first && !cm1e_drive_operational(drive);
    if (away && drive->change.known) /* it may have been switched off */
        cm1e_drive_mode_forget(drive);
    if (drive->change.phase != PHASE_WRITING && drive->change.phase != PHASE_READING) {
        if (away)
            drive->change.deadline_ns = 0; /* its time begins when it is there again */
        else
            go_on(drive);
        return;
    }
    const cm1e_sdo_state_t state = cm1e_sdo_state(&drive->change.sdo);
    if (state == CM1E_SDO_BUSY)
        return;
    if (drive->change.phase == PHASE_WRITING)
        written(drive, state == CM1E_SDO_DONE);
    else if (state == CM1E_SDO_DONE)
        read_done(drive);
    else
        not_read(drive);
}

void cm1e_drive_mode_forget(cm1e_drive_t *drive)
{
    drive->change.known = false;
    drive->change.deadline_ns = 0;
    drive->change.retry_ns = drive->now_ns;
    if (drive->change.phase == PHASE_WRITING || drive->change.phase == PHASE_READING)
        return;
    drive->change.phase = PHASE_IDLE;
    drive->change.uncertain = false;
    drive->change.shown = CM1E_MODE_NONE;
}

/* A switch that the process data cannot supervise is waited for, whatever its result. */
static bool under_way(const cm1e_drive_t *drive)
{
    if (drive->kind->asks_mode_first)
        return drive->change.shown != (int8_t)drive->mode.commanded && drive->change.phase != PHASE_GIVEN_UP;
    return drive->torque.was_enabled && drive->feedback.mode != (int8_t)drive->mode.commanded;
}

/* A mode whose words have another coding is entered without torque only. */
static bool needs_less(const cm1e_drive_t *drive, const cm1e_device_mode_t *to)
{
    const cm1e_fsa_state_t state = drive->feedback.state;
    if (to->words == drive->mode.words)
        return false;
    return drive->torque.asked || state == SWITCHED_ON || state == OPERATION_ENABLED || cm1e_drive_cmd_moves(drive);
}

/* Makes one switch at a time. Until the display shows the last one, the mode that acts on the next process data is
 * unknown. */
void cm1e_drive_mode_choose(cm1e_drive_t *drive)
{
    const cm1e_mode_t wanted = drive->command.mode;
    if (wanted == drive->mode.commanded || wanted == CM1E_MODE_NONE)
        return;
    const cm1e_device_mode_t *row = cm1e_device_mode(drive->kind, (int8_t)wanted);
    if (!row || under_way(drive) || needs_less(drive, row))
        return;
    if (drive->kind->asks_mode_first &&
        cm1e_drive_mode_check(drive, wanted, drive->command.mode_insist, NULL) != CM1E_OK)
        return;
    cm1e_drive_want_mode(drive, row);
    drive->torque.confirmed = false;
    drive->change.deadline_ns = drive->now_ns + mode_timeout_ns;
    drive->change.from_ns = drive->now_ns + (row->words == drive->mode.words ? 0 : silence_ns);
    if (drive->change.phase == PHASE_GIVEN_UP)
        drive->change.phase = PHASE_IDLE;
}
