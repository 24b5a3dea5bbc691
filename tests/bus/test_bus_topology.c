/* How slaves are wired: lines, junctions, branches on each port, a port that loops back, and states that explain
 * nothing. The port states are planted in the registers of simulated slaves. */
#include "bus_support.h"
#include "cm1e/esc.h"
#include "cm1e/topology.h"
#include "core/bytes.h"
#include "sim/esc_chip.h"

enum { SLAVES = 8 };
static cm1e_slave_place_t places[SLAVES];

/** Plants the ports of each slave: "0 1 3" are open; a port with "!" has a link and is closed. One with "?" is not
 *  closed, and there is no communication. */
static cm1e_bus_t *wired(const char *const ports[], unsigned count)
{
    sim_config(count);
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (unsigned i = 0; i < count; i++) {
        uint16_t status = 0x5500;
        for (const char *c = ports[i]; *c; c++) {
            const unsigned port = (unsigned)(*c - '0');
            if (*c < '0' || *c > '3')
                continue;
            status |= (uint16_t)(1u << (4 + port));
            if (c[1] != '!')
                status &= (uint16_t) ~(1u << (8 + 2 * port));
            if (c[1] != '!' && c[1] != '?')
                status |= (uint16_t)(1u << (9 + 2 * port));
        }
        cm1e_put_u16(cm1e_sim_segment_slave(segment_of(bus), i + 1)->memory + ESC_DL_STATUS, status);
    }
    memset(places, 0xEE, sizeof places);
    ck_assert_msg(cm1e_bus_topology(bus, places, SLAVES, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static void expect_place(unsigned position, unsigned parent, unsigned parent_port)
{
    const cm1e_slave_place_t *place = &places[position - 1];
    ck_assert(place->known);
    ck_assert_msg(place->parent == parent && place->parent_port == parent_port, "slave %u is at port %u of slave %u",
                  position, place->parent_port, place->parent);
    if (parent)
        ck_assert_uint_eq(places[parent - 1].next[parent_port], position);
}

static void expect_cable(unsigned position, int port, const char *expected)
{
    char text[96];
    cm1e_cable_text(&places[position - 1], (uint16_t)position, port, text, sizeof text);
    ck_assert_str_eq(text, expected);
}

START_TEST(a_line)
{
    cm1e_bus_t *bus = wired((const char *const[]){"0 1", "0 1", "0"}, 3);
    for (unsigned position = 1; position <= 3; position++)
        expect_place(position, position - 1, position > 1);
    expect_cable(1, 0, "between this computer and slave 1 (port 0, IN)");
    expect_cable(2, 0, "between slave 1 (port 1, OUT) and slave 2 (port 0, IN)");
    expect_cable(2, 1, "between slave 2 (port 1, OUT) and slave 3 (port 0, IN)");
    expect_cable(3, 1, "at port 1 (OUT) of slave 3, where no slave is");
    cm1e_bus_close(bus);
}
END_TEST

/** A frame leaves a junction by port 3, then 1, then 2, and goes to the end of each branch before. */
START_TEST(a_junction_with_branches)
{
    cm1e_bus_t *bus = wired((const char *const[]){"0 1 2 3", "0 1", "0", "0 1", "0", "0 1 3", "0", "0"}, 8);
    expect_place(1, 0, 0);
    expect_place(2, 1, 3);
    expect_place(3, 2, 1);
    expect_place(4, 1, 1);
    expect_place(5, 4, 1);
    expect_place(6, 1, 2);
    expect_place(7, 6, 3);
    expect_place(8, 6, 1);
    expect_cable(6, 0, "between slave 1 (port 2) and slave 6 (port 0, IN)");
    cm1e_bus_close(bus);
}
END_TEST

/** The last slave of a ring has an open port without a slave; a port with a link that is closed has none either. */
START_TEST(open_ends_and_loops)
{
    cm1e_bus_t *bus = wired((const char *const[]){"0 1", "0 1 3!", "0 1"}, 3);
    expect_place(2, 1, 1);
    expect_place(3, 2, 1);
    ck_assert(places[1].link[3] && !places[1].open[3] && places[1].next[3] == 0);
    ck_assert(places[2].open[1] && places[2].next[1] == 0);
    cm1e_bus_close(bus);
    bus = wired((const char *const[]){"0 1 2?", "0"}, 2);
    expect_place(2, 1, 1);
    ck_assert(places[0].link[2] && !places[0].open[2]);
    cm1e_bus_close(bus);
}
END_TEST

/** A slave in front of which no port is open cannot be where it is. */
START_TEST(states_that_explain_nothing)
{
    cm1e_bus_t *bus = wired((const char *const[]){"0", "0 1", ""}, 3);
    ck_assert(places[0].known && !places[1].known);
    ck_assert(places[2].known && places[2].parent == 2);
    expect_cable(2, 0, "at port 0 (IN) of slave 2");
    ck_assert_int_eq(cm1e_bus_topology(NULL, places, SLAVES, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_bus_close(bus);
}
END_TEST

/** A slave that is wired the other way round is entered by another port. */
START_TEST(a_slave_that_is_entered_by_its_second_port)
{
    cm1e_bus_t *bus = wired((const char *const[]){"0 1", "1 2", "0 1"}, 3);
    expect_place(2, 1, 1);
    expect_place(3, 2, 2);
    ck_assert_uint_eq(places[1].entry_port, 1);
    ck_assert_uint_eq(places[0].next_port[1], 1);
    ck_assert_uint_eq(places[1].next_port[2], 0);
    expect_cable(1, 1, "between slave 1 (port 1, OUT) and slave 2 (port 1, OUT)");
    expect_cable(2, 1, "between slave 1 (port 1, OUT) and slave 2 (port 1, OUT)");
    expect_cable(2, 2, "between slave 2 (port 2) and slave 3 (port 0, IN)");
    expect_cable(3, 0, "between slave 2 (port 2) and slave 3 (port 0, IN)");
    expect_cable(2, -1, "at port -1 of slave 2");
    expect_cable(2, 4, "at port 4 of slave 2");
    expect_cable(2, 3, "at port 3 of slave 2, where no slave is");
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(places_are_read_of_a_scanned_bus_only_and_as_far_as_there_is_room)
{
    cm1e_bus_t *bus = wired((const char *const[]){"0 1", "0 1", "0"}, 3);
    const cm1e_slave_place_t untouched = places[3];
    memset(places, 0xEE, sizeof places);
    ck_assert_int_eq(cm1e_bus_topology(bus, places, 2, &diag), CM1E_OK);
    ck_assert(places[1].known);
    ck_assert_mem_eq(&places[2], &untouched, sizeof untouched);
    simulate(bus, "unplug 3");
    ck_assert_int_eq(cm1e_bus_topology(bus, places, SLAVES, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_str_eq(diag.text, "Slave 3 does not answer when its ports are read.");
    ck_assert_uint_eq(diag.foreign_code, 0);
    cm1e_bus_close(bus);
    bus = open_bus();
    ck_assert_int_eq(cm1e_bus_topology(bus, places, SLAVES, &diag), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_topology(bus, places, SLAVES, &diag), CM1E_OK);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_bus_topology(bus, places, SLAVES, &diag), CM1E_ERROR_STATE);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("topology");
    TCase *tests = tcase_create("topology");
    tcase_add_test(tests, a_line);
    tcase_add_test(tests, a_junction_with_branches);
    tcase_add_test(tests, open_ends_and_loops);
    tcase_add_test(tests, states_that_explain_nothing);
    tcase_add_test(tests, a_slave_that_is_entered_by_its_second_port);
    tcase_add_test(tests, places_are_read_of_a_scanned_bus_only_and_as_far_as_there_is_room);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
