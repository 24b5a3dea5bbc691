#include <curses.h>
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <term.h>
#include <unistd.h>

#include "attach.h"
#include "command.h"
#include "monitor.h"

/* Macros of term.h. */
#undef columns
#undef lines

enum { HEAD = 4, FOOT = 7, MESSAGE_LINES = 2, GOOD = 1, BAD, BUSY, ESCAPE_MS = 25, ESCAPE = 0x1B };

/* HEAD and FOOT: lines above and below the axes. */
#define LEAST_SHOWN 0.00005

/* ---- the terminal ------------------------------------------------------------------------------------------------ */

static SCREEN *terminal;

bool screen_check(void)
{
    const char *name = getenv("TERM");
    int why = 0;
    if (!isatty(STDIN_FILENO) || !isatty(STDOUT_FILENO)) {
        complain("monitor needs a terminal. Without one, `--json` prints what it would show, once");
        return false;
    }
    if (name && name[0] && setupterm(NULL, STDOUT_FILENO, &why) == OK && cursor_address)
        return true;
    if (!name || !name[0])
        complain("the environment does not say what terminal this is: set TERM, for example TERM=xterm");
    else
        complain("TERM=%s is not known here, or a terminal whose cursor cannot be moved: set it to what it is, for "
                 "example TERM=xterm, or install the package ncurses-term", name);
    return false;
}

bool screen_begin(void)
{
    if (terminal)
        return true;
    setlocale(LC_CTYPE, "");
    terminal = newterm(NULL, stdout, stdin);
    if (!terminal) {
        complain("the terminal cannot be used as a screen");
        return false;
    }
    atexit(screen_end);
    cbreak();
    noecho();
    nonl();
    keypad(stdscr, TRUE);
    nodelay(stdscr, TRUE);
    set_escdelay(ESCAPE_MS);
    curs_set(0);
    if (has_colors() && start_color() == OK && use_default_colors() == OK) {
        init_pair(GOOD, COLOR_GREEN, -1);
        init_pair(BAD, COLOR_RED, -1);
        init_pair(BUSY, COLOR_CYAN, -1);
    }
    return true;
}

void screen_end(void)
{
    if (!terminal)
        return;
    endwin();
    delscreen(terminal);
    terminal = NULL;
}

bool screen_is_usable(void) { return COLS >= SCREEN_COLUMNS && LINES >= SCREEN_LINES; }

/** The rest of an arrow key of a terminal that does not follow its description, or had not yet been told to. */
static int escaped_key(void)
{
    static const int keys[] = {SCREEN_UP, SCREEN_DOWN, SCREEN_RIGHT, SCREEN_LEFT};
    const int second = getch();
    if (second != '[' && second != 'O')
        return 0;
    const int third = getch();
    return third >= 'A' && third <= 'D' ? keys[third - 'A'] : 0;
}

int screen_key(void)
{
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
    const int key = getch();
    switch (key) {
    case ESCAPE: return escaped_key();
    case ERR:
        return poll(&input, 1, 0) > 0 && (input.revents & (POLLHUP | POLLERR | POLLNVAL)) ? SCREEN_GONE : SCREEN_NO_KEY;
    case KEY_LEFT: return SCREEN_LEFT;
    case KEY_RIGHT: return SCREEN_RIGHT;
    case KEY_UP: return SCREEN_UP;
    case KEY_DOWN: return SCREEN_DOWN;
    case KEY_RESIZE:
        clear();
        return 0;
    default: return key < KEY_MIN ? key : 0;
    }
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

/** NAN: it is not known. */
static double number_of(const json_t *object, const char *name)
{
    const json_t *value = json_object_get(object, name);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static json_int_t count_of(const json_t *object, const char *name)
{
    return json_integer_value(json_object_get(object, name));
}

static double us_of(const json_t *statistics, const char *distribution, const char *name)
{
    return number_of(json_object_get(statistics, distribution), name) * 1e-3;
}

static int colour_of(const json_t *axis)
{
    const char *state = text_of(axis, "state");
    if (strcmp(state, "ErrorStop") == 0)
        return BAD;
    return strcmp(state, "Disabled") == 0 ? 0 : strcmp(state, "Standstill") == 0 ? GOOD : BUSY;
}

/* ---- drawing ----------------------------------------------------------------------------------------------------- */

/** A bar of `width` columns for `part` (0 ... 1) of a range, empty where there is none. */
static void draw_bar(int line, int column, int width, const char *name, double part)
{
    char bar[64];
    const int inner = width - 2 - (int)strlen(name);
    if (inner < 4 || inner > (int)sizeof bar - 1 || column + width > COLS)
        return;
    const int place = isfinite(part) ? (int)(fmin(fmax(part, 0.0), 1.0) * (inner - 1) + 0.5) : -1;
    for (int i = 0; i < inner; i++)
        bar[i] = i == place ? '#' : place < 0 ? ' ' : '-';
    bar[inner] = '\0';
    mvprintw(line, column, "%s[%s]", name, bar);
}

/** Where a value is between -bound and bound. */
static double part_of(double value, double bound) { return bound > 0 ? 0.5 + 0.5 * value / bound : NAN; }

static void draw_bars(int line, const json_t *axis)
{
    const json_t *limits = json_object_get(axis, "limits");
    const double lower = number_of(limits, "lower"), upper = number_of(limits, "upper"),
                 modulo = number_of(axis, "modulo_range"), position = number_of(axis, "position");
    const double place = modulo > 0 ? position / modulo : upper > lower ? (position - lower) / (upper - lower) : NAN;
    const int width = (COLS - 4) / 4;
    draw_bar(line, 4, width, "pos", place);
    draw_bar(line, 4 + width, width, "vel", part_of(number_of(axis, "velocity"), number_of(limits, "velocity")));
    draw_bar(line, 4 + 2 * width, width, "lag", part_of(number_of(axis, "lag"), number_of(limits, "lag")));
    draw_bar(line, 4 + 3 * width, width, "trq", part_of(number_of(axis, "torque"), 100));
}

/** A value in a column of its own, while there is room for it. */
static int draw_value(int line, int column, int width, const char *format, double value)
{
    char text[32];
    if (column + width > COLS)
        return COLS;
    snprintf(text, sizeof text, format, fabs(value) < LEAST_SHOWN ? 0.0 : value); /* no -0.0000 */
    mvprintw(line, column, "%*s", width, isnan(value) ? "-" : text);
    return column + width;
}

static const struct {
    const char *name, *head, *format;
    int width;
} columns[] = {{"position", "position u", "%.4f", 14}, {"velocity", "u/s", "%.4f", 12}, {"lag", "lag u", "%.4f", 10},
               {"torque", "torque %", "%.1f", 10}};
enum { COLUMNS = sizeof columns / sizeof columns[0], NAME = 10, STATE = 19 };

static void draw_head_of_axes(int line)
{
    int column = 2 + NAME + STATE;
    attron(A_BOLD);
    mvprintw(line, 2, "%-*s%-*s", NAME, "axis", STATE, "state");
    for (int i = 0; i < COLUMNS && column + columns[i].width <= COLS; column += columns[i++].width)
        mvprintw(line, column, "%*s", columns[i].width, columns[i].head);
    attroff(A_BOLD);
}

static void draw_axis(int line, const json_t *axis, bool selected)
{
    const int colour = colour_of(axis);
    int column = 2 + NAME + STATE;
    if (selected)
        attron(A_REVERSE);
    mvprintw(line, 0, "%c %-*.*s", selected ? '>' : ' ', NAME - 1, NAME - 1, text_of(axis, "name"));
    if (selected)
        attroff(A_REVERSE);
    attron(COLOR_PAIR(colour));
    mvprintw(line, 2 + NAME, "%-*.*s", STATE, STATE - 1, text_of(axis, "state"));
    attroff(COLOR_PAIR(colour));
    for (int i = 0; i < COLUMNS; i++)
        column = draw_value(line, column, columns[i].width, columns[i].format, number_of(axis, columns[i].name));
}

/** From `line` on to `end`, broken at blanks. */
static void draw_text(int line, int end, const char *text)
{
    const size_t width = (size_t)COLS - 1;
    for (; line < end && *text; line++) {
        size_t length = strlen(text);
        if (length > width) {
            for (length = width; length > 0 && text[length] != ' ';)
                length--;
            length = length > 0 ? length : width;
        }
        mvaddnstr(line, 0, text, (int)length);
        text += length;
        text += strspn(text, " ");
    }
}

static void draw_program(const monitor_t *m)
{
    const json_t *s = m->statistics, *bus = json_object_get(s, "bus");
    char title[256];
    if (m->alone)
        snprintf(title, sizeof title, "cm1e monitor: %s", text_of(m->hello, "interface"));
    else
        snprintf(title, sizeof title, "cm1e monitor: %s (process %d) on %s, control: %s", text_of(m->hello, "program"),
                 (int)count_of(m->hello, "pid"), text_of(m->hello, "interface"), text_of(m->hello, "control"));
    attron(A_BOLD);
    mvaddnstr(0, 0, title, COLS - 1);
    attroff(A_BOLD);
    if (!s)
        return;
    const bool trouble = count_of(s, "overruns") > 0 || count_of(bus, "lost_frames") > 0 ||
                         count_of(bus, "working_counter_errors") > 0;
    char line[256];
    snprintf(line, sizeof line, "cycle %.0f us: %.0f ... %.0f us, latency mean %.0f, maximum %.0f us",
             (double)count_of(m->hello, "cycle_ns") * 1e-3, us_of(s, "cycle_time", "minimum_ns"),
             us_of(s, "cycle_time", "maximum_ns"), us_of(s, "wake_up_latency", "mean_ns"),
             us_of(s, "wake_up_latency", "maximum_ns"));
    mvaddnstr(1, 0, line, COLS - 1);
    char networks[128];
    lost_by_network(s, networks, sizeof networks);
    snprintf(line, sizeof line, "lost frames %lld%s  overruns %lld  working counter errors %lld  cycles %lld",
             (long long)count_of(bus, "lost_frames"), networks, (long long)count_of(s, "overruns"),
             (long long)count_of(bus, "working_counter_errors"), (long long)count_of(s, "cycles"));
    attron(COLOR_PAIR(trouble ? BAD : GOOD));
    mvaddnstr(2, 0, line, COLS - 1);
    attroff(COLOR_PAIR(trouble ? BAD : GOOD));
}

/** What the selected axis is commanded by, what is wrong with it, the message and the keys. */
static void draw_foot(const monitor_t *m, int line)
{
    const json_t *axis = json_array_get(m->axes, m->selected);
    const char *command = text_of(axis, "command"), *error = text_of(axis, "text");
    char about[512];
    snprintf(about, sizeof about, "%s: %s%s%s%s%s%s  jog %.4g u/s", text_of(axis, "name"),
             json_is_true(json_object_get(axis, "online")) ? "" : "offline, ",
             json_is_true(json_object_get(axis, "homed")) ? "homed" : "not homed", command[0] ? ", " : "", command,
             json_is_true(json_object_get(axis, "held")) ? ", held through the socket" : "",
             json_is_true(json_object_get(axis, "resetting")) ? ", is being reset" : "", m->velocity);
    if (line < LINES - 1 - MESSAGE_LINES)
        mvaddnstr(line, 0, about, COLS - 1);
    attron(COLOR_PAIR(BAD));
    draw_text(line + 1, LINES - 1 - MESSAGE_LINES, error);
    attroff(COLOR_PAIR(BAD));
    attron(A_BOLD);
    draw_text(LINES - 1 - MESSAGE_LINES, LINES - 1,
              m->asks_home ? "Home this axis? It moves. y: yes, any other key: no" : m->message);
    attroff(A_BOLD);
    attron(A_REVERSE);
    mvaddnstr(LINES - 1, 0, "up/down axis  e enable  <- -> hold to jog  [ ] speed  h home  space stop  r reset  v variables  q quit",
              COLS - 1);
    attroff(A_REVERSE);
}

static void draw_axes(const monitor_t *m, int line, int end)
{
    const size_t count = json_array_size(m->axes);
    const int room = end - line;
    const int lines = (int)count * 2 <= room ? 2 : 1;
    const size_t shown = room > 0 ? (size_t)(room / lines) : 1;
    const size_t first = m->selected >= shown ? m->selected - shown + 1 : 0;
    draw_head_of_axes(line - 1);
    for (size_t i = 0; i < shown && first + i < count; i++) {
        const json_t *axis = json_array_get(m->axes, first + i);
        draw_axis(line + (int)i * lines, axis, first + i == m->selected);
        if (lines == 2)
            draw_bars(line + (int)i * lines + 1, axis);
    }
}

void screen_draw(const monitor_t *m)
{
    /* The line of what is forced takes the place of an axis: nobody may overlook it. */
    const int head = HEAD + (json_array_size(m->forced) > 0), foot = LINES - FOOT > head ? LINES - FOOT : head + 1;
    erase();
    if (!screen_is_usable()) {
        mvprintw(0, 0, "%dx%d at least", SCREEN_COLUMNS, SCREEN_LINES);
        refresh();
        return;
    }
    draw_program(m);
    screen_draw_forced(m, HEAD - 1);
    if (m->shows_variables)
        screen_draw_variables(m, head - 1, foot);
    else
        draw_axes(m, head, LINES - FOOT);
    draw_foot(m, foot);
    refresh();
}
