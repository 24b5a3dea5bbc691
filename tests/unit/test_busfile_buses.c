/* A bus file with several buses: what becomes of each, what they have to have in common, and how mistakes are told. */
#include <stdio.h>
#include <string.h>

#include "cm1e/config.h"
#include "unity.h"

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_buses.yaml";
static cm1e_bus_config_t configs[CM1E_MAX_BUSES];
static uint32_t count;
static cm1e_diag_t diag;

void setUp(void) { memset(configs, 0, sizeof configs); }
void tearDown(void)
{
    for (int i = 0; i < CM1E_MAX_BUSES; i++)
        cm1e_bus_config_free(&configs[i]);
}

static void write_file(const char *text)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(strlen(text), fwrite(text, 1, strlen(text), file));
    TEST_ASSERT_EQUAL(0, fclose(file));
}

static cm1e_error_t load(const char *text, uint32_t room)
{
    write_file(text);
    return cm1e_bus_config_load_all(configs, room, &count, temporary, &diag);
}

static const char two[] =
    "buses:\n"
    "  - name: left\n"
    "    bus: {interface: eth1, cycle_time_us: 500}\n"
    "    axes: [{name: feeder, limits: {velocity: 7}}, {position: 4}]\n"
    "    slaves: [{name: valves, position: 3}]\n"
    "  - name: right\n"
    "    bus: {interface: eth2, second_interface: eth3, cycle_time_us: 500}\n"
    "    axes: [{}]\n";

static void test_each_bus_has_what_its_own_file_would_have(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(two, CM1E_MAX_BUSES), diag.text);
    TEST_ASSERT_EQUAL(2, count);
    TEST_ASSERT_EQUAL_STRING("left", configs[0].name);
    TEST_ASSERT_EQUAL_STRING("eth1", configs[0].interface_name);
    TEST_ASSERT_EQUAL_DOUBLE(7, configs[0].axes[0].max_velocity);
    TEST_ASSERT_EQUAL(1, configs[0].slave_count);
    TEST_ASSERT_EQUAL_STRING("valves", configs[0].slaves[0].name);
    TEST_ASSERT_EQUAL_STRING("right", configs[1].name);
    TEST_ASSERT_EQUAL_STRING("eth3", configs[1].second_interface);
    TEST_ASSERT_EQUAL(500000, configs[1].cycle_time_ns);
    TEST_ASSERT_EQUAL(1, configs[1].axes[0].address);
    TEST_ASSERT_EQUAL_STRING("axis2", configs[0].axes[1].name); /* numbered over all buses, so that they differ */
    TEST_ASSERT_EQUAL_STRING("axis3", configs[1].axes[0].name);
}

static void test_a_file_of_one_bus_is_as_it_was(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load("bus: {interface: eth4}\naxes: [{}]\n", CM1E_MAX_BUSES), diag.text);
    TEST_ASSERT_EQUAL(1, count);
    TEST_ASSERT_EQUAL_STRING("", configs[0].name);
    TEST_ASSERT_EQUAL_STRING("axis1", configs[0].axes[0].name);
}

static void test_a_program_for_one_bus_refuses_several(void)
{
    write_file(two);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_load(&configs[0], temporary, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "the file has 2 buses; expected at most 1 here"), diag.text);
    TEST_ASSERT_NULL(configs[0].axes);
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_bus_config_load_all(configs, 4, NULL, temporary, &diag));
}

#define LEFT "buses:\n- name: left\n  bus: {interface: eth1}\n  axes: [{name: x}]\n"
static const struct {
    const char *file, *place, *says;
} broken[] = {
    {LEFT "- name: left\n  bus: {interface: eth2}\n  axes: [{name: y}]\n", ":5:9:", "two buses have the name left"},
    {LEFT "- name: right\n  bus: {interface: eth1}\n  axes: [{name: y}]\n", ":6:20:",
     "the bus left has the interface eth1 too"},
    {LEFT "- name: right\n  bus: {interface: \"eth1,xdp\"}\n  axes: [{name: y}]\n", ":6:20:",
     "the bus left has the interface eth1,xdp too"},
    {LEFT "- name: right\n  bus: {interface: eth2, second_interface: eth1}\n  axes: [{name: y}]\n", ":6:20:",
     "the bus left has the interface eth1 too"},
    {LEFT "- name: right\n  bus: {interface: eth2, cycle_time_us: 250}\n  axes: [{name: y}]\n", ":6:41:",
     "cycle_time_us is 250, and 1000 on the bus left"},
    {LEFT "- name: right\n  bus: {interface: eth2}\n  axes: [{name: y}, {name: x}]\n", ":7:28:",
     "axis x: the bus left has an axis of this name too"},
    {LEFT "- name: right\n  bus: {interface: eth2}\n  axes: [{name: y, limits: {velocity: -4}}]\n", ":7:39:",
     "limits.velocity is -4"},
    {LEFT "- name: right\n  bus: {interface: eth2}\n", ":5:3:", "key 'axes' is missing"},
    {LEFT "- bus: {interface: eth2}\n  axes: [{name: y}]\n", ":5:3:", "key 'name' is missing in buses[1]"},
    {LEFT "- name: right\n  busses: {}\n  axes: [{name: y}]\n", ":6:3:", "unknown key 'busses' in buses[1]"},
    {LEFT "axes: [{name: y}]\n", ":5:1:", "unknown key 'axes' in the file; expected one of: buses"},
    {"buses: []\n", ":1:8:", "buses is an empty list"},
    {"buses: 3\n", ":1:8:", "buses is '3'; expected a list"},
    {LEFT "- {name: b, axes: [{name: y}]}\n- {name: c, axes: [{name: z}]}\n- {name: d, axes: [{name: u}]}\n"
     "- {name: e, axes: [{name: v}]}\n", ":8:3:", "buses has 5 entries; expected at most 4"},
};

static void test_mistakes_are_told_with_their_place(void)
{
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, load(broken[i].file, CM1E_MAX_BUSES), broken[i].says);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, broken[i].says), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, broken[i].place), diag.text);
        TEST_ASSERT_NULL(configs[0].axes);
    }
}

static void test_simulated_segments_are_each_their_own(void)
{
    static const char simulated[] = "buses:\n- {name: a, axes: [{name: x}]}\n- {name: b, axes: [{name: y}]}\n";
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(simulated, CM1E_MAX_BUSES), diag.text);
    TEST_ASSERT_EQUAL_STRING("sim", configs[1].interface_name);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_bus_has_what_its_own_file_would_have);
    RUN_TEST(test_a_file_of_one_bus_is_as_it_was);
    RUN_TEST(test_a_program_for_one_bus_refuses_several);
    RUN_TEST(test_mistakes_are_told_with_their_place);
    RUN_TEST(test_simulated_segments_are_each_their_own);
    return UNITY_END();
}
