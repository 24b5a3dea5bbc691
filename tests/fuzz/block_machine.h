/**
 * @file block_machine.h
 * A machine for targets that call function blocks: a motor on the fake bus, a virtual axis, and a third one that is
 * virtual or an encoder; one axes group. In every cycle all blocks are called, and judged as the tests of the blocks
 * judge them (block_judge.h): outputs by PLCopen 2.4.1, states by figure 2, set-points within the limits of the axis
 * and without a jump. All values of an axis are finite, and every error has a text.
 */
#ifndef CM1E_TESTS_BLOCK_MACHINE_H
#define CM1E_TESTS_BLOCK_MACHINE_H

#include "block_judge.h"
#include "fake_bus.h"

enum { MACHINE_AXES = 3, MACHINE_BLOCKS = 24 };

typedef struct machine {
    cm1e_bus_t bus, others[MACHINE_AXES - 1];
    AXIS_REF_t named[MACHINE_AXES + 2];  /**< what a block may name: the axes, none, and a handle that nothing has */
    AXES_GROUP_REF_t group, no_group;
    MC_Power_t powers[MACHINE_AXES];
    instance_t blocks[MACHINE_BLOCKS];
    int count, first;                    /**< first: which block is called first */
    int lost;                            /**< cycles in which no frame comes back */
    uint32_t encoder;
    int32_t encoder_step;                /**< counts in a cycle */
} machine_t;
extern machine_t machine;

/** By the bits of `kind`: software limits, modulo, stop of a coupling, memory for cams, encoder. The axes are in
 *  Standstill. */
void machine_begin(unsigned kind);
void machine_end(void);

/** One more block for an axis, with inputs that make sense; NULL: there are too many. */
instance_t *machine_make(const char *name, int axis);

/** Any value for an input or a reference, from the bytes of an input. */
void machine_put(instance_t *fb, const block_member_t *member, const uint8_t **at, const uint8_t *end);

void machine_cycles(int count);

#endif
