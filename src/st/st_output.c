/* Writing C: lines, places, texts, and the names of types. */
#include "st/st_emit.h"

#include <stdarg.h>

void cm1e_st_put(st_t *st, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vfprintf(st->out, format, values);
    va_end(values);
}

void cm1e_st_begin_line(st_t *st) { fprintf(st->out, "%*s", st->indent * 4, ""); }

void cm1e_st_line(st_t *st, const char *format, ...)
{
    va_list values;
    cm1e_st_begin_line(st);
    va_start(values, format);
    vfprintf(st->out, format, values);
    va_end(values);
}

void cm1e_st_put_quoted(st_t *st, const char *text)
{
    fputc('"', st->out);
    for (; *text; text++) {
        const unsigned char byte = (unsigned char)*text;
        if (byte < ' ' || byte >= 0x7F || byte == '?')
            fprintf(st->out, "\\%03o", byte); /* "??/" would be a trigraph */
        else
            fprintf(st->out, byte == '"' || byte == '\\' ? "\\%c" : "%c", byte);
    }
    fputc('"', st->out);
}

void cm1e_st_place(st_t *st, place_t place)
{
    cm1e_st_put(st, "#line %u ", place.line);
    cm1e_st_put_quoted(st, st->sources[place.file].name);
    cm1e_st_put(st, "\n");
}

const char *cm1e_st_c_type(st_t *st, const type_t *type)
{
    if (type->kind == T_REF)
        return cm1e_st_format(st->arena, "%s *", cm1e_st_c_type(st, type->element));
    if (type->kind == T_NONE)
        return "void";
    return type->c_name;
}

const char *cm1e_st_int64(st_t *st, int64_t value)
{
    return value == INT64_MIN ? "INT64_MIN" : cm1e_st_format(st->arena, "INT64_C(%lld)", (long long)value);
}

const char *cm1e_st_plain_type(const type_t *type)
{
    switch (type->kind) {
    case T_ENUM: return cm1e_st_plain_type(type->element);
    case T_BOOL:
    case T_USINT: return "BYTE";
    case T_UINT: return "WORD";
    case T_UDINT: return "DWORD";
    case T_ULINT: return "LWORD";
    case T_TIME:
    case T_DATE:
    case T_TOD:
    case T_DT: return "LINT";
    default: return type->name;
    }
}
