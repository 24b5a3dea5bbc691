/* Overlapped process data: whatever happens to frames and slaves, the inputs are those that a bus with places of their
 * own would take, cycle by cycle. And what an overlapped frame alone can go wrong in. */
#include "bus_support.h"
#include "effort.h"
#include "sim/esc_chip.h"

enum { LRW = 12, DATA = 26, SLAVES = 4, MOTOR_BYTES = 21, RUN = 120, STRUCK = 40 };

/** Simple devices at 2 and, of another mapping, motors at 1, 3 and 4. */
static void describe(bool overlap, cm1e_sim_io_t gaps)
{
    sim_config(3);
    config.sim_gaps = gaps;
    config.axes[0].address = 1;
    config.axes[1].address = 3;
    config.axes[1].mapping = CM1E_MAPPING_CSP;
    config.axes[2].address = 4;
    config.overlap = overlap;
}

static size_t bytes_of(cm1e_bus_t *bus, bool inputs)
{
    size_t bytes = 0;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++) {
        const cm1e_slave_info_t *info = cm1e_bus_slave(bus, position);
        bytes += inputs ? info->input_bytes : info->output_bytes;
    }
    return bytes;
}

/** What nobody takes stays. */
static void spoil_inputs(cm1e_bus_t *bus) { memset((uint8_t *)(uintptr_t)cm1e_bus_inputs(bus), 0xEE, bytes_of(bus, true)); }

static bool is_process_data(const cm1e_tap_frame_t *frame) { return frame->length > DATA && frame->bytes[16] == LRW; }

static unsigned data_bytes(const cm1e_tap_frame_t *frame) { return cm1e_get_u16(frame->bytes + 22) & 0x7FFu; }

/* ---- beside a bus with places of their own ----------------------------------------------------------------------- */

typedef enum fault_kind {
    NONE = 0, LOSE_THERE, LOSE_BACK, COUNT_UP, COUNT_DOWN, COUNT_ZERO, TWICE, LATE, AGAIN, STRIKE, KINDS,
} fault_kind_t;

/** What each does to the process data of cycle `at`, and of the `more` behind it. */
static const struct {
    fault_kind_t kind;
    int more, amount; /**< of the working counter; us of the delay */
    const char *line; /**< to the console of the simulator */
} faults[] = {
    {NONE, 0, 0, ""},
    {LOSE_THERE, 0, 0, ""}, {LOSE_THERE, 5, 0, ""}, {LOSE_BACK, 0, 0, ""}, {LOSE_BACK, 5, 0, ""},
    {COUNT_UP, 0, 1, ""}, {COUNT_UP, 3, 2, ""}, {COUNT_DOWN, 0, 1, ""}, {COUNT_DOWN, 3, 2, ""},
    {COUNT_DOWN, 1, 3, ""}, {COUNT_ZERO, 2, 0, ""}, {TWICE, 3, 0, ""},
    {LATE, 0, 900, ""}, {LATE, 2, 1500, ""}, {LATE, 1, 15600, ""}, {LATE, 3, 16300, ""}, {LATE, 3, 31600, ""},
    {STRIKE, 0, 0, "unplug 1"}, {STRIKE, 0, 0, "unplug 2"}, {STRIKE, 0, 0, "unplug 3"}, {STRIKE, 0, 0, "unplug 4"},
    {STRIKE, 0, 0, "power-cycle 1 20"}, {STRIKE, 0, 0, "power-cycle 2 20"}, {STRIKE, 0, 0, "power-cycle 3 20"},
    {STRIKE, 0, 0, "power 3 off"}, {STRIKE, 0, 0, "error 4 7310"}, {STRIKE, 0, 0, "damage 3 4"},
    {STRIKE, 0, 0, "lose 2"}, {STRIKE, 0, 0, "delay 3 1200"},
};
enum { FAULTS = sizeof faults / sizeof faults[0] };

typedef struct moment {
    cm1e_error_t error;
    bool silent[SLAVES], fresh[SLAVES];
    uint8_t inputs[128];
} moment_t;

static struct {
    unsigned fault;
    int at, cycle;
} now;

static bool strikes(void) { return now.cycle >= now.at && now.cycle <= now.at + faults[now.fault].more; }

static cm1e_tap_verdict_t strike(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    const fault_kind_t kind = faults[now.fault].kind;
    const int amount = faults[now.fault].amount;
    const bool sent = frame->direction == CM1E_TAP_SENT;
    if (!is_process_data(frame) || !strikes() || sent != (kind == LOSE_THERE))
        return CM1E_TAP_PASS;
    switch (kind) {
    case LOSE_THERE:
    case LOSE_BACK:
        return CM1E_TAP_DROP;
    case COUNT_UP:
    case COUNT_DOWN:
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, kind == COUNT_UP ? amount : -amount);
        break;
    case COUNT_ZERO:
        cm1e_put_u16(frame->bytes + DATA + data_bytes(frame), 0);
        break;
    case TWICE:
        frame->copies = 2;
        break;
    case LATE:
        frame->delay_ns = amount * INT64_C(1000);
        break;
    default:
        break;
    }
    return CM1E_TAP_PASS;
}

/** Outputs that change in every cycle. The motors stay disabled, because bit 1 of no control word is set. */
static void write_outputs(cm1e_bus_t *bus, uint32_t *state)
{
    const size_t bytes = bytes_of(bus, false);
    for (size_t i = 0; i < bytes; i++) {
        *state = *state * 1664525u + 1013904223u;
        cm1e_bus_outputs(bus)[i] = (uint8_t)(*state >> 24);
    }
    for (uint16_t position = 1; position <= SLAVES; position++) {
        const cm1e_image_slot_t word = cm1e_bus_find_output(bus, position, 0x6040, 0);
        if (word.bytes)
            cm1e_bus_outputs(bus)[word.offset] &= 0xFD;
    }
}

static void record(bool overlap, cm1e_sim_io_t gaps, moment_t moments[RUN])
{
    uint32_t state = 1;
    describe(overlap, gaps);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), strike, NULL);
    for (now.cycle = 0; now.cycle < RUN; now.cycle++) {
        moment_t *moment = &moments[now.cycle];
        if (now.cycle == now.at && faults[now.fault].kind == STRIKE)
            simulate(bus, faults[now.fault].line);
        write_outputs(bus, &state);
        *moment = (moment_t){.error = cycle(bus)};
        memcpy(moment->inputs, cm1e_bus_inputs(bus), bytes_of(bus, true));
        for (uint16_t n = 0; n < SLAVES; n++) {
            const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, n + 1u);
            moment->silent[n] = watch.silent;
            moment->fresh[n] = watch.fresh;
        }
    }
    cm1e_bus_close(bus);
}

START_TEST(faults_take_no_other_inputs_than_with_places_of_their_own)
{
    static moment_t apart[RUN], overlapped[RUN];
    unsigned bad = 0;
    now.fault = (unsigned)_i % FAULTS;
    const int stride = slowness();
    for (now.at = (int)now.fault % stride; now.at < STRUCK; now.at += stride) {
        const cm1e_sim_io_t gaps = (cm1e_sim_io_t)((now.at + (int)now.fault) % 3);
        record(false, gaps, apart);
        record(true, gaps, overlapped);
        for (int n = 0; n < RUN; n++) {
            const moment_t *a = &apart[n], *b = &overlapped[n];
            ck_assert_msg(a->error == b->error, "fault %u at %d, cycle %d: %s, overlapped %s", now.fault, now.at, n,
                          cm1e_strerror(a->error), cm1e_strerror(b->error));
            ck_assert_msg(!memcmp(a->silent, b->silent, sizeof a->silent) && !memcmp(a->fresh, b->fresh, sizeof a->fresh),
                          "fault %u at %d, cycle %d: other slaves count as silent", now.fault, now.at, n);
            ck_assert_msg(!memcmp(a->inputs, b->inputs, sizeof a->inputs), "fault %u at %d, cycle %d: other inputs",
                          now.fault, now.at, n);
            bad += a->error != CM1E_OK;
        }
    }
    const fault_kind_t kind = faults[now.fault].kind;
    ck_assert(bad > 0 || kind == NONE || kind == TWICE || strstr(faults[now.fault].line, "power 3") ||
              strstr(faults[now.fault].line, "error") || faults[now.fault].amount == 900);
}
END_TEST

/* ---- the frame --------------------------------------------------------------------------------------------------- */

typedef struct seen_frames {
    unsigned bytes[8], count;
} seen_frames_t;

static cm1e_tap_verdict_t see(void *context, cm1e_tap_frame_t *frame)
{
    seen_frames_t *seen = context;
    if (frame->direction == CM1E_TAP_SENT && is_process_data(frame) && seen->count < 8)
        seen->bytes[seen->count++] = data_bytes(frame);
    return CM1E_TAP_PASS;
}

/** Each motor takes the longer of both directions; a device of one byte each way keeps both; 4 bytes are the number. */
START_TEST(inputs_take_the_place_of_outputs)
{
    static const uint32_t gap_bytes[] = {2, 2, 0};
    describe(true, (cm1e_sim_io_t)_i);
    cm1e_bus_t *bus = start_bus();
    seen_frames_t seen = {{0}, 0};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), see, &seen);
    cycles(bus, 1);
    ck_assert_uint_eq(seen.count, 1);
    ck_assert_uint_eq(seen.bytes[0], 2 * MOTOR_BYTES + 16 + gap_bytes[_i] + 4);
    for (uint32_t position = 1; position <= SLAVES; position += position == 1 ? 2 : 1) {
        const uint8_t *memory = cm1e_sim_segment_slave(segment_of(bus), position)->memory;
        ck_assert_uint_eq(cm1e_get_u32(memory + ESC_FMMU), cm1e_get_u32(memory + ESC_FMMU + 16)); /* both begin there */
    }
    cm1e_bus_close(bus);
}
END_TEST

/** The frame of some slaves is lost: their inputs stay, and those of the others are taken. */
typedef struct lost_frame {
    unsigned frame, frames, number;
} lost_frame_t;

static cm1e_tap_verdict_t lose_one(void *context, cm1e_tap_frame_t *frame)
{
    lost_frame_t *lost = context;
    if (frame->direction != CM1E_TAP_SENT || !is_process_data(frame))
        return CM1E_TAP_PASS;
    return lost->number++ % lost->frames == lost->frame ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

START_TEST(lost_frame_of_several_concerns_its_slaves)
{
    enum { MOTORS = 150, IN_A_FRAME = (1466 - 4) / MOTOR_BYTES, FRAMES = 3 };
    sim_config(MOTORS);
    config.overlap = true;
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    lost_frame_t lost = {.frame = (unsigned)_i, .frames = FRAMES};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_one, &lost);
    cycle(bus);
    for (int n = 0; n < 5; n++) {
        spoil_inputs(bus);
        ck_assert_int_eq(cycle(bus), CM1E_ERROR_BUS_WORKING_COUNTER);
        for (uint16_t position = 1; position <= MOTORS; position++) {
            const bool hit = (position - 1u) / IN_A_FRAME == lost.frame;
            const uint8_t *inputs = cm1e_bus_inputs(bus) + (position - 1u) * MOTOR_BYTES;
            ck_assert_msg(cm1e_bus_slave_watch(bus, position).fresh == !hit, "slave %u", position);
            ck_assert_msg((inputs[0] == 0xEE && inputs[MOTOR_BYTES - 1] == 0xEE) == hit, "slave %u", position);
        }
    }
    cm1e_bus_close(bus);
}
END_TEST

/* ---- what only an overlapped frame can do ------------------------------------------------------------------------- */

static cm1e_tap_verdict_t add_three(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction == CM1E_TAP_RECEIVED && is_process_data(frame))
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, 3);
    return CM1E_TAP_PASS;
}

/** A stranger counts for a motor that does not answer: the working counter is right, and the motor's inputs would be its
 *  own outputs. */
START_TEST(motor_that_returns_its_outputs_is_not_believed_even_if_the_working_counter_is_right)
{
    describe(true, CM1E_SIM_IO_MODULE);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    uint8_t before[128];
    simulate(bus, "unplug 4");
    cm1e_nic_set_tap(cm1e_bus_nic(bus), add_three, NULL);
    memset(cm1e_bus_outputs(bus), 0x11, bytes_of(bus, false));
    cycle(bus);
    memcpy(before, cm1e_bus_inputs(bus), bytes_of(bus, true));
    for (int n = 0; n < 10; n++) {
        ck_assert_int_eq(cycle(bus), CM1E_ERROR_BUS_WORKING_COUNTER);
        ck_assert(!memcmp(before, cm1e_bus_inputs(bus), bytes_of(bus, true)));
        ck_assert(!cm1e_bus_slave_watch(bus, 4).fresh);
    }
    cm1e_bus_close(bus);
}
END_TEST

enum { OTHER_NUMBER, NUMBER_OF_THE_CYCLE_BEFORE, OTHER_OUTPUT, WRONG_FRAMES };

/** Behind the first motor is the output of the module, which its input does not cover; at the end is the number. */
static cm1e_tap_verdict_t change_bytes(void *context, cm1e_tap_frame_t *frame)
{
    static uint32_t before;
    const int what = *(const int *)context;
    if (frame->direction != CM1E_TAP_RECEIVED || !is_process_data(frame))
        return CM1E_TAP_PASS;
    uint8_t *number = frame->bytes + DATA + data_bytes(frame) - 4;
    const uint32_t own = cm1e_get_u32(number);
    if (what == OTHER_OUTPUT)
        frame->bytes[DATA + MOTOR_BYTES] ^= 0x10;
    else
        cm1e_put_u32(number, what == OTHER_NUMBER ? own ^ 0x10 : before);
    before = own;
    return CM1E_TAP_PASS;
}

START_TEST(frame_that_was_not_sent_so_is_not_taken)
{
    describe(true, CM1E_SIM_IO_MODULE);
    cm1e_bus_t *bus = start_bus();
    int what = _i;
    cycles(bus, 20);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), change_bytes, &what);
    cycle(bus);
    spoil_inputs(bus);
    for (int n = 0; n < 5; n++) {
        ck_assert_int_eq(cycle(bus), CM1E_ERROR_BUS_LOST);
        for (size_t i = 0; i < bytes_of(bus, true); i++)
            ck_assert_uint_eq(cm1e_bus_inputs(bus)[i], 0xEE);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** After its power was off, a motor has its overlapped places again. */
START_TEST(slave_that_comes_back_has_its_places_again)
{
    describe(true, CM1E_SIM_IO_MODULE);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    char line[32];
    snprintf(line, sizeof line, "power-cycle %d 20", _i);
    simulate(bus, line);
    int n = 0;
    for (int good = 0; good < 100; n++) {
        ck_assert_int_lt(n, 3000);
        good = cycle(bus) == CM1E_OK && cm1e_bus_slave_watch(bus, (uint16_t)_i).al_state == CM1E_AL_OP ? good + 1 : 0;
        if (good == 0 && n > 30)
            cm1e_bus_request_recovery(bus, (uint16_t)_i);
    }
    ck_assert_int_gt(n, 120);
    cm1e_bus_close(bus);
}
END_TEST

/** The time of the reference goes beside the first frame of several, and keeps its room. */
START_TEST(clocks_ride_beside_overlapped_process_data)
{
    sim_config(100);
    config.overlap = config.distributed_clocks = true;
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 300);
    for (uint16_t position = 1; position <= 100; position++)
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- what is refused ---------------------------------------------------------------------------------------------- */

START_TEST(slave_that_does_not_know_lrw_is_refused)
{
    sim_config(1);
    config.overlap = true;
    cm1e_bus_t *bus = open_bus();
    forget_lrw(bus, 1);
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "overlap") && strstr(diag.text, "one datagram"), "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/** The slave of this station address does not take what is written into its FMMUs. */
static cm1e_tap_verdict_t refuse_fmmus(void *context, cm1e_tap_frame_t *frame)
{
    enum { FPWR = 5, FMMU0 = 0x0600, FRAME_HEADER_BYTES = 16 };
    const uint16_t station = *(const uint16_t *)context;
    size_t at = FRAME_HEADER_BYTES;
    for (bool more = frame->direction == CM1E_TAP_RECEIVED; more && at + 12 <= frame->length;) {
        uint8_t *header = frame->bytes + at;
        const unsigned length = cm1e_get_u16(header + 6);
        if (header[0] == FPWR && cm1e_get_u16(header + 2) == station && cm1e_get_u16(header + 4) == FMMU0 &&
            (length & 0x7FF) > 16)
            cm1e_put_u16(header + 10 + (length & 0x7FF), 0);
        more = length & 0x8000;
        at += 12 + (length & 0x7FF);
    }
    return CM1E_TAP_PASS;
}

/** The slave is named, the first one and the last one too; the next start succeeds. */
START_TEST(slave_that_does_not_take_its_places_is_named)
{
    char wanted[40];
    describe(true, CM1E_SIM_IO_TERMINAL);
    cm1e_bus_t *bus = open_bus();
    ck_assert(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK);
    const uint8_t *memory = register_memory_of(bus, (uint32_t)_i);
    uint16_t station = cm1e_get_u16(memory + 0x0010);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_fmmus, &station);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_BUS_WORKING_COUNTER);
    snprintf(wanted, sizeof wanted, "Slave %d (", _i);
    ck_assert_msg(strstr(diag.text, wanted) && strstr(diag.text, "does not accept the places of its process data"), "%s",
                  diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_overlap");
    TCase *tests = tcase_create("overlap");
    tcase_add_loop_test(tests, faults_take_no_other_inputs_than_with_places_of_their_own, 0, FAULTS);
    tcase_add_loop_test(tests, inputs_take_the_place_of_outputs, 0, 3);
    tcase_add_loop_test(tests, lost_frame_of_several_concerns_its_slaves, 0, 3);
    tcase_add_test(tests, motor_that_returns_its_outputs_is_not_believed_even_if_the_working_counter_is_right);
    tcase_add_loop_test(tests, frame_that_was_not_sent_so_is_not_taken, 0, WRONG_FRAMES);
    tcase_add_loop_test(tests, slave_that_comes_back_has_its_places_again, 1, SLAVES + 1);
    tcase_add_test(tests, clocks_ride_beside_overlapped_process_data);
    tcase_add_test(tests, slave_that_does_not_know_lrw_is_refused);
    tcase_add_loop_test(tests, slave_that_does_not_take_its_places_is_named, 1, SLAVES + 1);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
