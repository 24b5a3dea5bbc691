/*
 * Plays scenarios: deterministic simulations of a whole machine.
 *   scenario --seed N              one seed; prints its outcome and the hash of its trace
 *   scenario --seed N --count C    so many seeds from N on
 *   scenario --play FILE ...       scenarios that are written in files
 *   scenario --write --seed N      the scenario as text
 * with --shrink: a failing one is made smaller and written to shrunk-<seed>.scenario; --trace FILE: every cycle as CSV;
 * --faultless: without faults, and what the servo does by itself; --table: outcome of every fault, for scripts/soak;
 * --sample: a thousand seeds, or what tests/support/effort.h makes of them.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "effort.h"
#include "scenario.h"

enum { LIMIT_S = 60, FULL_COUNT = 1000 };

typedef struct options {
    uint64_t seed, count;
    bool shrink, write, faultless, table, sample;
    const char *folder;
} options_t;

static double worst_speed, worst_gain;

static const char *const speed_reason_names[SPEED_REASONS] = {
    [SPEED_OF_SERVO] = "servo",           [SPEED_OF_NETWORK] = "another network", [SPEED_AFTER_SILENCE] = "lost frames",
    [SPEED_OF_LOAD] = "lost frames and a heavy load", [SPEED_IN_RING] = "ring",   [SPEED_AFTER_PAUSE] = "pause",
    [SPEED_FROM_STOP] = "hard stop",      [SPEED_OF_HOMING] = "homing by the drive",
};

static double largest_speed(const outcome_t *outcome)
{
    double largest = 0;
    for (int i = 0; i < SPEED_REASONS; i++)
        largest = fmax(largest, outcome->over_speed[i]);
    return largest;
}

static void print_table(const scenario_t *scenario, const outcome_t *outcome)
{
    for (int i = 0; i < scenario->fault_count; i++)
        printf("fault %s %d\n", fault_names[(int)scenario->faults[i].kind], outcome->faults[i].cycles);
    for (int i = 0; i < SPEED_REASONS; i++)
        if (outcome->over_speed[i] > 0)
            printf("speed %llu %.6f %s\n", (unsigned long long)scenario->seed, outcome->over_speed[i],
                   speed_reason_names[i]);
    printf("run %d %.6f %d %d\n", outcome->failed, outcome->over_tolerance, outcome->recoveries, outcome->cycles);
}

static void shrink(scenario_t scenario, const outcome_t *failure, const options_t *options)
{
    char path[300];
    const int tries = scenario_shrink(&scenario, failure, LIMIT_S);
    snprintf(path, sizeof path, "%s/shrunk-%llu.scenario", options->folder, (unsigned long long)scenario.seed);
    FILE *file = fopen(path, "w");
    if (!file)
        return;
    outcome_t now;
    scenario_run_apart(&scenario, &now, LIMIT_S);
    fprintf(file, "# %s at cycle %d: %s\n", now.rule, now.cycle, now.text);
    scenario_write(&scenario, file);
    fclose(file);
    printf("    made smaller in %d runs: %d axes, %d steps, %d faults, %.0f cycles: %s\n", tries, scenario.axis_count,
           scenario.step_count, scenario.fault_count, scenario.cycles, path);
}

static bool play(scenario_t *scenario, const char *name, const options_t *options, bool say)
{
    outcome_t outcome;
    if (options->faultless)
        scenario->fault_count = 0;
    if (scenario_trace)
        scenario_run(scenario, &outcome);
    else
        scenario_run_apart(scenario, &outcome, LIMIT_S);
    worst_speed = fmax(worst_speed, largest_speed(&outcome));
    worst_gain = fmax(worst_gain, outcome.over_gain);
    if (options->table)
        print_table(scenario, &outcome);
    if (outcome.failed)
        printf("%s: FAIL: %s at cycle %d: %s\n", name, outcome.rule, outcome.cycle, outcome.text);
    else if (say)
        printf("%s: passed, %d cycles, hash %016llx\n", name, outcome.cycles, (unsigned long long)outcome.hash);
    if (outcome.failed && options->shrink)
        shrink(*scenario, &outcome, options);
    return !outcome.failed;
}

static bool play_file(const char *path, const options_t *options)
{
    char text[200];
    scenario_t scenario;
    FILE *file = fopen(path, "r");
    const bool is_read = file && scenario_read(&scenario, file, text, sizeof text);
    if (!is_read)
        printf("%s: FAIL: %s\n", path, file ? text : "it cannot be opened");
    if (file)
        fclose(file);
    return is_read && play(&scenario, path, options, true);
}

static int play_seeds(const options_t *options)
{
    int failed = 0;
    for (uint64_t i = 0; i < options->count; i++) {
        scenario_t scenario;
        char name[60];
        scenario_make(&scenario, options->seed + i);
        snprintf(name, sizeof name, "seed %llu", (unsigned long long)(options->seed + i));
        if (options->write)
            scenario_write(&scenario, stdout);
        else
            failed += !play(&scenario, name, options, options->count == 1);
        fflush(stdout);
    }
    if (options->count > 1)
        printf("%llu scenarios from seed %llu on: %d failed; largest speed %.3f %% and gain of speed %.1f %% over the "
               "limits\n", (unsigned long long)options->count, (unsigned long long)options->seed, failed,
               100 * worst_speed, 100 * worst_gain);
    return failed;
}

/** As many of each kind of seeds (scenario_random.c). */
static int play_sample(options_t *options)
{
    static const uint64_t firsts[] = {1, UINT64_C(1000000000), UINT64_C(2000000000), UINT64_C(3000000000),
                                      UINT64_C(4000000000), UINT64_C(5000000000), UINT64_C(6000000000),
                                      UINT64_C(7000000000), UINT64_C(8000000000), UINT64_C(9000000000)};
    enum { KINDS = sizeof firsts / sizeof firsts[0] };
    int failed = 0;
    options->count = (uint64_t)(FULL_COUNT / KINDS / slowness()) + 1;
    for (int i = 0; i < KINDS; i++) {
        options->seed = firsts[i];
        failed += play_seeds(options);
    }
    return failed;
}

/** A whole number from 0 on; else the program ends with a sentence. */
static uint64_t number(const char *option, const char *word)
{
    char *end;
    errno = 0;
    const uint64_t value = strtoull(word, &end, 10);
    if (word[0] >= '0' && word[0] <= '9' && *end == 0 && errno == 0)
        return value;
    fprintf(stderr, "scenario: %s needs a whole number from 0 on, not \"%s\"\n", option, word);
    exit(2);
}

static FILE *open_trace(const char *path)
{
    FILE *file = fopen(path, "w");
    if (file)
        return file;
    fprintf(stderr, "scenario: the trace \"%s\" cannot be written: %s\n", path, strerror(errno));
    exit(2);
}

/** Index of the first word that is no option. */
static int read_options(options_t *options, int count, char **words)
{
    int i = 1;
    for (; i < count && words[i][0] == '-'; i++) {
        const char *value = i + 1 < count ? words[i + 1] : "";
        const struct { const char *name; bool *flag; } flags[] = {
            {"--shrink", &options->shrink}, {"--write", &options->write}, {"--faultless", &options->faultless},
            {"--table", &options->table}, {"--sample", &options->sample}};
        bool known = strcmp(words[i], "--play") == 0;
        for (size_t k = 0; k < sizeof flags / sizeof flags[0]; k++)
            if (strcmp(words[i], flags[k].name) == 0)
                known = *flags[k].flag = true;
        if (known)
            continue;
        if (strcmp(words[i], "--seed") == 0)
            options->seed = number(words[i], value);
        else if (strcmp(words[i], "--count") == 0)
            options->count = number(words[i], value);
        else if (strcmp(words[i], "--folder") == 0)
            options->folder = value;
        else if (strcmp(words[i], "--trace") == 0)
            scenario_trace = open_trace(value);
        else
            return -1;
        i++;
    }
    return i;
}

int main(int count, char **words)
{
    options_t options = {.seed = 1, .count = 1, .folder = "."};
    const int first = read_options(&options, count, words);
    int failed = 0;
    if (first < 0) {
        fprintf(stderr, "usage: scenario [--seed N] [--count C] [--shrink] [--folder F] [--write] [--faultless] "
                        "[--table] [--trace FILE] [--play FILE ...]\n");
        return 2;
    }
    for (int i = first; i < count; i++)
        failed += !play_file(words[i], &options);
    if (options.sample)
        failed = play_sample(&options);
    else if (first == count)
        failed = play_seeds(&options);
    if (scenario_trace)
        fclose(scenario_trace);
    return failed ? 1 : 0;
}
