/** Propagation delays of distributed clocks: lines, branches and slaves without a clock, whose cables are known. */
#include <string.h>

#include "bus/dc_delay.h"
#include "unity.h"

enum { MAX = 16, THROUGH = 300 }; /* ns that a frame takes in a slave */

/* A tree: each slave hangs at a port of an earlier one, by a cable. */
typedef struct place {
    int parent;
    unsigned port;
    uint32_t cable_ns;
    bool no_clock;
} place_t;

static cm1e_dc_node_t nodes[MAX];
static uint32_t arrivals[MAX], count;
static const place_t *places;

void setUp(void) { memset(nodes, 0, sizeof nodes); }
void tearDown(void) {}

static int child_at(int slave, unsigned port)
{
    for (uint32_t i = 0; i < count; i++)
        if (places[i].parent == slave && places[i].port == port)
            return (int)i;
    return -1;
}

/* The frame enters a slave and comes back out of its port 0; every clock has a beginning of its own. */
static uint32_t pass(int slave, uint32_t now)
{
    static const unsigned order[] = {3, 1, 2};
    const uint32_t begin = (uint32_t)slave * 0x37654321u;
    cm1e_dc_node_t *node = &nodes[slave];
    arrivals[slave] = now;
    node->has_clock = !places[slave].no_clock;
    node->open_ports = 1;
    node->times[0] = now + begin;
    now += THROUGH / 2;
    for (int i = 0; i < 3; i++) {
        const int child = child_at(slave, order[i]);
        if (child < 0)
            continue;
        node->open_ports |= (uint8_t)(1u << order[i]);
        now = pass(child, now + THROUGH / 2 + places[child].cable_ns) + places[child].cable_ns + THROUGH / 2;
        node->times[order[i]] = now + begin;
    }
    return now + THROUGH / 2;
}

static void check(const place_t *tree, uint32_t slaves, uint32_t tolerance)
{
    places = tree;
    count = slaves;
    pass(0, 5000);
    cm1e_dc_delays(nodes, count);
    uint32_t first = 0;
    while (!nodes[first].has_clock)
        first++;
    for (uint32_t i = 0; i < count; i++)
        if (nodes[i].has_clock)
            TEST_ASSERT_UINT32_WITHIN(tolerance, arrivals[i] - arrivals[first], nodes[i].delay_ns);
        else
            TEST_ASSERT_EQUAL_UINT32(0, nodes[i].delay_ns);
}

static void test_line_with_cables_of_different_length(void)
{
    static const place_t line[] = {{-1, 0, 0, 0}, {0, 1, 10, 0}, {1, 1, 500, 0}, {2, 1, 35, 0}, {3, 1, 120, 0}};
    for (uint32_t slaves = 1; slaves <= 5; slaves++) {
        memset(nodes, 0, sizeof nodes);
        check(line, slaves, THROUGH);
    }
}

static void test_branches_are_visited_in_the_order_of_the_ports(void)
{
    /* A junction with three branches, the second of them with a branch of its own. */
    static const place_t tree[] = {{-1, 0, 0, 0}, {0, 1, 40, 0}, {1, 3, 200, 0}, {2, 1, 60, 0}, {1, 1, 15, 0},
                                   {4, 3, 90, 0}, {4, 1, 20, 0}, {1, 2, 300, 0}};
    check(tree, 8, THROUGH);
}

static void test_slaves_without_a_clock_are_a_part_of_the_cable(void)
{
    static const place_t line[] = {{-1, 0, 0, 1}, {0, 1, 50, 0}, {1, 1, 70, 1}, {2, 1, 30, 1}, {3, 1, 20, 0}};
    check(line, 5, 2 * THROUGH);
}

static void test_times_that_wrap_around_make_no_difference(void)
{
    static const place_t line[] = {{-1, 0, 0, 0}, {0, 1, 100, 0}};
    places = line;
    count = 2;
    pass(0, 0xFFFFFF00u);
    cm1e_dc_delays(nodes, 2);
    TEST_ASSERT_UINT32_WITHIN(THROUGH, arrivals[1] - arrivals[0], nodes[1].delay_ns);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_line_with_cables_of_different_length);
    RUN_TEST(test_branches_are_visited_in_the_order_of_the_ports);
    RUN_TEST(test_slaves_without_a_clock_are_a_part_of_the_cable);
    RUN_TEST(test_times_that_wrap_around_make_no_difference);
    return UNITY_END();
}
