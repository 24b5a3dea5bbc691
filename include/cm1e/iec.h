/**
 * @file iec.h
 * The standard function blocks of IEC 61131-3. TIME is 64-bit nanoseconds. A program calls the blocks in its task.
 * Timers use the time of the scan, which is the same for all blocks of one scan. The symbols have the prefix iec_ for
 * the linker, so that they do not collide with short names of an application.
 * Generated from fb/interface/standard.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_IEC_H
#define CM1E_IEC_H

#include "cm1e/api.h"
#include "cm1e/iec_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Private state of a timer. */
typedef struct cm1e_iec_timer {
    TIME start;  /**< start of the running time */
    BOOL before; /**< IN at the last call */
    BOOL running;
} cm1e_iec_timer_t;

/** Private: inputs at the last call. */
typedef struct cm1e_iec_edges {
    BOOL first, second;
} cm1e_iec_edges_t;

/** IEC 61131-3, 2.5.2.3.4. On-delay: Q becomes TRUE when IN has been TRUE for PT, and FALSE with IN. @rt cycle */
typedef struct TON_t {
    BOOL IN;
    TIME PT; /**< ns, >= 0 */
    /* outputs */
    BOOL Q;
    TIME ET; /**< ns, 0 ... PT; elapsed */
    cm1e_iec_timer_t Private;
} TON_t;
CM1E_API void TON(TON_t *fb) CM1E_SYMBOL("iec_TON");

/** IEC 61131-3, 2.5.2.3.4. Off-delay: Q becomes TRUE with IN, and FALSE when IN has been FALSE for PT. @rt cycle */
typedef struct TOF_t {
    BOOL IN;
    TIME PT; /**< ns, >= 0 */
    /* outputs */
    BOOL Q;
    TIME ET; /**< ns, 0 ... PT; elapsed */
    cm1e_iec_timer_t Private;
} TOF_t;
CM1E_API void TOF(TOF_t *fb) CM1E_SYMBOL("iec_TOF");

/** IEC 61131-3, 2.5.2.3.4. Pulse: Q is TRUE for PT from the rising edge of IN, whatever IN does meanwhile.
 *  @rt cycle */
typedef struct TP_t {
    BOOL IN;
    TIME PT; /**< ns, >= 0 */
    /* outputs */
    BOOL Q;
    TIME ET; /**< ns, 0 ... PT; elapsed */
    cm1e_iec_timer_t Private;
} TP_t;
CM1E_API void TP(TP_t *fb) CM1E_SYMBOL("iec_TP");

/** IEC 61131-3, 2.5.2.3.2. Rising edge: Q is TRUE for the call in which CLK has become TRUE, the first call
 *  included. @rt cycle */
typedef struct R_TRIG_t {
    BOOL CLK;
    /* outputs */
    BOOL Q;
    cm1e_iec_edges_t Private;
} R_TRIG_t;
CM1E_API void R_TRIG(R_TRIG_t *fb) CM1E_SYMBOL("iec_R_TRIG");

/** IEC 61131-3, 2.5.2.3.2. Falling edge: Q is TRUE for the call in which CLK has become FALSE, but not for the
 *  first call. @rt cycle */
typedef struct F_TRIG_t {
    BOOL CLK;
    /* outputs */
    BOOL Q;
    cm1e_iec_edges_t Private;
} F_TRIG_t;
CM1E_API void F_TRIG(F_TRIG_t *fb) CM1E_SYMBOL("iec_F_TRIG");

/** IEC 61131-3, 2.5.2.3.1. Bistable; set takes precedence. @rt cycle */
typedef struct SR_t {
    BOOL S1, R;
    /* outputs */
    BOOL Q1;
} SR_t;
CM1E_API void SR(SR_t *fb) CM1E_SYMBOL("iec_SR");

/** IEC 61131-3, 2.5.2.3.1. Bistable; reset takes precedence. @rt cycle */
typedef struct RS_t {
    BOOL S, R1;
    /* outputs */
    BOOL Q1;
} RS_t;
CM1E_API void RS(RS_t *fb) CM1E_SYMBOL("iec_RS");

/** IEC 61131-3, 2.5.2.3.3. Counts up at rising edges of CU, past PV up to the largest INT. @rt cycle */
typedef struct CTU_t {
    BOOL CU;
    BOOL R; /**< TRUE: CV is 0; takes precedence over CU */
    INT PV;
    /* outputs */
    BOOL Q; /**< CV >= PV */
    INT CV;
    cm1e_iec_edges_t Private;
} CTU_t;
CM1E_API void CTU(CTU_t *fb) CM1E_SYMBOL("iec_CTU");

/** IEC 61131-3, 2.5.2.3.3. Counts down at rising edges of CD, past 0 down to the smallest INT. @rt cycle */
typedef struct CTD_t {
    BOOL CD;
    BOOL LD; /**< TRUE: CV is PV; takes precedence over CD */
    INT PV;
    /* outputs */
    BOOL Q;  /**< CV <= 0 */
    INT CV;
    cm1e_iec_edges_t Private;
} CTD_t;
CM1E_API void CTD(CTD_t *fb) CM1E_SYMBOL("iec_CTD");

/** IEC 61131-3, 2.5.2.3.3. Counts up and down; edges of both in one call change nothing. @rt cycle */
typedef struct CTUD_t {
    BOOL CU, CD;
    BOOL R;  /**< TRUE: CV is 0; takes precedence over all */
    BOOL LD; /**< TRUE: CV is PV; takes precedence over counting */
    INT PV;
    /* outputs */
    BOOL QU; /**< CV >= PV */
    BOOL QD; /**< CV <= 0 */
    INT CV;
    cm1e_iec_edges_t Private;
} CTUD_t;
CM1E_API void CTUD(CTUD_t *fb) CM1E_SYMBOL("iec_CTUD");

#ifdef __cplusplus
}
#endif
#endif
