/**
 * @file stream_link.h
 * What a control and the bus tell each other: a struct without pointers, which two threads or two processes share. A
 * control (LinuxCNC, ROS 2) has a servo loop of its own. In each of its periods it puts one command and takes the
 * newest state; the cycle of the bus does the opposite. Both directions are rings for one writer and one reader: they
 * never wait, and what does not fit is refused and counted. Needs no other header of cm1e.
 */
#ifndef CM1E_STREAM_LINK_H
#define CM1E_STREAM_LINK_H

#include <stdatomic.h>
#include <stddef.h>

#include "stream_types.h"

enum {
    STREAM_VERSION = 2,
    STREAM_NAME = 48,
    STREAM_TEXT = 1024,
    STREAM_DEPTH = 64,     /**< places of a ring; a power of 2 */
};

/** A signal of a slave without a motor. */
typedef struct stream_signal {
    char name[STREAM_NAME];     /**< "slave.signal", of a-z, 0-9, - and . */
    bool bit;                   /**< false: a number */
} stream_signal_t;

typedef enum stream_phase {
    STREAM_STARTING = 0,
    STREAM_RUNNING,             /**< the description is complete, and the bus runs */
    STREAM_ENDED,               /**< `text` says why */
} stream_phase_t;

/** Places that were written and read; each is written by one side. */
typedef struct stream_ends {
    _Alignas(64) _Atomic uint32_t written;
    _Atomic uint32_t refused;
    _Alignas(64) _Atomic uint32_t taken;
} stream_ends_t;

typedef struct stream_link {
    uint32_t version, bytes;    /**< STREAM_VERSION and the size of this struct: both sides must have the same */
    _Atomic int phase;          /**< stream_phase_t */
    _Atomic int quit;           /**< not 0: the bus stops in order */
    /* written before the phase is STREAM_RUNNING */
    int64_t cycle_ns;           /**< of the bus */
    int64_t period_ns;          /**< of the control; 0: as the cycle. Written by the control before it starts the bus */
    uint32_t axis_count, input_count, output_count;
    char axis_names[STREAM_AXES][STREAM_NAME];
    uint32_t digital_outputs[STREAM_AXES]; /**< number of outputs of each motor */
    stream_signal_t inputs[STREAM_SIGNALS], outputs[STREAM_SIGNALS];
    char text[STREAM_TEXT];     /**< why it has ended */
    stream_ends_t command_ends, state_ends;
    stream_command_t commands[STREAM_DEPTH];
    stream_state_t states[STREAM_DEPTH];
} stream_link_t;

/** Makes an empty link. @rt init */
void stream_link_init(stream_link_t *link, int64_t period_ns);
/** Puts a command. false: the bus does not take them. Of the control, any thread with a period. */
bool stream_put_command(stream_link_t *link, const stream_command_t *command);
/** Takes the next command. false: there is none. Of the bus, in the cycle. */
bool stream_take_command(stream_link_t *link, stream_command_t *command);
/** Puts a state. false: the control does not take them, which does no harm. Of the bus, in the cycle. */
bool stream_put_state(stream_link_t *link, const stream_state_t *state);
/** Takes the newest state. false: there is no new one. Of the control. */
bool stream_take_state(stream_link_t *link, stream_state_t *state);

#endif
