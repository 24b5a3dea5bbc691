/** cm1e: the command line program. Each subcommand is a file cmd_<name>.c. */
#include <stdio.h>
#include <string.h>

#include "cm1e/version.h"
#include "command.h"

static const struct {
    const char *name, *summary;
    command_fn run;
} commands[] = {
    {"scan", "list the slaves of a network", command_scan},
    {"status", "show state, error and measurements of every drive", command_status},
    {"sdo", "read or write an object of a slave", command_sdo},
    {"cml", "send strings to a motor behind a Cool MUSCLE bridge", command_cml},
    {"sii", "read, write or show the EEPROM of a slave", command_sii},
    {"home", "home one axis", command_home},
    {"move", "move one axis", command_move},
    {"sim", "serve a simulated network on a network interface", command_sim},
    {"generate", "write files for other masters", command_generate},
    {"check", "check a file for other masters, from any source", command_check},
    {"diff", "compare a file with the live devices that it describes", command_diff},
    {"explain", "say what an error number or name means", command_explain},
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_usage(FILE *file)
{
    fputs("Usage: cm1e COMMAND [OPTION...]\n"
          "Drives Myostat CM1-E servo motors, and Cool Muscle motors behind a bridge, over EtherCAT.\n\n", file);
    for (int i = 0; i < COMMAND_COUNT; i++)
        fprintf(file, "  %-10s %s\n", commands[i].name, commands[i].summary);
    fputs("\n`cm1e COMMAND --help` shows a command's options. `-i sim` is a simulated network in this process,\n`-i "
          "eth1` a real one (it needs the right to open raw sockets).\n", file);
}

/* Output that was not written (a full disk, a closed pipe) is a failure. */
static int finish(int status)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return status;
    complain("cannot write to standard output");
    return status == EXIT_OK ? EXIT_FAILED : status;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_WRONG_USE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
        print_usage(stdout);
        return EXIT_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("cm1e %s\n", cm1e_version());
        return EXIT_OK;
    }
    argp_err_exit_status = EXIT_WRONG_USE;
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(argv[1], commands[i].name) == 0) {
            char name[32];
            snprintf(name, sizeof name, "cm1e %s", commands[i].name);
            argv[1] = program_invocation_name = name;
            return finish(commands[i].run(argc - 1, argv + 1));
        }
    fprintf(stderr, "cm1e: there is no command \"%s\"\n\n", argv[1]);
    print_usage(stderr);
    return EXIT_WRONG_USE;
}
