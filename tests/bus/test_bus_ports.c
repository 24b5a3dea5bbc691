/* The counters of the ports of every slave: each register ends in its own field of its own port. */
#include "bus/port_watch.h"
#include "bus_support.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

enum { SLAVES = 3 };

static uint8_t *registers_of(cm1e_bus_t *bus, uint32_t position)
{
    return cm1e_sim_segment_slave(segment_of(bus), position)->memory;
}

START_TEST(every_counter_of_every_port_is_found)
{
    cm1e_bus_t *bus = open_scanned_bus(SLAVES);
    cm1e_slave_port_t ports[CM1E_PORTS];
    for (uint16_t position = 1; position <= SLAVES; position++) {
        uint8_t *registers = registers_of(bus, position);
        for (int i = 0; i < 12; i++)
            registers[ESC_RX_ERRORS + i] = (uint8_t)(10 * position + i);
        for (int i = 0; i < 4; i++)
            registers[ESC_LOST_LINKS + i] = (uint8_t)(200 + 10 * position + i);
    }
    for (uint16_t position = 1; position <= SLAVES; position++) {
        ck_assert_msg(cm1e_bus_read_ports(bus, position, ports, &diag) == CM1E_OK, "%s", diag.text);
        for (int port = 0; port < CM1E_PORTS; port++) {
            ck_assert_uint_eq(ports[port].invalid_frames, 10 * position + 2 * port);
            ck_assert_uint_eq(ports[port].receive_errors, 10 * position + 2 * port + 1);
            ck_assert_uint_eq(ports[port].forwarded_errors, 10 * position + 8 + port);
            ck_assert_uint_eq(ports[port].lost_links, 200 + 10 * position + port);
        }
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(links_are_those_of_a_line)
{
    cm1e_bus_t *bus = open_scanned_bus(SLAVES);
    for (uint16_t position = 1; position <= SLAVES; position++) {
        cm1e_slave_port_t ports[CM1E_PORTS];
        ck_assert_int_eq(cm1e_bus_read_ports(bus, position, ports, &diag), CM1E_OK);
        ck_assert(ports[0].link);
        ck_assert_int_eq(ports[1].link, position < SLAVES);
        ck_assert(!ports[2].link && !ports[3].link);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Counters that grow while the cycle runs are found, each in its own port; what was counted before is not told. */
START_TEST(the_cycle_reads_the_counters_in_turn)
{
    sim_config(SLAVES);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 200);
    for (uint32_t position = 1; position <= SLAVES; position++)
        ck_assert_uint_eq(cm1e_bus_port_fault(bus, position, 0, FAULT_LOST_LINKS), 0);
    for (uint32_t position = 1; position <= SLAVES; position++) {
        uint8_t *registers = registers_of(bus, position);
        for (int i = 0; i < 12; i++)
            registers[ESC_RX_ERRORS + i] = (uint8_t)(registers[ESC_RX_ERRORS + i] + 10 * position + i);
        for (int i = 0; i < 4; i++)
            registers[ESC_LOST_LINKS + i] = (uint8_t)(registers[ESC_LOST_LINKS + i] + 100 + i);
    }
    cycles(bus, 20 * SLAVES + 40);
    for (uint16_t position = 1; position <= SLAVES; position++)
        for (int port = 0; port < CM1E_PORTS; port++) {
            const cm1e_port_faults_t faults = cm1e_bus_port_faults(bus, position, port);
            ck_assert_uint_eq(faults.invalid_frames, 10u * position + 2u * (unsigned)port);
            ck_assert_uint_eq(faults.receive_errors, 10u * position + 2u * (unsigned)port + 1u);
            ck_assert_uint_eq(faults.forwarded_errors, 10u * position + 8u + (unsigned)port);
            ck_assert_uint_eq(faults.lost_links, 100u + (unsigned)port);
        }
    ck_assert_uint_eq(cm1e_bus_port_faults(bus, SLAVES + 1, 0).lost_links, 0);
    ck_assert_uint_eq(cm1e_bus_port_faults(bus, 1, -1).lost_links, 0);
    /* A slave that was switched off counts from 0 again: nothing is counted twice. */
    memset(registers_of(bus, 2) + ESC_RX_ERRORS, 0, 20);
    cycles(bus, 20 * SLAVES + 40);
    ck_assert_uint_eq(cm1e_bus_port_faults(bus, 2, 0).invalid_frames, 20);
    simulate(bus, "damage 2 3");
    for (int i = 0; i < 10; i++)
        cycle(bus);
    cycles(bus, 20 * SLAVES + 40);
    ck_assert_uint_eq(cm1e_bus_port_faults(bus, 2, 0).invalid_frames, 23);
    ck_assert_uint_eq(cm1e_bus_port_faults(bus, 3, 0).forwarded_errors, 41);
    ck_assert_uint_eq(cm1e_bus_port_faults(bus, 1, 0).forwarded_errors, 18);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(slaves_that_are_none_or_silent_are_errors_in_words)
{
    cm1e_bus_t *bus = open_scanned_bus(SLAVES);
    cm1e_slave_port_t ports[CM1E_PORTS];
    ck_assert_int_eq(cm1e_bus_read_ports(bus, 0, ports, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_bus_read_ports(bus, SLAVES + 1, ports, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(diag.text, "no slave 4"));
    cm1e_sim_slave_reset(cm1e_sim_segment_slave(segment_of(bus), 2), INT64_MAX);
    ck_assert_int_eq(cm1e_bus_read_ports(bus, 2, ports, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_ptr_nonnull(strstr(diag.text, "Slave 2 does not answer"));
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_ports");
    TCase *tests = tcase_create("ports");
    tcase_add_test(tests, every_counter_of_every_port_is_found);
    tcase_add_test(tests, links_are_those_of_a_line);
    tcase_add_test(tests, the_cycle_reads_the_counters_in_turn);
    tcase_add_test(tests, slaves_that_are_none_or_silent_are_errors_in_words);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
