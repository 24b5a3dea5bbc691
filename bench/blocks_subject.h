/**
 * @file blocks_subject.h
 * What bench_blocks asks of an implementation of function blocks, so that it can time this library and another one with
 * the same work in one process. The other one comes as a shared library that exports `blocks_subject`.
 * Units: u, s; the cycle is 1 ms.
 */
#ifndef CM1E_BENCH_BLOCKS_SUBJECT_H
#define CM1E_BENCH_BLOCKS_SUBJECT_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct blocks_move {
    double position, velocity, acceleration, deceleration, jerk;
} blocks_move_t;

/** The number of axes. bench_limits has a few only, because they start under an instruction counter. */
#ifndef BLOCKS_AXES
#define BLOCKS_AXES 256
#endif

/** The largest values of the bench's moves. */
enum { BLOCKS_VELOCITY = 300, BLOCKS_ACCELERATION = 3000, BLOCKS_JERK = 60000, BLOCKS_MAX_AXES = BLOCKS_AXES };

/** What the axes do while they are timed. Every axis has an MC_Power besides, called in every cycle. */
typedef enum blocks_work {
    BLOCKS_MOVE = 0,   /**< each its MC_MoveAbsolute */
    BLOCKS_GEAR,       /**< of BLOCKS_SET axes the first its MC_MoveAbsolute, the others MC_GearIn to it, 1 : 2 */
    BLOCKS_CAM_LINEAR, /**< as before, MC_CamIn with the cam of blocks_cam() */
    BLOCKS_CAM_CUBIC,
    BLOCKS_CAM_POLYNOMIAL,
    BLOCKS_GROUP,      /**< groups of three, on the path of blocks_path(), given ahead by one MC_MoveLinearAbsolute and
                            one MC_MoveCircularAbsolute, both called in every cycle */
    BLOCKS_WORKS,
} blocks_work_t;

enum {
    BLOCKS_SET = 8,    /**< a master and its slaves: so many fit a group of the peer, which it needs for them */
    BLOCKS_MEMBERS = 3,
    BLOCKS_GROUPS = BLOCKS_AXES / 8, /**< most of them */
    BLOCKS_CAM_POINTS = 33, /**< 32 pieces of BLOCKS_CAM_PERIOD u of the master */
    BLOCKS_CAM_PERIOD = 100,
    BLOCKS_PIECES = 8, /**< of the path */
};
#define BLOCKS_RATIO 0.5
#define BLOCKS_CAM_HEIGHT 10.0
#define BLOCKS_FAR 250.0      /**< where the moves go; and back to 0 */
#define BLOCKS_TOLERANCE 0.2  /**< u, at the corners of the path that have to be rounded */

static inline bool blocks_follows(blocks_work_t work, unsigned axis)
{
    return work >= BLOCKS_GEAR && work < BLOCKS_GROUP && axis % BLOCKS_SET != 0;
}

/** Position of the master at a point of the cam. */
static inline double blocks_cam_master(unsigned point)
{
    return (double)BLOCKS_CAM_PERIOD * point / (BLOCKS_CAM_POINTS - 1);
}

/** Position of the slave there, up and down once, or a derivative of it by the master's. */
static inline double blocks_cam(unsigned point, unsigned derivative)
{
    const double turns = 6.283185307179586 / BLOCKS_CAM_PERIOD, angle = turns * blocks_cam_master(point);
    const double half = BLOCKS_CAM_HEIGHT / 2;
    return derivative == 0 ? half * (1 - cos(angle)) : derivative == 1 ? half * turns * sin(angle)
                                                                     : half * turns * turns * cos(angle);
}

/** A piece of the path: a line to `end`, or an arc through `border` to it. */
typedef struct blocks_piece {
    bool arc, clockwise;
    double border[BLOCKS_MEMBERS], end[BLOCKS_MEMBERS];
} blocks_piece_t;

/** Lines and arcs that touch, in the plane of the first two axes, and a line up; or the way back. */
static inline blocks_piece_t blocks_path(bool far, unsigned piece)
{
    /* of a circle of radius 10: the middle of a quarter */
    static const double near = 10 * 0.29289321881345254, wide = 10 * 0.70710678118654746;
    const blocks_piece_t pieces[BLOCKS_PIECES + 1] = {
        {false, false, {0, 0, 0}, {0, 0, 0}},
        {false, false, {0, 0, 0}, {40, 0, 0}},
        {true, false, {40 + wide, near, 0}, {50, 10, 0}},
        {false, false, {0, 0, 0}, {50, 50, 0}},
        {true, true, {50 + near, 50 + wide, 0}, {60, 60, 0}},
        {false, false, {0, 0, 0}, {100, 60, 0}},
        {true, false, {100 + wide, 60 + near, 0}, {110, 70, 0}},
        {false, false, {0, 0, 0}, {110, 110, 0}},
        {false, false, {0, 0, 0}, {140, 140, 40}},
    };
    if (far)
        return pieces[piece + 1];
    blocks_piece_t back = pieces[BLOCKS_PIECES - piece];
    back.clockwise = !back.clockwise;
    for (unsigned i = 0; i < BLOCKS_MEMBERS; i++)
        back.end[i] = pieces[BLOCKS_PIECES - piece - 1].end[i];
    return back;
}

static inline double blocks_random(uint64_t *state, double low, double high) /* splitmix64 */
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

/** A command for the starts. */
static inline blocks_move_t blocks_random_move(uint64_t *state)
{
    return (blocks_move_t){
        .position = blocks_random(state, -200, 200),
        .velocity = blocks_random(state, 0.1, 1) * BLOCKS_VELOCITY,
        .acceleration = blocks_random(state, 0.1, 1) * BLOCKS_ACCELERATION,
        .deceleration = blocks_random(state, 0.1, 1) * BLOCKS_ACCELERATION,
        .jerk = blocks_random(state, 0.1, 1) * BLOCKS_JERK,
    };
}

typedef struct blocks_bytes {
    const char *what; /**< NULL ends the list */
    size_t bytes;
} blocks_bytes_t;

typedef struct blocks_subject {
    const char *name;
    /** Once: makes the axes, powered, at rest at 0. */
    bool (*make)(unsigned axes);
    /** The work of the first `axes` axes from now on: they stand at 0, slaves are in step before the first move. 0
     *  axes: slaves wait for start(). FALSE: it has nothing like that. */
    bool (*begin)(blocks_work_t work, unsigned axes);
    /** Each axis by its MC_MoveAbsolute again, which may abort what still moves. */
    void (*end)(void);
    /** The next move of an axis, or path of the first axis of a group, which goes as far as blocks_path() says where
     *  `move->position` is not 0. Nothing for slaves, and for further axes of a group. Begins in the next cycle. */
    void (*give)(unsigned axis, const blocks_move_t *move);
    /** A command of which the start is timed, for a slave or the first axis of a group: inputs of its block, with
     *  ratio, offset or target by `move->position` (-200 ... 200). The next cycle sees a rising edge. */
    void (*start)(unsigned axis, const blocks_move_t *move);
    /** That many cycles of the first `axes` axes: all blocks called, then the axes' own work. */
    void (*run)(unsigned axes, unsigned cycles);
    bool (*done)(unsigned axis);
    bool (*failed)(unsigned axis);
    double (*position)(unsigned axis);
    /** Bytes taken from the heap since the start of the process. */
    size_t (*heap_bytes)(void);
    const blocks_bytes_t *(*bytes)(void);
} blocks_subject_t;

#endif
