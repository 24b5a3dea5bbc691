/**
 * @file app_time.h
 * How the time of a simulated device passes: in steps that its mechanics can be integrated with. Private to the
 * simulator.
 */
#ifndef CM1E_SIM_APP_TIME_H
#define CM1E_SIM_APP_TIME_H

#include <stdbool.h>
#include <stdint.h>

/** Lets the time of a device go on to `to_ns`: false: it is there already. The first call tells the time, and a longer
 *  pause is cut; `*missed_ns` is what the device did not live through, and `*now_ns` is behind it. */
bool cm1e_sim_time_passes(bool *running, int64_t *now_ns, int64_t to_ns, int64_t *missed_ns);
/** Moves `*now_ns` on by one step; the step in seconds, 0: `to_ns` is reached. */
double cm1e_sim_time_step(int64_t *now_ns, int64_t to_ns);

#endif
