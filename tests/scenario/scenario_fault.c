/* The faults of a scenario: what is done to the machine, and what must be detected of it, by docs/SAFETY.md. */
#include <stdarg.h>
#include <string.h>

#include "cia402/cia402.h"
#include "scenario_private.h"

/** Which axes must be in ErrorStop. */
typedef enum concerned { NOBODY = 0, THE_AXIS, THE_NETWORK } concerned_t;

/** "%p": position of the slave, "%c": channel, "%l": length in cycles, "%m": length in ms, "%v": value, "%x": value as
 *  hexadecimal, "%i": its explicit device ID, "%s": that of a stranger; "%o" and "%j": position and ID of the slave that
 *  changes places with it; "%t": that of the first terminal of its network, "%n": number of its
 *  input. Orders are separated by ';'. NULL: it is not for the console. */
typedef struct fault_row {
    const char *begin, *end;
    concerned_t concerned;
    int beyond;              /**< cycles to detection, on top of lost_cycles_limit if `from` is 1 */
    bool counts_lost;        /**< it must be detected only if it lasts for so many cycles as lost_cycles_limit */
    bool brief;              /**< it is over with its last frame; nothing has to be ended */
    const char *word;        /**< what the text of the axis has; NULL: anything */
} fault_row_t;

enum { FRAMES_A_CYCLE = 3, ALONE_CYCLES = 80, ORDER_BYTES = 100, AWAY_CYCLES = 30 };

static const fault_row_t rows[FAULT_KINDS] = {
    [FAULT_LOSE] = {"lose %l", NULL, THE_NETWORK, 1, true, true, NULL},
    [FAULT_LOSE_OUT] = {NULL, NULL, THE_NETWORK, 1, true, false, NULL},
    [FAULT_LOSE_BACK] = {NULL, NULL, THE_NETWORK, 1, true, false, NULL},
    [FAULT_CORRUPT] = {"corrupt %l", NULL, THE_NETWORK, 1, true, true, NULL},
    [FAULT_DELAY] = {"delay %l %v", NULL, NOBODY, 0, false, true, NULL},
    [FAULT_COUNTER] = {NULL, NULL, THE_NETWORK, 1, true, false, NULL},
    [FAULT_STALL] = {NULL, NULL, NOBODY, 0, false, true, NULL},
    [FAULT_UNPLUG] = {"unplug %p", "replug %p", THE_NETWORK, 1, true, false, NULL},
    [FAULT_POWER_CYCLE] = {"power-cycle %p %m", NULL, THE_NETWORK, 1, true, true, NULL},
    [FAULT_FALL_BACK] = {NULL, NULL, THE_AXIS, 4, false, true, NULL},
    [FAULT_MOTOR_POWER] = {"power %p off", "power %p on", THE_AXIS, 2, false, false, "power"},
    [FAULT_ERROR] = {"error %p %x", NULL, THE_AXIS, 2, false, true, "0x"},
    [FAULT_OVER_TORQUE] = {"over-torque %p", NULL, THE_AXIS, 2, false, true, "0x2310"},
    [FAULT_TEMPERATURE] = {"temperature %p 95", "temperature %p 30", THE_AXIS, 2, false, false, "0x4310"},
    [FAULT_LOAD] = {"load %p %v", "load %p 0", NOBODY, 0, false, false, NULL},
    [FAULT_JUMP] = {NULL, NULL, THE_AXIS, 2, true, false, NULL},
    [FAULT_FREEZE] = {NULL, NULL, NOBODY, 0, false, false, NULL},
    [FAULT_RING] = {"unplug %p", "replug %p", NOBODY, 0, false, false, NULL},
    [FAULT_CLOCK] = {"clock %p step %v", NULL, NOBODY, 0, false, true, NULL},
    [FAULT_BRIDGE_ERROR] = {"motor %p %c error overload", NULL, THE_AXIS, 40, false, true, NULL},
    [FAULT_BRIDGE_CABLE] = {"motor %p %c unplug", "motor %p %c replug", THE_AXIS, 60, false, false, NULL},
    [FAULT_SWITCH] = {"sensor %p 2 on", "sensor %p 2 auto", NOBODY, 0, false, false, NULL},
    [FAULT_EEPROM] = {"quirk %p slow-eeprom 20000", "quirk %p nothing", NOBODY, 0, false, false, NULL},
    [FAULT_DETACH] = {"detach %p", "attach %p", THE_AXIS, AWAY_CYCLES, true, false, NULL},
    [FAULT_STRANGER] = {"detach %p;switches %p %s;attach %p", "detach %p;switches %p %i;attach %p", THE_AXIS, AWAY_CYCLES,
                        true, false, NULL},
    [FAULT_SWAP] = {"power-cycle %p 30;power-cycle %o 30;switches %p %j;switches %o %i",
                    "power-cycle %p 30;power-cycle %o 30;switches %p %i;switches %o %j", THE_NETWORK, 1, true, false, NULL},
    [FAULT_EMERGENCY] = {NULL, NULL, NOBODY, 0, false, true, NULL},
    [FAULT_MAILBOX] = {"quirk %p slow-mailbox %v", "quirk %p nothing", NOBODY, 0, false, false, NULL},
    [FAULT_SHOVE] = {NULL, NULL, NOBODY, 0, false, true, NULL},
    [FAULT_INPUT] = {"input %t %n on", "input %t %n off", NOBODY, 0, false, false, NULL},
};

/* ---- what is done ------------------------------------------------------------------------------------------------ */

static void order(run_t *run, const fault_t *fault, const char *format)
{
    const machine_axis_t *axis = &run->axes[(int)fault->axis];
    char line[ORDER_BYTES] = "", answer[200];
    size_t used = 0;
    for (const char *c = format; *c && used < sizeof line - 24; c++) {
        const size_t room = sizeof line - used;
        if (*c != '%')
            line[used++] = *c;
        else if (*++c == 'p')
            used += (size_t)snprintf(line + used, room, "%u", axis->position);
        else if (*c == 't')
            used += (size_t)snprintf(line + used, room, "%u", run->fixed_motors[axis->network] + 1);
        else if (*c == 'c')
            used += (size_t)snprintf(line + used, room, "%u", axis->channel);
        else if (*c == 'l')
            used += (size_t)snprintf(line + used, room, "%.0f", fault->length);
        else if (*c == 'm')
            used += (size_t)snprintf(line + used, room, "%.0f", fault->length * run->scenario->cycle_us / 1000 + 1);
        else if (*c == 'x')
            used += (size_t)snprintf(line + used, room, "%04X", (unsigned)fault->value);
        else if (*c == 'i')
            used += (size_t)snprintf(line + used, room, "%02X", (unsigned)(FIRST_ID + axis->number));
        else if (*c == 'o')
            used += (size_t)snprintf(line + used, room, "%u", run->axes[(int)fault->value].position);
        else if (*c == 'j')
            used += (size_t)snprintf(line + used, room, "%02X", (unsigned)(FIRST_ID + (int)fault->value));
        else if (*c == 's')
            used += (size_t)snprintf(line + used, room, "%02X", (unsigned)STRANGER_ID);
        else
            used += (size_t)snprintf(line + used, room, "%.12g", fault->value);
    }
    const int network = rows[(int)fault->kind].concerned == THE_NETWORK ? (int)fault->network : axis->network;
    char *rest, *one = strtok_r(line, ";", &rest);
    for (; one; one = strtok_r(NULL, ";", &rest))
        if (cm1e_bus_simulate(run->buses[network], one, answer, sizeof answer) != CM1E_OK)
            scenario_fail(run, "console", "%s: %s", one, answer);
}

static wire_fault_t wire_of(const fault_t *fault)
{
    return fault->kind == FAULT_LOSE_OUT ? WIRE_OUT : fault->kind == FAULT_LOSE_BACK ? WIRE_BACK : WIRE_COUNTER;
}

static void begin_fault(run_t *run, const fault_t *fault)
{
    const machine_axis_t *axis = &run->axes[(int)fault->axis];
    switch ((fault_kind_t)fault->kind) {
    case FAULT_LOSE_OUT:
    case FAULT_LOSE_BACK:
    case FAULT_COUNTER: wire_set((int)fault->network, wire_of(fault), true); break;
    case FAULT_JUMP:
    case FAULT_FREEZE: wire_lie(axis, true, fault->kind == FAULT_FREEZE, fault->value); break;
    case FAULT_STALL: wire_stall(run, fault->length); break;
    case FAULT_EMERGENCY: break;
    case FAULT_SHOVE: wire_shove(run, axis, fault->value); break;
    case FAULT_FALL_BACK: wire_fall_back(run, axis->network, axis->position); break;
    default: order(run, fault, rows[(int)fault->kind].begin); break;
    }
}

/** An emergency in every cycle, of an error that the drive does not have. Its mailbox may be full, or it may be away. */
static void flood(run_t *run, const fault_t *fault)
{
    const machine_axis_t *axis = &run->axes[(int)fault->axis];
    char line[ORDER_BYTES], answer[200];
    snprintf(line, sizeof line, "emergency %u %04X", axis->position, (unsigned)fault->value);
    cm1e_bus_simulate(run->buses[axis->network], line, answer, sizeof answer);
}

static void end_fault(run_t *run, const fault_t *fault)
{
    if (fault->kind == FAULT_JUMP || fault->kind == FAULT_FREEZE)
        wire_lie(&run->axes[(int)fault->axis], false, false, 0);
    else if (rows[(int)fault->kind].end)
        order(run, fault, rows[(int)fault->kind].end);
    else if (!rows[(int)fault->kind].brief)
        wire_set((int)fault->network, wire_of(fault), false);
    if (fault->kind == FAULT_STRANGER || fault->kind == FAULT_SWAP)
        run->axes[(int)fault->axis].seen.stranger = false;
    if (fault->kind == FAULT_SWAP)
        run->axes[(int)fault->value].seen.stranger = false;
}

void fault_switches(run_t *run)
{
    for (int n = 0; n < run->scenario->axis_count; n++) {
        machine_axis_t *axis = &run->axes[n];
        for (int i = 0; axis->spec->switched != 0 && i < SWITCHES; i++) {
            const bool pressed = (i == 0 ? axis->seen.load : -axis->seen.load) > SWITCH_COUNTS;
            char line[ORDER_BYTES], answer[200];
            if (run->cycle > 0 && pressed == axis->seen.pressed[i])
                continue;
            axis->seen.pressed[i] = pressed;
            snprintf(line, sizeof line, "input %u %d %s", run->fixed_motors[axis->network] + 1, WIRED + 1 + i,
                     pressed ? "on" : "off");
            if (cm1e_bus_simulate(run->buses[axis->network], line, answer, sizeof answer) != CM1E_OK)
                scenario_fail(run, "console", "%s: %s", line, answer);
        }
    }
}

/* ---- whom it concerns -------------------------------------------------------------------------------------------- */

static double end_of(const fault_t *fault) { return fault->at + fault->length; }

/** Both pull the same cable, or whatever it is that they do. */
static bool do_the_same(const run_t *run, const fault_t *one, const fault_t *other)
{
    const char *begin = rows[(int)one->kind].begin, *begins = rows[(int)other->kind].begin;
    const machine_axis_t *here = &run->axes[(int)one->axis], *there = &run->axes[(int)other->axis];
    if (!begin)
        return one->kind == other->kind && one->network == other->network;
    return begins && strcmp(begin, begins) == 0 && here->network == there->network &&
           here->position == there->position && (!strstr(begin, "%c") || here->channel == there->channel) &&
           (!strstr(begin, "%n") || one->value == other->value);
}

/** What ends now goes on, by another one. */
static bool goes_on(const run_t *run, const fault_t *fault)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *other = &run->scenario->faults[i];
        if (other != fault && other->at <= run->cycle && end_of(other) > run->cycle && do_the_same(run, fault, other))
            return true;
    }
    return false;
}

bool fault_drives_input(const run_t *run, int number)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *fault = &run->scenario->faults[i];
        if (fault->kind == FAULT_INPUT && (int)fault->value == number && fault->at <= run->cycle &&
            end_of(fault) > run->cycle)
            return true;
    }
    return false;
}

bool fault_turns_input(const run_t *run, int cycles)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *fault = &run->scenario->faults[i];
        const double since_begin = run->cycle - fault->at, since_end = run->cycle - end_of(fault);
        if (fault->kind == FAULT_INPUT && ((since_begin >= 0 && since_begin < cycles) || (since_end >= 0 && since_end < cycles)))
            return true;
    }
    return false;
}

/** An optional slave is away, or a stranger is in its place. */
static bool is_absence(const fault_t *fault) { return fault->kind == FAULT_DETACH || fault->kind == FAULT_STRANGER; }

/** Its slave has been without power, or somebody turned at it. */
static void note(run_t *run, const fault_t *fault)
{
    for (int n = 0; n < run->scenario->axis_count; n++) {
        machine_axis_t *axis = &run->axes[n];
        const bool same_slave = axis->network == run->axes[(int)fault->axis].network &&
                                axis->position == run->axes[(int)fault->axis].position;
        const bool swapped = fault->kind == FAULT_SWAP && (n == (int)fault->axis || n == (int)fault->value);
        if (((fault->kind == FAULT_POWER_CYCLE || is_absence(fault)) && same_slave) || swapped)
            axis->seen.kept = false;
        if ((fault->kind == FAULT_STRANGER && n == (int)fault->axis) || swapped) {
            axis->seen.stranger = true;
            axis->seen.stranger_from = run->cycle;
        }
        if (fault->kind == FAULT_JUMP && n == (int)fault->axis) /* without torque it is the new origin */
            axis->seen.kept = false;
        /* Nor can the master help that a motor behind a bridge misses targets, and then gets to the last one. */
        if ((fault->kind == FAULT_LOAD || fault->kind == FAULT_SHOVE || fault->kind == FAULT_BRIDGE_CABLE) &&
            n == (int)fault->axis)
            axis->seen.pushed_until = end_of(fault);
        if (fault->kind == FAULT_SHOVE && n == (int)fault->axis)
            axis->seen.shoved_at = run->cycle;
        if (fault->kind == FAULT_BRIDGE_CABLE && n == (int)fault->axis) /* nobody sees how far it swings */
            axis->seen.unseen = true;
        if (fault->kind == FAULT_STALL) {
            axis->seen.stalled = 0;
            axis->seen.pause = (int)fault->length;
        }
        if ((fault->kind == FAULT_JUMP || fault->kind == FAULT_FREEZE) && n == (int)fault->axis)
            axis->seen.caught = -(int)fault->length; /* what the position loop of CSV makes of it */
        if (fault->kind == FAULT_RING || (run->scenario->ring != 0 && fault->kind == FAULT_POWER_CYCLE))
            axis->seen.rung = -(int)fault->length;
    }
}

static bool is_on(const machine_axis_t *axis)
{
    return is_motor(axis) && axis->power.Status && axis->info.online && axis->info.state != CM1E_AXIS_ERROR_STOP &&
           axis->info.state != CM1E_AXIS_DISABLED;
}

static bool concerns(const run_t *run, const fault_t *fault, const machine_axis_t *axis)
{
    const fault_row_t *row = &rows[(int)fault->kind];
    if (fault->kind == FAULT_BRIDGE_CABLE && fault->length < row->beyond) /* nobody needs to notice it */
        return false;
    if (fault->kind == FAULT_DETACH && fault->length < row->beyond + run->scenario->lost_limit)
        return false;
    if (fault->kind == FAULT_JUMP && (fault->length < run->scenario->lost_limit + 1 || !wire_watches(axis)))
        return false;
    if (row->concerned == THE_AXIS)
        return axis->number == (int)fault->axis && is_on(axis);
    if (row->concerned == NOBODY || !is_on(axis) || run->scenario->ring != 0)
        return false;
    /* Frames of supervision and of clocks may be lost in place of those with process data. */
    const bool by_frames = row->brief && fault->kind != FAULT_POWER_CYCLE;
    const double frames = (by_frames ? FRAMES_A_CYCLE : 1) * (run->scenario->lost_limit + 1);
    const machine_axis_t *there = &run->axes[(int)fault->axis];
    const bool of_slave = fault->kind == FAULT_UNPLUG || fault->kind == FAULT_POWER_CYCLE || fault->kind == FAULT_SWAP;
    const int network = of_slave ? there->network : (int)fault->network;
    if (of_slave && there->spec->optional != 0) /* those that are not behind it go on, and all if it is pulled out */
        return there->info.online && axis->network == network && axis->position >= there->position && fault->length >= frames + AWAY_CYCLES;
    return axis->network == network && fault->length >= frames;
}

static struct watch {
    bool armed[SCENARIO_AXES];
    int age[SCENARIO_AXES];  /**< cycles with good inputs since then, where the drive tells of it */
} watches[SCENARIO_FAULTS];

/** The console has one fault for the next frames. */
static bool is_of_frames(const fault_t *fault)
{
    return fault->kind == FAULT_LOSE || fault->kind == FAULT_CORRUPT || fault->kind == FAULT_DELAY;
}

static bool is_lie(const fault_t *fault) { return fault->kind == FAULT_JUMP || fault->kind == FAULT_FREEZE; }

/** Faults of the wire that one order sets and ends for all of their kind. */
static bool is_set(const fault_t *fault)
{
    return fault->kind == FAULT_LOSE_OUT || fault->kind == FAULT_LOSE_BACK || fault->kind == FAULT_COUNTER;
}

/** A fault begins or ends: it takes the place of others, or ends them, so nothing has to be detected of those. */
static void replace(const run_t *run, const fault_t *fault)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *other = &run->scenario->faults[i];
        const bool same = (is_of_frames(fault) && is_of_frames(other)) || (is_lie(fault) && is_lie(other)) ||
                          (is_set(fault) && other->kind == fault->kind);
        if (other != fault && same && other->network == fault->network)
            memset(&watches[i], 0, sizeof watches[i]);
    }
}

/* ---- each cycle -------------------------------------------------------------------------------------------------- */

void fault_cycle(run_t *run)
{
    if (run->cycle == 0) {
        memset(watches, 0, sizeof watches);
        for (int i = 0; i < run->scenario->fault_count; i++)
            if (run->scenario->faults[i].kind == FAULT_JUMP || run->scenario->faults[i].kind == FAULT_FREEZE)
                wire_watch(run, &run->axes[(int)run->scenario->faults[i].axis]);
    }
    for (int i = 0; run->phase == PHASE_PROGRAM && i < run->scenario->fault_count; i++) {
        const fault_t *fault = &run->scenario->faults[i];
        if (run->cycle == (int)fault->at) {
            for (int n = 0; n < run->scenario->axis_count; n++)
                watches[i].armed[n] = concerns(run, fault, &run->axes[n]);
            note(run, fault);
            replace(run, fault);
            begin_fault(run, fault);
        }
        if (fault->kind == FAULT_EMERGENCY && run->cycle >= (int)fault->at && run->cycle < (int)end_of(fault))
            flood(run, fault);
        /* A drive that has no torque, and is given some while it lies of its place, jumps by itself. */
        const bool lies = is_lie(fault);
        const bool ends = run->cycle == (int)end_of(fault) && fault->length > 0;
        if (!ends && !(lies && !run->axes[(int)fault->axis].probe.torque_on))
            continue;
        if (!is_of_frames(fault))
            replace(run, fault);
        if (lies || !goes_on(run, fault))
            end_fault(run, fault);
    }
}

void fault_mend(run_t *run)
{
    wire_forget();
    memset(watches, 0, sizeof watches);
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *fault = &run->scenario->faults[i];
        if (fault->at <= run->cycle && end_of(fault) >= run->cycle && rows[(int)fault->kind].end)
            end_fault(run, fault);
    }
    for (int i = 0; i < run->networks; i++) {
        char answer[100];
        cm1e_bus_simulate(run->buses[i], "lose 0", answer, sizeof answer);
    }
}

/** Only this fault can have done it. */
static bool is_alone(const run_t *run, int number)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *other = &run->scenario->faults[i];
        if (i != number && other->at <= run->cycle && end_of(other) + ALONE_CYCLES >= run->scenario->faults[number].at)
            return false;
    }
    return true;
}

/** It is shorter than lost_cycles_limit, and no other one is near, with which it could be longer. A slave that answers none
 *  of three questions is lost earlier; one slave is asked in each cycle. */
static bool is_tolerated(const run_t *run, const fault_t *fault)
{
    enum { NEAR = 10, QUESTIONS = 3 };
    if (fault->kind == FAULT_UNPLUG && fault->length >= QUESTIONS)
        return false;
    const bool is_brief = is_of_frames(fault) || is_set(fault) || fault->kind == FAULT_UNPLUG;
    if (!is_brief || fault->length >= run->scenario->lost_limit)
        return false;
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *other = &run->scenario->faults[i];
        if (other != fault && other->at <= end_of(fault) + NEAR && end_of(other) + NEAR >= fault->at)
            return false;
    }
    return true;
}

/** Two cables of a ring that are broken at once: what is between them is cut off. */
static bool cuts_ring(const run_t *run, const fault_t *fault)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *other = &run->scenario->faults[i];
        const bool same_ring = run->axes[(int)other->axis].network == run->axes[(int)fault->axis].network;
        if (other != fault && other->kind == FAULT_RING && same_ring && other->at <= end_of(fault) && end_of(other) >= fault->at)
            return true;
    }
    return false;
}

/** What a fault can do to an axis: a fault of one motor stops no other one, a network stops only its own axes, and some
 *  faults stop nobody by an error of bus or drive. */
static bool may_stop(const run_t *run, const fault_t *fault, const machine_axis_t *axis, bool of_bus)
{
    enum { WATCHDOG_US = 90000, MODE_TIMEOUT_US = 1000000, MODE_TRANSFERS = 4 /* for a switch of the mode, read twice */ };
    const machine_axis_t *there = &run->axes[(int)fault->axis];
    const bool same_slave = there->network == axis->network && there->position == axis->position;
    switch ((fault_kind_t)fault->kind) {
    case FAULT_EEPROM:
    case FAULT_EMERGENCY: return false;
    case FAULT_MAILBOX: return same_slave && !of_bus && fault->value >= MODE_TIMEOUT_US / MODE_TRANSFERS;
    case FAULT_RING: return there->network == axis->network && cuts_ring(run, fault);
    case FAULT_STALL: return fault->length * run->scenario->cycle_us >= WATCHDOG_US;
    case FAULT_DETACH:
    case FAULT_STRANGER: return there == axis;
    case FAULT_MOTOR_POWER:
    case FAULT_ERROR:
    case FAULT_OVER_TORQUE:
    case FAULT_TEMPERATURE:
    case FAULT_BRIDGE_ERROR:
    case FAULT_BRIDGE_CABLE:
    case FAULT_SWITCH:
    case FAULT_LOAD:
    case FAULT_SHOVE:
    case FAULT_JUMP:
    case FAULT_FREEZE: return same_slave && !of_bus;
    case FAULT_LOSE:
    case FAULT_LOSE_OUT:
    case FAULT_LOSE_BACK:
    case FAULT_CORRUPT:
    case FAULT_DELAY:
    case FAULT_COUNTER: return (int)fault->network == axis->network;
    default: return there->network == axis->network;
    }
}

bool fault_slows_mailbox(const run_t *run, const machine_axis_t *axis)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *fault = &run->scenario->faults[i];
        const machine_axis_t *there = &run->axes[(int)fault->axis];
        if (fault->kind == FAULT_MAILBOX && fault->at <= run->cycle && there->network == axis->network &&
            there->position == axis->position)
            return true;
    }
    return false;
}

bool fault_explains(const run_t *run, const machine_axis_t *axis, bool of_bus)
{
    for (int i = 0; i < run->scenario->fault_count; i++) {
        const fault_t *fault = &run->scenario->faults[i];
        if (fault->at <= run->cycle && may_stop(run, fault, axis, of_bus) && !(of_bus && is_tolerated(run, fault)))
            return true;
    }
    return false;
}

/** In the cycle of the fault it has begun to brake before a limit, because its coupling or a set-point from outside asks too
 *  much, with another axis of it, or without its master: the first cause stays, the log has the other one. */
static bool braked_before(const run_t *run, const fault_t *fault, const machine_axis_t *axis)
{
    return run->cycle == (int)fault->at + 1 && (axis->info.error == CM1E_ERROR_AXIS_POSITION_RANGE ||
                                                axis->info.error == CM1E_ERROR_AXIS_COUPLING_LIMIT ||
                                                axis->info.error == CM1E_ERROR_AXIS_COUPLED ||
                                                axis->info.error == CM1E_ERROR_AXIS_MASTER_LOST ||
                                                axis->info.error == CM1E_ERROR_AXIS_SET_POINT_LIMIT);
}

static void judge_text(run_t *run, int number, const machine_axis_t *axis)
{
    const fault_row_t *row = &rows[(int)run->scenario->faults[number].kind];
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(axis->reference, text, sizeof text);
    if (braked_before(run, &run->scenario->faults[number], axis))
        return;
    if (row->word && is_alone(run, number) && !strstr(text, row->word))
        scenario_fail(run, "text", "%s: after \"%s\" the text does not have \"%s\": %.200s", axis->name,
                      fault_names[(int)run->scenario->faults[number].kind], row->word, text);
}

/** A homing by the drive may set a new position until the drive has shown another mode (docs/SAFETY.md). */
static bool may_set_position(const machine_axis_t *axis)
{
    return axis->info.mode == CM1E_MODE_HM || axis->info.mode == CM1E_MODE_NONE;
}

/** An armed axis has stopped, or was switched off by its program, or it is late. */
static void judge_axis(run_t *run, int i, machine_axis_t *axis)
{
    const fault_t *fault = &run->scenario->faults[i];
    const fault_row_t *row = &rows[(int)fault->kind];
    int *good = &watches[i].age[axis->number];
    if (fault->kind == FAULT_JUMP && run->cycle == (int)end_of(fault) && *good <= (int)run->scenario->lost_limit) {
        watches[i].armed[axis->number] = false; /* frames were lost meanwhile: too few untrue positions have come */
        return;
    }
    *good += run->bad[axis->network] == 0;
    const int age = row->concerned == THE_AXIS ? *good : run->cycle - (int)fault->at;
    const int bound = row->beyond + (row->counts_lost ? (int)run->scenario->lost_limit : 0) +
                      (row->brief && row->counts_lost ? (int)run->scenario->lost_limit + 2 : 0) +
                      (axis->spec->optional != 0 ? AWAY_CYCLES : 0);
    if (axis->info.state == CM1E_AXIS_ERROR_STOP) {
        watches[i].armed[axis->number] = false;
        if (age > run->outcome->faults[i].cycles)
            run->outcome->faults[i].cycles = age;
        judge_text(run, i, axis);
    } else if (axis->info.state == CM1E_AXIS_DISABLED || !axis->power.Enable ||
               (fault->kind == FAULT_JUMP && may_set_position(axis)))
        watches[i].armed[axis->number] = false;
    else if (age > bound)
        scenario_fail(run, "detection", "%s is in %s, %d cycles after \"%s\"; %d are allowed", axis->name,
                      cm1e_axis_state_name(axis->info.state), age, fault_names[(int)fault->kind], bound);
}

void fault_judge(run_t *run)
{
    for (int i = 0; i < run->scenario->fault_count; i++)
        for (int n = 0; n < run->scenario->axis_count; n++)
            if (watches[i].armed[n] && run->cycle > (int)run->scenario->faults[i].at)
                judge_axis(run, i, &run->axes[n]);
}
