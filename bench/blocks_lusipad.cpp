// lusipad/plcopen (C++17, header-only) as a subject of bench_blocks. bench/blocks takes its source distribution from
// PyPI and builds this file; the build of the library does not know it.
//
// Slaves and masters have to be members of one enabled group there, of at most eight axes. Its MC_CamIn has no input
// for the curve and goes along straight lines; the cubic spline, which its axis has, is asked of the axis by a block
// with the same edge logic. Polynomials of degree 5 it has not. A group runs its members itself.
#include <cstdlib>
#include <memory>
#include <new>

#include "axis/group.h"
#include "axis/state.h"
#include "fb/group.h"
#include "fb/motion.h"
#include "fb/sync.h"

extern "C" {
#include "blocks_subject.h"
}

namespace core = plcopen::core;

namespace
{

constexpr double cycle_s = 1e-3;
std::size_t heap;

class SplineCamIn : public core::fb::SyncExecuteFb
{
public:
    core::axis::CamInCommand command{};

    void call()
    {
        if(rising_edge()) accept(slave_ref->cam_in(command));
        observe_sync();
    }
};

struct Axis
{
    core::axis::AxisModel model;
    core::fb::FbPower power;
    core::fb::FbMoveAbsolute move;
    core::fb::FbGearIn gear;
    core::fb::FbCamIn cam;
    SplineCamIn spline;
};
std::unique_ptr<Axis[]> axes;

struct Group
{
    core::axis::AxisGroup group; // of slaves and their master
    core::axis::AxisGroup path;  // of axes on a path
    core::fb::FbMoveLinearAbsolute line;
    core::fb::FbMoveCircularAbsolute arc;
};
std::unique_ptr<Group[]> groups;

core::exec::CamPoint cam_points[BLOCKS_CAM_POINTS];
blocks_work_t work;
std::size_t group_heap;

bool make(unsigned count)
{
    axes = std::make_unique<Axis[]>(count);
    groups = std::make_unique<Group[]>(count / BLOCKS_SET);
    const std::size_t before = heap;
    const auto one = std::make_unique<core::axis::AxisGroup>();
    group_heap = heap - before;
    for(unsigned i = 0; i < count; i++) {
        core::axis::MotionLimits limits{}; // in units per cycle, as the library has them
        limits.max_velocity = BLOCKS_VELOCITY * cycle_s;
        limits.max_acceleration = limits.max_deceleration = BLOCKS_ACCELERATION * cycle_s * cycle_s;
        limits.max_jerk = BLOCKS_JERK * cycle_s * cycle_s * cycle_s;
        limits.min_position = -1000;
        limits.max_position = 1000;
        limits.min_position_enabled = limits.max_position_enabled = true;
        Axis &axis = axes[i];
        if(axis.model.configure_limits(limits) != core::rt::ErrorCode::ok) return false;
        axis.power.axis_ref = axis.move.axis_ref = &axis.model;
        axis.gear.slave_ref = axis.cam.slave_ref = axis.spline.slave_ref = &axis.model;
        core::axis::AxisModel *master = &axes[i - i % BLOCKS_SET].model;
        axis.gear.master_ref = axis.cam.master_ref = axis.spline.master_ref = master;
        axis.spline.command.master = master;
        axis.power.enable = true;
        axis.power.call();
        if(!axis.power.status) return false;
    }
    for(unsigned k = 0; k < BLOCKS_CAM_POINTS; k++)
        cam_points[k] = {blocks_cam_master(k), blocks_cam(k, 0)};
    for(unsigned i = 0; i < count / BLOCKS_SET; i++)
        groups[i].line.group_ref = groups[i].arc.group_ref = &groups[i].path;
    return true;
}

template <blocks_work_t what> void run_as(unsigned count, unsigned cycles)
{
    while(cycles-- > 0)
        for(unsigned i = 0; i < count; i++) {
            Axis &axis = axes[i];
            axis.power.call();
            if constexpr(what == BLOCKS_GROUP) {
                if(i % BLOCKS_MEMBERS != BLOCKS_MEMBERS - 1) continue;
                Group &group = groups[i / BLOCKS_MEMBERS];
                group.line.call();
                group.arc.call();
                group.path.cycle();
                continue;
            }
            if(!blocks_follows(what, i)) axis.move.call();
            else if constexpr(what == BLOCKS_GEAR) axis.gear.call();
            else if constexpr(what == BLOCKS_CAM_LINEAR) axis.cam.call();
            else axis.spline.call();
            axis.model.cycle();
        }
}

void run(unsigned count, unsigned cycles)
{
    switch(work) {
    case BLOCKS_GEAR: run_as<BLOCKS_GEAR>(count, cycles); break;
    case BLOCKS_CAM_LINEAR: run_as<BLOCKS_CAM_LINEAR>(count, cycles); break;
    case BLOCKS_CAM_CUBIC: run_as<BLOCKS_CAM_CUBIC>(count, cycles); break;
    case BLOCKS_GROUP: run_as<BLOCKS_GROUP>(count, cycles); break;
    default: run_as<BLOCKS_MOVE>(count, cycles); break;
    }
}

void let_go(Axis &axis)
{
    axis.gear.execute = axis.cam.execute = axis.spline.execute = false;
    axis.gear.call();
    axis.cam.call();
    axis.spline.call();
}

void couple(unsigned i, double ratio, double offset, const blocks_move_t *move)
{
    Axis &axis = axes[i];
    let_go(axis);
    axis.gear.ratio_numerator = ratio;
    axis.gear.acceleration = move ? move->acceleration * cycle_s * cycle_s : 0;
    axis.gear.deceleration = move ? move->deceleration * cycle_s * cycle_s : 0;
    axis.gear.jerk = move ? move->jerk * cycle_s * cycle_s * cycle_s : 0;
    axis.cam.cam_table = axis.spline.command.table = {cam_points, BLOCKS_CAM_POINTS, true};
    axis.spline.command.interpolation = core::exec::CamInterpolation::spline;
    axis.cam.slave_offset = axis.spline.command.slave_offset = offset;
    axis.gear.execute = axis.cam.execute = axis.spline.execute = true;
}

bool begin_followers(unsigned count)
{
    for(unsigned i = 0; i < BLOCKS_MAX_AXES; i++) {
        core::axis::AxisGroup &group = groups[i / BLOCKS_SET].group;
        if(group.add_axis(axes[i].model) != core::rt::ErrorCode::ok) return false;
        if(i % BLOCKS_SET == BLOCKS_SET - 1 && group.enable() != core::rt::ErrorCode::ok) return false;
        if(blocks_follows(work, i) && i < count) couple(i, BLOCKS_RATIO, 0, nullptr);
    }
    run(count, 10);
    for(unsigned i = 0; i < count; i++)
        if(blocks_follows(work, i) &&
           !(work == BLOCKS_GEAR ? axes[i].gear.in_gear
             : work == BLOCKS_CAM_LINEAR ? axes[i].cam.in_sync : axes[i].spline.in_sync))
            std::abort();
    return true;
}

bool begin_groups(unsigned count)
{
    for(unsigned i = 0; i < count; i++) {
        core::axis::AxisGroup &group = groups[i / BLOCKS_MEMBERS].path;
        if(group.add_axis(axes[i].model) != core::rt::ErrorCode::ok) return false;
        if(i % BLOCKS_MEMBERS == BLOCKS_MEMBERS - 1 && group.enable() != core::rt::ErrorCode::ok) return false;
    }
    return true;
}

bool begin(blocks_work_t what, unsigned count)
{
    if(what == BLOCKS_CAM_POLYNOMIAL) return false;
    work = what;
    if(what == BLOCKS_MOVE) return true;
    const bool begun = what == BLOCKS_GROUP ? begin_groups(count) : begin_followers(count);
    if(!begun) std::abort();
    return true;
}

// Where a cam begins with a step, its velocity is more than a move could begin with: stopped without a ramp.
void end()
{
    for(unsigned i = 0; i < BLOCKS_MAX_AXES; i++) {
        Axis &axis = axes[i];
        let_go(axis);
        axis.power.enable = false;
        axis.power.call();
        axis.power.enable = true;
        axis.power.call();
    }
    for(unsigned i = 0; i < BLOCKS_MAX_AXES / BLOCKS_SET; i++) {
        groups[i].group.disable();
        groups[i].group.ungroup_all_axes();
        groups[i].path.disable();
        groups[i].path.ungroup_all_axes();
    }
    work = BLOCKS_MOVE;
}

template <typename Block> void set_dynamics(Block &block, const blocks_move_t *move)
{
    block.velocity = move->velocity * cycle_s;
    block.acceleration = move->acceleration * cycle_s * cycle_s;
    block.deceleration = move->deceleration * cycle_s * cycle_s;
    block.jerk = move->jerk * cycle_s * cycle_s * cycle_s;
}

template <typename Block> void blend(Block &block, bool first)
{
    block.execute = false;
    block.call();
    block.buffer_mode = first ? core::axis::BufferMode::aborting : core::axis::BufferMode::blending_high;
    block.transition_mode = first ? core::axis::TransitionMode::none
                                  : core::axis::TransitionMode::max_corner_deviation;
    block.transition_parameter = first ? 0 : BLOCKS_TOLERANCE;
    block.execute = true;
}

void copy(core::axis::GroupPosition &position, const double *values)
{
    position.size = BLOCKS_MEMBERS;
    for(unsigned i = 0; i < BLOCKS_MEMBERS; i++)
        position.value[i] = values[i];
}

void give_path(Group &group, const blocks_move_t *move)
{
    set_dynamics(group.line, move);
    set_dynamics(group.arc, move);
    for(unsigned k = 0; k < BLOCKS_PIECES; k++) {
        const blocks_piece_t piece = blocks_path(move->position != 0, k);
        if(piece.arc) {
            blend(group.arc, k == 0);
            copy(group.arc.aux_point, piece.border);
            copy(group.arc.end_point, piece.end);
            group.arc.path_choice = piece.clockwise ? core::axis::CircPathChoice::clockwise
                                                    : core::axis::CircPathChoice::counter_clockwise;
            group.arc.call();
            if(group.arc.outputs.error) std::abort();
        } else {
            blend(group.line, k == 0);
            copy(group.line.position, piece.end);
            group.line.call();
            if(group.line.outputs.error) std::abort();
        }
    }
}

void give(unsigned index, const blocks_move_t *move)
{
    if(work == BLOCKS_GROUP) {
        if(index % BLOCKS_MEMBERS == 0) give_path(groups[index / BLOCKS_MEMBERS], move);
        return;
    }
    if(blocks_follows(work, index)) return;
    core::fb::FbMoveAbsolute &block = axes[index].move;
    block.execute = false;
    block.call();
    block.position = move->position;
    set_dynamics(block, move);
    block.execute = true;
}

void start(unsigned index, const blocks_move_t *move)
{
    if(work != BLOCKS_GROUP) return couple(index, move->position / 1000, move->position / 100, move);
    Group &group = groups[index / BLOCKS_MEMBERS];
    blend(group.line, true);
    set_dynamics(group.line, move);
    const double end[BLOCKS_MEMBERS] = {move->position, move->position / 2, -move->position / 3};
    copy(group.line.position, end);
}

bool done(unsigned index)
{
    if(work == BLOCKS_GROUP) return groups[index / BLOCKS_MEMBERS].line.outputs.done;
    return blocks_follows(work, index) || axes[index].move.outputs.done;
}

bool failed(unsigned index)
{
    const Axis &axis = axes[index];
    const core::fb::MotionOutputs &outputs = work == BLOCKS_GROUP ? groups[index / BLOCKS_MEMBERS].line.outputs
                                             : !blocks_follows(work, index) ? axis.move.outputs
                                             : work == BLOCKS_GEAR ? axis.gear.outputs
                                             : work == BLOCKS_CAM_LINEAR ? axis.cam.outputs : axis.spline.outputs;
    return outputs.error || outputs.command_aborted;
}

double position(unsigned index) { return axes[index].model.snapshot().command_position; }
std::size_t heap_bytes() { return heap; }

const blocks_bytes_t *bytes()
{
    static const blocks_bytes_t list[] = {{"an axis, with its couplings", sizeof(core::axis::AxisModel)},
                                          {"MC_Power", sizeof(core::fb::FbPower)},
                                          {"MC_MoveAbsolute", sizeof(core::fb::FbMoveAbsolute)},
                                          {"MC_GearIn", sizeof(core::fb::FbGearIn)},
                                          {"MC_CamIn", sizeof(core::fb::FbCamIn)},
                                          {"a group, with its path", group_heap},
                                          {"MC_MoveLinearAbsolute", sizeof(core::fb::FbMoveLinearAbsolute)},
                                          {"MC_MoveCircularAbsolute", sizeof(core::fb::FbMoveCircularAbsolute)},
                                          {nullptr, 0}};
    return list;
}

} // namespace

void *operator new(std::size_t size)
{
    heap += size;
    if(void *memory = std::malloc(size)) return memory;
    throw std::bad_alloc();
}
void operator delete(void *memory) noexcept { std::free(memory); }
void operator delete(void *memory, std::size_t) noexcept { std::free(memory); }

extern "C" {
extern const blocks_subject_t blocks_subject;
const blocks_subject_t blocks_subject = {
    "lusipad/plcopen", make, begin, end, give, start, run, done, failed, position, heap_bytes, bytes,
};
}
