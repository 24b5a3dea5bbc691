#include "variable_value.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

/* ---- shown ------------------------------------------------------------------------------------------------------- */

static const char *text_of(const json_t *object, const char *name)
{
    const char *text = json_string_value(json_object_get(object, name));
    return text ? text : "";
}

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

static void quoted(const char *from, char quote, char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "%c", quote);
    for (char one[4]; *from && used + sizeof one + 1 < size; from++) {
        escaped(*from, quote, one);
        used += (size_t)snprintf(text + used, size - used, "%s", one);
    }
    snprintf(text + used, size - used, "%c", quote);
}

void variable_text(const json_t *row, char *text, size_t size)
{
    const json_t *value = json_object_get(row, "value");
    const char *type = text_of(row, "type"), *unit = text_of(row, "unit");
    const bool wide = strcmp(type, "WSTRING") == 0;
    if (wide || strcmp(type, "STRING") == 0)
        quoted(text_of(row, "value"), wide ? '"' : '\'', text, size);
    else if (strcmp(type, "BOOL") == 0)
        snprintf(text, size, "%s", json_number_value(value) != 0 ? "TRUE" : "FALSE");
    else if (json_is_string(value)) /* a ULINT that JSON has no number for */
        snprintf(text, size, "%s", json_string_value(value));
    else if (json_is_integer(value))
        snprintf(text, size, "%" JSON_INTEGER_FORMAT "%s%s", json_integer_value(value), *unit ? " " : "", unit);
    else if (json_is_real(value))
        snprintf(text, size, "%.15g%s%s", json_real_value(value), *unit ? " " : "", unit);
    else
        snprintf(text, size, "no number");
}

/* ---- read -------------------------------------------------------------------------------------------------------- */

/** What is between the quotes; NULL: there are none, or it is no UTF-8. */
static json_t *text_within(const char *text)
{
    const size_t length = strlen(text);
    const bool quoted = length >= 2 && (text[0] == '\'' || text[0] == '"') && text[length - 1] == text[0];
    return quoted ? json_stringn(text + 1, length - 2) : NULL;
}

json_t *variable_value(const char *text)
{
    char *end;
    json_t *quoted = text_within(text);
    if (quoted)
        return quoted;
    if (strcasecmp(text, "TRUE") == 0 || strcasecmp(text, "FALSE") == 0)
        return json_boolean(strcasecmp(text, "TRUE") == 0);
    errno = 0;
    const long long whole = strtoll(text, &end, 0);
    if (*text && !*end && errno == 0)
        return json_integer(whole);
    const double real = strtod(text, &end);
    if (*text && !*end && isfinite(real)) /* JSON knows neither NaN nor infinity */
        return json_real(real);
    complain("\"%s\" is no value: expected TRUE, FALSE, a finite number, or a text in quotes: \"'text'\"", text);
    return NULL;
}
