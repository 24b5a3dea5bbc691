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
#include "which_slave.h"

/** The common options, and --attach for options->attach. */
extern const struct argp_child attach_children[];

/** As load_configuration(); with --attach neither -i nor -b is needed. */
bool load_network(const common_options_t *options, cm1e_bus_config_t *config);

/** Opens the network and scans it, or attaches to the program that has it. After an error *bus is NULL. */
cm1e_error_t open_network(const common_options_t *options, const cm1e_bus_config_t *config, cm1e_bus_t **bus,
                          cm1e_diag_t *diag);

/** As run_on_slave(), but of a network that another program runs that program is asked. `where` NULL: `action` gets the
 *  position 0. */
int look_at_network(const common_options_t *common, const char *where, slave_action_t action, const void *options);
/** As look_at_network(), of a configuration from load_network(). */
int look_at_loaded(const common_options_t *common, const cm1e_bus_config_t *config, const char *where,
                   slave_action_t action, const void *options);

/** As open_network(), but our own network is not scanned: a damaged SII stops a scan. */
cm1e_error_t open_unscanned(const common_options_t *options, const cm1e_bus_config_t *config, cm1e_bus_t **bus,
                            cm1e_diag_t *diag);
/** Says no where another program runs the network, or with --attach: `what` ("Writing an SII") needs it for itself,
 *  `why` is half a sentence ("while it is written, the slave cannot ..."). CM1E_OK: nobody runs it, who could be
 *  asked. */
cm1e_error_t refuse_to_attach(const common_options_t *options, const cm1e_bus_config_t *config, const char *what,
                              const char *why, cm1e_diag_t *diag);

/** Opens the network, but does not scan it, after refuse_to_attach(). */
cm1e_error_t own_network(const common_options_t *options, const cm1e_bus_config_t *config, const char *what,
                         const char *why, cm1e_bus_t **bus, cm1e_diag_t *diag);

/** Connects to the program that runs the network; for commands that only make sense attached. */
cm1e_error_t connect_network(const common_options_t *options, const cm1e_bus_config_t *config,
                             cm1e_control_t **control, cm1e_diag_t *diag);

/** For commands that act on axes: *control is set if a program has the network, NULL if nobody has. `config` is empty
 *  afterwards. Returns the exit status, with a complaint. */
int attach_if_running(const common_options_t *options, cm1e_bus_config_t *config, cm1e_control_t **control);

/** Asks; takes the reference to `request`. Returns this member of the reply, which is the caller's; NULL: the program
 *  refuses or is gone, `diag` says why. */
json_t *ask_program(cm1e_control_t *control, json_t *request, const char *member, cm1e_diag_t *diag);

/** Which of several networks lost how many frames, by the program's `statistics`: " (left 3, right 1)"; "": it has one
 *  network, or lost none. */
void lost_by_network(const json_t *statistics, char *text, size_t size);

/** Which of the program's `axes` a word means, by name, else by number: counted from 1; 0: none. As find_axis(). */
size_t axis_of_program(const json_t *axes, const char *word);

/** Where an axis is found by its name: `config`; without a bus file the axes of the program that runs the network, if
 *  there is one, of which only name, slave, connector and whether there is a motor are known. */
const cm1e_bus_config_t *axes_to_name(const common_options_t *options, const cm1e_bus_config_t *config);

/** Says why nobody could attach to a run that was to have a control socket; it is no failure of the run. */
void complain_of_control(const cm1e_scheduler_t *scheduler);
/** Whether this run will have no control socket; complain_of_control() says why. */
bool has_no_socket(const cm1e_scheduler_statistics_t *statistics);

#endif
