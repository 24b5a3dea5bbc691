#include <string.h>

#include "core/bytes.h"
#include "description/sii_image.h"
#include "generate/esi_read.h"
#include "generate/words.h"

/* ---- process data ----------------------------------------------------------------------------------------------- */

static void read_pdo_entry(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_described_pdo_t *pdo)
{
    cm1e_described_pdo_entry_t *entry = CM1E_APPEND(reader->arena, &pdo->entries);
    entry->place = cm1e_xml_line(node);
    entry->index = cm1e_esi_index(reader, cm1e_xml_need(reader, node, "Index"), &entry->depends_on_slot);
    entry->subindex = (uint8_t)cm1e_xml_child_number(reader, node, "SubIndex", 0, UINT8_MAX, 0);
    entry->bits = (uint32_t)cm1e_xml_number(reader, cm1e_xml_need(reader, node, "BitLen"), 0, INT32_MAX, 0);
    entry->name = cm1e_esi_text(reader, node, "Name", NULL);
    entry->type = cm1e_xml_child_text(reader, node, "DataType", "");
    entry->comment = cm1e_xml_child_text(reader, node, "Comment", NULL);
}

static void read_pdo(cm1e_xml_reader_t *reader, const xmlNode *node, bool transmit, cm1e_pdo_list_t *pdos)
{
    cm1e_described_pdo_t *pdo = CM1E_APPEND(reader->arena, pdos);
    pdo->place = cm1e_xml_line(node);
    pdo->transmit = transmit;
    pdo->index = cm1e_esi_index(reader, cm1e_xml_need(reader, node, "Index"), &pdo->depends_on_slot);
    pdo->name = cm1e_esi_text(reader, node, "Name", "");
    pdo->sync_manager = (int)cm1e_xml_attribute_number(reader, node, "Sm", -1, UINT8_MAX, CM1E_NO_SYNC_MANAGER);
    pdo->fixed = cm1e_xml_attribute_flag(reader, node, "Fixed", false);
    pdo->mandatory = cm1e_xml_attribute_flag(reader, node, "Mandatory", false);
    pdo->is_virtual = cm1e_xml_attribute_flag(reader, node, "Virtual", false);
    for (const xmlNode *child = cm1e_xml_child(node, "Exclude"); child; child = cm1e_xml_next(child, "Exclude")) {
        cm1e_exclude_t *exclude = CM1E_APPEND(reader->arena, &pdo->excludes);
        exclude->place = cm1e_xml_line(child);
        exclude->index = cm1e_esi_index(reader, child, &exclude->depends_on_slot);
    }
    for (const xmlNode *child = cm1e_xml_child(node, "Entry"); child; child = cm1e_xml_next(child, "Entry"))
        read_pdo_entry(reader, child, pdo);
}

void cm1e_esi_read_pdos(cm1e_xml_reader_t *reader, const xmlNode *parent, cm1e_pdo_list_t *pdos)
{
    for (int transmit = 0; transmit < 2; transmit++) {
        const char *name = transmit ? "TxPdo" : "RxPdo";
        for (const xmlNode *pdo = cm1e_xml_child(parent, name); pdo; pdo = cm1e_xml_next(pdo, name))
            if (cm1e_xml_child(pdo, "Index") || !cm1e_xml_attribute(reader, pdo, "Ref")) /* oldest files: elsewhere */
                read_pdo(reader, pdo, transmit == 1, pdos);
    }
}

static void read_fmmus(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    for (const xmlNode *child = cm1e_xml_child(node, "Fmmu"); child; child = cm1e_xml_next(child, "Fmmu")) {
        cm1e_described_fmmu_t *fmmu = CM1E_APPEND(reader->arena, &device->fmmus);
        fmmu->place = cm1e_xml_line(child);
        fmmu->use = (cm1e_fmmu_use_t)cm1e_word_value(cm1e_words_of_fmmus, cm1e_xml_text(reader, child),
                                                     CM1E_FMMU_UNUSED);
    }
}

static void read_sync_managers(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    for (const xmlNode *child = cm1e_xml_child(node, "Sm"); child; child = cm1e_xml_next(child, "Sm")) {
        cm1e_described_sync_manager_t *manager = CM1E_APPEND(reader->arena, &device->sync_managers);
        const int64_t length = cm1e_xml_attribute_number(reader, child, "DefaultSize", 0, UINT16_MAX, -1);
        manager->place = cm1e_xml_line(child);
        manager->use = (cm1e_sync_manager_use_t)cm1e_word_value(cm1e_words_of_sync_managers,
                                                                cm1e_xml_text(reader, child), CM1E_SM_UNUSED);
        manager->start = (uint16_t)cm1e_xml_attribute_number(reader, child, "StartAddress", 0, UINT16_MAX, 0);
        manager->length_given = length >= 0;
        manager->length = length >= 0 ? (uint16_t)length : 0;
        manager->minimum_length = (uint16_t)cm1e_xml_attribute_number(reader, child, "MinSize", 0, UINT16_MAX, 0);
        manager->maximum_length = (uint16_t)cm1e_xml_attribute_number(reader, child, "MaxSize", 0, UINT16_MAX, 0);
        manager->control_missing = !cm1e_xml_attribute(reader, child, "ControlByte");
        manager->control = (uint8_t)cm1e_xml_attribute_number(reader, child, "ControlByte", 0, UINT8_MAX, 0);
        manager->enable = (uint8_t)cm1e_xml_attribute_number(reader, child, "Enable", 0, UINT8_MAX, 0);
    }
}

/* ---- mailbox ---------------------------------------------------------------------------------------------------- */

void cm1e_esi_read_init_commands(cm1e_xml_reader_t *reader, const xmlNode *coe, cm1e_init_command_list_t *commands)
{
    for (const xmlNode *node = cm1e_xml_child(coe, "InitCmd"); node; node = cm1e_xml_next(node, "InitCmd")) {
        cm1e_init_command_t *command = CM1E_APPEND(reader->arena, commands);
        const xmlNode *data = cm1e_xml_child(node, "Data");
        command->place = cm1e_xml_line(node);
        for (const xmlNode *child = cm1e_xml_child(node, "Transition"); child;
             child = cm1e_xml_next(child, "Transition"))
            command->transitions |=
                (uint8_t)cm1e_word_value(cm1e_words_of_transitions, cm1e_xml_text(reader, child), 0);
        command->index = cm1e_esi_index(reader, cm1e_xml_need(reader, node, "Index"), &command->depends_on_slot);
        command->subindex = (uint8_t)cm1e_xml_child_number(reader, node, "SubIndex", 0, UINT8_MAX, 0);
        command->fixed = cm1e_xml_attribute_flag(reader, node, "Fixed", false);
        command->complete_access = cm1e_xml_attribute_flag(reader, node, "CompleteAccess", false);
        command->adapts = cm1e_xml_attribute_flag(reader, data, "AdaptAutomatically", false);
        command->data = cm1e_xml_hex(reader, data);
        command->comment = cm1e_xml_child_text(reader, node, "Comment", NULL);
    }
}

static void read_mailbox(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    const xmlNode *mailbox = cm1e_xml_child(node, "Mailbox"), *coe = cm1e_xml_child(mailbox, "CoE");
    if (!mailbox)
        return;
    device->mailbox = (cm1e_mailbox_protocols_t){
        .place = cm1e_xml_line(mailbox),
        .present = true,
        .coe = coe != NULL,
        .foe = cm1e_xml_child(mailbox, "FoE") != NULL,
        .eoe = cm1e_xml_child(mailbox, "EoE") != NULL,
        .soe = cm1e_xml_child(mailbox, "SoE") != NULL,
        .voe = cm1e_xml_child(mailbox, "VoE") != NULL,
        .aoe = cm1e_xml_child(mailbox, "AoE") != NULL,
        .sdo_info = cm1e_xml_attribute_flag(reader, coe, "SdoInfo", false),
        .pdo_assign = cm1e_xml_attribute_flag(reader, coe, "PdoAssign", false),
        .pdo_config = cm1e_xml_attribute_flag(reader, coe, "PdoConfig", false),
        .pdo_upload = cm1e_xml_attribute_flag(reader, coe, "PdoUpload", false),
        .complete_access = cm1e_xml_attribute_flag(reader, coe, "CompleteAccess", false),
        .segmented_sdo = cm1e_xml_attribute_flag(reader, coe, "SegmentedSdo", false),
        .data_link_layer = cm1e_xml_attribute_flag(reader, mailbox, "DataLinkLayer", false),
    };
    cm1e_esi_read_init_commands(reader, coe, &device->init_commands);
}

/* ---- clocks and EEPROM ------------------------------------------------------------------------------------------ */

static int32_t time_of(cm1e_xml_reader_t *reader, const xmlNode *mode, const char *name)
{
    return (int32_t)cm1e_xml_child_number(reader, mode, name, INT32_MIN, INT32_MAX, 0);
}

static int32_t factor_of(cm1e_xml_reader_t *reader, const xmlNode *time)
{
    return (int32_t)cm1e_xml_attribute_number(reader, time, "Factor", INT32_MIN, INT32_MAX, 0);
}

static void read_dc_modes(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    const xmlNode *dc = cm1e_xml_child(node, "Dc");
    for (const xmlNode *child = cm1e_xml_child(dc, "OpMode"); child; child = cm1e_xml_next(child, "OpMode")) {
        const xmlNode *sync0 = cm1e_xml_child(child, "CycleTimeSync0");
        const xmlNode *sync1 = cm1e_xml_child(child, "CycleTimeSync1");
        cm1e_dc_mode_t *mode = CM1E_APPEND(reader->arena, &device->dc_modes);
        mode->place = cm1e_xml_line(child);
        mode->name = cm1e_xml_child_text(reader, child, "Name", "");
        mode->text = cm1e_xml_child_text(reader, child, "Desc", NULL);
        mode->assign_activate = (uint16_t)cm1e_xml_child_number(reader, child, "AssignActivate", 0, UINT16_MAX, 0);
        mode->sync0_given = sync0 != NULL;
        mode->sync0_cycle_ns = time_of(reader, child, "CycleTimeSync0");
        mode->sync0_factor = factor_of(reader, sync0);
        mode->sync0_shift_ns = time_of(reader, child, "ShiftTimeSync0");
        mode->sync1_given = sync1 != NULL;
        mode->sync1_cycle_ns = time_of(reader, child, "CycleTimeSync1");
        mode->sync1_factor = factor_of(reader, sync1);
        mode->sync1_shift_ns = time_of(reader, child, "ShiftTimeSync1");
    }
}

/* Part of the image of an EEPROM, if the image is long enough. */
static cm1e_bytes_t part_of(cm1e_bytes_t image, size_t at, size_t size)
{
    return image.size >= at + size ? (cm1e_bytes_t){image.data + at, size} : (cm1e_bytes_t){0};
}

/* Either the necessary words, or the image. */
static void read_eeprom(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    const xmlNode *child = cm1e_xml_child(node, "Eeprom");
    cm1e_described_eeprom_t *eeprom = &device->eeprom;
    if (!child)
        return;
    eeprom->place = cm1e_xml_line(child);
    const cm1e_bytes_t image = cm1e_xml_hex(reader, cm1e_xml_child(child, "Data"));
    if (image.data) {
        const cm1e_bytes_t kilobits = part_of(image, CM1E_SII_KBIT, 2);
        eeprom->byte_size =
            kilobits.data ? ((uint32_t)cm1e_get_u16(kilobits.data) + 1) * CM1E_SII_BYTES_PER_KBIT : 0;
        eeprom->config_data = part_of(image, CM1E_SII_CONFIG, CM1E_SII_CONFIG_BYTES);
        eeprom->bootstrap = part_of(image, CM1E_SII_BOOTSTRAP, CM1E_SII_BOOTSTRAP_BYTES);
    } else {
        eeprom->byte_size = (uint32_t)cm1e_xml_child_number(reader, child, "ByteSize", 0, INT32_MAX, 0);
        eeprom->config_data = cm1e_xml_hex(reader, cm1e_xml_child(child, "ConfigData"));
        eeprom->bootstrap = cm1e_xml_hex(reader, cm1e_xml_child(child, "BootStrap"));
    }
    eeprom->config_known = eeprom->config_data.data != NULL;
}

void cm1e_esi_read_communication(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_description_t *device)
{
    read_fmmus(reader, node, device);
    read_sync_managers(reader, node, device);
    read_mailbox(reader, node, device);
    read_dc_modes(reader, node, device);
    read_eeprom(reader, node, device);
}
