/* Counts what a bench takes from the heap: the linker leads the calls here (CMakeLists.txt). */
#include <stddef.h>

#include "blocks_cm1e.h"

static size_t heap;
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

void *__wrap_malloc(size_t size)
{
    heap += size;
    return __real_malloc(size);
}
void *__wrap_calloc(size_t count, size_t size)
{
    heap += count * size;
    return __real_calloc(count, size);
}
void *__wrap_realloc(void *memory, size_t size)
{
    heap += size;
    return __real_realloc(memory, size);
}
void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    heap += size;
    return __real_aligned_alloc(alignment, size);
}
size_t blocks_heap_bytes(void) { return heap; }
