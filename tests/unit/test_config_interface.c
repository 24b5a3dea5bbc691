/* Names of interfaces: what is simulated, the interface's own name, the way behind the comma. */
#include <string.h>

#include <unity.h>

#include "cm1e/config.h"
#include "config/interface.h"

void setUp(void) {}
void tearDown(void) {}

static char wrong[300];

static void expect_way(const char *name, cm1e_interface_way_t way, const char *expected_own)
{
    char own[64];
    cm1e_interface_own_name(own, sizeof own, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(way, cm1e_interface_way(name, wrong, sizeof wrong), name);
    TEST_ASSERT_EQUAL_STRING(expected_own, own);
}

static void test_a_name_has_its_way_behind_the_last_comma(void)
{
    expect_way("eth1", CM1E_WAY_PACKET, "eth1");
    expect_way("eth1,packet", CM1E_WAY_PACKET, "eth1");
    expect_way("eth1,xdp", CM1E_WAY_XDP, "eth1");
    expect_way("odd,name,packet", CM1E_WAY_PACKET, "odd,name");
    expect_way("odd,name,xdp", CM1E_WAY_XDP, "odd,name");
    expect_way("xdp", CM1E_WAY_PACKET, "xdp");
}

static void test_an_unknown_way_is_named_with_those_that_exist(void)
{
    static const char *const names[] = {"eth1,", "eth1,XDP", "eth1, xdp", "eth1,xd", "eth1,xdpp", "eth1,xdp,busy", "odd,name"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char word[64];
        snprintf(word, sizeof word, "has \"%s\"", strrchr(names[i], ',') + 1);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_WAY_UNKNOWN, cm1e_interface_way(names[i], wrong, sizeof wrong), names[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, word), wrong);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, "packet (as without a comma), xdp"), wrong);
        TEST_ASSERT_EQUAL_INT(CM1E_WAY_UNKNOWN, cm1e_interface_way(names[i], NULL, 0));
    }
    cm1e_interface_way("odd,name", wrong, sizeof wrong);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, "\"odd,name,packet\""), wrong);
}

static void test_a_simulated_segment_has_no_way(void)
{
    expect_way("", CM1E_WAY_PACKET, "");
    expect_way("sim", CM1E_WAY_PACKET, "sim");
    expect_way("sim:a,xdp", CM1E_WAY_PACKET, "sim:a,xdp"); /* a path may have a comma */
    TEST_ASSERT_FALSE(cm1e_interface_is_same("sim:a", "sim:a,xdp"));
}

static void test_one_interface_is_the_same_whichever_way(void)
{
    TEST_ASSERT_TRUE(cm1e_interface_is_same("eth1", "eth1"));
    TEST_ASSERT_TRUE(cm1e_interface_is_same("eth1,xdp", "eth1"));
    TEST_ASSERT_TRUE(cm1e_interface_is_same("eth1,packet", "eth1,xdp"));
    TEST_ASSERT_FALSE(cm1e_interface_is_same("eth1", "eth12"));
    TEST_ASSERT_FALSE(cm1e_interface_is_same("eth12,xdp", "eth1,xdp"));
    TEST_ASSERT_FALSE(cm1e_interface_is_same("eth1,xdp", ""));
}

static void test_a_long_name_is_cut_off(void)
{
    char own[5];
    cm1e_interface_own_name(own, sizeof own, "ethernet,xdp");
    TEST_ASSERT_EQUAL_STRING("ethe", own);
}

static void expect_wrong(const char *first, const char *second, const char *path, const char *words)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_bus_config_init(&config, first, 1));
    strcpy(config.second_interface, second);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, path), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, words), diag.text);
    cm1e_bus_config_free(&config);
}

static void test_a_configuration_is_refused_for_its_names(void)
{
    expect_wrong("eth1,fast", "", "interface", "\"fast\"");
    expect_wrong("eth1,xdp", "eth2,fast", "second_interface", "\"fast\"");
    expect_wrong("eth1,xdp", "eth1", "second_interface", "like the first");
    cm1e_bus_config_t config;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_bus_config_init(&config, "eth1,xdp", 1));
    strcpy(config.second_interface, "eth2");
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_bus_config_check(&config, NULL));
    cm1e_bus_config_free(&config);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_name_has_its_way_behind_the_last_comma);
    RUN_TEST(test_an_unknown_way_is_named_with_those_that_exist);
    RUN_TEST(test_a_simulated_segment_has_no_way);
    RUN_TEST(test_one_interface_is_the_same_whichever_way);
    RUN_TEST(test_a_long_name_is_cut_off);
    RUN_TEST(test_a_configuration_is_refused_for_its_names);
    return UNITY_END();
}
