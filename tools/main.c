/** cm1e: the command line program. Each subcommand is a file cmd_<name>.c. */
#include <errno.h>
#include <linux/capability.h>
#include <stdio.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "choose_bus.h"
#include "cm1e/version.h"
#include "command.h"
#include "core/near.h"
#include "manual.h"

#define ROW(name, summary, words) {#name, summary, words, command_##name, &argp_##name},
const command_t commands[] = {COMMANDS(ROW)};
#undef ROW
const int command_count = sizeof commands / sizeof commands[0];

static void print_usage(FILE *file)
{
    fputs("Usage: cm1e COMMAND [OPTION...]\n" PROGRAM_SUMMARY "\n\n", file);
    for (int i = 0; i < command_count; i++)
        fprintf(file, "  %-10s %s\n", commands[i].name, commands[i].summary);
    fputs("\n`cm1e COMMAND --help` and `man cm1e-COMMAND` describe a command. `-i sim` is a simulated network in this\n"
          "process, `-i eth1` a real one (it needs the right to open raw sockets).\n\nExit status:\n", file);
    for (const exit_status_t *row = exit_statuses; row->meaning; row++)
        fprintf(file, "  %d  %s\n", row->status, row->meaning);
}

static int complain_unknown(const char *word)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = word};
    for (int i = 0; i < command_count; i++)
        cm1e_near_look(&near, commands[i].name);
    fprintf(stderr, "cm1e: there is no command \"%s\"%s\n\n", word, cm1e_near_text(&near, text, sizeof text));
    print_usage(stderr);
    return EXIT_WRONG_USE;
}

static bool finished; /* by finish() */

/* argp ends the process by itself after --help. */
static void finish_help(void)
{
    if (finished || (fflush(stdout) == 0 && !ferror(stdout)))
        return;
    complain("cannot write to standard output");
    _exit(EXIT_FAILED);
}

/* Output that was not written (a full disk, a closed pipe) is a failure. */
static int finish(int status)
{
    finished = true;
    if (status != EXIT_OK)
        print_json_of_failure();
    if (fflush(stdout) == 0 && !ferror(stdout))
        return status;
    complain("cannot write to standard output");
    return status == EXIT_OK ? EXIT_FAILED : status;
}

/* A package installs the command once more, with the privileges that network interfaces need, for the members of a
 * group. Who may, and has no such privilege yet, runs that one. */
#ifdef CM1E_PRIVILEGED_COMMAND
static void become_privileged(char **argv)
{
    struct __user_cap_header_struct header = {.version = _LINUX_CAPABILITY_VERSION_3};
    struct __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3] = {0};
    const char *self = (const char *)getauxval(AT_EXECFN);
    const bool asked = self && strcmp(self, CM1E_PRIVILEGED_COMMAND) != 0 && syscall(SYS_capget, &header, sets) == 0;
    if (asked && !(sets[0].effective & 1U << CAP_NET_RAW))
        execv(CM1E_PRIVILEGED_COMMAND, argv); /* it returns where the user may not, or none is installed */
}
#else
static void become_privileged(char **argv) { (void)argv; }
#endif

int main(int argc, char **argv)
{
    become_privileged(argv);
    program_invocation_name = program_invocation_short_name;
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_WRONG_USE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_usage(stdout);
        return finish(EXIT_OK);
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("cm1e %s\n", cm1e_version());
        return finish(EXIT_OK);
    }
    if (strcmp(argv[1], "--describe") == 0)
        return finish(describe(argc - 2, argv + 2));
    argp_err_exit_status = EXIT_WRONG_USE;
    atexit(finish_help);
    for (int i = 0; i < command_count; i++)
        if (strcmp(argv[1], commands[i].name) == 0) {
            char name[32];
            snprintf(name, sizeof name, "cm1e %s", commands[i].name);
            argv[1] = program_invocation_name = name;
            remember_words(commands[i].name, argc - 1, argv + 1);
            return finish(commands[i].run(argc - 1, argv + 1));
        }
    return complain_unknown(argv[1]);
}
