/* The AL state machine: every change from every state, its conditions, error and acknowledgement, device ID. */
#include "sim_fake_app.h"

static bench_t b;

void setUp(void) { bench_open(&b, 1); }
void tearDown(void) { bench_close(&b); }

static const uint8_t states[] = {CM1E_AL_INIT, CM1E_AL_PRE_OP, CM1E_AL_SAFE_OP, CM1E_AL_OP};

/* The AL status code of every request (0-15) in every state; 0: it is done. */
static uint16_t expected_code(uint8_t from, uint8_t to)
{
    switch (to) {
    case CM1E_AL_INIT:
    case CM1E_AL_PRE_OP:
        return 0;
    case CM1E_AL_BOOT:
        return from == CM1E_AL_INIT ? AL_CODE_BOOT_NOT_SUPPORTED : AL_CODE_INVALID_STATE_CHANGE;
    case CM1E_AL_SAFE_OP:
        return from == CM1E_AL_INIT ? AL_CODE_INVALID_STATE_CHANGE : 0;
    case CM1E_AL_OP:
        return from < CM1E_AL_SAFE_OP ? AL_CODE_INVALID_STATE_CHANGE : 0;
    default:
        return AL_CODE_UNKNOWN_STATE;
    }
}

static void test_every_request_in_every_state_is_answered_as_the_standard_says(void)
{
    for (unsigned i = 0; i < 4; i++)
        for (uint8_t to = 0; to < 16; to++) {
            char text[48];
            snprintf(text, sizeof text, "state %u, request %u", states[i], to);
            tearDown();
            setUp();
            configure_mailboxes(&b, 0);
            configure_process_data(&b, 0);
            for (unsigned step = 0; step <= i; step++)
                TEST_ASSERT_EQUAL_HEX16_MESSAGE(states[step], request_state(&b, 0, states[step]), text);
            const uint16_t code = expected_code(states[i], to), status = request_state(&b, 0, to);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(code, read_u16(&b, 0, 0x0134), text);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(code ? states[i] | CM1E_AL_ERROR : to, status, text);
        }
}

static void test_a_change_takes_time(void)
{
    configure_mailboxes(&b, 0);
    write_u16(&b, 0, 0x0120, CM1E_AL_PRE_OP);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT, read_u16(&b, 0, 0x0130));
    /* asking again does not make it longer */
    for (int i = 0; i < 4; i++) {
        bench_wait(&b, 50000);
        write_u16(&b, 0, 0x0120, CM1E_AL_PRE_OP);
    }
    bench_wait(&b, 1);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, read_u16(&b, 0, 0x0130));
}

static void test_an_error_is_acknowledged_before_anything_else_happens(void)
{
    configure_mailboxes(&b, 0);
    TEST_ASSERT_EQUAL_HEX16(0x11, request_state(&b, 0, CM1E_AL_OP));
    TEST_ASSERT_EQUAL_HEX16(0x11, request_state(&b, 0, CM1E_AL_PRE_OP));
    TEST_ASSERT_EQUAL_HEX16(AL_CODE_INVALID_STATE_CHANGE, read_u16(&b, 0, 0x0134));
    TEST_ASSERT_EQUAL_HEX16(0x01, request_state(&b, 0, CM1E_AL_INIT | CM1E_AL_ERROR));
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 0, 0x0134));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, request_state(&b, 0, CM1E_AL_PRE_OP));
    /* acknowledged and changed at once */
    TEST_ASSERT_EQUAL_HEX16(0x12, request_state(&b, 0, 0x07));
    configure_process_data(&b, 0);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP, request_state(&b, 0, CM1E_AL_SAFE_OP | CM1E_AL_ERROR));
    /* Init starts again in any case */
    TEST_ASSERT_EQUAL_HEX16(0x14, request_state(&b, 0, CM1E_AL_BOOT));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT, request_state(&b, 0, CM1E_AL_INIT));
}

/* One wrong thing at a time in the mailboxes: start, length, control, activate of SM0 and SM1. */
static void test_wrong_mailboxes_are_refused(void)
{
    static const struct {
        uint16_t start[2], length[2];
        uint8_t control[2], activate[2];
    } rows[] = {
        {{0x1000, 0x1080}, {128, 128}, {0x26, 0x22}, {0, 1}},   /* off */
        {{0x1000, 0x1080}, {128, 128}, {0x26, 0x22}, {1, 0}},
        {{0x1000, 0x1080}, {128, 128}, {0x22, 0x22}, {1, 1}},   /* wrong direction */
        {{0x1000, 0x1080}, {128, 128}, {0x26, 0x26}, {1, 1}},
        {{0x1000, 0x1080}, {128, 128}, {0x24, 0x22}, {1, 1}},   /* not a mailbox */
        {{0x1000, 0x1080}, {128, 128}, {0x26, 0x20}, {1, 1}},
        {{0x1000, 0x1080}, {33, 128}, {0x26, 0x22}, {1, 1}},    /* too short */
        {{0x1000, 0x1080}, {128, 33}, {0x26, 0x22}, {1, 1}},
        {{0x1000, 0x1080}, {128, 0}, {0x26, 0x22}, {1, 1}},
        {{0x1000, 0x2000}, {1487, 128}, {0x26, 0x22}, {1, 1}},  /* longer than a frame */
        {{0x1000, 0x107F}, {128, 128}, {0x26, 0x22}, {1, 1}},   /* overlapping */
        {{0x0F00, 0x1080}, {128, 128}, {0x26, 0x22}, {1, 1}},   /* not in the RAM */
        {{0x1000, 0x2FFF}, {128, 128}, {0x26, 0x22}, {1, 1}},
        {{0x1000, 0xFFFF}, {128, 128}, {0x26, 0x22}, {1, 1}},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        tearDown();
        setUp();
        for (unsigned sm = 0; sm < 2; sm++)
            write_sm(&b, 0, sm, rows[i].start[sm], rows[i].length[sm], rows[i].control[sm], rows[i].activate[sm]);
        TEST_ASSERT_EQUAL_HEX16(0x11, request_state(&b, 0, CM1E_AL_PRE_OP));
        TEST_ASSERT_EQUAL_HEX16(AL_CODE_INVALID_MAILBOX_PREOP, read_u16(&b, 0, 0x0134));
    }
}

static void test_wrong_process_data_is_refused(void)
{
    static const struct {
        uint16_t start[2], length[2];
        uint8_t control[2], activate[2];
        uint16_t code;
    } rows[] = {
        {{0x1100, 0x1400}, {12, 21}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_OUTPUT_CONFIG},
        {{0x1100, 0x1400}, {14, 21}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_OUTPUT_CONFIG},
        {{0x1100, 0x1400}, {13, 20}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_INPUT_CONFIG},
        {{0x1100, 0x1400}, {13, 22}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_INPUT_CONFIG},
        {{0x1100, 0x1400}, {13, 21}, {0x64, 0x20}, {0, 1}, AL_CODE_INVALID_OUTPUT_CONFIG},
        {{0x1100, 0x1400}, {13, 21}, {0x64, 0x20}, {1, 0}, AL_CODE_INVALID_INPUT_CONFIG},
        {{0x1100, 0x1400}, {13, 21}, {0x60, 0x20}, {1, 1}, AL_CODE_INVALID_OUTPUT_CONFIG},
        {{0x1100, 0x1400}, {13, 21}, {0x64, 0x24}, {1, 1}, AL_CODE_INVALID_INPUT_CONFIG},
        {{0x1100, 0x1400}, {13, 21}, {0x66, 0x20}, {1, 1}, AL_CODE_INVALID_OUTPUT_CONFIG},
        {{0x10F7, 0x1400}, {13, 21}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_OUTPUT_CONFIG}, /* in the mailbox */
        {{0x1100, 0x110C}, {13, 21}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_OUTPUT_CONFIG},
        {{0x2FF8, 0x1400}, {13, 21}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_OUTPUT_CONFIG},
        {{0x1100, 0x2FEC}, {13, 21}, {0x64, 0x20}, {1, 1}, AL_CODE_INVALID_INPUT_CONFIG},
    };
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[16];
        snprintf(text, sizeof text, "row %u", i);
        tearDown();
        setUp();
        write_sm(&b, 0, 0, 0x1000, 128, 0x26, 1);
        write_sm(&b, 0, 1, 0x1080, 120, 0x22, 1);
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, request_state(&b, 0, CM1E_AL_PRE_OP));
        for (unsigned sm = 0; sm < 2; sm++)
            write_sm(&b, 0, sm + 2, rows[i].start[sm], rows[i].length[sm], rows[i].control[sm], rows[i].activate[sm]);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(0x12, request_state(&b, 0, CM1E_AL_SAFE_OP), text);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(rows[i].code, read_u16(&b, 0, 0x0134), text);
    }
}

static void test_a_slave_without_process_data_wants_no_sync_manager_for_it(void)
{
    b.apps[0]->output_bytes = b.apps[0]->input_bytes = 0;
    bring_to(&b, 0, CM1E_AL_PRE_OP);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP, request_state(&b, 0, CM1E_AL_SAFE_OP));
    request_state(&b, 0, CM1E_AL_PRE_OP);
    write_sm(&b, 0, 3, 0x1400, 21, 0x20, 1);
    TEST_ASSERT_EQUAL_HEX16(0x12, request_state(&b, 0, CM1E_AL_SAFE_OP));
    TEST_ASSERT_EQUAL_HEX16(AL_CODE_INVALID_INPUT_CONFIG, read_u16(&b, 0, 0x0134));
}

static void test_the_application_may_refuse(void)
{
    bring_to(&b, 0, CM1E_AL_SAFE_OP);
    b.apps[0]->veto_state = CM1E_AL_OP;
    b.apps[0]->veto_code = AL_CODE_NO_VALID_OUTPUTS;
    TEST_ASSERT_EQUAL_HEX16(0x14, request_state(&b, 0, CM1E_AL_OP));
    TEST_ASSERT_EQUAL_HEX16(AL_CODE_NO_VALID_OUTPUTS, read_u16(&b, 0, 0x0134));
    TEST_ASSERT_EQUAL_UINT8(CM1E_AL_SAFE_OP, cm1e_sim_slave_al_state(cm1e_sim_segment_slave(b.segment, 1)));
}

static void test_the_application_falls_back_by_itself(void)
{
    bring_to(&b, 0, CM1E_AL_OP);
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(b.segment, 1), CM1E_AL_PRE_OP, 0x8001);
    TEST_ASSERT_EQUAL_HEX16(0x12, read_u16(&b, 0, 0x0130));
    TEST_ASSERT_EQUAL_HEX16(0x8001, read_u16(&b, 0, 0x0134));
    TEST_ASSERT_EQUAL_UINT8(CM1E_AL_OP, b.apps[0]->from);
    TEST_ASSERT_EQUAL_UINT8(CM1E_AL_PRE_OP, b.apps[0]->to);
    /* not upwards */
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(b.segment, 1), CM1E_AL_OP, 0x8002);
    TEST_ASSERT_EQUAL_HEX16(0x12, read_u16(&b, 0, 0x0130));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, request_state(&b, 0, CM1E_AL_PRE_OP | CM1E_AL_ERROR));
}

static void test_explicit_device_id_is_told_on_request_in_every_state(void)
{
    configure_mailboxes(&b, 0);
    configure_process_data(&b, 0);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX16(states[i], request_state(&b, 0, states[i]));
        TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 0, 0x0134));
        TEST_ASSERT_EQUAL_HEX16(states[i] | 0x20, request_state(&b, 0, states[i] | 0x20));
        TEST_ASSERT_EQUAL_HEX16(0x20, read_u16(&b, 0, 0x0134));
    }
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, request_state(&b, 0, CM1E_AL_OP));
    TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, 0, 0x0134));
    /* an error comes first */
    TEST_ASSERT_EQUAL_HEX16(0x18, request_state(&b, 0, 0x20 | 0x06));
    TEST_ASSERT_EQUAL_HEX16(AL_CODE_UNKNOWN_STATE, read_u16(&b, 0, 0x0134));
}

static void test_al_control_takes_one_or_two_bytes(void)
{
    configure_mailboxes(&b, 0);
    TEST_ASSERT_EQUAL_INT(1, write_u8(&b, 0, 0x0120, CM1E_AL_PRE_OP));
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, read_u16(&b, 0, 0x0130));
}

static void test_leaving_pre_operational_empties_the_mailboxes(void)
{
    uint8_t junk[1] = {0};
    uint16_t length;
    bring_to(&b, 0, CM1E_AL_PRE_OP);
    mailbox_put(&b, 0x0F, 1, junk, 1);
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX8(0x08, read_u8(&b, 0, 0x080D) & 0x08);
    request_state(&b, 0, CM1E_AL_INIT);
    TEST_ASSERT_EQUAL_HEX8(0, read_u8(&b, 0, 0x080D) & 0x08);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, request_state(&b, 0, CM1E_AL_PRE_OP));
    TEST_ASSERT_EQUAL_INT(-1, mailbox_get(&b, &length));
    /* and the counters start again: 1 is no repetition */
    TEST_ASSERT_EQUAL_INT(1, mailbox_put(&b, 0x0F, 1, junk, 1));
    TEST_ASSERT_EQUAL_HEX8(0x10, mailbox_get(&b, &length));
}

static void test_random_requests_never_leave_the_states(void)
{
    const unsigned seed = 4711;
    printf("seed %u\n", seed);
    srand(seed);
    configure_mailboxes(&b, 0);
    configure_process_data(&b, 0);
    uint16_t before = read_u16(&b, 0, 0x0130);
    for (int i = 0; i < 20000; i++) {
        write_u16(&b, 0, 0x0120, (uint16_t)(rand() & 0x3F));
        bench_wait(&b, rand() % 400000);
        const uint16_t status = read_u16(&b, 0, 0x0130), code = read_u16(&b, 0, 0x0134);
        const uint8_t state = status & 0x0F;
        TEST_ASSERT_TRUE(state == 1 || state == 2 || state == 4 || state == 8);
        TEST_ASSERT_TRUE(!(status & CM1E_AL_ERROR) || code != 0);
        /* upwards one step at a time */
        TEST_ASSERT_TRUE(state <= 2 * (before & 0x0F));
        before = status;
    }
}

/* ---- when time has to pass though no frame comes ---------------------------------------------------------------- */

static int64_t due(void) { return cm1e_sim_segment_due(b.segment); }

static void test_a_segment_says_when_it_has_to_be_advanced_next(void)
{
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, due());
    configure_mailboxes(&b, 0);
    write_u16(&b, 0, 0x0120, CM1E_AL_PRE_OP);
    TEST_ASSERT_EQUAL_INT64(b.now_ns + 200000, due()); /* the request is decided */
    bench_wait(&b, 200000);
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, due());
    write_u16(&b, 0, 0x0502, 0x0100); /* an SII read */
    TEST_ASSERT_EQUAL_INT64(b.now_ns + 150000, due());
    bench_wait(&b, 150000);
    configure_process_data(&b, 0);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP, request_state(&b, 0, CM1E_AL_SAFE_OP));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, request_state(&b, 0, CM1E_AL_OP));
    const int64_t watchdog_ns = due();
    TEST_ASSERT_TRUE(watchdog_ns > b.now_ns && watchdog_ns <= b.now_ns + 100000000);
    bench_wait(&b, watchdog_ns - b.now_ns - 1);
    TEST_ASSERT_EQUAL_UINT(0, b.apps[0]->watchdogs);
    bench_wait(&b, 1);
    TEST_ASSERT_EQUAL_UINT(1, b.apps[0]->watchdogs);
    TEST_ASSERT_EQUAL_INT64(INT64_MAX, due());
    cm1e_sim_slave_reset(cm1e_sim_segment_slave(b.segment, 1), b.now_ns + 5000000);
    TEST_ASSERT_EQUAL_INT64(b.now_ns + 5000000, due()); /* it comes back */
}

/* ---- device emulation: a slave without a processor -------------------------------------------------------------- */

enum { EMULATING = 1 }; /* behind the slave with a state machine */

static void add_emulating(cm1e_sim_io_t kind)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_segment_add(b.segment, cm1e_sim_io_create(kind)));
    TEST_ASSERT_EQUAL_HEX8(0x01, read_u8(&b, EMULATING, 0x0141));
}

/* Its controller copies AL control to AL status: whatever the request, at once, the acknowledge bit too. */
static void test_device_emulation_copies_al_control_to_al_status(void)
{
    for (int kind = CM1E_SIM_IO_TERMINAL; kind <= CM1E_SIM_IO_COUPLER; kind++) {
        tearDown();
        setUp();
        add_emulating((cm1e_sim_io_t)kind);
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT, read_u16(&b, EMULATING, 0x0130));
        for (uint16_t before = 0; before <= 0x3F; before++)
            for (uint16_t request = 0; request <= 0x3F; request++) {
                write_u16(&b, EMULATING, 0x0120, before);
                write_u16(&b, EMULATING, 0x0120, request);
                TEST_ASSERT_EQUAL_HEX16(request, read_u16(&b, EMULATING, 0x0130));
                TEST_ASSERT_EQUAL_HEX16(0, read_u16(&b, EMULATING, 0x0134));
            }
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT, read_u16(&b, 0, 0x0130));
    }
}

/* INIT with the acknowledge bit, as masters broadcast it, shows an error, and each further acknowledgement keeps it. */
static void test_device_emulation_shows_an_acknowledgement_as_an_error(void)
{
    uint8_t init_and_acknowledge[2] = {CM1E_AL_INIT | CM1E_AL_ERROR, 0};
    add_emulating(CM1E_SIM_IO_TERMINAL);
    TEST_ASSERT_EQUAL_INT(2, send_to(&b, BWR, 0, 0x0120, init_and_acknowledge, 2));
    bench_wait(&b, 1000000);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT, read_u16(&b, 0, 0x0130));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT | CM1E_AL_ERROR, read_u16(&b, EMULATING, 0x0130));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT | CM1E_AL_ERROR,
                            request_state(&b, EMULATING, CM1E_AL_INIT | CM1E_AL_ERROR));
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_INIT, request_state(&b, EMULATING, CM1E_AL_INIT));
}

/* Nobody falls back: the watchdog switches the outputs off, and AL status stays what the master wrote. */
static void test_device_emulation_has_outputs_in_operational_with_a_watchdog(void)
{
    add_emulating(CM1E_SIM_IO_TERMINAL);
    write_sm(&b, EMULATING, 0, 0x1000, 1, 0x44, 1);
    write_sm(&b, EMULATING, 1, 0x1100, 1, 0x00, 1);
    write_fmmu(&b, EMULATING, 0, 0, 1, 0, 3, 0x1000, 0, 2); /* outputs in bits 0-3, inputs in bits 4-7 of one byte */
    write_fmmu(&b, EMULATING, 1, 0, 1, 4, 7, 0x1100, 0, 1);
    static const uint8_t requests[] = {CM1E_AL_OP, CM1E_AL_SAFE_OP, CM1E_AL_PRE_OP, CM1E_AL_INIT, CM1E_AL_OP};
    for (unsigned i = 0; i < sizeof requests; i++) {
        write_u16(&b, EMULATING, 0x0120, requests[i]);
        uint8_t data[1] = {0x0A};
        TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, 0, data, 1));
        data[0] = 0x0A;
        bench_wait(&b, 1000);
        TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, 0, data, 1));
        if (requests[i] >= CM1E_AL_SAFE_OP)
            TEST_ASSERT_EQUAL_HEX8(requests[i] == CM1E_AL_OP ? 0xAA : 0x0A, data[0]);
    }
    bench_wait(&b, 100000000);
    uint8_t data[1] = {0x0F};
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, 0, data, 1));
    TEST_ASSERT_EQUAL_HEX8(0x0F, data[0]);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, read_u16(&b, EMULATING, 0x0130));
}

static void test_a_coupler_has_no_process_data(void)
{
    add_emulating(CM1E_SIM_IO_COUPLER);
    TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, request_state(&b, EMULATING, CM1E_AL_OP));
    uint8_t data[1] = {0x55};
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRW, 0, data, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_request_in_every_state_is_answered_as_the_standard_says);
    RUN_TEST(test_a_change_takes_time);
    RUN_TEST(test_an_error_is_acknowledged_before_anything_else_happens);
    RUN_TEST(test_wrong_mailboxes_are_refused);
    RUN_TEST(test_wrong_process_data_is_refused);
    RUN_TEST(test_a_slave_without_process_data_wants_no_sync_manager_for_it);
    RUN_TEST(test_the_application_may_refuse);
    RUN_TEST(test_the_application_falls_back_by_itself);
    RUN_TEST(test_explicit_device_id_is_told_on_request_in_every_state);
    RUN_TEST(test_al_control_takes_one_or_two_bytes);
    RUN_TEST(test_leaving_pre_operational_empties_the_mailboxes);
    RUN_TEST(test_random_requests_never_leave_the_states);
    RUN_TEST(test_a_segment_says_when_it_has_to_be_advanced_next);
    RUN_TEST(test_device_emulation_copies_al_control_to_al_status);
    RUN_TEST(test_device_emulation_shows_an_acknowledgement_as_an_error);
    RUN_TEST(test_device_emulation_has_outputs_in_operational_with_a_watchdog);
    RUN_TEST(test_a_coupler_has_no_process_data);
    return UNITY_END();
}
