#include "bus/soem_adapter.h"

#include <stdlib.h>
#include <string.h>

#include "bus/soem_private.h"
#include "core/bytes.h"
#include "core/clock.h"
#include "device/device.h"
#include "nic/ring.h"

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
        .manualstatechange = 1, /* states are requested by us */
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
    cm1e_soem_forget_siis(soem);
    free(soem);
}

/* ---- process data ---------------------------------------------------------------------------------------------- */

static uint16_t bytes_of(uint32_t bits) { return (uint16_t)((bits + 7) / 8); }

/** SOEM maps what it finds in `Obits`, `SMtype` and `SM`, and asks the slave nothing, when configindex is set. From the
 *  SII only the place in the controller's memory is used, not the control byte: a damaged SII could omit the watchdog
 *  trigger of the outputs (bit 6), and a motor would go on for ever when the frames stop. */
static void set_direction(ec_slavet *slave, int sm, uint8 type, uint16_t bits)
{
    const cm1e_sync_manager_t *standard = &cm1e_device_sync_managers[sm];
    if (slave->SM[sm].StartAddr == 0)
        slave->SM[sm].StartAddr = htoes(standard->start);
    slave->SM[sm].SMflags = htoel(standard->control | (uint32)standard->enable << 16);
    slave->SM[sm].SMlength = htoes(bytes_of(bits));
    slave->SMtype[sm] = type;
}

/** Three buffers each, in the controller's memory from 0x1000 to 0xFFFF, without overlap. */
static bool are_apart(const ec_slavet *slave, uint16_t output_bits, uint16_t input_bits)
{
    const uint32_t outputs = etohs(slave->SM[2].StartAddr), inputs = etohs(slave->SM[3].StartAddr);
    const uint32_t output_end = outputs + 3u * bytes_of(output_bits), input_end = inputs + 3u * bytes_of(input_bits);
    const bool apart = output_end <= inputs || input_end <= outputs || !output_bits || !input_bits;
    return output_end <= 0x10000 && input_end <= 0x10000 && apart;
}

bool cm1e_soem_set_process_data(cm1e_soem_t *soem, uint16_t position, uint16_t output_bits, uint16_t input_bits)
{
    ec_slavet *slave = &soem->slaves[position];
    set_direction(slave, 2, 3, output_bits);
    set_direction(slave, 3, 4, input_bits);
    slave->Obits = output_bits;
    slave->Ibits = input_bits;
    slave->configindex = 1;
    return are_apart(slave, output_bits, input_bits) && output_bits + input_bits > 0;
}

bool cm1e_soem_set_process_data_by_sii(cm1e_soem_t *soem, uint16_t position)
{
    ec_slavet *slave = &soem->slaves[position];
    const cm1e_sii_t *sii = &soem->siis[position];
    uint32_t bits[2] = {0, 0};
    for (int direction = 0; direction < 2; direction++) {
        for (int sm = 0; sm < CM1E_SII_SYNC_MANAGERS; sm++) {
            const uint32_t carried = sii->bits[direction][sm];
            if (!carried)
                continue;
            bits[direction] = (bits[direction] + 7) / 8 * 8; /* a sync manager begins with a whole byte */
            /* SOEM's mapping does not end where a sync manager of that number is missing. */
            if (slave->SM[sm].StartAddr == 0 || (slave->mbx_l && sm < 2) || carried > UINT16_MAX - bits[direction])
                return false;
            slave->SM[sm].SMlength = htoes(bytes_of(carried));
            slave->SMtype[sm] = direction ? 4 : 3;
            bits[direction] += carried;
        }
    }
    slave->Obits = (uint16)bits[0];
    slave->Ibits = (uint16)bits[1];
    slave->configindex = 1;
    return true;
}

bool cm1e_soem_set_process_data_by_pdos(cm1e_soem_t *soem, uint16_t position, uint16_t output_bits, uint16_t input_bits)
{
    ec_slavet *slave = &soem->slaves[position];
    const uint16_t bits[2] = {output_bits, input_bits};
    const bool swapped = cm1e_sii_is_swapped(soem->siis[position].sync_managers);
    for (int direction = 0; direction < 2; direction++) {
        const int sm = swapped ? 3 - direction : 2 + direction;
        ec_smt *manager = &slave->SM[sm];
        if (bits[direction] && manager->StartAddr == 0)
            return false;
        manager->SMlength = htoes(bytes_of(bits[direction]));
        slave->SMtype[sm] = direction ? 4 : 3;
    }
    slave->Obits = output_bits;
    slave->Ibits = input_bits;
    slave->configindex = 1;
    return swapped ? are_apart(slave, input_bits, output_bits) : are_apart(slave, output_bits, input_bits);
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
    group->hasdc = FALSE; /* until cm1e_soem_use_clocks() */
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

unsigned cm1e_soem_process_frames(const cm1e_soem_t *soem) { return soem->groups[0].nsegments; }

int cm1e_soem_expected_working_counter(const cm1e_soem_t *soem)
{
    /* LRW counts 2 for a slave that takes outputs and 1 for one that gives inputs; SOEM emulates that for LRD/LWR. */
    return soem->groups[0].outputsWKC * 2 + soem->groups[0].inputsWKC;
}

void cm1e_soem_use_clocks(cm1e_soem_t *soem, uint16_t position)
{
    soem->groups[0].hasdc = position > 0;
    soem->groups[0].DCnext = position;
}

void cm1e_soem_set_clock_time(cm1e_soem_t *soem, int64_t time_ns) { soem->dc_time = (int64)htoell(time_ns); }
int64_t cm1e_soem_clock_time(const cm1e_soem_t *soem) { return soem->dc_time; }

void cm1e_soem_send_process_data(cm1e_soem_t *soem) { ecx_send_processdata(&soem->context); }

int cm1e_soem_receive_process_data(cm1e_soem_t *soem, int64_t timeout_ns)
{
    const int frames = soem->stack.pushed > 0 ? soem->stack.pushed : 1;
    const int working_counter = ecx_receive_processdata(&soem->context, (int)(timeout_ns / US_IN_NS / frames));
    return working_counter < 0 ? DATAGRAM_LOST : working_counter;
}

uint64_t cm1e_soem_late_frames(const cm1e_soem_t *soem) { return soem->port.counters.late; }
uint64_t cm1e_soem_foreign_frames(const cm1e_soem_t *soem) { return soem->port.counters.foreign; }
uint64_t cm1e_soem_unsent_frames(const cm1e_soem_t *soem) { return soem->port.counters.send_failed; }

bool cm1e_soem_ring_is_broken(const cm1e_soem_t *soem)
{
    return soem->port.redundant && soem->port.ring.state != RING_INTACT;
}

bool cm1e_soem_ring_reach(const cm1e_soem_t *soem, uint32_t reach[2])
{
    for (int i = 0; i < 2; i++)
        reach[i] = (uint32_t)soem->port.ring.reach[i];
    return soem->port.redundant && soem->port.ring.reach_known;
}

/* ---- single datagrams ------------------------------------------------------------------------------------------ */

void cm1e_soem_post(cm1e_soem_t *soem, cm1e_datagram_t *d, int64_t now_ns)
{
    d->frame_index = ecx_getindex(&soem->port);
    d->sent_ns = now_ns;
    d->working_counter = DATAGRAM_LOST;
    ecx_setupdatagram(&soem->port, &soem->port.txbuf[d->frame_index], d->command, d->frame_index, d->address, d->offset,
                      d->length, d->data);
    ecx_outframe_red(&soem->port, d->frame_index);
}

/** Whether the frame that came back under this index is the expected one: same command and length, and same address if
 *  no slave changes it. */
static bool is_answer(const cm1e_datagram_t *d, const uint8_t *frame)
{
    const bool fixed_address = d->command == COMMAND_FPRD || d->command == COMMAND_FPWR;
    return frame[2] == d->command && (cm1e_get_u16(frame + 8) & 0x07FF) == d->length &&
           cm1e_get_u16(frame + 6) == d->offset && (!fixed_address || cm1e_get_u16(frame + 4) == d->address);
}

bool cm1e_soem_take(cm1e_soem_t *soem, cm1e_datagram_t *d, int64_t timeout_ns)
{
    const int working_counter = ecx_waitinframe(&soem->port, d->frame_index, (int)(timeout_ns / US_IN_NS));
    if (working_counter < 0)
        return false;
    const uint8_t *frame = (const uint8_t *)&soem->port.rxbuf[d->frame_index];
    const bool ours = is_answer(d, frame);
    if (ours) {
        d->working_counter = cm1e_get_u16(frame + EC_HEADERSIZE + d->length);
        if (d->command == COMMAND_FPRD || d->command == COMMAND_APRD || d->command == COMMAND_APRW ||
            d->command == COMMAND_BRD)
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
    if (working_counter > 0 && (command == COMMAND_BRD || command == COMMAND_APRD || command == COMMAND_FPRD ||
                                command == COMMAND_FRMW))
        memcpy(data, (const uint8_t *)&soem->port.rxbuf[index] + EC_HEADERSIZE, length);
    ecx_setbufstat(&soem->port, index, EC_BUF_EMPTY);
    return working_counter < 0 ? DATAGRAM_LOST : working_counter;
}
