/* The system calls of the cycle, as the kernel sees them: on a real network interface, with moves, SDO transfers
 * and a look at the statistics, a filter (seccomp) catches every call that docs/DESIGN.md does not list. */
#include <errno.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cm1e/sim.h"
#include "machine.h"
#include "real_time.h"
#include "veth.h"

enum { FROM = 1000, CYCLES = 1500, AXES = 2, NOT_STARTED = 2, NO_XDP = 3 };

/** docs/DESIGN.md, "The cycle". The last two are this test's own: the end of catch(), and of the run. AF_XDP receives
 *  without a call: recvfrom, the first one, is not among those that it may make. */
static const int allowed[] = {SYS_recvfrom, SYS_sendto, SYS_ppoll, SYS_clock_nanosleep, SYS_clock_gettime,
                              SYS_rt_sigreturn, SYS_exit_group};
static bool by_xdp;

/** What the filter saw, in memory that outlives the process. */
static struct seen {
    int cycles, moves, transfers;
    int count, first; /**< calls that are not allowed, and the number of the first one */
} *seen;

static void catch(int number, siginfo_t *info, void *context)
{
    (void)number, (void)context;
    if (seen->count++ == 0)
        seen->first = info->si_syscall;
}

/** From now on a call of this thread that is not allowed is not made, and ends in catch(). */
static void filter_calls(void)
{
    enum { MOST = sizeof allowed / sizeof allowed[0] };
    const int *calls = allowed + by_xdp, rules = MOST - by_xdp;
    struct sock_filter code[MOST + 3];
    struct sock_fprog program = {(unsigned short)(rules + 3), code};
    code[0] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (int i = 0; i < rules; i++)
        code[1 + i] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)calls[i],
                                                   (unsigned char)(rules - i), 0);
    code[1 + rules] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
    code[2 + rules] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    sigset_t trap;
    sigemptyset(&trap);
    sigaddset(&trap, SIGSYS);
    pthread_sigmask(SIG_UNBLOCK, &trap, NULL); /* the scheduler blocks all signals */
    sigaction(SIGSYS, &(struct sigaction){.sa_sigaction = catch, .sa_flags = SA_SIGINFO}, NULL);
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
        _exit(errno);
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static machine_t machine = {.axis_count = AXES, .real_time = true};
static MC_Power_t powers[AXES];
static MC_Reset_t resets[AXES];
static MC_MoveRelative_t moves[AXES];
static uint8_t value[4];
static cm1e_sdo_t transfer;

static void move(int i)
{
    resets[i].Execute = powers[i].Error && !resets[i].Execute;
    MC_Power(&powers[i]);
    MC_Reset(&resets[i]);
    MC_MoveRelative(&moves[i]);
    if (moves[i].Done)
        moves[i].Distance = -moves[i].Distance;
    seen->moves += moves[i].Done;
    moves[i].Execute = powers[i].Status && !moves[i].Done && !moves[i].Error && !moves[i].CommandAborted;
}

static void program(void *unused)
{
    (void)unused;
    if (seen->cycles++ == FROM)
        filter_calls();
    for (int i = 0; i < AXES; i++)
        move(i);
    if (cm1e_sdo_state(&transfer) != CM1E_SDO_BUSY) {
        seen->transfers += cm1e_sdo_state(&transfer) == CM1E_SDO_DONE;
        transfer = (cm1e_sdo_t){.position = 1, .index = 0x1000, .data = value, .size = sizeof value};
        cm1e_sdo_submit(machine.bus, &transfer);
    }
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    if (seen->cycles >= FROM + CYCLES)
        _exit(0);
}

static void run_master(void)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    describe_axes(&config, AXES);
    config.virtual_time = false;
    config.lost_cycles_limit = 50; /* this machine may pause */
    strcpy(config.interface_name, by_xdp ? "wire0,xdp" : "wire0");
    const cm1e_error_t opened = cm1e_bus_open(&machine.bus, &config, &diag);
    if (by_xdp && (opened == CM1E_ERROR_PERMISSION || opened == CM1E_ERROR_UNSUPPORTED)) {
        printf("SKIPPED: system calls of the cycle with AF_XDP: %s\n", diag.text);
        fflush(stdout);
        _exit(NO_XDP);
    }
    if (opened != CM1E_OK || cm1e_bus_start(machine.bus, &diag) != CM1E_OK ||
        cm1e_scheduler_create(&machine.scheduler, machine.bus, &machine.config, &diag) != CM1E_OK) {
        fprintf(stderr, "%s\n", diag.text);
        _exit(NOT_STARTED);
    }
    for (uint32_t i = 0; i < AXES; i++) {
        machine.axis[i] = cm1e_scheduler_axis(machine.scheduler, i);
        powers[i] = (MC_Power_t){.Axis = &machine.axis[i], .Enable = TRUE, .EnablePositive = TRUE,
                                 .EnableNegative = TRUE};
        resets[i].Axis = &machine.axis[i];
        moves[i] = (MC_MoveRelative_t){.Axis = &machine.axis[i], .Distance = 0.5, .Velocity = 5.0};
    }
    machine_add(&machine, "program", 0, 0, program, NULL);
    machine_run(&machine, 0);
    _exit(NOT_STARTED);
}

/* ---- the segment ------------------------------------------------------------------------------------------------- */

static volatile int stop;

static void end(int number) { stop = number; }

static void run_segment(void)
{
    static cm1e_bus_config_t config;
    describe_axes(&config, AXES);
    signal(SIGTERM, end);
    cm1e_sim_server_t *server;
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create(&config, NULL);
    if (cm1e_sim_server_open(&server, segment, "wire1", NULL) != CM1E_OK)
        _exit(NOT_STARTED);
    int lines[2], answers[2];
    if (pipe(lines) != 0 || pipe(answers) != 0)
        _exit(errno);
    cm1e_sim_server_run(server, &(cm1e_sim_streams_t){lines[0], answers[1], answers[1]}, &stop);
    _exit(0);
}

static void judge_calls(void)
{
#ifdef __SANITIZE_THREAD__
    printf("SKIPPED: system calls of the cycle: ThreadSanitizer makes calls of its own\n");
    return;
#endif
    if (!veth_make()) {
        printf("SKIPPED: system calls of the cycle: needs root or user namespaces, and ip from iproute2\n");
        return;
    }
    seen = mmap(NULL, sizeof *seen, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ck_assert_ptr_ne(seen, MAP_FAILED);
    fflush(NULL);
    const pid_t segment = fork();
    if (segment == 0)
        run_segment();
    usleep(300000);
    const pid_t master = fork();
    if (master == 0)
        run_master();
    int status;
    ck_assert_int_eq(waitpid(master, &status, 0), master);
    kill(segment, SIGTERM);
    waitpid(segment, NULL, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == NO_XDP)
        return;
    ck_assert_msg(WIFEXITED(status) && WEXITSTATUS(status) == 0, "the master ended with %#x after %d cycles", status,
                  seen->cycles);
    ck_assert_msg(seen->count == 0, "%d other system calls, the first one is number %d", seen->count, seen->first);
    ck_assert_msg(seen->moves > 2 && seen->transfers > 5, "%d moves, %d transfers", seen->moves, seen->transfers);
}

START_TEST(test_cycle_makes_no_other_calls)
{
    judge_calls();
}
END_TEST

START_TEST(test_cycle_receives_without_a_call_by_xdp)
{
    by_xdp = true;
    judge_calls();
}
END_TEST

int main(void)
{
    need_real_time();
    Suite *suite = suite_create("system calls of the cycle");
    TCase *cases = tcase_create("calls");
    tcase_set_timeout(cases, 60);
    tcase_add_test(cases, test_cycle_makes_no_other_calls);
    tcase_add_test(cases, test_cycle_receives_without_a_call_by_xdp);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
