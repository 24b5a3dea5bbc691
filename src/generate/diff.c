#include <stdio.h>
#include <string.h>

#include "cm1e/generate.h"
#include "core/in_task.h"
#include "description/compare.h"
#include "description/expand.h"
#include "description/sii_image.h"
#include "generate/ec_extend.h"
#include "generate/eni.h"
#include "generate/esi.h"
#include "generate/file.h"
#include "generate/live.h"

static bool is_product(const cm1e_description_t *described, const cm1e_description_t *live)
{
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): live is there without an error */
    return described->vendor_id == live->vendor_id && described->product_given &&
           described->product_code == live->product_code;
}

static cm1e_error_t not_described(const cm1e_description_t *live, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "the file does not describe a device of vendor 0x%08X, product "
                         /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): live is there without an error */
                         "0x%08X", (unsigned)live->vendor_id, (unsigned)live->product_code);
}

/** The device of that revision; otherwise the newest one before it, or the first. NULL: no such product. */
static const cm1e_description_t *choose(const cm1e_description_file_t *file, const cm1e_description_t *live)
{
    const cm1e_description_t *best = NULL;
    for (size_t i = 0; i < file->devices.count; i++) {
        const cm1e_description_t *device = &file->devices.at[i];
        if (!is_product(device, live))
            continue;
        if (device->revision == live->revision)
            return device;
        const bool older = device->revision < live->revision;
        if (!best || (older && (best->revision > live->revision || device->revision > best->revision)))
            best = device;
    }
    return best;
}

static void name_revisions(cm1e_findings_t *findings, const cm1e_description_file_t *file,
                           const cm1e_description_t *live, const cm1e_description_t *chosen)
{
    char revisions[256] = "";
    unsigned count = 0;
    for (size_t i = 0; i < file->devices.count; i++) {
        if (!is_product(&file->devices.at[i], live))
            continue;
        const size_t used = strlen(revisions);
        snprintf(revisions + used, sizeof revisions - used, "%s0x%08X", count++ ? ", " : "",
                 (unsigned)file->devices.at[i].revision);
    }
    if (count > 1 && chosen->revision != live->revision)
        cm1e_findings_add(findings, CM1E_RULE_DIFFERS_IDENTITY, chosen->identity_place,
                          "The file has no device of revision 0x%08X; it has %s. The findings below are about 0x%08X.",
                          (unsigned)live->revision, revisions, (unsigned)chosen->revision);
}

/* ---- modules ---------------------------------------------------------------------------------------------------- */

/** Maximum number of alternative modules of a slot that are compared. */
enum { CHOICES_MAX = 16 };

typedef struct modular {
    cm1e_arena_t arena;
    const cm1e_description_file_t *file;
    const cm1e_description_t *device;
    size_t places, count;
    uint32_t defaults[CM1E_PLACES_MAX];
    cm1e_description_t variants[1 + 2 * CHOICES_MAX];
} modular_t;

/** One more variant: in every place (or those that are filled when nobody chooses) choice number `n` of its slot. */
static void add_variant(modular_t *m, size_t n, bool in_every_place)
{
    uint32_t idents[CM1E_PLACES_MAX];
    for (size_t place = 0; place < m->places; place++) {
        const cm1e_slot_t *slot = cm1e_description_place(m->device, place);
        const bool filled = slot && slot->choices.count > 0 && (in_every_place || m->defaults[place]);
        idents[place] = filled ? slot->choices.at[n % slot->choices.count].ident : 0;
    }
    cm1e_description_expand(&m->arena, &m->variants[m->count++], m->file, m->device, idents, m->places);
}

static void compare_modular(cm1e_findings_t *findings, const cm1e_description_file_t *file,
                            const cm1e_description_t *device, const cm1e_description_t *live)
{
    modular_t m = {.file = file, .device = device, .places = cm1e_description_places(device)};
    size_t choices = 0;
    for (size_t i = 0; i < device->slots.count; i++)
        if (device->slots.at[i].choices.count > choices)
            choices = device->slots.at[i].choices.count;
    if (choices > CHOICES_MAX)
        choices = CHOICES_MAX;
    cm1e_description_default_modules(device, m.defaults, m.places);
    cm1e_description_expand(&m.arena, &m.variants[m.count++], file, device, m.defaults, m.places);
    for (size_t n = 0; n < choices; n++)
        add_variant(&m, n, false);
    const size_t compared = m.count;
    for (size_t n = 0; n < choices; n++)
        add_variant(&m, n, true);
    findings->arena.failed |= m.arena.failed;
    if (!m.arena.failed)
        cm1e_compare_variants(findings, m.variants, compared, m.count, live);
    cm1e_arena_free(&m.arena);
}

/* ---- formats ---------------------------------------------------------------------------------------------------- */

static cm1e_error_t diff_described(cm1e_findings_t *findings, cm1e_file_format_t format, const void *bytes, size_t size,
                                   const cm1e_description_t *live, cm1e_diag_t *diag)
{
    cm1e_description_file_t file = {0};
    cm1e_error_t error = format == CM1E_FILE_ESI ? cm1e_esi_read(&file, bytes, size, diag)
                                                 : cm1e_sii_read(&file, bytes, size, NULL, diag);
    const cm1e_description_t *device = error == CM1E_OK ? choose(&file, live) : NULL;
    if (device) {
        name_revisions(findings, &file, live, device);
        if (device->slots.count > 0)
            compare_modular(findings, &file, device, live);
        else
            cm1e_compare(findings, device, live);
    } else if (error == CM1E_OK) {
        error = not_described(live, diag);
    }
    cm1e_description_file_free(&file);
    return error;
}

static cm1e_error_t diff_ec_extend(cm1e_findings_t *findings, const void *bytes, size_t size,
                                   const cm1e_description_t *live, cm1e_diag_t *diag)
{
    cm1e_ec_extend_t document = {0};
    cm1e_error_t error = cm1e_ec_extend_read(&document, bytes, size, diag);
    bool found = false;
    for (size_t i = 0; error == CM1E_OK && i < document.profiles.count && !found; i++)
        found = document.profiles.at[i].vendor_id == live->vendor_id &&
                document.profiles.at[i].product_code == live->product_code;
    if (found)
        cm1e_ec_extend_compare(findings, &document, live);
    else if (error == CM1E_OK)
        error = not_described(live, diag);
    cm1e_ec_extend_free(&document);
    return error;
}

/* An ENI describes a whole network: reports slaves of one side behind the last slave that both have. */
static void compare_ends(cm1e_findings_t *findings, const cm1e_eni_t *document, uint16_t position, uint32_t slaves)
{
    const size_t described = document->devices.count;
    if (position == described && slaves > described)
        cm1e_findings_add(findings, CM1E_RULE_DIFFERS, document->devices.at[described - 1].place,
                          "The network of the file ends with this slave, number %zu; the real network has %u. A master "
                          "that uses the file refuses it.", described, (unsigned)slaves);
    for (size_t i = slaves; position == slaves && i < described; i++)
        cm1e_findings_add(findings, CM1E_RULE_DIFFERS, document->devices.at[i].place,
                          "The file has slave %zu, \"%s\" (vendor 0x%08X, product 0x%08X), here; the network ends with "
                          "slave %u.", i + 1, document->devices.at[i].name,
                          (unsigned)document->devices.at[i].vendor_id, (unsigned)document->devices.at[i].product_code,
                          (unsigned)slaves);
}

static cm1e_error_t diff_eni(cm1e_findings_t *findings, const void *bytes, size_t size, uint16_t position,
                             uint32_t slaves, const cm1e_description_t *live, cm1e_diag_t *diag)
{
    cm1e_eni_t document = {0};
    cm1e_error_t error = cm1e_eni_read(&document, bytes, size, diag);
    if (error == CM1E_OK && position > document.devices.count)
        error = cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "the file describes a network of %zu slaves, and none at "
                              "position %u", document.devices.count, position);
    if (error == CM1E_OK) {
        cm1e_eni_compare(findings, &document, position, live);
        compare_ends(findings, &document, position, slaves);
    }
    cm1e_eni_free(&document);
    return error;
}

static cm1e_error_t diff(cm1e_findings_t *findings, const void *bytes, size_t size, cm1e_bus_t *bus, uint16_t position,
                         cm1e_diag_t *diag)
{
    const cm1e_file_format_t format = cm1e_file_recognise(bytes, size);
    cm1e_description_file_t device = {0};
    cm1e_error_t error = format == CM1E_FILE_UNKNOWN ? cm1e_file_not_recognised(diag)
                                                     : cm1e_live_describe(&device, bus, position, findings, diag);
    if (error == CM1E_OK) {
        const cm1e_description_t *live = &device.devices.at[0];
        const uint32_t slaves = cm1e_bus_slave_count(bus);
        error = format == CM1E_FILE_ENI         ? diff_eni(findings, bytes, size, position, slaves, live, diag)
                : format == CM1E_FILE_EC_EXTEND ? diff_ec_extend(findings, bytes, size, live, diag)
                                                : diff_described(findings, format, bytes, size, live, diag);
    }
    cm1e_description_file_free(&device);
    return error;
}

cm1e_error_t cm1e_diff_file(cm1e_findings_t **findings, const void *bytes, size_t size, cm1e_bus_t *bus,
                            uint16_t position, cm1e_diag_t *diag)
{
    if (!findings || (!bytes && size > 0))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_diff_file() needs a place for the findings, "
                             "and the bytes of a file.");
    if (!bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_diff_file() needs a bus.");
    *findings = NULL;
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_diff_file()", "", diag);
    cm1e_findings_t *found = cm1e_findings_create();
    if (!found)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    return cm1e_findings_give(found, diff(found, bytes, size, bus, position, diag), findings, diag);
}
