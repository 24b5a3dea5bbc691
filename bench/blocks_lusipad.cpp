// lusipad/plcopen (C++17, header-only) as a subject of bench_blocks. bench/blocks takes its source distribution from
// PyPI and builds this file; the build of the library does not know it.
#include <cstdlib>
#include <memory>
#include <new>

#include "axis/state.h"
#include "fb/motion.h"

extern "C" {
#include "blocks_subject.h"
}

namespace core = plcopen::core;

namespace
{

constexpr double cycle_s = 1e-3;
std::size_t heap;

struct Axis
{
    core::axis::AxisModel model;
    core::fb::FbPower power;
    core::fb::FbMoveAbsolute move;
};
std::unique_ptr<Axis[]> axes;

bool make(unsigned count)
{
    axes = std::make_unique<Axis[]>(count);
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
        axis.power.enable = true;
        axis.power.call();
        if(!axis.power.status) return false;
    }
    return true;
}

void give(unsigned index, const blocks_move_t *move)
{
    core::fb::FbMoveAbsolute &block = axes[index].move;
    block.execute = false;
    block.call();
    block.position = move->position;
    block.velocity = move->velocity * cycle_s;
    block.acceleration = move->acceleration * cycle_s * cycle_s;
    block.deceleration = move->deceleration * cycle_s * cycle_s;
    block.jerk = move->jerk * cycle_s * cycle_s * cycle_s;
    block.execute = true;
}

void run(unsigned count, unsigned cycles)
{
    while(cycles-- > 0)
        for(unsigned i = 0; i < count; i++) {
            axes[i].power.call();
            axes[i].move.call();
            axes[i].model.cycle();
        }
}

bool done(unsigned index) { return axes[index].move.outputs.done; }
bool failed(unsigned index) { return axes[index].move.outputs.error || axes[index].move.outputs.command_aborted; }
std::size_t heap_bytes() { return heap; }

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
    "lusipad/plcopen", make, give, run, done, failed, heap_bytes,
    sizeof(core::axis::AxisModel), sizeof(core::fb::FbPower), sizeof(core::fb::FbMoveAbsolute),
};
}
