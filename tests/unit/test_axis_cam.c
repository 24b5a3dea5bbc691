/* Cams: the memory of a slave for them. */
#include "unity.h"

#include "../support/axes_bench.h"
#include "axis/axis_cam.h"

void setUp(void) {}
void tearDown(void) { axes_end(); }

static MC_CAM_POINT points[200];

static MC_CAM_REF table_of(int count)
{
    for (int i = 0; i < count; i++)
        points[i] = (MC_CAM_POINT){i, i % 2, 0, 0};
    return (MC_CAM_REF){points, (UINT)count, mcCamPolynomial5};
}

static MC_CAM_ID selected(int n, const MC_CAM_REF *table, bool periodic, bool absolute)
{
    MC_CAM_ID id = 0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_cam_select(axes_axis(n), table, periodic, absolute, absolute, &id));
    TEST_ASSERT_NOT_EQUAL(0, id);
    return id;
}

static void refused(const MC_CAM_REF *table, cm1e_error_t expected, const char *words)
{
    MC_CAM_ID id = 77;
    TEST_ASSERT_EQUAL_INT(expected, cm1e_axis_cam_select(axes_axis(0), table, true, true, true, &id));
    TEST_ASSERT_EQUAL_UINT32(0, id);
    axes_told(0, words);
}

static void test_the_last_four_cams_stay(void)
{
    axes_begin(1);
    MC_CAM_ID ids[9];
    for (int i = 0; i < 9; i++) {
        const MC_CAM_REF table = table_of(2 + i);
        ids[i] = selected(0, &table, i % 2, i % 3);
        for (int k = 0; k <= i; k++) {
            const cam_slot_t *slot = cm1e_axis_cam_of(axes_axis(0), ids[k]);
            if (k <= i - CM1E_AXIS_CAMS) {
                TEST_ASSERT_NULL(slot);
                continue;
            }
            TEST_ASSERT_NOT_NULL(slot);
            TEST_ASSERT_EQUAL_INT(2 + k, slot->cam.count);
            TEST_ASSERT_EQUAL(k % 2, slot->cam.periodic);
            TEST_ASSERT_EQUAL(k % 3 != 0, slot->master_absolute);
            for (int p = 0; p < 2 + k; p++)
                TEST_ASSERT_EQUAL_DOUBLE(p % 2, slot->knots[p].slave);
        }
    }
    TEST_ASSERT_NULL(cm1e_axis_cam_of(axes_axis(0), 0));
    TEST_ASSERT_NULL(cm1e_axis_cam_of(axes_axis(0), 12345));
}

static void test_a_bad_cam_costs_no_good_one_and_is_told(void)
{
    axes_describe(1);
    axes_config(0)->cam_points = 20;
    axes_make();
    axes_enable_all();
    MC_CAM_REF table = table_of(20);
    MC_CAM_ID ids[CM1E_AXIS_CAMS];
    for (int i = 0; i < CM1E_AXIS_CAMS; i++)
        ids[i] = selected(0, &table, false, false);
    const MC_CAM_REF none = {NULL, 5, mcCamLinear};
    refused(&none, CM1E_ERROR_AXIS_CAM_TABLE, "2 ... 20 are right");
    table.NumberOfPoints = 1;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "only one");
    table = table_of(21);
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "too many points");
    table = table_of(20);
    table.Curve = (MC_CAM_CURVE)9;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "Curve");
    table = table_of(20);
    points[7].Slave = NAN;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "point 8");
    table = table_of(20);
    points[7].Master = 6;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "point 8 of a cam is not above that of point 7");
    table = table_of(20);
    points[6].Master = points[7].Master - 1e-100;
    points[7].Master = 7e-120;
    for (int i = 0; i < 7; i++)
        points[i].Master = i * 1e-120;
    refused(&table, CM1E_ERROR_AXIS_CAM_TABLE, "close together");
    for (int i = 0; i < CM1E_AXIS_CAMS; i++)
        TEST_ASSERT_NOT_NULL(cm1e_axis_cam_of(axes_axis(0), ids[i]));
    table = table_of(3);
    (void)selected(0, &table, false, false);
    TEST_ASSERT_EQUAL_STRING("", axes_text(0));
}

/* The application's points may change, or go, once they are taken. */
static void test_a_cam_is_a_copy(void)
{
    axes_begin(1);
    const MC_CAM_REF table = table_of(4);
    const cam_slot_t *slot = cm1e_axis_cam_of(axes_axis(0), selected(0, &table, false, true));
    memset(points, 0xff, sizeof points);
    cm1e_cam_place_t place = {0};
    cm1e_cam_sample_t sample;
    cm1e_cam_sample(&slot->cam, &place, 1, &sample);
    TEST_ASSERT_EQUAL_DOUBLE(1, sample.point.position);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_last_four_cams_stay);
    RUN_TEST(test_a_bad_cam_costs_no_good_one_and_is_told);
    RUN_TEST(test_a_cam_is_a_copy);
    return UNITY_END();
}
