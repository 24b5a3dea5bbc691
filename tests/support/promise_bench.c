#include "promise_bench.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "cm1e/sim.h"

bool running;
_Thread_local bool in_cycle;
unsigned violations;
static const char *violator;
static const void *caller;

static void note(const char *name, const void *from)
{
    if (!in_cycle)
        return;
    if (violations++ == 0) {
        violator = name;
        caller = from;
    }
}
#define NOTE(name) note(name, __builtin_return_address(0))

/* ---- what must not be called ----------------------------------------------------------------------------------- */

#define WRAP(TYPE, NAME, PARAMETERS, ARGUMENTS)                                                                      \
    TYPE __real_##NAME PARAMETERS;                                                                                   \
    TYPE __wrap_##NAME PARAMETERS;                                                                                   \
    TYPE __wrap_##NAME PARAMETERS                                                                                    \
    {                                                                                                                \
        NOTE(#NAME);                                                                                                 \
        return __real_##NAME ARGUMENTS;                                                                              \
    }

WRAP(void *, malloc, (size_t size), (size))
WRAP(void *, calloc, (size_t count, size_t size), (count, size))
WRAP(void *, realloc, (void *memory, size_t size), (memory, size))
WRAP(char *, strdup, (const char *text), (text))
WRAP(int, pthread_mutex_lock, (pthread_mutex_t *mutex), (mutex))
WRAP(int, pthread_cond_wait, (pthread_cond_t *condition, pthread_mutex_t *mutex), (condition, mutex))
WRAP(int, pthread_create, (pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *context),
     (thread, attributes, run, context))
WRAP(int, vsnprintf, (char *text, size_t size, const char *format, va_list args), (text, size, format, args))
WRAP(int, vfprintf, (FILE *file, const char *format, va_list args), (file, format, args))
WRAP(int, puts, (const char *text), (text))
WRAP(int, fputs, (const char *text, FILE *file), (text, file))
WRAP(size_t, fwrite, (const void *data, size_t size, size_t count, FILE *file), (data, size, count, file))
WRAP(int, fflush, (FILE *file), (file))
WRAP(ssize_t, write, (int fd, const void *data, size_t size), (fd, data, size))
WRAP(ssize_t, read, (int fd, void *data, size_t size), (fd, data, size))
WRAP(int, nanosleep, (const struct timespec *time, struct timespec *rest), (time, rest))
WRAP(int, usleep, (useconds_t us), (us))
bool in_real_time;

int __real_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *rest);
int __wrap_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *rest);
int __wrap_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *rest)
{
    if (in_real_time && flags == TIMER_ABSTIME)
        in_cycle = false;
    NOTE("clock_nanosleep");
    return __real_clock_nanosleep(clock, flags, time, rest);
}

void __real_free(void *memory);
void __wrap_free(void *memory);
void __wrap_free(void *memory)
{
    NOTE("free");
    __real_free(memory);
}

int __wrap_snprintf(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
int __wrap_snprintf(char *text, size_t size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    NOTE("snprintf");
    const int length = __real_vsnprintf(text, size, format, args);
    va_end(args);
    return length;
}

int __wrap_printf(const char *format, ...) __attribute__((format(printf, 1, 2)));
int __wrap_printf(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    NOTE("printf");
    const int length = __real_vfprintf(stdout, format, args);
    va_end(args);
    return length;
}

int __wrap_fprintf(FILE *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
int __wrap_fprintf(FILE *file, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    NOTE("fprintf");
    const int length = __real_vfprintf(file, format, args);
    va_end(args);
    return length;
}

/* ---- what the cycle is ----------------------------------------------------------------------------------------- */

cm1e_error_t __real_cm1e_bus_receive(cm1e_bus_t *bus);
cm1e_error_t __wrap_cm1e_bus_receive(cm1e_bus_t *bus);
cm1e_error_t __wrap_cm1e_bus_receive(cm1e_bus_t *bus)
{
    in_cycle = running;
    return __real_cm1e_bus_receive(bus);
}

void __real_cm1e_bus_stop(cm1e_bus_t *bus);
void __wrap_cm1e_bus_stop(cm1e_bus_t *bus);
void __wrap_cm1e_bus_stop(cm1e_bus_t *bus)
{
    running = in_cycle = false;
    __real_cm1e_bus_stop(bus);
}

/** The simulator's console formats its answer: that is the test's doing, not the cycle's. */
static void act(cm1e_bus_t *bus, const char *line)
{
    char answer[128];
    in_cycle = false;
    ck_assert_msg(cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
    in_cycle = true;
}


machine_t machine;
int64_t cycle_number;

static const struct {
    int64_t cycle;
    const char *line;
} acts[] = {
    {20, "lose 1"}, {7050, "sensor 1 4 on"}, {7060, "sensor 2 4 on"}, {7070, "sensor 3 4 on"}, {8000, "power 1 off"},
    {8300, "power 1 on"}, {9050, "over-torque 2"}, {10100, "lose 2"}, {11300, "lose 40"}, {12500, "corrupt 20"},
    {13600, "delay 30 800"}, {15000, "unplug 2"}, {15500, "replug 2"}, {18000, "power-cycle 3"},
    {21000, "error 1 7500"}, {21500, "error 1 clear"}, {23000, "error 2 4310"}, {23400, "error 2 clear"},
};

void acting_program(void *context)
{
    (void)context;
    for (size_t i = 0; i < sizeof acts / sizeof acts[0]; i++)
        if (acts[i].cycle == cycle_number)
            act(machine.bus, acts[i].line);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    cycle_number++;
}

void promise_run(int64_t duration_ns)
{
    cycle_number = 0;
    violations = 0;
    running = true;
    machine_run(&machine, duration_ns);
    ck_assert_msg(violations == 0, "%u calls in the cycle; the first: %s from %p", violations, violator, caller);
}
