/**
 * @file fake_wire.h
 * A backend for tests of the nic room alone: a line or ring of very simple slaves on virtual time, with cables that can
 * be cut. Each slave has a few registers, one byte of output and one of input in a logical image
 * [outputs of slaves 1 ... n][inputs of slaves 1 ... n]. It shares no code with the nic room or the simulator.
 */
#ifndef CM1E_TEST_FAKE_WIRE_H
#define CM1E_TEST_FAKE_WIRE_H

#include <string.h>

#include "nic/frame_queue.h"
#include "nic/nic_private.h"

enum { WIRE_SLAVES = 4, WIRE_BASE_NS = 10000, WIRE_SLAVE_NS = 1000, WIRE_REGISTERS = 64, WIRE_STATION = 0x1001 };

typedef struct fake_slave {
    uint8_t registers[WIRE_REGISTERS];
    uint8_t output, input;
    int frames;     /**< processed */
    int writes;     /**< by position or station address */
} fake_slave_t;

typedef struct fake_wire {
    int slaves;
    fake_slave_t slave[WIRE_SLAVES + 1];  /**< 1 = first */
    bool cut[WIRE_SLAVES + 2];            /**< cable before slave n; WIRE_SLAVES + 1: behind the last */
    bool mute;                            /**< answers are lost */
    bool refuse;                          /**< send fails */
    int sent[2];
    cm1e_clock_t clock;
    frame_queue_t queue;
} fake_wire_t;

extern fake_wire_t wire;

/** A fresh wire with WIRE_SLAVES slaves: a line (the last cable is open) or a ring. */
cm1e_nic_t *wire_start(bool ring);

#endif
