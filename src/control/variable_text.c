#include "control/variable_text.h"

#include <string.h>

#include "core/json_text.h"

/* ---- UTF-8 and UTF-16 -------------------------------------------------------------------------------------------- */

static size_t put_utf8(char *to, uint32_t c)
{
    static const uint8_t leads[] = {0, 0, 0xC0, 0xE0, 0xF0};
    const size_t count = c < 0x80 ? 1 : c < 0x800 ? 2 : c < 0x10000 ? 3 : 4;
    for (size_t i = count - 1; i > 0; i--, c >>= 6)
        to[i] = (char)(0x80 | (c & 0x3F));
    to[0] = (char)(leads[count > 1 ? count : 0] | c);
    return count;
}

static bool is_high(uint32_t c) { return (c & 0xFC00) == 0xD800; }
static bool is_low(uint32_t c) { return (c & 0xFC00) == 0xDC00; }

/** A half of a pair that stands alone becomes "?". */
static void wide_to_utf8(const uint8_t *bytes, char *text)
{
    uint16_t unit, next;
    for (; memcpy(&unit, bytes, 2), unit; bytes += 2) {
        uint32_t c = unit;
        memcpy(&next, bytes + 2, 2);
        if (is_high(c) && is_low(next)) {
            c = 0x10000 + ((c & 0x3FF) << 10) + (next & 0x3FF);
            bytes += 2;
        }
        text += put_utf8(text, is_high(c) || is_low(c) ? '?' : c);
    }
    *text = '\0';
}

/** The next character of valid UTF-8. */
static uint32_t take_utf8(const char **text)
{
    const uint8_t *at = (const uint8_t *)*text;
    const int more = at[0] < 0xC0 ? 0 : at[0] < 0xE0 ? 1 : at[0] < 0xF0 ? 2 : 3;
    uint32_t c = more ? at[0] & (0x3Fu >> more) : at[0];
    for (int i = 1; i <= more; i++)
        c = c << 6 | (at[i] & 0x3Fu);
    *text += more + 1;
    return c;
}

static bool utf8_to_wide(const char *text, const char *end, uint8_t *bytes, size_t room)
{
    size_t used = 0;
    while (text < end) {
        const uint32_t c = take_utf8(&text);
        const uint16_t units[2] = {(uint16_t)(c < 0x10000 ? c : 0xD7C0 + (c >> 10)), (uint16_t)(0xDC00 | (c & 0x3FF))};
        const size_t size = c < 0x10000 ? 2 : 4;
        if (used + size + 2 > room)
            return false;
        memcpy(bytes + used, units, size);
        used += size;
    }
    return true;
}

/* ---- JSON -------------------------------------------------------------------------------------------------------- */

json_t *cm1e_variable_text_show(const variable_t *variable, const uint8_t *bytes)
{
    char text[2 * VARIABLE_BYTES]; /* a character of 16 bits has at most 3 bytes */
    if (variable->form == VARIABLE_WSTRING)
        wide_to_utf8(bytes, text);
    else
        snprintf(text, sizeof text, "%s", (const char *)bytes);
    json_t *value = json_string(text);
    return value ? value : cm1e_json_text(text);
}

bool cm1e_variable_text_take(const variable_t *variable, const json_t *text, uint8_t bytes[VARIABLE_BYTES])
{
    const size_t length = json_string_length(text);
    const char *from = json_string_value(text);
    memset(bytes, 0, VARIABLE_BYTES);
    if (strlen(from) != length)
        return false;
    if (variable->form == VARIABLE_WSTRING)
        return utf8_to_wide(from, from + length, bytes, variable->bytes);
    if (length >= variable->bytes)
        return false;
    memcpy(bytes, from, length);
    return true;
}
