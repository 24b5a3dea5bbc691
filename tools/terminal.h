/**
 * @file terminal.h
 * Keys of a person at a terminal: read one by one and not echoed, while a program of function blocks runs.
 */
#ifndef CM1E_TOOLS_TERMINAL_H
#define CM1E_TOOLS_TERMINAL_H

#include <stdbool.h>

/** Standard input and standard error are a terminal. */
bool at_a_terminal(void);

/** Keys come one by one from now on, until terminal_end() or the end of the process. */
bool terminal_begin(void);
void terminal_end(void);

enum { TERMINAL_NONE = 0, TERMINAL_LEFT = 0x100, TERMINAL_RIGHT, TERMINAL_UP, TERMINAL_DOWN, TERMINAL_GONE };

/** The next key within `timeout_ms`: a byte, one of the arrows, NONE, or GONE: the terminal was closed. */
int terminal_key(int timeout_ms);

#endif
