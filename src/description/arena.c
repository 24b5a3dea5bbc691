#include "description/arena.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_BYTES = 16384, ALIGNMENT = 16, FIRST_ITEMS = 4 };

struct cm1e_arena_block {
    cm1e_arena_block_t *next;
    size_t size, used;
    _Alignas(ALIGNMENT) uint8_t memory[];
};

/* The sink of all arenas: its contents are never read. */
static _Alignas(ALIGNMENT) _Thread_local uint8_t sink[CM1E_ARENA_SINK];

void cm1e_arena_free(cm1e_arena_t *arena)
{
    for (cm1e_arena_block_t *block = arena->blocks, *next; block; block = next) {
        next = block->next;
        free(block);
    }
    *arena = (cm1e_arena_t){0};
}

static cm1e_arena_block_t *new_block(cm1e_arena_t *arena, size_t size)
{
    const size_t room = size > BLOCK_BYTES ? size : BLOCK_BYTES;
    if (arena->failed || room > CM1E_ARENA_LIMIT - arena->used)
        return NULL;
    cm1e_arena_block_t *block = malloc(sizeof *block + room);
    if (!block)
        return NULL;
    block->size = room;
    block->used = 0;
    block->next = arena->blocks;
    arena->blocks = block;
    arena->used += room;
    return block;
}

void *cm1e_arena_take(cm1e_arena_t *arena, size_t size)
{
    const size_t padded = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    cm1e_arena_block_t *block = arena->blocks;
    if (padded >= size && (!block || padded > block->size - block->used))
        block = new_block(arena, padded);
    if (padded < size || !block) {
        arena->failed = true;
        memset(sink, 0, sizeof sink);
        return sink;
    }
    void *taken = memset(block->memory + block->used, 0, size);
    block->used += padded;
    return taken;
}

const uint8_t *cm1e_arena_bytes(cm1e_arena_t *arena, const void *bytes, size_t size)
{
    if (size == 0)
        return NULL;
    uint8_t *copy = cm1e_arena_take(arena, size);
    return arena->failed ? NULL : memcpy(copy, bytes, size);
}

const char *cm1e_arena_text(cm1e_arena_t *arena, const char *text)
{
    if (!text)
        return NULL;
    const char *copy = (const char *)cm1e_arena_bytes(arena, text, strlen(text) + 1);
    return copy ? copy : "";
}

const char *cm1e_arena_format(cm1e_arena_t *arena, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    const int length = vsnprintf(NULL, 0, format, arguments);
    char *text = length < 0 ? NULL : cm1e_arena_take(arena, (size_t)length + 1);
    if (text && !arena->failed)
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    va_end(arguments);
    return text && !arena->failed ? text : "";
}

/* The room of a list is the power of two not below its count, and at least FIRST_ITEMS. */
void *cm1e_arena_grow(cm1e_arena_t *arena, void *items, size_t count, size_t item_size)
{
    const bool full = count == 0 || (count >= FIRST_ITEMS && (count & (count - 1)) == 0);
    if (!full)
        return items;
    const size_t room = count == 0 ? FIRST_ITEMS : 2 * count;
    if (room > CM1E_ARENA_LIMIT / item_size) {
        arena->failed = true;
        return items;
    }
    void *grown = cm1e_arena_take(arena, room * item_size);
    if (arena->failed)
        return items;
    if (count > 0)
        memcpy(grown, items, count * item_size);
    return grown;
}
