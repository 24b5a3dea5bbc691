#include <string.h>

#include "core/bytes.h"
#include "sim/coe_server.h"
#include "sim/esc_chip.h"

/* SDO information (ETG.1000.6 5.6.3). Layout behind the CoE header. */
enum { AT_OPCODE = 2, AT_FRAGMENTS = 4, AT_DATA = 6, OPCODE = 0x7F, INCOMPLETE = 0x80 };
enum {
    GET_LIST = 1, LIST = 2, GET_OBJECT = 3, OBJECT = 4, GET_ENTRY = 5, ENTRY = 6, INFORMATION_ERROR = 7,
};
enum {
    LIST_LENGTHS = 0, LIST_ALL = 1, LIST_RXPDO = 2, LIST_TXPDO = 3, LIST_BACKUP = 4, LIST_SETTINGS = 5, LIST_TYPES = 6,
};
enum { SDO_INFORMATION = 8 << 12 };
enum { INFO_UNIT = 0x08, INFO_DEFAULT = 0x10, INFO_MINIMUM = 0x20, INFO_MAXIMUM = 0x40, INFO_ALWAYS = 0x07 };

static void answer_begin(mailbox_message_t *answer, uint8_t opcode, uint16_t fragments_left)
{
    cm1e_put_u16(answer->data, SDO_INFORMATION);
    answer->data[AT_OPCODE] = (uint8_t)(opcode | (fragments_left ? INCOMPLETE : 0));
    answer->data[AT_OPCODE + 1] = 0;
    cm1e_put_u16(answer->data + AT_FRAGMENTS, fragments_left);
    answer->length = AT_DATA;
}

static void answer_error(mailbox_message_t *answer, uint32_t code)
{
    answer_begin(answer, INFORMATION_ERROR, 0);
    cm1e_put_u32(answer->data + AT_DATA, code);
    answer->length = AT_DATA + 4;
}

static void append_u16(mailbox_message_t *answer, unsigned value)
{
    cm1e_put_u16(answer->data + answer->length, (uint16_t)value);
    answer->length += 2;
}

/* A name at the end of the message; what does not fit is cut off. */
static void append_name(mailbox_message_t *answer, const char *name, size_t room)
{
    const size_t length = name ? strlen(name) : 0, fits = room - answer->length;
    const size_t n = length < fits ? length : fits;
    memcpy(answer->data + answer->length, name ? name : "", n);
    answer->length = (uint16_t)(answer->length + n);
}

/* ---- lists ----------------------------------------------------------------------------------------------------- */

static bool has_access(const cm1e_object_t *object, uint8_t access)
{
    for (unsigned i = 0; i < object->entry_count; i++)
        if (object->entries[i].access & access)
            return true;
    return false;
}

static bool in_list(const cm1e_object_t *object, uint16_t type)
{
    switch (type) {
    case LIST_ALL:
        return true;
    case LIST_RXPDO:
        return has_access(object, CM1E_ACCESS_RXPDO);
    case LIST_TXPDO:
        return has_access(object, CM1E_ACCESS_TXPDO);
    default: /* the device says of no object that it must be stored or set at start-up */
        return false;
    }
}

static const cm1e_object_t *next_in_list(cm1e_sim_slave_t *slave, uint16_t type, size_t *n)
{
    const cm1e_object_t *object;
    while (slave->ops->object && (object = slave->ops->object(slave->app, *n)) != NULL) {
        ++*n;
        if (in_list(object, type) && !cm1e_sim_profile_hides(slave, object->index, 0))
            return object;
    }
    return NULL;
}

static unsigned list_length(cm1e_sim_slave_t *slave, uint16_t type)
{
    unsigned count = 0;
    for (size_t n = 0; next_in_list(slave, type, &n);)
        count++;
    return count;
}

static void append_indices(cm1e_sim_slave_t *slave, mailbox_message_t *answer, size_t room)
{
    coe_server_t *coe = &slave->coe;
    const cm1e_object_t *object;
    while (answer->length + 2u <= room && (object = next_in_list(slave, coe->list_type, &coe->list_object)) != NULL)
        append_u16(answer, object->index);
    if (coe->fragments_left == 0)
        coe->list_type = 0;
    else
        coe->fragments_left--;
}

static void get_list(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                     size_t room)
{
    const uint16_t type = length < AT_DATA + 2 ? LIST_TYPES : cm1e_get_u16(request + AT_DATA);
    if (type >= LIST_TYPES) {
        answer_error(answer, SDO_ABORT_UNSUPPORTED_ACCESS);
        return;
    }
    if (type == LIST_LENGTHS) {
        answer_begin(answer, LIST, 0);
        append_u16(answer, type);
        /* NOLINTNEXTLINE(bugprone-too-small-loop-variable): LIST_TYPES is below 10 */
        for (uint16_t t = LIST_ALL; t < LIST_TYPES; t++)
            append_u16(answer, list_length(slave, t));
        return;
    }
    /* The list type and all indices in a row, cut where a mailbox ends. */
    const unsigned words = 1 + list_length(slave, type), words_per_fragment = (unsigned)(room - AT_DATA) / 2;
    slave->coe.list_type = type;
    slave->coe.list_object = 0;
    slave->coe.fragments_sent = 0;
    slave->coe.fragments_left = (uint16_t)((words + words_per_fragment - 1) / words_per_fragment - 1);
    if (slave->coe.fragments_left < slave->quirks.info_fragments) /* of those that never come */
        slave->coe.fragments_left = (uint16_t)slave->quirks.info_fragments;
    answer_begin(answer, LIST, slave->coe.fragments_left);
    append_u16(answer, type);
    append_indices(slave, answer, room);
}

bool cm1e_sim_coe_next_fragment(cm1e_sim_slave_t *slave, mailbox_message_t *answer, size_t room)
{
    if (slave->coe.list_type == 0)
        return false;
    if (room > sizeof answer->data)
        room = sizeof answer->data;
    answer->type = MAILBOX_TYPE_COE;
    if (++slave->coe.fragments_sent == slave->quirks.info_fragments) {
        slave->coe.list_type = 0;
        answer_error(answer, SDO_ABORT_GENERAL);
        return true;
    }
    answer_begin(answer, LIST, slave->coe.fragments_left);
    append_indices(slave, answer, room);
    return true;
}

/* ---- descriptions ---------------------------------------------------------------------------------------------- */

/* Types of records (ETG.1020, ETG.1000.6 table 64): a mapping, an identity; of arrays that of their elements. */
static uint16_t object_type(cm1e_sim_slave_t *slave, const cm1e_object_t *object)
{
    enum { PDO_MAPPING = 0x0021, IDENTITY = 0x0023 };
    if (object->object_code != CM1E_OBJECT_RECORD) {
        const cm1e_entry_t *entry =
            cm1e_sim_coe_entry(slave, object->index, object->object_code == CM1E_OBJECT_VAR ? 0 : 1);
        return entry ? (uint16_t)entry->type : 0;
    }
    const uint16_t area = object->index & 0xFE00;
    return object->index == OBJ_1018_IDENTITY ? IDENTITY : area == 0x1600 || area == 0x1A00 ? PDO_MAPPING : 0;
}

static void get_object(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                       size_t room)
{
    const cm1e_object_t *object =
        length < AT_DATA + 2 ? NULL : cm1e_sim_coe_object(slave, cm1e_get_u16(request + AT_DATA));
    if (!object) {
        answer_error(answer, SDO_ABORT_NO_OBJECT);
        return;
    }
    answer_begin(answer, OBJECT, 0);
    append_u16(answer, object->index);
    append_u16(answer, object_type(slave, object));
    append_u16(answer, object->highest_subindex | (unsigned)object->object_code << 8);
    append_name(answer, object->name, room);
}

/* Object access (ETG.1000.6 table 46): read in three states, write in three states, mappable. */
static unsigned object_access(const cm1e_entry_t *entry)
{
    unsigned access = 0;
    if (entry->access & CM1E_ACCESS_READ)
        access |= 0x0007;
    if (entry->access & CM1E_ACCESS_WRITE)
        access |= entry->access & CM1E_ACCESS_WRITE_PREOP_ONLY ? 0x0008 : 0x0038;
    if (entry->access & CM1E_ACCESS_RXPDO)
        access |= 0x0040;
    if (entry->access & CM1E_ACCESS_TXPDO)
        access |= 0x0080;
    return access;
}

static void append_value(mailbox_message_t *answer, const cm1e_entry_t *entry, int64_t value)
{
    const unsigned bytes = (entry->bits + 7u) / 8u;
    cm1e_put_uint(answer->data + answer->length, bytes, (uint64_t)value);
    answer->length = (uint16_t)(answer->length + bytes);
}

static void get_entry(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                      size_t room)
{
    enum { NUMBER_MAX_BITS = 32 };
    if (length < AT_DATA + 4) {
        answer_error(answer, SDO_ABORT_NO_OBJECT);
        return;
    }
    const uint16_t index = cm1e_get_u16(request + AT_DATA);
    const uint8_t subindex = request[AT_DATA + 2];
    const cm1e_entry_t *entry = cm1e_sim_coe_entry(slave, index, subindex);
    if (!entry || !cm1e_sim_coe_object(slave, index)) {
        answer_error(answer, cm1e_sim_coe_object(slave, index) ? SDO_ABORT_NO_SUBINDEX : SDO_ABORT_NO_OBJECT);
        return;
    }
    /* Of what the master asks for, numbers have the values and nothing has a unit in the tables. */
    const bool number = entry->type != CM1E_TYPE_STRING && entry->bits <= NUMBER_MAX_BITS;
    const uint8_t values = number ? request[AT_DATA + 3] & (INFO_DEFAULT | INFO_MINIMUM | INFO_MAXIMUM) : 0;
    answer_begin(answer, ENTRY, 0);
    append_u16(answer, index);
    append_u16(answer, subindex | (unsigned)(INFO_ALWAYS | values) << 8);
    append_u16(answer, entry->type);
    append_u16(answer, entry->bits);
    append_u16(answer, object_access(entry));
    if (values & INFO_DEFAULT)
        append_value(answer, entry, entry->default_value);
    if (values & INFO_MINIMUM)
        append_value(answer, entry, entry->minimum);
    if (values & INFO_MAXIMUM)
        append_value(answer, entry, entry->maximum);
    append_name(answer, entry->name, room);
}

void cm1e_sim_coe_info(cm1e_sim_slave_t *slave, const uint8_t *request, size_t length, mailbox_message_t *answer,
                       size_t room)
{
    switch (request[AT_OPCODE] & OPCODE) {
    case GET_LIST:
        get_list(slave, request, length, answer, room);
        break;
    case GET_OBJECT:
        get_object(slave, request, length, answer, room);
        break;
    case GET_ENTRY:
        get_entry(slave, request, length, answer, room);
        break;
    default:
        answer_error(answer, SDO_ABORT_UNSUPPORTED_ACCESS);
        break;
    }
}
