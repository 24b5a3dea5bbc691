#include "real_time.h"

#include <sys/wait.h>
#include <unistd.h>

/** Somebody waited for a processor in nearly all of the last ten seconds. False where the kernel does not tell. */
static bool no_processor_is_free(void)
{
    double share = 0.0;
    FILE *pressure = fopen("/proc/pressure/cpu", "r");
    if (!pressure)
        return false;
    const bool told = fscanf(pressure, "some avg10=%lf", &share) == 1;
    fclose(pressure);
    return told && share > 80.0;
}

bool run_above_others(bool above)
{
    const struct sched_param parameters = {.sched_priority = above ? TEST_PRIORITY : 0};
    return sched_setscheduler(0, above ? SCHED_FIFO : SCHED_OTHER, &parameters) == 0;
}

void need_real_time(void)
{
    if (run_above_others(true) || !no_processor_is_free())
        return;
    printf("SKIPPED: this machine has no free processor, and SCHED_FIFO is not allowed: no time is judged\n");
    exit(EXIT_SUCCESS);
}

static int run_part(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}

int run_parts(Suite *(*make)(int part), int parts)
{
    int result = EXIT_SUCCESS, status;
    for (int part = 0; part < parts; part++) {
        const pid_t child = fork();
        if (child == 0)
            exit(run_part(make(part)));
        if (child < 0)
            result = EXIT_FAILURE;
    }
    for (int part = 0; part < parts; part++)
        if (wait(&status) < 0 || status != 0)
            result = EXIT_FAILURE;
    return result;
}
