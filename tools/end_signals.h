/**
 * @file end_signals.h
 * Signals that would end this program: a command that must leave something in order ends it itself.
 */
#ifndef CM1E_TOOLS_END_SIGNALS_H
#define CM1E_TOOLS_END_SIGNALS_H

#include <stdbool.h>

/** From now on SIGINT, SIGTERM, SIGQUIT and SIGHUP only make told_to_end() true. Behind nohup a terminal that is closed
 *  still ends nothing. */
void catch_signals(void);
bool told_to_end(void);

#endif
