/* Elements in the order of the schema (EtherCATConfig.xsd). Numbers are decimal but for the indexes of PDOs, flags 1
 * and 0: see eni.h for who cannot read what. */
#include <stdio.h>

#include "generate/eni.h"
#include "generate/words.h"
#include "generate/xml_write.h"

typedef cm1e_xml_writer_t writer_t;

static void put_number(writer_t *w, const char *name, int64_t value)
{
    cm1e_xml_put(w, name, "%lld", (long long)value);
}

static void put_given(writer_t *w, const char *name, int64_t value)
{
    if (value != CM1E_ENI_NOT_GIVEN)
        put_number(w, name, value);
}

static void put_flag(writer_t *w, const char *name, bool value)
{
    put_number(w, name, value);
}

static void put_text(writer_t *w, const char *name, const char *text)
{
    if (text)
        cm1e_xml_put(w, name, "%s", text);
}

static void put_set_attribute(writer_t *w, const char *name, bool value)
{
    if (value)
        cm1e_xml_put_attribute(w, name, "1");
}

static void put_transitions(writer_t *w, uint16_t transitions)
{
    for (int bit = 0; bit < CM1E_ENI_TRANSITION_COUNT; bit++)
        if (transitions & 1u << bit)
            cm1e_xml_put(w, "Transition", "%s", cm1e_eni_transition_names[bit]);
}

/* ---- datagrams -------------------------------------------------------------------------------------------------- */

static void put_address(writer_t *w, const cm1e_eni_command_t *command)
{
    if (cm1e_eni_is_logical(command->code)) {
        put_number(w, "Addr", command->address);
        return;
    }
    put_number(w, "Adp", command->adp);
    put_number(w, "Ado", command->ado);
}

static void put_data(writer_t *w, const cm1e_eni_command_t *command)
{
    if (command->data.size > 0)
        cm1e_xml_put_hex(w, "Data", command->data);
    else
        put_number(w, "DataLength", command->length);
}

static void put_init_command(writer_t *w, const cm1e_eni_command_t *command)
{
    cm1e_xml_open(w, "InitCmd");
    put_transitions(w, command->transitions);
    if (command->before_slave)
        put_flag(w, "BeforeSlave", true);
    put_text(w, "Comment", command->comment);
    put_text(w, "Requires", command->requires);
    put_number(w, "Cmd", command->code);
    put_address(w, command);
    put_data(w, command);
    put_given(w, "Cnt", command->count);
    put_given(w, "Retries", command->retries);
    if (command->validates) {
        cm1e_xml_open(w, "Validate");
        cm1e_xml_put_hex(w, "Data", command->expected);
        cm1e_xml_put_hex(w, "DataMask", command->mask);
        put_number(w, "Timeout", command->timeout_ms == CM1E_ENI_NOT_GIVEN ? 0 : command->timeout_ms);
        cm1e_xml_close(w);
    } else {
        put_given(w, "Timeout", command->timeout_ms);
    }
    cm1e_xml_close(w);
}

static void put_init_commands(writer_t *w, const cm1e_eni_command_list_t *list)
{
    if (list->count == 0)
        return;
    cm1e_xml_open(w, "InitCmds");
    for (size_t i = 0; i < list->count; i++)
        put_init_command(w, &list->at[i]);
    cm1e_xml_close(w);
}

static void put_cyclic_command(writer_t *w, const cm1e_eni_command_t *command)
{
    cm1e_xml_open(w, "Cmd");
    for (int bit = 0; bit < CM1E_ENI_STATE_COUNT; bit++)
        if (command->states & 1u << bit)
            cm1e_xml_put(w, "State", "%s", cm1e_eni_state_names[bit]);
    put_text(w, "Comment", command->comment);
    put_number(w, "Cmd", command->code);
    put_address(w, command);
    put_data(w, command);
    put_given(w, "Cnt", command->count);
    put_given(w, "InputOffs", command->input_offset);
    put_given(w, "OutputOffs", command->output_offset);
    cm1e_xml_close(w);
}

/* ---- a slave ---------------------------------------------------------------------------------------------------- */

static void put_info(writer_t *w, const cm1e_eni_device_t *device)
{
    cm1e_xml_open(w, "Info");
    put_text(w, "Name", device->name);
    put_number(w, "PhysAddr", device->station);
    if (device->position_given)
        put_number(w, "AutoIncAddr", device->position);
    put_text(w, "Physics", *device->physics ? device->physics : NULL);
    put_number(w, "VendorId", device->vendor_id);
    put_number(w, "ProductCode", device->product_code);
    put_number(w, "RevisionNo", device->revision);
    put_number(w, "SerialNo", device->serial_number);
    cm1e_xml_close(w);
}

static void put_range(writer_t *w, const char *name, const cm1e_eni_range_t *range)
{
    cm1e_xml_open(w, name);
    put_number(w, "BitStart", range->start);
    put_number(w, "BitLength", range->length);
    cm1e_xml_close(w);
}

static void put_sync_manager(writer_t *w, const cm1e_eni_sync_manager_t *manager)
{
    const char *use = cm1e_word_text(cm1e_words_of_sync_managers, (int)manager->manager.use);
    char name[8];
    snprintf(name, sizeof name, "Sm%u", manager->number);
    cm1e_xml_open(w, name);
    cm1e_xml_put(w, "Type", "%s", use ? use : name);
    if (manager->manager.minimum_length > 0)
        put_number(w, "MinSize", manager->manager.minimum_length);
    if (manager->manager.maximum_length > 0)
        put_number(w, "MaxSize", manager->manager.maximum_length);
    if (manager->manager.length_given)
        put_number(w, "DefaultSize", manager->manager.length);
    put_number(w, "StartAddress", manager->manager.start);
    put_number(w, "ControlByte", manager->manager.control);
    put_flag(w, "Enable", manager->manager.enable != 0);
    for (size_t i = 0; i < manager->pdos.count; i++)
        put_number(w, "Pdo", manager->pdos.at[i]);
    cm1e_xml_close(w);
}

static void put_entry(writer_t *w, const cm1e_described_pdo_entry_t *entry)
{
    cm1e_xml_open(w, "Entry");
    cm1e_xml_put(w, "Index", "#x%04x", entry->index);
    if (entry->index != 0)
        put_number(w, "SubIndex", entry->subindex);
    put_number(w, "BitLen", entry->bits);
    if (entry->index != 0) {
        put_text(w, "Name", entry->name);
        put_text(w, "DataType", entry->type && *entry->type ? entry->type : NULL);
    }
    cm1e_xml_close(w);
}

static void put_pdo(writer_t *w, const cm1e_described_pdo_t *pdo)
{
    cm1e_xml_open(w, pdo->transmit ? "TxPdo" : "RxPdo");
    put_set_attribute(w, "Fixed", pdo->fixed);
    put_set_attribute(w, "Mandatory", pdo->mandatory);
    if (pdo->sync_manager != CM1E_NO_SYNC_MANAGER)
        cm1e_xml_put_attribute(w, "Sm", "%d", pdo->sync_manager);
    cm1e_xml_put(w, "Index", "#x%04x", pdo->index);
    put_text(w, "Name", pdo->name);
    for (size_t i = 0; i < pdo->excludes.count; i++)
        cm1e_xml_put(w, "Exclude", "#x%04x", pdo->excludes.at[i].index);
    for (size_t i = 0; i < pdo->entries.count; i++)
        put_entry(w, &pdo->entries.at[i]);
    cm1e_xml_close(w);
}

static void put_process_data(writer_t *w, const cm1e_eni_device_t *device)
{
    if (!device->has_send && !device->has_receive && device->sync_managers.count == 0 && device->pdos.count == 0)
        return;
    cm1e_xml_open(w, "ProcessData");
    if (device->has_send)
        put_range(w, "Send", &device->send);
    if (device->has_receive)
        put_range(w, "Recv", &device->receive);
    for (size_t i = 0; i < device->sync_managers.count; i++)
        put_sync_manager(w, &device->sync_managers.at[i]);
    for (size_t i = 0; i < device->pdos.count; i++)
        put_pdo(w, &device->pdos.at[i]);
    cm1e_xml_close(w);
}

static void put_area(writer_t *w, const char *name, const cm1e_eni_mailbox_area_t *area, int64_t poll_ms,
                     int64_t status_bit)
{
    cm1e_xml_open(w, name);
    put_number(w, "Start", area->start);
    put_number(w, "Length", area->length);
    put_given(w, "PollTime", poll_ms);
    put_given(w, "StatusBitAddr", status_bit);
    cm1e_xml_close(w);
}

static void put_sdo(writer_t *w, const cm1e_eni_sdo_t *sdo)
{
    cm1e_xml_open(w, "InitCmd");
    put_set_attribute(w, "Fixed", sdo->fixed);
    put_set_attribute(w, "CompleteAccess", sdo->complete_access);
    put_transitions(w, sdo->transitions);
    put_text(w, "Comment", sdo->comment);
    put_number(w, "Timeout", sdo->timeout_ms);
    put_number(w, "Ccs", sdo->specifier);
    put_number(w, "Index", sdo->index);
    put_number(w, "SubIndex", sdo->subindex);
    cm1e_xml_put_hex(w, "Data", sdo->data);
    if (sdo->disabled)
        put_flag(w, "Disabled", true);
    cm1e_xml_close(w);
}

static void put_mailbox(writer_t *w, const cm1e_eni_mailbox_t *mailbox)
{
    const struct {
        bool spoken;
        const char *name;
    } protocols[] = {{mailbox->aoe, "AoE"}, {mailbox->eoe, "EoE"}, {mailbox->coe, "CoE"},
                     {mailbox->soe, "SoE"}, {mailbox->foe, "FoE"}, {mailbox->voe, "VoE"}};
    if (!mailbox->present)
        return;
    cm1e_xml_open(w, "Mailbox");
    put_set_attribute(w, "DataLinkLayer", mailbox->data_link_layer);
    put_area(w, "Send", &mailbox->send, CM1E_ENI_NOT_GIVEN, CM1E_ENI_NOT_GIVEN);
    put_area(w, "Recv", &mailbox->receive, mailbox->poll_ms, mailbox->status_bit);
    if (mailbox->has_bootstrap) {
        cm1e_xml_open(w, "BootStrap");
        put_area(w, "Send", &mailbox->boot_send, CM1E_ENI_NOT_GIVEN, CM1E_ENI_NOT_GIVEN);
        put_area(w, "Recv", &mailbox->boot_receive, CM1E_ENI_NOT_GIVEN, CM1E_ENI_NOT_GIVEN);
        cm1e_xml_close(w);
    }
    for (size_t i = 0; i < sizeof protocols / sizeof protocols[0]; i++)
        if (protocols[i].spoken)
            cm1e_xml_put(w, "Protocol", "%s", protocols[i].name);
    if (mailbox->sdos.count > 0) {
        cm1e_xml_open(w, "CoE");
        cm1e_xml_open(w, "InitCmds");
        for (size_t i = 0; i < mailbox->sdos.count; i++)
            put_sdo(w, &mailbox->sdos.at[i]);
        cm1e_xml_close(w);
        cm1e_xml_close(w);
    }
    cm1e_xml_close(w);
}

static void put_slave(writer_t *w, const cm1e_eni_device_t *device)
{
    cm1e_xml_open(w, "Slave");
    put_info(w, device);
    put_process_data(w, device);
    put_mailbox(w, &device->mailbox);
    put_init_commands(w, &device->commands);
    for (size_t i = 0; i < device->previous.count; i++) {
        const cm1e_eni_previous_port_t *previous = &device->previous.at[i];
        cm1e_xml_open(w, "PreviousPort");
        put_set_attribute(w, "Selected", previous->selected);
        cm1e_xml_put(w, "Port", "%c", previous->port);
        put_given(w, "PhysAddr", previous->station);
        cm1e_xml_close(w);
    }
    if (device->dc.present) {
        cm1e_xml_open(w, "DC");
        put_flag(w, "PotentialReferenceClock", device->dc.potential_reference);
        put_flag(w, "ReferenceClock", device->dc.reference);
        put_number(w, "CycleTime0", device->dc.cycle0_ns);
        put_number(w, "CycleTime1", device->dc.cycle1_ns);
        put_number(w, "ShiftTime", device->dc.shift_ns);
        cm1e_xml_close(w);
    }
    cm1e_xml_close(w);
}

/* ---- the network ------------------------------------------------------------------------------------------------ */

static void put_master(writer_t *w, const cm1e_eni_t *document)
{
    cm1e_xml_open(w, "Master");
    cm1e_xml_open(w, "Info");
    put_text(w, "Name", document->master_name);
    cm1e_xml_put_hex(w, "Destination", document->destination);
    cm1e_xml_put_hex(w, "Source", document->source);
    cm1e_xml_put_hex(w, "EtherType", document->ether_type);
    cm1e_xml_close(w);
    if (document->has_mailbox_states) {
        cm1e_xml_open(w, "MailboxStates");
        put_number(w, "StartAddr", document->mailbox_states_start);
        put_number(w, "Count", document->mailbox_states_count);
        cm1e_xml_close(w);
    }
    put_init_commands(w, &document->commands);
    cm1e_xml_close(w);
}

static void put_cyclic(writer_t *w, const cm1e_eni_cyclic_t *cyclic)
{
    cm1e_xml_open(w, "Cyclic");
    put_text(w, "Comment", cyclic->comment);
    put_given(w, "CycleTime", cyclic->cycle_time_us);
    put_given(w, "Priority", cyclic->priority);
    put_text(w, "TaskId", cyclic->task);
    for (size_t i = 0; i < cyclic->frames.count; i++) {
        cm1e_xml_open(w, "Frame");
        for (size_t c = 0; c < cyclic->frames.at[i].commands.count; c++)
            put_cyclic_command(w, &cyclic->frames.at[i].commands.at[c]);
        cm1e_xml_close(w);
    }
    cm1e_xml_close(w);
}

static void put_image(writer_t *w, const char *name, const cm1e_eni_image_t *image)
{
    cm1e_xml_open(w, name);
    put_number(w, "ByteSize", image->bytes);
    for (size_t i = 0; i < image->variables.count; i++) {
        const cm1e_eni_variable_t *variable = &image->variables.at[i];
        cm1e_xml_open(w, "Variable");
        put_text(w, "Name", variable->name);
        put_text(w, "Comment", variable->comment);
        put_text(w, "DataType", variable->type);
        put_number(w, "BitSize", variable->bits);
        put_number(w, "BitOffs", variable->offset);
        cm1e_xml_close(w);
    }
    cm1e_xml_close(w);
}

cm1e_error_t cm1e_eni_write(cm1e_file_t *out, const cm1e_eni_t *document, cm1e_diag_t *diag)
{
    writer_t w;
    cm1e_xml_begin(&w);
    cm1e_xml_open(&w, "EtherCATConfig");
    cm1e_xml_put_attribute(&w, "xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
    cm1e_xml_put_attribute(&w, "xsi:noNamespaceSchemaLocation", "EtherCATConfig.xsd");
    cm1e_xml_put_attribute(&w, "Version", "1.3");
    cm1e_xml_open(&w, "Config");
    put_master(&w, document);
    for (size_t i = 0; i < document->devices.count; i++)
        put_slave(&w, &document->devices.at[i]);
    for (size_t i = 0; i < document->cyclics.count; i++)
        put_cyclic(&w, &document->cyclics.at[i]);
    if (document->has_image) {
        cm1e_xml_open(&w, "ProcessImage");
        put_image(&w, "Inputs", &document->inputs);
        put_image(&w, "Outputs", &document->outputs);
        cm1e_xml_close(&w);
    }
    cm1e_xml_close(&w);
    cm1e_xml_close(&w);
    return cm1e_xml_finish(&w, out, diag);
}
