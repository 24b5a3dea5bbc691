/**
 * @file io_guest.h
 * Signals for others than the program that runs the bus. An output belongs to the program as soon as it has found it by
 * a function of cm1e/io.h, written or not: what a program knows of, it may count on.
 */
#ifndef CM1E_BUS_IO_GUEST_H
#define CM1E_BUS_IO_GUEST_H

#include "cm1e/io.h"
#include "core/guest_api.h"

/** The next signal after `info`; position 0: the first one. false: there is no more. @rt any */
CM1E_GUEST_API bool cm1e_io_guest_next(const cm1e_bus_t *bus, cm1e_io_info_t *info);
/** The handle of a signal that was listed; it claims nothing. @rt any */
CM1E_GUEST_API cm1e_error_t cm1e_io_guest_take(cm1e_bus_t *bus, const cm1e_io_info_t *info, cm1e_io_t *io,
                                               cm1e_diag_t *diag);
/** As cm1e_io_find(); it claims nothing. @rt any */
CM1E_GUEST_API cm1e_error_t cm1e_io_guest_find(cm1e_bus_t *bus, const char *name, cm1e_io_t *io, cm1e_diag_t *diag);
/** Whether an output, or a bit of it, belongs to the program. @rt any */
CM1E_GUEST_API bool cm1e_io_is_claimed(const cm1e_io_t *io);
/** Gives an output the value that it had before anybody wrote it: its safe value, 0 without one. @rt cycle */
CM1E_GUEST_API void cm1e_io_guest_release(const cm1e_io_t *io);

#endif
