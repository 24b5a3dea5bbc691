/**
 * What other threads may not do while a scheduler runs the bus: send frames of their own beside the cycle, stop the bus or
 * free it. It is refused in words, no frame is lost, and the motor stops with its ramp.
 */
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "cm1e/sdo_info.h"
#include "cm1e/sim.h"
#include "machine.h"

enum { POSITION = 1 };

static machine_t machine;
static cm1e_diag_t diag;
static MC_Power_t power;
static MC_MoveVelocity_t turn;
static atomic_bool turns;

static void program(void *context)
{
    (void)context;
    power.Axis = turn.Axis = &machine.axis[0];
    power.Enable = power.EnablePositive = power.EnableNegative = TRUE;
    MC_Power(&power);
    turn.Execute = power.Status;
    turn.Velocity = 10;
    MC_MoveVelocity(&turn);
    turns = turn.InVelocity;
}

static void *run(void *result)
{
    *(cm1e_error_t *)result = cm1e_scheduler_run(machine.scheduler, 0, &diag);
    return NULL;
}

static pthread_t runner;
static cm1e_error_t ran;

static void begin(void)
{
    machine = (machine_t){.axis_count = 1, .real_time = true};
    memset(&power, 0, sizeof power);
    memset(&turn, 0, sizeof turn);
    turns = false;
    machine_open(&machine);
    machine_add(&machine, "program", 0, 0, program, NULL);
    ck_assert_int_eq(pthread_create(&runner, NULL, run, &ran), 0);
    while (!turns)
        cm1e_clock_sleep_until(cm1e_clock_monotonic(), cm1e_clock_now(cm1e_clock_monotonic()) + MS_IN_NS);
}

static void end(cm1e_error_t wanted)
{
    cm1e_scheduler_statistics_t statistics;
    pthread_join(runner, NULL);
    ck_assert_msg(ran == wanted, "%s", diag.text);
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    ck_assert_uint_eq(statistics.bus.lost_frames + statistics.bus.working_counter_errors, 0);
}

START_TEST(test_what_sends_frames_of_its_own_is_refused)
{
    uint8_t data[4];
    size_t size = sizeof data, count = 10;
    uint16_t indexes[10];
    cm1e_object_info_t object;
    cm1e_entry_info_t entry;
    cm1e_slave_port_t ports[CM1E_PORTS];
    cm1e_diag_t why;
    begin();
    for (int n = 0; n < 50; n++) {
        ck_assert_int_eq(cm1e_sdo_read(machine.bus, POSITION, 0x1018, 1, data, &size, &why), CM1E_ERROR_STATE);
        ck_assert_ptr_nonnull(strstr(why.text, "cm1e_sdo_submit()"));
        ck_assert_int_eq(cm1e_sdo_write(machine.bus, POSITION, 0x6081, 0, data, 4, &why), CM1E_ERROR_STATE);
        ck_assert_int_eq(cm1e_bus_read_ports(machine.bus, POSITION, ports, &why), CM1E_ERROR_STATE);
        ck_assert_ptr_nonnull(strstr(why.text, "cm1e_bus_port_faults()"));
        ck_assert_int_eq(cm1e_sdo_info_list(machine.bus, POSITION, CM1E_OBJECTS_ALL, indexes, &count, &why),
                         CM1E_ERROR_STATE);
        ck_assert_int_eq(cm1e_sdo_info_object(machine.bus, POSITION, 0x6041, &object, &why), CM1E_ERROR_STATE);
        ck_assert_int_eq(cm1e_sdo_info_entry(machine.bus, POSITION, 0x6041, 0, &entry, &why), CM1E_ERROR_STATE);
    }
    ck_assert(power.Status && !power.Error);
    cm1e_scheduler_stop(machine.scheduler);
    end(CM1E_OK);
    machine_close(&machine);
}
END_TEST

/** Stops the bus (0) or closes it (1) while the motor turns. */
START_TEST(test_what_ends_the_bus_is_refused_and_the_run_ends_in_order)
{
    begin();
    if (_i == 0)
        cm1e_bus_stop(machine.bus);
    else
        ck_assert_int_eq(cm1e_bus_close(machine.bus), CM1E_ERROR_STATE);
    end(CM1E_ERROR_STATE);
    ck_assert_msg(strstr(diag.text, _i ? "cm1e_bus_close()" : "cm1e_bus_stop()") == diag.text, "%s", diag.text);
    cm1e_axis_info_t info; /* a bus that was stopped under it would have put it into ErrorStop */
    ck_assert_int_eq(cm1e_axis_read(machine.axis[0], &info), CM1E_OK);
    ck_assert_int_eq(info.state, CM1E_AXIS_DISABLED);
    ck_assert_int_eq(info.error, CM1E_OK);
    cm1e_scheduler_destroy(machine.scheduler);
    ck_assert_int_eq(cm1e_bus_close(machine.bus), CM1E_OK);
}
END_TEST

int main(void)
{
    TCase *all = tcase_create("other threads");
    tcase_set_timeout(all, 30);
    tcase_add_test(all, test_what_sends_frames_of_its_own_is_refused);
    tcase_add_loop_test(all, test_what_ends_the_bus_is_refused_and_the_run_ends_in_order, 0, 2);
    Suite *suite = suite_create("other threads while a scheduler runs");
    suite_add_tcase(suite, all);
    SRunner *runner_of_all = srunner_create(suite);
    srunner_run_all(runner_of_all, CK_ENV);
    const int failed = srunner_ntests_failed(runner_of_all);
    srunner_free(runner_of_all);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
