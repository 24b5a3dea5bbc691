#include "trace_file.h"

#include <string.h>

#include "cm1e/trace.h"
#include "command.h"

int check_trace_file(const char *option, const char *path)
{
    cm1e_diag_t diag = {0};
    if (!path)
        return EXIT_OK;
    if (strcmp(path, "-") != 0)
        return cm1e_scheduler_check_path(path, &diag) == CM1E_OK ? EXIT_OK : fail(&diag);
    complain("%s: standard output has the result of the command; give a file", option);
    return EXIT_WRONG_USE;
}
