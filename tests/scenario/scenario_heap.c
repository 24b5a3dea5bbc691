/* The heap of a scenario: allocations are counted, one of them can fail, and what is not freed is found. */
#include <string.h>

#include "scenario_private.h"

enum { PLACES = 1 << 14 };

static uint64_t allocations, fails_at;
static bool tracking;
static void *places[PLACES]; /**< what was allocated since tracking began and is not free, at its hash or behind it */

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void __real_free(void *memory);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void __wrap_free(void *memory);

static size_t place_of(const void *memory)
{
    size_t at = ((uintptr_t)memory >> 4) % PLACES;
    for (size_t tries = 0; tries < PLACES && places[at] && places[at] != memory; tries++)
        at = (at + 1) % PLACES;
    return at;
}

static void *note(void *memory)
{
    if (tracking && memory)
        places[place_of(memory)] = memory;
    return memory;
}

/** Those behind it move up, so that each is found from its hash. */
static void forget(const void *memory)
{
    size_t at = place_of(memory);
    if (!tracking || !memory || !places[at])
        return;
    places[at] = NULL;
    for (at = (at + 1) % PLACES; places[at]; at = (at + 1) % PLACES) {
        void *other = places[at];
        places[at] = NULL;
        places[place_of(other)] = other;
    }
}

/** Whether this allocation is the one that fails. */
static bool fails(void) { return ++allocations == fails_at; }

void *__wrap_malloc(size_t size) { return fails() ? NULL : note(__real_malloc(size)); }

void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : note(__real_calloc(count, size)); }

void *__wrap_realloc(void *memory, size_t size)
{
    if (fails())
        return NULL;
    forget(memory);
    return note(__real_realloc(memory, size));
}

void __wrap_free(void *memory)
{
    forget(memory);
    __real_free(memory);
}

uint64_t heap_allocations(void) { return allocations; }

void heap_track(uint64_t failing)
{
    memset(places, 0, sizeof places);
    tracking = true;
    fails_at = allocations + failing;
}

bool heap_failed(void) { return allocations >= fails_at; }

int heap_left(void)
{
    int left = 0;
    for (int i = 0; i < PLACES; i++)
        left += places[i] != NULL;
    tracking = false;
    fails_at = 0;
    return left;
}
