/* Rules about what an ENI's cyclic frames carry, and where it lies in the images of the master. */
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "generate/eni.h"
#include "generate/eni_registers.h"

typedef struct fmmu {
    const cm1e_eni_command_t *command; /* NULL: this one is not set */
    const cm1e_eni_command_t *carrier; /* the cyclic command that carries the whole of it; NULL: none does */
    const cm1e_eni_device_t *device;
    uint64_t logical, end;
    uint16_t length, physical;
    uint8_t start_bit, type;
} fmmu_t;

typedef CM1E_LIST(fmmu_t) fmmu_list_t;

/* What the InitCmds leave in the FMMUs of a slave in Operational. */
static void read_fmmus(fmmu_t fmmus[FMMUS], const cm1e_eni_device_t *device)
{
    memset(fmmus, 0, FMMUS * sizeof fmmus[0]);
    for (size_t i = 0; i < device->commands.count; i++) {
        const cm1e_eni_command_t *command = &device->commands.at[i];
        const uint8_t *data = command->data.data;
        unsigned n;
        if (!(command->transitions & (CM1E_ENI_IP | CM1E_ENI_PS | CM1E_ENI_SO)) ||
            !cm1e_eni_sets(command, FMMU, FMMU_BYTES, &n) || !(data[12] & 1))
            continue;
        fmmus[n] = (fmmu_t){.command = command, .device = device, .logical = cm1e_get_u32(data),
                            .length = cm1e_get_u16(data + 4), .start_bit = data[6] & 7,
                            .physical = cm1e_get_u16(data + 8), .type = data[11]};
        fmmus[n].end = fmmus[n].logical + fmmus[n].length;
    }
}

static bool moves(uint8_t code, uint8_t type)
{
    return code == CM1E_ENI_LRW || (type == FMMU_READ ? code == CM1E_ENI_LRD : code == CM1E_ENI_LWR);
}

static const cm1e_eni_command_t *carrier(const cm1e_eni_t *document, const fmmu_t *fmmu)
{
    for (size_t c = 0; c < document->cyclics.count; c++)
        for (size_t f = 0; f < document->cyclics.at[c].frames.count; f++) {
            const cm1e_eni_frame_t *frame = &document->cyclics.at[c].frames.at[f];
            for (size_t i = 0; i < frame->commands.count; i++) {
                const cm1e_eni_command_t *command = &frame->commands.at[i];
                if (cm1e_eni_is_logical(command->code) && moves(command->code, fmmu->type & (FMMU_READ | FMMU_WRITE)) &&
                    command->address <= fmmu->logical && fmmu->end <= (uint64_t)command->address + command->length)
                    return command;
            }
        }
    return NULL;
}

/* ---- FMMUs ------------------------------------------------------------------------------------------------------ */

/* Whether a sync manager of the FMMU's direction holds what it maps. */
static bool held(const cm1e_description_t *described, const fmmu_t *fmmu)
{
    const cm1e_sync_manager_use_t use = fmmu->type == FMMU_WRITE ? CM1E_SM_OUTPUTS : CM1E_SM_INPUTS;
    for (size_t i = 0; i < described->sync_managers.count; i++) {
        const cm1e_described_sync_manager_t *manager = &described->sync_managers.at[i];
        if (manager->use == use && manager->start <= fmmu->physical &&
            fmmu->physical + fmmu->length <= manager->start + manager->length)
            return true;
    }
    return false;
}

static void check_fmmu(cm1e_findings_t *findings, const cm1e_description_t *described, const fmmu_t *fmmu)
{
    const cm1e_place_t place = fmmu->command->place;
    const char *name = fmmu->device->name;
    if ((fmmu->type != FMMU_READ && fmmu->type != FMMU_WRITE) || fmmu->length == 0) {
        cm1e_findings_add(findings, CM1E_RULE_ENI_FMMU, place,
                          "%s: an FMMU of type %u and %u bytes; 1 is for inputs, 2 for outputs.", name, fmmu->type,
                          fmmu->length);
        return;
    }
    if (fmmu->physical >= REGISTERS_END && !held(described, fmmu))
        cm1e_findings_add(findings, CM1E_RULE_ENI_FMMU, place,
                          "%s: an FMMU maps 0x%04X ... 0x%04X, which no sync manager for %s holds.", name,
                          fmmu->physical, (unsigned)fmmu->physical + fmmu->length - 1,
                          fmmu->type == FMMU_WRITE ? "outputs" : "inputs");
    if (!fmmu->carrier)
        cm1e_findings_add(findings, CM1E_RULE_ENI_FMMU, place,
                          "%s: no cyclic command for %s carries the logical addresses 0x%08llX ... 0x%08llX.", name,
                          fmmu->type == FMMU_WRITE ? "outputs" : "inputs", (unsigned long long)fmmu->logical,
                          (unsigned long long)fmmu->end - 1);
}

/* ---- images ----------------------------------------------------------------------------------------------------- */

/* Where a slave's data begin in the image, by the frame that carries its first FMMU of that direction. By InputOffs and
 * OutputOffs some mean the datagram, others its data: see eni.h. */
static void check_place(cm1e_findings_t *findings, const cm1e_eni_device_t *device, const fmmu_t *fmmus, uint8_t type)
{
    const cm1e_eni_range_t *range = type == FMMU_WRITE ? &device->send : &device->receive;
    const fmmu_t *first = NULL;
    for (int n = 0; n < FMMUS; n++)
        if (fmmus[n].command && fmmus[n].type == type && fmmus[n].physical >= REGISTERS_END &&
            (!first || fmmus[n].logical < first->logical))
            first = &fmmus[n];
    if (!(type == FMMU_WRITE ? device->has_send : device->has_receive) || !first || !first->carrier)
        return;
    const int64_t offset = type == FMMU_WRITE ? first->carrier->output_offset : first->carrier->input_offset;
    const int64_t bit = (offset + (int64_t)first->logical - first->carrier->address) * 8 + first->start_bit;
    if (offset != CM1E_ENI_NOT_GIVEN && range->start != bit && range->start != bit + CM1E_ENI_DATAGRAM_HEADER * 8)
        cm1e_findings_add(findings, CM1E_RULE_ENI_IMAGE_PLACE, range->place,
                          "%s: BitStart of %s is %u, but its frame brings them to bit %lld (or %lld, where the image "
                          "holds the datagrams' headers too).",
                          device->name, type == FMMU_WRITE ? "Send" : "Recv", (unsigned)range->start, (long long)bit,
                          (long long)bit + CM1E_ENI_DATAGRAM_HEADER * 8);
}

/* A range of an image, in bits. */
typedef struct stretch {
    uint64_t start, end;
    cm1e_place_t place;
    const char *name;
} stretch_t;

static int by_start(const void *left, const void *right)
{
    const stretch_t *a = left, *b = right;
    if (a->start != b->start)
        return a->start < b->start ? -1 : 1;
    return a->place < b->place ? -1 : a->place > b->place;
}

static void check_stretches(cm1e_findings_t *findings, stretch_t *stretches, size_t count, const char *image,
                            uint64_t image_bits, bool has_image)
{
    qsort(stretches, count, sizeof stretches[0], by_start);
    for (size_t i = 0; i < count; i++) {
        const stretch_t *stretch = &stretches[i];
        if (has_image && stretch->end > image_bits)
            cm1e_findings_add(findings, CM1E_RULE_ENI_IMAGE_RANGE, stretch->place,
                              "%s: bits %llu to %llu; the image of %s has %llu.", stretch->name,
                              (unsigned long long)stretch->start, (unsigned long long)stretch->end, image,
                              (unsigned long long)image_bits);
        if (i > 0 && stretch->start < stretches[i - 1].end)
            cm1e_findings_add(findings, CM1E_RULE_ENI_IMAGE_OVERLAP, stretch->place,
                              "%s begins at bit %llu of the image of %s, within %s in line %u.", stretch->name,
                              (unsigned long long)stretch->start, image, stretches[i - 1].name,
                              (unsigned)stretches[i - 1].place);
    }
}

static size_t command_count(const cm1e_eni_t *document)
{
    size_t count = 0;
    for (size_t c = 0; c < document->cyclics.count; c++)
        for (size_t f = 0; f < document->cyclics.at[c].frames.count; f++)
            count += document->cyclics.at[c].frames.at[f].commands.count;
    return count;
}

static size_t stretches_of_slaves(stretch_t *stretches, const cm1e_eni_t *document, bool send)
{
    size_t count = 0;
    for (size_t i = 0; i < document->devices.count; i++) {
        const cm1e_eni_device_t *device = &document->devices.at[i];
        const cm1e_eni_range_t *range = send ? &device->send : &device->receive;
        if ((send ? device->has_send : device->has_receive) && range->length > 0)
            stretches[count++] = (stretch_t){range->start, (uint64_t)range->start + range->length, range->place,
                                             device->name};
    }
    return count;
}

static size_t stretches_of_commands(stretch_t *stretches, const cm1e_eni_t *document, bool send)
{
    size_t count = 0;
    for (size_t c = 0; c < document->cyclics.count; c++)
        for (size_t f = 0; f < document->cyclics.at[c].frames.count; f++) {
            const cm1e_eni_command_list_t *list = &document->cyclics.at[c].frames.at[f].commands;
            for (size_t i = 0; i < list->count; i++) {
                const cm1e_eni_command_t *command = &list->at[i];
                const int64_t offset = send ? command->output_offset : command->input_offset;
                if (!cm1e_eni_is_logical(command->code) || !moves(command->code, send ? FMMU_WRITE : FMMU_READ) ||
                    offset == CM1E_ENI_NOT_GIVEN || command->length == 0)
                    continue;
                stretches[count++] = (stretch_t){(uint64_t)offset * 8, ((uint64_t)offset + command->length) * 8,
                                                 command->place, "The process data of a cyclic command"};
            }
        }
    return count;
}

static int by_name(const void *left, const void *right)
{
    const cm1e_eni_variable_t *const *a = left, *const *b = right;
    const int order = strcmp((*a)->name, (*b)->name);
    return order != 0 ? order : (*a)->place < (*b)->place ? -1 : (*a)->place > (*b)->place;
}

/* TwinCAT's diagnosis of the network is behind the image, in an area of its own that ByteSize leaves out. */
static bool is_diagnosis(const char *name)
{
    return strncmp(name, "InfoData.", 9) == 0 || strstr(name, ".InfoData.") != NULL;
}

static void check_variables(cm1e_findings_t *findings, const cm1e_eni_image_t *image, const char *name)
{
    const cm1e_eni_variable_t **sorted = calloc(image->variables.count + 1, sizeof(const cm1e_eni_variable_t *));
    findings->arena.failed |= !sorted;
    for (size_t i = 0; i < image->variables.count; i++) {
        const cm1e_eni_variable_t *variable = &image->variables.at[i];
        if ((uint64_t)variable->offset + variable->bits > (uint64_t)image->bytes * 8 && !is_diagnosis(variable->name))
            cm1e_findings_add(findings, CM1E_RULE_ENI_IMAGE_RANGE, variable->place,
                              "%s ends at bit %llu; the image of %s has %llu.", variable->name,
                              (unsigned long long)variable->offset + variable->bits, name,
                              (unsigned long long)image->bytes * 8);
        if (sorted)
            sorted[i] = variable;
    }
    if (sorted)
        qsort(sorted, image->variables.count, sizeof sorted[0], by_name);
    for (size_t i = 1; sorted && i < image->variables.count; i++)
        if (strcmp(sorted[i]->name, sorted[i - 1]->name) == 0)
            cm1e_findings_add(findings, CM1E_RULE_ENI_VARIABLE_TWICE, sorted[i]->place,
                              "%s is the name of the variable in line %u too.", sorted[i]->name,
                              (unsigned)sorted[i - 1]->place);
    free(sorted);
}

static void check_image(cm1e_findings_t *findings, const cm1e_eni_t *document, bool send)
{
    const cm1e_eni_image_t *image = send ? &document->outputs : &document->inputs;
    const char *name = send ? "outputs" : "inputs";
    stretch_t *stretches = calloc(document->devices.count + command_count(document) + 1, sizeof *stretches);
    findings->arena.failed |= !stretches;
    if (stretches) {
        check_stretches(findings, stretches, stretches_of_slaves(stretches, document, send), name,
                        (uint64_t)image->bytes * 8, document->has_image);
        check_stretches(findings, stretches, stretches_of_commands(stretches, document, send), name,
                        (uint64_t)image->bytes * 8, document->has_image);
    }
    free(stretches);
    check_variables(findings, image, name);
}

/* ---- frames ----------------------------------------------------------------------------------------------------- */

/* Contribution of one slave to the working counter of a logical command. */
static uint64_t count_of(uint8_t code, bool reads, bool writes)
{
    if (code == CM1E_ENI_LRW)
        return (reads ? LRW_INPUTS : 0u) + (writes ? LRW_OUTPUTS : 0u);
    return code == CM1E_ENI_LRD ? reads : writes;
}

/* Contribution of all slaves in Operational. The FMMUs of a slave are adjacent in the list. */
static uint64_t expected_count(const cm1e_eni_command_t *command, const fmmu_list_t *fmmus)
{
    const uint64_t end = (uint64_t)command->address + command->length;
    uint64_t count = 0;
    bool reads = false, writes = false;
    for (size_t i = 0; i < fmmus->count; i++) {
        const fmmu_t *fmmu = &fmmus->at[i];
        if (i > 0 && fmmu->device != fmmus->at[i - 1].device) {
            count += count_of(command->code, reads, writes);
            reads = writes = false;
        }
        if (fmmu->logical < end && fmmu->end > command->address) {
            reads |= (fmmu->type & FMMU_READ) != 0;
            writes |= (fmmu->type & FMMU_WRITE) != 0;
        }
    }
    return count + count_of(command->code, reads, writes);
}

static void check_command(cm1e_findings_t *findings, const cm1e_eni_t *document, const cm1e_eni_command_t *command,
                          const fmmu_list_t *fmmus)
{
    const bool states = command->code == CM1E_ENI_BRD && command->ado == AL_STATUS;
    if (command->count == CM1E_ENI_NOT_GIVEN || (!states && !cm1e_eni_is_logical(command->code)))
        return;
    const uint64_t count = states ? document->devices.count : expected_count(command, fmmus);
    if (count != (uint64_t)command->count)
        cm1e_findings_add(findings, CM1E_RULE_ENI_WORKING_COUNTER, command->place,
                          "Cnt is %d; %s count up to %llu.", (int)command->count,
                          states ? "all slaves" : "the slaves with FMMUs there (outputs 2, inputs 1 in LRW, else 1)",
                          (unsigned long long)count);
}

static void check_frame(cm1e_findings_t *findings, const cm1e_eni_t *document, const cm1e_eni_frame_t *frame,
                        const fmmu_list_t *fmmus)
{
    uint64_t bytes = 0;
    for (size_t i = 0; i < frame->commands.count; i++) {
        bytes += CM1E_ENI_DATAGRAM_OVERHEAD + frame->commands.at[i].length;
        check_command(findings, document, &frame->commands.at[i], fmmus);
    }
    if (bytes > CM1E_ENI_FRAME_BYTES)
        cm1e_findings_add(findings, CM1E_RULE_ENI_FRAME, frame->place,
                          "The datagrams of this frame have %llu bytes; an Ethernet frame holds %d.",
                          (unsigned long long)bytes, CM1E_ENI_FRAME_BYTES);
}

/* Checks the FMMUs of a slave and adds them to the list of all. */
static void check_device(cm1e_findings_t *findings, const cm1e_eni_t *document, const cm1e_eni_device_t *device,
                         cm1e_arena_t *arena, fmmu_list_t *all)
{
    fmmu_t fmmus[FMMUS];
    cm1e_arena_t own = {0};
    const cm1e_description_t described = cm1e_eni_describe(&own, device);
    read_fmmus(fmmus, device);
    for (int n = 0; n < FMMUS && !own.failed; n++) {
        if (!fmmus[n].command)
            continue;
        fmmus[n].carrier = carrier(document, &fmmus[n]);
        check_fmmu(findings, &described, &fmmus[n]);
        *(fmmu_t *)CM1E_APPEND(arena, all) = fmmus[n];
    }
    findings->arena.failed |= own.failed;
    cm1e_arena_free(&own);
    check_place(findings, device, fmmus, FMMU_WRITE);
    check_place(findings, device, fmmus, FMMU_READ);
}

void cm1e_eni_check_frames(cm1e_findings_t *findings, const cm1e_eni_t *document)
{
    cm1e_arena_t arena = {0};
    fmmu_list_t fmmus = {0};
    for (size_t d = 0; d < document->devices.count; d++)
        check_device(findings, document, &document->devices.at[d], &arena, &fmmus);
    for (size_t c = 0; c < document->cyclics.count && !arena.failed; c++)
        for (size_t f = 0; f < document->cyclics.at[c].frames.count; f++)
            check_frame(findings, document, &document->cyclics.at[c].frames.at[f], &fmmus);
    findings->arena.failed |= arena.failed;
    cm1e_arena_free(&arena);
    check_image(findings, document, true);
    check_image(findings, document, false);
}
