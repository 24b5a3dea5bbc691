/* Who took part in a cycle with a wrong working counter: of every set of slaves whose inputs came back as they were sent, and
 * for every working counter, the inputs of the others count exactly if something can have happened that explains both. And an
 * optional slave that leaves in the cycle in which the few inputs of another one are like their marker. */
#include "bus/bus_internal.h" /* first, as bus_support.h has a global `diag` */

#include "bus_support.h"

enum { LRW = 12, HEADER = 26 /**< Ethernet 14, EtherCAT 2, datagram 10 */, MOTOR = 2, SLAVES = 6, COUNTER = 13 };

enum { CHANGE = 3 }; /**< of two bits: what no marker is */

/** What the tap does to the process data of one cycle. The few inputs of slaves that are not silent change. */
typedef struct disguise {
    cm1e_bus_t *bus;
    unsigned silent; /**< bit n: the inputs of slave n come back as they were sent */
    int counter;     /**< the working counter; -1: as it is */
    bool on;
    uint8_t sent[1500];
} disguise_t;

static cm1e_tap_verdict_t act(void *context, cm1e_tap_frame_t *frame)
{
    disguise_t *disguise = context;
    if (frame->length <= HEADER || frame->bytes[16] != LRW)
        return CM1E_TAP_PASS;
    if (frame->direction == CM1E_TAP_SENT) {
        memcpy(disguise->sent, frame->bytes, frame->length);
        return CM1E_TAP_PASS;
    }
    for (unsigned n = 1; n <= cm1e_bus_slave_count(disguise->bus) && disguise->on; n++) {
        const cm1e_slave_placement_t *place = &disguise->bus->slaves[n - 1].placement;
        uint8_t *inputs = frame->bytes + HEADER + place->wire_input;
        if (disguise->silent >> n & 1)
            memcpy(inputs, disguise->sent + HEADER + place->wire_input, place->input_bytes);
        else if (place->input_bytes == 1)
            *inputs ^= CHANGE;
    }
    if (disguise->on && disguise->counter >= 0)
        cm1e_put_u16(frame->bytes + HEADER + (cm1e_get_u16(frame->bytes + 22) & 0x7FF), (uint16_t)disguise->counter);
    disguise->on = false;
    return CM1E_TAP_PASS;
}

static cm1e_slave_config_t *add_digital(const char *name, uint16_t address, uint8_t inputs, uint8_t outputs)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, name);
    slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = inputs, .outputs = outputs};
    slave->address = address;
    return slave;
}

/** The kinds of slaves that the working counter tells apart. */
static const struct {
    uint8_t inputs, outputs;
} digital[SLAVES + 1] = {[1] = {2, 0}, [3] = {4, 4}, [4] = {0, 4}, [5] = {2, 0}, [6] = {4, 4}};

/** Whether the slaves from `n` on can have made so much missing in the working counter. */
static bool can_be(unsigned silent, int missing, unsigned n)
{
    if (n > SLAVES)
        return missing == 0;
    const bool motor = n == MOTOR, gives = motor || digital[n].inputs, takes = motor || digital[n].outputs;
    const int all = gives + 2 * takes;
    if (silent >> n & 1 && (motor || can_be(silent, missing - all, n + 1)))
        return can_be(silent, missing - all, n + 1); /* it took no part */
    return can_be(silent, missing, n + 1) || (takes && can_be(silent, missing - 2, n + 1));
}

START_TEST(the_inputs_of_the_others_count_if_something_explains_the_cycle)
{
    static disguise_t disguise;
    unsigned fresh = 0, stale = 0;
    sim_config(1);
    config.axes[0].address = MOTOR;
    for (unsigned n = 1; n <= SLAVES; n++)
        if (n != MOTOR) {
            char name[16];
            snprintf(name, sizeof name, "terminal %u", n);
            add_digital(name, (uint16_t)n, digital[n].inputs, digital[n].outputs);
        }
    cm1e_bus_t *bus = start_bus();
    disguise = (disguise_t){.bus = bus};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), act, &disguise);
    cycles(bus, 10);
    ck_assert_int_eq(bus->expected_working_counter, COUNTER);
    for (unsigned set = 0; set < 1u << (SLAVES + 1); set += 2) {
        if (set >> 4 & 1)
            continue; /* it has no inputs */
        for (int counter = 0; counter <= COUNTER + 2; counter++) {
            if (counter == COUNTER)
                continue;
            const bool wanted = can_be(set, COUNTER - counter, 1);
            disguise.silent = set;
            disguise.counter = counter;
            disguise.on = true;
            ck_assert_int_eq(cycle(bus), CM1E_ERROR_BUS_WORKING_COUNTER);
            for (uint16_t n = 1; n <= SLAVES; n++) {
                const bool its = wanted && !(set >> n & 1);
                const cm1e_slave_placement_t *place = &bus->slaves[n - 1].placement;
                ck_assert_msg(cm1e_bus_slave_watch(bus, n).fresh == its, "silent 0x%02X, working counter %d, slave %u", set,
                              counter, n);
                ck_assert(place->input_bytes != 1 || bus->inputs[place->input_offset] == (its ? CHANGE : 0));
            }
            fresh += wanted;
            stale += !wanted;
            ck_assert_int_eq(cycle(bus), CM1E_OK);
        }
    }
    ck_assert(fresh > 50 && stale > 50);
    cm1e_bus_close(bus);
}
END_TEST

/** Two switches and a motor that are always there, and an optional lamp. It has left if it is silent and if as much is missing
 *  as all count that are silent. */
START_TEST(an_optional_slave_has_left_if_enough_is_missing_for_all_that_are_silent)
{
    static disguise_t disguise;
    enum { LAMP = 3, ALL = 7 };
    static const int shares[] = {[1] = 1, [MOTOR] = 3, [LAMP] = 3};
    unsigned left = 0;
    sim_config(1);
    config.axes[0].address = MOTOR;
    add_digital("switches", 1, 2, 0);
    cm1e_slave_config_t *lamp = add_digital("lamp", 4711, 4, 4);
    lamp->address_kind = CM1E_ADDRESS_ALIAS;
    lamp->vendor = 0x000004D8;
    lamp->product = 0x00001235;
    lamp->optional = true;
    cm1e_bus_t *bus = start_bus();
    disguise = (disguise_t){.bus = bus};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), act, &disguise);
    cycles(bus, 50);
    for (unsigned set = 0; set < 16; set += 2) {
        for (int counter = 0; counter <= ALL + 2; counter++) {
            int share = 0;
            for (unsigned n = 1; n <= LAMP; n++)
                share += set >> n & 1 ? shares[n] : 0;
            const bool leaves = set >> LAMP & 1 && share <= ALL - counter;
            ck_assert_uint_eq(cm1e_bus_slave_count(bus), LAMP);
            ck_assert(bus->slaves[LAMP - 1].hot.counted);
            disguise.silent = set;
            disguise.counter = counter;
            disguise.on = true;
            const cm1e_error_t error = cycle(bus);
            ck_assert_msg(bus->slaves[LAMP - 1].hot.counted == !leaves, "silent 0x%02X, working counter %d", set, counter);
            ck_assert(error == CM1E_ERROR_BUS_WORKING_COUNTER || !(set >> MOTOR & 1));
            ck_assert(error == CM1E_OK || !(leaves && set == 1u << LAMP && counter == ALL - shares[LAMP]));
            left += leaves;
            cycles(bus, 2);
        }
    }
    ck_assert_uint_gt(left, 10);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("silence");
    TCase *tests = tcase_create("silence");
    tcase_add_test(tests, the_inputs_of_the_others_count_if_something_explains_the_cycle);
    tcase_add_test(tests, an_optional_slave_has_left_if_enough_is_missing_for_all_that_are_silent);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
