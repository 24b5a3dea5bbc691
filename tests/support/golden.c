#include "golden.h"

unsigned golden_differing_line(const char *a, size_t a_size, const char *b, size_t b_size)
{
    unsigned line = 1;
    for (size_t i = 0; i < a_size && i < b_size; i++) {
        if (a[i] != b[i])
            return line;
        line += a[i] == '\n';
    }
    return a_size == b_size ? 0 : line;
}

void golden_compare(const char *name, const void *bytes, size_t size)
{
    char path[512], message[640];
    snprintf(path, sizeof path, CM1E_SOURCE_DIR "/tests/golden/%s", name);
    const char *update = getenv("CM1E_GOLDEN_UPDATE");
    FILE *stream = fopen(path, update ? "wb" : "rb");
    snprintf(message, sizeof message, "%s cannot be opened; CM1E_GOLDEN_UPDATE=1 and this test write it", path);
    TEST_ASSERT_NOT_NULL_MESSAGE(stream, message);
    if (update) {
        TEST_ASSERT_EQUAL(size, fwrite(bytes, 1, size, stream));
        fclose(stream);
        return;
    }
    fseek(stream, 0, SEEK_END);
    const size_t golden_size = (size_t)ftell(stream);
    rewind(stream);
    char *golden = malloc(golden_size + 1);
    TEST_ASSERT_EQUAL(golden_size, fread(golden, 1, golden_size, stream));
    fclose(stream);
    const unsigned line = golden_differing_line(bytes, size, golden, golden_size);
    free(golden);
    snprintf(message, sizeof message, "%s is not the same from line %u on; if that is right, CM1E_GOLDEN_UPDATE=1 and "
             "this test write it anew", path, line);
    TEST_ASSERT_TRUE_MESSAGE(line == 0, message);
}
