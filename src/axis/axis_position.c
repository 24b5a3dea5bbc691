/* Positions: from the drive's 32-bit counts, which wrap, to 64 bits and to units. */
#include <math.h>

#include "axis/axis_private.h"

/* Beyond 2^52 a double no longer resolves half a count; at full speed that is 57 years away. */
static const int64_t farthest_counts = INT64_C(1) << 52;

position_t cm1e_position_plus(position_t position, double counts)
{
    const double whole = floor(counts);
    position.counts += (int64_t)whole;
    position.fraction += counts - whole;
    if (position.fraction >= 1.0) {
        position.fraction -= 1.0;
        position.counts++;
    }
    return position;
}

double cm1e_position_minus(position_t a, position_t b)
{
    return (double)(a.counts - b.counts) + (a.fraction - b.fraction);
}

bool cm1e_axis_position_in_range(position_t position)
{
    return position.counts < farthest_counts && position.counts > -farthest_counts;
}

double cm1e_axis_farthest(const cm1e_axis_t *axis) { return (double)farthest_counts / fabs(axis->scale); }

double cm1e_axis_units(const cm1e_axis_t *axis, position_t position)
{
    const position_t origin = {axis->origin_counts, 0.0};
    return axis->origin_units + cm1e_position_minus(position, origin) / axis->scale;
}

bool cm1e_axis_position_from_units(const cm1e_axis_t *axis, double units, position_t *position)
{
    const double counts = (units - axis->origin_units) * axis->scale;
    if (!isfinite(units) || !(fabs(counts) < (double)farthest_counts))
        return false;
    *position = cm1e_position_plus((position_t){axis->origin_counts, 0.0}, counts);
    return cm1e_axis_position_in_range(*position);
}

cm1e_error_t cm1e_axis_resolve_target(const cm1e_axis_t *axis, double position, MC_DIRECTION direction,
                                      position_t from, double velocity, position_t *target)
{
    (void)direction;
    (void)from;
    (void)velocity;
    return cm1e_axis_position_from_units(axis, position, target) ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
}

/* Differences of wrapping counts are exact as long as the motor moves less than half the range between two looks. */
void cm1e_axis_track(cm1e_axis_t *axis)
{
    const int32_t raw = axis->drive.feedback.position;
    if (axis->position_known) {
        axis->actual_counts += (int32_t)((uint32_t)raw - (uint32_t)axis->raw);
    } else {
        axis->actual_counts = raw;
        axis->position_known = true;
    }
    axis->raw = raw;
}

void cm1e_axis_set_to_actual(cm1e_axis_t *axis)
{
    axis->set = axis_actual(axis);
    axis->set_velocity = 0.0;
    axis->set_acceleration = 0.0;
}
