/* Who owns a network interface: one at a time, by index and network namespace, for as long as the process lives. */
#include <fcntl.h>
#include <net/if.h>
#include <sched.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <unity.h>

#include "../support/veth.h"
#include "nic/nic.h"
#include "nic/raw_socket.h"

static bool have_wire;
static cm1e_diag_t diag;
static cm1e_interface_lock_t lock;

void setUp(void)
{
    if (!have_wire)
        TEST_IGNORE_MESSAGE("needs root or user namespaces, and ip from iproute2");
    memset(&diag, 0, sizeof diag);
    lock = CM1E_INTERFACE_UNLOCKED;
}

void tearDown(void)
{
    if (have_wire)
        cm1e_interface_lock_release(&lock);
}

static void take(const char *name)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_interface_lock_take(&lock, name, &diag), diag.text);
}

static void expect_taken(const char *name, const char *words)
{
    cm1e_interface_lock_t second;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INTERFACE_IN_USE, cm1e_interface_lock_take(&second, name, &diag));
    TEST_ASSERT_EQUAL_INT(-1, second.name_fd);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, words), diag.text);
}

static void expect_free(const char *name)
{
    cm1e_interface_lock_t second;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_interface_lock_take(&second, name, &diag), diag.text);
    cm1e_interface_lock_release(&second);
}

/** A process that takes the lock and waits to be killed. */
static pid_t start_owner(const char *name)
{
    int ready[2];
    char word;
    TEST_ASSERT_EQUAL_INT(0, pipe(ready));
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        const char answer = cm1e_interface_lock_take(&lock, name, NULL) == CM1E_OK ? 'y' : 'n';
        if (write(ready[1], &answer, 1) != 1)
            _exit(1);
        for (;;)
            pause();
    }
    TEST_ASSERT_EQUAL_INT(1, read(ready[0], &word, 1));
    TEST_ASSERT_EQUAL_INT('y', word);
    close(ready[0]);
    close(ready[1]);
    return child;
}

static void end_owner(pid_t owner)
{
    kill(owner, SIGKILL);
    TEST_ASSERT_EQUAL_INT(owner, waitpid(owner, NULL, 0));
}

static void test_the_second_is_told_who_has_the_interface_and_since_when(void)
{
    const time_t before = time(NULL);
    const pid_t owner = start_owner("wire0");
    cm1e_interface_owner_t told;
    TEST_ASSERT_TRUE(cm1e_interface_owner("wire0", &told));
    TEST_ASSERT_EQUAL_INT(owner, told.pid);
    TEST_ASSERT_EQUAL_STRING("test_nic_lock", told.program);
    TEST_ASSERT_TRUE(told.since_s >= before && told.since_s <= time(NULL));
    char words[80];
    snprintf(words, sizeof words, "\"wire0\" is in use by test_nic_lock (process %d) since 20", (int)owner);
    for (int i = 0; i < 300; i++) /* asking leaves nothing behind */
        expect_taken("wire0", words);
    TEST_ASSERT_EQUAL_UINT32(owner, diag.foreign_code);
    expect_free("wire1");
    end_owner(owner);
    TEST_ASSERT_FALSE(cm1e_interface_owner("wire0", &told));
    expect_free("wire0");
}

static void test_the_own_process_is_refused_too(void)
{
    take("wire0");
    expect_taken("wire0", "this program itself");
    cm1e_interface_lock_release(&lock);
    cm1e_interface_lock_release(&lock);
    expect_free("wire0");
}

/** Names that any program can take: one that is no whole record tells of no owner. */
static void test_a_record_that_is_not_whole_is_none(void)
{
    static const struct {
        const char *record;
        int pid; /* 0: it is no record */
    } rows[] = {{"12:34:prog", 12}, {"12:34:", 12}, {"12:34", 0}, {"12", 0}, {"12:", 0}, {"x:34:prog", 0}, {"", 0}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct sockaddr_un address = {.sun_family = AF_UNIX};
        cm1e_interface_owner_t told;
        const int length = snprintf(address.sun_path + 1, sizeof address.sun_path - 1, "cm1e-owner.%u:%s",
                                    if_nametoindex("wire0"), rows[i].record);
        const int s = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        TEST_ASSERT_EQUAL_INT(0, bind(s, (const struct sockaddr *)&address,
                                      (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + (size_t)length)));
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].pid != 0, cm1e_interface_owner("wire0", &told), rows[i].record);
        TEST_ASSERT_EQUAL_INT(rows[i].pid, told.pid);
        TEST_ASSERT_EQUAL_STRING(i == 0 ? "prog" : "", told.program);
        close(s);
    }
}

static void test_a_renamed_interface_is_the_same_one(void)
{
    take("wire0");
    TEST_ASSERT_EQUAL_INT(0, system("ip link set wire0 down && ip link set wire0 name other0"));
    expect_taken("other0", "\"other0\" is in use");
    TEST_ASSERT_EQUAL_INT(0, system("ip link set other0 name wire0 && ip link set wire0 up"));
    expect_taken("wire0", "in use");
}

static void test_the_same_name_in_another_namespace_is_another_interface(void)
{
    take("wire0");
    const unsigned index = if_nametoindex("wire0");
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        char command[200];
        snprintf(command, sizeof command, "ip link add wire0 index %u type veth peer name wire1", index);
        if (unshare(CLONE_NEWNET) != 0 || system(command) != 0 || if_nametoindex("wire0") != index)
            _exit(2);
        cm1e_interface_lock_t other;
        _exit(cm1e_interface_lock_take(&other, "wire0", NULL) == CM1E_OK ? 0 : 1);
    }
    int status;
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    TEST_ASSERT_EQUAL_INT(0, WEXITSTATUS(status));
}

static void test_a_user_sees_a_lock_of_root(void)
{
    if (geteuid() != 0)
        TEST_IGNORE_MESSAGE("needs root");
    take("wire0");
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        cm1e_interface_lock_t other;
        if (setgid(65534) != 0 || setuid(65534) != 0)
            _exit(2);
        _exit(cm1e_interface_lock_take(&other, "wire0", &diag) == CM1E_ERROR_INTERFACE_IN_USE &&
              strstr(diag.text, "test_nic_lock (process") ? 0 : 1);
    }
    int status;
    TEST_ASSERT_EQUAL_INT(child, waitpid(child, &status, 0));
    TEST_ASSERT_TRUE(WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 2);
}

static void test_a_child_that_outlives_the_owner_is_spoken_of(void)
{
    int alive[2];
    TEST_ASSERT_EQUAL_INT(0, pipe(alive));
    fflush(stdout);
    const pid_t owner = fork();
    if (owner == 0) {
        take("wire0");
        if (fork() > 0)
            _exit(0);
        char word;
        close(alive[1]);
        _exit(read(alive[0], &word, 1) == 0 ? 0 : 1); /* until the test ends */
    }
    TEST_ASSERT_EQUAL_INT(owner, waitpid(owner, NULL, 0));
    expect_taken("wire0", "a process that it started may still hold");
    close(alive[0]);
    close(alive[1]);
    for (int i = 0; i < 1000; i++) {
        cm1e_interface_owner_t told;
        if (!cm1e_interface_owner("wire0", &told))
            break;
        usleep(1000);
    }
    expect_free("wire0");
}

static void test_every_socket_that_sends_has_the_lock(void)
{
    cm1e_bus_config_t config = {.interface_name = "wire0"};
    cm1e_nic_t *nic = NULL, *second = NULL;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nic, &config, &diag));
    expect_taken("wire0", "in use");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INTERFACE_IN_USE, cm1e_nic_open(&second, &config, &diag));
    /* The second interface of a ring is owned too; a ring that cannot have both keeps none. */
    cm1e_bus_config_t ring = {.interface_name = "wire1", .second_interface = "wire0"};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INTERFACE_IN_USE, cm1e_nic_open(&second, &ring, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "\"wire0\""), diag.text);
    expect_free("wire1");
    cm1e_nic_close(nic);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_nic_open(&nic, &ring, &diag));
    expect_taken("wire0", "in use");
    expect_taken("wire1", "in use");
    cm1e_nic_close(nic);
    expect_free("wire0");
    expect_free("wire1");
}

static void test_a_socket_that_cannot_be_opened_gives_the_lock_back(void)
{
    cm1e_raw_socket_t made;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_raw_socket_open(&made, "lo", &diag));
    TEST_ASSERT_EQUAL_INT(-1, made.fd);
    expect_free("lo");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_NOT_FOUND, cm1e_interface_lock_take(&lock, "eth77", &diag));
}

int main(void)
{
    have_wire = veth_make();
    UNITY_BEGIN();
    RUN_TEST(test_the_second_is_told_who_has_the_interface_and_since_when);
    RUN_TEST(test_the_own_process_is_refused_too);
    RUN_TEST(test_a_record_that_is_not_whole_is_none);
    RUN_TEST(test_a_renamed_interface_is_the_same_one);
    RUN_TEST(test_the_same_name_in_another_namespace_is_another_interface);
    RUN_TEST(test_a_user_sees_a_lock_of_root);
    RUN_TEST(test_a_child_that_outlives_the_owner_is_spoken_of);
    RUN_TEST(test_every_socket_that_sends_has_the_lock);
    RUN_TEST(test_a_socket_that_cannot_be_opened_gives_the_lock_back);
    return UNITY_END();
}
