/**
 * @file wired_machine.h
 * A motor whose further inputs and outputs are bits of terminals, an encoder whose counts a terminal brings, and a
 * virtual axis, on axis_segment.h. The terminals can go away and come back.
 */
#ifndef CM1E_TESTS_WIRED_MACHINE_H
#define CM1E_TESTS_WIRED_MACHINE_H

#include "axis_segment.h"
#include "cm1e/plcopen.h"
#undef axis

enum { MOTOR = 0, WHEEL, LINE, AXES };                         /**< axes */
enum { SLAVE_MOTOR = 1, VALVES, SWITCHES, COUNTS, COUNTER };   /**< slaves */
enum { HOME = 11, LIMIT_POSITIVE, LIMIT_NEGATIVE, PART };      /**< inputs of the motor's axis */
enum { GLUE = 11, BLOWER };                                    /**< its outputs */
enum { LOST_CYCLES = 3 };
enum { BACK = 3000 }; /**< cycles after which a slave that went away is back */

extern AXIS_REF_t motor, wheel, line;

void describe_machine(void);
/** Adds a terminal behind the others, with so many inputs and outputs. */
cm1e_slave_config_t *add_slave(const char *name, cm1e_sim_slave_kind_t kind, unsigned in, unsigned out);
/** Opens the machine of describe_machine() and runs some cycles. */
void begin(void);
/** For a test that opens the machine itself. */
void take_references(void);
void enable_motor(void);
cm1e_command_id_t go(double velocity);

/** An input of the terminal `switches`, from 1 on. */
void set_input(int number, bool on);
/** The terminal is switched off and comes back by itself. */
void take_away(unsigned slave, unsigned ms);
/** The slave falls back to Safe-Operational, where its inputs go on to come. They are those of a slave that is not what
 *  the program expects: they count as away. The bus brings it back. A terminal with device emulation does it by a stray
 *  request alone. */
void fall_back(unsigned position);

/** What the master sends to an output. */
bool sent(const char *name);
WORD id_of(cm1e_error_t error);

#endif
