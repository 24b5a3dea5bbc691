/* Files of RETAIN variables. Either all variables have the values of the file, which is then written again as it was, or
 * none has changed and an error says why. An input that begins with '=' gives the values only: the head of the file is
 * made for them, so that the checksum is right. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz.h"
#include "st_retain.h"

enum { VALUES = 24 };
#define LAYOUT UINT64_C(0x1234)

static struct {
    int16_t number;
    char text[14];
    double real;
} values;

static const st_variable_t table[] = {
    {.name = "Main.number", .data = &values.number, .size = sizeof values.number, .kind = ST_KIND_INT},
    {.name = "Main.text", .data = values.text, .size = sizeof values.text, .kind = ST_KIND_STRING},
    {.name = "Main.real", .data = &values.real, .size = sizeof values.real, .kind = ST_KIND_LREAL},
};
static const st_program_t program = {.version = ST_PROGRAM_VERSION, .layout = LAYOUT, .name = "Main",
                                     .retained = {.first = table, .count = 3}};

/** A file in a folder of its own, because the writer makes its copy beside it. */
static const char *path_of_file(void)
{
    static char path[64];
    char folder[] = "/tmp/fuzz_retain_XXXXXX";
    if (!path[0] && !mkdtemp(folder))
        fuzz_fail("no folder");
    if (!path[0])
        snprintf(path, sizeof path, "%s/retain", folder);
    return path;
}

static void write_file(const uint8_t *bytes, size_t size)
{
    FILE *file = fopen(path_of_file(), "wb");
    if (!file)
        fuzz_fail("no file");
    if (size > 0 && bytes[0] == '=') {
        uint64_t sum = UINT64_C(14695981039346656037); /* FNV-1a */
        for (size_t i = 1; i < size; i++)
            sum = (sum ^ bytes[i]) * UINT64_C(1099511628211);
        fprintf(file, "cm1e retain %016" PRIx64 " %zu %016" PRIx64 "\n", LAYOUT, size - 1, sum);
        bytes++;
        size--;
    }
    fwrite(bytes, 1, size, file);
    fclose(file);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    static st_retain_t retain;
    cm1e_diag_t diag = {0};
    (void)written, (void)must;
    memset(&values, 0x11, sizeof values);
    const uint8_t *expected = size == VALUES + 1 && bytes[0] == '=' ? bytes + 1 : NULL;
    write_file(bytes, size);
    const cm1e_error_t error = st_retain_begin(&retain, &program, path_of_file(), false, &diag);
    if (error != CM1E_OK) {
        fuzz_use_text(diag.text);
        if (expected || values.number != 0x1111 || values.text[13] != 0x11)
            fuzz_fail("a good file is refused, or one that is refused has changed variables: %s", diag.text);
        st_retain_end(&retain, &diag);
        return false;
    }
    if (expected && memcmp(expected, &values.number, 2) != 0)
        fuzz_fail("a value of the file is not that of the variable");
    if (st_retain_end(&retain, &diag) != CM1E_OK)
        fuzz_fail("the file cannot be written: %s", diag.text);
    return false;
}

void fuzz_seeds(void)
{
    static const char other[] = "cm1e retain 0000000000001234 24 0000000000000000\n123456789012345678901234";
    char good[VALUES + 1] = "=";
    for (int i = 1; i <= VALUES; i++)
        good[i] = (char)(i * 7);
    fuzz_seed("good", good, sizeof good);
    fuzz_seed("short", good, sizeof good - 3);
    fuzz_seed("damaged", other, sizeof other - 1);
}
