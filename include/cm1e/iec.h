/**
 * @file iec.h
 * The standard function blocks of IEC 61131-3. TIME is 64-bit nanoseconds. A program calls them in its task; the time
 * of timers is that of the scan, the same for all of one scan. The symbols that the linker sees have the prefix iec_,
 * so that an application may have names of its own as short as these.
 * Generated from fb/interface/standard.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_IEC_H
#define CM1E_IEC_H

#include "cm1e/api.h"
#include "cm1e/iec_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Clock of a timer that is not to be touched. */
typedef struct cm1e_iec_timer {
    TIME start;  /**< when it began */
    BOOL before; /**< IN at the last call */
    BOOL running;
} cm1e_iec_timer_t;

/** Input at the last call, not to be touched. */
typedef struct cm1e_iec_edges {
    BOOL first, second;
} cm1e_iec_edges_t;

/** IEC 61131-3, 2.5.2.3.4. On-delay: Q follows IN, but goes on only when IN has been on for PT. @rt cycle */
typedef struct TON {
    BOOL IN;
    TIME PT; /**< ns, >= 0 */
    /* outputs */
    BOOL Q;
    TIME ET; /**< ns, 0 ... PT; elapsed */
    cm1e_iec_timer_t Private;
} TON_t;
CM1E_API void TON(TON_t *fb) CM1E_SYMBOL("iec_TON");

/** IEC 61131-3, 2.5.2.3.4. Off-delay: Q follows IN, but goes off only when IN has been off for PT. @rt cycle */
typedef struct TOF {
    BOOL IN;
    TIME PT; /**< ns, >= 0 */
    /* outputs */
    BOOL Q;
    TIME ET; /**< ns, 0 ... PT; elapsed */
    cm1e_iec_timer_t Private;
} TOF_t;
CM1E_API void TOF(TOF_t *fb) CM1E_SYMBOL("iec_TOF");

/** IEC 61131-3, 2.5.2.3.4. Pulse: Q is on for PT from the rising edge of IN, whatever IN does meanwhile. @rt cycle */
typedef struct TP {
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
typedef struct R_TRIG {
    BOOL CLK;
    /* outputs */
    BOOL Q;
    cm1e_iec_edges_t Private;
} R_TRIG_t;
CM1E_API void R_TRIG(R_TRIG_t *fb) CM1E_SYMBOL("iec_R_TRIG");

/** IEC 61131-3, 2.5.2.3.2. Falling edge: Q is TRUE for the call in which CLK has become FALSE, but not for the
 *  first call. @rt cycle */
typedef struct F_TRIG {
    BOOL CLK;
    /* outputs */
    BOOL Q;
    cm1e_iec_edges_t Private;
} F_TRIG_t;
CM1E_API void F_TRIG(F_TRIG_t *fb) CM1E_SYMBOL("iec_F_TRIG");

/** IEC 61131-3, 2.5.2.3.1. Bistable, set goes first. @rt cycle */
typedef struct SR {
    BOOL S1, R;
    /* outputs */
    BOOL Q1;
} SR_t;
CM1E_API void SR(SR_t *fb) CM1E_SYMBOL("iec_SR");

/** IEC 61131-3, 2.5.2.3.1. Bistable, reset goes first. @rt cycle */
typedef struct RS {
    BOOL S, R1;
    /* outputs */
    BOOL Q1;
} RS_t;
CM1E_API void RS(RS_t *fb) CM1E_SYMBOL("iec_RS");

/** IEC 61131-3, 2.5.2.3.3. Counts up at rising edges of CU, past PV to the largest INT. @rt cycle */
typedef struct CTU {
    BOOL CU;
    BOOL R; /**< TRUE: CV is 0; goes before CU */
    INT PV;
    /* outputs */
    BOOL Q; /**< CV >= PV */
    INT CV;
    cm1e_iec_edges_t Private;
} CTU_t;
CM1E_API void CTU(CTU_t *fb) CM1E_SYMBOL("iec_CTU");

/** IEC 61131-3, 2.5.2.3.3. Counts down at rising edges of CD, past 0 to the smallest INT. @rt cycle */
typedef struct CTD {
    BOOL CD;
    BOOL LD; /**< TRUE: CV is PV; goes before CD */
    INT PV;
    /* outputs */
    BOOL Q;  /**< CV <= 0 */
    INT CV;
    cm1e_iec_edges_t Private;
} CTD_t;
CM1E_API void CTD(CTD_t *fb) CM1E_SYMBOL("iec_CTD");

/** IEC 61131-3, 2.5.2.3.3. Counts up and down; edges of both in one call change nothing. @rt cycle */
typedef struct CTUD {
    BOOL CU, CD;
    BOOL R;  /**< TRUE: CV is 0; goes before all */
    BOOL LD; /**< TRUE: CV is PV; goes before counting */
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
