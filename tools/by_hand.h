/**
 * @file by_hand.h
 * jog, enable and reset of an axis of a running program, by requests to its control socket. What they print is what the
 * commands print that run the network themselves.
 */
#ifndef CM1E_TOOLS_BY_HAND_H
#define CM1E_TOOLS_BY_HAND_H

#include "attach.h"

typedef struct by_hand {
    const common_options_t *common;
    const char *axis_word;                 /**< name or number; NULL: the first one, of a reset all */
    double velocity, acceleration, dead_man_s; /**< of a jog */
    double seconds;                        /**< of enabling; 0: until a key */
} by_hand_t;

/** They close the connection, and return the exit status. */
int jog_attached(const by_hand_t *hand, cm1e_control_t *control);
int enable_attached(const by_hand_t *hand, cm1e_control_t *control);
int reset_attached(const by_hand_t *hand, cm1e_control_t *control);

#endif
