/** cm1e cml: strings in CML to a motor behind a bridge, from the command line or line by line. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cm1e/cml.h"
#include "command.h"
#include "core/json_text.h"
#include "device/bridge_status.h"
#include "device/devices.h"
#include "device/cml_command.h"
#include "end_signals.h"

enum { KEY_SLAVE = 0x400, KEY_CHANNEL, KEY_TIMEOUT, KEY_ALLOW, KEY_STAY, MAX_STRINGS = 64 };

typedef struct cml_options {
    common_options_t common;
    const char *axis_word;
    long long slave, channel;  /**< 0: not stated */
    double timeout_s;
    bool allow_motion, stay;
    const char *strings[MAX_STRINGS];
    int count;
} cml_options_t;

/** The receiver of the strings, and what has to be restored at the end. */
typedef struct session {
    const cml_options_t *options;
    cm1e_bus_t *bus;
    uint16_t slave;
    unsigned channel; /**< 0: each string names it */
    bool used[CM1E_BRIDGE_AXES], moved[CM1E_BRIDGE_AXES];
} session_t;

static bool is_interrupted(void *context)
{
    (void)context;
    return told_to_end();
}

static error_t parse_count(char *arg, const char *what, long long maximum, long long *value)
{
    return parse_number(arg, what, 1, maximum, value) ? 0 : EINVAL;
}

static error_t parse_timeout(char *arg, struct argp_state *state, double *value)
{
    if (!parse_real(arg, "the timeout", value))
        return EINVAL;
    if (!(*value > 0.0 && *value <= 3600.0))
        argp_error(state, "the timeout is %s s; expected above 0, up to 3600", arg);
    return 0;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    cml_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case 'a': options->axis_word = arg; return 0;
    case KEY_SLAVE: return parse_count(arg, "the position of the slave", CM1E_MAX_SLAVES, &options->slave);
    case KEY_CHANNEL: return parse_count(arg, "the connector", CM1E_BRIDGE_AXES, &options->channel);
    case KEY_TIMEOUT: return parse_timeout(arg, state, &options->timeout_s);
    case KEY_ALLOW: options->allow_motion = true; return 0;
    case KEY_STAY: options->stay = true; return 0;
    case ARGP_KEY_ARG:
        if (options->count == MAX_STRINGS)
            argp_error(state, "more than %d strings", MAX_STRINGS);
        options->strings[options->count++] = arg;
        return 0;
    case ARGP_KEY_END:
        if (options->axis_word && (options->slave || options->channel))
            argp_error(state, "--axis already selects slave and connector");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- to whom ----------------------------------------------------------------------------------------------------- */

/** Returns the exit status, as choose_slave(). */
static int choose_axis(session_t *session, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    const int axis = find_axis(config, session->options->axis_word);
    if (axis < 0)
        return EXIT_WRONG_USE;
    session->channel = config->axes[axis].channel;
    if (session->channel == 0) {
        complain("axis \"%s\" is a CM1-E, which has no CML; only motors behind a bridge have it",
                 session->options->axis_word);
        return EXIT_WRONG_USE;
    }
    if (cm1e_bus_identify(session->bus, diag) != CM1E_OK)
        return fail(diag);
    session->slave = cm1e_bus_axis_position(session->bus, (uint32_t)axis);
    return EXIT_OK;
}

static bool takes_cml(const cm1e_slave_info_t *slave) { return slave->device && slave->device->channels > 0; }

/* The only bridge, if none is named. */
static int choose_slave(session_t *session)
{
    unsigned bridges = 0;
    session->channel = (unsigned)session->options->channel;
    session->slave = (uint16_t)session->options->slave;
    if (session->slave)
        return EXIT_OK;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(session->bus); position++)
        if (takes_cml(cm1e_bus_slave(session->bus, position)) && bridges++ == 0)
            session->slave = (uint16_t)position;
    if (bridges == 1)
        return EXIT_OK;
    complain(bridges ? "there are %u bridges: choose one with --slave or --axis" : "there is no EtherCAT Cool MUSCLE "
             "Bridge; only motors behind one have CML", bridges);
    return bridges ? EXIT_WRONG_USE : EXIT_FAILED;
}

/* The connector that the first command with a connector names; 0: none. */
static unsigned named_channel(const char *text)
{
    do {
        const cm1e_cml_command_t command = cm1e_cml_next(&text);
        if (command.sign && command.id)
            return command.id;
    } while (text);
    return 0;
}

/* ---- one string -------------------------------------------------------------------------------------------------- */

/* "in position" for the state in an answer; "" for other answers. */
static const char *state_in_words(const session_t *session, const char *line, char *text, size_t size)
{
    char whole[CM1E_CML_BYTES + 2];
    cm1e_cml_answer_t answer;
    snprintf(whole, sizeof whole, "%.*s\n", CM1E_CML_BYTES - 1, line);
    if (cm1e_cml_parse(&answer, whole, strlen(whole)) != CM1E_OK || answer.what != CM1E_CML_STATUS)
        return "";
    const cm1e_device_model_t model = cm1e_bus_slave(session->bus, session->slave)->model;
    return cm1e_bridge_status_text(cm1e_bridge_motor(model, answer.id - 1), (uint32_t)answer.value, text, size);
}

static json_t *as_json(const session_t *session, const cm1e_cml_exchange_t *exchange, const cm1e_diag_t *diag)
{
    char words[CM1E_BRIDGE_STATUS_TEXT];
    json_t *lines = json_array();
    json_t *object = json_pack("{s:o, s:i, s:i, s:o}", "sent", cm1e_json_text(exchange->text), "slave",
                               exchange->position, "channel", exchange->channel, "lines", lines);
    for (unsigned i = 0; i < exchange->count; i++) {
        const char *state = state_in_words(session, exchange->lines[i], words, sizeof words);
        json_array_append_new(lines, cm1e_json_text(exchange->lines[i]));
        if (state[0])
            json_object_set_new(object, "state", cm1e_json_text(state));
    }
    json_object_set_new(object, "strays", json_integer(exchange->strays));
    if (exchange->strays)
        json_object_set_new(object, "stray", cm1e_json_text(exchange->stray));
    if (diag->error != CM1E_OK)
        json_object_set_new(object, "error", cm1e_json_text(diag->text));
    return object;
}

static void print_text(const session_t *session, const cm1e_cml_exchange_t *exchange, const cm1e_diag_t *diag)
{
    char words[CM1E_BRIDGE_STATUS_TEXT];
    for (unsigned i = 0; i < exchange->count; i++) {
        const char *state = state_in_words(session, exchange->lines[i], words, sizeof words);
        printf("%s%s%s\n", exchange->lines[i], state[0] ? "  " : "", state);
    }
    if (exchange->count == 0 && diag->error == CM1E_OK)
        puts("sent");
    if (exchange->lost)
        complain("%u more lines were dropped", exchange->lost);
    if (exchange->strays)
        complain("%u %s that %s nothing asked now: \"%s\"", exchange->strays, exchange->strays == 1 ? "line" : "lines",
                 exchange->strays == 1 ? "answers" : "answer", exchange->stray);
}

/* Called before anything is sent to the slave, including its mode. */
static bool refused_here(cm1e_error_t error)
{
    return error == CM1E_ERROR_INVALID_ARGUMENT || error == CM1E_ERROR_CM_NO_BRIDGE ||
           error == CM1E_ERROR_CML_STRING || error == CM1E_ERROR_CML_MOTION;
}

static bool has_sent(const session_t *session)
{
    bool any = false;
    for (int i = 0; i < CM1E_BRIDGE_AXES; i++)
        any = any || session->used[i];
    return any;
}

/* The beginning of the input, safe for a terminal. */
static const char *show(const char *text, char shown[CM1E_CML_BYTES + 1])
{
    size_t size = 0;
    for (; size < CM1E_CML_BYTES && text[size]; size++)
        shown[size] = text[size] >= ' ' && text[size] <= '~' ? text[size] : '?';
    shown[size] = '\0';
    return shown;
}

/** Sends a string and shows the answer, in `results` if that is not NULL. */
static int send_string(session_t *session, const char *text, json_t *results)
{
    static cm1e_cml_exchange_t exchange;
    char shown[CM1E_CML_BYTES + 1];
    cm1e_diag_t diag = {0};
    const unsigned channel = session->channel ? session->channel : named_channel(text);
    if (channel == 0) {
        complain("the string \"%s\" names no connector: name it in the string (\"?99.1\"), or with --channel "
                 "or --axis", show(text, shown));
        return EXIT_WRONG_USE;
    }
    exchange = (cm1e_cml_exchange_t){
        .position = session->slave, .channel = (uint8_t)(channel <= UINT8_MAX ? channel : 0), .text = text,
        .timeout_ns = (int64_t)(session->options->timeout_s * 1e9), .cancelled = is_interrupted,
        .allow_motion = session->options->allow_motion,
    };
    const cm1e_error_t error = cm1e_cml_exchange(session->bus, &exchange, &diag);
    if (!refused_here(error)) {
        session->used[channel - 1] = true;
        session->moved[channel - 1] |= cm1e_cml_kind(text) == CM1E_CML_MOTION;
    }
    if (session->options->common.json)
        json_array_append_new(results, as_json(session, &exchange, &diag));
    else
        print_text(session, &exchange, &diag);
    if (error == CM1E_ERROR_CML_MOTION && !session->options->common.json)
        complain("%s Use --allow-motion to send it.", diag.text);
    else if (error != CM1E_OK)
        fail(&diag);
    if (error == CM1E_OK)
        return EXIT_OK;
    const bool is_there = cm1e_bus_slave(session->bus, session->slave) != NULL;
    return refused_here(error) && is_there && !has_sent(session) ? EXIT_WRONG_USE : EXIT_FAILED;
}

/* ---- all strings ------------------------------------------------------------------------------------------------- */

static int send_arguments(session_t *session)
{
    json_t *results = json_array();
    int status = EXIT_OK;
    for (int i = 0; i < session->options->count && status == EXIT_OK && !told_to_end(); i++)
        status = send_string(session, session->options->strings[i], results);
    if (session->options->common.json)
        print_json(results);
    else
        json_decref(results);
    return status;
}

static int refuse_binary(const char *line)
{
    char shown[CM1E_CML_BYTES + 1];
    complain("the line that begins with \"%s\" contains a byte 0, which is not allowed in CML: nothing was sent",
             show(line, shown));
    return EXIT_WRONG_USE;
}

/* Sends the input line by line. A line that fails does not end it, but sets the exit status. */
static int send_lines(session_t *session)
{
    const bool prompts = isatty(STDIN_FILENO) && isatty(STDOUT_FILENO);
    char *line = NULL;
    size_t room = 0;
    int status = EXIT_OK;
    while (!told_to_end()) {
        if (prompts)
            fputs("cml> ", stdout);
        fflush(stdout);
        const ssize_t size = getline(&line, &room, stdin);
        if (size < 0)
            break;
        const bool whole = strlen(line) == (size_t)size; /* otherwise the line contains a byte 0 */
        line[strcspn(line, "\r\n")] = '\0';
        if (line[0] == '\0' && whole)
            continue;
        json_t *results = json_array();
        const int result = whole ? send_string(session, line, results) : refuse_binary(line);
        status = result == EXIT_OK ? status : result;
        if (session->options->common.json && json_array_size(results) > 0)
            print_json(json_incref(json_array_get(results, 0)));
        json_decref(results);
    }
    if (prompts)
        putchar('\n');
    free(line);
    return status;
}

/* Returns to csp; without torque after strings that may have moved a motor, because no program supervises it any
 * more. */
static int leave(session_t *session)
{
    int status = EXIT_OK;
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES && !session->options->stay; i++) {
        cm1e_diag_t diag = {0};
        if (session->used[i] && cm1e_cml_leave(session->bus, session->slave, (uint8_t)(i + 1), session->moved[i],
                                               &diag) != CM1E_OK)
            status = fail(&diag);
    }
    return status;
}

static int run_session(session_t *session, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    const int chosen = session->options->axis_word ? choose_axis(session, config, diag) : choose_slave(session);
    if (chosen != EXIT_OK)
        return chosen;
    const int sent = session->options->count > 0 ? send_arguments(session) : send_lines(session);
    const int left = leave(session);
    return sent != EXIT_OK ? sent : left;
}

/* Also if the terminal or the reader of our output is closed: a motor that moves by a string must be freed at the end,
 * and no watchdog does that. */
static void end_in_order(void)
{
    catch_signals();
    signal(SIGPIPE, SIG_IGN);
}

static const struct argp_option table[] = {
    {"axis", 'a', "AXIS", 0, "The motor, by the name or number of its axis in the bus file", 0},
    {"slave", KEY_SLAVE, "POSITION", 0, "The bridge of the motor, by position; default: the only bridge", 0},
    {"channel", KEY_CHANNEL, "ID", 0, "The connector of the motor, 1 ... 4; default: the one that the "
                                      "string names", 0},
    {"timeout", KEY_TIMEOUT, "SECONDS", 0, "Time for an answer; default 1, for an origin search 70", 0},
    {"allow-motion", KEY_ALLOW, NULL, 0, "Also send strings that may move the motor or change its power", 0},
    {"stay", KEY_STAY, NULL, 0, "Leave the motor in CML mode, with its torque", 0},
    {0}};
const struct argp argp_cml = {
    table, parse, "[STRING...]",
    "Sends strings in CML, the language of the Cool Muscle motors, to a motor behind an EtherCAT Cool MUSCLE "
    "Bridge, and shows its answers, for example `cm1e cml -i eth1 \"?99.1\"`. Without strings it sends the lines "
    "of standard input.\vQueries (?90.1, ?96.1, ?99.1, K37.1), parameters (K53.1=100; the motor keeps them when "
    "its power is off) and outputs (O2.1, F2.1) are sent unchanged. All other strings may move the motor: they "
    "need --allow-motion, and at the end the motor is freed. No other master may use the bridge meanwhile.",
    common_children, NULL, NULL};

int command_cml(int argc, char **argv)
{
    cml_options_t options = {0};
    if (parse_options(&argp_cml, argc, argv, &options))
        return EXIT_WRONG_USE;
    static cm1e_bus_config_t config;
    if (!load_configuration(&options.common, &config))
        return EXIT_WRONG_USE;
    end_in_order();
    cm1e_diag_t diag = {0};
    session_t session = {.options = &options};
    if (open_scanned(&config, &session.bus) != EXIT_OK)
        return EXIT_FAILED;
    return close_bus(session.bus, &options.common, run_session(&session, &config, &diag));
}
