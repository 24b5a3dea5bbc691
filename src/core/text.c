#include "core/text.h"

#include <stdbool.h>
#include <stdint.h>

/* Bytes of the character at the beginning of a text, and which it is (RFC 3629: shortest form, no surrogates, to
 * U+10FFFF); 0: it is none. */
static int character_at(const unsigned char *text, uint32_t *character)
{
    static const struct {
        unsigned char mask, value;
        uint32_t least;
    } leads[] = {{0x80, 0x00, 0}, {0xE0, 0xC0, 0x80}, {0xF0, 0xE0, 0x800}, {0xF8, 0xF0, 0x10000}};
    for (int bytes = 1; bytes <= 4; bytes++) {
        if ((text[0] & leads[bytes - 1].mask) != leads[bytes - 1].value)
            continue;
        uint32_t value = text[0] & (unsigned char)~leads[bytes - 1].mask;
        for (int i = 1; i < bytes; i++) {
            if ((text[i] & 0xC0) != 0x80) /* the end of the text too */
                return 0;
            value = value << 6 | (text[i] & 0x3Fu);
        }
        *character = value;
        return value >= leads[bytes - 1].least && value <= 0x10FFFF && (value & 0xFFFFF800) != 0xD800 ? bytes : 0;
    }
    return 0;
}

static bool can_be_shown(uint32_t character)
{
    const bool control = character < 0x20 || (character >= 0x7F && character < 0xA0);
    const bool line = character == 0x2028 || character == 0x2029;
    const bool turns = (character >= 0x202A && character <= 0x202E) || (character >= 0x2066 && character <= 0x2069);
    return !control && !line && !turns;
}

void cm1e_text_clean(char *text)
{
    const unsigned char *from = (const unsigned char *)text;
    char *to = text;
    while (*from) {
        uint32_t character = 0;
        const int bytes = character_at(from, &character);
        if (bytes == 0 || !can_be_shown(character))
            *to++ = '?';
        else
            for (int i = 0; i < bytes; i++)
                *to++ = (char)from[i];
        from += bytes > 0 ? bytes : 1;
    }
    *to = '\0';
}
