/* Slaves on a cam that cannot go on, with coupling_stop keep_ratio: how hard the master brakes, where the cam is flat and
 * where it is steep. */
#include "unity.h"

#include "../support/axes_cam.h"
#include "../support/chance.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

static void failed(int n, cm1e_error_t error, const char *words)
{
    axes_must_be(n, CM1E_AXIS_ERROR_STOP);
    TEST_ASSERT_EQUAL_INT_MESSAGE(error, axes_info(n).error, axes_text(n));
    axes_told(n, words);
}

/* Cycles until its set-point stands. */
static int braking_of(int n)
{
    int cycles = 0;
    for (; cycles < 20000 && axes_info(n).set_velocity != 0.0; cycles++)
        axes_cycles(1);
    return cycles;
}

static void make_two(double software_limit)
{
    axes_describe(2);
    axes_config(SLAVE)->coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    axes_config(SLAVE)->software_limit_negative = -software_limit;
    axes_config(SLAVE)->software_limit_positive = software_limit;
    axes_make();
    axes_enable_all();
}

/* Flat at 0 up to 5 u of the master, then up by `height` within `way`, and flat up to 9 u; within 1 u it is back. */
static MC_CAM_ID select_step(double height, double way)
{
    points[0] = (MC_CAM_POINT){0.0, 0.0, 0, 0};
    points[1] = (MC_CAM_POINT){5.0, 0.0, 0, 0};
    points[2] = (MC_CAM_POINT){5.0 + way, height, 0, 0};
    points[3] = (MC_CAM_POINT){9.0, height, 0, 0};
    points[4] = (MC_CAM_POINT){10.0, 0.0, 0, 0};
    const MC_CAM_REF table = {points, 5, mcCamPolynomial5};
    return selected(SLAVE, &table, true, true);
}

/* A slave that still ramps into its cam, from a motion of its own, has no ratio to keep. The steepest place of the cam
 * would let the master go on for seconds. */
static void test_a_slave_that_ramps_into_its_cam_does_not_keep_its_master_turning(void)
{
    make_two(2.0);
    const cm1e_axis_coupling_t coupling = by_cam(select_step(1.0, 0.05), mcRampIn);
    axes_move_velocity(MASTER, 10.0);
    axes_move_velocity(SLAVE, -10.0);
    AXES_UNTIL(axes_info(SLAVE).set_position < -1.4);
    cam_in(&coupling);
    for (int n = 0; n < 500 && axes_state(MASTER) != CM1E_AXIS_ERROR_STOP; n++)
        axes_cycles(1);
    failed(SLAVE, CM1E_ERROR_AXIS_COUPLING_LIMIT, "the software limit at -2 u");
    failed(MASTER, CM1E_ERROR_AXIS_COUPLED, "because axis \"axis1\"");
    TEST_ASSERT_LESS_THAN_INT(105, braking_of(MASTER)); /* 10 u/s at 100 u/s2 */
    axes_cycles(400);
    TEST_ASSERT_TRUE(axes_bench.witness[SLAVE].lowest >= -2.0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_slave_that_ramps_into_its_cam_does_not_keep_its_master_turning);
    return UNITY_END();
}
