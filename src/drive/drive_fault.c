/* The latched fault in sentences: whose, what, with which numbers, and what to do about it. */
#include <stdarg.h>
#include <stdio.h>

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
    {CM1E_ERROR_BUS_WORKING_COUNTER, "A slave did not take part in the cycle. Look for a slave without power, a loose "
                                     "cable, or one that left Operational"},
    {CM1E_ERROR_BUS_STATE, "The slave left Operational. Remove what the AL status code names"},
    {CM1E_ERROR_AXIS_OFFLINE, "Check its power and its cables"},
    {CM1E_ERROR_DRIVE_POWER, "Motor power (24 V, statusword bit 4) is missing: check supply, fuse and emergency stop"},
    {CM1E_ERROR_DRIVE_ENABLE_LOST, "The drive dropped its torque without a fault. Check its watchdog, its power and "
                                   "whether another tool controls it"},
    {CM1E_ERROR_DRIVE_ENABLE_TIMEOUT, "The drive stayed in the state named here although it was told to go on. Check "
                                      "motor power and whether another tool controls it"},
    {CM1E_ERROR_DRIVE_MODE_TIMEOUT, "Object 0x6061 does not show the mode that was commanded. Check the mapping and "
                                    "the firmware"},
    {CM1E_ERROR_DRIVE_MODE_LOST, "Object 0x6061 left the commanded mode by itself. Check whether another tool controls "
                                 "the drive"},
    {CM1E_ERROR_DRIVE_RESET_TIMEOUT, "The fault came back or stayed. Remove its cause, or switch the drive off and on"},
};

static const char *advice(cm1e_error_t error)
{
    for (size_t i = 0; i < sizeof advices / sizeof advices[0]; i++)
        if (advices[i].error == error)
            return advices[i].text;
    return "Remove the cause";
}

static const char *mode_name(int8_t mode)
{
    const cm1e_mode_row_t *row = cm1e_mode_find(mode);
    return row ? row->abbreviation : "none";
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
        const cm1e_device_error_t *device = cm1e_device_error(fault->device_code);
        say(&w, " Device error 0x%04X: %s.", fault->device_code, device ? device->text : "not a code of the manual");
        if (device)
            say(&w, " Cure: %s.", device->cure);
    }
    if (fault->slave_lost)
        say(&w, " This slave does not answer at its address.");
    else if (fault->al_state)
        say(&w, " EtherCAT state %u, AL status code 0x%04X: %s.", fault->al_state & 0x0Fu, fault->al_status_code,
            cm1e_al_status_text(fault->al_status_code));
    say(&w, " Statusword 0x%04X (%s)", fault->statusword, cm1e_fsa_name(cm1e_fsa_decode(fault->statusword)));
    if (fault->mode_commanded != fault->mode_shown)
        say(&w, ", mode %d (%s) commanded, %d (%s) shown", fault->mode_commanded, mode_name(fault->mode_commanded),
            fault->mode_shown, mode_name(fault->mode_shown));
    say(&w, ". %s, then reset the axis with MC_Reset.", advice(fault->error));
}
