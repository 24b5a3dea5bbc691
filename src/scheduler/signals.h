/**
 * @file signals.h
 * Signals that would end or suspend the program (Ctrl-C, a closed terminal ...) end the run of one scheduler in order.
 */
#ifndef CM1E_SCHEDULER_SIGNALS_H
#define CM1E_SCHEDULER_SIGNALS_H

#include "cm1e/scheduler.h"

/** Attaches a scheduler, in place of the one attached before. */
void cm1e_signals_attach(cm1e_scheduler_t *scheduler);
/** Restores the earlier action of the signals, if this scheduler is attached. Behind it no handler knows it. */
void cm1e_signals_detach(const cm1e_scheduler_t *scheduler);

#endif
