/* R_TRIG and F_TRIG (IEC 61131-3, 2.5.2.3.2). An input that is TRUE at the first call is a rising edge. An input that
 * is FALSE is not a falling edge. CODESYS and TwinCAT do the same; the text of the second edition would set F_TRIG.Q
 * there. */
#include "cm1e/iec.h"

void R_TRIG(R_TRIG_t *fb)
{
    fb->Q = fb->CLK && !fb->Private.first;
    fb->Private.first = fb->CLK != FALSE;
}

void F_TRIG(F_TRIG_t *fb)
{
    fb->Q = !fb->CLK && fb->Private.first;
    fb->Private.first = fb->CLK != FALSE;
}
