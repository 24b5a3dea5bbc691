#include "bus/al_machine.h"

#include "core/bytes.h"

enum { AL_STATUS_BYTES = 6 }; /**< status, 2 reserved bytes, status code */
/** So many looks and so long a slave with a processor may take to accept an acknowledgement. */
enum { ACKNOWLEDGE_LOOKS = 10, ACKNOWLEDGE_NS = 1000000 };

static void end(cm1e_al_machine_t *machine, cm1e_error_t error)
{
    machine->error = error;
    machine->step = AL_IDLE;
}

void cm1e_al_request(cm1e_al_machine_t *machine, uint8_t target, int64_t deadline_ns)
{
    machine->target = target;
    machine->deadline_ns = deadline_ns;
    machine->answered = false;
    machine->unanswered = 0;
    machine->without_bit = false;
    machine->state = machine->code = 0;
    machine->error = CM1E_OK;
    machine->step = AL_LOOK;
}

void cm1e_al_read_id(cm1e_al_machine_t *machine, int64_t deadline_ns)
{
    machine->deadline_ns = deadline_ns;
    machine->answered = false;
    machine->explicit_id = 0;
    machine->error = CM1E_OK;
    machine->target = 0;
    machine->step = AL_LOOK;
}

void cm1e_al_cancel(cm1e_al_machine_t *machine) { end(machine, CM1E_ERROR_CANCELLED); }

static void write_control(const cm1e_al_machine_t *machine, cm1e_datagram_t *d, unsigned value)
{
    cm1e_datagram_set(d, COMMAND_FPWR, machine->station, REG_AL_CONTROL, 2);
    cm1e_put_u16(d->data, (uint16_t)value);
}

/** The value of AL control that acknowledges an error: the present state with the acknowledge bit, or on the way to
 *  Init that state at once, because Init needs no configuration. A slave with device emulation copies AL control to AL
 *  status, so every acknowledgement shows as a new error. If the error is still shown, every second request therefore
 *  omits the bit. */
static unsigned acknowledgement(const cm1e_al_machine_t *machine)
{
    const unsigned state = machine->target == CM1E_AL_INIT ? CM1E_AL_INIT : machine->state & AL_STATE_MASK;
    return machine->without_bit ? state : state | AL_ERROR_FLAG;
}

bool cm1e_al_next(cm1e_al_machine_t *machine, cm1e_datagram_t *d, int64_t now_ns)
{
    const unsigned present = machine->state & AL_STATE_MASK;
    const bool is_id = machine->target == 0;
    if (machine->step != AL_IDLE && now_ns >= machine->deadline_ns) {
        const bool must_end = machine->step == AL_ID_WAIT; /* take the request back before giving up */
        if (!must_end) {
            end(machine, is_id ? CM1E_OK : machine->answered ? CM1E_ERROR_BUS_STATE : CM1E_ERROR_TIMEOUT);
            return false;
        }
        machine->step = AL_ID_END;
        write_control(machine, d, present);
        return true;
    }
    switch (machine->step) {
    case AL_IDLE:
        break;
    case AL_LOOK:
    case AL_ACKNOWLEDGED:
    case AL_WAIT:
    case AL_ID_WAIT:
        cm1e_datagram_set(d, COMMAND_FPRD, machine->station, REG_AL_STATUS, AL_STATUS_BYTES);
        return true;
    case AL_ACKNOWLEDGE:
        write_control(machine, d, acknowledgement(machine));
        return true;
    case AL_REQUEST:
        write_control(machine, d, machine->target);
        return true;
    case AL_ID_ASK:
        write_control(machine, d, present | AL_ID_REQUEST);
        return true;
    case AL_ID_END:
        write_control(machine, d, present);
        return true;
    }
    return false;
}

static void take_status(cm1e_al_machine_t *machine, const cm1e_datagram_t *d)
{
    machine->answered = true;
    machine->state = cm1e_get_u16(d->data);
    machine->code = cm1e_get_u16(d->data + 4);
}

static void after_look(cm1e_al_machine_t *machine)
{
    if (machine->target == 0)
        machine->step = AL_ID_ASK;
    else if (machine->state & AL_ERROR_FLAG)
        machine->step = AL_ACKNOWLEDGE;
    else
        machine->step = AL_REQUEST;
}

static void after_acknowledgement(cm1e_al_machine_t *machine, int64_t now_ns)
{
    if (!(machine->state & AL_ERROR_FLAG)) {
        machine->step = AL_REQUEST;
    } else if (++machine->looks >= ACKNOWLEDGE_LOOKS && now_ns - machine->acknowledged_ns >= ACKNOWLEDGE_NS) {
        machine->without_bit = !machine->without_bit;
        machine->step = AL_ACKNOWLEDGE;
    }
}

static void after_wait(cm1e_al_machine_t *machine)
{
    if (machine->state & AL_ERROR_FLAG)
        end(machine, CM1E_ERROR_BUS_STATE);
    else if ((machine->state & AL_STATE_MASK) == machine->target)
        end(machine, CM1E_OK);
}

void cm1e_al_result(cm1e_al_machine_t *machine, const cm1e_datagram_t *d, int64_t now_ns)
{
    machine->unanswered = d->working_counter == 1 ? 0 : machine->unanswered + 1;
    if (d->working_counter != 1)
        return; /* lost or not answered: the request is repeated until the deadline */
    switch (machine->step) {
    case AL_IDLE:
        break;
    case AL_LOOK:
        take_status(machine, d);
        after_look(machine);
        break;
    case AL_ACKNOWLEDGE:
        machine->looks = 0;
        machine->acknowledged_ns = now_ns;
        machine->step = AL_ACKNOWLEDGED;
        break;
    case AL_ACKNOWLEDGED:
        take_status(machine, d);
        after_acknowledgement(machine, now_ns);
        break;
    case AL_REQUEST:
        machine->step = AL_WAIT;
        break;
    case AL_WAIT:
        take_status(machine, d);
        after_wait(machine);
        break;
    case AL_ID_ASK:
        machine->step = AL_ID_WAIT;
        break;
    case AL_ID_WAIT:
        take_status(machine, d);
        if (machine->state & AL_ID_REQUEST) {
            machine->explicit_id = machine->code;
            machine->step = AL_ID_END;
        }
        break;
    case AL_ID_END:
        end(machine, CM1E_OK);
        break;
    }
}

const char *cm1e_al_state_text(uint16_t al_state)
{
    static const char *const plain[] = {
        [CM1E_AL_NONE] = "no state", [CM1E_AL_INIT] = "INIT", [CM1E_AL_PRE_OP] = "PRE-OP", [CM1E_AL_BOOT] = "BOOT",
        [CM1E_AL_SAFE_OP] = "SAFE-OP", [CM1E_AL_OP] = "OP",
    };
    static const char *const with_error[] = {
        [CM1E_AL_NONE] = "no state + ERROR", [CM1E_AL_INIT] = "INIT + ERROR", [CM1E_AL_PRE_OP] = "PRE-OP + ERROR",
        [CM1E_AL_BOOT] = "BOOT + ERROR", [CM1E_AL_SAFE_OP] = "SAFE-OP + ERROR", [CM1E_AL_OP] = "OP + ERROR",
    };
    const unsigned state = al_state & AL_STATE_MASK;
    const char *const *texts = al_state & AL_ERROR_FLAG ? with_error : plain;
    return state <= CM1E_AL_OP && texts[state] ? texts[state] : "an unknown state";
}
