#include "jog_keys.h"

#include <math.h>
#include <stdio.h>

#include "terminal.h"

enum { ESCAPE = 0x1B, CTRL_D = 0x04, KEY_SLOW = '[', KEY_FAST = ']' };

static void take(jog_keys_t *keys, int key)
{
    switch (key) {
    case TERMINAL_RIGHT: case TERMINAL_UP: case '+': case 'l':
        keys->forward++;
        keys->sign = 1;
        break;
    case TERMINAL_LEFT: case TERMINAL_DOWN: case '-': case 'h':
        keys->backwards++;
        keys->sign = -1;
        break;
    case KEY_FAST: keys->factor = fmin(keys->factor * 2, 4); break;
    case KEY_SLOW: keys->factor = fmax(keys->factor / 2, 1.0 / 64); break;
    case 'q': case TERMINAL_GONE: case ESCAPE: case CTRL_D: keys->end = true; break;
    default: break;
    }
}

void jog_keys_read(jog_keys_t *keys, int timeout_ms)
{
    keys->sign = 0;
    for (int key; (key = terminal_key(timeout_ms)) != TERMINAL_NONE;) {
        take(keys, key);
        if (key == TERMINAL_GONE)
            break;
    }
}

void jog_line(const char *name, double position, bool moves, double velocity)
{
    fprintf(stderr, "\r\033[K%s: %12.6g  %s  %.4g u/s  arrow keys move, [ ] slower and faster, q ends", name, position,
            moves ? "moves  " : "at rest", velocity);
    fflush(stderr);
}

void jog_line_clear(void)
{
    fputs("\r\033[K", stderr);
    fflush(stderr);
}
