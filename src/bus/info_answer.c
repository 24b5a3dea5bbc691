#include "bus/info_answer.h"

#include <string.h>

#include "core/bytes.h"
#include "core/text.h"

/* Bytes before the name: of an object, of an entry. */
enum { OBJECT_BYTES = 6, ENTRY_BYTES = 10 };

bool cm1e_info_take_list(uint16_t *indexes, size_t room, size_t *count, const uint8_t *answer, size_t size)
{
    if (size < 2 || size % 2 != 0 || (size - 2) / 2 > room)
        return false;
    *count = (size - 2) / 2;
    for (size_t i = 0; i < *count; i++)
        indexes[i] = cm1e_get_u16(answer + 2 + 2 * i);
    return true;
}

bool cm1e_info_take_object(cm1e_object_info_t *info, const uint8_t *answer, size_t size)
{
    if (size < OBJECT_BYTES)
        return false;
    *info = (cm1e_object_info_t){
        .index = cm1e_get_u16(answer),
        .data_type = cm1e_get_u16(answer + 2),
        .highest_subindex = answer[4],
        .code = answer[5],
    };
    cm1e_text_of_device(info->name, sizeof info->name, answer + OBJECT_BYTES, size - OBJECT_BYTES);
    return true;
}

/** Reads a value of `bytes` bytes at `*place`; NULL: the answer has ended. A value that is too long is skipped. */
static const uint8_t *take_value(cm1e_info_value_t *value, const uint8_t *place, const uint8_t *end, size_t bytes)
{
    if (!place || (size_t)(end - place) < bytes)
        return NULL;
    if (bytes <= sizeof value->bytes) {
        value->size = (uint8_t)bytes;
        memcpy(value->bytes, place, bytes);
    }
    return place + bytes;
}

bool cm1e_info_take_entry(cm1e_entry_info_t *info, const uint8_t *answer, size_t size)
{
    if (size < ENTRY_BYTES)
        return false;
    *info = (cm1e_entry_info_t){
        .index = cm1e_get_u16(answer),
        .subindex = answer[2],
        .data_type = cm1e_get_u16(answer + 4),
        .bits = cm1e_get_u16(answer + 6),
        .access = cm1e_get_u16(answer + 8),
    };
    const uint8_t told = answer[3], *place = answer + ENTRY_BYTES, *end = answer + size;
    const size_t bytes = (info->bits + 7u) / 8u;
    cm1e_info_value_t unit = {0};
    if (told & INFO_VALUE_UNIT)
        place = take_value(&unit, place, end, sizeof info->unit);
    if (told & INFO_VALUE_DEFAULT)
        place = take_value(&info->default_value, place, end, bytes);
    if (told & INFO_VALUE_MINIMUM)
        place = take_value(&info->minimum, place, end, bytes);
    if (told & INFO_VALUE_MAXIMUM)
        place = take_value(&info->maximum, place, end, bytes);
    if (!place)
        return false;
    info->unit_given = unit.size > 0;
    info->unit = cm1e_get_u32(unit.bytes);
    cm1e_text_of_device(info->name, sizeof info->name, place, (size_t)(end - place));
    return true;
}
