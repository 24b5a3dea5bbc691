/**
 * @file history.h
 * The last records of something, in a ring: one thread writes and never waits, any number of others read at the same
 * time. A reader sees by the number of a record whether it was overwritten meanwhile, and how many it has missed.
 *
 * The ring is a plain array of words, so that it may lie in a struct that is zeroed: an array of zeros is an empty
 * ring. A record is a struct of whole words whose first member is its number, a uint64_t; the ring counts from 1.
 */
#ifndef CM1E_CORE_HISTORY_H
#define CM1E_CORE_HISTORY_H

#include <stddef.h>
#include <stdint.h>

/** The words of a ring: the number of the newest record, then the records. */
#define CM1E_HISTORY_WORDS(records, type) (1 + (records) * (sizeof(type) / sizeof(uint64_t)))

typedef struct cm1e_history_shape {
    uint32_t records; /**< so many are kept */
    uint32_t words;   /**< of one record */
} cm1e_history_shape_t;
#define CM1E_HISTORY_SHAPE(records, type) ((cm1e_history_shape_t){(records), sizeof(type) / sizeof(uint64_t)})

/** The number of the newest record; 0: there was none. @rt any */
uint64_t cm1e_history_last(const uint64_t *ring);
/** Adds a copy of the record, with the next number. The writer only. @rt cycle */
void cm1e_history_add(uint64_t *ring, cm1e_history_shape_t shape, const void *record);
/** The next record gets the number after `last`: the one before it was not kept here. The writer only. @rt cycle */
void cm1e_history_go_on_after(uint64_t *ring, uint64_t last);
/** Copies the records after the one with number `after` (0: all that there are), oldest first, at most `room`. Returns
 *  how many there are in `records`; their numbers have no gap. `*lost`, if not NULL, is the number of those after
 *  `after` that are no longer kept. @rt any */
size_t cm1e_history_copy(const uint64_t *ring, cm1e_history_shape_t shape, uint64_t after, void *records, size_t room,
                         uint64_t *lost);

#endif
