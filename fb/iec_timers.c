/* TON, TOF, TP (IEC 61131-3, 2.5.2.3.4) on the time of the scan. The time begins at the edge and is over in the first
 * call that comes PT or more after it, with PT 0 in the call of the edge. If PT changes while the time runs, the new PT
 * applies; a time that is over stays over. A negative PT acts as 0. What has passed is a difference of two times in 64
 * bits without a sign: right for every pair of them. */
#include "cm1e/iec.h"
#include "cm1e/scan_time.h"

static void start(cm1e_iec_timer_t *timer)
{
    timer->start = cm1e_scan_time();
    timer->running = TRUE;
}

/** Time since the start, at most PT; the timer stops there. */
static TIME run(cm1e_iec_timer_t *timer, TIME preset)
{
    const TIME now = cm1e_scan_time(), most = preset > 0 ? preset : 0;
    if (now < timer->start)
        timer->start = now; /* the time was set back */
    const uint64_t passed = (uint64_t)now - (uint64_t)timer->start;
    timer->running = passed < (uint64_t)most;
    return timer->running ? (TIME)passed : most;
}

void TON(TON_t *fb)
{
    cm1e_iec_timer_t *timer = &fb->Private;
    if (fb->IN && !timer->before)
        start(timer);
    timer->before = fb->IN != FALSE;
    if (!fb->IN) {
        timer->running = FALSE;
        fb->Q = FALSE;
        fb->ET = 0;
    } else if (timer->running) {
        fb->ET = run(timer, fb->PT);
        fb->Q = !timer->running;
    }
}

void TOF(TOF_t *fb)
{
    cm1e_iec_timer_t *timer = &fb->Private;
    if (!fb->IN && timer->before)
        start(timer);
    timer->before = fb->IN != FALSE;
    if (fb->IN) {
        timer->running = FALSE;
        fb->Q = TRUE;
        fb->ET = 0;
    } else if (timer->running) {
        fb->ET = run(timer, fb->PT);
        fb->Q = timer->running;
    }
}

/** A pulse can be triggered again in the call after the one in which it ends: Q is FALSE between two pulses, and no
 *  pulse is longer than PT and one scan. */
void TP(TP_t *fb)
{
    cm1e_iec_timer_t *timer = &fb->Private;
    const BOOL edge = fb->IN && !timer->before, pulse = timer->running;
    timer->before = fb->IN != FALSE;
    if (edge && !pulse)
        start(timer);
    if (timer->running)
        fb->ET = run(timer, fb->PT);
    if (!timer->running && !fb->IN)
        fb->ET = 0;
    fb->Q = timer->running;
}
