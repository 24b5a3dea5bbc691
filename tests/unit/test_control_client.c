/* A client of the control socket: every cut of an answer, answers that do not come, come late or cannot be read, and what
 * is refused before anything is sent. An answer is never taken for that of another request. */
#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <unity.h>

#include "cm1e/bus.h"
#include "cm1e/control.h"
#include "cm1e/sdo_info.h"
#include "cm1e/sii.h"
#include "control/message.h"
#include "core/in_task.h"

static const char path[] = CM1E_TEST_OUTPUT "/client.sock";
static cm1e_control_t *control;
static cm1e_diag_t diag;
static char *reply;

/* ---- a program that answers -------------------------------------------------------------------------------------- */

/** What it does with a request; a late answer comes when the next request has come, before that of it. */
typedef enum act { ANSWER = 0, BYTE_BY_BYTE, LATE, NO_JSON, TOO_LONG, NOT_OK, NO_REASON, CLOSE, SLAVES, NO_DATA, ACTS } act_t;
static act_t acts[6];
static unsigned act_count;
static int listening;
static pthread_t thread;

static void send_bytes(int fd, const void *bytes, size_t length) { (void)!send(fd, bytes, length, MSG_NOSIGNAL); }

static void send_text(int fd, const char *text, bool byte_by_byte)
{
    const size_t length = strlen(text), step = byte_by_byte ? 1 : length;
    const uint8_t header[CM1E_MESSAGE_HEADER] = {0, 0, (uint8_t)(length >> 8), (uint8_t)length};
    for (size_t i = 0; i < sizeof header; i += byte_by_byte ? 1 : sizeof header)
        send_bytes(fd, header + i, byte_by_byte ? 1 : sizeof header);
    for (size_t i = 0; i < length; i += step)
        send_bytes(fd, text + i, step);
}

static bool take_request(int fd)
{
    uint8_t bytes[CM1E_REQUEST_MAX];
    if (recv(fd, bytes, CM1E_MESSAGE_HEADER, MSG_WAITALL) != CM1E_MESSAGE_HEADER)
        return false;
    const size_t length = (size_t)bytes[2] << 8 | bytes[3];
    return recv(fd, bytes, length, MSG_WAITALL) == (ssize_t)length;
}

static void answer(int fd, unsigned number)
{
    static const uint8_t too_long[CM1E_MESSAGE_HEADER] = {0x7F, 0xFF, 0xFF, 0xFF};
    char text[80];
    snprintf(text, sizeof text, "{\"ok\": true, \"number\": %u}", number);
    switch (acts[number]) {
    case ANSWER: send_text(fd, text, false); break;
    case BYTE_BY_BYTE: send_text(fd, text, true); break;
    case NO_JSON: send_text(fd, "[1, 2", false); break;
    case TOO_LONG: send_bytes(fd, too_long, sizeof too_long); break;
    case NOT_OK: send_text(fd, "{\"ok\": false, \"error\": {\"code\": -22, \"foreign_code\": 5, \"text\": \"no\"}}", false); break;
    case NO_REASON: send_text(fd, "{}", false); break;
    case SLAVES: send_text(fd, "{\"ok\": true, \"slaves\": [{\"position\": 1, \"name\": \"a\", \"coe\": true}]}", false); break;
    case NO_DATA: send_text(fd, "{\"ok\": true, \"data\": \"0g\"}", false); break;
    case LATE:
    case CLOSE:
    case ACTS: break;
    }
}

static void *serve(void *context)
{
    (void)context;
    const int fd = accept(listening, NULL, NULL);
    for (unsigned n = 0; n < act_count && take_request(fd) && acts[n] != CLOSE; n++) {
        if (n > 0 && acts[n - 1] == LATE)
            send_text(fd, "{\"ok\": true, \"number\": 99}", false);
        answer(fd, n);
    }
    if (act_count == 0 || acts[act_count - 1] != CLOSE)
        (void)take_request(fd); /* until the client has closed it */
    close(fd);
    return NULL;
}

static void connect_to(unsigned count, const act_t *list)
{
    act_count = count;
    if (count > 0)
        memcpy(acts, list, count * sizeof *list);
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread, NULL, serve, NULL));
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_control_connect(&control, path, NULL, &diag), diag.text);
}

/** The client waits for 65 s for an answer; from here on for 0.2 s. Its socket is the one whose other end has the path. */
static void lose_patience(void)
{
    const struct timeval patience = {.tv_usec = 200000};
    for (int fd = 0; fd < 64; fd++) {
        struct sockaddr_un peer = {0};
        socklen_t size = sizeof peer;
        if (getpeername(fd, (struct sockaddr *)&peer, &size) != 0 || strcmp(peer.sun_path, path) != 0)
            continue;
        TEST_ASSERT_EQUAL_INT(0, setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience));
        return;
    }
    TEST_FAIL_MESSAGE("no socket of the client");
}

static void end(void)
{
    cm1e_control_close(control);
    control = NULL;
    pthread_join(thread, NULL);
}

static cm1e_error_t ask(void)
{
    free(reply);
    diag = (cm1e_diag_t){0};
    return cm1e_control_ask(control, "{\"request\": \"hello\"}", &reply, &diag);
}

static void check_number(unsigned number)
{
    char text[40];
    snprintf(text, sizeof text, "\"number\":%u", number);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, ask(), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(reply, text), reply);
}

static void bind_to_path(void)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    snprintf(address.sun_path, sizeof address.sun_path, "%s", path);
    unlink(path);
    listening = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    TEST_ASSERT_EQUAL_INT(0, bind(listening, (struct sockaddr *)&address, sizeof address));
}

void setUp(void)
{
    bind_to_path();
    TEST_ASSERT_EQUAL_INT(0, listen(listening, 1));
}

void tearDown(void)
{
    free(reply);
    reply = NULL;
    close(listening);
    unlink(path);
}

/* ---- answers ----------------------------------------------------------------------------------------------------- */

static void test_answers_come_whole_or_byte_by_byte(void)
{
    connect_to(3, (const act_t[]){ANSWER, BYTE_BY_BYTE, ANSWER});
    for (unsigned n = 0; n < 3; n++)
        check_number(n);
    end();
}

/* The late answer must not be that of the next request. */
static void test_connection_is_given_up_after_an_answer_that_did_not_come(void)
{
    connect_to(2, (const act_t[]){LATE, ANSWER});
    lose_patience();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, ask());
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "did not answer in time"), diag.text);
    TEST_ASSERT_NULL(reply);
    for (int n = 0; n < 2; n++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, ask());
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "connect again"), diag.text);
        TEST_ASSERT_NULL(reply);
    }
    end();
    connect_to(1, (const act_t[]){ANSWER});
    check_number(0);
    end();
}

static void test_answers_that_cannot_be_read_end_the_connection(void)
{
    static const struct {
        act_t act;
        const char *words;
    } rows[] = {{NO_JSON, "cannot be read: "}, {TOO_LONG, "cannot be read: it is too long"}};
    for (int i = 0; i < 2; i++) {
        connect_to(2, (const act_t[]){rows[i].act, ANSWER});
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, ask());
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, rows[i].words), diag.text);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, ask());
        end();
    }
}

static void test_program_that_closes_the_connection_has_ended(void)
{
    connect_to(2, (const act_t[]){ANSWER, CLOSE});
    check_number(0);
    for (int n = 0; n < 2; n++)
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, ask());
    end();
    connect_to(1, (const act_t[]){CLOSE});
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, ask());
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "has ended, or closed the connection"), diag.text);
    end();
}

/* A refusal is an answer: the connection goes on. */
static void test_refusal_has_the_words_of_the_program(void)
{
    connect_to(3, (const act_t[]){NOT_OK, NO_REASON, ANSWER});
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_STATE, ask());
    TEST_ASSERT_EQUAL_STRING("no", diag.text);
    TEST_ASSERT_EQUAL_UINT(5, diag.foreign_code);
    TEST_ASSERT_NOT_NULL(reply);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_IO, ask());
    TEST_ASSERT_EQUAL_STRING("The program refused without a reason.", diag.text);
    check_number(2);
    end();
}

/* ---- an attached bus ---------------------------------------------------------------------------------------------- */

static cm1e_bus_t *open_attached(unsigned count, const act_t *list)
{
    static cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    connect_to(count, list);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_bus_config_init(&config, "eth9", 0));
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_bus_open_attached(&bus, &config, control, &diag), diag.text);
    cm1e_bus_config_free(&config);
    control = NULL; /* the bus has it */
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_bus_scan(bus, &diag), diag.text);
    return bus;
}

/* What does not fit into a request is refused; it was written as an empty value. */
static void test_object_that_is_too_large_for_a_request_is_not_written(void)
{
    enum { MOST = (CM1E_REQUEST_MAX - 512) / 2 };
    static uint8_t bytes[MOST + 10000];
    cm1e_bus_t *bus = open_attached(2, (const act_t[]){SLAVES, ANSWER});
    for (size_t size = MOST + 1; size <= sizeof bytes; size += 3333) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_sdo_write(bus, 1, 0x2000, 0, bytes, size, &diag));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "at most 32512 bytes"), diag.text);
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_sdo_write(bus, 1, 0x2000, 0, bytes, MOST, &diag), diag.text);
    cm1e_bus_close(bus);
    pthread_join(thread, NULL);
}

/* No code of a slave is beside the error: the slave was not asked, or its answer is not known. */
static void test_data_of_an_answer_that_cannot_be_read_are_told_as_such(void)
{
    static uint8_t bytes[CM1E_SII_IMAGE_MAX];
    static uint16_t indexes[8];
    cm1e_bus_t *bus = open_attached(4, (const act_t[]){SLAVES, NO_DATA, NO_DATA, NO_DATA});
    for (int kind = 0; kind < 3; kind++) {
        size_t size = sizeof bytes, count = 8;
        diag = (cm1e_diag_t){.foreign_code = 7};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE,
                              kind == 0   ? cm1e_sdo_read(bus, 1, 0x2000, 0, bytes, &size, &diag)
                              : kind == 1 ? cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag)
                                          : cm1e_sii_read_device(bus, 1, bytes, &size, &diag));
        TEST_ASSERT_EQUAL_STRING("The answer of the program has no data in hexadecimal digits.", diag.text);
        TEST_ASSERT_EQUAL_UINT32(0, diag.foreign_code);
    }
    cm1e_bus_close(bus);
    pthread_join(thread, NULL);
}

/* ---- before anything is sent ------------------------------------------------------------------------------------- */

static void test_request_that_is_no_object_is_not_sent(void)
{
    static const char *const requests[] = {"", "[]", "5", "{", "{\"a\": 1, \"a\": 2}", "no JSON"};
    connect_to(1, (const act_t[]){ANSWER});
    for (size_t i = 0; i < sizeof requests / sizeof requests[0]; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_control_ask(control, requests[i], &reply, &diag));
        TEST_ASSERT_EQUAL_STRING("The request is not a JSON object.", diag.text);
        TEST_ASSERT_NULL(reply);
    }
    check_number(0);
    end();
}

static void test_connections_that_cannot_be_made_say_why(void)
{
    char name[300];
    memset(name, 'x', sizeof name);
    name[0] = '/';
    name[sizeof name - 1] = 0;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_control_connect(&control, name, NULL, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "is too long for a socket"), diag.text);
    TEST_ASSERT_NULL(control);
    static const char *const sockets[] = {"/no/such/socket", "12x", "x12", "1234567890"}; /* no numbers of processes */
    for (size_t i = 0; i < sizeof sockets / sizeof *sockets; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_NOT_FOUND, cm1e_control_connect(&control, sockets[i], NULL, &diag));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, sockets[i]), diag.text);
    }
    cm1e_in_task_begin();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_STATE, cm1e_control_connect(&control, path, NULL, &diag));
    cm1e_in_task_end();
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "cm1e_control_connect()"), diag.text);
    TEST_ASSERT_NULL(control);
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* A program that is suspended accepts nobody. Its queue takes some, and then connecting would wait for ever. */
static void test_program_that_lets_nobody_in_is_given_up(void)
{
    enum { QUEUED = 8 };
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    int fds[QUEUED], count = 0, full = 0;
    snprintf(address.sun_path, sizeof address.sun_path, "%s", path);
    while (count < QUEUED && !full) {
        fds[count] = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        full = connect(fds[count++], (struct sockaddr *)&address, sizeof address) != 0;
    }
    TEST_ASSERT_TRUE(full);
    const double begin = seconds();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, cm1e_control_connect(&control, path, NULL, &diag));
    TEST_ASSERT_TRUE(seconds() - begin < 30);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "has accepted no connection for 5 s"), diag.text);
    TEST_ASSERT_NULL(control);
    while (count > 0)
        close(fds[--count]);
}

static double listens_since;

static void *listen_later(void *context)
{
    (void)context;
    usleep(30000);
    const int failed = listen(listening, 1);
    listens_since = seconds();
    return failed == 0 ? serve(NULL) : NULL;
}

/* A program that has just begun has the name of its socket for a moment before it listens. The client waits for 0.1 s:
 * on a busy machine, which lets the thread listen later than that, the attempt says nothing and is made again. */
static void test_socket_that_nobody_listens_to_yet_is_asked_again(void)
{
    cm1e_error_t error = CM1E_OK;
    for (int tries = 0; tries < 20; tries++) {
        tearDown();
        bind_to_path();
        act_count = 1;
        acts[0] = ANSWER;
        TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread, NULL, listen_later, NULL));
        const double begin = seconds();
        error = cm1e_control_connect(&control, path, NULL, &diag);
        if (error == CM1E_OK)
            break;
        shutdown(listening, SHUT_RDWR); /* ends accept() */
        pthread_join(thread, NULL);
        if (listens_since - begin < 0.09)
            break;
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, error, diag.text);
    check_number(0);
    end();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_answers_come_whole_or_byte_by_byte);
    RUN_TEST(test_connection_is_given_up_after_an_answer_that_did_not_come);
    RUN_TEST(test_answers_that_cannot_be_read_end_the_connection);
    RUN_TEST(test_program_that_closes_the_connection_has_ended);
    RUN_TEST(test_refusal_has_the_words_of_the_program);
    RUN_TEST(test_object_that_is_too_large_for_a_request_is_not_written);
    RUN_TEST(test_data_of_an_answer_that_cannot_be_read_are_told_as_such);
    RUN_TEST(test_request_that_is_no_object_is_not_sent);
    RUN_TEST(test_connections_that_cannot_be_made_say_why);
    RUN_TEST(test_program_that_lets_nobody_in_is_given_up);
    RUN_TEST(test_socket_that_nobody_listens_to_yet_is_asked_again);
    return UNITY_END();
}
