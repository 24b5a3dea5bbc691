/* SR and RS (IEC 61131-3, 2.5.2.3.1): the input with the 1 takes precedence. */
#include "cm1e/iec.h"

void SR(SR_t *fb) { fb->Q1 = fb->S1 || (!fb->R && fb->Q1); }

void RS(RS_t *fb) { fb->Q1 = !fb->R1 && (fb->S || fb->Q1); }
