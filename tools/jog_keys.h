/**
 * @file jog_keys.h
 * The keys of `cm1e jog`, and the line that it shows.
 */
#ifndef CM1E_TOOLS_JOG_KEYS_H
#define CM1E_TOOLS_JOG_KEYS_H

#include <stdbool.h>

typedef struct jog_keys {
    unsigned forward, backwards; /**< how often these keys came */
    int sign;                    /**< of the last read: 1, -1; 0: no key to move */
    double factor;               /**< of the velocity */
    bool end;
} jog_keys_t;

/** Takes the keys that wait; the first of them is waited for. */
void jog_keys_read(jog_keys_t *keys, int timeout_ms);
void jog_line(const char *name, double position, bool moves, double velocity);
void jog_line_clear(void);

#endif
