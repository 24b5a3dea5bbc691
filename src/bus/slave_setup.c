#include "bus/slave_setup.h"

#include "core/bytes.h"
#include "device/device.h"

enum { SDO_TIMEOUT_NS = 1000000000, COUNT_BYTES = 1, PDO_BYTES = 2, ENTRY_BYTES = 4 };
enum { CONFIGURED_MODULES = 0xF030 };
enum { TO_PARAMETER = 0x200, EXCLUDES = 6, NUMBER_BYTES = 8 }; /* 0x1800:06 is that of the PDO 0x1A00 (ETG.1000.6) */
/* ETG.1020: sub-indices, values for DC with SYNC0 and with SYNC1, and the bits of those in what is supported. */
enum { SYNC_TYPE = 1, SYNC_SUPPORTED = 4, SYNC_BYTES = 2, BY_SYNC0 = 2, BY_SYNC1 = 3, CAN_SYNC0 = 0x04,
       CAN_SYNC1 = 0x08 };

/** One transfer of the list. */
typedef struct step {
    uint16_t index;
    uint8_t subindex, bytes;
    bool check; /**< reads what was written; false: writes */
    bool optional; /**< a write that may be refused; then what follows, its check, is left out */
    bool asks;     /**< reads what the slave supports; it may be refused */
    bool excludes; /**< reads which PDOs the one in `value` excludes; a slave need not have that object */
    uint64_t value;
    const cm1e_sdo_config_t *sdo; /**< as the configuration states it; NULL: it is of a PDO */
} step_t;

/** Goes along the list until it is at the step that is looked for. */
typedef struct walk {
    unsigned left;
    step_t *step;
    bool check; /**< the steps are those that read */
    bool optional, asks, excludes, swapped;
} walk_t;

/** false: go on; true: this is the step. */
static bool visit(walk_t *walk, unsigned index, unsigned subindex, unsigned bytes, uint64_t value)
{
    if (walk->left-- > 0)
        return false;
    *walk->step = (step_t){.index = (uint16_t)index, .subindex = (uint8_t)subindex, .bytes = (uint8_t)bytes,
                           .check = walk->check, .optional = walk->optional, .asks = walk->asks,
                           .excludes = walk->excludes, .value = value};
    return true;
}

static bool walk_sdos(walk_t *walk, const cm1e_slave_config_t *config, bool before_op)
{
    for (unsigned i = 0; i < config->sdo_count; i++) {
        const cm1e_sdo_config_t *sdo = &config->sdos[i];
        if (sdo->before_op != before_op || !visit(walk, sdo->index, sdo->subindex, sdo->bytes, sdo->value))
            continue;
        walk->step->sdo = sdo;
        return true;
    }
    return false;
}

/** A PDO is emptied, filled and counted (ETG.1000.6 section 5.6.7); then read. */
static bool walk_mapping(walk_t *walk, const cm1e_slave_config_t *config)
{
    for (unsigned first = 0, end; first < config->entry_count; first = end) {
        const unsigned pdo = config->entries[first].pdo;
        for (end = first; end < config->entry_count && config->entries[end].pdo == pdo;)
            end++;
        if (!walk->check && visit(walk, pdo, 0, COUNT_BYTES, 0))
            return true;
        for (unsigned i = first; i < end; i++) {
            const cm1e_pdo_entry_config_t *entry = &config->entries[i];
            const uint32_t value = (uint32_t)entry->index << 16 | (uint32_t)entry->subindex << 8 | entry->bits;
            if (visit(walk, pdo, i - first + 1, ENTRY_BYTES, value))
                return true;
        }
        if (visit(walk, pdo, 0, COUNT_BYTES, end - first))
            return true;
    }
    return false;
}

/** The object that assigns the PDOs of a direction: that of its sync manager. */
static unsigned assignment_of(const walk_t *walk, int direction)
{
    return OBJ_1C12_RXPDO_ASSIGN + (unsigned)(direction ^ (int)walk->swapped);
}

static unsigned assigned_count(const cm1e_slave_config_t *config, int direction)
{
    return direction ? config->inputs_pdo_count : config->outputs_pdo_count;
}

/** Of a modular device: what it has detected is compared, and what it is to have is written where it lets it be. */
static bool walk_modules(walk_t *walk, const cm1e_slave_config_t *config)
{
    const unsigned count = config->module_count;
    if (count == 0)
        return false;
    walk->check = true;
    for (unsigned n = 0; n <= count; n++)
        if (visit(walk, DETECTED_MODULES, n, n ? ENTRY_BYTES : COUNT_BYTES, n ? config->modules[n - 1] : count))
            return true;
    for (unsigned n = 0; n <= count + 1; n++) { /* emptied, filled, counted */
        const uint32_t value = n == 0 ? 0 : n <= count ? config->modules[n - 1] : count;
        const bool is_count = n == 0 || n > count;
        for (int check = 0; check < 2; check++) {
            walk->check = check != 0;
            walk->optional = !walk->check;
            if (visit(walk, CONFIGURED_MODULES, is_count ? 0 : n, is_count ? COUNT_BYTES : ENTRY_BYTES, value))
                return true;
        }
    }
    walk->check = walk->optional = false;
    return false;
}

/** A PDO alone excludes none. */
static bool walk_excludes(walk_t *walk, const cm1e_slave_config_t *config)
{
    walk->check = walk->excludes = true;
    for (int direction = 0; direction < 2; direction++) {
        const unsigned count = assigned_count(config, direction);
        const uint16_t *pdos = direction ? config->inputs_pdos : config->outputs_pdos;
        for (unsigned i = 0; i < count && count > 1; i++)
            if (visit(walk, pdos[i] - TO_PARAMETER, EXCLUDES, NUMBER_BYTES, pdos[i]))
                return true;
    }
    walk->check = walk->excludes = false;
    return false;
}

/** A slave may refuse to have a PDO written that is assigned, so assignments are emptied before. */
static bool walk_clearing(walk_t *walk, const cm1e_slave_config_t *config)
{
    for (int direction = 0; direction < 2; direction++)
        if (assigned_count(config, direction) && visit(walk, assignment_of(walk, direction), 0, COUNT_BYTES, 0))
            return true;
    return false;
}

static bool walk_assignment(walk_t *walk, const cm1e_slave_config_t *config)
{
    for (int direction = 0; direction < 2; direction++) {
        const unsigned index = assignment_of(walk, direction), count = assigned_count(config, direction);
        const uint16_t *pdos = direction ? config->inputs_pdos : config->outputs_pdos;
        for (unsigned i = 0; i < count; i++)
            if (visit(walk, index, i + 1, PDO_BYTES, pdos[i]))
                return true;
        if (count && visit(walk, index, 0, COUNT_BYTES, count))
            return true;
    }
    return false;
}

static bool is_stated(const cm1e_slave_config_t *config, unsigned index)
{
    for (unsigned i = 0; i < config->sdo_count; i++)
        if (config->sdos[i].index == index && config->sdos[i].subindex == SYNC_TYPE)
            return true;
    return false;
}

/** Reads what the slave supports, in the step before this is needed. */
static bool walk_asking(walk_t *walk, unsigned index)
{
    walk->check = walk->optional = walk->asks = true;
    const bool found = visit(walk, index, SYNC_SUPPORTED, SYNC_BYTES, 0);
    walk->check = walk->optional = walk->asks = false;
    return found;
}

static unsigned type_for(cm1e_setup_pulses_t pulses, unsigned supported)
{
    if (pulses == CM1E_SETUP_SYNC0)
        return BY_SYNC0;
    return supported & CAN_SYNC1 ? BY_SYNC1 : supported & CAN_SYNC0 ? BY_SYNC0 : 0;
}

static bool walk_synchronisation(walk_t *walk, const cm1e_slave_config_t *config, cm1e_setup_pulses_t pulses,
                                 const uint16_t supported[2])
{
    for (unsigned i = 0; i < 2; i++) {
        const unsigned index = OBJ_1C32_SM_OUTPUT_PARAMETER + i, type = type_for(pulses, supported[i]);
        if (is_stated(config, index))
            continue;
        if (pulses == CM1E_SETUP_SYNC1 && walk_asking(walk, index))
            return true;
        for (int check = 0; check < 2 && type; check++) {
            walk->check = check != 0;
            walk->optional = !walk->check;
            if (visit(walk, index, SYNC_TYPE, SYNC_BYTES, type))
                return true;
        }
        walk->check = walk->optional = false;
    }
    return false;
}

static bool find_step(const cm1e_setup_job_t *job, unsigned number, step_t *step)
{
    const cm1e_slave_config_t *config = job->config;
    const bool before_op = job->before_op;
    walk_t walk = {.left = number, .step = step, .swapped = job->swapped};
    if (walk_sdos(&walk, config, before_op))
        return true;
    if (before_op)
        return false;
    if (job->pulses && walk_synchronisation(&walk, config, job->pulses, job->supported))
        return true;
    if (walk_modules(&walk, config) || walk_excludes(&walk, config) || walk_clearing(&walk, config) ||
        walk_mapping(&walk, config) || walk_assignment(&walk, config))
        return true;
    walk.check = true;
    return walk_mapping(&walk, config) || walk_assignment(&walk, config);
}

bool cm1e_setup_is_needed(const cm1e_slave_config_t *config, cm1e_setup_pulses_t pulses, bool before_op)
{
    step_t step;
    const cm1e_setup_job_t job = {.config = config, .pulses = pulses, .before_op = before_op};
    return config && find_step(&job, 0, &step);
}

void cm1e_setup_begin(cm1e_setup_job_t *job, uint16_t position, const cm1e_slave_config_t *config,
                      cm1e_setup_pulses_t pulses, bool before_op, bool swapped)
{
    *job = (cm1e_setup_job_t){.config = config, .pulses = pulses, .before_op = before_op, .swapped = swapped,
                              .sdo = {.position = position}};
}

static bool is_assigned(const cm1e_slave_config_t *config, unsigned pdo)
{
    for (int direction = 0; direction < 2; direction++) {
        const uint16_t *pdos = direction ? config->inputs_pdos : config->outputs_pdos;
        for (unsigned i = 0; i < assigned_count(config, direction); i++)
            if (pdos[i] == pdo)
                return true;
    }
    return false;
}

/** false: the slave says that `pdo` excludes another one that is to be assigned. */
static bool took_excludes(cm1e_setup_job_t *job)
{
    if (cm1e_sdo_state(&job->sdo) == CM1E_SDO_ERROR) {
        job->error = job->sdo.error == CM1E_ERROR_SDO_ABORT ? CM1E_OK : job->sdo.error;
        return job->error == CM1E_OK;
    }
    for (size_t at = 0; at + PDO_BYTES <= job->sdo.size; at += PDO_BYTES) {
        const uint16_t pdo = cm1e_get_u16(job->data + at);
        if (pdo == job->pdo || !is_assigned(job->config, pdo))
            continue;
        job->excluded = pdo;
        job->error = CM1E_ERROR_PDO_MAPPING;
        return false;
    }
    return true;
}

/** false: the job has failed. */
static bool took(cm1e_setup_job_t *job)
{
    if (job->asks_excludes)
        return took_excludes(job);
    if (cm1e_sdo_state(&job->sdo) == CM1E_SDO_ERROR) {
        if (job->optional && job->sdo.error == CM1E_ERROR_SDO_ABORT) {
            job->step += !job->asked; /* without its check */
            return true;
        }
        job->error = job->sdo.error;
        return false;
    }
    if (job->sdo.write)
        return true;
    job->shown = cm1e_get_uint(job->data, (unsigned)(job->sdo.size < NUMBER_BYTES ? job->sdo.size : NUMBER_BYTES));
    if (job->asked) {
        job->supported[job->sdo.index - OBJ_1C32_SM_OUTPUT_PARAMETER] = (uint16_t)job->shown;
        return true;
    }
    job->differs = job->shown != job->expected;
    if (job->differs)
        job->error = CM1E_ERROR_PDO_MAPPING;
    return !job->differs;
}

/** What the configuration states of a transfer beyond a value of at most 8 bytes. */
static void take_stated(cm1e_setup_job_t *job, const cm1e_sdo_config_t *stated)
{
    job->sdo.complete_access = stated->complete_access;
    if (stated->bytes > 0)
        return;
    /* A transfer that writes does not change it. */
    job->sdo.data = (void *)(uintptr_t)(job->config->sdo_data + stated->value);
    job->sdo.size = stated->size;
}

cm1e_sdo_t *cm1e_setup_next(cm1e_setup_job_t *job)
{
    step_t step;
    if (!job->config)
        return NULL;
    if ((job->started && !took(job)) || !find_step(job, job->step, &step)) {
        job->config = NULL;
        return NULL;
    }
    job->step++;
    job->started = true;
    job->optional = step.optional;
    job->asked = step.asks;
    job->expected = step.value;
    job->asks_excludes = step.excludes;
    job->pdo = step.excludes ? (uint16_t)step.value : 0;
    cm1e_put_uint(job->data, NUMBER_BYTES, step.check ? 0 : step.value);
    job->sdo = (cm1e_sdo_t){.position = job->sdo.position, .index = step.index, .subindex = step.subindex,
                            .write = !step.check, .data = job->data, .timeout_ns = SDO_TIMEOUT_NS,
                            .size = step.excludes ? sizeof job->data : step.check ? NUMBER_BYTES : step.bytes,
                            .state = CM1E_SDO_BUSY};
    if (step.sdo)
        take_stated(job, step.sdo);
    return &job->sdo;
}
