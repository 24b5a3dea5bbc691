/* cm1e io at a running program. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "attach.h"
#include "core/clock.h"
#include "core/json_text.h"
#include "end_signals.h"
#include "io_rows.h"

enum { OBJ_DIGITAL_OUTPUTS = 0x60FE, KEEP_MS = 1000, PAUSE_US = 100000 };

typedef struct told {
    json_t *hello, *axes, *signals;
    cm1e_diag_t diag;
} told_t;

static json_t *ask(cm1e_control_t *control, const char *name, cm1e_diag_t *diag)
{
    return ask_program(control, json_pack("{s:s}", "request", name), name, diag);
}

static int number_of(const json_t *object, const char *name)
{
    return (int)json_integer_value(json_object_get(object, name));
}

/* ---- lists ------------------------------------------------------------------------------------------------------- */

static void add_inputs(json_t *rows, const json_t *axis)
{
    const json_t *inputs = json_object_get(axis, "inputs"), *switches = json_object_get(axis, "switches");
    for (int n = 1; n <= IO_INPUTS; n++) {
        char wired[96] = "";
        for (size_t i = 0; i < json_array_size(switches); i++) {
            const json_t *row = json_array_get(switches, i);
            if (number_of(row, "input") == n)
                io_add_switch(wired, sizeof wired, text_of(row, "name"),
                              json_is_true(json_object_get(row, "normally_closed")));
        }
        json_t *value = json_is_integer(inputs) ? json_boolean(json_integer_value(inputs) >> (n - 1) & 1) : NULL;
        json_array_append_new(rows, io_input_row(text_of(axis, "name"), n, value, wired));
    }
}

/** The output of a CM1-E, as it is sent (UG 7.3.25: bit 0). */
static void add_output(json_t *rows, const json_t *axis, const json_t *signals)
{
    for (size_t i = 0; i < json_array_size(signals) && number_of(axis, "channel") == 0; i++) {
        const json_t *signal = json_array_get(signals, i);
        if (json_is_true(json_object_get(signal, "output")) && number_of(signal, "index") == OBJ_DIGITAL_OUTPUTS &&
            number_of(signal, "slave") == number_of(axis, "slave"))
            json_array_append_new(rows, io_output_row(text_of(axis, "name"), number_of(signal, "value") & 1));
    }
}

static json_t *axis_rows(const told_t *told)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < json_array_size(told->axes); i++) {
        const json_t *axis = json_array_get(told->axes, i);
        if (strcmp(text_of(axis, "type"), "motor") != 0)
            continue;
        add_inputs(rows, axis);
        add_output(rows, axis, told->signals);
    }
    return rows;
}

static void print_value(const json_t *value, char *text, size_t size)
{
    if (json_is_integer(value))
        snprintf(text, size, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
    else if (json_is_real(value))
        snprintf(text, size, "%.6g", json_real_value(value));
    else
        snprintf(text, size, "-");
}

static json_t *signal_rows(const told_t *told, bool all)
{
    json_t *rows = json_array();
    for (size_t i = 0; i < json_array_size(told->signals); i++) {
        const json_t *signal = json_array_get(told->signals, i);
        const bool of_axis = json_is_true(json_object_get(signal, "of_axis"));
        char value[IO_SIGNAL_NAME];
        print_value(json_object_get(signal, "value"), value, sizeof value);
        if (all || !of_axis)
            json_array_append_new(rows, io_signal_row(number_of(signal, "slave"), text_of(signal, "slave_name"),
                                                      text_of(signal, "name"), text_of(signal, "type"),
                                                      json_is_true(json_object_get(signal, "output")), of_axis, value,
                                                      text_of(signal, "use")));
    }
    return rows;
}

static int list(const io_options_t *options, cm1e_control_t *control)
{
    told_t told = {0};
    told.hello = ask(control, "hello", &told.diag);
    told.axes = told.hello ? ask(control, "axes", &told.diag) : NULL;
    told.signals = told.axes ? ask(control, "io", &told.diag) : NULL;
    const bool complete = told.signals != NULL, simulated = strncmp(text_of(told.hello, "interface"), "sim", 3) == 0;
    if (complete)
        io_print(axis_rows(&told), signal_rows(&told, options->all), options->common.json, simulated);
    if (complete && simulated && !options->common.json)
        puts("simulated network: no real device");
    json_decref(told.hello);
    json_decref(told.axes);
    json_decref(told.signals);
    return complete ? EXIT_OK : fail(&told.diag);
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

/** Sets all outputs, or renews them; `check`: only asks whether they may be written at all. `*set` counts them. */
static bool set_all(const io_options_t *options, cm1e_control_t *control, bool check, long *set, cm1e_diag_t *diag)
{
    bool good = true;
    for (int i = 0; i < options->write_count && good; i++) {
        char name[IO_SIGNAL_NAME];
        io_name(&options->writes[i], name);
        json_t *value = check ? json_null() : json_real(options->writes[i].value);
        json_t *done = ask_program(control, json_pack("{s:s, s:o, s:o, s:i}", "request", "output", "name",
                                                      cm1e_json_text(name), "value", value, "keep_ms", KEEP_MS),
                                   "output", diag);
        good = done != NULL;
        *set += good && !check;
        json_decref(done);
    }
    return good;
}

/** Returns the exit status. The outputs are on when it is EXIT_OK. */
static int write_for_a_while(const io_options_t *options, cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    const int64_t begin_ns = cm1e_clock_now(cm1e_clock_monotonic());
    long set = 0;
    bool good = set_all(options, control, true, &set, &diag);
    while (good && !told_to_end()) {
        good = set_all(options, control, false, &set, &diag);
        if ((double)(cm1e_clock_now(cm1e_clock_monotonic()) - begin_ns) * 1e-9 >= options->seconds)
            break;
        usleep(PAUSE_US);
    }
    if (!good)
        return set == 0 ? fail_at_once(&diag) : fail(&diag);
    if (told_to_end())
        complain("interrupted");
    return told_to_end() ? EXIT_FAILED : EXIT_OK;
}

int io_attached(const io_options_t *options, cm1e_control_t *control)
{
    catch_signals();
    int status = options->write_count > 0 ? write_for_a_while(options, control) : EXIT_OK;
    if (status == EXIT_OK)
        status = list(options, control);
    cm1e_control_close(control); /* with it the outputs are safe again */
    return status;
}
