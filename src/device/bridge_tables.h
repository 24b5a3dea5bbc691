/**
 * @file bridge_tables.h
 * What the tables of the bridge share between axes and kinds of motor, each fact once (BR appendix 6); private to this
 * room. Indexes are those of axis 0.
 */
#ifndef CM1E_DEVICE_BRIDGE_TABLES_H
#define CM1E_DEVICE_BRIDGE_TABLES_H

#include "device/bridge_facts.h"
#include "device/objects.h"

/* As the headings of appendix 6 say "ID1". */
#define AXIS_NAME_0 "ID1"
#define AXIS_NAME_1 "ID2"
#define AXIS_NAME_2 "ID3"
#define AXIS_NAME_3 "ID4"

/* The words of the appendix's column "Availability". */
#define YES .availability = CM1E_AVAILABLE
#define NA .availability = CM1E_NOT_AVAILABLE
#define NONE .availability = CM1E_NO_PARAMETER

/* Rows of the mapping objects: X(context, place, index, bits, name). 0x1601 and 0x1A01 are the process data; the others
 * are "N/A". */
#define BRIDGE_PDO_1600(X, context)                                                                                 \
    X(context, 1, 0x6040, 16, "Controlword")                                                                        \
    X(context, 2, 0x6060, 8, "Modes of operation")                                                                  \
    X(context, 3, 0x607A, 32, "Target Position")                                                                    \
    X(context, 4, 0x60FF, 32, "Target velocity")
#define BRIDGE_PDO_1601(X, context)                                                                                 \
    X(context, 1, 0x6040, 16, "Controlword")                                                                        \
    X(context, 2, 0x607A, 32, "Target Position")
#define BRIDGE_PDO_1602(X, context)                                                                                 \
    X(context, 1, 0x6040, 16, "Controlword")                                                                        \
    X(context, 2, 0x60FF, 32, "Target velocity")
#define BRIDGE_PDO_1A00(X, context)                                                                                 \
    X(context, 1, 0x6041, 16, "Statusword")                                                                         \
    X(context, 2, 0x6061, 8, "Modes of Operation Display")                                                          \
    X(context, 3, 0x6064, 32, "Actual position")                                                                    \
    X(context, 4, 0x606C, 32, "Actual velocity")
#define BRIDGE_PDO_1A01(X, context)                                                                                 \
    X(context, 1, 0x6041, 16, "Statusword")                                                                         \
    X(context, 2, 0x6064, 32, "Actual position")
#define BRIDGE_PDO_1A02(X, context)                                                                                 \
    X(context, 1, 0x6041, 16, "Statusword")                                                                         \
    X(context, 2, 0x606C, 32, "Actual velocity")

#endif
