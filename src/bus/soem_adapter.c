#include "bus/soem_adapter.h"

#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "core/clock.h"
#include "device/device.h"
#include "ethercat.h"

enum { NS_PER_US = 1000 };
#define NS_PER_S INT64_C(1000000000)
/** A scan is given up after 0.2 s without any frame, or when it takes longer than this. */
enum { SCAN_SILENT_FRAMES = 100, SCAN_BASE_S = 5, SCAN_SLAVE_S = 1 };
/** SOEM reads the SII in groups of 8 bytes and may write a group past its buffer and its map. */
enum { SII_SLACK_BYTES = 8, SII_SLACK_WORDS = 1 };

struct cm1e_soem {
    ecx_contextt context;
    ecx_portt port;
    ecx_redportt redundant_port;
    ec_slavet slaves[CM1E_MAX_SLAVES + 1]; /* [0] is the master */
    int slave_count;
    ec_groupt groups[EC_MAXGROUP];
    uint8 sii_cache[(EC_MAXEEPBUF) + SII_SLACK_BYTES];
    uint32 sii_map[EC_MAXEEPBITMAP + SII_SLACK_WORDS];
    ec_eringt errors;
    ec_idxstackT stack;
    boolean error;
    int64 dc_time;
    ec_SMcommtypet sm_types[EC_MAX_MAPT];
    ec_PDOassignt pdo_assign[EC_MAX_MAPT];
    ec_PDOdesct pdo_description[EC_MAX_MAPT];
    ec_eepromSMt sii_sm;
    ec_eepromFMMUt sii_fmmu;
    uint8_t *image;
};

cm1e_soem_t *cm1e_soem_create(cm1e_nic_t *nic, const cm1e_bus_config_t *config)
{
    cm1e_soem_t *soem = calloc(1, sizeof *soem);
    if (!soem)
        return NULL;
    soem->context = (ecx_contextt){
        .port = &soem->port,
        .slavelist = soem->slaves,
        .slavecount = &soem->slave_count,
        .maxslave = CM1E_MAX_SLAVES + 1,
        .grouplist = soem->groups,
        .maxgroup = EC_MAXGROUP,
        .esibuf = soem->sii_cache,
        .esimap = soem->sii_map,
        .elist = &soem->errors,
        .idxstack = &soem->stack,
        .ecaterror = &soem->error,
        .DCtime = &soem->dc_time,
        .SMcommtype = soem->sm_types,
        .PDOassign = soem->pdo_assign,
        .PDOdesc = soem->pdo_description,
        .eepSM = &soem->sii_sm,
        .eepFMMU = &soem->sii_fmmu,
        .manualstatechange = 0,
    };
    soem->port.nic = nic;
    char second[sizeof config->second_interface];
    memcpy(second, config->second_interface, sizeof second);
    const int ok = second[0] ? ecx_init_redundant(&soem->context, &soem->redundant_port, config->interface_name, second)
                             : ecx_init(&soem->context, config->interface_name);
    if (ok <= 0) {
        free(soem);
        return NULL;
    }
    return soem;
}

void cm1e_soem_destroy(cm1e_soem_t *soem)
{
    if (!soem)
        return;
    ecx_close(&soem->context);
    free(soem);
}

/* ---- slaves -------------------------------------------------------------------------------------------------------- */

/** SOEM walks through the categories of a SII with a 16-bit address and no other end than their own end mark: a length
 *  that leads backwards would keep it for ever. So the way is walked before, by us, with bounds. */
static bool sii_can_be_walked(cm1e_soem_t *soem, int position)
{
    enum { FIRST_WORD = 0x40, LAST_WORD = 0x3FFF, CATEGORIES_MAX = 64, END_MARK = 0xFFFF };
    uint32 word = FIRST_WORD;
    for (int n = 0; n < CATEGORIES_MAX; n++) {
        const uint64 read = ecx_readeepromAP(&soem->context, (uint16)(1 - position), (uint16)word, EC_TIMEOUTEEP);
        const uint32 header = etohl((uint32)read);
        if ((header & 0xFFFF) == END_MARK || word >= (EC_MAXEEPBUF) / 2)
            return true; /* SOEM's buffer reads as end marks behind its end */
        word += 2 + (header >> 16);
        if (word > LAST_WORD)
            return false;
    }
    return false;
}

static int first_damaged_sii(cm1e_soem_t *soem, int count)
{
    uint8 take = 2, release = 0; /* EEPROM configuration: taken from the devices, then given to the master */
    ecx_BWR(&soem->port, 0, ECT_REG_EEPCFG, 1, &take, EC_TIMEOUTRET3);
    ecx_BWR(&soem->port, 0, ECT_REG_EEPCFG, 1, &release, EC_TIMEOUTRET3);
    for (int position = 1; position <= count; position++) {
        if (!sii_can_be_walked(soem, position))
            return position;
    }
    return 0;
}

static int scan(cm1e_soem_t *soem, int count, uint16_t *position)
{
    *position = (uint16_t)first_damaged_sii(soem, count);
    if (*position)
        return SCAN_DAMAGED_SII;
    soem->context.manualstatechange = 0; /* Pre-Operational is requested by the scan ... */
    const int found = ecx_config_init(&soem->context, FALSE);
    soem->context.manualstatechange = 1; /* ... everything above it by us */
    if (found == EC_SLAVECOUNTEXCEEDED)
        return SCAN_TOO_MANY;
    return found > 0 ? soem->slave_count : 0;
}

static void leave_scan(void *context) { longjmp(*(jmp_buf *)context, 1); }

/* SOEM's scan asks on, a minute and more for every slave, when nobody answers any more: it is left then. */
int cm1e_soem_scan(cm1e_soem_t *soem, uint16_t *position)
{
    uint16 type;
    const int count = ecx_BRD(&soem->port, 0, ECT_REG_TYPE, sizeof type, &type, EC_TIMEOUTSAFE);
    *position = 0;
    if (count <= 0)
        return 0;
    if (count > CM1E_MAX_SLAVES)
        return SCAN_TOO_MANY;
    jmp_buf gave_up;
    const cm1e_nic_patience_t patience = {
        .silent_frames = SCAN_SILENT_FRAMES,
        .deadline_ns = cm1e_clock_now(cm1e_clock_current()) + (SCAN_BASE_S + count * SCAN_SLAVE_S) * NS_PER_S,
        .give_up = leave_scan,
        .context = &gave_up,
    };
    cm1e_nic_set_patience(soem->port.nic, &patience);
    int found = SCAN_GAVE_UP;
    if (setjmp(gave_up) == 0)
        found = scan(soem, count, position);
    cm1e_nic_set_patience(soem->port.nic, NULL);
    return found;
}

static void copy_name(char *to, size_t room, const char *from, size_t from_size)
{
    size_t n = 0;
    for (; n + 1 < room && n < from_size && from[n]; n++)
        to[n] = from[n] >= ' ' && from[n] <= '~' ? from[n] : '?';
    to[n] = 0;
}

void cm1e_soem_facts(const cm1e_soem_t *soem, uint16_t position, cm1e_slave_facts_t *facts)
{
    const ec_slavet *slave = &soem->slaves[position];
    *facts = (cm1e_slave_facts_t){
        .station = slave->configadr,
        .alias = slave->aliasadr,
        .vendor_id = slave->eep_man,
        .product_code = slave->eep_id,
        .revision = slave->eep_rev,
        .serial_number = slave->eep_sn,
        .mailbox_out_start = etohs(slave->SM[0].StartAddr),
        .mailbox_out_length = slave->mbx_l ? etohs(slave->SM[0].SMlength) : 0,
        .mailbox_in_start = etohs(slave->SM[1].StartAddr),
        .mailbox_in_length = slave->mbx_l ? etohs(slave->SM[1].SMlength) : 0,
        .coe = slave->mbx_l > 0 && slave->mbx_proto & ECT_MBXPROT_COE,
        .complete_access = slave->CoEdetails & ECT_COEDET_SDOCA,
    };
    copy_name(facts->name, sizeof facts->name, slave->name, sizeof slave->name);
}

/* ---- process data ---------------------------------------------------------------------------------------------------- */

static uint16_t bytes_of(uint32_t bits) { return (uint16_t)((bits + 7) / 8); }

/** SOEM maps what it finds in `Obits`, `SMtype` and `SM`, and asks the slave nothing, when configindex is set. */
static void set_direction(ec_slavet *slave, int sm, uint8 type, uint16_t bits)
{
    const cm1e_sync_manager_t *standard = &cm1e_device_sync_managers[sm];
    if (slave->SM[sm].StartAddr == 0) {
        slave->SM[sm].StartAddr = htoes(standard->start);
        slave->SM[sm].SMflags = htoel(standard->control | (uint32)standard->enable << 16);
    }
    slave->SM[sm].SMlength = htoes(bytes_of(bits));
    slave->SMtype[sm] = type;
}

bool cm1e_soem_set_process_data(cm1e_soem_t *soem, uint16_t position, uint16_t output_bits, uint16_t input_bits)
{
    ec_slavet *slave = &soem->slaves[position];
    set_direction(slave, 2, 3, output_bits);
    set_direction(slave, 3, 4, input_bits);
    slave->Obits = output_bits;
    slave->Ibits = input_bits;
    slave->configindex = 1;
    const uint32_t outputs = etohs(slave->SM[2].StartAddr), inputs = etohs(slave->SM[3].StartAddr);
    /* Three buffers each, in the controller's memory from 0x1000 to 0xFFFF, without overlap. */
    const uint32_t output_end = outputs + 3u * bytes_of(output_bits), input_end = inputs + 3u * bytes_of(input_bits);
    const bool apart = output_end <= inputs || input_end <= outputs || !output_bits || !input_bits;
    return output_end <= 0x10000 && input_end <= 0x10000 && apart && output_bits + input_bits > 0;
}

bool cm1e_soem_set_process_data_by_sii(cm1e_soem_t *soem, uint16_t position)
{
    ec_slavet *slave = &soem->slaves[position];
    ec_eepromPDOt pdos;
    uint32 bits[2];
    for (uint8 direction = 0; direction < 2; direction++) { /* 0: inputs (TxPDO), 1: outputs */
        memset(&pdos, 0, sizeof pdos);
        bits[direction] = ecx_siiPDO(&soem->context, position, &pdos, direction);
        uint32 carried = 0;
        for (int sm = 0; sm < EC_MAXSM; sm++) {
            if (!pdos.SMbitsize[sm])
                continue;
            if (slave->SM[sm].StartAddr == 0 || (slave->mbx_l && sm < 2))
                return false;
            slave->SM[sm].SMlength = htoes(bytes_of(pdos.SMbitsize[sm]));
            slave->SMtype[sm] = direction ? 3 : 4;
            carried += pdos.SMbitsize[sm];
        }
        /* SOEM's mapping does not end when no sync manager carries the announced bits. */
        if (carried != bits[direction] || bits[direction] > UINT16_MAX)
            return false;
    }
    slave->Ibits = (uint16)bits[0];
    slave->Obits = (uint16)bits[1];
    slave->configindex = 1;
    return true;
}

size_t cm1e_soem_image_bytes(const cm1e_soem_t *soem)
{
    size_t bytes = 0;
    for (int i = 1; i <= soem->slave_count; i++)
        bytes += (size_t)bytes_of(soem->slaves[i].Obits) + bytes_of(soem->slaves[i].Ibits);
    return bytes;
}

bool cm1e_soem_map(cm1e_soem_t *soem, uint8_t *image, size_t room, size_t *output_bytes, size_t *input_bytes)
{
    ec_groupt *group = &soem->groups[0];
    if (room > (size_t)CM1E_PROCESS_FRAMES_MAX * (EC_MAXLRWDATA - EC_FIRSTDCDATAGRAM))
        return false;
    soem->image = image;
    const int used = ecx_config_map_group_aligned(&soem->context, image, 0);
    *output_bytes = group->Obytes;
    *input_bytes = group->Ibytes;
    /* Distributed clocks are not used: the drives take their cycle from the process data (UG 4.3). */
    group->hasdc = FALSE;
    return used >= 0 && (size_t)used <= room && group->nsegments <= CM1E_PROCESS_FRAMES_MAX;
}

void cm1e_soem_placement(const cm1e_soem_t *soem, uint16_t position, cm1e_slave_placement_t *placement)
{
    const ec_slavet *slave = &soem->slaves[position];
    const ec_groupt *group = &soem->groups[0];
    memset(placement, 0, sizeof *placement);
    if (slave->outputs)
        placement->output_offset = (uint32_t)(slave->outputs - soem->image);
    if (slave->inputs)
        placement->input_offset = (uint32_t)(slave->inputs - soem->image) - group->Obytes;
    placement->output_bytes = bytes_of(slave->Obits);
    placement->input_bytes = bytes_of(slave->Ibits);
    for (int i = 0; i < 4; i++)
        memcpy(placement->sync_managers[i], &slave->SM[i], SYNC_MANAGER_BYTES);
    placement->fmmu_count = slave->FMMUunused < EC_MAXFMMU ? slave->FMMUunused : EC_MAXFMMU;
    for (unsigned i = 0; i < placement->fmmu_count; i++)
        memcpy(placement->fmmus[i], &slave->FMMU[i], FMMU_BYTES);
}

int cm1e_soem_expected_working_counter(const cm1e_soem_t *soem)
{
    /* LRW counts 2 for a slave that takes outputs and 1 for one that gives inputs; SOEM emulates that for LRD/LWR. */
    return soem->groups[0].outputsWKC * 2 + soem->groups[0].inputsWKC;
}

void cm1e_soem_send_process_data(cm1e_soem_t *soem) { ecx_send_processdata(&soem->context); }

int cm1e_soem_receive_process_data(cm1e_soem_t *soem, int64_t timeout_ns)
{
    const int frames = soem->stack.pushed > 0 ? soem->stack.pushed : 1;
    const int working_counter = ecx_receive_processdata(&soem->context, (int)(timeout_ns / NS_PER_US / frames));
    return working_counter < 0 ? DATAGRAM_LOST : working_counter;
}

uint64_t cm1e_soem_late_frames(const cm1e_soem_t *soem) { return soem->port.counters.late; }

/* ---- single datagrams ------------------------------------------------------------------------------------------------ */

void cm1e_soem_post(cm1e_soem_t *soem, cm1e_datagram_t *d, int64_t now_ns)
{
    d->frame_index = ecx_getindex(&soem->port);
    d->sent_ns = now_ns;
    d->working_counter = DATAGRAM_LOST;
    ecx_setupdatagram(&soem->port, &soem->port.txbuf[d->frame_index], d->command, d->frame_index, d->address, d->offset,
                      d->length, d->data);
    ecx_outframe_red(&soem->port, d->frame_index);
}

/** The frame that came back under our index is ours: same command, same length, same address where nobody changes it. */
static bool is_answer(const cm1e_datagram_t *d, const uint8_t *frame)
{
    const bool fixed_address = d->command == COMMAND_FPRD || d->command == COMMAND_FPWR;
    return frame[2] == d->command && (cm1e_get_u16(frame + 8) & 0x07FF) == d->length &&
           cm1e_get_u16(frame + 6) == d->offset && (!fixed_address || cm1e_get_u16(frame + 4) == d->address);
}

bool cm1e_soem_take(cm1e_soem_t *soem, cm1e_datagram_t *d, int64_t timeout_ns)
{
    const int working_counter = ecx_waitinframe(&soem->port, d->frame_index, (int)(timeout_ns / NS_PER_US));
    if (working_counter < 0)
        return false;
    const uint8_t *frame = (const uint8_t *)&soem->port.rxbuf[d->frame_index];
    const bool ours = is_answer(d, frame);
    if (ours) {
        d->working_counter = cm1e_get_u16(frame + EC_HEADERSIZE + d->length);
        if (d->command == COMMAND_FPRD || d->command == COMMAND_APRD || d->command == COMMAND_BRD)
            memcpy(d->data, frame + EC_HEADERSIZE, d->length);
    }
    ecx_setbufstat(&soem->port, d->frame_index, EC_BUF_EMPTY);
    return true;
}

void cm1e_soem_drop(cm1e_soem_t *soem, cm1e_datagram_t *d)
{
    ecx_setbufstat(&soem->port, d->frame_index, EC_BUF_EMPTY);
    d->working_counter = DATAGRAM_LOST;
}

int cm1e_soem_transfer(cm1e_soem_t *soem, cm1e_command_t command, uint16_t address, uint16_t offset, void *data,
                       uint16_t length)
{
    const uint8 index = ecx_getindex(&soem->port);
    ecx_setupdatagram(&soem->port, &soem->port.txbuf[index], (uint8)command, index, address, offset, length, data);
    const int working_counter = ecx_srconfirm(&soem->port, index, EC_TIMEOUTRET3);
    if (working_counter > 0 && (command == COMMAND_BRD || command == COMMAND_APRD || command == COMMAND_FPRD))
        memcpy(data, (const uint8_t *)&soem->port.rxbuf[index] + EC_HEADERSIZE, length);
    ecx_setbufstat(&soem->port, index, EC_BUF_EMPTY);
    return working_counter < 0 ? DATAGRAM_LOST : working_counter;
}
