/* An optional device that comes and cannot be taken, because it is another one or cannot be configured: it is refused
 * with a reason, never takes part, never gets an address that is another's, and stops nobody. When it is gone, it is no
 * longer refused; when it is mended, or the right one comes, that one takes part. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "description/sii_format.h"
#include "description/sii_image.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

/** On the wire: a motor, the wrong device and the right one at the same address, a motor. */
enum { FIRST = 1, WRONG = 2, RIGHT = 3, LAST = 4, TOOL = 3 /* position, behind the others */ };
enum { ID = 7, ALIAS = 4711, REFUSED_CYCLES = 3000, GONE = 600, COMES = 4000 };

static cm1e_bus_config_t wire;

/* ---- who is refused ---------------------------------------------------------------------------------------------- */

static cm1e_slave_config_t *add_tool(cm1e_bus_config_t *to, const char *name, cm1e_sim_slave_kind_t kind,
                                     unsigned channels)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(to, name);
    slave->sim = (cm1e_sim_slave_config_t){.kind = kind, .inputs = (uint8_t)channels, .outputs = (uint8_t)channels};
    slave->vendor = 0x000004D8;
    slave->product = 0x00001234;
    slave->address_kind = CM1E_ADDRESS_ALIAS;
    slave->address = ALIAS;
    slave->optional = to == &config;
    return slave;
}

static void name_bit(cm1e_slave_config_t *slave, unsigned bit)
{
    cm1e_signal_config_t *signal = &slave->signals[slave->signal_count++];
    snprintf(signal->name, sizeof signal->name, "part");
    signal->bit = (uint16_t)bit;
    signal->bits = 1;
}

/** Three devices of one kind: the one that is expected, the wrong one and the right one. */
typedef struct tools {
    cm1e_slave_config_t *expected, *wrong, *right;
} tools_t;

static tools_t add_tools(cm1e_sim_slave_kind_t kind, unsigned wrong_channels, unsigned right_channels)
{
    add_tool(&config, "tool", kind, right_channels);
    add_tool(&wire, "wrong", kind, wrong_channels);
    add_tool(&wire, "right", kind, right_channels);
    return (tools_t){config.slaves, wire.slaves, wire.slaves + 1}; /* adding one may have moved the one before */
}

static void another_product(void) { add_tools(CM1E_SIM_SLAVE_DIGITAL, 4, 4).wrong->product++; }

static void fewer_channels(void)
{
    const tools_t tools = add_tools(CM1E_SIM_SLAVE_DIGITAL, 4, 4);
    name_bit(tools.expected, 2);
    tools.wrong->sim.inputs = 0;
}

static void fewer_modules(void)
{
    const tools_t tools = add_tools(CM1E_SIM_SLAVE_MODULAR, 0, 0);
    tools.expected->sim.kind = CM1E_SIM_SLAVE_GAP; /* which modules it has is not stated */
    name_bit(tools.expected, 12);
    tools.wrong->modules[0] = 0x105;
    tools.right->modules[0] = tools.right->modules[1] = 0x302;
    tools.wrong->module_count = 1;
    tools.right->module_count = 2;
}

static void other_modules(void)
{
    const tools_t tools = add_tools(CM1E_SIM_SLAVE_MODULAR, 0, 0);
    tools.expected->modules[0] = tools.right->modules[0] = 0x302;
    tools.wrong->modules[0] = 0x105;
    tools.expected->module_count = tools.right->module_count = tools.wrong->module_count = 1;
}

static void without_the_object(void)
{
    add_tools(CM1E_SIM_SLAVE_ANALOG, 2, 4).expected->sdos[0] =
        (cm1e_sdo_config_t){.index = 0x8020, .subindex = 0x12, .bytes = 2, .value = 7};
    config.slaves[0].sdo_count = 1;
}

/** Its EEPROM describes entries of 255 bits (set_up_wire()). */
static void too_much(void) { add_tools(CM1E_SIM_SLAVE_DIGITAL, 4, 4); }

static void add_motor(cm1e_bus_config_t *to, const char *name, const char *firmware)
{
    cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(to, name);
    snprintf(axis->firmware, sizeof axis->firmware, "%s", firmware);
    axis->address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    axis->address = ID;
    axis->optional = to == &config;
    axis->recover = CM1E_RECOVER_AUTO;
}

static void other_firmware(void)
{
    add_motor(&config, "tool", "1.3.5");
    add_motor(&wire, "wrong", "1.3.0");
    add_motor(&wire, "right", "1.3.5");
}

static void add_bridge(cm1e_bus_config_t *to, const char *name, const char *motor, uint16_t alias)
{
    cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(to, name);
    axis->address_kind = CM1E_ADDRESS_ALIAS;
    axis->address = alias;
    axis->channel = 1;
    axis->k37 = 10;
    axis->k37_stated = true;
    snprintf(axis->motor, sizeof axis->motor, "%s", motor);
    axis->optional = to == &config;
    axis->recover = CM1E_RECOVER_AUTO;
}

/** Two aliases, because the axes of one alias belong to one bridge; the right one gets its own in start_without_tool(). */
static void other_motors(void)
{
    add_bridge(&config, "tool", "CM1", ALIAS);
    add_bridge(&wire, "wrong", "CM2", ALIAS);
    add_bridge(&wire, "right", "CM1", ALIAS + 1);
}

#define OTHER_PRODUCT "its vendor, product or revision is another one"
#define TOO_FEW "it has fewer process data than the signals of the configuration need"
#define OTHER_MAPPING "its PDO mapping cannot be used, or is another one than before"
#define NOT_WRITTEN "it does not take what the configuration writes into it"
#define OTHER_FIRMWARE "its firmware is not the expected one"

static const struct {
    const char *what;
    void (*describe)(void);
    const char *first, *later; /* reasons: before the right one was there; afterwards; NULL: not compared */
} cases[] = {
    {"product", another_product, OTHER_PRODUCT, OTHER_PRODUCT},
    {"channels", fewer_channels, TOO_FEW, NULL},
    {"modules that are too few", fewer_modules, TOO_FEW, OTHER_MAPPING},
    {"other modules", other_modules, NOT_WRITTEN, NOT_WRITTEN},
    {"object", without_the_object, NOT_WRITTEN, NOT_WRITTEN},
    {"room", too_much, "its process data need more room than was kept free for it: start with it plugged in", NULL},
    {"firmware", other_firmware, OTHER_FIRMWARE, OTHER_FIRMWARE},
    {"motors", other_motors, "it is not of the expected kind, or its motors are others", OTHER_PRODUCT},
};
enum { CASES = sizeof cases / sizeof cases[0] };

static void describe(cm1e_bus_config_t *to, uint16_t last)
{
    cm1e_bus_config_free(to);
    cm1e_bus_config_init(to, "sim", 2);
    to->virtual_time = true;
    to->sim_pdo_order = tested_order();
    for (uint32_t i = 0; i < 2; i++)
        snprintf(to->axes[i].firmware, sizeof to->axes[i].firmware, "%s", tested_firmware());
    to->axes[1].address = last;
}

static void widen_entries(cm1e_sim_slave_t *slave)
{
    enum { PDO_HEADER = 8, ENTRY_BYTES = 8, ENTRY_BITS = 5 };
    size_t bytes = 0;
    const size_t inputs = cm1e_sim_esc_sii_category(slave, SII_CATEGORY_TXPDO, &bytes);
    ck_assert_uint_ge(bytes, PDO_HEADER + 2 * ENTRY_BYTES);
    for (size_t entry = PDO_HEADER; entry < PDO_HEADER + 2 * ENTRY_BYTES; entry += ENTRY_BYTES)
        slave->sii[inputs + entry + ENTRY_BITS] = 0xFF;
}

static cm1e_sim_slave_t *at(cm1e_bus_t *bus, uint32_t place) { return cm1e_sim_segment_slave(segment_of(bus), place); }
static void attach(cm1e_bus_t *bus, uint32_t place) { cm1e_sim_segment_attach(segment_of(bus), place); }

static void give_alias(cm1e_sim_slave_t *slave)
{
    enum { ALIAS_AT = 8 };
    cm1e_put_u16(slave->sii + ALIAS_AT, ALIAS);
    slave->sii[CM1E_SII_CHECKSUM] = cm1e_sii_crc8(slave->sii, CM1E_SII_CONFIG_BYTES);
}

static cm1e_bus_t *start_without_tool(int number)
{
    describe(&config, 2);
    describe(&wire, LAST);
    cases[number].describe();
    cm1e_bus_t *bus = open_bus_on(&wire);
    if (cases[number].describe == too_much)
        widen_entries(at(bus, WRONG));
    if (cases[number].describe == other_motors)
        give_alias(at(bus, RIGHT));
    cm1e_sim_segment_detach(segment_of(bus), WRONG, false);
    cm1e_sim_segment_detach(segment_of(bus), RIGHT, false);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s: %s", cases[number].what, diag.text);
    return bus;
}

/* ---- the judge --------------------------------------------------------------------------------------------------- */

static uint16_t station_of(cm1e_bus_t *bus, uint32_t place)
{
    return cm1e_get_u16(at(bus, place)->memory + ESC_STATION_ADDRESS);
}

static const char *how(const cm1e_bus_t *bus)
{
    static char text[CM1E_PRESENCE_TEXT];
    cm1e_bus_presence_text(bus, TOOL, text, sizeof text);
    return text;
}

/** The others lose no cycle and keep their addresses, which nobody else has. */
static void good_cycle(cm1e_bus_t *bus)
{
    ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_uint_eq(station_of(bus, FIRST), 0x1001);
    ck_assert_uint_eq(station_of(bus, LAST), 0x1002);
    for (uint32_t place = WRONG; place <= RIGHT; place++)
        ck_assert(station_of(bus, place) != 0x1001 && station_of(bus, place) != 0x1002);
}

static void expect_refused(cm1e_bus_t *bus, uint32_t place, const char *reason)
{
    unsigned refused = 0;
    for (int n = 0; n < REFUSED_CYCLES; n++) {
        good_cycle(bus);
        ck_assert_int_ne(cm1e_bus_presence(bus, TOOL), CM1E_PRESENCE_THERE);
        ck_assert_uint_ne(cm1e_sim_slave_al_state(at(bus, place)), CM1E_AL_OP);
        if (cm1e_bus_presence(bus, TOOL) != CM1E_PRESENCE_REFUSED)
            continue;
        refused++;
        ck_assert_msg(strstr(how(bus), reason) != NULL, "%s", how(bus));
    }
    ck_assert_msg(refused > 0, "%s", how(bus));
}

static void expect_there(cm1e_bus_t *bus, uint32_t place)
{
    for (int n = 0; n < COMES && cm1e_bus_presence(bus, TOOL) != CM1E_PRESENCE_THERE; n++)
        good_cycle(bus);
    ck_assert_msg(cm1e_bus_presence(bus, TOOL) == CM1E_PRESENCE_THERE, "%s", how(bus));
    ck_assert_uint_eq(cm1e_sim_slave_al_state(at(bus, place)), CM1E_AL_OP);
}

static void expect_absent(cm1e_bus_t *bus)
{
    for (int n = 0; n < GONE; n++)
        good_cycle(bus);
    ck_assert_msg(cm1e_bus_presence(bus, TOOL) == CM1E_PRESENCE_ABSENT, "%s", how(bus));
    ck_assert_msg(strstr(how(bus), "is optional and absent") != NULL, "%s", how(bus));
}

static void detach(cm1e_bus_t *bus, uint32_t place)
{
    cm1e_sim_segment_detach(segment_of(bus), place, false);
    cycle(bus); /* the frame that is on its way when the plug is pulled */
}

/** First while nobody knows what the tool is, then after it has been there. */
START_TEST(the_wrong_device_is_refused_until_the_right_one_comes)
{
    cm1e_bus_t *bus = start_without_tool(_i);
    for (int round = 0; round < 2 && (round == 0 || cases[_i].later); round++) {
        attach(bus, WRONG);
        expect_refused(bus, WRONG, round ? cases[_i].later : cases[_i].first);
        detach(bus, WRONG);
        expect_absent(bus);
        attach(bus, RIGHT);
        expect_there(bus, RIGHT);
        detach(bus, RIGHT);
        expect_absent(bus);
    }
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/* ---- strangers --------------------------------------------------------------------------------------------------- */

/** Behind the two motors; then the tool. */
enum { STRANGERS = CM1E_STRANGERS + 3, FIRST_STRANGER = 3, BEHIND = FIRST_STRANGER + STRANGERS };

static cm1e_bus_t *start_with_strangers(void)
{
    describe(&config, 2);
    describe(&wire, 2);
    add_tool(&config, "tool", CM1E_SIM_SLAVE_DIGITAL, 4);
    for (unsigned n = 0; n < STRANGERS; n++) {
        char name[16];
        snprintf(name, sizeof name, "stranger%u", n);
        add_tool(&wire, name, CM1E_SIM_SLAVE_DIGITAL, 4)->address++;
    }
    add_tool(&wire, "right", CM1E_SIM_SLAVE_DIGITAL, 4);
    cm1e_bus_t *bus = open_bus_on(&wire);
    for (uint32_t place = FIRST_STRANGER; place <= BEHIND; place++)
        cm1e_sim_segment_detach(segment_of(bus), place, false);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

/** Those that are not kept are not configured either, and the tool behind all of them is found. */
START_TEST(more_strangers_than_are_kept_keep_nobody_out)
{
    enum { TIME_OF_A_STRANGER = 1000 };
    cm1e_stranger_t strangers[CM1E_STRANGERS];
    cm1e_bus_t *bus = start_with_strangers();
    for (uint32_t place = FIRST_STRANGER; place <= BEHIND; place++)
        attach(bus, place);
    for (int n = 0; n < STRANGERS * TIME_OF_A_STRANGER; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_msg(cm1e_bus_presence(bus, TOOL) == CM1E_PRESENCE_THERE, "%s", how(bus));
    ck_assert_uint_eq(cm1e_bus_strangers(bus, strangers, CM1E_STRANGERS), CM1E_STRANGERS);
    for (uint32_t n = 0; n < CM1E_STRANGERS; n++)
        ck_assert_uint_eq(strangers[n].place, FIRST_STRANGER + n);
    for (uint32_t place = FIRST_STRANGER; place < BEHIND; place++) {
        ck_assert_uint_eq(cm1e_sim_slave_al_state(at(bus, place)), CM1E_AL_INIT);
        ck_assert(station_of(bus, place) == 0 || station_of(bus, place) == 0x2FFE);
        detach(bus, place);
    }
    for (int n = 0; n < GONE; n++)
        cycle(bus);
    ck_assert_uint_eq(cm1e_bus_strangers(bus, strangers, CM1E_STRANGERS), 0);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** The one that came first is the tool. */
START_TEST(a_second_device_with_the_same_address_is_a_stranger)
{
    cm1e_stranger_t stranger;
    cm1e_bus_t *bus = start_without_tool(0);
    attach(bus, RIGHT);
    expect_there(bus, RIGHT);
    const uint16_t own = station_of(bus, RIGHT);
    attach(bus, WRONG);
    for (int n = 0; n < REFUSED_CYCLES; n++) {
        good_cycle(bus);
        ck_assert_int_eq(cm1e_bus_presence(bus, TOOL), CM1E_PRESENCE_THERE);
        ck_assert(station_of(bus, RIGHT) == own && station_of(bus, WRONG) != own);
    }
    ck_assert_uint_eq(cm1e_bus_strangers(bus, &stranger, 1), 1);
    ck_assert(stranger.place == WRONG && stranger.alias == ALIAS);
    char text[CM1E_PRESENCE_TEXT], wanted[CM1E_PRESENCE_TEXT];
    cm1e_stranger_text(&stranger, text, sizeof text);
    snprintf(wanted, sizeof wanted, "A device at place %u of the wire was refused: vendor 0x%08X, product 0x%08X, alias %u, "
             "explicit device ID 0 are not those of a slave that is missing.", WRONG, stranger.vendor_id,
             stranger.product_code, ALIAS);
    ck_assert_str_eq(text, wanted);
    ck_assert_uint_eq(cm1e_bus_strangers(bus, &stranger, 0), 0);
    const uint64_t news = cm1e_bus_presence_news(bus);
    for (int n = 0; n < REFUSED_CYCLES; n++) /* it is identified again and again, which is no news */
        good_cycle(bus);
    ck_assert_uint_eq(cm1e_bus_presence_news(bus), news);
    detach(bus, WRONG);
    for (int n = 0; n < GONE; n++)
        good_cycle(bus);
    ck_assert_uint_eq(cm1e_bus_strangers(bus, &stranger, 1), 0);
    ck_assert_uint_gt(cm1e_bus_presence_news(bus), news);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

static cm1e_tap_verdict_t count_requests_for_id(void *context, cm1e_tap_frame_t *frame)
{
    enum { FPWR = 5, AL_CONTROL = 0x0120, REQUEST_ID = 0x20, HEADER_AT = 16 };
    const uint8_t *header = frame->bytes + HEADER_AT;
    if (frame->direction == CM1E_TAP_SENT && header[0] == FPWR && cm1e_get_u16(header + 4) == AL_CONTROL)
        *(unsigned *)context += (header[10] & REQUEST_ID) != 0;
    return CM1E_TAP_PASS;
}

/** Where all are found by their alias nobody is asked for an explicit device ID, which would cost time. */
START_TEST(a_device_that_is_known_by_its_alias_is_not_asked_for_its_id)
{
    unsigned requests = 0;
    cm1e_bus_t *bus = start_without_tool(0);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), count_requests_for_id, &requests);
    attach(bus, RIGHT);
    expect_there(bus, RIGHT);
    ck_assert_uint_eq(requests, 0);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** Its EEPROM answers too slowly. When it is mended, the device is known. */
START_TEST(a_device_whose_eeprom_cannot_be_read_is_named_and_may_be_mended)
{
    enum { SLOW = 8000 };
    char text[CM1E_PRESENCE_TEXT];
    cm1e_stranger_t stranger;
    cm1e_bus_t *bus = start_without_tool(0);
    simulate(bus, "quirk 3 slow-eeprom 1000000");
    attach(bus, RIGHT);
    for (int n = 0; n < SLOW; n++)
        good_cycle(bus);
    ck_assert_uint_eq(cm1e_bus_strangers(bus, &stranger, 1), 1);
    cm1e_stranger_text(&stranger, text, sizeof text);
    ck_assert_str_eq(text, "A device at place 2 of the wire was refused: its EEPROM cannot be read.");
    ck_assert_int_eq(cm1e_bus_presence(bus, TOOL), CM1E_PRESENCE_ABSENT);
    simulate(bus, "quirk 3 nothing");
    for (int n = 0; n < SLOW && cm1e_bus_presence(bus, TOOL) != CM1E_PRESENCE_THERE; n++)
        good_cycle(bus);
    ck_assert_msg(cm1e_bus_presence(bus, TOOL) == CM1E_PRESENCE_THERE, "%s", how(bus));
    ck_assert_uint_eq(cm1e_bus_strangers(bus, &stranger, 1), 0);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_hot_refused");
    TCase *tests = tcase_create("refused");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, the_wrong_device_is_refused_until_the_right_one_comes, 0, CASES);
    tcase_add_test(tests, more_strangers_than_are_kept_keep_nobody_out);
    tcase_add_test(tests, a_second_device_with_the_same_address_is_a_stranger);
    tcase_add_test(tests, a_device_that_is_known_by_its_alias_is_not_asked_for_its_id);
    tcase_add_test(tests, a_device_whose_eeprom_cannot_be_read_is_named_and_may_be_mended);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
