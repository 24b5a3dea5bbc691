#include "description/description.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* CoE data types by name: ETG.1020 "Base data types". `bits` 0: the length stands in brackets behind the name. */
static const struct {
    const char *name;
    uint16_t code;
    uint32_t bits;
    uint32_t element_bits; /* of what stands in brackets */
} base_types[] = {
    {"BOOL", 0x01, 1, 0}, {"BOOLEAN", 0x01, 1, 0}, {"SINT", 0x02, 8, 0}, {"INT", 0x03, 16, 0}, {"DINT", 0x04, 32, 0},
    {"USINT", 0x05, 8, 0}, {"UINT", 0x06, 16, 0}, {"UDINT", 0x07, 32, 0}, {"REAL", 0x08, 32, 0},
    {"STRING", 0x09, 0, 8}, {"OCTET_STRING", 0x0A, 0, 8},
    {"UNICODE_STRING", 0x0B, 0, 16}, {"TIME_OF_DAY", 0x0C, 48, 0}, {"TIME_DIFFERENCE", 0x0D, 48, 0},
    {"INT24", 0x10, 24, 0}, {"LREAL", 0x11, 64, 0}, {"INT40", 0x12, 40, 0}, {"INT48", 0x13, 48, 0},
    {"INT56", 0x14, 56, 0}, {"LINT", 0x15, 64, 0}, {"UINT24", 0x16, 24, 0}, {"UINT40", 0x18, 40, 0},
    {"UINT48", 0x19, 48, 0}, {"UINT56", 0x1A, 56, 0}, {"ULINT", 0x1B, 64, 0}, {"GUID", 0x1D, 128, 0},
    {"BYTE", 0x1E, 8, 0}, {"WORD", 0x1F, 16, 0}, {"DWORD", 0x20, 32, 0},
    {"BITARR8", 0x2D, 8, 0}, {"BITARR16", 0x2E, 16, 0}, {"BITARR32", 0x2F, 32, 0},
    {"BIT1", 0x30, 1, 0}, {"BIT2", 0x31, 2, 0}, {"BIT3", 0x32, 3, 0}, {"BIT4", 0x33, 4, 0}, {"BIT5", 0x34, 5, 0},
    {"BIT6", 0x35, 6, 0}, {"BIT7", 0x36, 7, 0}, {"BIT8", 0x37, 8, 0},
};
/* "ARRAY [0..n] OF ..." of them, which are one value too. */
static const struct {
    const char *element;
    uint16_t code;
    uint32_t bits;
} array_types[] = {
    {"BYTE", 0x0A, 8}, {"UINT", 0x0B, 16}, {"INT", 0x0260, 16}, {"SINT", 0x0261, 8}, {"DINT", 0x0262, 32},
    {"UDINT", 0x0263, 32},
};
enum { ARRAY_TYPES = sizeof array_types / sizeof array_types[0] };
enum { BASE_TYPES = sizeof base_types / sizeof base_types[0], LONGEST_STRING = 65535 };

void cm1e_description_file_free(cm1e_description_file_t *file)
{
    cm1e_arena_free(&file->arena);
    *file = (cm1e_description_file_t){0};
}

void cm1e_description_init(cm1e_description_t *device)
{
    *device = (cm1e_description_t){
        .type = "", .name = "", .group = "",
        .dpram_bytes = -1, .sync_managers_available = -1, .fmmus_available = -1,
        .timeouts = {-1, -1, -1, -1, -1, -1},
    };
}

const cm1e_described_object_t *cm1e_description_object(const cm1e_description_t *device, uint16_t index)
{
    for (size_t i = 0; i < device->objects.count; i++)
        if (device->objects.at[i].index == index)
            return &device->objects.at[i];
    return NULL;
}

const cm1e_described_entry_t *cm1e_description_entry(const cm1e_description_t *device, uint16_t index, uint8_t subindex)
{
    const cm1e_described_object_t *object = cm1e_description_object(device, index);
    for (size_t i = 0; object && i < object->entries.count; i++)
        if (object->entries.at[i].subindex == subindex)
            return &object->entries.at[i];
    return NULL;
}

cm1e_described_pdo_t *cm1e_pdo_find(const cm1e_pdo_list_t *list, uint16_t index)
{
    for (size_t i = 0; i < list->count; i++)
        if (list->at[i].index == index)
            return &list->at[i];
    return NULL;
}

const cm1e_described_pdo_t *cm1e_description_pdo(const cm1e_description_t *device, uint16_t index)
{
    return cm1e_pdo_find(&device->pdos, index);
}

const char *cm1e_pdo_kind(const cm1e_described_pdo_t *pdo)
{
    return pdo->transmit ? "TxPDO" : "RxPDO";
}

uint32_t cm1e_pdo_bits(const cm1e_described_pdo_t *pdo)
{
    uint32_t bits = 0;
    for (size_t i = 0; i < pdo->entries.count; i++)
        bits += pdo->entries.at[i].bits;
    return bits;
}

uint32_t cm1e_description_process_bytes(const cm1e_description_t *device, unsigned sync_manager)
{
    uint32_t bits = 0;
    for (size_t i = 0; i < device->pdos.count; i++)
        if (device->pdos.at[i].sync_manager == (int)sync_manager)
            bits += cm1e_pdo_bits(&device->pdos.at[i]);
    return (bits + 7) / 8;
}

/* Row of a base type; `*length` what stands in brackets behind its name, 0: nothing. -1: no base type. */
static int base_type(const char *name, uint32_t *length)
{
    const size_t letters = strcspn(name, "(");
    *length = 0;
    for (int i = 0; i < BASE_TYPES; i++) {
        if (strlen(base_types[i].name) != letters || strncmp(base_types[i].name, name, letters) != 0)
            continue;
        if (name[letters] == '\0')
            return i;
        if (base_types[i].element_bits == 0 || !isdigit((unsigned char)name[letters + 1]))
            return -1;
        char *end;
        const unsigned long number = strtoul(name + letters + 1, &end, 10);
        if (number > LONGEST_STRING || strcmp(end, ")") != 0)
            return -1;
        *length = (uint32_t)number;
        return i;
    }
    return -1;
}

/* Row of "ARRAY [0..3] OF BYTE" with its number of elements; -1: no such name. */
static int array_type(const char *name, uint32_t *elements)
{
    static const char begin[] = "ARRAY [", end[] = "] OF ";
    if (strncmp(name, begin, sizeof begin - 1) != 0)
        return -1;
    char *at;
    const long first = strtol(name + sizeof begin - 1, &at, 10);
    if (strncmp(at, "..", 2) != 0)
        return -1;
    const long last = strtol(at + 2, &at, 10);
    if (strncmp(at, end, sizeof end - 1) != 0 || first < 0 || last > LONGEST_STRING)
        return -1;
    *elements = last < first ? 0 : (uint32_t)(last - first + 1);
    for (int i = 0; i < ARRAY_TYPES; i++)
        if (strcmp(array_types[i].element, at + sizeof end - 1) == 0)
            return i;
    return -1;
}

uint16_t cm1e_type_code(const char *name)
{
    uint32_t length;
    const int row = base_type(name, &length), array = array_type(name, &length);
    return row >= 0 ? base_types[row].code : array >= 0 ? array_types[array].code : 0;
}

uint32_t cm1e_type_bits(const char *name)
{
    uint32_t length;
    const int array = array_type(name, &length);
    if (array >= 0)
        return length * array_types[array].bits;
    const int row = base_type(name, &length);
    return row < 0 ? 0 : base_types[row].element_bits ? length * base_types[row].element_bits : base_types[row].bits;
}

const char *cm1e_type_name(cm1e_arena_t *arena, uint16_t code, uint32_t bits)
{
    for (int i = 0; i < BASE_TYPES; i++) {
        if (base_types[i].code != code)
            continue;
        if (base_types[i].element_bits == 0)
            return base_types[i].name;
        return cm1e_arena_format(arena, "%s(%u)", base_types[i].name, (unsigned)(bits / base_types[i].element_bits));
    }
    return NULL;
}

uint64_t cm1e_bytes_unsigned(cm1e_bytes_t bytes)
{
    uint64_t value = 0;
    for (size_t i = 0; i < bytes.size && i < sizeof value; i++)
        value |= (uint64_t)bytes.data[i] << (8 * i);
    return value;
}

int64_t cm1e_bytes_signed(cm1e_bytes_t bytes)
{
    const unsigned bits = 8 * (unsigned)(bytes.size < sizeof(int64_t) ? bytes.size : sizeof(int64_t));
    uint64_t value = cm1e_bytes_unsigned(bytes);
    if (bits > 0 && bits < 64 && value >> (bits - 1) & 1)
        value |= UINT64_MAX << bits;
    return (int64_t)value;
}

cm1e_bytes_t cm1e_bytes_of(cm1e_arena_t *arena, int64_t value, size_t bytes)
{
    uint8_t little_endian[sizeof value];
    for (size_t i = 0; i < sizeof little_endian; i++)
        little_endian[i] = (uint8_t)((uint64_t)value >> (8 * i));
    if (bytes > sizeof little_endian)
        bytes = sizeof little_endian;
    return (cm1e_bytes_t){cm1e_arena_bytes(arena, little_endian, bytes), bytes};
}
