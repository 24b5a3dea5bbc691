#include "core/text.h"

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Decodes the first character of a text (RFC 3629: shortest form, no surrogates, up to U+10FFFF). Returns its number of
 * bytes; 0 if it is not valid. */
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
    const bool no_character = (character & 0xFFFE) == 0xFFFE; /* XML has none of them */
    return !control && !line && !turns && !no_character;
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

/* character_at() of a text that has no final zero. */
static int character_within(const unsigned char *text, size_t size, uint32_t *character)
{
    unsigned char start[5] = {0};
    memcpy(start, text, size < 4 ? size : 4);
    return character_at(start, character);
}

/* Whole characters; only the last one may be cut, as devices do where their mailbox is small. */
static bool is_utf8(const unsigned char *text, size_t size, size_t *whole)
{
    uint32_t character;
    for (*whole = 0; *whole < size;) {
        const int bytes = character_within(text + *whole, size - *whole, &character);
        if (bytes == 0)
            break;
        *whole += (size_t)bytes;
    }
    const size_t rest = size - *whole;
    if (rest == 0)
        return true;
    const unsigned char lead = text[*whole];
    const size_t wanted = lead >= 0xF0 && lead <= 0xF4 ? 4 : lead >= 0xE0 && lead < 0xF0 ? 3 : lead >= 0xC2 ? 2 : 0;
    bool cut = lead < 0xF5 && rest < wanted;
    for (size_t i = 1; i < rest; i++)
        cut = cut && (text[*whole + i] & 0xC0) == 0x80;
    return cut;
}

void cm1e_text_of_device(char *text, size_t room, const void *told, size_t size)
{
    const unsigned char *from = told;
    size_t whole, length = 0;
    size = strnlen(told, size);
    const bool utf8 = is_utf8(from, size, &whole);
    for (size_t i = 0; i < (utf8 ? whole : size);) {
        uint32_t character = from[i];
        const int read = utf8 ? character_within(from + i, size - i, &character) : 1;
        unsigned char out[4] = {'?'};
        size_t bytes = 1;
        if (can_be_shown(character) && utf8) {
            bytes = (size_t)read;
            memcpy(out, from + i, bytes);
        } else if (can_be_shown(character) && character >= 0x80) {
            bytes = 2;
            out[0] = (unsigned char)(0xC0 | character >> 6);
            out[1] = (unsigned char)(0x80 | (character & 0x3F));
        } else if (can_be_shown(character)) {
            out[0] = (unsigned char)character;
        }
        if (length + bytes >= room)
            break;
        memcpy(text + length, out, bytes);
        length += bytes;
        i += (size_t)read;
    }
    text[length] = '\0';
}

size_t cm1e_text_width(const char *text)
{
    size_t width = 0;
    for (; *text; text++)
        width += (*text & 0xC0) != 0x80;
    return width;
}
