/* Makes a slave play a profile. The dictionary is amended in the store of the application (store_profile.c). */
#include <stdlib.h>
#include <string.h>

#include "description/sii_image.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

/* At least one byte, so that NULL means no memory. */
static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = calloc(count + 1, size);
    if (copy && count > 0)
        memcpy(copy, from, count * size);
    return copy;
}

static bool copy_profile(cm1e_sim_profile_t *to, const cm1e_sim_profile_t *from)
{
    *to = (cm1e_sim_profile_t){.entry_count = from->entry_count, .code_count = from->code_count};
    to->entries = copy_of(from->entries, from->entry_count, sizeof *from->entries);
    to->codes = copy_of(from->codes, from->code_count, sizeof *from->codes);
    return to->entries && to->codes;
}

cm1e_error_t cm1e_sim_segment_play(cm1e_sim_segment_t *segment, uint32_t position, const cm1e_sim_profile_t *profile,
                                   cm1e_diag_t *diag)
{
    if (!segment || !profile)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_sim_segment_play() needs a segment and a profile.");
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment, position);
    if (!slave)
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "there is a profile for the simulated slave %u; the "
                             "segment has %u slaves", (unsigned)position,
                             (unsigned)cm1e_sim_segment_slave_count(segment));
    if (!slave->ops->play)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "the simulated slave %u cannot play a profile: only a "
                             "CM1-E, a bridge and a drive by CiA 402 can", (unsigned)position);
    if (profile->sii && profile->sii_size < CM1E_SII_HEADER_BYTES)
        return cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "the SII image of the profile has %zu bytes; expected %d or "
                             "more", profile->sii_size, CM1E_SII_HEADER_BYTES);
    if (slave->profile.entries)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "the simulated slave %u plays a profile already",
                             (unsigned)position);
    uint8_t *sii = profile->sii ? copy_of(profile->sii, profile->sii_size, 1) : NULL;
    const bool copied = copy_profile(&slave->profile, profile) && (sii || !profile->sii);
    const cm1e_error_t error = copied ? slave->ops->play(slave->app, &slave->profile, slave->now_ns, diag)
                                      : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    if (error != CM1E_OK) {
        free(sii);
        cm1e_sim_profile_free(&slave->profile);
        slave->profile = (cm1e_sim_profile_t){0};
        return error;
    }
    if (sii) {
        free(slave->sii);
        slave->sii = sii;
        slave->sii_size = profile->sii_size;
    }
    cm1e_sim_cm1e_t *drive = cm1e_sim_cm1e_of(slave);
    if (drive)
        slave->ops = cm1e_sim_cm1e_ops(drive); /* by its firmware */
    cm1e_sim_esc_power_on(slave, slave->now_ns);
    return CM1E_OK;
}
