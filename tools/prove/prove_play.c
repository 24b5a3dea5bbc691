#include "prove/prove_play.h"

#include <stdlib.h>

#include "command.h"
#include "files.h"
#include "prove/profile_file.h"
#include "prove/prove.h"

bool play_profile(cm1e_sim_segment_t *segment, uint32_t position, const char *path)
{
    input_t input;
    cm1e_diag_t diag = {0};
    if (!read_input(path, &input))
        return false;
    profile_file_t *file = profile_file_read(path, input.bytes, input.size);
    bool good = file != NULL;
    free(input.bytes);
    if (good && cm1e_sim_segment_play(segment, position, profile_file_content(file), &diag) != CM1E_OK) {
        complain("%s: %s", path, diag.text);
        good = false;
    }
    profile_file_free(file);
    return good;
}

bool prove_play(const prove_options_t *options, cm1e_bus_t *bus)
{
    cm1e_sim_segment_t *segment = cm1e_bus_segment(bus);
    const uint32_t position = options->where ? (uint32_t)strtoul(options->where, NULL, 10) : 1;
    return !options->profile || !segment || play_profile(segment, position, options->profile);
}
