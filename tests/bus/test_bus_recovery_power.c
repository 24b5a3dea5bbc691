/* A slave that loses its power while it is brought back: at every moment of its recovery. */
#include "bus/bus_internal.h"
#include "bus_support.h"

/** Cycles; its controller is asked every other cycle at the latest, and ten questions in a row decide. */
enum { NOTICED_WITHIN = 40, RECOVERY_CYCLES = 180 };

/** A slave that loses its power in a recovery is not waited for, also where the next thing that it is sent is a request
 *  of a transfer, which a full mailbox does not take either. */
START_TEST(power_lost_at_any_moment_of_a_recovery_ends_it_at_once)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    const cm1e_recovery_t *recovery = &cm1e_bus_at(bus, 2)->recovery;
    simulate(bus, "power-cycle 2 10");
    for (int n = 0; n < 400 && recovery->step <= RECOVERY_LOOK; n++) {
        cycle(bus);
        cm1e_bus_request_recovery(bus, 2);
    }
    ck_assert_int_gt(recovery->step, RECOVERY_LOOK);
    for (int n = 0; n < _i; n++)
        cycle(bus);
    const uint32_t attempts = recovery->attempts;
    simulate(bus, "power-cycle 2 5000");
    for (int n = 0; recovery->step > RECOVERY_LOOK && recovery->attempts == attempts; n++) {
        ck_assert_msg(n < NOTICED_WITHIN, "step %d goes on without power", (int)recovery->step);
        cycle(bus);
    }
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_recovery_power");
    TCase *tests = tcase_create("recovery_power");
    tcase_add_loop_test(tests, power_lost_at_any_moment_of_a_recovery_ends_it_at_once, 0, RECOVERY_CYCLES);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
