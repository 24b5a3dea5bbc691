#include "io_rows.h"
#include "core/json_text.h"

#include <stdio.h>
#include <string.h>

void io_name(const io_write_t *write, char name[IO_SIGNAL_NAME])
{
    snprintf(name, IO_SIGNAL_NAME, "%.*s", (int)(write->equals - write->word), write->word);
}

void io_add_switch(char *wired, size_t size, const char *name, bool normally_closed)
{
    const size_t used = strlen(wired);
    snprintf(wired + used, size - used, "%s%s%s", used ? ", " : "", name, normally_closed ? " (normally closed)" : "");
}

json_t *io_input_row(const char *axis, int input, json_t *value, const char *wired)
{
    return json_pack("{s:s, s:i, s:o, s:s}", "axis", axis, "input", input, "value", value ? value : json_null(),
                     "wired", wired);
}

json_t *io_output_row(const char *axis, bool on)
{
    return json_pack("{s:s, s:i, s:b}", "axis", axis, "output", 1, "value", on);
}

json_t *io_signal_row(int slave, const char *slave_name, const char *name, const char *type, bool output, bool of_axis,
                      const char *value, const char *use)
{
    return json_pack("{s:i, s:s, s:o, s:s, s:b, s:b, s:s, s:o}", "slave", slave, "slave_name", slave_name, "name",
                     cm1e_json_text(name), "type", type, "output", output, "of_axis", of_axis, "value", value, "use",
                     cm1e_json_text(use));
}

/* ---- as text ----------------------------------------------------------------------------------------------------- */

enum { SIGNAL_WIDTH = 48 }; /* of the first column */

static void print_axis_row(const json_t *row)
{
    const json_t *input = json_object_get(row, "input"), *value = json_object_get(row, "value");
    const char *axis = text_of(row, "axis"), *wired = text_of(row, "wired");
    char name[CM1E_NAME_LENGTH + 48];
    if (input)
        snprintf(name, sizeof name, "%s.IN%d%s%s", axis, (int)json_integer_value(input), wired[0] ? "  " : "", wired);
    else
        snprintf(name, sizeof name, "%s.OUT1", axis);
    printf("%-*s %-6s %-4s %s\n", in_bytes(SIGNAL_WIDTH, name), name, "BOOL", input ? "in" : "out",
           json_is_null(value) ? "-" : json_is_true(value) ? "1" : "0");
}

/** "valves.clamp", "2.Output 1" */
static void print_signal_row(const json_t *row)
{
    const char *slave = text_of(row, "slave_name");
    char position[16], name[IO_SIGNAL_NAME + CM1E_NAME_LENGTH];
    snprintf(position, sizeof position, "%d", (int)json_integer_value(json_object_get(row, "slave")));
    snprintf(name, sizeof name, "%s.%s", slave[0] ? slave : position, text_of(row, "name"));
    const char *use = text_of(row, "use");
    printf("%-*s %-6s %-4s %s%s%s\n", in_bytes(SIGNAL_WIDTH, name), name, text_of(row, "type"),
           json_is_true(json_object_get(row, "output")) ? "out" : "in", text_of(row, "value"), use[0] ? "    " : "", use);
}

void io_print(json_t *axes, json_t *signals, bool json, bool simulated)
{
    size_t i;
    json_t *row;
    if (json) {
        print_json(json_pack("{s:o, s:o, s:b}", "axes", axes, "signals", signals, "simulated", simulated));
        return;
    }
    json_array_foreach (axes, i, row)
        print_axis_row(row);
    json_array_foreach (signals, i, row)
        print_signal_row(row);
    json_decref(axes);
    json_decref(signals);
}
