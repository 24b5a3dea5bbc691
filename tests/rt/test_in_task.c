/**
 * What waits, and what frees what the cycle works with, is refused in a task: with an error in words, and the axis that
 * moves meanwhile does not notice.
 */
#include <math.h>
#include <stdlib.h>

#include "bus/firmware_update.h"
#include "cm1e/bridge.h"
#include "cm1e/cml.h"
#include "cm1e/esc.h"
#include "cm1e/foe.h"
#include "cm1e/plot.h"
#include "cm1e/sdo_info.h"
#include "cm1e/sii.h"
#include "cm1e/trace.h"
#include "machine.h"

#define MS INT64_C(1000000)

static machine_t machine;
static MC_Power_t power;
static MC_MoveVelocity_t turn;
static LREAL fastest_change, before; /* of the set velocity, in a cycle */
static cm1e_diag_t diag;

static void turn_and_watch(void)
{
    cm1e_axis_info_t info;
    power.Enable = TRUE;
    MC_Power(&power);
    turn.Execute = power.Status;
    MC_MoveVelocity(&turn);
    cm1e_axis_read(machine.axis[0], &info);
    fastest_change = fmax(fastest_change, fabs(info.set_velocity - before));
    before = info.set_velocity;
}

static void open_machine(cm1e_program_t program, void *context)
{
    machine = (machine_t){.axis_count = 2, .config = {.trace_capacity = 1000}};
    machine_open(&machine);
    power = (MC_Power_t){.Axis = &machine.axis[0], .EnablePositive = TRUE, .EnableNegative = TRUE};
    turn = (MC_MoveVelocity_t){.Axis = &machine.axis[0], .Velocity = 5, .Acceleration = 100, .Deceleration = 100};
    fastest_change = before = 0;
    diag = (cm1e_diag_t){0};
    machine_add(&machine, "", 0, 0, program, context);
}

/* ---- with an error of its own ------------------------------------------------------------------------------------ */

static uint8_t bytes[4096];
static size_t size;

static cm1e_error_t call_open(cm1e_bus_t *bus)
{
    cm1e_bus_t *other = NULL;
    (void)bus;
    return cm1e_bus_open(&other, cm1e_bus_configuration(machine.bus), &diag);
}
static cm1e_error_t call_scan(cm1e_bus_t *bus) { return cm1e_bus_scan(bus, &diag); }
static cm1e_error_t call_identify(cm1e_bus_t *bus) { return cm1e_bus_identify(bus, &diag); }
static cm1e_error_t call_configure(cm1e_bus_t *bus) { return cm1e_bus_configure(bus, &diag); }
static cm1e_error_t call_operate(cm1e_bus_t *bus) { return cm1e_bus_operate(bus, &diag); }
static cm1e_error_t call_start(cm1e_bus_t *bus) { return cm1e_bus_start(bus, &diag); }
static cm1e_error_t call_read(cm1e_bus_t *bus) { return cm1e_sdo_read(bus, 1, 0x6081, 0, bytes, &size, &diag); }
static cm1e_error_t call_write(cm1e_bus_t *bus) { return cm1e_sdo_write(bus, 1, 0x6081, 0, bytes, 4, &diag); }
static cm1e_error_t call_list(cm1e_bus_t *bus)
{
    static uint16_t indexes[256];
    size_t count = 256;
    return cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag);
}
static cm1e_error_t call_object(cm1e_bus_t *bus)
{
    cm1e_object_info_t info;
    return cm1e_sdo_info_object(bus, 1, 0x6081, &info, &diag);
}
static cm1e_error_t call_entry(cm1e_bus_t *bus)
{
    cm1e_entry_info_t info;
    return cm1e_sdo_info_entry(bus, 1, 0x6081, 0, &info, &diag);
}
static cm1e_error_t call_bridge(cm1e_bus_t *bus)
{
    static cm1e_bridge_info_t info;
    return cm1e_bridge_read(bus, 1, &info, &diag);
}
static cm1e_error_t call_sii_read(cm1e_bus_t *bus) { return cm1e_sii_read_device(bus, 1, bytes, &size, &diag); }
static cm1e_error_t call_sii_write(cm1e_bus_t *bus) { return cm1e_sii_write_device(bus, 1, bytes, 2048, NULL, &diag); }
static cm1e_error_t call_foe_read(cm1e_bus_t *bus) { return cm1e_foe_read(bus, 1, "f", bytes, &size, NULL, &diag); }
static cm1e_error_t call_foe_write(cm1e_bus_t *bus) { return cm1e_foe_write(bus, 1, "f", bytes, 1, NULL, &diag); }
static cm1e_error_t call_firmware(cm1e_bus_t *bus)
{
    const cm1e_firmware_file_t file = {.name = "f", .bytes = bytes, .size = 1};
    cm1e_firmware_state_t state = CM1E_FIRMWARE_WRITTEN;
    const cm1e_error_t error = cm1e_firmware_update(bus, 1, &file, &state, &diag);
    ck_assert_int_eq(state, CM1E_FIRMWARE_UNTOUCHED);
    return error;
}
static cm1e_error_t call_esc_read(cm1e_bus_t *bus) { return cm1e_esc_read(bus, 1, 0x0130, bytes, 2, &diag); }
static cm1e_error_t call_esc_write(cm1e_bus_t *bus) { return cm1e_esc_write(bus, 1, 0x0420, bytes, 2, &diag); }
static cm1e_error_t call_esc_state(cm1e_bus_t *bus)
{
    cm1e_al_answer_t answer;
    return cm1e_esc_request_state(bus, 1, CM1E_AL_INIT, 1, &answer, &diag);
}
static cm1e_error_t call_cml(cm1e_bus_t *bus)
{
    static cm1e_cml_exchange_t exchange;
    exchange = (cm1e_cml_exchange_t){.position = 1, .channel = 1, .text = "?99.1"};
    return cm1e_cml_exchange(bus, &exchange, &diag);
}
static cm1e_error_t call_cml_leave(cm1e_bus_t *bus) { return cm1e_cml_leave(bus, 1, 1, false, &diag); }
static cm1e_error_t call_load(cm1e_bus_t *bus)
{
    static cm1e_bus_config_t config;
    (void)bus;
    return cm1e_bus_config_load(&config, "no-such-file.yaml", &diag);
}
static cm1e_error_t call_create(cm1e_bus_t *bus)
{
    cm1e_scheduler_t *other;
    return cm1e_scheduler_create(&other, bus, NULL, &diag);
}
static cm1e_error_t call_add_bus(cm1e_bus_t *bus) { return cm1e_scheduler_add_bus(machine.scheduler, bus, &diag); }
static cm1e_error_t call_run(cm1e_bus_t *bus)
{
    (void)bus;
    return cm1e_scheduler_run(machine.scheduler, 0, &diag);
}
static cm1e_error_t call_csv(cm1e_bus_t *bus)
{
    (void)bus;
    return cm1e_scheduler_write_csv(machine.scheduler, CM1E_TEST_OUTPUT "/never.csv", &diag);
}
static cm1e_error_t call_svg(cm1e_bus_t *bus)
{
    (void)bus;
    return cm1e_scheduler_write_svg(machine.scheduler, CM1E_TEST_OUTPUT "/never.svg", &diag);
}

static cm1e_error_t call_check(cm1e_bus_t *bus)
{
    (void)bus;
    return cm1e_scheduler_check_path(CM1E_TEST_OUTPUT "/never.svg", &diag);
}

static cm1e_error_t call_ports(cm1e_bus_t *bus)
{
    cm1e_slave_port_t ports[CM1E_PORTS];
    return cm1e_bus_read_ports(bus, 1, ports, &diag);
}
static cm1e_error_t call_html(cm1e_bus_t *bus)
{
    (void)bus;
    return cm1e_scheduler_write_html(machine.scheduler, CM1E_TEST_OUTPUT "/never.html", &diag);
}
static cm1e_error_t call_npy(cm1e_bus_t *bus)
{
    (void)bus;
    return cm1e_scheduler_write_npy(machine.scheduler, CM1E_TEST_OUTPUT "/never.npy", &diag);
}

static const struct {
    const char *name;
    cm1e_error_t (*call)(cm1e_bus_t *bus);
} waiting[] = {
    {"cm1e_bus_open()", call_open}, {"cm1e_bus_scan()", call_scan}, {"cm1e_bus_identify()", call_identify},
    {"cm1e_bus_configure()", call_configure}, {"cm1e_bus_operate()", call_operate}, {"cm1e_bus_start()", call_start},
    {"cm1e_sdo_read()", call_read}, {"cm1e_sdo_write()", call_write}, {"cm1e_sdo_info_list()", call_list},
    {"cm1e_sdo_info_object()", call_object}, {"cm1e_sdo_info_entry()", call_entry}, {"cm1e_bridge_read()", call_bridge},
    {"cm1e_foe_read()", call_foe_read}, {"cm1e_foe_write()", call_foe_write}, {"cm1e_firmware_update()", call_firmware},
    {"cm1e_esc_read()", call_esc_read}, {"cm1e_esc_write()", call_esc_write},
    {"cm1e_esc_request_state()", call_esc_state}, {"cm1e_sii_read_device()", call_sii_read}, {"cm1e_sii_write_device()", call_sii_write},
    {"cm1e_cml_exchange()", call_cml}, {"cm1e_cml_leave()", call_cml_leave}, {"cm1e_bus_config_load()", call_load},
    {"cm1e_scheduler_create()", call_create}, {"cm1e_scheduler_add_bus()", call_add_bus},
    {"cm1e_scheduler_run()", call_run},
    {"cm1e_scheduler_write_csv()", call_csv}, {"cm1e_scheduler_write_svg()", call_svg},
    {"cm1e_scheduler_check_path()", call_check}, {"cm1e_bus_read_ports()", call_ports},
    {"cm1e_scheduler_write_html()", call_html}, {"cm1e_scheduler_write_npy()", call_npy},
};
enum { WAITING = sizeof waiting / sizeof waiting[0] };

static void call_what_waits(void *context)
{
    const int number = *(const int *)context;
    turn_and_watch();
    if (!turn.InVelocity)
        return;
    const cm1e_error_t error = waiting[number].call(machine.bus);
    ck_assert_msg(error == CM1E_ERROR_STATE && diag.error == error, "%s: %s", waiting[number].name,
                  cm1e_strerror(error));
    ck_assert_msg(strstr(diag.text, waiting[number].name) && strstr(diag.text, " in a task"), "%s", diag.text);
}

START_TEST(test_what_waits_is_refused_in_a_task_and_nothing_jumps)
{
    int number = _i;
    size = sizeof bytes;
    open_machine(call_what_waits, &number);
    machine_run(&machine, 300 * MS);
    ck_assert_msg(diag.error == CM1E_ERROR_STATE, "%s was not called", waiting[number].name);
    ck_assert_msg(fastest_change <= 100 * 0.001 * (1 + 1e-9), "%s: a step of %g u/s", waiting[number].name,
                  fastest_change);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    ck_assert_uint_eq(statistics.overruns, 0);
    machine_close(&machine);
}
END_TEST

START_TEST(test_an_sdo_that_is_refused_in_a_task_says_what_to_use)
{
    int number = 0;
    while (waiting[number].call != call_read)
        number++;
    open_machine(call_what_waits, &number);
    machine_run(&machine, 300 * MS);
    ck_assert_msg(strstr(diag.text, "cm1e_sdo_submit()"), "%s", diag.text);
    machine_close(&machine);
}
END_TEST

/* ---- without one: the run tells --------------------------------------------------------------------------------- */

static void call_destroy(void) { cm1e_scheduler_destroy(machine.scheduler); }
static void call_close(void) { cm1e_bus_close(machine.bus); }
static void call_stop(void) { cm1e_bus_stop(machine.bus); }

static const struct {
    const char *name;
    void (*call)(void);
} ending[] = {{"cm1e_scheduler_destroy()", call_destroy}, {"cm1e_bus_close()", call_close}, {"cm1e_bus_stop()", call_stop}};
enum { ENDING = sizeof ending / sizeof ending[0] };

static void call_what_ends(void *context)
{
    turn_and_watch();
    if (turn.InVelocity)
        ending[*(const int *)context].call();
}

START_TEST(test_what_frees_the_cycle_is_refused_in_a_task_and_ends_the_run_in_order)
{
    int number = _i;
    cm1e_diag_t told = {0};
    open_machine(call_what_ends, &number);
    ck_assert_int_eq(cm1e_scheduler_run(machine.scheduler, 0, &told), CM1E_ERROR_STATE);
    ck_assert_msg(strstr(told.text, ending[number].name) && strstr(told.text, " in a task"), "%s", told.text);
    cm1e_axis_info_t info;
    ck_assert_int_eq(cm1e_axis_read(machine.axis[0], &info), CM1E_OK);
    ck_assert_int_eq(info.state, CM1E_AXIS_DISABLED);
    ck_assert(fabs(info.actual_velocity) < 0.1);
    ck_assert_int_eq(cm1e_bus_slave(machine.bus, 1)->al_state, CM1E_AL_INIT);
    machine_close(&machine);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("in a task");
    TCase *all = tcase_create("all");
    tcase_add_loop_test(all, test_what_waits_is_refused_in_a_task_and_nothing_jumps, 0, WAITING);
    tcase_add_test(all, test_an_sdo_that_is_refused_in_a_task_says_what_to_use);
    tcase_add_loop_test(all, test_what_frees_the_cycle_is_refused_in_a_task_and_ends_the_run_in_order, 0, ENDING);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
