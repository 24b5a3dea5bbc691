/* A scenario from the opening of its networks to their end, on virtual time. */
#include <dirent.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenario_private.h"

FILE *scenario_trace;

/* ---- the heap ---------------------------------------------------------------------------------------------------- */

static uint64_t allocations;
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);

void *__wrap_malloc(size_t size)
{
    allocations++;
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    allocations++;
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *memory, size_t size)
{
    allocations++;
    return __real_realloc(memory, size);
}

static int open_files(void)
{
    int count = 0;
    DIR *folder = opendir("/proc/self/fd");
    while (folder && readdir(folder))
        count++;
    if (folder)
        closedir(folder);
    return count;
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

void scenario_fail(run_t *run, const char *rule, const char *format, ...)
{
    outcome_t *outcome = run->outcome;
    if (outcome->failed)
        return;
    outcome->failed = true;
    outcome->cycle = run->cycle;
    snprintf(outcome->rule, sizeof outcome->rule, "%s", rule);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(outcome->text, sizeof outcome->text, format, arguments);
    va_end(arguments);
    if (run->scheduler)
        cm1e_scheduler_stop(run->scheduler);
}

/** The one task of the program. */
static void one_cycle(void *context)
{
    run_t *run = context;
    if (run->outcome->failed || run->phase == PHASE_END)
        return;
    if (run->cycle > 0 && allocations != run->allocations)
        scenario_fail(run, "memory", "%llu allocations between two cycles",
                      (unsigned long long)(allocations - run->allocations));
    judge_look(run);
    fault_cycle(run);
    program_cycle(run);
    judge_cycle(run);
    if (run->cycle >= run->scenario->cycles)
        program_recover(run);
    if (run->phase == PHASE_END) {
        judge_end(run);
        cm1e_scheduler_stop(run->scheduler);
    }
    run->cycle++;
    run->allocations = allocations;
}

static void judge_stopped(run_t *run, cm1e_error_t error, const cm1e_diag_t *diag)
{
    if (error != CM1E_OK)
        scenario_fail(run, "stop", "the end of the run: %s", diag->text);
    for (int n = 0; n < run->scenario->axis_count; n++) {
        machine_axis_t *axis = &run->axes[n];
        if (!is_motor(axis))
            continue;
        cm1e_sim_probe_channel(run->segments[axis->network], axis->position, axis->channel, &axis->probe);
        if (axis->probe.torque_on)
            scenario_fail(run, "stop", "%s is under torque after the end of the run", axis->name);
    }
}

void scenario_run(const scenario_t *scenario, outcome_t *outcome)
{
    static run_t run;
    cm1e_diag_t diag = {0};
    const int files = open_files();
    memset(&run, 0, sizeof run);
    *outcome = (outcome_t){.over_tolerance = -1};
    for (int i = 0; i < SCENARIO_FAULTS; i++)
        outcome->faults[i].cycles = -1;
    run.scenario = scenario;
    run.outcome = outcome;
    judge_begin(&run);
    if (scenario_open(&run, one_cycle)) {
        program_prepare(&run);
        const cm1e_error_t error = cm1e_scheduler_run(run.scheduler, 0, &diag);
        judge_stopped(&run, error, &diag);
    }
    scenario_close(&run);
    outcome->cycles = run.cycle;
    const int left = open_files() - files;
    if (left != 0)
        scenario_fail(&run, "files", "%d files are open after the end", left);
}

/* ---- in a process of its own ------------------------------------------------------------------------------------- */

static void read_outcome(int pipe_end, outcome_t *outcome)
{
    size_t used = 0;
    ssize_t got;
    while (used < sizeof *outcome && (got = read(pipe_end, (char *)outcome + used, sizeof *outcome - used)) > 0)
        used += (size_t)got;
    if (used < sizeof *outcome)
        *outcome = (outcome_t){.failed = true, .rule = "crash"};
}

void scenario_run_apart(const scenario_t *scenario, outcome_t *outcome, unsigned limit_s)
{
    int ends[2], status = 0;
    *outcome = (outcome_t){.failed = true, .rule = "crash", .text = "no process for the run"};
    if (pipe(ends) != 0)
        return;
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        alarm(limit_s);
        scenario_run(scenario, outcome);
        _exit(write(ends[1], outcome, sizeof *outcome) == (ssize_t)sizeof *outcome ? 0 : 1);
    }
    close(ends[1]);
    if (child > 0) {
        read_outcome(ends[0], outcome);
        waitpid(child, &status, 0);
        if (WIFSIGNALED(status))
            snprintf(outcome->text, sizeof outcome->text, "signal %d%s", WTERMSIG(status),
                     WTERMSIG(status) == SIGALRM ? ": it does not end" : "");
    }
    close(ends[0]);
}
