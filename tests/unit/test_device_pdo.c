#include <stdio.h>
#include <string.h>

#include "device/device.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

enum { MAPPINGS = 4, ORDERS = 2 };

static unsigned bytes_of(const cm1e_pdo_t *pdo)
{
    unsigned bits = 0;
    for (unsigned i = 0; i < pdo->entry_count; i++)
        bits += pdo->entries[i].bits;
    TEST_ASSERT_EQUAL(0, bits % 8);
    return bits / 8;
}

/* The objects in the order of the manual, as hexadecimal text "index:bits". */
static const struct {
    uint16_t index;
    cm1e_mapping_t mapping;
    bool transmit;
    unsigned bytes, bytes_before_1_3_0;
    const char *ug_4_4, *ug_7_2;
} manual[] = {
    {0x1600, CM1E_MAPPING_DYNAMIC, false, 13, 13, "6040:16 60FE:16 607A:32 60FF:32 6060:8 ",
     "6040:16 607A:32 60FF:32 60FE:16 6060:8 "},
    {0x1601, CM1E_MAPPING_CSP, false, 8, 8, "6040:16 60FE:16 607A:32 ", "6040:16 607A:32 60FE:16 "},
    {0x1602, CM1E_MAPPING_CSV, false, 8, 8, "6040:16 60FE:16 60FF:32 ", "6040:16 60FF:32 60FE:16 "},
    {0x1603, CM1E_MAPPING_PROFILE, false, 21, 20, "6040:16 60FE:16 607A:32 60FF:32 6081:32 6083:32 6060:8 ",
     "6040:16 60FE:16 607A:32 60FF:32 6081:32 6083:32 6060:8 "},
    {0x1A00, CM1E_MAPPING_DYNAMIC, true, 21, 21,
     "6041:16 603F:16 6064:32 606C:32 6077:16 60FD:16 2301:16 6079:16 6061:8 ",
     "6041:16 6064:32 606C:32 6077:16 60FD:16 603F:16 2301:16 6079:16 6061:8 "},
    {0x1A01, CM1E_MAPPING_CSP, true, 16, 16, "6041:16 603F:16 6064:32 6077:16 606C:32 60FD:16 ",
     "6041:16 6064:32 606C:32 6077:16 60FD:16 603F:16 "},
    {0x1A02, CM1E_MAPPING_CSV, true, 16, 16, "6041:16 603F:16 6064:32 6077:16 606C:32 60FD:16 ",
     "6041:16 6064:32 606C:32 6077:16 60FD:16 603F:16 "},
    {0x1A03, CM1E_MAPPING_PROFILE, true, 21, 20,
     "6041:16 603F:16 6064:32 606C:32 6077:16 60FD:16 2301:16 6079:16 6061:8 ",
     "6041:16 6064:32 606C:32 6077:16 60FD:16 603F:16 2301:16 6079:16 6061:8 "},
};
enum { ROWS = sizeof manual / sizeof manual[0] };

static void test_size_is_the_manuals_for_every_mapping_order_and_firmware(void)
{
    for (int row = 0; row < ROWS; row++)
        for (int order = 0; order < ORDERS; order++)
            for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++) {
                cm1e_pdo_t pdo;
                memset(&pdo, 0xA5, sizeof pdo);
                cm1e_device_pdo(&pdo, manual[row].mapping, manual[row].transmit, (cm1e_pdo_order_t)order,
                                (cm1e_firmware_t)firmware);
                TEST_ASSERT_EQUAL_HEX16(manual[row].index, pdo.index);
                TEST_ASSERT_EQUAL(firmware < CM1E_FIRMWARE_1_3_0 ? manual[row].bytes_before_1_3_0 : manual[row].bytes,
                                  bytes_of(&pdo));
            }
}

static void test_entries_are_the_manuals_in_both_orders(void)
{
    for (int row = 0; row < ROWS; row++)
        for (int order = 0; order < ORDERS; order++) {
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, manual[row].mapping, manual[row].transmit, (cm1e_pdo_order_t)order,
                            CM1E_FIRMWARE_1_3_5);
            char text[200] = "";
            for (unsigned i = 0; i < pdo.entry_count; i++) {
                TEST_ASSERT_EQUAL(0, pdo.entries[i].subindex);
                snprintf(text + strlen(text), sizeof text - strlen(text), "%04X:%u ", pdo.entries[i].index,
                         pdo.entries[i].bits);
            }
            TEST_ASSERT_EQUAL_STRING(order == CM1E_PDO_ORDER_UG_4_4 ? manual[row].ug_4_4 : manual[row].ug_7_2, text);
        }
}

static void test_old_profile_mapping_lacks_only_the_mode(void)
{
    for (int order = 0; order < ORDERS; order++)
        for (int transmit = 0; transmit < 2; transmit++) {
            cm1e_pdo_t old, new;
            cm1e_device_pdo(&old, CM1E_MAPPING_PROFILE, transmit, (cm1e_pdo_order_t)order, CM1E_FIRMWARE_1_2_0);
            cm1e_device_pdo(&new, CM1E_MAPPING_PROFILE, transmit, (cm1e_pdo_order_t)order, CM1E_FIRMWARE_1_3_0);
            TEST_ASSERT_EQUAL(new.entry_count - 1, old.entry_count);
            TEST_ASSERT_EQUAL_MEMORY(new.entries, old.entries, old.entry_count * sizeof old.entries[0]);
            TEST_ASSERT_EQUAL_HEX16(transmit ? 0x6061 : 0x6060, new.entries[old.entry_count].index);
            TEST_ASSERT_EQUAL_HEX16(0, old.entries[old.entry_count].index);
        }
}

static void test_every_mapped_object_exists_is_mappable_and_as_long(void)
{
    for (int row = 0; row < ROWS; row++)
        for (int order = 0; order < ORDERS; order++) {
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, manual[row].mapping, manual[row].transmit, (cm1e_pdo_order_t)order,
                            CM1E_FIRMWARE_1_3_5);
            for (unsigned i = 0; i < pdo.entry_count; i++) {
                const cm1e_pdo_entry_t *mapped = &pdo.entries[i];
                const cm1e_entry_t *entry = cm1e_device_entry(mapped->index, mapped->subindex);
                char place[40];
                snprintf(place, sizeof place, "%04X in %04X", mapped->index, pdo.index);
                TEST_ASSERT_NOT_NULL_MESSAGE(entry, place);
                TEST_ASSERT_TRUE_MESSAGE(
                    entry->access & (manual[row].transmit ? CM1E_ACCESS_TXPDO : CM1E_ACCESS_RXPDO), place);
                /* UG 7.3.13 says DINT, UG 4.4 and 7.2 map 16 bits: the only such object. */
                TEST_ASSERT_EQUAL_MESSAGE(mapped->index == 0x6079 ? 32 : mapped->bits, entry->bits, place);
                for (unsigned k = 0; k < i; k++)
                    TEST_ASSERT_NOT_EQUAL_HEX16(pdo.entries[k].index, mapped->index);
            }
        }
}

static void test_dictionary_holds_the_order_of_ug_4_4(void)
{
    for (int row = 0; row < ROWS; row++)
        for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++) {
            cm1e_pdo_t pdo;
            cm1e_device_pdo(&pdo, manual[row].mapping, manual[row].transmit, CM1E_PDO_ORDER_UG_4_4,
                            (cm1e_firmware_t)firmware);
            unsigned count = 0;
            for (unsigned sub = 1; sub <= CM1E_PDO_MAX_ENTRIES; sub++) {
                const cm1e_entry_t *entry = cm1e_device_entry(pdo.index, (uint8_t)sub);
                if (!entry || (int)entry->since > firmware)
                    continue;
                const cm1e_pdo_entry_t *mapped = &pdo.entries[count++];
                TEST_ASSERT_EQUAL_HEX32((uint32_t)mapped->index << 16 | (uint32_t)mapped->subindex << 8 | mapped->bits,
                                        entry->default_value);
            }
            TEST_ASSERT_EQUAL(pdo.entry_count, count);
        }
}

/* EC_EXTEND of UG 11.2.1 */
static void test_sync_managers_do_not_overlap_and_hold_the_largest_mapping(void)
{
    static const uint8_t control[4] = {0x26, 0x22, 0x64, 0x20};
    static const uint16_t start[4] = {0x1000, 0x1080, 0x1100, 0x1400};
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX16(start[i], cm1e_device_sync_managers[i].start);
        TEST_ASSERT_EQUAL_HEX8(control[i], cm1e_device_sync_managers[i].control);
        TEST_ASSERT_EQUAL(1, cm1e_device_sync_managers[i].enable);
        TEST_ASSERT_EQUAL(i + 1, cm1e_device_sync_managers[i].type);
        TEST_ASSERT_EQUAL(i + 1, cm1e_device_entry(0x1C00, (uint8_t)(i + 1))->default_value);
    }
    TEST_ASSERT_EQUAL(128, cm1e_device_sync_managers[0].length);
    TEST_ASSERT_EQUAL(128, cm1e_device_sync_managers[1].length);
    TEST_ASSERT_EQUAL(13, cm1e_device_sync_managers[2].length);
    TEST_ASSERT_EQUAL(21, cm1e_device_sync_managers[3].length);
    /* Three buffers each for process data (ETG.1000.4), the largest mapping 21 bytes both ways. */
    TEST_ASSERT_TRUE(cm1e_device_sync_managers[2].start + 3 * 21 <= cm1e_device_sync_managers[3].start);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_size_is_the_manuals_for_every_mapping_order_and_firmware);
    RUN_TEST(test_entries_are_the_manuals_in_both_orders);
    RUN_TEST(test_old_profile_mapping_lacks_only_the_mode);
    RUN_TEST(test_every_mapped_object_exists_is_mappable_and_as_long);
    RUN_TEST(test_dictionary_holds_the_order_of_ug_4_4);
    RUN_TEST(test_sync_managers_do_not_overlap_and_hold_the_largest_mapping);
    return UNITY_END();
}
