#include "generate/esi_write.h"

#include <inttypes.h>
#include <search.h>
#include <string.h>

#include "generate/esi.h"
#include "generate/words.h"

/*
 * The order of elements and attributes is that of ETG.2000 (EtherCATInfo.xsd, EtherCATBase.xsd 1.14); "#x" numbers,
 * because the schema knows no "0x". What is not stated is not written.
 */
#define SCHEMA_VERSION "1.14"

void cm1e_esi_put_index(cm1e_xml_writer_t *xml, const char *element, uint16_t index, bool depends_on_slot)
{
    cm1e_xml_open(xml, element);
    if (depends_on_slot)
        cm1e_xml_put_attribute(xml, "DependOnSlot", "1");
    cm1e_xml_put_text(xml, "#x%04X", index);
    cm1e_xml_close(xml);
}

static void put_text(cm1e_xml_writer_t *xml, const char *element, const char *text)
{
    if (text)
        cm1e_xml_put(xml, element, "%s", text);
}

static void put_int(cm1e_xml_writer_t *xml, const char *element, int32_t number)
{
    cm1e_xml_put(xml, element, "%" PRId32, number);
}

static void put_stated(cm1e_xml_writer_t *xml, const char *element, int32_t number)
{
    if (number >= 0)
        put_int(xml, element, number);
}

static void put_flag(cm1e_xml_writer_t *xml, const char *attribute, bool flag)
{
    cm1e_xml_put_attribute(xml, attribute, "%d", flag);
}

static void put_flag_if(cm1e_xml_writer_t *xml, const char *attribute, bool flag)
{
    if (flag)
        put_flag(xml, attribute, true);
}

/* ---- process data ----------------------------------------------------------------------------------------------- */

static void put_pdo_entry(cm1e_xml_writer_t *xml, const cm1e_described_pdo_entry_t *entry)
{
    cm1e_xml_open(xml, "Entry");
    cm1e_esi_put_index(xml, "Index", entry->index, entry->depends_on_slot);
    if (entry->index != 0 || entry->subindex != 0)
        cm1e_xml_put(xml, "SubIndex", "%u", entry->subindex);
    cm1e_xml_put(xml, "BitLen", "%" PRIu32, entry->bits);
    put_text(xml, "Name", entry->name);
    put_text(xml, "Comment", entry->comment);
    if (entry->type && entry->type[0] != '\0')
        put_text(xml, "DataType", entry->type);
    cm1e_xml_close(xml);
}

static void put_pdo(cm1e_xml_writer_t *xml, const cm1e_described_pdo_t *pdo)
{
    cm1e_xml_open(xml, pdo->transmit ? "TxPdo" : "RxPdo");
    put_flag_if(xml, "Fixed", pdo->fixed);
    put_flag_if(xml, "Mandatory", pdo->mandatory);
    put_flag_if(xml, "Virtual", pdo->is_virtual);
    if (pdo->sync_manager != CM1E_NO_SYNC_MANAGER)
        cm1e_xml_put_attribute(xml, "Sm", "%d", pdo->sync_manager);
    cm1e_esi_put_index(xml, "Index", pdo->index, pdo->depends_on_slot);
    cm1e_xml_put(xml, "Name", "%s", pdo->name ? pdo->name : "");
    for (size_t i = 0; i < pdo->excludes.count; i++)
        cm1e_esi_put_index(xml, "Exclude", pdo->excludes.at[i].index, pdo->excludes.at[i].depends_on_slot);
    for (size_t i = 0; i < pdo->entries.count; i++)
        put_pdo_entry(xml, &pdo->entries.at[i]);
    cm1e_xml_close(xml);
}

/* RxPDOs before TxPDOs. */
static void put_pdos(cm1e_xml_writer_t *xml, const cm1e_pdo_list_t *pdos)
{
    for (int transmit = 0; transmit < 2; transmit++)
        for (size_t i = 0; i < pdos->count; i++)
            if (pdos->at[i].transmit == (transmit == 1))
                put_pdo(xml, &pdos->at[i]);
}

static void put_fmmu(cm1e_xml_writer_t *xml, const cm1e_described_fmmu_t *fmmu)
{
    const char *use = cm1e_word_text(cm1e_words_of_fmmus, (int)fmmu->use);
    put_text(xml, "Fmmu", use ? use : "");
}

static void put_sync_manager(cm1e_xml_writer_t *xml, const cm1e_described_sync_manager_t *manager)
{
    const char *use = cm1e_word_text(cm1e_words_of_sync_managers, (int)manager->use);
    cm1e_xml_open(xml, "Sm");
    if (manager->minimum_length > 0)
        cm1e_xml_put_attribute(xml, "MinSize", "%u", manager->minimum_length);
    if (manager->maximum_length > 0)
        cm1e_xml_put_attribute(xml, "MaxSize", "%u", manager->maximum_length);
    if (manager->length_given)
        cm1e_xml_put_attribute(xml, "DefaultSize", "%u", manager->length);
    cm1e_xml_put_attribute(xml, "StartAddress", "#x%04X", manager->start);
    cm1e_xml_put_attribute(xml, "ControlByte", "#x%02X", manager->control);
    cm1e_xml_put_attribute(xml, "Enable", "%u", manager->enable);
    cm1e_xml_put_text(xml, "%s", use ? use : "");
    cm1e_xml_close(xml);
}

/* ---- mailbox ---------------------------------------------------------------------------------------------------- */

static void put_init_command(cm1e_xml_writer_t *xml, const cm1e_init_command_t *command)
{
    cm1e_xml_open(xml, "InitCmd");
    put_flag_if(xml, "Fixed", command->fixed);
    put_flag_if(xml, "CompleteAccess", command->complete_access);
    for (const cm1e_word_t *transition = cm1e_words_of_transitions; transition->text; transition++)
        if (command->transitions & transition->value)
            put_text(xml, "Transition", transition->text);
    cm1e_esi_put_index(xml, "Index", command->index, command->depends_on_slot);
    cm1e_xml_put(xml, "SubIndex", "%u", command->subindex);
    cm1e_xml_open(xml, "Data");
    put_flag_if(xml, "AdaptAutomatically", command->adapts);
    cm1e_xml_put_hex_text(xml, command->data);
    cm1e_xml_close(xml);
    put_text(xml, "Comment", command->comment);
    cm1e_xml_close(xml);
}

static void put_init_commands(cm1e_xml_writer_t *xml, const cm1e_init_command_list_t *commands)
{
    for (size_t i = 0; i < commands->count; i++)
        put_init_command(xml, &commands->at[i]);
}

static void put_empty_if(cm1e_xml_writer_t *xml, const char *element, bool present)
{
    if (!present)
        return;
    cm1e_xml_open(xml, element);
    cm1e_xml_close(xml);
}

static void put_mailbox(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    const cm1e_mailbox_protocols_t *mailbox = &device->mailbox;
    if (!mailbox->present)
        return;
    cm1e_xml_open(xml, "Mailbox");
    put_flag(xml, "DataLinkLayer", mailbox->data_link_layer);
    put_empty_if(xml, "AoE", mailbox->aoe);
    put_empty_if(xml, "EoE", mailbox->eoe);
    if (mailbox->coe) {
        cm1e_xml_open(xml, "CoE");
        put_flag(xml, "SdoInfo", mailbox->sdo_info);
        put_flag(xml, "PdoAssign", mailbox->pdo_assign);
        put_flag(xml, "PdoConfig", mailbox->pdo_config);
        put_flag_if(xml, "PdoUpload", mailbox->pdo_upload);
        put_flag(xml, "CompleteAccess", mailbox->complete_access);
        put_flag(xml, "SegmentedSdo", mailbox->segmented_sdo);
        put_init_commands(xml, &device->init_commands);
        cm1e_xml_close(xml);
    }
    put_empty_if(xml, "FoE", mailbox->foe);
    put_empty_if(xml, "SoE", mailbox->soe);
    put_empty_if(xml, "VoE", mailbox->voe);
    cm1e_xml_close(xml);
}

/* ---- clocks, slots, EEPROM -------------------------------------------------------------------------------------- */

static void put_cycle_time(cm1e_xml_writer_t *xml, const char *element, int32_t cycle_ns, int32_t factor)
{
    cm1e_xml_open(xml, element);
    if (factor != 0)
        cm1e_xml_put_attribute(xml, "Factor", "%" PRId32, factor);
    cm1e_xml_put_text(xml, "%" PRId32, cycle_ns);
    cm1e_xml_close(xml);
}

static void put_dc_mode(cm1e_xml_writer_t *xml, const cm1e_dc_mode_t *mode)
{
    cm1e_xml_open(xml, "OpMode");
    cm1e_xml_put(xml, "Name", "%s", mode->name ? mode->name : "");
    put_text(xml, "Desc", mode->text);
    cm1e_xml_put(xml, "AssignActivate", "#x%04X", mode->assign_activate);
    if (mode->sync0_given)
        put_cycle_time(xml, "CycleTimeSync0", mode->sync0_cycle_ns, mode->sync0_factor);
    if (mode->sync0_shift_ns != 0)
        put_int(xml, "ShiftTimeSync0", mode->sync0_shift_ns);
    if (mode->sync1_given)
        put_cycle_time(xml, "CycleTimeSync1", mode->sync1_cycle_ns, mode->sync1_factor);
    if (mode->sync1_shift_ns != 0)
        put_int(xml, "ShiftTimeSync1", mode->sync1_shift_ns);
    cm1e_xml_close(xml);
}

static void put_dc(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    if (device->dc_modes.count == 0)
        return;
    cm1e_xml_open(xml, "Dc");
    for (size_t i = 0; i < device->dc_modes.count; i++)
        put_dc_mode(xml, &device->dc_modes.at[i]);
    cm1e_xml_close(xml);
}

static void put_slot(cm1e_xml_writer_t *xml, const cm1e_slot_t *slot)
{
    cm1e_xml_open(xml, "Slot");
    cm1e_xml_put_attribute(xml, "MinInstances", "%" PRIu32, slot->minimum_instances);
    cm1e_xml_put_attribute(xml, "MaxInstances", "%" PRIu32, slot->maximum_instances);
    if (slot->name && slot->name[0] != '\0')
        put_text(xml, "Name", slot->name);
    for (size_t i = 0; i < slot->choices.count; i++) {
        cm1e_xml_open(xml, "ModuleIdent");
        put_flag_if(xml, "Default", slot->choices.at[i].is_default);
        cm1e_xml_put_text(xml, "#x%08" PRIX32, slot->choices.at[i].ident);
        cm1e_xml_close(xml);
    }
    cm1e_xml_close(xml);
}

static void put_slots(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    if (device->slots.count == 0)
        return;
    cm1e_xml_open(xml, "Slots");
    cm1e_xml_put_attribute(xml, "SlotPdoIncrement", "#x%02X", device->slot_pdo_increment);
    cm1e_xml_put_attribute(xml, "SlotIndexIncrement", "#x%04X", device->slot_index_increment);
    for (size_t i = 0; i < device->slots.count; i++)
        put_slot(xml, &device->slots.at[i]);
    cm1e_xml_close(xml);
}

/* The configuration words decide how the controller talks to the device behind it: with wrong ones it does not. So they
 * are written only where they are those of a real device. Without them there is no Eeprom at all, which the schema
 * allows (its ConfigData is not optional): a tool then has nothing that it could put into a device, and masters take
 * what they need of it, such as the bootstrap mailbox, from the device itself. */
static bool has_eeprom(const cm1e_description_t *device)
{
    return device->eeprom.config_known && device->eeprom.config_data.data;
}

static void put_warning_of_eeprom(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    if (!has_eeprom(device))
        cm1e_xml_put_comment(xml, "WARNING: no Eeprom in this description, because the configuration words of the "
                                  "device's EEPROM are not known. Do not write an EEPROM from this file: with wrong "
                                  "words a device cannot be reached any more.");
}

static void put_eeprom(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    const cm1e_described_eeprom_t *eeprom = &device->eeprom;
    if (!has_eeprom(device))
        return;
    cm1e_xml_open(xml, "Eeprom");
    cm1e_xml_put(xml, "ByteSize", "%" PRIu32, eeprom->byte_size);
    cm1e_xml_put_hex(xml, "ConfigData", eeprom->config_data);
    cm1e_xml_put_hex(xml, "BootStrap", eeprom->bootstrap);
    cm1e_xml_close(xml);
}

/* ---- devices and modules ---------------------------------------------------------------------------------------- */

/* All of a kind or none: the schema requires them together. */
static bool has_state_timeouts(const cm1e_described_timeouts_t *timeouts)
{
    return timeouts->preop >= 0 && timeouts->safeop_op >= 0 && timeouts->back_to_init >= 0 &&
           timeouts->back_to_safeop >= 0;
}

static bool has_mailbox_timeouts(const cm1e_described_timeouts_t *timeouts)
{
    return timeouts->mailbox_request >= 0 && timeouts->mailbox_response >= 0;
}

static void put_timeouts(cm1e_xml_writer_t *xml, const cm1e_described_timeouts_t *timeouts)
{
    if (has_state_timeouts(timeouts)) {
        cm1e_xml_open(xml, "StateMachine");
        cm1e_xml_open(xml, "Timeout");
        put_int(xml, "PreopTimeout", timeouts->preop);
        put_int(xml, "SafeopOpTimeout", timeouts->safeop_op);
        put_int(xml, "BackToInitTimeout", timeouts->back_to_init);
        put_int(xml, "BackToSafeopTimeout", timeouts->back_to_safeop);
        cm1e_xml_close(xml);
        cm1e_xml_close(xml);
    }
    if (has_mailbox_timeouts(timeouts)) {
        cm1e_xml_open(xml, "Mailbox");
        cm1e_xml_open(xml, "Timeout");
        put_int(xml, "RequestTimeout", timeouts->mailbox_request);
        put_int(xml, "ResponseTimeout", timeouts->mailbox_response);
        cm1e_xml_close(xml);
        cm1e_xml_close(xml);
    }
}

static bool has_info(const cm1e_description_t *device)
{
    return device->identification_reg134_given || device->dpram_bytes >= 0 || device->sync_managers_available >= 0 ||
           device->fmmus_available >= 0 || has_state_timeouts(&device->timeouts) ||
           has_mailbox_timeouts(&device->timeouts);
}

static void put_info(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    if (!has_info(device))
        return;
    cm1e_xml_open(xml, "Info");
    put_timeouts(xml, &device->timeouts);
    if (device->dpram_bytes >= 0 || device->sync_managers_available >= 0 || device->fmmus_available >= 0) {
        cm1e_xml_open(xml, "EtherCATController");
        put_stated(xml, "DpramSize", device->dpram_bytes);
        put_stated(xml, "SmCount", device->sync_managers_available);
        put_stated(xml, "FmmuCount", device->fmmus_available);
        cm1e_xml_close(xml);
    }
    if (device->identification_reg134_given)
        put_int(xml, "IdentificationReg134", device->identification_reg134);
    cm1e_xml_close(xml);
}

static void put_profile(cm1e_xml_writer_t *xml, cm1e_arena_t *scratch, const cm1e_description_t *device)
{
    if (device->channels.count == 0 && device->objects.count == 0)
        return;
    cm1e_xml_open(xml, "Profile");
    for (size_t i = 0; i < device->channels.count; i++) {
        cm1e_xml_open(xml, "ChannelInfo");
        put_int(xml, "ProfileNo", device->channels.at[i].profile_no);
        put_stated(xml, "AddInfo", device->channels.at[i].add_info);
        cm1e_xml_close(xml);
    }
    if (device->objects.count > 0)
        cm1e_esi_put_dictionary(xml, scratch, &device->objects);
    cm1e_xml_close(xml);
}

static void put_type(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    cm1e_xml_open(xml, "Type");
    if (device->product_given)
        cm1e_xml_put_attribute(xml, "ProductCode", "#x%08" PRIX32, device->product_code);
    if (device->revision_given)
        cm1e_xml_put_attribute(xml, "RevisionNo", "#x%08" PRIX32, device->revision);
    put_flag_if(xml, "UseLrdLwr", device->no_lrw);
    cm1e_xml_put_text(xml, "%s", device->type);
    cm1e_xml_close(xml);
}

static void put_device(cm1e_xml_writer_t *xml, cm1e_arena_t *scratch, const cm1e_description_t *device)
{
    cm1e_xml_open(xml, "Device");
    cm1e_xml_put_attribute(xml, "Physics", "%s", device->physics ? device->physics : "");
    put_warning_of_eeprom(xml, device);
    put_type(xml, device);
    put_text(xml, "Name", device->name);
    put_text(xml, "Comment", device->comment);
    put_text(xml, "URL", device->url);
    put_info(xml, device);
    put_text(xml, "GroupType", device->group);
    put_profile(xml, scratch, device);
    for (size_t i = 0; i < device->fmmus.count; i++)
        put_fmmu(xml, &device->fmmus.at[i]);
    for (size_t i = 0; i < device->sync_managers.count; i++)
        put_sync_manager(xml, &device->sync_managers.at[i]);
    put_pdos(xml, &device->pdos);
    put_mailbox(xml, device);
    put_dc(xml, device);
    put_slots(xml, device);
    put_eeprom(xml, device);
    cm1e_xml_close(xml);
}

static void put_module(cm1e_xml_writer_t *xml, cm1e_arena_t *scratch, const cm1e_module_t *module)
{
    cm1e_xml_open(xml, "Module");
    cm1e_xml_open(xml, "Type");
    cm1e_xml_put_attribute(xml, "ModuleIdent", "#x%08" PRIX32, module->ident);
    cm1e_xml_put_text(xml, "%s", module->type ? module->type : "");
    cm1e_xml_close(xml);
    cm1e_xml_put(xml, "Name", "%s", module->name ? module->name : "");
    put_pdos(xml, &module->pdos);
    if (module->init_commands.count > 0) {
        cm1e_xml_open(xml, "Mailbox");
        cm1e_xml_open(xml, "CoE");
        put_init_commands(xml, &module->init_commands);
        cm1e_xml_close(xml);
        cm1e_xml_close(xml);
    }
    if (module->profile_no >= 0 || module->profile_info >= 0 || module->objects.count > 0) {
        cm1e_xml_open(xml, "Profile");
        put_stated(xml, "ProfileNo", module->profile_no);
        put_stated(xml, "AddInfo", module->profile_info);
        if (module->objects.count > 0)
            cm1e_esi_put_dictionary(xml, scratch, &module->objects);
        cm1e_xml_close(xml);
    }
    cm1e_xml_close(xml);
}

/* ---- the file --------------------------------------------------------------------------------------------------- */

static int compare_texts(const void *a, const void *b)
{
    return strcmp(a, b);
}

static void keep(void *node)
{
    (void)node; /* is the description's */
}

static void put_group(cm1e_xml_writer_t *xml, const cm1e_description_t *device)
{
    cm1e_xml_open(xml, "Group");
    put_text(xml, "Type", device->group);
    put_text(xml, "Name", device->group_name ? device->group_name : device->group);
    cm1e_xml_close(xml);
}

/* Each group once, in the order of devices. */
static void put_groups(cm1e_xml_writer_t *xml, const cm1e_description_file_t *file)
{
    void *known = NULL; /* a tree of tsearch() */
    cm1e_xml_open(xml, "Groups");
    for (size_t i = 0; i < file->devices.count; i++) {
        const cm1e_description_t *device = &file->devices.at[i];
        if (device->group[0] == '\0' || tfind(device->group, &known, compare_texts))
            continue;
        xml->failed |= !tsearch(device->group, &known, compare_texts);
        put_group(xml, device);
    }
    cm1e_xml_close(xml);
    tdestroy(known, keep);
}

static void put_descriptions(cm1e_xml_writer_t *xml, cm1e_arena_t *scratch, const cm1e_description_file_t *file)
{
    cm1e_xml_open(xml, "Descriptions");
    put_groups(xml, file);
    cm1e_xml_open(xml, "Devices");
    for (size_t i = 0; i < file->devices.count; i++)
        put_device(xml, scratch, &file->devices.at[i]);
    cm1e_xml_close(xml);
    if (file->modules.count > 0) {
        cm1e_xml_open(xml, "Modules");
        for (size_t i = 0; i < file->modules.count; i++)
            put_module(xml, scratch, &file->modules.at[i]);
        cm1e_xml_close(xml);
    }
    cm1e_xml_close(xml);
}

static void put_vendor(cm1e_xml_writer_t *xml, uint32_t id, const char *name)
{
    cm1e_xml_open(xml, "Vendor");
    cm1e_xml_put(xml, "Id", "#x%08" PRIX32, id);
    if (name && name[0] != '\0')
        put_text(xml, "Name", name);
    else
        cm1e_xml_put(xml, "Name", "Vendor #x%08" PRIX32, id);
    cm1e_xml_close(xml);
}

/* Checks what the schema requires and a description may lack. */
static cm1e_error_t check(const cm1e_description_file_t *file, cm1e_diag_t *diag)
{
    for (size_t i = 0; i < file->devices.count; i++) {
        const cm1e_description_t *device = &file->devices.at[i];
        if (device->vendor_id != file->devices.at[0].vendor_id)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                 "an ESI is of one vendor: %s has vendor 0x%08" PRIX32 ", %s has 0x%08" PRIX32
                                 "; write them into a file each",
                                 file->devices.at[0].type, file->devices.at[0].vendor_id, device->type,
                                 device->vendor_id);
        for (size_t s = 0; s < device->slots.count; s++)
            if (device->slots.at[s].choices.count == 0)
                return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                     "slot %zu of %s can hold no module: an ESI needs at least one for every slot",
                                     s + 1, device->type);
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_esi_write(cm1e_file_t *out, const cm1e_description_file_t *file, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check(file, diag);
    if (error != CM1E_OK)
        return error;
    const cm1e_description_t *first = file->devices.count > 0 ? &file->devices.at[0] : NULL;
    cm1e_arena_t scratch = {0};
    cm1e_xml_writer_t xml;
    cm1e_xml_begin(&xml);
    if (file->comment)
        cm1e_xml_put_comment(&xml, file->comment);
    cm1e_xml_open(&xml, "EtherCATInfo");
    cm1e_xml_put_attribute(&xml, "xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance");
    cm1e_xml_put_attribute(&xml, "xsi:noNamespaceSchemaLocation", "EtherCATInfo.xsd");
    cm1e_xml_put_attribute(&xml, "Version", SCHEMA_VERSION);
    put_vendor(&xml, first ? first->vendor_id : file->vendor_id,
               first && first->vendor_name ? first->vendor_name : file->vendor_name);
    put_descriptions(&xml, &scratch, file);
    cm1e_xml_close(&xml);
    cm1e_arena_free(&scratch);
    return cm1e_xml_finish(&xml, out, diag);
}
