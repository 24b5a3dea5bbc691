/**
 * @file maintain.h
 * What others do to the axes of a running program with its consent (`control: maintain`): enable, jog, home, stop,
 * reset. Whoever moves or enables an axis holds it, and has to renew that: a motion that is not renewed in time is
 * ended by the cycle, power that is not renewed goes off. What a client holds ends with its connection. The program has
 * precedence (axis/axis_guest.h).
 */
#ifndef CM1E_CONTROL_MAINTAIN_H
#define CM1E_CONTROL_MAINTAIN_H

#include "axis/axis_guest.h"
#include "control/view.h"

typedef enum maintain_what {
    MAINTAIN_ENABLE = 0, MAINTAIN_DISABLE, MAINTAIN_JOG, MAINTAIN_HOME, MAINTAIN_STOP, MAINTAIN_RESET,
    MAINTAIN_KEEP,             /**< renews power and homing of all axes that the client holds */
    MAINTAIN_COUNT,
} maintain_what_t;

/** Why the cycle did not do it, beside what cm1e_guest_refusal_t says. */
typedef enum maintain_refusal {
    MAINTAIN_DONE = 0,
    MAINTAIN_BY_GUEST,         /**< `guest` says why */
    MAINTAIN_BY_AXIS,          /**< `error` of the axis */
    MAINTAIN_HELD,             /**< another client holds it */
    MAINTAIN_NOT_HELD,         /**< it is not enabled by a client, or does not move by one */
    MAINTAIN_MOVES,            /**< it jogs or homes already, otherwise */
    MAINTAIN_STOPPED,          /**< another client has stopped this jog */
    MAINTAIN_ENDING,           /**< the program ends */
} maintain_refusal_t;

typedef struct maintain_order {
    view_order_t order;
    maintain_what_t what;
    uint32_t client, axis;     /**< 0 = first */
    double velocity, acceleration;
    int64_t keep_ns;
    /* valid when decided */
    maintain_refusal_t refusal;
    cm1e_guest_refusal_t guest;
    cm1e_error_t error;
    cm1e_axis_state_t state;   /**< of the axis */
    cm1e_command_id_t command; /**< that was active; 0: none */
    cm1e_command_kind_t kind;
    uint32_t kept;             /**< axes that the client holds */
} maintain_order_t;

/** Decides on a maintain_order_t. @rt cycle */
void cm1e_maintain_decide(view_t *view, view_order_t *order);
/** Ends what was not renewed. @rt cycle */
void cm1e_maintain_cycle(view_t *view);
/** Of the thread: what this client holds ends. */
void cm1e_maintain_leave(view_t *view, uint32_t client);

#endif
