#include "control/view.h"

#include <stdlib.h>
#include <string.h>

#include "control/maintain.h"
#include "control/recorder.h"
#include "core/cache_line.h"

cm1e_error_t cm1e_view_init(view_t *view, cm1e_scheduler_t *scheduler, uint32_t bus)
{
    view->scheduler = scheduler;
    view->bus = cm1e_scheduler_bus_at(scheduler, bus);
    view->axes = cm1e_scheduler_axes_at(scheduler, bus, &view->first_axis, &view->axis_count);
    view->slave_count = cm1e_bus_slave_count(view->bus);
    size_t bytes = 0;
    for (uint32_t i = 0; i < view->axis_count; i++) {
        view->copy_at[i] = bytes;
        bytes += cm1e_axis_copy_bytes(view->axes[i]);
    }
    view->copies = cm1e_cache_lines(bytes ? bytes : 1);
    return view->copies ? CM1E_OK : CM1E_ERROR_NO_MEMORY;
}

void cm1e_view_free(view_t *view) { free(view->copies); }

/* ---- the cycle -------------------------------------------------------------------------------------------------- */

static unsigned char *copy_of(const view_t *view, uint32_t axis)
{
    return view->copies + view->copy_at[axis];
}

static void begin(view_t *view)
{
    view->begun = true;
    view->next = 0;
    view->run_ns = cm1e_scheduler_time_ns(view->scheduler);
    for (uint32_t i = 0; i < view->axis_count; i++) {
        cm1e_axis_get(view->axes[i], &view->infos[i]);
        cm1e_axis_news(view->axes[i], &view->news[i]);
        view->has_text[i] = cm1e_axis_has_text(view->axes[i]);
        view->measures[i] = cm1e_axis_measures(view->axes[i]);
        view->holders[i] = view->maintained.holds[i].held ? (int32_t)view->maintained.holds[i].client : -1;
        view->resetting[i] = cm1e_axis_reset_state(view->axes[i], NULL) == CM1E_COMMAND_ACTIVE;
    }
    for (uint32_t i = 0; i < view->slave_count; i++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(view->bus, i + 1);
        view->slaves[i].al_state = slave->al_state;
        view->slaves[i].al_status_code = slave->al_status_code;
        cm1e_bus_slave_clock(view->bus, slave->position, &view->slaves[i].clock);
    }
    cm1e_bus_ring(view->bus, &view->ring);
}

static void fill(view_t *view)
{
    if (!view->begun)
        begin(view);
    while (view->next < view->axis_count && !view->has_text[view->next])
        view->next++;
    if (view->next < view->axis_count) {
        cm1e_axis_copy(view->axes[view->next], copy_of(view, view->next));
        view->next++;
        return;
    }
    view->begun = false;
    atomic_store_explicit(&view->state, VIEW_FILLED, memory_order_release);
}

/** A program's block moves it, or something that a block began. */
static bool is_commanded(const cm1e_axis_t *axis)
{
    cm1e_axis_news_t news;
    cm1e_axis_news(axis, &news);
    return news.command != 0 || (news.state != CM1E_AXIS_DISABLED && news.state != CM1E_AXIS_STANDSTILL &&
                                 news.state != CM1E_AXIS_ERROR_STOP);
}

void cm1e_view_decide_write(view_t *view, view_order_t *order)
{
    view_write_t *write = (view_write_t *)order;
    const uint16_t position = write->file ? write->file->position : write->sdo->position;
    write->commanded = -1;
    for (uint32_t i = 0; i < view->axis_count && write->commanded < 0; i++)
        if (cm1e_bus_axis_position(view->bus, i) == position && is_commanded(view->axes[i]))
            write->commanded = (int32_t)i;
    if (write->commanded >= 0)
        write->result = CM1E_ERROR_AXIS_STATE;
    else
        write->result = write->file ? cm1e_foe_submit(view->bus, write->file, NULL)
                                    : cm1e_sdo_submit(view->bus, write->sdo);
}

/** Variables that a client has forced are the program's again when it is gone. */
static void look_after_forced(view_t *view)
{
    const uint32_t gone = atomic_load_explicit(&view->gone, memory_order_relaxed)
                              ? atomic_exchange_explicit(&view->gone, 0, memory_order_acquire) : 0;
    for (uint32_t client = 0; gone && client < CM1E_CONTROL_CLIENTS; client++)
        if (gone & UINT32_C(1) << client)
            cm1e_scheduler_release_all(view->scheduler, view, client);
    cm1e_scheduler_forcing_cycle(view->scheduler);
}

void cm1e_view_cycle(view_t *view)
{
    if (atomic_load_explicit(&view->state, memory_order_acquire) == VIEW_WANTED)
        fill(view);
    cm1e_maintain_cycle(view);
    if (view->outputs.count > 0 || atomic_load_explicit(&view->outputs.gone, memory_order_relaxed))
        cm1e_guest_outputs_cycle(&view->outputs, cm1e_scheduler_time_ns(view->scheduler),
                                 cm1e_scheduler_is_ending(view->scheduler));
    look_after_forced(view);
    if (atomic_load_explicit(&view->recording, memory_order_relaxed))
        cm1e_recorder_cycle(view);
    if (!atomic_load_explicit(&view->order, memory_order_relaxed))
        return;
    view_order_t *order = atomic_exchange_explicit(&view->order, NULL, memory_order_acquire);
    if (!order)
        return;
    order->decide(view, order);
    atomic_store_explicit(&order->decided, true, memory_order_release);
}

/* ---- the thread ------------------------------------------------------------------------------------------------- */

static uint32_t want_next(view_t *view)
{
    atomic_store_explicit(&view->state, VIEW_WANTED, memory_order_release);
    return ++view->number;
}

uint32_t cm1e_view_want(view_t *view)
{
    /* The cycle may have begun the one that is wanted: its numbers are of that time. */
    const bool wanted = atomic_load_explicit(&view->state, memory_order_acquire) == VIEW_WANTED;
    return wanted ? view->number + 1 : want_next(view);
}

bool cm1e_view_has(view_t *view, uint32_t number)
{
    if (atomic_load_explicit(&view->state, memory_order_acquire) != VIEW_FILLED)
        return false;
    if (view->number - number <= UINT32_MAX / 2)
        return true;
    want_next(view);
    return false;
}

void cm1e_view_text(const view_t *view, uint32_t axis, char *text, size_t size)
{
    text[0] = 0;
    if (view->has_text[axis])
        cm1e_axis_text((const cm1e_axis_t *)(const void *)copy_of(view, axis), text, size);
}

bool cm1e_view_submit(view_t *view, view_order_t *order)
{
    view_order_t *none = NULL;
    atomic_store_explicit(&order->decided, false, memory_order_relaxed);
    return atomic_compare_exchange_strong_explicit(&view->order, &none, order, memory_order_release,
                                                   memory_order_relaxed);
}

bool cm1e_view_withdraw(view_t *view, view_order_t *order)
{
    view_order_t *expected = order;
    return atomic_compare_exchange_strong(&view->order, &expected, NULL);
}
