/* Function blocks that a program calls with anything: NaN, infinities, denormals, enumerations that do not exist, NULL and
 * handles that name nothing, in any order. block_machine.h judges every call and every set-point.
 *
 * An input: the kind of the machine; then one instruction after the other, each a byte and its operands. */
#include <string.h>

#include "block_machine.h"
#include "fuzz.h"

enum { MOST_CYCLES = 800, LONG_CYCLES = 150 };

typedef enum instruction {
    DO_PASS = 0, DO_MAKE, DO_PUT, DO_TRIGGER, DO_POWER, DO_FAULT, DO_TABLE, DO_TURN, INSTRUCTIONS,
} instruction_t;

/* What blocks point at, beside axes and groups. */
static MC_TP_REF positions;
static MC_TV_REF velocities;
static MC_TA_REF accelerations;
static MC_CAM_POINT points[8];
static MC_CAM_REF cam;
static MC_CAMSWITCH_REF switches;
static MC_TRACK_REF tracks;
static MC_OUTPUT_REF output;
static MC_INPUT_REF in;
static MC_TRIGGER_REF probe;
static cm1e_homing_config_t homing;

static const struct {
    const char *member;
    void *what;
} tables[] = {{"TimePosition", &positions}, {"TimeVelocity", &velocities}, {"TimeAcceleration", &accelerations},
              {"CamTable", &cam}, {"Switches", &switches}, {"TrackOptions", &tracks}, {"Outputs", &output},
              {"Output", &output}, {"Input", &in}, {"TriggerInput", &probe}, {"Parameters", &homing}};

static void begin_tables(void)
{
    memset(&positions, 0, sizeof positions);
    memset(&velocities, 0, sizeof velocities);
    memset(&accelerations, 0, sizeof accelerations);
    memset(&switches, 0, sizeof switches);
    memset(&tracks, 0, sizeof tracks);
    for (int i = 0; i < 8; i++)
        points[i] = (MC_CAM_POINT){.Master = i * 10, .Slave = i % 2};
    cam = (MC_CAM_REF){.Points = points, .NumberOfPoints = 8};
    output = (MC_OUTPUT_REF){.Axis = machine.named[0]};
    in = (MC_INPUT_REF){.Axis = machine.named[0]};
    probe = (MC_TRIGGER_REF){.Axis = machine.named[0]};
    homing = (cm1e_homing_config_t){.method = -1};
}

static void make_block(unsigned number, int axis)
{
    instance_t *fb = machine_make(block_table[number % block_count].name, axis);
    for (size_t i = 0; fb && i < sizeof tables / sizeof *tables; i++)
        point_at(fb, tables[i].member, tables[i].what);
}

/* ---- instructions ------------------------------------------------------------------------------------------------ */

static void put_input(const uint8_t **at, const uint8_t *end)
{
    const unsigned n = fuzz_take(at, end, 1), k = fuzz_take(at, end, 1);
    if (machine.count == 0)
        return;
    instance_t *fb = &machine.blocks[n % (unsigned)machine.count];
    const block_t *type = fb->view->type;
    const block_member_t *m = &type->members[k % type->member_count];
    if (m->section != BLOCK_OUTPUT)
        machine_put(fb, m, at, end);
}

static void put_fault(const uint8_t **at, const uint8_t *end)
{
    const unsigned what = fuzz_take(at, end, 1), how = fuzz_take(at, end, 2);
    cm1e_bus_t *motor = &machine.bus;
    switch (what % 7) {
    case 0: fake_bus_fault(motor, cm1e_device_errors[how % cm1e_device_error_count].code); break;
    case 1: motor->power = how & 1; break;
    case 2: motor->blocked = how & 1; break;
    case 3: machine.lost = (int)(how % 16); break;
    case 4: motor->digital_inputs = (uint16_t)(how % 16); break;
    case 5: machine.encoder_step = (int16_t)how / 16; break;
    default: motor->torque = (int16_t)how; break;
    }
}

static void put_pair(const uint8_t **at, const uint8_t *end)
{
    const unsigned table = fuzz_take(at, end, 1), n = fuzz_take(at, end, 1);
    const TIME time = (TIME)fuzz_take(at, end, 4);
    const double value = fuzz_take_real(at, end);
    MC_CAM_POINT *point = &points[n % 8];
    switch (table % 8) {
    case 0:
        positions.MC_TP_Array[n % 8] = (MC_TP){time, value};
        positions.NumberOfPairs = (WORD)(n % 16);
        break;
    case 1:
        velocities.MC_TV_Array[n % 8] = (MC_TV){time, value};
        velocities.NumberOfPairs = (WORD)(n % 16);
        break;
    case 2:
        accelerations.MC_TA_Array[n % 8] = (MC_TA){time, value};
        accelerations.NumberOfPairs = (WORD)(n % 16);
        break;
    case 3: cam.Curve = (MC_CAM_CURVE)(time % 4), cam.NumberOfPoints = (UINT)(n % 10 > 8 ? 0 : n % 9); break;
    case 4: *(time & 1 ? &point->Master : &point->Slave) = value; break;
    case 5: *(time & 1 ? &point->Velocity : &point->Acceleration) = value; break;
    case 6:
        switches.Switches[n % CM1E_CAM_SWITCHES] = (MC_CAMSWITCH){
            .TrackNumber = (INT)(time % 40), .FirstOnPosition = value, .LastOnPosition = fuzz_take_real(at, end),
            .AxisDirection = (INT)(time / 64 % 4), .CamSwitchMode = (INT)(time / 256 % 3), .Duration = time};
        switches.NumberOfSwitches = (UINT)(n % 40);
        tracks.Tracks[n % CM1E_CAM_TRACKS] = (MC_TRACK){time, -time, fuzz_take_real(at, end)};
        break;
    default:
        output.Axis = in.Axis = probe.Axis = machine.named[n % (MACHINE_AXES + 2)];
        output.Number = in.Number = probe.InputNumber = (INT)time;
        homing = (cm1e_homing_config_t){.method = (int8_t)time, .velocity = value, .acceleration = value,
                                        .torque = fuzz_take_real(at, end), .timeout_s = fuzz_take_real(at, end)};
    }
}

static int pass(unsigned code, int left)
{
    const int wanted = code >= 0xF0 ? LONG_CYCLES : 1 + (int)code % 64, cycles = wanted < left ? wanted : left;
    machine_cycles(cycles);
    return cycles;
}

static int execute(const uint8_t **at, const uint8_t *end, int left)
{
    const instruction_t instruction = (instruction_t)(fuzz_take(at, end, 1) % INSTRUCTIONS);
    const unsigned operand = instruction == DO_PUT || instruction == DO_FAULT || instruction == DO_TABLE
                                 ? 0 : fuzz_take(at, end, 1);
    switch (instruction) {
    case DO_PASS:
        return pass(operand, left);
    case DO_MAKE:
        make_block(operand, (int)(fuzz_take(at, end, 1) % MACHINE_AXES));
        break;
    case DO_PUT:
        put_input(at, end);
        break;
    case DO_TRIGGER:
        if (machine.count > 0) {
            instance_t *fb = &machine.blocks[operand % (unsigned)machine.count];
            trigger(fb, !fb->now.trigger);
        }
        break;
    case DO_POWER:
        machine.powers[operand % MACHINE_AXES].Enable = operand & 8 ? TRUE : FALSE;
        machine.powers[operand % MACHINE_AXES].EnablePositive = operand & 16 ? TRUE : FALSE;
        machine.powers[operand % MACHINE_AXES].EnableNegative = operand & 32 ? TRUE : FALSE;
        break;
    case DO_FAULT:
        put_fault(at, end);
        break;
    case DO_TABLE:
        put_pair(at, end);
        break;
    case DO_TURN:
    case INSTRUCTIONS:
        machine.first = (int)operand;
    }
    return 0;
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    const uint8_t *at = bytes, *end = size ? bytes + size : bytes;
    machine_begin(fuzz_take(&at, end, 1));
    begin_tables();
    for (int left = MOST_CYCLES; at < end && left > 0;)
        left -= execute(&at, end, left);
    machine_cycles(2);
    machine_end();
    return false;
}

/** Lets the second block try a member with a hostile value, and makes that good again. */
static size_t try_member(uint8_t *bytes, uint8_t k, const block_member_t *m, uint8_t value)
{
    const bool real = m->type == BLOCK_LREAL;
    const unsigned good = 160 + 80 * (k % 4u); /* 10 ... 25, so that a motion has to change */
    const uint8_t begin[] = {DO_PUT, 1, k, value}, run[] = {DO_TRIGGER, 1, DO_PASS, 50, DO_TRIGGER, 1, DO_PASS, 1};
    const uint8_t end[] = {DO_PUT, 1, k, real ? 0x90 : m->type == BLOCK_POINTER, (uint8_t)good, (uint8_t)(good >> 8)};
    const size_t end_bytes = real ? 6 : 4;
    memcpy(bytes, begin, sizeof begin);
    memcpy(bytes + sizeof begin, run, sizeof run);
    memcpy(bytes + sizeof begin + sizeof run, end, end_bytes);
    return sizeof begin + sizeof run + end_bytes;
}

/** Each block behind a motion; then with one hostile number in each of its inputs, one after the other. */
void fuzz_seeds(void)
{
    static const uint8_t hostile[] = {0, 1, 6, 8}; /* of fuzz_take_real(): NaN, infinity, 1e300, 2^31 */
    unsigned mover = 0;
    char name[80];
    while (strcmp(block_table[mover].name, "MC_MoveVelocity") != 0)
        mover++;
    for (size_t i = 0; i < block_count; i++) {
        const block_t *type = &block_table[i];
        uint8_t bytes[1000] = {(uint8_t)(i * 37)};
        const uint8_t head[] = {DO_MAKE, (uint8_t)mover, 1, DO_MAKE, (uint8_t)i, 0, DO_TRIGGER, 0, DO_PASS, 40,
                                DO_TRIGGER, 1, DO_PASS, 0xF0, DO_TRIGGER, 1, DO_PASS, 2};
        memcpy(bytes + 1, head, sizeof head);
        snprintf(name, sizeof name, "%s.bin", type->name);
        fuzz_seed(name, bytes, 1 + sizeof head);
        for (size_t n = 0; n < sizeof hostile; n++) {
            size_t at = 1 + sizeof head - 8; /* not yet with what makes sense */
            for (size_t k = 0; k < type->member_count && at + 30 < sizeof bytes; k++) {
                const block_member_t *m = &type->members[k];
                const bool one_value = m->type == BLOCK_LREAL && m->size == sizeof(LREAL);
                if (m->section != BLOCK_OUTPUT && (one_value || m->type == BLOCK_ENUM || m->type == BLOCK_POINTER))
                    at += try_member(bytes + at, (uint8_t)k, m, hostile[n]);
            }
            snprintf(name, sizeof name, "%s_%u.bin", type->name, hostile[n]);
            fuzz_seed(name, bytes, at);
        }
    }
}
