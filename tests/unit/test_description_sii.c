/* The SII image, read back by a parser that knows the format from ETG.1000.6 and nothing of the writer. */
#include <string.h>

#include "core/bytes.h"
#include "description/sii.h"
#include "unity.h"

static uint8_t image[CM1E_SII_SIZE];

void setUp(void) {}
void tearDown(void) {}

static void generate(const cm1e_sii_options_t *options)
{
    memset(image, 0xAA, sizeof image);
    TEST_ASSERT_EQUAL_UINT(CM1E_SII_SIZE, cm1e_generate_sii(image, sizeof image, options));
}

static uint16_t word(unsigned at) { return cm1e_get_u16(image + 2 * at); }
static uint32_t double_word(unsigned at) { return cm1e_get_u32(image + 2 * at); }

/* Data of the nth category of a type; NULL: none. Checks the chain to its end. */
static const uint8_t *category(uint16_t type, unsigned *bytes)
{
    const uint8_t *found = NULL;
    size_t at = 128;
    for (;;) {
        TEST_ASSERT_LESS_OR_EQUAL_UINT(sizeof image - 2, at);
        const uint16_t t = cm1e_get_u16(image + at);
        if (t == 0xFFFF)
            return found;
        const unsigned n = 2u * cm1e_get_u16(image + at + 2);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(sizeof image - 6, at + n);
        if (t == type) {
            TEST_ASSERT_NULL_MESSAGE(found, "a category stands there twice");
            found = image + at + 4;
            *bytes = n;
        }
        at += 4 + n;
    }
}

/* String number n as C text; "" for 0. */
static const char *string(unsigned n)
{
    static char text[256];
    unsigned bytes;
    const uint8_t *p = category(10, &bytes);
    TEST_ASSERT_NOT_NULL(p);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(p[0], n);
    text[0] = 0;
    const uint8_t *s = p + 1;
    for (unsigned i = 1; i <= n; i++, s += 1 + s[0]) {
        TEST_ASSERT_LESS_OR_EQUAL_UINT(bytes, (unsigned)(s - p) + 1 + s[0]);
        memcpy(text, s + 1, s[0]);
        text[s[0]] = 0;
    }
    return text;
}

static void test_checksum_is_that_of_published_images(void)
{
    static const uint8_t words[14] = {0x00, 0x01, 0x00, 0x00, 0x0A, 0x00};
    TEST_ASSERT_EQUAL_HEX8(0x3D, cm1e_sii_crc8(words, sizeof words));
    TEST_ASSERT_EQUAL_HEX8(0xFF, cm1e_sii_crc8(words, 0));
}

static void test_a_room_too_small_is_left_alone(void)
{
    const cm1e_sii_options_t options = {0};
    image[0] = 0x77;
    TEST_ASSERT_EQUAL_UINT(0, cm1e_generate_sii(image, sizeof image - 1, &options));
    TEST_ASSERT_EQUAL_UINT(0, cm1e_generate_sii_io_module(image, 0));
    TEST_ASSERT_EQUAL_HEX8(0x77, image[0]);
}

static void test_header_says_who_and_where_the_mailboxes_are(void)
{
    const cm1e_sii_options_t options = {.firmware = CM1E_FIRMWARE_1_3_5, .alias = 0x1234, .serial_number = 0x11223344};
    generate(&options);
    TEST_ASSERT_EQUAL_HEX16(0x1234, word(4));
    TEST_ASSERT_EQUAL_HEX16(cm1e_sii_crc8(image, 14), word(7));
    TEST_ASSERT_EQUAL_HEX32(0x00004441, double_word(0x08));
    TEST_ASSERT_EQUAL_HEX32(0x44412002, double_word(0x0A));
    TEST_ASSERT_EQUAL_HEX32(0x20020103, double_word(0x0C));
    TEST_ASSERT_EQUAL_HEX32(0x11223344, double_word(0x0E));
    static const uint16_t mailboxes[] = {0x1000, 128, 0x1080, 128};
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX16(mailboxes[i], word(0x14 + i));
        TEST_ASSERT_EQUAL_HEX16(mailboxes[i], word(0x18 + i));
    }
    TEST_ASSERT_EQUAL_HEX16(0x000C, word(0x1C)); /* CoE, FoE */
    TEST_ASSERT_EQUAL_UINT16(15, word(0x3E));    /* 16 kbit */
    TEST_ASSERT_EQUAL_UINT16(1, word(0x3F));
}

static void test_revision_follows_the_firmware(void)
{
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++) {
        const cm1e_sii_options_t options = {.firmware = (cm1e_firmware_t)f};
        generate(&options);
        TEST_ASSERT_EQUAL_HEX32(f == CM1E_FIRMWARE_1_2_0 ? 0x20020001 : 0x20020103, double_word(0x0C));
    }
}

static void test_string_1_is_the_name(void)
{
    const cm1e_sii_options_t options = {0};
    generate(&options);
    TEST_ASSERT_EQUAL_STRING("CM1-E", string(1));
}

static void test_general_tells_what_the_mailbox_can(void)
{
    cm1e_sii_options_t options = {.firmware = CM1E_FIRMWARE_1_3_5};
    unsigned bytes;
    generate(&options);
    const uint8_t *general = category(30, &bytes);
    TEST_ASSERT_NOT_NULL(general);
    TEST_ASSERT_EQUAL_UINT(32, bytes);
    TEST_ASSERT_EQUAL_STRING("CM1-E", string(general[3]));
    TEST_ASSERT_EQUAL_HEX8(0x07, general[5]); /* SDO, SDO information, PDO assignment */
    TEST_ASSERT_EQUAL_HEX8(0x01, general[6]); /* FoE */
    TEST_ASSERT_EQUAL_HEX8(0x00, general[7]);
    TEST_ASSERT_EQUAL_HEX8(0x00, general[11] & 0x02); /* LRW is allowed */
    TEST_ASSERT_EQUAL_HEX16(0x0011, cm1e_get_u16(general + 16));
    options.complete_access = true;
    generate(&options);
    TEST_ASSERT_EQUAL_HEX8(0x27, category(30, &bytes)[5]);
}

static void test_fmmus_and_sync_managers_are_those_of_the_device(void)
{
    const cm1e_sii_options_t options = {.firmware = CM1E_FIRMWARE_1_3_5};
    unsigned bytes;
    generate(&options);
    const uint8_t *fmmus = category(40, &bytes);
    TEST_ASSERT_EQUAL_UINT(4, bytes);
    static const uint8_t expected_fmmus[] = {1, 2, 3, 0};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected_fmmus, fmmus, 4);
    const uint8_t *sm = category(41, &bytes);
    static const uint8_t expected[] = {
        0x00, 0x10, 0x80, 0, 0x26, 0, 1, 1, 0x80, 0x10, 0x80, 0, 0x22, 0, 1, 2,
        0x00, 0x11, 13,   0, 0x64, 0, 1, 3, 0x00, 0x14, 21,   0, 0x20, 0, 1, 4,
    };
    TEST_ASSERT_EQUAL_UINT(sizeof expected, bytes);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, sm, sizeof expected);
}

/* Walks a PDO category; returns the bits that belong to `sync_manager`, checks every PDO against the tables. */
static unsigned check_pdos(const cm1e_sii_options_t *options, bool transmit, unsigned sync_manager)
{
    unsigned bytes, bits = 0, number = 0;
    const uint8_t *begin = category(transmit ? 50 : 51, &bytes), *p = begin;
    TEST_ASSERT_NOT_NULL(begin);
    for (; p < begin + bytes; number++) {
        cm1e_pdo_t pdo;
        cm1e_device_pdo(&pdo, (cm1e_mapping_t)number, transmit, options->order, options->firmware);
        TEST_ASSERT_EQUAL_HEX16(pdo.index, cm1e_get_u16(p));
        TEST_ASSERT_EQUAL_UINT8(pdo.entry_count, p[2]);
        TEST_ASSERT_EQUAL_HEX8(number == (unsigned)options->mapping ? sync_manager : 0xFF, p[3]);
        TEST_ASSERT_EQUAL_STRING(pdo.name, string(p[5]));
        const bool assigned = p[3] == sync_manager;
        p += 8;
        for (unsigned e = 0; e < pdo.entry_count; e++, p += 8) {
            TEST_ASSERT_EQUAL_HEX16(pdo.entries[e].index, cm1e_get_u16(p));
            TEST_ASSERT_EQUAL_HEX8(pdo.entries[e].subindex, p[2]);
            TEST_ASSERT_EQUAL_UINT8(pdo.entries[e].bits, p[5]);
            const cm1e_entry_t *entry = cm1e_device_entry(pdo.entries[e].index, pdo.entries[e].subindex);
            TEST_ASSERT_EQUAL_STRING(entry->name, string(p[3]));
            /* a type of that many bits (ETG.1020) */
            static const uint8_t type_bits[8] = {0, 1, 8, 16, 32, 8, 16, 32};
            TEST_ASSERT_LESS_THAN_UINT8(8, p[4]);
            TEST_ASSERT_EQUAL_UINT8(pdo.entries[e].bits, type_bits[p[4]]);
            bits += assigned ? p[5] : 0;
        }
    }
    TEST_ASSERT_EQUAL_UINT(4, number);
    TEST_ASSERT_EQUAL_PTR(begin + bytes, p);
    return bits;
}

static void test_every_choice_gives_the_pdos_of_the_device_tables(void)
{
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        for (int order = 0; order < 2; order++)
            for (int mapping = 0; mapping < 4; mapping++) {
                const cm1e_sii_options_t options = {.firmware = (cm1e_firmware_t)f, .order = (cm1e_pdo_order_t)order,
                                                    .mapping = (cm1e_mapping_t)mapping,
                                                    .distributed_clocks = mapping % 2 == 1};
                generate(&options);
                unsigned bytes;
                const uint8_t *sm = category(41, &bytes);
                TEST_ASSERT_EQUAL_UINT(check_pdos(&options, false, 2), 8u * cm1e_get_u16(sm + 16 + 2));
                TEST_ASSERT_EQUAL_UINT(check_pdos(&options, true, 3), 8u * cm1e_get_u16(sm + 24 + 2));
            }
}

static void test_default_mapping_has_13_and_21_bytes(void)
{
    const cm1e_sii_options_t options = {.firmware = CM1E_FIRMWARE_1_3_5};
    generate(&options);
    TEST_ASSERT_EQUAL_UINT(13 * 8, check_pdos(&options, false, 2));
    TEST_ASSERT_EQUAL_UINT(21 * 8, check_pdos(&options, true, 3));
}

static void test_dc_modes_are_there_on_request(void)
{
    cm1e_sii_options_t options = {.firmware = CM1E_FIRMWARE_1_3_5};
    unsigned bytes;
    generate(&options);
    TEST_ASSERT_NULL(category(60, &bytes));
    options.distributed_clocks = true;
    generate(&options);
    const uint8_t *dc = category(60, &bytes);
    TEST_ASSERT_NOT_NULL(dc);
    TEST_ASSERT_EQUAL_UINT(48, bytes);
    TEST_ASSERT_EQUAL_HEX16(0x0000, cm1e_get_u16(dc + 14));
    TEST_ASSERT_EQUAL_HEX16(0x0300, cm1e_get_u16(dc + 24 + 14));
    TEST_ASSERT_EQUAL_STRING("DC Synchron", string(dc[24 + 18]));
}

static void test_images_are_reproducible_and_end_in_empty_cells(void)
{
    const cm1e_sii_options_t options = {.firmware = CM1E_FIRMWARE_1_3_4, .distributed_clocks = true};
    uint8_t first[CM1E_SII_SIZE];
    generate(&options);
    memcpy(first, image, sizeof first);
    generate(&options);
    TEST_ASSERT_EQUAL_MEMORY(first, image, sizeof first);
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, cm1e_get_u32(image + sizeof image - 4));
}

static void test_io_module_has_a_byte_each_way_and_no_mailbox(void)
{
    memset(image, 0xAA, sizeof image);
    TEST_ASSERT_EQUAL_UINT(CM1E_SII_SIZE, cm1e_generate_sii_io_module(image, sizeof image));
    TEST_ASSERT_EQUAL_HEX16(cm1e_sii_crc8(image, 14), word(7));
    for (unsigned i = 0x14; i <= 0x1C; i++)
        TEST_ASSERT_EQUAL_HEX16(0, word(i));
    unsigned bytes;
    const uint8_t *sm = category(41, &bytes);
    TEST_ASSERT_EQUAL_UINT(16, bytes);
    TEST_ASSERT_EQUAL_UINT8(3, sm[7]);
    TEST_ASSERT_EQUAL_UINT8(4, sm[15]);
    TEST_ASSERT_EQUAL_UINT8(8, category(50, &bytes)[8 + 5]);
    TEST_ASSERT_EQUAL_UINT8(1, category(50, &bytes)[3]);
    TEST_ASSERT_EQUAL_UINT8(8, category(51, &bytes)[8 + 5]);
    TEST_ASSERT_EQUAL_UINT8(0, category(51, &bytes)[3]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_checksum_is_that_of_published_images);
    RUN_TEST(test_a_room_too_small_is_left_alone);
    RUN_TEST(test_header_says_who_and_where_the_mailboxes_are);
    RUN_TEST(test_revision_follows_the_firmware);
    RUN_TEST(test_string_1_is_the_name);
    RUN_TEST(test_general_tells_what_the_mailbox_can);
    RUN_TEST(test_fmmus_and_sync_managers_are_those_of_the_device);
    RUN_TEST(test_every_choice_gives_the_pdos_of_the_device_tables);
    RUN_TEST(test_default_mapping_has_13_and_21_bytes);
    RUN_TEST(test_dc_modes_are_there_on_request);
    RUN_TEST(test_images_are_reproducible_and_end_in_empty_cells);
    RUN_TEST(test_io_module_has_a_byte_each_way_and_no_mailbox);
    return UNITY_END();
}
