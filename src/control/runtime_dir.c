#include "control/runtime_dir.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SOCKET_NAME "cm1e-%d-%d.sock"

/* ---- the directory ---------------------------------------------------------------------------------------------- */

static cm1e_error_t choose(char *path, size_t size, cm1e_diag_t *diag)
{
    const char *stated = getenv("CM1E_RUNTIME_DIR"), *of_session = getenv("XDG_RUNTIME_DIR");
    const bool is_stated = stated && stated[0];
    int length;
    if (is_stated)
        length = snprintf(path, size, "%s", stated);
    else if (geteuid() == 0)
        length = snprintf(path, size, "/run/cm1e");
    else if (of_session && of_session[0] == '/')
        length = snprintf(path, size, "%s/cm1e", of_session);
    else
        length = snprintf(path, size, "/tmp/cm1e-%u", (unsigned)geteuid());
    if (length < 0 || (size_t)length >= size || path[0] != '/')
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s is \"%.80s\"; expected an absolute path of at most %zu "
                             "bytes.", is_stated ? "CM1E_RUNTIME_DIR" : "XDG_RUNTIME_DIR",
                             is_stated ? stated : of_session, size - (is_stated ? 1 : sizeof "/cm1e"));
    return CM1E_OK;
}

cm1e_error_t cm1e_runtime_dir(char *path, size_t size, cm1e_diag_t *diag)
{
    struct stat found;
    const cm1e_error_t error = choose(path, size, diag);
    if (error != CM1E_OK)
        return error;
    const int made = mkdir(path, 0700);
    if (made != 0 && errno != EEXIST)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The directory %s cannot be made: %s. Make it, or set "
                             "CM1E_RUNTIME_DIR to a directory of your own.", path, strerror(errno));
    if (lstat(path, &found) != 0 || !S_ISDIR(found.st_mode))
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s is not a directory.", path);
    if (found.st_uid != geteuid() || (found.st_mode & 022))
        return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0, "The directory %s belongs to user %u with rights %03o; "
                             "expected your own, which no other user may write (chmod 700), because whoever writes "
                             "there could act for this program.", path, (unsigned)found.st_uid, found.st_mode & 0777u);
    if (access(path, W_OK | X_OK) != 0)
        return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0, "The directory %s cannot be written: %s. Set "
                             "CM1E_RUNTIME_DIR to another one.", path, strerror(errno));
    return CM1E_OK;
}

cm1e_error_t cm1e_runtime_socket(char path[CM1E_SOCKET_PATH], const char *directory, int n, cm1e_diag_t *diag)
{
    const int length = snprintf(path, CM1E_SOCKET_PATH, "%s/" SOCKET_NAME, directory, getpid(), n);
    if (length < 0 || length >= CM1E_SOCKET_PATH)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Set CM1E_RUNTIME_DIR to a shorter path: that of a control "
                             "socket may have %d bytes, and %s/" SOCKET_NAME " has more.", CM1E_SOCKET_PATH - 1,
                             directory, getpid(), n);
    return CM1E_OK;
}

void cm1e_runtime_dir_tidy(const char *directory)
{
    DIR *entries = opendir(directory);
    for (const struct dirent *entry; entries && (entry = readdir(entries));) {
        int pid, n, end = 0, other;
        char path[CM1E_SOCKET_PATH];
        if (sscanf(entry->d_name, SOCKET_NAME "%n", &pid, &n, &end) != 2 || end == 0 || entry->d_name[end])
            continue;
        other = n; /* a process of another namespace has this number too: what somebody serves stays */
        if (kill(pid, 0) == 0 || errno != ESRCH || cm1e_runtime_find(pid, &other, path))
            continue;
        if (snprintf(path, sizeof path, "%s/%.64s", directory, entry->d_name) < (int)sizeof path)
            unlink(path);
    }
    if (entries)
        closedir(entries);
}

/* ---- sockets of others ------------------------------------------------------------------------------------------ */

/** The number of the socket in a line of /proc/net/unix; -1: it is none of this process. */
static int number_in(const char *line, int pid, char path[CM1E_SOCKET_PATH])
{
    const char *begin = strchr(line, '/'), *name = strrchr(line, '/');
    int of, n, end = 0;
    if (!name || sscanf(name + 1, SOCKET_NAME "%n", &of, &n, &end) != 2 || end == 0 || name[1 + end] != '\n' ||
        of != pid)
        return -1;
    const size_t length = strcspn(begin, "\n");
    if (length >= CM1E_SOCKET_PATH)
        return -1;
    memcpy(path, begin, length);
    path[length] = 0;
    return n;
}

bool cm1e_runtime_find(int pid, int *n, char path[CM1E_SOCKET_PATH])
{
    char *line = NULL, candidate[CM1E_SOCKET_PATH];
    size_t size = 0;
    int best = -1;
    FILE *file = fopen("/proc/net/unix", "r");
    while (file && getline(&line, &size, file) > 0) {
        const int number = number_in(line, pid, candidate);
        if (number < *n || (best >= 0 && number >= best))
            continue;
        best = number;
        memcpy(path, candidate, sizeof candidate);
    }
    free(line);
    if (file)
        fclose(file);
    if (best < 0)
        return false;
    *n = best + 1;
    return true;
}
