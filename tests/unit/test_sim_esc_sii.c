/* The SII interface of the simulated slave controller (0x0500 ... 0x050F) and what is loaded from it. */
#include "sim_fake_app.h"

enum { BUSY = 0x8000, READ = 0x0100, WRITE = 0x0201, RELOAD = 0x0400 };

static bench_t b;
static uint8_t image[CM1E_SII_SIZE];

static void open_image(void) { bench_open_with(&b, 1, image, sizeof image); }

void setUp(void)
{
    fake_sii(image, 0x4711, 0xDEADBEEF);
    open_image();
}
void tearDown(void) { bench_close(&b); }

static uint16_t wait_ready(void)
{
    for (int i = 0; i < 100; i++) {
        const uint16_t status = read_u16(&b, 0, 0x0502);
        if (!(status & BUSY))
            return status;
        bench_wait(&b, 100000);
    }
    return BUSY;
}

/* Command and address in one write, as most masters do. */
static uint16_t command(uint16_t code, uint32_t word)
{
    uint8_t data[6];
    cm1e_put_u16(data, code);
    cm1e_put_u32(data + 2, word);
    TEST_ASSERT_EQUAL_INT(1, write_bytes(&b, 0, 0x0502, data, 6));
    return wait_ready();
}

static void test_the_whole_image_can_be_read(void)
{
    for (uint32_t word = 0; word < CM1E_SII_SIZE / 2; word += 4) {
        uint8_t data[8] = {0};
        TEST_ASSERT_EQUAL_HEX16(0x00C0, command(READ, word));
        TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, 0x0508, data, 8));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(image + 2 * word, data, 8);
    }
    /* from an odd word as well, up to the last */
    command(READ, CM1E_SII_SIZE / 2 - 1);
    TEST_ASSERT_EQUAL_HEX16(cm1e_get_u16(image + CM1E_SII_SIZE - 2), read_u16(&b, 0, 0x0508));
}

static void test_reading_takes_time_and_nothing_else_is_accepted_meanwhile(void)
{
    TEST_ASSERT_EQUAL_INT(1, write_u16(&b, 0, 0x0504, 8));
    TEST_ASSERT_EQUAL_INT(1, write_u16(&b, 0, 0x0502, READ));
    TEST_ASSERT_EQUAL_HEX16(BUSY, read_u16(&b, 0, 0x0502) & BUSY);
    TEST_ASSERT_EQUAL_INT(0, write_u16(&b, 0, 0x0504, 0));
    TEST_ASSERT_EQUAL_INT(0, write_u16(&b, 0, 0x0502, READ));
    wait_ready();
    TEST_ASSERT_EQUAL_HEX32(CM1E_VENDOR_ID, read_u32(&b, 0, 0x0508));
}

static void test_control_can_be_written_as_one_byte(void)
{
    TEST_ASSERT_EQUAL_INT(1, write_u16(&b, 0, 0x0504, 0x0A));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0503, READ >> 8));
    TEST_ASSERT_EQUAL_HEX16(0, wait_ready() & 0x7800);
    TEST_ASSERT_EQUAL_HEX32(CM1E_PRODUCT_CODE, read_u32(&b, 0, 0x0508));
    /* write enable first, the command in a second byte */
    TEST_ASSERT_EQUAL_INT(1, write_u16(&b, 0, 0x0508, 0x1234));
    TEST_ASSERT_EQUAL_INT(1, write_u16(&b, 0, 0x0504, 0x0E));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0502, 1));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0503, WRITE >> 8));
    TEST_ASSERT_EQUAL_HEX16(0, wait_ready() & 0x7800);
    command(READ, 0x0E);
    TEST_ASSERT_EQUAL_HEX32(0xDEAD1234, read_u32(&b, 0, 0x0508));
}

static void test_a_word_is_written_where_writing_is_enabled(void)
{
    TEST_ASSERT_EQUAL_INT(1, write_u16(&b, 0, 0x0508, 0xBEEF));
    TEST_ASSERT_EQUAL_HEX16(0x4000, command(WRITE & 0xFF00, 0x0E) & 0x7800); /* not enabled */
    command(READ, 0x0E);
    TEST_ASSERT_EQUAL_HEX32(0xDEADBEEF, read_u32(&b, 0, 0x0508));
    TEST_ASSERT_EQUAL_INT(1, write_u16(&b, 0, 0x0508, 0x5678));
    TEST_ASSERT_EQUAL_HEX16(0, command(WRITE, 0x0E) & 0x7800);
    command(READ, 0x0E);
    TEST_ASSERT_EQUAL_HEX32(0xDEAD5678, read_u32(&b, 0, 0x0508));
}

static void test_commands_that_do_not_exist_are_an_error_until_cleared(void)
{
    for (uint16_t code = 0x0300; code <= 0x0700; code += 0x0100) {
        if (code == RELOAD)
            continue;
        TEST_ASSERT_EQUAL_HEX16(0x2000, command(code, 0) & 0x7800);
        TEST_ASSERT_EQUAL_HEX16(0, command(0, 0) & 0x7800);
    }
    TEST_ASSERT_EQUAL_HEX16(0x2000, command(READ, CM1E_SII_SIZE / 2) & 0x7800);
    TEST_ASSERT_EQUAL_HEX16(0x2000, command(READ, UINT32_MAX) & 0x7800);
    TEST_ASSERT_EQUAL_HEX16(0x2000, command(WRITE, 0x80000000) & 0x7800);
    TEST_ASSERT_EQUAL_HEX16(0, command(READ, 0) & 0x7800);
}

static void test_the_owner_is_the_master_unless_it_gives_the_interface_away(void)
{
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0500, 1));
    TEST_ASSERT_EQUAL_INT(0, write_u16(&b, 0, 0x0502, READ));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0500, 2));
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0500, 0));
    TEST_ASSERT_EQUAL_HEX16(0, command(READ, 0) & 0x7800);
}

static void test_a_new_alias_is_taken_over_at_power_on_only(void)
{
    write_u16(&b, 0, 0x0508, 0x0815);
    command(WRITE, 4);
    uint8_t words[14];
    memcpy(words, image, sizeof words);
    cm1e_put_u16(words + 8, 0x0815);
    write_u16(&b, 0, 0x0508, cm1e_sii_crc8(words, sizeof words));
    command(WRITE, 7);
    TEST_ASSERT_EQUAL_HEX16(0, command(RELOAD, 0) & 0x7800);
    TEST_ASSERT_EQUAL_HEX16(0x4711, read_u16(&b, 0, 0x0012));
    cm1e_sim_slave_reset(cm1e_sim_segment_slave(b.segment, 1), b.now_ns + 1000);
    bench_wait(&b, 2000);
    TEST_ASSERT_EQUAL_HEX16(0x0815, read_u16(&b, 0, 0x0012));
}

static void test_a_wrong_checksum_keeps_the_slave_in_init(void)
{
    write_u16(&b, 0, 0x0508, 0x0815);
    command(WRITE, 4);
    TEST_ASSERT_EQUAL_HEX16(0x1800, command(RELOAD, 0) & 0x7800);
    cm1e_sim_slave_reset(cm1e_sim_segment_slave(b.segment, 1), b.now_ns + 1000);
    bench_wait(&b, 2000);
    TEST_ASSERT_EQUAL_HEX16(0x1800, read_u16(&b, 0, 0x0502) & 0x7800);
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 0, 0x0012));
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 0, 0x0110) & 0x0001);
    configure_mailboxes(&b, 0);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT, request_state(&b, 0, CM1E_AL_PRE_OP));
    /* the master can repair it */
    write_u16(&b, 0, 0x0508, 0x4711);
    TEST_ASSERT_EQUAL_HEX16(0x1800, command(WRITE, 4) & 0x7800);
    TEST_ASSERT_EQUAL_HEX16(0, command(RELOAD, 0) & 0x7800);
}

/* Any image, however broken: the slave is made, answers, and reads nothing beyond its end. */
static void test_broken_images_do_no_harm(void)
{
    const unsigned seed = 815;
    printf("seed %u\n", seed);
    srand(seed);
    for (int i = 0; i < 3000; i++) {
        tearDown();
        const size_t size = i < 200 ? (size_t)i : (size_t)(rand() % (int)sizeof image);
        uint8_t *broken = malloc(size + 1);
        fake_sii(image, 0, 0);
        memcpy(broken, image, size);
        for (int n = rand() % 20; size && n > 0; n--)
            broken[128 % size + (size_t)rand() % (size - 128 % size)] = (uint8_t)rand();
        if (size >= 16)
            broken[14] = cm1e_sii_crc8(broken, 14);
        bench_open_with(&b, 1, broken, size);
        free(broken);
        TEST_ASSERT_EQUAL_HEX8(CM1E_AL_INIT, read_u8(&b, 0, 0x0130));
        configure_mailboxes(&b, 0);
        request_state(&b, 0, CM1E_AL_PRE_OP);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_whole_image_can_be_read);
    RUN_TEST(test_reading_takes_time_and_nothing_else_is_accepted_meanwhile);
    RUN_TEST(test_control_can_be_written_as_one_byte);
    RUN_TEST(test_a_word_is_written_where_writing_is_enabled);
    RUN_TEST(test_commands_that_do_not_exist_are_an_error_until_cleared);
    RUN_TEST(test_the_owner_is_the_master_unless_it_gives_the_interface_away);
    RUN_TEST(test_a_new_alias_is_taken_over_at_power_on_only);
    RUN_TEST(test_a_wrong_checksum_keeps_the_slave_in_init);
    RUN_TEST(test_broken_images_do_no_harm);
    return UNITY_END();
}
