#include "bus/mapping.h"

#include <stddef.h>
#include <string.h>

#include "core/bytes.h"

static const uint16_t assign_index[2] = {OBJ_1C12_RXPDO_ASSIGN, OBJ_1C13_TXPDO_ASSIGN};
enum { SDO_TIMEOUT_NS = 1000000000, DIRECTION_BITS_MAX = 8 * 1024 };
static const uint32_t abort_no_subindex = 0x06090011;

void cm1e_mapping_begin(cm1e_mapping_job_t *job, uint16_t position, const cm1e_pdo_choice_t *choice)
{
    *job = (cm1e_mapping_job_t){.step = choice->count ? MAPPING_CLEAR : MAPPING_READ_COUNT, .choice = *choice,
                                .assigned = *choice, .sdo = {.position = position}};
}

void cm1e_mapping_begin_any(cm1e_mapping_job_t *job, uint16_t position, bool swapped)
{
    *job = (cm1e_mapping_job_t){.step = MAPPING_READ_COUNT, .any = true, .swapped = swapped,
                                .sdo = {.position = position}};
}

static void end(cm1e_mapping_job_t *job, cm1e_error_t error, const char *reason)
{
    job->step = MAPPING_IDLE;
    job->error = error;
    job->reason = reason;
}

/** Ends the job because the slave shows another assignment. If the slave refused a write, that refusal is reported,
 *  because it says more. */
static void end_wrong_assignment(cm1e_mapping_job_t *job, const char *reason)
{
    if (job->is_refused)
        job->sdo = job->refused;
    end(job, job->is_refused ? CM1E_ERROR_SDO_ABORT : CM1E_ERROR_PDO_MAPPING, reason);
}

/** Fills the transfer of the present step. */
static cm1e_sdo_t *prepare(cm1e_mapping_job_t *job)
{
    if (job->step == MAPPING_IDLE)
        return NULL; /* the last transfer stays readable */
    const uint16_t position = job->sdo.position, pdo = job->assigned.pdos[job->direction][job->place];
    const bool write = job->step <= MAPPING_COUNT;
    job->sdo = (cm1e_sdo_t){.position = position, .index = assign_index[job->direction ^ (int)job->swapped],
                            .write = write,
                            .data = job->data, .size = write ? 1 : sizeof job->data, .timeout_ns = SDO_TIMEOUT_NS,
                            .state = CM1E_SDO_BUSY};
    switch (job->step) {
    case MAPPING_IDLE:
        break;
    case MAPPING_CLEAR:
        job->data[0] = 0;
        break;
    case MAPPING_ASSIGN:
        cm1e_put_u16(job->data, pdo);
        job->sdo.subindex = (uint8_t)(job->place + 1);
        job->sdo.size = 2;
        break;
    case MAPPING_COUNT:
        job->data[0] = job->assigned.count;
        break;
    case MAPPING_READ_COUNT:
        break;
    case MAPPING_READ_PDO:
        job->sdo.subindex = (uint8_t)(job->place + 1);
        break;
    case MAPPING_READ_ENTRIES:
        job->sdo.index = pdo;
        break;
    case MAPPING_READ_ENTRY:
        job->sdo.index = pdo;
        job->sdo.subindex = job->entry;
        break;
    }
    job->started = true;
    return &job->sdo;
}

/** Repeats the step for the next PDO, or goes to `next` with the first PDO. */
static void next_pdo(cm1e_mapping_job_t *job, cm1e_mapping_step_t next)
{
    if (++job->place < job->assigned.count)
        return;
    job->place = 0;
    job->step = next;
}

static void next_direction(cm1e_mapping_job_t *job)
{
    if (job->direction == 0) {
        job->direction = 1;
        /* Both directions are written before the first is read: the slave may check them together. */
        job->step = job->step <= MAPPING_COUNT ? MAPPING_CLEAR : MAPPING_READ_COUNT;
    } else if (job->step <= MAPPING_COUNT) {
        job->direction = 0;
        job->step = MAPPING_READ_COUNT;
    } else {
        end(job, CM1E_OK, NULL);
    }
}

static void read_next_pdo(cm1e_mapping_job_t *job)
{
    if (job->place + 1 < job->assigned.count) {
        job->place++;
        job->step = MAPPING_READ_ENTRIES;
    } else {
        job->place = 0;
        next_direction(job);
    }
}

static void took_entry(cm1e_mapping_job_t *job)
{
    cm1e_mapped_direction_t *mapped = &job->mapped[job->direction];
    const uint32_t value = cm1e_get_u32(job->data);
    const uint8_t bits = (uint8_t)value;
    if (value != 0) { /* else a row that is not used */
        if (mapped->entry_count >= CM1E_MAPPED_ENTRIES || bits == 0 || mapped->bits + bits > DIRECTION_BITS_MAX) {
            end(job, CM1E_ERROR_PDO_MAPPING, "its PDO has too many entries or an entry of no bits");
            return;
        }
        mapped->entries[mapped->entry_count++] =
            (cm1e_mapped_entry_t){.index = (uint16_t)(value >> 16), .subindex = (uint8_t)(value >> 8), .bits = bits,
                                  .bit_offset = mapped->bits};
        mapped->bits = (uint16_t)(mapped->bits + bits);
    }
    if (job->entry < job->entries)
        job->entry++;
    else if (mapped->bits == 0 && !job->any)
        end(job, CM1E_ERROR_PDO_MAPPING, "its PDO is empty");
    else
        read_next_pdo(job);
}

/** Takes the number of PDOs that the device has assigned itself. */
static void take_count(cm1e_mapping_job_t *job)
{
    job->assigned.count = job->data[0];
    if (job->assigned.count == 0 && job->any)
        next_direction(job);
    else if (job->assigned.count == 0)
        end(job, CM1E_ERROR_PDO_MAPPING, "it has no PDO assigned; name PDOs in the bus file");
    else if (job->assigned.count > CM1E_ASSIGNED_PDOS)
        end(job, CM1E_ERROR_PDO_MAPPING, "it has more PDOs assigned than are understood; name PDOs in the bus file");
}

/** Takes what a transfer has read. */
static void took(cm1e_mapping_job_t *job)
{
    switch (job->step) {
    case MAPPING_IDLE:
        break;
    case MAPPING_CLEAR:
        job->step = MAPPING_ASSIGN;
        break;
    case MAPPING_ASSIGN:
        next_pdo(job, MAPPING_COUNT);
        break;
    case MAPPING_COUNT:
        next_direction(job);
        break;
    case MAPPING_READ_COUNT:
        job->step = MAPPING_READ_PDO;
        if (job->choice.count == 0)
            take_count(job);
        else if (job->data[0] != job->choice.count)
            end_wrong_assignment(job, "it assigns another number of PDOs than was written");
        break;
    case MAPPING_READ_PDO:
        if (job->choice.count == 0)
            job->assigned.pdos[job->direction][job->place] = cm1e_get_u16(job->data);
        if (cm1e_get_u16(job->data) != job->assigned.pdos[job->direction][job->place])
            end_wrong_assignment(job, "it did not keep the assigned PDO");
        else
            next_pdo(job, MAPPING_READ_ENTRIES);
        break;
    case MAPPING_READ_ENTRIES:
        job->entries = job->data[0];
        job->entry = 1;
        job->step = MAPPING_READ_ENTRY;
        if (job->entries == 0 && job->any)
            read_next_pdo(job);
        else if (job->entries == 0)
            end(job, CM1E_ERROR_PDO_MAPPING, "its PDO is empty");
        break;
    case MAPPING_READ_ENTRY:
        took_entry(job);
        break;
    }
}

/** Behind the first row: sub-index 0 states more rows than there are, as the tables of UG 7.2 do. The slave checks the
 *  size of its process data on the way to Safe-Operational. */
static bool no_more_rows(const cm1e_mapping_job_t *job)
{
    return job->step == MAPPING_READ_ENTRY && job->entry > 1 && job->sdo.error == CM1E_ERROR_SDO_ABORT &&
           job->sdo.abort_code == abort_no_subindex;
}

/** Whether the job may go on after a transfer. A refused write is no error yet, because what is read back decides. A
 *  slave may have no object for its assignment. */
static bool may_go_on(cm1e_mapping_job_t *job)
{
    if (no_more_rows(job)) {
        memset(job->data, 0, sizeof job->data);
        job->entries = job->entry;
        return true;
    }
    if (job->any && job->step == MAPPING_READ_COUNT && job->sdo.error == CM1E_ERROR_SDO_ABORT) {
        job->unknown++;
        job->data[0] = 0;
        return true;
    }
    if (!job->sdo.write || job->sdo.error != CM1E_ERROR_SDO_ABORT)
        return false;
    if (!job->is_refused)
        job->refused = job->sdo;
    job->is_refused = true;
    return true;
}

cm1e_sdo_t *cm1e_mapping_next(cm1e_mapping_job_t *job)
{
    if (job->started) {
        job->started = false;
        const size_t wanted = job->step == MAPPING_READ_ENTRY ? 4 : job->step == MAPPING_READ_PDO ? 2 : 1;
        if (cm1e_sdo_state(&job->sdo) == CM1E_SDO_ERROR && !may_go_on(job))
            end(job, job->sdo.error, NULL);
        else if (!job->sdo.write && job->sdo.size < wanted)
            end(job, CM1E_ERROR_PDO_MAPPING, "an entry of its PDO mapping is too short");
        else
            took(job);
    }
    return prepare(job);
}

bool cm1e_mapping_equal(const cm1e_mapped_direction_t *a, const cm1e_mapped_direction_t *b)
{
    if (a->bits != b->bits || a->entry_count != b->entry_count)
        return false;
    for (unsigned i = 0; i < a->entry_count; i++) {
        const cm1e_mapped_entry_t *x = &a->entries[i], *y = &b->entries[i];
        if (x->index != y->index || x->subindex != y->subindex || x->bits != y->bits)
            return false;
    }
    return true;
}

const cm1e_mapped_entry_t *cm1e_mapping_find(const cm1e_mapped_direction_t *direction, uint16_t index,
                                             uint8_t subindex)
{
    for (unsigned i = 0; i < direction->entry_count; i++) {
        const cm1e_mapped_entry_t *entry = &direction->entries[i];
        const bool whole = entry->bit_offset % 8 == 0 && entry->bits % 8 == 0 && entry->bits <= 32;
        if (index && entry->index == index && entry->subindex == subindex && whole)
            return entry;
    }
    return NULL;
}
