/* Which backend an interface name opens. This program links the nic without the simulator. */
#include <string.h>

#include <ethercat.h>
#include <unity.h>

#include "nic/backend.h"

static cm1e_bus_config_t config;
static cm1e_diag_t diag;
static cm1e_nic_t *nic;
static int guest_state;

void setUp(void)
{
    memset(&config, 0, sizeof config);
    memset(&diag, 0, sizeof diag);
    nic = NULL;
}

void tearDown(void) { cm1e_nic_close(nic); }

/* ---- guests ------------------------------------------------------------------------------------------------------ */

static bool is_guest(const char *name) { return strcmp(name, "guest") == 0; }
static bool is_nothing(const char *name) { return !name; }

static cm1e_error_t guest_open(cm1e_nic_link_t *link, const cm1e_bus_config_t *opened, cm1e_diag_t *why)
{
    (void)why;
    TEST_ASSERT_EQUAL_STRING(opened->interface_name, link->interface_name);
    TEST_ASSERT_EQUAL_INT(opened->second_interface[0] ? 2 : 1, link->ports);
    TEST_ASSERT_EQUAL_PTR(cm1e_clock_monotonic(), link->clock);
    link->state = &guest_state;
    return CM1E_OK;
}

static bool guest_send(cm1e_nic_link_t *link, int port, const uint8_t *frame, size_t length)
{
    (void)port, (void)frame, (void)length;
    return link->state != NULL;
}

static size_t guest_receive(cm1e_nic_link_t *link, int *port, uint8_t *frame, int64_t deadline_ns)
{
    (void)link, (void)port, (void)frame, (void)deadline_ns;
    return 0;
}

static void guest_close(cm1e_nic_link_t *link) { link->state = NULL; }

#define GUEST(matches) {"guest", matches, guest_open, guest_send, guest_receive, guest_close}

static const cm1e_nic_backend_t guest = GUEST(is_guest), other = GUEST(is_nothing);

static void open_named(const char *name)
{
    strcpy(config.interface_name, name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_nic_open(&nic, &config, &diag), diag.text);
}

/* ---- without a simulator ----------------------------------------------------------------------------------------- */

static void test_a_simulated_interface_without_simulator_is_refused_with_the_cure(void)
{
    static const char *const names[] = {"", "sim", "sim:cell.yaml"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        strcpy(config.interface_name, names[i]);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, cm1e_nic_open(&nic, &config, &diag));
        TEST_ASSERT_NULL(nic);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, diag.error);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, names[i][0] ? names[i] : "\"sim\""), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "Link the library cm1e::sim"), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "cm1e_sim_register()"), diag.text);
    }
}

static void test_every_other_name_is_a_network_interface(void)
{
    static const char *const names[] = {"simple0", "guest", "eth77"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        strcpy(config.interface_name, names[i]);
        TEST_ASSERT_NOT_EQUAL(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
        TEST_ASSERT_NOT_EQUAL(CM1E_ERROR_UNSUPPORTED, diag.error);
    }
}

/* ---- registration ------------------------------------------------------------------------------------------------ */

static void test_a_registered_backend_opens_its_names(void)
{
    TEST_ASSERT_TRUE(cm1e_nic_register(&guest));
    open_named("guest");
    TEST_ASSERT_EQUAL_PTR(&guest_state, cm1e_nic_state_of(nic, &guest));
    TEST_ASSERT_NULL(cm1e_nic_state_of(nic, &other));
    strcpy(config.interface_name, "sim");
    cm1e_nic_t *second = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, cm1e_nic_open(&second, &config, &diag));
}

static void test_registering_again_changes_nothing_and_the_table_has_an_end(void)
{
    static cm1e_nic_backend_t more[CM1E_NIC_GUESTS];
    for (int i = 0; i < 2 * CM1E_NIC_GUESTS; i++)
        TEST_ASSERT_TRUE(cm1e_nic_register(&guest));
    for (int i = 0; i < CM1E_NIC_GUESTS; i++) {
        more[i] = other;
        TEST_ASSERT_EQUAL_INT(i < CM1E_NIC_GUESTS - 1, cm1e_nic_register(&more[i]));
    }
    TEST_ASSERT_TRUE(cm1e_nic_register(&guest));
    open_named("guest");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_simulated_interface_without_simulator_is_refused_with_the_cure);
    RUN_TEST(test_every_other_name_is_a_network_interface);
    RUN_TEST(test_a_registered_backend_opens_its_names);
    RUN_TEST(test_registering_again_changes_nothing_and_the_table_has_an_end);
    return UNITY_END();
}
