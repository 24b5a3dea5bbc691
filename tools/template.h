/**
 * @file template.h
 * The files of `cm1e new`: those of examples/new, which the build makes a source of (tools/template.cmake).
 */
#ifndef CM1E_TOOLS_TEMPLATE_H
#define CM1E_TOOLS_TEMPLATE_H

#include <stddef.h>
#include <stdint.h>

typedef struct template_file {
    const char *name;
    const uint8_t *bytes;
    size_t size;
} template_file_t;
extern const template_file_t template_files[];
extern const size_t template_file_count;

#endif
