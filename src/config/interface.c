#include "config/interface.h"

static const char *const words[CM1E_WAYS] = {[CM1E_WAY_PACKET] = "packet", [CM1E_WAY_XDP] = "xdp"};

cm1e_interface_way_t cm1e_interface_way(const char *name, char *wrong, size_t size)
{
    const size_t length = cm1e_interface_length(name);
    if (name[length] == '\0')
        return CM1E_WAY_PACKET;
    const char *word = name + length + 1;
    for (int way = 0; way < CM1E_WAYS; way++)
        if (strcmp(word, words[way]) == 0)
            return (cm1e_interface_way_t)way;
    if (wrong)
        snprintf(wrong, size, "has \"%s\" behind its comma; expected one of: %s (as without a comma), %s. An interface "
                 "with a comma in its own name is written with its way, \"%s,%s\"", word, words[CM1E_WAY_PACKET],
                 words[CM1E_WAY_XDP], name, words[CM1E_WAY_PACKET]);
    return CM1E_WAY_UNKNOWN;
}
