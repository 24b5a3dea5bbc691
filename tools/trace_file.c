#include "trace_file.h"

#include <string.h>

#include "cm1e/trace.h"
#include "command.h"
#include "files.h"

static const char *const options[TRACE_FILES] = {"--csv", "--svg", "--html", "--npy"};

int need_trace_files(struct argp_state *state, const char *const *files, int count)
{
    int wanted = 0;
    for (int i = 0; i < count; i++) {
        wanted += files[i] != NULL;
        if (files[i] && !files[i][0])
            argp_error(state, "%s needs the name of a file", options[i]);
        for (int k = 0; k < i && files[i]; k++)
            if (files[k] && same_file(files[i], files[k]))
                argp_error(state, "%s and %s write the same file", options[k], options[i]);
    }
    return wanted;
}

static int check_file(const char *option, const char *path)
{
    cm1e_diag_t diag = {0};
    if (!path)
        return EXIT_OK;
    if (strcmp(path, "-") != 0)
        return cm1e_scheduler_check_path(path, &diag) == CM1E_OK ? EXIT_OK : fail(&diag);
    complain("%s: standard output has the result of the command; give a file", option);
    return EXIT_WRONG_USE;
}

int check_trace_files(const char *const *files, int count)
{
    int status = EXIT_OK;
    for (int i = 0; i < count && status == EXIT_OK; i++)
        status = check_file(options[i], files[i]);
    return status;
}

void tell_missing_cycles(const cm1e_scheduler_t *scheduler, uint32_t kept)
{
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(scheduler, &statistics);
    if (statistics.cycles > kept)
        complain("the files have the last %u of %llu cycles. For a longer time record beside the run: cm1e trace --every N",
                 (unsigned)kept, (unsigned long long)statistics.cycles);
}
