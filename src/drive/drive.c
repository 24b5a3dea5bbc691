/* The drive in the cycle: reading, the way to Operation enabled, and what may pass to the motor. */
#include "drive/drive.h"

#include <stdlib.h>
#include <string.h>

#include "drive/drive_kind.h"
#include "drive/drive_private.h"
#include "drive/drive_wiring.h"

static const int64_t enable_timeout_ns = 2000 * MS_IN_NS;
/* A controlword shows in the statusword some cycles later. After the torque was taken away, it is not requested again
 * for this time. Otherwise the answer to the old command would look like a loss of the new torque. */
static const int64_t torque_pause_ns = 20 * MS_IN_NS;
/* At the latest then, after the torque was taken away, a quick stop that the drive has begun by itself is ended. */
static const int64_t quick_stop_ns = 10000 * MS_IN_NS;
/* So long it may show torque after that. */
static const int64_t disable_timeout_ns = 2000 * MS_IN_NS;
/* Of the velocity that the motor may have: below this part a quick stop counts as over. */
enum { QUICK_STOP_PART = 100 };

/* cm1e_bus_identify() has matched the slave with the axis. A bus without that step may have another device there. */
static cm1e_error_t find_device(cm1e_drive_t *drive, const cm1e_drive_kind_t **kind, cm1e_diag_t *diag)
{
    const cm1e_slave_info_t *slave = cm1e_bus_slave(drive->bus, drive->position);
    const cm1e_device_t *expected = cm1e_device_configured(drive->config);
    drive->device = slave && slave->device ? slave->device : expected;
    drive->kind = drive->device ? cm1e_device_drive(drive->device, drive->config->channel) : NULL;
    *kind = cm1e_drive_kind(drive->device);
    if (drive->kind && *kind && cm1e_device_same_kind(drive->device, expected) && slave)
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                         "Axis \"%s\" (slave %u): channel %u is configured; the slave would have to be an EtherCAT "
                         "Cool MUSCLE Bridge, which has channels 1 ... %u.", drive->config->name, drive->position,
                         drive->config->channel, CM1E_BRIDGE_AXES);
}

static cm1e_error_t init_motor(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    drive->position = cm1e_bus_axis_position(drive->bus, drive->axis);
    if (drive->position == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "Axis \"%s\" has no slave on the bus.",
                             drive->config->name);
    const cm1e_drive_kind_t *kind;
    cm1e_error_t error = find_device(drive, &kind, diag);
    if (error != CM1E_OK)
        return error;
    drive->feedback.state = CM1E_FSA_UNKNOWN;
    drive->range.velocity_unit = 1;
    drive->range.velocity_believed = (int64_t)(2.0 * cm1e_unit_peak_velocity(drive->config));
    drive->range.velocity_possible = (int64_t)(1.25 * cm1e_unit_peak_velocity(drive->config));
    drive->step = kind->step;
    drive->range.position_least = INT32_MIN;
    drive->range.position_most = INT32_MAX;
    error = kind->init(drive, diag);
    if (error == CM1E_OK)
        error = cm1e_drive_resolve(drive, diag);
    return error != CM1E_OK ? error : cm1e_drive_mode_init(drive, diag);
}

cm1e_error_t cm1e_drive_init(cm1e_drive_t *drive, cm1e_bus_t *bus, uint32_t axis, cm1e_diag_t *diag)
{
    memset(drive, 0, sizeof *drive);
    const cm1e_bus_config_t *config = cm1e_bus_configuration(bus);
    if (axis >= config->axis_count)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no axis %u: the configuration has %u.",
                             (unsigned)axis, (unsigned)config->axis_count);
    drive->bus = bus;
    drive->axis = axis;
    drive->config = &config->axes[axis];
    const bool has_motor = drive->config->type == CM1E_AXIS_MOTOR;
    const cm1e_error_t error = has_motor ? init_motor(drive, diag) : cm1e_drive_init_virtual(drive);
    return error != CM1E_OK ? error : cm1e_drive_wire(drive, diag);
}

void cm1e_drive_free(cm1e_drive_t *drive)
{
    free(drive->behind);
    free(drive->foreign);
    free(drive->wiring);
    drive->behind = NULL;
    drive->foreign = NULL;
    drive->wiring = NULL;
}

const cm1e_entry_t *cm1e_drive_entry(const cm1e_drive_t *drive, uint16_t index, uint8_t subindex)
{
    if (cm1e_drive_is_virtual(drive))
        return NULL;
    const cm1e_entry_t *entry = drive->device->entry(drive->device, cm1e_drive_index(drive, index), subindex);
    return entry && entry->availability == CM1E_AVAILABLE ? entry : NULL;
}

/* The slave has come for the first time: its process data lie elsewhere in its room, and its firmware is known. */
static void bind(cm1e_drive_t *drive)
{
    const cm1e_drive_image_t before = drive->image;
    const cm1e_drive_kind_t *kind = cm1e_drive_kind(drive->device);
    drive->bound = drive->watch.bound;
    drive->unbound = kind && kind->bind ? kind->bind(drive) : CM1E_OK;
    if (drive->unbound == CM1E_OK)
        drive->unbound = cm1e_drive_resolve(drive, NULL);
    if (drive->unbound != CM1E_OK) {
        drive->image = before;
        cm1e_drive_fail(drive, drive->unbound);
        return;
    }
    cm1e_drive_mode_forget(drive);
}

/* After some cycles without a frame the state of the slave is known when the supervision has seen it again; no watchdog
 * ends before. */
static void note_offline(cm1e_drive_t *drive)
{
    enum { SOME_CYCLES = 5 };
    if (drive->offline < SOME_CYCLES)
        drive->offline++;
    else
        drive->looks = cm1e_bus_slave_looks(drive->bus, drive->position);
}

void cm1e_drive_read(cm1e_drive_t *drive, bool bus_ok, int64_t now_ns)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    drive->now_ns = now_ns;
    drive->ordinary.calm = false;
    if (drive->wiring)
        cm1e_drive_wiring_read(drive);
    if (cm1e_drive_is_virtual(drive)) {
        cm1e_drive_virtual_read(drive);
        return;
    }
    drive->watch = cm1e_bus_slave_watch(drive->bus, drive->position);
    bus_ok = bus_ok && !drive->watch.out && drive->unbound == CM1E_OK;
    drive->answered = bus_ok;
    if (drive->bound != drive->watch.bound)
        bind(drive);
    cm1e_drive_mode_step(drive);
    f->fresh = bus_ok || (drive->watch.fresh && drive->unbound == CM1E_OK);
    if (f->fresh)
        cm1e_drive_decode(drive);
    f->online = bus_ok && cm1e_drive_operational(drive);
    if (f->online)
        drive->offline = 0;
    else
        note_offline(drive);
    if (f->state != OPERATION_ENABLED || !drive->mode.may_hold)
        drive->target.holds = false;
    else if (f->mode == CM1E_MODE_NONE)
        drive->target.holds = true;
    if (drive->step)
        drive->step(drive);
    if (drive->reset.phase != RESET_IDLE) {
        cm1e_drive_reset_step(drive);
        f->enabled = false;
        return;
    }
    const bool operating = drive->mode.operates && drive->torque.asked;
    const bool shown = f->mode == (int8_t)drive->mode.commanded;
    cm1e_drive_latch_faults(drive);
    if (operating && f->online && drive->actual.distrusted == 0)
        drive->torque.was_enabled = true;
    if (operating && shown && f->online)
        drive->torque.confirmed = true;
    /* A single lost frame changes nothing: the last inputs hold until the supervision reports the bus as lost. */
    f->enabled = operating && shown && drive->torque.was_enabled &&
                 (drive->fault.error == CM1E_OK || drive_fault_allows_ramp(drive->fault.error));
}

int64_t cm1e_drive_sent_ns(const cm1e_drive_t *drive) { return cm1e_bus_sent_ns(drive->bus); }

/* Reports an error to a caller that requests torque where there will be none. */
static void refuse_torque(cm1e_drive_t *drive)
{
    const bool asked = drive->command.enable && !drive->torque.asked && drive->actual.seen && drive->feedback.online;
    /* As a target it would be clamped, which is a jump. */
    if (asked && !cm1e_drive_in_range(drive, drive->feedback.position))
        cm1e_drive_fail(drive, CM1E_ERROR_AXIS_POSITION_RANGE);
    if (!asked || drive->mode.takes_torque || drive->waits.blocked_ns == 0) /* 0: not set yet */
        drive->waits.blocked_ns = drive->now_ns;
    else if (drive->now_ns - drive->waits.blocked_ns >= enable_timeout_ns)
        cm1e_drive_fail(drive, CM1E_ERROR_DRIVE_ENABLE_TIMEOUT);
}

/* Whether the drive may still be on a ramp of its own, which ends with its torque. */
static bool brakes_by_itself(const cm1e_drive_t *drive)
{
    const int64_t slow = drive->range.velocity_possible / QUICK_STOP_PART;
    return llabs((int64_t)drive->feedback.velocity) > slow &&
           drive->now_ns < drive->waits.torque_from_ns + quick_stop_ns;
}

/* Nobody waits for ever for a drive that does not obey: that its motor has torque is an error, also while power is
 * off. */
static void watch_torque(cm1e_drive_t *drive)
{
    cm1e_drive_waits_t *waits = &drive->waits;
    const cm1e_drive_feedback_t *f = &drive->feedback;
    const bool shown = cm1e_drive_shows_torque(drive) && !f->motor_free;
    cm1e_drive_torque_t *torque = &drive->torque;
    torque->gives_up = torque->asked || (torque->gives_up && (shown || !f->online));
    const bool told = !torque->asked && drive->reset.phase == RESET_IDLE && drive->mode.takes_torque;
    const bool kept = told && f->online && shown && (drive->command.enable || torque->gives_up);
    if (!kept || brakes_by_itself(drive))
        waits->kept_ns = 0;
    else if (waits->kept_ns == 0)
        waits->kept_ns = drive->now_ns;
    else if (drive->now_ns - waits->kept_ns >= disable_timeout_ns)
        cm1e_drive_fail(drive, CM1E_ERROR_DRIVE_KEEPS_TORQUE);
}

static bool wants_torque(const cm1e_drive_t *drive)
{
    if (!drive->command.enable || !drive->actual.seen || drive->reset.phase != RESET_IDLE || !drive->mode.takes_torque)
        return false;
    if (drive->fault.error != CM1E_OK)
        return drive_fault_allows_ramp(drive->fault.error) && drive->feedback.enabled;
    if (!drive->torque.asked && (cm1e_drive_shows_torque(drive) || drive->now_ns < drive->waits.torque_from_ns))
        return false;
    /* A jump of the position on the way to torque: it would be a target. The way begins anew. */
    if (!drive->torque.was_enabled && drive->actual.distrusted > 0)
        return false;
    /* Without fresh inputs the actual position is unknown, so the drive takes no step towards torque. */
    return drive->feedback.online || drive->torque.was_enabled;
}

static uint16_t mode_bits(cm1e_drive_t *drive, bool pass)
{
    const cm1e_drive_command_t *command = &drive->command;
    const int8_t shown = drive->feedback.mode;
    uint16_t bits = 0;
    if (command->halt && drive->mode.shown && drive->mode.shown->halts)
        bits |= CONTROLWORD_HALT;
    if (shown == CM1E_MODE_HM && pass && command->homing_start)
        bits |= CONTROLWORD_HOMING_START;
    if (shown == CM1E_MODE_PP && pass) { /* UG 6.2.2: edge and acknowledge announce a set-point */
        if (drive->target.set_point_bit && drive->feedback.bit12) {
            drive->target.set_point_bit = false;
        } else if (!drive->target.set_point_bit && !drive->feedback.bit12 && !command->halt &&
                   command->target_position != drive->target.set_point) {
            drive->target.set_point_bit = true;
            drive->target.set_point = command->target_position;
        }
        if (drive->target.set_point_bit)
            bits |= CONTROLWORD_NEW_SET_POINT;
    }
    return bits;
}

/* A drive that is in Quick stop active by itself brakes, and may stay in that state under torque (0x605A). Shutdown
 * does not lead out of it, but Disable voltage does (CiA 402, transition 12). It waits until the ramp of the drive is
 * over. */
static bool ends_quick_stop(const cm1e_drive_t *drive)
{
    return drive->feedback.state == QUICK_STOP_ACTIVE && !brakes_by_itself(drive);
}

/* During a switch to a mode with other words, the present words are meaningless. */
static uint16_t no_torque_word(const cm1e_drive_t *drive)
{
    const cm1e_device_words_t *words = drive->mode.words;
    if (words != drive->mode.wanted->words)
        return 0;
    if (words->commands)
        return cm1e_drive_cmd_word(drive);
    return ends_quick_stop(drive) ? cm1e_fsa_commands[COMMAND_DISABLE_VOLTAGE].controlword : words->no_torque;
}

/* The torque comes with a target where the motor is, so not with one that was made cycles ago; but what was commanded
 * before stays. */
static bool is_too_late(const cm1e_drive_t *drive, cm1e_fsa_command_t command)
{
    const uint16_t enables = cm1e_fsa_commands[COMMAND_ENABLE_OPERATION].controlword;
    return drive->target.late && command == COMMAND_ENABLE_OPERATION &&
           (drive->ordinary.controlword & enables) != enables;
}

/* Sends one command per cycle, chosen from the state that the drive shows (UG 6.1.2, BR 6.1.2). */
static uint16_t controlword(cm1e_drive_t *drive, bool pass)
{
    const cm1e_drive_feedback_t *f = &drive->feedback;
    const cm1e_device_words_t *words = drive->mode.words;
    if (drive->reset.phase == RESET_EDGE && words == drive->mode.wanted->words && !words->commands)
        return words->fault_reset;
    if (!drive->torque.asked || f->state >= CM1E_FSA_STATE_COUNT)
        return no_torque_word(drive);
    /* Switched on without motor power is a drive fault (UG 6.1.1). The mode must be the right one by then, too. */
    const bool ready = f->voltage && f->mode == (int8_t)drive->mode.commanded;
    if (!ready && f->state != OPERATION_ENABLED)
        return no_torque_word(drive);
    cm1e_fsa_command_t command = cm1e_fsa_next_command(f->state, true);
    if (is_too_late(drive, command))
        command = COMMAND_SWITCH_ON;
    if (command == COMMAND_FAULT_RESET || command >= CM1E_FSA_COMMAND_COUNT)
        return no_torque_word(drive);
    uint16_t word = cm1e_fsa_commands[command].controlword;
    if (f->state == OPERATION_ENABLED)
        word |= (uint16_t)(mode_bits(drive, pass) | (drive->mode.shown ? drive->mode.shown->controlword : 0));
    return word;
}

static uint16_t signals(const cm1e_drive_t *drive)
{
    const cm1e_device_words_t *words = drive->mode.words;
    const unsigned outputs = drive->command.digital_outputs & cm1e_drive_output_mask(drive);
    return (uint16_t)(words->mark | (outputs << CM1E_DEVICE_SIGNALS_AT & words->outputs));
}

/* The position to write while the caller's target is not used. It is the actual position. While the drive shows torque
 * in a mode that holds a position, it is the last target: the motor does not sag by its lag, and a stale actual
 * position cannot move it. */
static int32_t safe_position(const cm1e_drive_t *drive)
{
    return drive->target.holds ? drive->target.position : drive->feedback.position;
}

static int32_t slewed(int32_t from, int32_t to, int32_t step)
{
    const int64_t way = (int64_t)to - from;
    return step == 0 || llabs(way) <= step ? to : from + (way > 0 ? step : -step);
}

/* CSP. Without an answer to the last frame the drive may hold its target or an earlier one, so the last target is
 * repeated. The next frame that arrives then carries the step of one cycle, however many frames were lost before it.
 * Otherwise the target stays within one step of the last target, or of the actual position. */
static int32_t next_position(const cm1e_drive_t *drive)
{
    const int32_t wanted = drive->command.target_position, last = drive->target.position;
    const int32_t step = drive->command.position_step;
    if (drive->mode.wanted->mode != CM1E_MODE_CSP)
        return wanted;
    if (!drive->answered)
        return last;
    if (drive->feedback.fresh && llabs(cm1e_drive_way_between(drive->feedback.position, wanted)) <= step)
        return wanted;
    return (int32_t)((uint32_t)last + (uint32_t)slewed(0, (int32_t)cm1e_drive_way_between(last, wanted), step));
}

/* CSV. After lost frames the velocity changes in limited steps: a position loop that was without inputs, or the frames
 * that were lost, cause no jump. */
static int32_t next_velocity(cm1e_drive_t *drive)
{
    const int32_t wanted = drive->command.target_velocity;
    if (drive->mode.wanted->mode != CM1E_MODE_CSV)
        return wanted;
    cm1e_drive_target_t *target = &drive->target;
    target->slewing |= !drive->answered;
    const int32_t next = target->slewing ? slewed(target->velocity, wanted, drive->command.velocity_step) : wanted;
    target->slewing = !drive->answered || next != wanted;
    return next;
}

void cm1e_drive_write(cm1e_drive_t *drive)
{
    const cm1e_drive_command_t *command = &drive->command;
    if (cm1e_drive_is_virtual(drive)) {
        cm1e_drive_virtual_write(drive);
        return;
    }
    if (cm1e_drive_reset_asked(drive) && drive->reset.phase == RESET_IDLE)
        cm1e_drive_reset_start(drive);

    if (!drive->torque.asked)
        refuse_torque(drive);
    watch_torque(drive);
    const bool torque = wants_torque(drive);
    if (torque && !drive->torque.asked)
        drive->waits.enable_deadline_ns = drive->now_ns + enable_timeout_ns;
    if (!torque && drive->torque.asked)
        drive->waits.torque_from_ns = drive->now_ns + torque_pause_ns;
    if (!torque) {
        drive->torque.was_enabled = false;
        drive->feedback.enabled = false;
    }
    drive->torque.asked = torque;
    cm1e_drive_mode_choose(drive);

    const bool pass = drive->feedback.enabled && drive->feedback.mode == (int8_t)drive->mode.commanded;
    if (!pass) {
        drive->target.set_point_bit = false;
        drive->target.set_point = drive->feedback.position;
    }
    const bool follow = pass && !drive->fault.slave_absent;
    const bool held_before = drive->target.holds;
    drive->target.holds |= follow && drive->mode.holds;
    int32_t position = safe_position(drive);
    if (follow && drive->mode.holds && cm1e_drive_in_range(drive, command->target_position))
        position = held_before || !drive->answered ? next_position(drive) : command->target_position;
    else if (follow && drive->mode.holds)
        cm1e_drive_fail(drive, CM1E_ERROR_AXIS_POSITION_RANGE); /* the last target holds until the torque goes */
    const uint16_t word = controlword(drive, pass) | (drive->mode.marked ? signals(drive) : 0);
    cm1e_drive_encode(drive, word, position, follow ? next_velocity(drive) : 0);
    drive->target.late = false;
    cm1e_drive_note_calm(drive, word);
}
