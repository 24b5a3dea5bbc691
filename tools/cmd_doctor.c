/** cm1e doctor: looks at the machine, the interface and the network, and says what to do. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "config/interface.h"
#include "core/json_text.h"
#include "doctor/doctor.h"

enum { KEY_FIX = 0x300, KEY_ROOT, KEY_SECONDS };
#define DEFAULT_SECONDS 2.0
#define DEFAULT_CYCLE_NS INT64_C(1000000)

typedef struct doctor_options {
    common_options_t common;
    const char *root;
    double seconds;
    bool fix;
} doctor_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    doctor_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_FIX: options->fix = true; return 0;
    case KEY_ROOT: options->root = arg; return 0;
    case KEY_SECONDS:
        if (!parse_real(arg, "the time", &options->seconds))
            return EINVAL;
        if (options->seconds < 0 || options->seconds > 3600)
            argp_error(state, "the time must be 0 ... 3600 s; %s was given", arg);
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static json_t *as_json(const doctor_t *doctor)
{
    json_t *list = json_array();
    for (int i = 0; i < doctor->count; i++) {
        const finding_t *f = &doctor->findings[i];
        json_array_append_new(
            list, json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:o}", "level", doctor_level_name(f->level), "group",
                            f->group, "subject", cm1e_json_text(f->subject), "fact", cm1e_json_text(f->fact), "why",
                            cm1e_json_text(f->why), "action", cm1e_json_text(f->action), "fix", cm1e_json_text(f->fix)));
    }
    return list;
}

static void print_text(const doctor_t *doctor)
{
    const char *group = "";
    for (int i = 0; i < doctor->count; i++) {
        const finding_t *f = &doctor->findings[i];
        if (strcmp(group, f->group) != 0)
            printf("%s%s\n", i ? "\n" : "", f->group);
        group = f->group;
        printf("  %-8s %s: %s\n", doctor_level_name(f->level), f->subject, f->fact);
        if (f->why)
            printf("           why:  %s\n", f->why);
        if (f->action[0])
            printf("           do:   %s\n", f->action);
        if (f->fix[0])
            printf("           with: %s\n", f->fix);
    }
}

/** A script for a person who has read it; nothing runs it. */
static void print_script(const doctor_t *doctor)
{
    puts("#!/bin/sh\n# What `cm1e doctor` advises. Read it before you run it, as root.\nset -eu");
    for (int i = 0; i < doctor->count; i++) {
        const finding_t *f = &doctor->findings[i];
        if (f->level < FINDING_NOTE || (!f->fix[0] && !f->action[0]))
            continue;
        printf("\n# %s, %s: %s\n# %s\n", f->group, f->subject, f->fact, f->action);
        if (f->fix[0])
            puts(f->fix);
    }
}

static int count_of(const doctor_t *doctor, finding_level_t level)
{
    int count = 0;
    for (int i = 0; i < doctor->count; i++)
        count += doctor->findings[i].level == level;
    return count;
}

/** The interface without "sim": the segment in this process has none. */
static bool is_network(const char *name) { return strncmp(name, "sim", 3) != 0 || (name[3] && name[3] != ':'); }

static bool is_named(const doctor_options_t *options)
{
    return options->common.interface_name || options->common.bus_file || options->common.attach;
}

static void look(doctor_t *doctor, const doctor_options_t *options, const cm1e_bus_config_t *config)
{
    const bool named = is_named(options);
    static char own_name[sizeof config->interface_name]; /* findings point to it */
    const int64_t cycle_time_ns = config->cycle_time_ns ? config->cycle_time_ns : DEFAULT_CYCLE_NS;
    cm1e_interface_own_name(own_name, sizeof own_name, config->interface_name);
    doctor_look_at_machine(doctor);
    if (options->seconds > 0)
        doctor_measure_latency(doctor, cycle_time_ns, options->seconds);
    if (!named)
        doctor_find(doctor, FINDING_NOTE, "interface", "interface",
                    "none named: -i NAME looks at it and at its slaves");
    else if (!config->interface_name[0] || !is_network(config->interface_name) ||
             doctor_look_at_interface(doctor, own_name))
        doctor_look_at_bus(doctor, &options->common, config);
}

static const struct argp_option option_list[] = {
    {"fix", KEY_FIX, NULL, 0, "Print a shell script that does what is advised; it is not run", 0},
    {"root", KEY_ROOT, "DIR", 0, "Look at proc, sys and run below DIR", 0},
    {"seconds", KEY_SECONDS, "S", 0, "Measure the wake-up latency for so long (default 2; 0: not at all)", 0},
    {0},
};
const struct argp argp_doctor = {
    option_list,
    parse,
    NULL,
    "Looks at the machine, at the network interface and at its slaves, and says what is wrong, why it matters, and "
    "what to do. Nothing is changed, and no motor moves. The slaves go to Init and back to Pre-Operational, so the "
    "interface must not be in use; if a program of this library has it, that program is asked, and no slave changes "
    "its state. Exit status 1: there is a problem.",
    attach_children,
    NULL,
    NULL,
};

int command_doctor(int argc, char **argv)
{
    doctor_options_t options = {.root = "", .seconds = DEFAULT_SECONDS};
    if (parse_options(&argp_doctor, argc, argv, &options))
        return EXIT_WRONG_USE;
    static cm1e_bus_config_t config;
    static doctor_t doctor;
    if (is_named(&options) && !load_network(&options.common, &config))
        return EXIT_WRONG_USE;
    doctor.root = options.root;
    look(&doctor, &options, &config);
    if (options.fix)
        print_script(&doctor);
    else if (options.common.json)
        print_json(as_json(&doctor));
    else
        print_text(&doctor);
    const int problems = count_of(&doctor, FINDING_PROBLEM);
    if (!options.fix && !options.common.json)
        printf("\n%d problem%s, %d with advice\n", problems, problems == 1 ? "" : "s",
               count_of(&doctor, FINDING_ADVICE));
    return problems ? EXIT_FAILED : EXIT_OK;
}
