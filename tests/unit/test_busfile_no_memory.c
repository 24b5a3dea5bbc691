/* Every allocation of a load and of a check fails once: it is told as what it is, and nothing is half loaded. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "cm1e/config.h"

/* The linker puts these in the place of the functions (tests/CMakeLists.txt); libcyaml asks cyaml_mem(), and libyaml has
 * its own. */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__real_cyaml_mem(void *context, void *memory, size_t size);
void *__wrap_cyaml_mem(void *context, void *memory, size_t size);

static int countdown; /* the allocation that fails; 0: none */

static bool fails(void) { return countdown > 0 && --countdown == 0; }
void *__wrap_malloc(size_t size) { return fails() ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : __real_calloc(count, size); }
void *__wrap_realloc(void *memory, size_t size) { return fails() ? NULL : __real_realloc(memory, size); }
void *__wrap_cyaml_mem(void *context, void *memory, size_t size)
{
    return size > 0 && fails() ? NULL : __real_cyaml_mem(context, memory, size); /* 0 gives memory back */
}

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_no_memory.yaml";
static const char one_bus[] =
    "axes: [{name: x, software_limits: {negative: -1, positive: 2}}, {channel: 2, k37: 10}, {type: virtual}]\n"
    "slaves:\n"
    "  - {name: valves, position: 3, outputs: [{name: clamp, bit: 3}]}\n"
    "  - {position: 4, sdo: [{object: 0x8000:01, type: INT, value: 1}]}\n";
static const char two_buses[] =
    "buses:\n"
    "  - {name: left, bus: {interface: eth1}, axes: [{name: x}], slaves: [{position: 2}]}\n"
    "  - {name: right, bus: {interface: eth2}, axes: [{name: y}, {name: z}]}\n";
static cm1e_bus_config_t configs[CM1E_MAX_BUSES];
static uint32_t count;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) { countdown = 0; }

static void write_file(const char *text)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(strlen(text), fwrite(text, 1, strlen(text), file));
    TEST_ASSERT_EQUAL(0, fclose(file));
}

static void free_all(void)
{
    for (int i = 0; i < CM1E_MAX_BUSES; i++)
        cm1e_bus_config_free(&configs[i]);
    memset(configs, 0, sizeof configs);
}

/* The allocation `n` fails, if there are so many; returns whether there were. */
static bool load_without(int n)
{
    char told[600];
    free_all();
    memset(&diag, 0x5A, sizeof diag);
    count = 7;
    countdown = n;
    const cm1e_error_t error = cm1e_bus_config_load_all(configs, CM1E_MAX_BUSES, &count, temporary, &diag);
    const bool failed = countdown == 0;
    countdown = 0;
    snprintf(told, sizeof told, "allocation %d: %d, %.400s", n, (int)error, diag.text);
    if (!failed) {
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, error, told);
        return false;
    }
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_NO_MEMORY, error, told);
    TEST_ASSERT_EQUAL(CM1E_ERROR_NO_MEMORY, diag.error);
    TEST_ASSERT_TRUE_MESSAGE(strstr(diag.text, ".yaml: out of memory") ||
                             strstr(diag.text, ".yaml: cannot be read: out of memory"), told);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, count, told);
    for (int i = 0; i < CM1E_MAX_BUSES; i++) {
        TEST_ASSERT_NULL_MESSAGE(configs[i].axes, told); /* nothing is to be freed */
        TEST_ASSERT_NULL_MESSAGE(configs[i].slaves, told);
        TEST_ASSERT_EQUAL_MESSAGE(0, configs[i].axis_count + configs[i].slave_count, told);
    }
    return true;
}

static void test_a_load_without_memory_says_so_and_loads_nothing(void)
{
    static const char *const files[] = {one_bus, two_buses};
    for (int i = 0; i < 2; i++) {
        int n = 1;
        write_file(files[i]);
        while (load_without(n))
            n++;
        TEST_ASSERT_GREATER_THAN(10, n);
        TEST_ASSERT_EQUAL(i + 1, count);
        TEST_ASSERT_EQUAL(i == 0 ? 3 : 1, configs[0].axis_count);
        TEST_ASSERT_EQUAL(i == 0 ? 2 : 1, configs[0].slave_count);
    }
    free_all();
}

static void test_a_check_without_memory_says_so(void)
{
    bool failed = true;
    write_file(one_bus);
    TEST_ASSERT_FALSE(load_without(0x7FFF));
    for (int n = 1; failed; n++) {
        countdown = n;
        const cm1e_error_t error = cm1e_bus_config_check(&configs[0], &diag);
        failed = countdown == 0;
        countdown = 0;
        TEST_ASSERT_EQUAL_MESSAGE(failed ? CM1E_ERROR_NO_MEMORY : CM1E_OK, error, diag.text);
    }
    free_all();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_load_without_memory_says_so_and_loads_nothing);
    RUN_TEST(test_a_check_without_memory_says_so);
    return UNITY_END();
}
