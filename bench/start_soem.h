/**
 * @file start_soem.h
 * Bare SOEM, started slave by slave as its simple_test does, with the PDO assignment of a CM1-E. start_soem.c is
 * compiled twice: with the SOEM and the port of the library, and with SOEM's own port and names.
 */
#ifndef CM1E_BENCH_START_SOEM_H
#define CM1E_BENCH_START_SOEM_H

#include <stdbool.h>
#include <stdint.h>

typedef struct start_soem {
    void *nic;                   /**< cm1e_nic_t, open: the SOEM of the library; NULL: SOEM's own port */
    const char *interface;
    uint32_t slaves;             /**< that must be found */
    uint16_t pdos[2];            /**< that every slave gets assigned: outputs, inputs */
    void (*phase)(const char *); /**< called at the end of each phase; NULL: not called */
    /** Called in Operational, with functions that receive and send the process data; NULL: not called. */
    void (*operating)(void *soem, int (*receive)(void *soem), void (*send)(void *soem));
} start_soem_t;

/** Brings all slaves to Operational. Returns NULL, or what went wrong. Afterwards all are in Init again. */
const char *start_soem_of_the_library(const start_soem_t *start);
const char *start_soem_of_its_own(const start_soem_t *start);

#endif
