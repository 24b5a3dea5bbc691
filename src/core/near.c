#include "core/near.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { WORD_BYTES = 64, NEAR_PART = 3, PREFIX_BYTES = 2 };

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

size_t cm1e_edit_distance(const char *a, const char *b)
{
    const size_t rows = strnlen(a, WORD_BYTES - 1), columns = strnlen(b, WORD_BYTES - 1);
    size_t table[3][WORD_BYTES]; /* the row before the last one, the last one, this one */
    size_t *before = table[0], *last = table[1], *now = table[2];
    for (size_t j = 0; j <= columns; j++)
        last[j] = j;
    for (size_t i = 1; i <= rows; i++) {
        now[0] = i;
        for (size_t j = 1; j <= columns; j++) {
            const char left = lower(a[i - 1]), right = lower(b[j - 1]);
            now[j] = least(least(last[j] + 1, now[j - 1] + 1), last[j - 1] + (left != right));
            if (i > 1 && j > 1 && left == lower(b[j - 2]) && lower(a[i - 2]) == right)
                now[j] = least(now[j], before[j - 2] + 1);
        }
        size_t *const free_row = before;
        before = last;
        last = now;
        now = free_row;
    }
    return last[columns];
}

/** Bytes of the parts, each with its point, that both paths begin with. */
static size_t common_parts(const char *a, const char *b)
{
    size_t parts = 0;
    for (size_t i = 0; a[i] && lower(a[i]) == lower(b[i]); i++)
        if (a[i] == '.')
            parts = i + 1;
    return parts;
}

void cm1e_near_look(cm1e_near_t *near, const char *candidate)
{
    const size_t parts = common_parts(near->word, candidate);
    const char *word = near->word + parts, *other = candidate + parts;
    const size_t length = strlen(word);
    const size_t allowed = length / NEAR_PART > 1 ? length / NEAR_PART : 1;
    size_t distance = cm1e_edit_distance(word, other);
    if (length >= PREFIX_BYTES && strncasecmp(word, other, length) == 0)
        distance = least(distance, allowed);
    /* A word of which no letter is kept is not near. */
    if (distance > allowed || distance >= parts + length || (near->nearest && distance >= near->distance))
        return;
    near->nearest = candidate;
    near->distance = distance;
}

const char *cm1e_near_text(const cm1e_near_t *near, char *text, size_t size)
{
    const int length = near->nearest ? snprintf(text, size, "; did you mean \"%s\"?", near->nearest) : 0;
    if (length <= 0 || (size_t)length >= size)
        text[0] = '\0';
    return text;
}
