/**
 * @file axes_cam.h
 * A slave that follows a master by a cam, on axes_bench.h, with the ideal function of the cam to compare with.
 */
#ifndef CM1E_TESTS_AXES_CAM_H
#define CM1E_TESTS_AXES_CAM_H

#include "axes_bench.h"

enum { MASTER = 0, SLAVE = 1 };

/** The application's memory for cams. */
extern MC_CAM_POINT points[200];

/** Fills `points` with a zigzag. */
MC_CAM_REF table_of(int count);
MC_CAM_ID selected(int n, const MC_CAM_REF *table, bool periodic, bool absolute);

double set_of(int n);

/** From rest to rest within 1, as every book has it. */
double smooth_step(double t);
/** Up by `height` within the first half of 10 u of the master, and on to `end` in the second half. */
double hill(double x, double height, double end);
double hill_back(double x);
double hill_on(double x);
MC_CAM_ID select_hill(double height, double end, bool periodic, bool master_absolute, bool slave_absolute);

cm1e_axis_coupling_t by_cam(MC_CAM_ID id, MC_START_MODE mode);
cm1e_command_id_t cam_in(const cm1e_axis_coupling_t *coupling);
void cam_refused(const cm1e_axis_coupling_t *coupling, cm1e_error_t expected);

/** The master goes to and fro, ever faster and slower. At every sample the slave is within a thousandth of a count of
 *  the ideal function (the smallest count of all is 0.00002 u). */
void master_wanders(int cycles, double (*ideal)(double master));

#endif
