/* From the wire to Operational: scan, identify, configure, operate, stop. */
#include "bus/bus_internal.h"
#include "bus_support.h"
#include "cm1e/bridge.h"
#include "cm1e/sdo_info.h"
#include "device/devices.h"

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
enum { FIRMWARES = 6, MAPPINGS = 4 };

START_TEST(scan_finds_every_slave_from_1_to_16)
{
    const uint32_t count = (uint32_t)_i;
    sim_config(count);
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), count);
    for (uint32_t position = 1; position <= count; position++) {
        const cm1e_slave_info_t *info = cm1e_bus_slave(bus, position);
        ck_assert_uint_eq(info->position, position);
        ck_assert_uint_eq(info->vendor_id, CM1E_VENDOR_ID);
        ck_assert_uint_eq(info->product_code, CM1E_PRODUCT_CODE);
        ck_assert(info->device == &cm1e_device_cm1e);
        ck_assert_uint_eq(info->al_state, CM1E_AL_PRE_OP);
        ck_assert_str_ne(info->name, "");
        ck_assert_msg(strstr(info->software_version, tested_firmware()) != NULL, "%s", info->software_version);
    }
    ck_assert_ptr_null(cm1e_bus_slave(bus, 0));
    ck_assert_ptr_null(cm1e_bus_slave(bus, count + 1));
    cm1e_bus_close(bus);
}
END_TEST

/** A look at a state that was asked for before the slave changed it must not be taken afterwards. */
START_TEST(every_slave_is_seen_in_operational_at_once)
{
    sim_config((uint32_t)_i);
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (uint16_t position = 1; position <= _i; position++) {
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
        ck_assert_uint_eq(cm1e_bus_slave(bus, position)->al_state, CM1E_AL_OP);
    }
    cm1e_bus_close(bus);
}
END_TEST

static unsigned exchanges, questions;

/** Counts the frames of process data, and those that ask a slave for its state. */
static cm1e_tap_verdict_t count_questions(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND_AT = 16, LRW_NUMBER = 12 };
    uint16_t station;
    (void)context;
    if (frame->direction == CM1E_TAP_SENT && frame->bytes[COMMAND_AT] == LRW_NUMBER) {
        exchanges++;
        questions += find_read(frame, REG_AL_STATUS, &station) >= 0;
    }
    return CM1E_TAP_PASS;
}

/** Also after a question that was given up, because it is older than a change of the state. */
START_TEST(every_cycle_of_a_start_asks_for_a_state)
{
    sim_config(3);
    cm1e_bus_t *bus = open_bus();
    ck_assert(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK);
    ck_assert_msg(cm1e_bus_configure(bus, &diag) == CM1E_OK, "%s", diag.text);
    exchanges = questions = 0;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), count_questions, NULL);
    ck_assert_msg(cm1e_bus_operate(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_gt(exchanges, 3);
    ck_assert_uint_eq(questions, exchanges);
    cm1e_bus_close(bus);
}
END_TEST

static void check_direction(cm1e_bus_t *bus, uint16_t position, const cm1e_axis_config_t *axis, bool transmit,
                            uint32_t base)
{
    cm1e_pdo_t pdo;
    const cm1e_firmware_info_t *firmware = cm1e_firmware_from_version(axis->firmware);
    cm1e_device_pdo(&pdo, axis->mapping, transmit, config.sim_pdo_order, firmware->firmware);
    uint32_t bits = 0;
    for (unsigned i = 0; i < pdo.entry_count; i++) {
        const cm1e_pdo_entry_t *entry = &pdo.entries[i];
        const cm1e_image_slot_t slot = transmit
                                           ? cm1e_bus_find_input(bus, position, entry->index, entry->subindex)
                                           : cm1e_bus_find_output(bus, position, entry->index, entry->subindex);
        if (entry->index) {
            ck_assert_uint_eq(slot.bytes, entry->bits / 8);
            ck_assert_uint_eq(slot.offset, base + bits / 8);
        }
        bits += entry->bits;
    }
    const cm1e_slave_info_t *info = cm1e_bus_slave(bus, position);
    ck_assert_uint_eq(transmit ? info->input_bytes : info->output_bytes, bits / 8);
    /* What is not in this mapping is not found in it. */
    ck_assert_uint_eq(cm1e_bus_find_input(bus, position, 0x6040, 0).bytes, 0);
    ck_assert_uint_eq(cm1e_bus_find_output(bus, position, 0x6041, 0).bytes, 0);
    ck_assert_uint_eq(cm1e_bus_find_output(bus, position, 0, 0).bytes, 0);
}

/** Both orders, every firmware, every mapping; three axes with different mappings, so that places differ. */
/** Frames have the numbers of their buffers, which take turns: one of the last two comes again only if it is sent again. */
static cm1e_tap_verdict_t see_number(void *context, cm1e_tap_frame_t *frame)
{
    enum { NUMBER = 17 };
    int *numbers = context;
    if (frame->direction != CM1E_TAP_SENT || frame->length <= NUMBER)
        return CM1E_TAP_PASS;
    ck_assert_int_ne(frame->bytes[NUMBER], numbers[0]);
    ck_assert_int_ne(frame->bytes[NUMBER], numbers[1]);
    numbers[1] = numbers[0];
    numbers[0] = frame->bytes[NUMBER];
    return CM1E_TAP_PASS;
}

/** A frame that is waited for in vain takes 2 ms: one of them would show. */
START_TEST(a_start_sends_no_frame_twice_and_waits_for_none_in_vain)
{
    const int64_t scan_ns = 5000000, configure_ns = 8300000;
    int numbers[] = {-1, -1};
    sim_config((uint32_t)_i);
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), see_number, numbers);
    const int64_t begin_ns = now_of(bus);
    ck_assert(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK);
    const int64_t scanned_ns = now_of(bus);
    ck_assert_int_lt(scanned_ns - begin_ns, scan_ns);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_OK);
    ck_assert_int_lt(now_of(bus) - scanned_ns, configure_ns);
    ck_assert_int_eq(cm1e_bus_operate(bus, &diag), CM1E_OK);
    cycles(bus, 100);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(start_resolves_every_object_in_every_order_firmware_and_mapping)
{
    sim_config(3);
    config.sim_pdo_order = (cm1e_pdo_order_t)(_i / (FIRMWARES * MAPPINGS));
    for (unsigned i = 0; i < 3; i++) {
        strcpy(config.axes[i].firmware, firmwares[_i / MAPPINGS % FIRMWARES]);
        config.axes[i].mapping = (cm1e_mapping_t)(((unsigned)_i + i) % MAPPINGS);
    }
    cm1e_bus_t *bus = start_bus();
    uint32_t output = 0, input = 0;
    for (uint16_t position = 1; position <= 3; position++) {
        const cm1e_axis_config_t *axis = &config.axes[position - 1];
        ck_assert_uint_eq(cm1e_bus_axis_position(bus, position - 1u), position);
        check_direction(bus, position, axis, false, output);
        check_direction(bus, position, axis, true, input);
        output += cm1e_bus_slave(bus, position)->output_bytes;
        input += cm1e_bus_slave(bus, position)->input_bytes;
        ck_assert_str_eq(cm1e_bus_slave_firmware(bus, position)->version, axis->firmware);
    }
    cycles(bus, 20);
    for (uint16_t position = 1; position <= 3; position++) {
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
        const cm1e_image_slot_t slot = cm1e_bus_find_input(bus, position, 0x6041, 0);
        cm1e_sim_probe_t probe;
        cm1e_sim_probe(segment_of(bus), position, &probe);
        ck_assert_uint_eq(cm1e_get_u16(cm1e_bus_inputs(bus) + slot.offset), probe.statusword);
        ck_assert_uint_eq(probe.controlword, 0);
    }
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->lost_frames, 0);
    cm1e_bus_close(bus);
}
END_TEST

/** More than one frame of process data: 43 drives fill the first (34 bytes each). */
START_TEST(large_bus_runs_in_several_frames)
{
    static const uint32_t counts[] = {43, 44, 87, 243};
    sim_config(counts[_i]);
    config.frame_timeout_ns = 900000;
    cm1e_bus_t *bus = start_bus();
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), counts[_i]);
    for (uint32_t n = 1; n <= 300; n++) {
        for (uint32_t position = 1; position <= counts[_i]; position++)
            cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, (uint16_t)position, 0x60FE, 0).offset,
                         (uint16_t)((n + position) % 4));
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    }
    for (uint32_t position = 1; position <= counts[_i]; position++) {
        uint8_t data[2];
        size_t size = 2;
        ck_assert_int_eq(cm1e_sdo_read(bus, (uint16_t)position, 0x60FE, 0, data, &size, &diag), CM1E_OK);
        ck_assert_uint_eq(cm1e_get_u16(data), (300 + position) % 4); /* each got its own outputs */
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, (uint16_t)position).al_state, CM1E_AL_OP);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Positions beyond 255, and the last axis of the list, on the longest network: motors between I/O modules, and virtual axes in the
 *  list before them. */
START_TEST(the_longest_network_has_motors_at_its_end)
{
    static const struct {
        uint32_t axis, position;
    } motors[] = {{0, 1}, {251, 255}, {252, 256}, {253, 257}, {254, 271}, {CM1E_MAX_AXES - 1, CM1E_MAX_SLAVES}};
    enum { MOTORS = sizeof motors / sizeof motors[0] };
    sim_config(CM1E_MAX_AXES);
    for (uint32_t i = 0; i < CM1E_MAX_AXES; i++)
        config.axes[i] = (cm1e_axis_config_t){.type = CM1E_AXIS_VIRTUAL};
    for (uint32_t i = 0; i < MOTORS; i++) {
        cm1e_axis_config_t *axis = &config.axes[motors[i].axis];
        *axis = (cm1e_axis_config_t){.type = CM1E_AXIS_MOTOR, .address = (uint16_t)motors[i].position};
        strcpy(axis->firmware, tested_firmware());
    }
    cm1e_bus_t *bus = start_bus();
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), CM1E_MAX_SLAVES);
    for (uint32_t i = 0; i < MOTORS; i++) {
        const uint16_t position = (uint16_t)motors[i].position;
        ck_assert_uint_eq(cm1e_bus_axis_position(bus, motors[i].axis), position);
        ck_assert_ptr_eq(cm1e_bus_axis_of(bus, cm1e_bus_at(bus, position), 0), &bus->config.axes[motors[i].axis]);
        cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, position, 0x60FE, 0).offset, (uint16_t)(i % 4));
    }
    cycles(bus, CM1E_MAX_SLAVES + 100); /* the supervision has looked at each */
    for (uint32_t i = 0; i < MOTORS; i++) {
        uint8_t data[2];
        size_t size = 2;
        const uint16_t position = (uint16_t)motors[i].position;
        ck_assert_int_eq(cm1e_sdo_read(bus, position, 0x60FE, 0, data, &size, &diag), CM1E_OK);
        ck_assert_uint_eq(cm1e_get_u16(data), i % 4);
    }
    for (uint16_t position = 1; position <= CM1E_MAX_SLAVES; position++)
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(stop_brings_all_slaves_to_init_and_start_works_again)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    for (int round = 0; round < 3; round++) {
        cycles(bus, 10);
        cm1e_bus_stop(bus);
        for (uint32_t position = 1; position <= 2; position++)
            ck_assert_uint_eq(cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), position)), CM1E_AL_INIT);
        ck_assert_int_eq(cm1e_bus_receive(bus), CM1E_ERROR_STATE);
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    }
    cm1e_bus_stop(bus);
    cm1e_bus_stop(bus);
    cm1e_bus_close(bus);
    cm1e_bus_close(NULL);
    cm1e_bus_stop(NULL);
}
END_TEST

typedef struct way_down {
    cm1e_bus_t *bus;
    unsigned requests, too_early;
} way_down_t;

/** Counts the requests of Init of all slaves, and those of a slave that is in Operational still. */
static cm1e_tap_verdict_t watch_requests(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND_AT = 16, OFFSET_AT = 20, DATA_AT = 26 };
    way_down_t *way = context;
    if (frame->direction != CM1E_TAP_SENT || frame->bytes[COMMAND_AT] != COMMAND_BWR ||
        cm1e_get_u16(frame->bytes + OFFSET_AT) != REG_AL_CONTROL || frame->bytes[DATA_AT] != CM1E_AL_INIT)
        return CM1E_TAP_PASS;
    way->requests++;
    for (uint32_t position = 1; position <= 2; position++)
        way->too_early += cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(way->bus), position)) == CM1E_AL_OP;
    return CM1E_TAP_PASS;
}

/** So its outputs are safe for as long as it needs, also of a slave that leaves Operational only after a while. */
START_TEST(stop_asks_for_init_when_no_slave_is_in_operational)
{
    sim_config(2);
    way_down_t way = {.bus = start_bus()};
    cycles(way.bus, 10);
    cm1e_nic_set_tap(cm1e_bus_nic(way.bus), watch_requests, &way);
    cm1e_bus_stop(way.bus);
    ck_assert_uint_ge(way.requests, 1);
    ck_assert_uint_eq(way.too_early, 0);
    cm1e_nic_set_tap(cm1e_bus_nic(way.bus), NULL, NULL);
    cm1e_bus_close(way.bus);
}
END_TEST

static void refused(cm1e_error_t error, const char *function)
{
    ck_assert_int_eq(error, CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_msg(strncmp(diag.text, function, strlen(function)) == 0 && strstr(diag.text, "needs a "), "%s", diag.text);
}

START_TEST(functions_without_a_bus_or_a_place_for_their_result_are_refused)
{
    refused(cm1e_bus_scan(NULL, &diag), "cm1e_bus_scan()");
    refused(cm1e_bus_identify(NULL, &diag), "cm1e_bus_identify()");
    refused(cm1e_bus_configure(NULL, &diag), "cm1e_bus_configure()");
    refused(cm1e_bus_operate(NULL, &diag), "cm1e_bus_operate()");
    refused(cm1e_bus_start(NULL, &diag), "cm1e_bus_start()");
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    refused(cm1e_bus_read_ports(bus, 1, NULL, &diag), "cm1e_bus_read_ports()");
    refused(cm1e_sdo_info_object(bus, 1, 0x6041, NULL, &diag), "cm1e_sdo_info_object()");
    refused(cm1e_sdo_info_entry(bus, 1, 0x6041, 0, NULL, &diag), "cm1e_sdo_info_entry()");
    refused(cm1e_bridge_read(bus, 1, NULL, &diag), "cm1e_bridge_read()");
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(steps_out_of_order_are_refused)
{
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    uint8_t byte;
    size_t size = 1;
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_operate(bus, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1001, 0, &byte, &size, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_receive(bus), CM1E_ERROR_STATE);
    cm1e_bus_send(bus);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_operate(bus, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_operate(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_operate(bus, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_ERROR_STATE);
    cycles(bus, 5); /* the refused calls did not disturb it */
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(cycle_time_must_suit_the_firmware)
{
    static const int64_t times[] = {200000, 250000, 500000, 1000000};
    for (int f = 0; f < FIRMWARES; f++) {
        for (int t = 0; t < 4; t++) {
            strcpy(sim_config(1)->axes[0].firmware, firmwares[f]);
            cm1e_bus_config_t real = config;
            config.axes = NULL; /* they are of the other one now */
            sim_config(1)->cycle_time_ns = times[t];
            config.axes[0].firmware[0] = '\0'; /* any */
            const bool good = times[t] == 1000000 || f >= 2; /* all four from V1.3.2 on (UG 10.1) */
            cm1e_bus_t *bus = open_bus_on(&real);
            cm1e_bus_config_free(&real);
            const cm1e_error_t error = cm1e_bus_start(bus, &diag);
            ck_assert_msg(error == (good ? CM1E_OK : CM1E_ERROR_BUS_CYCLE_TIME), "%s %d: %s", firmwares[f], t,
                          diag.text);
            if (good) {
                const int64_t begin_ns = now_of(bus);
                cycles(bus, 100);
                ck_assert_int_eq(now_of(bus) - begin_ns, 100 * times[t]);
            } else {
                ck_assert_msg(strstr(diag.text, firmwares[f]) && strstr(diag.text, "1000"), "%s", diag.text);
            }
            cm1e_bus_close(bus);
        }
    }
}
END_TEST

/** Time of all frames that are sent, on a wire of 100 Mbit/s: 60 bytes at least, and 24 around them. */
static cm1e_tap_verdict_t add_wire_time(void *context, cm1e_tap_frame_t *frame)
{
    int64_t *wire_ns = context;
    if (frame->direction == CM1E_TAP_SENT)
        *wire_ns += (int64_t)((frame->length > 60 ? frame->length : 60) + 24) * 80;
    return CM1E_TAP_PASS;
}

/** A cycle time too short for the wire is refused with the reason; one that is accepted holds, and with all mailboxes at
 *  work the frames of a cycle are back before the next one, if a slave takes 1.2 us. */
START_TEST(cycle_time_must_leave_the_frames_their_time)
{
    static const struct {
        int64_t cycle_us;
        uint32_t fits, too_many;
    } limits[] = {{200, 43, 44}, {250, 56, 57}, {500, 118, 119}, {1000, 243, 244}};
    const uint32_t axes = _i % 2 ? limits[_i / 2].too_many : limits[_i / 2].fits;
    sim_config(axes);
    for (uint32_t i = 0; i < axes; i++)
        strcpy(config.axes[i].firmware, "1.3.5");
    config.cycle_time_ns = limits[_i / 2].cycle_us * 1000;
    cm1e_bus_t *bus = open_bus();
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    if (_i % 2) {
        ck_assert_int_eq(error, CM1E_ERROR_CONFIG);
        char words[120];
        const char *about = strstr(diag.text, "takes about ");
        const long long wire_us = about ? strtoll(about + strlen("takes about "), NULL, 10) : 0;
        snprintf(words, sizeof words, "mailboxes and supervision at least 21 us more: too long for a cycle time of %lld us.",
                 (long long)limits[_i / 2].cycle_us);
        ck_assert_msg(strstr(diag.text, words) != NULL, "%s", diag.text);
        ck_assert_int_ge(wire_us + 22, limits[_i / 2].cycle_us);
        ck_assert_int_le(wire_us + 21, limits[_i / 2].cycle_us + 4); /* by the one slave that is too much */
    } else {
        ck_assert_msg(error == CM1E_OK, "%s", diag.text);
        static cm1e_sdo_t sdos[CM1E_MAX_AXES];
        static uint8_t data[CM1E_MAX_AXES][64];
        int64_t wire_ns = 0, most_ns = 0;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), add_wire_time, &wire_ns);
        for (int n = 0; n < 1000; n++) {
            for (uint32_t i = 0; i < axes; i++) { /* all mailboxes at work all the time */
                if (cm1e_sdo_state(&sdos[i]) == CM1E_SDO_BUSY)
                    continue;
                sdos[i] = (cm1e_sdo_t){.position = (uint16_t)(i + 1), .index = 0x1008, .data = data[i], .size = 64};
                cm1e_sdo_submit(bus, &sdos[i]);
            }
            wire_ns = 0;
            ck_assert_int_eq(cycle(bus), CM1E_OK);
            most_ns = wire_ns > most_ns ? wire_ns : most_ns;
        }
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL); /* wire_ns ends here */
        most_ns += axes * INT64_C(1200);
        ck_assert_int_le(most_ns, config.cycle_time_ns);
        ck_assert_int_gt(most_ns, config.cycle_time_ns * 9 / 10); /* mailboxes had their turn */
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Slaves whose outputs are closed outside of Operational, or for ever. */
typedef struct closed_outputs {
    cm1e_bus_t *bus;
    bool for_ever;
} closed_outputs_t;

static cm1e_tap_verdict_t do_not_count_outputs(void *context, cm1e_tap_frame_t *frame)
{
    const closed_outputs_t *closed = context;
    int missing = 0;
    for (uint32_t n = 1; n <= 2; n++) {
        const bool in_op = cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(closed->bus), n)) == CM1E_AL_OP;
        missing += !in_op || closed->for_ever ? 2 : 0;
    }
    if (frame->direction == CM1E_TAP_RECEIVED && frame->bytes[16] == 12 /* LRW */)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -missing);
    return CM1E_TAP_PASS;
}

START_TEST(outputs_that_open_in_operational_only_are_no_obstacle)
{
    sim_config(2);
    closed_outputs_t closed = {.bus = open_bus(), .for_ever = _i};
    cm1e_nic_set_tap(cm1e_bus_nic(closed.bus), do_not_count_outputs, &closed);
    const cm1e_error_t error = cm1e_bus_start(closed.bus, &diag);
    ck_assert_msg(error == (_i ? CM1E_ERROR_BUS_WORKING_COUNTER : CM1E_OK), "%s", diag.text);
    if (error == CM1E_OK)
        cycles(closed.bus, 20);
    else
        ck_assert_uint_eq(cm1e_bus_slave(closed.bus, 1)->al_state, CM1E_AL_INIT);
    cm1e_bus_close(closed.bus);
}
END_TEST

START_TEST(no_slaves_is_an_error_that_names_the_interface)
{
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), cm1e_sim_segment_create_empty());
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_BUS_NO_SLAVES);
    ck_assert_ptr_nonnull(strstr(diag.text, "sim"));
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(io_module_between_the_axes_is_mapped_by_its_sii)
{
    sim_config(2);
    config.axes[0].address = 1;
    config.axes[1].address = 3;
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    cm1e_sim_segment_add(segment, cm1e_sim_cm1e_create(&config.axes[0], CM1E_PDO_ORDER_UG_4_4, 0, 0));
    cm1e_sim_segment_add(segment, cm1e_sim_io_module_create());
    cm1e_sim_segment_add(segment, cm1e_sim_cm1e_create(&config.axes[1], CM1E_PDO_ORDER_UG_4_4, 0, 0));
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave(bus, 2)->output_bytes, 1);
    ck_assert_uint_eq(cm1e_bus_slave(bus, 2)->input_bytes, 1);
    ck_assert(cm1e_bus_slave(bus, 2)->device != &cm1e_device_cm1e);
    ck_assert_uint_eq(cm1e_bus_find_output(bus, 1, 0x6040, 0).offset, 0);
    ck_assert_uint_eq(cm1e_bus_find_output(bus, 3, 0x6040, 0).offset, 14);
    cycles(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

/** Gives the station address of a slave, found by its place, to another one: as if slaves had been moved since. */
static void change_station(cm1e_bus_t *bus, uint16_t place, uint16_t station)
{
    uint8_t frame[60] = {[12] = 0x88, [13] = 0xA4, [14] = 14, [15] = 0x10, [16] = 2 /* APWR */, [20] = 0x10, [22] = 2};
    cm1e_put_u16(frame + 18, (uint16_t)(1 - place));
    cm1e_put_u16(frame + 26, station);
    cm1e_sim_segment_process(segment_of(bus), 0, frame, sizeof frame, now_of(bus));
    ck_assert_uint_eq(cm1e_get_u16(frame + 28), 1);
}

/** A slave was put in front, one was taken out, two changed places: addresses of an earlier scan are still there. */
START_TEST(scan_takes_no_notice_of_addresses_of_an_earlier_one)
{
    static const uint16_t left_behind[][3] = {
        {0, 0x1001, 0x1002}, {0x1002, 0x1003, 0}, {0x1002, 0x1001, 0x1003}, {0x1001, 0x1001, 0x1001}, {0, 0, 0},
        {0x1003, 0x1003, 0x1002},
    };
    sim_config(3);
    cm1e_bus_t *bus = open_bus();
    for (uint16_t place = 1; place <= 3; place++)
        change_station(bus, place, left_behind[_i][place - 1]);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 3);
    cycles(bus, 20);
    cm1e_bus_close(bus);
}
END_TEST

/** Ports that are held closed, an alias that is an address, pulses, process data. */
START_TEST(a_scan_clears_what_another_master_left)
{
    static const struct {
        uint16_t offset, bytes;
    } left[] = {{0x0101, 1}, {0x0103, 1}, {0x0981, 1}, {0x0600, 64}, {0x0816, 1}, {0x081E, 1}};
    sim_config(2);
    cm1e_bus_t *bus = open_bus();
    for (uint32_t position = 1; position <= 2; position++)
        for (size_t i = 0; i < sizeof left / sizeof left[0]; i++)
            memset(register_memory_of(bus, position) + left[i].offset, 1, left[i].bytes);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (uint32_t position = 1; position <= 2; position++)
        for (size_t i = 0; i < sizeof left / sizeof left[0]; i++)
            for (uint16_t n = 0; n < left[i].bytes; n++)
                ck_assert_msg(register_memory_of(bus, position)[left[i].offset + n] == 0, "slave %u: register 0x%04X",
                              position, left[i].offset + n);
    cm1e_bus_close(bus);
}
END_TEST

/** What a register of one slave does not take is written as if nobody had answered. */
typedef struct refusal {
    uint16_t station, offset;
} refusal_t;

static cm1e_tap_verdict_t refuse_write(void *context, cm1e_tap_frame_t *frame)
{
    enum { FPWR = 5, FRAME_HEADER_BYTES = 16, DATAGRAM_BYTES = 12 };
    const refusal_t *refusal = context;
    size_t at = FRAME_HEADER_BYTES;
    for (bool more = frame->direction == CM1E_TAP_RECEIVED; more && at + DATAGRAM_BYTES <= frame->length;) {
        uint8_t *header = frame->bytes + at;
        const unsigned length = cm1e_get_u16(header + 6);
        if (header[0] == FPWR && cm1e_get_u16(header + 2) == refusal->station &&
            cm1e_get_u16(header + 4) == refusal->offset)
            cm1e_put_u16(header + 10 + (length & 0x7FF), 0);
        more = length & 0x8000;
        at += DATAGRAM_BYTES + (length & 0x7FF);
    }
    return CM1E_TAP_PASS;
}

/** A motor might go on for ever when frames stay away; another device may have none. */
START_TEST(a_motor_that_does_not_take_its_watchdog_is_named)
{
    static const uint16_t offsets[] = {0x0400, 0x0420};
    for (int n = 0; n < 2 * 4; n++) {
        char wanted[40];
        sim_config(3);
        config.sim_gaps = CM1E_SIM_IO_TERMINAL;
        config.axes[0].address = 1;
        config.axes[1].address = 3; /* a terminal between them */
        config.axes[2].address = 4;
        refusal_t refusal = {.offset = offsets[n % 2]};
        cm1e_bus_t *bus = open_bus();
        ck_assert(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK);
        refusal.station = bus->slaves[n / 2].facts.station;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_write, &refusal);
        ck_assert_int_eq(cm1e_bus_configure(bus, &diag), n / 2 == 1 ? CM1E_OK : CM1E_ERROR_BUS_WORKING_COUNTER);
        snprintf(wanted, sizeof wanted, "Slave %d (", n / 2 + 1);
        ck_assert_msg(n / 2 == 1 || (strstr(diag.text, wanted) && strstr(diag.text, "the time of its watchdog")), "%s",
                      diag.text);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** Of 100 Mbit/s Ethernet, and of the slaves on the way. */
START_TEST(time_on_the_wire_is_that_of_bytes_frames_and_slaves)
{
    for (uint32_t axes = 1; axes <= 60; axes += 59) {
        sim_config(axes);
        cm1e_bus_t *bus = start_bus();
        size_t bytes = 0;
        for (uint32_t position = 1; position <= axes; position++)
            bytes += cm1e_bus_slave(bus, position)->input_bytes + cm1e_bus_slave(bus, position)->output_bytes;
        const int64_t frames = axes == 1 ? 1 : 2;
        ck_assert_int_eq(cm1e_bus_wire_ns(bus), ((int64_t)bytes + frames * 52) * 80 + (int64_t)axes * 1200);
        cm1e_bus_close(bus);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_start");
    TCase *tests = tcase_create("start");
    tcase_add_loop_test(tests, scan_finds_every_slave_from_1_to_16, 1, 17);
    tcase_add_loop_test(tests, every_slave_is_seen_in_operational_at_once, 1, 9);
    tcase_add_test(tests, functions_without_a_bus_or_a_place_for_their_result_are_refused);
    tcase_add_test(tests, every_cycle_of_a_start_asks_for_a_state);
    tcase_add_loop_test(tests, a_start_sends_no_frame_twice_and_waits_for_none_in_vain, 1, 4);
    tcase_add_loop_test(tests, start_resolves_every_object_in_every_order_firmware_and_mapping, 0,
                        2 * FIRMWARES * MAPPINGS);
    tcase_add_loop_test(tests, large_bus_runs_in_several_frames, 0, 4);
    tcase_add_test(tests, the_longest_network_has_motors_at_its_end);
    tcase_add_test(tests, stop_brings_all_slaves_to_init_and_start_works_again);
    tcase_add_test(tests, stop_asks_for_init_when_no_slave_is_in_operational);
    tcase_add_test(tests, steps_out_of_order_are_refused);
    tcase_add_test(tests, cycle_time_must_suit_the_firmware);
    tcase_add_loop_test(tests, cycle_time_must_leave_the_frames_their_time, 0, 8);
    tcase_add_loop_test(tests, outputs_that_open_in_operational_only_are_no_obstacle, 0, 2);
    tcase_add_test(tests, no_slaves_is_an_error_that_names_the_interface);
    tcase_add_test(tests, io_module_between_the_axes_is_mapped_by_its_sii);
    tcase_add_loop_test(tests, scan_takes_no_notice_of_addresses_of_an_earlier_one, 0, 6);
    tcase_add_test(tests, a_scan_clears_what_another_master_left);
    tcase_add_test(tests, a_motor_that_does_not_take_its_watchdog_is_named);
    tcase_add_test(tests, time_on_the_wire_is_that_of_bytes_frames_and_slaves);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
