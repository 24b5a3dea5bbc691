/* What moves the reference of the servo: the modes of operation, and the touch probes that look at the motor. */
#include <math.h>

#include "sim/cia402_app.h"

#define POSITION_WINDOW 10.0  /* counts of the mechanics; target reached */
#define VELOCITY_WINDOW 500.0 /* counts/s */
#define REACHED_TIME_S 0.005

/* Positions, velocities and accelerations on the wire are counts of the drive; the mechanics have their own. */
static double from_wire(const cm1e_sim_cia402_t *drive, double counts) { return counts / drive->scale; }

/* 0x607A has 32 bits and wraps: the nearest turn of the wheel is meant. */
static double target_position(cm1e_sim_cia402_t *drive)
{
    cm1e_sim_cia402_refresh(drive);
    const int32_t actual = (int32_t)*drive->v.position;
    const int32_t way = (int32_t)((uint32_t)*drive->v.target_position - (uint32_t)actual);
    const double shown = floor(drive->mechanics.position * drive->scale + 0.5);
    return from_wire(drive, shown + way);
}

static double limited(const cm1e_sim_cia402_t *drive, double counts_per_s)
{
    return from_wire(drive, fmax(fmin(counts_per_s, drive->peak_velocity), -drive->peak_velocity));
}

static bool halt_bit(const cm1e_sim_cia402_t *drive) { return *drive->v.controlword & CONTROLWORD_HALT; }

static double cycle_s(const cm1e_sim_cia402_t *drive)
{
    return (double)*drive->v.interpolation_value * pow(10, (double)*drive->v.interpolation_index);
}

/* ---- csp, csv ---------------------------------------------------------------------------------------------------- */

static void csp_enter(cm1e_sim_cia402_t *drive)
{
    cm1e_sim_line_begin(&drive->line, &drive->servo, target_position(drive));
}

static void csp_outputs(cm1e_sim_cia402_t *drive, uint16_t rising_bits)
{
    (void)rising_bits;
    cm1e_sim_line_target(&drive->line, target_position(drive), cycle_s(drive));
}

static void csp_step(cm1e_sim_cia402_t *drive, double step_s)
{
    cm1e_sim_line_step(&drive->line, &drive->servo, cycle_s(drive), step_s);
}

/* "Drive follows the command value" (ETG.6010). */
static uint16_t cyclic_bits(const cm1e_sim_cia402_t *drive)
{
    return drive->state == OPERATION_ENABLED ? STATUSWORD_BIT12 : 0;
}

static void velocity_outputs(cm1e_sim_cia402_t *drive, uint16_t rising_bits)
{
    (void)rising_bits;
    drive->goal_velocity = limited(drive, (double)(int32_t)*drive->v.target_velocity);
}

static void csv_enter(cm1e_sim_cia402_t *drive)
{
    cm1e_servo_forget_distance(&drive->servo, &drive->mechanics);
    drive->servo.own_profile = false;
    velocity_outputs(drive, 0);
}

static void csv_step(cm1e_sim_cia402_t *drive, double step_s)
{
    drive->servo.reference_velocity = drive->goal_velocity;
    cm1e_servo_run(&drive->servo, &drive->mechanics, step_s);
}

/* ---- pv ---------------------------------------------------------------------------------------------------------- */

static void pv_enter(cm1e_sim_cia402_t *drive)
{
    cm1e_servo_forget_distance(&drive->servo, &drive->mechanics);
    drive->servo.own_profile = true;
    velocity_outputs(drive, 0);
}

static void pv_step(cm1e_sim_cia402_t *drive, double step_s)
{
    cm1e_servo_t *servo = &drive->servo;
    const double wanted = halt_bit(drive) ? 0 : drive->goal_velocity;
    const bool slower = fabs(wanted) < fabs(servo->reference_velocity);
    const int64_t ramp = slower ? *drive->v.profile_deceleration : *drive->v.profile_acceleration;
    cm1e_sim_ramp(&servo->reference_velocity, wanted, from_wire(drive, (double)ramp), step_s);
    cm1e_servo_run(&drive->servo, &drive->mechanics, step_s);
    drive->reached_s = fabs(drive->mechanics.velocity - wanted) < VELOCITY_WINDOW ? drive->reached_s + step_s : 0;
    cm1e_servo_rest(servo, &drive->mechanics);
}

static uint16_t pv_bits(const cm1e_sim_cia402_t *drive)
{
    const bool stands = cm1e_sim_cia402_stands(drive);
    const bool at_rest = drive->state != OPERATION_ENABLED || halt_bit(drive) || drive->goal_velocity == 0;
    const bool reached = at_rest ? stands : drive->reached_s >= REACHED_TIME_S;
    return (uint16_t)((reached ? STATUSWORD_TARGET_REACHED : 0) | (stands ? STATUSWORD_BIT12 : 0));
}

/* ---- pp: single set-points that act at once ---------------------------------------------------------------------- */

static void pp_enter(cm1e_sim_cia402_t *drive)
{
    cm1e_servo_t *servo = &drive->servo;
    const double acceleration = from_wire(drive, (double)*drive->v.profile_acceleration);
    servo->own_profile = true;
    drive->goal = cm1e_sim_stopping_place(servo, fmax(acceleration, 1));
    drive->acknowledge = false;
}

static void pp_outputs(cm1e_sim_cia402_t *drive, uint16_t rising_bits)
{
    const uint16_t controlword = (uint16_t)*drive->v.controlword;
    if (rising_bits & CONTROLWORD_NEW_SET_POINT && controlword & CONTROLWORD_CHANGE_IMMEDIATELY) {
        drive->goal = target_position(drive);
        drive->acknowledge = true;
    } else if (!(controlword & CONTROLWORD_NEW_SET_POINT))
        drive->acknowledge = false;
}

static void pp_step(cm1e_sim_cia402_t *drive, double step_s)
{
    cm1e_servo_t *servo = &drive->servo;
    const double acceleration = fmax(from_wire(drive, (double)*drive->v.profile_acceleration), 1);
    if (halt_bit(drive))
        cm1e_sim_halt_step(servo, acceleration, step_s);
    else
        cm1e_sim_move_step(servo, drive->goal, limited(drive, (double)*drive->v.profile_velocity), acceleration,
                           step_s);
}

static bool pp_reached(const cm1e_sim_cia402_t *drive)
{
    if (drive->state != OPERATION_ENABLED)
        return false;
    if (halt_bit(drive))
        return cm1e_sim_cia402_stands(drive);
    return drive->servo.reference == drive->goal && drive->servo.reference_velocity == 0 &&
           fabs(drive->goal - drive->mechanics.position) <= POSITION_WINDOW;
}

static uint16_t pp_bits(const cm1e_sim_cia402_t *drive)
{
    return (uint16_t)((pp_reached(drive) ? STATUSWORD_TARGET_REACHED : 0) |
                      (drive->acknowledge ? STATUSWORD_SET_POINT_ACKNOWLEDGE : 0));
}

/* ---- hm ---------------------------------------------------------------------------------------------------------- */

/* Methods by IEC 61800-7-201 (CiA 402-2), object 6098h: 17 ... 30 are 1 ... 14 without the index pulse. Limit switches
 * are 0x60FD bits 0 (negative) and 1 (positive), the home switch is bit 2. While that switch is off, 19 and 20 (3 and
 * 4) begin in positive direction, 21 and 22 (5 and 6) in negative direction; while it is on, they leave it first. The
 * two of a pair take the two edges of the switch signal, which are one place here because the switch has no hysteresis.
 * 37 takes the position where the motor is; 35 is the same in older editions. */
static const struct {
    int8_t method, direction;
    uint8_t input;
} methods[] = {{17, -1, 0x01}, {18, +1, 0x02}, {19, +1, 0x04}, {20, +1, 0x04},
               {21, -1, 0x04}, {22, -1, 0x04}, {35, 0, 0},     {37, 0, 0}};
enum { METHODS = sizeof methods / sizeof methods[0] };
#define TAKE_TIME_S 0.02

static void look_at_switch(cm1e_sim_cia402_t *drive)
{
    cm1e_sim_cia402_homing_t *homing = &drive->homing;
    homing->search.sensor = cm1e_sim_cia402_inputs(drive) & homing->input;
    homing->search.edge = homing->input == 0x01 ? NAN : cm1e_sim_sensors_edge(&drive->sensors, homing->input);
}

static void homing_start(cm1e_sim_cia402_t *drive)
{
    cm1e_sim_cia402_homing_t *homing = &drive->homing;
    *homing = (cm1e_sim_cia402_homing_t){.failed = true};
    for (size_t i = 0; i < METHODS; i++) {
        if (methods[i].method != (int8_t)*drive->v.homing_method)
            continue;
        *homing = (cm1e_sim_cia402_homing_t){
            .started = true, .input = methods[i].input,
            .search = {.direction = methods[i].direction, .speed = from_wire(drive, (double)*drive->v.homing_speed),
                       .acceleration = from_wire(drive, (double)*drive->v.homing_acceleration)},
        };
        if (homing->input) {
            look_at_switch(drive);
            cm1e_sim_search_begin(&homing->search, true);
        }
        return;
    }
}

static void hm_enter(cm1e_sim_cia402_t *drive)
{
    drive->servo.own_profile = true;
    drive->homing.halted = false;
    if (drive->homing.search.phase != SEARCH_DONE)
        drive->homing = (cm1e_sim_cia402_homing_t){0};
}

/* Bit 4 starts, and ends what it started when it is taken away. */
static void hm_outputs(cm1e_sim_cia402_t *drive, uint16_t rising_bits)
{
    cm1e_sim_cia402_homing_t *homing = &drive->homing;
    const bool start = *drive->v.controlword & CONTROLWORD_HOMING_START;
    if (rising_bits & CONTROLWORD_HOMING_START && !halt_bit(drive))
        homing_start(drive);
    const bool running = homing->started && homing->search.phase != SEARCH_DONE;
    homing->halted = running && (halt_bit(drive) || !start);
}

/* The drive stays where it found its reference; that place shows as the home offset. */
static void take_zero(cm1e_sim_cia402_t *drive)
{
    const double offset = (double)*drive->v.home_offset;
    drive->zero = (int64_t)floor(drive->mechanics.position * drive->scale - offset + 0.5);
    drive->homing.search.phase = SEARCH_DONE;
}

static void hm_step(cm1e_sim_cia402_t *drive, double step_s)
{
    cm1e_sim_cia402_homing_t *homing = &drive->homing;
    int64_t unused;
    const cm1e_sim_searcher_t motor = {&drive->servo, &drive->mechanics, &unused};
    if (!homing->started || homing->halted || homing->search.phase == SEARCH_DONE) {
        if (homing->search.acceleration > 0)
            cm1e_sim_search_stand(&homing->search, &motor, step_s);
        cm1e_servo_rest(&drive->servo, &drive->mechanics);
        return;
    }
    if (!homing->input) {
        homing->settle_s += step_s;
        if (homing->settle_s >= TAKE_TIME_S)
            take_zero(drive);
        return;
    }
    look_at_switch(drive);
    cm1e_sim_search_step(&homing->search, &motor, step_s);
    if (homing->search.phase == SEARCH_DONE)
        take_zero(drive);
}

static uint16_t hm_bits(const cm1e_sim_cia402_t *drive)
{
    const cm1e_sim_cia402_homing_t *homing = &drive->homing;
    const bool done = homing->search.phase == SEARCH_DONE;
    const bool running = homing->started && !done && !homing->halted;
    const bool reached = !running && (done || cm1e_sim_cia402_stands(drive));
    return (uint16_t)((homing->failed ? STATUSWORD_HOMING_ERROR : 0) | (done ? STATUSWORD_HOMING_ATTAINED : 0) |
                      (reached ? STATUSWORD_TARGET_REACHED : 0));
}

const cm1e_sim_cia402_mode_t *cm1e_sim_cia402_mode(int8_t mode)
{
    static const cm1e_sim_cia402_mode_t modes[] = {
        {CM1E_MODE_PP, pp_enter, pp_outputs, pp_step, pp_bits},
        {CM1E_MODE_PV, pv_enter, velocity_outputs, pv_step, pv_bits},
        {CM1E_MODE_HM, hm_enter, hm_outputs, hm_step, hm_bits},
        {CM1E_MODE_CSP, csp_enter, csp_outputs, csp_step, cyclic_bits},
        {CM1E_MODE_CSV, csv_enter, velocity_outputs, csv_step, cyclic_bits},
    };
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++)
        if (modes[i].mode == mode)
            return &modes[i];
    return NULL;
}

bool cm1e_sim_cia402_brake(cm1e_sim_cia402_t *drive, double step_s)
{
    cm1e_servo_t *servo = &drive->servo;
    cm1e_sim_ramp(&servo->reference_velocity, 0, from_wire(drive, (double)*drive->v.quick_stop_deceleration), step_s);
    servo->reference += servo->reference_velocity * step_s;
    return servo->reference_velocity == 0;
}

/* ---- touch probes ------------------------------------------------------------------------------------------------ */

/* Probe 1 is wired to the home switch (IN3), probe 2 to the positive limit switch (IN2). */
static const uint8_t probe_inputs[2] = {CM1E_SIM_INPUT_3, CM1E_SIM_INPUT_2};

/* To the count: where the sensor switches, and not where the step ended. */
static int64_t probed(const cm1e_sim_cia402_t *drive, uint8_t input)
{
    const double edge = cm1e_sim_sensors_edge(&drive->sensors, input);
    const double place = isnan(edge) ? drive->mechanics.position : edge;
    return (int64_t)floor(place * drive->scale + 0.5) - drive->zero;
}

static void probe(cm1e_sim_cia402_t *drive, unsigned n, bool was, bool is)
{
    const unsigned function = (unsigned)*drive->v.probe_function >> 8 * n & 0xFF;
    const unsigned before = (unsigned)drive->probe_before >> 8 * n & 0xFF;
    unsigned status = (unsigned)*drive->v.probe_status >> 8 * n & 0xFF;
    if (!(function & CM1E_PROBE_ENABLE)) {
        status = 0;
    } else {
        if (!(before & CM1E_PROBE_ENABLE)) /* the rising edge of the enable bit arms it anew */
            status = CM1E_PROBE_ENABLED;
        for (unsigned falling = 0; falling < 2; falling++) {
            const unsigned wanted = (unsigned)CM1E_PROBE_POSITIVE << falling;
            const unsigned stored = (unsigned)CM1E_PROBE_POSITIVE_STORED << falling;
            if (!(function & wanted)) /* timing diagram of the touch probe: sampling off resets "stored" */
                status &= ~stored;
            const bool again = function & CM1E_PROBE_CONTINUOUS || !(status & stored);
            if (function & wanted && again && was == (falling == 1) && is != was) {
                *drive->v.probe_positions[2 * n + falling] = (int32_t)probed(drive, probe_inputs[n]);
                status |= stored;
            }
        }
    }
    const unsigned others = (unsigned)*drive->v.probe_status & ~(0xFFu << 8 * n);
    *drive->v.probe_status = others | status << 8 * n;
}

void cm1e_sim_cia402_probe_step(cm1e_sim_cia402_t *drive)
{
    const uint8_t levels = (uint8_t)cm1e_sim_cia402_inputs(drive);
    for (unsigned n = 0; n < 2; n++)
        probe(drive, n, drive->probe_inputs & probe_inputs[n], levels & probe_inputs[n]);
    drive->probe_inputs = levels;
    drive->probe_before = (uint16_t)*drive->v.probe_function;
}
