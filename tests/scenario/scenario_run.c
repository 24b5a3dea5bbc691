/* A scenario from the opening of its networks to their end, on virtual time. */
#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenario_private.h"

enum { BEYOND_NS = 20000 };

FILE *scenario_trace;

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
    if (run->cycle > 0 && heap_allocations() != run->allocations)
        scenario_fail(run, "memory", "%llu allocations between two cycles",
                      (unsigned long long)(heap_allocations() - run->allocations));
    judge_look(run);
    fault_switches(run);
    fault_cycle(run);
    program_cycle(run);
    analog_cycle(run);
    judge_cycle(run);
    if (run->cycle >= run->scenario->cycles)
        program_recover(run);
    if (run->phase == PHASE_END) {
        judge_end(run);
        cm1e_scheduler_stop(run->scheduler);
    }
    run->cycle++;
    run->allocations = heap_allocations();
}

/** A clock that jumped beyond the tolerance, and nothing else happened: it was counted. The first one is the reference,
 *  which all others follow. */
static void judge_clocks(run_t *run)
{
    const fault_t *fault = &run->scenario->faults[0];
    const bool follows = run->axes[(int)fault->axis].position > 1;
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(run->scheduler, &statistics);
    if (run->scenario->fault_count == 1 && fault->kind == FAULT_CLOCK && fabs(fault->value) >= BEYOND_NS && follows &&
        statistics.clocks.sync_losses == 0)
        scenario_fail(run, "clock", "a clock that jumped by %.0f ns was not counted", fault->value);
}

static void judge_stopped(run_t *run, cm1e_error_t error, const cm1e_diag_t *diag)
{
    if (error != CM1E_OK)
        scenario_fail(run, "stop", "the end of the run: %s", diag->text);
    judge_clocks(run);
    for (int n = 0; n < run->scenario->axis_count; n++) {
        machine_axis_t *axis = &run->axes[n];
        if (!is_motor(axis))
            continue;
        cm1e_sim_probe_channel(run->segments[axis->network], axis->position, axis->channel, &axis->probe);
        if (axis->probe.torque_on)
            scenario_fail(run, "stop", "%s is under torque after the end of the run", axis->name);
    }
}

/** Number of allocations that a set-up leaves behind in which the allocation number `memory` fails. `said` is why it
 *  failed, "" if it did not. */
static int set_up_without_memory(const scenario_t *scenario, char *said, size_t size)
{
    static run_t run;
    static outcome_t outcome;
    memset(&run, 0, sizeof run);
    outcome = (outcome_t){0};
    run.scenario = scenario;
    run.outcome = &outcome;
    heap_track((uint64_t)scenario->memory);
    scenario_open(&run, one_cycle);
    snprintf(said, size, "%s", heap_failed() ? outcome.text : "it needs less");
    scenario_close(&run);
    return heap_left();
}

/** Without memory a set-up fails in words and leaves nothing behind. It is tried twice, because what a process allocates
 *  once for all its time is no leak. */
static void judge_memory(run_t *run)
{
    char said[400];
    set_up_without_memory(run->scenario, said, sizeof said);
    const int left = set_up_without_memory(run->scenario, said, sizeof said);
    if (!said[0])
        scenario_fail(run, "no-memory", "the set-up does not say that allocation %.0f failed", run->scenario->memory);
    if (left > 0)
        scenario_fail(run, "leak", "a set-up in which allocation %.0f fails leaves %d others: %.200s",
                      run->scenario->memory, left, said);
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
    program_forget();
    judge_begin(&run);
    if (scenario->memory > 0)
        judge_memory(&run);
    if (outcome->failed)
        return;
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
        exit(write(ends[1], outcome, sizeof *outcome) == (ssize_t)sizeof *outcome ? 0 : 1); /* counters of coverage too */
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
