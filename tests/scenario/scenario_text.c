/*
 * A scenario as text: one line for the run, one for each axis, step and fault, each with names and values. What has its
 * default is not written. Lines that begin with # are comments.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenario.h"

typedef struct field {
    const char *name;
    size_t offset;
    const char *const *words; /**< the value is a place in them; NULL: it is a number */
} field_t;

static const char *const kinds[] = {"cm1e", "eb01", "eb02", "eb12", "cia402", "virtual", NULL};
static const char *const firmwares[] = {"1.3.5", "1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", NULL};
static const char *const mappings[] = {"dynamic", "csp", "csv", "profile", NULL};

const char *const fault_names[FAULT_KINDS + 1] = {
    "lose", "lose-out", "lose-back", "corrupt", "delay", "counter", "stall", "unplug", "power-cycle", "fall-back",
    "motor-power", "error", "over-torque", "temperature", "load", "jump", "freeze", "ring", "clock", "bridge-error",
    "bridge-cable", "switch", "eeprom", "detach", "stranger", "swap", "emergency", "input", "mailbox", "shove",
    NULL};

const char *const scenario_blocks[] = {
    "MC_MoveAbsolute", "MC_MoveRelative", "MC_MoveAdditive", "MC_MoveVelocity", "MC_Halt", "MC_Stop", "MC_Power",
    "MC_Reset", "MC_Home", "MC_MoveSuperimposed", "MC_HaltSuperimposed", "MC_MoveContinuousAbsolute",
    "MC_MoveContinuousRelative", "MC_Jog", "MC_SetPosition", "MC_SetOverride", "MC_GearIn", "MC_GearOut", "MC_CamIn",
    "MC_CamOut", "MC_PhasingRelative", "MC_GearInPos", "MC_CombineAxes", "MC_WriteDigitalOutput", "MC_TouchProbe",
    "MC_MoveLinearAbsolute", "MC_MoveLinearRelative", "MC_MoveCircularRelative", "MC_GroupStop", "MC_GroupHalt",
    "MC_GroupReset", "MC_PositionProfile", "MC_VelocityProfile", "MC_AccelerationProfile", "CM_FollowPosition",
    "MC_StepAbsoluteSwitch", "MC_StepLimitSwitch", "MC_StepBlock", "MC_HomeDirect", "MC_FinishHoming",
    "MC_PhasingAbsolute", "MC_DigitalCamSwitch", "MC_TorqueControl", "MC_AbortTrigger",
    "MC_MoveCircularAbsolute", "MC_GroupSetOverride", "MC_GroupDisable", "MC_GroupEnable", "MC_WriteParameter",
    "MC_WriteBoolParameter", "MC_CamTableSelect", "MC_HomeAbsolute", "MC_StepReferencePulse",
    "MC_StepReferenceFlyingSwitch", "MC_AbortPassiveHoming",
    "MC_ReadActualPosition", "MC_ReadActualVelocity", "MC_ReadActualTorque", "MC_ReadParameter", "MC_ReadBoolParameter",
    "MC_ReadAxisInfo", "MC_ReadDigitalInput", "MC_ReadDigitalOutput", "CM_SendCML", "CM_SetMode", "CM_Command",
    "MC_GroupReadPosition", "MC_GroupReadVelocity", "MC_GroupReadError", "MC_GroupReadConfiguration",
    "MC_GroupInterrupt", "MC_GroupContinue", "MC_MoveDirectAbsolute", "MC_MoveDirectRelative", NULL};

#define NUMBER(type, member) {#member, offsetof(type, member), NULL}
#define WORD_OF(type, member, words) {#member, offsetof(type, member), words}
#define END {NULL, 0, NULL}

static const field_t run_fields[] = {
    NUMBER(scenario_t, cycles), NUMBER(scenario_t, cycle_us), NUMBER(scenario_t, lost_limit), NUMBER(scenario_t, ring),
    NUMBER(scenario_t, clocks), NUMBER(scenario_t, io), NUMBER(scenario_t, memory), NUMBER(scenario_t, overlap),
    NUMBER(scenario_t, analog), END};
static const field_t axis_fields[] = {
    WORD_OF(axis_spec_t, kind, kinds), NUMBER(axis_spec_t, network), NUMBER(axis_spec_t, channel),
    WORD_OF(axis_spec_t, firmware, firmwares), WORD_OF(axis_spec_t, mapping, mappings),
    NUMBER(axis_spec_t, counts_per_unit), NUMBER(axis_spec_t, invert), NUMBER(axis_spec_t, velocity),
    NUMBER(axis_spec_t, acceleration), NUMBER(axis_spec_t, deceleration), NUMBER(axis_spec_t, jerk),
    NUMBER(axis_spec_t, limit_negative), NUMBER(axis_spec_t, limit_positive), NUMBER(axis_spec_t, load_inertia),
    NUMBER(axis_spec_t, friction), NUMBER(axis_spec_t, stops),
    NUMBER(axis_spec_t, coupling_stop), NUMBER(axis_spec_t, motion), NUMBER(axis_spec_t, optional),
    NUMBER(axis_spec_t, identified), NUMBER(axis_spec_t, modulo), NUMBER(axis_spec_t, done_waits),
    NUMBER(axis_spec_t, start), NUMBER(axis_spec_t, wired), NUMBER(axis_spec_t, switched),
    NUMBER(axis_spec_t, backlash), NUMBER(axis_spec_t, backlash_velocity), END};
static const field_t step_fields[] = {
    NUMBER(step_t, at), NUMBER(step_t, axis), WORD_OF(step_t, block, scenario_blocks), NUMBER(step_t, master),
    NUMBER(step_t, hold), NUMBER(step_t, position), NUMBER(step_t, distance), NUMBER(step_t, velocity),
    NUMBER(step_t, acceleration), NUMBER(step_t, deceleration), NUMBER(step_t, jerk), NUMBER(step_t, buffer),
    NUMBER(step_t, direction), NUMBER(step_t, end_velocity), NUMBER(step_t, numerator), NUMBER(step_t, denominator),
    NUMBER(step_t, factor), NUMBER(step_t, relative), NUMBER(step_t, value), NUMBER(step_t, mode), NUMBER(step_t, x),
    NUMBER(step_t, y), NUMBER(step_t, aux_x), NUMBER(step_t, aux_y), NUMBER(step_t, torque),
    NUMBER(step_t, period), NUMBER(step_t, points), NUMBER(step_t, again), NUMBER(step_t, update),
    NUMBER(step_t, change), NUMBER(step_t, change_after), NUMBER(step_t, parameter), NUMBER(step_t, source),
    NUMBER(step_t, transition), NUMBER(step_t, corner), NUMBER(step_t, scaling), NUMBER(step_t, start_distance),
    NUMBER(step_t, allow), END};
static const field_t fault_fields[] = {
    NUMBER(fault_t, at), WORD_OF(fault_t, kind, fault_names), NUMBER(fault_t, axis), NUMBER(fault_t, network),
    NUMBER(fault_t, length), NUMBER(fault_t, value), END};

/** The kinds of lines that may stand several times. */
typedef struct list {
    const char *word;
    const field_t *fields;
    size_t items, count; /**< places in scenario_t */
    size_t size;
    int room;
} list_t;
static const list_t lists[] = {
    {"axis", axis_fields, offsetof(scenario_t, axes), offsetof(scenario_t, axis_count), sizeof(axis_spec_t),
     SCENARIO_AXES},
    {"step", step_fields, offsetof(scenario_t, steps), offsetof(scenario_t, step_count), sizeof(step_t),
     SCENARIO_STEPS},
    {"fault", fault_fields, offsetof(scenario_t, faults), offsetof(scenario_t, fault_count), sizeof(fault_t),
     SCENARIO_FAULTS}};
enum { LISTS = sizeof lists / sizeof lists[0], LINE_BYTES = 1000 };

static int place_of(const char *const *words, const char *word)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], word) == 0)
            return i;
    return -1;
}

int scenario_block(const char *name) { return place_of(scenario_blocks, name); }

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static void write_fields(const field_t *fields, const void *item, FILE *file)
{
    for (const field_t *field = fields; field->name; field++) {
        double value;
        memcpy(&value, (const char *)item + field->offset, sizeof value);
        if (field->words)
            fprintf(file, " %s=%s", field->name, field->words[(int)value]);
        else if (value != 0)
            fprintf(file, " %s=%.17g", field->name, value);
    }
    fputc('\n', file);
}

void scenario_write(const scenario_t *scenario, FILE *file)
{
    fprintf(file, "run seed=%llu", (unsigned long long)scenario->seed);
    write_fields(run_fields, scenario, file);
    for (int i = 0; i < LISTS; i++) {
        int count;
        memcpy(&count, (const char *)scenario + lists[i].count, sizeof count);
        for (int n = 0; n < count; n++) {
            fprintf(file, "%s", lists[i].word);
            write_fields(lists[i].fields, (const char *)scenario + lists[i].items + (size_t)n * lists[i].size, file);
        }
    }
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static bool read_value(const field_t *field, const char *word, void *item)
{
    char *end;
    double value = strtod(word, &end);
    if (field->words)
        value = place_of(field->words, word);
    else if (end == word || *end || !isfinite(value))
        return false;
    memcpy((char *)item + field->offset, &value, sizeof value);
    return value >= 0 || !field->words;
}

/** "name=value"; NULL, or what is wrong. */
static const char *read_pair(const field_t *fields, char *pair, void *item)
{
    char *value = strchr(pair, '=');
    if (!value)
        return "expected name=value";
    *value++ = '\0';
    for (const field_t *field = fields; field->name; field++)
        if (strcmp(field->name, pair) == 0)
            return read_value(field, value, item) ? NULL : "the value is not one of this name";
    return "there is no such name in this kind of line";
}

/** Where the values of a line go; NULL: there is no such kind of line, or no room for another one. */
static void *item_of(scenario_t *scenario, const char *word, const field_t **fields)
{
    *fields = run_fields;
    if (strcmp(word, "run") == 0)
        return scenario;
    for (int i = 0; i < LISTS; i++) {
        int count;
        memcpy(&count, (char *)scenario + lists[i].count, sizeof count);
        if (strcmp(word, lists[i].word) != 0 || count == lists[i].room)
            continue;
        *fields = lists[i].fields;
        void *item = (char *)scenario + lists[i].items + (size_t)count++ * lists[i].size;
        memcpy((char *)scenario + lists[i].count, &count, sizeof count);
        return item;
    }
    return NULL;
}

static const char *read_line(scenario_t *scenario, char *line)
{
    char *rest, *word = strtok_r(line, " \t\r\n", &rest);
    const field_t *fields;
    if (!word || word[0] == '#')
        return NULL;
    void *item = item_of(scenario, word, &fields);
    if (!item)
        return "expected run, axis, step or fault, and no more of them than there is room for";
    while ((word = strtok_r(NULL, " \t\r\n", &rest))) {
        if (fields == run_fields && strncmp(word, "seed=", 5) == 0) {
            scenario->seed = strtoull(word + 5, NULL, 10);
            continue;
        }
        const char *wrong = read_pair(fields, word, item);
        if (wrong)
            return wrong;
    }
    return NULL;
}

/** Numbers that the rest of the program takes as places in lists. */
static const char *check(const scenario_t *scenario)
{
    if (scenario->axis_count < 1 || scenario->cycles < 1 || scenario->cycle_us < 1)
        return "it needs an axis, cycles and cycle_us";
    for (int i = 0; i < scenario->step_count; i++) {
        const step_t *step = &scenario->steps[i];
        if (!(step->axis >= 0 && step->axis < scenario->axis_count && step->master >= 0 &&
              step->master < scenario->axis_count))
            return "a step names an axis that is not there";
    }
    for (int i = 0; i < scenario->fault_count; i++)
        if (!(scenario->faults[i].axis >= 0 && scenario->faults[i].axis < scenario->axis_count))
            return "a fault names an axis that is not there";
    return NULL;
}

bool scenario_read(scenario_t *scenario, FILE *file, char *text, size_t size)
{
    char line[LINE_BYTES];
    *scenario = (scenario_t){0};
    for (int number = 1; fgets(line, sizeof line, file); number++) {
        const char *wrong = read_line(scenario, line);
        if (wrong)
            return snprintf(text, size, "line %d: %s", number, wrong) < 0;
    }
    const char *wrong = check(scenario);
    return !wrong || snprintf(text, size, "%s", wrong) < 0;
}
