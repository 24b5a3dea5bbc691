/**
 * @file attach.h
 * A network that another program runs: commands that look attach to that program instead of opening the network
 * themselves. The output is the same.
 */
#ifndef CM1E_TOOLS_ATTACH_H
#define CM1E_TOOLS_ATTACH_H

#include "cm1e/control.h"
#include "cm1e/scheduler.h"
#include "command.h"

/** Child parser with the option --attach, for options->attach; its input is a common_options_t. */
extern const struct argp attach_argp;

/** As load_configuration(); with --attach neither -i nor -b is needed. */
bool load_network(const common_options_t *options, cm1e_bus_config_t *config);

/** Opens the network and scans it, or attaches to the program that has it. After an error *bus is NULL. */
cm1e_error_t open_network(const common_options_t *options, const cm1e_bus_config_t *config, cm1e_bus_t **bus,
                          cm1e_diag_t *diag);

/** Connects to the program that runs the network; for commands that only make sense attached. */
cm1e_error_t connect_network(const common_options_t *options, const cm1e_bus_config_t *config,
                             cm1e_control_t **control, cm1e_diag_t *diag);

/** Says why nobody could attach to a run that was to have a control socket; it is no failure of the run. */
void complain_of_control(const cm1e_scheduler_t *scheduler);

#endif
