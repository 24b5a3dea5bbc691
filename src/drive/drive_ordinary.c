/*
 * The short ways of an ordinary cycle: the drive has torque, follows set positions in CSP, and shows what it showed in
 * the cycle before but for its measured values. Then nothing is to be decided: the values are taken from the wire and
 * the next target is put there. Whatever else has happened or is commanded takes the long ways (cm1e_drive_read(),
 * cm1e_drive_write()), which decide by the same numbers; after them cm1e_drive_note_calm() looks again. Both ways give
 * the same bits (test_axis_ordinary).
 */
#include "core/bytes.h"
#include "core/rare.h"
#include "drive/drive_private.h"

/* Between two answers; beyond it the way that the motor tells takes more care (way_in() of drive_io.c). */
static const int64_t longest_ns = 4 * S_IN_NS;

/* What the device shows. */
static bool shows_calm(const cm1e_drive_t *drive)
{
    const cm1e_drive_feedback_t *f = &drive->feedback;
    const cm1e_drive_actual_t *actual = &drive->actual;
    return f->online && f->fresh && f->enabled && f->voltage && !f->fault && drive->mode.operates &&
           f->mode == CM1E_MODE_CSP && actual->seen && actual->rejected == 0 && actual->contradictions == 0 &&
           actual->distrusted == 0;
}

/* What the library does with it. */
static bool is_led(const cm1e_drive_t *drive)
{
    return drive->torque.asked && drive->torque.was_enabled && drive->torque.confirmed &&
           drive->mode.commanded == CM1E_MODE_CSP && drive->mode.takes_torque && drive->mode.may_hold &&
           drive->mode.holds && drive->target.holds && !drive->mode.marked && !drive->target.set_point_bit &&
           !drive->command.halt && !drive->command.reset && !drive->reset.before && drive->reset.phase == RESET_IDLE;
}

void cm1e_drive_note_calm(cm1e_drive_t *drive, uint16_t controlword)
{
    drive->ordinary.controlword = controlword;
    drive->ordinary.calm = drive->wire.known && !drive->step && !drive->wiring && drive->fault.error == CM1E_OK &&
                           !drive->fault.slave_absent && drive->unbound == CM1E_OK && is_led(drive) &&
                           shows_calm(drive);
}

CM1E_RARE static void renew(cm1e_drive_t *drive, int64_t elapsed_ns)
{
    drive->ordinary.elapsed_ns = elapsed_ns;
    drive->ordinary.farthest = cm1e_drive_farthest(drive, elapsed_ns);
    drive->ordinary.tolerance = cm1e_drive_tolerance(drive, elapsed_ns);
}

bool cm1e_drive_read_ordinary(cm1e_drive_t *drive, int64_t now_ns)
{
    cm1e_drive_feedback_t *f = &drive->feedback;
    const cm1e_drive_wire_t *wire = &drive->wire;
    if (!drive->ordinary.calm || !cm1e_bus_slave_goes_on(drive->bus, drive->position, &drive->watch))
        return false;
    const uint8_t *in = cm1e_bus_inputs(drive->bus) + wire->in;
    const int64_t elapsed_ns = now_ns - drive->actual.read_ns;
    if (cm1e_get_u16(in) != f->statusword || (int8_t)in[wire->in_mode] != f->mode || elapsed_ns <= 0)
        return false;
    if (elapsed_ns != drive->ordinary.elapsed_ns) {
        if (elapsed_ns > longest_ns)
            return false;
        renew(drive, elapsed_ns);
    }
    const int32_t position = (int32_t)cm1e_get_u32(in + wire->in_position);
    const int64_t way = cm1e_drive_way_between(f->position, position);
    const int64_t shown = (int32_t)cm1e_get_u32(in + wire->in_velocity);
    const int32_t velocity = cm1e_drive_clamp(shown * drive->range.velocity_unit);
    if (llabs(way) > drive->ordinary.farthest ||
        cm1e_drive_ways_differ(way, velocity * elapsed_ns / S_IN_NS, drive->ordinary.tolerance))
        return false;
    drive->now_ns = drive->actual.read_ns = now_ns;
    drive->actual.sent_ns = cm1e_bus_sent_ns(drive->bus);
    drive->answered = true;
    f->position = position;
    f->velocity = velocity;
    f->error_code = cm1e_get_u16(in + wire->in_error);
    f->torque = (int16_t)cm1e_get_u16(in + wire->in_torque);
    f->digital_inputs = cm1e_get_u16(in + wire->in_digital);
    f->temperature = (int16_t)cm1e_get_u16(in + wire->in_temperature);
    f->dc_link_decivolt = (int16_t)cm1e_get_u16(in + wire->in_dc);
    return true;
}

bool cm1e_drive_write_ordinary(cm1e_drive_t *drive)
{
    const cm1e_drive_command_t *command = &drive->command;
    const cm1e_drive_wire_t *wire = &drive->wire;
    const int32_t position = command->target_position, velocity = command->target_velocity;
    if (!drive->ordinary.calm || !drive->answered || !command->enable || command->reset || command->halt ||
        command->mode != CM1E_MODE_CSP || !cm1e_drive_in_range(drive, position) ||
        llabs(cm1e_drive_way_between(drive->target.position, position)) > command->position_step)
        return false;
    uint8_t *out = cm1e_bus_outputs(drive->bus) + wire->out;
    cm1e_put_u16(out, drive->ordinary.controlword);
    cm1e_put_u16(out + wire->out_digital,
                 (uint16_t)((uint32_t)command->digital_outputs << drive->kind->signals.output_shift));
    cm1e_put_u32(out + wire->out_position, (uint32_t)position);
    cm1e_put_u32(out + wire->out_velocity, velocity ? (uint32_t)cm1e_drive_velocity_on_wire(drive, velocity) : 0);
    out[wire->out_mode] = CM1E_MODE_CSP;
    drive->target.position = position;
    drive->target.velocity = velocity;
    return true;
}
