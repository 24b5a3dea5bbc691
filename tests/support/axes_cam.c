#include "axes_cam.h"

#include "unity.h"

MC_CAM_POINT points[200];

MC_CAM_REF table_of(int count)
{
    for (int i = 0; i < count; i++)
        points[i] = (MC_CAM_POINT){i, i % 2, 0, 0};
    return (MC_CAM_REF){points, (UINT)count, mcCamPolynomial5};
}

MC_CAM_ID selected(int n, const MC_CAM_REF *table, bool periodic, bool absolute)
{
    MC_CAM_ID id = 0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_cam_select(axes_axis(n), table, periodic, absolute, absolute, &id));
    TEST_ASSERT_NOT_EQUAL(0, id);
    return id;
}

double set_of(int n) { return axes_info(n).set_position; }

double smooth_step(double t) { return t * t * t * (10 + t * (-15 + t * 6)); }

double hill(double x, double height, double end)
{
    const double turn = floor(x / 10), phase = x - 10 * turn;
    return turn * end + (phase < 5 ? height * smooth_step(phase / 5)
                                   : height + (end - height) * smooth_step((phase - 5) / 5));
}

MC_CAM_ID select_hill(double height, double end, bool periodic, bool master_absolute, bool slave_absolute)
{
    points[0] = (MC_CAM_POINT){0, 0, 0, 0};
    points[1] = (MC_CAM_POINT){5, height, 0, 0};
    points[2] = (MC_CAM_POINT){10, end, 0, 0};
    const MC_CAM_REF table = {points, 3, mcCamPolynomial5};
    MC_CAM_ID id = 0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_cam_select(axes_axis(SLAVE), &table, periodic, master_absolute,
                                                        slave_absolute, &id));
    return id;
}

cm1e_axis_coupling_t by_cam(MC_CAM_ID id, MC_START_MODE mode)
{
    return (cm1e_axis_coupling_t){.master = {{.axis = axes_reference(MASTER), .numerator = 1, .denominator = 1}},
                                  .cam = id, .start_mode = mode};
}

cm1e_command_id_t cam_in(const cm1e_axis_coupling_t *coupling)
{
    return axes_command(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = coupling});
}

void cam_refused(const cm1e_axis_coupling_t *coupling, cm1e_error_t expected)
{
    axes_refused(SLAVE, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_CAM_IN, .coupling = coupling}, expected);
}

void master_wanders(int cycles, double (*ideal)(double master))
{
    static const double velocities[] = {3, -1, 8, 0.01, -6, 10, -10, 5};
    for (int i = 0; i < cycles; i++) {
        if (i % 500 == 0)
            axes_move_velocity(MASTER, velocities[i / 500 % 8]);
        axes_cycles(1);
        TEST_ASSERT_DOUBLE_WITHIN(2e-8, ideal(set_of(MASTER)), set_of(SLAVE));
    }
    axes_must_be(SLAVE, CM1E_AXIS_SYNCHRONIZED_MOTION);
}

double hill_back(double x) { return hill(x, 0.6, 0); }
double hill_on(double x) { return hill(x, 0.6, 1); }
