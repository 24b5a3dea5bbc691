#include <math.h>

#include "core/extreme.h"
#include "motion/approach.h"

/* Fraction of a turn: tolerance of rounding for a slave that is in synchronism already. */
static const double same_place = 1e-9;

void cm1e_approach_demand(const cm1e_curve_extremes_t *extremes, double master_velocity, cm1e_motion_limits_t *demand)
{
    const double speed = fabs(master_velocity);
    demand->velocity = larger(fabs(extremes->least_slope), fabs(extremes->most_slope)) * speed;
    demand->acceleration = demand->deceleration = extremes->curvature * speed * speed;
    demand->jerk = extremes->third * speed * speed * speed;
}

double cm1e_approach_end(MC_SYNC_MODE mode, double start, double slope, double end, double ratio, double way,
                         double turn)
{
    if (turn == 0)
        return end;
    /* A slope that begins and ends with these, without curvature there, changes least when it does so evenly. */
    const double even = (slope + ratio) / 2 * way, in_step = ratio * way;
    const bool farther = (mode == mcCatchUp) == (in_step > 0);
    const double wanted = start + (mode == mcShortest ? even : in_step);
    const double turns = (wanted - end) / turn;
    const double whole = mode == mcShortest ? round(turns) : farther ? ceil(turns - same_place)
                                                                     : floor(turns + same_place);
    return end + whole * turn;
}
