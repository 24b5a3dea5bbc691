/**
 * @file presence_text.h
 * Sentences about slaves that came or went, for the event log.
 */
#ifndef CM1E_BUS_PRESENCE_TEXT_H
#define CM1E_BUS_PRESENCE_TEXT_H

#include "cm1e/hot_connect.h"

/** What is said of a slave whose presence is, or was, this one. */
void cm1e_presence_sentence(const cm1e_bus_t *bus, uint32_t position, cm1e_presence_t presence, char *text,
                            size_t size);

#endif
