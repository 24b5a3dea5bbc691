/**
 * @file st_memory.h
 * An arena that all parts of a translation live in, and a map from names to these parts. Names are compared without
 * regard to case, as IEC 61131-3 wants. If memory runs out, the translation ends with that error: no caller tests for
 * it.
 */
#ifndef CM1E_ST_MEMORY_H
#define CM1E_ST_MEMORY_H

#include <stddef.h>

#include "cm1e/api.h"

typedef struct arena arena_t;
typedef struct map map_t;

arena_t *cm1e_st_arena_new(void);
void cm1e_st_arena_free(arena_t *arena);
/** Zeroed memory. */
void *cm1e_st_take(arena_t *arena, size_t size);
char *cm1e_st_copy(arena_t *arena, const char *text, size_t length);
char *cm1e_st_format(arena_t *arena, const char *format, ...) CM1E_PRINTF(2, 3);

map_t *cm1e_st_map_new(arena_t *arena);
/** NULL: there is no such name. */
void *cm1e_st_map_get(const map_t *map, const char *name);
void cm1e_st_map_put(map_t *map, const char *name, void *value);
/** Calls `visit` for every name, in the order in which they were put. */
void cm1e_st_map_each(const map_t *map, void (*visit)(const char *name, void *value, void *context), void *context);

#endif
