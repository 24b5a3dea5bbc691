#include "device/module_kinds.h"

#include <stddef.h>

static const cm1e_module_kind_t modules[] = {
    {.ident = 0x105, .name = "5 digital inputs", .channels = 5, .bits = 1, .padding = 3},
    {.ident = 0x108, .name = "8 digital inputs", .channels = 8, .bits = 1},
    {.ident = 0x205, .name = "5 digital outputs", .output = true, .channels = 5, .bits = 1, .padding = 3},
    {.ident = 0x208, .name = "8 digital outputs", .output = true, .channels = 8, .bits = 1},
    {.ident = 0x302, .name = "2 analog inputs", .channels = 2, .bits = 16},
    {.ident = 0x402, .name = "2 analog outputs", .output = true, .channels = 2, .bits = 16},
};

const cm1e_module_kind_t *cm1e_module_kind(uint32_t ident)
{
    for (size_t i = 0; i < sizeof modules / sizeof modules[0]; i++)
        if (modules[i].ident == ident)
            return &modules[i];
    return NULL;
}
