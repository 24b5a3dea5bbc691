/** The simulated CM1-E in its slave: emergencies (ETG.1000.6 5.6.4), restarts, the image it boots from. */
#include <string.h>

#include "core/bytes.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"
#include "unity.h"

enum { MS = 1000000 };

static cm1e_sim_slave_t *slave;
static cm1e_sim_cm1e_t *drive;
static int64_t now_ns;

static void open_drive(const char *firmware)
{
    cm1e_axis_config_t config = {0};
    strcpy(config.firmware, firmware);
    slave = cm1e_sim_cm1e_create(&config, CM1E_PDO_ORDER_UG_4_4, 0, 0);
    drive = cm1e_sim_cm1e_of(slave);
    TEST_ASSERT_NOT_NULL(drive);
    now_ns = 1000 * (int64_t)MS;
    cm1e_sim_esc_advance(slave, now_ns);
    slave->mailbox.running = true; /* as from Pre-Operational on */
}

void setUp(void) { open_drive(""); }
void tearDown(void) { cm1e_sim_slave_destroy(slave); }

static void outputs(uint16_t controlword)
{
    uint8_t image[13] = {0};
    cm1e_put_u16(image, controlword);
    image[12] = CM1E_MODE_CSP;
    drive->al_state = 8;
    now_ns += MS;
    slave->ops->advance(drive, now_ns);
    slave->ops->outputs(drive, image, sizeof image, now_ns);
    uint8_t inputs[21];
    slave->ops->inputs(drive, inputs, sizeof inputs);
}

static void enable(void)
{
    for (int i = 0; i < 10; i++)
        outputs(0x0F);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, drive->fsa.state);
}

static unsigned emergencies(void) { return slave->mailbox.emergency_count; }

static void check_emergency(uint16_t code, uint8_t error_register)
{
    mailbox_t *mailbox = &slave->mailbox;
    TEST_ASSERT_TRUE_MESSAGE(mailbox->emergency_count > 0, "no emergency was queued");
    const uint8_t *e = mailbox->emergencies[mailbox->emergency_first];
    TEST_ASSERT_EQUAL_HEX16(code, cm1e_get_u16(e));
    TEST_ASSERT_EQUAL_HEX8(error_register, e[2]);
    mailbox->emergency_first = (mailbox->emergency_first + 1) % MAILBOX_EMERGENCIES;
    mailbox->emergency_count--;
}

static void test_normal_operation_sends_no_emergency(void)
{
    enable();
    for (int i = 0; i < 5; i++) {
        outputs(0x06);
        outputs(0x0F);
    }
    TEST_ASSERT_EQUAL(0, emergencies());
}

static void test_an_error_and_its_reset_send_one_emergency_each(void)
{
    for (size_t i = 0; i < cm1e_device_error_count; i++) {
        const cm1e_device_error_t *error = &cm1e_device_errors[i];
        if (!error->fault)
            continue;
        enable();
        cm1e_sim_fsa_error(drive, error->code);
        check_emergency(error->code, error->error_register);
        for (int n = 0; n < 20; n++)
            outputs(0x0F);
        TEST_ASSERT_EQUAL(0, emergencies());
        outputs(0x86);
        check_emergency(0, 0);
        outputs(0x06);
        TEST_ASSERT_EQUAL(0, emergencies());
    }
}

static void test_missing_motor_power_is_told_without_a_fault(void)
{
    cm1e_sim_fsa_motor_power(drive, false);
    check_emergency(0xFF05, 0x11);
    cm1e_sim_fsa_motor_power(drive, true);
    check_emergency(0, 0);
    TEST_ASSERT_EQUAL(0, emergencies());
}

static void test_a_full_queue_drops_what_follows(void)
{
    for (int i = 0; i < 100; i++)
        cm1e_sim_fsa_motor_power(drive, i % 2 != 0);
    TEST_ASSERT_EQUAL(MAILBOX_EMERGENCIES, emergencies());
}

static void test_clearing_a_power_up_fault_takes_the_device_off_the_bus(void)
{
    drive->troubles.failing_power_ups = 2;
    cm1e_sim_slave_reset(slave, now_ns + MS);
    cm1e_sim_esc_advance(slave, now_ns += 2 * MS);
    TEST_ASSERT_EQUAL_HEX16(0x7510, drive->fsa.fault_code);
    for (int attempt = 0; attempt < 2; attempt++) {
        outputs(0x06);
        TEST_ASSERT_TRUE(cm1e_sim_esc_present(slave));
        outputs(0x86);
        TEST_ASSERT_FALSE(cm1e_sim_esc_present(slave));
        cm1e_sim_esc_advance(slave, now_ns += 200 * MS);
        TEST_ASSERT_FALSE(cm1e_sim_esc_present(slave));
        cm1e_sim_esc_advance(slave, now_ns += 200 * MS);
        TEST_ASSERT_TRUE(cm1e_sim_esc_present(slave));
        TEST_ASSERT_EQUAL(1, cm1e_sim_slave_al_state(slave));
        TEST_ASSERT_EQUAL_HEX16(attempt == 0 ? 0x7510 : 0, drive->fsa.fault_code);
    }
}

static void test_the_eeprom_has_the_revision_of_the_firmware(void)
{
    static const struct {
        const char *firmware;
        uint32_t revision;
    } rows[] = {{"1.2.0", 0x20020001}, {"1.3.0", 0x20020103}, {"1.3.5", 0x20020103}};
    for (int i = 0; i < 3; i++) {
        cm1e_sim_slave_destroy(slave);
        open_drive(rows[i].firmware);
        TEST_ASSERT_EQUAL_HEX32(0x4441, cm1e_get_u32(slave->sii + 16));
        TEST_ASSERT_EQUAL_HEX32(0x44412002, cm1e_get_u32(slave->sii + 20));
        TEST_ASSERT_EQUAL_HEX32(rows[i].revision, cm1e_get_u32(slave->sii + 24));
    }
}

static void test_only_a_cm1e_is_taken_for_one(void)
{
    TEST_ASSERT_NULL(cm1e_sim_cm1e_of(NULL));
    cm1e_sim_slave_t *module = cm1e_sim_io_module_create();
    TEST_ASSERT_NULL(cm1e_sim_cm1e_of(module));
    cm1e_sim_slave_destroy(module);
}

static void test_wrong_motor_or_firmware_gives_no_slave(void)
{
    const cm1e_axis_config_t motor = {.motor = "CM1-E-17S30"}, firmware = {.firmware = "latest"};
    TEST_ASSERT_NULL(cm1e_sim_cm1e_create(&motor, CM1E_PDO_ORDER_UG_4_4, 0, 0));
    TEST_ASSERT_NULL(cm1e_sim_cm1e_create(&firmware, CM1E_PDO_ORDER_UG_4_4, 0, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_normal_operation_sends_no_emergency);
    RUN_TEST(test_an_error_and_its_reset_send_one_emergency_each);
    RUN_TEST(test_missing_motor_power_is_told_without_a_fault);
    RUN_TEST(test_a_full_queue_drops_what_follows);
    RUN_TEST(test_clearing_a_power_up_fault_takes_the_device_off_the_bus);
    RUN_TEST(test_the_eeprom_has_the_revision_of_the_firmware);
    RUN_TEST(test_only_a_cm1e_is_taken_for_one);
    RUN_TEST(test_wrong_motor_or_firmware_gives_no_slave);
    return UNITY_END();
}
