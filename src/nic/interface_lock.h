/**
 * @file interface_lock.h
 * One owner of a network interface at a time, among all programs that use this library. Two masters on one interface
 * answer each other's frames and throw each other's slaves out of Operational.
 *
 * The lock is a Unix socket that is bound to an abstract name with the index of the interface. The kernel keeps these
 * names by network namespace, as it keeps interfaces: the same name in another namespace is another interface, and a
 * renamed interface keeps its index. The name is free again when its process has ended, however that happened, and it
 * needs no directory and no rights: a lock of root is seen by every user. A second name is the record of the owner,
 * which others find in /proc/net/unix. (A file with flock() would need a directory that root and users share, would
 * know nothing of namespaces, and leaves its record behind.)
 */
#ifndef CM1E_NIC_INTERFACE_LOCK_H
#define CM1E_NIC_INTERFACE_LOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/error.h"
#include "core/guest_api.h"

typedef struct cm1e_interface_lock {
    int name_fd, record_fd;
} cm1e_interface_lock_t;

/** A lock that is not taken. */
#define CM1E_INTERFACE_UNLOCKED ((cm1e_interface_lock_t){-1, -1})

/** Who has an interface, as it says itself. */
typedef struct cm1e_interface_owner {
    char program[48];   /**< "cm1e move"; "": not known */
    int pid;            /**< in the owner's process namespace; 0: not known */
    int64_t since_s;    /**< seconds since 1970; 0: not known */
} cm1e_interface_owner_t;

/** Takes the lock of an existing interface, whatever way its name states: "eth1" and "eth1,xdp" have one lock.
 *  CM1E_ERROR_INTERFACE_IN_USE: somebody has it, this process included; `diag` says who. @rt init */
cm1e_error_t cm1e_interface_lock_take(cm1e_interface_lock_t *lock, const char *interface_name, cm1e_diag_t *diag);
/** Releases it. Releasing a lock that is not taken does nothing. @rt init */
void cm1e_interface_lock_release(cm1e_interface_lock_t *lock);

/** "cm1e move (process 1234) since 2026-11-22 17:30:12". @rt block */
CM1E_GUEST_API void cm1e_interface_owner_text(char *text, size_t size, const cm1e_interface_owner_t *owner);
/** Who has the interface; false: nobody has, or there is no such interface. @rt init */
CM1E_GUEST_API bool cm1e_interface_owner(const char *interface_name, cm1e_interface_owner_t *owner);

#endif
