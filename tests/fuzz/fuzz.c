#include "fuzz.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static const char *seed_folder;

int LLVMFuzzerInitialize(int *argc, char ***argv);

/* fuzz_<format> --seeds FOLDER writes the seeds and ends. */
int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    if (*argc == 3 && strcmp((*argv)[1], "--seeds") == 0) {
        seed_folder = (*argv)[2];
        fuzz_seeds();
        exit(0);
    }
    return 0;
}

void fuzz_seed(const char *name, const void *bytes, size_t size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", seed_folder, name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(1);
    }
}

void fuzz_seed_file(const char *path)
{
    char whole[4096], name[100];
    static uint8_t bytes[65536];
    snprintf(whole, sizeof whole, CM1E_SOURCE_DIR "/%s", path);
    snprintf(name, sizeof name, "%s", path);
    for (char *at = name; (at = strchr(at, '/'));)
        *at = '_';
    FILE *file = fopen(whole, "rb");
    if (!file)
        fuzz_fail("no seed %s", whole);
    fuzz_seed(name, bytes, fread(bytes, 1, sizeof bytes, file));
    fclose(file);
}

const char *fuzz_file(const uint8_t *bytes, size_t size)
{
    static char path[32];
    static int fd = -1;
    if (fd < 0) {
        fd = memfd_create("input", 0);
        snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    }
    if (fd < 0 || ftruncate(fd, 0) != 0 || pwrite(fd, bytes, size, 0) != (ssize_t)size)
        fuzz_fail("no file for the input");
    return path;
}

void fuzz_use_text(const char *text)
{
    if (!text[0])
        fuzz_fail("nothing is said");
    for (; *text; text++)
        if ((unsigned char)*text < ' ' && *text != '\n')
            fuzz_fail("a text for a terminal has the byte 0x%02X", (unsigned char)*text);
}

unsigned fuzz_take(const uint8_t **at, const uint8_t *end, unsigned bytes)
{
    unsigned value = 0;
    for (unsigned i = 0; i < bytes; i++)
        value |= (unsigned)(*at < end ? *(*at)++ : 0) << 8 * i;
    return value;
}

double fuzz_take_real(const uint8_t **at, const uint8_t *end)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY, -0.0, 5e-324, 2.2250738585072014e-308, 1e300, -1e300,
                                 0x1p31, -0x1p31, 0x1p53, 0x1p63, 1e-9, 1, 360, 0};
    const unsigned kind = fuzz_take(at, end, 1);
    uint64_t bits;
    double value;
    if (kind < sizeof odd / sizeof odd[0])
        return odd[kind];
    if (kind >= 0x40)
        return (int16_t)fuzz_take(at, end, 2) / (kind >= 0x80 ? 16.0 : 1024.0);
    bits = fuzz_take(at, end, 4);
    bits |= (uint64_t)fuzz_take(at, end, 4) << 32;
    memcpy(&value, &bits, sizeof value);
    return value;
}

const cm1e_device_options_t *fuzz_devices(size_t *count)
{
    static const cm1e_device_options_t devices[] = {
        {.firmware = "1.2.0", .order = CM1E_PDO_ORDER_UG_7_2},
        {.firmware = "1.3.3", .mapping = CM1E_MAPPING_CSV, .distributed_clocks = true},
        {.mapping = CM1E_MAPPING_PROFILE, .complete_access = true, .config_data_size = 14, .serial_number = 4711},
        {.model = CM1E_DEVICE_EB01, .axes = 2, .vendor_id = 0xAA77, .product_code = 0x01020304, .revision = 1},
        {.model = CM1E_DEVICE_EB12, .vendor_id = 0xAA77, .product_code = 0x01020305, .revision = 0x10002},
    };
    *count = sizeof devices / sizeof devices[0];
    return devices;
}

void fuzz_fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("FINDING: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    abort();
}

static void expect_same(const cm1e_file_t *first, const cm1e_file_t *second)
{
    size_t at = 0;
    while (at < first->size && at < second->size && first->bytes[at] == second->bytes[at])
        at++;
    if (at < first->size || at < second->size)
        fuzz_fail("written, read and written again, the file differs from byte %zu on:\n%.200s\n"
                  "---- before it was:\n%.200s", at, second->bytes + at, first->bytes + at);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    cm1e_file_t first = {0}, second = {0};
    if (fuzz_rewrite(&first, bytes, size, false)) {
        fuzz_rewrite(&second, first.bytes, first.size, true);
        expect_same(&first, &second);
    }
    cm1e_file_free(&first);
    cm1e_file_free(&second);
    return 0;
}

cm1e_findings_t *fuzz_findings(void)
{
    cm1e_findings_t *findings = cm1e_findings_create();
    if (!findings)
        fuzz_fail("no memory");
    return findings;
}

void fuzz_use_findings(cm1e_findings_t *findings)
{
    cm1e_findings_sort(findings);
    for (size_t i = 0; i < cm1e_findings_count(findings); i++) {
        const cm1e_finding_t *finding = cm1e_findings_at(findings, i);
        if (strlen(finding->rule) == 0 || strlen(finding->text) == 0)
            fuzz_fail("a finding in line %u says nothing", (unsigned)finding->line);
    }
    cm1e_findings_free(findings);
}
