/* A slave that answers nonsense: registers that the bus reads have any values, from the start on or in operation. */
#include "bus/bus_internal.h"
#include "bus_support.h"
#include "cm1e/esc.h"
#include "cm1e/sdo_info.h"
#include "cm1e/topology.h"
#include "effort.h"
#include "nic/frame.h"

typedef struct range {
    const char *name;
    uint16_t first, end;
} range_t;

static const range_t ranges[] = {
    {"type, revision, build", 0x0000, 0x0004}, {"number of FMMUs", 0x0004, 0x0005},
    {"number of sync managers", 0x0005, 0x0006}, {"memory, ports", 0x0006, 0x0008}, {"features", 0x0008, 0x000A},
    {"station address", 0x0010, 0x0012}, {"alias", 0x0012, 0x0014}, {"DL status", 0x0110, 0x0112},
    {"AL status", 0x0130, 0x0132}, {"AL status code", 0x0134, 0x0136}, {"error counters", 0x0300, 0x0314},
    {"watchdog", 0x0400, 0x0444}, {"EEPROM control", 0x0500, 0x0504}, {"EEPROM address", 0x0504, 0x0508},
    {"EEPROM data", 0x0508, 0x0510}, {"sync manager status", 0x0805, 0x0806}, {"SM1 status", 0x080D, 0x080E},
    {"sync managers", 0x0800, 0x0820}, {"port times", 0x0900, 0x0910}, {"system time", 0x0910, 0x0918},
    {"delay", 0x0928, 0x092C}, {"difference", 0x092C, 0x0930}, {"DC", 0x0900, 0x09A0}, {"mailbox", 0x1000, 0x2000},
    {"all registers", 0x0000, 0x1000},
};
enum { RANGES = sizeof ranges / sizeof ranges[0], PATTERNS = 10, NETWORKS = 3 };
enum { LIAR = 2, START_MS = 20000, ASKED_FOR_MS = 6000, LIES_CYCLES = 1500, COMES_BACK_CYCLES = 16000 };

static struct {
    const range_t *range;
    int pattern;
    bool on;
    uint32_t random;
    uint16_t station;
} lie;

static uint8_t value(uint16_t address)
{
    static const uint8_t fixed[] = {0x00, 0xFF, 0x01, 0x80, 0x7F, 0x10, 0x55};
    if (lie.pattern < (int)sizeof fixed)
        return fixed[lie.pattern];
    if (lie.pattern == 7) /* what stays, but is nonsense */
        return (uint8_t)((address * 2654435761u) >> 13);
    lie.random = lie.random * 1103515245u + 12345u;
    return (uint8_t)(lie.random >> 16);
}

static cm1e_tap_verdict_t tell(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction == CM1E_TAP_SENT)
        return CM1E_TAP_PASS;
    datagram_t d = {.more = true};
    size_t at = FRAME_HEADER;
    while (lie.on && d.more && cm1e_frame_datagram(frame->bytes, frame->length, &at, &d)) {
        const uint8_t command = d.header[0];
        const uint16_t adp = cm1e_get_u16(d.header + 2), ado = cm1e_get_u16(d.header + 4);
        const bool mine = (command == COMMAND_FPRD && adp == lie.station) || (command == COMMAND_APRD && adp == LIAR) ||
                          command == COMMAND_BRD;
        const uint16_t length = cm1e_get_u16(d.header + 6) & 0x7FF;
        uint8_t *data = (uint8_t *)(uintptr_t)(d.header + 10);
        for (uint16_t i = 0; mine && i < length; i++)
            if (ado + i >= lie.range->first && ado + i < lie.range->end) {
                if (lie.pattern == 9 && (lie.random >> 20) % 4) {
                    lie.random = lie.random * 1103515245u + 12345u;
                    continue;
                }
                data[i] = value((uint16_t)(ado + i));
            }
    }
    return CM1E_TAP_PASS;
}

/** Three motors; the second one lies. With a clock, or optional. */
static void describe_network(int network)
{
    sim_config(3);
    cm1e_axis_config_t *liar = &config.axes[1];
    if (network == 1) {
        liar->firmware[0] = '\0';
        strcpy(liar->device, "cia402");
        liar->counts_per_revolution = 131072;
        liar->max_speed_rpm = 3000;
        liar->dc.sync0_us = 1000;
    } else if (network == 2) {
        liar->address_kind = CM1E_ADDRESS_ALIAS;
        liar->address = 77;
        liar->optional = true;
        liar->recover = CM1E_RECOVER_AUTO;
        config.axes[2].address = 2;
    }
}

static void recover_all(cm1e_bus_t *bus)
{
    for (uint16_t position = 1; position <= 3; position++)
        if (cm1e_bus_slave_watch(bus, position).al_state != CM1E_AL_OP)
            cm1e_bus_request_recovery(bus, position);
}

/** A slave that answers every question is not said to be silent, whatever it answers. */
static void expect_words(const char *text)
{
    ck_assert_str_ne(text, "");
    ck_assert_msg(!strstr(text, "stopped answering") && !strstr(text, "does not answer when") &&
                      !strstr(text, "heck its power"), "%s: %s", lie.range->name, text);
}

/** What is asked beside the cycle has an end, and words. */
static void ask_all(cm1e_bus_t *bus)
{
    static uint8_t image[65536];
    cm1e_slave_place_t places[3];
    cm1e_slave_port_t ports[CM1E_PORTS];
    cm1e_al_answer_t answer;
    uint16_t indexes[512];
    size_t size = sizeof image, count = 512;
    const int64_t before_ns = now_of(bus);
    ck_assert_int_eq(cm1e_bus_topology(bus, places, 3, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_read_ports(bus, LIAR, ports, &diag), CM1E_OK);
    if (cm1e_sii_read_device(bus, LIAR, image, &size, &diag) != CM1E_OK)
        expect_words(diag.text);
    if (cm1e_sdo_info_list(bus, LIAR, CM1E_OBJECTS_ALL, indexes, &count, &diag) != CM1E_OK)
        expect_words(diag.text);
    if (cm1e_esc_request_state(bus, LIAR, CM1E_AL_PRE_OP, 1000000000, &answer, &diag) != CM1E_OK)
        expect_words(diag.text);
    ck_assert_int_le(now_of(bus) - before_ns, ASKED_FOR_MS * INT64_C(1000000));
}

static cm1e_bus_t *open_liar(int row)
{
    lie.range = &ranges[row / PATTERNS % RANGES];
    lie.pattern = row % PATTERNS;
    lie.random = (uint32_t)row;
    lie.station = 0x1000 + LIAR;
    describe_network(row % NETWORKS);
    cm1e_bus_t *bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), tell, NULL);
    return bus;
}

/** The bus starts anyway, or is refused in time and in words; on honest answers it starts. */
START_TEST(nonsense_in_a_start_ends_it_in_words)
{
    cm1e_bus_t *bus = open_liar(_i);
    lie.on = true;
    const int64_t before_ns = now_of(bus);
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_int_le(now_of(bus) - before_ns, START_MS * INT64_C(1000000));
    if (error != CM1E_OK)
        expect_words(diag.text);
    lie.on = false;
    cm1e_bus_stop(bus);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

/** The others stay in Operational; a transfer ends; the slave comes back as soon as its answers are honest. */
START_TEST(nonsense_in_operation_concerns_its_slave_only)
{
    uint8_t data[4];
    cm1e_sdo_t sdo = {.position = LIAR, .index = 0x1018, .subindex = 2, .data = data, .size = sizeof data};
    cm1e_bus_t *bus = open_liar(_i);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    const uint16_t liar = cm1e_bus_axis_position(bus, 1);
    sdo.position = liar;
    lie.station = cm1e_bus_at(bus, liar)->facts.station;
    lie.on = true;
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    for (int n = 0; n < LIES_CYCLES; n++) {
        cycle(bus);
        recover_all(bus);
        for (uint16_t position = 1; position <= 3; position++) {
            const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, position);
            ck_assert_msg(position == liar || (!watch.lost && (watch.al_state == CM1E_AL_OP || !watch.al_state)),
                          "%s: slave %d", lie.range->name, position);
        }
    }
    ck_assert_int_ne(cm1e_sdo_state(&sdo), CM1E_SDO_BUSY);
    lie.on = false;
    int n = 0;
    for (; n < COMES_BACK_CYCLES && (n < 10 || cm1e_bus_slave_watch(bus, liar).al_state != CM1E_AL_OP); n++) {
        cycle(bus);
        recover_all(bus);
    }
    ck_assert_msg(n < COMES_BACK_CYCLES, "%s: it does not come back", lie.range->name);
    cm1e_bus_stop(bus);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    lie.on = true;
    ask_all(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** What is told of some of them. */
START_TEST(nonsense_is_told_as_what_it_is)
{
    static const struct {
        const char *range, *words;
        int pattern;
    } rows[] = {
        {"AL status", "gives no reason: its AL status code is 0", 1},
        {"station address", "answers, but not at the station address that it was given", 1},
        {"mailbox", "It answers, but not as CoE says", 6},
        {"SM1 status", "It answers, but its mailbox does not", 0},
        {"EEPROM control", "cannot be read", 0},
    };
    int range = 0;
    while (strcmp(ranges[range].name, rows[_i].range) != 0)
        range++;
    cm1e_bus_t *bus = open_liar(range * PATTERNS + rows[_i].pattern);
    describe_network(0);
    cm1e_bus_close(bus);
    bus = open_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), tell, NULL);
    lie.on = true;
    ck_assert_int_ne(cm1e_bus_start(bus, &diag), CM1E_OK);
    ck_assert_msg(strstr(diag.text, rows[_i].words) != NULL, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_nonsense");
    TCase *tests = tcase_create("nonsense");
    const int stride = sweep_stride(1, EFFORT_EVERYDAY);
    tcase_set_timeout(tests, 60);
    for (int row = sweep_first(0, stride); row < RANGES * PATTERNS * NETWORKS; row += stride) {
        tcase_add_loop_test(tests, nonsense_in_a_start_ends_it_in_words, row, row + 1);
        tcase_add_loop_test(tests, nonsense_in_operation_concerns_its_slave_only, row, row + 1);
    }
    tcase_add_loop_test(tests, nonsense_is_told_as_what_it_is, 0, 5);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
