#include "sim/console_call.h"
#include "sim/esc_chip.h"
#include "sim/esc_clock_orders.h"
#include "sim/io_device.h"

enum { FRAMES_MAX = 1000000, DELAY_MAX_US = 1000000, ABSENCE_MAX_MS = 60000, ABSENCE_DEFAULT_MS = 500 };
enum { FORWARDED_AT = 8 /* behind the receive errors */ };

cm1e_error_t cm1e_console_emergency(call_t *call)
{
    uint8_t data[5] = {0};
    long code, error_register = 1, first = 0;
    if (!parse_whole(argument(call, 0), 16, 0, 0xFFFF, &code) ||
        (call->count > 3 && !parse_whole(argument(call, 1), 16, 0, 0xFF, &error_register)) ||
        (call->count > 4 && !parse_whole(argument(call, 2), 16, 0, 0xFF, &first)))
        return REFUSE(call, "expected a code 0000 to FFFF, a register 00 to FF and a byte 00 to FF");
    data[0] = (uint8_t)first;
    if (!call->slave->ops->sdo_read ||
        !cm1e_sim_slave_emergency(call->slave, (uint16_t)code, (uint8_t)error_register, data))
        return REFUSE(call, "slave %u sends no emergency: it has no CoE, is in INIT, or eight of them wait",
                      call->position);
    say(call, "slave %u: emergency 0x%04lX", call->position, code);
    return CM1E_OK;
}

cm1e_error_t cm1e_console_power_cycle(call_t *call)
{
    long ms = ABSENCE_DEFAULT_MS;
    if (argument(call, 0)[0] && !parse_whole(argument(call, 0), 10, 1, ABSENCE_MAX_MS, &ms))
        return REFUSE(call, "\"%s\": expected milliseconds, 1 to %d", argument(call, 0), ABSENCE_MAX_MS);
    if (call->drive)
        cm1e_sim_fsa_off(call->drive);
    cm1e_sim_slave_reset(call->slave, call->slave->now_ns + ms * INT64_C(1000000));
    say(call, "slave %u: control power off for %ld ms", call->position, ms);
    return CM1E_OK;
}

/* The cable to a slave, or the one behind it: of the last slave of a ring that leads to the second interface. */
static cm1e_error_t cut(call_t *call, bool unplug)
{
    const char *word = argument(call, 0), *done = unplug ? "unplugged" : "plugged in";
    const bool behind = strcmp(word, "behind") == 0;
    if (word[0] && !behind)
        return REFUSE(call, "\"%s\": expected \"behind\", or nothing for the cable to slave %u", word, call->position);
    cm1e_sim_segment_cut(call->segment, call->position + behind, unplug);
    say(call, behind ? "slave %u: cable behind it %s" : "slave %u: cable to it %s", call->position, done);
    return CM1E_OK;
}

cm1e_error_t cm1e_console_unplug(call_t *call) { return cut(call, true); }
cm1e_error_t cm1e_console_replug(call_t *call) { return cut(call, false); }

cm1e_error_t cm1e_console_detach(call_t *call)
{
    static const char *const words[] = {"powered", NULL};
    if (argument(call, 0)[0] && choice(argument(call, 0), words) < 0)
        return REFUSE(call, "\"%s\": expected powered or nothing", argument(call, 0));
    const bool powered = argument(call, 0)[0] != '\0';
    if (call->drive && !powered)
        cm1e_sim_fsa_off(call->drive);
    cm1e_sim_segment_detach(call->segment, call->position, powered);
    say(call, "slave %u: pulled out, its neighbours are connected%s", call->position,
        powered ? "; it keeps its power" : "");
    return CM1E_OK;
}

cm1e_error_t cm1e_console_attach(call_t *call)
{
    cm1e_sim_segment_attach(call->segment, call->position);
    say(call, "slave %u: plugged in", call->position);
    return CM1E_OK;
}

/* As a bad cable does: the slave behind it counts an invalid frame, those behind that one a forwarded error, and the
 * frame is destroyed. */
cm1e_error_t cm1e_console_damage(call_t *call)
{
    long count;
    if (!parse_whole(argument(call, 0), 10, 1, FRAMES_MAX, &count))
        return REFUSE(call, "\"%s\": expected a number of frames, 1 to %d", argument(call, 0), FRAMES_MAX);
    for (uint32_t p = call->position; p <= cm1e_sim_segment_slave_count(call->segment); p++)
        for (long n = 0; n < count; n++)
            cm1e_sim_esc_count(cm1e_sim_segment_slave(call->segment, p),
                               p == call->position ? ESC_RX_ERRORS : ESC_RX_ERRORS + FORWARDED_AT);
    cm1e_sim_segment_set_frame_fault(call->segment, CM1E_FRAME_LOSE, (uint32_t)count, 0);
    say(call, "slave %u: the next %ld frame%s damaged on the cable to it", call->position, count,
        count == 1 ? " is" : "s are");
    return CM1E_OK;
}

static cm1e_error_t frame_fault(call_t *call, cm1e_frame_fault_t kind, const char *verb)
{
    long count, us = 0;
    if (!parse_whole(argument(call, 0), 10, 0, FRAMES_MAX, &count))
        return REFUSE(call, "\"%s\": expected a number of frames, 0 to %d", argument(call, 0), FRAMES_MAX);
    if (kind == CM1E_FRAME_DELAY && !parse_whole(argument(call, 1), 10, 1, DELAY_MAX_US, &us))
        return REFUSE(call, "\"%s\": expected microseconds, 1 to %d", argument(call, 1), DELAY_MAX_US);
    cm1e_sim_segment_set_frame_fault(call->segment, kind, (uint32_t)count, us * 1000);
    say(call, "the next %ld frame%s %s", count, count == 1 ? " is" : "s are", verb);
    if (kind == CM1E_FRAME_DELAY)
        say(call, " by %ld us", us);
    return CM1E_OK;
}

cm1e_error_t cm1e_console_lose(call_t *call) { return frame_fault(call, CM1E_FRAME_LOSE, "lost"); }
cm1e_error_t cm1e_console_corrupt(call_t *call) { return frame_fault(call, CM1E_FRAME_CORRUPT, "corrupted"); }
cm1e_error_t cm1e_console_delay(call_t *call) { return frame_fault(call, CM1E_FRAME_DELAY, "delayed"); }

static cm1e_error_t firmware_of(call_t *call, cm1e_sim_update_t *update, const char *what, const char *value)
{
    static const char *const kinds[] = {"busy", "name", "password", "error", "silent", NULL};
    long number = 0, at = 0;
    const int kind = choice(what, kinds);
    const bool is_hex = kind == 3;
    if (kind < 0 || (kind != 1 && !parse_whole(value, is_hex ? 16 : 10, 0, INT32_MAX, &number)))
        return REFUSE(call, "\"%s %s\": expected busy <requests>, name <file>, password <number>, error <code> "
                      "[bytes], silent <bytes> or nothing", what, value);
    if (is_hex && argument(call, 2)[0] && !parse_whole(argument(call, 2), 10, 0, INT32_MAX, &at))
        return REFUSE(call, "\"%s\": expected a number of bytes", argument(call, 2));
    switch (kind) {
    case 0: update->busy = (uint32_t)number; break;
    case 1: snprintf(update->name, sizeof update->name, "%.63s", value); break;
    case 2: update->password = (uint32_t)number; break;
    case 3: update->error = (uint32_t)number; update->error_at = (size_t)at; break;
    default: update->error = FOE_RESULT_SILENT; update->error_at = (size_t)number; break;
    }
    say(call, "slave %u: the next update of its firmware meets %s %s", call->position, what, value);
    return CM1E_OK;
}

cm1e_error_t cm1e_console_firmware(call_t *call)
{
    cm1e_sim_update_t *update = &call->drive->update;
    if (strcmp(argument(call, 0), "nothing") != 0)
        return firmware_of(call, update, argument(call, 0), argument(call, 1));
    update->error = update->busy = update->password = 0;
    update->error_at = 0;
    update->name[0] = '\0';
    say(call, "slave %u takes every firmware", call->position);
    return CM1E_OK;
}

cm1e_error_t cm1e_console_clock(call_t *call)
{
    char text[160];
    const bool taken = cm1e_sim_clock_order(call->slave, argument(call, 0), argument(call, 1), text, sizeof text);
    say(call, "slave %u: %s", call->position, text);
    return taken ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT;
}

/* What comes to the terminal of an input, in place of its wire. */
cm1e_error_t cm1e_console_input(call_t *call)
{
    static const char *const words[] = {"off", "on", "wire", NULL};
    cm1e_sim_io_device_t *device = cm1e_sim_io_device_of(call->slave);
    const unsigned inputs = device ? device->config.inputs : 0;
    const char *text = argument(call, 1);
    const int word = choice(text, words);
    long channel, value = word;
    if (inputs == 0)
        return REFUSE(call, "slave %u has no simulated inputs", call->position);
    if (!parse_whole(argument(call, 0), 10, 1, (long)inputs, &channel))
        return REFUSE(call, "\"%s\": expected an input, 1 to %u", argument(call, 0), inputs);
    const bool analog = device->config.kind >= CM1E_SIM_SLAVE_ANALOG;
    if (word < 0 && !(analog && parse_whole(text, 10, INT16_MIN, INT16_MAX, &value)))
        return REFUSE(call, "\"%s\": expected %s or wire", text, analog ? "-32768 to 32767" : "on, off");
    device->is_held[channel - 1] = word != 2;
    device->held[channel - 1] = value;
    say(call, "slave %u: input %ld is %s", call->position, channel, word == 2 ? "wired again" : text);
    return CM1E_OK;
}

cm1e_error_t cm1e_console_quirk(call_t *call)
{
    char text[200];
    const bool taken = cm1e_sim_quirk(call->slave, argument(call, 0), argument(call, 1), text, sizeof text);
    say(call, "slave %u: %s", call->position, text);
    return taken ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT;
}
