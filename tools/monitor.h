/**
 * @file monitor.h
 * The screen of `cm1e monitor`, and what it knows of the program that it looks at. All of it comes through the control
 * socket, also where that program is this one.
 */
#ifndef CM1E_TOOLS_MONITOR_H
#define CM1E_TOOLS_MONITOR_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

#include "cm1e/control.h"

typedef struct monitor {
    cm1e_control_t *control;
    json_t *hello, *axes, *statistics; /**< the last replies; NULL: none yet */
    json_t *forced, *variables;        /**< variables that somebody forces; those of the page */
    bool shows_variables;              /**< instead of the axes */
    size_t first_variable;             /**< of the page */
    size_t selected;                   /**< axis, 0 = first */
    double velocity, acceleration;     /**< of a jog; u/s, u/s2 */
    bool alone;                        /**< the program that runs the network is this one */
    bool asks_home;                    /**< whether to home is asked, and the next key answers */
    bool quit;
    bool holds;                        /**< something is enabled, or moves, through this connection */
    int64_t looked_ns, judged_ns;      /**< when axes and statistics were asked for last */
    char message[sizeof((cm1e_diag_t *)0)->text];                 /**< what became of the last key */
} monitor_t;

enum { SCREEN_COLUMNS = 40, SCREEN_LINES = 8 }; /**< smaller terminals show nothing */

/** Asks; the text of an error becomes the message. `member` of the reply, which is the caller's, or NULL. */
json_t *monitor_ask(monitor_t *monitor, json_t *request, const char *member, cm1e_diag_t *diag);

/** The terminal can be a screen; false, with a complaint: it cannot. */
bool screen_check(void);
/** Takes over the terminal; false, with a complaint: it cannot be done. */
bool screen_begin(void);
/** Gives it back; again: nothing happens. */
void screen_end(void);
/** It is large enough to show what keys do. */
bool screen_is_usable(void);
void screen_draw(const monitor_t *monitor);
/** Lines from `line` to `end` with variables and their values. */
void screen_draw_variables(const monitor_t *monitor, int line, int end);
/** One line with the variables that somebody forces; nothing, if there are none. */
void screen_draw_forced(const monitor_t *monitor, int line);

enum { SCREEN_NO_KEY = -1, SCREEN_GONE = -2, SCREEN_LEFT = 0x1000, SCREEN_RIGHT, SCREEN_UP, SCREEN_DOWN };
/** The next key: a byte, or one of these. GONE: the terminal was closed. */
int screen_key(void);

#endif
