#include <string.h>

#include "generate/ec_extend.h"
#include "generate/xml_read.h"

/* Bounds of what a field can hold; beyond them a number is a slip. */
enum { MAX_INDEX = 0xFFFF, MAX_ENTRY_BYTES = 4096, MAX_AXES = 256, MAX_SYNC_MANAGER = 15, MAX_IN_LIST = 500 };
#define MAX_U32 ((int64_t)UINT32_MAX)

/* ---- what can be written back ----------------------------------------------------------------------------------- */

static bool is_blank(const xmlNode *text)
{
    const char *content = (const char *)text->content;
    return !content || content[strspn(content, " \t\r\n")] == '\0';
}

static bool attributes_are_plain(const xmlNode *node)
{
    for (const xmlAttr *attribute = node->properties; attribute; attribute = attribute->next)
        if (attribute->ns)
            return false;
    return true;
}

/* Elements with elements in them, or with a text: so is every EC_EXTEND, and only so it comes back as it was. */
static void check_shape(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    bool has_text = false, has_others = false;
    if (node->ns || node->nsDef || !attributes_are_plain(node))
        cm1e_xml_fail(reader, node, "<%s> has an XML namespace; an EC_EXTEND has none", (const char *)node->name);
    for (const xmlNode *child = node->children; child && !reader->failed; child = child->next) {
        if (child->type == XML_TEXT_NODE) {
            has_text = has_text || !is_blank(child);
            continue;
        }
        has_others = true;
        if (child->type == XML_ELEMENT_NODE)
            check_shape(reader, child);
        else if (child->type != XML_COMMENT_NODE)
            cm1e_xml_fail(reader, node, "in <%s>: an EC_EXTEND has elements, texts and comments, nothing else",
                          (const char *)node->name);
    }
    if (has_text && has_others)
        cm1e_xml_fail(reader, node, "<%s> has a text and elements or comments beside it; one of them is too much",
                      (const char *)node->name);
}

/* ---- fields ----------------------------------------------------------------------------------------------------- */

/* A field that stands once at most. */
static const xmlNode *field(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name)
{
    const xmlNode *node = cm1e_xml_child(parent, name);
    const xmlNode *again = cm1e_xml_next(node, name);
    if (again)
        cm1e_xml_fail(reader, again, "<%s> is there twice in this <%s>", name, (const char *)parent->name);
    return node;
}

static const xmlNode *needed(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name)
{
    cm1e_xml_need(reader, parent, name);
    return field(reader, parent, name);
}

static const char *text(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    return node ? cm1e_xml_text(reader, node) : "";
}

static uint32_t need_number(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, int64_t maximum)
{
    return (uint32_t)cm1e_xml_number(reader, needed(reader, parent, name), 0, maximum, 0);
}

static uint32_t number(cm1e_xml_reader_t *reader, const xmlNode *parent, const char *name, int64_t maximum)
{
    return (uint32_t)cm1e_xml_number(reader, field(reader, parent, name), 0, maximum, 0);
}

static cm1e_ec_reference_t reference(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    return (cm1e_ec_reference_t){.place = cm1e_xml_line(node), .text = cm1e_xml_text(reader, node)};
}

/* Limit that keeps the comparison of all pairs short. */
static bool is_counted(cm1e_xml_reader_t *reader, const xmlNode *node, size_t *count)
{
    if (node && ++*count > MAX_IN_LIST)
        cm1e_xml_fail(reader, node, "more than %d <%s> in one list", MAX_IN_LIST, (const char *)node->name);
    return node && !reader->failed;
}

#define EACH(node, parent, name)                                                                                    \
    (size_t count_ = 0, once_ = 1; once_; once_ = 0)                                                                \
        for (const xmlNode *node = cm1e_xml_child(parent, name); is_counted(reader, node, &count_);                 \
             node = cm1e_xml_next(node, name))

/* ---- the lists -------------------------------------------------------------------------------------------------- */

static void read_pdo(cm1e_xml_reader_t *reader, cm1e_ec_pdo_t *pdo, const xmlNode *node)
{
    pdo->place = cm1e_xml_line(node);
    pdo->index = need_number(reader, node, "Index", MAX_INDEX);
    pdo->name = text(reader, needed(reader, node, "Name"));
    for EACH(child, node, "Entry") {
        cm1e_ec_entry_t *entry = CM1E_APPEND(reader->arena, &pdo->entries);
        entry->place = cm1e_xml_line(child);
        entry->name = text(reader, needed(reader, child, "Name"));
        entry->length = need_number(reader, child, "Length", MAX_ENTRY_BYTES);
    }
}

static void read_commands(cm1e_xml_reader_t *reader, cm1e_ec_command_list_t *list, const xmlNode *node)
{
    list->place = cm1e_xml_line(node);
    list->index = need_number(reader, node, "Index", MAX_INDEX);
    list->name = text(reader, needed(reader, node, "Name"));
    for EACH(child, node, "Entry") {
        cm1e_ec_command_t *command = CM1E_APPEND(reader->arena, &list->entries);
        command->place = cm1e_xml_line(child);
        command->index = (uint16_t)need_number(reader, child, "Index", MAX_INDEX);
        command->subindex = (uint8_t)need_number(reader, child, "SubIndex", UINT8_MAX);
        command->length = need_number(reader, child, "Length", MAX_ENTRY_BYTES);
        command->data = cm1e_xml_number(reader, needed(reader, child, "Data"), INT64_MIN, INT64_MAX, 0);
        command->transition = (int32_t)need_number(reader, child, "Transition", INT32_MAX);
    }
}

static void read_controller(cm1e_xml_reader_t *reader, cm1e_ec_controller_t *controller, const xmlNode *node)
{
    controller->place = cm1e_xml_line(node);
    controller->index = need_number(reader, node, "Index", MAX_INDEX);
    for EACH(child, node, "Sm") {
        cm1e_ec_sync_manager_t *manager = CM1E_APPEND(reader->arena, &controller->sync_managers);
        manager->place = cm1e_xml_line(child);
        manager->index = need_number(reader, child, "Index", MAX_SYNC_MANAGER);
        manager->start = (uint16_t)need_number(reader, child, "Startaddress", UINT16_MAX);
        manager->size = (int32_t)cm1e_xml_number(reader, field(reader, child, "Size"), 0, UINT16_MAX, -1);
        manager->control = (uint8_t)need_number(reader, child, "Controlbyte", UINT8_MAX);
        manager->enable = (uint8_t)need_number(reader, child, "Enable", UINT8_MAX);
        manager->function = text(reader, needed(reader, child, "Function"));
    }
}

static void read_slave(cm1e_xml_reader_t *reader, cm1e_ec_slave_t *slave, const xmlNode *node)
{
    slave->place = cm1e_xml_line(node);
    slave->index = need_number(reader, node, "Index", MAX_INDEX);
    slave->type = text(reader, needed(reader, node, "SlaveType"));
    slave->axes = need_number(reader, node, "Axes", MAX_AXES);
    slave->slot_pdo_increment = number(reader, node, "SlotPdoIncrement", MAX_INDEX);
    slave->startup_protocol = text(reader, field(reader, node, "MbxStartupProtocol"));
    for EACH(child, node, "MbxProtocols") {
        cm1e_ec_reference_t *protocol = CM1E_APPEND(reader->arena, &slave->protocols);
        *protocol = reference(reader, child);
    }
    slave->controller = reference(reader, field(reader, node, "EscCfgIndex"));
    slave->commands = reference(reader, field(reader, node, "SdoInitCmdIndex"));
    slave->rx_pdo = reference(reader, field(reader, node, "RxPdoIndex"));
    slave->tx_pdo = reference(reader, field(reader, node, "TxPdoIndex"));
}

static void read_profile(cm1e_xml_reader_t *reader, cm1e_ec_profile_t *profile, const xmlNode *node)
{
    profile->place = cm1e_xml_line(node);
    profile->index = need_number(reader, node, "Index", MAX_INDEX);
    profile->vendor_id = need_number(reader, node, "Vid", MAX_U32);
    profile->product_code = need_number(reader, node, "Pid", MAX_U32);
    profile->revision = need_number(reader, node, "Rev", MAX_U32);
    profile->drive_profile = number(reader, node, "ProfileIndex", MAX_U32);
    profile->name = text(reader, field(reader, node, "Name"));
    profile->slave = reference(reader, needed(reader, node, "SlvCfgIndex"));
}

static void read_vendor(cm1e_xml_reader_t *reader, cm1e_ec_vendor_t *vendor, const xmlNode *node)
{
    vendor->place = cm1e_xml_line(node);
    vendor->vendor_id = need_number(reader, node, "Vid", MAX_U32);
    vendor->name = text(reader, field(reader, node, "Name"));
}

static void read_lists(cm1e_xml_reader_t *reader, cm1e_ec_extend_t *document, const xmlNode *root)
{
    for EACH(node, field(reader, root, "RxPdos"), "RxPdo")
        read_pdo(reader, CM1E_APPEND(reader->arena, &document->rx_pdos), node);
    for EACH(node, field(reader, root, "TxPdos"), "TxPdo")
        read_pdo(reader, CM1E_APPEND(reader->arena, &document->tx_pdos), node);
    for EACH(node, field(reader, root, "SdoInitCmds"), "SdoInitCmd")
        read_commands(reader, CM1E_APPEND(reader->arena, &document->commands), node);
    for EACH(node, field(reader, root, "EscCfgs"), "EscCfg")
        read_controller(reader, CM1E_APPEND(reader->arena, &document->controllers), node);
    for EACH(node, field(reader, root, "SlvCfgs"), "SlvCfg")
        read_slave(reader, CM1E_APPEND(reader->arena, &document->slaves), node);
    for EACH(node, field(reader, root, "Profiles"), "Profile")
        read_profile(reader, CM1E_APPEND(reader->arena, &document->profiles), node);
    for EACH(node, field(reader, root, "Vendors"), "Vendor")
        read_vendor(reader, CM1E_APPEND(reader->arena, &document->vendors), node);
}

cm1e_error_t cm1e_ec_extend_read(cm1e_ec_extend_t *document, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    cm1e_diag_t own = {0};
    cm1e_xml_reader_t reader = {.arena = &document->arena, .diag = diag ? diag : &own};
    xmlDoc *doc = cm1e_xml_parse(bytes, size, reader.diag);
    if (!doc)
        return reader.diag->error;
    document->doc = doc;
    const xmlNode *root = xmlDocGetRootElement(doc);
    if (!cm1e_xml_is(root, "EtherCAT"))
        cm1e_xml_fail(&reader, root, "the root element is <%s>; that of an EC_EXTEND is <EtherCAT>",
                      (const char *)root->name);
    for (const xmlNode *node = doc->children; node; node = node->next)
        if (node->type != XML_ELEMENT_NODE && node->type != XML_COMMENT_NODE)
            cm1e_xml_fail(&reader, root,
                          "beside <EtherCAT>: an EC_EXTEND has elements, texts and comments, nothing else");
    if (!reader.failed)
        check_shape(&reader, root);
    if (!reader.failed)
        read_lists(&reader, document, root);
    if (!reader.failed && document->arena.failed)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    return reader.failed ? CM1E_ERROR_FILE : CM1E_OK;
}
