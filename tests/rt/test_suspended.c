/**
 * A machine that is suspended while a motor moves: no frame is sent for an hour, and then the program goes on. The motor
 * does not move again by itself. The kernel is replaced at link time: while a machine is suspended, CLOCK_MONOTONIC stands
 * still and CLOCK_BOOTTIME goes on.
 */
#include <time.h>

#include "machine.h"
#include "real_time.h"

#define HOUR_S 3600

static time_t suspended_s; /* in all */

/* NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): the linker wants these names */
int __real_clock_gettime(clockid_t clock, struct timespec *time);
int __real_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *left);
int __wrap_clock_gettime(clockid_t clock, struct timespec *time);
int __wrap_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *left);

int __wrap_clock_gettime(clockid_t clock, struct timespec *time)
{
    if (clock != CLOCK_BOOTTIME)
        return __real_clock_gettime(clock, time);
    const int error = __real_clock_gettime(CLOCK_MONOTONIC, time);
    time->tv_sec += suspended_s;
    return error;
}

int __wrap_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *left)
{
    if (clock != CLOCK_BOOTTIME)
        return __real_clock_nanosleep(clock, flags, time, left);
    const struct timespec awake = {.tv_sec = time->tv_sec - suspended_s, .tv_nsec = time->tv_nsec};
    return __real_clock_nanosleep(CLOCK_MONOTONIC, flags, &awake, left);
}
/* NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming) */

enum { MOST_CYCLES = 5000, AFTER_CYCLES = 300 };

typedef struct run {
    machine_t machine;
    MC_Power_t power;
    MC_MoveVelocity_t turn;
    int cycles, after;
    cm1e_axis_state_t state; /**< in the first cycle after the pause */
    char text[512];
} run_t;

static cm1e_axis_info_t info_of(const run_t *run)
{
    cm1e_axis_info_t info = {0};
    cm1e_axis_read(run->machine.axis[0], &info);
    return info;
}

static void program(void *context)
{
    run_t *run = context;
    if (run->after == 1) {
        run->state = info_of(run).state;
        cm1e_axis_error_text(run->machine.axis[0], run->text, sizeof run->text);
    }
    MC_Power(&run->power);
    run->turn.Execute = run->power.Status;
    MC_MoveVelocity(&run->turn);
    if (run->after == 0 && run->turn.InVelocity)
        suspended_s += HOUR_S;
    run->after += run->after > 0 || run->turn.InVelocity;
    if (run->after == AFTER_CYCLES || ++run->cycles == MOST_CYCLES)
        cm1e_scheduler_stop(run->machine.scheduler);
}

START_TEST(test_after_an_hour_without_frames_no_motor_moves_again_by_itself)
{
    run_t run = {.machine = {.axis_count = 1, .real_time = true}};
    machine_open(&run.machine);
    AXIS_REF_t *axis = &run.machine.axis[0];
    run.power = (MC_Power_t){.Axis = axis, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
    run.turn = (MC_MoveVelocity_t){.Axis = axis, .Velocity = 1};
    machine_add(&run.machine, "turn", 0, 0, program, &run);
    machine_run(&run.machine, 0);
    ck_assert_msg(run.after > 0, "it never turned");
    ck_assert_msg(run.state == CM1E_AXIS_ERROR_STOP, "after an hour it is in %s", cm1e_axis_state_name(run.state));
    ck_assert_msg(strstr(run.text, "no frame was sent for 36000"), "%s", run.text); /* 3,600,000 ms, and a little */
    ck_assert_int_eq(info_of(&run).state, CM1E_AXIS_ERROR_STOP);
    machine_close(&run.machine);
}
END_TEST

int main(void)
{
    need_real_time();
    Suite *suite = suite_create("a machine that is suspended");
    TCase *cases = tcase_create("suspended");
    tcase_set_timeout(cases, 60);
    tcase_add_test(cases, test_after_an_hour_without_frames_no_motor_moves_again_by_itself);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
