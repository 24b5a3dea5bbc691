/** Files that are renamed when they are whole. */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/output.h"
#include "unity.h"

static const char folder[] = CM1E_TEST_OUTPUT "/output";
static const char path[] = CM1E_TEST_OUTPUT "/output/file", link_path[] = CM1E_TEST_OUTPUT "/output/link";
static cm1e_diag_t diag;

static void put(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    TEST_ASSERT_NOT_NULL(file);
    fputs(text, file);
    fclose(file);
}

static void expect_content(const char *name, const char *expected)
{
    char text[64] = "";
    FILE *file = fopen(name, "r");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(strlen(expected), fread(text, 1, sizeof text - 1, file));
    fclose(file);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static int files_in_folder(void)
{
    int count = 0;
    DIR *entries = opendir(folder);
    while (readdir(entries))
        count++;
    closedir(entries);
    return count - 2;
}

void setUp(void)
{
    mkdir(folder, 0777);
    unlink(path);
    unlink(link_path);
    diag = (cm1e_diag_t){0};
}
void tearDown(void) {}

static void write_new(const char *name)
{
    cm1e_output_t output;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_output_open(&output, name, &diag), diag.text);
    fputs("new", output.file);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_output_close(&output, &diag), diag.text);
}

static void test_a_file_is_there_when_it_is_whole(void)
{
    cm1e_output_t output;
    const mode_t mask = umask(027);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_output_open(&output, path, &diag));
    fputs("new", output.file);
    TEST_ASSERT_NOT_EQUAL(0, access(path, F_OK));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_output_close(&output, &diag));
    umask(mask);
    struct stat about;
    TEST_ASSERT_EQUAL(0, stat(path, &about));
    TEST_ASSERT_EQUAL_HEX(0640, about.st_mode & 0777);
    expect_content(path, "new");
    TEST_ASSERT_EQUAL(1, files_in_folder());
}

static void test_rights_and_links_stay(void)
{
    put(path, "old");
    chmod(path, 0604);
    TEST_ASSERT_EQUAL(0, symlink(path, link_path));
    write_new(link_path);
    struct stat about;
    TEST_ASSERT_EQUAL(0, lstat(link_path, &about));
    TEST_ASSERT_TRUE(S_ISLNK(about.st_mode));
    TEST_ASSERT_EQUAL(0, stat(path, &about));
    TEST_ASSERT_EQUAL_HEX(0604, about.st_mode & 0777);
    expect_content(path, "new");
}

static void test_what_does_not_arrive_changes_nothing(void)
{
    cm1e_output_t output;
    put(path, "old");
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_output_open(&output, path, &diag));
    close(fileno(output.file)); /* as a disk that is full */
    fputs("new", output.file);
    TEST_ASSERT_EQUAL(CM1E_ERROR_IO, cm1e_output_close(&output, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, path));
    expect_content(path, "old");
    TEST_ASSERT_EQUAL(1, files_in_folder());
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_output_open(&output, "/dev/full", &diag));
    fputs("new", output.file);
    TEST_ASSERT_EQUAL(CM1E_ERROR_IO, cm1e_output_close(&output, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "/dev/full"));
}

static void test_check_tells_before_and_leaves_nothing_behind(void)
{
    static const char *const wrong[] = {"/no/such/folder/x", folder, "", NULL};
    put(path, "old");
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_output_check(path, &diag));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_output_check(link_path, &diag));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_output_check("/dev/null", &diag));
    expect_content(path, "old");
    TEST_ASSERT_EQUAL(1, files_in_folder());
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        cm1e_output_t output;
        const cm1e_error_t expected = wrong[i] && wrong[i][0] ? CM1E_ERROR_IO : CM1E_ERROR_INVALID_ARGUMENT;
        TEST_ASSERT_EQUAL(expected, cm1e_output_check(wrong[i], &diag));
        TEST_ASSERT_EQUAL(expected, cm1e_output_open(&output, wrong[i], &diag));
        TEST_ASSERT_TRUE(!wrong[i] || !wrong[i][0] || strstr(diag.text, wrong[i]));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_file_is_there_when_it_is_whole);
    RUN_TEST(test_rights_and_links_stay);
    RUN_TEST(test_what_does_not_arrive_changes_nothing);
    RUN_TEST(test_check_tells_before_and_leaves_nothing_behind);
    return UNITY_END();
}
