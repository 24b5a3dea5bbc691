#include <string.h>

#include "description/describe.h"
#include "device/devices.h"
#include "generate/ec_extend.h"
#include "generate/xml_write.h"

enum { DC_MODE = 0x0300, MAILBOX_RATE = 100, TRANSITION_PREOP_SAFEOP = 2 };
/* Where the controller puts what has no name of its own, and takes it from; as in the file of Trio's. */
enum { VR_OUTPUT = 300, VR_INPUT = 200 };

/* What a Trio controller is told of a model beside its tables. CM1-E: the view "Slave Configurations" of UG 11.2. What
 * a bridge has of digital signals is reached by SDO only. */
static const struct {
    unsigned din, dout, ain, aout;
} signals[] = {
    [CM1E_DEVICE_CM1E] = {4, 2, 1, 0},
    [CM1E_DEVICE_EB01] = {0, 0, 0, 0},
    [CM1E_DEVICE_EB02] = {0, 0, 0, 0},
    [CM1E_DEVICE_EB12] = {0, 0, 0, 0},
};

/* Names of the lists, and CtrlMode. DYNAMIC: UG 11.2, which runs it in CSP. That CSV is spelled so is a guess. */
static const struct {
    const char *rx, *tx, *commands, *control;
} styles[] = {
    [CM1E_MAPPING_DYNAMIC] = {"RXPDO_PROFILE", "TXPDO_PROFILE", "SDO_APP_CSP", "CSP"},
    [CM1E_MAPPING_CSP] = {"RXPDO_PROFILE_CSP", "TXPDO_PROFILE_CSP", "SDO_APP_CSP", "CSP"},
    [CM1E_MAPPING_CSV] = {"RXPDO_PROFILE_CSV", "TXPDO_PROFILE_CSV", "SDO_APP_CSV", "CSV"},
    [CM1E_MAPPING_PROFILE] = {"RXPDO_PROFILE_PP", "TXPDO_PROFILE_PP", "SDO_APP_PP", "NONE"},
};

static const char profile_warning[] =
    "with the profile mapping the motor computes the motion: MOVE and similar commands do not work, and a program has "
    "to write DRIVE_CONTROLWORD; profile velocity and acceleration come from VR(300) on. For motions of the controller "
    "use the mapping dynamic or csp.";
static const char csv_warning[] =
    "in CSV the controller closes the position loop: gains and the scale of its output have to be tuned before the "
    "motor may turn. Use the mapping dynamic or csp unless you need CSV.";
static const char bridge_warning[] =
    "the bridge's guide does not say where its sync managers lie; here they are the CM1-E's. Compare the file with the "
    "bridge before use (cm1e diff).";

/* One device on its way into the document. */
typedef struct plan {
    cm1e_ec_extend_t lists;  /* without a doc: what is to be written */
    cm1e_description_file_t described;
    const cm1e_generate_options_t *options;
} plan_t;

/* The device has several mappings to choose from; those with channels have one. */
static bool has_mappings(const cm1e_device_options_t *options)
{
    const cm1e_device_t *device = cm1e_device_of_model(options->model);
    return device && device->channels == 0;
}

/* Device n, and the options that it comes of. */
static const cm1e_device_options_t *device_options(const plan_t *plan, size_t n)
{
    static const cm1e_device_options_t one_cm1e = {0};
    return plan->options->devices ? &plan->options->devices[n] : &one_cm1e;
}

/* ---- one axis of a device --------------------------------------------------------------------------------------- */

static const cm1e_module_t *axis_module(const plan_t *plan, const cm1e_description_t *device)
{
    const cm1e_slot_t *slot = device->slots.count > 0 ? &device->slots.at[0] : NULL;
    for (size_t c = 0; slot && c < slot->choices.count; c++)
        for (size_t m = 0; m < plan->described.modules.count; m++)
            if ((slot->choices.at[c].is_default || slot->choices.count == 1) &&
                plan->described.modules.at[m].ident == slot->choices.at[c].ident)
                return &plan->described.modules.at[m];
    return NULL;
}

static uint32_t axis_count(const cm1e_description_t *device)
{
    uint32_t axes = 0;
    for (size_t i = 0; i < device->slots.count; i++)
        axes += device->slots.at[i].maximum_instances;
    return axes > 0 ? axes : 1;
}

/* The PDO of the first axis that is assigned by default: the controller adds SlotPdoIncrement for the others. */
static const cm1e_described_pdo_t *axis_pdo(const plan_t *plan, const cm1e_description_t *device, bool transmit)
{
    const cm1e_module_t *module = axis_module(plan, device);
    const cm1e_pdo_list_t *pdos = module ? &module->pdos : &device->pdos;
    for (size_t i = 0; i < pdos->count; i++)
        if (pdos->at[i].transmit == transmit && pdos->at[i].sync_manager != CM1E_NO_SYNC_MANAGER)
            return &pdos->at[i];
    return NULL;
}

/* ---- lists, shared by devices that have the same ---------------------------------------------------------------- */

static bool same_entries(const cm1e_ec_pdo_t *a, const cm1e_ec_pdo_t *b)
{
    bool same = a->entries.count == b->entries.count;
    for (size_t i = 0; same && i < a->entries.count; i++)
        same = strcmp(a->entries.at[i].name, b->entries.at[i].name) == 0 &&
               a->entries.at[i].length == b->entries.at[i].length;
    return same;
}

static bool same_commands(const cm1e_ec_command_list_t *a, const cm1e_ec_command_list_t *b)
{
    bool same = a->entries.count == b->entries.count;
    for (size_t i = 0; same && i < a->entries.count; i++) {
        const cm1e_ec_command_t *x = &a->entries.at[i], *y = &b->entries.at[i];
        same = x->index == y->index && x->subindex == y->subindex && x->length == y->length && x->data == y->data;
    }
    return same;
}

static bool same_managers(const cm1e_ec_controller_t *a, const cm1e_ec_controller_t *b)
{
    bool same = a->sync_managers.count == b->sync_managers.count;
    for (size_t i = 0; same && i < a->sync_managers.count; i++) {
        const cm1e_ec_sync_manager_t *x = &a->sync_managers.at[i], *y = &b->sync_managers.at[i];
        same = x->start == y->start && x->size == y->size && x->control == y->control && x->enable == y->enable;
    }
    return same;
}

/* `item` as a member of `list`: one that is the same already, or itself at the end with a name of its own. */
#define SHARE(arena, list, item, same, wanted, its_name)                                                            \
    do {                                                                                                            \
        bool taken = false;                                                                                         \
        for (size_t i = 0; i < (list).count; i++) {                                                                 \
            taken = taken || strcmp((list).at[i].its_name, (wanted)) == 0;                                          \
            if (same(&(list).at[i], &(item)))                                                                       \
                return (list).at[i].its_name;                                                                       \
        }                                                                                                           \
        (item).index = (uint32_t)(list).count;                                                                      \
        (item).its_name = taken ? cm1e_arena_format(arena, "%s_%u", (wanted), (item).index) : (wanted);             \
        memcpy(CM1E_APPEND(arena, &(list)), &(item), sizeof(item));                                                 \
        return (item).its_name;                                                                                     \
    } while (0)

static const char *share_pdo(plan_t *plan, const cm1e_described_pdo_t *pdo, const char *wanted)
{
    cm1e_arena_t *arena = &plan->lists.arena;
    cm1e_ec_pdo_t list = {0};
    for (size_t i = 0; i < pdo->entries.count; i++) {
        cm1e_ec_entry_t *entry = CM1E_APPEND(arena, &list.entries);
        entry->name = cm1e_ec_name_of(&pdo->entries.at[i], pdo->transmit);
        entry->length = (pdo->entries.at[i].bits + 7) / 8;
    }
    if (pdo->transmit)
        SHARE(arena, plan->lists.tx_pdos, list, same_entries, wanted, name);
    SHARE(arena, plan->lists.rx_pdos, list, same_entries, wanted, name);
}

static void add_command(plan_t *plan, cm1e_ec_command_list_t *list, const cm1e_init_command_t *from, unsigned axis,
                        const cm1e_description_t *device)
{
    const bool assignment = from->index == OBJ_1C12_RXPDO_ASSIGN || from->index == OBJ_1C13_TXPDO_ASSIGN;
    if (assignment && from->subindex > 1)
        return; /* of another axis: the controller's by SlotPdoIncrement */
    cm1e_ec_command_t *command = CM1E_APPEND(&plan->lists.arena, &list->entries);
    command->index = (uint16_t)(from->index + (from->depends_on_slot ? axis * device->slot_index_increment : 0));
    command->subindex = from->subindex;
    command->length = (uint32_t)from->data.size;
    command->data = (int64_t)cm1e_bytes_unsigned(from->data);
    if (assignment && from->subindex == 0 && command->data > 1)
        command->data = 1;
}

static const char *share_commands(plan_t *plan, const cm1e_description_t *device, const char *wanted)
{
    cm1e_ec_command_list_t list = {0};
    for (size_t i = 0; i < device->init_commands.count; i++)
        add_command(plan, &list, &device->init_commands.at[i], 0, device);
    const cm1e_module_t *module = axis_module(plan, device);
    for (unsigned axis = 0; module && axis < axis_count(device); axis++)
        for (size_t i = 0; i < module->init_commands.count; i++)
            add_command(plan, &list, &module->init_commands.at[i], axis, device);
    SHARE(&plan->lists.arena, plan->lists.commands, list, same_commands, wanted, name);
}

static uint32_t share_controller(plan_t *plan, const cm1e_description_t *device)
{
    cm1e_ec_controller_t controller = {.index = (uint32_t)plan->lists.controllers.count};
    for (size_t i = 0; i < device->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *from = &device->sync_managers.at[i];
        const bool mailbox = cm1e_sync_manager_is_mailbox(from->use);
        cm1e_ec_sync_manager_t *manager = CM1E_APPEND(&plan->lists.arena, &controller.sync_managers);
        manager->index = (uint32_t)i;
        manager->start = from->start;
        manager->size = mailbox ? from->length : -1; /* blank in UG 11.2: it follows from the PDOs */
        manager->control = from->control;
        manager->enable = from->enable;
        manager->function = cm1e_ec_function(from->use);
    }
    for (size_t i = 0; i < plan->lists.controllers.count; i++)
        if (same_managers(&plan->lists.controllers.at[i], &controller))
            return plan->lists.controllers.at[i].index;
    *(cm1e_ec_controller_t *)CM1E_APPEND(&plan->lists.arena, &plan->lists.controllers) = controller;
    return controller.index;
}

/* ---- a device --------------------------------------------------------------------------------------------------- */

static cm1e_ec_reference_t reference(const char *text)
{
    return (cm1e_ec_reference_t){.text = text};
}

/* Each warning once. */
static void warn(plan_t *plan, const char *text)
{
    const char *before = plan->lists.warning ? plan->lists.warning : "";
    if (!strstr(before, text))
        plan->lists.warning = cm1e_arena_format(&plan->lists.arena, "%s%s%s", before, *before ? " " : "", text);
}

static void plan_slave(plan_t *plan, size_t n)
{
    cm1e_arena_t *arena = &plan->lists.arena;
    const cm1e_description_t *device = &plan->described.devices.at[n];
    const cm1e_device_options_t *options = device_options(plan, n);
    /* The bridge has one mapping, of CSP (BR 6.3.1). */
    const cm1e_mapping_t mapping = has_mappings(options) ? options->mapping : CM1E_MAPPING_CSP;
    cm1e_ec_slave_t slave = {.index = (uint32_t)n, .type = "SERVO", .axes = axis_count(device),
                             .startup_protocol = "COE"};
    slave.slot_pdo_increment = slave.axes > 1 ? device->slot_pdo_increment : 0;
    slave.rx_pdo = reference(share_pdo(plan, axis_pdo(plan, device, false), styles[mapping].rx));
    slave.tx_pdo = reference(share_pdo(plan, axis_pdo(plan, device, true), styles[mapping].tx));
    slave.commands = reference(share_commands(plan, device, styles[mapping].commands));
    slave.controller = reference(cm1e_arena_format(arena, "%u", share_controller(plan, device)));
    *(cm1e_ec_reference_t *)CM1E_APPEND(arena, &slave.protocols) = reference("COE");
    if (device->mailbox.foe)
        *(cm1e_ec_reference_t *)CM1E_APPEND(arena, &slave.protocols) = reference("FOE");
    *(cm1e_ec_slave_t *)CM1E_APPEND(arena, &plan->lists.slaves) = slave;
    warn(plan, !has_mappings(options) ? bridge_warning
               : mapping == CM1E_MAPPING_PROFILE  ? profile_warning
               : mapping == CM1E_MAPPING_CSV      ? csv_warning
                                                  : "");
}

static void plan_vendor(plan_t *plan, const cm1e_description_t *device)
{
    for (size_t i = 0; i < plan->lists.vendors.count; i++)
        if (plan->lists.vendors.at[i].vendor_id == device->vendor_id)
            return;
    cm1e_ec_vendor_t *vendor = CM1E_APPEND(&plan->lists.arena, &plan->lists.vendors);
    vendor->vendor_id = device->vendor_id;
    vendor->name = device->vendor_name ? device->vendor_name : "";
}

/* The controller goes by vendor, product and revision. What DRIVE_PROFILE might tell apart beside them is not
 * documented, so nothing here relies on it. */
static cm1e_error_t check_identities(const plan_t *plan, cm1e_diag_t *diag)
{
    const cm1e_description_t *devices = plan->described.devices.at;
    for (size_t i = 0; i < plan->described.devices.count; i++)
        for (size_t j = 0; j < i; j++)
            if (devices[i].vendor_id == devices[j].vendor_id && devices[i].product_code == devices[j].product_code &&
                devices[i].revision == devices[j].revision)
                return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                                     "devices %zu and %zu have the same vendor 0x%08X, product 0x%08X and revision "
                                     "0x%08X: the controller could not tell them apart. One entry serves all motors of "
                                     "that revision; make a separate file for another mapping",
                                     j + 1, i + 1, (unsigned)devices[i].vendor_id, (unsigned)devices[i].product_code,
                                     (unsigned)devices[i].revision);
    return CM1E_OK;
}

static cm1e_error_t plan_devices(plan_t *plan, cm1e_diag_t *diag)
{
    const size_t count = plan->options->devices ? plan->options->device_count : 1;
    cm1e_error_t error = CM1E_OK;
    if (count == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "no device is given");
    for (size_t i = 0; i < count && error == CM1E_OK; i++) {
        const cm1e_device_options_t *options = device_options(plan, i);
        /* By modules a device shows what belongs to one axis. */
        const cm1e_esi_layout_t layout = has_mappings(options) ? CM1E_ESI_FLAT : CM1E_ESI_MDP;
        error = cm1e_describe(&plan->described, options, layout, diag);
    }
    if (error == CM1E_OK)
        error = check_identities(plan, diag);
    for (size_t i = 0; i < count && error == CM1E_OK; i++) {
        plan_slave(plan, i);
        plan_vendor(plan, &plan->described.devices.at[i]);
    }
    if (error == CM1E_OK && plan->lists.arena.failed)
        error = cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    return error;
}

/* ---- in the order of Trio's file -------------------------------------------------------------------------------- */

static void put_number(cm1e_xml_writer_t *writer, const char *name, unsigned number)
{
    cm1e_xml_put(writer, name, "%u", number);
}

static void put_pdo(cm1e_xml_writer_t *writer, const char *element, const cm1e_ec_pdo_t *pdo)
{
    cm1e_xml_open(writer, element);
    put_number(writer, "Index", pdo->index);
    cm1e_xml_put(writer, "Name", "%s", pdo->name);
    for (size_t i = 0; i <= pdo->entries.count; i++) {
        const bool end = i == pdo->entries.count;
        cm1e_xml_open(writer, "Entry");
        cm1e_xml_put(writer, "Name", "%s", end ? CM1E_EC_END_ENTRY : pdo->entries.at[i].name);
        put_number(writer, "Length", end ? 0 : pdo->entries.at[i].length);
        put_number(writer, "Flags", 0);
        cm1e_xml_close(writer);
    }
    cm1e_xml_close(writer);
}

static void put_commands(cm1e_xml_writer_t *writer, const cm1e_ec_command_list_t *list)
{
    cm1e_xml_open(writer, "SdoInitCmd");
    put_number(writer, "Index", list->index);
    cm1e_xml_put(writer, "Name", "%s", list->name);
    for (size_t i = 0; i < list->entries.count; i++) {
        const cm1e_ec_command_t *command = &list->entries.at[i];
        cm1e_xml_open(writer, "Entry");
        cm1e_xml_put(writer, "Index", "0x%04X", command->index);
        put_number(writer, "SubIndex", command->subindex);
        put_number(writer, "Length", command->length);
        cm1e_xml_put(writer, "Data", command->length == 2 ? "0x%04llX" : "%llu", (unsigned long long)command->data);
        cm1e_xml_put(writer, "Flags", "NONE");
        put_number(writer, "Transition", TRANSITION_PREOP_SAFEOP);
        cm1e_xml_close(writer);
    }
    cm1e_xml_close(writer);
}

static void put_controller(cm1e_xml_writer_t *writer, const cm1e_ec_controller_t *controller)
{
    cm1e_xml_open(writer, "EscCfg");
    put_number(writer, "Index", controller->index);
    for (size_t i = 0; i < controller->sync_managers.count; i++) {
        const cm1e_ec_sync_manager_t *manager = &controller->sync_managers.at[i];
        cm1e_xml_open(writer, "Sm");
        put_number(writer, "Index", manager->index);
        cm1e_xml_put(writer, "Startaddress", "0x%04X", manager->start);
        if (manager->size >= 0)
            put_number(writer, "Size", (unsigned)manager->size);
        cm1e_xml_put(writer, "Controlbyte", "0x%02X", manager->control);
        put_number(writer, "Enable", manager->enable);
        cm1e_xml_put(writer, "Function", "%s", manager->function);
        cm1e_xml_close(writer);
    }
    cm1e_xml_close(writer);
}

static void put_vrs(cm1e_xml_writer_t *writer)
{
    cm1e_xml_open(writer, "Vr");
    cm1e_xml_open(writer, "Output");
    put_number(writer, "Address", VR_OUTPUT);
    cm1e_xml_close(writer);
    cm1e_xml_open(writer, "Input");
    put_number(writer, "Address", VR_INPUT);
    cm1e_xml_close(writer);
    cm1e_xml_close(writer);
}

static void put_cyclic_data(cm1e_xml_writer_t *writer, const char *control)
{
    cm1e_xml_open(writer, "CycData");
    cm1e_xml_put(writer, "Atype", "POSITION");
    cm1e_xml_put(writer, "CtrlMode", "%s", control);
    cm1e_xml_put(writer, "UseLrdLwr", "FALSE");
    cm1e_xml_put(writer, "Cmd", "LRW");
    cm1e_xml_put(writer, "State", "DEVICE_STATE_SAFEOP,DEVICE_STATE_OP");
    cm1e_xml_close(writer);
}

static void put_slave(cm1e_xml_writer_t *writer, const plan_t *plan, size_t n)
{
    const cm1e_ec_slave_t *slave = &plan->lists.slaves.at[n];
    const cm1e_device_options_t *options = device_options(plan, n);
    const bool is_motor = has_mappings(options);
    cm1e_xml_open(writer, "SlvCfg");
    put_number(writer, "Index", slave->index);
    cm1e_xml_put(writer, "SlaveType", "%s", slave->type);
    put_number(writer, "Axes", slave->axes);
    put_number(writer, "Din", signals[options->model].din);
    put_number(writer, "Dout", signals[options->model].dout);
    put_number(writer, "Ain", signals[options->model].ain);
    put_number(writer, "Aout", signals[options->model].aout);
    if (is_motor && options->mapping == CM1E_MAPPING_PROFILE)
        put_vrs(writer);
    put_cyclic_data(writer, styles[is_motor ? options->mapping : CM1E_MAPPING_CSP].control);
    cm1e_xml_open(writer, "Dc");
    cm1e_xml_put(writer, "Mode", "0x%04X", plan->options->dc_mode ? plan->options->dc_mode : DC_MODE);
    cm1e_xml_close(writer);
    if (slave->slot_pdo_increment)
        cm1e_xml_put(writer, "SlotPdoIncrement", "0x%02X", (unsigned)slave->slot_pdo_increment);
    cm1e_xml_put(writer, "MbxStartupProtocol", "%s", slave->startup_protocol);
    for (size_t i = 0; i < slave->protocols.count; i++)
        cm1e_xml_put(writer, "MbxProtocols", "%s", slave->protocols.at[i].text);
    put_number(writer, "MbxRate", plan->options->mailbox_rate ? plan->options->mailbox_rate : MAILBOX_RATE);
    cm1e_xml_put(writer, "EscCfgIndex", "%s", slave->controller.text);
    cm1e_xml_put(writer, "SdoInitCmdIndex", "%s", slave->commands.text);
    cm1e_xml_put(writer, "RxPdoIndex", "%s", slave->rx_pdo.text);
    cm1e_xml_put(writer, "TxPdoIndex", "%s", slave->tx_pdo.text);
    cm1e_xml_close(writer);
}

static void put_profile(cm1e_xml_writer_t *writer, const cm1e_description_t *device, unsigned n)
{
    cm1e_xml_open(writer, "Profile");
    put_number(writer, "Index", n);
    cm1e_xml_put(writer, "Vid", "0x%08X", (unsigned)device->vendor_id);
    cm1e_xml_put(writer, "Pid", "0x%08X", (unsigned)device->product_code);
    put_number(writer, "Rev", device->revision); /* decimal, as in UG 11.2 */
    put_number(writer, "ProfileIndex", 0);
    cm1e_xml_put(writer, "Atype", "POSITION");
    cm1e_xml_put(writer, "Name", "%s", device->type);
    put_number(writer, "SlvCfgIndex", n);
    cm1e_xml_close(writer);
}

#define SECTION(writer, section, list, put_item)                                                                    \
    do {                                                                                                            \
        cm1e_xml_open(writer, section);                                                                             \
        for (size_t i = 0; i < (list).count; i++)                                                                   \
            put_item;                                                                                               \
        cm1e_xml_close(writer);                                                                                     \
    } while (0)

static cm1e_error_t put_document(cm1e_file_t *file, const plan_t *plan, cm1e_diag_t *diag)
{
    const cm1e_ec_extend_t *lists = &plan->lists;
    cm1e_xml_writer_t writer;
    cm1e_xml_begin(&writer);
    cm1e_xml_open(&writer, "EtherCAT");
    cm1e_xml_put(&writer, "Version", "1.0.0");
    SECTION(&writer, "RxPdos", lists->rx_pdos, put_pdo(&writer, "RxPdo", &lists->rx_pdos.at[i]));
    SECTION(&writer, "TxPdos", lists->tx_pdos, put_pdo(&writer, "TxPdo", &lists->tx_pdos.at[i]));
    SECTION(&writer, "SdoInitCmds", lists->commands, put_commands(&writer, &lists->commands.at[i]));
    SECTION(&writer, "EscCfgs", lists->controllers, put_controller(&writer, &lists->controllers.at[i]));
    SECTION(&writer, "SlvCfgs", lists->slaves, put_slave(&writer, plan, i));
    SECTION(&writer, "Profiles", lists->slaves, put_profile(&writer, &plan->described.devices.at[i], (unsigned)i));
    cm1e_xml_open(&writer, "Vendors");
    for (size_t i = 0; i < lists->vendors.count; i++) {
        cm1e_xml_open(&writer, "Vendor");
        cm1e_xml_put(&writer, "Vid", "0x%08X", (unsigned)lists->vendors.at[i].vendor_id);
        cm1e_xml_put(&writer, "Name", "%s", lists->vendors.at[i].name);
        cm1e_xml_close(&writer);
    }
    cm1e_xml_close(&writer);
    cm1e_xml_close(&writer);
    return cm1e_xml_finish(&writer, file, diag);
}

/* Made by writing it and reading it: so its lists have the lines of the file that it becomes. */
cm1e_error_t cm1e_ec_extend_make(cm1e_ec_extend_t *document, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    plan_t plan = {.options = options};
    cm1e_file_t file = {0};
    cm1e_error_t error = plan_devices(&plan, diag);
    if (error == CM1E_OK)
        error = put_document(&file, &plan, diag);
    if (error == CM1E_OK)
        error = cm1e_ec_extend_read(document, file.bytes, file.size, diag);
    document->warning = cm1e_arena_text(&document->arena, plan.lists.warning);
    cm1e_file_free(&file);
    cm1e_description_file_free(&plan.described);
    cm1e_ec_extend_free(&plan.lists);
    return error;
}
