/**
 * @file manual.h
 * `cm1e --describe`: man pages and completions of shells, from the options that `--help` shows. The build calls it.
 */
#ifndef CM1E_TOOLS_MANUAL_H
#define CM1E_TOOLS_MANUAL_H

#define PROGRAM_SUMMARY \
    "Drives Myostat CM1-E servo motors, and Cool Muscle motors behind a bridge, over EtherCAT."

/** Words: man [COMMAND], bash, zsh, commands. Returns the exit status. */
int describe(int word_count, char **words);

#endif
