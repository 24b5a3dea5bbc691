/** cm1e recover: asks a running program to take back a slave that waits (`recover: ask`), and lists those that take no
 *  part. No motor gets torque. */
#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "attach.h"
#include "cm1e/hot_connect.h"
#include "core/clock.h"
#include "core/json_text.h"
#include "end_signals.h"

enum { KEY_FOR = 0x600, PAUSE_US = 20000, LONGEST_S = 600 };
#define PATIENCE_S 10.0

typedef struct recover_options {
    common_options_t common;
    const char *where;
    double seconds;
} recover_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    recover_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_FOR: return parse_seconds(arg, LONGEST_S, &options->seconds) ? 0 : EINVAL;
    case ARGP_KEY_ARG:
        if (options->where)
            argp_error(state, "one slave, or none for a list; \"%s\" is too many", arg);
        options->where = arg;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static json_t *slaves_of(cm1e_control_t *control, cm1e_diag_t *diag)
{
    return ask_program(control, json_pack("{s:s}", "request", "slaves"), "slaves", diag);
}

static cm1e_presence_t presence_of(const json_t *slave)
{
    return (cm1e_presence_t)json_integer_value(json_object_get(slave, "presence"));
}

/* ---- those that take no part ------------------------------------------------------------------------------------- */

static int list(const recover_options_t *options, cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    json_t *slaves = slaves_of(control, &diag), *all = json_array();
    for (size_t i = 0; i < json_array_size(slaves); i++) {
        const json_t *slave = json_array_get(slaves, i);
        const cm1e_presence_t presence = presence_of(slave);
        if (presence == CM1E_PRESENCE_THERE)
            continue;
        if (!options->common.json)
            printf("%s: %s\n", cm1e_presence_name(presence), text_of(slave, "presence_text"));
        json_array_append_new(all, json_pack("{s:i, s:s, s:o}", "position", (int)i + 1, "presence",
                                             cm1e_presence_name(presence), "text",
                                             cm1e_json_text(text_of(slave, "presence_text"))));
    }
    if (options->common.json && slaves)
        print_json(json_incref(all));
    else if (slaves && json_array_size(all) == 0)
        puts("every slave takes part");
    json_decref(all);
    json_decref(slaves);
    return slaves ? EXIT_OK : fail(&diag);
}

/* ---- one that waits ---------------------------------------------------------------------------------------------- */

/** Its position; 0: the program refuses, `diag` says why. */
static int ask_for(const recover_options_t *options, cm1e_control_t *control, cm1e_diag_t *diag)
{
    const bool named = !isdigit((unsigned char)options->where[0]);
    long long position = 0;
    if (!named && !parse_number(options->where, "the position", 1, CM1E_MAX_SLAVES, &position))
        return -1;
    json_t *slave = named ? cm1e_json_text(options->where) : json_integer(position);
    json_t *accepted = ask_program(control, json_pack("{s:s, s:o}", "request", "recover", "slave", slave), "recover",
                                   diag);
    const int found = (int)json_integer_value(accepted);
    json_decref(accepted);
    return found;
}

/** How it stands with the slave, with its sentence; COUNT: the program does not answer any more. */
static cm1e_presence_t look(cm1e_control_t *control, int position, char *text, size_t size, cm1e_diag_t *diag)
{
    json_t *slaves = slaves_of(control, diag);
    const json_t *slave = json_array_get(slaves, (size_t)position - 1);
    const cm1e_presence_t presence = slaves ? presence_of(slave) : CM1E_PRESENCE_COUNT;
    snprintf(text, size, "%s", text_of(slave, "presence_text"));
    json_decref(slaves);
    return presence;
}

static int tell(const recover_options_t *options, int position, cm1e_presence_t presence, const char *text)
{
    const bool good = presence == CM1E_PRESENCE_THERE;
    if (options->common.json)
        print_json(json_pack("{s:i, s:b, s:s, s:o}", "position", position, "good", good, "presence",
                             cm1e_presence_name(presence), "text", cm1e_json_text(text)));
    else if (good)
        printf("slave %d: Operational again; its axis, if it has one, still needs a reset and power\n", position);
    if (!good)
        complain("slave %d does not take part after %g s. %s", position, options->seconds, text);
    return good ? EXIT_OK : EXIT_FAILED;
}

static int recover(const recover_options_t *options, cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    char text[CM1E_PRESENCE_TEXT] = "";
    const int64_t begin_ns = cm1e_clock_now(cm1e_clock_monotonic());
    const int position = ask_for(options, control, &diag);
    if (position <= 0)
        return position < 0 ? EXIT_WRONG_USE : fail_at_once(&diag);
    cm1e_presence_t presence;
    while ((presence = look(control, position, text, sizeof text, &diag)) != CM1E_PRESENCE_THERE) {
        if (presence == CM1E_PRESENCE_COUNT)
            return fail(&diag);
        if (told_to_end() ||
            (double)(cm1e_clock_now(cm1e_clock_monotonic()) - begin_ns) * 1e-9 >= options->seconds)
            break;
        usleep(PAUSE_US);
    }
    return tell(options, position, presence, text);
}

/* ---- the command ------------------------------------------------------------------------------------------------- */

static const struct argp_option table[] = {
    {"for", KEY_FOR, "SECONDS", 0, "Wait so long until the slave takes part; default 10", 0}, {0}};
const struct argp argp_recover = {
    table, parse, "[POSITION|NAME]",
    "Asks the program that runs the network to bring a slave back to Operational that answers and waits for being "
    "asked (`recover: ask`): by its position, its name in the bus file, or the name of its axis. Without one it lists "
    "the slaves that take no part, and why. The program's bus file needs `control: maintain`. No motor gets torque: "
    "its axis needs a reset and power afterwards.", attach_children, NULL, NULL};

int command_recover(int argc, char **argv)
{
    recover_options_t options = {.seconds = PATIENCE_S};
    static cm1e_bus_config_t config;
    cm1e_control_t *control;
    if (parse_options(&argp_recover, argc, argv, &options))
        return EXIT_WRONG_USE;
    const int status = attach_if_running(&options.common, &config, &control);
    if (status != EXIT_OK)
        return status;
    if (!control) {
        complain("no program runs this network, so no slave waits: a program brings all slaves to Operational when it "
                 "starts. `cm1e status` shows what is on the network, and --attach PROCESS names a program");
        return EXIT_FAILED;
    }
    catch_signals();
    const int done = options.where ? recover(&options, control) : list(&options, control);
    cm1e_control_close(control);
    return done;
}
