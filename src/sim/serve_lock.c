#include "sim/serve_lock.h"

#include <errno.h>
#include <net/if.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

/* An abstract address: it belongs to a network namespace, as interfaces do, and leaves no file behind. */
static socklen_t address_of(struct sockaddr_un *address, const char *interface_name)
{
    /* An interface may have other names; this is the one that all processes see. */
    char name[IF_NAMESIZE];
    if (!if_indextoname(if_nametoindex(interface_name), name))
        snprintf(name, sizeof name, "%.*s", IF_NAMESIZE - 1, interface_name);
    *address = (struct sockaddr_un){.sun_family = AF_UNIX};
    const int n = snprintf(address->sun_path + 1, sizeof address->sun_path - 1, "cm1e-sim.%s", name);
    return (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + (size_t)n);
}

/* 0: not known. */
static int owner_of(const struct sockaddr_un *address, socklen_t length)
{
    struct ucred owner = {0};
    socklen_t size = sizeof owner;
    const int s = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (s < 0)
        return 0;
    const bool asked = connect(s, (const struct sockaddr *)address, length) == 0 &&
                       getsockopt(s, SOL_SOCKET, SO_PEERCRED, &owner, &size) == 0;
    close(s);
    return asked ? (int)owner.pid : 0;
}

static cm1e_error_t taken(const char *name, int owner, cm1e_diag_t *diag)
{
    char who[48] = "";
    if (owner > 0)
        snprintf(who, sizeof who, ", process %d", owner);
    return cm1e_diag_set(diag, CM1E_ERROR_STATE, owner,
                         "On \"%s\" a simulated segment is served already%s. Two would answer every frame twice: end "
                         "the other one, or choose another interface.", name, who);
}

cm1e_error_t cm1e_serve_lock_take(int *lock, const char *interface_name, cm1e_diag_t *diag)
{
    struct sockaddr_un address;
    const socklen_t length = address_of(&address, interface_name);
    *lock = -1;
    const int s = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (s < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "No socket to lock \"%s\": %s.", interface_name, strerror(errno));
    if (bind(s, (const struct sockaddr *)&address, length) == 0 && listen(s, 1) == 0) {
        *lock = s;
        return CM1E_OK;
    }
    const int why = errno;
    close(s);
    if (why == EADDRINUSE)
        return taken(interface_name, owner_of(&address, length), diag);
    return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "\"%s\" cannot be locked: %s.", interface_name, strerror(why));
}
