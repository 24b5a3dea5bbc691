/**
 * @file expand.h
 * A modular device (ETG.5001) with modules in its slots, as one flat description: objects, PDOs and start-up commands
 * of each module moved by the increments of its slot. Any thread.
 */
#ifndef CM1E_DESCRIPTION_EXPAND_H
#define CM1E_DESCRIPTION_EXPAND_H

#include "description/description.h"

/** Maximum number of places; further places stay empty. */
#define CM1E_PLACES_MAX 256

/** Places for modules: every slot as often as it may be there (MaxInstances), at most CM1E_PLACES_MAX. */
size_t cm1e_description_places(const cm1e_description_t *device);
/** The slot that a place belongs to; NULL: there is no such place. */
const cm1e_slot_t *cm1e_description_place(const cm1e_description_t *device, size_t place);
/** The module with that ident; NULL: the file has none. */
const cm1e_module_t *cm1e_description_module(const cm1e_description_file_t *file, uint32_t ident);
/** The default module of each of `count` places; 0: none. */
void cm1e_description_default_modules(const cm1e_description_t *device, uint32_t *idents, size_t count);
/** Makes the device with the module `idents[n]` in place n; with 0, or a module that the file lacks, that place is
 *  empty. Parts that do not depend on the slot are shared with `device`; the result has no slots. */
void cm1e_description_expand(cm1e_arena_t *arena, cm1e_description_t *expanded, const cm1e_description_file_t *file,
                             const cm1e_description_t *device, const uint32_t *idents, size_t count);

#endif
