/* MC_GearIn, MC_CombineAxes: the coupling function is the sum of the masters' motions, each times its ratio. MC_GearOut
 * and MC_CamOut leave the masters. */
#include <math.h>

#include "axis/axis_commands.h"
#include "axis/axis_plan.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling_private.h"

static inline from_t sum_of(const follow_t *follow, int masters)
{
    double counts = 0.0, velocity = 0.0, acceleration = 0.0;
    for (int i = 0; i < masters; i++) {
        const link_t *link = &follow->links[i];
        counts += link->seen.counts * link->counts_ratio;
        velocity += link->seen.velocity * link->ratio;
        acceleration += link->seen.acceleration * link->ratio;
    }
    return (from_t){cm1e_position_towards(follow->anchor, counts), velocity, acceleration, false};
}

static void evaluate(cm1e_axis_t *axis, follow_t *follow, from_t *point)
{
    (void)axis;
    *point = sum_of(follow, follow->count);
}

static double steepest(const cm1e_axis_t *axis, const follow_t *follow, int link)
{
    (void)axis;
    return fabs(follow->links[link].ratio);
}

static bool bounds(const cm1e_axis_t *axis, const follow_t *follow, const course_t *master, cm1e_motion_bounds_t *most)
{
    (void)axis;
    const double ratio = fabs(follow->links[0].ratio);
    *most = (cm1e_motion_bounds_t){ratio * master->most.velocity, ratio * master->most.acceleration,
                              ratio * master->most.jerk};
    return true;
}

static bool ordinary(cm1e_axis_t *axis, follow_t *follow)
{
    const from_t f = sum_of(follow, 1);
    cm1e_coupling_put(axis, &f);
    return true;
}

static const coupling_function_t gear = {evaluate, steepest, ordinary, bounds, NULL};

/* The ratio in counts. It is computed from whole numbers as far as doubles hold them, so it is rounded only once. */
static double counts_ratio(const cm1e_axis_t *slave, const cm1e_axis_t *master, double numerator, double denominator)
{
    const double sign = slave->position.scale * master->position.scale < 0.0 ? -1.0 : 1.0;
    return sign * (numerator * (slave->position.unit.counts * master->position.unit.units)) /
           (denominator * (slave->position.unit.units * master->position.unit.counts));
}

cm1e_error_t cm1e_gear_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                                    const from_t *from)
{
    follow_t *follow = cm1e_coupling_spare(axis);
    const int masters = move->kind == CM1E_COMMAND_COMBINE_AXES ? 2 : 1;
    if (coupling->combine != mcAddAxes && coupling->combine != mcSubAxes)
        return CM1E_ERROR_INVALID_ARGUMENT;
    *follow = (follow_t){.function = &gear, .anchor = from->position, .in_step = true};
    for (int i = 0; i < masters; i++) {
        const cm1e_coupling_master_t *master = &coupling->master[i];
        if (master->numerator == 0 || master->denominator == 0) {
            axis->coupling->numerator = master->numerator;
            axis->coupling->denominator = master->denominator;
            return CM1E_ERROR_AXIS_RATIO;
        }
        const cm1e_error_t error = cm1e_coupling_link(axis, follow, master);
        if (error != CM1E_OK)
            return error;
        link_t *link = &follow->links[i];
        const bool subtracted = i == 1 && coupling->combine == mcSubAxes;
        const double numerator = subtracted ? -(double)master->numerator : master->numerator;
        link->ratio = numerator / master->denominator;
        link->counts_ratio = counts_ratio(axis, link->master, numerator, master->denominator);
    }
    return CM1E_OK;
}

/* ---- out again --------------------------------------------------------------------------------------------------- */

static bool leaves(cm1e_command_kind_t out, cm1e_command_kind_t in)
{
    return out == CM1E_COMMAND_CAM_OUT ? in == CM1E_COMMAND_CAM_IN : in != CM1E_COMMAND_CAM_IN;
}

/* Leaves the masters. The command is done at once, and the motion goes on as a command that no block owns. */
cm1e_error_t cm1e_gear_out(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const from_t from = from_set(axis);
    const double factor = axis->override.velocity > 0.0 ? axis->override.velocity : 1.0;
    move_t move = {.kind = (uint8_t)command->kind, .end_velocity = from_base(axis).velocity, .velocity = factor};
    cm1e_profile_t profile;
    if (!axis_follows(axis) || !axis->commands.active || !leaves(command->kind, axis->commands.kind))
        return CM1E_ERROR_AXIS_NOT_COUPLED;
    const cm1e_error_t error = cm1e_axis_plan(axis, &from, &move, false, &profile);
    if (error != CM1E_OK)
        return error;
    cm1e_axis_commands_end(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    *id = cm1e_axis_next_id(axis);
    cm1e_axis_record(axis, *id, CM1E_COMMAND_DONE, CM1E_OK);
    move.id = cm1e_axis_next_id(axis);
    cm1e_axis_take(axis, &move, &from, &profile, 0.0);
    return CM1E_OK;
}
