/** cm1e states: the EtherCAT states of all slaves, or another state for one of them. */
#include <stdio.h>
#include <string.h>

#include "attach.h"
#include "cm1e/esc.h"
#include "core/json_text.h"
#include "which_slave.h"

enum { STATE_TIMEOUT_S = 10 };
#define STATES "init|preop|safeop|boot"
static const uint8_t codes[] = {CM1E_AL_INIT, CM1E_AL_PRE_OP, CM1E_AL_SAFE_OP, CM1E_AL_BOOT};

typedef struct states_options {
    common_options_t common;
    const char *where;
    int state; /* place in STATES; -1: show */
} states_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    states_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case ARGP_KEY_ARG:
        if (!options->where) {
            options->where = arg;
            return 0;
        }
        if (options->state >= 0)
            argp_error(state, "one state at a time; \"%s\" is too many", arg);
        if (strcmp(arg, "op") == 0)
            argp_error(state, "Operational needs a program that exchanges the process data in every cycle");
        options->state = choose_word("state", arg, STATES);
        return options->state < 0 ? EINVAL : 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static json_t *as_json(const cm1e_slave_info_t *slave)
{
    char state[48];
    return json_pack("{s:i, s:o, s:s, s:i, s:s}", "position", slave->position, "name", cm1e_json_text(slave->name),
                     "al_state", al_state_name(slave->al_state, state, sizeof state), "al_status_code",
                     slave->al_status_code, "text",
                     slave->al_status_code ? cm1e_al_status_text(slave->al_status_code) : "");
}

static void print_state(const cm1e_slave_info_t *slave)
{
    char state[48];
    printf("%3u  %-22s %s", slave->position, al_state_name(slave->al_state, state, sizeof state),
           slave->name[0] ? slave->name : "without a name");
    if (slave->al_status_code)
        printf(": AL status code 0x%04X, %s", slave->al_status_code, cm1e_al_status_text(slave->al_status_code));
    putchar('\n');
}

/** All slaves, or the one that is given. */
static int show(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t only)
{
    const states_options_t *options = context;
    (void)config;
    json_t *all = options->common.json ? json_array() : NULL;
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, i);
        if (only && slave->position != only)
            continue;
        if (all)
            json_array_append_new(all, as_json(slave));
        else
            print_state(slave);
    }
    if (all)
        print_json(all);
    return EXIT_OK;
}

static int request(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const states_options_t *options = context;
    const uint8_t wanted = codes[options->state];
    cm1e_al_answer_t answer = {0};
    cm1e_diag_t diag = {0};
    if (cm1e_esc_request_state(bus, position, wanted, STATE_TIMEOUT_S * INT64_C(1000000000), &answer, &diag) !=
        CM1E_OK)
        return fail(&diag);
    show(bus, config, options, position);
    if (answer.state == wanted)
        return EXIT_OK;
    complain("slave %u refuses the state", position);
    return EXIT_FAILED;
}

const struct argp argp_states = {
    NULL, parse, "[POSITION|AXIS [init|preop|safeop|boot]]",
    "Shows the EtherCAT state of every slave or of one, with the reason of an error. Where a program runs the network, "
    "it is asked; else the network is brought to Pre-Operational. With a state, that is requested of the slave as it "
    "is, for commissioning: the slave may refuse it, and says why.", attach_children, NULL, NULL};

int command_states(int argc, char **argv)
{
    states_options_t options = {.state = -1};
    if (parse_options(&argp_states, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (options.state < 0)
        return look_at_network(&options.common, options.where, show, &options);
    if (options.common.attach) {
        complain("a state is requested only where no program runs the network: leave --attach out, and end the "
                 "program");
        return EXIT_WRONG_USE;
    }
    return run_on_slave(&options.common, options.where, request, &options);
}
