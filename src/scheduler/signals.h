/**
 * @file signals.h
 * What would end or suspend the program from outside (Ctrl-C, a closed terminal ...) ends one scheduler's run in order.
 */
#ifndef CM1E_SCHEDULER_SIGNALS_H
#define CM1E_SCHEDULER_SIGNALS_H

#include "cm1e/scheduler.h"

/** Replaces a scheduler attached before. */
void cm1e_signals_attach(cm1e_scheduler_t *scheduler);
/** The signals do again what they did before, if it is this scheduler that they stop. */
void cm1e_signals_detach(const cm1e_scheduler_t *scheduler);

#endif
