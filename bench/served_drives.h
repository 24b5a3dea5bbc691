/**
 * @file served_drives.h
 * Simulated drives in another process, behind the interface wire1 of a network namespace of its own (veth_make()); what is
 * measured is at wire0.
 */
#ifndef CM1E_BENCH_SERVED_DRIVES_H
#define CM1E_BENCH_SERVED_DRIVES_H

#include <sys/types.h>

/** Ends the program with a text that says why, where they do not start. */
pid_t served_drives_begin(unsigned drives);
void served_drives_end(pid_t server);

#endif
