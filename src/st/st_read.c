/* Reading sources: files, our own interface, and the run of lexer and parser over each. */
#include "st/st_parsing.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "st/st_embedded.h"
#include "st/st_twincat.h"

enum { LISTED_MOST = 10000 };

typedef void *yyscan_t;
int cm1e_st_yylex_init_extra(parsing_t *parsing, yyscan_t *scanner);
int cm1e_st_yylex_destroy(yyscan_t scanner);
struct yy_buffer_state;
struct yy_buffer_state *cm1e_st_yy_scan_bytes(const char *bytes, int length, yyscan_t scanner);
int cm1e_st_yyparse(parsing_t *parsing);

st_t *cm1e_st_new_bare(void)
{
    st_t *st = calloc(1, sizeof *st);
    if (!st)
        return NULL;
    st->arena = cm1e_st_arena_new();
    st->types = cm1e_st_map_new(st->arena);
    st->units = cm1e_st_map_new(st->arena);
    st->globals = cm1e_st_map_new(st->arena);
    st->enumerators = cm1e_st_map_new(st->arena);
    st->spaces = cm1e_st_map_new(st->arena);
    st->used = cm1e_st_map_new(st->arena);
    cm1e_st_begin_types(st);
    st->listed_most = LISTED_MOST;
    return st;
}

void cm1e_st_list_most(st_t *st, uint64_t count) { st->listed_most = count; }

st_t *cm1e_st_new(void)
{
    st_t *st = cm1e_st_new_bare();
    if (!st)
        return NULL;
    for (const embedded_t *part = cm1e_st_interface_parts; part->begin; part++) {
        cm1e_st_add_text(st, part->name, part->begin, (size_t)(part->end - part->begin));
        st->sources[st->source_count - 1].external = !part->library;
        st->sources[st->source_count - 1].library = part->library;
        st->sources[st->source_count - 1].symbol = part->symbol;
    }
    return st;
}

void cm1e_st_free(st_t *st)
{
    if (!st)
        return;
    cm1e_st_arena_free(st->arena);
    free(st);
}

uint64_t cm1e_st_interface(void)
{
    uint64_t hash = UINT64_C(14695981039346656037); /* FNV-1a */
    for (const embedded_t *part = cm1e_st_interface_parts; part->begin; part++)
        for (const char *at = part->begin; at < part->end; at++)
            hash = (hash ^ (unsigned char)*at) * UINT64_C(1099511628211);
    return hash;
}

/** What the text is, if it is none of the language at all; NULL: nothing is known against it. */
static const char *foreign(const char *text, size_t size)
{
    const size_t mark = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    if (size >= 2 && (memcmp(text, "\xFF\xFE", 2) == 0 || memcmp(text, "\xFE\xFF", 2) == 0))
        return "this file is UTF-16: save it as UTF-8";
    if (size > mark && text[mark] == '<')
        return "this file is XML, and none of a TwinCAT project (.TcPOU, .TcGVL, .TcDUT, .TcIO): copy the Structured "
               "Text out of it into a file of its own";
    return NULL;
}

void cm1e_st_add_text(st_t *st, const char *name, const char *text, size_t size)
{
    if (st->source_count == ST_SOURCES) {
        cm1e_st_report(st, (place_t){0}, "there are more than %d sources", ST_SOURCES);
        return;
    }
    source_t *source = &st->sources[st->source_count++];
    *source = (source_t){.name = cm1e_st_copy(st->arena, name, strlen(name)), .size = size,
                         .text = cm1e_st_copy(st->arena, text, size)};
    const char *why = foreign(text, size);
    if (cm1e_st_is_twincat(text, size)) {
        cm1e_st_twincat(st, source);
    } else if (why) {
        cm1e_st_report(st, (place_t){.file = (uint16_t)(st->source_count - 1), .line = 1, .column = 1}, "%s", why);
        source->size = 0; /* all further errors would follow from that */
    }
}

cm1e_error_t cm1e_st_add_file(st_t *st, const char *path, cm1e_diag_t *diag)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, (uint32_t)errno, "%s cannot be read: %s", path, strerror(errno));
    char *text = malloc(ST_SOURCE_BYTES + 1);
    const size_t size = text ? fread(text, 1, ST_SOURCE_BYTES + 1, file) : 0;
    const bool failed = !text || ferror(file);
    cm1e_error_t error = CM1E_OK;
    if (failed)
        error = cm1e_diag_set(diag, CM1E_ERROR_IO, (uint32_t)errno, "%s cannot be read: %s", path, strerror(errno));
    else if (size > ST_SOURCE_BYTES)
        error = cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s is larger than %d MB; divide it", path,
                              ST_SOURCE_BYTES >> 20);
    else
        cm1e_st_add_text(st, path, text, size);
    free(text);
    fclose(file);
    return error;
}

/* ---- what the lexer calls ---------------------------------------------------------------------------------------- */

/** What stands between words, and does not count: blanks, comments, pragmas, the mark of UTF-8 that begins a file. */
static bool is_between(const char *text, size_t length)
{
    static const char *const begins[] = {"//", "(*", "/*", "{", "\xEF\xBB\xBF"};
    for (size_t i = 0; i < sizeof begins / sizeof begins[0]; i++)
        if (length >= strlen(begins[i]) && memcmp(text, begins[i], strlen(begins[i])) == 0)
            return true;
    return length == 0 || (unsigned char)text[0] <= ' ';
}

void cm1e_st_step(parsing_t *parsing, const char *text, size_t length, bool skipped, place_t *place)
{
    *place = (place_t){.file = (uint16_t)parsing->st->source, .line = parsing->line, .column = parsing->column};
    const size_t kept = length < sizeof parsing->last - 1 ? length : sizeof parsing->last - 1;
    if (!skipped && !is_between(text, length)) {
        memcpy(parsing->before, parsing->last, sizeof parsing->before);
        memcpy(parsing->last, text, kept);
        parsing->last[kept] = '\0';
    }
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '\n') {
            parsing->line++;
            parsing->column = 1;
        } else if (((unsigned char)text[i] & 0xC0) != 0x80) { /* the bytes of a character of UTF-8 count once */
            parsing->column++;
        }
    }
}

/* They are names wherever a name makes sense: programs have variables that are called step or reference. */
static const char *const missing[] = {
    "VAR_ACCESS", "VAR_CONFIG", "GOTO", "JMP", "STEP", "INITIAL_STEP", "TRANSITION",
};

bool cm1e_st_begins_part(const parsing_t *parsing)
{
    return cm1e_st_in_heading(parsing) || strcmp(parsing->before, ";") == 0 ||
           strncasecmp(parsing->before, "END_", 4) == 0;
}

/* A program may be called Action: what stands right behind PROGRAM is its name. */
bool cm1e_st_in_heading(const parsing_t *parsing)
{
    return parsing->heading && strcasecmp(parsing->before, "PROGRAM") != 0;
}

bool cm1e_st_is_modifier(const parsing_t *parsing)
{
    static const char *const sections[] = {"VAR", "VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR_TEMP"};
    static const char *const words[] = {"METHOD", "PROPERTY", "FUNCTION_BLOCK", "CLASS", "ABSTRACT", "FINAL", "PUBLIC",
                                        "PRIVATE", "PROTECTED", "INTERNAL", "OVERRIDE"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (parsing->heading && strcasecmp(parsing->before, words[i]) == 0)
            return true;
    for (size_t i = 0; i < sizeof sections / sizeof sections[0]; i++)
        if (strcasecmp(parsing->before, sections[i]) == 0)
            return true;
    return false;
}

bool cm1e_st_unsupported(parsing_t *parsing, place_t place)
{
    for (size_t i = 0; i < sizeof missing / sizeof missing[0]; i++)
        if (strcasecmp(parsing->last, missing[i]) == 0 || strcasecmp(parsing->before, missing[i]) == 0) {
            cm1e_st_report(parsing->st, place, "%s is not supported by this translator (docs/STRUCTURED-TEXT.md says "
                           "what is)", missing[i]);
            return true;
        }
    return false;
}

/** What a sign of another language is here, with a semicolon before it; "": nothing. */
static const char *written_here(char character)
{
    switch (character) {
    case '!': return "; \"not equal\" is <>, and a negation is NOT";
    case '|': return "; that is OR";
    case '%': return "; a remainder is MOD";
    case '~': return "; a negation is NOT";
    case '?': return "; SEL(condition, value if FALSE, value if TRUE) chooses";
    default: return "";
    }
}

void cm1e_st_bad_character(parsing_t *parsing, place_t place, char character)
{
    if (character == '%' && strcmp(parsing->before, ".") == 0)
        cm1e_st_report(parsing->st, place, "parts of a value (.%%X3, .%%B1) are not supported: a single bit is "
                       "value.3, and SHR and WORD_TO_BYTE give the rest");
    else if (character > ' ' && character < 0x7F)
        cm1e_st_report(parsing->st, place, "\"%c\" is not a character of the language here%s", character,
                       written_here(character));
    else
        cm1e_st_report(parsing->st, place, "the byte 0x%02X is not a character of the language; only comments and "
                       "texts have others than those of ASCII", (unsigned char)character);
}

static void parse_source(st_t *st)
{
    parsing_t parsing = {.st = st, .line = 1, .column = 1};
    const source_t *source = &st->sources[st->source];
    st->scope = cm1e_st_take(st->arena, sizeof *st->scope);
    *st->scope = (scope_t){.space = ""};
    if (cm1e_st_yylex_init_extra(&parsing, &parsing.scanner) != 0)
        return;
    if (cm1e_st_yy_scan_bytes(source->text, (int)source->size, parsing.scanner))
        cm1e_st_yyparse(&parsing);
    cm1e_st_yylex_destroy(parsing.scanner);
}

void cm1e_st_parse(st_t *st)
{
    for (st->source = 0; st->source < st->source_count; st->source++)
        parse_source(st);
    st->scope = NULL;
}
