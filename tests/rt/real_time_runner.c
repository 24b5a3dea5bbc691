/**
 * Runs a test of programs in real time, and again where it failed while the machine itself stood still.
 *
 *     real_time_runner PROGRAM [ARGUMENT ...]
 *
 * A virtual machine loses its processors to others for milliseconds: then frames are late, whatever cm1e does. So a
 * thread on each processor, above all programs of the test, sleeps for a millisecond at a time and notes by how much it
 * woke too late. A test that failed after a wake-up at least PAUSE_NS late runs again, RUNS times in all, and each time
 * says so. A test that failed while the machine ran on has failed.
 *
 * A test that found out that such pauses hide what it looks for exits with 78. It runs twice. If the machine stood still
 * both times, it is a skip.
 */
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { RUNS = 5, RUNS_NOT_JUDGED = 2, PRIORITY = 90, STACK_BYTES = 64 * 1024 };
enum { SKIPPED = 77, NOT_JUDGED = 78, NOT_STARTED = 127 };
static const int64_t TICK_NS = 1000000, PAUSE_NS = 2000000, NS_PER_S = 1000000000;

static _Atomic int64_t longest_ns;

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

static void *watch(void *unused)
{
    (void)unused;
    for (;;) {
        const int64_t due = now_ns() + TICK_NS;
        const struct timespec until = {.tv_sec = due / NS_PER_S, .tv_nsec = due % NS_PER_S};
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
        const int64_t late = now_ns() - due;
        int64_t longest = atomic_load(&longest_ns);
        while (late > longest && !atomic_compare_exchange_weak(&longest_ns, &longest, late))
            ;
    }
    return NULL;
}

/** Above all programs where that is allowed; without it a pause may be the load of the machine too. */
static bool start_watch(int processor)
{
    const struct sched_param above = {.sched_priority = PRIORITY};
    pthread_attr_t attributes;
    pthread_t thread;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(processor, &one);
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, STACK_BYTES);
    pthread_attr_setaffinity_np(&attributes, sizeof one, &one);
    const bool started = pthread_create(&thread, &attributes, watch, NULL) == 0;
    if (started)
        pthread_setschedparam(thread, SCHED_FIFO, &above);
    pthread_attr_destroy(&attributes);
    return started;
}

static bool watch_all_processors(void)
{
    cpu_set_t ours;
    bool watched = sched_getaffinity(0, sizeof ours, &ours) == 0;
    for (int processor = 0; watched && processor < CPU_SETSIZE; processor++)
        if (CPU_ISSET(processor, &ours))
            watched = start_watch(processor);
    return watched;
}

/** A test in the background, or under nohup, was told to ignore some signals, and the programs that it ends by them would
 *  ignore them too. */
static void hear_signals(void)
{
    static const int numbers[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        signal(numbers[i], SIG_DFL);
}

/** The exit status of the program; 128 and more: the signal that ended it. */
static int run(char *const words[])
{
    int status = 0;
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        hear_signals();
        execvp(words[0], words);
        fprintf(stderr, "%s cannot be started: %s\n", words[0], strerror(errno));
        _exit(NOT_STARTED);
    }
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (child < 0)
        return NOT_STARTED;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int main(int count, char *words[])
{
    if (count < 2 || !watch_all_processors()) {
        fprintf(stderr, "real_time_runner PROGRAM [ARGUMENT ...]\n");
        return EXIT_FAILURE;
    }
    for (int n = 1;; n++) {
        atomic_store(&longest_ns, 0);
        const int result = run(words + 1);
        const int64_t longest = atomic_load(&longest_ns);
        if (result == 0 || result == SKIPPED || result == NOT_STARTED || longest < PAUSE_NS || n == RUNS)
            return result;
        if (result == NOT_JUDGED && n >= RUNS_NOT_JUDGED)
            return SKIPPED;
        printf("RUNS AGAIN: %s, because it failed while this machine stood still for %.1f ms\n",
               words[count > 2 ? 2 : 1], (double)longest * 1e-6);
    }
}
