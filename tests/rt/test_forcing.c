/**
 * Forced variables: bits of a byte beside each other, the last free place and one more, an owner that others do not push
 * aside, and the time at which a variable is the program's again.
 */
#include <stdlib.h>

#include "machine.h"
#include "scheduler/forcing.h"

#define MS INT64_C(1000000)
enum { BITS = 8, VARIABLES = CM1E_FORCED + 6 };

static machine_t machine;
static uint8_t bytes[VARIABLES];
static char names[VARIABLES][16];
static variable_t rows[VARIABLES];
static int here, there; /* two owners */

/** The first eight are the bits of one byte, the others have a byte each. */
static void open_machine(cm1e_program_t program)
{
    memset(bytes, 0, sizeof bytes);
    for (uint32_t i = 0; i < VARIABLES; i++) {
        snprintf(names[i], sizeof names[i], "Main.v%u", (unsigned)i);
        rows[i] = (variable_t){.name = names[i], .unit = "", .declared = i < BITS ? "BOOL" : "BYTE", .bytes = 1,
                               .type = i < BITS ? CM1E_TRACE_BOOL : CM1E_TRACE_USINT, .data = &bytes[i < BITS ? 0 : i],
                               .bit = i < BITS ? (uint8_t)(i + 1) : 0};
    }
    machine = (machine_t){.axis_count = 1};
    machine_open(&machine);
    cm1e_scheduler_set_variables(machine.scheduler, rows, VARIABLES);
    machine_add(&machine, "", 0, 0, program, NULL);
}

static forcing_result_t force(uint32_t variable, uint8_t value, const void *owner)
{
    const int64_t now_ns = cm1e_scheduler_time_ns(machine.scheduler);
    const forced_t forced = {.owner = owner, .variable = variable, .value = {.bytes = {value}},
                             .until_ns = now_ns + 20 * MS};
    return cm1e_scheduler_force(machine.scheduler, &forced);
}

static void release(uint32_t variable, const void *owner)
{
    cm1e_scheduler_release(machine.scheduler, &(forced_t){.owner = owner, .variable = variable});
}

static uint32_t count_forced(void)
{
    uint32_t list[CM1E_FORCED];
    return cm1e_scheduler_list_forced(machine.scheduler, list);
}

/* ---- bits -------------------------------------------------------------------------------------------------------- */

static void force_bits(void *context)
{
    (void)context;
    for (unsigned mask = 0; mask < 256; mask++) {
        const uint8_t before = (uint8_t)~mask;
        bytes[0] = before;
        for (uint32_t bit = 0; bit < BITS; bit++) {
            const uint8_t value = mask >> bit & 1 ? 0xFF : 0, rest = (uint8_t)~(1u << bit);
            const uint8_t kept = bytes[0] & rest;
            ck_assert_int_eq(force(bit, value, &here), FORCING_DONE);
            ck_assert_uint_eq(bytes[0] & rest, kept); /* its neighbours are as they were */
            ck_assert_double_eq(cm1e_variable_number(&rows[bit]), value ? 1 : 0);
        }
        ck_assert_uint_eq(bytes[0], mask);
        bytes[0] = before; /* the program writes them all */
        cm1e_scheduler_apply_forced(machine.scheduler);
        ck_assert_uint_eq(bytes[0], mask);
    }
    for (uint32_t bit = 0; bit < BITS; bit++)
        release(bit, &here);
    ck_assert_uint_eq(count_forced(), 0);
    cm1e_scheduler_stop(machine.scheduler);
}

START_TEST(test_bits_of_a_byte_are_forced_each_by_itself)
{
    open_machine(force_bits);
    machine_run(&machine, 0);
    machine_close(&machine);
}
END_TEST

/* ---- places ------------------------------------------------------------------------------------------------------ */

static void force_too_many(void *context)
{
    const uint32_t first = BITS;
    (void)context;
    for (uint32_t i = 0; i < CM1E_FORCED; i++)
        ck_assert_int_eq(force(first - 3 + i, 7, &here), FORCING_DONE);
    ck_assert_uint_eq(count_forced(), CM1E_FORCED);
    for (int again = 0; again < 3; again++) {
        ck_assert_int_eq(force(VARIABLES - 1, 7, &here), FORCING_FULL);
        ck_assert(!cm1e_scheduler_is_forced(machine.scheduler, VARIABLES - 1));
        ck_assert_uint_eq(bytes[VARIABLES - 1], 0);
        ck_assert_int_eq(force(first, 9, &here), FORCING_DONE); /* one that is forced needs no place */
        ck_assert_uint_eq(bytes[first], 9);
    }
    release(first, &here);
    ck_assert_int_eq(force(VARIABLES - 1, 7, &here), FORCING_DONE);
    ck_assert_int_eq(force(first, 7, &here), FORCING_FULL);
    cm1e_scheduler_release_all(machine.scheduler, &here, 0);
    ck_assert_uint_eq(count_forced(), 0);
    for (uint32_t i = 0; i < VARIABLES; i++)
        ck_assert(!cm1e_scheduler_is_forced(machine.scheduler, i));
    cm1e_scheduler_stop(machine.scheduler);
}

START_TEST(test_one_more_than_there_are_places_is_refused)
{
    open_machine(force_too_many);
    machine_run(&machine, 0);
    machine_close(&machine);
}
END_TEST

/* ---- owners, time ------------------------------------------------------------------------------------------------ */

static unsigned calls;

static void force_and_wait(void *context)
{
    const variable_value_t value = {.bytes = {3}};
    const uint32_t variable = BITS;
    (void)context;
    cm1e_scheduler_forcing_cycle(machine.scheduler);
    if (calls++ == 0) {
        ck_assert_int_eq(force(variable, 5, &here), FORCING_DONE);
        ck_assert_int_eq(force(variable, 6, &there), FORCING_HELD);
        ck_assert_int_eq(cm1e_scheduler_write(machine.scheduler, variable, &value), FORCING_HELD);
        cm1e_scheduler_release_all(machine.scheduler, &there, 0);
        cm1e_scheduler_release_all(machine.scheduler, &here, 1); /* another number of that owner */
    }
    ck_assert_int_eq(cm1e_scheduler_is_forced(machine.scheduler, variable), calls <= 20);
    ck_assert_uint_eq(bytes[variable], 5);
    if (calls == 30) {
        ck_assert_int_eq(cm1e_scheduler_write(machine.scheduler, variable, &value), FORCING_DONE);
        ck_assert_uint_eq(bytes[variable], 3);
        ck_assert_int_eq(force(variable, 6, &there), FORCING_DONE);
        cm1e_scheduler_stop(machine.scheduler);
        ck_assert_int_eq(force(variable, 7, &there), FORCING_DONE);
    }
}

START_TEST(test_what_is_not_renewed_in_time_is_free_and_nothing_is_forced_behind_the_run)
{
    calls = 0;
    open_machine(force_and_wait);
    machine_run(&machine, 0);
    ck_assert_uint_eq(calls, 30);
    ck_assert_int_eq(force(BITS, 7, &here), FORCING_ENDING);
    cm1e_scheduler_forcing_cycle(machine.scheduler);
    ck_assert_uint_eq(count_forced(), 0);
    machine_close(&machine);
}
END_TEST

/* ---- released by another one ------------------------------------------------------------------------------------- */

static void force_what_was_released(void *context)
{
    const uint32_t variable = BITS, other = BITS + 1;
    (void)context;
    cm1e_scheduler_forcing_cycle(machine.scheduler);
    switch (calls++) {
    case 0:
        ck_assert_int_eq(force(variable, 5, &here), FORCING_DONE);
        ck_assert_int_eq(force(other, 5, &here), FORCING_DONE);
        release(variable, &there);
        ck_assert_uint_eq(count_forced(), 1);
        break;
    case 10: /* it asks on: no renewal forces it again, and the others stay as they are */
    case 25:
        ck_assert_int_eq(force(variable, 5, &here), FORCING_TAKEN);
        ck_assert_int_eq(force(other, 5, &here), FORCING_DONE);
        break;
    case 26: /* who released it may force it, and whoever did not have it */
        ck_assert_int_eq(force(variable, 6, &there), FORCING_DONE);
        ck_assert_int_eq(force(variable, 5, &here), FORCING_TAKEN);
        break;
    case 27: /* the owner lets go of it by a release, which does not end what another one forces meanwhile */
        release(variable, &here);
        ck_assert_uint_eq(count_forced(), 2);
        ck_assert_int_eq(force(variable, 6, &there), FORCING_DONE);
        ck_assert_int_eq(force(variable, 5, &here), FORCING_HELD);
        release(variable, &here);
        ck_assert_uint_eq(count_forced(), 1);
        ck_assert_int_eq(force(variable, 6, &there), FORCING_TAKEN);
        release(variable, &there);
        ck_assert_int_eq(force(variable, 5, &here), FORCING_DONE);
        release(variable, &there);
        break;
    case 60: /* and by not asking */
        ck_assert_int_eq(force(variable, 5, &here), FORCING_DONE);
        release(variable, &there);
        cm1e_scheduler_release_all(machine.scheduler, &here, 0); /* another connection may have its number */
        ck_assert_int_eq(force(variable, 5, &here), FORCING_DONE);
        for (uint32_t i = 0; i < CM1E_FORCED; i++) { /* what is remembered of them takes no place */
            ck_assert_int_eq(force(i, 1, &here), FORCING_DONE);
            release(i, &there);
        }
        for (uint32_t i = 0; i < CM1E_FORCED; i++)
            ck_assert_int_eq(force(i, 1, &there), FORCING_DONE);
        cm1e_scheduler_stop(machine.scheduler);
        break;
    default: break;
    }
}

START_TEST(test_what_another_one_has_released_is_not_renewed)
{
    calls = 0;
    open_machine(force_what_was_released);
    machine_run(&machine, 0);
    ck_assert_uint_eq(calls, 61);
    machine_close(&machine);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("forcing");
    TCase *tests = tcase_create("forcing");
    tcase_add_test(tests, test_bits_of_a_byte_are_forced_each_by_itself);
    tcase_add_test(tests, test_one_more_than_there_are_places_is_refused);
    tcase_add_test(tests, test_what_is_not_renewed_in_time_is_free_and_nothing_is_forced_behind_the_run);
    tcase_add_test(tests, test_what_another_one_has_released_is_not_renewed);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
