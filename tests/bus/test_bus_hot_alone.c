/* Networks on which a single device answers, or whose first device is the optional one: the count of the devices is 1
 * then, like the working counter of any question to one slave. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

enum { ID = 7, SETTLE = 200, AWAY = 1500, COMES = 4000 };

static void make_optional(cm1e_axis_config_t *axis, uint16_t id)
{
    axis->address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    axis->address = id;
    axis->optional = true;
    axis->recover = CM1E_RECOVER_AUTO;
}

static uint16_t station_of(cm1e_bus_t *bus, uint32_t place)
{
    return cm1e_get_u16(cm1e_sim_segment_slave(segment_of(bus), place)->memory + ESC_STATION_ADDRESS);
}

/** Whether the slave takes part in the cycle again. */
static bool comes(cm1e_bus_t *bus, uint16_t position)
{
    for (int n = 0; n < COMES; n++) {
        const bool good = cycle(bus) == CM1E_OK;
        if (good && cm1e_bus_presence(bus, position) == CM1E_PRESENCE_THERE &&
            cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), position)) == CM1E_AL_OP)
            return true;
    }
    return false;
}

/** Cycles in which no frame need come back. */
static void silent_cycles(cm1e_bus_t *bus, int count)
{
    for (int n = 0; n < count; n++)
        cycle(bus);
}

/** A motor, and a tool behind it. */
START_TEST(a_motor_alone_keeps_its_address_while_the_tool_is_away)
{
    make_optional(&sim_config(2)->axes[1], ID);
    cm1e_bus_t *bus = start_bus();
    const uint16_t station = station_of(bus, 1);
    cycles(bus, SETTLE);
    cm1e_sim_segment_detach(segment_of(bus), 2, false);
    cycle(bus); /* the frame that is on its way when the plug is pulled */
    for (int n = 0; n < AWAY; n++) {
        ck_assert_int_eq(cycle(bus), CM1E_OK);
        ck_assert_uint_eq(station_of(bus, 1), station);
    }
    ck_assert_int_eq(cm1e_bus_presence(bus, 2), CM1E_PRESENCE_ABSENT);
    cm1e_sim_segment_attach(segment_of(bus), 2);
    ck_assert(comes(bus, 2));
    ck_assert_uint_eq(station_of(bus, 1), station);
    cm1e_bus_close(bus);
}
END_TEST

/** The tool is all that the network has. Without it no frame comes back. */
START_TEST(a_tool_alone_comes_back)
{
    make_optional(&sim_config(1)->axes[0], ID);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    for (int round = 0; round < 2; round++) {
        cm1e_sim_segment_detach(segment_of(bus), 1, false);
        silent_cycles(bus, AWAY);
        cm1e_sim_segment_attach(segment_of(bus), 1);
        ck_assert_msg(comes(bus, 1), "round %d", round);
    }
    for (int n = 0; n < SETTLE; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

/** Two tools: the first one leaves, and the cable leads to the second one. */
START_TEST(the_second_of_two_tools_goes_on_when_the_first_one_leaves)
{
    sim_config(2);
    make_optional(&config.axes[0], ID);
    make_optional(&config.axes[1], ID + 1);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    cm1e_sim_segment_detach(segment_of(bus), 1, false);
    cycle(bus);
    for (int n = 0; n < AWAY; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_presence(bus, 2), CM1E_PRESENCE_THERE);
    cm1e_sim_segment_attach(segment_of(bus), 1);
    ck_assert(comes(bus, 1));
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_hot_alone");
    TCase *tests = tcase_create("alone");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, a_motor_alone_keeps_its_address_while_the_tool_is_away);
    tcase_add_test(tests, a_tool_alone_comes_back);
    tcase_add_test(tests, the_second_of_two_tools_goes_on_when_the_first_one_leaves);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
