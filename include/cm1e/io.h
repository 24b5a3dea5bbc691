/**
 * @file io.h
 * The process data of any slave, signal by signal: digital and analog terminals, encoders, devices of other makers. A
 * signal is found once by its name, its object or its place; then reading and writing it in the cycle costs a copy of a
 * few bytes. The names come from the bus file (`slaves`), else from the SII of the slave (ETG.2010, categories TxPDO
 * and RxPDO). A slave with a motor, or with CoE and listed in the bus file, has the signals of its present PDO mapping.
 *
 * An output that a program has found here is its own: others who attach to the program (docs/CONTROL.md) do not write
 * it.
 *
 * While a slave is away its inputs keep the last values that came from it; cm1e_io_quality() tells. The outputs of a
 * slave that the bus file lists take their safe values before the program writes them, while the slave or the bus is
 * lost, and after the last program (docs/BUS-FILE.md). Those of another slave keep their values, and are zeros from its
 * return until it is in Operational again. The outputs of a slave with a motor belong to its axis and are not written
 * here. The slave itself decides what it does when the bus has left Operational, and when no frames come (watchdog).
 */
#ifndef CM1E_IO_H
#define CM1E_IO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** "BOOL", "USINT" ...; never NULL. @rt any */
CM1E_API const char *cm1e_io_type_name(cm1e_io_type_t type);
/** The unsigned type of a signal with this number of bits. @rt any */
CM1E_API cm1e_io_type_t cm1e_io_type_of_bits(uint32_t bits);

/** A signal, as it is listed. */
typedef struct cm1e_io_info {
    uint16_t position;    /**< slave, 1 = first */
    uint16_t number;      /**< among the signals of this direction of the slave, 1 = first */
    bool output;          /**< from the master to the slave */
    bool of_axis;         /**< the slave has a motor: it can be read here, not written */
    uint16_t index;       /**< object that is mapped */
    uint8_t subindex;
    cm1e_io_type_t type;
    uint16_t bits;
    uint32_t bit_offset;  /**< from the beginning of the slave's process data of this direction */
    char name[64];        /**< "Channel 1 Input"; "0x6041:00" where the slave has no name for it */
} cm1e_io_info_t;

/** A signal, found. The caller owns it; its members are the library's. It is valid until the next cm1e_bus_scan() or
 *  cm1e_bus_close(): find it again after a new start of the bus. One of an optional drive that was found before the
 *  drive came is valid until it comes with other process data than was planned: find it again then. */
typedef struct cm1e_io {
    cm1e_bus_t *bus;
    uint32_t layout, byte; /**< number of the process image and of the slave's part; place in it */
    uint16_t position, bits;
    uint8_t shift, type;
    bool output;
} cm1e_io_t;

/** How far a value can be trusted. */
typedef enum cm1e_io_quality {
    CM1E_IO_GOOD = 0, /**< the slave took part in this cycle, and is in Operational */
    CM1E_IO_STALE,    /**< nothing came from the slave in this cycle: the value is the last one that came */
    CM1E_IO_OFFLINE,  /**< the slave has left Operational, does not answer, or the bus is not in operation */
    CM1E_IO_INVALID,  /**< the handle names nothing, is of an earlier start of the bus, or was found in planned process
                           data and the slave has come with other ones */
} cm1e_io_quality_t;

/** "good", "stale", "offline", "invalid"; never NULL. @rt any */
CM1E_API const char *cm1e_io_quality_name(cm1e_io_quality_t quality);

/** Number of signals of all slaves, from cm1e_bus_configure() on; 0 before. @rt init */
CM1E_API uint32_t cm1e_io_count(const cm1e_bus_t *bus);
/** Signal number `n` (0 = first), in the order of the slaves, inputs before outputs. False: there is no such signal.
 *  @rt init */
CM1E_API bool cm1e_io_at(const cm1e_bus_t *bus, uint32_t n, cm1e_io_info_t *info);

/** Writes how the axes of the configuration use a signal of another slave, as "feed: input 11, home switch"; "" if none
 *  does. Such an output is written by the blocks of its axis (MC_WriteDigitalOutput, MC_DigitalCamSwitch). Returns
 *  whether one uses it. After cm1e_bus_configure(). @rt block */
CM1E_API bool cm1e_io_use(cm1e_bus_t *bus, const cm1e_io_info_t *info, char *text, size_t size);

/** Finds a signal by "SLAVE.SIGNAL", without regard to upper and lower case, after cm1e_bus_configure().
 *  SLAVE: name in the bus file, position ("3"), "slave 3", or the name of its SII where only one slave has it.
 *  SIGNAL: name as listed; "input 2" or "output 2", the second one; or its object, "0x6000:01".
 *  Returns CM1E_ERROR_NOT_FOUND, where `diag` lists what is there, or CM1E_ERROR_INVALID_ARGUMENT if two signals have
 *  this name. @rt init */
CM1E_API cm1e_error_t cm1e_io_find(cm1e_bus_t *bus, const char *name, cm1e_io_t *io, cm1e_diag_t *diag);
/** Finds a signal by its object. @rt init */
CM1E_API cm1e_error_t cm1e_io_find_object(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex,
                                          bool output, cm1e_io_t *io, cm1e_diag_t *diag);
/** Finds bits by their place in the process data of a slave, whatever they mean there. `bits` is the number that the
 *  type has; an integer may have fewer. Returns CM1E_ERROR_NOT_FOUND if the slave does not have that many. @rt init */
CM1E_API cm1e_error_t cm1e_io_find_bits(cm1e_bus_t *bus, uint16_t position, bool output, uint32_t bit_offset,
                                        uint16_t bits, cm1e_io_type_t type, cm1e_io_t *io, cm1e_diag_t *diag);

/** See cm1e_io_quality_t. @rt cycle */
CM1E_API cm1e_io_quality_t cm1e_io_quality(const cm1e_io_t *io);

/** Value of a signal, of any type but BYTES; of an output the one that is sent. True: it is not 0. False where the
 *  quality is INVALID. @rt cycle */
CM1E_API bool cm1e_io_bool(const cm1e_io_t *io);
/** As cm1e_io_bool(); 0 where the quality is INVALID. REAL is rounded towards 0 and kept in the range of int64_t (NaN:
 *  0); ULINT beyond that range wraps. @rt cycle */
CM1E_API int64_t cm1e_io_integer(const cm1e_io_t *io);
/** As cm1e_io_bool(), as a number; 0 where the quality is INVALID. @rt cycle */
CM1E_API double cm1e_io_real(const cm1e_io_t *io);
/** Copies the bits of a signal of any type, beginning with bit 0 of the first byte. Returns the number of bytes, 0 if
 *  they are more than `size` or the handle is not valid. @rt cycle */
CM1E_API size_t cm1e_io_bytes(const cm1e_io_t *io, void *bytes, size_t size);

/** Sets an output to 0 or 1; it is sent with the frame of this cycle. Nothing is written in case of an error:
 *  CM1E_ERROR_INVALID_ARGUMENT: it is an input, belongs to an axis, is of type BYTES, or the value is outside the range
 *  of its type; CM1E_ERROR_STATE: the handle is not valid. May be called before the bus operates: the slave gets the
 *  value with its first frame in Operational. @rt cycle */
CM1E_API cm1e_error_t cm1e_io_set_bool(const cm1e_io_t *io, bool value);
/** As cm1e_io_set_bool(), a whole number. @rt cycle */
CM1E_API cm1e_error_t cm1e_io_set_integer(const cm1e_io_t *io, int64_t value);
/** As cm1e_io_set_bool(), any finite number that its type has; a signal that is no REAL or LREAL takes
 *  whole numbers only. @rt cycle */
CM1E_API cm1e_error_t cm1e_io_set_real(const cm1e_io_t *io, double value);
/** Sets the bits of an output of any type; `size`: as many bytes as it has. @rt cycle */
CM1E_API cm1e_error_t cm1e_io_set_bytes(const cm1e_io_t *io, const void *bytes, size_t size);

#ifdef __cplusplus
}
#endif
#endif
