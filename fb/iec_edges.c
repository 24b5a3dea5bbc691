/* R_TRIG and F_TRIG (IEC 61131-3, 2.5.2.3.2). An input of TRUE at the first call is a rising edge; an input of FALSE is
 * no falling one: nothing has fallen. That is what CODESYS and TwinCAT do; the text of the second edition would have
 * F_TRIG.Q TRUE there. */
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
