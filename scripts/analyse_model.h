/* What scripts/analyse tells clang's analyzer of functions that it does not see into. Some return the error that they
 * describe, so a function that ends with one of them has failed; argp_error() ends the program. No program includes this
 * file. */
#include <argp.h>
#include <stdlib.h>

#include "cm1e/error.h"
#include "core/in_task.h"

#define cm1e_diag_set(diag, error, ...) (cm1e_diag_set(diag, error, __VA_ARGS__), (error))
#define cm1e_in_task_refuse(...) (cm1e_in_task_refuse(__VA_ARGS__), CM1E_ERROR_STATE)
#define argp_error(...) (argp_error(__VA_ARGS__), exit(1))
