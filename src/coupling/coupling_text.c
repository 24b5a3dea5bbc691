/* Sentences about couplings: why a command was refused, and why a coupling was lost. */
#include <math.h>
#include <stdio.h>

#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling_private.h"

static const char *const troubles[] = {
    [MASTER_GOOD] = "is well",
    [MASTER_DESTROYED] = "does not exist any more: its scheduler has been destroyed",
    [MASTER_ERROR_STOP] = "is in ErrorStop: look up its own error, and reset it with MC_Reset",
    [MASTER_STOPPING] = "is in ErrorStop: look up its own error, and reset it with MC_Reset",
    [MASTER_FREE] = ("has no torque, and so no set value: enable it with MC_Power before, or follow its actual value "
                     "(mcActualValue)"),
    [MASTER_HOMING] = "is homed by its drive, which changes its positions: wait for the end of the homing",
    [MASTER_UNSEEN] = "shows no position: its inputs are missing",
    [MASTER_JUMPED] = "jumped: its position was set to where its motor is, which no slave can follow",
};

static void master_lost_text(const cm1e_axis_t *axis, bool refused, char *text, size_t size)
{
    const coupling_t *c = axis->coupling;
    int used = snprintf(text, size, "Axis \"%s\" %s its master \"%s\", which %s", axis->config->name,
                        refused ? "cannot follow" : "was braked, as it lost", axis->followed->other_name,
                        troubles[c->trouble]);
    if (c->master_error != CM1E_OK && used > 0 && (size_t)used < size)
        used += snprintf(text + used, size - (size_t)used, " (%s)", cm1e_strerror(c->master_error));
    if (used > 0 && (size_t)used < size)
        snprintf(text + used, size - (size_t)used, "%s",
                 refused ? "." : ". Then reset this axis with MC_Reset, and start the coupling again.");
}

static void not_coupled_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const cm1e_command_kind_t kind = axis->commands.refused.kind;
    snprintf(text, size, "Axis \"%s\", %s: %s needs an axis that follows a master by %s; this one follows %s.",
             axis->config->name, cm1e_axis_state_name(axis->state), kind_row(kind)->name,
             kind == CM1E_COMMAND_CAM_OUT    ? "MC_CamIn"
             : kind == CM1E_COMMAND_GEAR_OUT ? "MC_GearIn, MC_GearInPos or MC_CombineAxes"
                                             : "MC_GearIn, MC_GearInPos, MC_CamIn or MC_CombineAxes",
             axis_follows(axis) && axis->commands.active ? kind_row(axis->commands.kind)->name : "none");
}

static void ratio_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    if (axis->commands.refused.kind == CM1E_COMMAND_CAM_IN)
        snprintf(text, size, "Axis \"%s\": MasterScaling or SlaveScaling is out of range; right is 1e-9 ... 1e9, "
                 "positive or negative, or 0, which acts as 1.", axis->config->name);
    else
        snprintf(text, size, "Axis \"%s\": the ratio %ld / %lu was commanded; neither number may be 0; for the "
                 "opposite direction use a negative numerator.", axis->config->name, (long)axis->coupling->numerator,
                 (unsigned long)axis->coupling->denominator);
}

/* Explains a refused command by its kind; false: it has no such explanation. */
static bool mode_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    static const char *const modes[CM1E_COMMAND_KIND_COUNT] = {
        [CM1E_COMMAND_GEAR_IN] = "",
        [CM1E_COMMAND_GEAR_IN_POS] = "; SyncMode is mcShortest, mcCatchUp or mcSlowDown",
        [CM1E_COMMAND_CAM_IN] = "; StartMode is mcAbsolute, mcRelative or mcRampIn",
        [CM1E_COMMAND_COMBINE_AXES] = "; CombineMode is mcAddAxes or mcSubAxes",
    };
    const unsigned kind = axis->commands.refused.kind;
    const char *mode = kind < CM1E_COMMAND_KIND_COUNT ? modes[kind] : NULL;
    if (mode)
        snprintf(text, size, "Axis \"%s\": %s was given an unknown mode. MasterValueSource is mcSetValue or "
                 "mcActualValue%s.", axis->config->name, kind_row(axis->commands.refused.kind)->name, mode);
    return mode != NULL;
}

static void refused_coupling_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    char what[64];
    snprintf(what, sizeof what, "%s was refused", kind_row(axis->commands.refused.kind)->name);
    cm1e_no_couplings_text(axis, what, text, size);
}

/* Of MC_GearInPos and MC_CamIn, whose positions are in several inputs; false: of another block. */
static bool place_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    static const char *const gear = "SlaveSyncPosition, or the way to it,";
    static const char *const cam = "the cam at this place, or the way to it,";
    const cm1e_command_kind_t kind = axis->commands.refused.kind;
    if (kind != CM1E_COMMAND_GEAR_IN_POS && kind != CM1E_COMMAND_CAM_IN)
        return false;
    const bool is_cam = kind == CM1E_COMMAND_CAM_IN, limited = axis->limits.software_limits;
    const double farthest = cm1e_axis_farthest(axis);
    snprintf(text, size, "Axis \"%s\", at %.6g u: %s: %s would leave %.6g ... %.6g u%s, or an input is no finite "
             "number that its axis can have.", axis->config->name, cm1e_axis_units(axis, axis->setpoint.position),
             kind_row(kind)->name, is_cam ? cam : gear, limited ? axis->limits.lower : -farthest,
             limited ? axis->limits.upper : farthest, limited ? " (software limits)" : "");
    return true;
}

/* A slave that gives way gets in step when its master leaves it the velocity for that; else it never does. One that
 * makes up distance has what its master leaves of its limits, which can take long. */
static bool not_in_step_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const coupling_t *c = axis->coupling;
    const double most = axis->limits.maximum.velocity, next_to_nothing = 1e-4;
    if (!c || !axis_follows(axis) || !coupling_gives_way(axis))
        return false;
    const bool too_slow = fabs(c->f_velocity) >= most * (1.0 - next_to_nothing);
    if (too_slow)
        snprintf(text, size, "Axis \"%s\" is not in step: its master asks it for %.6g u/s, and its maximum is %.6g "
                 "u/s. It follows as fast as it may. Let the master be slower, or raise the maximum velocity of this "
                 "axis.", axis->config->name, fabs(c->f_velocity), most);
    else if (c->catch_up.on && c->catch_up.made_up)
        snprintf(text, size, "Axis \"%s\" is not in step: it makes up %.6g u with what its master leaves of its "
                 "limits. It is sooner in step if the master moves more slowly and evenly, or with higher maxima of "
                 "this axis.", axis->config->name, fabs(c->catch_up.now.position));
    else
        return false;
    return true;
}

static bool refusal_text(const cm1e_axis_t *axis, cm1e_error_t error, char *text, size_t size)
{
    switch (error) {
    case CM1E_ERROR_AXIS_POSITION_RANGE:
        return place_text(axis, text, size) || cm1e_phasing_text(axis, text, size);
    case CM1E_ERROR_AXIS_VELOCITY_RANGE:
    case CM1E_ERROR_AXIS_DYNAMICS_RANGE:
        return cm1e_phasing_text(axis, text, size);
    case CM1E_ERROR_AXIS_NO_COUPLINGS:
        refused_coupling_text(axis, text, size);
        return true;
    case CM1E_ERROR_AXIS_SYNC_WAY:
        cm1e_coupling_approach_text(axis, text, size);
        return true;
    case CM1E_ERROR_AXIS_CAM_ID:
        cm1e_cam_id_text(axis, text, size);
        return true;
    case CM1E_ERROR_AXIS_CAM_START:
        cm1e_cam_start_text(axis, text, size);
        return true;
    case CM1E_ERROR_INVALID_ARGUMENT:
        return mode_text(axis, text, size);
    default:
        return false;
    }
}

bool cm1e_coupling_text(const cm1e_axis_t *axis, cm1e_error_t error, bool refused, char *text, size_t size)
{
    if (refused && refusal_text(axis, error, text, size))
        return true;
    const char *name = axis->config->name, *other = axis->followed->other_name;
    switch (error) {
    case CM1E_OK:
        return not_in_step_text(axis, text, size);
    case CM1E_ERROR_AXIS_MASTER:
        snprintf(text, size, "Axis \"%s\": Master names no axis of its scheduler; expected the AXIS_REF of another "
                 "axis of a bus in this scheduler.", name);
        return true;
    case CM1E_ERROR_AXIS_COUPLING_CYCLE:
        snprintf(text, size, "Axis \"%s\" cannot follow \"%s\", which is this axis or follows it, perhaps through "
                 "others: end that coupling first, or choose another master.", name, other);
        return true;
    case CM1E_ERROR_AXIS_MASTER_LOST:
        master_lost_text(axis, refused, text, size);
        return true;
    case CM1E_ERROR_AXIS_NOT_COUPLED:
        not_coupled_text(axis, text, size);
        return true;
    case CM1E_ERROR_AXIS_RATIO:
        ratio_text(axis, text, size);
        return true;
    case CM1E_ERROR_AXIS_COUPLED:
        if (other[0] == '\0')
            return false;
        snprintf(text, size, "Axis \"%s\" was braked because axis \"%s\", which it is coupled with, has failed: look "
                 "up the error of that one and remove its cause; then reset both with MC_Reset.", name, other);
        return true;
    default:
        return false;
    }
}
