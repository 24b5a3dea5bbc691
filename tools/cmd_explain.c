/** cm1e explain: what a number or a name means that the library, a drive or EtherCAT shows. It needs no network. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "core/near.h"
#include "device/emergency_codes.h"
#include "meaning.h"

enum { KEY_JSON = 0x500, QUERY_BYTES = 120, NEAR_SHOWN = 4, EMERGENCY_FIRST = 0x1000 };

typedef struct explain_options {
    bool json;
    char query[QUERY_BYTES]; /**< the words, one blank between them */
} explain_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    explain_options_t *options = state->input;
    const size_t length = strlen(options->query);
    switch (key) {
    case KEY_JSON: options->json = want_json(); return 0;
    case ARGP_KEY_ARG:
        if (length + strlen(arg) + 2 > sizeof options->query)
            argp_error(state, "the question is too long: at most %d characters", QUERY_BYTES - 2);
        snprintf(options->query + length, sizeof options->query - length, "%s%s", length ? " " : "", arg);
        return 0;
    case ARGP_KEY_END:
        if (!options->query[0])
            argp_error(state, "what is to be explained? A number (0xFF05, 16#1E47, -71) or words of its text (lag)");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- numbers ----------------------------------------------------------------------------------------------------- */

/** Up to two numbers that a word can be: digits alone are decimal, and hexadecimal as manuals print codes. */
typedef struct question {
    uint32_t codes[2];
    int code_count;
    int error;          /**< a negative number: cm1e_error_t; 0: none */
} question_t;

static bool read_code(const char *digits, int base, const char *tail, question_t *question)
{
    char *end;
    if (!isxdigit((unsigned char)digits[0]))
        return false;
    const unsigned long long value = strtoull(digits, &end, base);
    if (end == digits || strcasecmp(end, tail) != 0 || value > UINT32_MAX)
        return false;
    if (question->code_count == 0 || question->codes[0] != (uint32_t)value)
        question->codes[question->code_count++] = (uint32_t)value;
    return true;
}

/** 0xFF05, 16#FF05, FF05h, 65285, FF05, -71. False: it is none of these. */
static bool read_question(const char *word, question_t *question)
{
    *question = (question_t){0};
    if (word[0] == '-') {
        char *end;
        const long value = strtol(word, &end, 10);
        question->error = value < 0 && value > -1000 ? (int)value : 0;
        return question->error && !*end;
    }
    if (strncasecmp(word, "0x", 2) == 0 || strncmp(word, "16#", 3) == 0)
        return read_code(word + (word[1] == '6' ? 3 : 2), 16, "", question);
    if (read_code(word, 16, "h", question))
        return true;
    read_code(word, 10, "", question);
    /* "added" is a word, "FADE" may be either: letters alone are words unless there is a digit. */
    if (word[strcspn(word, "0123456789")])
        read_code(word, 16, "", question);
    return question->code_count > 0;
}

static bool is_asked(const meaning_t *row, const question_t *question)
{
    for (int i = 0; i < question->code_count; i++)
        if (row->code == question->codes[i])
            return true;
    return question->error && row->error == question->error;
}

/* ---- words ------------------------------------------------------------------------------------------------------- */

/** Whether a word of the text begins with these bytes. */
static bool has_word(const char *text, const char *word, size_t bytes)
{
    for (const char *at = text; text && *at; at++)
        if ((at == text || !isalnum((unsigned char)at[-1])) && strncasecmp(at, word, bytes) == 0)
            return true;
    return false;
}

/** All words of the question are in the name, the text or the cause. */
static bool has_words(const meaning_t *row, const char *query)
{
    for (const char *at = query; *at; at += strspn(at, " ")) {
        const size_t bytes = strcspn(at, " ");
        const size_t prefix = strncmp(at, "CM1E_ERROR_", 11) == 0 ? 5 : 0; /* the name as C has it */
        if (!has_word(row->name, at + prefix, bytes - prefix) && !has_word(row->text, at, bytes)
            && !has_word(row->cause, at, bytes))
            return false;
        at += bytes;
    }
    return true;
}

static void look_at_words(cm1e_near_t *near, const char *text, char *kept, size_t size)
{
    char word[48];
    for (const char *at = text; at && *at;) {
        const char *const before = near->nearest;
        size_t bytes = 0;
        while (isalpha((unsigned char)at[bytes]))
            bytes++;
        snprintf(word, sizeof word, "%.*s", (int)bytes, at);
        if (bytes > 2)
            cm1e_near_look(near, word);
        if (near->nearest != before || near->nearest == word) {
            snprintf(kept, size, "%s", near->nearest);
            near->nearest = kept;
        }
        at += bytes + (at[bytes] != '\0');
    }
}

/* ---- what is near ------------------------------------------------------------------------------------------------ */

static uint32_t between(uint32_t a, uint32_t b) { return a > b ? a - b : b - a; }

/** How far a code is from the one that was asked for: by its digits first, by its number then. */
static uint64_t how_far(const meaning_t *row, uint32_t code)
{
    char digits[12], asked[12];
    snprintf(digits, sizeof digits, "%0*X", row->digits, (unsigned)row->code);
    snprintf(asked, sizeof asked, "%0*X", row->digits, (unsigned)code);
    return (uint64_t)cm1e_edit_distance(digits, asked) << 32 | between(row->code, code);
}

static void print_near_codes(const meaning_t *rows, size_t count, const question_t *question)
{
    uint64_t shown = 0;
    const uint32_t code = question->code_count ? question->codes[0] : (uint32_t)(0x1E00 - question->error);
    fputs("near:\n", stderr);
    for (int n = 0; n < NEAR_SHOWN; n++) {
        uint64_t nearest = UINT64_MAX;
        for (size_t i = 0; i < count; i++) {
            const uint64_t distance = how_far(&rows[i], code) + 1;
            nearest = distance > shown && distance < nearest ? distance : nearest;
        }
        for (size_t i = 0; i < count && nearest < UINT64_MAX; i++)
            if (how_far(&rows[i], code) + 1 == nearest)
                fprintf(stderr, "  0x%0*X  %s: %s\n", rows[i].digits, (unsigned)rows[i].code, rows[i].whose,
                        rows[i].text);
        shown = nearest;
    }
}

static int complain_unknown(const meaning_t *rows, size_t count, const char *query, const question_t *question)
{
    if (question->code_count || question->error) {
        complain("no table has \"%s\": no device error, ErrorID, AL status code, SDO abort code, FoE error or status "
                 "of a Cool Muscle", query);
        for (int i = 0; i < question->code_count; i++)
            if (question->codes[i] >= EMERGENCY_FIRST && question->codes[i] <= UINT16_MAX)
                fprintf(stderr, "as an emergency of a slave, 0x%04X is of the class: %s\n",
                        (unsigned)question->codes[i], cm1e_emergency_class((uint16_t)question->codes[i]));
        print_near_codes(rows, count, question);
        return EXIT_FAILED;
    }
    char text[CM1E_NEAR_TEXT_BYTES], kept[48] = "";
    cm1e_near_t near = {.word = query};
    for (size_t i = 0; i < count; i++) {
        look_at_words(&near, rows[i].text, kept, sizeof kept);
        look_at_words(&near, rows[i].name, kept, sizeof kept);
    }
    complain("no text has \"%s\"%s", query, cm1e_near_text(&near, text, sizeof text));
    return EXIT_FAILED;
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

static void print_line(const char *label, const char *text)
{
    if (text && text[0])
        printf("  %-7s %s\n", label, text);
}

static void print_meaning(const meaning_t *row)
{
    printf("0x%0*X  %s\n", row->digits, (unsigned)row->code, row->text);
    print_line("whose", row->whose);
    print_line("name", row->name);
    print_line(row->error ? "when" : "cause", row->cause);
    print_line("effect", row->effect);
    print_line("cure", row->cure);
    print_line("clause", row->clause);
    print_line("page", row->page);
}

static json_t *meaning_as_json(const meaning_t *row)
{
    return json_pack("{s:I, s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:s}", "code", (json_int_t)row->code, "text", row->text,
                     "whose", row->whose, "name", row->name ? row->name : "", "cause", row->cause ? row->cause : "",
                     "effect", row->effect ? row->effect : "", "cure", row->cure ? row->cure : "", "clause",
                     row->clause ? row->clause : "", "page", row->page);
}

static int explain(const explain_options_t *options, const meaning_t *rows, size_t count)
{
    question_t question;
    const bool is_number = read_question(options->query, &question);
    json_t *all = options->json ? json_array() : NULL;
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        if (is_number ? !is_asked(&rows[i], &question) : !has_words(&rows[i], options->query))
            continue;
        if (all)
            json_array_append_new(all, meaning_as_json(&rows[i]));
        else {
            printf("%s", found ? "\n" : "");
            print_meaning(&rows[i]);
        }
        found++;
    }
    if (all)
        print_json(all);
    return found ? EXIT_OK : complain_unknown(rows, count, options->query, &question);
}

static const struct argp_option table[] = {{"json", KEY_JSON, NULL, 0, "Write JSON", 0}, {0}};
const struct argp argp_explain = {
    table, parse, "NUMBER|WORD...",
    "Explains what the library, a motor or EtherCAT shows: error codes of drives (object 0x603F), ErrorIDs of "
    "function blocks, AL status codes, SDO abort codes, statuses of motors behind a bridge. A number is given as "
    "0xFF05, 16#FF05, FF05h or in decimal, an error of the C interface as -71; all its meanings are shown. Words "
    "are looked for in names and texts: `cm1e explain lag`.", NULL, NULL, NULL};

int command_explain(int argc, char **argv)
{
    explain_options_t options = {0};
    char *words[MAX_WORDS + 2];
    const int word_count = shelter_negative_value(argc, argv, words);
    if (word_count < 0 || parse_options(&argp_explain, word_count, words, &options))
        return EXIT_WRONG_USE;
    size_t count;
    meaning_t *rows = all_meanings(&count);
    if (!rows) {
        complain("out of memory");
        return EXIT_FAILED;
    }
    const int status = explain(&options, rows, count);
    free(rows);
    return status;
}
