/* Start-up with a fault at every single frame: it succeeds or ends with an error in words, in bounded time, and no
 * motor moves. And what a slave can refuse is reported in its own words. */
#include "bridge_segment.h"
#include "effort.h"
#include "sim/esc_chip.h"

typedef enum fault_kind {
    LOSE_THERE = 0, LOSE_BACK, COUNT_UP, COUNT_DOWN, COUNT_ZERO, CUT, TWICE, LATE, GARBAGE, KINDS,
} fault_kind_t;
static const char *const kind_names[KINDS] = {"lost on the way there", "lost on the way back", "working counter + 1",
                                              "working counter - 1", "working counter 0", "cut short", "doubled",
                                              "late", "garbage"};

/** One fault, at frame number `at` (of those of its direction). */
typedef struct single_fault {
    fault_kind_t kind;
    uint64_t at, seen;
    unsigned in_a_row;
} single_fault_t;

static cm1e_tap_verdict_t strike(void *context, cm1e_tap_frame_t *frame)
{
    single_fault_t *fault = context;
    const cm1e_tap_direction_t direction = fault->kind == LOSE_THERE ? CM1E_TAP_SENT : CM1E_TAP_RECEIVED;
    if (frame->direction != direction)
        return CM1E_TAP_PASS;
    const uint64_t number = fault->seen++;
    if (number < fault->at || number >= fault->at + fault->in_a_row)
        return CM1E_TAP_PASS;
    const unsigned data = frame->length > 26 ? cm1e_get_u16(frame->bytes + 22) & 0x7FF : 0;
    switch (fault->kind) {
    case LOSE_THERE:
    case LOSE_BACK:
        return CM1E_TAP_DROP;
    case COUNT_UP:
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, 1);
        break;
    case COUNT_DOWN:
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
        break;
    case COUNT_ZERO:
        if (26 + data + 2 <= frame->length)
            cm1e_put_u16(frame->bytes + 26 + data, 0);
        break;
    case CUT:
        frame->length = frame->length * 2 / 3;
        break;
    case TWICE:
        frame->copies = 2;
        break;
    case LATE:
        frame->delay_ns = 3000000;
        break;
    case GARBAGE: /* what a broken slave writes into the data of a datagram */
        for (unsigned i = 0; i < data && 26 + i < frame->length; i++)
            frame->bytes[26 + i] = (uint8_t)rand();
        break;
    case KINDS:
        break;
    }
    return CM1E_TAP_PASS;
}

/** One CM1-E, or four motors behind a bridge. */
static bool with_bridge;

static void configure_network(void)
{
    sim_config(with_bridge ? CM1E_BRIDGE_AXES : 1);
    for (uint8_t i = 0; i < CM1E_BRIDGE_AXES && with_bridge; i++)
        expect_bridged(i, 1, (uint8_t)(i + 1), i < 2 ? "CM1" : "CM2");
}

static void check_nothing_moved(cm1e_bus_t *bus)
{
    cm1e_sim_probe_t probe;
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES && with_bridge; i++) {
        const cm1e_sim_bridge_axis_t *axis = &bridge_at(bus, 1)->axes[i];
        ck_assert_int_ne(axis->state, OPERATION_ENABLED);
        ck_assert_double_eq(axis->mechanics.position, 0);
    }
    if (with_bridge)
        return;
    cm1e_sim_probe(segment_of(bus), 1, &probe);
    ck_assert(!probe.torque_on);
    ck_assert_double_eq(probe.travel_counts, 0);
}

/** Runs a start with the fault. Returns its result. */
static cm1e_error_t start_with(single_fault_t *fault)
{
    configure_network();
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), strike, fault);
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_int_lt(now_of(bus), INT64_C(30000000000)); /* bounded, whatever happens */
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    if (error == CM1E_OK) {
        cycle(bus);
        cycles(bus, 3);
    } else {
        ck_assert_msg(diag.error == error && strlen(diag.text) > 20, "%s", diag.text);
        ck_assert_uint_le(cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), 1)), CM1E_AL_PRE_OP);
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "again: %s", diag.text);
    }
    check_nothing_moved(bus);
    cm1e_bus_close(bus);
    return error;
}

static uint64_t frames_of_a_start(void)
{
    single_fault_t fault = {.in_a_row = 0};
    ck_assert_int_eq(start_with(&fault), CM1E_OK);
    return fault.seen;
}

static void sweep_a_start(fault_kind_t kind)
{
    const bool harmless = kind == LOSE_THERE || kind == LOSE_BACK || kind == TWICE || kind == LATE || kind == CUT;
    unsigned failed = 0;
    srand(1);
    const uint64_t frames = frames_of_a_start();
    const int stride = slowness();
    for (uint64_t at = (uint64_t)sweep_first((int)kind, stride); at < frames; at += (uint64_t)stride) {
        single_fault_t fault = {.kind = kind, .at = at, .in_a_row = 1};
        const cm1e_error_t error = start_with(&fault);
        failed += error != CM1E_OK;
        /* One frame that the wire lost is nobody's error. */
        ck_assert_msg(error == CM1E_OK || !harmless, "%s at frame %u: %s", kind_names[kind], (unsigned)at, diag.text);
    }
    ck_assert_uint_gt(frames, 200);
    printf("%s: %u of %u starts failed\n", kind_names[kind], failed, (unsigned)frames);
}

START_TEST(start_with_a_fault_at_every_frame_ends_defined) { sweep_a_start((fault_kind_t)_i); }
END_TEST

START_TEST(start_of_a_bridge_with_a_fault_at_every_frame_ends_defined)
{
    if (getenv("CM1E_TEST_FIRMWARE"))
        return; /* there is no other bridge */
    with_bridge = true;
    sweep_a_start((fault_kind_t)_i);
}
END_TEST

START_TEST(start_that_loses_the_bus_at_any_frame_ends_with_an_error)
{
    with_bridge = _i == 1;
    if (with_bridge && getenv("CM1E_TEST_FIRMWARE"))
        return;
    const uint64_t frames = frames_of_a_start();
    const uint64_t stride = (uint64_t)sweep_stride(3, 12);
    for (uint64_t at = 0; at + 12 < frames; at += stride) { /* the last ones belong to the cycles after it */
        single_fault_t fault = {.kind = LOSE_BACK, .at = at, .in_a_row = 1000000};
        configure_network();
        cm1e_bus_t *bus = open_bus();
        cm1e_nic_set_tap(cm1e_bus_nic(bus), strike, &fault);
        const cm1e_error_t error = cm1e_bus_start(bus, &diag);
        ck_assert_msg(error != CM1E_OK && strlen(diag.text) > 20, "frame %u: %s", (unsigned)at, diag.text);
        ck_assert_int_lt(now_of(bus), INT64_C(90000000000));
        check_nothing_moved(bus);
        cm1e_bus_close(bus);
    }
}
END_TEST

/* ---- refusals -------------------------------------------------------------------------------------------------- */

/** Makes every mailbox answer to a request for an object another one, as a broken device would. */
typedef struct object_lie {
    uint16_t index;
    uint8_t subindex;
    uint32_t value;
} object_lie_t;

static cm1e_tap_verdict_t lie(void *context, cm1e_tap_frame_t *frame)
{
    const object_lie_t *object = context;
    uint8_t *mailbox = frame->bytes + 26;
    const bool is_read = frame->direction == CM1E_TAP_RECEIVED && frame->length > 60 && frame->bytes[16] == 4;
    if (is_read && (mailbox[5] & 0xF) == 3 && (mailbox[8] & 0xE0) == 0x40 &&
        cm1e_get_u16(mailbox + 9) == object->index && mailbox[11] == object->subindex)
        cm1e_put_u32(mailbox + 12, object->value);
    return CM1E_TAP_PASS;
}

static const struct {
    object_lie_t lie;
    const char *word;
} lies[] = {
    {{0x1C12, 0, 0}, "number of PDOs"},    {{0x1C13, 0, 2}, "number of PDOs"},    {{0x1C12, 1, 0x1601}, "assigned PDO"},
    {{0x1C13, 1, 0x6040}, "assigned PDO"}, {{0x1600, 0, 0}, "empty"},             {{0x1600, 1, 0x60400000}, "no bits"},
    {{0x1600, 1, 0}, "invalid output configuration"}, {{0x1A00, 3, 0x606400FF}, "lave 1"},
};

START_TEST(mapping_that_cannot_be_is_refused_in_words)
{
    object_lie_t object = lies[_i].lie;
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lie, &object);
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_int_ne(error, CM1E_OK);
    ck_assert_msg(strstr(diag.text, lies[_i].word) != NULL, "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/** Changes what the master writes into one register, so that the slave has a reason to refuse a state. */
typedef struct refusal {
    uint16_t offset;
    unsigned byte;
    uint8_t value;
    uint16_t code;
    const char *state;
} refusal_t;

static const refusal_t refusals[] = {
    {0x0800, 2, 0x10, 0x0016, "PRE-OP"},  /* mailbox of 16 bytes */
    {0x0810, 2, 12, 0x001D, "SAFE-OP"},   /* outputs of 12 bytes */
    {0x0818, 2, 22, 0x001E, "SAFE-OP"},   /* inputs of 22 bytes */
};

static cm1e_tap_verdict_t spoil(void *context, cm1e_tap_frame_t *frame)
{
    const refusal_t *refusal = context;
    const bool is_write = frame->direction == CM1E_TAP_SENT && frame->bytes[16] == 5;
    if (is_write && cm1e_get_u16(frame->bytes + 20) == refusal->offset)
        frame->bytes[26 + refusal->byte] = refusal->value;
    return CM1E_TAP_PASS;
}

START_TEST(refused_transition_is_told_with_the_al_status_code)
{
    refusal_t refusal = refusals[_i];
    sim_config(1);
    strcpy(config.axes[0].name, "gantry");
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), spoil, &refusal);
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_BUS_STATE);
    char code[16];
    snprintf(code, sizeof code, "0x%04X", refusal.code);
    ck_assert_uint_eq(diag.foreign_code, refusal.code);
    ck_assert_msg(strstr(diag.text, code) && strstr(diag.text, cm1e_al_status_text(refusal.code)) &&
                      strstr(diag.text, refusal.state) && strstr(diag.text, "Slave 1"), "%s", diag.text);
    if (_i > 0)
        ck_assert_msg(strstr(diag.text, "gantry") != NULL, "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- SII ------------------------------------------------------------------------------------------------------- */

enum { SII_STATUS = 0x0502, SII_GROUP = 0x0508 - SII_STATUS };

/** What every read of the SII gives, whatever was asked for: status and words come in one datagram. */
static cm1e_tap_verdict_t damage_sii(void *context, cm1e_tap_frame_t *frame)
{
    const uint32_t *words = context;
    const bool is_read = frame->bytes[16] == 1 || frame->bytes[16] == 4;
    if (frame->direction == CM1E_TAP_RECEIVED && is_read && cm1e_get_u16(frame->bytes + 20) == SII_STATUS) {
        cm1e_put_u32(frame->bytes + 26 + SII_GROUP, *words);
        cm1e_put_u32(frame->bytes + 30 + SII_GROUP, *words);
    }
    return CM1E_TAP_PASS;
}

static const struct {
    uint32_t words; /* category type, length in words */
    bool walkable;
} damages[] = {
    {0x00000000, false}, /* empty categories without end */
    {0x7FFC000A, false}, /* a length that leads 4 bytes back in a 16-bit address: SOEM would never return */
    {0xFFFE000A, false}, {0x00010000, false}, {0x80000033, false}, {0x01000800, true}, {0xFFFFFFFF, true},
};

START_TEST(damaged_sii_is_refused_and_never_hangs)
{
    uint32_t words = damages[_i].words;
    sim_config(2);
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), damage_sii, &words);
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_msg(error == CM1E_ERROR_BUS_IDENTITY || (damages[_i].walkable && error != CM1E_OK), "%d: %s", error,
                  diag.text);
    if (!damages[_i].walkable)
        ck_assert_msg(strstr(diag.text, "SII") && strstr(diag.text, "slave 1"), "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

typedef struct scramble {
    int one_in;
    unsigned struck;
} scramble_t;

static cm1e_tap_verdict_t scramble_sii(void *context, cm1e_tap_frame_t *frame)
{
    scramble_t *scramble = context;
    const bool is_read = frame->bytes[16] == 1 || frame->bytes[16] == 4;
    if (frame->direction != CM1E_TAP_RECEIVED || !is_read || cm1e_get_u16(frame->bytes + 20) != SII_STATUS ||
        rand() % scramble->one_in != 0)
        return CM1E_TAP_PASS;
    frame->bytes[26 + SII_GROUP + rand() % 8] = (uint8_t)rand();
    scramble->struck++;
    return CM1E_TAP_PASS;
}

START_TEST(scrambled_sii_never_hangs_nor_overruns)
{
    scramble_t scramble = {.one_in = 1 + _i % 8};
    srand((unsigned)_i);
    sim_config(2);
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), scramble_sii, &scramble);
    for (int n = 0; n < 10; n++) {
        const cm1e_error_t error = cm1e_bus_start(bus, &diag);
        ck_assert(error == CM1E_OK || strlen(diag.text) > 20);
    }
    ck_assert_uint_gt(scramble.struck, 0);
    check_nothing_moved(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Where the control byte of a sync manager lies in a SII. */
static uint8_t *control_in_sii(cm1e_bus_t *bus, unsigned manager)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment_of(bus), 1);
    uint8_t *place = slave->sii + 0x80;
    while (cm1e_get_u16(place) != 41)
        place += 4 + 2 * cm1e_get_u16(place + 2);
    return place + 4 + 8 * manager + 4;
}

START_TEST(outputs_trigger_the_watchdog_whatever_the_sii_says)
{
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    *control_in_sii(bus, 2) &= (uint8_t)~0x40;
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    const cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment_of(bus), 1);
    ck_assert_uint_eq(slave->memory[ESC_SM + 2 * 8 + 4], 0x64);
    ck_assert_uint_eq(cm1e_get_u16(slave->memory + ESC_WATCHDOG_DATA), 1000);
    cm1e_bus_close(bus);
}
END_TEST

typedef struct deaf_register {
    uint16_t offset;
    int times;
} deaf_register_t;

/** Writes to a register do not arrive, though the frame comes back. */
static cm1e_tap_verdict_t not_written(void *context, cm1e_tap_frame_t *frame)
{
    deaf_register_t *reg = context;
    const bool is_write = frame->bytes[16] == 5 || frame->bytes[16] == 8;
    if (frame->direction == CM1E_TAP_SENT && is_write && cm1e_get_u16(frame->bytes + 20) == reg->offset &&
        reg->times-- > 0)
        frame->bytes[16] = 0; /* NOP */
    return CM1E_TAP_PASS;
}

START_TEST(watchdog_that_is_not_set_is_an_error)
{
    deaf_register_t reg = {.offset = _i & 1 ? 0x0400 : 0x0420, .times = _i & 2 ? 2 : 1000};
    const bool disturbed = (_i & 2) != 0;
    sim_config(2);
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), not_written, &reg);
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_int_eq(error, disturbed ? CM1E_OK : CM1E_ERROR_BUS_WORKING_COUNTER);
    ck_assert_msg(disturbed || strstr(diag.text, "watchdog"), "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_faults");
    TCase *tests = tcase_create("faults");
    tcase_add_loop_test(tests, start_with_a_fault_at_every_frame_ends_defined, 0, KINDS);
    tcase_add_loop_test(tests, start_of_a_bridge_with_a_fault_at_every_frame_ends_defined, 0, KINDS);
    tcase_add_loop_test(tests, start_that_loses_the_bus_at_any_frame_ends_with_an_error, 0, 2);
    tcase_add_loop_test(tests, mapping_that_cannot_be_is_refused_in_words, 0, sizeof lies / sizeof lies[0]);
    tcase_add_loop_test(tests, refused_transition_is_told_with_the_al_status_code, 0,
                        sizeof refusals / sizeof refusals[0]);
    tcase_add_loop_test(tests, damaged_sii_is_refused_and_never_hangs, 0, sizeof damages / sizeof damages[0]);
    tcase_add_loop_test(tests, scrambled_sii_never_hangs_nor_overruns, 0, 40);
    tcase_add_test(tests, outputs_trigger_the_watchdog_whatever_the_sii_says);
    tcase_add_loop_test(tests, watchdog_that_is_not_set_is_an_error, 0, 4);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
