#include "generate/esi_read.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/*
 * Reads what masters read, from any version of the schema (ETG.2000): elements that are not known are passed over, what
 * is not there is "not stated", what contradicts itself is for the checker. An error is only what cannot be understood.
 */

enum { REGISTER_ID = 0x0134 };

/* What the devices of a file share while it is read. */
typedef struct names {
    cm1e_esi_names_t groups;         /* Type -> number in group_names */
    CM1E_LIST(const char *) group_names;
    cm1e_esi_names_t module_classes; /* ModuleClass -> number of the module */
    const cm1e_description_file_t *file;
} names_t;

/* ---- by name ---------------------------------------------------------------------------------------------------- */

void cm1e_esi_names_add(cm1e_xml_reader_t *reader, cm1e_esi_names_t *names, const char *name, size_t number)
{
    *(cm1e_esi_name_t *)CM1E_APPEND(reader->arena, names) = (cm1e_esi_name_t){name, number};
}

static int by_name(const void *left, const void *right)
{
    const cm1e_esi_name_t *a = left, *b = right;
    const int order = strcmp(a->name, b->name);
    return order != 0 ? order : (a->number > b->number) - (a->number < b->number);
}

void cm1e_esi_names_sort(cm1e_esi_names_t *names)
{
    if (names->count > 0)
        qsort(names->at, names->count, sizeof names->at[0], by_name);
}

size_t cm1e_esi_names_find(const cm1e_esi_names_t *names, const char *name)
{
    size_t low = 0, high = names->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (strcmp(names->at[middle].name, name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < names->count && strcmp(names->at[low].name, name) == 0 ? low : names->count;
}

/* ---- elements that come up everywhere --------------------------------------------------------------------------- */

uint16_t cm1e_esi_index(cm1e_xml_reader_t *reader, const xmlNode *node, bool *depends_on_slot)
{
    if (depends_on_slot)
        *depends_on_slot = cm1e_xml_attribute_flag(reader, node, "DependOnSlot", false);
    return (uint16_t)cm1e_xml_number(reader, node, 0, UINT16_MAX, 0);
}

const char *cm1e_esi_text(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, const char *fallback)
{
    enum { ENGLISH = 1033 };
    const xmlNode *first = cm1e_xml_child(parent, name), *found = first;
    while (found && cm1e_xml_attribute_number(reader, found, "LcId", 0, INT32_MAX, ENGLISH) != ENGLISH)
        found = cm1e_xml_next(found, name);
    return first ? cm1e_xml_text(reader, found ? found : first) : fallback;
}

static int32_t stated(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name)
{
    return (int32_t)cm1e_xml_child_number(reader, parent, name, 0, INT32_MAX, -1);
}

/* ---- device ----------------------------------------------------------------------------------------------------- */

static void read_identity(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    const xmlNode *type = cm1e_xml_need(reader, node, "Type");
    const int64_t product = cm1e_xml_attribute_number(reader, type, "ProductCode", 0, UINT32_MAX, -1);
    const int64_t revision = cm1e_xml_attribute_number(reader, type, "RevisionNo", 0, UINT32_MAX, -1);
    device->identity_place = cm1e_xml_line(type);
    device->product_given = product >= 0;
    device->revision_given = revision >= 0;
    device->product_code = product >= 0 ? (uint32_t)product : 0;
    device->revision = revision >= 0 ? (uint32_t)revision : 0;
    device->no_lrw = cm1e_xml_attribute_flag(reader, type, "UseLrdLwr", false);
    if (type)
        device->type = cm1e_xml_text(reader, type);
    device->name = cm1e_esi_text(reader, node, "Name", "");
    device->comment = cm1e_esi_text(reader, node, "Comment", NULL);
    device->url = cm1e_esi_text(reader, node, "URL", NULL);
    device->physics = cm1e_xml_attribute(reader, node, "Physics");
}

static void read_group(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device,
                       const names_t *names)
{
    device->group = cm1e_xml_child_text(reader, node, "GroupType", "");
    const size_t found = cm1e_esi_names_find(&names->groups, device->group);
    if (found < names->groups.count)
        device->group_name = names->group_names.at[names->groups.at[found].number];
}

static void read_info(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    const xmlNode *info = cm1e_xml_child(node, "Info");
    const xmlNode *states = cm1e_xml_child(cm1e_xml_child(info, "StateMachine"), "Timeout");
    const xmlNode *mailbox = cm1e_xml_child(cm1e_xml_child(info, "Mailbox"), "Timeout");
    const xmlNode *controller = cm1e_xml_child(info, "EtherCATController");
    device->timeouts = (cm1e_described_timeouts_t){
        .preop = stated(reader, states, "PreopTimeout"),
        .safeop_op = stated(reader, states, "SafeopOpTimeout"),
        .back_to_init = stated(reader, states, "BackToInitTimeout"),
        .back_to_safeop = stated(reader, states, "BackToSafeopTimeout"),
        .mailbox_request = stated(reader, mailbox, "RequestTimeout"),
        .mailbox_response = stated(reader, mailbox, "ResponseTimeout"),
    };
    device->dpram_bytes = stated(reader, controller, "DpramSize");
    device->sync_managers_available = stated(reader, controller, "SmCount");
    device->fmmus_available = stated(reader, controller, "FmmuCount");
    /* Before IdentificationReg134 there was IdentificationAdo, the address of a register with the number. */
    const int64_t ado = cm1e_xml_child_number(reader, info, "IdentificationAdo", 0, UINT16_MAX, -1);
    device->identification_reg134_given = ado >= 0 || cm1e_xml_child(info, "IdentificationReg134");
    device->identification_reg134 =
        cm1e_xml_child_flag(reader, info, "IdentificationReg134", ado == REGISTER_ID);
}

static void read_channel(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    cm1e_channel_t *channel = CM1E_APPEND(reader->arena, &device->channels);
    channel->place = cm1e_xml_line(node);
    channel->profile_no = (int32_t)cm1e_xml_child_number(reader, node, "ProfileNo", 0, INT32_MAX, 0); /* 0: none */
    channel->add_info = stated(reader, node, "AddInfo");
}

/* A channel is an axis, say: those listed, or the one that the profile itself speaks of. */
static void read_profiles(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    for (const xmlNode *profile = cm1e_xml_child(node, "Profile"); profile;
         profile = cm1e_xml_next(profile, "Profile")) {
        const xmlNode *channel = cm1e_xml_child(profile, "ChannelInfo");
        if (!channel && cm1e_xml_child(profile, "ProfileNo"))
            read_channel(reader, profile, device);
        for (; channel; channel = cm1e_xml_next(channel, "ChannelInfo"))
            read_channel(reader, channel, device);
        cm1e_esi_read_dictionary(reader, cm1e_xml_child(profile, "Dictionary"), &device->types, &device->objects);
    }
}

/* ---- slots ------------------------------------------------------------------------------------------------------ */

static void read_choices(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_slot_t *slot)
{
    for (const xmlNode *ident = cm1e_xml_child(node, "ModuleIdent"); ident;
         ident = cm1e_xml_next(ident, "ModuleIdent")) {
        cm1e_slot_choice_t *choice = CM1E_APPEND(reader->arena, &slot->choices);
        choice->place = cm1e_xml_line(ident);
        choice->ident = (uint32_t)cm1e_xml_number(reader, ident, 0, UINT32_MAX, 0);
        choice->is_default = cm1e_xml_attribute_number(reader, ident, "Default", INT64_MIN, INT64_MAX, 0) != 0;
    }
}

/* A slot may also take every module of a class. */
static void read_classes(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_slot_t *slot, const names_t *names)
{
    for (const xmlNode *class = cm1e_xml_child(node, "ModuleClass"); class;
         class = cm1e_xml_next(class, "ModuleClass")) {
        const char *name = cm1e_xml_child_text(reader, class, "Class", "");
        for (size_t i = cm1e_esi_names_find(&names->module_classes, name);
             i < names->module_classes.count && strcmp(names->module_classes.at[i].name, name) == 0; i++) {
            cm1e_slot_choice_t *choice = CM1E_APPEND(reader->arena, &slot->choices);
            if (reader->arena->failed)
                return;
            choice->place = cm1e_xml_line(class);
            choice->ident = names->file->modules.at[names->module_classes.at[i].number].ident;
        }
    }
}

static void read_slots(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device,
                       const names_t *names)
{
    const xmlNode *slots = cm1e_xml_child(node, "Slots"), *first = cm1e_xml_child(slots, "Slot");
    /* Older files state the increments slot by slot. */
    device->slot_pdo_increment = (uint16_t)cm1e_xml_attribute_number(
        reader, slots, "SlotPdoIncrement", 0, UINT16_MAX,
        cm1e_xml_attribute_number(reader, first, "SlotPdoIncrement", 0, UINT16_MAX, 0));
    device->slot_index_increment = (uint16_t)cm1e_xml_attribute_number(
        reader, slots, "SlotIndexIncrement", 0, UINT16_MAX,
        cm1e_xml_attribute_number(reader, first, "SlotIndexIncrement", 0, UINT16_MAX, 0));
    for (const xmlNode *child = first; child; child = cm1e_xml_next(child, "Slot")) {
        cm1e_slot_t *slot = CM1E_APPEND(reader->arena, &device->slots);
        slot->place = cm1e_xml_line(child);
        slot->name = cm1e_esi_text(reader, child, "Name", "");
        slot->minimum_instances = (uint32_t)cm1e_xml_attribute_number(reader, child, "MinInstances", 0, UINT32_MAX, 0);
        slot->maximum_instances = (uint32_t)cm1e_xml_attribute_number(reader, child, "MaxInstances", 0, UINT32_MAX, 0);
        read_choices(reader, child, slot);
        read_classes(reader, child, slot, names);
    }
}

static void read_device(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_file_t *file,
                        const names_t *names)
{
    cm1e_description_t *device = CM1E_APPEND(reader->arena, &file->devices);
    cm1e_description_init(device);
    device->place = cm1e_xml_line(node);
    device->vendor_id = file->vendor_id;
    device->vendor_name = file->vendor_name;
    read_identity(reader, node, device);
    read_group(reader, node, device, names);
    read_info(reader, node, device);
    read_profiles(reader, node, device);
    cm1e_esi_read_communication(reader, node, device);
    cm1e_esi_read_pdos(reader, node, &device->pdos);
    read_slots(reader, node, device, names);
}

/* ---- modules ---------------------------------------------------------------------------------------------------- */

static void read_module(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_file_t *file,
                        names_t *names)
{
    const xmlNode *type = cm1e_xml_need(reader, node, "Type"), *profile = cm1e_xml_child(node, "Profile");
    const xmlNode *channel = cm1e_xml_child(profile, "ChannelInfo");
    cm1e_module_t *module = CM1E_APPEND(reader->arena, &file->modules);
    const int64_t ident = cm1e_xml_attribute_number(reader, type, "ModuleIdent", 0, UINT32_MAX, -1);
    if (type && ident < 0)
        cm1e_xml_fail(reader, type, "the Type of a module has no attribute ModuleIdent");
    module->place = cm1e_xml_line(node);
    module->ident = ident < 0 ? 0 : (uint32_t)ident;
    module->type = type ? cm1e_xml_text(reader, type) : "";
    module->name = cm1e_esi_text(reader, node, "Name", "");
    module->profile_no = stated(reader, cm1e_xml_child(profile, "ProfileNo") ? profile : channel, "ProfileNo");
    module->profile_info = stated(reader, cm1e_xml_child(profile, "ProfileNo") ? profile : channel, "AddInfo");
    cm1e_esi_read_pdos(reader, node, &module->pdos);
    cm1e_esi_read_init_commands(reader, cm1e_xml_child(cm1e_xml_child(node, "Mailbox"), "CoE"),
                                &module->init_commands);
    cm1e_esi_read_dictionary(reader, cm1e_xml_child(profile, "Dictionary"), &module->types, &module->objects);
    const char *class = cm1e_xml_attribute(reader, type, "ModuleClass");
    if (class)
        cm1e_esi_names_add(reader, &names->module_classes, class, file->modules.count - 1);
}

static void read_modules(cm1e_xml_reader_t *reader, const xmlNode *modules, cm1e_description_file_t *file,
                         names_t *names)
{
    for (const xmlNode *module = cm1e_xml_child(modules, "Module"); module && !reader->arena->failed;
         module = cm1e_xml_next(module, "Module"))
        read_module(reader, module, file, names);
    cm1e_esi_names_sort(&names->module_classes);
}

/* ---- file ------------------------------------------------------------------------------------------------------- */

static void read_groups(cm1e_xml_reader_t *reader, const xmlNode *groups, names_t *names)
{
    for (const xmlNode *group = cm1e_xml_child(groups, "Group"); group; group = cm1e_xml_next(group, "Group")) {
        const char *type = cm1e_xml_child_text(reader, group, "Type", "");
        cm1e_esi_names_add(reader, &names->groups, type, names->group_names.count);
        *(const char **)CM1E_APPEND(reader->arena, &names->group_names) = cm1e_esi_text(reader, group, "Name", NULL);
    }
    cm1e_esi_names_sort(&names->groups);
}

static void read_vendor(cm1e_xml_reader_t *reader, const xmlNode *root, cm1e_description_file_t *file)
{
    const xmlNode *vendor = cm1e_xml_need(reader, root, "Vendor");
    file->vendor_place = cm1e_xml_line(vendor);
    file->vendor_id = (uint32_t)cm1e_xml_number(reader, cm1e_xml_need(reader, vendor, "Id"), 0, UINT32_MAX, 0);
    file->vendor_name = cm1e_esi_text(reader, vendor, "Name", NULL);
}

/* A file of modules alone (root EtherCATModule, to which an ESI refers) has them without Descriptions. */
static void read_root(cm1e_xml_reader_t *reader, const xmlNode *root, cm1e_description_file_t *file)
{
    const bool of_modules = cm1e_xml_is(root, "EtherCATModule");
    if (!of_modules && !cm1e_xml_is(root, "EtherCATInfo")) {
        cm1e_xml_fail(reader, root, "the root element of an ESI is EtherCATInfo, here it is %.60s",
                      (const char *)root->name);
        return;
    }
    names_t names = {.file = file};
    const xmlNode *descriptions = of_modules ? root : cm1e_xml_need(reader, root, "Descriptions");
    file->comment = cm1e_xml_comment(reader, root);
    read_vendor(reader, root, file);
    read_groups(reader, cm1e_xml_child(descriptions, "Groups"), &names);
    read_modules(reader, cm1e_xml_child(descriptions, "Modules"), file, &names);
    const xmlNode *devices = cm1e_xml_child(descriptions, "Devices");
    for (const xmlNode *device = cm1e_xml_child(devices, "Device"); device && !reader->arena->failed;
         device = cm1e_xml_next(device, "Device"))
        read_device(reader, device, file, &names);
    if (!reader->failed && file->devices.count == 0 && file->modules.count == 0)
        cm1e_xml_fail(reader, root, "there is neither a device nor a module in the file");
}

cm1e_error_t cm1e_esi_read(cm1e_description_file_t *file, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    cm1e_diag_t own = {0};
    cm1e_xml_reader_t reader = {.arena = &file->arena, .diag = diag ? diag : &own};
    xmlDoc *doc = cm1e_xml_parse(bytes, size, reader.diag);
    if (!doc)
        return reader.diag->error;
    read_root(&reader, xmlDocGetRootElement(doc), file);
    xmlFreeDoc(doc);
    if (file->arena.failed)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0,
                             "out of memory, or the file needs more memory than any real one");
    return reader.failed ? CM1E_ERROR_FILE : CM1E_OK;
}
