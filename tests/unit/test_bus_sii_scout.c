/* What the search for a slave reads of its SII: identity, mailbox, sync managers, and the bits of each of them. */
#include <string.h>

#include "bus/eeprom_interface.h"
#include "bus/sii_scout.h"
#include "core/bytes.h"
#include "description/sii_image.h"
#include "unity.h"

enum { SYNC_MANAGERS = 41, TX_PDO = 50, RX_PDO = 51, END = 0xFFFF, UNASSIGNED = 0xFF };

static uint8_t sii[1024];
static size_t used, category_at;
static cm1e_scout_t scout;
static const uint16_t mailbox[5] = {0x1000, 128, 0x1080, 192, 0x000C}; /* out, in, and the protocols */
static uint32_t end_at; /* a word beyond the image that ends it */
static enum { OF_PROCESSOR, FORCED, OF_MASTER } access; /* to the EEPROM */
static unsigned errors_left, nacks_left, busy_left, clears; /* what the interface does wrong; commands that clear errors */

/* ---- an image ---------------------------------------------------------------------------------------------------- */

static void put_u16(unsigned value)
{
    cm1e_put_u16(sii + used, (uint16_t)value);
    used += 2;
}

static void category(unsigned type)
{
    category_at = used;
    put_u16(type);
    put_u16(0);
}

static void category_ends(void) { cm1e_put_u16(sii + category_at + 2, (uint16_t)((used - category_at - 4) / 2)); }

static void pdo(unsigned index, unsigned entries, unsigned sync_manager)
{
    put_u16(index);
    put_u16(entries | sync_manager << 8);
    put_u16(0);
    put_u16(0);
}

static void entry(unsigned bits)
{
    put_u16(0x6000);
    put_u16(1);
    put_u16(bits << 8); /* data type, bits */
    put_u16(0);
}

void setUp(void)
{
    errors_left = nacks_left = busy_left = clears = 0;
    memset(sii, 0, sizeof sii);
    cm1e_put_u32(sii + CM1E_SII_VENDOR, 0x1234);
    cm1e_put_u32(sii + CM1E_SII_PRODUCT, 0x56789ABC);
    cm1e_put_u32(sii + CM1E_SII_PRODUCT + 4, 0x00010002);
    cm1e_put_u32(sii + CM1E_SII_SERIAL, 77);
    for (unsigned n = 0; n < 5; n++)
        cm1e_put_u16(sii + CM1E_SII_MAILBOX + 2 * n, mailbox[n]);
    cm1e_put_u16(sii + CM1E_SII_KBIT, 15);
    cm1e_put_u16(sii + CM1E_SII_KBIT + 2, 1); /* its version */
    used = CM1E_SII_HEADER_BYTES;
    end_at = 0;
    access = OF_PROCESSOR;
}
void tearDown(void) {}

/* ---- the memory -------------------------------------------------------------------------------------------------- */

/** Status of the interface, before a command and after it. */
static uint16_t status_now(bool after_command)
{
    if (busy_left > 0) {
        busy_left--;
        return EEPROM_BUSY;
    }
    if (!after_command)
        return errors_left > 0 ? EEPROM_NACK : 0;
    nacks_left -= nacks_left > 0;
    return nacks_left > 0 ? EEPROM_NACK : 0;
}

static void answer(cm1e_datagram_t *d)
{
    static uint32_t word;
    d->working_counter = 1;
    TEST_ASSERT_EQUAL_HEX16(0x1001, d->address);
    if (d->offset == REG_EEPROM_CONFIG) { /* first taken by force, which ends an access of the processor */
        TEST_ASSERT_TRUE(d->command == COMMAND_FPWR && d->length == 1 && access != OF_MASTER);
        TEST_ASSERT_EQUAL(access == OF_PROCESSOR ? CONFIG_FORCE : CONFIG_MASTER, d->data[0]);
        access++;
        return;
    }
    TEST_ASSERT_EQUAL(OF_MASTER, access);
    TEST_ASSERT_EQUAL_HEX16(REG_EEPROM_CONTROL, d->offset);
    TEST_ASSERT_TRUE(d->length == 2 || d->length == (d->command == COMMAND_FPRD ? EEPROM_GROUP_AT + 8 : EEPROM_GROUP_AT));
    if (d->command == COMMAND_FPWR && d->length > 2) {
        TEST_ASSERT_EQUAL_HEX16(EEPROM_READ, cm1e_get_u16(d->data));
        word = cm1e_get_u32(d->data + 2);
    } else if (d->command == COMMAND_FPWR) {
        TEST_ASSERT_EQUAL_HEX16(EEPROM_NOP, cm1e_get_u16(d->data));
        clears++;
        errors_left -= errors_left > 0;
    }
    if (d->command != COMMAND_FPRD)
        return;
    memset(d->data, 0, d->length);
    cm1e_put_u16(d->data, status_now(d->length > EEPROM_GROUP_AT));
    if (d->length > EEPROM_GROUP_AT && 2 * word + 4 <= sizeof sii)
        memcpy(d->data + EEPROM_GROUP_AT, sii + 2 * word, 4);
    else if (d->length > EEPROM_GROUP_AT && word == end_at)
        cm1e_put_u16(d->data + EEPROM_GROUP_AT, END);
}

/** Every datagram takes a nanosecond. */
static void read_without_end(void)
{
    cm1e_scout_begin(&scout, 0x1001, 1000000);
    for (int64_t now_ns = 0; !cm1e_scout_idle(&scout); now_ns++) {
        cm1e_datagram_t d;
        memset(&d, 0x55, sizeof d);
        if (!cm1e_scout_next(&scout, &d, now_ns))
            break;
        answer(&d);
        cm1e_scout_result(&scout, &d);
    }
    cm1e_datagram_t none;
    TEST_ASSERT_FALSE(cm1e_scout_next(&scout, &none, 0));
}

static void read_all(void)
{
    put_u16(END);
    read_without_end();
}

/* ---- what was read ----------------------------------------------------------------------------------------------- */

static void test_the_bits_of_several_pdos_are_added_by_sync_manager(void)
{
    category(TX_PDO);
    pdo(0x1A00, 1, 3);
    entry(1);
    pdo(0x1A01, 3, 3);
    entry(16);
    entry(32);
    entry(7);
    pdo(0x1A02, 0, 3);
    pdo(0x1A03, 1, UNASSIGNED);
    entry(64);
    pdo(0x1A04, 1, 1);
    entry(8);
    category_ends();
    category(30); /* something else */
    put_u16(0x0102);
    category_ends();
    category(RX_PDO);
    pdo(0x1600, 2, 2);
    entry(16);
    entry(16);
    pdo(0x1602, 1, CM1E_SII_SYNC_MANAGERS); /* beyond the last one */
    entry(128);
    pdo(0x1601, 3, 2);
    entry(4);
    entry(2);
    entry(1);
    category_ends();
    category(31); /* something else that looks like a PDO */
    pdo(0x1603, 1, 2);
    entry(32);
    category_ends();
    read_all();
    TEST_ASSERT_TRUE(scout.good);
    const uint16_t inputs[] = {0, 8, 0, 1 + 16 + 32 + 7}, outputs[] = {0, 0, 16 + 16 + 4 + 2 + 1, 0};
    TEST_ASSERT_EQUAL_UINT16_ARRAY(inputs, scout.found.bits[1], 4);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(outputs, scout.found.bits[0], 4);
}

static void test_identity_and_sync_managers_are_found_wherever_the_category_is(void)
{
    category(TX_PDO);
    pdo(0x1A00, 1, 0);
    entry(8);
    category_ends();
    for (unsigned n = 0; n < 2; n++) { /* each in a category of its own */
        category(SYNC_MANAGERS);
        put_u16(0x1000 + 0x100 * n);
        put_u16(2 + n);
        put_u16(0x44);
        put_u16(1 | (3 + n) << 8);
        category_ends();
    }
    read_all();
    TEST_ASSERT_TRUE(scout.good);
    TEST_ASSERT_EQUAL_HEX32(0x1234, scout.found.vendor_id);
    TEST_ASSERT_EQUAL_HEX32(0x56789ABC, scout.found.product_code);
    TEST_ASSERT_EQUAL_HEX32(0x00010002, scout.found.revision);
    TEST_ASSERT_EQUAL_UINT32(77, scout.found.serial_number);
    TEST_ASSERT_EQUAL_HEX16(mailbox[0], scout.found.mailbox_out_start);
    TEST_ASSERT_EQUAL_UINT16(mailbox[1], scout.found.mailbox_out_length);
    TEST_ASSERT_EQUAL_HEX16(mailbox[2], scout.found.mailbox_in_start);
    TEST_ASSERT_EQUAL_UINT16(mailbox[3], scout.found.mailbox_in_length);
    TEST_ASSERT_EQUAL_HEX16(mailbox[4], scout.found.protocols);
    TEST_ASSERT_EQUAL_UINT8(2, scout.found.sync_manager_count);
    for (unsigned n = 0; n < 2; n++) {
        const cm1e_sii_sync_manager_t *manager = &scout.found.sync_managers[n];
        TEST_ASSERT_EQUAL_HEX16(0x1000 + 0x100 * n, manager->start);
        TEST_ASSERT_EQUAL_UINT16(2 + n, manager->length);
        TEST_ASSERT_EQUAL_HEX8(0x44, manager->control);
        TEST_ASSERT_EQUAL_HEX8(1, manager->enable);
        TEST_ASSERT_EQUAL_UINT8(3 + n, manager->use);
    }
}

/* The category that was begun has so many bits, and the one behind it is read as it is. */
static void expect_before_another_category(uint16_t bits)
{
    category_ends();
    category(RX_PDO);
    pdo(0x1600, 1, 2);
    entry(16);
    category_ends();
    read_all();
    TEST_ASSERT_TRUE(scout.good);
    TEST_ASSERT_EQUAL_UINT16(bits, scout.found.bits[1][3]);
    TEST_ASSERT_EQUAL_UINT16(16, scout.found.bits[0][2]);
}

/* A number of entries is not trusted beyond its category. */
static void test_entries_that_are_not_there_are_not_counted(void)
{
    category(TX_PDO);
    pdo(0x1A00, 200, 3);
    entry(8);
    expect_before_another_category(8);
}

/* Not even the first one, where the category ends behind the PDO. */
static void test_an_entry_behind_its_category_is_not_counted(void)
{
    category(TX_PDO);
    pdo(0x1A00, 1, 3);
    expect_before_another_category(0);
}

static void test_more_sync_managers_than_there_is_room_for_are_passed_over(void)
{
    category(SYNC_MANAGERS);
    for (unsigned n = 0; n < CM1E_SII_SYNC_MANAGERS + 3; n++) {
        put_u16(0x1000 + n);
        put_u16(n);
        put_u16(0x44);
        put_u16(1);
    }
    category_ends();
    category(RX_PDO);
    pdo(0x1600, 1, 2);
    entry(16);
    category_ends();
    read_all();
    TEST_ASSERT_TRUE(scout.good);
    TEST_ASSERT_EQUAL_UINT8(CM1E_SII_SYNC_MANAGERS, scout.found.sync_manager_count);
    TEST_ASSERT_EQUAL_HEX16(0x1000 + CM1E_SII_SYNC_MANAGERS - 1,
                            scout.found.sync_managers[CM1E_SII_SYNC_MANAGERS - 1].start);
    TEST_ASSERT_EQUAL_UINT16(16, scout.found.bits[0][2]);
}

/* ---- an SII that does not end, an interface that does not work --------------------------------------------------- */

static void test_a_category_that_is_larger_than_any_eeprom_is_no_good_sii(void)
{
    category(TX_PDO);
    pdo(0x1A00, 1, 3);
    entry(8);
    category_ends();
    cm1e_put_u16(sii + category_at + 2, 0x2000);
    read_all();
    TEST_ASSERT_FALSE(scout.good);
    TEST_ASSERT_TRUE(scout.reads < 20);
}

/* The largest one ends at word 0x2000. */
static void test_a_category_may_reach_up_to_the_largest_eeprom(void)
{
    for (unsigned more = 0; more < 4; more++) {
        setUp();
        category(30);
        const unsigned place = (unsigned)category_at / 2;
        end_at = 0x2000 + more;
        cm1e_put_u16(sii + category_at + 2, (uint16_t)(end_at - place - 2));
        read_without_end();
        TEST_ASSERT_EQUAL(more == 0, scout.good);
    }
}

/* Empty categories all the way: behind the image there are zeros, and they go up to the largest word. */
static void test_categories_that_never_end_are_no_good_sii(void)
{
    category(30);
    category_ends();
    read_without_end();
    TEST_ASSERT_FALSE(scout.good);
    TEST_ASSERT_EQUAL_UINT(1500, scout.reads);
}

static void a_small_sii(void)
{
    category(RX_PDO);
    pdo(0x1600, 1, 2);
    entry(16);
    category_ends();
}

static void check_small_sii(void)
{
    TEST_ASSERT_TRUE(scout.good);
    TEST_ASSERT_EQUAL_HEX32(0x56789ABC, scout.found.product_code);
    TEST_ASSERT_EQUAL_UINT16(16, scout.found.bits[0][2]);
}

static void test_errors_of_the_interface_are_cleared_before_the_first_command(void)
{
    a_small_sii();
    errors_left = 1;
    read_all();
    check_small_sii();
    TEST_ASSERT_EQUAL_UINT(1, clears);
}

static void test_words_that_were_not_acknowledged_are_read_again(void)
{
    for (unsigned n = 2; n < 6; n++) {
        setUp();
        a_small_sii();
        nacks_left = n;
        read_all();
        check_small_sii();
        TEST_ASSERT_EQUAL_UINT(n - 1, clears);
    }
}

static void test_an_interface_that_never_works_ends_at_the_deadline(void)
{
    unsigned *const faults[] = {&nacks_left, &busy_left};
    for (int n = 0; n < 2; n++) {
        setUp();
        a_small_sii();
        *faults[n] = UINT32_MAX;
        read_all();
        TEST_ASSERT_FALSE(scout.good);
        TEST_ASSERT_EQUAL_UINT(0, scout.reads);
        cm1e_datagram_t d;
        cm1e_scout_begin(&scout, 0x1001, 1000);
        TEST_ASSERT_TRUE(cm1e_scout_next(&scout, &d, 999));
        TEST_ASSERT_FALSE(cm1e_scout_next(&scout, &d, 1000));
        TEST_ASSERT_TRUE(cm1e_scout_idle(&scout));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_bits_of_several_pdos_are_added_by_sync_manager);
    RUN_TEST(test_identity_and_sync_managers_are_found_wherever_the_category_is);
    RUN_TEST(test_entries_that_are_not_there_are_not_counted);
    RUN_TEST(test_an_entry_behind_its_category_is_not_counted);
    RUN_TEST(test_more_sync_managers_than_there_is_room_for_are_passed_over);
    RUN_TEST(test_a_category_that_is_larger_than_any_eeprom_is_no_good_sii);
    RUN_TEST(test_a_category_may_reach_up_to_the_largest_eeprom);
    RUN_TEST(test_categories_that_never_end_are_no_good_sii);
    RUN_TEST(test_errors_of_the_interface_are_cleared_before_the_first_command);
    RUN_TEST(test_words_that_were_not_acknowledged_are_read_again);
    RUN_TEST(test_an_interface_that_never_works_ends_at_the_deadline);
    return UNITY_END();
}
