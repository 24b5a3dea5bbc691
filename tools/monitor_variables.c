/* The variables of a program on the screen of `cm1e monitor`. */
#include <curses.h>
#include <string.h>

#include "command.h"
#include "monitor.h"
#include "variable_value.h"

enum { BAD = 2, NAME_SHARE = 2, TEXT_BYTES = 600 }; /* BAD: the pair of colours of monitor_screen.c */

void screen_draw_variables(const monitor_t *m, int line, int end)
{
    const int width = COLS / NAME_SHARE;
    attron(A_BOLD);
    mvprintw(line++, 2, "%-*.*s%s", width, width, "variable", "value");
    attroff(A_BOLD);
    if (json_array_size(m->variables) == 0)
        mvaddnstr(line, 2, "The program has no variables with names, or no more of them.", COLS - 3);
    for (size_t i = 0; i < json_array_size(m->variables) && line < end; i++, line++) {
        const json_t *variable = json_array_get(m->variables, i);
        const bool forced = json_is_true(json_object_get(variable, "forced"));
        char value[TEXT_BYTES], text[TEXT_BYTES + 16];
        variable_text(variable, value, sizeof value);
        snprintf(text, sizeof text, "%s%s", value, forced ? "  FORCED" : "");
        mvprintw(line, 2, "%-*.*s", width, width - 1, text_of(variable, "name"));
        if (forced)
            attron(COLOR_PAIR(BAD));
        mvaddnstr(line, 2 + width, text, COLS - 3 - width);
        if (forced)
            attroff(COLOR_PAIR(BAD));
    }
}

void screen_draw_forced(const monitor_t *m, int line)
{
    const size_t count = json_array_size(m->forced);
    char text[TEXT_BYTES] = "";
    if (count == 0)
        return;
    snprintf(text, sizeof text, "FORCED (%zu):", count);
    for (size_t i = 0; i < count; i++) {
        const size_t used = strlen(text);
        char value[TEXT_BYTES];
        variable_text(json_array_get(m->forced, i), value, sizeof value);
        snprintf(text + used, sizeof text - used, "%s %s = %.40s", i ? "," : "",
                 text_of(json_array_get(m->forced, i), "name"), value);
    }
    attron(COLOR_PAIR(BAD) | A_BOLD);
    mvaddnstr(line, 0, text, COLS - 1);
    attroff(COLOR_PAIR(BAD) | A_BOLD);
}
