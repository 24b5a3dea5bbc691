/* The errors of a translation. */
#include <stdarg.h>
#include <string.h>

#include "st/st_state.h"

enum { TEXT_BYTES = 1000, SHOWN_BYTES = 160 };

static bool is_earlier(const st_error_t *a, const st_error_t *b)
{
    const int order = strcmp(a->file, b->file);
    return order ? order < 0 : a->line != b->line ? a->line < b->line : a->column < b->column;
}

void cm1e_st_report(st_t *st, place_t place, const char *format, ...)
{
    char text[TEXT_BYTES];
    const char *file = place.file < st->source_count ? st->sources[place.file].name : "";
    for (unsigned i = 0; i < st->error_count; i++)
        if (st->errors[i].line == place.line && st->errors[i].file == file)
            return; /* what follows from the first error of a line is of no use */
    if (st->error_count == ST_ERRORS) {
        st->suppressed++;
        return;
    }
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(text, sizeof text, format, values);
    va_end(values);
    const size_t kept = (size_t)length < sizeof text ? (size_t)length : sizeof text - 1;
    const st_error_t error = {.file = file, .line = place.line, .column = place.column,
                              .text = cm1e_st_copy(st->arena, text, kept)};
    unsigned at = st->error_count++;
    for (; at > 0 && is_earlier(&error, &st->errors[at - 1]); at--)
        st->errors[at] = st->errors[at - 1];
    st->errors[at] = error;
}

const char *cm1e_st_meant(st_t *st, const cm1e_near_t *near)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    return cm1e_st_format(st->arena, "%s", cm1e_near_text(near, text, sizeof text));
}

const char *cm1e_st_meant_var(st_t *st, const char *word, const var_t *vars, unsigned sections)
{
    cm1e_near_t near = {.word = word};
    for (; vars; vars = vars->next)
        if (sections >> vars->section & 1)
            cm1e_near_look(&near, vars->name);
    return cm1e_st_meant(st, &near);
}

static void look_at(const char *name, void *value, void *context)
{
    (void)value;
    cm1e_near_look(context, name);
}

const char *cm1e_st_meant_name(st_t *st, const char *word, const map_t *map)
{
    cm1e_near_t near = {.word = word};
    cm1e_st_map_each(map, look_at, &near);
    return cm1e_st_meant(st, &near);
}

unsigned cm1e_st_errors(const st_t *st) { return st->error_count; }
unsigned cm1e_st_suppressed(const st_t *st) { return st->suppressed; }
st_error_t cm1e_st_error(const st_t *st, unsigned n) { return st->errors[n]; }

/** The text of a line of a source, and its length. */
static const char *line_of(const st_t *st, const st_error_t *error, size_t *length)
{
    for (unsigned i = 0; i < st->source_count; i++) {
        if (st->sources[i].name != error->file)
            continue;
        const source_t *source = &st->sources[i];
        const char *at = source->shown ? source->shown : source->text;
        const char *end = at + (source->shown ? source->shown_size : source->size);
        for (uint32_t line = 1; line < error->line && at; line++) {
            at = memchr(at, '\n', (size_t)(end - at));
            at = at ? at + 1 : NULL;
        }
        const char *stop = at ? memchr(at, '\n', (size_t)(end - at)) : NULL;
        *length = at ? (size_t)((stop ? stop : end) - at) : 0;
        return at;
    }
    return NULL;
}

void cm1e_st_print_error(const st_t *st, unsigned n, FILE *file)
{
    const st_error_t *error = &st->errors[n];
    size_t length = 0;
    fprintf(file, "%s:%u:%u: error: %s\n", error->file, error->line, error->column, error->text);
    const char *line = error->line > 0 ? line_of(st, error, &length) : NULL;
    if (length > 0 && line[length - 1] == '\r')
        length--;
    if (length == 0 || length > SHOWN_BYTES)
        return;
    fputs("    ", file);
    for (size_t i = 0; i < length; i++)
        fputc((unsigned char)line[i] >= ' ' || line[i] == '\t' ? line[i] : '?', file);
    fputs("\n    ", file);
    uint32_t column = 1;
    for (size_t i = 0; i < length && column < error->column; i++)
        if (((unsigned char)line[i] & 0xC0) != 0x80) {
            fputc(line[i] == '\t' ? '\t' : ' ', file);
            column++;
        }
    fputs("^\n", file);
}
