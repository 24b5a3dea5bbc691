/*
 * A jog panel in the terminal: MC_Jog behind keys, MC_Power and MC_Reset beside it, software limits at +-4 revolutions.
 *
 *     06_jog_panel -i sim
 *
 *     l or right arrow   forward, as long as the key repeats        e   power on, off
 *     h or left arrow    backwards                                  r   reset
 *     1 2 3              slow, fast, 3 u/s                          q   quit
 *     4 5                steps of 0.5 u, to multiples of 0.5 u      any other key: stop
 *
 * A terminal tells no release of a key, only that it repeats; so a button is held a while beyond its last character.
 * And a thread that reads a keyboard may die while a button is held: it shows that it lives, and the program in the
 * cycle lets both buttons fall when it no longer does. Whoever brings buttons over a network needs the same.
 *
 * Without a terminal the keys come from a script on standard input, one a line: key and for how many milliseconds,
 * `-` for none: "e 300", "l 1000", "- 500".
 */
#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "example.h"

#define MS INT64_C(1000000)

/* A key begins to repeat after about half a second, then comes many times a second. */
static const int64_t first_hold_ns = 700 * MS, next_hold_ns = 150 * MS, dead_ns = 200 * MS;

static example_t example;
static MC_Power_t power = {.Axis = &example.axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_Reset_t reset = {.Axis = &example.axis};
static MC_Jog_t jog = {.Axis = &example.axis, .Velocity = 3, .Acceleration = 50, .Position = 0.5};

/* ---- what panel and program tell each other ---------------------------------------------------------------------- */

static atomic_bool forward, backwards, enable, reset_asked, quit;
static atomic_int mode, alive;                      /* alive: counts as long as the panel lives */
static atomic_llong shown_position, shown_velocity; /* 0.001 u, 0.001 u/s */
static atomic_int shown_state, shown_error;

static void key(char c)
{
    if (c >= '1' && c <= '5')
        atomic_store(&mode, c - '1');
    else if (c == 'e')
        atomic_store(&enable, !atomic_load(&enable));
    else if (c == 'r')
        atomic_store(&reset_asked, true);
    else if (c == 'q')
        atomic_store(&quit, true);
}

/* ---- the program in the cycle ------------------------------------------------------------------------------------ */

typedef struct line {
    char key;
    int64_t duration_ns;
} line_t;
enum { LINES = 200 };
static line_t script[LINES];
static int lines;
static bool scripted;

/* The script uses the time of the cycle, so that it is the same on virtual time. */
static void play(int64_t now_ns)
{
    static int next;
    static int64_t until_ns;
    if (now_ns < until_ns)
        return;
    const char c = next < lines ? script[next].key : 'q';
    until_ns = now_ns + (next < lines ? script[next].duration_ns : 0);
    next++;
    atomic_store(&forward, c == 'l' || c == 'b'); /* b: both buttons, which no keyboard of a terminal can press */
    atomic_store(&backwards, c == 'h' || c == 'b');
    key(c);
    atomic_fetch_add(&alive, 1);
}

/* The panel has not responded for a while. */
static bool panel_is_dead(int64_t now_ns)
{
    static int alive_before;
    static int64_t alive_ns;
    const int now = atomic_load(&alive);
    if (now != alive_before || scripted)
        alive_ns = now_ns;
    alive_before = now;
    return now_ns - alive_ns > dead_ns;
}

static void show(void)
{
    cm1e_axis_info_t now;
    cm1e_axis_read(example.axis, &now);
    atomic_store(&shown_position, (long long)(now.actual_position * 1000));
    atomic_store(&shown_velocity, (long long)(now.actual_velocity * 1000));
    atomic_store(&shown_state, (int)now.state);
    atomic_store(&shown_error, jog.Error ? jog.ErrorID : power.Error ? power.ErrorID : 0);
}

static void program(void *context)
{
    (void)context;
    const int64_t now_ns = cm1e_scheduler_time_ns(example.scheduler);
    if (scripted)
        play(now_ns);
    const bool dead = panel_is_dead(now_ns);
    power.Enable = atomic_load(&enable) && !atomic_load(&quit);
    MC_Power(&power);
    reset.Execute = reset.Busy || atomic_exchange(&reset_asked, false);
    MC_Reset(&reset);
    if (!jog.Busy)
        jog.Mode = (E_JogMode)atomic_load(&mode);
    jog.JogForward = atomic_load(&forward) && !dead;
    jog.JogBackwards = atomic_load(&backwards) && !dead;
    MC_Jog(&jog);
    show();
    if (atomic_load(&quit) && !power.Status)
        example_finish(&example);
}

/* ---- the terminal ------------------------------------------------------------------------------------------------ */

static int64_t clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000 * MS + t.tv_nsec;
}

/* A button that is held until its time is over. */
typedef struct button {
    atomic_bool *down;
    int64_t until_ns;
} button_t;
static button_t buttons[] = {{&forward, 0}, {&backwards, 0}};

static void press(int which, int64_t now_ns)
{
    for (int i = 0; i < 2; i++) {
        const bool repeats = now_ns < buttons[i].until_ns;
        buttons[i].until_ns = i != which ? 0 : now_ns + (repeats ? next_hold_ns : first_hold_ns);
    }
}

/* Characters that came together; arrows are ESC [ C and ESC [ D. */
static void characters(const char *text, ssize_t length, int64_t now_ns)
{
    for (ssize_t i = 0; i < length; i++) {
        const bool arrow = text[i] == 27 && i + 2 < length && text[i + 1] == '[';
        const char c = arrow ? text[i += 2] : text[i];
        press(c == 'l' || (arrow && c == 'C') ? 0 : c == 'h' || (arrow && c == 'D') ? 1 : -1, now_ns);
        if (!arrow)
            key(c);
    }
}

static void print_status(void)
{
    static const char *const modes[] = {"slow", "fast", "3 u/s", "step 0.5", "multiple of 0.5"};
    const int error = atomic_load(&shown_error);
    const char *state = cm1e_axis_state_name((cm1e_axis_state_t)atomic_load(&shown_state));
    printf("\r%-16s %9.3f u %8.3f u/s  %-15s %s %-60.60s", state, (double)atomic_load(&shown_position) / 1000,
           (double)atomic_load(&shown_velocity) / 1000, modes[atomic_load(&mode)],
           atomic_load(&backwards) ? "<" : atomic_load(&forward) ? ">" : " ",
           error ? cm1e_strerror(cm1e_error_from_id((WORD)error)) : "");
    fflush(stdout);
}

static void *panel(void *context)
{
    (void)context;
    struct pollfd keyboard = {.fd = STDIN_FILENO, .events = POLLIN};
    while (!atomic_load(&quit)) {
        char text[64];
        const int64_t now_ns = clock_ns();
        if (poll(&keyboard, 1, 20) > 0) {
            const ssize_t length = read(STDIN_FILENO, text, sizeof text);
            if (length <= 0)
                atomic_store(&quit, true); /* the terminal is gone */
            characters(text, length, now_ns);
        }
        for (int i = 0; i < 2; i++)
            atomic_store(buttons[i].down, now_ns < buttons[i].until_ns);
        atomic_fetch_add(&alive, 1);
        print_status();
    }
    return NULL;
}

static cm1e_error_t run_with_terminal(cm1e_diag_t *why)
{
    struct termios before, raw;
    pthread_t thread;
    tcgetattr(STDIN_FILENO, &before);
    raw = before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO); /* Ctrl-C stays what it is */
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    puts("l, h: forward, backwards   1 ... 5: mode   e: power   r: reset   q: quit   other keys: stop");
    const bool made = pthread_create(&thread, NULL, panel, NULL) == 0;
    const cm1e_error_t error = example_run(&example, program, why);
    atomic_store(&quit, true);
    if (made)
        pthread_join(thread, NULL);
    tcsetattr(STDIN_FILENO, TCSANOW, &before);
    putchar('\n');
    return error;
}

/* ---- a script instead -------------------------------------------------------------------------------------------- */

static bool read_script(void)
{
    char text[80];
    for (int number = 1; fgets(text, sizeof text, stdin); number++) {
        char c, rest;
        long long ms = 0;
        const int fields = sscanf(text, " %c %lld %c", &c, &ms, &rest);
        if (fields <= 0 || c == '#')
            continue;
        if (fields != 2 || ms < 0 || ms > 600000 || lines == LINES) {
            fprintf(stderr, "line %d: expected a key and milliseconds (0 ... 600000), at most %d lines\n", number,
                    LINES);
            return false;
        }
        script[lines++] = (line_t){c, ms * MS};
    }
    return true;
}

static void limits(cm1e_axis_config_t *axis)
{
    axis->software_limit_negative = -4;
    axis->software_limit_positive = 4;
    axis->jog_slow = 1;
    axis->jog_fast = 8;
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example.describe = limits;
    example_options(&example, argc, argv, "A jog panel in the terminal; without one, keys from a script.");
    scripted = !isatty(STDIN_FILENO);
    if (scripted && !read_script())
        return EXIT_FAILURE;
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK)
        error = scripted ? example_run(&example, program, &why) : run_with_terminal(&why);
    printf("the axis is at %.3f u\n", (double)atomic_load(&shown_position) / 1000);
    example.finished = true; /* a panel does not end by itself: Ctrl-C and a closed terminal end it like q */
    return example_end(&example, error, &why, true);
}
