/**
 * @file arena.h
 * Memory of one file that is read or written: allocated piece by piece, freed at once. Callers need not check for NULL:
 * when memory ends, `failed` is set, later allocations return a sink, and the owner of the arena checks once, at the
 * end. One thread at a time.
 */
#ifndef CM1E_DESCRIPTION_ARENA_H
#define CM1E_DESCRIPTION_ARENA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** An arena never grows beyond this, whatever a file says. */
#define CM1E_ARENA_LIMIT ((size_t)256 << 20)
#define CM1E_ARENA_SINK 4096

typedef struct cm1e_arena_block cm1e_arena_block_t;

/** Valid when zeroed. */
typedef struct cm1e_arena {
    cm1e_arena_block_t *blocks;
    size_t used;      /**< bytes in all */
    bool failed;      /**< an allocation failed: the data in the arena is incomplete */
} cm1e_arena_t;

/** Frees everything; the arena is then empty and valid. @rt init */
void cm1e_arena_free(cm1e_arena_t *arena);
/** `size` zeroed bytes, aligned for anything; `size` at most CM1E_ARENA_SINK, or check `failed` before use. @rt init */
void *cm1e_arena_take(cm1e_arena_t *arena, size_t size);
/** A copy of `size` bytes; NULL where there is no memory, and where `size` is 0. @rt init */
const uint8_t *cm1e_arena_bytes(cm1e_arena_t *arena, const void *bytes, size_t size);
/** A copy of a text; NULL stays NULL. "" where there is no memory. @rt init */
const char *cm1e_arena_text(cm1e_arena_t *arena, const char *text);
/** A text made as printf does. "" where there is no memory. @rt init */
const char *cm1e_arena_format(cm1e_arena_t *arena, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** An array that grows: `at[0]` ... `at[count - 1]`. Valid when zeroed. */
#define CM1E_LIST(type)                                                                                             \
    struct {                                                                                                        \
        type *at;                                                                                                   \
        size_t count;                                                                                               \
    }
/** Pointer to a new zeroed item at the end of a list; valid until the next one is appended. */
#define CM1E_APPEND(arena, list)                                                                                    \
    ((list)->at = cm1e_arena_grow((arena), (list)->at, (list)->count, sizeof *(list)->at),                          \
     (arena)->failed ? cm1e_arena_take((arena), sizeof *(list)->at) : (void *)&(list)->at[(list)->count++])
/** For CM1E_APPEND. */
void *cm1e_arena_grow(cm1e_arena_t *arena, void *items, size_t count, size_t item_size);

#endif
