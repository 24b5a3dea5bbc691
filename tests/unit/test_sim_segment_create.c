/* The segment that a configuration describes: who stands where, with which alias and explicit ID. */
#include <math.h>

#include "sim/bridge_app.h"
#include "sim_fake_app.h"

static cm1e_bus_config_t config;
static cm1e_diag_t diag;
static bench_t b;

void setUp(void)
{
    memset(&diag, 0, sizeof diag);
    memset(&b, 0, sizeof b);
    b.now_ns = 1000000000;
}
void tearDown(void)
{
    cm1e_sim_segment_destroy(b.segment);
    b.segment = NULL;
}

static void open_axes(uint32_t count)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", count);
    for (uint32_t i = 0; i < count; i++)
        config.axes[i].address = 0;
}

static void create(uint32_t expected_slaves)
{
    b.segment = cm1e_sim_segment_create(&config, &diag);
    TEST_ASSERT_NOT_NULL_MESSAGE(b.segment, diag.text);
    TEST_ASSERT_EQUAL_UINT32(expected_slaves, cm1e_sim_segment_slave_count(b.segment));
}

static void refuse(const char *word)
{
    TEST_ASSERT_NULL(cm1e_sim_segment_create(&config, &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, diag.error);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, word), diag.text);
    TEST_ASSERT_NULL(cm1e_sim_segment_create(&config, NULL));
}

/* Product code as the SII interface of a slave gives it. */
static uint32_t product(unsigned slave)
{
    write_u16(&b, slave, 0x0504, 0x000A);
    write_u16(&b, slave, 0x0502, 0x0100);
    bench_wait(&b, 1000000);
    return read_u32(&b, slave, 0x0508);
}

static uint16_t explicit_id(unsigned slave)
{
    write_u16(&b, slave, 0x0120, 0x21);
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX16(0x21, read_u16(&b, slave, 0x0130));
    return read_u16(&b, slave, 0x0134);
}

static void test_axes_without_address_stand_in_the_order_of_the_list(void)
{
    open_axes(16);
    create(16);
    for (unsigned i = 0; i < 16; i++) {
        TEST_ASSERT_EQUAL_HEX32(CM1E_PRODUCT_CODE, product(i));
        TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, i, 0x0012));
        TEST_ASSERT_EQUAL_HEX16(0, explicit_id(i));
    }
}

static void test_no_axes_is_an_empty_segment(void)
{
    open_axes(1);
    config.axis_count = 0;
    create(0);
}

static void test_positions_are_kept_and_gaps_filled_with_io_modules(void)
{
    open_axes(2);
    config.axes[0].address = 4;
    config.axes[1].address = 2;
    create(4);
    TEST_ASSERT_EQUAL_HEX32(0x808, product(0));
    TEST_ASSERT_EQUAL_HEX32(CM1E_PRODUCT_CODE, product(1));
    TEST_ASSERT_EQUAL_HEX32(0x808, product(2));
    TEST_ASSERT_EQUAL_HEX32(CM1E_PRODUCT_CODE, product(3));
}

static void test_gaps_are_filled_with_what_the_configuration_says(void)
{
    static const uint32_t products[] = {
        [CM1E_SIM_IO_MODULE] = 0x808, [CM1E_SIM_IO_TERMINAL] = 0x404, [CM1E_SIM_IO_COUPLER] = 0x100};
    for (int kind = CM1E_SIM_IO_MODULE; kind <= CM1E_SIM_IO_COUPLER; kind++) {
        tearDown();
        setUp();
        open_axes(1);
        config.axes[0].address = 2;
        config.sim_gaps = (cm1e_sim_io_t)kind;
        create(2);
        TEST_ASSERT_EQUAL_HEX32(products[kind], product(0));
        TEST_ASSERT_EQUAL_HEX32(CM1E_PRODUCT_CODE, product(1));
    }
}

static void test_alias_and_id_fill_the_places_between(void)
{
    open_axes(4);
    config.axes[0].address_kind = CM1E_ADDRESS_ALIAS;
    config.axes[0].address = 0x1001;
    config.axes[1].address = 2;
    config.axes[2].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    config.axes[2].address = 254;
    config.axes[3].address = 1;
    create(4);
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 0, 0x0012));
    TEST_ASSERT_EQUAL_HEX16(0x1001, read_u16(&b, 2, 0x0012));
    TEST_ASSERT_EQUAL_HEX16(0, explicit_id(2));
    TEST_ASSERT_EQUAL_HEX16(254, explicit_id(3));
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 3, 0x0012));
}

static void test_contradictions_are_refused_in_words(void)
{
    open_axes(3);
    config.axes[2].address = 1;
    refuse("taken");
    config.axes[2].address = CM1E_MAX_SLAVES + 1;
    refuse("far");
    config.axes[2].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    config.axes[2].address = 255;
    refuse("255");
    config.axes[2].address = 9;
    strcpy(config.axes[1].motor, "CM2-X");
    refuse("CM2-X");
    config.axes[1].motor[0] = 0;
    strcpy(config.axes[0].firmware, "new");
    refuse("new");
    config.axis_count = CM1E_MAX_AXES + 1;
    refuse("axes");
}

/* ---- bridges ---------------------------------------------------------------------------------------------------- */

static void add_bridge_axis(uint32_t i, uint16_t position, uint8_t channel, const char *motor)
{
    config.axes[i].address = position;
    config.axes[i].channel = channel;
    snprintf(config.axes[i].motor, sizeof config.axes[i].motor, "%s", motor);
}

static cm1e_sim_bridge_t *bridge_at(uint32_t position)
{
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(b.segment, position));
    TEST_ASSERT_NOT_NULL(bridge);
    return bridge;
}

static void test_axes_with_channels_share_a_bridge_of_the_model_that_fits(void)
{
    open_axes(8);
    add_bridge_axis(0, 2, 4, "");
    add_bridge_axis(1, 2, 1, "CM2");
    add_bridge_axis(2, 4, 1, "CM1");
    add_bridge_axis(3, 4, 3, "CM1");
    add_bridge_axis(4, 5, 2, "");
    config.axes[5].address = 6;
    add_bridge_axis(6, 77, 1, "");
    add_bridge_axis(7, 77, 2, "");
    config.axes[6].address_kind = config.axes[7].address_kind = CM1E_ADDRESS_ALIAS;
    create(6);
    TEST_ASSERT_EQUAL_HEX32(0xEB12, product(0)); /* the alias takes the first free place */
    TEST_ASSERT_EQUAL_HEX16(77, read_u16(&b, 0, 0x0012));
    TEST_ASSERT_EQUAL_HEX32(0xEB02, product(1));
    TEST_ASSERT_EQUAL_HEX32(0x808, product(2));
    TEST_ASSERT_EQUAL_HEX32(0xEB01, product(3));
    TEST_ASSERT_EQUAL_HEX32(0xEB12, product(4));
    TEST_ASSERT_EQUAL_HEX32(CM1E_PRODUCT_CODE, product(5));
}

static void test_k37_and_mechanics_of_an_axis_are_those_of_its_motor(void)
{
    open_axes(2);
    add_bridge_axis(0, 1, 2, "CM1");
    add_bridge_axis(1, 1, 3, "CM2");
    config.axes[0].k37 = 3; /* 1000 pulses a revolution: a count of the mechanics is 1/50 */
    config.axes[0].k37_stated = true;
    config.axes[0].sim = (cm1e_sim_axis_config_t){.stop_positive = 2000, .stop_negative = -500, .sensor_input2 = 100,
                                                  .sensor_input3 = -40, .friction = 0.02};
    config.axes[1].sim = (cm1e_sim_axis_config_t){.no_stops = true, .no_sensors = true, .load_inertia = 1e-5};
    create(1);
    const cm1e_sim_bridge_t *bridge = bridge_at(1);
    const cm1e_sim_bridge_axis_t *axes = bridge->axes;
    TEST_ASSERT_EQUAL_INT64(3, *cm1e_sim_bridge_k(bridge, 1, 37));
    TEST_ASSERT_EQUAL_DOUBLE(100000, axes[1].mechanics.stop_positive);
    TEST_ASSERT_EQUAL_DOUBLE(-25000, axes[1].mechanics.stop_negative);
    TEST_ASSERT_EQUAL_DOUBLE(0.02, axes[1].mechanics.friction);
    TEST_ASSERT_EQUAL_DOUBLE(5000, axes[1].sensors.edges[0]);
    TEST_ASSERT_EQUAL_DOUBLE(-2000, axes[1].sensors.edges[1]);
    TEST_ASSERT_TRUE(isinf(axes[2].mechanics.stop_positive));
    TEST_ASSERT_TRUE(axes[2].sensors.none);
    TEST_ASSERT_TRUE(axes[2].mechanics.gain < axes[1].mechanics.gain);
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i += 3) { /* not in the configuration: defaults */
        TEST_ASSERT_EQUAL_INT64(10, *cm1e_sim_bridge_k(bridge, i, 37));
        TEST_ASSERT_EQUAL_DOUBLE(250000, axes[i].mechanics.stop_positive);
        TEST_ASSERT_EQUAL_DOUBLE(150000, axes[i].sensors.edges[0]);
    }
}

static void test_contradictions_on_a_bridge_are_refused_in_words(void)
{
    open_axes(2);
    add_bridge_axis(0, 1, 1, "CM2");
    add_bridge_axis(1, 1, 2, "CM1");
    refuse("no bridge has the motors 'CM2', 'CM1'");
    add_bridge_axis(1, 1, 1, "CM2");
    refuse("taken");
    add_bridge_axis(1, 1, 0, "");
    refuse("taken");
    add_bridge_axis(1, 2, 5, "");
    refuse("axis 2");
    config.axes[0].address_kind = config.axes[1].address_kind = CM1E_ADDRESS_ALIAS;
    add_bridge_axis(1, 1, 1, "CM2");
    refuse("channel 1");
}

static void test_the_longest_bus_can_be_made(void)
{
    open_axes(CM1E_MAX_AXES);
    create(CM1E_MAX_AXES);
    uint8_t data[1] = {0};
    TEST_ASSERT_EQUAL_INT(CM1E_MAX_AXES, send_to(&b, BRD, 0, 0x0000, data, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_axes_without_address_stand_in_the_order_of_the_list);
    RUN_TEST(test_no_axes_is_an_empty_segment);
    RUN_TEST(test_positions_are_kept_and_gaps_filled_with_io_modules);
    RUN_TEST(test_gaps_are_filled_with_what_the_configuration_says);
    RUN_TEST(test_alias_and_id_fill_the_places_between);
    RUN_TEST(test_contradictions_are_refused_in_words);
    RUN_TEST(test_axes_with_channels_share_a_bridge_of_the_model_that_fits);
    RUN_TEST(test_k37_and_mechanics_of_an_axis_are_those_of_its_motor);
    RUN_TEST(test_contradictions_on_a_bridge_are_refused_in_words);
    RUN_TEST(test_the_longest_bus_can_be_made);
    return UNITY_END();
}
