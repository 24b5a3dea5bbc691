/* Literals: their text becomes a constant and a type. A number without a type is of T_ANY_INT or T_ANY_REAL, until what
 * it is used for says more. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"

#define NS_PER_S INT64_C(1000000000)
enum { DAY_S = 86400, TEXT_BYTES = 128 };

/** An underscore is between two digits of a number, or two characters of what has a '#'. */
static bool has_right_underscores(const char *text)
{
    int (*const is_right)(int) = strchr(text, '#') ? isalnum : isdigit;
    for (const char *at = strchr(text, '_'); at; at = strchr(at + 1, '_'))
        if (at == text || !is_right((unsigned char)at[-1]) || !is_right((unsigned char)at[1]))
            return false;
    return true;
}

/** The text in capitals, without underscores. Too long for any literal: cut, which no literal survives. */
static void clean(const char *text, char *cleaned)
{
    size_t used = 0;
    for (; *text && used < TEXT_BYTES - 1; text++)
        if (*text != '_')
            cleaned[used++] = (char)(*text >= 'a' && *text <= 'z' ? *text - 'a' + 'A' : *text);
    cleaned[used] = '\0';
}

static expr_t *made(st_t *st, place_t place, type_kind_t kind, constant_t value)
{
    expr_t *expr = cm1e_st_node(st, E_LITERAL, place, NULL, NULL);
    expr->type = st->elementary[kind];
    expr->value = value;
    expr->value.known = true;
    return expr;
}

static expr_t *wrong(st_t *st, place_t place)
{
    expr_t *expr = cm1e_st_node(st, E_LITERAL, place, NULL, NULL);
    expr->type = st->elementary[T_WRONG];
    return expr;
}

/** "12", "16#FF", "-3". False: no number, or more than 64 bits. */
static bool read_integer(const char *text, constant_t *value)
{
    const bool negative = *text == '-';
    char *end = NULL;
    text += *text == '-' || *text == '+';
    const char *mark = strchr(text, '#');
    int base = 10;
    if (mark) {
        base = (int)strtol(text, &end, 10);
        if (end != mark || (base != 2 && base != 8 && base != 16))
            return false;
        text = mark + 1;
    }
    errno = 0;
    const uint64_t number = strtoull(text, &end, base);
    if (errno != 0 || end == text || *end != '\0' || *text == '-' || *text == '+')
        return false;
    if (negative && number > (uint64_t)INT64_MAX + 1)
        return false;
    value->huge = !negative && number > INT64_MAX;
    value->integer = (int64_t)(negative ? 0 - number : number);
    return true;
}

static expr_t *number(st_t *st, place_t place, const char *text)
{
    constant_t value = {0};
    if (strchr(text, '#') || !strpbrk(text, ".E")) {
        if (read_integer(text, &value))
            return made(st, place, T_ANY_INT, value);
        cm1e_st_report(st, place, "\"%s\" is not a number of at most 64 bits; a base is 2, 8 or 16, as in 16#FF", text);
        return wrong(st, place);
    }
    char *end;
    value.real = strtod(text, &end);
    if (isfinite(value.real) && *end == '\0')
        return made(st, place, T_ANY_REAL, value);
    cm1e_st_report(st, place, *end ? "\"%s\" is no number" : "\"%s\" is larger than any LREAL", text);
    return wrong(st, place);
}

/** INT#5, REAL#1.5, BOOL#1: a number of an elementary type. */
static expr_t *typed_number(st_t *st, place_t place, const char *name, const char *text)
{
    type_t *type = cm1e_st_elementary(st, name);
    if (!type || cm1e_st_is_time(type->kind)) {
        cm1e_st_report(st, place, "\"%s\" is no type of numbers; write for instance INT#5 or WORD#16#FF", name);
        return wrong(st, place);
    }
    expr_t *expr = number(st, place, text);
    if (expr->type->kind == T_WRONG)
        return expr;
    if (cm1e_st_is_floating(type->kind) && expr->type->kind == T_ANY_INT)
        expr->value = (constant_t){.known = true, .real = expr->value.huge ? (double)(uint64_t)expr->value.integer
                                                                          : (double)expr->value.integer};
    else if ((expr->type->kind == T_ANY_REAL) != cm1e_st_is_floating(type->kind) ||
             !cm1e_st_fits(type->kind, &expr->value)) {
        cm1e_st_report(st, place, "%s is not a value of %s", text, type->name);
        return wrong(st, place);
    }
    if (type->kind == T_REAL)
        expr->value.real = (float)expr->value.real;
    expr->type = type;
    return expr;
}

/** "1H2M3.5S" in ns; false: not a duration. Units come in falling order, only the last may have a fraction. */
static bool read_duration(const char *text, int64_t *result)
{
    static const struct { const char *name; int64_t ns; } units[] = {
        {"D", DAY_S * NS_PER_S}, {"H", 3600 * NS_PER_S}, {"MS", 1000000}, {"M", 60 * NS_PER_S}, {"S", NS_PER_S},
        {"US", 1000}, {"NS", 1},
    };
    long double sum = 0;
    int64_t last = INT64_MAX;
    bool fraction = false;
    const bool negative = *text == '-';
    text += *text == '-' || *text == '+';
    if (!*text)
        return false;
    while (*text) {
        char *end;
        const size_t digits = strspn(text, "0123456789.");
        const long double count = strtold(text, &end);
        size_t unit = 0;
        if (digits == 0 || fraction || end != text + digits)
            return false;
        fraction = memchr(text, '.', digits) != NULL;
        for (text = end; unit < sizeof units / sizeof units[0]; unit++) {
            const size_t length = strlen(units[unit].name);
            if (strncmp(text, units[unit].name, length) == 0 && (!text[length] || strchr("0123456789", text[length])))
                break;
        }
        if (unit == sizeof units / sizeof units[0] || units[unit].ns >= last)
            return false;
        last = units[unit].ns;
        sum += count * (long double)last;
        text += strlen(units[unit].name);
    }
    const long double ns = roundl(negative ? -sum : sum);
    if (ns < (long double)INT64_MIN || ns > (long double)INT64_MAX)
        return false;
    *result = (int64_t)ns;
    return true;
}

static bool is_leap(long year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

/** "2024-01-31" in ns since 1970-01-01; `end` is behind it. */
static bool read_date(const char *text, char **end, int64_t *result)
{
    static const int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    const long year = strtol(text, end, 10);
    const long month = **end == '-' ? strtol(*end + 1, end, 10) : 0;
    const long day = **end == '-' ? strtol(*end + 1, end, 10) : 0;
    if (year < 1970 || year > 2262 || month < 1 || month > 12)
        return false;
    if (day < 1 || day > days[month - 1] + (month == 2 && is_leap(year)))
        return false;
    int64_t count = day - 1;
    for (long y = 1970; y < year; y++)
        count += is_leap(y) ? 366 : 365;
    for (long m = 1; m < month; m++)
        count += days[m - 1] + (m == 2 && is_leap(year));
    if (count > INT64_MAX / (DAY_S * NS_PER_S) - 1)
        return false;
    *result = count * DAY_S * NS_PER_S;
    return true;
}

/** "12:30:15.5" in ns since midnight. */
static bool read_clock(const char *text, int64_t *result)
{
    char *end;
    const long hour = strtol(text, &end, 10);
    const long minute = *end == ':' ? strtol(end + 1, &end, 10) : 60;
    const double second = *end == ':' ? strtod(end + 1, &end) : 0;
    if (*end != '\0' || hour < 0 || hour > 23 || minute < 0 || minute > 59 || !(second >= 0 && second < 60))
        return false;
    *result = (hour * 3600 + minute * 60) * NS_PER_S + (int64_t)round(second * 1e9);
    return *result < DAY_S * NS_PER_S; /* not what is rounded up to midnight */
}

static expr_t *time_literal(st_t *st, place_t place, type_kind_t kind, const char *text, const char *whole)
{
    constant_t value = {0};
    int64_t clock = 0;
    char *end = NULL;
    bool good;
    if (kind == T_TIME) {
        good = read_duration(text, &value.integer);
    } else if (kind == T_TOD) {
        good = read_clock(text, &value.integer);
    } else {
        good = read_date(text, &end, &value.integer);
        if (good && kind == T_DT)
            good = *end == '-' && read_clock(end + 1, &clock);
        else if (good)
            good = *end == '\0';
        value.integer += clock;
    }
    if (good)
        return made(st, place, kind, value);
    static const char *const right[] = {
        [T_TIME] = "T#1h30m or T#2.5s, the largest unit first, up to 106751 days", [T_TOD] = "TOD#23:59:59.999",
        [T_DATE] = "D#2024-02-29, from 1970 to 2262", [T_DT] = "DT#2024-02-29-23:59:59, from 1970 to 2262",
    };
    cm1e_st_report(st, place, "\"%s\" is not a value of %s; right is for instance %s", whole,
                   st->elementary[kind]->name, right[kind]);
    return wrong(st, place);
}

expr_t *cm1e_st_literal(st_t *st, place_t place, const char *text)
{
    char cleaned[TEXT_BYTES], prefix[TEXT_BYTES];
    if (strlen(text) >= TEXT_BYTES) {
        cm1e_st_report(st, place, "no literal is longer than %d characters", TEXT_BYTES - 1);
        return wrong(st, place);
    }
    if (!has_right_underscores(text)) {
        cm1e_st_report(st, place, "\"%s\" is no literal: an underscore is between two digits, one at a time", text);
        return wrong(st, place);
    }
    clean(text, cleaned);
    const bool is_true = strcasecmp(text, "TRUE") == 0 || strcasecmp(text, "BOOL#TRUE") == 0;
    if (is_true || strcasecmp(text, "FALSE") == 0 || strcasecmp(text, "BOOL#FALSE") == 0)
        return made(st, place, T_BOOL, (constant_t){.integer = is_true});
    if (strcmp(cleaned, "NULL") == 0)
        return made(st, place, T_NULL, (constant_t){0});
    const char *mark = strchr(cleaned, '#');
    if (!mark || (cleaned[0] >= '0' && cleaned[0] <= '9'))
        return number(st, place, cleaned);
    snprintf(prefix, sizeof prefix, "%.*s", (int)(strchr(text, '#') - text), text);
    if (strcasecmp(prefix, "T") == 0 || strcasecmp(prefix, "LT") == 0)
        return time_literal(st, place, T_TIME, mark + 1, text);
    if (strcasecmp(prefix, "D") == 0 || strcasecmp(prefix, "LD") == 0)
        return time_literal(st, place, T_DATE, mark + 1, text);
    const type_t *type = cm1e_st_elementary(st, prefix);
    if (type && cm1e_st_is_time(type->kind))
        return time_literal(st, place, type->kind, mark + 1, text);
    return typed_number(st, place, prefix, mark + 1);
}

bool cm1e_st_read_literal(const char *text, st_literal_t *literal, char *why, size_t size)
{
    st_t *st = cm1e_st_new_bare();
    if (!st) {
        snprintf(why, size, "no memory");
        return false;
    }
    const bool good_text = *text && text[strcspn(text, " \t\r\n")] == '\0';
    const expr_t *expr = good_text ? cm1e_st_literal(st, (place_t){0}, text) : wrong(st, (place_t){0});
    const type_kind_t kind = expr->type->kind;
    const bool good = kind <= T_DT || kind == T_ANY_INT || kind == T_ANY_REAL;
    *literal = (st_literal_t){.type = "", .huge = expr->value.huge, .integer = expr->value.integer,
                              .real = expr->value.real,
                              .is_real = cm1e_st_is_floating(kind) || kind == T_ANY_REAL,
                              .is_time = cm1e_st_is_time(kind)};
    if (good && kind <= T_DT)
        literal->type = expr->type->name;
    if (!good)
        snprintf(why, size, "%s", cm1e_st_errors(st) > 0 ? cm1e_st_error(st, 0).text : "it is no literal");
    cm1e_st_free(st);
    return good;
}

/** The character of an escape behind a $, which may have `digits` hexadecimal ones; `length`: how many characters it
 *  has. -1: there is no such escape. */
static long escape(const char *text, size_t digits, size_t *length)
{
    static const char from[] = "$'NnLlRrTtPp\"", to[] = "$'\n\n\n\n\r\r\t\t\f\f\"";
    const char *at = *text ? strchr(from, *text) : NULL;
    char number[5] = "", *end;
    *length = 1;
    if (at)
        return to[at - from];
    snprintf(number, digits + 1, "%s", text);
    const long code = strtol(number, &end, 16);
    *length = digits;
    return end == number + digits && code > 0 && number[0] != '-' && number[0] != '+' && number[0] != ' ' ? code : -1;
}

static expr_t *text_of(st_t *st, const char *bytes, size_t used, int64_t length, bool wide, place_t place)
{
    expr_t *expr = made(st, place, T_WRONG, (constant_t){.text = cm1e_st_copy(st->arena, bytes, used)});
    expr->type = cm1e_st_text_type(st, length, wide);
    return expr;
}

expr_t *cm1e_st_string_literal(st_t *st, place_t place, const char *text)
{
    char bytes[ST_STRING_BYTES + 1];
    size_t used = 0;
    while (*text) {
        long byte = (unsigned char)*text++;
        if (byte == '$') {
            size_t skip;
            byte = escape(text, 2, &skip);
            if (byte < 0) {
                cm1e_st_report(st, place, "\"$%.2s\" means nothing in a text; right are $$, $', $N, $L, $R, $T, $P and "
                               "$41 (a byte other than 0)", text);
                return wrong(st, place);
            }
            text += skip;
        }
        if (used == ST_STRING_BYTES) {
            cm1e_st_report(st, place, "a text has at most %d bytes", ST_STRING_BYTES);
            return wrong(st, place);
        }
        bytes[used++] = (char)byte;
    }
    return text_of(st, bytes, used, (int64_t)used, false, place);
}

/** A character of 16 bits in UTF-8, also half of a pair, which has 3 bytes then. */
static size_t put_utf8(char *to, unsigned long unit)
{
    const size_t count = unit < 0x80 ? 1 : unit < 0x800 ? 2 : 3;
    to[0] = (char)(count == 1 ? unit : count == 2 ? 0xC0 | unit >> 6 : 0xE0 | unit >> 12);
    for (size_t i = 1; i < count; i++)
        to[i] = (char)(0x80 | (unit >> 6 * (count - 1 - i) & 0x3F));
    return count;
}

/** Source texts are in UTF-8. A character beyond 16 bits counts as two. */
expr_t *cm1e_st_wide_literal(st_t *st, place_t place, const char *text)
{
    char bytes[4 * ST_STRING_BYTES + 8];
    size_t used = 0;
    int64_t length = 0;
    while (*text) {
        const unsigned char byte = (unsigned char)*text++;
        if (byte == '$') {
            size_t skip;
            const long unit = escape(text, 4, &skip);
            if (unit < 0) {
                cm1e_st_report(st, place, "\"$%.4s\" means nothing in a WSTRING; right are $$, $\", $N, $L, $R, $T, $P "
                               "and $0041 (a character other than 0)", text);
                return wrong(st, place);
            }
            used += put_utf8(bytes + used, (unsigned long)unit);
            text += skip;
            length++;
        } else {
            bytes[used++] = (char)byte;
            length += (byte & 0xC0) != 0x80 ? 1 + (byte >= 0xF0) : 0;
        }
        if (length > ST_STRING_BYTES) {
            cm1e_st_report(st, place, "a text has at most %d characters", ST_STRING_BYTES);
            return wrong(st, place);
        }
    }
    return text_of(st, bytes, used, length, true, place);
}
