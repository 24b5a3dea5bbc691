/* The Cool MUSCLE Bridge on the bus: recognised, matched with its axes, mapped, in Operational beside other devices. */
#include "bridge_segment.h"
#include "sdo_harm.h"
#include "device/devices.h"

/* What a row of a table leaves out is 0. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

static bool is_bridge(const cm1e_slave_info_t *info) { return info->kind && strcmp(info->kind, "bridge") == 0; }

/* ---- scan -------------------------------------------------------------------------------------------------------- */

START_TEST(scan_knows_every_model_and_its_motors)
{
    static const device_kind_t devices[] = {AN_EB01, AN_EB02, AN_EB12, A_MOTOR, AN_IO_MODULE};
    static const uint8_t motors[3][4] = {{1, 1, 1, 1}, {2, 2, 2, 2}, {1, 1, 2, 2}};
    sim_config(0);
    cm1e_bus_t *bus = open_bus_on_devices(devices, 5);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (unsigned i = 0; i < 3; i++) {
        const cm1e_slave_info_t *info = cm1e_bus_slave(bus, i + 1);
        ck_assert(is_bridge(info));
        ck_assert(info->device != &cm1e_device_cm1e);
        ck_assert_int_eq(info->model, CM1E_DEVICE_EB01 + (int)i);
        ck_assert_mem_eq(info->motors, motors[i], 4);
    }
    for (unsigned position = 4; position <= 5; position++) {
        ck_assert(!is_bridge(cm1e_bus_slave(bus, position)));
        ck_assert_int_eq(cm1e_bus_slave(bus, position)->model, CM1E_DEVICE_CM1E);
    }
    ck_assert(cm1e_bus_slave(bus, 4)->device == &cm1e_device_cm1e);
    ck_assert_msg(cm1e_bus_identify(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- scan, of others --------------------------------------------------------------------------------------------- */

static const struct {
    uint16_t index;
    uint8_t subindex;
    bool must_be; /**< or it is no bridge */
} questions[] = {
    {0x1000, 0, true}, {0xF000, 1, true}, {0xF010, 1, true}, {0xF010, 2, true}, {0xF010, 3, true}, {0xF010, 4, true},
    {0xF050, 1, true}, {0xF050, 2, true}, {0xF050, 3, true}, {0xF050, 4, true}, {0xF511, 1, false},
    {0xF512, 1, false}, {0xF513, 1, false}, {0xF514, 1, false}, {0x1018, 3, false},
};
enum { QUESTIONS = sizeof questions / sizeof questions[0] };

/** Slave 2 answers one question as no bridge does; slave 1 is a good one. */
START_TEST(hostile_answers_make_no_bridge_and_do_not_hold_up_the_scan)
{
    static const device_kind_t devices[] = {AN_EB02, AN_EB12, A_MOTOR};
    sim_config(0);
    cm1e_bus_t *bus = open_bus_on_devices(devices, 3);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    const int64_t usual_ns = now_of(bus);
    srand(1);
    for (unsigned kind = ABORT; kind <= GARBAGE; kind++) {
        harm_t harm = {.kind = (harm_kind_t)kind, .station = 0x1002, .index = questions[_i].index,
                       .subindex = questions[_i].subindex};
        const int64_t before_ns = now_of(bus);
        set_harm(bus, &harm);
        ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
        ck_assert_int_lt(now_of(bus) - before_ns, usual_ns + 1100000000);
        const cm1e_slave_info_t *info = cm1e_bus_slave(bus, 2);
        const bool answered = kind == ABORT || kind == OTHER_VALUE;
        if (kind != GARBAGE) { /* which may be anything */
            ck_assert_msg(is_bridge(info) == (answered && !questions[_i].must_be), "kind %u", kind);
            if (is_bridge(info) && questions[_i].index != 0x1018)
                ck_assert_int_eq(info->model, CM1E_DEVICE_CM1E);
        }
        ck_assert_int_eq(cm1e_bus_slave(bus, 1)->model, CM1E_DEVICE_EB02);
        ck_assert(cm1e_bus_slave(bus, 3)->device == &cm1e_device_cm1e);
        ck_assert_uint_gt(harm.seen, 0);
    }
    harm_t none = {.kind = NO_HARM};
    set_harm(bus, &none);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_bus_slave(bus, 2)->model, CM1E_DEVICE_EB12);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(slave_that_answers_late_does_not_hold_up_the_scan)
{
    static const device_kind_t devices[] = {AN_EB02, AN_EB12};
    sim_config(0);
    cm1e_bus_t *bus = open_bus_on_devices(devices, 2);
    harm_t harm = {.kind = LATE, .station = 0x1002};
    set_harm(bus, &harm);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_lt(now_of(bus), INT64_C(6000000000));
    ck_assert(is_bridge(cm1e_bus_slave(bus, 1)));
    ck_assert(!is_bridge(cm1e_bus_slave(bus, 2)));
    cm1e_bus_close(bus);
}
END_TEST

/* ---- identify ---------------------------------------------------------------------------------------------------- */

typedef struct expected {
    uint16_t position; /**< from 100 on: an alias */
    uint8_t channel;
    const char *motor;
} expected_t;

#define WRONG CM1E_ERROR_BUS_IDENTITY
static const struct {
    const char *name;
    device_kind_t devices[4];
    uint32_t axes;
    expected_t expected[5];
    cm1e_error_t error;
    const char *words[4];
} cases[] = {
    {"four axes", {AN_EB12}, 4, {{1, 1, "CM1"}, {1, 2, ""}, {1, 3, "CM2"}, {1, 4, ""}}, CM1E_OK, {0}},
    {"one of four", {AN_EB01}, 1, {{1, 3, ""}}, CM1E_OK, {0}},
    {"in any order, two bridges", {AN_EB01, A_MOTOR, AN_EB02}, 4, {{3, 4, ""}, {2, 0, ""}, {1, 2, ""}, {3, 1, ""}},
     CM1E_OK, {0}},
    {"none configured at all", {AN_EB01, AN_EB02}, 0, {{0}}, CM1E_OK, {0}},
    {"missing", {AN_EB01}, 2, {{1, 1, ""}, {2, 1, ""}}, WRONG,
     {"\"axis2\"", "Cool MUSCLE Bridge at position 2", "missing"}},
    {"the same channel twice", {AN_EB01}, 2, {{1, 2, ""}, {101, 2, ""}}, WRONG,
     {"\"axis1\"", "\"axis2\"", "channel 2 of slave 1"}},
    {"a CM1-E where a bridge should be", {A_MOTOR}, 1, {{1, 1, ""}}, WRONG,
     {"expected a Cool MUSCLE Bridge", "a CM1-E", "remove the key channel"}},
    {"a bridge where a CM1-E should be", {AN_EB12}, 1, {{1, 0, ""}}, WRONG,
     {"expected a CM1-E", "slave 1, the bridge EB12", "channel, 1 ... 4"}},
    {"an axis with and one without channel", {AN_EB12}, 2, {{1, 1, ""}, {101, 0, ""}}, WRONG, {"\"axis2\"", "channel"}},
    {"by alias", {AN_IO_MODULE, AN_EB02}, 2, {{102, 1, ""}, {102, 4, "CM2"}}, CM1E_OK, {0}},
    {"an I/O module where a bridge should be", {AN_IO_MODULE}, 1, {{1, 1, ""}}, WRONG,
     {"expected a Cool MUSCLE Bridge", "another kind", "no mailbox"}},
    {"a CM1 where a CM2 is, beside a right one", {AN_EB12}, 2, {{1, 1, "CM1"}, {1, 3, "CM1"}}, WRONG,
     {"\"axis2\"", "motor CM1 at channel 3", "a CM2 there", "0xF513:01"}},
    {"a CM2 where a CM1 is", {AN_EB01}, 1, {{1, 2, "CM2"}}, WRONG, {"\"axis1\"", "a CM1 there", "0xF512:01"}},
    {"a CM1 where a CM2 is", {AN_EB02}, 1, {{1, 4, "CM1"}}, WRONG, {"\"axis1\"", "a CM2 there", "0xF514:01"}},
    {"an extra bridge", {A_MOTOR, AN_EB01}, 1, {{1, 0, ""}}, WRONG, {"Slave 2", "Bridge that is extra", "behind it"}},
    {"an extra CM1-E", {AN_EB01, A_MOTOR}, 1, {{1, 1, ""}}, WRONG, {"Slave 2", "CM1-E that is extra"}},
    {"an I/O module between", {AN_EB01, AN_IO_MODULE, AN_EB02}, 2, {{1, 1, ""}, {3, 1, ""}}, CM1E_OK, {0}},
};

static void expect_axes(const expected_t *expected, uint32_t count)
{
    sim_config(count);
    for (uint32_t i = 0; i < count; i++) {
        snprintf(config.axes[i].name, sizeof config.axes[i].name, "axis%u", i + 1);
        if (expected[i].channel)
            expect_bridged(i, expected[i].position, expected[i].channel, expected[i].motor);
        else
            config.axes[i].address = expected[i].position;
        if (expected[i].position >= alias_at(0))
            config.axes[i].address_kind = CM1E_ADDRESS_ALIAS;
    }
}

START_TEST(identity_of_every_axis_is_checked_in_words)
{
    expect_axes(cases[_i].expected, cases[_i].axes);
    cm1e_bus_t *bus = open_bus_on_devices(cases[_i].devices, 4);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    const cm1e_error_t error = cm1e_bus_identify(bus, &diag);
    ck_assert_msg(error == cases[_i].error, "%s: %s: %s", cases[_i].name, cm1e_strerror(error), diag.text);
    for (int i = 0; i < 4 && cases[_i].words[i]; i++)
        ck_assert_msg(strstr(diag.text, cases[_i].words[i]) != NULL, "%s: \"%s\" lacks \"%s\"", cases[_i].name,
                      diag.text, cases[_i].words[i]);
    for (uint32_t axis = 0; axis < cases[_i].axes && error == CM1E_OK; axis++)
        ck_assert_uint_eq(cm1e_bus_axis_position(bus, axis), cases[_i].expected[axis].position % alias_at(0));
    if (error == CM1E_OK)
        ck_assert_msg(cm1e_bus_configure(bus, &diag) == CM1E_OK, "%s: %s", cases[_i].name, diag.text);
    else
        ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_STATE);
    cm1e_bus_close(bus);
}
END_TEST

static const struct {
    harm_t harm;
    const char *words[3];
} lies[] = {
    {{.kind = OTHER_VALUE, .index = 0xF512, .subindex = 1}, {"1, 65, 2, 2", "0xF511:01", "EB12 1, 1, 2, 2"}},
    {{.kind = ABORT, .index = 0xF514, .subindex = 1}, {"1, 1, 2, 0", "no known model"}},
    {{.kind = OTHER_VALUE, .index = 0xF050, .subindex = 3}, {"another kind", "0xF050:03 is 0x00219840", "0x00219800"}},
    {{.kind = ABORT, .index = 0x1000, .subindex = 0}, {"another kind", "0x1000:00 cannot be read"}},
};

START_TEST(bridge_of_no_model_and_no_bridge_say_what_they_showed)
{
    static const device_kind_t devices[] = {AN_EB12};
    harm_t harm = lies[_i].harm;
    expect_axes(cases[0].expected, 4);
    cm1e_bus_t *bus = open_bus_on_devices(devices, 1);
    set_harm(bus, &harm);
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_BUS_IDENTITY);
    for (int i = 0; i < 3 && lies[_i].words[i]; i++)
        ck_assert_msg(strstr(diag.text, lies[_i].words[i]) != NULL, "\"%s\" lacks \"%s\"", diag.text,
                      lies[_i].words[i]);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- start ------------------------------------------------------------------------------------------------------- */

START_TEST(mixed_network_runs_with_the_process_data_of_all)
{
    cm1e_bus_t *bus = start_mixed();
    static const uint16_t positions[] = {2, 4, 1, 2, 2};
    for (uint32_t axis = 0; axis < 5; axis++)
        ck_assert_uint_eq(cm1e_bus_axis_position(bus, axis), positions[axis]);
    static const uint16_t bridges[] = {2, 4};
    uint32_t target[2][CM1E_BRIDGE_AXES];
    for (unsigned n = 0; n < 2; n++) {
        ck_assert_uint_eq(cm1e_bus_slave(bus, bridges[n])->output_bytes, 24);
        ck_assert_uint_eq(cm1e_bus_slave(bus, bridges[n])->input_bytes, 24);
        for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES; channel++) {
            const cm1e_image_slot_t word = cm1e_bus_find_output(bus, bridges[n], on_channel(channel, 0x6040), 0);
            const cm1e_image_slot_t position = cm1e_bus_find_output(bus, bridges[n], on_channel(channel, 0x607A), 0);
            ck_assert_uint_eq(word.bytes, 2);
            ck_assert_uint_eq(position.bytes, 4);
            ck_assert_uint_eq(position.offset, word.offset + 2);
            ck_assert_uint_eq(cm1e_bus_find_output(bus, bridges[n], on_channel(channel, 0x6041), 0).bytes, 0);
            ck_assert_uint_eq(cm1e_bus_find_input(bus, bridges[n], on_channel(channel, 0x6064), 0).bytes, 4);
            target[n][channel - 1] = 1000 * n + channel;
            cm1e_put_u16(cm1e_bus_outputs(bus) + word.offset, channel == 3 ? 0 : 0x0006);
            cm1e_put_u32(cm1e_bus_outputs(bus) + position.offset, target[n][channel - 1]);
        }
    }
    cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, 1, 0x6040, 0).offset, 0x0006);
    cycles(bus, 100);
    for (unsigned n = 0; n < 2; n++) {
        const cm1e_sim_bridge_t *bridge = bridge_at(bus, bridges[n]);
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, bridges[n]).al_state, CM1E_AL_OP);
        for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
            const uint32_t at = cm1e_bus_find_input(bus, bridges[n], on_channel(i + 1, 0x6041), 0).offset;
            ck_assert_uint_eq(bridge->axes[i].controlword, i == 2 ? 0 : 6);
            ck_assert_int_eq(bridge->axes[i].target_position, (int32_t)target[n][i]);
            ck_assert_uint_eq(cm1e_get_u16(cm1e_bus_inputs(bus) + at), cm1e_sim_bridge_statusword(&bridge->axes[i]));
            ck_assert_uint_eq(cm1e_get_u16(cm1e_bus_inputs(bus) + at) & 0x4F, i == 2 ? 0x40 : 0x01);
        }
    }
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment_of(bus), 1, &probe);
    ck_assert_uint_eq(probe.controlword, 6);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 3).al_state, CM1E_AL_OP);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    cm1e_bus_close(bus);
}
END_TEST

/** As after power-on, when a CM1 holds its position and a CM2 is what its K68 says (BR 6.1.1): nothing moves them. */
START_TEST(motors_without_an_axis_stay_disabled)
{
    static const device_kind_t devices[] = {AN_EB01};
    sim_config(1);
    expect_bridged(0, 1, 2, "CM1");
    cm1e_bus_t *bus = open_bus_on_devices(devices, 1);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    static const uint16_t words[] = {0x0006, 0x0007, 0x000F};
    for (unsigned i = 0; i < 3; i++) {
        cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, 1, 0x6840, 0).offset, words[i]);
        cycles(bus, 100);
    }
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
        const cm1e_sim_bridge_axis_t *axis = &bridge_at(bus, 1)->axes[i];
        ck_assert_uint_eq(axis->controlword, i == 1 ? 0x000F : 0);
        ck_assert_int_eq(axis->state, i == 1 ? OPERATION_ENABLED : SWITCH_ON_DISABLED);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(bridge_runs_at_1_ms_only)
{
    static const int64_t times_us[] = {200, 250, 500, 1000};
    for (unsigned i = 0; i < 4; i++) {
        static const device_kind_t devices[] = {AN_IO_MODULE, AN_EB12};
        sim_config(0); /* with an axis behind a bridge the configuration itself is refused */
        config.cycle_time_ns = times_us[i] * 1000;
        cm1e_bus_t *bus = open_bus_on_devices(devices, 2);
        const cm1e_error_t error = cm1e_bus_start(bus, &diag);
        const bool right = times_us[i] == 1000;
        ck_assert_msg(error == (right ? CM1E_OK : CM1E_ERROR_BUS_CYCLE_TIME), "%s", diag.text);
        ck_assert_msg(right || (strstr(diag.text, "Slave 2 (bridge EB12)") && strstr(diag.text, "1000 us only")), "%s",
                      diag.text);
        cm1e_bus_close(bus);
    }
}
END_TEST

/* ---- mapping ----------------------------------------------------------------------------------------------------- */

/** Up to the configuration everything is right. */
static cm1e_bus_t *identified_bus(void)
{
    static const device_kind_t devices[] = {AN_EB12};
    expect_axes(cases[0].expected, 4);
    cm1e_bus_t *bus = open_bus_on_devices(devices, 1);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), CM1E_OK);
    return bus;
}

enum { MAPPING_TRANSFERS = 12 + 34 };

START_TEST(mapping_damaged_at_any_transfer_ends_defined)
{
    for (unsigned kind = ABORT; kind <= GARBAGE; kind++) {
        cm1e_bus_t *bus = identified_bus();
        harm_t harm = {.kind = (harm_kind_t)kind, .at = (unsigned)_i};
        srand((unsigned)_i);
        const int64_t before_ns = now_of(bus);
        set_harm(bus, &harm);
        cm1e_error_t error = cm1e_bus_configure(bus, &diag);
        ck_assert_int_lt(now_of(bus) - before_ns, INT64_C(5000000000));
        if (_i > MAPPING_TRANSFERS) {
            ck_assert_msg(error == CM1E_OK && harm.seen == MAPPING_TRANSFERS, "%u transfers: %s", harm.seen, diag.text);
        } else if (error != CM1E_OK) {
            ck_assert_msg(strlen(diag.text) > 40 && strstr(diag.text, "lave 1 ("), "%s", diag.text);
        } else { /* a refusal of what was done nevertheless; values that lie in a download's answer are none */
            ck_assert_msg(_i <= 12 || kind == OTHER_VALUE || kind == GARBAGE, "transfer %d, kind %u", _i, kind);
        }
        harm_t none = {.kind = NO_HARM};
        set_harm(bus, &none);
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
        cycles(bus, 20);
        ck_assert_uint_eq(cm1e_bus_slave(bus, 1)->output_bytes, 24);
        for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
            ck_assert_int_eq(bridge_at(bus, 1)->axes[i].state, SWITCH_ON_DISABLED);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** The device says no to every write of the assignment, which it has already, or else lacks one PDO. */
typedef struct stubborn {
    bool wrong;
    unsigned refused;
} stubborn_t;

static cm1e_tap_verdict_t refuse_assignment(void *context, cm1e_tap_frame_t *frame)
{
    stubborn_t *stubborn = context;
    uint8_t *mailbox = frame->bytes + 26;
    const uint16_t index = frame->length > 60 ? cm1e_get_u16(mailbox + 9) : 0;
    if ((index != 0x1C12 && index != 0x1C13) || (mailbox[5] & 0x0F) != 3)
        return CM1E_TAP_PASS;
    const bool write = frame->direction == CM1E_TAP_SENT && frame->bytes[16] == 5 && (mailbox[8] & 0xE0) == 0x20;
    const bool written = frame->direction == CM1E_TAP_RECEIVED && frame->bytes[16] == 4 && mailbox[8] == 0x60;
    if (write && stubborn->wrong && mailbox[11] == 0 && mailbox[SDO_DATA] == 4)
        mailbox[SDO_DATA] = 3;
    if (written) {
        stubborn->refused++;
        spoil(&(harm_t){.kind = ABORT}, mailbox);
    }
    return CM1E_TAP_PASS;
}

START_TEST(assignment_that_is_refused_is_judged_by_what_it_is)
{
    for (unsigned wrong = 0; wrong < 2; wrong++) {
        stubborn_t stubborn = {.wrong = wrong};
        cm1e_bus_t *bus = identified_bus();
        cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_assignment, &stubborn);
        const cm1e_error_t error = cm1e_bus_configure(bus, &diag);
        ck_assert_msg(error == (wrong ? CM1E_ERROR_SDO_ABORT : CM1E_OK), "%s", diag.text);
        ck_assert_uint_eq(stubborn.refused, 12);
        ck_assert_msg(!wrong || (strstr(diag.text, "refuses to write object 0x1C12:00") &&
                                 strstr(diag.text, "read-only") && strstr(diag.text, "bridge EB12")), "%s", diag.text);
        cm1e_bus_close(bus);
    }
}
END_TEST

static cm1e_tap_verdict_t lose_watchdog(void *context, cm1e_tap_frame_t *frame)
{
    const uint16_t station = *(const uint16_t *)context;
    const bool is = frame->bytes[16] == 5 && cm1e_get_u16(frame->bytes + 18) == station &&
                    cm1e_get_u16(frame->bytes + 20) == 0x0420;
    return is ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

START_TEST(bridge_that_does_not_take_its_watchdog_is_refused)
{
    uint16_t station = 0x1001;
    cm1e_bus_t *bus = identified_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_watchdog, &station);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_BUS_WORKING_COUNTER);
    ck_assert_msg(strstr(diag.text, "watchdog") &&
                  strstr(diag.text, "Slave 1 (\"axis1\", \"axis2\", \"axis3\", \"axis4\", bridge EB12)"),
                  "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_bridge");
    TCase *tests = tcase_create("bridge");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, scan_knows_every_model_and_its_motors);
    tcase_add_loop_test(tests, hostile_answers_make_no_bridge_and_do_not_hold_up_the_scan, 0, QUESTIONS);
    tcase_add_test(tests, slave_that_answers_late_does_not_hold_up_the_scan);
    tcase_add_loop_test(tests, identity_of_every_axis_is_checked_in_words, 0, sizeof cases / sizeof cases[0]);
    tcase_add_loop_test(tests, bridge_of_no_model_and_no_bridge_say_what_they_showed, 0, sizeof lies / sizeof lies[0]);
    tcase_add_test(tests, mixed_network_runs_with_the_process_data_of_all);
    tcase_add_test(tests, motors_without_an_axis_stay_disabled);
    tcase_add_test(tests, bridge_runs_at_1_ms_only);
    tcase_add_loop_test(tests, mapping_damaged_at_any_transfer_ends_defined, 1, MAPPING_TRANSFERS + 2);
    tcase_add_test(tests, assignment_that_is_refused_is_judged_by_what_it_is);
    tcase_add_test(tests, bridge_that_does_not_take_its_watchdog_is_refused);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
