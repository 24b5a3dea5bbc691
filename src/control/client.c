#include "control/client.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include "config/interface.h"
#include "control/message.h"
#include "control/runtime_dir.h"
#include "core/in_task.h"
#include "nic/interface_lock.h"

/** For a reply longer than the longest transfer (request.c). A program accepts connections within milliseconds, so one
 *  whose queue stays full for so long is suspended. */
enum { REPLY_TIMEOUT_S = 65, CONNECT_TIMEOUT_S = 5, LISTEN_TRIES = 10 };

struct cm1e_control {
    int fd;
    char path[CM1E_SOCKET_PATH];
    uint8_t *in;
    size_t in_used, in_room;
};

/* ---- messages --------------------------------------------------------------------------------------------------- */

static cm1e_error_t gone(const cm1e_control_t *control, cm1e_diag_t *diag)
{
    if (errno == EAGAIN || errno == EWOULDBLOCK)
        return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "The program at %s did not answer in time.", control->path);
    return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The program at %s has ended, or closed the connection.",
                         control->path);
}

static bool send_all(const cm1e_control_t *control, const uint8_t *bytes, size_t length)
{
    for (size_t sent = 0; sent < length;) {
        const ssize_t n = send(control->fd, bytes + sent, length - sent, MSG_NOSIGNAL);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        sent += (size_t)n;
    }
    return true;
}

/** Room for at least one byte more; false: no memory, or the reply is too long. */
static bool make_room(cm1e_control_t *control)
{
    if (control->in_used < control->in_room)
        return true;
    const size_t room = control->in_room ? 2 * control->in_room : 1 << 14;
    uint8_t *grown = room <= 2 * (size_t)CM1E_REPLY_MAX ? realloc(control->in, room) : NULL;
    if (!grown)
        return false;
    control->in = grown;
    control->in_room = room;
    return true;
}

static cm1e_error_t receive(cm1e_control_t *control, json_t **reply, cm1e_diag_t *diag)
{
    char why[JSON_ERROR_TEXT_LENGTH] = "it is too long";
    for (;;) {
        size_t used = 0;
        const cm1e_message_state_t state =
            cm1e_message_read(control->in, control->in_used, CM1E_REPLY_MAX, reply, &used, why);
        if (state != CM1E_MESSAGE_PART) {
            memmove(control->in, control->in + used, control->in_used - used);
            control->in_used -= used;
            return state == CM1E_MESSAGE_WHOLE ? CM1E_OK
                                               : cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "The answer of %s cannot be "
                                                               "read: %s.", control->path, why);
        }
        if (!make_room(control))
            return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the answer of %s.", control->path);
        const ssize_t n = recv(control->fd, control->in + control->in_used, control->in_room - control->in_used, 0);
        if (n < 0 && errno == EINTR)
            continue;
        if (n == 0)
            errno = 0;
        if (n <= 0)
            return gone(control, diag);
        control->in_used += (size_t)n;
    }
}

/** Ends a connection on which an answer is missing: it could come later, and be taken for that of the next request. */
static cm1e_error_t lose(cm1e_control_t *control, cm1e_error_t error)
{
    close(control->fd);
    control->fd = -1;
    return error;
}

/** The error of a reply, as the program has said it. */
static cm1e_error_t error_of(const json_t *reply, cm1e_diag_t *diag)
{
    const json_t *error = json_object_get(reply, "error");
    const char *text = json_string_value(json_object_get(error, "text"));
    const cm1e_error_t code = (cm1e_error_t)json_integer_value(json_object_get(error, "code"));
    if (json_is_true(json_object_get(reply, "ok")))
        return CM1E_OK;
    return cm1e_diag_set(diag, code != CM1E_OK ? code : CM1E_ERROR_IO,
                         (uint32_t)json_integer_value(json_object_get(error, "foreign_code")), "%s",
                         text ? text : "The program refused without a reason.");
}

cm1e_error_t cm1e_control_call(cm1e_control_t *control, json_t *request, json_t **reply, cm1e_diag_t *diag)
{
    size_t length = 0;
    uint8_t *bytes = cm1e_message_write(request, &length);
    *reply = NULL;
    if (!bytes)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a request, or it is too long.");
    errno = 0;
    const bool is_lost = control->fd < 0, sent = !is_lost && send_all(control, bytes, length);
    free(bytes);
    if (is_lost)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The connection to %s was given up because of an answer that did "
                             "not come, or could not be read: connect again.", control->path);
    if (!sent && errno != EPIPE && errno != ECONNRESET)
        return lose(control, gone(control, diag));
    /* One that was turned away has been told why before it asked. */
    const cm1e_error_t error = receive(control, reply, diag);
    return error == CM1E_OK ? error_of(*reply, diag) : lose(control, error);
}

cm1e_error_t cm1e_control_ask(cm1e_control_t *control, const char *request, char **reply, cm1e_diag_t *diag)
{
    json_error_t wrong;
    if (!control || !request || !reply)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_control_ask() needs a connection, a request "
                             "and a place for the reply.");
    json_t *asked = json_loads(request, JSON_REJECT_DUPLICATES, &wrong), *told = NULL;
    *reply = NULL;
    if (!json_is_object(asked)) {
        json_decref(asked);
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The request is not a JSON object.");
    }
    const cm1e_error_t error = cm1e_control_call(control, asked, &told, diag);
    if (told)
        *reply = json_dumps(told, JSON_COMPACT);
    json_decref(told);
    return error;
}

/* ---- connecting ------------------------------------------------------------------------------------------------- */

/** The socket of a program that has just begun has its name for a moment before anybody listens. */
static int connect_patiently(int fd, const struct sockaddr_un *address)
{
    const struct timespec moment = {.tv_nsec = 10000000};
    for (int tries = 0;; tries++) {
        const int failed = connect(fd, (const struct sockaddr *)address, sizeof *address);
        if (failed == 0 || errno != ECONNREFUSED || tries == LISTEN_TRIES)
            return failed;
        nanosleep(&moment, NULL);
    }
}

static void set_patience(int fd, int option, int seconds)
{
    const struct timeval patience = {.tv_sec = seconds};
    setsockopt(fd, SOL_SOCKET, option, &patience, sizeof patience);
}

static cm1e_error_t connect_to(cm1e_control_t **control, const char *path, cm1e_diag_t *diag)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (strlen(path) >= sizeof address.sun_path)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The path %.100s... is too long for a socket.",
                             path);
    cm1e_control_t *made = calloc(1, sizeof *made);
    if (!made)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a connection.");
    strcpy(address.sun_path, path);
    strcpy(made->path, path);
    made->fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (made->fd >= 0)
        set_patience(made->fd, SO_SNDTIMEO, CONNECT_TIMEOUT_S); /* connect() takes it, too */
    if (made->fd >= 0 && connect_patiently(made->fd, &address) == 0) {
        set_patience(made->fd, SO_RCVTIMEO, REPLY_TIMEOUT_S);
        set_patience(made->fd, SO_SNDTIMEO, REPLY_TIMEOUT_S);
        *control = made;
        return CM1E_OK;
    }
    const int why = errno;
    cm1e_control_close(made);
    if (why == EACCES || why == EPERM)
        return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0, "The control socket %s belongs to another user: use the "
                             "rights of the one who started the program, or sudo.", path);
    if (why == EAGAIN)
        return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "The program at %s has accepted no connection for %d s: it "
                             "is suspended, or it hangs.", path, CONNECT_TIMEOUT_S);
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "No program serves the control socket %s: %s.", path,
                         strerror(why));
}

/** Whether a program that answers `hello` tells of this network, by its interface or by its name in the bus file. */
static bool is_network(const json_t *hello, const char *word)
{
    const char *interface = json_string_value(json_object_get(hello, "interface"));
    const char *name = json_string_value(json_object_get(hello, "network"));
    return (interface && cm1e_interface_is_same(interface, word)) || (name && strcmp(name, word) == 0);
}

/** A socket that was found by its name is that of the process in its name: any user can give a socket such a name. */
static cm1e_error_t check_server(const cm1e_control_t *control, int pid, cm1e_diag_t *diag)
{
    struct ucred peer = {0};
    socklen_t size = sizeof peer;
    if (getsockopt(control->fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.pid == (pid_t)pid)
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0, "%s has the name of process %d, and process %d of user %u "
                         "serves it: name the path if that is meant.", control->path, pid, (int)peer.pid,
                         (unsigned)peer.uid);
}

/** Of several networks of one program, the one with this interface or name; NULL or "": the first. */
static cm1e_error_t connect_to_process(cm1e_control_t **control, int pid, const char *interface_name, cm1e_diag_t *diag)
{
    char path[CM1E_SOCKET_PATH];
    cm1e_error_t error = cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "Process %d has no control socket: it does not "
                                       "run a network at present, its configuration says `control: none`, or it was "
                                       "built without cm1e::control.", pid);
    for (int n = 0; cm1e_runtime_find(pid, &n, path);) {
        json_t *reply = NULL;
        error = connect_to(control, path, diag);
        if (error == CM1E_OK)
            error = check_server(*control, pid, diag);
        if (error != CM1E_OK || !interface_name || !interface_name[0])
            return error;
        error = cm1e_control_call(*control, json_pack("{s:s}", "request", "hello"), &reply, diag);
        const bool found = is_network(json_object_get(reply, "hello"), interface_name);
        json_decref(reply);
        if (error != CM1E_OK || found)
            return error;
        cm1e_control_close(*control);
        *control = NULL;
        error = cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "Process %d runs other networks than \"%s\".", pid,
                              interface_name);
    }
    return error;
}

static bool is_number(const char *text)
{
    size_t digits = 0;
    while (isdigit((unsigned char)text[digits]))
        digits++;
    return digits > 0 && digits <= 9 && text[digits] == 0;
}

static cm1e_error_t connect_to_owner(cm1e_control_t **control, const char *interface_name, cm1e_diag_t *diag)
{
    cm1e_interface_owner_t owner;
    cm1e_diag_t why = {0};
    if (!interface_name || !cm1e_interface_owner(interface_name, &owner))
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "No program has the network interface \"%s\". One with a "
                             "simulated segment is found by its process: --attach PROCESS.",
                             interface_name ? interface_name : "");
    if (connect_to_process(control, owner.pid, interface_name, &why) == CM1E_OK)
        return CM1E_OK;
    char told[256];
    cm1e_interface_owner_text(told, sizeof told, &owner);
    return cm1e_diag_set(diag, CM1E_ERROR_INTERFACE_IN_USE, (uint32_t)owner.pid,
                         "Network interface \"%s\" is in use by %s, which cannot be asked. %s", interface_name, told,
                         why.text);
}

cm1e_error_t cm1e_control_connect(cm1e_control_t **control, const char *target, const char *interface_name,
                                  cm1e_diag_t *diag)
{
    if (!control || (!target && !interface_name))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_control_connect() needs a place for the "
                             "connection, and a target or a network interface.");
    *control = NULL;
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_control_connect()", "", diag);
    cm1e_error_t error;
    if (!target)
        error = connect_to_owner(control, interface_name, diag);
    else if (is_number(target))
        error = connect_to_process(control, (int)strtol(target, NULL, 10), interface_name, diag);
    else
        error = connect_to(control, target, diag);
    if (error != CM1E_OK) {
        cm1e_control_close(*control);
        *control = NULL;
    }
    return error;
}

void cm1e_control_close(cm1e_control_t *control)
{
    if (!control)
        return;
    if (control->fd >= 0)
        close(control->fd);
    free(control->in);
    free(control);
}
