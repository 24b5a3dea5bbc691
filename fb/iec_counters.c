/* CTU, CTD, CTUD (IEC 61131-3, 2.5.2.3.3). They count edges of the inputs up to the limits of the type, not of PV. An
 * edge while R or LD acts is lost. An input that is TRUE at the first call is an edge, as for R_TRIG. */
#include "cm1e/iec.h"

static BOOL rising(BOOL input, BOOL *before)
{
    const BOOL edge = input && !*before;
    *before = input != FALSE;
    return edge;
}

static INT up(INT value) { return value < INT16_MAX ? (INT)(value + 1) : value; }
static INT down(INT value) { return value > INT16_MIN ? (INT)(value - 1) : value; }

void CTU(CTU_t *fb)
{
    const BOOL edge = rising(fb->CU, &fb->Private.first);
    if (fb->R)
        fb->CV = 0;
    else if (edge)
        fb->CV = up(fb->CV);
    fb->Q = fb->CV >= fb->PV;
}

void CTD(CTD_t *fb)
{
    const BOOL edge = rising(fb->CD, &fb->Private.first);
    if (fb->LD)
        fb->CV = fb->PV;
    else if (edge)
        fb->CV = down(fb->CV);
    fb->Q = fb->CV <= 0;
}

void CTUD(CTUD_t *fb)
{
    const BOOL more = rising(fb->CU, &fb->Private.first), less = rising(fb->CD, &fb->Private.second);
    if (fb->R)
        fb->CV = 0;
    else if (fb->LD)
        fb->CV = fb->PV;
    else if (more && !less)
        fb->CV = up(fb->CV);
    else if (less && !more)
        fb->CV = down(fb->CV);
    fb->QU = fb->CV >= fb->PV;
    fb->QD = fb->CV <= 0;
}
