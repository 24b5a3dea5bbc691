/** This library as a subject of bench_blocks: without the drive below the axis (a), and with it (a+b). */
#include "blocks_cm1e.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assembly/assembly.h"
#include "axis/axis_setpoint.h"
#include "bridge/cool_muscle.h"
#include "cm1e/plcopen.h"
#include "coupling/coupling_private.h"
#include "homing/homing.h"

enum { BUSES = 2, BUS_AXES = BLOCKS_MAX_AXES / BUSES };
#define CYCLE_NS INT64_C(1000000)
#define ALWAYS_INLINE static inline __attribute__((always_inline))

static cm1e_bus_t *buses[BUSES];
static cm1e_axis_t *axes[BLOCKS_MAX_AXES];
static AXIS_REF_t references[BLOCKS_MAX_AXES];
static MC_Power_t powers[BLOCKS_MAX_AXES];
static MC_MoveAbsolute_t moves[BLOCKS_MAX_AXES];
static MC_GearIn_t gears[BLOCKS_MAX_AXES];
static MC_CamIn_t cams[BLOCKS_MAX_AXES];
static AXES_GROUP_REF_t groups[BLOCKS_GROUPS];
static MC_MoveLinearAbsolute_t lines[BLOCKS_GROUPS];
static MC_MoveCircularAbsolute_t arcs[BLOCKS_GROUPS];
static int64_t cycle_now_ns;
static blocks_work_t work;
static size_t axis_heap, group_heap;
static size_t plain_heap, unasked_heap; /* of an axis that follows nothing; of that, for what it may follow */

static void fail(const char *why)
{
    fprintf(stderr, "%s\n", why);
    exit(1);
}

/* The process image stands still while the bench runs, so the lag grows with the set-point and must be allowed. What a
 * slave needs goes far beyond what the moves ask for. */
static cm1e_bus_t *start_bus(void)
{
    cm1e_bus_config_t config;
    cm1e_bus_config_init(&config, "sim", BUS_AXES);
    config.virtual_time = true;
    config.cycle_time_ns = CYCLE_NS;
    for (uint32_t i = 0; i < BUS_AXES; i++) {
        cm1e_axis_config_t *axis = &config.axes[i];
        axis->counts_per_unit = 500;
        axis->max_velocity = BLOCKS_VELOCITY;
        axis->max_acceleration = axis->max_deceleration = 20 * BLOCKS_ACCELERATION;
        axis->max_jerk = 100 * BLOCKS_JERK;
        axis->software_limit_negative = -1000;
        axis->software_limit_positive = 1000;
        axis->max_position_lag = 1e6;
    }
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_bus_config_free(&config);
    return bus;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

ALWAYS_INLINE void run_programs(blocks_work_t what, unsigned i)
{
    MC_Power(&powers[i]);
    if (what == BLOCKS_GROUP) {
        if (i % BLOCKS_MEMBERS == 0) {
            MC_MoveLinearAbsolute(&lines[i / BLOCKS_MEMBERS]);
            MC_MoveCircularAbsolute(&arcs[i / BLOCKS_MEMBERS]);
        }
    } else if (!blocks_follows(what, i))
        MC_MoveAbsolute(&moves[i]);
    else if (what == BLOCKS_GEAR)
        MC_GearIn(&gears[i]);
    else
        MC_CamIn(&cams[i]);
}

/* (a): the programs and what the axis does for them. Masters are advanced after the programs, as they are always. */
ALWAYS_INLINE void run_blocks_of(blocks_work_t what, unsigned count, unsigned cycles)
{
    while (cycles-- > 0) {
        for (unsigned i = 0; i < count; i++) {
            run_programs(what, i);
            if (what == BLOCKS_MOVE)
                cm1e_axis_advance(axes[i]);
        }
        for (unsigned i = 0; i < count && what != BLOCKS_MOVE; i++)
            cm1e_axis_advance(axes[i]);
    }
}

/* (a+b): the same in the scheduler's order: inputs of all axes, programs, outputs of all axes. */
ALWAYS_INLINE void run_whole_of(blocks_work_t what, unsigned count, unsigned cycles)
{
    while (cycles-- > 0) {
        cycle_now_ns += CYCLE_NS;
        for (unsigned i = 0; i < count; i++)
            cm1e_axis_inputs(axes[i], CM1E_OK, CM1E_OK, cycle_now_ns);
        for (unsigned i = 0; i < count; i++)
            run_programs(what, i);
        for (unsigned i = 0; i < count; i++)
            cm1e_axis_outputs(axes[i]);
    }
}

static void run_blocks(unsigned count, unsigned cycles)
{
    switch (work) {
    case BLOCKS_MOVE: run_blocks_of(BLOCKS_MOVE, count, cycles); break;
    case BLOCKS_GEAR: run_blocks_of(BLOCKS_GEAR, count, cycles); break;
    case BLOCKS_GROUP: run_blocks_of(BLOCKS_GROUP, count, cycles); break;
    default: run_blocks_of(BLOCKS_CAM_CUBIC, count, cycles); break;
    }
}

static void run_whole(unsigned count, unsigned cycles)
{
    switch (work) {
    case BLOCKS_MOVE: run_whole_of(BLOCKS_MOVE, count, cycles); break;
    case BLOCKS_GEAR: run_whole_of(BLOCKS_GEAR, count, cycles); break;
    case BLOCKS_GROUP: run_whole_of(BLOCKS_GROUP, count, cycles); break;
    default: run_whole_of(BLOCKS_CAM_CUBIC, count, cycles); break;
    }
}

/* Whole cycles, frames included. */
static void run_cycle(unsigned count, unsigned cycles)
{
    while (cycles-- > 0) {
        for (unsigned i = 0; i < BUSES; i++) {
            cm1e_clock_sleep_until(cm1e_bus_clock(buses[i]), cycle_now_ns + CYCLE_NS);
            if (cm1e_bus_receive(buses[i]) != CM1E_OK)
                fail("a frame was lost");
        }
        run_whole(count, 1);
        for (unsigned i = 0; i < BUSES; i++)
            cm1e_bus_send(buses[i]);
    }
}

/* ---- axes -------------------------------------------------------------------------------------------------------- */

static void make_groups(void)
{
    cm1e_diag_t diag = {0};
    const cm1e_group_config_t config = {.name = ""};
    for (unsigned i = 0; i < BLOCKS_GROUPS; i++) {
        const size_t before = blocks_heap_bytes();
        if (cm1e_group_create(&groups[i], &config, &diag) != CM1E_OK)
            fail(diag.text);
        group_heap = blocks_heap_bytes() - before;
        lines[i].AxesGroup = arcs[i].AxesGroup = &groups[i];
    }
}

/* Made without the room of couplings, it has all that an axis has for other purposes. */
static void weigh_an_axis_that_follows_nothing(void)
{
    cm1e_diag_t diag = {0};
    cm1e_bus_config_t config;
    cm1e_bus_t *bus = NULL;
    cm1e_axis_t *axis = NULL, *without = NULL;
    cm1e_bus_config_init(&config, "sim", 1);
    config.virtual_time = true;
    config.axes[0].follows = CM1E_FOLLOWS_NOTHING;
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_bus_config_free(&config);
    const size_t before = blocks_heap_bytes();
    if (cm1e_axis_create(&axis, bus, 0, &diag) != CM1E_OK)
        fail(diag.text);
    plain_heap = blocks_heap_bytes() - before;
    if (cm1e_axis_make(&without, bus, 0, &diag) != CM1E_OK || cm1e_homing_add(without, &diag) != CM1E_OK ||
        cm1e_cool_muscle_add(without, &diag) != CM1E_OK)
        fail(diag.text);
    unasked_heap = 2 * plain_heap + before - blocks_heap_bytes() - sizeof(followed_t);
    cm1e_axis_destroy(without);
    cm1e_axis_destroy(axis);
    cm1e_bus_close(bus);
}

static bool make(unsigned count)
{
    cm1e_diag_t diag = {0};
    if (axes[0])
        return true; /* our two subjects work on the same axes */
    weigh_an_axis_that_follows_nothing();
    for (unsigned i = 0; i < BUSES; i++)
        buses[i] = start_bus();
    for (unsigned i = 0; i < count; i++) {
        const size_t before = blocks_heap_bytes();
        if (cm1e_axis_create(&axes[i], buses[i / BUS_AXES], i % BUS_AXES, &diag) != CM1E_OK)
            fail(diag.text);
        axis_heap = blocks_heap_bytes() - before;
        references[i] = cm1e_axis_reference(axes[i]);
        AXIS_REF_t *axis = &references[i], *master = &references[i - i % BLOCKS_SET];
        powers[i] = (MC_Power_t){.Axis = axis, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
        moves[i].Axis = axis;
        gears[i] = (MC_GearIn_t){.Master = master, .Slave = axis, .RatioNumerator = 1, .RatioDenominator = 2};
        cams[i] = (MC_CamIn_t){.Master = master, .Slave = axis, .StartMode = mcRampIn};
    }
    make_groups();
    cycle_now_ns = cm1e_clock_now(cm1e_bus_clock(buses[0]));
    run_cycle(count, 200); /* the way to Operation enabled needs the frames */
    bool powered = true;
    for (unsigned i = 0; i < count; i++)
        powered &= powers[i].Status;
    return powered;
}

static double position(unsigned i)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axes[i], &info);
    return info.set_position;
}

/* ---- groups ------------------------------------------------------------------------------------------------------ */

static bool begin_groups(unsigned count)
{
    for (unsigned i = 0; i < count / BLOCKS_MEMBERS; i++) {
        for (unsigned k = 0; k < BLOCKS_MEMBERS; k++) {
            MC_AddAxisToGroup_t add = {.AxesGroup = &groups[i], .Axis = &references[i * BLOCKS_MEMBERS + k],
                                       .IdentInGroup = (MC_IDENT_IN_GROUP)(k + 1), .Execute = TRUE};
            MC_AddAxisToGroup(&add);
            if (!add.Done)
                fail("MC_AddAxisToGroup: an error");
        }
        MC_GroupEnable_t enable = {.AxesGroup = &groups[i], .Execute = TRUE};
        MC_GroupEnable(&enable);
        if (!enable.Done)
            fail("MC_GroupEnable: an error");
    }
    return true;
}

/* They come to rest first. */
static void end_groups(void)
{
    for (unsigned i = 0; i < BLOCKS_GROUPS; i++) {
        MC_UngroupAllAxes_t ungroup = {.AxesGroup = &groups[i], .Execute = TRUE};
        for (int cycle = 0; cycle < 10000 && !ungroup.Done; cycle++) {
            MC_UngroupAllAxes(&ungroup);
            run_blocks((i + 1) * BLOCKS_MEMBERS, 1);
        }
        if (!ungroup.Done)
            fail("MC_UngroupAllAxes: not done");
    }
}

static void prepare_line(unsigned group, const double *end, const blocks_move_t *move, bool first)
{
    MC_MoveLinearAbsolute_t *line = &lines[group];
    line->Execute = FALSE;
    MC_MoveLinearAbsolute(line);
    memcpy(line->Position, end, BLOCKS_MEMBERS * sizeof *end);
    line->Velocity = move->velocity;
    line->Acceleration = move->acceleration;
    line->Deceleration = move->deceleration;
    line->Jerk = move->jerk;
    line->BufferMode = first ? mcAborting : mcBlendingHigh;
    line->TransitionMode = first ? mcTMNone : mcTMMaxCornerDeviation;
    line->TransitionParameter = first ? 0 : BLOCKS_TOLERANCE;
    line->Execute = TRUE;
}

static void prepare_arc(unsigned group, const blocks_piece_t *piece, const blocks_move_t *move)
{
    MC_MoveCircularAbsolute_t *arc = &arcs[group];
    arc->Execute = FALSE;
    MC_MoveCircularAbsolute(arc);
    arc->CircMode = mcBorder;
    memcpy(arc->AuxPoint, piece->border, sizeof piece->border);
    memcpy(arc->EndPoint, piece->end, sizeof piece->end);
    arc->Velocity = move->velocity;
    arc->Acceleration = move->acceleration;
    arc->Deceleration = move->deceleration;
    arc->Jerk = move->jerk;
    arc->BufferMode = mcBlendingHigh;
    arc->TransitionMode = mcTMMaxCornerDeviation;
    arc->TransitionParameter = BLOCKS_TOLERANCE;
    arc->Execute = TRUE;
}

static void give_path(unsigned group, const blocks_move_t *move)
{
    for (unsigned k = 0; k < BLOCKS_PIECES; k++) {
        const blocks_piece_t piece = blocks_path(move->position != 0, k);
        if (piece.arc) {
            prepare_arc(group, &piece, move);
            MC_MoveCircularAbsolute(&arcs[group]);
        } else {
            prepare_line(group, piece.end, move, k == 0);
            MC_MoveLinearAbsolute(&lines[group]);
        }
        if (lines[group].Error || arcs[group].Error) {
            char text[CM1E_GROUP_ERROR_TEXT_BYTES];
            cm1e_group_error_text(groups[group], text, sizeof text);
            fail(text);
        }
    }
}

/* ---- followers --------------------------------------------------------------------------------------------------- */

static void select_cam(unsigned i)
{
    static const MC_CAM_CURVE curves[BLOCKS_WORKS] = {
        [BLOCKS_CAM_LINEAR] = mcCamLinear,
        [BLOCKS_CAM_CUBIC] = mcCamCubicSpline,
        [BLOCKS_CAM_POLYNOMIAL] = mcCamPolynomial5,
    };
    static MC_CAM_POINT points[BLOCKS_CAM_POINTS];
    for (unsigned k = 0; k < BLOCKS_CAM_POINTS; k++) {
        points[k] = (MC_CAM_POINT){.Master = blocks_cam_master(k), .Slave = blocks_cam(k, 0),
                                   .Velocity = blocks_cam(k, 1), .Acceleration = blocks_cam(k, 2)};
    }
    const MC_CAM_REF cam = {.Points = points, .NumberOfPoints = BLOCKS_CAM_POINTS, .Curve = curves[work]};
    MC_CamTableSelect_t select = {.Slave = &references[i], .CamTable = &cam, .Execute = TRUE, .Periodic = TRUE,
                                  .MasterAbsolute = TRUE, .SlaveAbsolute = TRUE};
    MC_CamTableSelect(&select);
    MC_CamTableSelect(&select);
    if (!select.Done) {
        char text[CM1E_AXIS_ERROR_TEXT_BYTES];
        cm1e_axis_error_text(references[i], text, sizeof text);
        fail(text);
    }
    cams[i].CamTableID = select.CamTableID;
    cams[i].SlaveOffset = 0;
}

static void let_go(unsigned i)
{
    gears[i].Execute = cams[i].Execute = FALSE;
    MC_GearIn(&gears[i]);
    MC_CamIn(&cams[i]);
}

static bool begin(blocks_work_t what, unsigned count)
{
    work = what;
    if (what == BLOCKS_GROUP)
        return begin_groups(count);
    for (unsigned i = 0; i < BLOCKS_MAX_AXES && what != BLOCKS_MOVE; i++) {
        let_go(i);
        gears[i].RatioNumerator = 1;
        gears[i].RatioDenominator = 2;
        if (what != BLOCKS_GEAR && blocks_follows(what, i))
            select_cam(i);
        gears[i].Execute = cams[i].Execute = i < count;
    }
    run_blocks(count, 10);
    for (unsigned i = 0; i < count; i++)
        if (blocks_follows(what, i) && !(what == BLOCKS_GEAR ? gears[i].InGear : cams[i].InSync))
            fail("a slave is not in step");
    return true;
}

static void end(void)
{
    if (work == BLOCKS_GROUP)
        end_groups();
    for (unsigned i = 0; i < BLOCKS_MAX_AXES; i++)
        let_go(i);
    work = BLOCKS_MOVE;
}

static void start(unsigned i, const blocks_move_t *move)
{
    if (work == BLOCKS_GROUP) {
        const double target[] = {move->position, move->position / 2, -move->position / 3};
        prepare_line(i / BLOCKS_MEMBERS, target, move, true);
        return;
    }
    let_go(i);
    gears[i].RatioNumerator = (DINT)(move->position * 1000);
    gears[i].RatioDenominator = 1000 * 1000;
    gears[i].Acceleration = move->acceleration;
    gears[i].Deceleration = move->deceleration;
    gears[i].Jerk = move->jerk;
    cams[i].SlaveOffset = move->position / 100;
    gears[i].Execute = cams[i].Execute = TRUE;
}

/* ---- moves ------------------------------------------------------------------------------------------------------- */

static void give(unsigned i, const blocks_move_t *move)
{
    if (work == BLOCKS_GROUP && i % BLOCKS_MEMBERS == 0)
        give_path(i / BLOCKS_MEMBERS, move);
    if (work == BLOCKS_GROUP || blocks_follows(work, i))
        return;
    moves[i].Execute = FALSE;
    MC_MoveAbsolute(&moves[i]);
    moves[i].Position = move->position;
    moves[i].Velocity = move->velocity;
    moves[i].Acceleration = move->acceleration;
    moves[i].Deceleration = move->deceleration;
    moves[i].Jerk = move->jerk;
    moves[i].Execute = TRUE;
}

static bool done(unsigned i)
{
    return work == BLOCKS_GROUP ? lines[i / BLOCKS_MEMBERS].Done : blocks_follows(work, i) || moves[i].Done;
}

static bool failed(unsigned i)
{
    if (work == BLOCKS_GROUP)
        return lines[i / BLOCKS_MEMBERS].Error || lines[i / BLOCKS_MEMBERS].CommandAborted;
    if (!blocks_follows(work, i))
        return moves[i].Error || moves[i].CommandAborted;
    return work == BLOCKS_GEAR ? gears[i].Error || gears[i].CommandAborted : cams[i].Error || cams[i].CommandAborted;
}

static const blocks_bytes_t *bytes(void)
{
    static blocks_bytes_t list[] = {{"an axis, with its couplings and cams", 0},
                                    {"an axis that follows nothing", 0},
                                    {"of that for what it may follow", 0},
                                    {"of that for its followers", sizeof(followed_t)},
                                    {"of that the axis itself", sizeof(struct cm1e_axis)},
                                    {"MC_Power", sizeof(MC_Power_t)},
                                    {"MC_MoveAbsolute", sizeof(MC_MoveAbsolute_t)},
                                    {"MC_GearIn", sizeof(MC_GearIn_t)},
                                    {"MC_CamIn", sizeof(MC_CamIn_t)},
                                    {"a group, with its path", 0},
                                    {"MC_MoveLinearAbsolute", sizeof(MC_MoveLinearAbsolute_t)},
                                    {"MC_MoveCircularAbsolute", sizeof(MC_MoveCircularAbsolute_t)},
                                    {NULL, 0}};
    list[0].bytes = axis_heap;
    list[1].bytes = plain_heap;
    list[2].bytes = unasked_heap;
    list[9].bytes = group_heap;
    return list;
}

#define OURS make, begin, end, give, start
const blocks_subject_t blocks_cm1e = {"cm1e (a)", OURS, run_blocks, done, failed, position, blocks_heap_bytes, bytes};
const blocks_subject_t blocks_cm1e_whole = {"cm1e (a+b)", OURS,   run_whole,         done,
                                            failed,       position, blocks_heap_bytes, bytes};
const blocks_subject_t blocks_cm1e_cycle = {"cm1e, all",  OURS,     run_cycle,         done,
                                            failed,       position, blocks_heap_bytes, bytes};
