#include "control/guest_outputs.h"

static bool is_same(const cm1e_io_t *a, const cm1e_io_t *b)
{
    return a->byte == b->byte && a->shift == b->shift && a->bits == b->bits;
}

static bool overlaps(const cm1e_io_t *a, const cm1e_io_t *b)
{
    const uint32_t a_first = a->byte * 8 + a->shift, b_first = b->byte * 8 + b->shift;
    return a_first < b_first + b->bits && b_first < a_first + a->bits;
}

static void let_go(guest_outputs_t *outputs, guest_output_t *output)
{
    cm1e_io_guest_release(&output->io);
    output->held = false;
    outputs->count--;
}

/** The one that this client holds already, or a free place; NULL: there is none, `refusal` says why. */
static guest_output_t *place_of(guest_outputs_t *outputs, uint32_t client, const cm1e_io_t *io,
                                output_refusal_t *refusal)
{
    guest_output_t *place = NULL;
    *refusal = OUTPUT_FULL;
    for (int i = 0; i < CM1E_GUEST_OUTPUTS; i++) {
        guest_output_t *output = &outputs->outputs[i];
        if (!output->held) {
            place = place ? place : output;
        } else if (overlaps(&output->io, io)) {
            *refusal = OUTPUT_HELD;
            return output->client == client && is_same(&output->io, io) ? output : NULL;
        }
    }
    return place;
}

output_refusal_t cm1e_guest_output_set(guest_outputs_t *outputs, uint32_t client, const cm1e_io_t *io, double value,
                                       int64_t until_ns)
{
    output_refusal_t refusal;
    const cm1e_io_quality_t quality = cm1e_io_quality(io);
    if (quality == CM1E_IO_OFFLINE || quality == CM1E_IO_INVALID)
        return OUTPUT_OFFLINE;
    guest_output_t *output = place_of(outputs, client, io, &refusal);
    if (!output)
        return refusal;
    if (cm1e_io_set_real(io, value) != CM1E_OK)
        return OUTPUT_BY_BUS;
    outputs->count += !output->held;
    *output = (guest_output_t){.held = true, .client = client, .io = *io, .until_ns = until_ns};
    return OUTPUT_DONE;
}

void cm1e_guest_output_release(guest_outputs_t *outputs, uint32_t client, const cm1e_io_t *io)
{
    for (int i = 0; i < CM1E_GUEST_OUTPUTS; i++) {
        guest_output_t *output = &outputs->outputs[i];
        if (output->held && output->client == client && is_same(&output->io, io))
            let_go(outputs, output);
    }
}

void cm1e_guest_outputs_cycle(guest_outputs_t *outputs, int64_t now_ns, bool ending)
{
    const uint32_t gone = atomic_load_explicit(&outputs->gone, memory_order_relaxed)
                              ? atomic_exchange_explicit(&outputs->gone, 0, memory_order_acquire) : 0;
    for (int i = 0; outputs->count > 0 && i < CM1E_GUEST_OUTPUTS; i++) {
        guest_output_t *output = &outputs->outputs[i];
        if (output->held && (ending || now_ns >= output->until_ns || gone & UINT32_C(1) << output->client))
            let_go(outputs, output);
    }
}

void cm1e_guest_outputs_leave(guest_outputs_t *outputs, uint32_t client)
{
    atomic_fetch_or_explicit(&outputs->gone, UINT32_C(1) << client, memory_order_release);
}
