/**
 * @file io_rows.h
 * What `cm1e io` is asked for, and what it prints: the same of its own network and of that of another program.
 */
#ifndef CM1E_TOOLS_IO_ROWS_H
#define CM1E_TOOLS_IO_ROWS_H

#include "cm1e/control.h"
#include "cm1e/io.h"
#include "command.h"

enum { IO_WRITES_MAX = 16, IO_SIGNAL_NAME = 96, IO_INPUTS = 4, IO_USE = 256 };

/** An output to be written: NAME=VALUE. */
typedef struct io_write {
    const char *word, *equals;
    cm1e_io_t io;
    double value;
} io_write_t;

typedef struct io_options {
    common_options_t common;
    io_write_t writes[IO_WRITES_MAX];
    int write_count;
    bool allow, all;
    double seconds; /**< 0: not given */
} io_options_t;

/** The name of the signal of a write. */
void io_name(const io_write_t *write, char name[IO_SIGNAL_NAME]);

/** Rows of the two lists. `value` NULL: unknown. */
json_t *io_input_row(const char *axis, int input, json_t *value, const char *wired);
json_t *io_output_row(const char *axis, bool on);
/** `use`: how axes use it; "": none does. */
json_t *io_signal_row(int slave, const char *slave_name, const char *name, const char *type, bool output, bool of_axis,
                      const char *value, const char *use);
/** Adds " (normally closed)" and what else is to be said of a switch to `wired`. */
void io_add_switch(char *wired, size_t size, const char *name, bool normally_closed);

/** Prints both lists, and releases them. */
void io_print(json_t *axes, json_t *signals, bool json, bool simulated);

/** Lists those of the program that runs the network, and writes outputs that are none of its own, if it consents.
 *  Closes the connection. Returns the exit status. */
int io_attached(const io_options_t *options, cm1e_control_t *control);

#endif
