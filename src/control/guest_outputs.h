/**
 * @file guest_outputs.h
 * What others do to outputs of slaves without a motor, with the program's consent (`control: maintain`). An output
 * that the program has found belongs to it and is refused. Whoever sets another one holds it and has to renew that: an
 * output that is not renewed in time has its safe value again (0 without one), and so have those of a client that is
 * gone and of a run that ends.
 */
#ifndef CM1E_CONTROL_GUEST_OUTPUTS_H
#define CM1E_CONTROL_GUEST_OUTPUTS_H

#include <stdatomic.h>

#include "bus/io_guest.h"

enum { CM1E_GUEST_OUTPUTS = 64 };

/** The cycle's. */
typedef struct guest_output {
    bool held;
    uint32_t client;           /**< its place, 0 = first */
    cm1e_io_t io;
    int64_t until_ns;
} guest_output_t;

typedef struct guest_outputs {
    guest_output_t outputs[CM1E_GUEST_OUTPUTS];
    uint32_t count;            /**< of those that are held */
    _Atomic uint32_t gone;     /**< a bit for each client that is gone */
} guest_outputs_t;

/** Why the cycle did not do it. */
typedef enum output_refusal {
    OUTPUT_DONE = 0,
    OUTPUT_BY_BUS,             /**< cm1e_io_set_real() has refused the value */
    OUTPUT_HELD,               /**< another client holds it */
    OUTPUT_OFFLINE,            /**< its slave does not take part */
    OUTPUT_FULL,
    OUTPUT_ENDING,             /**< the program ends */
} output_refusal_t;

/** @rt cycle */
output_refusal_t cm1e_guest_output_set(guest_outputs_t *outputs, uint32_t client, const cm1e_io_t *io, double value,
                                       int64_t until_ns);
/** Gives it its safe value and lets go of it, if this client holds it. @rt cycle */
void cm1e_guest_output_release(guest_outputs_t *outputs, uint32_t client, const cm1e_io_t *io);
/** Ends what was not renewed; `ending`: all. @rt cycle */
void cm1e_guest_outputs_cycle(guest_outputs_t *outputs, int64_t now_ns, bool ending);
/** Of the thread: what this client holds ends. */
void cm1e_guest_outputs_leave(guest_outputs_t *outputs, uint32_t client);

#endif
