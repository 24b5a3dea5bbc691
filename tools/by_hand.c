#include "by_hand.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "axis_run.h"
#include "cm1e/config.h"
#include "core/clock.h"
#include "core/json_text.h"
#include "end_signals.h"
#include "jog_keys.h"
#include "terminal.h"

enum { ENABLE_MS = 2000, PAUSE_US = 20000, KEY_MS = 5 };
#define ENABLE_S 5.0
#define RESET_S 20.0
#define STOP_S 10.0

typedef struct other {
    cm1e_control_t *control;
    json_t *axes;
    const json_t *axis;     /**< one of them */
    json_int_t number;      /**< its, 1 = first */
    const char *simulated;
    cm1e_diag_t diag;
} other_t;

/* ---- the other program ------------------------------------------------------------------------------------------- */

static double now_s(void) { return (double)cm1e_clock_now(cm1e_clock_monotonic()) * 1e-9; }

static bool is_true(const json_t *object, const char *name) { return json_is_true(json_object_get(object, name)); }

static bool is_in(const other_t *other, const char *state) { return strcmp(text_of(other->axis, "state"), state) == 0; }

static double real_of(const other_t *other, const char *name)
{
    return json_number_value(json_object_get(other->axis, name));
}

/** false: it does not answer; `diag` says why. */
static bool look(other_t *other)
{
    json_t *axes = ask_program(other->control, json_pack("{s:s}", "request", "axes"), "axes", &other->diag);
    if (!axes)
        return false;
    json_decref(other->axes);
    other->axes = axes;
    other->axis = json_array_get(axes, (size_t)(other->number - 1));
    return true;
}

static bool order(other_t *other, const char *what, json_t *request)
{
    json_object_set_new(request, "request", json_string(what));
    json_object_set_new(request, "axis", json_integer(other->number));
    json_t *value = ask_program(other->control, request, what, &other->diag);
    json_decref(value);
    return value != NULL;
}

static bool keep(other_t *other)
{
    json_t *kept = ask_program(other->control, json_pack("{s:s}", "request", "keep"), "keep", &other->diag);
    json_decref(kept);
    return kept != NULL && look(other);
}

static bool begin(other_t *other, cm1e_control_t *control)
{
    *other = (other_t){.control = control, .number = 1, .simulated = ""};
    json_t *hello = ask_program(control, json_pack("{s:s}", "request", "hello"), "hello", &other->diag);
    if (strncmp(text_of(hello, "interface"), "sim", 3) == 0)
        other->simulated = " (simulated)";
    json_decref(hello);
    return hello && look(other);
}

static int end(other_t *other, int status)
{
    cm1e_control_close(other->control);
    json_decref(other->axes);
    return status;
}

/** false, with a complaint: there is no such axis. */
static bool choose(other_t *other, const char *word)
{
    const size_t number = axis_of_program(other->axes, word);
    if (number == 0) {
        complain("the program has no axis \"%s\"; its axes are numbered 1 ... %zu", word, json_array_size(other->axes));
        return false;
    }
    other->axis = json_array_get(other->axes, number - 1);
    other->number = (json_int_t)number;
    return true;
}

/** false: the program refused, or the axis did not come. */
static bool enable(other_t *other)
{
    const double begin_s = now_s();
    if (!order(other, "enable", json_pack("{s:i}", "keep_ms", ENABLE_MS)))
        return false;
    while (!is_in(other, "Standstill") && now_s() - begin_s < ENABLE_S && !told_to_end()) {
        usleep(PAUSE_US);
        if (!keep(other))
            return false;
        if (is_in(other, "ErrorStop"))
            break;
    }
    if (is_in(other, "Standstill"))
        return true;
    const char *text = text_of(other->axis, "text");
    cm1e_diag_set(&other->diag, CM1E_ERROR_AXIS_STATE, 0, "%s is not enabled: %s", text_of(other->axis, "name"),
                  text[0] ? text : text_of(other->axis, "state"));
    return false;
}

/** Waits for the end of a motion, and takes the torque of what was enabled here. */
static void let_go(other_t *other, bool own)
{
    const double begin_s = now_s();
    while (is_true(other->axis, "held") && real_of(other, "set_velocity") != 0 && now_s() - begin_s < STOP_S &&
           keep(other))
        usleep(PAUSE_US);
    if (own && order(other, "disable", json_object()))
        while (is_true(other->axis, "powered") && now_s() - begin_s < STOP_S && look(other))
            usleep(PAUSE_US);
}

/* ---- jog --------------------------------------------------------------------------------------------------------- */

/** Of a lost connection, of an error of the axis, or of a request that was refused. */
static bool has_failed(const other_t *other, bool asked)
{
    return !asked || is_in(other, "ErrorStop");
}

static int report_jog(const by_hand_t *hand, const other_t *other, double from, bool failed)
{
    const json_t *error = json_object_get(other->axis, "error");
    const char *name = text_of(other->axis, "name"), *details = text_of(other->axis, "text");
    const bool in_error = is_in(other, "ErrorStop");
    const char *why = in_error ? text_of(error, "name") : cm1e_strerror(other->diag.error);
    if (hand->common->json)
        print_json(json_pack("{s:s, s:b, s:f, s:f, s:s, s:o, s:b, s:n}", "axis", name, "done", !failed, "from", from,
                             "to", real_of(other, "position"), "error", failed ? why : "", "details",
                             cm1e_json_text(!failed ? "" : in_error ? details : other->diag.text), "simulated",
                             other->simulated[0] != '\0', "timing"));
    else if (!failed)
        printf("%s: jogged from %.6g to %.6g%s\n", name, from, real_of(other, "position"), other->simulated);
    if (failed && in_error)
        complain_of_axis(name, why, details);
    else if (failed)
        complain("%s", other->diag.text);
    return failed ? EXIT_FAILED : EXIT_OK;
}

/** One look at the keys. false: a request was refused, or the program is gone. */
static bool jog_step(const by_hand_t *hand, other_t *other, jog_keys_t *keys)
{
    bool asked = true;
    jog_keys_read(keys, KEY_MS);
    if (keys->sign != 0 && !keys->end)
        asked = order(other, "jog", json_pack("{s:f, s:f, s:i}", "velocity",
                                              keys->sign * hand->velocity * keys->factor, "acceleration",
                                              hand->acceleration, "keep_ms", (int)lround(hand->dead_man_s * 1e3)));
    if (!asked && other->diag.error == CM1E_ERROR_AXIS_POSITION_RANGE)
        asked = true; /* it is at its software limit: the other direction is free */
    return asked && keep(other);
}

int jog_attached(const by_hand_t *hand, cm1e_control_t *control)
{
    other_t other;
    jog_keys_t keys = {.factor = 1};
    catch_signals();
    if (!begin(&other, control))
        return end(&other, fail(&other.diag));
    if (!choose(&other, hand->axis_word ? hand->axis_word : "1"))
        return end(&other, EXIT_WRONG_USE);
    const double from = real_of(&other, "position");
    const bool own = !is_true(other.axis, "powered") || is_true(other.axis, "held"); /* one of the program's is jogged, too */
    if (own && !enable(&other))
        return end(&other, report_jog(hand, &other, from, true));
    if (!terminal_begin())
        return end(&other, EXIT_FAILED);
    bool asked = true;
    while (!keys.end && !told_to_end() && !has_failed(&other, asked)) {
        asked = jog_step(hand, &other, &keys);
        jog_line(text_of(other.axis, "name"), real_of(&other, "position"), real_of(&other, "set_velocity") != 0,
                 hand->velocity * keys.factor);
        usleep(PAUSE_US);
    }
    jog_line_clear();
    const bool failed = has_failed(&other, asked);
    const cm1e_diag_t why = other.diag;
    let_go(&other, own);
    other.diag = why;
    terminal_end();
    return end(&other, report_jog(hand, &other, from, failed));
}

/* ---- enable ------------------------------------------------------------------------------------------------------ */

static int report_enable(const by_hand_t *hand, const other_t *other, double seconds, double way, bool failed)
{
    const char *name = text_of(other->axis, "name");
    if (hand->common->json)
        print_json(json_pack("{s:s, s:b, s:f, s:f, s:f, s:s, s:o, s:b, s:n}", "axis", name, "enabled", seconds > 0,
                             "seconds", seconds, "position", real_of(other, "position"), "way", way, "error",
                             failed ? cm1e_strerror(other->diag.error) : "", "details",
                             cm1e_json_text(failed ? other->diag.text : ""), "simulated", other->simulated[0] != '\0',
                             "timing"));
    else if (!failed)
        printf("%s: was enabled for %.1f s, at %.6g, and was displaced by %.2g%s\n", name, seconds,
               real_of(other, "position"), way, other->simulated);
    if (failed)
        complain("%s", other->diag.text);
    return failed ? EXIT_FAILED : EXIT_OK;
}

int enable_attached(const by_hand_t *hand, cm1e_control_t *control)
{
    other_t other;
    catch_signals();
    if (!begin(&other, control))
        return end(&other, fail(&other.diag));
    if (!choose(&other, hand->axis_word ? hand->axis_word : "1"))
        return end(&other, EXIT_WRONG_USE);
    if (!enable(&other)) /* one that the program has enabled is refused */
        return end(&other, report_enable(hand, &other, 0, 0, true));
    if (hand->seconds == 0 && !terminal_begin())
        return end(&other, EXIT_FAILED);
    if (!hand->common->json && hand->seconds == 0)
        fprintf(stderr, "%s is enabled and holds its position. Any key ends it.\n", text_of(other.axis, "name"));
    const double from = real_of(&other, "position"), begin_s = now_s();
    bool answers = true, is_over = false;
    while (answers && !is_over && !told_to_end() && is_true(other.axis, "powered")) {
        usleep(PAUSE_US);
        answers = keep(&other);
        is_over = hand->seconds > 0 ? now_s() - begin_s > hand->seconds : terminal_key(0) != TERMINAL_NONE;
    }
    const double seconds = now_s() - begin_s, way = real_of(&other, "position") - from;
    const bool lost = answers && !is_over && !told_to_end();
    if (lost)
        cm1e_diag_set(&other.diag, CM1E_ERROR_AXIS_STATE, 0, "%s: %s", text_of(other.axis, "name"),
                      text_of(other.axis, "text")[0] ? text_of(other.axis, "text") : "the program took its torque");
    const cm1e_diag_t why = other.diag;
    if (answers)
        let_go(&other, true);
    other.diag = why;
    terminal_end();
    return end(&other, report_enable(hand, &other, seconds, way, lost || !answers));
}

/* ---- reset ------------------------------------------------------------------------------------------------------- */

static void tell_reset(const other_t *other, const char *what, const char *details)
{
    char line[AXIS_LINE_BYTES];
    const char *axis = text_of(other->axis, "name");
    describe_error(line, sizeof line, axis, what, details);
    printf("%s: error reset%s. It was: %s\n", axis, other->simulated, line);
}

static bool reset_one(const by_hand_t *hand, other_t *other, json_t *all)
{
    const json_t *error = json_object_get(other->axis, "error");
    const bool had_error = is_in(other, "ErrorStop");
    const json_int_t device_error = json_integer_value(json_object_get(error, "device_error"));
    const char *name = cm1e_strerror((cm1e_error_t)json_integer_value(json_object_get(error, "code")));
    const double begin_s = now_s();
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    snprintf(text, sizeof text, "%s", had_error ? text_of(other->axis, "text") : "");
    bool good = !had_error || order(other, "reset", json_object());
    const bool accepted = good;
    while (had_error && accepted && look(other) && is_true(other->axis, "resetting") && now_s() - begin_s < RESET_S)
        usleep(PAUSE_US);
    good = good && !is_in(other, "ErrorStop");
    const char *axis = text_of(other->axis, "name"), *why = good       ? ""
                                                            : accepted ? text_of(other->axis, "text")
                                                                       : other->diag.text;
    json_array_append_new(all, json_pack("{s:s, s:b, s:b, s:s, s:I, s:o, s:o}", "axis", axis, "had_error", had_error,
                                         "good", good, "error", had_error ? name : "", "device_error",
                                         had_error ? device_error : 0, "details", cm1e_json_text(text), "why",
                                         cm1e_json_text(why)));
    if (hand->common->json)
        return good;
    if (!had_error)
        printf("%s: has no error%s\n", axis, other->simulated);
    else if (good)
        tell_reset(other, name, text);
    else
        complain("%s: the error is still there. %s", axis, why);
    return good;
}

int reset_attached(const by_hand_t *hand, cm1e_control_t *control)
{
    other_t other;
    if (!begin(&other, control))
        return end(&other, fail(&other.diag));
    if (hand->axis_word && !choose(&other, hand->axis_word))
        return end(&other, EXIT_WRONG_USE);
    json_t *all = json_array();
    bool good = true;
    const size_t count = hand->axis_word ? 1 : json_array_size(other.axes);
    for (size_t i = 0; i < count; i++) {
        if (!hand->axis_word) {
            other.number = (json_int_t)i + 1;
            other.axis = json_array_get(other.axes, i);
        }
        if (strcmp(text_of(other.axis, "type"), "motor") == 0)
            good = reset_one(hand, &other, all) && good;
    }
    if (hand->common->json)
        print_json(all);
    else
        json_decref(all);
    return end(&other, good ? EXIT_OK : EXIT_FAILED);
}
