#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "description/sii_image.h"
#include "generate/eni.h"
#include "generate/eni_registers.h"

/* Station addresses as this library's own master gives them; logical addresses as TwinCAT does, a range for each frame
 * that is longer than any frame. */
enum { FIRST_STATION = 0x1001, FIRST_LOGICAL = 0x01000000, LOGICAL_PER_FRAME = 0x800 };
/* An image is the frames behind each other, each in a room of its own; datagrams begin behind the headers of Ethernet
 * and EtherCAT. */
enum { IMAGE_PER_FRAME = 1536, FRAME_HEADERS = 16 };
enum { COE_TIMEOUT_MS = 3000, MAILBOX_POLL_MS = 50 };
enum { BY_SYNC0 = 0x0300, BY_SYNC0_AND_SYNC1 = 0x0700 };

typedef struct maker {
    cm1e_eni_t *document;
    cm1e_arena_t *arena;
    cm1e_diag_t *diag;
    cm1e_eni_frame_t *frame;     /* that slaves are being put into; NULL: none yet */
    cm1e_eni_command_t *shared;  /* its last command, if that is an LRW, which further slaves share; else NULL */
    uint32_t frames;
    int64_t cycle_time_ns;
    bool reference;              /* there is a reference clock */
    uint16_t reference_position; /* its AutoIncAddr */
} maker_t;

static cm1e_error_t wrong(maker_t *maker, const cm1e_eni_slave_t *slave, const char *what)
{
    return cm1e_diag_set(maker->diag, CM1E_ERROR_CONFIG, 0, "%s: %s", slave->name && *slave->name ? slave->name : "?",
                         what);
}

/* ---- a slave ---------------------------------------------------------------------------------------------------- */

static uint32_t directed_bytes(const cm1e_eni_device_t *device, cm1e_sync_manager_use_t use)
{
    uint32_t bytes = 0;
    for (size_t i = 0; i < device->sync_managers.count; i++)
        if (device->sync_managers.at[i].manager.use == use && device->sync_managers.at[i].manager.enable)
            bytes += device->sync_managers.at[i].manager.length;
    return bytes;
}

static void make_sync_managers(maker_t *maker, cm1e_eni_device_t *device, const cm1e_description_t *described)
{
    for (size_t n = 0; n < described->sync_managers.count; n++) {
        const cm1e_described_sync_manager_t *manager = &described->sync_managers.at[n];
        if (manager->use != CM1E_SM_OUTPUTS && manager->use != CM1E_SM_INPUTS)
            continue;
        cm1e_eni_sync_manager_t *made = CM1E_APPEND(maker->arena, &device->sync_managers);
        made->number = (uint8_t)n;
        made->manager = *manager;
        made->manager.place = 0;
        made->manager.minimum_length = made->manager.maximum_length = 0;
        made->manager.length = (uint16_t)cm1e_description_process_bytes(described, (unsigned)n);
        made->manager.length_given = true;
        made->manager.enable = made->manager.length > 0;
        for (size_t i = 0; i < described->pdos.count; i++)
            if (described->pdos.at[i].sync_manager == (int)n)
                *(uint16_t *)CM1E_APPEND(maker->arena, &made->pdos) = described->pdos.at[i].index;
    }
}

/* TxPDOs, then RxPDOs, as the schema wants them; `sync_manager` is where the file puts a PDO. */
static void make_pdos(maker_t *maker, cm1e_eni_device_t *device, const cm1e_description_t *described)
{
    for (int transmit = 1; transmit >= 0; transmit--)
        for (size_t i = 0; i < described->pdos.count; i++)
            if (described->pdos.at[i].transmit == (transmit == 1))
                *(cm1e_described_pdo_t *)CM1E_APPEND(maker->arena, &device->pdos) = described->pdos.at[i];
}

static uint16_t eni_transitions(uint8_t transitions)
{
    static const struct {
        uint8_t described;
        uint16_t eni;
    } rows[] = {
        {CM1E_TRANSITION_IP, CM1E_ENI_IP}, {CM1E_TRANSITION_PS, CM1E_ENI_PS}, {CM1E_TRANSITION_SO, CM1E_ENI_SO},
        {CM1E_TRANSITION_SP, CM1E_ENI_SP}, {CM1E_TRANSITION_OP, CM1E_ENI_OP}, {CM1E_TRANSITION_OS, CM1E_ENI_OS},
    };
    uint16_t mask = 0;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (transitions & rows[i].described)
            mask |= rows[i].eni;
    return mask;
}

static void make_sdos(maker_t *maker, cm1e_eni_mailbox_t *mailbox, const cm1e_description_t *described)
{
    for (size_t i = 0; i < described->init_commands.count; i++) {
        const cm1e_init_command_t *command = &described->init_commands.at[i];
        cm1e_eni_sdo_t *sdo = CM1E_APPEND(maker->arena, &mailbox->sdos);
        sdo->transitions = eni_transitions(command->transitions);
        sdo->comment = command->comment;
        sdo->timeout_ms = COE_TIMEOUT_MS;
        sdo->specifier = 1;
        sdo->index = command->index;
        sdo->subindex = command->subindex;
        sdo->fixed = command->fixed;
        sdo->complete_access = command->complete_access;
        sdo->data = command->data;
    }
}

/* The mailbox of a direction: that of its sync manager, with the length of the words 0x18 to 0x1B of an EEPROM where
 * that states none. No length: there is none. */
static cm1e_eni_mailbox_area_t mailbox_area(const cm1e_description_t *described, cm1e_sync_manager_use_t use)
{
    const cm1e_described_eeprom_t *eeprom = &described->eeprom;
    const uint16_t length = use == CM1E_SM_MAILBOX_OUT ? eeprom->mailbox_out_length : eeprom->mailbox_in_length;
    for (size_t n = 0; n < described->sync_managers.count; n++) {
        const cm1e_described_sync_manager_t *manager = &described->sync_managers.at[n];
        if (manager->use == use)
            return (cm1e_eni_mailbox_area_t){manager->start, manager->length > 0 ? manager->length : length};
    }
    return (cm1e_eni_mailbox_area_t){0};
}

static void make_mailbox(maker_t *maker, cm1e_eni_device_t *device, const cm1e_description_t *described)
{
    cm1e_eni_mailbox_t *mailbox = &device->mailbox;
    const cm1e_mailbox_protocols_t *protocols = &described->mailbox;
    mailbox->poll_ms = CM1E_ENI_NOT_GIVEN;
    mailbox->status_bit = CM1E_ENI_NOT_GIVEN;
    mailbox->send = mailbox_area(described, CM1E_SM_MAILBOX_OUT);
    mailbox->receive = mailbox_area(described, CM1E_SM_MAILBOX_IN);
    mailbox->present = mailbox->send.length > 0 && mailbox->receive.length > 0;
    if (!mailbox->present)
        return;
    mailbox->poll_ms = MAILBOX_POLL_MS;
    mailbox->data_link_layer = protocols->data_link_layer;
    mailbox->aoe = protocols->aoe;
    mailbox->eoe = protocols->eoe;
    mailbox->coe = protocols->coe;
    mailbox->foe = protocols->foe;
    mailbox->soe = protocols->soe;
    mailbox->voe = protocols->voe;
    const cm1e_bytes_t boot = described->eeprom.bootstrap;
    if (protocols->foe && boot.size == CM1E_SII_BOOTSTRAP_BYTES) {
        mailbox->boot_send = (cm1e_eni_mailbox_area_t){cm1e_get_u16(boot.data), cm1e_get_u16(boot.data + 2)};
        mailbox->boot_receive = (cm1e_eni_mailbox_area_t){cm1e_get_u16(boot.data + 4), cm1e_get_u16(boot.data + 6)};
        mailbox->has_bootstrap = mailbox->boot_send.length > 0 && mailbox->boot_receive.length > 0;
    }
    if (protocols->coe)
        make_sdos(maker, mailbox, described);
}

static int64_t ns_of(double us) { return llround(us * 1000); }

static void make_clock(maker_t *maker, cm1e_eni_device_t *device, const cm1e_eni_slave_t *slave)
{
    const bool pulses = slave->pulses.sync0_us != 0;
    if (!slave->has_clock)
        return;
    device->dc = (cm1e_eni_dc_t){.present = true, .potential_reference = true, .reference = !maker->reference,
                                 .cycle0_ns = ns_of(slave->pulses.sync0_us),
                                 .cycle1_ns = ns_of(slave->pulses.sync1_us)};
    if (pulses)
        device->dc.shift_ns = slave->pulses.shift_us != 0 ? ns_of(slave->pulses.shift_us) : maker->cycle_time_ns / 2;
    if (!maker->reference) {
        maker->reference = true;
        maker->reference_position = device->position;
    }
}

static uint16_t assign_activate(const cm1e_eni_slave_t *slave)
{
    const uint16_t needed = slave->pulses.sync1_us != 0 ? BY_SYNC0_AND_SYNC1 : BY_SYNC0;
    return slave->assign_activate ? slave->assign_activate : needed;
}

static void make_device(maker_t *maker, cm1e_eni_device_t *device, const cm1e_eni_slave_t *slave, size_t place)
{
    const cm1e_description_t *described = slave->device;
    device->name = cm1e_arena_text(maker->arena, slave->name);
    device->station = (uint16_t)(FIRST_STATION + place);
    device->position = (uint16_t)-(int)place;
    device->position_given = true;
    device->physics = described->physics ? described->physics : "";
    device->vendor_id = described->vendor_id;
    device->product_code = described->product_code;
    device->revision = described->revision;
    device->serial_number = described->eeprom.serial_number;
    make_clock(maker, device, slave);
    make_sync_managers(maker, device, described);
    make_pdos(maker, device, described);
    make_mailbox(maker, device, described);
    if (place > 0) { /* in a line: on the second port of the one before */
        cm1e_eni_previous_port_t *previous = CM1E_APPEND(maker->arena, &device->previous);
        *previous = (cm1e_eni_previous_port_t){.selected = true, .port = 'B', .station = device->station - 1};
    }
}

/* ---- frames and images ------------------------------------------------------------------------------------------ */

static uint32_t frame_bytes(const cm1e_eni_frame_t *frame)
{
    uint32_t bytes = 0;
    for (size_t i = 0; i < frame->commands.count; i++)
        bytes += CM1E_ENI_DATAGRAM_OVERHEAD + frame->commands.at[i].length;
    return bytes;
}

static cm1e_eni_command_t *add_command(maker_t *maker, uint8_t code, uint8_t states, const char *comment)
{
    const uint32_t offset = (maker->frames - 1) * IMAGE_PER_FRAME + FRAME_HEADERS + frame_bytes(maker->frame);
    cm1e_eni_command_t *command = CM1E_APPEND(maker->arena, &maker->frame->commands);
    *command = cm1e_eni_command(code);
    command->states = states;
    command->comment = comment;
    command->input_offset = command->output_offset = offset;
    return command;
}

static void begin_frame(maker_t *maker)
{
    maker->frame = CM1E_APPEND(maker->arena, &maker->document->cyclics.at[0].frames);
    maker->frames++;
    maker->shared = NULL;
}

static uint32_t data_bytes(const cm1e_eni_frame_t *frame)
{
    return frame_bytes(frame) - (uint32_t)frame->commands.count * CM1E_ENI_DATAGRAM_OVERHEAD;
}

/* A command in which there is room for `bytes` more: the LRW at the end of the frame at hand, or a new one, maybe of a
 * new frame. */
static cm1e_eni_command_t *process_data_for(maker_t *maker, uint8_t code, uint32_t bytes)
{
    const bool shares = code == CM1E_ENI_LRW && maker->shared;
    const uint32_t wanted = bytes + (shares ? 0 : CM1E_ENI_DATAGRAM_OVERHEAD);
    if (!maker->frame || frame_bytes(maker->frame) + wanted > CM1E_ENI_FRAME_BYTES)
        begin_frame(maker);
    if (code == CM1E_ENI_LRW && maker->shared)
        return maker->shared;
    const uint32_t address = FIRST_LOGICAL + (maker->frames - 1) * LOGICAL_PER_FRAME + data_bytes(maker->frame);
    cm1e_eni_command_t *command =
        add_command(maker, code, CM1E_ENI_SAFEOP | CM1E_ENI_OPERATIONAL, "process data");
    command->address = address;
    command->count = 0;
    maker->shared = code == CM1E_ENI_LRW ? command : NULL;
    return command;
}

/* Puts data of a slave into a frame. Returns where they are in the images, in bits. */
static uint32_t take_room(maker_t *maker, uint8_t code, uint32_t bytes, int32_t count, uint32_t *logical)
{
    cm1e_eni_command_t *command = process_data_for(maker, code, bytes);
    const uint32_t bit = ((uint32_t)command->input_offset + CM1E_ENI_DATAGRAM_HEADER + command->length) * 8;
    *logical = command->address + command->length;
    command->length += bytes;
    command->count += count;
    return bit;
}

static bool is_taken(const cm1e_eni_image_t *image, const char *name)
{
    for (size_t i = 0; i < image->variables.count; i++)
        if (strcmp(image->variables.at[i].name, name) == 0)
            return true;
    return false;
}

/* <slave>.<PDO>.<entry>; a second one of that name gets a number. */
static const char *variable_name(maker_t *maker, const cm1e_eni_image_t *image, const char *device,
                                 const cm1e_described_pdo_t *pdo, const cm1e_described_pdo_entry_t *entry)
{
    char pdo_name[16], entry_name[16];
    snprintf(pdo_name, sizeof pdo_name, "0x%04X", pdo->index);
    snprintf(entry_name, sizeof entry_name, "0x%04X:%02X", entry->index, entry->subindex);
    const char *base = cm1e_arena_format(maker->arena, "%s.%s.%s", device,
                                         pdo->name && *pdo->name ? pdo->name : pdo_name,
                                         entry->name && *entry->name ? entry->name : entry_name);
    const char *name = base;
    for (unsigned n = 2; is_taken(image, name) && !maker->arena->failed; n++)
        name = cm1e_arena_format(maker->arena, "%s (%u)", base, n);
    return name;
}

static void add_variables(maker_t *maker, cm1e_eni_image_t *image, const cm1e_eni_device_t *device,
                          cm1e_sync_manager_use_t use, uint32_t bit)
{
    for (size_t m = 0; m < device->sync_managers.count; m++) {
        const cm1e_eni_sync_manager_t *manager = &device->sync_managers.at[m];
        uint32_t at = bit;
        if (manager->manager.use != use)
            continue;
        for (size_t p = 0; p < device->pdos.count; p++) {
            const cm1e_described_pdo_t *pdo = &device->pdos.at[p];
            for (size_t e = 0; pdo->sync_manager == manager->number && e < pdo->entries.count; e++) {
                const cm1e_described_pdo_entry_t *entry = &pdo->entries.at[e];
                if (entry->index != 0) {
                    const char *name = variable_name(maker, image, device->name, pdo, entry);
                    cm1e_eni_variable_t *variable = CM1E_APPEND(maker->arena, &image->variables);
                    *variable = (cm1e_eni_variable_t){.name = name, .bits = entry->bits, .offset = at,
                                                      .type = entry->type && *entry->type ? entry->type : NULL};
                }
                at += entry->bits;
            }
        }
        bit += manager->manager.length * 8u;
    }
}

/* Puts a slave's process data into a frame and into both images. LRW takes the outputs out of the frame before it puts
 * the inputs there (ETG.1000.4 5.4.3), so both have one place, as long as the longer of the two. A slave that cannot do
 * LRW has an LWR and an LRD of its own. */
static cm1e_eni_logical_t place_process_data(maker_t *maker, cm1e_eni_device_t *device, bool no_lrw)
{
    const uint32_t outputs = directed_bytes(device, CM1E_SM_OUTPUTS), inputs = directed_bytes(device, CM1E_SM_INPUTS);
    uint32_t outputs_bit = 0, inputs_bit = 0;
    cm1e_eni_logical_t logical = {FIRST_LOGICAL, FIRST_LOGICAL};
    if (no_lrw) {
        if (outputs)
            outputs_bit = take_room(maker, CM1E_ENI_LWR, outputs, 1, &logical.outputs);
        if (inputs)
            inputs_bit = take_room(maker, CM1E_ENI_LRD, inputs, 1, &logical.inputs);
    } else if (outputs || inputs) {
        outputs_bit = inputs_bit = take_room(maker, CM1E_ENI_LRW, outputs > inputs ? outputs : inputs,
                                             (outputs ? LRW_OUTPUTS : 0) + (inputs ? LRW_INPUTS : 0), &logical.outputs);
        logical.inputs = logical.outputs;
    }
    device->has_send = outputs > 0;
    device->has_receive = inputs > 0;
    if (outputs)
        device->send = (cm1e_eni_range_t){.start = outputs_bit, .length = outputs * 8};
    if (inputs)
        device->receive = (cm1e_eni_range_t){.start = inputs_bit, .length = inputs * 8};
    add_variables(maker, &maker->document->outputs, device, CM1E_SM_OUTPUTS, outputs_bit);
    add_variables(maker, &maker->document->inputs, device, CM1E_SM_INPUTS, inputs_bit);
    return logical;
}

/* The states of all slaves, or-ed together, at the end of every cycle: with this and the working counters a master
 * detects that a slave left Operational. */
static void add_state_check(maker_t *maker, size_t slaves)
{
    enum { STATE_BYTES = 2 };
    if (!maker->frame ||
        frame_bytes(maker->frame) + CM1E_ENI_DATAGRAM_OVERHEAD + STATE_BYTES > CM1E_ENI_FRAME_BYTES)
        begin_frame(maker);
    cm1e_eni_command_t *command = add_command(maker, CM1E_ENI_BRD,
                                              CM1E_ENI_PREOP | CM1E_ENI_SAFEOP | CM1E_ENI_OPERATIONAL, "AL status");
    command->ado = AL_STATUS;
    command->length = STATE_BYTES;
    command->count = (int32_t)slaves;
}

/* The time of the reference clock for all others, with every cycle from Pre-Operational on. It goes with the first
 * frame, behind the process data, so that their places are those of a network without clocks. How many answer is not
 * stated: not every controller has the register. */
static void add_drift_compensation(maker_t *maker)
{
    enum { TIME_BYTES = 8 };
    if (!maker->frame || frame_bytes(maker->frame) + CM1E_ENI_DATAGRAM_OVERHEAD + TIME_BYTES > CM1E_ENI_FRAME_BYTES)
        begin_frame(maker);
    cm1e_eni_command_t *command =
        add_command(maker, CM1E_ENI_ARMW, CM1E_ENI_PREOP | CM1E_ENI_SAFEOP | CM1E_ENI_OPERATIONAL,
                    "dc drift compensation");
    command->adp = maker->reference_position;
    command->ado = DC_SYSTEM_TIME;
    command->length = TIME_BYTES;
}

/* ---- the network ------------------------------------------------------------------------------------------------ */

static cm1e_error_t check_size(maker_t *maker, const cm1e_eni_slave_t *slave)
{
    uint32_t outputs = 0, inputs = 0;
    if (slave->device->sync_managers.count > SYNC_MANAGERS)
        return wrong(maker, slave, "a slave controller has 16 sync managers at most");
    for (unsigned n = 0; n < slave->device->sync_managers.count; n++) {
        const cm1e_sync_manager_use_t use = slave->device->sync_managers.at[n].use;
        outputs += use == CM1E_SM_OUTPUTS ? cm1e_description_process_bytes(slave->device, n) : 0;
        inputs += use == CM1E_SM_INPUTS ? cm1e_description_process_bytes(slave->device, n) : 0;
    }
    if (outputs > CM1E_ENI_DATAGRAM_BYTES || inputs > CM1E_ENI_DATAGRAM_BYTES)
        return wrong(maker, slave, "its process data do not fit into one frame (1486 bytes)");
    return CM1E_OK;
}

/* Without its mailbox in the file a slave that has one stays in Init, and its start-up commands would be lost. */
static cm1e_error_t check_mailbox(maker_t *maker, const cm1e_eni_slave_t *slave)
{
    const cm1e_mailbox_protocols_t *mailbox = &slave->device->mailbox;
    const bool needed = mailbox->aoe || mailbox->eoe || mailbox->coe || mailbox->foe || mailbox->soe || mailbox->voe;
    if (needed && (mailbox_area(slave->device, CM1E_SM_MAILBOX_OUT).length == 0 ||
                   mailbox_area(slave->device, CM1E_SM_MAILBOX_IN).length == 0))
        return wrong(maker, slave, "it has a mailbox, and its description does not state the size of it in both "
                                   "directions (DefaultSize of an ESI)");
    return CM1E_OK;
}

static cm1e_error_t check_slaves(maker_t *maker, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns)
{
    if (count == 0 || count > CM1E_MAX_SLAVES)
        return cm1e_diag_set(maker->diag, CM1E_ERROR_CONFIG, 0, "an ENI describes 1 to %d slaves, not %zu",
                             CM1E_MAX_SLAVES, count);
    if (cycle_time_ns <= 0 || cycle_time_ns % 1000 != 0)
        return cm1e_diag_set(maker->diag, CM1E_ERROR_CONFIG, 0, "an ENI states the cycle time in whole microseconds");
    for (size_t i = 0; i < count; i++) {
        if (!slaves[i].name || !*slaves[i].name)
            return wrong(maker, &slaves[i], "every slave needs a name");
        for (size_t j = 0; j < i; j++)
            if (strcmp(slaves[i].name, slaves[j].name) == 0)
                return wrong(maker, &slaves[i], "this name is there twice; the variables could not be told apart");
        cm1e_error_t error = check_size(maker, &slaves[i]);
        if (error == CM1E_OK)
            error = check_mailbox(maker, &slaves[i]);
        if (error != CM1E_OK)
            return error;
    }
    return CM1E_OK;
}

static void make_network(maker_t *maker, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns)
{
    static const uint8_t broadcast[6] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}, none[6] = {0};
    cm1e_eni_t *document = maker->document;
    document->master_name = "EtherCAT master";
    document->destination = (cm1e_bytes_t){broadcast, sizeof broadcast};
    document->source = (cm1e_bytes_t){cm1e_arena_bytes(maker->arena, none, sizeof none), sizeof none};
    document->ether_type = cm1e_bytes_of(maker->arena, 0x88A4, 2);
    bool clocks = false;
    for (size_t i = 0; i < count; i++)
        clocks |= slaves[i].has_clock;
    cm1e_eni_make_master_commands(maker->arena, &document->commands, clocks);
    cm1e_eni_cyclic_t *cyclic = CM1E_APPEND(maker->arena, &document->cyclics);
    cyclic->cycle_time_us = cycle_time_ns / 1000;
    cyclic->priority = 1;
    cyclic->task = "1";
    for (size_t i = 0; i < count; i++) {
        cm1e_eni_device_t *device = CM1E_APPEND(maker->arena, &document->devices);
        make_device(maker, device, &slaves[i], i);
        if (maker->arena->failed)
            return;
        const cm1e_eni_logical_t logical = place_process_data(maker, device, slaves[i].device->no_lrw);
        cm1e_eni_make_commands(maker->arena, device, logical, slaves[i].alias, assign_activate(&slaves[i]));
    }
    if (maker->arena->failed)
        return;
    if (clocks)
        add_drift_compensation(maker);
    add_state_check(maker, count);
    document->has_image = true;
    document->inputs.bytes = document->outputs.bytes = maker->frames * IMAGE_PER_FRAME;
}

cm1e_error_t cm1e_eni_make(cm1e_eni_t *document, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns,
                           cm1e_diag_t *diag)
{
    maker_t maker = {.document = document, .arena = &document->arena, .diag = diag,
                     .cycle_time_ns = cycle_time_ns};
    const cm1e_error_t error = check_slaves(&maker, slaves, count, cycle_time_ns);
    if (error != CM1E_OK)
        return error;
    make_network(&maker, slaves, count, cycle_time_ns);
    return document->arena.failed ? cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory") : CM1E_OK;
}
