/* A configuration between a program and a library of different versions, which know more or fewer members of it. */
#include <malloc.h>
#include <stddef.h>
#include <string.h>

#include "config/copy.h"
#include "unity.h"

static cm1e_bus_config_t config;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) { cm1e_bus_config_free(&config); }

/* The structs of an older version end before these members. */
enum {
    OLD_SIZE = offsetof(cm1e_bus_config_t, sim_gaps),
    OLD_AXIS_SIZE = offsetof(cm1e_axis_config_t, sim),
};

static cm1e_axis_config_t *axis_of(const cm1e_bus_config_t *c, uint32_t index)
{
    return (cm1e_axis_config_t *)(void *)((char *)c->axes + index * c->axis_size);
}

static void test_an_older_program_has_defaults_for_what_it_does_not_know(void)
{
    memset(&config, 0x5A, sizeof config); /* what is behind the program's struct is not its own */
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_init_sized(&config, OLD_SIZE, OLD_AXIS_SIZE, "sim", 2));
    TEST_ASSERT_EQUAL_HEX8(0x5A, ((unsigned char *)&config)[OLD_SIZE]);
    TEST_ASSERT_EQUAL_STRING("axis2", axis_of(&config, 1)->name);
    axis_of(&config, 1)->max_jerk = 7;
    axis_of(&config, 0)->max_jerk = 5;
    TEST_ASSERT_NOT_NULL(cm1e_bus_config_add_axis(&config, "third"));
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_check(&config, &diag), diag.text);
    cm1e_bus_config_t own;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_config_copy(&own, &config));
    TEST_ASSERT_EQUAL(sizeof own, own.size);
    TEST_ASSERT_EQUAL(CM1E_SIM_IO_MODULE, own.sim_gaps);
    TEST_ASSERT_EQUAL(3, own.axis_count);
    TEST_ASSERT_EQUAL_DOUBLE(5, own.axes[0].max_jerk);
    TEST_ASSERT_EQUAL_DOUBLE(7, own.axes[1].max_jerk);
    TEST_ASSERT_EQUAL_STRING("third", own.axes[2].name);
    TEST_ASSERT_FALSE(own.axes[1].sim.no_stops);
    axis_of(&config, 1)->max_jerk = -1;
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "limits.jerk"));
    cm1e_bus_config_free(&own);
}

static void test_a_newer_program_has_members_that_the_library_does_not_know(void)
{
    static struct { cm1e_bus_config_t config; char more[40]; } newer;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_init_sized(&newer.config, sizeof newer,
                                                          sizeof(cm1e_axis_config_t) + 24, "sim", 3));
    TEST_ASSERT_EACH_EQUAL_UINT8(0, newer.more, sizeof newer.more);
    axis_of(&newer.config, 2)->address = 9;
    memset(axis_of(&newer.config, 0) + 1, 0x77, 24);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_config_copy(&config, &newer.config));
    TEST_ASSERT_EQUAL(9, config.axes[2].address);
    TEST_ASSERT_EQUAL_STRING("axis2", config.axes[1].name);
    cm1e_bus_config_free(&newer.config);
}

static void test_a_loaded_configuration_has_the_sizes_of_the_program(void)
{
    cm1e_bus_config_t from;
    cm1e_bus_config_init(&from, "eth7", 2);
    from.axes[1].channel = 3;
    memset(&config, 0x5A, sizeof config);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_config_copy_sized(&config, OLD_SIZE, OLD_AXIS_SIZE, &from));
    cm1e_bus_config_free(&from);
    TEST_ASSERT_EQUAL_HEX8(0x5A, ((unsigned char *)&config)[OLD_SIZE]);
    TEST_ASSERT_EQUAL(OLD_AXIS_SIZE, config.axis_size);
    TEST_ASSERT_EQUAL_STRING("eth7", config.interface_name);
    TEST_ASSERT_EQUAL(3, axis_of(&config, 1)->channel);
}

static void test_no_more_axes_than_the_maximum_are_added(void)
{
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_init(&config, NULL, CM1E_MAX_AXES));
    TEST_ASSERT_NULL(cm1e_bus_config_add_axis(&config, NULL));
    TEST_ASSERT_EQUAL(CM1E_MAX_AXES, config.axis_count);
    cm1e_bus_config_free(&config);
    TEST_ASSERT_EQUAL_STRING("axis1", cm1e_bus_config_add_axis(&config, "")->name);
    cm1e_bus_config_free(NULL);
}

static void test_axes_that_are_only_counted_are_refused(void)
{
    cm1e_bus_config_init(&config, NULL, 0);
    config.axis_count = 2;
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "axis_count is 2"));
    TEST_ASSERT_NULL(cm1e_bus_config_add_axis(&config, NULL));
}

/* Whatever was in the memory before. */
static void test_what_is_added_is_empty(void)
{
    static const cm1e_axis_config_t no_axis;
    static const cm1e_slave_config_t no_slave;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_init(&config, NULL, 0));
    for (int i = 0; i < 3; i++) {
        cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(&config, "x");
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "y");
        TEST_ASSERT_EQUAL_STRING("x", axis->name);
        TEST_ASSERT_EQUAL_STRING("y", slave->name);
        axis->name[0] = slave->name[0] = '\0';
        TEST_ASSERT_EQUAL_MEMORY(&no_axis, axis, sizeof *axis);
        TEST_ASSERT_EQUAL_MEMORY(&no_slave, slave, sizeof *slave);
        memset(axis, 0x5A, sizeof *axis);
        memset(slave, 0x5A, sizeof *slave);
    }
}

int main(void)
{
    mallopt(M_PERTURB, 0x5A); /* what is allocated has other bytes than 0 */
    UNITY_BEGIN();
    RUN_TEST(test_an_older_program_has_defaults_for_what_it_does_not_know);
    RUN_TEST(test_a_newer_program_has_members_that_the_library_does_not_know);
    RUN_TEST(test_a_loaded_configuration_has_the_sizes_of_the_program);
    RUN_TEST(test_no_more_axes_than_the_maximum_are_added);
    RUN_TEST(test_axes_that_are_only_counted_are_refused);
    RUN_TEST(test_what_is_added_is_empty);
    return UNITY_END();
}
