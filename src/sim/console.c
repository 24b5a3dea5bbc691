/*
 * The console of a simulated segment: one line, one answer. The grammar is "<command> <slave> <arguments>"; commands
 * that concern the frames have no slave.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/bus.h"
#include "core/bytes.h"
#include "core/c_locale.h"
#include "sim/bridge_app.h"
#include "sim/cia402_app.h"
#include "sim/cm1e_app.h"
#include "sim/console_call.h"
#include "sim/esc_chip.h"

enum { ERROR_OVERLOAD = 0x2310, ERROR_MOTOR_POWER = 0xFF05 };

typedef struct command {
    const char *word;
    enum { NO_SLAVE, ANY_SLAVE, DRIVE, ANY_DRIVE, DRIVE_OR_ALL, BRIDGE } subject;
    int least, most;         /* arguments behind the slave */
    cm1e_error_t (*run)(call_t *call);
    const char *usage, *help;
} command_t;

/* ---- commands on a drive ---------------------------------------------------------------------------------------- */

static const char *al_state_name(uint8_t state)
{
    switch (state) {
    case 1: return "INIT";
    case 2: return "PREOP";
    case 4: return "SAFEOP";
    case 8: return "OP";
    case 3: return "BOOT";
    default: return "no state"; /* with device emulation it is what the master wrote */
    }
}

/* The state, and the reason if it is not the requested one. */
static void say_al(call_t *call, cm1e_sim_slave_t *slave)
{
    say(call, "%s", al_state_name(cm1e_sim_slave_al_state(slave)));
    if (!slave->al_error)
        return;
    const uint16_t code = cm1e_get_u16(slave->memory + ESC_AL_STATUS_CODE);
    say(call, " + ERROR, AL status code 0x%04X, %s", code, cm1e_al_status_text(code));
    const cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(slave);
    if (!bridge || code != AL_CODE_SYNC_ERROR)
        return;
    if (cm1e_sim_bridge_wrong_cycles(bridge) == 0)
        say(call, ": wrong cycles were counted beyond 0x10F1:02");
    else
        say(call, ": %d cycles in a row were %s than %d us", cm1e_sim_bridge_wrong_cycles(bridge),
            bridge->wrong_cycles > 0 ? "longer" : "shorter", bridge->wrong_cycles > 0 ? CM1E_SIM_BRIDGE_LATE_US
                                                                                      : CM1E_SIM_BRIDGE_EARLY_US);
    say(call, ", the last one %u us. The cycle of a bridge is 1 ms (BR 6.3)", bridge->last_cycle_us);
}

static const char *mode_name(int32_t mode)
{
    const cm1e_mode_row_t *row = cm1e_mode_find((int8_t)mode);
    return row ? row->abbreviation : "no mode";
}

static void say_bridge(call_t *call, uint32_t position, const cm1e_sim_bridge_t *bridge)
{
    say(call, "%u: %s, ", position, cm1e_bridge_name(bridge->model));
    say_al(call, bridge->slave);
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
        const cm1e_sim_bridge_axis_t *axis = &bridge->axes[i];
        say(call, "; ID%u %s, mode %d, position %d, motor 0x%02X", i + 1, cm1e_fsa_name(axis->state), axis->mode,
            (int)cm1e_sim_bridge_shown_position(axis), cm1e_sim_bridge_motor_status(axis));
        if (axis->broken_rules)
            say(call, ", broken rules 0x%03X", axis->broken_rules);
    }
}

static void say_other(call_t *call, uint32_t position, cm1e_sim_cia402_t *drive)
{
    cm1e_sim_cia402_refresh(drive);
    say(call, "%u: CiA 402 servo drive, ", position);
    say_al(call, drive->slave);
    say(call, ", %s, %s, position %d, motor power %s, error 0x%04X", cm1e_fsa_name(drive->state),
        mode_name((int32_t)*drive->v.mode_display), (int)*drive->v.position, drive->motor_power ? "on" : "off",
        (unsigned)*drive->v.error_code);
}

static void say_status(call_t *call, uint32_t position)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(call->segment, position);
    cm1e_sim_cm1e_t *drive = cm1e_sim_cm1e_of(slave);
    const cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(slave);
    if (bridge) {
        say_bridge(call, position, bridge);
        return;
    }
    if (cm1e_sim_cia402_of(slave)) {
        say_other(call, position, cm1e_sim_cia402_of(slave));
        return;
    }
    if (!drive) {
        say(call, "%u: not a CM1-E, ", position);
        say_al(call, slave);
        return;
    }
    cm1e_sim_refresh(drive);
    say(call, "%u: %s V%s, ", position, drive->motor->name, drive->firmware->version);
    say_al(call, slave);
    say(call, ", %s, %s, position %d, motor power %s, error 0x%04X", cm1e_fsa_name(drive->fsa.state),
        mode_name(drive->objects.mode_display), drive->objects.position, drive->motor_power ? "on" : "off",
        (unsigned)drive->objects.error_code);
}

static cm1e_error_t run_status(call_t *call)
{
    if (call->slave) {
        say_status(call, call->position);
        return CM1E_OK;
    }
    const uint32_t count = cm1e_sim_segment_slave_count(call->segment);
    if (count == 0)
        say(call, "the segment has no slaves");
    for (uint32_t position = 1; position <= count; position++) {
        if (position > 1)
            say(call, "\n");
        say_status(call, position);
    }
    return CM1E_OK;
}

static cm1e_error_t run_show(call_t *call)
{
    const cm1e_sim_cm1e_t *drive = call->drive;
    const cm1e_sim_objects_t *objects = &drive->objects;
    const cm1e_device_error_t *error = cm1e_device_error((uint16_t)objects->error_code);
    say_status(call, call->position);
    say(call, "\n   %s", error ? error->text : "an error that only its profile has");
    say(call, "\n   controlword 0x%04X, statusword 0x%04X, mode commanded %s", (unsigned)objects->controlword,
        (unsigned)objects->statusword, mode_name(objects->mode));
    say(call, "\n   shaft at %.1f counts since the start, %.1f counts/s, motor torque %.4f Nm, load %.4f Nm",
        drive->mechanics.position, drive->mechanics.velocity, drive->servo.torque, drive->mechanics.load_torque);
    say(call, "\n   inputs 0x%X, outputs 0x%X, %d degrees C, rotary switches %02X, cycle time %d us",
        (unsigned)objects->digital_inputs, (unsigned)objects->digital_outputs, objects->temperature,
        drive->rotary_switches, objects->cycle_time_us);
    return CM1E_OK;
}

static cm1e_error_t run_power(call_t *call)
{
    static const char *const words[] = {"off", "on", NULL};
    const int on = choice(argument(call, 0), words);
    if (on < 0)
        return REFUSE(call, "\"%s\": expected on or off", argument(call, 0));
    if (call->other)
        cm1e_sim_cia402_motor_power(call->other, on == 1);
    else
        cm1e_sim_fsa_motor_power(call->drive, on == 1);
    say(call, "slave %u: motor power %s", call->position, words[on]);
    return CM1E_OK;
}

static cm1e_error_t run_switches(call_t *call)
{
    long value;
    if (!parse_whole(argument(call, 0), 16, 0, 0xFF, &value))
        return REFUSE(call, "\"%s\": expected two hexadecimal digits, 00 to FF", argument(call, 0));
    call->drive->rotary_switches = (uint8_t)value;
    say(call, "slave %u: rotary switches %02lX%s", call->position, value,
        value == 0xFF ? " (reserved: the device reads as ID 0)" : value == 0 ? " (no ID)" : "");
    return CM1E_OK;
}

/* The n-th argument is the input, the next one its new state. */
static cm1e_error_t hold_input(call_t *call, cm1e_sim_sensors_t *sensors, int n, long least, long most)
{
    static const char *const words[] = {"off", "on", "auto", NULL};
    long input;
    const int how = choice(argument(call, n + 1), words);
    if (!parse_whole(argument(call, n), 10, least, most, &input))
        return REFUSE(call, "\"%s\": expected an input, %ld to %ld", argument(call, n), least, most);
    if (how < 0)
        return REFUSE(call, "\"%s\": expected on, off or auto", argument(call, n + 1));
    cm1e_sim_sensors_hold(sensors, (uint8_t)(1u << (input - 1)), how < 2, how == 1);
    say(call, "slave %u: input %ld %s", call->position, input,
        how == 2 ? "follows the axis" : how == 1 ? "held on" : "held off");
    return CM1E_OK;
}

static cm1e_error_t run_sensor(call_t *call)
{
    return hold_input(call, call->other ? &call->other->sensors : &call->drive->sensors, 0, 1, 4);
}

static cm1e_error_t set_load(call_t *call, cm1e_mechanics_t *mechanics, int n, double peak_torque)
{
    double torque;
    if (!parse_real(argument(call, n), -10, 10, &torque))
        return REFUSE(call, "\"%s\": expected a torque in Nm, -10 to 10", argument(call, n));
    mechanics->load_torque = torque;
    say(call, "slave %u: load torque %g Nm (peak torque of the motor: %g Nm)", call->position, torque, peak_torque);
    return CM1E_OK;
}

static cm1e_error_t run_load(call_t *call)
{
    if (call->other)
        return set_load(call, &call->other->mechanics, 0, call->other->servo.torque_limit);
    return set_load(call, &call->drive->mechanics, 0, call->drive->motor->peak_torque_nm);
}

static cm1e_error_t run_temperature(call_t *call)
{
    long degrees;
    if (!parse_whole(argument(call, 0), 10, -40, 200, &degrees))
        return REFUSE(call, "\"%s\": expected whole degrees C, -40 to 200", argument(call, 0));
    cm1e_sim_fsa_temperature(call->drive, (int16_t)degrees);
    say(call, "slave %u: %ld degrees C", call->position, degrees);
    return CM1E_OK;
}

static cm1e_error_t run_refuse(call_t *call)
{
    const char *word = argument(call, 0);
    char *end;
    const unsigned long index = strtoul(word, &end, 16), subindex = *end == ':' ? strtoul(end + 1, &end, 16) : 0;
    if (strcmp(word, "nothing") == 0) {
        call->drive->troubles.refusal.writing = false;
        say(call, "slave %u: refuses nothing", call->position);
        return CM1E_OK;
    }
    if (end == word || *end || index > UINT16_MAX || subindex > UINT8_MAX)
        return REFUSE(call, "\"%s\": expected index:sub-index in hexadecimal, as 60F6:1B, or nothing", word);
    call->drive->troubles.refusal.writing = true;
    call->drive->troubles.refusal.missing = strcmp(argument(call, 1), "missing") == 0;
    call->drive->troubles.refusal.index = (uint16_t)index;
    call->drive->troubles.refusal.subindex = (uint8_t)subindex;
    say(call, "slave %u: refuses to write 0x%04lX:%02lX", call->position, index, subindex);
    return CM1E_OK;
}

static cm1e_error_t run_over_torque(call_t *call)
{
    cm1e_sim_fsa_error(call->drive, ERROR_OVERLOAD);
    say(call, "slave %u: torque overload (0x2310)", call->position);
    return CM1E_OK;
}

static cm1e_error_t motor_power_missing(call_t *call)
{
    cm1e_sim_fsa_motor_power(call->drive, false);
    say(call, "slave %u: motor power off (0xFF05) until \"power %u on\"", call->position, call->position);
    return CM1E_OK;
}

static cm1e_error_t clear_error(call_t *call)
{
    call->drive->troubles.held_code = call->drive->troubles.shown_code = 0;
    cm1e_sim_fsa_update_error(call->drive);
    say(call, "slave %u: no cause of an error is left; a fault still needs a fault reset", call->position);
    return CM1E_OK;
}

static cm1e_error_t refuse_code(call_t *call)
{
    say(call, "\"%s\": expected clear or one of", argument(call, 0));
    for (size_t i = 0; i < cm1e_device_error_count; i++)
        say(call, " %04X", cm1e_device_errors[i].code);
    return CM1E_ERROR_INVALID_ARGUMENT;
}

/* An error of a drive of another maker. */
static cm1e_error_t run_error_of_other(call_t *call)
{
    const bool hold = strcmp(argument(call, 1), "hold") == 0, clear = strcmp(argument(call, 0), "clear") == 0;
    long code = 0;
    if (!clear && (!parse_whole(argument(call, 0), 16, 1, 0xFFFF, &code) || !cm1e_cia402_error((uint16_t)code)))
        return REFUSE(call, "\"%s\": expected clear or an error code of CiA 402", argument(call, 0));
    call->other->held_code = hold ? (uint16_t)code : 0;
    if (!clear)
        cm1e_sim_cia402_fault(call->other, (uint16_t)code);
    if (clear)
        say(call, "slave %u: no cause of an error is left", call->position);
    else
        say(call, "slave %u: error 0x%04lX", call->position, (unsigned long)code);
    return CM1E_OK;
}

static cm1e_error_t run_error(call_t *call)
{
    if (call->other)
        return run_error_of_other(call);
    static const char *const holds[] = {"hold", NULL};
    cm1e_sim_cm1e_t *drive = call->drive;
    const bool hold = argument(call, 1)[0] != '\0';
    long code;
    if (hold && choice(argument(call, 1), holds) < 0)
        return REFUSE(call, "\"%s\": expected hold or nothing", argument(call, 1));
    if (!hold && strcmp(argument(call, 0), "clear") == 0)
        return clear_error(call);
    if (!parse_whole(argument(call, 0), 16, 0, 0xFFFF, &code) || !cm1e_device_error((uint16_t)code))
        return refuse_code(call);
    const cm1e_device_error_t *error = cm1e_device_error((uint16_t)code);
    if (code == 0)
        return clear_error(call);
    if (code == ERROR_MOTOR_POWER)
        return motor_power_missing(call);
    if (error->fault) {
        cm1e_sim_fsa_error(drive, error->code);
        drive->troubles.held_code = hold ? error->code : drive->troubles.held_code;
    } else
        drive->troubles.shown_code = error->code;
    cm1e_sim_fsa_update_error(drive);
    say(call, "slave %u: 0x%04lX %s%s", call->position, code, error->text,
        hold ? ", held until \"error <slave> clear\"" : "");
    return CM1E_OK;
}

static cm1e_error_t run_power_up_fault(call_t *call)
{
    long count = 0;
    const bool always = strcmp(argument(call, 0), "always") == 0;
    if (!always && !parse_whole(argument(call, 0), 10, 0, 1000, &count))
        return REFUSE(call, "\"%s\": expected how often, 0 to 1000, or always", argument(call, 0));
    call->drive->troubles.failing_power_ups = always ? UINT32_MAX : (uint32_t)count;
    if (always)
        say(call, "slave %u: no power-up will reach the motor controller (0x7510)", call->position);
    else
        say(call, "slave %u: the next %ld power-ups do not reach the motor controller (0x7510)", call->position, count);
    return CM1E_OK;
}

/* ---- commands on a bridge --------------------------------------------------------------------------------------- */

static cm1e_error_t motor_error(call_t *call, cm1e_sim_bridge_axis_t *axis)
{
    static const char *const names[] = {"position", "over-speed", "overload", "temperature", "over-current", NULL};
    static const uint8_t codes[] = {BRIDGE_STATUS_POSITION_OVERFLOW, BRIDGE_STATUS_OVER_SPEED, BRIDGE_STATUS_OVERLOAD,
                                    BRIDGE_STATUS_TEMPERATURE, BRIDGE_STATUS_OVER_CURRENT};
    const int n = choice(argument(call, 2), names);
    if (n < 0 || (codes[n] == BRIDGE_STATUS_OVER_CURRENT && axis->motor == CM1E_BRIDGE_CM1)) /* BR 7.4 */
        return REFUSE(call, "\"%s\": expected position, over-speed, overload, temperature, or over-current of a CM2",
                      argument(call, 2));
    cm1e_sim_bridge_axis_error(axis, codes[n]);
    say(call, "slave %u: motor %u has the error %s (0x%02X)", call->position, axis->number + 1u, names[n], codes[n]);
    return CM1E_OK;
}

static cm1e_error_t break_answers(call_t *call, cm1e_sim_bridge_axis_t *axis)
{
    enum { ANSWERS_MAX = 1000000 };
    long count;
    if (!parse_whole(argument(call, 2), 10, 0, ANSWERS_MAX, &count))
        return REFUSE(call, "\"%s\": expected a number of answers, 0 to %d", argument(call, 2), ANSWERS_MAX);
    axis->broken_answers = (uint32_t)count;
    say(call, "slave %u: the next %ld answers of motor %u arrive broken", call->position, count, axis->number + 1u);
    return CM1E_OK;
}

static cm1e_error_t hold_motor_input(call_t *call, cm1e_sim_bridge_axis_t *axis)
{
    const bool cm1 = axis->motor == CM1E_BRIDGE_CM1;
    return hold_input(call, &axis->sensors, 2, cm1 ? 2 : 1, cm1 ? 4 : 6); /* BR 6.5.1 */
}

static cm1e_error_t run_motor(call_t *call)
{
    enum { UNPLUG, REPLUG, BROKEN, ERROR, SENSOR, LOAD };
    static const char *const words[] = {"unplug", "replug", "broken", "error", "sensor", "load", NULL};
    const int what = choice(argument(call, 1), words);
    long id;
    if (!parse_whole(argument(call, 0), 10, 1, CM1E_BRIDGE_AXES, &id))
        return REFUSE(call, "\"%s\": expected the ID of a motor, 1 to %d", argument(call, 0), CM1E_BRIDGE_AXES);
    if (what < 0)
        return REFUSE(call, "\"%s\": expected unplug, replug, broken, error, sensor or load", argument(call, 1));
    cm1e_sim_bridge_axis_t *axis = &cm1e_sim_bridge_of(call->slave)->axes[id - 1];
    const int most = what == SENSOR ? 2 : what >= BROKEN ? 1 : 0;
    if (argument(call, 2 + most)[0])
        return REFUSE(call, "\"%s\" is too much behind %s", argument(call, 2 + most), words[what]);
    if (what == BROKEN)
        return break_answers(call, axis);
    if (what == ERROR)
        return motor_error(call, axis);
    if (what == SENSOR)
        return hold_motor_input(call, axis);
    if (what == LOAD)
        return set_load(call, &axis->mechanics, 2, cm1e_sim_bridge_peak_torque());
    cm1e_sim_bridge_axis_plug(axis, what == REPLUG);
    say(call, "slave %u: cable to motor %ld %s", call->position, id, what == REPLUG ? "plugged in" : "unplugged");
    return CM1E_OK;
}

/* ---- the table -------------------------------------------------------------------------------------------------- */

static cm1e_error_t run_help(call_t *call);

static const command_t commands[] = {
    {"help", NO_SLAVE, 0, 0, run_help, "", "this list"},
    {"status", DRIVE_OR_ALL, 0, 0, run_status, "[slave]", "one line a slave"},
    {"show", DRIVE, 0, 0, run_show, "<slave>", "everything about one CM1-E"},
    {"power", ANY_DRIVE, 1, 1, run_power, "<slave> on|off", "24 V motor power"},
    {"switches", DRIVE, 1, 1, run_switches, "<slave> <00...FF>", "rotary switches (explicit device ID)"},
    {"sensor", ANY_DRIVE, 2, 2, run_sensor, "<slave> <1...4> on|off|auto",
     "hold a digital input, or let it follow the axis"},
    {"load", ANY_DRIVE, 1, 1, run_load, "<slave> <Nm>", "torque on the shaft from outside, positive drives CW"},
    {"refuse", DRIVE, 1, 2, run_refuse, "<slave> <index>:<sub>|nothing [missing]",
     "writing this object fails from now on; missing: it is not there"},
    {"firmware", DRIVE, 1, 3, cm1e_console_firmware, "<slave> busy|name|password|error|silent|nothing ...",
     "what the next update of the firmware meets"},
    {"over-torque", DRIVE, 0, 0, run_over_torque, "<slave>", "torque overload, error 2310"},
    {"temperature", DRIVE, 1, 1, run_temperature, "<slave> <degrees C>", "of the drive; error 4310 from 85 on"},
    {"error", ANY_DRIVE, 1, 2, run_error, "<slave> <code>|clear [hold]",
     "an error code of the guide's 7.3.1; hold: its cause stays until clear"},
    {"emergency", ANY_SLAVE, 1, 3, cm1e_console_emergency, "<slave> <code> [register [byte]]", "send a CoE emergency"},
    {"power-up-fault", DRIVE, 1, 1, run_power_up_fault, "<slave> <times>|always", "error 7510 at the next power-ups"},
    {"motor", BRIDGE, 2, 4, run_motor,
     "<slave> <1...4> unplug|replug|broken|error|sensor|load ...",
     "a bridge's motor: cable, answers, error, input, load"},
    {"power-cycle", ANY_SLAVE, 0, 1, cm1e_console_power_cycle, "<slave> [ms]", "control power off and on again"},
    {"unplug", ANY_SLAVE, 0, 1, cm1e_console_unplug, "<slave> [behind]", "pull the cable before it, or behind it"},
    {"replug", ANY_SLAVE, 0, 1, cm1e_console_replug, "<slave> [behind]", "plug the cable in again"},
    {"detach", ANY_SLAVE, 0, 1, cm1e_console_detach, "<slave> [powered]", "pull it out; its neighbours are connected"},
    {"attach", ANY_SLAVE, 0, 0, cm1e_console_attach, "<slave>", "put it in again"},
    {"input", ANY_SLAVE, 2, 2, cm1e_console_input, "<slave> <1...8> on|off|<value>|wire",
     "hold an input of a digital or analog device"},
    {"clock", ANY_SLAVE, 1, 2, cm1e_console_clock, "<slave> drift|temperature|jitter|step|...",
     "its distributed clock: drifts, jumps, loses its reference"},
    {"quirk", ANY_SLAVE, 1, 2, cm1e_console_quirk, "<slave> <name>|nothing [number]",
     "what real slaves do: few FMMUs, a slow EEPROM ..."},
    {"damage", ANY_SLAVE, 1, 1, cm1e_console_damage, "<slave> <frames>", "the cable before it damages the next frames"},
    {"lose", NO_SLAVE, 1, 1, cm1e_console_lose, "<frames>", "lose the next frames"},
    {"corrupt", NO_SLAVE, 1, 1, cm1e_console_corrupt, "<frames>", "corrupt the next frames"},
    {"delay", NO_SLAVE, 2, 2, cm1e_console_delay, "<frames> <us>", "deliver the next frames late"},
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static cm1e_error_t run_help(call_t *call)
{
    for (int i = 0; i < COMMAND_COUNT; i++) {
        char left[80];
        snprintf(left, sizeof left, "%s %s", commands[i].word, commands[i].usage);
        say(call, "%s%-36s %s", i ? "\n" : "", left, commands[i].help);
    }
    return CM1E_OK;
}

/* Words; false: more or longer ones than any command has. */
static bool split(call_t *call, const char *line)
{
    call->count = 0;
    while (*line) {
        const size_t blank = strspn(line, " \t\r\n");
        line += blank;
        const size_t length = strcspn(line, " \t\r\n");
        if (length == 0)
            break;
        if (call->count == WORDS_MAX || length >= LINE_MAX_BYTES)
            return false;
        memcpy(call->words[call->count], line, length);
        call->words[call->count++][length] = '\0';
        line += length;
    }
    return true;
}

static cm1e_error_t find_slave(call_t *call, const command_t *command)
{
    const uint32_t count = cm1e_sim_segment_slave_count(call->segment);
    if (command->subject == NO_SLAVE || (command->subject == DRIVE_OR_ALL && call->count < 2))
        return CM1E_OK;
    if (call->count < 2)
        return REFUSE(call, "the slave is missing; usage: %s %s", command->word, command->usage);
    long position;
    if (!parse_whole(call->words[1], 10, 1, (long)count, &position))
        return REFUSE(call, "\"%s\": expected a slave, 1 to %u", call->words[1], count);
    call->position = (uint32_t)position;
    call->slave = cm1e_sim_segment_slave(call->segment, call->position);
    call->drive = cm1e_sim_cm1e_of(call->slave);
    call->other = cm1e_sim_cia402_of(call->slave);
    if ((command->subject == DRIVE && !call->drive) ||
        (command->subject == ANY_DRIVE && !call->drive && !call->other))
        return REFUSE(call, "slave %u is not a CM1-E", call->position);
    if (command->subject == BRIDGE && !cm1e_sim_bridge_of(call->slave))
        return REFUSE(call, "slave %u is not a bridge", call->position);
    return CM1E_OK;
}

static cm1e_error_t run_command(call_t *call, const command_t *command)
{
    const cm1e_error_t error = find_slave(call, command);
    if (error != CM1E_OK)
        return error;
    const int arguments = call->count - (call->slave ? 2 : 1);
    if (arguments < command->least)
        return REFUSE(call, "an argument is missing; usage: %s %s", command->word, command->usage);
    if (arguments > command->most)
        return REFUSE(call, "\"%s\" is too much; usage: %s %s", argument(call, command->most), command->word,
                      command->usage);
    return command->run(call);
}

static cm1e_error_t run_line(call_t *call, const char *line)
{
    if (!split(call, line))
        return REFUSE(call, "too many or too long words; help lists the commands");
    if (call->count == 0)
        return REFUSE(call, "an empty line; help lists the commands");
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(call->words[0], commands[i].word) == 0)
            return run_command(call, &commands[i]);
    return REFUSE(call, "\"%s\" is not a command; help lists the commands", call->words[0]);
}

bool cm1e_sim_segment_news(cm1e_sim_segment_t *segment, char *text, size_t size)
{
    const uint32_t position = segment && text ? cm1e_sim_segment_fallen_back(segment) : 0;
    if (position == 0)
        return false;
    call_t call = {.segment = segment, .answer = text, .size = size};
    say(&call, "slave %u fell back to ", position);
    say_al(&call, cm1e_sim_segment_slave(segment, position));
    return true;
}

cm1e_error_t cm1e_sim_console(cm1e_sim_segment_t *segment, const char *line, char *answer, size_t size)
{
    static const char continued[] = "...";
    char nowhere[1];
    call_t call = {.segment = segment, .answer = answer ? answer : nowhere, .size = answer ? size : 0};
    if (call.size > 0)
        answer[0] = '\0';
    if (!segment || !line)
        return REFUSE(&call, "a segment or a line is missing");
    c_locale_t locale;
    if (!cm1e_c_locale_begin(&locale))
        return say(&call, "out of memory"), CM1E_ERROR_NO_MEMORY;
    const cm1e_error_t error = run_line(&call, line);
    cm1e_c_locale_end(&locale);
    if (call.cut && call.size >= sizeof continued)
        memcpy(answer + size - sizeof continued, continued, sizeof continued);
    return error;
}
