#include "variable_value.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "command.h"
#include "st/st.h"

/* ---- shown ------------------------------------------------------------------------------------------------------- */

/** A character of a text as in a program: 'it$'s$N'. What is no character of a terminal becomes its number. */
static void escaped(char c, char quote, char text[4])
{
    if (c == quote || c == '$')
        snprintf(text, 4, "$%c", c);
    else if (c == '\n' || c == '\r' || c == '\t')
        snprintf(text, 4, "$%c", c == '\n' ? 'N' : c == '\r' ? 'R' : 'T');
    else if ((unsigned char)c < ' ' || c == 0x7F)
        snprintf(text, 4, "$%02X", (unsigned char)c);
    else
        snprintf(text, 4, "%c", c);
}

/** The control characters U+0080 to U+009F, in UTF-8. */
static bool is_c1(const char *text)
{
    const unsigned char *bytes = (const unsigned char *)text;
    return bytes[0] == 0xC2 && bytes[1] >= 0x80 && bytes[1] < 0xA0;
}

/** What there is no room for becomes "...". */
static void quoted(const char *from, char quote, char *text, size_t size)
{
    enum { END_BYTES = 10 }; /* the last character, the dots and the quote */
    size_t used = (size_t)snprintf(text, size, "%c", quote);
    for (char one[4]; *from && (used + END_BYTES < size || ((unsigned char)*from & 0xC0) == 0x80); from++) {
        if (is_c1(from))
            snprintf(one, sizeof one, "$%02X", (unsigned char)*++from);
        else
            escaped(*from, quote, one);
        used += (size_t)snprintf(text + used, size - used, "%s", one);
    }
    snprintf(text + used, size - used, "%s%c", *from ? "..." : "", quote);
}

/** The part of a second, without zeros at its end. */
static void fraction(int64_t ns, char *text, size_t size)
{
    size_t length = (size_t)snprintf(text, size, ".%09" PRId64, ns);
    while (text[length - 1] == '0')
        length--;
    text[text[length - 1] == '.' ? length - 1 : length] = 0;
}

/** T#1m5s: as a program writes it, and as TIME_TO_STRING does. */
static void duration_text(int64_t value, char *text, size_t size)
{
    static const struct { const char *name; uint64_t ns; } units[] = {
        {"d", UINT64_C(86400000000000)}, {"h", UINT64_C(3600000000000)}, {"m", UINT64_C(60000000000)}, {"s", 1000000000},
        {"ms", 1000000}, {"us", 1000}, {"ns", 1},
    };
    uint64_t left = value < 0 ? 0 - (uint64_t)value : (uint64_t)value;
    size_t used = (size_t)snprintf(text, size, "T#%s%s", value < 0 ? "-" : "", left ? "" : "0ms");
    for (size_t i = 0; left > 0 && used < size; left %= units[i++].ns)
        if (left >= units[i].ns)
            used += (size_t)snprintf(text + used, size - used, "%" PRIu64 "%s", left / units[i].ns, units[i].name);
}

/** The literal of a time or date. False: there is none, or `declared` is a type of the program, which may be any of
 *  them. */
static bool time_literal(const char *declared, int64_t ns, char *text, size_t size)
{
    static const int64_t second_ns = 1000000000;
    char rest[16];
    if (strcmp(declared, "TIME") == 0) {
        duration_text(ns, text, size);
        return true;
    }
    const bool day = strcmp(declared, "DATE") == 0, moment = strcmp(declared, "DT") == 0;
    if (ns < 0 || (!day && !moment && strcmp(declared, "TOD") != 0)) /* no literal is before 1970 */
        return false;
    const time_t at = (time_t)(ns / second_ns);
    struct tm tm;
    char date[40] = "";
    if (!gmtime_r(&at, &tm))
        return false;
    strftime(date, sizeof date, day ? "%Y-%m-%d" : moment ? "%Y-%m-%d-%H:%M:%S" : "%H:%M:%S", &tm);
    fraction(ns % second_ns, rest, sizeof rest);
    snprintf(text, size, "%s#%s%s", day ? "D" : declared, date, day ? "" : rest);
    return true;
}

void variable_text(const json_t *row, char *text, size_t size)
{
    const json_t *value = json_object_get(row, "value");
    const char *type = text_of(row, "type"), *unit = text_of(row, "unit"), *enumerator = text_of(row, "enumerator");
    const bool wide = strcmp(type, "WSTRING") == 0;
    if (wide || strcmp(type, "STRING") == 0)
        quoted(text_of(row, "value"), wide ? '"' : '\'', text, size);
    else if (*enumerator)
        snprintf(text, size, "%s", enumerator);
    else if (strcmp(type, "BOOL") == 0)
        snprintf(text, size, "%s", json_number_value(value) != 0 ? "TRUE" : "FALSE");
    else if (json_is_string(value)) /* a ULINT that JSON has no number for */
        snprintf(text, size, "%s", json_string_value(value));
    else if (json_is_integer(value) && strcmp(unit, "ns") == 0 &&
             time_literal(text_of(row, "declared"), json_integer_value(value), text, size))
        return;
    else if (json_is_integer(value))
        snprintf(text, size, "%" JSON_INTEGER_FORMAT "%s%s", json_integer_value(value), *unit ? " " : "", unit);
    else if (json_is_real(value))
        snprintf(text, size, "%.15g%s%s", json_real_value(value), *unit ? " " : "", unit);
    else
        snprintf(text, size, "no number");
}

/* ---- read -------------------------------------------------------------------------------------------------------- */

static bool is_time(const json_t *row) { return strcmp(text_of(row, "unit"), "ns") == 0; }

/** What is between the quotes; NULL: there are none, or it is no UTF-8. */
static json_t *text_within(const char *text)
{
    const size_t length = strlen(text);
    const bool quoted = length >= 2 && (text[0] == '\'' || text[0] == '"') && text[length - 1] == text[0];
    return quoted ? json_stringn(text + 1, length - 2) : NULL;
}

/** A whole number: JSON has those of 63 bits and a sign, the digits of others are a text. */
static json_t *whole_number(uint64_t number, bool negative)
{
    char digits[24];
    if (number <= INT64_MAX || (negative && number == (uint64_t)INT64_MAX + 1))
        return json_integer((json_int_t)(negative ? 0 - number : number));
    snprintf(digits, sizeof digits, "%s%" PRIu64, negative ? "-" : "", number);
    return json_string(digits);
}

/** A number without a type: 12, -0x1F, 1.5e3; NULL: it is none. */
static json_t *plain_number(const char *word)
{
    char *end;
    const bool negative = word[0] == '-';
    const char *digits = word + (negative || word[0] == '+');
    const bool hexadecimal = digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X');
    errno = 0;
    const uint64_t whole = strtoull(digits, &end, hexadecimal ? 16 : 10);
    if (digits[0] >= '0' && digits[0] <= '9' && !*end && errno == 0)
        return whole_number(whole, negative);
    const bool decimal = word[strspn(word, "+-.0123456789eE")] == '\0'; /* strtod() knows other forms too */
    const double real = strtod(word, &end);
    return *word && decimal && !*end && isfinite(real) ? json_real(real) : NULL; /* JSON knows neither NaN nor infinity */
}

/** 16#FF, T#1m5s, D#2024-02-29 for a variable of that kind; NULL and a complaint: it is none. */
static json_t *literal_value(const json_t *row, const char *word)
{
    char why[300];
    st_literal_t literal;
    const bool time = is_time(row);
    static const char *const times[] = {"TIME", "DATE", "TOD", "DT"};
    if (!cm1e_st_read_literal(word, &literal, why, sizeof why)) {
        complain("%s: \"%s\" is no value: %s", text_of(row, "name"), word, why);
        return NULL;
    }
    bool same = time == literal.is_time;
    for (size_t i = 0; i < sizeof times / sizeof *times && same && time; i++) /* a type of the program may be any of them */
        same = strcmp(text_of(row, "declared"), times[i]) != 0 || strcmp(literal.type, times[i]) == 0;
    if (!same) {
        complain("%s is %s, and \"%s\" is %s", text_of(row, "name"), text_of(row, "declared"), word,
                 *literal.type ? literal.type : "a number");
        return NULL;
    }
    if (strcmp(literal.type, "BOOL") == 0)
        return json_boolean(literal.integer);
    if (literal.is_real)
        return json_real(literal.real);
    return literal.huge ? whole_number((uint64_t)literal.integer, false) : json_integer(literal.integer);
}

/** What a variable is given, in words. */
static const char *right_words(const json_t *row)
{
    const char *type = text_of(row, "type");
    return strcmp(type, "STRING") == 0 || strcmp(type, "WSTRING") == 0 ? "a text in quotes: \"'text'\""
           : strcmp(type, "BOOL") == 0 ? "TRUE or FALSE"
           : json_object_get(row, "enumerator") ? "the name of an enumerator"
           : is_time(row) ? "a time as T#1m5s, D#2024-02-29, TOD#23:59:59 or DT#2024-02-29-23:59:59"
                          : "a number, as 12, 1.5 or 16#FF";
}

/** A number for a REAL: one of more than 63 bits is no text of digits there. Takes `value` over. */
static json_t *as_real(json_t *value)
{
    const char *digits = json_string_value(value);
    if (!digits)
        return value;
    json_t *real = json_real(strtod(digits, NULL));
    json_decref(value);
    return real;
}

/** A time is none without its unit: 5 would be 5 ms in a program, and is 5 ns in JSON. */
static json_t *any_value(const json_t *row, const char *word)
{
    const bool enumeration = json_object_get(row, "enumerator"), text = strstr(text_of(row, "type"), "STRING");
    const bool plain = !text && !is_time(row);
    json_t *value = text ? text_within(word) : plain ? plain_number(word) : NULL;
    if (!value && plain && (strcasecmp(word, "TRUE") == 0 || strcasecmp(word, "FALSE") == 0))
        value = json_boolean(strcasecmp(word, "TRUE") == 0);
    if (!value && enumeration && !(word[0] >= '0' && word[0] <= '9'))
        value = *word ? json_string(word) : NULL;
    if (!value && !text && (strchr(word, '#') || (strchr(word, '_') && !enumeration)))
        return literal_value(row, word);
    if (!value)
        complain("%s (%s): \"%s\" is no value: expected %s", text_of(row, "name"), text_of(row, "declared"), word,
                 right_words(row));
    return value;
}

json_t *variable_value(const json_t *row, const char *word)
{
    const char *type = text_of(row, "type");
    json_t *value = any_value(row, word);
    return strcmp(type, "REAL") == 0 || strcmp(type, "LREAL") == 0 ? as_real(value) : value;
}
