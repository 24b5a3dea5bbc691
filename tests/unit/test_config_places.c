/* Which slave of a scan is which one of the configuration: by position without the optional ones, by alias, by explicit
 * device ID, and behind the head of its Hot Connect group. */
#include <stdio.h>
#include <string.h>

#include "config/places.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* The segment: a tool that comes and goes stands between a motor and a terminal, and a group at the end. */
static const cm1e_slave_info_t segment[] = {
    {.position = 1, .vendor_id = 2, .product_code = 10},
    {.position = 2, .vendor_id = 2, .product_code = 11, .explicit_id = 7},
    {.position = 3, .vendor_id = 2, .product_code = 12, .alias = 30},
    {.position = 4, .vendor_id = 2, .product_code = 13},
    {.position = 5, .vendor_id = 2, .product_code = 14, .alias = 50},
    {.position = 6, .vendor_id = 2, .product_code = 15},
    {.position = 7, .vendor_id = 3, .product_code = 16},
};
enum { SEGMENT = sizeof segment / sizeof segment[0] };

static uint32_t there = SEGMENT; /* so many slaves are there */

static const cm1e_slave_info_t *slave_at(const cm1e_bus_t *bus, uint32_t position)
{
    (void)bus;
    return position >= 1 && position <= there ? &segment[position - 1] : NULL;
}

static cm1e_bus_config_t config;

static void add(cm1e_address_kind_t kind, uint16_t address, const char *group, uint32_t vendor, uint32_t product)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, NULL);
    slave->address_kind = kind;
    slave->address = address;
    snprintf(slave->hot_connect, sizeof slave->hot_connect, "%s", group);
    slave->vendor = vendor;
    slave->product = product;
}

static void make(void)
{
    there = SEGMENT;
    cm1e_bus_config_init(&config, "sim", 3);
    config.axes[1].address_kind = CM1E_ADDRESS_EXPLICIT_ID; /* the tool; the others take places 1 and 2 */
    config.axes[1].address = 7;
    config.axes[1].optional = true;
    add(CM1E_ADDRESS_ALIAS, 50, "tail", 2, 14);
    add(CM1E_ADDRESS_POSITION, 2, "tail", 2, 15);
    add(CM1E_ADDRESS_POSITION, 3, "tail", 3, 16);
    add(CM1E_ADDRESS_POSITION, 3, "", 0, 0);
    add(CM1E_ADDRESS_ALIAS, 30, "", 0, 0);
    add(CM1E_ADDRESS_POSITION, 3, "tail", 3, 17);  /* another product */
    add(CM1E_ADDRESS_POSITION, 3, "tail", 2, 16);  /* another vendor */
    add(CM1E_ADDRESS_POSITION, 2, "other", 2, 15); /* a group without a head */
    add(CM1E_ADDRESS_POSITION, 0, "", 0, 0);       /* nowhere */
}

/* Which entries of the configuration a slave is: axes as a, b, c, slaves by their numbers. */
static void entries_of(const cm1e_slave_info_t *slave, char text[20])
{
    const cm1e_places_t places = {&config, NULL, slave_at};
    const uint16_t place = cm1e_place_of(&places, slave);
    unsigned used = 0;
    for (uint32_t i = 0; i < config.axis_count; i++)
        if (cm1e_place_is_of_axis(&places, i, slave, place))
            text[used++] = (char)('a' + i);
    for (uint32_t i = 0; i < config.slave_count; i++)
        if (cm1e_place_is_of_slave(&places, &config.slaves[i], slave, place))
            text[used++] = (char)('1' + i);
    snprintf(text + used, 20 - used, " at %u", place);
}

static void expect(const char *const expected[SEGMENT])
{
    for (uint32_t i = 0; i < there; i++) {
        char text[20];
        entries_of(&segment[i], text);
        TEST_ASSERT_EQUAL_STRING(expected[i], text);
    }
}

static void test_each_slave_is_its_entry(void)
{
    static const char *const expected[] = {"a at 1", "b at 0", "c5 at 2", "4 at 3", "1 at 0", "2 at 0", "3 at 0"};
    make();
    expect(expected);
    cm1e_bus_config_free(&config);
}

static void test_without_its_head_a_group_is_not_there(void)
{
    static const char *const expected[] = {"a at 1", "b at 0", "c5 at 2", "4 at 3", " at 4", " at 5", " at 6"};
    make();
    config.slaves[0].address = 51;
    expect(expected);
    cm1e_bus_config_free(&config);
}

/* An axis without a motor has no place. */
static void test_a_virtual_axis_is_no_slave(void)
{
    static const char *const expected[] = {"c at 1", "b at 0", "5 at 2", "4 at 3", "1 at 0", "2 at 0", "3 at 0"};
    make();
    config.axes[0].type = CM1E_AXIS_VIRTUAL;
    expect(expected);
    cm1e_bus_config_free(&config);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_slave_is_its_entry);
    RUN_TEST(test_without_its_head_a_group_is_not_there);
    RUN_TEST(test_a_virtual_axis_is_no_slave);
    return UNITY_END();
}
