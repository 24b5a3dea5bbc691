#include "esi_read_bench.h"

#define EVERY_ELEMENT CM1E_SOURCE_DIR "/tests/fuzz/seeds/esi/every_element.xml"

cm1e_description_file_t parsed;
cm1e_diag_t diag;
char *every;
char changed[1 << 16];

char *load(const char *path)
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    fseek(stream, 0, SEEK_END);
    const size_t size = (size_t)ftell(stream);
    rewind(stream);
    char *text = malloc(size + 1);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_EQUAL(size, fread(text, 1, size, stream));
    text[size] = '\0';
    fclose(stream);
    return text;
}

void setUp(void)
{
    diag = (cm1e_diag_t){0};
    every = load(EVERY_ELEMENT);
    TEST_ASSERT_NOT_NULL(every);
}

void tearDown(void)
{
    cm1e_description_file_free(&parsed);
    free(every);
    every = NULL;
}

cm1e_error_t read_bytes(const void *bytes, size_t size)
{
    cm1e_description_file_free(&parsed);
    diag = (cm1e_diag_t){0};
    return cm1e_esi_read(&parsed, bytes, size, &diag);
}

cm1e_error_t read_text(const char *text) { return read_bytes(text, strlen(text)); }

const char *with(const char *what, const char *instead)
{
    const char *at = strstr(every, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    TEST_ASSERT_NULL_MESSAGE(strstr(at + 1, what), what);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - every), every, instead, at + strlen(what));
    return changed;
}

unsigned line_of(const char *what)
{
    const char *at = strstr(every, what);
    unsigned line = 1;
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    for (const char *c = every; c < at; c++)
        line += *c == '\n';
    return line;
}

void good(const char *text) { TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, read_text(text), diag.text); }

void bad(const char *text, unsigned line, const char *words)
{
    char beginning[64];
    snprintf(beginning, sizeof beginning, "line %u: ", line);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_FILE, read_text(text), words);
    TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, diag.error);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(beginning, diag.text, strlen(beginning), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, words), diag.text);
}
