/* Describes the latched fault in sentences: the axis, the cause, its numbers, and the cure. */
#include <stdarg.h>
#include <stdio.h>

#include "device/bridge_status.h"
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

typedef struct writer {
    char *text;
    size_t size, used;
} writer_t;

__attribute__((format(printf, 2, 3))) static void say(writer_t *w, const char *format, ...)
{
    if (w->used + 1 >= w->size)
        return;
    va_list arguments;
    va_start(arguments, format);
    const int n = vsnprintf(w->text + w->used, w->size - w->used, format, arguments);
    va_end(arguments);
    if (n > 0)
        w->used += (size_t)n < w->size - w->used ? (size_t)n : w->size - w->used - 1;
}

typedef struct advice {
    cm1e_error_t error;
    const char *text;
} advice_t;

static const advice_t advices[] = {
    {CM1E_ERROR_BUS_LOST, "No frame came back for several cycles. Check cable, network interface and the load of this "
                          "machine"},
    {CM1E_ERROR_BUS_WORKING_COUNTER, "Look for a slave without power, a loose cable, or one that left Operational"},
    {CM1E_ERROR_BUS_STATE, "The slave left Operational. Remove what the AL status code names"},
    {CM1E_ERROR_AXIS_OFFLINE, "Check its power and its cables"},
    {CM1E_ERROR_DRIVE_POWER, "Motor power (24 V, statusword bit 4) is missing: check supply, fuse and emergency stop"},
    {CM1E_ERROR_DRIVE_ENABLE_LOST, "The drive dropped its torque without a fault. Check its watchdog, its power and "
                                   "whether another tool controls it"},
    {CM1E_ERROR_DRIVE_ENABLE_TIMEOUT, "The drive stayed in the state named here although the next one was commanded, "
                                      "or every cycle was too late to command it. Check motor power, whether another "
                                      "tool controls it, and whether the cycles of this program are late"},
    {CM1E_ERROR_DRIVE_MODE_TIMEOUT, "Object 0x6061 does not show the mode that was commanded"},
    {CM1E_ERROR_DRIVE_MODE_LOST, "Object 0x6061 left the commanded mode by itself. Check whether another tool controls "
                                 "the drive"},
    {CM1E_ERROR_DRIVE_POSITION, "For several cycles object 0x6064 showed a position that the motor cannot have reached "
                                "since the last good one. The set-points were ramped down without that position. Check "
                                "the motor's encoder, what else writes to the drive (homing, position preset), and its "
                                "PDO mapping"},
    {CM1E_ERROR_DRIVE_KEEPS_TORQUE, "The drive stayed in the state named here, in which its motor has torque, although "
                                    "it was told to have none (controlword Shutdown, or Disable voltage in a quick "
                                    "stop). Cut its motor power before somebody reaches into the machine. Check "
                                    "whether another tool controls it, and whether it is defect"},
    {CM1E_ERROR_AXIS_POSITION_RANGE, "The actual position, or a target, is beyond what the resolution of the motor "
                                     "(K37) allows"},
    {CM1E_ERROR_DRIVE_RESET_TIMEOUT, "The fault came back or stayed. Remove its cause, or switch the drive off and on"},
};

static const cm1e_fsa_row_t *states_of(const cm1e_drive_t *drive)
{
    const cm1e_device_mode_t *row = cm1e_device_mode(drive->kind, drive->fault.mode_shown);
    return (row ? row : drive->mode.wanted)->words->states;
}

static const char *advice(const cm1e_drive_t *drive)
{
    const cm1e_error_t error = drive->fault.error;
    const cm1e_fsa_row_t *states = states_of(drive);
    if (error == CM1E_ERROR_DRIVE_ENABLE_LOST && states &&
        cm1e_fsa_decode_by(states, drive->fault.statusword) == QUICK_STOP_ACTIVE)
        return "The drive has begun a quick stop by itself. Check its limit switches, its input for a quick stop, and "
               "whether another tool controls it";
    if (error == CM1E_ERROR_DRIVE_MODE_TIMEOUT && drive->fault.turned)
        return "The motor turned, so the mode was not written. Let it come to rest";
    for (size_t i = 0; i < sizeof advices / sizeof advices[0]; i++)
        if (advices[i].error == error)
            return advices[i].text;
    return "Remove the cause";
}

static const char *mode_name(const cm1e_drive_t *drive, int8_t mode)
{
    const char *name = cm1e_drive_mode_name(drive, mode);
    return name ? name : "none";
}

static void say_words(writer_t *w, const cm1e_drive_t *drive)
{
    const cm1e_drive_fault_t *fault = &drive->fault;
    const cm1e_fsa_row_t *states = states_of(drive);
    say(w, " Statusword 0x%04X", fault->statusword);
    if (states)
        say(w, " (%s)", cm1e_fsa_name(cm1e_fsa_decode_by(states, fault->statusword)));
    if (fault->mode_commanded != fault->mode_shown)
        say(w, ", mode %d (%s) commanded, %d (%s) shown", fault->mode_commanded,
            mode_name(drive, fault->mode_commanded), fault->mode_shown, mode_name(drive, fault->mode_shown));
}

/* BR 7.4 */
static void say_status(writer_t *w, const cm1e_drive_t *drive)
{
    char text[CM1E_BRIDGE_STATUS_TEXT];
    const cm1e_bridge_motor_t motor = cm1e_drive_bridge_motor(drive);
    const uint8_t status = drive->fault.motor_status;
    const char *cure = cm1e_bridge_status_cure(motor, status);
    say(w, " The motor (%s) says: %s (F530:%u = 0x%02X).", cm1e_bridge_motor_name(motor),
        cm1e_bridge_status_text(motor, status, text, sizeof text),
        CM1E_BRIDGE_STATUS_SUBINDEX(drive->config->channel), status);
    if (cure[0])
        say(w, " Cure: %s.", cure);
}

/* The cure of the device's own error; NULL: the common advice applies. */
static const char *further(const cm1e_drive_t *drive)
{
    const cm1e_device_mode_t *row = cm1e_device_mode(drive->kind, drive->fault.mode_shown);
    const cm1e_error_t error = drive->fault.error;
    if (error == CM1E_ERROR_DRIVE_MODE_TIMEOUT)
        return drive->kind->refusal;
    const bool stays = error == CM1E_ERROR_DRIVE_RESET_TIMEOUT || error == CM1E_ERROR_DRIVE_FAULT;
    return stays && row ? row->cure : NULL;
}

void cm1e_drive_fault_text(const cm1e_drive_t *drive, char *text, size_t size)
{
    if (!text || size == 0)
        return;
    text[0] = '\0';
    const cm1e_drive_fault_t *fault = &drive->fault;
    if (fault->error == CM1E_OK)
        return;
    writer_t w = {.text = text, .size = size};
    say(&w, "Axis \"%s\" (slave %u): %s.", drive->config->name, drive->position, cm1e_strerror(fault->error));
    if (fault->device_code) {
        const cm1e_device_error_t *device = drive->kind->error(fault->device_code);
        say(&w, " Device error 0x%04X: %s.", fault->device_code, device ? device->text : "not a code of the manual");
        if (device)
            say(&w, " Cure: %s.", device->cure);
    }
    char label[CM1E_LABEL_LENGTH];
    if (fault->missing)
        say(&w, " It is %s.", cm1e_bus_slave_label(drive->bus, fault->missing, label));
    if (fault->slave_lost)
        say(&w, " This slave does not answer at its address.");
    else if (fault->al_state)
        say(&w, " EtherCAT state %u, AL status code 0x%04X: %s.", fault->al_state & 0x0Fu, fault->al_status_code,
            cm1e_al_status_text(fault->al_status_code));
    const cm1e_bus_counters_t *counters = cm1e_bus_counters(drive->bus);
    const uint64_t unsent = __atomic_load_n(&counters->unsent_frames, __ATOMIC_RELAXED);
    if (unsent > 0 && fault->error == CM1E_ERROR_BUS_LOST)
        say(&w, " The network interface did not take %llu frames since the start: it is down, or too slow.",
            (unsigned long long)unsent);
    const uint64_t foreign = __atomic_load_n(&counters->foreign_frames, __ATOMIC_RELAXED);
    if (foreign > 0)
        say(&w, CM1E_OTHER_MASTER_TEXT, (unsigned long long)foreign);
    if (fault->motor_status_known)
        say_status(&w, drive);
    say_words(&w, drive);
    if (fault->keeps_torque && fault->error != CM1E_ERROR_DRIVE_KEEPS_TORQUE)
        say(&w, ". Its motor still has torque, although the drive was told to have none: cut its motor power");
    const char *more = further(drive);
    if (fault->error == CM1E_ERROR_AXIS_OFFLINE && drive->watch.absent) {
        say(&w, ". The slave is optional and absent. Plug it in, then reset the axis with MC_Reset.");
        return;
    }
    say(&w, ". %s%s%s, then reset the axis with MC_Reset.", advice(drive), more ? ". " : "", more ? more : "");
}
