/* Options and words of the command line: unknown ones are refused with the one that may have been meant. */
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "core/near.h"

const exit_status_t exit_statuses[] = {
    {EXIT_OK, "done"},
    {EXIT_FAILED, "not done, or not completely: the text on standard error says what failed, and what to do"},
    {EXIT_WRONG_USE, "refused, nothing was done: wrong options, numbers, names or bus file, a file that cannot be read, "
                     "also where a running program refuses them"},
    {0, NULL},
};

bool visit_options(const struct argp *argp, option_visitor_t visit, void *context)
{
    for (const struct argp_option *option = argp->options; option && (option->name || option->key); option++)
        if (!(option->flags & OPTION_HIDDEN) && !visit(option, context))
            return false;
    for (const struct argp_child *child = argp->children; child && child->argp; child++)
        if (!visit_options(child->argp, visit, context))
            return false;
    return true;
}

/* ---- unknown long options ---------------------------------------------------------------------------------------- */

typedef struct search {
    const char *name;   /* as it was typed, up to "=" */
    size_t bytes;
    int key;            /* or the letter of a short option; 0: a long one */
    bool found, has_value;
    cm1e_near_t near;
} search_t;

static bool look(const struct argp_option *option, void *context)
{
    search_t *search = context;
    const bool is_it = search->key ? option->key == search->key
                                   : option->name && strncmp(option->name, search->name, search->bytes) == 0;
    if (is_it) {
        search->found = true;
        search->has_value = option->arg != NULL;
        return search->key == 0 && strlen(option->name) != search->bytes; /* an exact one ends the search */
    }
    if (!search->key && option->name)
        cm1e_near_look(&search->near, option->name);
    return true;
}

/** False, with a complaint: there is no such option. */
static bool check_long(const struct argp *argp, const char *word, bool *takes_next)
{
    static const struct argp_option own[] = {{"help", '?', NULL, 0, NULL, 0}, {"usage", 0x1000, NULL, 0, NULL, 0}, {0}};
    static const struct argp builtin = {own, NULL, NULL, NULL, NULL, NULL, NULL};
    char name[64], text[CM1E_NEAR_TEXT_BYTES];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(word, "="), word);
    search_t search = {.name = name, .bytes = strlen(name), .near = {.word = name}};
    if (visit_options(argp, look, &search))
        visit_options(&builtin, look, &search);
    *takes_next = search.has_value && !strchr(word, '=');
    if (search.found)
        return true;
    if (search.near.nearest) {
        char dashed[64];
        snprintf(dashed, sizeof dashed, "--%.60s", search.near.nearest);
        search.near.nearest = dashed;
        cm1e_near_text(&search.near, text, sizeof text);
    } else {
        snprintf(text, sizeof text, "; --help lists the options");
    }
    complain("there is no option \"--%s\"%s", name, text);
    return false;
}

/** Whether the letters of short options end with one that takes the next word as its value. */
static bool short_takes_next(const struct argp *argp, const char *letters)
{
    for (; *letters; letters++) {
        search_t search = {.key = *letters};
        visit_options(argp, look, &search);
        if (search.has_value)
            return letters[1] == '\0';
    }
    return false;
}

int parse_options(const struct argp *argp, int argc, char **argv, void *options)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++) {
        bool takes_next = false;
        if (strncmp(argv[i], "--", 2) == 0 && !check_long(argp, argv[i] + 2, &takes_next))
            return EXIT_WRONG_USE;
        if (argv[i][0] == '-' && argv[i][1] != '-')
            takes_next = short_takes_next(argp, argv[i] + 1);
        i += takes_next;
    }
    return argp_parse(argp, argc, argv, 0, NULL, options);
}

void need_name(struct argp_state *state, const char *what, const char *word)
{
    if (!word[0])
        argp_error(state, "%s needs a name; it is empty", what);
}

/* ---- words ------------------------------------------------------------------------------------------------------- */

int choose_word(const char *what, const char *word, const char *words)
{
    char list[128] = "", one[32], kept[32] = "", text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = word};
    int number = 0;
    for (const char *at = words; *at; number++) {
        const size_t bytes = strcspn(at, "|");
        snprintf(one, sizeof one, "%.*s", (int)bytes, at);
        if (strcasecmp(one, word) == 0)
            return number;
        const size_t before = near.nearest ? near.distance : SIZE_MAX;
        cm1e_near_look(&near, one);
        if (near.nearest && near.distance < before)
            near.nearest = strcpy(kept, one);
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", at == words ? "" : at[bytes] ? ", " : " and ",
                 one);
        at += bytes + (at[bytes] == '|');
    }
    complain("there is no %s \"%s\"; there %s %s%s", what, word, number > 1 ? "are" : "is only", list,
             cm1e_near_text(&near, text, sizeof text));
    return -1;
}
