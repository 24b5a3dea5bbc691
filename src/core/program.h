/**
 * @file program.h
 * How a program is called where others are told of it.
 */
#ifndef CM1E_CORE_PROGRAM_H
#define CM1E_CORE_PROGRAM_H

#include <stddef.h>
#include <stdint.h>

/** This program with its first word that is no option: "cm1e move", "python3 machine.py". @rt init */
void cm1e_program_name(char *text, size_t size);
/** The path of its file, for a command that gives it a right; "<program>" if it is not known or too long. @rt block */
void cm1e_program_path(char *path, size_t size);
/** Of raw sockets, real-time priority and locked memory; bits as in CapBnd of /proc/self/status. */
#define CM1E_PRIVILEGE_RAW (UINT64_C(1) << 13)
#define CM1E_PRIVILEGE_LOCK (UINT64_C(1) << 14)
#define CM1E_PRIVILEGE_PRIORITY (UINT64_C(1) << 23)
enum { CM1E_PRIVILEGES_TEXT = 48 };

/** Those of these three that a set has, as `setcap` takes them: "cap_net_raw,cap_ipc_lock". @rt block */
void cm1e_program_privileges(char text[CM1E_PRIVILEGES_TEXT], uint64_t set);
/** How this program gets the privileges of `needed`, as a sentence without its point. In a container or service that
 *  lacks one, not even root has it; a file with that capability does not start at all, so it is not given to one.
 *  @rt block */
void cm1e_program_cure(char *text, size_t size, uint64_t needed);

#endif
