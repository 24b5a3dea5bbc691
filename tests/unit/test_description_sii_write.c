/* The SII image, read back by a parser that knows the format from ETG.1000.6 and nothing of the writer. */
#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "unity.h"

static uint8_t image[CM1E_SII_SIZE];


static cm1e_description_file_t file;
static cm1e_diag_t diag;

void setUp(void) { diag = (cm1e_diag_t){0}; }
void tearDown(void) { cm1e_description_file_free(&file); }

static cm1e_description_t *describe(const cm1e_device_options_t *options)
{
    cm1e_description_file_free(&file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_describe(&file, options, CM1E_ESI_FLAT, &diag), diag.text);
    return &file.devices.at[0];
}

static void write(const cm1e_description_t *device)
{
    memset(image, 0xAA, sizeof image);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(CM1E_SII_SIZE, cm1e_sii_write(image, sizeof image, device, &diag), diag.text);
}

static const char *version_of(int firmware) { return cm1e_firmware_info((cm1e_firmware_t)firmware)->version; }

static void generate(const cm1e_device_options_t *options) { write(describe(options)); }

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
    const cm1e_device_options_t options = {0};
    image[0] = 0x77;
    TEST_ASSERT_EQUAL_size_t(0, cm1e_sii_write(image, sizeof image - 1, describe(&options), &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, diag.error);
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "has 2048 bytes; there is room for 2047"));
    TEST_ASSERT_EQUAL_size_t(0, cm1e_sii_write(image, 0, &file.devices.at[0], NULL));
    TEST_ASSERT_EQUAL_HEX8(0x77, image[0]);
}

static void test_header_says_who_and_where_the_mailboxes_are(void)
{
    const cm1e_device_options_t options = {.alias = 0x1234, .serial_number = 0x11223344};
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
        cm1e_device_options_t options = {0};
        strcpy(options.firmware, version_of(f));
        generate(&options);
        TEST_ASSERT_EQUAL_HEX32(f == CM1E_FIRMWARE_1_2_0 ? 0x20020001 : 0x20020103, double_word(0x0C));
    }
}

/* SOEM shows string 1 as the name. */
static void test_string_1_is_the_order_number(void)
{
    const cm1e_device_options_t options = {0};
    generate(&options);
    TEST_ASSERT_EQUAL_STRING("CM1-E", string(1));
}

static void test_general_tells_what_the_mailbox_can(void)
{
    cm1e_device_options_t options = {0};
    unsigned bytes;
    generate(&options);
    const uint8_t *general = category(30, &bytes);
    TEST_ASSERT_NOT_NULL(general);
    TEST_ASSERT_EQUAL_UINT(32, bytes);
    TEST_ASSERT_EQUAL_STRING("Servo motors", string(general[0]));
    TEST_ASSERT_EQUAL_STRING("CM1-E", string(general[2]));
    TEST_ASSERT_EQUAL_STRING("CM1-E", string(general[3]));
    TEST_ASSERT_EQUAL_HEX8(0x07, general[5]); /* SDO, SDO information, PDO assignment */
    TEST_ASSERT_EQUAL_HEX8(0x01, general[6]); /* FoE */
    TEST_ASSERT_EQUAL_HEX8(0x00, general[7]);
    TEST_ASSERT_EQUAL_UINT8(1, general[9]);   /* drives */
    TEST_ASSERT_EQUAL_HEX8(0x0C, general[11]); /* LRW allowed; repeat of mailbox messages, ID in the AL status code */
    TEST_ASSERT_EQUAL_HEX16(0x0011, cm1e_get_u16(general + 16));
    options.complete_access = true;
    generate(&options);
    TEST_ASSERT_EQUAL_HEX8(0x27, category(30, &bytes)[5]);
}

static void test_fmmus_and_sync_managers_are_those_of_the_device(void)
{
    const cm1e_device_options_t options = {0};
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
static unsigned check_pdos(const cm1e_device_options_t *options, bool transmit, unsigned sync_manager)
{
    unsigned bytes, bits = 0, number = 0;
    const uint8_t *begin = category(transmit ? 50 : 51, &bytes), *p = begin;
    TEST_ASSERT_NOT_NULL(begin);
    for (; p < begin + bytes; number++) {
        cm1e_pdo_t pdo;
        cm1e_device_pdo(&pdo, (cm1e_mapping_t)number, transmit, options->order,
                        cm1e_firmware_from_version(*options->firmware ? options->firmware : "1.3.5")->firmware);
        TEST_ASSERT_EQUAL_HEX16(pdo.index, cm1e_get_u16(p));
        TEST_ASSERT_EQUAL_UINT8(pdo.entry_count, p[2]);
        TEST_ASSERT_EQUAL_HEX8(number == (unsigned)options->mapping ? sync_manager : 0xFF, p[3]);
        TEST_ASSERT_EQUAL_STRING(pdo.name, string(p[5]));
        TEST_ASSERT_EQUAL_HEX16(p[3] == sync_manager ? 0x0012 : 0x0010, cm1e_get_u16(p + 6)); /* default, fixed */
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
                cm1e_device_options_t options = {.order = (cm1e_pdo_order_t)order, .mapping = (cm1e_mapping_t)mapping,
                                                 .distributed_clocks = mapping % 2 == 1};
                strcpy(options.firmware, version_of(f));
                generate(&options);
                unsigned bytes;
                const uint8_t *sm = category(41, &bytes);
                TEST_ASSERT_EQUAL_UINT(check_pdos(&options, false, 2), 8u * cm1e_get_u16(sm + 16 + 2));
                TEST_ASSERT_EQUAL_UINT(check_pdos(&options, true, 3), 8u * cm1e_get_u16(sm + 24 + 2));
            }
}

static void test_default_mapping_has_13_and_21_bytes(void)
{
    const cm1e_device_options_t options = {0};
    generate(&options);
    TEST_ASSERT_EQUAL_UINT(13 * 8, check_pdos(&options, false, 2));
    TEST_ASSERT_EQUAL_UINT(21 * 8, check_pdos(&options, true, 3));
}

static void test_dc_modes_are_there_on_request(void)
{
    cm1e_device_options_t options = {0};
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
    TEST_ASSERT_EQUAL_STRING("DC Synchronous", string(dc[24 + 18]));
}

static void test_images_are_reproducible_and_end_in_empty_cells(void)
{
    const cm1e_device_options_t options = {.firmware = "1.3.4", .distributed_clocks = true};
    uint8_t first[CM1E_SII_SIZE];
    generate(&options);
    memcpy(first, image, sizeof first);
    generate(&options);
    TEST_ASSERT_EQUAL_MEMORY(first, image, sizeof first);
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, cm1e_get_u32(image + sizeof image - 4));
}

static void test_io_module_has_a_byte_each_way_and_no_mailbox(void)
{
    cm1e_describe_io_module(&file);
    write(&file.devices.at[0]);
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

/* ---- descriptions from elsewhere -------------------------------------------------------------------------------- */

/* What an ESI leaves open follows from the rest. */
static void test_what_is_not_stated_follows_from_the_sync_managers(void)
{
    cm1e_description_t *device = describe(&(cm1e_device_options_t){0});
    device->eeprom = (cm1e_described_eeprom_t){.alias = 7};
    for (size_t i = 0; i < 4; i++) {
        device->sync_managers.at[i].length_given = i < 2;
        if (i >= 2)
            device->sync_managers.at[i].length = 0;
    }
    write(device);
    static const uint16_t mailboxes[] = {0x1000, 128, 0x1080, 128};
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX16(0, word(0x14 + i));
        TEST_ASSERT_EQUAL_HEX16(mailboxes[i], word(0x18 + i));
    }
    unsigned bytes;
    const uint8_t *sm = category(41, &bytes);
    TEST_ASSERT_EQUAL_UINT16(13, cm1e_get_u16(sm + 16 + 2));
    TEST_ASSERT_EQUAL_UINT16(21, cm1e_get_u16(sm + 24 + 2));
    TEST_ASSERT_EQUAL_UINT16(7, word(4));
    TEST_ASSERT_EQUAL_UINT16(15, word(0x3E));
    TEST_ASSERT_EQUAL_UINT16(1, word(0x3F));
}

static void test_names_are_written_in_iso_8859_1(void)
{
    cm1e_description_t *device = describe(&(cm1e_device_options_t){0});
    device->type = "";
    device->name = "\xC2\xB5m \xC3\xBC \xCE\xA9 \xF0\x9F\x98\x80 \t\xFF \xC2"; /* µm ü Ω, a face, no UTF-8 */
    device->group = device->name;
    write(device);
    TEST_ASSERT_EQUAL_STRING("\xB5m \xFC ? ? ?? ?", string(1));
    unsigned bytes;
    const uint8_t *general = category(30, &bytes);
    TEST_ASSERT_EQUAL_UINT8(1, general[0]);
    TEST_ASSERT_EQUAL_UINT8(0, general[2]);
    TEST_ASSERT_EQUAL_UINT8(1, general[3]);
}

static void test_ports_are_those_of_the_physics(void)
{
    static const struct {
        const char *physics;
        uint16_t ports;
    } cases[] = {{"YY", 0x0011}, {"KYKH", 0x4313}, {" K", 0x0030}, {"Y?Y", 0x0101},
                 {"", 0},        {NULL, 0},        {"YYYYYY", 0x1111}};
    cm1e_description_t *device = describe(&(cm1e_device_options_t){0});
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        unsigned bytes;
        device->physics = cases[i].physics;
        write(device);
        TEST_ASSERT_EQUAL_HEX16(cases[i].ports, cm1e_get_u16(category(30, &bytes) + 16));
    }
}

/* SOEM takes for granted that a category of PDOs has one. */
static void test_what_a_device_lacks_has_no_category(void)
{
    cm1e_description_t *device = describe(&(cm1e_device_options_t){0});
    device->pdos.count = 4; /* the RxPDOs */
    device->fmmus.count = device->sync_managers.count = 0;
    write(device);
    unsigned bytes;
    TEST_ASSERT_NULL(category(50, &bytes));
    TEST_ASSERT_NULL(category(40, &bytes));
    TEST_ASSERT_NULL(category(41, &bytes));
    TEST_ASSERT_NOT_NULL(category(51, &bytes));
}

/* ---- what the format has no room for ---------------------------------------------------------------------------- */

static char long_name[400];

static void too_many_names(cm1e_description_t *device)
{
    static char names[300][16];
    for (int i = 0; i < 300; i++) {
        cm1e_described_pdo_entry_t *entry = CM1E_APPEND(&file.arena, &device->pdos.at[i / 100].entries);
        snprintf(names[i], sizeof names[i], "n%d", i);
        *entry = (cm1e_described_pdo_entry_t){.bits = 8, .name = names[i], .type = ""};
    }
}
static void too_many_entries(cm1e_description_t *device)
{
    for (int i = 0; i < 256; i++)
        *(cm1e_described_pdo_entry_t *)CM1E_APPEND(&file.arena, &device->pdos.at[0].entries) =
            (cm1e_described_pdo_entry_t){.bits = 8, .type = ""};
}
static void too_many_pdos(cm1e_description_t *device)
{
    for (int i = 0; i < 17000; i++)
        *(cm1e_described_pdo_t *)CM1E_APPEND(&file.arena, &device->pdos) = (cm1e_described_pdo_t){.name = ""};
    device->eeprom.byte_size = CM1E_SII_SIZE;
}
static void too_many_bytes(cm1e_description_t *device)
{
    for (int i = 0; i < 200; i++)
        *(cm1e_described_pdo_t *)CM1E_APPEND(&file.arena, &device->pdos) = (cm1e_described_pdo_t){.name = ""};
}
static void long_names(cm1e_description_t *device)
{
    memset(long_name, 'x', 256);
    device->name = long_name;
}
static void wide_entry(cm1e_description_t *device) { device->pdos.at[1].entries.at[1].bits = 256; }
static void odd_sync_manager(cm1e_description_t *device) { device->pdos.at[1].sync_manager = 255; }
static void negative_sync_manager(cm1e_description_t *device) { device->pdos.at[1].sync_manager = -2; }
static void odd_size(cm1e_description_t *device) { device->eeprom.byte_size = 2047; }
static void huge_size(cm1e_description_t *device) { device->eeprom.byte_size = 0xFFFFFF80; }
static void small_size(cm1e_description_t *device) { device->eeprom.byte_size = 128; }
static void large_factor(cm1e_description_t *device) { device->dc_modes.at[1].sync0_factor = 32768; }
static void small_factor(cm1e_description_t *device) { device->dc_modes.at[1].sync1_factor = -32769; }
static void long_sync_manager(cm1e_description_t *device)
{
    cm1e_described_pdo_t wide = {.name = "", .sync_manager = 2};
    for (int i = 0; i < 255; i++)
        *(cm1e_described_pdo_entry_t *)CM1E_APPEND(&file.arena, &wide.entries) =
            (cm1e_described_pdo_entry_t){.bits = 255, .type = ""};
    for (int i = 0; i < 9; i++)
        *(cm1e_described_pdo_t *)CM1E_APPEND(&file.arena, &device->pdos) = wide;
    device->sync_managers.at[2].length_given = false;
}

static void test_what_does_not_fit_is_refused_with_the_reason(void)
{
    static const struct {
        void (*spoil)(cm1e_description_t *device);
        const char *reason;
    } cases[] = {
        {too_many_names, "more than 255 different names"},
        {too_many_entries, "PDO 0x1600 has 261 entries; the format has room for 255"},
        {too_many_pdos, "a category would have"},
        {too_many_bytes, "bytes; its EEPROM has 2048"},
        {long_names, "has more than 255 letters"},
        {wide_entry, "PDO 0x1601 maps 0x60FE:0 with 256 bits"},
        {odd_sync_manager, "PDO 0x1601 is carried by sync manager 255"},
        {negative_sync_manager, "PDO 0x1601 is carried by sync manager -2"},
        {odd_size, "has 2047 bytes; expected a multiple of 128"},
        {huge_size, "at most 8 MiB"},
        {small_size, "its EEPROM has 128"},
        {large_factor, "factor 32768 of the DC mode DC Synchronous"},
        {small_factor, "factor -32769"},
        {long_sync_manager, "sync manager 2 carries"},
    };
    static const cm1e_device_options_t options = {.distributed_clocks = true};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cm1e_description_t *device = describe(&options);
        cases[i].spoil(device);
        diag = (cm1e_diag_t){0};
        TEST_ASSERT_EQUAL_size_t_MESSAGE(0, cm1e_sii_write(image, sizeof image, device, &diag), cases[i].reason);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, diag.error);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, cases[i].reason), diag.text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_checksum_is_that_of_published_images);
    RUN_TEST(test_a_room_too_small_is_left_alone);
    RUN_TEST(test_header_says_who_and_where_the_mailboxes_are);
    RUN_TEST(test_revision_follows_the_firmware);
    RUN_TEST(test_string_1_is_the_order_number);
    RUN_TEST(test_general_tells_what_the_mailbox_can);
    RUN_TEST(test_fmmus_and_sync_managers_are_those_of_the_device);
    RUN_TEST(test_every_choice_gives_the_pdos_of_the_device_tables);
    RUN_TEST(test_default_mapping_has_13_and_21_bytes);
    RUN_TEST(test_dc_modes_are_there_on_request);
    RUN_TEST(test_images_are_reproducible_and_end_in_empty_cells);
    RUN_TEST(test_io_module_has_a_byte_each_way_and_no_mailbox);
    RUN_TEST(test_what_is_not_stated_follows_from_the_sync_managers);
    RUN_TEST(test_names_are_written_in_iso_8859_1);
    RUN_TEST(test_ports_are_those_of_the_physics);
    RUN_TEST(test_what_a_device_lacks_has_no_category);
    RUN_TEST(test_what_does_not_fit_is_refused_with_the_reason);
    return UNITY_END();
}
