#include "scheduler/realtime.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/capability.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/program.h"

/** Stack that the calls of a cycle may need. It is touched before the run, so that no page fault happens in the
 *  cycle. */
enum { STACK_TOUCHED = 64 * 1024, PAGE = 4096 };

/** Sanitizers map terabytes of shadow memory, which cannot be locked. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { MEMORY_CAN_BE_LOCKED = false };
#else
enum { MEMORY_CAN_BE_LOCKED = true };
#endif

static bool has_capability(unsigned capability)
{
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    struct __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3] = {{0}};
    if (syscall(SYS_capget, &header, data) != 0)
        return false;
    return data[CAP_TO_INDEX(capability)].effective & CAP_TO_MASK(capability);
}

/** Future memory is locked only where no limit counts: under a finite one the next large allocation would fail. */
static bool lock_memory(void)
{
    struct rlimit limit;
    if (!MEMORY_CAN_BE_LOCKED)
        return true;
    const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
    return (unlimited || has_capability(CAP_IPC_LOCK)) && mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
}

static __attribute__((noinline)) void touch_stack(void)
{
    volatile uint8_t stack[STACK_TOUCHED];
    for (size_t i = 0; i < sizeof stack; i += PAGE)
        stack[i] = 0;
}

static bool take_fifo(realtime_t *realtime, int priority)
{
    const struct sched_param parameters = {.sched_priority = priority};
    if (pthread_getschedparam(pthread_self(), &realtime->policy, &realtime->parameters) != 0)
        return false;
    realtime->fifo = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
    return realtime->fifo;
}

static bool bind_to_cpu(realtime_t *realtime, int cpu)
{
    cpu_set_t wanted;
    if (cpu > CPU_SETSIZE || pthread_getaffinity_np(pthread_self(), sizeof realtime->cpus, &realtime->cpus) != 0)
        return false;
    CPU_ZERO(&wanted);
    CPU_SET((size_t)(cpu - 1), &wanted);
    realtime->bound = pthread_setaffinity_np(pthread_self(), sizeof wanted, &wanted) == 0;
    return realtime->bound;
}

/** Forbids sleep states of the processors while the file is open, which ends with the process at the latest. A
 *  processor that sleeps between two cycles wakes up late. It is no part of "real time is in force": the file is
 *  root's, unless the administrator gave it away (docs/REALTIME.md), and a privilege does not replace that. */
static void keep_awake(realtime_t *realtime)
{
    const int32_t latency_us = 0;
    const int fd = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    realtime->awake = fd >= 0 && write(fd, &latency_us, sizeof latency_us) == sizeof latency_us;
    realtime->awake_fd = fd;
    if (fd >= 0 && !realtime->awake)
        close(fd);
}

static void advise(char *advice, size_t size, bool fifo, bool locked, int priority)
{
    char cure[300];
    cm1e_program_cure(cure, sizeof cure,
                      (fifo ? 0 : CM1E_PRIVILEGE_PRIORITY) | (locked ? 0 : CM1E_PRIVILEGE_LOCK));
    snprintf(advice, size,
             "Not real time: %s%s%s refused. %s; or limits of the user in /etc/security/limits.conf: rtprio %d, "
             "memlock unlimited (ulimit -r -l shows them).", fifo ? "" : "SCHED_FIFO", fifo || locked ? "" : " and ",
             locked ? "" : "locked memory", cure, priority);
}

bool cm1e_realtime_begin(realtime_t *realtime, const cm1e_scheduler_config_t *config, char *advice, size_t size)
{
    *realtime = (realtime_t){.timer_slack_ns = (int)prctl(PR_GET_TIMERSLACK)};
    advice[0] = '\0';
    prctl(PR_SET_TIMERSLACK, 1); /* the kernel wakes a thread that is not real time up to 50 us late */
    const bool bound = config->cpu <= 0 || bind_to_cpu(realtime, config->cpu);
    if (!bound)
        snprintf(advice, size,
                 "This thread cannot be bound to CPU %d (1 = first): the machine or the container does not have it.",
                 config->cpu);
    if (config->realtime_priority < 0)
        return false;
    /* The priority first: locking takes tens of milliseconds of computing, and the slaves are in Operational already.
     * On a busy machine their watchdogs (100 ms) would not wait for it at an ordinary priority. */
    const bool fifo = take_fifo(realtime, config->realtime_priority);
    keep_awake(realtime);
    touch_stack();
    const bool locked = lock_memory();
    if (!fifo || !locked)
        advise(advice, size, fifo, locked, config->realtime_priority);
    return bound && fifo && locked;
}

void cm1e_realtime_end(const realtime_t *realtime)
{
    if (realtime->awake)
        close(realtime->awake_fd);
    if (realtime->fifo)
        pthread_setschedparam(pthread_self(), realtime->policy, &realtime->parameters);
    if (realtime->bound)
        pthread_setaffinity_np(pthread_self(), sizeof realtime->cpus, &realtime->cpus);
    if (realtime->timer_slack_ns > 0)
        prctl(PR_SET_TIMERSLACK, realtime->timer_slack_ns);
}
