/**
 * @file motion.h
 * The points at which the motor moves: a program of function blocks for each, and the run around it.
 */
#ifndef CM1E_TOOLS_PROVE_MOTION_H
#define CM1E_TOOLS_PROVE_MOTION_H

#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "prove/prove.h"

typedef enum motion_step { MOTION_POWER, MOTION_ACT, MOTION_STOP, MOTION_OFF, MOTION_END } motion_step_t;

typedef struct motion motion_t;
struct motion {
    prove_t *prove;
    const point_t *point;
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    double velocity, distance;  /**< revolutions/s, revolutions */
    double acceleration;        /**< revolutions/s2, of the axis */

    motion_step_t step;
    int64_t step_ns;            /**< when the step began */
    MC_Power_t power;
    MC_MoveRelative_t there, back;
    MC_MoveVelocity_t run;
    MC_Reset_t reset;
    MC_Stop_t stop;
    MC_Home_t home;

    cm1e_axis_info_t begin, now;
    double last_position, travelled; /**< since the motor was enabled; a homing does not change it */
    double farthest;
    double deviation_there, deviation_back, from_position, shown_sum;
    int64_t from_ns;
    unsigned shown_count;
    int64_t last_ns, quarter_ns, three_quarters_ns; /**< the last cycle; when a run had these parts of its velocity */
    double speed;               /**< revolutions/s, by the positions of the last two cycles */
    int8_t mode;                /**< while it moved */
    double shown, measured;     /**< velocities, of a run */
    bool enabled, done, failed, beyond, paused;
    WORD error_id;
    uint16_t failed_device_error; /**< 0x603F at that time */
    uint16_t al_code;           /**< after the pause */
    char error[300];
};

/** The method of a point of homing: -1 ... -6, behind a bridge 1 ... 4. */
static inline int motion_method(const point_t *point)
{
    return point->row < MOVE_HOME_BRIDGE ? -1 - (point->row - MOVE_HOME) : 1 + point->row - MOVE_HOME_BRIDGE;
}
/** Every cycle. */
void motion_program(void *context);
/** The comparisons of the point, after the run. */
void motion_judge(motion_t *motion);

#endif
