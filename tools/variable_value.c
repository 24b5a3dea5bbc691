#include "variable_value.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

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
