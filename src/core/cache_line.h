/**
 * @file cache_line.h
 * Memory that begins at a cache line, for what every cycle of every axis looks at: which members share a line is then
 * the same in every run.
 */
#ifndef CM1E_CORE_CACHE_LINE_H
#define CM1E_CORE_CACHE_LINE_H

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { CM1E_CACHE_LINE = 64 };

/** So many bytes, up to the end of their last cache line. @rt any */
static inline size_t cm1e_whole_cache_lines(size_t size)
{
    return (size + CM1E_CACHE_LINE - 1) / CM1E_CACHE_LINE * CM1E_CACHE_LINE;
}

/** Zeroed, to be given back by free(). NULL: there is none. @rt init */
static inline void *cm1e_cache_lines(size_t size)
{
    const size_t whole = cm1e_whole_cache_lines(size);
    void *memory = aligned_alloc(CM1E_CACHE_LINE, whole);
    return memory ? memset(memory, 0, whole) : NULL;
}

#endif
