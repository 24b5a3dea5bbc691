/* What the bus takes from a slave's SII: all that it needs of a good one, and nothing in a bad one leads it astray. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "bus/sii_reader.h"
#include "cm1e/io.h"
#include "core/bytes.h"

enum { BYTES = 0x8000 };
static uint8_t image[BYTES];
static size_t end;             /* bytes written */
static unsigned reads, fail_at; /* fail_at 0: never */
static cm1e_sii_t sii;
static bool brief;

/* In pairs, as an EEPROM is read. */
static bool read_image(void *context, uint16_t word, uint16_t count, uint8_t *bytes)
{
    (void)context;
    TEST_ASSERT_EQUAL_UINT(0, count % 2);
    for (unsigned i = 0; i < 2u * count; i++) {
        if (i % 4 == 0 && ++reads == fail_at)
            return false;
        bytes[i] = 2u * word + i < BYTES ? image[2u * word + i] : 0xFF;
    }
    return true;
}

static void put_category(uint16_t type, const void *bytes, uint16_t words)
{
    cm1e_put_u16(image + end, type);
    cm1e_put_u16(image + end + 2, words);
    memcpy(image + end + 4, bytes, 2u * words);
    end += 4u + 2u * words;
}

void setUp(void)
{
    memset(image, 0xFF, sizeof image);
    memset(image, 0, 0x80);
    end = 0x80;
    reads = fail_at = 0;
    brief = false;
    cm1e_put_u32(image + 0x10, 0x00004441);
    cm1e_put_u32(image + 0x14, 0x44412002);
    cm1e_put_u32(image + 0x18, 0x20020103);
    cm1e_put_u32(image + 0x1C, 12345);
    cm1e_put_u32(image + 0x30, 0x00801000);
    cm1e_put_u32(image + 0x34, 0x00901080);
    cm1e_put_u32(image + 0x38, 0x0004);
}
void tearDown(void) { cm1e_sii_free(&sii); }

static cm1e_sii_result_t parse(void)
{
    cm1e_sii_free(&sii);
    const cm1e_sii_result_t result = cm1e_sii_read_header(&sii, read_image, NULL);
    return result == SII_OK ? cm1e_sii_read_categories(&sii, brief, read_image, NULL) : result;
}

static void put_good_categories(void)
{
    static const char strings[] = "\003\005ORDER\004name\003abc";
    static const uint8_t general[32] = {0, 0, 1, 2, 0, 0x23, 0, 0, 0, 0, 0, 0x02};
    static const uint8_t managers[32] = {0x00, 0x10, 0x80, 0, 0x26, 0, 1, 1, 0x80, 0x10, 0x80, 0, 0x22, 0, 1, 2,
                                         0x00, 0x11, 13, 0, 0x64, 0, 1, 3, 0x00, 0x14, 21, 0, 0x20, 0, 1, 4};
    static const uint8_t tx[8 + 16 + 8] = {0x00, 0x1A, 2, 3, 0, 0, 0, 0, 0x41, 0x60, 0, 0, 6, 16, 0, 0,
                                           0x64, 0x60, 0, 0, 4, 32, 0, 0, 0x01, 0x1A, 0, 0xFF, 0, 0, 0, 0};
    static const uint8_t rx[8 + 8] = {0x00, 0x16, 1, 2, 0, 0, 0, 0, 0x40, 0x60, 0, 0, 6, 16, 0, 0};
    put_category(10, strings, 8);
    put_category(60, tx, 3); /* one that nobody wants */
    put_category(30, general, 16);
    put_category(41, managers, 16);
    put_category(50, tx, 16);
    put_category(51, rx, 8);
}

static void test_good_image_gives_everything(void)
{
    put_good_categories();
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_HEX32(0x4441, sii.vendor_id);
    TEST_ASSERT_EQUAL_HEX32(0x44412002, sii.product_code);
    TEST_ASSERT_EQUAL_HEX32(0x20020103, sii.revision);
    TEST_ASSERT_EQUAL_UINT32(12345, sii.serial_number);
    TEST_ASSERT_EQUAL_HEX16(0x1000, sii.mailbox_out_start);
    TEST_ASSERT_EQUAL_HEX16(0x80, sii.mailbox_out_length);
    TEST_ASSERT_EQUAL_HEX16(0x1080, sii.mailbox_in_start);
    TEST_ASSERT_EQUAL_HEX16(0x90, sii.mailbox_in_length);
    TEST_ASSERT_TRUE(sii.coe && !sii.foe);
    TEST_ASSERT_EQUAL_STRING("name", sii.name);
    TEST_ASSERT_TRUE(sii.complete_access);
    TEST_ASSERT_NOT_NULL(sii.signals); /* 0x1A01 has no sync manager */
    TEST_ASSERT_EQUAL_UINT32(3, sii.signals->count);
    const cm1e_sii_signal_t *second = &sii.signals->at[1];
    TEST_ASSERT_EQUAL_HEX16(0x6064, second->index);
    TEST_ASSERT_EQUAL_UINT32(16, second->bit_offset);
    TEST_ASSERT_EQUAL_UINT16(32, second->bits);
    TEST_ASSERT_EQUAL_INT(CM1E_IO_DINT, second->type);
    TEST_ASSERT_TRUE(second->input);
    TEST_ASSERT_TRUE(sii.no_lrw);
    TEST_ASSERT_EQUAL_UINT8(4, sii.sync_manager_count);
    TEST_ASSERT_EQUAL_HEX16(0x1400, sii.sync_managers[3].start);
    TEST_ASSERT_EQUAL_UINT16(21, sii.sync_managers[3].length);
    TEST_ASSERT_EQUAL_HEX16(0x1000, sii.sync_managers[0].start);
    TEST_ASSERT_EQUAL_UINT8(1, sii.sync_managers[0].enable);
    TEST_ASSERT_EQUAL_UINT8(4, sii.sync_managers[3].use);
    TEST_ASSERT_EQUAL_HEX8(0x64, sii.sync_managers[2].control);
    TEST_ASSERT_EQUAL_UINT32(16, sii.bits[0][2]);
    TEST_ASSERT_EQUAL_UINT32(48, sii.bits[1][3]);
    TEST_ASSERT_EQUAL_UINT32(0, sii.bits[0][3] + sii.bits[1][2]);
}

/* An entry without an index is a gap of so many bits. */
static void test_padding_is_no_signal_and_keeps_its_place(void)
{
    static const uint8_t managers[32] = {[24] = 0x00, 0x11, 2, 0, 0x20, 0, 1, 4};
    static const uint8_t tx[8 + 24] = {0x00, 0x1A, 3, 3, 0, 0, 0, 0, 0x00, 0x60, 1, 0, 1, 1, 0, 0,
                                       0x00, 0x00, 0, 0, 0, 7, 0, 0, 0x01, 0x60, 1, 0, 5, 8, 0, 0};
    put_category(41, managers, 16);
    put_category(50, tx, 16);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_NOT_NULL(sii.signals);
    TEST_ASSERT_EQUAL_UINT32(2, sii.signals->count);
    TEST_ASSERT_EQUAL_HEX16(0x6000, sii.signals->at[0].index);
    TEST_ASSERT_EQUAL_HEX16(0x6001, sii.signals->at[1].index);
    TEST_ASSERT_EQUAL_UINT32(8, sii.signals->at[1].bit_offset);
    TEST_ASSERT_EQUAL_UINT32(16, sii.bits[1][3]);
}

/* Behind the bytes of a sync manager begin those of the next one. */
static void test_inputs_of_two_sync_managers_are_one_behind_the_other(void)
{
    static const uint8_t managers[32] = {[16] = 0x00, 0x11, 2, 0, 0x20, 0, 1, 4, 0x00, 0x12, 1, 0, 0x20, 0, 1, 4};
    static const uint8_t tx[32] = {0x00, 0x1A, 1, 2, 0, 0, 0, 0, 0x00, 0x60, 1, 0, 0, 11, 0, 0,
                                   0x01, 0x1A, 1, 3, 0, 0, 0, 0, 0x01, 0x60, 1, 0, 5, 8, 0, 0};
    put_category(41, managers, 16);
    put_category(50, tx, 16);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_NOT_NULL(sii.signals);
    TEST_ASSERT_EQUAL_UINT32(2, sii.signals->count);
    TEST_ASSERT_EQUAL_UINT32(0, sii.signals->at[0].bit_offset);
    TEST_ASSERT_EQUAL_UINT16(11, sii.signals->at[0].bits);
    TEST_ASSERT_EQUAL_UINT32(16, sii.signals->at[1].bit_offset);
}

/* PDOs of all kinds: what each entry is called, where it is, and which type it has. */
enum { NO_NAME = 0, INPUTS = 1, STATUS = 2, VALUE = 3, NOTHING = 4 };
static const char names[] = "\004\006Inputs\006Status\005Value\000";

static const struct {
    bool input;
    uint8_t sync_manager, name;
    struct {
        uint16_t index;
        uint8_t subindex, name, type, bits;
    } entries[4];
} pdos[] = {
    {true, 3, INPUTS, {{0x6000, 1, STATUS, 0x01, 1}, {0, 0, NO_NAME, 0, 3}, {0x6000, 2, NO_NAME, 0x05, 8}}},
    {true, 0, NO_NAME, {{0x6010, 1, VALUE, 0x02, 8}, {0x6010, 2, NO_NAME, 0x03, 16}}}, /* in front of the others */
    {true, 7, NOTHING, {{0x6020, 1, VALUE, 0x04, 32}, {0x6020, 2, NOTHING, 0x08, 32}}},
    {true, 8, INPUTS, {{0x6030, 1, VALUE, 0x05, 8}}}, /* sync managers that there are not */
    {true, 0xFF, INPUTS, {{0x6031, 1, VALUE, 0x05, 8}}},
    {true, 3, STATUS, {{0x6040, 0, VALUE, 0x11, 64}, {0x6041, 0, VALUE, 0x15, 64}, {0x6042, 0, VALUE, 0x03, 8}}},
    {false, 2, INPUTS, {{0x7000, 1, STATUS, 0x06, 16}, {0, 7, NO_NAME, 0, 16}, {0x7000, 3, STATUS, 0x07, 32}}},
    {false, 0, INPUTS, {{0x7010, 1, STATUS, 0x05, 5}}},
};
static const struct {
    uint16_t index;
    uint8_t subindex;
    uint16_t bits;
    uint32_t bit_offset;
    cm1e_io_type_t type;
    const char *name;
} signals[] = {
    {0x6000, 1, 1, 24, CM1E_IO_BOOL, "Inputs Status"}, {0x6000, 2, 8, 28, CM1E_IO_USINT, "Inputs"},
    {0x6010, 1, 8, 0, CM1E_IO_SINT, "Value"}, {0x6010, 2, 16, 8, CM1E_IO_INT, ""},
    {0x6020, 1, 32, 24 + 152, CM1E_IO_DINT, "Value"}, {0x6020, 2, 32, 24 + 184, CM1E_IO_REAL, ""},
    {0x6040, 0, 64, 36, CM1E_IO_LREAL, "Status Value"}, {0x6041, 0, 64, 100, CM1E_IO_LINT, "Status Value"},
    {0x6042, 0, 8, 164, CM1E_IO_USINT, "Status Value"}, /* an INT has not 8 bits */
    {0x7000, 1, 16, 8, CM1E_IO_UINT, "Inputs Status"}, {0x7000, 3, 32, 40, CM1E_IO_UDINT, "Inputs Status"},
    {0x7010, 1, 5, 0, CM1E_IO_USINT, "Inputs Status"},
};

static void put_pdos(bool input)
{
    uint8_t bytes[8 * 40] = {0};
    size_t used = 0;
    for (size_t i = 0; i < sizeof pdos / sizeof pdos[0]; i++) {
        if (pdos[i].input != input)
            continue;
        uint8_t *pdo = bytes + used;
        cm1e_put_u16(pdo, (uint16_t)((input ? 0x1A00 : 0x1600) + i));
        pdo[3] = pdos[i].sync_manager;
        pdo[5] = pdos[i].name;
        for (used += 8; pdo[2] < 4 && pdos[i].entries[pdo[2]].bits; used += 8) {
            uint8_t *entry = bytes + used;
            cm1e_put_u16(entry, pdos[i].entries[pdo[2]].index);
            entry[2] = pdos[i].entries[pdo[2]].subindex;
            entry[3] = pdos[i].entries[pdo[2]].name;
            entry[4] = pdos[i].entries[pdo[2]].type;
            entry[5] = pdos[i].entries[pdo[2]].bits;
            pdo[2]++;
        }
    }
    put_category(input ? 50 : 51, bytes, (uint16_t)(used / 2));
}

static void test_every_signal_has_its_place_its_name_and_its_type(void)
{
    static const uint32_t bits[2][8] = {{5, 0, 64}, {24, 0, 0, 12 + 136, 0, 0, 0, 64}};
    put_category(10, names, sizeof names / 2);
    put_pdos(true);
    put_pdos(false);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_NOT_NULL(sii.signals);
    TEST_ASSERT_EQUAL_UINT32(sizeof signals / sizeof signals[0], sii.signals->count);
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; i++) {
        const cm1e_sii_signal_t *signal = &sii.signals->at[i];
        TEST_ASSERT_EQUAL_HEX16(signals[i].index, signal->index);
        TEST_ASSERT_EQUAL_UINT8(signals[i].subindex, signal->subindex);
        TEST_ASSERT_EQUAL_UINT16(signals[i].bits, signal->bits);
        TEST_ASSERT_EQUAL_UINT32(signals[i].bit_offset, signal->bit_offset);
        TEST_ASSERT_EQUAL_INT(signals[i].type, signal->type);
        TEST_ASSERT_EQUAL_STRING(signals[i].name, signal->name);
        TEST_ASSERT_EQUAL_INT(signals[i].index < 0x7000, signal->input);
    }
    for (int direction = 0; direction < 2; direction++)
        TEST_ASSERT_EQUAL_UINT32_ARRAY(bits[direction], sii.bits[direction], 8);
}

/* The modes of a clock, with their names, in a whole and in a brief reading. More than there is room for are not kept. */
static void test_modes_of_the_clock_are_those_of_category_60(void)
{
    for (unsigned n = 0; n < 2 * 4; n++) {
        static const unsigned counts[] = {1, 2, CM1E_SII_DC_MODES, CM1E_SII_DC_MODES + 2};
        const unsigned count = counts[n / 2];
        uint8_t bytes[24 * (CM1E_SII_DC_MODES + 2)] = {0};
        setUp();
        brief = n % 2;
        for (unsigned i = 0; i < count; i++) {
            uint8_t *mode = bytes + 24 * i;
            cm1e_put_u32(mode, 1000000 + i); /* cycle and shift of SYNC0, shift of SYNC1 */
            cm1e_put_u32(mode + 4, 2000 + i);
            cm1e_put_u32(mode + 8, 3000 + i);
            cm1e_put_u16(mode + 12, (uint16_t)(2 + i)); /* factor of SYNC1 */
            cm1e_put_u16(mode + 14, (uint16_t)(0x0700 + i));
            cm1e_put_u16(mode + 16, (uint16_t)(5 + i));
            mode[18] = (uint8_t)(1 + i % 3);
        }
        put_category(60, bytes, (uint16_t)(12 * count));
        put_category(10, names, sizeof names / 2);
        TEST_ASSERT_EQUAL_INT(SII_OK, parse());
        TEST_ASSERT_EQUAL_UINT(count < CM1E_SII_DC_MODES ? count : CM1E_SII_DC_MODES, sii.dc_mode_count);
        for (unsigned i = 0; i < sii.dc_mode_count; i++) {
            static const char *const called[] = {"Inputs", "Status", "Value"};
            TEST_ASSERT_EQUAL_STRING(called[i % 3], sii.dc_modes[i].name);
            TEST_ASSERT_EQUAL_HEX16(0x0700 + i, sii.dc_modes[i].facts.assign_activate);
            TEST_ASSERT_EQUAL_INT(1000000 + i, sii.dc_modes[i].facts.sync0_cycle_ns);
            TEST_ASSERT_EQUAL_INT(2000 + i, sii.dc_modes[i].facts.sync0_shift_ns);
            TEST_ASSERT_EQUAL_INT(3000 + i, sii.dc_modes[i].facts.sync1_shift_ns);
            TEST_ASSERT_EQUAL_INT(2 + i, sii.dc_modes[i].facts.sync1_factor);
            TEST_ASSERT_EQUAL_INT(5 + i, sii.dc_modes[i].facts.sync0_factor);
        }
    }
}

/* The largest SII ends at word 0x2000; a category that ends there may be the last one. */
static void test_categories_may_reach_up_to_the_largest_sii(void)
{
    static uint8_t bytes[0x4000];
    for (unsigned more = 0; more < 3; more++) {
        setUp();
        put_category(30 + 100, bytes, (uint16_t)(0x2000 + more - (end / 2 + 2)));
        TEST_ASSERT_EQUAL_INT(more ? SII_DAMAGED : SII_OK, parse());
    }
    for (unsigned count = 62; count < 66; count++) { /* with the end mark 64 */
        setUp();
        for (unsigned n = 0; n < count; n++)
            put_category(130, bytes, 1);
        TEST_ASSERT_EQUAL_INT(count < 64 ? SII_OK : SII_DAMAGED, parse());
    }
}

static void test_read_that_fails_anywhere_is_reported(void)
{
    put_good_categories();
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    const unsigned last = reads;
    TEST_ASSERT_TRUE(last > 20);
    for (unsigned n = 1; n <= last; n++) {
        reads = 0;
        fail_at = n;
        TEST_ASSERT_EQUAL_INT_MESSAGE(SII_UNREADABLE, parse(), "a failed read went unnoticed");
        TEST_ASSERT_EQUAL_UINT(n, reads); /* and ended the reading */
    }
}

static void test_no_categories_at_all_is_a_slave_without_name(void)
{
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_STRING("", sii.name);
    TEST_ASSERT_EQUAL_UINT8(0, sii.sync_manager_count);
    cm1e_put_u16(image + 0x38, 0x0008); /* FoE alone */
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_TRUE(!sii.coe && sii.foe);
}

static void test_names_are_cut_and_cleaned(void)
{
    uint8_t strings[260] = {1, 255};
    memset(strings + 2, 'x', 255);
    strings[5] = '\n';
    strings[6] = 0x1B;
    strings[7] = 0x9B;
    put_category(10, strings, 130);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_size_t(CM1E_SII_NAME - 1, strlen(sii.name));
    TEST_ASSERT_EQUAL_STRING_LEN("xxx???xxx", sii.name, 9);
}

static void test_a_name_that_is_not_ascii_is_shown_as_it_is(void)
{
    put_category(10, "\001\005\xC4nd\xB5m", 4);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_STRING("\xC3\x84nd\xC2\xB5m", sii.name);
}

static void test_a_slave_without_name_shows_its_order_number(void)
{
    static const uint8_t general[32] = {0, 0, 1};
    put_category(10, "\001\005ORDER", 4);
    put_category(30, general, 16);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_STRING("ORDER", sii.name);
    TEST_ASSERT_FALSE(sii.complete_access);
    TEST_ASSERT_FALSE(sii.no_lrw);
}

/* It would cost the time of a scan. */
static void test_categories_that_nobody_reads_are_not_fetched(void)
{
    static uint8_t bytes[0x2000];
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    const unsigned before = reads;
    put_category(0x8001, bytes, 0x1000);
    reads = 0;
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_UINT(before + 1, reads);
}

/* Of a device whose mapping is asked for anyway. */
static void test_brief_reading_has_all_but_the_process_data(void)
{
    put_good_categories();
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    cm1e_sii_t whole = sii;
    const unsigned reads_of_whole = reads;
    sii.signals = NULL;
    brief = true;
    reads = 0;
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_STRING("name", sii.name);
    TEST_ASSERT_NULL(sii.signals);
    TEST_ASSERT_TRUE(reads + 10 < reads_of_whole);
    cm1e_sii_free(&whole);
    memset(whole.bits, 0, sizeof whole.bits);
    TEST_ASSERT_EQUAL_MEMORY(&whole, &sii, sizeof sii);
}

static void test_brief_reading_knows_names_as_the_whole_one_does(void)
{
    static const char strings[] = "\003\005ORDER\000\003abc"; /* number 2 is empty */
    for (uint8_t order = 0; order <= 4; order++)
        for (uint8_t name = 0; name <= 4; name++) {
            const uint8_t general[32] = {0, 0, order, name};
            char as_whole[CM1E_SII_NAME];
            setUp();
            put_category(30, general, 16); /* before what it refers to */
            put_category(10, strings, 6);
            TEST_ASSERT_EQUAL_INT(SII_OK, parse());
            memcpy(as_whole, sii.name, sizeof as_whole);
            brief = true;
            TEST_ASSERT_EQUAL_INT(SII_OK, parse());
            TEST_ASSERT_EQUAL_STRING(as_whole, sii.name);
        }
    setUp();
    put_category(10, strings, 6);
    brief = true;
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_STRING("ORDER", sii.name);
}

static void test_string_longer_than_its_category_ends_with_it(void)
{
    static const uint8_t strings[4] = {1, 200, 'a', 'b'};
    put_category(10, strings, 2);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_STRING("ab", sii.name);
}

static void test_lengths_that_lead_nowhere_are_damage(void)
{
    static const uint32_t headers[] = {0x00000000, 0x7FFC000A, 0xFFFE000A, 0xFFFF0001, 0x20000033, 0x80000033};
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; i++) {
        setUp();
        for (size_t place = 0x80; place + 4 <= BYTES; place += 4)
            cm1e_put_u32(image + place, headers[i]);
        TEST_ASSERT_EQUAL_INT(SII_DAMAGED, parse());
        TEST_ASSERT_TRUE(reads < 5000);
    }
}

static void test_more_sync_managers_and_entries_than_fit_are_bounded(void)
{
    static uint8_t bytes[4096];
    memset(bytes, 0x11, sizeof bytes);
    put_category(41, bytes, 1000);
    for (size_t i = 0; i < sizeof bytes; i += 8) {
        bytes[i + 2] = 255; /* entries */
        bytes[i + 3] = 7;
        bytes[i + 5] = 255; /* bits */
    }
    put_category(50, bytes, 2000);
    TEST_ASSERT_EQUAL_INT(SII_OK, parse());
    TEST_ASSERT_EQUAL_UINT8(CM1E_SII_SYNC_MANAGERS, sii.sync_manager_count);
    TEST_ASSERT_TRUE(sii.bits[1][7] > 0);
    TEST_ASSERT_TRUE(sii.bits[1][7] <= 255u * 4096);
}

static void test_random_images_end_within_bounds(void)
{
    const unsigned seed = 20250303;
    printf("seed %u\n", seed);
    srand(seed);
    for (int round = 0; round < 3000; round++) {
        setUp();
        put_good_categories();
        for (int n = rand() % 40; n >= 0; n--)
            image[rand() % 4 ? 0x80 + (unsigned)rand() % 0x200 : (unsigned)rand() % BYTES] = (uint8_t)rand();
        if (round % 3 == 0) {
            for (size_t i = 0x80; i < BYTES; i++)
                image[i] = (uint8_t)rand();
        }
        parse();
        TEST_ASSERT_TRUE(reads < 20000);
        TEST_ASSERT_TRUE(strlen(sii.name) < CM1E_SII_NAME);
        TEST_ASSERT_TRUE(sii.sync_manager_count <= CM1E_SII_SYNC_MANAGERS);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_good_image_gives_everything);
    RUN_TEST(test_padding_is_no_signal_and_keeps_its_place);
    RUN_TEST(test_inputs_of_two_sync_managers_are_one_behind_the_other);
    RUN_TEST(test_every_signal_has_its_place_its_name_and_its_type);
    RUN_TEST(test_modes_of_the_clock_are_those_of_category_60);
    RUN_TEST(test_categories_may_reach_up_to_the_largest_sii);
    RUN_TEST(test_read_that_fails_anywhere_is_reported);
    RUN_TEST(test_no_categories_at_all_is_a_slave_without_name);
    RUN_TEST(test_names_are_cut_and_cleaned);
    RUN_TEST(test_a_name_that_is_not_ascii_is_shown_as_it_is);
    RUN_TEST(test_a_slave_without_name_shows_its_order_number);
    RUN_TEST(test_categories_that_nobody_reads_are_not_fetched);
    RUN_TEST(test_brief_reading_has_all_but_the_process_data);
    RUN_TEST(test_brief_reading_knows_names_as_the_whole_one_does);
    RUN_TEST(test_string_longer_than_its_category_ends_with_it);
    RUN_TEST(test_lengths_that_lead_nowhere_are_damage);
    RUN_TEST(test_more_sync_managers_and_entries_than_fit_are_bounded);
    RUN_TEST(test_random_images_end_within_bounds);
    return UNITY_END();
}
