/**
 * @file overlap.h
 * Overlapped process data: in the frame the inputs of a slave take the place of its outputs, so the longer of both
 * counts.
 *
 * A slave that does not answer returns its own outputs there. So nothing is taken that came back as it was sent: each
 * slave has bytes of its inputs, up to CM1E_OVERLAP_OWN_BYTES, that no output covers, and they leave with the marker.
 * And no output comes back by which a frame is known again. So each frame ends with the number of its cycle, which no
 * slave is mapped to.
 */
#ifndef CM1E_BUS_OVERLAP_H
#define CM1E_BUS_OVERLAP_H

#include "bus/soem_adapter.h"
#include "cm1e/bus.h"

enum { CM1E_OVERLAP_OWN_BYTES = 4, CM1E_OVERLAP_NUMBER_BYTES = 4 };

typedef struct cm1e_overlap {
    bool used;
    unsigned frames;
    uint32_t ends[CM1E_PROCESS_FRAMES_MAX]; /**< of the data of each frame in the image; the number is behind them */
    uint32_t number;                        /**< of the cycle that was sent last */
} cm1e_overlap_t;

struct cm1e_bus_slave;

/** Places the process data of all slaves, which are mapped one behind the other, and moves their FMMUs there. */
cm1e_error_t cm1e_overlap_map(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Bytes of the image, with the numbers of the frames. */
size_t cm1e_overlap_bytes(const cm1e_bus_t *bus);
/** Makes the image of a cycle from the outputs. @rt cycle */
void cm1e_overlap_fill(cm1e_bus_t *bus);
/** Gives the frames their number, and keeps what leaves. @rt cycle */
void cm1e_overlap_seal(cm1e_bus_t *bus);
/** Whether the image that came back is an answer to what was sent. @rt cycle */
bool cm1e_overlap_is_answer(const cm1e_bus_t *bus);
/** Whether the inputs of a slave came back as they were sent. @rt cycle */
bool cm1e_overlap_is_echo(const cm1e_bus_t *bus, const struct cm1e_bus_slave *slave);
/** Whether that is so of a motor, which never has these inputs. @rt cycle */
bool cm1e_overlap_has_echo(const cm1e_bus_t *bus);
/** Takes the inputs of all slaves. @rt cycle */
void cm1e_overlap_take_inputs(cm1e_bus_t *bus);

#endif
