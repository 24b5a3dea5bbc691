/**
 * @file runtime_dir.h
 * The directory with the control sockets of a user: $CM1E_RUNTIME_DIR, else /run/cm1e for root, else
 * $XDG_RUNTIME_DIR/cm1e, else /tmp/cm1e-<user number>. It belongs to the user, and nobody else may enter it. A socket
 * is cm1e-<process>-<n>.sock; the kernel lists it in /proc/net/unix, so that others find it wherever it is.
 */
#ifndef CM1E_CONTROL_RUNTIME_DIR_H
#define CM1E_CONTROL_RUNTIME_DIR_H

#include <stdbool.h>
#include <stddef.h>

#include "cm1e/error.h"

/** Paths of sockets are at most so long, by the kernel. */
enum { CM1E_SOCKET_PATH = 108, CM1E_SOCKETS_OF_PROCESS = 16 };

/** Makes the directory if it is missing, and checks it. */
cm1e_error_t cm1e_runtime_dir(char *path, size_t size, cm1e_diag_t *diag);
/** The path of socket `n` of this process. CM1E_ERROR_CONFIG: it is too long. */
cm1e_error_t cm1e_runtime_socket(char path[CM1E_SOCKET_PATH], const char *directory, int n, cm1e_diag_t *diag);
/** Removes sockets of processes that have ended without doing so. */
void cm1e_runtime_dir_tidy(const char *directory);
/** The path of the next socket of a process that somebody serves, from number *n on; *n is the number after it then.
 *  false: there is none. */
bool cm1e_runtime_find(int pid, int *n, char path[CM1E_SOCKET_PATH]);

#endif
