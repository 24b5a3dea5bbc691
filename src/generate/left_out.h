/**
 * @file left_out.h
 * What a file that was written anew does not have of the file that it was read from.
 */
#ifndef CM1E_GENERATE_LEFT_OUT_H
#define CM1E_GENERATE_LEFT_OUT_H

#include "cm1e/generate.h"

/** Compares the elements and attributes of two files of one XML format by name, and adds those that `file` has nowhere
 *  to its warning: "Device/ImageData16x14", "Device/@Foo". Does nothing if one of them cannot be parsed. */
void cm1e_warn_of_left_out(cm1e_file_t *file, const void *bytes, size_t size);

#endif
