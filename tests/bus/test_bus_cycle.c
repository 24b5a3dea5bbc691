/* The cyclic exchange: only the right answer of this very cycle is taken, and every fault is counted and bounded. */
#include "bus_support.h"
#include "bus/datagram.h"

enum { LRW = 12, HEADER = 26 }; /**< Ethernet 14, EtherCAT 2, datagram 10 */

static bool is_process_data(const cm1e_tap_frame_t *frame)
{
    return frame->length > HEADER && frame->bytes[16] == LRW;
}

/** What the tap does to process data frames that come back. */
typedef struct fault {
    unsigned skip, count;    /**< lets `skip` frames pass, then acts on `count` */
    enum { LOSE, COUNT_UP, COUNT_DOWN, COUNT_ZERO, OUTPUTS, DELAY, TWICE, CUT } what;
    int64_t delay_ns;
    size_t length;
} fault_t;

static cm1e_tap_verdict_t act(void *context, cm1e_tap_frame_t *frame)
{
    fault_t *fault = context;
    if (frame->direction != CM1E_TAP_RECEIVED || !is_process_data(frame))
        return CM1E_TAP_PASS;
    if (fault->skip > 0) {
        fault->skip--;
        return CM1E_TAP_PASS;
    }
    if (fault->count == 0)
        return CM1E_TAP_PASS;
    fault->count--;
    const unsigned data = cm1e_get_u16(frame->bytes + 22) & 0x7FF;
    switch (fault->what) {
    case LOSE:
        return CM1E_TAP_DROP;
    case COUNT_UP:
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, 1);
        break;
    case COUNT_DOWN:
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
        break;
    case COUNT_ZERO:
        cm1e_put_u16(frame->bytes + HEADER + data, 0);
        break;
    case OUTPUTS:
        frame->bytes[HEADER] ^= 0x80;
        break;
    case DELAY:
        frame->delay_ns = fault->delay_ns;
        break;
    case TWICE:
        frame->copies = 2;
        break;
    case CUT:
        frame->length = fault->length;
        break;
    }
    /* Wrong inputs, to see whether anybody takes them. */
    if (fault->what != TWICE)
        memset(frame->bytes + HEADER + data - 4, 0x55, 4);
    return CM1E_TAP_PASS;
}

static void set_fault(cm1e_bus_t *bus, fault_t *fault) { cm1e_nic_set_tap(cm1e_bus_nic(bus), act, fault); }

static size_t input_bytes(cm1e_bus_t *bus)
{
    size_t bytes = 0;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        bytes += cm1e_bus_slave(bus, position)->input_bytes;
    return bytes;
}

/* ---- one fault ------------------------------------------------------------------------------------------------- */

typedef struct fault_case {
    const char *name;
    fault_t fault;
    cm1e_error_t error;
} fault_case_t;

static const fault_case_t faults[] = {
    {"lost", {0, 1, LOSE, 0, 0}, CM1E_ERROR_BUS_LOST},
    {"working counter one more", {0, 1, COUNT_UP, 0, 0}, CM1E_ERROR_BUS_WORKING_COUNTER},
    {"working counter one less", {0, 1, COUNT_DOWN, 0, 0}, CM1E_ERROR_BUS_WORKING_COUNTER},
    {"working counter 0", {0, 1, COUNT_ZERO, 0, 0}, CM1E_ERROR_BUS_WORKING_COUNTER},
    {"outputs changed on the way", {0, 1, OUTPUTS, 0, 0}, CM1E_ERROR_BUS_LOST},
    {"too late", {0, 1, DELAY, 5000000, 0}, CM1E_ERROR_BUS_LOST},
    {"twice", {0, 1, TWICE, 0, 0}, CM1E_OK},
    {"cut to 20 bytes", {0, 1, CUT, 0, 20}, CM1E_ERROR_BUS_LOST},
    {"cut to 30 bytes", {0, 1, CUT, 0, 30}, CM1E_ERROR_BUS_LOST},
    {"cut to 60 bytes", {0, 1, CUT, 0, 60}, CM1E_ERROR_BUS_LOST},
    {"cut to nothing", {0, 1, CUT, 0, 0}, CM1E_ERROR_BUS_LOST},
};

START_TEST(faulty_frame_leaves_the_inputs_as_they_were_and_is_counted)
{
    const fault_case_t *c = &faults[_i];
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    const size_t bytes = input_bytes(bus);
    uint8_t before[128];
    cycles(bus, 10);
    memcpy(before, cm1e_bus_inputs(bus), bytes);
    const cm1e_bus_counters_t old = *cm1e_bus_counters(bus), *now = cm1e_bus_counters(bus);
    fault_t fault = c->fault;
    fault.skip = 1; /* the answer to the frame under way has been seen by the tap already, or not: both are fine */
    set_fault(bus, &fault);
    cm1e_error_t error = CM1E_OK;
    for (int n = 0; n < 5 && error == CM1E_OK; n++) {
        error = cycle(bus);
        ck_assert_msg(!memcmp(before, cm1e_bus_inputs(bus), bytes), "%s", c->name);
        ck_assert_int_eq(cm1e_bus_health(bus), CM1E_OK);
    }
    ck_assert_msg(error == c->error, "%s: %s", c->name, cm1e_strerror(error));
    ck_assert_uint_eq(fault.count, 0);
    ck_assert_uint_eq(now->lost_frames - old.lost_frames, error == CM1E_ERROR_BUS_LOST);
    ck_assert_uint_eq(now->working_counter_errors - old.working_counter_errors,
                      error == CM1E_ERROR_BUS_WORKING_COUNTER);
    cycles(bus, 20);
    if (fault.what == DELAY)
        ck_assert_uint_gt(now->late_frames, old.late_frames);
    ck_assert(!memcmp(before, cm1e_bus_inputs(bus), bytes));
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(lost_frame_costs_exactly_the_configured_timeout)
{
    static const int64_t timeouts[] = {0, 50000, 100000, 250000, 900000};
    sim_config(1);
    config.frame_timeout_ns = timeouts[_i];
    const int64_t expected = timeouts[_i] ? timeouts[_i] : 250000; /* a quarter of the cycle */
    cm1e_bus_t *bus = start_bus();
    fault_t fault = {.count = 1000, .what = LOSE};
    set_fault(bus, &fault);
    cycle(bus);
    for (int n = 0; n < 50; n++) {
        const int64_t begin_ns = now_of(bus);
        ck_assert_int_eq(cm1e_bus_receive(bus), CM1E_ERROR_BUS_LOST);
        ck_assert_int_eq(now_of(bus) - begin_ns, expected);
        cm1e_bus_send(bus);
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), begin_ns + 1000000);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(good_cycle_waits_for_nothing)
{
    sim_config(16);
    cm1e_bus_t *bus = start_bus();
    for (int n = 0; n < 100; n++) {
        const int64_t begin_ns = now_of(bus);
        ck_assert_int_eq(cm1e_bus_receive(bus), CM1E_OK);
        cm1e_bus_send(bus);
        ck_assert_int_eq(now_of(bus), begin_ns);
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), begin_ns + 1000000);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(health_falls_after_the_limit_and_returns_with_the_first_good_cycle)
{
    const uint32_t limit = (uint32_t)_i;
    sim_config(1);
    config.lost_cycles_limit = limit;
    const uint32_t expected = limit ? limit : 3;
    cm1e_bus_t *bus = start_bus();
    for (uint32_t bad = 1; bad <= expected + 3; bad++) {
        cycles(bus, 5);
        ck_assert_int_eq(cm1e_bus_health(bus), CM1E_OK);
        fault_t fault = {.count = bad, .what = bad % 2 ? LOSE : COUNT_DOWN};
        set_fault(bus, &fault);
        uint32_t seen = 0;
        for (int n = 0; n < 30; n++) {
            const cm1e_error_t error = cycle(bus);
            seen = error == CM1E_OK ? 0 : seen + 1;
            ck_assert_int_eq(cm1e_bus_health(bus), seen >= expected ? error : CM1E_OK);
        }
        ck_assert_uint_eq(fault.count, 0);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    }
    cm1e_bus_close(bus);
}
END_TEST

/* ---- random faults --------------------------------------------------------------------------------------------- */

/** Marks the inputs of every process data answer with the number that its outputs carry, then may disturb it. */
typedef struct random_faults {
    uint32_t output, input; /**< places of the marks in the image, from the begin of the frame's data */
    bool quiet;
    unsigned disturbed;
} random_faults_t;

static cm1e_tap_verdict_t disturb(void *context, cm1e_tap_frame_t *frame)
{
    random_faults_t *faults_now = context;
    if (frame->direction == CM1E_TAP_RECEIVED && is_process_data(frame))
        memcpy(frame->bytes + HEADER + faults_now->input, frame->bytes + HEADER + faults_now->output, 4);
    if (faults_now->quiet || rand() % 10)
        return CM1E_TAP_PASS;
    faults_now->disturbed++;
    /* A slave controller drops a frame whose checksum is wrong; so on their way out frames are not changed. */
    switch (frame->direction == CM1E_TAP_SENT ? rand() % 3 : rand() % 7) {
    case 0:
        return CM1E_TAP_DROP;
    case 1:
        frame->delay_ns = rand() % 20000000;
        break;
    case 2:
        frame->copies = 2;
        break;
    case 3:
        frame->length = (size_t)rand() % (frame->length + 1);
        break;
    case 4:
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, rand() % 5 - 2);
        break;
    case 5: /* a bit in the headers */
        if (frame->length > HEADER)
            frame->bytes[rand() % HEADER] ^= (uint8_t)(1 << rand() % 8);
        break;
    case 6:
        frame->bytes[17] = (uint8_t)rand(); /* the index of another frame */
        break;
    }
    return CM1E_TAP_PASS;
}

START_TEST(random_frame_faults_never_bring_inputs_of_another_cycle)
{
    const unsigned seed = 1000u + (unsigned)_i;
    printf("seed %u\n", seed);
    srand(seed);
    sim_config(1u + (uint32_t)_i % 4);
    cm1e_bus_t *bus = start_bus();
    size_t outputs = 0;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        outputs += cm1e_bus_slave(bus, position)->output_bytes;
    const uint32_t out = cm1e_bus_find_output(bus, 1, 0x607A, 0).offset;
    const uint32_t in = cm1e_bus_find_input(bus, 1, 0x6064, 0).offset;
    random_faults_t context = {.output = out, .input = (uint32_t)outputs + in};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), disturb, &context);
    uint8_t data[4];
    cm1e_sdo_t sdo = {.state = CM1E_SDO_IDLE};
    uint32_t last = 0, good = 0, transfers = 0, refused = 0;
    cycle(bus);
    for (uint32_t n = 1; n <= 4000; n++) {
        const int64_t begin_ns = now_of(bus);
        const cm1e_error_t error = cm1e_bus_receive(bus);
        ck_assert_int_le(now_of(bus) - begin_ns, 250000);
        const uint32_t mark = cm1e_get_u32(cm1e_bus_inputs(bus) + in);
        /* A wrong working counter may still tell that only others were missing. */
        const bool fresh = error == CM1E_OK || (error == CM1E_ERROR_BUS_WORKING_COUNTER && mark == n - 1);
        if (n > 1)
            ck_assert_uint_eq(mark, fresh ? n - 1 : last);
        last = mark;
        good += error == CM1E_OK;
        cm1e_put_u32(cm1e_bus_outputs(bus) + out, n);
        if (cm1e_sdo_state(&sdo) != CM1E_SDO_BUSY) {
            /* With working counters changed at will a slave may look lost for a while; no other error is right. */
            refused += n > 1 && cm1e_sdo_state(&sdo) == CM1E_SDO_ERROR;
            if (n > 1 && cm1e_sdo_state(&sdo) == CM1E_SDO_ERROR)
                ck_assert_msg(sdo.error == CM1E_ERROR_BUS_LOST, "cycle %u: %s", n, cm1e_strerror(sdo.error));
            else if (n > 1)
                ck_assert_uint_eq(cm1e_get_u32(data), 0x00040192);
            sdo = (cm1e_sdo_t){.position = 1, .index = 0x1000, .data = data, .size = 4};
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
            transfers++;
        }
        cm1e_bus_send(bus);
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), begin_ns + 1000000);
    }
    ck_assert_uint_gt(context.disturbed, 500);
    ck_assert_uint_gt(good, 2000);
    ck_assert_uint_gt(transfers, 200);
    ck_assert_uint_lt(refused, transfers / 10);
    /* Afterwards everything is as it was. */
    context.quiet = true;
    for (int n = 0; n < 100; n++)
        cycle(bus);
    cycles(bus, 100);
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment_of(bus), 1, &probe);
    ck_assert(!probe.torque_on);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(silence_of_the_application_is_bounded)
{
    /* Sending twice without receiving, receiving twice without sending: no index is lost, nothing hangs. */
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    for (int n = 0; n < 200; n++)
        cm1e_bus_send(bus);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 10000000);
    ck_assert_int_eq(cm1e_bus_receive(bus), CM1E_OK);
    for (int n = 0; n < 200; n++)
        ck_assert_int_eq(cm1e_bus_receive(bus), CM1E_ERROR_STATE);
    cm1e_bus_send(bus);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 1000000);
    cycles(bus, 50);
    cm1e_bus_close(bus);
}
END_TEST

/** Questions for an AL status, as they are sent. */
typedef struct asked {
    bool swallow;            /**< no frame with a question comes back */
    unsigned riding, alone;
    bool rode;               /**< the last one was in the frame of the process data */
    int64_t alone_ns;        /**< when the last one in a frame of its own was sent */
    unsigned of[4];          /**< by slave */
} asked_t;

static void note_question(asked_t *asked, const cm1e_tap_frame_t *frame, uint16_t station)
{
    const bool rides = is_process_data(frame);
    if (asked->swallow) {
        ck_assert_int_ge(frame->time_ns - asked->alone_ns, 2000000);
        ck_assert(!rides || !asked->rode); /* the process data did not come back */
    }
    asked->rode = rides;
    asked->alone_ns = rides ? asked->alone_ns : frame->time_ns;
    asked->riding += rides;
    asked->alone += !rides;
    asked->of[station & 3]++;
}

static cm1e_tap_verdict_t watch_questions(void *context, cm1e_tap_frame_t *frame)
{
    asked_t *asked = context;
    uint16_t station;
    if (find_read(frame, REG_AL_STATUS, &station) < 0)
        return CM1E_TAP_PASS;
    if (frame->direction == CM1E_TAP_SENT)
        note_question(asked, frame, station);
    return asked->swallow && frame->direction == CM1E_TAP_RECEIVED ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/** A question in a frame of its own that is not answered is given up after 2 ms, and one in the frame of the process
 *  data with that frame. Until then there is no other one. After a lost frame of process data it has its own. */
START_TEST(supervision_has_one_question_on_its_way)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 50);
    asked_t asked = {.swallow = true};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_questions, &asked);
    for (int n = 0; n < 60; n++)
        cycle(bus);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL); /* the stop of the bus asks too */
    const unsigned all = asked.alone + asked.riding;
    ck_assert_msg(all >= 19 && all <= 31, "%u questions in 60 cycles of 1 ms", all);
    ck_assert_msg(asked.alone >= 9 && asked.riding >= 9, "%u questions alone, %u riding", asked.alone, asked.riding);
    ck_assert(!cm1e_bus_slave_watch(bus, 1).lost); /* a lost frame is no unanswered question */
    cm1e_bus_close(bus);
}
END_TEST

/** Every slave is asked in its turn, and no question needs a frame of its own. Every 20 ms it is for port counters. */
START_TEST(questions_ride_with_the_process_data)
{
    sim_config(3);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 50);
    asked_t asked = {.swallow = false};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_questions, &asked);
    cycles(bus, 63);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_uint_eq(asked.alone, 0);
    for (int slave = 1; slave <= 3; slave++)
        ck_assert_msg(asked.of[slave] >= 19, "slave %d was asked %u times", slave, asked.of[slave]);
    cm1e_bus_close(bus);
}
END_TEST

/** A start without process data tells those that come back too late from those that do not come back. */
START_TEST(start_tells_late_frames_from_lost_ones)
{
    const bool late = _i == 1;
    sim_config(2)->frame_timeout_ns = 300000;
    cm1e_bus_t *bus = open_bus();
    fault_t fault = {0, UINT32_MAX, late ? DELAY : LOSE, 800000, 0};
    set_fault(bus, &fault);
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_BUS_LOST);
    ck_assert_msg((strstr(diag.text, "of them came back after the 300 us of frame_timeout_us") != NULL) == late, "%s",
                  diag.text);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_cycle");
    TCase *tests = tcase_create("cycle");
    tcase_add_loop_test(tests, faulty_frame_leaves_the_inputs_as_they_were_and_is_counted, 0,
                        sizeof faults / sizeof faults[0]);
    tcase_add_loop_test(tests, lost_frame_costs_exactly_the_configured_timeout, 0, 5);
    tcase_add_test(tests, good_cycle_waits_for_nothing);
    tcase_add_loop_test(tests, health_falls_after_the_limit_and_returns_with_the_first_good_cycle, 0, 6);
    tcase_add_loop_test(tests, random_frame_faults_never_bring_inputs_of_another_cycle, 0, 12);
    tcase_add_test(tests, supervision_has_one_question_on_its_way);
    tcase_add_test(tests, questions_ride_with_the_process_data);
    tcase_add_test(tests, silence_of_the_application_is_bounded);
    tcase_add_loop_test(tests, start_tells_late_frames_from_lost_ones, 0, 2);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
