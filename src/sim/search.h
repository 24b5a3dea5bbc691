/**
 * @file search.h
 * The origin search of a simulated motor: to a hard stop or a sensor, then to an offset, with its servo. It is common
 * to the CM1-E's homing (UG 6.2.4) and the Cool Muscle's origin search (BR 6.4). @rt cycle.
 */
#ifndef CM1E_SIM_SEARCH_H
#define CM1E_SIM_SEARCH_H

#include <stdint.h>

#include "sim/reference.h"

typedef enum cm1e_sim_search_phase {
    SEARCH_IDLE = 0,      /**< not started, or aborted */
    SEARCH_LEAVE_SENSOR,  /**< standing on the sensor: move off it first */
    SEARCH_TURN_ROUND,    /**< off the sensor: stop */
    SEARCH_SENSOR,
    SEARCH_STOP,
    SEARCH_APPROACH,      /**< back to the captured position or the encoder tooth */
    SEARCH_OFFSET,
    SEARCH_DONE,
    SEARCH_PHASE_COUNT,
} cm1e_sim_search_phase_t;

typedef struct cm1e_sim_search {
    cm1e_sim_search_phase_t phase;
    int8_t direction;      /**< +1 CW, -1 CCW */
    bool sensor;           /**< is on now; kept up to date before every step */
    double edge;           /**< where it switches, on the scale of the mechanics; NAN: not known */
    double speed, acceleration;
    double offset;         /**< counts from the origin to the position 0 */
    double target;         /**< counts on the scale of the mechanics */
    double stalled_s;      /**< how long the torque limit has held the motor, or a move has been settling */
} cm1e_sim_search_t;

/** The motor that searches. `zero`: the place on the scale of the mechanics that counts as 0. */
typedef struct cm1e_sim_searcher {
    cm1e_servo_t *servo;
    const cm1e_mechanics_t *mechanics;
    int64_t *zero;
} cm1e_sim_searcher_t;

/** Begins a search; direction, sensor, edge, speed, acceleration and offset must be set. */
void cm1e_sim_search_begin(cm1e_sim_search_t *search, bool by_sensor);
void cm1e_sim_search_step(cm1e_sim_search_t *search, const cm1e_sim_searcher_t *motor, double step_s);
/** Stops the motor without leaving the phase. */
void cm1e_sim_search_stand(const cm1e_sim_search_t *search, const cm1e_sim_searcher_t *motor, double step_s);
static inline bool cm1e_sim_search_running(const cm1e_sim_search_t *search)
{
    return search->phase != SEARCH_IDLE && search->phase != SEARCH_DONE;
}

#endif
