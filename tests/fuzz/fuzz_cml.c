#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/cml.h"
#include "fuzz.h"

/* The bytes as a string of a user: a string that is classified as harmless must have a valid form. */
static void send(const uint8_t *bytes, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        fuzz_fail("no memory");
    memcpy(text, bytes, size);
    text[size] = '\0';
    const bool good = cm1e_cml_check(text, 1) == NULL;
    if (good && strlen(text) > CM1E_CML_BYTES)
        fuzz_fail("too long a string was called good");
    if (cm1e_cml_kind(text) != CM1E_CML_MOTION && strlen(text) <= CM1E_CML_BYTES && !good && !strchr(text, '.'))
        fuzz_fail("a string without an ID has a harmless kind, but cannot be sent: %s", text);
    free(text);
}

/* An answer with a value is written anew from what was read; what has none stands for itself. */
bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    cm1e_cml_answer_t answer;
    char line[CM1E_CML_BYTES + 1], number[12] = "";
    send(bytes, size);
    if (cm1e_cml_parse(&answer, bytes, size) != CM1E_OK || answer.what == CM1E_CML_TEXT) {
        if (must)
            fuzz_fail("a line of ours cannot be read");
        return false;
    }
    if (answer.what == CM1E_CML_K)
        snprintf(number, sizeof number, "%u", answer.number);
    if (answer.what == CM1E_CML_NOTHING)
        snprintf(line, sizeof line, "Null\r\n");
    else
        snprintf(line, sizeof line, "%s%s.%u=%d\r\n", answer.name, number, answer.id, answer.value);
    written->bytes = (uint8_t *)strdup(line);
    if (!written->bytes)
        fuzz_fail("no memory");
    written->size = strlen(line);
    return true;
}

void fuzz_seeds(void)
{
    static const char *const lines[] = {"K53.1=100\r\n", "Ux.1=8\r\n", "Origin.1=-2\r\n", "Px.4=7\r\n", "Null\r\n"};
    char name[16];
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        snprintf(name, sizeof name, "line_%zu.txt", i);
        fuzz_seed(name, lines[i], strlen(lines[i]));
    }
}
