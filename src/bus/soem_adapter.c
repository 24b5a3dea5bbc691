#include "bus/soem_adapter.h"

#include <stdlib.h>
#include <string.h>

#include "bus/soem_private.h"
#include "core/bytes.h"
#include "core/clock.h"
#include "device/device.h"
#include "nic/rider.h"
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

size_t cm1e_soem_frame_room(void) { return EC_MAXLRWDATA - EC_FIRSTDCDATAGRAM; }

bool cm1e_soem_map(cm1e_soem_t *soem, uint16_t present, uint8_t *image, unsigned most_frames, size_t *output_bytes,
                   size_t *input_bytes)
{
    ec_groupt *group = &soem->groups[0];
    const size_t room = cm1e_soem_image_bytes(soem);
    if (room > most_frames * cm1e_soem_frame_room())
        return false;
    soem->image = image;
    soem->port.logical = image;
    soem->port.absent_from = (uint16_t)(EC_NODEOFFSET + present + 1);
    const int used = ecx_config_map_group_aligned(&soem->context, image, 0);
    soem->port.absent_from = 0;
    *output_bytes = group->Obytes;
    *input_bytes = group->Ibytes;
    group->hasdc = FALSE; /* until cm1e_soem_use_clocks() */
    return used >= 0 && (size_t)used <= room && group->nsegments <= most_frames;
}

bool cm1e_soem_refuses_lrw(const cm1e_soem_t *soem, uint16_t position) { return soem->slaves[position].blockLRW; }

void cm1e_soem_set_frames(cm1e_soem_t *soem, const uint32_t *sizes, unsigned count, unsigned takers, unsigned givers)
{
    ec_groupt *group = &soem->groups[0];
    group->Obytes = 0;
    for (unsigned i = 0; i < count; i++) {
        group->IOsegment[i] = sizes[i];
        group->Obytes += sizes[i];
    }
    group->Ibytes = 0; /* the inputs come back in the place of what is sent */
    group->nsegments = (uint16)count;
    group->outputs = soem->image;
    group->outputsWKC = (uint16)takers;
    group->inputsWKC = (uint16)givers;
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
    placement->last_input_bits = slave->Ibits % 8 ? (uint8_t)((1u << slave->Ibits % 8) - 1) : 0xFF;
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

/* FRAME_ROOM: without the check sequence. */
enum { DATAGRAM_HEADER_BYTES = 10, DATAGRAM_LENGTH = 0x07FF, FRAME_ROOM = EC_MAXECATFRAME - 4 };

void cm1e_soem_post(cm1e_soem_t *soem, cm1e_datagram_t *d, int64_t now_ns)
{
    d->rides = false;
    d->frame_index = ecx_getindex(&soem->port);
    d->sent_ns = now_ns;
    d->working_counter = DATAGRAM_LOST;
    ecx_setupdatagram(&soem->port, &soem->port.txbuf[d->frame_index], d->command, d->frame_index, d->address, d->offset,
                      d->length, d->data);
    ecx_outframe_red(&soem->port, d->frame_index);
}

/** Whether the datagram that came back is the expected one: same command and length, and same address if no slave
 *  changes it. */
static bool is_answer(const cm1e_datagram_t *d, const uint8_t *header)
{
    const bool fixed_address = d->command == COMMAND_FPRD || d->command == COMMAND_FPWR;
    return header[0] == d->command && (cm1e_get_u16(header + 6) & DATAGRAM_LENGTH) == d->length &&
           cm1e_get_u16(header + 4) == d->offset && (!fixed_address || cm1e_get_u16(header + 2) == d->address);
}

/** Takes the answer to a datagram whose data came back here. */
static void take_data(const uint8_t *data, cm1e_datagram_t *d)
{
    if (!is_answer(d, data - DATAGRAM_HEADER_BYTES))
        return;
    d->working_counter = cm1e_get_u16(data + d->length);
    if (d->command == COMMAND_FPRD || d->command == COMMAND_APRD || d->command == COMMAND_APRW ||
        d->command == COMMAND_BRD)
        memcpy(d->data, data, d->length);
}

/** Takes the answer to a datagram whose data are at `at` of the frame that is back. */
static void take_answer(const cm1e_soem_t *soem, uint8_t index, unsigned at, cm1e_datagram_t *d)
{
    take_data((const uint8_t *)&soem->port.rxbuf[index] + at, d);
}

static bool find_seat(const ecx_portt *port, uint8_t *seat)
{
    for (*seat = 0; *seat < CM1E_RIDERS; ++*seat)
        if (port->riders[*seat].state == RIDER_NONE)
            return true;
    return false;
}

void cm1e_soem_offer(cm1e_soem_t *soem, cm1e_datagram_t *d)
{
    const size_t bytes = DATAGRAM_HEADER_BYTES + d->length + EC_WKCSIZE;
    d->rides = d->command == COMMAND_FPRD && bytes <= CM1E_RIDER_ROOM && find_seat(&soem->port, &d->seat);
    if (!d->rides)
        return;
    cm1e_port_rider_t *rider = &soem->port.riders[d->seat];
    memset(rider->datagram, 0, bytes);
    rider->datagram[0] = d->command;
    cm1e_put_u16(rider->datagram + 2, d->address);
    cm1e_put_u16(rider->datagram + 4, d->offset);
    cm1e_put_u16(rider->datagram + 6, d->length);
    rider->bytes = (uint16_t)bytes;
    rider->state = RIDER_WAITS;
}

static void leave_seat(cm1e_soem_t *soem, cm1e_datagram_t *d)
{
    soem->port.riders[d->seat].state = RIDER_NONE;
    d->rides = false;
}

bool cm1e_soem_rides(cm1e_soem_t *soem, cm1e_datagram_t *d, int64_t now_ns)
{
    if (d->rides && soem->port.riders[d->seat].state != RIDER_ABOARD)
        leave_seat(soem, d);
    if (!d->rides)
        return false;
    d->sent_ns = now_ns;
    d->working_counter = DATAGRAM_LOST;
    return true;
}

static bool take_rider(cm1e_soem_t *soem, cm1e_datagram_t *d)
{
    const cm1e_port_rider_t *rider = &soem->port.riders[d->seat];
    if (rider->state == RIDER_ABOARD)
        return false;
    if (rider->state == RIDER_BACK)
        take_data(rider->datagram + DATAGRAM_HEADER_BYTES, d);
    leave_seat(soem, d);
    return true;
}

bool cm1e_soem_take(cm1e_soem_t *soem, cm1e_datagram_t *d, int64_t timeout_ns)
{
    if (d->rides)
        return take_rider(soem, d);
    const int working_counter = ecx_waitinframe(&soem->port, d->frame_index, (int)(timeout_ns / US_IN_NS));
    if (working_counter < 0)
        return false;
    take_answer(soem, d->frame_index, EC_HEADERSIZE, d);
    ecx_setbufstat(&soem->port, d->frame_index, EC_BUF_EMPTY);
    return true;
}

void cm1e_soem_drop(cm1e_soem_t *soem, cm1e_datagram_t *d)
{
    if (d->rides)
        leave_seat(soem, d);
    else
        ecx_setbufstat(&soem->port, d->frame_index, EC_BUF_EMPTY);
    d->working_counter = DATAGRAM_LOST;
}

/* ---- several datagrams in one frame ------------------------------------------------------------------------------ */

static void begin_bundle(cm1e_soem_t *soem, cm1e_bundle_t *bundle, const cm1e_datagram_t *d)
{
    ecx_portt *port = &soem->port;
    bundle->frame_index = ecx_getindex(port);
    ecx_setupdatagram(port, &port->txbuf[bundle->frame_index], d->command, bundle->frame_index, d->address, d->offset,
                      d->length, (void *)(uintptr_t)d->data);
    bundle->at[0] = EC_HEADERSIZE;
}

/** SOEM says of the first datagram only that another one follows. */
static void say_that_one_follows(cm1e_soem_t *soem, const cm1e_bundle_t *bundle)
{
    const unsigned data = ETH_HEADERSIZE + bundle->at[bundle->count - 1];
    uint8_t *length = (uint8_t *)&soem->port.txbuf[bundle->frame_index] + data - DATAGRAM_HEADER_BYTES + 6;
    cm1e_put_u16(length, cm1e_get_u16(length) | EC_DATAGRAMFOLLOWS);
}

bool cm1e_soem_add(cm1e_soem_t *soem, cm1e_bundle_t *bundle, cm1e_datagram_t *d)
{
    ecx_portt *port = &soem->port;
    if (bundle->count == 0) {
        begin_bundle(soem, bundle, d);
    } else {
        const uint8_t index = bundle->frame_index;
        const size_t bytes = (size_t)port->txbuflength[index] + DATAGRAM_HEADER_BYTES + d->length + EC_WKCSIZE;
        if (bundle->count == CM1E_BUNDLE_DATAGRAMS || bytes > FRAME_ROOM)
            return false;
        say_that_one_follows(soem, bundle);
        bundle->at[bundle->count] = ecx_adddatagram(port, &port->txbuf[index], d->command, index, FALSE, d->address,
                                                    d->offset, d->length, d->data);
    }
    bundle->datagrams[bundle->count++] = d;
    return true;
}

void cm1e_soem_post_bundle(cm1e_soem_t *soem, cm1e_bundle_t *bundle, int64_t now_ns)
{
    bundle->sent_ns = now_ns;
    for (unsigned i = 0; i < bundle->count; i++) {
        bundle->datagrams[i]->sent_ns = now_ns;
        bundle->datagrams[i]->working_counter = DATAGRAM_LOST;
    }
    ecx_outframe_red(&soem->port, bundle->frame_index);
}

bool cm1e_soem_take_bundle(cm1e_soem_t *soem, const cm1e_bundle_t *bundle, int64_t timeout_ns)
{
    if (ecx_waitinframe(&soem->port, bundle->frame_index, (int)(timeout_ns / US_IN_NS)) < 0)
        return false;
    for (unsigned i = 0; i < bundle->count; i++)
        take_answer(soem, bundle->frame_index, bundle->at[i], bundle->datagrams[i]);
    ecx_setbufstat(&soem->port, bundle->frame_index, EC_BUF_EMPTY);
    return true;
}

void cm1e_soem_drop_bundle(cm1e_soem_t *soem, const cm1e_bundle_t *bundle)
{
    ecx_setbufstat(&soem->port, bundle->frame_index, EC_BUF_EMPTY);
}

cm1e_datagram_t *cm1e_soem_batch(cm1e_soem_t *soem) { return soem->batch; }

/** Sends the next frames of those that are not answered yet, from `from` on, and takes them. Returns where it ended. */
static unsigned transfer_some(cm1e_soem_t *soem, cm1e_datagram_t *datagrams, unsigned from, unsigned count)
{
    cm1e_bundle_t frames[CM1E_FRAMES_IN_FLIGHT];
    unsigned used = 0;
    while (from < count && used < CM1E_FRAMES_IN_FLIGHT) {
        cm1e_bundle_t *frame = &frames[used++];
        frame->count = 0;
        while (from < count && (datagrams[from].working_counter == 1 || cm1e_soem_add(soem, frame, &datagrams[from])))
            from++;
        if (frame->count == 0)
            used--;
        else
            cm1e_soem_post_bundle(soem, frame, cm1e_clock_now(cm1e_clock_current()));
    }
    for (unsigned i = 0; i < used; i++)
        if (!cm1e_soem_take_bundle(soem, &frames[i], EC_TIMEOUTRET * US_IN_NS))
            cm1e_soem_drop_bundle(soem, &frames[i]);
    return from;
}

void cm1e_soem_transfer_all(cm1e_soem_t *soem, cm1e_datagram_t *datagrams, unsigned count, unsigned tries)
{
    for (unsigned i = 0; i < count; i++)
        datagrams[i].working_counter = DATAGRAM_LOST;
    for (unsigned try = 0; try < tries; try++)
        for (unsigned from = 0; from < count;)
            from = transfer_some(soem, datagrams, from, count);
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
