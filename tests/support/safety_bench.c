#include "safety_bench.h"

/* ---- the witness ------------------------------------------------------------------------------------------------- */

void bench_fail(const bench_t *bench, const char *format, ...)
{
    char words[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words, sizeof words, format, arguments);
    va_end(arguments);
    ck_abort_msg("%s, cycle %d: %s", bench->scene, bench->cycle, words);
    abort();
}

static void locate(const cm1e_pdo_t *pdo, int base, uint16_t index, int *place)
{
    int bits = base * 8;
    *place = -1;
    for (int i = 0; i < pdo->entry_count; i++) {
        if (pdo->entries[i].index == index)
            *place = bits / 8;
        bits += pdo->entries[i].bits;
    }
}

static int pdo_bytes(const cm1e_pdo_t *pdo)
{
    int bits = 0;
    for (int i = 0; i < pdo->entry_count; i++)
        bits += pdo->entries[i].bits;
    return (bits + 7) / 8;
}

static double or_else(double value, double otherwise) { return value > 0 ? value : otherwise; }

static uint32_t bench_position(const bench_t *bench, uint32_t n)
{
    return bench->config.axes[n].address ? bench->config.axes[n].address : n + 1;
}

/** An axis of the slave at a position, by its connector (0: a CM1-E has none); -1: none is configured. */
static int axis_at(const bench_t *bench, uint32_t position, unsigned channel)
{
    for (uint32_t n = 0; n < bench->config.axis_count; n++)
        if (bench_position(bench, n) == position && bench->config.axes[n].channel == channel)
            return (int)n;
    return -1;
}

const cm1e_firmware_info_t *bench_firmware(const cm1e_axis_config_t *axis)
{
    return cm1e_firmware_from_version(axis->firmware[0] ? axis->firmware : "1.3.5");
}

static void witness_limits(const bench_t *bench, uint32_t n, witness_t *w)
{
    const cm1e_axis_config_t *axis = &bench->config.axes[n];
    const double count = cm1e_unit_counts_per_revolution(axis) / CM1E_COUNTS_PER_REVOLUTION;
    const double unit = or_else(axis->counts_per_unit, CM1E_COUNTS_PER_REVOLUTION * count);
    const double peak = cm1e_unit_peak_velocity(axis);
    const double cycle_s = (double)bench->config.cycle_time_ns * 1e-9;
    const double gain = or_else(axis->max_acceleration * unit, 5e6 * count);
    w->bridged = axis->channel != 0;
    w->peak_step = peak * cycle_s;
    w->max_step = fmin(or_else(axis->max_velocity * unit, peak), peak) * cycle_s;
    w->max_gain = gain * cycle_s * cycle_s;
    w->max_loss = or_else(axis->max_deceleration * unit, gain) * cycle_s * cycle_s;
    w->max_lag = or_else(axis->max_position_lag * unit, 25000 * count);
    w->velocity_unit = !w->bridged && bench_firmware(axis)->velocity_in_counts_per_ms ? 1000.0 : 1.0;
    w->mode = axis->mapping == CM1E_MAPPING_CSV ? CM1E_MODE_CSV : CM1E_MODE_CSP;
}

/** One direction of one axis at `base`; returns its bytes. `n` < 0: a motor behind a bridge that nobody uses. */
static int locate_axis(bench_t *bench, int n, unsigned channel, bool transmit, int base)
{
    cm1e_pdo_t pdo;
    const cm1e_axis_config_t *axis = n < 0 ? NULL : &bench->config.axes[n];
    const uint16_t offset = (uint16_t)(channel ? (channel - 1) * CM1E_BRIDGE_INDEX_INCREMENT : 0);
    if (channel)
        cm1e_bridge_pdo(&pdo, channel - 1, transmit);
    else
        cm1e_device_pdo(&pdo, axis->mapping, transmit, bench->config.sim_pdo_order, bench_firmware(axis)->firmware);
    witness_t nobody, *w = n < 0 ? &nobody : &bench->witness[n];
    if (transmit) {
        locate(&pdo, base, (uint16_t)(OBJ_6041_STATUSWORD + offset), &w->in_statusword);
        locate(&pdo, base, (uint16_t)(OBJ_6064_POSITION_ACTUAL_VALUE + offset), &w->in_position);
        locate(&pdo, base, (uint16_t)(OBJ_6061_MODES_OF_OPERATION_DISPLAY + offset), &w->in_mode);
    } else {
        locate(&pdo, base, (uint16_t)(OBJ_6040_CONTROLWORD + offset), &w->out_controlword);
        locate(&pdo, base, (uint16_t)(OBJ_607A_TARGET_POSITION + offset), &w->out_position);
        locate(&pdo, base, (uint16_t)(OBJ_60FF_TARGET_VELOCITY + offset), &w->out_velocity);
        locate(&pdo, base, (uint16_t)(OBJ_6060_MODES_OF_OPERATION + offset), &w->out_mode);
    }
    return pdo_bytes(&pdo);
}

bool is_bridge(const bench_t *bench, uint32_t position)
{
    for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES; channel++)
        if (axis_at(bench, position, channel) >= 0)
            return true;
    return false;
}

/** One direction of one slave at `base`; returns its bytes. */
static int locate_slave(bench_t *bench, uint32_t position, bool transmit, int base)
{
    int at = base;
    if (!is_bridge(bench, position))
        return locate_axis(bench, axis_at(bench, position, 0), 0, transmit, at);
    for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES; channel++)
        at += locate_axis(bench, axis_at(bench, position, channel), channel, transmit, at);
    return at - base;
}

/** All outputs, then all inputs, each in the order of the slaves. */
static void locate_apart(bench_t *bench)
{
    int at = 0;
    for (int transmit = 0; transmit < 2; transmit++) {
        for (uint32_t position = 1; position <= (uint32_t)bench->slaves; position++)
            at += locate_slave(bench, position, transmit, at);
        if (!transmit)
            bench->output_bytes = at;
    }
    bench->image_bytes = at;
}

/** Slave by slave: its inputs in the place of its outputs, but for four bytes; behind all the number of the cycle. */
static void locate_overlapped(bench_t *bench)
{
    int at = 0;
    for (uint32_t position = 1; position <= (uint32_t)bench->slaves; position++) {
        const int outputs = locate_slave(bench, position, false, at);
        const int inputs = locate_slave(bench, position, true, at); /* their number */
        const int bytes = inputs > outputs + 4 ? inputs : outputs + 4;
        locate_slave(bench, position, true, at + bytes - inputs);
        at += bytes;
    }
    bench->image_bytes = at + 4;
}

static void witness_layout(bench_t *bench)
{
    bench->slaves = 0;
    for (uint32_t n = 0; n < bench->config.axis_count; n++) {
        bench->witness[n] = (witness_t){0};
        witness_limits(bench, n, &bench->witness[n]);
        if ((int)bench_position(bench, n) > bench->slaves)
            bench->slaves = (int)bench_position(bench, n);
    }
    if (bench->config.overlap)
        locate_overlapped(bench);
    else
        locate_apart(bench);
}

uint16_t word_at(const uint8_t *data, int place) { return (uint16_t)(data[place] | data[place + 1] << 8); }

int32_t long_at(const uint8_t *data, int place)
{
    return (int32_t)((uint32_t)word_at(data, place) | (uint32_t)word_at(data, place + 2) << 16);
}

bool is_process_data(const bench_t *bench, const cm1e_tap_frame_t *frame)
{
    return frame->length >= (size_t)LRW_DATA + (size_t)bench->image_bytes + 2 && frame->bytes[16] == LRW &&
           (word_at(frame->bytes, 22) & 0x7FF) == bench->image_bytes;
}

cm1e_sim_cm1e_t *bench_drive(const bench_t *bench, uint32_t n)
{
    return cm1e_sim_cm1e_of(cm1e_sim_segment_slave(bench->segment, bench_position(bench, n)));
}

cm1e_sim_bridge_axis_t *bench_motor(const bench_t *bench, uint32_t n)
{
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(bench->segment, bench_position(bench, n)));
    return bridge ? &bridge->axes[bench->config.axes[n].channel - 1] : NULL;
}

/** As the device has it. */
static int8_t true_mode(const bench_t *bench, uint32_t n)
{
    return bench->witness[n].bridged ? bench_motor(bench, n)->mode
                                     : (int8_t)bench_drive(bench, n)->objects.mode_display;
}

/** It has all datagrams that its header tells of; there may be others behind the process data. */
static bool is_whole(const cm1e_tap_frame_t *frame)
{
    return frame->length >= 16u + (word_at(frame->bytes, 14) & 0x7FF);
}

/** Outputs come back as they left; overlapped, the number of the cycle does. */
static bool is_of_last_frame(const bench_t *bench, const uint8_t *data)
{
    const int from = bench->config.overlap ? bench->image_bytes - 4 : 0;
    const int to = bench->config.overlap ? bench->image_bytes : bench->output_bytes;
    return memcmp(data + from, bench->last_sent + from, (size_t)(to - from)) == 0;
}

static double counts_between(int32_t to, int32_t from) { return (double)(int32_t)((uint32_t)to - (uint32_t)from); }

/** Inputs that the master may believe: of the frame it sent last, with every slave's part in it. */
static void witness_received(bench_t *bench, const cm1e_tap_frame_t *frame)
{
    const uint8_t *data = frame->bytes + LRW_DATA;
    const uint32_t count = bench->config.axis_count;
    if (frame->bytes[17] != bench->last_index || frame->delay_ns > 0 || !is_whole(frame) ||
        word_at(data, bench->image_bytes) != SLAVE_WORKING_COUNTER * bench->slaves ||
        !is_of_last_frame(bench, data))
        return;
    bench->answered = true;
    for (uint32_t n = 0; n < count; n++) {
        witness_t *w = &bench->witness[n];
        w->statusword = word_at(data, w->in_statusword);
        w->position_before = w->shown ? w->position : long_at(data, w->in_position);
        w->position = long_at(data, w->in_position);
        w->shaft = counts_between(w->position, w->position_before) / fmax(bench->cycle - w->cycle_shown, 1);
        w->cycle_shown = bench->cycle;
        w->mode_shown = w->in_mode < 0 ? true_mode(bench, n) : (int8_t)data[w->in_mode];
        w->shown = true;
    }
}

/** Where the mode comes over SDO, the master learns late that the drive is back from homing; it keeps its target
 *  meanwhile, whatever the motor does about it. */
static bool at_shown_position(const bench_t *bench, const witness_t *w, bool enabling_before, int32_t target_before)
{
    return w->target == w->position || (bench->frames_late && w->target == w->position_before) ||
           (w->in_mode < 0 && enabling_before && w->target == target_before);
}

/** A shaft that turns when it gets its torque is braked from there: never faster than it was seen to turn, nor the other
 *  way. */
static bool brakes(const bench_t *bench, const witness_t *w)
{
    const double cycle_s = (double)bench->config.cycle_time_ns * 1e-9;
    const bool in_csv = w->out_position < 0;
    const double step = in_csv ? w->velocity * cycle_s : counts_between(w->target, w->position);
    const double least = in_csv ? w->velocity_unit * cycle_s : 1;
    return step * w->shaft > 0 && fabs(step) <= fabs(w->shaft) + least;
}

/** A motor that its axis catches when it gets its torque has turned round: its target meets it there (docs/SAFETY.md). It
 *  comes nearer, and is no farther beyond than the way of the motor in a cycle. */
static bool meets(const witness_t *w, double off, double step, double shaft)
{
    return fabs(off) < fabs(off - step) && (off * (off - step) >= 0 || fabs(off) <= shaft + 1) &&
           fabs(step) <= w->peak_step + 1;
}

bool began_anew(const bench_t *bench, uint32_t n, const witness_t *w, double step)
{
    cm1e_axis_info_t info = {0};
    cm1e_axis_read(bench->axis[n], &info);
    const double off = (double)(int32_t)((uint32_t)w->target - (uint32_t)w->position);
    const bool moving = info.state == CM1E_AXIS_DISCRETE_MOTION || info.state == CM1E_AXIS_CONTINUOUS_MOTION ||
                        info.state == CM1E_AXIS_SYNCHRONIZED_MOTION;
    const double shaft = fabs((double)(int32_t)((uint32_t)w->position - (uint32_t)w->position_before));
    if (!moving && step * (off - step) < 0 && fabs(off) <= fabs(off - step) && fabs(step) <= w->max_step + 1.0)
        return true; /* on the way back there, no faster than the axis may go */
    if (info.state == CM1E_AXIS_DISABLED && meets(w, off, step, shaft))
        return true;
    /* A motor that has just got its torque is seen every cycle: its target is no farther ahead than its way in one. */
    const double most = info.state == CM1E_AXIS_DISABLED ? shaft : fmax(w->max_step, 3 * shaft);
    return !moving && (step == 0 || fabs(off) <= most + 1.0);
}

/** A load has turned the shaft on while no targets came: it is ahead of its target by more than a servo ever puts it.
 *  Then the target goes after it: with any step that does not lead beyond the shaft, or with smaller and smaller ones. */
static bool goes_after(const witness_t *w, double step)
{
    const double shaft = counts_between(w->position, w->position_before), sign = copysign(1, w->direction);
    const double lead = sign * (counts_between(w->position, w->target) + step + shaft); /* before this step */
    return w->direction != 0 && step * sign >= 0 && lead > 0.25 * fmax(fabs(w->step), fabs(step)) + 2 &&
           (lead >= fabs(step) || fabs(step) <= fabs(w->step) + w->max_gain + 2);
}

/** Set-points may neither be faster nor change faster than the axis's limits say; a target is rounded to counts. */
static void judge_step(const bench_t *bench, uint32_t n, witness_t *w, double step)
{
    const double change = fabs(step) - fabs(w->step);
    const double most = fmax(w->max_gain, w->max_loss) + 2.0;
    const bool slow = fabs(step) <= w->max_step + 1.0;
    const bool within = change <= w->max_gain + 2.0 && -change <= w->max_loss + 2.0;
    /* Braking that turns the motion round may be harder than speeding up may be, and takes its time to ease. */
    w->eased_cycles = step * w->direction < 0 ? 0 : within && change <= w->max_gain + 1.0 ? w->eased_cycles + 1 : 0;
    w->turning = step * w->direction < 0 || (w->turning && w->eased_cycles < 20);
    w->direction = step != 0 ? step : w->direction;
    const bool after = goes_after(w, step), like_ramp = fabs(step - w->ramp_step) <= most;
    const bool smooth = (fabs(step - w->step) <= most && (w->turning || within)) || after || like_ramp;
    const bool begins = after && bench_info(bench, n).state == CM1E_AXIS_DISABLED;
    w->ramp_step = begins ? counts_between(w->target, w->position) : NAN;
    w->set_points++;
    if (!(slow && smooth) && began_anew(bench, n, w, step)) {
        w->step = step == 0 ? 0 : (double)(int32_t)((uint32_t)w->target - (uint32_t)w->position);
        w->new_beginnings++;
        return;
    }
    MUST(bench, slow, "axis %u: the target moves by %.0f counts in a cycle, limit %.1f", n, step, w->max_step);
    MUST(bench, smooth, "axis %u: steps of %.0f, then %.0f counts; limits: %.1f more, %.1f less", n, w->step, step,
         w->max_gain, w->max_loss);
    w->step = step;
}

/** While nobody knows which target the drive holds, it stays. With the first answer the motor goes on no faster than it
 *  did before, if it has not slowed down meanwhile. TRUE: that is all there is to say about this step. */
static bool judge_silence(const bench_t *bench, uint32_t n, witness_t *w, double step)
{
    const bool was_silent = w->silent;
    w->silent = !bench->answered;
    if (w->silent) { /* in another mode, which only frames with a wrong counter have shown, it takes no targets */
        MUST(bench, step == 0 || w->target == w->position || true_mode(bench, n) != w->mode, "axis %u: the target moves by %.0f counts while no frame comes back", n, step);
        return true;
    }
    const bool turns = step * w->step < 0 && fabs(step) > w->max_gain + 1.0; /* from rest it may go either way */
    if (!was_silent || turns || fabs(step) > fabs(w->step) + w->max_gain + 1.0)
        return false;
    w->step = step;
    return true;
}

/** Without an error a motor is brought to rest first: nobody takes its torque away at speed, if it follows. */
static void judge_end_of_torque(const bench_t *bench, uint32_t n, const witness_t *w)
{
    cm1e_axis_info_t info = {0};
    cm1e_axis_read(bench->axis[n], &info);
    if (info.state == CM1E_AXIS_ERROR_STOP)
        return;
    const double lag = (double)(int32_t)((uint32_t)w->target - (uint32_t)w->position);
    MUST(bench, fabs(w->step) <= 2 * w->max_loss + 3 || fabs(lag) > 0.9 * w->max_lag,
         "axis %u, %s: torque is taken away at %.0f counts a cycle", n, cm1e_axis_state_name(info.state), w->step);
}

bool takes_targets(const witness_t *w)
{
    if (!w->bridged)
        return (w->statusword & 0x6F) == 0x27 && w->mode_shown == w->mode;
    return w->mode_shown == CM1E_BRIDGE_MODE_CPIO ? (w->statusword & 0x0F) == 0x07
                                                  : (w->statusword & 0x4F) == 0x07 && w->mode_shown == w->mode;
}

/** Behind a bridge the same word is another command in another mode (BR 6.1.2, 7.1.2). 0000h is none in any. */
static void judge_word(const bench_t *bench, uint32_t n, uint16_t word)
{
    const int8_t mode = true_mode(bench, n);
    const unsigned high = word >> 8;
    bool right = false;
    switch (mode) {
    case CM1E_BRIDGE_MODE_CSP: right = high == 0 && !(word & 0x10); break;
    case CM1E_BRIDGE_MODE_HM: right = high == 0; break;
    case CM1E_BRIDGE_MODE_CMD: right = (word & 0xFF) == 0x07 && (high == 0 || (high >= 0xF1 && high <= 0xF6)); break;
    case CM1E_BRIDGE_MODE_CPIO: right = word >> 12 == 0xC; break;
    default: break;
    }
    MUST(bench, right || word == 0, "axis %u: controlword %04Xh in mode %d", n, word, mode);
}

static void witness_sent_axis(bench_t *bench, uint32_t n, const uint8_t *data)
{
    witness_t *w = &bench->witness[n];
    if (w->holding && (word_at(data, w->out_controlword) & 0x08) == 0)
        judge_end_of_torque(bench, n, w);
    const int32_t target_before = w->target;
    if (bench->paused) { /* the motor stands at that target */
        w->step = 0;
        bench->answered = true;
    }
    const bool enabling_before = w->enabling, holding_before = w->holding;
    w->controlword = word_at(data, w->out_controlword);
    w->enabling = (w->controlword & 0x08) != 0;
    w->target = w->out_position < 0 ? w->position : long_at(data, w->out_position);
    w->velocity = w->out_velocity < 0 ? 0 : long_at(data, w->out_velocity) * w->velocity_unit;
    w->holding = w->enabling && takes_targets(w);
    if (w->bridged)
        judge_word(bench, n, w->controlword);
    const double most = w->max_step * 1e9 / (double)bench->config.cycle_time_ns;
    MUST(bench, fabs(w->velocity) <= most + w->velocity_unit, "axis %u: target velocity %.0f, limit %.0f", n,
         w->velocity, most);
    if (!w->enabling || bench->config.axes[n].motion == CM1E_MOTION_DRIVE)
        return;
    if (!enabling_before)
        w->enablings++;
    MUST(bench, w->shown, "axis %u: enabled although the drive has not shown its position yet", n);
    if (w->mode_shown == CM1E_MODE_HM && enabling_before)
        return; /* takes no targets */
    if (!w->holding || !holding_before) { /* the drive may act on this frame, or acts on it as the first one */
        const bool braked = w->holding && brakes(bench, w);
        MUST(bench, braked || at_shown_position(bench, w, enabling_before, target_before),
             "axis %u: controlword 0x%04X, statusword 0x%04X, mode %d: target %d, but the drive is at %d", n,
             w->controlword, w->statusword, w->mode_shown, w->target, w->position);
        MUST(bench, braked || w->velocity == 0, "axis %u: controlword 0x%04X, statusword 0x%04X: target velocity %.0f", n,
             w->controlword, w->statusword, w->velocity);
        w->step = braked ? counts_between(w->target, w->position) : 0;
        w->silent = false;
        return;
    }
    const double step = (double)(int32_t)((uint32_t)w->target - (uint32_t)target_before);
    if (w->out_position >= 0 && !judge_silence(bench, n, w, step))
        judge_step(bench, n, w, step);
}

cm1e_tap_verdict_t bench_tap(void *context, cm1e_tap_frame_t *frame)
{
    bench_t *bench = context;
    if (!is_process_data(bench, frame))
        return CM1E_TAP_PASS;
    cm1e_tap_verdict_t verdict = bench->fault ? bench->fault(bench, frame) : CM1E_TAP_PASS;
    if (frame->direction == CM1E_TAP_RECEIVED) {
        if (verdict == CM1E_TAP_PASS && is_process_data(bench, frame))
            witness_received(bench, frame);
        if (verdict == CM1E_TAP_PASS && bench->lie)
            bench->lie(bench, frame->bytes + LRW_DATA);
        return verdict;
    }
    bench->process_frames++;
    bench->last_index = frame->bytes[17];
    memcpy(bench->last_sent, frame->bytes + LRW_DATA, (size_t)bench->image_bytes);
    for (uint32_t n = 0; n < bench->config.axis_count; n++)
        witness_sent_axis(bench, n, frame->bytes + LRW_DATA);
    bench->answered = bench->paused = false;
    return verdict;
}

/* ---- the bench --------------------------------------------------------------------------------------------------- */

void bench_random_axis(cm1e_axis_config_t *axis, cm1e_firmware_t oldest)
{
    const double unit = one_in(3) ? 50000 : uniform(50, 5000);
    snprintf(axis->firmware, sizeof axis->firmware, "%s",
             cm1e_firmware_info((cm1e_firmware_t)(oldest + pick(CM1E_FIRMWARE_COUNT - oldest)))->version);
    snprintf(axis->motor, sizeof axis->motor, "%s", cm1e_device_motors[pick(4)].name);
    axis->mapping = one_in(2) ? CM1E_MAPPING_DYNAMIC : (cm1e_mapping_t)pick(4);
    axis->counts_per_unit = unit;
    axis->invert = one_in(2);
    axis->max_velocity = uniform(50000, 1200000) / unit;
    axis->max_acceleration = uniform(300000, 6000000) / unit;
    axis->max_deceleration = uniform(300000, 6000000) / unit;
    axis->max_jerk = uniform(1e7, 3e8) / unit;
    axis->homing = (cm1e_homing_config_t){.method = (int8_t)(-1 - pick(6)), .velocity = 100000 / unit,
                                          .acceleration = 2000000 / unit, .timeout_s = 5};
    if (one_in(2)) {
        axis->software_limit_negative = uniform(-180000, -20000) / unit;
        axis->software_limit_positive = uniform(20000, 180000) / unit;
    }
    axis->sim.no_stops = one_in(4);
}

void bench_describe(bench_t *bench, uint32_t axes)
{
    cm1e_bus_config_free(&bench->config);
    cm1e_bus_config_init(&bench->config, "sim", axes);
    bench->config.virtual_time = true;
    bench->config.cycle_time_ns = 1000000;
    for (uint32_t n = 0; n < axes; n++) {
        cm1e_axis_config_t *axis = &bench->config.axes[n];
        axis->counts_per_unit = 1000;
        axis->homing = (cm1e_homing_config_t){.method = -2, .velocity = 100, .acceleration = 2000, .torque = 30};
    }
}

void bench_cycle(void *context)
{
    bench_t *bench = context;
    bench->program(bench);
    bench->cycle++;
}

void bench_open(bench_t *bench)
{
    cm1e_diag_t diag = {0};
    bench->cycle = 0;
    bench->process_frames = 0;
    bench->config.overlap = getenv("CM1E_TEST_OVERLAP") != NULL;
    witness_layout(bench);
    if (cm1e_bus_open(&bench->bus, &bench->config, &diag) != CM1E_OK)
        bench_fail(bench, "%s", diag.text);
    bench->segment = cm1e_bus_segment(bench->bus);
    cm1e_nic_set_tap(cm1e_bus_nic(bench->bus), bench_tap, bench);
}

void bench_start(bench_t *bench)
{
    cm1e_diag_t diag = {0};
    if (cm1e_bus_start(bench->bus, &diag) != CM1E_OK ||
        cm1e_scheduler_create(&bench->scheduler, bench->bus, &bench->scheduler_config, &diag) != CM1E_OK)
        bench_fail(bench, "%s", diag.text);
    const cm1e_task_config_t task = {.program = bench_cycle, .context = bench};
    if (cm1e_scheduler_add_task(bench->scheduler, &task, &diag) != CM1E_OK)
        bench_fail(bench, "%s", diag.text);
    for (uint32_t n = 0; n < bench->config.axis_count; n++)
        bench->axis[n] = cm1e_scheduler_axis(bench->scheduler, n);
}

cm1e_sim_probe_t bench_probe(const bench_t *bench, uint32_t n)
{
    cm1e_sim_probe_t probe;
    cm1e_sim_probe_channel(bench->segment, bench_position(bench, n), bench->config.axes[n].channel, &probe);
    return probe;
}

void bench_probe_reset(const bench_t *bench, uint32_t n)
{
    cm1e_sim_probe_reset_channel(bench->segment, bench_position(bench, n), bench->config.axes[n].channel);
}

cm1e_axis_info_t bench_info(const bench_t *bench, uint32_t n)
{
    cm1e_axis_info_t info = {0};
    cm1e_axis_read(bench->axis[n], &info);
    return info;
}

void bench_console(bench_t *bench, const char *format, ...)
{
    char line[96], answer[256] = "";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    if (cm1e_bus_simulate(bench->bus, line, answer, sizeof answer) != CM1E_OK)
        bench_fail(bench, "console: %s: %s", line, answer);
}

void bench_miss(bench_t *bench, int64_t silence_ns)
{
    cm1e_clock_t *clock = cm1e_bus_clock(bench->bus);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + silence_ns);
    const int64_t missed = silence_ns / bench->config.cycle_time_ns;
    const bool noticed = missed > 0;
    bench->paused = missed > CM1E_AXIS_RIDDEN_OUT_CYCLES;
    bench->answered = bench->answered && !noticed; /* the target stays until the next answer */
}

cm1e_error_t bench_run(bench_t *bench, cm1e_diag_t *diag)
{
    return cm1e_scheduler_run(bench->scheduler, 0, diag);
}

void bench_close(bench_t *bench)
{
    cm1e_scheduler_destroy(bench->scheduler);
    cm1e_bus_close(bench->bus);
    bench->scheduler = NULL;
    bench->bus = NULL;
}
