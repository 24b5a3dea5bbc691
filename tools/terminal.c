#include "terminal.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

static struct termios before;
static bool changed;

bool at_a_terminal(void) { return isatty(STDIN_FILENO) && isatty(STDERR_FILENO); }

void terminal_end(void)
{
    if (changed)
        tcsetattr(STDIN_FILENO, TCSADRAIN, &before);
    changed = false;
}

/* Ctrl-C stays a signal, which stops the run in order. */
bool terminal_begin(void)
{
    struct termios raw;
    if (tcgetattr(STDIN_FILENO, &before) != 0)
        return false;
    raw = before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
    raw.c_cc[VMIN] = 1;
    raw.c_cc[VTIME] = 0;
    if (tcsetattr(STDIN_FILENO, TCSADRAIN, &raw) != 0)
        return false;
    changed = true;
    atexit(terminal_end);
    return true;
}

/** One byte; -1: none came in time; -2: the terminal is gone. */
static int next_byte(int timeout_ms)
{
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
    const int ready = poll(&input, 1, timeout_ms);
    if (ready <= 0)
        return ready < 0 && errno != EINTR ? -2 : -1;
    unsigned char byte;
    const ssize_t bytes = read(STDIN_FILENO, &byte, 1);
    return bytes == 1 ? byte : bytes < 0 && (errno == EINTR || errno == EAGAIN) ? -1 : -2;
}

int terminal_key(int timeout_ms)
{
    enum { ESCAPE = 0x1B, FOLLOWS_MS = 5 };
    const int byte = next_byte(timeout_ms);
    if (byte != ESCAPE)
        return byte == -1 ? TERMINAL_NONE : byte == -2 ? TERMINAL_GONE : byte;
    const int second = next_byte(FOLLOWS_MS);
    if (second != '[' && second != 'O')
        return ESCAPE;
    switch (next_byte(FOLLOWS_MS)) {
    case 'A': return TERMINAL_UP;
    case 'B': return TERMINAL_DOWN;
    case 'C': return TERMINAL_RIGHT;
    case 'D': return TERMINAL_LEFT;
    default: return TERMINAL_NONE;
    }
}
