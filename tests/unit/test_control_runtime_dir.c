/* The directory of the control sockets: by which variable it is found, who may have it, and what is told where it cannot be
 * used. Run by root, each check is made in a process of an ordinary user. */
#include <grp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <unity.h>

#include "control/runtime_dir.h"

enum { USER = 45678, OTHER = 45679 };
static char folder[64], inside[200], path[CM1E_SOCKET_PATH];
static cm1e_diag_t diag;
static bool is_root;

void setUp(void)
{
    is_root = geteuid() == 0;
    snprintf(folder, sizeof folder, "/tmp/cm1e-test-XXXXXX");
    TEST_ASSERT_NOT_NULL(mkdtemp(folder));
    TEST_ASSERT_TRUE(!is_root || chown(folder, USER, USER) == 0);
    unsetenv("CM1E_RUNTIME_DIR");
    unsetenv("XDG_RUNTIME_DIR");
}

void tearDown(void)
{
    char command[100];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    TEST_ASSERT_EQUAL_INT(0, system(command));
}

/** In a process of its own: a check that fails ends it. */
static void as_user(void (*check)(void))
{
    int status = 0;
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        if (is_root && (setgroups(0, NULL) != 0 || setgid(USER) != 0 || setuid(USER) != 0))
            _exit(2);
        check();
        _exit(0);
    }
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    TEST_ASSERT_EQUAL_INT(0, status);
}

/** In a child a failed assertion must not go on with the other tests of the program. */
#define CHECK(condition)                                                                                              \
    do {                                                                                                              \
        if (!(condition)) {                                                                                           \
            printf("line %d: %s: %s\n", __LINE__, #condition, diag.text);                                             \
            fflush(stdout);                                                                                           \
            _exit(1);                                                                                                 \
        }                                                                                                             \
    } while (0)

static cm1e_error_t find(void) { return cm1e_runtime_dir(path, sizeof path, &diag); }

static const char *within(const char *name)
{
    snprintf(inside, sizeof inside, "%s/%s", folder, name);
    return inside;
}

/* ---- where ------------------------------------------------------------------------------------------------------- */

static void check_where(void)
{
    struct stat found;
    char expected[100];
    snprintf(expected, sizeof expected, "/tmp/cm1e-%u", (unsigned)geteuid());
    CHECK(find() == CM1E_OK && strcmp(path, expected) == 0);
    setenv("XDG_RUNTIME_DIR", "relative", 1); /* not by its specification: as if there were none */
    CHECK(find() == CM1E_OK && strcmp(path, expected) == 0);
    rmdir(expected);
    setenv("XDG_RUNTIME_DIR", folder, 1);
    CHECK(find() == CM1E_OK && strcmp(path, within("cm1e")) == 0);
    CHECK(stat(path, &found) == 0 && (found.st_mode & 0777) == 0700);
    setenv("CM1E_RUNTIME_DIR", within("own"), 1);
    CHECK(find() == CM1E_OK && strcmp(path, within("own")) == 0);
    setenv("CM1E_RUNTIME_DIR", "", 1); /* as if it were not there */
    CHECK(find() == CM1E_OK && strcmp(path, within("cm1e")) == 0);
}

static void test_directory_is_stated_or_of_the_session_or_of_the_user(void) { as_user(check_where); }

static void check_length(void)
{
    char name[200] = "/";
    memset(name + 1, 'x', sizeof name - 2);
    setenv("XDG_RUNTIME_DIR", name, 1);
    CHECK(find() == CM1E_ERROR_CONFIG);
    CHECK(strstr(diag.text, "XDG_RUNTIME_DIR is \"/xxx") && strstr(diag.text, "at most 102 bytes"));
    setenv("CM1E_RUNTIME_DIR", name, 1);
    CHECK(find() == CM1E_ERROR_CONFIG);
    CHECK(strstr(diag.text, "CM1E_RUNTIME_DIR is \"/xxx") && strstr(diag.text, "at most 107 bytes"));
    setenv("CM1E_RUNTIME_DIR", "relative", 1);
    CHECK(find() == CM1E_ERROR_CONFIG);
    CHECK(strstr(diag.text, "CM1E_RUNTIME_DIR is \"relative\"; expected an absolute path"));
}

static void test_path_that_is_too_long_or_relative_is_told_with_its_variable(void) { as_user(check_length); }

/* ---- whose ------------------------------------------------------------------------------------------------------- */

static void check_others(void)
{
    setenv("CM1E_RUNTIME_DIR", within("of-another"), 1);
    CHECK(!is_root || find() == CM1E_ERROR_PERMISSION);
    CHECK(!is_root || (strstr(diag.text, "belongs to user 45679 with rights 700") && strstr(diag.text, "chmod 700")));
    for (unsigned rights = 0; rights < 0100; rights++) {
        CHECK(mkdir(within("open"), 0700) == 0 && chmod(inside, 0700 | rights) == 0);
        setenv("CM1E_RUNTIME_DIR", inside, 1);
        const bool others_write = rights & 022;
        CHECK(find() == (others_write ? CM1E_ERROR_PERMISSION : CM1E_OK));
        CHECK(rmdir(within("open")) == 0);
    }
    CHECK(mkdir(within("closed"), 0500) == 0);
    setenv("CM1E_RUNTIME_DIR", inside, 1);
    CHECK(find() == CM1E_ERROR_PERMISSION);
    CHECK(strstr(diag.text, "closed cannot be written: ") && strstr(diag.text, "Set CM1E_RUNTIME_DIR to another one."));
    CHECK(symlink(folder, within("link")) == 0);
    setenv("CM1E_RUNTIME_DIR", inside, 1);
    CHECK(find() == CM1E_ERROR_IO && strstr(diag.text, "link is not a directory."));
    setenv("CM1E_RUNTIME_DIR", within("closed/new"), 1);
    CHECK(find() == CM1E_ERROR_IO && strstr(diag.text, "cannot be made: "));
}

static void test_directory_that_others_write_or_nobody_is_refused(void)
{
    TEST_ASSERT_EQUAL_INT(0, mkdir(within("of-another"), 0700));
    TEST_ASSERT_TRUE(!is_root || chown(inside, OTHER, OTHER) == 0);
    as_user(check_others);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_directory_is_stated_or_of_the_session_or_of_the_user);
    RUN_TEST(test_path_that_is_too_long_or_relative_is_told_with_its_variable);
    RUN_TEST(test_directory_that_others_write_or_nobody_is_refused);
    return UNITY_END();
}
