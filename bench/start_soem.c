#include "start_soem.h"

#include <stdlib.h>
#include <string.h>

#include "ethercat.h"

enum { IMAGE_BYTES = 128 * 64, ASSIGN_OUTPUTS = 0x1C12, CHECKS = 200, CHECK_US = 50000 };

/** What simple_test has as globals. */
typedef struct soem_master {
    ecx_contextt context;
    ecx_portt port;
    ec_slavet slaves[EC_MAXSLAVE];
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
    uint8 image[IMAGE_BYTES];
} soem_master_t;

static soem_master_t *make(void)
{
    soem_master_t *master = calloc(1, sizeof *master);
    if (!master)
        return NULL;
    master->context = (ecx_contextt){
        .port = &master->port, .slavelist = master->slaves, .slavecount = &master->slave_count,
        .maxslave = EC_MAXSLAVE, .grouplist = master->groups, .maxgroup = EC_MAXGROUP, .esibuf = master->sii_cache,
        .esimap = master->sii_map, .elist = &master->errors, .idxstack = &master->stack, .ecaterror = &master->error,
        .DCtime = &master->dc_time, .SMcommtype = master->sm_types, .PDOassign = master->pdo_assign,
        .PDOdesc = master->pdo_description, .eepSM = &master->sii_sm, .eepFMMU = &master->sii_fmmu,
    };
    return master;
}

static const start_soem_t *started;

/** Pre-Operational to Safe-Operational: an assignment is emptied, filled and counted. */
static int assign_pdos(ecx_contextt *context, uint16 slave)
{
    uint8 none = 0, one = 1;
    int written = 0;
    for (int direction = 0; direction < 2; direction++) {
        const uint16 index = (uint16)(ASSIGN_OUTPUTS + direction);
        uint16 pdo = htoes(started->pdos[direction]);
        written += ecx_SDOwrite(context, slave, index, 0, FALSE, sizeof none, &none, EC_TIMEOUTRXM) > 0;
        written += ecx_SDOwrite(context, slave, index, 1, FALSE, sizeof pdo, &pdo, EC_TIMEOUTRXM) > 0;
        written += ecx_SDOwrite(context, slave, index, 0, FALSE, sizeof one, &one, EC_TIMEOUTRXM) > 0;
    }
    return written == 6;
}

static void end_of(const char *phase)
{
    if (started->phase)
        started->phase(phase);
}

static int receive(void *soem) { return ecx_receive_processdata(soem, EC_TIMEOUTRET); }
static void send(void *soem) { ecx_send_processdata(soem); }

static const char *run(soem_master_t *master)
{
    ecx_contextt *context = &master->context;
    if (ecx_config_init(context, FALSE) != (int)started->slaves)
        return "SOEM found another number of slaves";
    for (uint32_t i = 1; i <= started->slaves; i++)
        master->slaves[i].PO2SOconfigx = assign_pdos;
    end_of("ec_config_init");
    if (ecx_config_map_group(context, master->image, 0) > IMAGE_BYTES)
        return "the process image is too small";
    end_of("ec_config_map");
    if (ecx_statecheck(context, 0, EC_STATE_SAFE_OP, EC_TIMEOUTSTATE * 4) != EC_STATE_SAFE_OP)
        return "SOEM did not reach Safe-Operational";
    end_of("Safe-Operational");
    ecx_send_processdata(context);
    ecx_receive_processdata(context, EC_TIMEOUTRET);
    master->slaves[0].state = EC_STATE_OPERATIONAL;
    ecx_writestate(context, 0);
    for (int i = 0; i < CHECKS; i++) {
        ecx_send_processdata(context);
        ecx_receive_processdata(context, EC_TIMEOUTRET);
        if (ecx_statecheck(context, 0, EC_STATE_OPERATIONAL, CHECK_US) == EC_STATE_OPERATIONAL) {
            end_of("Operational");
            if (started->operating)
                started->operating(context, receive, send);
            return NULL;
        }
    }
    return "SOEM did not reach Operational";
}

static const char *run_and_stop(soem_master_t *master)
{
    const char *why = run(master);
    master->slaves[0].state = EC_STATE_INIT;
    ecx_writestate(&master->context, 0);
    ecx_close(&master->context);
    return why;
}

#ifdef START_SOEM_OF_ITS_OWN
const char *start_soem_of_its_own(const start_soem_t *start)
#else
const char *start_soem_of_the_library(const start_soem_t *start)
#endif
{
    soem_master_t *master = make();
    if (!master)
        return "out of memory";
    started = start;
#ifndef START_SOEM_OF_ITS_OWN
    master->port.nic = start->nic;
#endif
    const char *why = "SOEM cannot open the interface";
    if (ecx_init(&master->context, start->interface) > 0)
        why = run_and_stop(master);
    free(master);
    return why;
}
