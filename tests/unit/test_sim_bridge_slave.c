/* The simulated bridge in its slave: the image it boots from, complete access, cycle time. */
#include "description/sii_image.h"
#include "sim/esc_chip.h"
#include "sim_bridge_bench.h"

enum { SYNC_ERROR = 0x001A };

static cm1e_sim_slave_t *slave;
static bench_t b;

static void open_slave(cm1e_device_model_t model)
{
    slave = cm1e_sim_bridge_create(model, NULL, 0);
    b = (bench_t){.bridge = cm1e_sim_bridge_of(slave), .ops = &cm1e_sim_bridge_ops};
    TEST_ASSERT_NOT_NULL(b.bridge);
    b.now_ns = 1000 * (int64_t)BENCH_MS;
    cm1e_sim_esc_advance(slave, b.now_ns);
    slave->al_state = BENCH_OP;
    b.ops->state_change(b.bridge, BENCH_SAFEOP, BENCH_OP);
}

void setUp(void) { open_slave(CM1E_DEVICE_EB12); }
void tearDown(void)
{
    cm1e_sim_slave_destroy(slave);
    slave = NULL;
}

static void test_the_sii_is_that_of_the_model(void)
{
    static const struct {
        cm1e_device_model_t model;
        uint32_t product;
        const char *type;
    } rows[] = {{CM1E_DEVICE_EB01, 0xEB01, "EB01"}, {CM1E_DEVICE_EB02, 0xEB02, "EB02"},
                {CM1E_DEVICE_EB12, 0xEB12, "EB12"}};
    for (int i = 0; i < 3; i++) {
        tearDown();
        open_slave(rows[i].model);
        cm1e_description_file_t file = {0};
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_sii_read(&file, slave->sii, slave->sii_size, NULL, NULL));
        const cm1e_description_t *device = &file.devices.at[0];
        TEST_ASSERT_EQUAL_HEX32(0xAA77, device->vendor_id);
        TEST_ASSERT_EQUAL_HEX32(rows[i].product, device->product_code);
        TEST_ASSERT_EQUAL_STRING(rows[i].type, device->type);
        TEST_ASSERT_EQUAL_size_t(8, device->pdos.count);
        cm1e_description_file_free(&file);
    }
}

static void test_a_cm1e_is_no_bridge(void)
{
    TEST_ASSERT_NULL(cm1e_sim_bridge_create(CM1E_DEVICE_CM1E, NULL, 0));
    TEST_ASSERT_NULL(cm1e_sim_bridge_of(NULL));
    cm1e_sim_slave_t *module = cm1e_sim_io_module_create();
    TEST_ASSERT_NULL(cm1e_sim_bridge_of(module));
    cm1e_sim_slave_destroy(module);
}

/* Rows that are "N/A" or "-" read as zero where the object as a whole can be read; an "N/A" object cannot. */
static void test_complete_access(void)
{
    uint8_t data[512];
    size_t size = sizeof data;
    TEST_ASSERT_EQUAL_HEX32(0, cm1e_sim_coe_read(slave, 0x60F6, 0, true, data, &size));
    TEST_ASSERT_EQUAL_size_t(2 + 4 * 79, size);
    TEST_ASSERT_EQUAL(79, cm1e_get_u16(data));
    TEST_ASSERT_EQUAL(100, cm1e_get_u32(data + 2 + 4 * 21)); /* K42 */
    TEST_ASSERT_EQUAL(0, cm1e_get_u32(data + 2 + 4 * 16));   /* K37, N/A and not 0 */
    size = sizeof data;
    TEST_ASSERT_EQUAL_HEX32(0x06010000, cm1e_sim_coe_read(slave, 0x1600, 0, true, data, &size));
    size = sizeof data;
    TEST_ASSERT_EQUAL_HEX32(0x06010000, cm1e_sim_coe_read(slave, 0x60FB, 1, true, data, &size));
    TEST_ASSERT_EQUAL_HEX32(0x06010000, cm1e_sim_coe_write(slave, 0x607D, 0, true, data, 10));
}

/* ---- cycle time ------------------------------------------------------------------------------------------------- */

static void cycles_of(int64_t us, int count)
{
    for (int i = 0; i < count; i++)
        bench_cycle_after(&b, us * 1000);
}

static uint16_t al_code(void) { return cm1e_get_u16(slave->memory + ESC_AL_STATUS_CODE); }

static void test_cycles_are_measured(void)
{
    cycles_of(1000, 10);
    TEST_ASSERT_EQUAL(1000, bench_read(&b, 0xF530, 17));
    TEST_ASSERT_EQUAL(1000, bench_read(&b, 0xF530, 18));
    cycles_of(1301, 3);
    cycles_of(699, 2);
    cycles_of(1300, 4);
    cycles_of(700, 4);
    TEST_ASSERT_EQUAL(1301, bench_read(&b, 0xF530, 17));
    TEST_ASSERT_EQUAL(699, bench_read(&b, 0xF530, 18));
    TEST_ASSERT_EQUAL(3, bench_read(&b, 0xF530, 19));
    TEST_ASSERT_EQUAL(2, bench_read(&b, 0xF530, 20));
}

static void test_another_cycle_time_than_1_ms_is_a_synchronisation_error(void)
{
    static const int64_t wrong_us[] = {200, 250, 500, 2000, 4000};
    for (int i = 0; i < 5; i++) {
        tearDown();
        setUp();
        cycles_of(wrong_us[i], 100); /* the first has no cycle before it */
        TEST_ASSERT_EQUAL(BENCH_OP, slave->al_state);
        cycles_of(wrong_us[i], 1);
        TEST_ASSERT_EQUAL(BENCH_SAFEOP, slave->al_state);
        TEST_ASSERT_EQUAL_HEX16(SYNC_ERROR, al_code());
    }
}

/* What the console says of it, asked (status) and unasked. */
/* BR 2.3: free run. */
static void test_in_free_run_no_cycle_time_is_wrong(void)
{
    bench_write(&b, 0x1C32, 1, 0);
    cycles_of(2000, 200);
    TEST_ASSERT_EQUAL(BENCH_OP, slave->al_state);
    bench_write(&b, 0x1C32, 1, 1);
    cycles_of(2000, 101);
    TEST_ASSERT_EQUAL(BENCH_SAFEOP, slave->al_state);
}

static void test_a_wrong_cycle_time_is_said_in_words(void)
{
    static const struct {
        int64_t us;
        const char *words;
    } rows[] = {
        {2000, "SAFEOP + ERROR, AL status code 0x001A, synchronization error: 100 cycles in a row were longer than "
               "1300 us, the last one 2000 us. The cycle of a bridge is 1 ms (BR 6.3)"},
        {500, "SAFEOP + ERROR, AL status code 0x001A, synchronization error: 100 cycles in a row were shorter than 700 "
              "us, the last one 500 us. The cycle of a bridge is 1 ms (BR 6.3)"},
    };
    for (int i = 0; i < 2; i++) {
        char news[400] = "none", again[400] = "none", status[1200];
        tearDown();
        setUp();
        cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_segment_add(segment, slave));
        cycles_of(rows[i].us, 100);
        TEST_ASSERT_FALSE(cm1e_sim_segment_news(segment, news, sizeof news));
        cycles_of(rows[i].us, 1);
        TEST_ASSERT_TRUE(cm1e_sim_segment_news(segment, news, sizeof news));
        TEST_ASSERT_FALSE_MESSAGE(cm1e_sim_segment_news(segment, again, sizeof again), "told twice");
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_console(segment, "status 1", status, sizeof status));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(news, rows[i].words), news);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(news, "slave 1 fell back"), news);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(status, rows[i].words), status);
        cm1e_sim_segment_destroy(segment);
        slave = NULL;
    }
}

static void test_a_host_that_is_late_and_then_early_is_let_pass(void)
{
    for (int i = 0; i < 500; i++) {
        cycles_of(1400, 1);
        cycles_of(600, 1);
    }
    cycles_of(1400, 99);
    cycles_of(1000, 1);
    cycles_of(1400, 99);
    TEST_ASSERT_EQUAL(BENCH_OP, slave->al_state);
}

/* 0x10F1:2 as ETG.1020 counts: a wrong cycle 3, a right one -1. */
static void test_a_stated_limit_of_synchronisation_errors(void)
{
    bench_write(&b, 0x10F1, 2, 4);
    cycles_of(1000, 2);
    for (int i = 0; i < 20; i++) {
        cycles_of(1500, 1);
        cycles_of(1000, 3);
    }
    TEST_ASSERT_EQUAL(BENCH_OP, slave->al_state);
    cycles_of(1500, 2);
    TEST_ASSERT_EQUAL(BENCH_SAFEOP, slave->al_state);
    TEST_ASSERT_EQUAL_HEX16(SYNC_ERROR, al_code());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_sii_is_that_of_the_model);
    RUN_TEST(test_a_cm1e_is_no_bridge);
    RUN_TEST(test_complete_access);
    RUN_TEST(test_cycles_are_measured);
    RUN_TEST(test_another_cycle_time_than_1_ms_is_a_synchronisation_error);
    RUN_TEST(test_in_free_run_no_cycle_time_is_wrong);
    RUN_TEST(test_a_wrong_cycle_time_is_said_in_words);
    RUN_TEST(test_a_host_that_is_late_and_then_early_is_let_pass);
    RUN_TEST(test_a_stated_limit_of_synchronisation_errors);
    return UNITY_END();
}
