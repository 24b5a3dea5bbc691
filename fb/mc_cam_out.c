#include "coupling_block.h"

void MC_CamOut(MC_CamOut_t *fb)
{
    const fb_outputs_t out = cm1e_fb_decouple(&fb->Private, fb->Slave, fb->Execute, CM1E_COMMAND_CAM_OUT);
    FB_SHOW_DONE(fb, out);
}
