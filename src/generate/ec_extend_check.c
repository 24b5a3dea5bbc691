#include <stdio.h>
#include <string.h>

#include "description/describe.h"
#include "generate/ec_extend.h"
#include "generate/xml_read.h"

enum { WRITTEN_BY_MASTER = 0x04, DIRECTION_MASK = 0x0C, MODE_MASK = 0x03, MODE_MAILBOX = 0x02, SYNC_MANAGERS = 16,
       TRANSITION_PREOP_SAFEOP = 2 };

/* Text for a finding that cannot grow with the file. */
#define SHORT "%.80s"

/* ---- indexes, names, references --------------------------------------------------------------------------------- */

/* Finds an Index, and a name if there are names, that exists twice in a list. */
#define CHECK_UNIQUE(findings, list, what, name_of)                                                                 \
    do {                                                                                                            \
        for (size_t i = 1; i < (list).count; i++)                                                                   \
            for (size_t j = 0; j < i; j++) {                                                                        \
                if ((list).at[i].index == (list).at[j].index)                                                       \
                    cm1e_findings_add(findings, CM1E_RULE_TRIO_INDEX, (list).at[i].place,                           \
                                      "%s %u is there twice; each needs an Index of its own", what,                   \
                                      (unsigned)(list).at[i].index);                                                \
                if (strcmp(name_of(i), name_of(j)) == 0 && *name_of(i))                                             \
                    cm1e_findings_add(findings, CM1E_RULE_TRIO_NAME, (list).at[i].place,                            \
                                      "%s \"" SHORT "\" is there twice; a reference by name finds one of them", what, \
                                      name_of(i));                                                                  \
            }                                                                                                       \
    } while (0)
#define RX_NAME(n) document->rx_pdos.at[n].name
#define TX_NAME(n) document->tx_pdos.at[n].name
#define COMMANDS_NAME(n) document->commands.at[n].name
#define NO_NAME(n) ""

static void check_unique(cm1e_findings_t *findings, const cm1e_ec_extend_t *document)
{
    CHECK_UNIQUE(findings, document->rx_pdos, "RxPdo", RX_NAME);
    CHECK_UNIQUE(findings, document->tx_pdos, "TxPdo", TX_NAME);
    CHECK_UNIQUE(findings, document->commands, "SdoInitCmd", COMMANDS_NAME);
    CHECK_UNIQUE(findings, document->controllers, "EscCfg", NO_NAME);
    CHECK_UNIQUE(findings, document->slaves, "SlvCfg", NO_NAME);
    CHECK_UNIQUE(findings, document->profiles, "Profile", NO_NAME);
}

static void check_reference(cm1e_findings_t *findings, const cm1e_ec_reference_t *reference, const char *element,
                            const void *target)
{
    if (reference->text && !target)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_REFERENCE, reference->place,
                          "%s is \"" SHORT "\", which is not in this file", element, reference->text);
}

/* ---- process data ----------------------------------------------------------------------------------------------- */

static void check_entries(cm1e_findings_t *findings, const cm1e_ec_pdo_t *pdo, bool transmit)
{
    for (size_t i = 0; i < pdo->entries.count; i++) {
        const cm1e_ec_entry_t *entry = &pdo->entries.at[i];
        const cm1e_ec_name_t *name = cm1e_ec_name(entry->name);
        const bool end = strcmp(entry->name, CM1E_EC_END_ENTRY) == 0;
        if (end && (entry->length != 0 || i + 1 < pdo->entries.count))
            cm1e_findings_add(findings, CM1E_RULE_TRIO_PDO_ENTRY, entry->place,
                              CM1E_EC_END_ENTRY " ends a list: it must be the last entry, with length 0");
        if (!end && entry->length == 0)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_PDO_ENTRY, entry->place,
                              SHORT " has length 0; only " CM1E_EC_END_ENTRY ", which ends a list, has", entry->name);
        if (name && name->transmit != transmit)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_PDO_ENTRY, entry->place,
                              "%s is what the %s sends; this list is of the other direction", entry->name,
                              name->transmit ? "device" : "controller");
        if (!name && !end)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_UNKNOWN, entry->place,
                              "\"" SHORT "\" is no name of process data that is known here", entry->name);
    }
}

static bool has_entry(const cm1e_ec_pdo_t *pdo, const char *name)
{
    for (size_t i = 0; pdo && i < pdo->entries.count; i++)
        if (strcmp(pdo->entries.at[i].name, name) == 0)
            return true;
    return false;
}

/* ---- sync managers ---------------------------------------------------------------------------------------------- */

static void check_sync_manager(cm1e_findings_t *findings, const cm1e_ec_sync_manager_t *manager)
{
    bool bootstrap;
    const cm1e_sync_manager_use_t use = cm1e_ec_use(manager->function, &bootstrap);
    const bool out = cm1e_sync_manager_is_written(use);
    if (use == CM1E_SM_UNUSED) {
        cm1e_findings_add(findings, CM1E_RULE_TRIO_UNKNOWN, manager->place,
                          "\"" SHORT "\" is no function of a sync manager that is known here: MBOXOUT, MBOXIN, "
                          "OUTPUTS, INPUTS, BOOTMBOXOUT, BOOTMBOXIN are", manager->function);
        return;
    }
    if ((manager->control & DIRECTION_MASK) != (out ? WRITTEN_BY_MASTER : 0))
        cm1e_findings_add(findings, CM1E_RULE_TRIO_SYNC_MANAGER, manager->place,
                          "%s with control byte 0x%02X: its bits 2 and 3 say that the %s writes", manager->function,
                          manager->control, out ? "device" : "controller");
    /* Trio's file has mailboxes of Bootstrap in buffered mode; whoever does that will know why. */
    if (cm1e_sync_manager_is_mailbox(use) && !bootstrap && (manager->control & MODE_MASK) != MODE_MAILBOX)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_SYNC_MANAGER, manager->place,
                          "%s with control byte 0x%02X: bits 0 and 1 of a mailbox are 2", manager->function,
                          manager->control);
    if (cm1e_sync_manager_is_mailbox(use) && manager->size <= 0)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_SYNC_MANAGER, manager->place, "%s needs a Size", manager->function);
}

static void check_controller(cm1e_findings_t *findings, const cm1e_ec_controller_t *controller)
{
    uint32_t seen[2] = {0};
    for (size_t i = 0; i < controller->sync_managers.count; i++) {
        const cm1e_ec_sync_manager_t *manager = &controller->sync_managers.at[i];
        bool bootstrap;
        cm1e_ec_use(manager->function, &bootstrap);
        if (seen[bootstrap] >> manager->index & 1)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_SYNC_MANAGER, manager->place,
                              "sync manager %u is there twice", (unsigned)manager->index);
        seen[bootstrap] |= 1u << manager->index;
        check_sync_manager(findings, manager);
    }
}

/* Those of Bootstrap, or those of the other states, with the lengths that they have for this slave. */
static void check_memory(cm1e_findings_t *findings, const cm1e_ec_controller_t *controller, const uint32_t lengths[2],
                         bool of_bootstrap)
{
    cm1e_described_sync_manager_t managers[SYNC_MANAGERS] = {0};
    for (size_t i = 0; i < controller->sync_managers.count; i++) {
        const cm1e_ec_sync_manager_t *from = &controller->sync_managers.at[i];
        bool bootstrap;
        const cm1e_sync_manager_use_t use = cm1e_ec_use(from->function, &bootstrap);
        if (bootstrap != of_bootstrap)
            continue;
        const uint32_t bytes = use == CM1E_SM_OUTPUTS ? lengths[0] : use == CM1E_SM_INPUTS ? lengths[1] : 0;
        managers[from->index] = (cm1e_described_sync_manager_t){
            .place = from->place, .use = use, .start = from->start, .control = from->control, .enable = from->enable,
            .length = from->size >= 0 ? (uint16_t)from->size : bytes <= UINT16_MAX ? (uint16_t)bytes : UINT16_MAX};
        if (bytes > 0 && from->size >= 0 && (uint32_t)from->size != bytes)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_PDO_SIZE, from->place,
                              "sync manager %u has %d bytes, the process data of a slave that uses it %u",
                              (unsigned)from->index, (int)from->size, (unsigned)bytes);
    }
    cm1e_check_overlap(findings, managers, SYNC_MANAGERS);
}

/* ---- start-up commands ------------------------------------------------------------------------------------------ */

static bool holds(uint32_t bytes, int64_t value)
{
    if (bytes >= sizeof value)
        return true;
    return value < (int64_t)1 << (8 * bytes) && value >= -((int64_t)1 << (8 * bytes - 1));
}

static bool is_assignment(const cm1e_ec_command_t *command)
{
    return command->index == OBJ_1C12_RXPDO_ASSIGN || command->index == OBJ_1C13_TXPDO_ASSIGN;
}

static void check_command(cm1e_findings_t *findings, const cm1e_ec_command_t *command)
{
    if (command->length == 0 || !holds(command->length, command->data))
        cm1e_findings_add(findings, CM1E_RULE_TRIO_INIT_COMMAND, command->place,
                          "0x%04X:%02X: %lld does not fit into %u bytes", command->index, command->subindex,
                          (long long)command->data, (unsigned)command->length);
    if (is_assignment(command) && command->length != (command->subindex == 0 ? 1 : 2))
        cm1e_findings_add(findings, CM1E_RULE_TRIO_INIT_COMMAND, command->place,
                          "0x%04X:%02X has %u bytes; the number of PDOs has 1, a PDO 2", command->index,
                          command->subindex, (unsigned)command->length);
    if (command->transition != TRANSITION_PREOP_SAFEOP)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_UNKNOWN, command->place,
                          "Transition %d is not known here; 2 is from Pre-Operational to Safe-Operational",
                          (int)command->transition);
}

/* How an assignment stands after the commands so far. */
typedef struct assignment {
    const cm1e_ec_command_t *last; /* NULL: nothing is said of it */
    int64_t count;                 /* sub-index 0; -1: not written */
    unsigned highest;              /* sub-index that was written since sub-index 0 was 0 */
} assignment_t;

static void follow_assignment(assignment_t *assignment, const cm1e_ec_command_t *command)
{
    assignment->last = command;
    if (command->subindex == 0)
        assignment->count = command->data;
    else if (command->subindex > assignment->highest)
        assignment->highest = command->subindex;
    if (command->subindex == 0 && command->data == 0)
        assignment->highest = 0;
}

/* PDOs are assigned by 0 into sub-index 0, the PDOs into 1 ... n, n into sub-index 0 (ETG.1000.6 5.6). */
static void check_assignment(cm1e_findings_t *findings, const cm1e_ec_command_list_t *list, uint16_t object)
{
    assignment_t assignment = {.count = -1};
    for (size_t i = 0; i < list->entries.count; i++) {
        const cm1e_ec_command_t *command = &list->entries.at[i];
        if (command->index != object)
            continue;
        if (command->subindex != 0 && assignment.count != 0)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_ASSIGNMENT, command->place,
                              "0x%04X:%02X is written while sub-index 0 is not 0: devices refuse that", object,
                              command->subindex);
        follow_assignment(&assignment, command);
    }
    if (assignment.highest > 0 && assignment.count != assignment.highest)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_ASSIGNMENT, assignment.last->place,
                          "%u PDOs are written into 0x%04X, and its sub-index 0 ends as %lld", assignment.highest,
                          object, (long long)assignment.count);
}

/* The commands take the assignment back and leave it so. */
static bool assigns_nothing(const cm1e_ec_command_list_t *list, uint16_t object)
{
    assignment_t assignment = {.count = -1};
    for (size_t i = 0; i < list->entries.count; i++)
        if (list->entries.at[i].index == object)
            follow_assignment(&assignment, &list->entries.at[i]);
    return assignment.count == 0 && assignment.highest == 0;
}

static void check_commands(cm1e_findings_t *findings, const cm1e_ec_command_list_t *list)
{
    for (size_t i = 0; i < list->entries.count; i++)
        check_command(findings, &list->entries.at[i]);
    check_assignment(findings, list, OBJ_1C12_RXPDO_ASSIGN);
    check_assignment(findings, list, OBJ_1C13_TXPDO_ASSIGN);
}

/* ---- slaves and profiles ---------------------------------------------------------------------------------------- */

static bool speaks(const cm1e_ec_slave_t *slave, const char *protocol)
{
    for (size_t i = 0; i < slave->protocols.count; i++)
        if (strcmp(slave->protocols.at[i].text, protocol) == 0)
            return true;
    return false;
}

static void check_mailbox(cm1e_findings_t *findings, const cm1e_ec_slave_t *slave,
                          const cm1e_ec_command_list_t *commands)
{
    if (*slave->startup_protocol && !speaks(slave, slave->startup_protocol))
        cm1e_findings_add(findings, CM1E_RULE_TRIO_MAILBOX, slave->place,
                          "slave configuration %u starts by " SHORT ", which is not one of its MbxProtocols",
                          (unsigned)slave->index, slave->startup_protocol);
    if (commands && commands->entries.count > 0 && !speaks(slave, "COE"))
        cm1e_findings_add(findings, CM1E_RULE_TRIO_MAILBOX, slave->place,
                          "slave configuration %u has initialization commands, which need COE among its MbxProtocols",
                          (unsigned)slave->index);
}

static void check_axes(cm1e_findings_t *findings, const cm1e_ec_slave_t *slave, const cm1e_ec_pdo_t *rx,
                       const cm1e_ec_pdo_t *tx)
{
    const bool servo = strcmp(slave->type, "SERVO") == 0;
    if (!servo && strcmp(slave->type, "GENERIC") != 0)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_UNKNOWN, slave->place,
                          "\"" SHORT "\" is no SlaveType that is known here: SERVO and GENERIC are", slave->type);
    if (servo && slave->axes == 0)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_AXES, slave->place, "a SERVO has 1 axis or more, not 0");
    if (slave->axes > 1 && slave->slot_pdo_increment == 0)
        cm1e_findings_add(findings, CM1E_RULE_TRIO_AXES, slave->place,
                          "%u axes need a SlotPdoIncrement, which leads from the PDOs of one to those of the next",
                          (unsigned)slave->axes);
    if (servo && ((rx && !has_entry(rx, "CTRL_WORD")) || (tx && !has_entry(tx, "STATUS_WORD"))))
        cm1e_findings_add(findings, CM1E_RULE_TRIO_AXES, slave->place,
                          "a SERVO without CTRL_WORD and STATUS_WORD in its process data cannot be enabled");
}

static void check_slave(cm1e_findings_t *findings, const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave)
{
    const cm1e_ec_pdo_t *rx = cm1e_ec_extend_rx_pdo(document, slave), *tx = cm1e_ec_extend_tx_pdo(document, slave);
    const cm1e_ec_command_list_t *commands = cm1e_ec_extend_commands(document, slave);
    const cm1e_ec_controller_t *controller = cm1e_ec_extend_controller(document, slave);
    const uint32_t axes = slave->axes > 0 ? slave->axes : 1;
    const uint32_t lengths[2] = {cm1e_ec_pdo_bytes(rx) * axes, cm1e_ec_pdo_bytes(tx) * axes};
    check_reference(findings, &slave->controller, "EscCfgIndex", controller);
    check_reference(findings, &slave->commands, "SdoInitCmdIndex", commands);
    check_reference(findings, &slave->rx_pdo, "RxPdoIndex", rx);
    check_reference(findings, &slave->tx_pdo, "TxPdoIndex", tx);
    check_mailbox(findings, slave, commands);
    check_axes(findings, slave, rx, tx);
    for (int bootstrap = 0; controller && bootstrap < 2; bootstrap++)
        check_memory(findings, controller, lengths, bootstrap);
    for (int transmit = 0; commands && transmit < 2; transmit++)
        if (lengths[transmit] > 0 &&
            assigns_nothing(commands, transmit ? OBJ_1C13_TXPDO_ASSIGN : OBJ_1C12_RXPDO_ASSIGN))
            cm1e_findings_add(findings, CM1E_RULE_TRIO_ASSIGNMENT, commands->place,
                              "after these commands no PDO is assigned, and slave configuration %u has %u bytes of "
                              "%s",
                              (unsigned)slave->index, (unsigned)lengths[transmit], transmit ? "inputs" : "outputs");
}

static void check_profiles(cm1e_findings_t *findings, const cm1e_ec_extend_t *document)
{
    for (size_t i = 0; i < document->profiles.count; i++) {
        const cm1e_ec_profile_t *profile = &document->profiles.at[i];
        bool vendor_is_there = false;
        check_reference(findings, &profile->slave, "SlvCfgIndex", cm1e_ec_extend_slave(document, profile));
        for (size_t v = 0; v < document->vendors.count; v++)
            vendor_is_there = vendor_is_there || document->vendors.at[v].vendor_id == profile->vendor_id;
        if (!vendor_is_there)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_VENDOR, profile->place, "vendor 0x%08X is not under Vendors",
                              (unsigned)profile->vendor_id);
        for (size_t j = 0; j < i; j++) {
            const cm1e_ec_profile_t *other = &document->profiles.at[j];
            if (other->vendor_id == profile->vendor_id && other->product_code == profile->product_code &&
                other->revision == profile->revision && other->drive_profile == profile->drive_profile)
                cm1e_findings_add(findings, CM1E_RULE_TRIO_PROFILE, profile->place,
                                  "the same Vid, Pid, Rev and ProfileIndex as in line %u: one of the two is never used",
                                  (unsigned)other->place);
        }
    }
    for (size_t i = 0; i < document->vendors.count; i++)
        for (size_t j = 0; j < i; j++)
            if (document->vendors.at[i].vendor_id == document->vendors.at[j].vendor_id)
                cm1e_findings_add(findings, CM1E_RULE_TRIO_VENDOR, document->vendors.at[i].place,
                                  "vendor 0x%08X is there twice", (unsigned)document->vendors.at[i].vendor_id);
}

/* ---- our own devices -------------------------------------------------------------------------------------------- */

/* The newest firmware with that revision; NULL: none has it. */
static const cm1e_firmware_info_t *firmware_of(uint32_t revision)
{
    for (int f = CM1E_FIRMWARE_COUNT - 1; f >= 0; f--)
        if (cm1e_firmware_info((cm1e_firmware_t)f)->revision == revision)
            return cm1e_firmware_info((cm1e_firmware_t)f);
    return NULL;
}

/* The CM1-E of a firmware in both orders of the mappings, made when it is asked for first. */
typedef struct known {
    cm1e_description_file_t files[CM1E_FIRMWARE_COUNT];
} known_t;

static const cm1e_description_t *known_orders(known_t *known, const cm1e_firmware_info_t *firmware)
{
    cm1e_description_file_t *file = &known->files[firmware->firmware];
    for (int order = CM1E_PDO_ORDER_UG_4_4; file->devices.count <= (size_t)order && order <= CM1E_PDO_ORDER_UG_7_2;
         order++) {
        cm1e_device_options_t options = {.order = (cm1e_pdo_order_t)order};
        snprintf(options.firmware, sizeof options.firmware, "%s", firmware->version);
        if (cm1e_describe(file, &options, CM1E_ESI_FLAT, NULL) != CM1E_OK)
            return NULL;
    }
    return file->devices.at;
}

/* In either order: both are in the field, and the file may be for either. */
static void check_cm1e(cm1e_findings_t *findings, const cm1e_ec_extend_t *document, const cm1e_ec_slave_t *slave,
                       const cm1e_description_t *orders)
{
    findings->arena.failed |= !orders;
    if (orders && cm1e_ec_extend_beside(NULL, CM1E_RULE_TRIO_DEVICE, document, slave, &orders[1]) > 0)
        cm1e_ec_extend_beside(findings, CM1E_RULE_TRIO_DEVICE, document, slave, &orders[0]);
}

static void check_known_devices(cm1e_findings_t *findings, const cm1e_ec_extend_t *document)
{
    known_t known = {0};
    for (size_t i = 0; i < document->profiles.count; i++) {
        const cm1e_ec_profile_t *profile = &document->profiles.at[i];
        const cm1e_ec_slave_t *slave = cm1e_ec_extend_slave(document, profile);
        if (profile->vendor_id != CM1E_VENDOR_ID || profile->product_code != CM1E_PRODUCT_CODE || !slave)
            continue;
        const cm1e_firmware_info_t *firmware = firmware_of(profile->revision);
        if (!firmware)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_REVISION, profile->place,
                              "no firmware of the CM1-E that is known here has revision 0x%08X; 0x%08X has from V1.3.0 "
                              "on, 0x%08X before",
                              (unsigned)profile->revision,
                              (unsigned)cm1e_firmware_info(CM1E_FIRMWARE_COUNT - 1)->revision,
                              (unsigned)cm1e_firmware_info(CM1E_FIRMWARE_1_2_0)->revision);
        check_cm1e(findings, document, slave,
                   known_orders(&known, firmware ? firmware : cm1e_firmware_info(CM1E_FIRMWARE_COUNT - 1)));
    }
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        cm1e_description_file_free(&known.files[f]);
}

/* ---- elements --------------------------------------------------------------------------------------------------- */

/* What stands in what, as far as it is known (UG 11.2, docs/TRIO.md). */
static const struct {
    const char *parent, *children;
} elements[] = {
    {"EtherCAT", " Version RxPdos TxPdos SdoInitCmds EscCfgs SlvCfgs Profiles Vendors "},
    {"RxPdos", " RxPdo "}, {"TxPdos", " TxPdo "}, {"SdoInitCmds", " SdoInitCmd "}, {"EscCfgs", " EscCfg "},
    {"SlvCfgs", " SlvCfg "}, {"Profiles", " Profile "}, {"Vendors", " Vendor "},
    {"RxPdo", " Index Name Entry "}, {"TxPdo", " Index Name Entry "}, {"SdoInitCmd", " Index Name Entry "},
    {"Entry", " Name Length Flags Index SubIndex Data Transition "},
    {"EscCfg", " Index Sm "}, {"Sm", " Index Startaddress Size Controlbyte Enable Function "},
    {"SlvCfg", " Index SlaveType Axes Din Dout Ain Aout Vr CycData Dc SlotPdoIncrement MbxStartupProtocol MbxProtocols "
               "MbxRate EscCfgIndex SdoInitCmdIndex RxPdoIndex TxPdoIndex "},
    {"Vr", " Output Input "}, {"Output", " Address "}, {"Input", " Address "},
    {"CycData", " Atype CtrlMode UseLrdLwr Cmd State "}, {"Dc", " Mode "},
    {"Profile", " Index Vid Pid Rev ProfileIndex Atype Name SlvCfgIndex "}, {"Vendor", " Vid Name "},
};

static bool is_known_child(const char *parent, const char *child)
{
    char word[64];
    if ((size_t)snprintf(word, sizeof word, " %s ", child) >= sizeof word)
        return false;
    for (size_t i = 0; i < sizeof elements / sizeof elements[0]; i++)
        if (strcmp(elements[i].parent, parent) == 0)
            return strstr(elements[i].children, word) != NULL;
    return false;
}

/* What is not known is kept, but a controller that does not know it either goes by its default: a misspelled name is
 * found nowhere else. */
static void check_elements(cm1e_findings_t *findings, const xmlNode *node)
{
    for (const xmlNode *child = cm1e_xml_child(node, NULL); child; child = cm1e_xml_next(child, NULL)) {
        if (is_known_child((const char *)node->name, (const char *)child->name))
            check_elements(findings, child);
        else
            cm1e_findings_add(findings, CM1E_RULE_TRIO_UNKNOWN, cm1e_xml_line(child),
                              "<" SHORT "> in <" SHORT "> is not known here; names of elements count to the letter",
                              (const char *)child->name, (const char *)node->name);
        if (child->properties)
            cm1e_findings_add(findings, CM1E_RULE_TRIO_UNKNOWN, cm1e_xml_line(child),
                              "<" SHORT "> has an attribute; none is known here", (const char *)child->name);
    }
}

void cm1e_ec_extend_check(cm1e_findings_t *findings, const cm1e_ec_extend_t *document)
{
    check_elements(findings, xmlDocGetRootElement(document->doc));
    check_unique(findings, document);
    for (size_t i = 0; i < document->rx_pdos.count; i++)
        check_entries(findings, &document->rx_pdos.at[i], false);
    for (size_t i = 0; i < document->tx_pdos.count; i++)
        check_entries(findings, &document->tx_pdos.at[i], true);
    for (size_t i = 0; i < document->commands.count; i++)
        check_commands(findings, &document->commands.at[i]);
    for (size_t i = 0; i < document->controllers.count; i++)
        check_controller(findings, &document->controllers.at[i]);
    for (size_t i = 0; i < document->slaves.count; i++)
        check_slave(findings, document, &document->slaves.at[i]);
    check_profiles(findings, document);
    check_known_devices(findings, document);
}
