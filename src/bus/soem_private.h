/**
 * @file soem_private.h
 * The SOEM context with all that it points to, shared by soem_adapter.c and soem_scan.c only.
 */
#ifndef CM1E_BUS_SOEM_PRIVATE_H
#define CM1E_BUS_SOEM_PRIVATE_H

#include "bus/sii_reader.h"
#include "bus/soem_adapter.h"
#include "ethercat.h"

struct cm1e_soem {
    ecx_contextt context;
    ecx_portt port;
    ecx_redportt redundant_port;
    ec_slavet slaves[CM1E_MAX_SLAVES + 1]; /* [0] is the master */
    int slave_count;
    ec_groupt groups[EC_MAXGROUP];
    uint8 sii_cache[EC_MAXEEPBUF];
    uint32 sii_map[EC_MAXEEPBITMAP];
    ec_eringt errors;
    ec_idxstackT stack;
    boolean error;
    int64 dc_time;
    ec_SMcommtypet sm_types[EC_MAX_MAPT];
    ec_PDOassignt pdo_assign[EC_MAX_MAPT];
    ec_PDOdesct pdo_description[EC_MAX_MAPT];
    ec_eepromSMt sii_sm;
    ec_eepromFMMUt sii_fmmu;
    cm1e_sii_t siis[CM1E_MAX_SLAVES + 1];
    uint8_t *image;
    cm1e_datagram_t batch[CM1E_MAX_SLAVES];
};

/** Frees what was read of the slaves' SII. */
void cm1e_soem_forget_siis(cm1e_soem_t *soem);

#endif
