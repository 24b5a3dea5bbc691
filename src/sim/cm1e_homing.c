#include "sim/cm1e_app.h"

/* UG 6.2.4 */
static const struct {
    int8_t method, direction;
    uint8_t input;
} methods[] = {
    {-1, +1, 0}, {-2, -1, 0}, {-3, +1, CM1E_SIM_INPUT_2}, {-4, -1, CM1E_SIM_INPUT_2}, {-5, +1, CM1E_SIM_INPUT_3},
    {-6, -1, CM1E_SIM_INPUT_3},
};
enum { METHOD_COUNT = sizeof methods / sizeof methods[0] };

bool cm1e_sim_homing_running(const cm1e_sim_cm1e_t *drive)
{
    return cm1e_sim_search_running(&drive->homing.search);
}

void cm1e_sim_homing_reset(cm1e_sim_cm1e_t *drive) { drive->homing = (cm1e_sim_homing_t){0}; }

void cm1e_sim_homing_abort(cm1e_sim_cm1e_t *drive)
{
    drive->homing.halted = drive->homing.abandoned = false;
    if (cm1e_sim_homing_running(drive))
        drive->homing.search.phase = SEARCH_IDLE;
}

/* ---- the mode --------------------------------------------------------------------------------------------------- */

static cm1e_sim_searcher_t searcher(cm1e_sim_cm1e_t *drive)
{
    return (cm1e_sim_searcher_t){&drive->servo, &drive->mechanics, &drive->zero};
}

/* Where an input is held by the console, its sensor switches nowhere. */
static void look_at_sensor(cm1e_sim_cm1e_t *drive)
{
    const uint8_t input = drive->homing.input;
    cm1e_sim_search_t *search = &drive->homing.search;
    search->sensor = (cm1e_sim_digital_inputs(drive) & input) != 0;
    search->edge = cm1e_sim_sensors_edge(&drive->sensors, input);
}

static void homing_step(cm1e_sim_cm1e_t *drive, double step_s)
{
    cm1e_sim_homing_t *homing = &drive->homing;
    const cm1e_sim_searcher_t motor = searcher(drive);
    if (homing->halted || homing->abandoned) {
        cm1e_sim_search_stand(&homing->search, &motor, step_s);
        cm1e_servo_rest(&drive->servo, &drive->mechanics);
        if (homing->abandoned && drive->servo.reference_velocity == 0)
            cm1e_sim_homing_abort(drive);
        return;
    }
    const bool was_running = cm1e_sim_search_running(&homing->search);
    look_at_sensor(drive);
    cm1e_sim_search_step(&homing->search, &motor, step_s);
    if (was_running && homing->search.phase == SEARCH_DONE)
        drive->servo.torque_limit = drive->motor->peak_torque_nm;
}

static void start(cm1e_sim_cm1e_t *drive)
{
    const cm1e_sim_objects_t *objects = &drive->objects;
    for (size_t i = 0; i < METHOD_COUNT; i++) {
        if (methods[i].method != objects->homing_method)
            continue;
        drive->homing = (cm1e_sim_homing_t){
            .search = {.direction = methods[i].direction, .speed = objects->homing_speed,
                       .acceleration = objects->homing_acceleration, .offset = objects->home_offset},
            .input = methods[i].input,
        };
        look_at_sensor(drive);
        cm1e_sim_search_begin(&drive->homing.search, methods[i].input != 0);
        drive->servo.torque_limit = drive->rated_torque * objects->homing_torque / 100;
        return;
    }
}

static void homing_outputs(cm1e_sim_cm1e_t *drive, uint16_t rising_bits)
{
    cm1e_sim_homing_t *homing = &drive->homing;
    const bool halt = (drive->objects.controlword & CONTROLWORD_HALT) != 0;
    const bool leaving = drive->fsa.next_mode != CM1E_MODE_HM;
    /* UG 10.1, V1.3.0: before it the halt bit had no effect together with a switch of mode. */
    if (halt && cm1e_sim_homing_running(drive) && !(leaving && drive->firmware->firmware < CM1E_FIRMWARE_1_3_0))
        homing->halted = true;
    if (!(rising_bits & CONTROLWORD_HOMING_START) || halt)
        return;
    if (homing->halted)
        homing->halted = false; /* "start or continue" */
    else if (!cm1e_sim_homing_running(drive))
        start(drive);
}

static void homing_enter(cm1e_sim_cm1e_t *drive)
{
    drive->servo.own_profile = true;
    drive->homing.search.acceleration = drive->objects.homing_acceleration;
    if (!cm1e_sim_homing_running(drive))
        drive->homing.halted = false;
}

/* The table of bits 13, 12 and 10 in UG 6.2.4. */
static uint16_t homing_status_bits(const cm1e_sim_cm1e_t *drive)
{
    const cm1e_sim_homing_t *homing = &drive->homing;
    const cm1e_sim_search_phase_t phase = homing->search.phase;
    const bool running = cm1e_sim_homing_running(drive);
    const bool error = drive->fsa.state == FAULT || drive->fsa.state == FAULT_REACTION_ACTIVE;
    const bool stands = cm1e_sim_stands(drive);
    const bool attained = phase == SEARCH_DONE || (phase >= SEARCH_APPROACH && !homing->halted);
    const bool reached = running ? homing->halted && stands : !error || stands;
    return (uint16_t)((error ? STATUSWORD_HOMING_ERROR : 0) | (attained ? STATUSWORD_HOMING_ATTAINED : 0) |
                      (reached ? STATUSWORD_TARGET_REACHED : 0));
}

const cm1e_sim_mode_t cm1e_sim_homing_mode = {CM1E_MODE_HM, homing_enter, homing_outputs, homing_step,
                                              homing_status_bits};
