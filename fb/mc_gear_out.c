#include "coupling_block.h"

void MC_GearOut(MC_GearOut_t *fb)
{
    const fb_outputs_t out = cm1e_fb_decouple(&fb->Private, fb->Slave, fb->Execute, CM1E_COMMAND_GEAR_OUT);
    FB_SHOW_DONE(fb, out);
}
