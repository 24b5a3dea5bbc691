#include "coupling_block.h"

void MC_CamOut(MC_CamOut_t *fb)
{
    const fb_outputs_t out = cm1e_fb_decouple(&fb->Private, fb->Slave, fb->Execute, CM1E_COMMAND_CAM_OUT);
    fb->Done = out.done;
    fb->Busy = out.busy;
    fb->Error = out.error;
    fb->ErrorID = out.error_id;
}
