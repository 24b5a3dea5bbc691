/* The table of the kinds of commands: complete, and its columns once more by hand from the standard. */
#include <string.h>

#include "../support/axis_bench.h"

void setUp(void) { bench_start(); }

void tearDown(void) { bench_end(); }

static void test_every_kind_has_a_row(void)
{
    for (unsigned kind = 0; kind < CM1E_COMMAND_KIND_COUNT; kind++) {
        const command_kind_t *row = kind_row(kind);
        char where[32];
        snprintf(where, sizeof where, "command %u", kind);
        TEST_ASSERT_NOT_NULL_MESSAGE(row->name, where);
        TEST_ASSERT_TRUE_MESSAGE(row->plan > PLAN_NONE && row->plan < PLAN_COUNT, where);
        TEST_ASSERT_TRUE_MESSAGE(row->trigger < COMMAND_TRIGGERS, where);
        for (unsigned other = 0; other < kind; other++)
            TEST_ASSERT_NOT_EQUAL_INT_MESSAGE(0, strcmp(row->name, kind_row(other)->name), row->name);
    }
}

/* What waits has to begin some day. */
static void test_every_kind_can_be_done(void)
{
    for (unsigned kind = 0; kind < CM1E_COMMAND_KIND_COUNT; kind++) {
        const command_kind_t *row = kind_row(kind);
        const command_method_t *method = cm1e_axis_method(axis, row->plan);
        const bool waits = row->has_buffer_mode && !is_beside(kind);
        TEST_ASSERT_TRUE_MESSAGE(method->start, row->name);
        if (waits)
            TEST_ASSERT_TRUE_MESSAGE(method->buffer && method->begin, row->name);
    }
}

/* By hand, so that a slip in the table shows. B: may be buffered (table 4; phasing by its own queue), E: goes on when it
 * has reached what it was to reach, V: Velocity is an input that moves it, S: a stop, O: MC_SetOverride acts on it
 * (3.18; on the velocity that MC_GearOut keeps VelFactor alone), T: a superimposed motion may be on top of it (3.8), D: by the drive too (docs/BUS-FILE.md, `motion`). */
static const char *const expected[CM1E_COMMAND_KIND_COUNT] = {
    [CM1E_COMMAND_MOVE_ABSOLUTE] = "BVOTD",
    [CM1E_COMMAND_MOVE_RELATIVE] = "BVOTD",
    [CM1E_COMMAND_MOVE_ADDITIVE] = "BVOTD",
    [CM1E_COMMAND_MOVE_VELOCITY] = "BEVOTD",
    [CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE] = "BEVOT",
    [CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE] = "BEVOT",
    [CM1E_COMMAND_POSITION_PROFILE] = "B",
    [CM1E_COMMAND_VELOCITY_PROFILE] = "BE",
    [CM1E_COMMAND_ACCELERATION_PROFILE] = "BE",
    [CM1E_COMMAND_HALT] = "BSOTD",
    [CM1E_COMMAND_STOP] = "STD",
    [CM1E_COMMAND_HOME] = "BD",
    [CM1E_COMMAND_HOMING_STEP] = "BVD",
    [CM1E_COMMAND_MOVE_SUPERIMPOSED] = "VO",
    [CM1E_COMMAND_HALT_SUPERIMPOSED] = "SO",
    [CM1E_COMMAND_GEAR_IN] = "BT",
    [CM1E_COMMAND_GEAR_IN_POS] = "BVT",
    [CM1E_COMMAND_CAM_IN] = "BT",
    [CM1E_COMMAND_COMBINE_AXES] = "BT",
    [CM1E_COMMAND_GEAR_OUT] = "ET",
    [CM1E_COMMAND_CAM_OUT] = "ET",
    [CM1E_COMMAND_PHASING_ABSOLUTE] = "BV",
    [CM1E_COMMAND_PHASING_RELATIVE] = "BV",
    [CM1E_COMMAND_FOLLOW_POSITION] = "",
};

static void test_what_every_kind_is(void)
{
    for (unsigned kind = 0; kind < CM1E_COMMAND_KIND_COUNT; kind++) {
        const command_kind_t *row = kind_row(kind);
        char is[8] = "";
        const struct {
            bool set;
            const char *letter;
        } columns[] = {{row->has_buffer_mode, "B"}, {row->is_endless, "E"},   {row->has_velocity, "V"},
                       {row->is_stop, "S"},         {row->has_override, "O"}, {row->carries_superimposed, "T"},
                       {row->drive_can, "D"}};
        for (unsigned i = 0; i < sizeof columns / sizeof columns[0]; i++)
            if (columns[i].set)
                strcat(is, columns[i].letter);
        TEST_ASSERT_NOT_NULL_MESSAGE(expected[kind], row->name);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(expected[kind], is, row->name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_kind_has_a_row);
    RUN_TEST(test_every_kind_can_be_done);
    RUN_TEST(test_what_every_kind_is);
    return UNITY_END();
}
