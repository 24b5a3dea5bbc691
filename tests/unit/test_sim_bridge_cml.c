/* CML over the mailbox of the simulated bridge (BR 7.2) by the flows of BR appendix 2. */
#include "sim_bridge_bench.h"

enum { CSP = 8, CML = 101, CMD = 120, FIVE_CYCLES = 5, TOO_LONG = 0x06070012, WRONG_STATE = 0x08000022 };

static bench_t b;
static char answer[80];

static int64_t switched(int axis, int8_t mode)
{
    bench_cycles(&b, 6);
    bench_write(&b, (uint16_t)(0x6060 + 0x800 * axis), 0, mode);
    bench_cycles(&b, 6);
    return bench_read(&b, (uint16_t)(0x6061 + 0x800 * axis), 0);
}

void setUp(void)
{
    bench_open(&b, CM1E_DEVICE_EB12);
    for (int axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        TEST_ASSERT_EQUAL(CML, switched(axis, CML));
    bench_cycles(&b, FIVE_CYCLES); /* controlword 0000h */
}
void tearDown(void) { bench_close(&b); }

static uint32_t send(int axis, const char *text)
{
    return b.ops->sdo_write(b.bridge, (uint16_t)(0xF581 + axis), 0, BENCH_OP, (const uint8_t *)text, strlen(text));
}

static const char *receive(int axis)
{
    size_t size = sizeof answer - 1;
    TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_read(b.bridge, (uint16_t)(0xF591 + axis), 0, BENCH_OP, (uint8_t *)answer,
                                               &size));
    answer[size] = '\0';
    return answer;
}

static void check(int axis, const char *expected)
{
    TEST_ASSERT_EQUAL_STRING(expected, receive(axis));
    TEST_ASSERT_EQUAL_STRING("Null\r\n", receive(axis));
}

static void ask(int axis, const char *text, const char *expected)
{
    TEST_ASSERT_EQUAL_HEX32(0, send(axis, text));
    TEST_ASSERT_EQUAL_STRING("Null\r\n", receive(axis)); /* "has possibly not received the reply" */
    bench_cycles(&b, 9);
    check(axis, expected);
}

static void test_parameters_are_read_and_written(void)
{
    ask(0, "K53.1", "K53.1=0\r\n");
    ask(0, "K53.1=100", "Null\r\n");
    ask(0, "K53.1", "K53.1=100\r\n");
    TEST_ASSERT_EQUAL(100, bench_read(&b, 0x60F6, 53 - 20) /* available on a CM1 */);
    ask(2, "K42.3=55", "Null\r\n");
    TEST_ASSERT_EQUAL(55, bench_read(&b, 0x7099, 1));
    ask(1, "K37.2", "K37.2=10\r\n"); /* "N/A" as an object, but the motor has it */
}

static void test_what_the_motor_does_not_understand_has_no_answer(void)
{
    static const char *const texts[] = {"K66.1", "K20.1", "K100.1", "K42.1=0", "K42.1=x", "K42.1=", "?98.1", "X",
                                        "?99.2", "K53.", "?99.1x", ",,", "K", "?", "|.2", "O1.1=3"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        ask(0, texts[i], "Null\r\n");
    TEST_ASSERT_EQUAL(100, bench_read(&b, 0x6099, 1));
    ask(0, "", "Null\r\n");
}

static void test_queries(void)
{
    ask(0, "?99.1", "Ux.1=8\r\n");
    ask(3, "?99.4", "Ux.4=16\r\n"); /* a CM2 is free from the start */
    ask(3, "(.4", "Null\r\n");
    ask(3, "?99", "Ux.4=8\r\n");
    ask(1, "?96.2", "Px.2=0\r\n");
    cm1e_sim_bridge_axis_error(&b.bridge->axes[1], BRIDGE_STATUS_OVERLOAD);
    ask(1, "?99.2", "Ux.2=4\r\n");
}

static void test_several_commands_in_a_string_answer_one_by_one(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "K42.1,?99.1,K43.1"));
    bench_cycles(&b, 5);
    TEST_ASSERT_EQUAL_STRING("K42.1=100\r\n", receive(0));
    TEST_ASSERT_EQUAL_STRING("Ux.1=8\r\n", receive(0));
    check(0, "K43.1=100\r\n");
}

/* Appendix 2.5: every 10 ms a line, until there is none. */
static void test_a_list_comes_line_by_line(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, send(2, "?90.3"));
    bench_cycles(&b, 5);
    int lines = 0, last = 0, number = 0;
    while (strcmp(receive(2), "Null\r\n") != 0) {
        TEST_ASSERT_EQUAL(1, sscanf(answer, "K%d.3=", &number));
        TEST_ASSERT_TRUE(number > last);
        last = number;
        if (lines++ == 0)
            TEST_ASSERT_EQUAL_STRING("Null\r\n", receive(2)); /* the next one is still to come */
        bench_cycles(&b, 10);
    }
    size_t expected = 0;
    for (uint8_t sub = 1; sub <= 79; sub++)
        expected += cm1e_bridge_entry(CM1E_DEVICE_EB12, 0x70F6, sub)->availability != CM1E_NO_PARAMETER;
    TEST_ASSERT_EQUAL(expected, lines);
}

static void test_an_answer_stays_until_it_is_read(void)
{
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "K42.1"));
    bench_cycles(&b, 100);
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "?99.1"));
    bench_cycles(&b, 10);
    TEST_ASSERT_EQUAL_STRING("K42.1=100\r\n", receive(0)); /* "another data received previously" */
    check(0, "Ux.1=8\r\n");
    for (int i = 0; i < 20; i++) { /* what finds no room is lost */
        send(0, "?99.1");
        bench_cycles(&b, 9);
    }
    for (int i = 0; i < CML_LINES; i++)
        TEST_ASSERT_EQUAL_STRING("Ux.1=8\r\n", receive(0));
    TEST_ASSERT_EQUAL_STRING("Null\r\n", receive(0));
}

/* Less than 32 bytes 4 ms, more 8 ms. */
static void test_a_string_that_comes_too_soon_is_lost(void)
{
    static const char text[] = "K42.1,,,,,,,,,,,,,,,,,,,,,,,,,,,,"; /* 33 bytes */
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "?99.1"));
    bench_cycles(&b, 3);
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "K42.1"));
    bench_cycles(&b, 4);
    check(0, "Ux.1=8\r\n");
    TEST_ASSERT_EQUAL_HEX32(0, send(0, text));
    bench_cycles(&b, 7);
    TEST_ASSERT_EQUAL_STRING("Null\r\n", receive(0));
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "?99.1"));
    bench_cycles(&b, 8);
    check(0, "K42.1=100\r\n");
}

static void test_controlwords_keep_the_line_busy(void)
{
    b.axes[0].controlword = 0x0F;
    bench_cycles(&b, 2);
    ask(0, "?99.1", "Null\r\n");
    b.axes[0].controlword = 0;
    bench_cycles(&b, 3);
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "?99.1")); /* the third is on its way */
    b.axes[0].controlword = 0x0F;
    bench_cycles(&b, 10);
    check(0, "Null\r\n");
    b.axes[0].controlword = 0;
    bench_cycles(&b, FIVE_CYCLES);
    ask(0, "?99.1", "Ux.1=8\r\n");
    b.ops->state_change(b.bridge, BENCH_OP, BENCH_PREOP); /* no controlwords at all */
    bench_wait(&b, 10 * BENCH_MS);
    TEST_ASSERT_EQUAL_HEX32(0, send(0, "?99.1"));
    bench_wait(&b, 10 * BENCH_MS);
    check(0, "Ux.1=8\r\n");
}

static void test_strings_that_are_refused_or_lost(void)
{
    char text[66];
    memset(text, ',', sizeof text);
    text[65] = '\0';
    TEST_ASSERT_EQUAL_HEX32(TOO_LONG, send(0, text));
    text[64] = '\0';
    TEST_ASSERT_EQUAL_HEX32(0, send(0, text));
    bench_cycles(&b, 10);
    ask(0, "?99.1\r\n", "Null\r\n");
    TEST_ASSERT_EQUAL(CSP, switched(0, CSP));
    TEST_ASSERT_EQUAL_HEX32(WRONG_STATE, send(0, "?99.1"));
    TEST_ASSERT_EQUAL_STRING("Null\r\n", receive(0));
}

static void search(int axis, const char *command)
{
    const uint16_t offset = (uint16_t)(0x800 * axis);
    bench_write(&b, (uint16_t)(0x6099 + offset), 1, 1000);
    bench_write(&b, (uint16_t)(0x609A + offset), 0, 1000);
    bench_write(&b, (uint16_t)(0x6098 + offset), 0, 4);
    TEST_ASSERT_EQUAL_HEX32(0, send(axis, command));
    bench_cycles(&b, 1000);
    TEST_ASSERT_EQUAL_STRING("Null\r\n", receive(axis));
}

/* Appendix 2.4. */
static void test_origin_search(void)
{
    search(0, "|.1");
    bench_cycles(&b, 3000);
    check(0, "Origin.1=0\r\n");
    TEST_ASSERT_DOUBLE_WITHIN(1, -150000, b.bridge->axes[0].mechanics.position);
    search(1, "|.2");
    cm1e_sim_bridge_axis_error(&b.bridge->axes[1], BRIDGE_STATUS_OVER_SPEED);
    bench_cycles(&b, 2);
    check(1, "Ux.2=2\r\n"); /* "No Origin Detected" */
    ask(2, "|.3", "Ux.3=16\r\n");
}

/* Appendix 2.6. */
static void test_outputs(void)
{
    ask(3, "O1.4,O2.4,F3.4,O4.4", "Null\r\n");
    TEST_ASSERT_EQUAL_HEX8(0x0B, b.bridge->axes[3].outputs);
    ask(3, "F1.4,O5.4,F0.4", "Null\r\n");
    TEST_ASSERT_EQUAL_HEX8(0x0A, b.bridge->axes[3].outputs);
    ask(0, "O1.1,O2.1,O3.1", "Null\r\n");
    TEST_ASSERT_EQUAL_HEX8(0x02, b.bridge->axes[0].outputs);
}

static void test_motor_free_and_enable(void)
{
    ask(0, ").1", "Null\r\n");
    TEST_ASSERT_TRUE(b.bridge->axes[0].motor_free);
    ask(0, "(.1", "Null\r\n");
    TEST_ASSERT_FALSE(b.bridge->axes[0].motor_free);
}

/* ---- the mode --------------------------------------------------------------------------------------------------- */

static void test_from_cml_back_to_csp_the_axis_moves_again(void)
{
    TEST_ASSERT_EQUAL(CML, switched(0, 6)); /* hm is reached from csp only */
    TEST_ASSERT_EQUAL(CSP, switched(0, CSP));
    bench_cycles(&b, 2);
    bench_enable(&b, 0);
    TEST_ASSERT_EQUAL_HEX16(0x1000, b.axes[0].statusword & 0x1000);
}

/* "It will possibly result in operating abnormal" (BR 6, note 2). */
static void test_csp_by_way_of_cml_after_cmd_moves_nothing(void)
{
    TEST_ASSERT_EQUAL(CMD, switched(0, CMD));
    TEST_ASSERT_EQUAL(CML, switched(0, CML));
    TEST_ASSERT_EQUAL(CSP, switched(0, CSP));
    bench_enable(&b, 0);
    for (int i = 0; i < 100; i++) {
        b.axes[0].target += 10;
        bench_cycles(&b, 1);
        TEST_ASSERT_EQUAL_HEX16(0, b.axes[0].statusword & 0x1000);
    }
    TEST_ASSERT_EQUAL_INT32(0, b.axes[0].position);
    b.ops->power_on(b.bridge, b.now_ns);
    b.axes[0].controlword = 0;
    bench_cycles(&b, 100);
    bench_enable(&b, 0);
    TEST_ASSERT_EQUAL_HEX16(0x1000, b.axes[0].statusword & 0x1000);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_parameters_are_read_and_written);
    RUN_TEST(test_what_the_motor_does_not_understand_has_no_answer);
    RUN_TEST(test_queries);
    RUN_TEST(test_several_commands_in_a_string_answer_one_by_one);
    RUN_TEST(test_a_list_comes_line_by_line);
    RUN_TEST(test_an_answer_stays_until_it_is_read);
    RUN_TEST(test_a_string_that_comes_too_soon_is_lost);
    RUN_TEST(test_controlwords_keep_the_line_busy);
    RUN_TEST(test_strings_that_are_refused_or_lost);
    RUN_TEST(test_origin_search);
    RUN_TEST(test_outputs);
    RUN_TEST(test_motor_free_and_enable);
    RUN_TEST(test_from_cml_back_to_csp_the_axis_moves_again);
    RUN_TEST(test_csp_by_way_of_cml_after_cmd_moves_nothing);
    return UNITY_END();
}
