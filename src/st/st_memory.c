#include "st_memory.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { BLOCK_BYTES = 65536, ALIGNMENT = 16, FIRST_SLOTS = 16 };

typedef struct block {
    struct block *next;
    size_t used, size;
    _Alignas(ALIGNMENT) unsigned char bytes[];
} block_t;

struct arena {
    block_t *blocks;
};

typedef struct entry {
    const char *name;
    void *value;
} entry_t;

/* Open addressing over an array of entries in the order of their addition. */
struct map {
    arena_t *arena;
    entry_t *entries;
    uint32_t *slots; /* number of the entry + 1; 0: free */
    size_t count, slot_count;
};

static void *or_end(void *memory)
{
    if (memory)
        return memory;
    fputs("cm1e st: there is no memory left\n", stderr);
    exit(EXIT_FAILURE);
}

arena_t *cm1e_st_arena_new(void) { return or_end(calloc(1, sizeof(arena_t))); }

void cm1e_st_arena_free(arena_t *arena)
{
    if (!arena)
        return;
    for (block_t *block = arena->blocks, *next; block; block = next) {
        next = block->next;
        free(block);
    }
    free(arena);
}

void *cm1e_st_take(arena_t *arena, size_t size)
{
    const size_t rounded = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    block_t *block = arena->blocks;
    if (!block || block->size - block->used < rounded) {
        const size_t bytes = rounded > BLOCK_BYTES ? rounded : BLOCK_BYTES;
        block = or_end(calloc(1, sizeof *block + bytes));
        block->size = bytes;
        block->next = arena->blocks;
        arena->blocks = block;
    }
    block->used += rounded;
    return block->bytes + block->used - rounded;
}

char *cm1e_st_copy(arena_t *arena, const char *text, size_t length)
{
    char *copy = cm1e_st_take(arena, length + 1);
    memcpy(copy, text, length);
    return copy;
}

char *cm1e_st_format(arena_t *arena, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(NULL, 0, format, values);
    va_end(values);
    char *text = cm1e_st_take(arena, (size_t)length + 1);
    va_start(values, format);
    vsnprintf(text, (size_t)length + 1, format, values);
    va_end(values);
    return text;
}

static size_t hash_of(const char *name)
{
    uint64_t hash = UINT64_C(14695981039346656037); /* FNV-1a */
    for (; *name; name++) {
        const unsigned char letter = (unsigned char)(*name >= 'a' && *name <= 'z' ? *name - 'a' + 'A' : *name);
        hash = (hash ^ letter) * UINT64_C(1099511628211);
    }
    return (size_t)hash;
}

map_t *cm1e_st_map_new(arena_t *arena)
{
    map_t *map = cm1e_st_take(arena, sizeof *map);
    map->arena = arena;
    return map;
}

/** The slot of a name: its own, or the free one where it would be. */
static uint32_t *slot_of(const map_t *map, const char *name)
{
    size_t at = hash_of(name) % map->slot_count;
    while (map->slots[at] && strcasecmp(map->entries[map->slots[at] - 1].name, name) != 0)
        at = (at + 1) % map->slot_count;
    return &map->slots[at];
}

void *cm1e_st_map_get(const map_t *map, const char *name)
{
    if (map->slot_count == 0)
        return NULL;
    const uint32_t slot = *slot_of(map, name);
    return slot ? map->entries[slot - 1].value : NULL;
}

static void grow(map_t *map)
{
    const size_t slots = map->slot_count ? map->slot_count * 2 : FIRST_SLOTS;
    entry_t *entries = cm1e_st_take(map->arena, slots * sizeof *entries);
    if (map->count)
        memcpy(entries, map->entries, map->count * sizeof *entries);
    map->entries = entries;
    map->slots = cm1e_st_take(map->arena, slots * sizeof *map->slots);
    map->slot_count = slots;
    for (size_t i = 0; i < map->count; i++)
        *slot_of(map, entries[i].name) = (uint32_t)(i + 1);
}

void cm1e_st_map_put(map_t *map, const char *name, void *value)
{
    if ((map->count + 1) * 2 > map->slot_count)
        grow(map);
    uint32_t *slot = slot_of(map, name);
    if (*slot == 0) {
        map->entries[map->count].name = name;
        *slot = (uint32_t)++map->count;
    }
    map->entries[*slot - 1].value = value;
}

void cm1e_st_map_each(const map_t *map, void (*visit)(const char *name, void *value, void *context), void *context)
{
    for (size_t i = 0; i < map->count; i++)
        visit(map->entries[i].name, map->entries[i].value, context);
}
