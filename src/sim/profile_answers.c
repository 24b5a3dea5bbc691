/* What a slave answers by the profile that it plays (play.c). What is missing is hidden here, because an application
 * may need its own objects. */
#include <stdlib.h>

#include "sim/esc_chip.h"

bool cm1e_sim_profile_hides(const cm1e_sim_slave_t *slave, uint16_t index, uint8_t subindex)
{
    const cm1e_sim_profile_t *profile = &slave->profile;
    for (size_t i = profile->entry_count; i > 0; i--)
        if (profile->entries[i - 1].index == index && profile->entries[i - 1].subindex == subindex)
            return profile->entries[i - 1].missing;
    return false;
}

uint32_t cm1e_sim_slave_code(const cm1e_sim_slave_t *slave, int kind, uint32_t code)
{
    for (size_t i = 0; slave && i < slave->profile.code_count; i++)
        if ((int)slave->profile.codes[i].kind == kind && slave->profile.codes[i].ours == code)
            return slave->profile.codes[i].theirs;
    return code;
}

/* The parts of a profile belong to the slave, and only it changes them. */
static void *own(const void *pointer)
{
    union {
        const void *in;
        void *out;
    } part = {.in = pointer};
    return part.out;
}

void cm1e_sim_profile_free(cm1e_sim_profile_t *profile)
{
    free(own(profile->entries));
    free(own(profile->codes));
    *profile = (cm1e_sim_profile_t){0};
}
