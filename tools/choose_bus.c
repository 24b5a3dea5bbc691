#include "choose_bus.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "config/interface.h"

typedef struct buses {
    cm1e_bus_config_t configs[CM1E_MAX_BUSES];
    uint32_t count;
} buses_t;

enum { NONE = -1, REFUSED = -2 };

static const char *command = "";
static int word_count;
static char **words;
/* A command loads its configuration more than once, and means the same bus each time. */
static int chosen = NONE;

void remember_words(const char *name, int argc, char **argv)
{
    command = name;
    word_count = argc;
    words = argv;
}

static bool takes_values(void)
{
    for (int i = 0; i < word_count; i++)
        if (words[i][0] != '-' && strchr(words[i], '='))
            return true;
    return false;
}

/* Commands that show things, and change nothing. */
static bool shows_all(void)
{
    static const char *const names[] = {"scan", "status", "io", "states", "graph"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(command, names[i]) == 0)
            return !takes_values();
    return false;
}

static const char *list(const buses_t *buses, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (uint32_t i = 0; i < buses->count && used < size; i++) {
        const int n = snprintf(text + used, size - used, "%s%s%s%s%s", used ? ", " : "", buses->configs[i].name,
                               buses->configs[i].name[0] ? " (" : "", buses->configs[i].interface_name,
                               buses->configs[i].name[0] ? ")" : "");
        used += n > 0 ? (size_t)n : 0;
    }
    return text;
}

/* The only bus with this name or interface. */
static int find(const buses_t *buses, const char *word)
{
    int found = NONE;
    for (uint32_t i = 0; i < buses->count; i++)
        if (strcmp(buses->configs[i].name, word) == 0)
            return (int)i;
    for (uint32_t i = 0; i < buses->count; i++)
        if (cm1e_interface_is_same(buses->configs[i].interface_name, word))
            found = found == NONE ? (int)i : REFUSED;
    return found;
}

static bool has_axis(const cm1e_bus_config_t *config, const char *word)
{
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (strcmp(config->axes[i].name, word) == 0)
            return true;
    return false;
}

static bool has_slave(const cm1e_bus_config_t *config, const char *word)
{
    for (uint32_t i = 0; i < config->slave_count; i++)
        if (strcmp(config->slaves[i].name, word) == 0)
            return true;
    return false;
}

/* The bus of an axis, else the only one with a slave of that name: unlike axes, slaves of several buses may have one name. */
static int find_by_words(const buses_t *buses)
{
    int found = NONE;
    for (int k = 1; k < word_count; k++)
        for (uint32_t i = 0; i < buses->count; i++)
            if (has_axis(&buses->configs[i], words[k]))
                return (int)i;
    for (int k = 1; k < word_count; k++)
        for (uint32_t i = 0; i < buses->count; i++)
            if (has_slave(&buses->configs[i], words[k]))
                found = found == NONE || found == (int)i ? (int)i : REFUSED;
    return found;
}

/* Runs the command in a process of its own for each bus, one after the other. Returns in these only. */
static int show_each(const buses_t *buses, bool json)
{
    int worst = EXIT_OK, status;
    for (uint32_t i = 0; i < buses->count; i++) {
        const pid_t child = fork();
        if (child == 0) {
            if (!json)
                printf("%sbus %s on %s:\n", i > 0 ? "\n" : "", buses->configs[i].name,
                       buses->configs[i].interface_name);
            return (int)i;
        }
        if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status))
            status = EXIT_FAILED;
        else
            status = WEXITSTATUS(status);
        worst = status > worst ? status : worst;
    }
    exit(worst);
}

static int choose(const buses_t *buses, const common_options_t *options)
{
    char text[400];
    const int named = options->network ? find(buses, options->network) : NONE;
    if (options->network && named < 0) {
        complain("there is no bus \"%s\" in %s, or several are on it: %s", options->network, options->bus_file,
                 list(buses, text, sizeof text));
        return REFUSED;
    }
    if (named >= 0 || buses->count == 1)
        return named >= 0 ? named : 0;
    const int by_interface = options->interface_name ? find(buses, options->interface_name) : NONE;
    const int by_word = find_by_words(buses);
    if (by_interface >= 0 || by_word >= 0)
        return by_interface >= 0 ? by_interface : by_word;
    if (shows_all() && (!options->interface_name || strcmp(options->interface_name, "sim") == 0))
        return show_each(buses, options->json);
    complain("%s has %u buses: %s. Choose one with --network NAME", options->bus_file, buses->count,
             list(buses, text, sizeof text));
    return REFUSED;
}

bool load_chosen_bus(const common_options_t *options, cm1e_bus_config_t *config)
{
    static buses_t buses;
    cm1e_diag_t diag = {0};
    if (cm1e_bus_config_load_all(buses.configs, CM1E_MAX_BUSES, &buses.count, options->bus_file, &diag) != CM1E_OK) {
        fail(&diag);
        return false;
    }
    chosen = chosen >= 0 ? chosen : choose(&buses, options);
    for (uint32_t i = 0; i < buses.count; i++)
        if ((int)i != chosen)
            cm1e_bus_config_free(&buses.configs[i]);
    if (chosen < 0)
        return false;
    *config = buses.configs[chosen];
    return true;
}
