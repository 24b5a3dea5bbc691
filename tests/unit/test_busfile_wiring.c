/* Inputs, outputs and encoders of axes on other slaves' bits, in a bus file: what each key becomes, and what a wrong one
 * is told. */
#include <stdio.h>
#include <string.h>

#include "cm1e/config.h"
#include "unity.h"

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_wiring.yaml";
static cm1e_bus_config_t config;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) { cm1e_bus_config_free(&config); }

static cm1e_error_t load(const char *axes)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_GREATER_THAN(0, fprintf(file, "axes:\n%s", axes));
    TEST_ASSERT_GREATER_THAN(0, fprintf(file, "slaves:\n  - {name: switches, position: 2}\n  - {position: 3}\n"
                                            "  - name: mixed\n    position: 4\n"
                                            "    inputs: [{name: bit, bit: 0}, {name: byte, bit: 8, bits: 8}, "
                                            "{name: object, object: 0x6000:01}, {name: real, bit: 16, type: REAL}, "
                                            "{name: long, bit: 48, bits: 65}, "
                                            "{name: narrow, object: 0x6000:02, type: USINT}]\n"
                                            "    outputs: [{name: lamp, bit: 0}, {name: level, object: 0x7000:01, "
                                            "type: REAL}]\n"));
    TEST_ASSERT_EQUAL(0, fclose(file));
    return cm1e_bus_config_load(&config, temporary, &diag);
}

static void test_every_key_becomes_what_it_says(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(
        "  - name: feed\n"
        "    inputs:\n"
        "      signals: [switches.part, Switches.input 4]\n"
        "      home: switches.home\n"
        "      limit_positive: SWITCHES.PART\n"
        "      limit_negative: 3\n"
        "    outputs: {signals: [slave2.output 1, \"switches.0x7000:01\"]}\n"
        "  - {name: belt, type: encoder, encoder_signal: slave2.count, unit: {counts_per_unit: 20.48},\n"
        "     limits: {velocity: 1500}, inputs: {signals: [switches.mark]}}\n"), diag.text);
    const cm1e_axis_config_t *feed = &config.axes[0], *belt = &config.axes[1];
    TEST_ASSERT_EQUAL(3, feed->wiring.input_count);
    TEST_ASSERT_EQUAL_STRING("switches.part", feed->wiring.inputs[0]);
    TEST_ASSERT_EQUAL_STRING("Switches.input 4", feed->wiring.inputs[1]);
    TEST_ASSERT_EQUAL_STRING("switches.home", feed->wiring.inputs[2]);
    TEST_ASSERT_EQUAL(CM1E_WIRED_FIRST + 2, feed->inputs.home);
    TEST_ASSERT_EQUAL(CM1E_WIRED_FIRST, feed->inputs.limit_positive);
    TEST_ASSERT_EQUAL(3, feed->inputs.limit_negative);
    TEST_ASSERT_EQUAL(2, feed->wiring.output_count);
    TEST_ASSERT_EQUAL_STRING("switches.0x7000:01", feed->wiring.outputs[1]);
    TEST_ASSERT_EQUAL_STRING("", feed->wiring.encoder);
    TEST_ASSERT_EQUAL_STRING("slave2.count", belt->wiring.encoder);
    TEST_ASSERT_EQUAL_DOUBLE(1500.0, belt->max_velocity);
    TEST_ASSERT_EQUAL(1, belt->wiring.input_count);
    TEST_ASSERT_EQUAL(0, belt->inputs.home);
}

static void test_wrong_keys_are_told_with_their_place(void)
{
    static const struct {
        const char *axes, *place, *words;
    } cases[] = {
        {"  - {inputs: {home: 5}}\n", ":2:21: ", "home is '5'; expected 1 ... 4, or a signal of a slave"},
        {"  - {inputs: {home: 11}}\n", ":2:21: ", "home is '11'"},
        {"  - {inputs: {home: switches}}\n", ":2:21: ", "home is 'switches'"},
        {"  - {inputs: {home: valves.input 1}}\n", ":2:", "has 'valves.input 1'; expected the name of a slave"},
        {"  - {inputs: {signals: [switches.]}}\n", ":2:", "has 'switches.'"},
        {"  - {inputs: {signals: [switches.a, SWITCHES.A]}}\n", ":2:", "has 'SWITCHES.A' twice"},
        {"  - {inputs: {signals: []}}\n", ":2:", "signals"},
        {"  - {outputs: {signals: [switches.a]}}\n  - {outputs: {signals: [switches.A]}}\n", ":3:",
         "which axis 1 of the list has too"},
        {"  - {inputs: {signals: [switches.1, switches.2, switches.3, switches.4, switches.5, switches.6, switches.7,\n"
         "               switches.8], home: switches.9}}\n", ":3:", "an axis has at most eight"},
        {"  - {inputs: {signals: [switches.1, switches.2, switches.3, switches.4, switches.5, switches.6, switches.7,\n"
         "               switches.8, switches.9]}}\n", ":3:", "signals has 9 entries; expected at most 8"},
        {"  - {type: encoder, encoder_signal: switches.a}\n", ":2:", "needs limits.velocity"},
        {"  - {type: encoder, limits: {velocity: 5}}\n", ":2:", "limits.velocity"},
        {"  - {encoder_signal: switches.a, limits: {velocity: 5}}\n", ":2:", "expected `type: encoder`"},
        {"  - {type: virtual, inputs: {home: switches.a}}\n", ":2:", "inputs"},
        {"  - {inputs: {limit_positive: switches.a, limit_negative: switches.a}}\n", ":2:", "expected another input"},
        {"  - {inputs: {signals: [mixed.lamp]}}\n", ":2:24: ", "has 'mixed.lamp', which is an output of its slave"},
        {"  - {outputs: {signals: [mixed.bit]}}\n", ":2:25: ", "has 'mixed.bit', which is an input of its slave"},
        {"  - {inputs: {signals: [mixed.byte]}}\n", ":2:24: ", "has 8 bits; expected a signal of a single bit"},
        {"  - {inputs: {signals: [MIXED.Real]}}\n", ":2:24: ", "has 32 bits"},
        {"  - {outputs: {signals: [mixed.level]}}\n", ":2:25: ", "has 32 bits"},
        {"  - {type: encoder, encoder_signal: mixed.bit, limits: {velocity: 5}}\n", ":2:37: ", "is no counter"},
        {"  - {type: encoder, encoder_signal: mixed.real, limits: {velocity: 5}}\n", ":2:37: ", "is no counter"},
        {"  - {type: encoder, encoder_signal: mixed.long, limits: {velocity: 5}}\n", ":2:37: ", "is no counter"},
        {"  - {type: encoder, encoder_signal: mixed.level, limits: {velocity: 5}}\n", ":2:37: ", "is an output of"},
        {"  - {outputs: {signals: [switches.0123456789012345678901234567890123456789012345678901234567]}}\n", ":2:",
         "signals"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, load(cases[i].axes), cases[i].axes);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, cases[i].place), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, cases[i].words), diag.text);
    }
}

static void test_signals_that_may_fit_are_left_to_the_bus(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, load(
        "  - {inputs: {signals: [mixed.bit, mixed.object, mixed.input 2, mixed.narrow]}, "
        "outputs: {signals: [mixed.lamp]}}\n"
        "  - {type: encoder, encoder_signal: mixed.byte, limits: {velocity: 5}}\n"
        "  - {type: encoder, encoder_signal: mixed.object, limits: {velocity: 5}}\n"), diag.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_key_becomes_what_it_says);
    RUN_TEST(test_wrong_keys_are_told_with_their_place);
    RUN_TEST(test_signals_that_may_fit_are_left_to_the_bus);
    return UNITY_END();
}
