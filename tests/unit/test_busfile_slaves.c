/* Slaves without an axis in a bus file: what each key becomes, and what a wrong one is told. */
#include <stdio.h>
#include <string.h>

#include "cm1e/config.h"
#include "unity.h"

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_slaves.yaml";
static cm1e_bus_config_t config;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) { cm1e_bus_config_free(&config); }

static cm1e_error_t load(const char *text)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(strlen(text), fwrite(text, 1, strlen(text), file));
    TEST_ASSERT_EQUAL(0, fclose(file));
    return cm1e_bus_config_load(&config, temporary, &diag);
}

static const char everything[] =
    "axes: [{name: feed, position: 9}]\n"
    "slaves:\n"
    "  - name: analog in\n"
    "    position: 3\n"
    "    vendor: 0x00000002\n"
    "    product: 0x0BC03052\n"
    "    revision: 0x00120000\n"
    "    watchdog_ms: 250\n"
    "    sdo:\n"
    "      - {object: 0x8000:12, type: INT, value: -100}\n"
    "      - {object: 0x8000:a, type: REAL, value: 1.5, before: op}\n"
    "      - {object: 0xF800, type: UDINT, value: 0xFFFFFFFF, before: safe_op}\n"
    "      - {object: 0x8000:01, type: BOOL, value: true}\n"
    "      - {object: 0x8000:02, type: ULINT, value: 18446744073709551615}\n"
    "      - {object: 0x8000:03, type: REAL, value: -3.4028235e38}\n"
    "      - {object: 0x8000:04, type: REAL, value: 1e-45}\n"
    "      - {object: 0x8000:05, type: LREAL, value: -0.1}\n"
    "    mapping:\n"
    "      - {pdo: 0x1A00, entries: [0x6000:11/16, gap/7, 0x6000:01/1]}\n"
    "      - {pdo: 0x1600, entries: [0x7000:11/255]}\n"
    "    outputs_pdos: [0x1600]\n"
    "    inputs_pdos: [0x1A00, 0x1A03]\n"
    "    outputs:\n"
    "      - {name: speed, object: 0x7000:11, type: INT, safe: -5}\n"
    "      - {name: clamp, bit: 3, safe: on}\n"
    "      - {name: lamp, bit: 4, safe: hold}\n"
    "    inputs:\n"
    "      - {name: pressure, object: 0x6000:11}\n"
    "      - {name: state, bit: 16, bits: 3, type: USINT}\n"
    "      - {name: weight, bit: 32, type: REAL}\n"
    "    sim: {device: analog, inputs: 2, outputs: 1, wired_to: other}\n"
    "  - {name: other, alias: 1001, sim: {device: analog, outputs: 8}}\n"
    "  - {explicit_id: 7}\n";

static void test_every_key_becomes_what_it_says(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(everything), diag.text);
    TEST_ASSERT_EQUAL(3, config.slave_count);
    const cm1e_slave_config_t *slave = &config.slaves[0];
    TEST_ASSERT_EQUAL_STRING("analog in", slave->name);
    TEST_ASSERT_EQUAL(CM1E_ADDRESS_POSITION, slave->address_kind);
    TEST_ASSERT_EQUAL(3, slave->address);
    TEST_ASSERT_EQUAL_HEX32(2, slave->vendor);
    TEST_ASSERT_EQUAL_HEX32(0x0BC03052, slave->product);
    TEST_ASSERT_EQUAL_HEX32(0x00120000, slave->revision);
    TEST_ASSERT_EQUAL(250, slave->watchdog_ms);
    TEST_ASSERT_EQUAL(1, slave->outputs_pdo_count);
    TEST_ASSERT_EQUAL_HEX16(0x1600, slave->outputs_pdos[0]);
    TEST_ASSERT_EQUAL(2, slave->inputs_pdo_count);
    TEST_ASSERT_EQUAL_HEX16(0x1A03, slave->inputs_pdos[1]);
    TEST_ASSERT_EQUAL(CM1E_SIM_SLAVE_ANALOG, slave->sim.kind);
    TEST_ASSERT_EQUAL(2, slave->sim.inputs);
    TEST_ASSERT_EQUAL(1, slave->sim.outputs);
    TEST_ASSERT_EQUAL_STRING("other", slave->sim.wired_to);
    TEST_ASSERT_EQUAL(CM1E_ADDRESS_ALIAS, config.slaves[1].address_kind);
    TEST_ASSERT_EQUAL(1001, config.slaves[1].address);
    TEST_ASSERT_EQUAL(CM1E_ADDRESS_EXPLICIT_ID, config.slaves[2].address_kind);
    TEST_ASSERT_EQUAL_STRING("slave3", config.slaves[2].name);
}

static void test_sdos_have_the_bits_of_their_values(void)
{
    static const cm1e_sdo_config_t expected[] = {
        {.index = 0x8000, .subindex = 0x12, .bytes = 2, .value = (uint64_t)-100},
        {.index = 0x8000, .subindex = 0x0A, .bytes = 4, .before_op = true, .value = 0x3FC00000},
        {.index = 0xF800, .subindex = 0, .bytes = 4, .value = 0xFFFFFFFF},
        {.index = 0x8000, .subindex = 1, .bytes = 1, .value = 1},
        {.index = 0x8000, .subindex = 2, .bytes = 8, .value = UINT64_MAX},
        {.index = 0x8000, .subindex = 3, .bytes = 4, .value = 0xFF7FFFFF}, /* the largest and the smallest REAL */
        {.index = 0x8000, .subindex = 4, .bytes = 4, .value = 1},
        {.index = 0x8000, .subindex = 5, .bytes = 8, .value = 0xBFB999999999999A},
    };
    enum { EXPECTED = sizeof expected / sizeof expected[0] };
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(everything), diag.text);
    TEST_ASSERT_EQUAL(EXPECTED, config.slaves[0].sdo_count);
    for (int i = 0; i < EXPECTED; i++) {
        const cm1e_sdo_config_t *sdo = &config.slaves[0].sdos[i];
        const uint64_t mask = sdo->bytes == 8 ? UINT64_MAX : (UINT64_C(1) << 8 * sdo->bytes) - 1;
        TEST_ASSERT_EQUAL_HEX16(expected[i].index, sdo->index);
        TEST_ASSERT_EQUAL_HEX8(expected[i].subindex, sdo->subindex);
        TEST_ASSERT_EQUAL(expected[i].bytes, sdo->bytes);
        TEST_ASSERT_EQUAL(expected[i].before_op, sdo->before_op);
        TEST_ASSERT_EQUAL_HEX64(expected[i].value & mask, sdo->value & mask);
    }
}

static void test_the_bounds_of_whole_numbers_are_those_of_their_types(void)
{
    static const char *const rows[][5] = { /* type, the smallest, one less, the largest, one more */
        {"SINT", "-128", "-129", "127", "128"}, {"USINT", "0", "-1", "255", "256"},
        {"INT", "-32768", "-32769", "32767", "32768"}, {"UINT", "0", "-1", "65535", "65536"},
        {"DINT", "-2147483648", "-2147483649", "2147483647", "2147483648"},
        {"UDINT", "0", "-1", "4294967295", "4294967296"},
        {"LINT", "-9223372036854775808", "-9223372036854775809", "9223372036854775807", "9223372036854775808"},
        {"ULINT", "0", "-1", "18446744073709551615", "18446744073709551616"}, {"BOOL", "0", "-1", "1", "2"},
        {"SINT", "0x0", "0x", "0xFF", "0x100"}, {"LINT", "0x0", "-0x1", "0xFFFFFFFFFFFFFFFF", "0x10000000000000000"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int n = 1; n < 5; n++) {
            char text[160];
            snprintf(text, sizeof text, "slaves: [{position: 1, sdo: [{object: 0x8000:01, type: %s, value: %s}]}]\n",
                     rows[i][0], rows[i][n]);
            TEST_ASSERT_EQUAL_MESSAGE(n % 2 ? CM1E_OK : CM1E_ERROR_CONFIG, load(text), text);
            cm1e_bus_config_free(&config);
        }
}

/* 0 is a value, and not what is too small. */
static void test_zero_is_a_value_of_every_type(void)
{
    static const char *const values[] = {"BOOL, value: 0", "INT, value: -0", "REAL, value: 0", "REAL, value: -0.0",
                                         "LREAL, value: 0e5", "ULINT, value: 0x0"};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        char text[120];
        snprintf(text, sizeof text, "slaves: [{position: 1, sdo: [{object: 0x8000:01, type: %s}]}]\n", values[i]);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(text), diag.text);
        cm1e_bus_config_free(&config);
    }
}

static void test_modules_and_simulated_devices(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load("slaves:\n  - {position: 1, modules: [0x205, 0x00000105], "
                                            "sim: {device: modular}}\n"
                                            "  - {position: 2, sim: {device: encoder, inputs: 2, counts_per_s: -2.5}}\n"
                                            "  - {position: 3, sim: {device: analog, inputs: 2, swapped: true}}\n"),
                              diag.text);
    TEST_ASSERT_EQUAL(2, config.slaves[0].module_count);
    TEST_ASSERT_EQUAL_HEX32(0x205, config.slaves[0].modules[0]);
    TEST_ASSERT_EQUAL_HEX32(0x105, config.slaves[0].modules[1]);
    TEST_ASSERT_EQUAL(CM1E_SIM_SLAVE_MODULAR, config.slaves[0].sim.kind);
    TEST_ASSERT_EQUAL(CM1E_SIM_SLAVE_ENCODER, config.slaves[1].sim.kind);
    TEST_ASSERT_TRUE(config.slaves[1].sim.counts_per_s < -2.4 && config.slaves[1].sim.counts_per_s > -2.6);
    TEST_ASSERT_TRUE(config.slaves[2].sim.swapped);
}

static void test_mapping_and_signals_are_in_their_order(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(everything), diag.text);
    const cm1e_slave_config_t *slave = &config.slaves[0];
    static const cm1e_pdo_entry_config_t entries[] = {
        {0x1A00, 0x6000, 0x11, 16}, {0x1A00, 0, 0, 7}, {0x1A00, 0x6000, 1, 1}, {0x1600, 0x7000, 0x11, 255}};
    TEST_ASSERT_EQUAL(4, slave->entry_count);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX16(entries[i].pdo, slave->entries[i].pdo);
        TEST_ASSERT_EQUAL_HEX16(entries[i].index, slave->entries[i].index);
        TEST_ASSERT_EQUAL_HEX8(entries[i].subindex, slave->entries[i].subindex);
        TEST_ASSERT_EQUAL(entries[i].bits, slave->entries[i].bits);
    }
    TEST_ASSERT_EQUAL(6, slave->signal_count);
    const cm1e_signal_config_t *signals = slave->signals; /* inputs first */
    TEST_ASSERT_EQUAL_STRING("pressure", signals[0].name);
    TEST_ASSERT_FALSE(signals[0].output);
    TEST_ASSERT_EQUAL_HEX16(0x6000, signals[0].index);
    TEST_ASSERT_EQUAL_HEX8(0x11, signals[0].subindex);
    TEST_ASSERT_EQUAL(16, signals[1].bit);
    TEST_ASSERT_EQUAL(3, signals[1].bits);
    TEST_ASSERT_TRUE(signals[1].type_stated && signals[1].type == CM1E_IO_USINT);
    TEST_ASSERT_EQUAL(32, signals[2].bits);
    TEST_ASSERT_TRUE(signals[3].output && signals[3].safe == -5);
    TEST_ASSERT_TRUE(signals[4].safe == 1 && signals[4].bit == 3 && signals[4].bits == 1);
    TEST_ASSERT_TRUE(signals[5].hold && signals[5].safe == 0);
}

/* `keys` of a slave at position 3, in line 3 from column 6 on. */
static void expect_wrong(const char *keys, const char *place, const char *part)
{
    char text[800], where[600];
    snprintf(text, sizeof text, "axes: [{name: feed, position: 9}]\nslaves:\n  - {position: 3, %s}\n", keys);
    TEST_ASSERT_NOT_EQUAL_MESSAGE(CM1E_OK, load(text), keys);
    snprintf(where, sizeof where, strchr(place, ':')[1] ? "%s:%s: " : "%s:%s", temporary, place);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(where, diag.text, strlen(where), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, part), diag.text);
}

static void test_wrong_keys_are_told_with_place_and_cure(void)
{
    static const struct {
        const char *keys, *place, *part;
    } cases[] = {
        {"option: true", "3:19", "unknown key 'option' in slaves[0]; did you mean \"optional\"? Expected one of: name, position"},
        {"optional: true", "3:29", "neither alias nor explicit_id"},
        {"recover: soon", "3:28", "expected one of: never, ask, auto"},
        {"hot_connect: tool, vendor: 0x1, product: 0x2", "3:32", "whose first entry has a position"},
        {"name: a}\n  - {alias: 5, optional: true, product: 0x1", "4:5", "expected vendor and product"},
        {"name: a}\n  - {alias: 5, hot_connect: t, vendor: 0x1, product: 0x1}\n  - {alias: 6, hot_connect: t, vendor: "
         "0x1, product: 0x1", "5:29", "whose first entry has an address already"},
        {"name: a}\n  - {alias: 5, hot_connect: t, vendor: 0x1, product: 0x1}\n  - {position: 1, hot_connect: t, "
         "vendor: 0x1, product: 0x1", "5:16", "the place of the first one of the group"},
        {"name: a}\n  - {alias: 5, hot_connect: t, vendor: 0x1, product: 0x1}\n  - {position: 2, hot_connect: t, "
         "vendor: 0x1, product: 0x1}\n  - {position: 2, hot_connect: t, vendor: 0x1, product: 0x1", "6:16",
         "which entry 3 of the list has already"},
        {"esi: a.xml", "3:24", "this program cannot read ESI files: it has to be linked with cm1e::generate"},
        {"ezi: a.xml", "3:19", "unknown key 'ezi'"},
        {"alias: 4", "3:26", "addressed twice"},
        {"name: a.b", "3:25", "expected a name without '.'"},
        {"name: 7", "3:25", "is '7'; expected a name"},
        {"name: slave 7", "3:25", "that is no position"},
        {"name: feed", "3:25", "is also the name of an axis"},
        {"vendor: 2", "3:27", "vendor is '2'; expected it as in 0x0000001A"},
        {"product: 0x123456789", "3:28", "product is '0x123456789'"},
        {"watchdog_ms: 0", "3:32", "watchdog_ms is '0'; expected a whole number, 1 ... 6000"},
        {"outputs_pdos: [0x1A00]", "3:34", "is 0x1A00; expected 0x1600 ... 0x17FF"},
        {"inputs_pdos: [0x1A00, 0x1A00]", "3:41", "which the list has already"},
        {"inputs_pdos: [6656]", "3:33", "'6656' is no PDO"},
        {"inputs_pdos: []", "3:32", "empty list"},
        {"mapping: [{pdo: 0x1C00, entries: [gap/8]}]", "3:28", "has the PDO 0x1C00"},
        {"mapping: [{pdo: 0x1A00, entries: [0x6000:1]}]", "3:53", "'0x6000:1' is no entry of a PDO"},
        {"mapping: [{pdo: 0x1A00, entries: [gap/0]}]", "3:53", "'gap/0' is no entry"},
        {"mapping: [{pdo: 0x1A00, entries: [gap/256]}]", "3:53", "'gap/256' is no entry"},
        {"mapping: [{pdo: 0x1A00, entries: [0x6000:111/8]}]", "3:53", "'0x6000:111/8' is no entry"},
        {"mapping: [{pdo: 0x1A00}]", "3:29", "'entries' is missing"},
        {"mapping: [{pdo: 0x1A00, entries: [gap/8]}, {pdo: 0x1A01, entries: [gap/8]}, {pdo: 0x1A00, "
         "entries: [gap/8]}]", "3:28", "has the PDO 0x1A00 twice"},
        {"sdo: [{object: 0x8000:01, type: UINT, value: 65536}]", "3:64", "value is '65536', which is no UINT; expected 0 ... 65535, "
         "or 0x0 ... 0xFFFF"},
        {"sdo: [{object: 0x8000:01, type: INT, value: -32769}]", "3:63", "which is no INT"},
        {"sdo: [{object: 0x8000:01, type: UINT, value: 1.5}]", "3:64", "which is no UINT"},
        {"sdo: [{object: 0x8000:01, type: UINT, value: 0x10000}]", "3:64", "which is no UINT"},
        {"sdo: [{object: 0x8000:01, type: UINT, value: true}]", "3:64", "which is no UINT"},
        {"sdo: [{object: 0x8000:01, type: LINT, value: 9223372036854775808}]", "3:64", "which is no LINT; expected "
         "-9223372036854775808 ... 9223372036854775807, or 0x0 ... 0xFFFFFFFFFFFFFFFF"},
        {"sdo: [{object: 0x8000:01, type: BOOL, value: 2}]", "3:64", "which is no BOOL; expected true, false, 0 or 1"},
        {"sdo: [{object: 0x8000:01, type: REAL, value: nan}]", "3:64", "which is no REAL"},
        {"sdo: [{object: 0x8000:01, type: REAL, value: -1e39}]", "3:64", "which is no REAL; expected a number that is "
         "neither too large nor too small for it"},
        {"sdo: [{object: 0x8000:01, type: REAL, value: 1e-60}]", "3:64", "which is no REAL; expected"},
        {"sdo: [{object: 0x8000:01, type: LREAL, value: 1e309}]", "3:65", "which is no LREAL; expected"},
        {"sdo: [{object: 0x8000:01, type: LREAL, value: 1e-400}]", "3:65", "which is no LREAL; expected"},
        {"sdo: [{object: 0x8000:01, type: WORD, value: 1}]", "3:51", "type is 'WORD'; expected one of: BOOL, SINT, USINT, "
         "INT, UINT, DINT, UDINT, LINT, ULINT, REAL, LREAL"},
        {"sdo: [{object: 0x80000:01, type: UINT, value: 1}]", "3:34", "object is '0x80000:01'; expected it as in"},
        {"sdo: [{object: \"0x8000:\", type: UINT, value: 1}]", "3:34", "object is '0x8000:'"},
        {"sdo: [{object: 0x8000:001, type: UINT, value: 1}]", "3:34", "object is '0x8000:001'"},
        {"inputs_pdos: [0x1A000]", "3:33", "'0x1A000' is no PDO"},
        {"inputs_pdos: [0x1A0g]", "3:33", "'0x1A0g' is no PDO"},
        {"mapping: [{pdo: 0x1A00, entries: [gap/+8]}]", "3:53", "'gap/+8' is no entry"},
        {"mapping: [{pdo: 0x1A00, entries: [gap/08]}]", "3:53", "'gap/08' is no entry"},
        {"mapping: [{pdo: 0x1A00, entries: [gap/x]}]", "3:53", "'gap/x' is no entry"},
        {"mapping: [{pdo: 0x1A00, entries: [gap/8x]}]", "3:53", "'gap/8x' is no entry"},
        {"inputs: [{name: 0x6000:01, bit: 1}]", "3:28", "has the name '0x6000:01'"},
        {"inputs: [{name: a, object: 0x6000:001}]", "3:46", "object is '0x6000:001'; expected it as in 0x6000:01"},
        {"inputs: [{name: a, object: 0x6000:1z}]", "3:46", "object is '0x6000:1z'"},
        {"inputs: [{name: a, object: 0x60000}]", "3:46", "object is '0x60000'"},
        {"inputs: [{name: a, object: 0x0:01}]", "3:46", "object is '0x0:01'"},
        {"outputs: [{name: OUTPUT 1, bit: 1}]", "3:29", "has the name 'OUTPUT 1'"},
        {"sdo: [{object: 8000, type: UINT, value: 1}]", "3:34", "object is '8000'"},
        {"sdo: [{object: 0x0800:01, type: UINT, value: 1}]", "3:34", "expected an object from 0x1000 on"},
        {"sdo: [{object: 0x8000:01, value: 1}]", "3:25", "'type' is missing"},
        {"sdo: [{object: 0x8000:01, type: UINT, value: 1, before: init}]", "3:75", "expected one of: safe_op, op"},
        {"inputs: [{name: a}]", "3:28", "neither an object nor a bit"},
        {"inputs: [{name: a, bit: 1, object: 0x6000:01}]", "3:28", "an object and a bit"},
        {"inputs: [{name: a, bit: 1, safe: 1}]", "3:46", "unknown key 'safe'"},
        {"inputs: [{name: input 1, bit: 1}]", "3:28", "has the name 'input 1'"},
        {"inputs: [{name: a, bit: 1}, {name: A, bit: 2}]", "3:47", "which another signal of the slave has already"},
        {"inputs: [{name: a, bit: 1, type: REAL, bits: 8}]", "3:28", "has 8 bits; a REAL has 32"},
        {"inputs: [{name: a, bit: 11888}]", "3:43", "0 ... 11887"},
        {"outputs: [{name: a, bit: 1, safe: 2}]", "3:29", "has the safe value 2, which is no BOOL of 1 bits"},
        {"outputs: [{name: a, bit: 1, safe: maybe}]", "3:53", "expected a number, true, false or hold"},
        {"sim: {inputs: 3}", "3:24", "'device' is missing"},
        {"modules: [517]", "3:29", "'517' is no ident of a module; expected it as in 0x00000205"},
        {"sim: {device: modular}", "3:", "has 0 entries; expected 1 ... 8 of a simulated modular device"},
        {"modules: [0x205, 0x999], sim: {device: modular}", "3:", "has 0x00000999, which is not simulated"},
        {"sim: {device: encoder, outputs: 1}", "3:", "an encoder has inputs only"},
        {"sim: {device: encoder, inputs: 1, counts_per_s: 2e9}", "3:", "up to 1e+09"},
        {"sim: {device: analog, inputs: 1, counts_per_s: 5}", "3:", "of the device encoder only"},
        {"sim: {device: digital, inputs: 1, swapped: true}", "3:", "of the device analog or encoder only"},
        {"sim: {device: digital}", "3:24", "neither inputs nor outputs"},
        {"sim: {device: coupler, inputs: 1}", "3:24", "which its device has not"},
        {"sim: {device: digital, inputs: 9}", "3:50", "1 ... 8"},
        {"sim: {device: digital, outputs: 9}", "3:51", "1 ... 8"},
        {"inputs: [{name: a, object: 0x6000:01, bits: 11889}]", "3:", "1 ... 11888"},
        {"sim: {device: digital, inputs: 1, wired_to: x}", "3:63", "expected the name of a slave of the list"},
        {"sim: {device: digital, outputs: 1, wired_to: x}", "3:64", "there are no inputs to wire"},
        {"name: a}\n  - {name: A, position: 4", "4:12", "is also the name of entry 1"},
        {"name: a}\n  - {position: 3", "4:16", "is 3, which entry 1 of the list has already"},
        {"name: a}\n  - {position: 9", "4:16", "where the axis feed is"},
        {"name: a}\n  - {name: b", "4:5", "position is missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect_wrong(cases[i].keys, cases[i].place, cases[i].part);
}

static void test_optional_slaves_groups_and_who_brings_them_back(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(
        "axes:\n  - {name: a}\n  - {name: tool, explicit_id: 7, optional: true, recover: auto, sim: {absent: true}}\n"
        "  - {name: b}\n"
        "slaves:\n  - {name: changer, alias: 5, hot_connect: gripper, vendor: 0x1, product: 0x2, recover: never}\n"
        "  - {name: fingers, position: 3, hot_connect: gripper, vendor: 0x1, product: 0x3, recover: ask}\n"
        "  - {name: lamp, explicit_id: 8, optional: true, vendor: 0x1, product: 0x4, sim: {device: coupler, "
        "absent: true}}\n"), diag.text);
    TEST_ASSERT_TRUE(config.axes[1].optional && config.axes[1].sim_absent && !config.axes[0].optional);
    TEST_ASSERT_EQUAL(CM1E_RECOVER_AUTO, config.axes[1].recover);
    TEST_ASSERT_EQUAL(CM1E_RECOVER_DEFAULT, config.axes[0].recover);
    TEST_ASSERT_EQUAL_MESSAGE(2, config.axes[2].address, "places count without optional slaves");
    TEST_ASSERT_EQUAL_STRING("gripper", config.slaves[0].hot_connect);
    TEST_ASSERT_EQUAL(CM1E_RECOVER_NEVER, config.slaves[0].recover);
    TEST_ASSERT_EQUAL(3, config.slaves[1].address);
    TEST_ASSERT_EQUAL(CM1E_RECOVER_ASK, config.slaves[1].recover);
    TEST_ASSERT_TRUE(config.slaves[2].optional && config.slaves[2].sim_absent);
}

static void test_slaves_of_an_older_or_newer_program(void)
{
    const size_t old = offsetof(cm1e_bus_config_t, slave_size);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(everything), diag.text);
    cm1e_bus_config_t older = {0};
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_load_sized(&older, old, sizeof(cm1e_axis_config_t), temporary,
                                                                    &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "compile it again"), diag.text);
    const size_t larger = sizeof(cm1e_slave_config_t) + 24;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_size_slaves(&config, larger, &diag));
    const cm1e_slave_config_t *second = (cm1e_slave_config_t *)(void *)((char *)config.slaves + larger);
    TEST_ASSERT_EQUAL_STRING("other", second->name);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_check(&config, &diag), diag.text);
}

static void test_a_file_has_axes_or_slaves(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load("slaves: [{position: 1}]\n"), diag.text);
    TEST_ASSERT_EQUAL(0, config.axis_count);
    TEST_ASSERT_EQUAL(1, config.slave_count);
    cm1e_bus_config_free(&config);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, load("bus: {interface: sim}\n"));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "expected axes, slaves or both"), diag.text);
}

static void test_no_more_slaves_than_the_maximum(void)
{
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_init(&config, "sim", 0));
    for (unsigned i = 0; i < CM1E_MAX_SLAVES; i++) {
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, NULL);
        TEST_ASSERT_NOT_NULL(slave);
        slave->address = (uint16_t)(i + 1);
    }
    TEST_ASSERT_NULL(cm1e_bus_config_add_slave(&config, NULL));
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_check(&config, &diag), diag.text);
    config.slaves[5].signal_count = CM1E_SLAVE_SIGNALS + 1;
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag));
    config.slaves[5].signal_count = 0;
    config.slave_count++;
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag));
    config.slave_count--;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_key_becomes_what_it_says);
    RUN_TEST(test_sdos_have_the_bits_of_their_values);
    RUN_TEST(test_the_bounds_of_whole_numbers_are_those_of_their_types);
    RUN_TEST(test_zero_is_a_value_of_every_type);
    RUN_TEST(test_modules_and_simulated_devices);
    RUN_TEST(test_mapping_and_signals_are_in_their_order);
    RUN_TEST(test_wrong_keys_are_told_with_place_and_cure);
    RUN_TEST(test_optional_slaves_groups_and_who_brings_them_back);
    RUN_TEST(test_slaves_of_an_older_or_newer_program);
    RUN_TEST(test_a_file_has_axes_or_slaves);
    RUN_TEST(test_no_more_slaves_than_the_maximum);
    return UNITY_END();
}
