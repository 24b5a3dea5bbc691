/* Numbers as a user writes them. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

bool parse_number(const char *word, const char *what, long long minimum, long long maximum, long long *value)
{
    char *end;
    errno = 0;
    *value = strtoll(word, &end, 0);
    if (*word && *end == '\0' && errno == 0 && *value >= minimum && *value <= maximum)
        return true;
    complain("%s is \"%s\"; expected a whole number %lld ... %lld", what, word, minimum, maximum);
    return false;
}

/** The place behind a hexadecimal number; NULL: there is none, or it is above `maximum`. */
static const char *read_hex(const char *word, unsigned long maximum, unsigned long *value)
{
    char *end;
    if (!isxdigit((unsigned char)word[0]))
        return NULL;
    *value = strtoul(word, &end, 16);
    return *value <= maximum ? end : NULL;
}

bool read_object(const char *word, uint16_t *index, uint8_t *subindex)
{
    unsigned long object = 0, part = 0;
    const char *end = read_hex(word, 0xFFFF, &object);
    if (end && *end == ':')
        end = read_hex(end + 1, 0xFF, &part);
    *index = (uint16_t)object;
    *subindex = (uint8_t)part;
    return end && *end == '\0';
}

bool parse_real(const char *word, const char *what, double *value)
{
    char *end;
    *value = strtod(word, &end);
    const bool decimal = word[strspn(word, "+-.0123456789eE")] == '\0';
    if (*word && *end == '\0' && decimal && isfinite(*value))
        return true;
    const bool large = *word && *end == '\0' && decimal; /* strtod() has made it infinite */
    complain("%s is \"%s\"; expected a number%s", what, word,
             large ? " up to 1.7e308" : strchr(word, ',') ? ", with a point instead of the comma" : "");
    return false;
}

bool parse_positive(const char *word, const char *what, double *value)
{
    if (!parse_real(word, what, value))
        return false;
    if (*value > 0)
        return true;
    complain("%s is %s; expected above 0, or leave the option out for the default", what, word);
    return false;
}

bool parse_seconds(const char *word, int longest, double *value)
{
    if (!parse_real(word, "the time", value))
        return false;
    if (*value > 0 && *value <= longest)
        return true;
    complain("the time is %s s; expected above 0, up to %d", word, longest);
    return false;
}
