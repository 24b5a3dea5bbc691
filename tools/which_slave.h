/**
 * @file which_slave.h
 * The slave of a word that a user gives to a command: a position, or a name of the bus file. A name means the device that
 * the bus file describes: where another one is found, the name is refused. A position means whatever is there;
 * a word of digits is a position, also where the bus file has a name of digits.
 */
#ifndef CM1E_TOOLS_WHICH_SLAVE_H
#define CM1E_TOOLS_WHICH_SLAVE_H

#include "command.h"

/** The axis of the configuration at a slave, and behind a bridge at a connector (1 ... 4; else 0); -1: none. */
int find_axis_at(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave, uint8_t channel);

/** Whether the word is a position: digits. */
bool is_position(const char *word);
/** false and a complaint: no slave can have this position. */
bool parse_position(const char *word, uint16_t *position);

/** The slave of a word after a scan: the name of an axis (not behind a bridge) or of a slave of the bus file, or a
 *  position. Returns the exit status, with a complaint: there is no such slave, or it is another device. */
int find_slave(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const char *word, uint16_t *position);
/** As find_slave(), and an axis may be behind a bridge: at the connector `*channel`; 0: it is not, or it is a position. */
int find_motor_of(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const char *word, uint16_t *position,
                  uint8_t *channel);
/** As find_slave(), of a network that is not scanned: a position is taken as it is, and a name is found by a scan. */
int find_slave_unscanned(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const char *word, uint16_t *position);

/** What a command does to one slave of a scanned network. It complains of its errors and returns the exit status. */
typedef int (*slave_action_t)(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *options,
                              uint16_t position);

/** Loads the configuration, opens and scans the network, finds the slave of the word `where`, acts on it with `options`,
 *  and closes the network. Returns the exit status. */
int run_on_slave(const common_options_t *common, const char *where, slave_action_t action, const void *options);

#endif
