/* Plans the problems that come in on stdin, nine doubles each (position, velocity, acceleration, target position,
 * target velocity, limits of velocity, acceleration, deceleration, jerk), and writes each duration; -1: no plan. */
#include <stdio.h>

#include "motion/profile.h"

int main(void)
{
    struct {
        cm1e_motion_state_t start;
        double target, target_velocity;
        cm1e_motion_limits_t limits;
    } problem;
    while (fread(&problem, sizeof problem, 1, stdin) == 1) {
        cm1e_profile_t profile;
        double duration_s = -1;
        if (cm1e_profile_to_state(&profile, &problem.start, problem.target, problem.target_velocity,
                                  &problem.limits) == CM1E_OK)
            duration_s = profile.duration_s;
        if (fwrite(&duration_s, sizeof duration_s, 1, stdout) != 1)
            return 1;
    }
    return 0;
}
