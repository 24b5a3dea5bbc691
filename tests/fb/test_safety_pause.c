/**
 * A master that pauses in the middle of a motion, for 1 ... 95 ms, at every phase of it: the next set-points begin at
 * rest where the motor stands and keep the axis's limits (the witness of safety_bench.h), the motion ends where it was
 * to end, a stop that was under way ends there, and nothing is an error. In CSV, where the motor goes on alone, its
 * velocity does not jump.
 */
#include "safety_run.h"

enum { WATCHDOG_MS = 95 };
static const double speed_u = 300, way_u = 60;

typedef enum motion { MOTION_ABSOLUTE = 0, MOTION_VELOCITY, MOTION_STOP, MOTION_POWER_OFF, MOTIONS } motion_t;

static bench_t bench;
static motion_t motion;
static int pause_ms, pause_at, end_at;
static MC_Power_t power;
static MC_MoveAbsolute_t absolute;
static MC_MoveVelocity_t velocity;
static MC_Stop_t stop;
static double speed_before, fastest, hardest, at_pause;

static void watch(bench_t *b)
{
    const double speed = bench_probe(b, 0).velocity_counts_per_s;
    if (b->cycle > pause_at + 1)
        hardest = fmax(hardest, fabs(speed - speed_before));
    speed_before = speed;
    fastest = fmax(fastest, fabs(speed));
}

static void program(bench_t *b)
{
    MC_Power(&power);
    absolute.Execute = motion == MOTION_ABSOLUTE && power.Status;
    velocity.Execute = motion != MOTION_ABSOLUTE && power.Status;
    MC_MoveAbsolute(&absolute);
    MC_MoveVelocity(&velocity);
    if (b->cycle == 200)
        stop.Execute = motion == MOTION_STOP;
    MC_Stop(&stop);
    if (b->cycle == 200 && motion == MOTION_POWER_OFF)
        power.Enable = FALSE;
    watch(b);
    if (b->cycle == pause_at) {
        at_pause = bench_info(b, 0).set_position;
        bench_miss(b, pause_ms * INT64_C(1000000));
    }
    if (b->cycle == end_at)
        cm1e_scheduler_stop(b->scheduler);
}

static void judge_end(void)
{
    const cm1e_axis_info_t info = bench_info(&bench, 0);
    MUST(&bench, info.state != CM1E_AXIS_ERROR_STOP, "error %d", info.error);
    MUST(&bench, fastest < 1.05 * speed_u * 1000, "%.0f counts/s", fastest);
    if (motion == MOTION_ABSOLUTE)
        MUST(&bench, fabs(info.set_position - way_u) < 1e-6, "ends at %g", info.set_position);
    if (bench.config.axes[0].mapping == CM1E_MAPPING_CSV && pause_ms > CM1E_AXIS_RIDDEN_OUT_CYCLES)
        MUST(&bench, hardest < 12000, "the velocity jumps by %.0f counts/s", hardest);
}

static void run(void)
{
    snprintf(bench.scene, sizeof bench.scene, "motion %d, mapping %d, %d ms in cycle %d", motion,
             bench.config.axes[0].mapping, pause_ms, pause_at);
    speed_before = fastest = hardest = 0;
    power = (MC_Power_t){.Axis = &bench.axis[0], .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
    absolute = (MC_MoveAbsolute_t){.Axis = &bench.axis[0], .Position = way_u, .Velocity = speed_u};
    velocity = (MC_MoveVelocity_t){.Axis = &bench.axis[0], .Velocity = speed_u};
    stop = (MC_Stop_t){.Axis = &bench.axis[0]};
    bench_play(&bench);
}

static void program_then_judge(bench_t *b)
{
    if (b->cycle == end_at)
        judge_end();
    program(b);
}

START_TEST(test_pause_at_every_phase_of_a_motion_makes_no_step)
{
    static const int pauses[] = {1, 2, 3, 4, 5, 8, 20, 50, WATCHDOG_MS};
    motion = (motion_t)(_i % MOTIONS);
    for (int mapping = CM1E_MAPPING_DYNAMIC; mapping <= CM1E_MAPPING_CSV; mapping += CM1E_MAPPING_CSV)
        for (size_t p = 0; p < sizeof pauses / sizeof pauses[0]; p++)
            for (pause_at = 20; pause_at < 420; pause_at += 13 * slowness()) {
                bench_free_axes(&bench, 1, (cm1e_mapping_t)mapping, "1.3.5");
                bench.config.axes[0].max_jerk = 50000;
                bench.program = program_then_judge;
                pause_ms = pauses[p];
                end_at = 1400;
                run();
            }
}
END_TEST

int main(void)
{
    return bench_main("a master that pauses", 120,
                      (bench_test_t[]){{test_pause_at_every_phase_of_a_motion_makes_no_step, MOTIONS}, {0}});
}
