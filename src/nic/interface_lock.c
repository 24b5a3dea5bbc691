#include "nic/interface_lock.h"

#include <errno.h>
#include <net/if.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include "config/interface.h"
#include "core/program.h"
#include "core/text.h"

/** The record follows the name within a moment, or the owner has just ended: on a busy machine after some 10 ms. */
enum { RECORD_TRIES = 200, RECORD_PAUSE_US = 500, TAKE_TRIES = 5 };

/* ---- names ------------------------------------------------------------------------------------------------------ */

static socklen_t make_address(struct sockaddr_un *address, const char *name)
{
    *address = (struct sockaddr_un){.sun_family = AF_UNIX};
    const size_t length = strnlen(name, sizeof address->sun_path - 1);
    memcpy(address->sun_path + 1, name, length); /* the zero before it makes it abstract */
    return (socklen_t)(offsetof(struct sockaddr_un, sun_path) + 1 + length);
}

/** A socket that has this name; -1: errno says why, EADDRINUSE: another has it. */
static int take_name(const char *name)
{
    struct sockaddr_un address;
    const socklen_t length = make_address(&address, name);
    const int s = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (s < 0 || bind(s, (const struct sockaddr *)&address, length) == 0)
        return s;
    const int why = errno;
    close(s);
    errno = why;
    return -1;
}

/* ---- records ---------------------------------------------------------------------------------------------------- */

static bool parse_record(const char *line, const char *prefix, cm1e_interface_owner_t *owner)
{
    const char *record = strstr(line, prefix);
    long long since;
    int pid, end = 0;
    if (!record || sscanf(record + strlen(prefix), "%d:%lld:%n", &pid, &since, &end) < 2 || end == 0)
        return false;
    *owner = (cm1e_interface_owner_t){.pid = pid, .since_s = since};
    snprintf(owner->program, sizeof owner->program, "%s", record + strlen(prefix) + end);
    owner->program[strcspn(owner->program, "\n")] = 0;
    cm1e_text_clean(owner->program);
    return true;
}

static bool find_record(unsigned index, cm1e_interface_owner_t *owner)
{
    char prefix[40], *line = NULL;
    size_t size = 0;
    bool found = false;
    FILE *file = fopen("/proc/net/unix", "r");
    snprintf(prefix, sizeof prefix, " @cm1e-owner.%u:", index);
    while (file && !found && getline(&line, &size, file) > 0)
        found = parse_record(line, prefix, owner);
    free(line);
    if (file)
        fclose(file);
    return found;
}

static unsigned index_of(const char *interface_name)
{
    char own[IFNAMSIZ + 1]; /* what is longer than a name can be is no interface */
    cm1e_interface_own_name(own, sizeof own, interface_name);
    return if_nametoindex(own);
}

static void write_name(char *name, size_t size, unsigned index) { snprintf(name, size, "cm1e-interface.%u", index); }

bool cm1e_interface_owner(const char *interface_name, cm1e_interface_owner_t *owner)
{
    char name[40];
    const unsigned index = index_of(interface_name);
    *owner = (cm1e_interface_owner_t){0};
    if (index == 0)
        return false;
    write_name(name, sizeof name, index);
    for (int i = 0; i < RECORD_TRIES; i++) {
        if (find_record(index, owner))
            return true;
        const int free_again = take_name(name);
        if (free_again >= 0)
            close(free_again);
        if (free_again >= 0 || errno != EADDRINUSE)
            return false;
        usleep(RECORD_PAUSE_US);
    }
    return true;
}

/* ---- the lock --------------------------------------------------------------------------------------------------- */

void cm1e_interface_owner_text(char *text, size_t size, const cm1e_interface_owner_t *owner)
{
    char since[40] = "", process[24] = "";
    const time_t time_s = (time_t)owner->since_s;
    struct tm local;
    if (owner->since_s > 0 && localtime_r(&time_s, &local))
        strftime(since, sizeof since, " since %Y-%m-%d %H:%M:%S", &local);
    if (owner->pid > 0)
        snprintf(process, sizeof process, " (process %d)", owner->pid);
    snprintf(text, size, "%s%s%s%s", owner->program[0] ? owner->program : "another program", process,
             owner->pid == getpid() ? ", this program itself," : "", since);
}

static cm1e_error_t in_use(const char *interface_name, const cm1e_interface_owner_t *owner, cm1e_diag_t *diag)
{
    char who[128];
    cm1e_interface_owner_text(who, sizeof who, owner);
    /* A process that is forked off inherits the socket and keeps the name. */
    const bool ended = owner->pid > 0 && kill(owner->pid, 0) != 0 && errno == ESRCH;
    return cm1e_diag_set(diag, CM1E_ERROR_INTERFACE_IN_USE, (uint32_t)owner->pid,
                         "Network interface \"%s\" is in use by %s. An interface has one owner at a time: two masters, "
                         "or two simulated segments, on one network disturb each other, and motors lose their "
                         "torque.%s End that program first, or use another interface.", interface_name, who,
                         ended ? " This process has ended, or is in another container; a process that it started may "
                                 "still hold the interface." : "");
}

/* The name of an interface. One that has just been given back, or that another looks at only, is tried again. */
static int take_interface(const char *name, const char *interface_name, cm1e_interface_owner_t *owner)
{
    for (int i = 0; i < TAKE_TRIES; i++) {
        const int taken = take_name(name);
        if (taken >= 0 || errno != EADDRINUSE)
            return taken;
        if (cm1e_interface_owner(interface_name, owner))
            break;
    }
    errno = EADDRINUSE;
    return -1;
}

cm1e_error_t cm1e_interface_lock_take(cm1e_interface_lock_t *lock, const char *interface_name, cm1e_diag_t *diag)
{
    char name[40], record[108], program[48];
    cm1e_interface_owner_t owner = {0};
    const unsigned index = index_of(interface_name);
    *lock = CM1E_INTERFACE_UNLOCKED;
    if (index == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "There is no network interface \"%s\".", interface_name);
    write_name(name, sizeof name, index);
    lock->name_fd = take_interface(name, interface_name, &owner);
    if (lock->name_fd < 0 && errno == EADDRINUSE)
        return in_use(interface_name, &owner, diag);
    if (lock->name_fd < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "Network interface \"%s\" cannot be locked: %s.", interface_name,
                             strerror(errno));
    cm1e_program_name(program, sizeof program);
    snprintf(record, sizeof record, "cm1e-owner.%u:%d:%lld:%s", index, getpid(), (long long)time(NULL), program);
    lock->record_fd = take_name(record); /* without it others know that somebody has the interface, but not who */
    return CM1E_OK;
}

void cm1e_interface_lock_release(cm1e_interface_lock_t *lock)
{
    if (lock->record_fd >= 0)
        close(lock->record_fd);
    if (lock->name_fd >= 0)
        close(lock->name_fd);
    *lock = CM1E_INTERFACE_UNLOCKED;
}
