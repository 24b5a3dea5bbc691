/* Every allocation of ours fails once: a check that is not complete must not look like one that found nothing. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "cm1e/generate.h"

/* The linker puts these in the place of the functions (tests/CMakeLists.txt); libxml2 has its own. */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);

static int countdown; /* the allocation that fails; 0: none */

static bool fails(void) { return countdown > 0 && --countdown == 0; }
void *__wrap_malloc(size_t size) { return fails() ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : __real_calloc(count, size); }

void setUp(void) {}
void tearDown(void) { countdown = 0; }

static cm1e_bus_config_t *network(void)
{
    static cm1e_bus_config_t config;
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 2);
    return &config;
}

/* Two slaves of an ENI with one station address: what a check that was cut short would not see. */
static void spoil(cm1e_file_t *file)
{
    char *at = strstr((char *)file->bytes, "<PhysAddr>4098</PhysAddr>");
    if (at)
        memcpy(at, "<PhysAddr>4097</PhysAddr>", strlen("<PhysAddr>4097</PhysAddr>"));
}

static size_t findings_of(const cm1e_file_t *file, bool *no_memory)
{
    cm1e_findings_t *findings;
    const cm1e_error_t error = cm1e_check_file(&findings, file->bytes, file->size, NULL);
    *no_memory = error != CM1E_OK;
    const size_t count = error == CM1E_OK ? cm1e_findings_count(findings) : 0;
    cm1e_findings_free(findings);
    return count;
}

static void sweep(cm1e_file_format_t format)
{
    const cm1e_generate_options_t options = {.format = format,
                                             .network = format == CM1E_FILE_ENI ? network() : NULL};
    cm1e_file_t file;
    cm1e_diag_t diag = {0};
    char message[80];
    bool no_memory, failed = true;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_generate(&file, &options, &diag), diag.text);
    spoil(&file);
    const size_t expected = findings_of(&file, &no_memory);
    TEST_ASSERT_FALSE(no_memory);
    for (int n = 1; failed; n++) {
        countdown = n;
        const size_t count = findings_of(&file, &no_memory);
        failed = countdown == 0;
        countdown = 0;
        snprintf(message, sizeof message, "%s, allocation %d", cm1e_file_format_name(format), n);
        if (!no_memory)
            TEST_ASSERT_EQUAL_size_t_MESSAGE(expected, count, message);
        TEST_ASSERT_TRUE_MESSAGE(!no_memory || failed, message);
    }
    cm1e_file_free(&file);
}

static void test_a_check_is_complete_or_an_error(void)
{
    sweep(CM1E_FILE_ESI);
    sweep(CM1E_FILE_SII);
    sweep(CM1E_FILE_EC_EXTEND);
    sweep(CM1E_FILE_ENI);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_check_is_complete_or_an_error);
    return UNITY_END();
}
