/* The dictionary of a device that a profile describes: that of the tables, amended. */
#include <stdlib.h>

#include "cm1e/sdo_info.h"
#include "cm1e/sim.h"
#include "sim/store.h"

/* A dictionary that is built: objects in order of index, each with its entries in order of sub-index. */
typedef struct build {
    const cm1e_sim_store_t *from;
    const cm1e_sim_profile_t *profile;
    cm1e_sim_store_t to;
    size_t entry_count;
} build_t;

static const cm1e_sim_profile_entry_t *find(const cm1e_sim_profile_t *profile, uint16_t index, uint8_t subindex)
{
    for (size_t i = profile->entry_count; i > 0; i--)
        if (profile->entries[i - 1].index == index && profile->entries[i - 1].subindex == subindex)
            return &profile->entries[i - 1];
    return NULL;
}

/* A number of up to 64 bits, or a text; of other types the simulator knows nothing. */
static bool is_described(const cm1e_sim_profile_entry_t *told)
{
    enum { NUMBER_MAX_BITS = 64 };
    return told->described && !told->missing
           && (told->data_type == CM1E_TYPE_STRING || (told->bits > 0 && told->bits <= NUMBER_MAX_BITS));
}

/* The next index of the profile from `from` on that describes an entry; UINT32_MAX: none. */
static uint32_t next_index(const cm1e_sim_profile_t *profile, uint32_t from)
{
    uint32_t next = UINT32_MAX;
    for (size_t i = 0; i < profile->entry_count; i++)
        if (is_described(&profile->entries[i]) && profile->entries[i].index >= from && profile->entries[i].index < next)
            next = profile->entries[i].index;
    return next;
}

static uint8_t access_of(uint16_t told)
{
    uint8_t access = told & CM1E_INFO_READ_PREOP ? CM1E_ACCESS_READ : 0;
    if (told & (CM1E_INFO_WRITE_PREOP | CM1E_INFO_WRITE_OP))
        access |= CM1E_ACCESS_WRITE;
    if ((told & CM1E_INFO_WRITE_PREOP) && !(told & CM1E_INFO_WRITE_OP))
        access |= CM1E_ACCESS_WRITE_PREOP_ONLY;
    return (uint8_t)(access | (told & CM1E_INFO_RXPDO ? CM1E_ACCESS_RXPDO : 0)
                     | (told & CM1E_INFO_TXPDO ? CM1E_ACCESS_TXPDO : 0));
}

static void amend(cm1e_entry_t *entry, const cm1e_sim_profile_entry_t *told)
{
    if (is_described(told)) {
        entry->type = (cm1e_data_type_t)told->data_type;
        entry->bits = told->bits;
        entry->access = access_of(told->access);
    }
    if (told->has_default)
        entry->default_value = told->default_value;
    if (told->has_minimum)
        entry->minimum = told->minimum;
    if (told->has_maximum)
        entry->maximum = told->maximum;
    if (told->name[0])
        entry->name = told->name;
    if (told->text[0])
        entry->default_string = told->text;
    if (!entry->default_string)
        entry->default_string = ""; /* a number in the tables, a text in the device */
}

static void add_entry(build_t *build, const cm1e_entry_t *ours, const cm1e_sim_profile_entry_t *told, int64_t value)
{
    cm1e_sim_store_t *to = &build->to;
    cm1e_entry_t *entry = &to->own_entries[build->entry_count];
    *entry = ours ? *ours
                  /* cppcheck-suppress nullPointerRedundantCheck ; one of the two is there */
                  : (cm1e_entry_t){.index = told->index, .subindex = told->subindex, .name = "", .unit = "",
                                   .default_string = "", .minimum = INT64_MIN, .maximum = INT64_MAX};
    if (told && !told->missing)
        amend(entry, told);
    to->values[build->entry_count++] = ours ? value : entry->default_value;
}

static const cm1e_entry_t *entry_of(const build_t *build, const cm1e_object_t *ours, uint8_t subindex, int64_t *value)
{
    cm1e_sim_cell_t cell;
    if (!ours || cm1e_sim_store_find(build->from, ours->index, subindex, &cell) != 0)
        return NULL;
    *value = *cell.value;
    return cell.entry;
}

static void add_object(build_t *build, uint16_t index, const cm1e_object_t *ours)
{
    cm1e_sim_store_t *to = &build->to;
    cm1e_object_t *object = &to->own_objects[to->object_count];
    const size_t first = build->entry_count;
    uint8_t highest = 0;
    for (unsigned subindex = 0; subindex <= UINT8_MAX; subindex++) {
        int64_t value = 0;
        const cm1e_sim_profile_entry_t *told = find(build->profile, index, (uint8_t)subindex);
        const cm1e_entry_t *entry = entry_of(build, ours, (uint8_t)subindex, &value);
        if (!entry && (!told || !is_described(told)))
            continue;
        add_entry(build, entry, told, value);
        highest = (uint8_t)subindex;
    }
    *object = ours ? *ours
                   : (cm1e_object_t){.index = index, .object_code = highest ? CM1E_OBJECT_RECORD : CM1E_OBJECT_VAR,
                                     .name = to->own_entries[first].name};
    object->entries = &to->own_entries[first];
    object->entry_count = (uint16_t)(build->entry_count - first);
    if (highest > object->highest_subindex)
        object->highest_subindex = highest;
    object->since = CM1E_FIRMWARE_1_2_0;
    to->objects[to->object_count] = object;
    to->first_entry[to->object_count++] = (uint32_t)first;
}

static bool make_room(build_t *build)
{
    size_t entries = build->profile->entry_count;
    const size_t objects = build->from->object_count + build->profile->entry_count;
    for (size_t i = 0; i < build->from->object_count; i++)
        entries += build->from->objects[i]->entry_count;
    cm1e_sim_store_t *to = &build->to;
    to->firmware = build->from->firmware;
    to->profile = build->profile;
    to->objects = calloc(objects, sizeof *to->objects);
    to->first_entry = calloc(objects, sizeof *to->first_entry);
    to->values = calloc(entries, sizeof *to->values);
    to->own_objects = calloc(objects, sizeof *to->own_objects);
    to->own_entries = calloc(entries, sizeof *to->own_entries);
    return to->objects && to->first_entry && to->values && to->own_objects && to->own_entries;
}

/* The values of a whole number on the wire; false: the entry has none. */
static bool range_of(const cm1e_entry_t *entry, int64_t *least, int64_t *most)
{
    const bool is_signed = cm1e_sim_is_signed(entry->type), is_bool = entry->type == CM1E_TYPE_BOOL;
    const unsigned bits = is_bool && entry->bits < 8 ? 8 : entry->bits; /* a BOOL comes in a byte */
    const bool is_whole = is_signed || is_bool || entry->type == CM1E_TYPE_USINT || entry->type == CM1E_TYPE_UINT ||
                          entry->type == CM1E_TYPE_UDINT;
    if (!is_whole || bits == 0 || bits > 32)
        return false;
    *most = (INT64_C(1) << (bits - is_signed)) - 1;
    *least = is_signed ? -*most - 1 : 0;
    return true;
}

static cm1e_error_t check_numbers(const cm1e_sim_store_t *store, const cm1e_sim_profile_entry_t *told,
                                  cm1e_diag_t *diag)
{
    const struct {
        const char *key;
        bool given;
        int64_t value;
    } numbers[] = {{"default", told->has_default, told->default_value}, {"minimum", told->has_minimum, told->minimum},
                   {"maximum", told->has_maximum, told->maximum}, {"value", told->has_value, told->value}};
    int64_t least, most;
    cm1e_sim_cell_t cell;
    if (told->missing || cm1e_sim_store_find(store, told->index, told->subindex, &cell) != 0 ||
        !range_of(cell.entry, &least, &most))
        return CM1E_OK;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
        if (numbers[i].given && (numbers[i].value < least || numbers[i].value > most))
            return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "the profile gives 0x%04X:%02X the %s %lld, which its type "
                                 "does not have: %lld ... %lld", told->index, told->subindex, numbers[i].key,
                                 (long long)numbers[i].value, (long long)least, (long long)most);
    return CM1E_OK;
}

cm1e_error_t cm1e_sim_store_play(cm1e_sim_store_t *store, const cm1e_sim_profile_t *profile, cm1e_diag_t *diag)
{
    build_t build = {.from = store, .profile = profile};
    if (!make_room(&build)) {
        cm1e_sim_store_destroy(&build.to);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    }
    size_t n = 0;
    for (uint32_t told = next_index(profile, 0); n < store->object_count || told != UINT32_MAX;) {
        const cm1e_object_t *ours = n < store->object_count ? store->objects[n] : NULL;
        if (ours && ours->index <= told) {
            add_object(&build, ours->index, ours);
            n++;
        } else {
            ours = NULL;
            add_object(&build, (uint16_t)told, NULL);
        }
        if (build.to.own_objects[build.to.object_count - 1].index == told)
            told = next_index(profile, told + 1);
    }
    cm1e_error_t error = CM1E_OK;
    for (size_t i = 0; i < profile->entry_count && error == CM1E_OK; i++)
        error = check_numbers(&build.to, &profile->entries[i], diag);
    cm1e_sim_store_destroy(error == CM1E_OK ? store : &build.to);
    if (error == CM1E_OK)
        *store = build.to;
    return error;
}

void cm1e_sim_store_set_profile_values(cm1e_sim_store_t *store)
{
    const cm1e_sim_profile_t *profile = store->profile;
    for (size_t i = 0; profile && i < profile->entry_count; i++) {
        const cm1e_sim_profile_entry_t *entry = &profile->entries[i];
        if (entry->has_value)
            cm1e_sim_store_set(store, entry->index, entry->subindex, entry->value);
    }
}
