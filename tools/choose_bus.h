/**
 * @file choose_bus.h
 * Which bus of a bus file with several a command means.
 */
#ifndef CM1E_TOOLS_CHOOSE_BUS_H
#define CM1E_TOOLS_CHOOSE_BUS_H

#include "command.h"

/** The words of the command line. One that is the name of an axis chooses the bus of that axis. */
void remember_words(const char *command, int argc, char **argv);

/** Loads the bus that the options and words mean: --network, else the interface of -i, else the name of an axis among
 *  the words. Without any of these, a command that only shows things shows every bus in turn: the function forks, and
 *  returns once in each child. Else it complains, names the buses, and returns false. */
bool load_chosen_bus(const common_options_t *options, cm1e_bus_config_t *config);

#endif
