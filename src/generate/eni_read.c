#include <string.h>

#include "generate/eni.h"
#include "generate/eni_registers.h"
#include "generate/words.h"
#include "generate/xml_read.h"

typedef cm1e_xml_reader_t reader_t;

enum { U8 = 0xFF, U16 = 0xFFFF };
#define U32 ((int64_t)UINT32_MAX)
#define S32_LEAST ((int64_t)INT32_MIN)
#define S32_MOST ((int64_t)INT32_MAX)

/* Limits above those of any network or slave; the checks rely on them. */
enum { MAX_DEVICES = 65535, MAX_PDOS = 1024, MAX_ASSIGNED = 255, MAX_CYCLIC_COMMANDS = 4096 };

/* Whether one more may be there. */
static bool room(reader_t *r, const xmlNode *node, size_t count, size_t limit)
{
    if (count >= limit)
        cm1e_xml_fail(r, node, "more than %zu <%s>", limit, (const char *)node->name);
    return !r->failed;
}

/* The schema calls identities and addresses signed, so their top bit may be a sign: -1 is 65535. */
static uint32_t pattern32(reader_t *r, const xmlNode *parent, const char *name)
{
    return (uint32_t)cm1e_xml_child_number(r, parent, name, S32_LEAST, U32, 0);
}

static uint16_t pattern16(reader_t *r, const xmlNode *parent, const char *name)
{
    return (uint16_t)cm1e_xml_child_number(r, parent, name, INT16_MIN, U16, 0);
}

static const char *text_or_null(reader_t *r, const xmlNode *parent, const char *name)
{
    return cm1e_xml_child_text(r, parent, name, NULL);
}

/* Place of a name in a list; -1: not there, which is an error. */
static int known(reader_t *r, const xmlNode *node, const char *const *names, int count)
{
    const char *text = cm1e_xml_text(r, node);
    for (int i = 0; i < count; i++)
        if (names[i] && strcmp(names[i], text) == 0)
            return i;
    cm1e_xml_fail(r, node, "there is no %s \"%.20s\"", (const char *)node->name, text);
    return -1;
}

static uint16_t read_names(reader_t *r, const xmlNode *parent, const char *element, const char *const *names, int count)
{
    uint16_t mask = 0;
    for (const xmlNode *node = cm1e_xml_child(parent, element); node; node = cm1e_xml_next(node, element)) {
        const int bit = known(r, node, names, count);
        if (bit >= 0)
            mask |= (uint16_t)(1u << bit);
    }
    return mask;
}

static uint16_t read_transitions(reader_t *r, const xmlNode *node)
{
    return read_names(r, node, "Transition", cm1e_eni_transition_names, CM1E_ENI_TRANSITION_COUNT);
}

/* ---- datagrams -------------------------------------------------------------------------------------------------- */

static void read_address(reader_t *r, const xmlNode *node, cm1e_eni_command_t *command)
{
    const bool logical = cm1e_eni_is_logical(command->code);
    const char *needed = logical ? "Addr" : "Ado";
    if (command->code != CM1E_ENI_NOP)
        cm1e_xml_need(r, node, needed);
    command->address = logical ? pattern32(r, node, "Addr") : 0;
    command->adp = logical ? 0 : pattern16(r, node, "Adp");
    command->ado = logical ? 0 : (uint16_t)cm1e_xml_child_number(r, node, "Ado", 0, U16, 0);
}

static void read_data(reader_t *r, const xmlNode *node, cm1e_eni_command_t *command)
{
    const xmlNode *data = cm1e_xml_child(node, "Data");
    command->data = cm1e_xml_hex(r, data);
    command->length = command->data.size > 0
                          ? (uint32_t)command->data.size
                          : (uint32_t)cm1e_xml_child_number(r, node, "DataLength", 0, CM1E_ENI_DATAGRAM_BYTES, 0);
    if (command->data.size > CM1E_ENI_DATAGRAM_BYTES)
        cm1e_xml_fail(r, data, "%zu bytes do not fit into a datagram, %d do", command->data.size,
                      CM1E_ENI_DATAGRAM_BYTES);
}

static void read_validate(reader_t *r, const xmlNode *node, cm1e_eni_command_t *command)
{
    const xmlNode *validate = cm1e_xml_child(node, "Validate");
    command->validates = validate != NULL;
    command->timeout_ms = (int32_t)cm1e_xml_child_number(r, validate ? validate : node, "Timeout", 0, S32_MOST,
                                                         CM1E_ENI_NOT_GIVEN);
    command->expected = cm1e_xml_hex(r, cm1e_xml_child(validate, "Data"));
    command->mask = cm1e_xml_hex(r, cm1e_xml_child(validate, "DataMask"));
}

static void read_command(reader_t *r, const xmlNode *node, cm1e_eni_command_t *command)
{
    const xmlNode *code = cm1e_xml_need(r, node, "Cmd");
    *command = cm1e_eni_command((uint8_t)cm1e_xml_number(r, code, 0, CM1E_ENI_FRMW, 0));
    command->place = cm1e_xml_line(node);
    command->comment = text_or_null(r, node, "Comment");
    read_address(r, node, command);
    read_data(r, node, command);
    command->count = (int32_t)cm1e_xml_child_number(r, node, "Cnt", 0, U16, CM1E_ENI_NOT_GIVEN);
}

static void read_init_commands(reader_t *r, const xmlNode *parent, cm1e_eni_command_list_t *list)
{
    const xmlNode *node = cm1e_xml_child(cm1e_xml_child(parent, "InitCmds"), "InitCmd");
    for (; node && !r->failed; node = cm1e_xml_next(node, "InitCmd")) {
        cm1e_eni_command_t *command = CM1E_APPEND(r->arena, list);
        read_command(r, node, command);
        command->transitions = read_transitions(r, node);
        command->before_slave = cm1e_xml_child_flag(r, node, "BeforeSlave", false);
        command->requires = text_or_null(r, node, "Requires");
        command->retries = (int32_t)cm1e_xml_child_number(r, node, "Retries", 0, S32_MOST, CM1E_ENI_NOT_GIVEN);
        read_validate(r, node, command);
    }
}

/* ---- a slave ---------------------------------------------------------------------------------------------------- */

static void read_info(reader_t *r, const xmlNode *slave, cm1e_eni_device_t *device)
{
    const xmlNode *info = cm1e_xml_need(r, slave, "Info");
    device->place = cm1e_xml_line(info);
    device->name = cm1e_xml_child_text(r, info, "Name", "");
    device->station = (uint16_t)cm1e_xml_child_number(r, info, "PhysAddr", 0, U16, 0);
    device->position_given = cm1e_xml_child(info, "AutoIncAddr") != NULL;
    device->position = pattern16(r, info, "AutoIncAddr");
    device->physics = cm1e_xml_child_text(r, info, "Physics", "");
    device->vendor_id = pattern32(r, info, "VendorId");
    device->product_code = pattern32(r, info, "ProductCode");
    device->revision = pattern32(r, info, "RevisionNo");
    device->serial_number = pattern32(r, info, "SerialNo");
}

static bool read_range(reader_t *r, const xmlNode *node, cm1e_eni_range_t *range)
{
    range->place = cm1e_xml_line(node);
    range->start = (uint32_t)cm1e_xml_child_number(r, node, "BitStart", 0, U32, 0);
    range->length = (uint32_t)cm1e_xml_child_number(r, node, "BitLength", 0, U32, 0);
    return node != NULL;
}

static cm1e_sync_manager_use_t read_use(reader_t *r, const xmlNode *node)
{
    /* TwinCAT writes "Sm0" for a sync manager without data. */
    return (cm1e_sync_manager_use_t)cm1e_word_value(cm1e_words_of_sync_managers,
                                                    cm1e_xml_child_text(r, node, "Type", ""), CM1E_SM_UNUSED);
}

static void read_sync_manager(reader_t *r, const xmlNode *node, unsigned number, cm1e_eni_sync_manager_t *into)
{
    into->number = (uint8_t)number;
    into->manager.place = cm1e_xml_line(node);
    into->manager.use = read_use(r, node);
    into->manager.minimum_length = (uint16_t)cm1e_xml_child_number(r, node, "MinSize", 0, U16, 0);
    into->manager.maximum_length = (uint16_t)cm1e_xml_child_number(r, node, "MaxSize", 0, U16, 0);
    into->manager.length_given = cm1e_xml_child(node, "DefaultSize") != NULL;
    into->manager.length = (uint16_t)cm1e_xml_child_number(r, node, "DefaultSize", 0, U16, 0);
    into->manager.start = (uint16_t)cm1e_xml_child_number(r, node, "StartAddress", 0, U16, 0);
    into->manager.control = (uint8_t)cm1e_xml_child_number(r, node, "ControlByte", 0, U8, 0);
    into->manager.enable = cm1e_xml_child_flag(r, node, "Enable", false);
    const xmlNode *pdo = cm1e_xml_child(node, "Pdo");
    for (; pdo && room(r, pdo, into->pdos.count, MAX_ASSIGNED); pdo = cm1e_xml_next(pdo, "Pdo"))
        *(uint16_t *)CM1E_APPEND(r->arena, &into->pdos) = (uint16_t)cm1e_xml_number(r, pdo, 0, U16, 0);
}

static void read_entry(reader_t *r, const xmlNode *node, cm1e_described_pdo_entry_t *entry)
{
    entry->place = cm1e_xml_line(node);
    entry->index = (uint16_t)cm1e_xml_child_number(r, node, "Index", 0, U16, 0);
    entry->subindex = (uint8_t)cm1e_xml_child_number(r, node, "SubIndex", 0, U8, 0);
    entry->bits = (uint32_t)cm1e_xml_child_number(r, node, "BitLen", 0, U16, 0);
    entry->name = text_or_null(r, node, "Name");
    entry->type = cm1e_xml_child_text(r, node, "DataType", "");
}

static void read_pdos(reader_t *r, const xmlNode *parent, bool transmit, cm1e_pdo_list_t *list)
{
    const char *name = transmit ? "TxPdo" : "RxPdo";
    const xmlNode *node = cm1e_xml_child(parent, name);
    for (; node && room(r, node, list->count, MAX_PDOS); node = cm1e_xml_next(node, name)) {
        cm1e_described_pdo_t *pdo = CM1E_APPEND(r->arena, list);
        pdo->place = cm1e_xml_line(node);
        pdo->transmit = transmit;
        pdo->index = (uint16_t)cm1e_xml_child_number(r, node, "Index", 0, U16, 0);
        pdo->name = cm1e_xml_child_text(r, node, "Name", "");
        pdo->fixed = cm1e_xml_attribute_flag(r, node, "Fixed", false);
        pdo->mandatory = cm1e_xml_attribute_flag(r, node, "Mandatory", false);
        pdo->sync_manager = (int)cm1e_xml_attribute_number(r, node, "Sm", 0, SYNC_MANAGERS - 1, CM1E_NO_SYNC_MANAGER);
        for (const xmlNode *e = cm1e_xml_child(node, "Exclude"); e; e = cm1e_xml_next(e, "Exclude")) {
            cm1e_exclude_t *exclude = CM1E_APPEND(r->arena, &pdo->excludes);
            exclude->place = cm1e_xml_line(e);
            exclude->index = (uint16_t)cm1e_xml_number(r, e, 0, U16, 0);
        }
        for (const xmlNode *e = cm1e_xml_child(node, "Entry"); e; e = cm1e_xml_next(e, "Entry"))
            read_entry(r, e, CM1E_APPEND(r->arena, &pdo->entries));
    }
}

static void read_process_data(reader_t *r, const xmlNode *slave, cm1e_eni_device_t *device)
{
    const xmlNode *data = cm1e_xml_child(slave, "ProcessData");
    device->has_send = read_range(r, cm1e_xml_child(data, "Send"), &device->send);
    device->has_receive = read_range(r, cm1e_xml_child(data, "Recv"), &device->receive);
    for (unsigned n = 0; n < SYNC_MANAGERS; n++) {
        const xmlNode *node = cm1e_xml_child(data, cm1e_arena_format(r->arena, "Sm%u", n));
        if (node)
            read_sync_manager(r, node, n, CM1E_APPEND(r->arena, &device->sync_managers));
    }
    read_pdos(r, data, true, &device->pdos);
    read_pdos(r, data, false, &device->pdos);
}

static cm1e_eni_mailbox_area_t read_area(reader_t *r, const xmlNode *node)
{
    return (cm1e_eni_mailbox_area_t){(uint16_t)cm1e_xml_child_number(r, node, "Start", 0, U16, 0),
                                     (uint16_t)cm1e_xml_child_number(r, node, "Length", 0, U16, 0)};
}

static void read_sdos(reader_t *r, const xmlNode *mailbox, cm1e_eni_mailbox_t *into)
{
    const xmlNode *list = cm1e_xml_child(cm1e_xml_child(mailbox, "CoE"), "InitCmds");
    for (const xmlNode *node = cm1e_xml_child(list, "InitCmd"); node; node = cm1e_xml_next(node, "InitCmd")) {
        cm1e_eni_sdo_t *sdo = CM1E_APPEND(r->arena, &into->sdos);
        sdo->place = cm1e_xml_line(node);
        sdo->transitions = read_transitions(r, node);
        sdo->comment = text_or_null(r, node, "Comment");
        sdo->timeout_ms = (uint32_t)cm1e_xml_child_number(r, node, "Timeout", 0, U32, 0);
        sdo->specifier = (uint8_t)cm1e_xml_child_number(r, node, "Ccs", 0, U8, 1);
        sdo->index = (uint16_t)cm1e_xml_child_number(r, node, "Index", 0, U16, 0);
        sdo->subindex = (uint8_t)cm1e_xml_child_number(r, node, "SubIndex", 0, U8, 0);
        sdo->fixed = cm1e_xml_attribute_flag(r, node, "Fixed", false);
        sdo->complete_access = cm1e_xml_attribute_flag(r, node, "CompleteAccess", false);
        sdo->disabled = cm1e_xml_child_flag(r, node, "Disabled", false);
        sdo->data = cm1e_xml_hex(r, cm1e_xml_child(node, "Data"));
    }
}

static void read_mailbox(reader_t *r, const xmlNode *slave, cm1e_eni_mailbox_t *mailbox)
{
    static const char *const names[] = {"AoE", "EoE", "CoE", "SoE", "FoE", "VoE"};
    bool *const spoken[] = {&mailbox->aoe, &mailbox->eoe, &mailbox->coe, &mailbox->soe, &mailbox->foe, &mailbox->voe};
    const xmlNode *node = cm1e_xml_child(slave, "Mailbox"), *receive = cm1e_xml_child(node, "Recv");
    const xmlNode *boot = cm1e_xml_child(node, "BootStrap");
    mailbox->poll_ms = CM1E_ENI_NOT_GIVEN;
    mailbox->status_bit = CM1E_ENI_NOT_GIVEN;
    mailbox->present = node != NULL;
    if (!node)
        return;
    mailbox->place = cm1e_xml_line(node);
    mailbox->data_link_layer = cm1e_xml_attribute_flag(r, node, "DataLinkLayer", false);
    mailbox->send = read_area(r, cm1e_xml_child(node, "Send"));
    mailbox->receive = read_area(r, receive);
    mailbox->poll_ms = (int32_t)cm1e_xml_child_number(r, receive, "PollTime", 0, S32_MOST, CM1E_ENI_NOT_GIVEN);
    mailbox->status_bit = cm1e_xml_child_number(r, receive, "StatusBitAddr", S32_LEAST, U32, CM1E_ENI_NOT_GIVEN);
    mailbox->has_bootstrap = boot != NULL;
    mailbox->boot_send = read_area(r, cm1e_xml_child(boot, "Send"));
    mailbox->boot_receive = read_area(r, cm1e_xml_child(boot, "Recv"));
    for (const xmlNode *p = cm1e_xml_child(node, "Protocol"); p; p = cm1e_xml_next(p, "Protocol")) {
        const int protocol = known(r, p, names, sizeof names / sizeof names[0]);
        if (protocol >= 0)
            *spoken[protocol] = true;
    }
    read_sdos(r, node, mailbox);
}

static void read_previous(reader_t *r, const xmlNode *slave, cm1e_eni_device_t *device)
{
    const xmlNode *node = cm1e_xml_child(slave, "PreviousPort");
    for (; node; node = cm1e_xml_next(node, "PreviousPort")) {
        static const char *const ports[] = {"A", "B", "C", "D"};
        const xmlNode *port = cm1e_xml_need(r, node, "Port");
        const int number = port ? known(r, port, ports, 4) : 0;
        cm1e_eni_previous_port_t *previous = CM1E_APPEND(r->arena, &device->previous);
        previous->place = cm1e_xml_line(node);
        previous->port = (char)('A' + (number > 0 ? number : 0));
        previous->selected = cm1e_xml_attribute_flag(r, node, "Selected", false);
        previous->station = (int32_t)cm1e_xml_child_number(r, node, "PhysAddr", 0, U16, CM1E_ENI_NOT_GIVEN);
    }
}

static void read_dc(reader_t *r, const xmlNode *slave, cm1e_eni_dc_t *dc)
{
    const xmlNode *node = cm1e_xml_child(slave, "DC");
    dc->present = node != NULL;
    dc->place = cm1e_xml_line(node);
    dc->potential_reference = cm1e_xml_child_flag(r, node, "PotentialReferenceClock", false);
    dc->reference = cm1e_xml_child_flag(r, node, "ReferenceClock", false);
    dc->cycle0_ns = cm1e_xml_child_number(r, node, "CycleTime0", S32_LEAST, U32, 0);
    dc->cycle1_ns = cm1e_xml_child_number(r, node, "CycleTime1", S32_LEAST, U32, 0);
    dc->shift_ns = cm1e_xml_child_number(r, node, "ShiftTime", S32_LEAST, U32, 0);
}

static void read_slave(reader_t *r, const xmlNode *node, cm1e_eni_device_t *device)
{
    read_info(r, node, device);
    read_process_data(r, node, device);
    read_mailbox(r, node, &device->mailbox);
    read_init_commands(r, node, &device->commands);
    read_previous(r, node, device);
    read_dc(r, node, &device->dc);
}

/* ---- the network ------------------------------------------------------------------------------------------------ */

static void read_master(reader_t *r, const xmlNode *node, cm1e_eni_t *document)
{
    const xmlNode *info = cm1e_xml_child(node, "Info"), *states = cm1e_xml_child(node, "MailboxStates");
    document->master_name = text_or_null(r, info, "Name");
    document->destination = cm1e_xml_hex(r, cm1e_xml_child(info, "Destination"));
    document->source = cm1e_xml_hex(r, cm1e_xml_child(info, "Source"));
    document->ether_type = cm1e_xml_hex(r, cm1e_xml_child(info, "EtherType"));
    document->has_mailbox_states = states != NULL;
    document->mailbox_states_start = pattern32(r, states, "StartAddr");
    document->mailbox_states_count = (uint32_t)cm1e_xml_child_number(r, states, "Count", 0, U16, 0);
    read_init_commands(r, node, &document->commands);
}

static void read_frame(reader_t *r, const xmlNode *node, cm1e_eni_frame_t *frame, size_t *commands)
{
    frame->place = cm1e_xml_line(node);
    const xmlNode *c = cm1e_xml_child(node, "Cmd");
    for (; c && room(r, c, (*commands)++, MAX_CYCLIC_COMMANDS); c = cm1e_xml_next(c, "Cmd")) {
        cm1e_eni_command_t *command = CM1E_APPEND(r->arena, &frame->commands);
        read_command(r, c, command);
        command->states = (uint8_t)read_names(r, c, "State", cm1e_eni_state_names, CM1E_ENI_STATE_COUNT);
        command->input_offset = cm1e_xml_child_number(r, c, "InputOffs", 0, U32, CM1E_ENI_NOT_GIVEN);
        command->output_offset = cm1e_xml_child_number(r, c, "OutputOffs", 0, U32, CM1E_ENI_NOT_GIVEN);
    }
}

static void read_cyclic(reader_t *r, const xmlNode *node, cm1e_eni_cyclic_t *cyclic, size_t *commands)
{
    cyclic->place = cm1e_xml_line(node);
    cyclic->comment = text_or_null(r, node, "Comment");
    cyclic->cycle_time_us = cm1e_xml_child_number(r, node, "CycleTime", 0, U32, CM1E_ENI_NOT_GIVEN);
    cyclic->priority = (int32_t)cm1e_xml_child_number(r, node, "Priority", 0, S32_MOST, CM1E_ENI_NOT_GIVEN);
    cyclic->task = text_or_null(r, node, "TaskId");
    for (const xmlNode *f = cm1e_xml_child(node, "Frame"); f && !r->failed; f = cm1e_xml_next(f, "Frame"))
        read_frame(r, f, CM1E_APPEND(r->arena, &cyclic->frames), commands);
}

static void read_image(reader_t *r, const xmlNode *node, cm1e_eni_image_t *image)
{
    image->place = cm1e_xml_line(node);
    image->bytes = (uint32_t)cm1e_xml_child_number(r, node, "ByteSize", 0, U32, 0);
    for (const xmlNode *v = cm1e_xml_child(node, "Variable"); v; v = cm1e_xml_next(v, "Variable")) {
        cm1e_eni_variable_t *variable = CM1E_APPEND(r->arena, &image->variables);
        variable->place = cm1e_xml_line(v);
        variable->name = cm1e_xml_child_text(r, v, "Name", "");
        variable->comment = text_or_null(r, v, "Comment");
        variable->type = text_or_null(r, v, "DataType");
        variable->bits = (uint32_t)cm1e_xml_child_number(r, v, "BitSize", 0, U32, 0);
        variable->offset = (uint32_t)cm1e_xml_child_number(r, v, "BitOffs", 0, U32, 0);
    }
}

static void read_config(reader_t *r, const xmlNode *config, cm1e_eni_t *document)
{
    read_master(r, cm1e_xml_need(r, config, "Master"), document);
    size_t commands = 0;
    const xmlNode *n = cm1e_xml_child(config, "Slave");
    for (; n && room(r, n, document->devices.count, MAX_DEVICES); n = cm1e_xml_next(n, "Slave"))
        read_slave(r, n, CM1E_APPEND(r->arena, &document->devices));
    for (n = cm1e_xml_child(config, "Cyclic"); n && !r->failed; n = cm1e_xml_next(n, "Cyclic"))
        read_cyclic(r, n, CM1E_APPEND(r->arena, &document->cyclics), &commands);
    const xmlNode *image = cm1e_xml_child(config, "ProcessImage");
    document->has_image = image != NULL;
    read_image(r, cm1e_xml_child(image, "Inputs"), &document->inputs);
    read_image(r, cm1e_xml_child(image, "Outputs"), &document->outputs);
}

cm1e_error_t cm1e_eni_read(cm1e_eni_t *document, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    cm1e_diag_t own = {0};
    cm1e_xml_reader_t r = {.arena = &document->arena, .diag = diag ? diag : &own};
    xmlDoc *doc = cm1e_xml_parse(bytes, size, r.diag);
    if (!doc)
        return r.diag->error;
    const xmlNode *root = xmlDocGetRootElement(doc);
    if (!cm1e_xml_is(root, "EtherCATConfig"))
        cm1e_xml_fail(&r, root, "the root of an ENI is <EtherCATConfig>, not <%s>", (const char *)root->name);
    else
        read_config(&r, cm1e_xml_need(&r, root, "Config"), document);
    xmlFreeDoc(doc);
    if (document->arena.failed)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "the file is too large: out of memory");
    return r.failed ? CM1E_ERROR_FILE : CM1E_OK;
}
