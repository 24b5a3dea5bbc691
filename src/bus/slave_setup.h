/**
 * @file slave_setup.h
 * What the configuration writes into a slave without an axis at its start: SDOs and PDOs. What it wrote of PDOs is read
 * back, because a slave may take another value without a word. Before that a modular device is asked for its modules,
 * and the slave which PDOs exclude each other: an assignment that names two of these is refused, and nothing of it is
 * written. A list of SDO transfers, one after the other; who runs it owns the CoE client. No clock inside.
 */
#ifndef CM1E_BUS_SLAVE_SETUP_H
#define CM1E_BUS_SLAVE_SETUP_H

#include "cm1e/bus.h"

/** ETG.5001: the list of the modules that a modular device has found in its slots. */
enum { DETECTED_MODULES = 0xF050 };

/** The pulses of the clock of a slave that has CoE. */
typedef enum cm1e_setup_pulses {
    CM1E_SETUP_NO_PULSES = 0,
    CM1E_SETUP_SYNC0,
    CM1E_SETUP_SYNC1, /**< SYNC0 and SYNC1 */
} cm1e_setup_pulses_t;

typedef struct cm1e_setup_job {
    const cm1e_slave_config_t *config; /**< NULL: idle */
    cm1e_setup_pulses_t pulses;        /**< 0x1C32 and 0x1C33 say so, if the slave lets them be written */
    uint16_t supported[2];             /**< 0x1C32:04, 0x1C33:04, read if the slave gets SYNC1; 0: it has none */
    bool asked;                        /**< the last transfer read one of these */
    bool optional;                     /**< the last transfer may be refused */
    bool swapped;                      /**< 0x1C12 assigns inputs */
    bool before_op;                    /**< true: the start-up SDOs before Operational; false: those before
                                            Safe-Operational, and PDOs */
    bool started;                      /**< `sdo` is in work or done */
    bool differs;                      /**< the last transfer read another value than the one that was written */
    unsigned step;
    uint64_t expected, shown;          /**< of the last transfer that read */
    cm1e_sdo_t sdo;
    bool asks_excludes;                /**< the last transfer read which PDOs `pdo` excludes */
    uint16_t pdo, excluded;            /**< excluded: one that the configuration assigns beside `pdo`; 0: none */
    uint8_t data[128];
    cm1e_error_t error;                /**< result, valid when idle; foreign code in sdo.abort_code */
} cm1e_setup_job_t;

/** Whether anything is written into the slave. If it gets SYNC0, its objects of synchronisation (ETG.1020: 0x1C32:01
 *  and 0x1C33:01) are set to 2 and read back, unless the slave lacks or refuses them, or the configuration writes them
 *  itself. If it gets SYNC1 too, it is asked what it supports (sub-index 4): they are set to 3 if it can be synchronous
 *  with SYNC1, to 2 if only with SYNC0, and left as they are if it does not say. */
bool cm1e_setup_is_needed(const cm1e_slave_config_t *config, cm1e_setup_pulses_t pulses, bool before_op);
/** `swapped`: inputs are on sync manager 2, outputs on 3, so 0x1C12 assigns the inputs. */
void cm1e_setup_begin(cm1e_setup_job_t *job, uint16_t position, const cm1e_slave_config_t *config,
                      cm1e_setup_pulses_t pulses, bool before_op, bool swapped);
static inline bool cm1e_setup_idle(const cm1e_setup_job_t *job) { return job->config == NULL; }
static inline void cm1e_setup_cancel(cm1e_setup_job_t *job) { job->config = NULL; }
/** The transfer to begin now; NULL: the job has ended, or is idle. The transfer that was returned before must have
 *  ended. */
cm1e_sdo_t *cm1e_setup_next(cm1e_setup_job_t *job);

#endif
