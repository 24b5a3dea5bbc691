/* Files of TwinCAT's PLC projects (.TcPOU, .TcGVL, .TcDUT, .TcIO) are XML with Structured Text in it. They become plain
 * Structured Text, every word on its line, so that errors and the debugger name the lines of the file. */
#include "st/st_twincat.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct conversion {
    st_t *st;
    source_t *source;
    const char *at, *end;
    char *out;
    uint32_t line;
    bool declares, implements; /* within <Declaration>, <ST> */
    const char *unit;          /* word that begins the declaration of the POU */
} conversion_t;

bool cm1e_st_is_twincat(const char *text, size_t size)
{
    static const char mark[] = "<TcPlcObject";
    const size_t looked_at = size < 400 ? size : 400;
    return memmem(text, looked_at, mark, sizeof mark - 1) != NULL;
}

static void put(conversion_t *c, const char *word)
{
    const size_t length = strlen(word);
    memcpy(c->out, word, length);
    c->out += length;
}

/** Blanks keep the places of what follows in its line. */
static void skip(conversion_t *c, size_t count)
{
    for (; count > 0 && c->at < c->end; count--, c->at++) {
        *c->out++ = *c->at == '\n' ? '\n' : ' ';
        c->line += *c->at == '\n';
    }
}

static bool begins(const conversion_t *c, const char *word)
{
    const size_t length = strlen(word);
    return (size_t)(c->end - c->at) >= length && memcmp(c->at, word, length) == 0;
}

/** The value of an attribute of the tag that ends at `close`. */
static const char *attribute(conversion_t *c, const char *close, const char *name)
{
    const char *found = memmem(c->at, (size_t)(close - c->at), name, strlen(name));
    const char *begin = found ? found + strlen(name) : NULL;
    const char *stop = begin ? memchr(begin, '"', (size_t)(close - begin)) : NULL;
    return stop ? cm1e_st_copy(c->st->arena, begin, (size_t)(stop - begin)) : "";
}

/** The first word of a declaration, behind comments and pragmas. */
static const char *first_word(const char *text, const char *end)
{
    static const char *const words[] = {"FUNCTION_BLOCK", "FUNCTION", "PROGRAM", "INTERFACE"};
    while (text < end) {
        const char *close = *text == '{'                    ? "}"
                            : strncmp(text, "(*", 2) == 0   ? "*)"
                            : strncmp(text, "//", 2) == 0   ? "\n"
                                                            : NULL;
        const char *stop = close ? memmem(text, (size_t)(end - text), close, strlen(close)) : NULL;
        for (size_t i = 0; i < sizeof words / sizeof words[0] && !close; i++)
            if (strncasecmp(text, words[i], strlen(words[i])) == 0)
                return words[i];
        if (close && !stop)
            break;
        text = close ? stop + strlen(close) : text + 1;
    }
    return NULL;
}

static void copy_text(conversion_t *c)
{
    static const char mark[] = "<![CDATA[";
    skip(c, sizeof mark - 1);
    const char *stop = memmem(c->at, (size_t)(c->end - c->at), "]]>", 3);
    stop = stop ? stop : c->end;
    if (c->declares && !c->unit)
        c->unit = first_word(c->at, stop);
    if (!c->declares && !c->implements) {
        skip(c, (size_t)(stop - c->at));
        return;
    }
    for (; c->at < stop; c->at++) {
        c->line += *c->at == '\n';
        *c->out++ = *c->at;
    }
}

static void begin_element(conversion_t *c, const char *name, const char *close)
{
    static const char *const others[] = {"NWL", "SFC", "CFC", "LD", "FBD", "IL", "UML"};
    const bool empty = close[-1] == '/';
    if (strcmp(name, "Declaration") == 0)
        c->declares = !empty;
    else if (strcmp(name, "ST") == 0)
        c->implements = !empty;
    else if (strcmp(name, "GVL") == 0)
        c->source->list = attribute(c, close, "Name=\"");
    else if (strcmp(name, "Action") == 0)
        put(c, cm1e_st_format(c->st->arena, " ACTION %s : ", attribute(c, close, "Name=\"")));
    else if (strcmp(name, "Get") == 0)
        put(c, " GET ");
    else if (strcmp(name, "Set") == 0)
        put(c, " SET ");
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        if (strcmp(name, others[i]) == 0)
            cm1e_st_report(c->st,
                           (place_t){.file = (uint16_t)(c->source - c->st->sources), .line = c->line, .column = 1},
                           "this part is not in Structured Text (it is <%s>): write it in Structured Text", name);
}

static void end_element(conversion_t *c, const char *name)
{
    static const struct { const char *element, *word; } ends[] = {
        {"Method", " END_METHOD "}, {"Property", " END_PROPERTY "}, {"Action", " END_ACTION "}, {"Get", " END_GET "},
        {"Set", " END_SET "}, {"Itf", " END_INTERFACE "}};
    if (strcmp(name, "Declaration") == 0)
        c->declares = false;
    else if (strcmp(name, "ST") == 0)
        c->implements = false;
    else if (strcmp(name, "POU") == 0 && c->unit)
        put(c, cm1e_st_format(c->st->arena, " END_%s ", c->unit));
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++)
        if (strcmp(name, ends[i].element) == 0)
            put(c, ends[i].word);
}

static void tag(conversion_t *c)
{
    const char *close = memchr(c->at, '>', (size_t)(c->end - c->at));
    close = close ? close : c->end - 1;
    const bool ends = begins(c, "</");
    const char *begin = c->at + 1 + ends;
    const char *name = cm1e_st_copy(c->st->arena, begin, strcspn(begin, " \t\r\n/>"));
    if (ends)
        end_element(c, name);
    else
        begin_element(c, name, close);
    skip(c, (size_t)(close + 1 - c->at));
}

/** Room for the words that replace tags: each is shorter than three times its tag. */
void cm1e_st_twincat(st_t *st, source_t *source)
{
    conversion_t c = {.st = st, .source = source, .at = source->text, .end = source->text + source->size, .line = 1};
    char *text = c.out = cm1e_st_take(st->arena, source->size * 3 + 64);
    while (c.at < c.end) {
        if (begins(&c, "<![CDATA["))
            copy_text(&c);
        else if (*c.at == '<')
            tag(&c);
        else
            skip(&c, 1);
    }
    source->qualified = source->list && memmem(source->text, source->size, "'qualified_only'", 16);
    source->shown = source->text;
    source->shown_size = source->size;
    source->text = text;
    source->size = (size_t)(c.out - text);
}
