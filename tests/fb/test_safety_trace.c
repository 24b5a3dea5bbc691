/**
 * What the trace of a run shows of more than two cycles in which the motor did not take part. Frames that do not come
 * back: no time is missing, the set position stands meanwhile and goes on from there without a step. A pause of the
 * master: its times are missing, and the set velocity begins at 0. The set velocity never grows faster than the axis may
 * accelerate.
 */
#include "safety_run.h"

enum { ENABLED = 260, END = 1500, LOST_LIMIT = 10, MOST_ROWS = END + 100 };
enum { FIRST = ENABLED + 60, LAST = ENABLED + 360 }; /* cycles in which silence begins; the motion takes longer */
static const double unit = 50000, limit_u = 20, acceleration_u = 200, cycle_s = 1e-3;
static const double digits = 1e-6; /* of the numbers in the file */
static const double SERVO_OVERSHOOT = 0.003;

typedef struct row {
    double time_s, set, actual, velocity;
} row_t;

static bench_t bench;
static int begin, length;
static bool paused; /**< the master pauses; else frames are lost */
static MC_Power_t power;
static MC_MoveAbsolute_t move;
static row_t rows[MOST_ROWS];
static int row_count;

static cm1e_tap_verdict_t lose(bench_t *b, cm1e_tap_frame_t *frame)
{
    (void)frame;
    return !paused && b->cycle >= begin && b->cycle < begin + length ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

static void program(bench_t *b)
{
    MC_Power(&power);
    move.Execute = b->cycle >= ENABLED;
    MC_MoveAbsolute(&move);
    if (paused && b->cycle == begin)
        bench_miss(b, length * INT64_C(1000000));
    if (b->cycle == END)
        cm1e_scheduler_stop(b->scheduler);
}

static void read_rows(const char *path)
{
    char line[512];
    FILE *file = fopen(path, "r");
    MUST(&bench, file && fgets(line, sizeof line, file), "%s cannot be read", path);
    for (row_count = 0; row_count < MOST_ROWS && fgets(line, sizeof line, file); row_count++) {
        row_t *row = &rows[row_count];
        MUST(&bench, sscanf(line, "%lf,%*[^,],%lf,%lf,%lf", &row->time_s, &row->set, &row->actual, &row->velocity) == 4,
             "not a row: %s", line);
    }
    fclose(file);
    MUST(&bench, row_count > END, "%d rows", row_count);
}

static void run(void)
{
    static const char path[] = CM1E_TEST_OUTPUT "/silence.csv";
    cm1e_diag_t diag = {0};
    bench_free_axes(&bench, 1, CM1E_MAPPING_DYNAMIC, "1.3.5");
    bench_limit_axes(&bench, unit, limit_u, acceleration_u, 4000);
    bench.config.lost_cycles_limit = LOST_LIMIT;
    bench.scheduler_config.trace_capacity = MOST_ROWS;
    bench.program = program;
    bench.fault = lose;
    snprintf(bench.scene, sizeof bench.scene, "%s of %d cycles from %d", paused ? "a pause" : "silence", length,
             begin - ENABLED);
    power = (MC_Power_t){.Axis = &bench.axis[0], .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};
    move = (MC_MoveAbsolute_t){.Axis = &bench.axis[0], .Position = 6, .Velocity = limit_u};
    bench_open(&bench);
    bench_start(&bench);
    MUST(&bench, bench_run(&bench, &diag) == CM1E_OK, "%s", diag.text);
    MUST(&bench, move.Done, "the move is not done");
    MUST(&bench, cm1e_scheduler_write_csv(bench.scheduler, path, &diag) == CM1E_OK, "%s", diag.text);
    bench_close(&bench);
    read_rows(path);
}

static int missing(const row_t *row) { return (int)lround((row->time_s - row[-1].time_s) / cycle_s) - 1; }

/** From one row to the next, whatever lies between. While nothing is heard the actual position is the last one. */
static void judge_row(const row_t *row)
{
    const row_t *shown = row - 1;
    while (shown > rows && shown->actual == shown[-1].actual)
        shown--;
    const double step = fabs(row->set - row[-1].set), way = fabs(row->actual - row[-1].actual);
    const double gain = fabs(row->velocity) - fabs(row[-1].velocity);
    /* The answer that comes after a pause is that to the frame sent at its end, and the one before it a cycle older. */
    const double time_s = row->time_s - shown->time_s + (missing(row) > 0 ? cycle_s : 0);
    MUST(&bench, step <= limit_u * cycle_s + digits, "%.4f s: the set position moves by %.6f u", row->time_s, step);
    MUST(&bench, gain <= acceleration_u * cycle_s + digits, "%.4f s: the set velocity grows by %.6f u/s", row->time_s,
         gain);
    MUST(&bench, way <= limit_u * (1 + SERVO_OVERSHOOT) * time_s + 1 / unit, "%.4f s: the actual position moves by %.6f u",
         row->time_s, way);
}

START_TEST(test_silence_shows_as_a_set_position_that_stands)
{
    paused = false;
    length = 3 + _i;
    for (begin = FIRST; begin < LAST; begin += sweep_stride(23, 151)) {
        run();
        int standing = 0, most = 0;
        for (int i = 1; i < row_count; i++) {
            judge_row(&rows[i]);
            MUST(&bench, missing(&rows[i]) == 0, "%.4f s: a time is missing before", rows[i].time_s);
            const bool moves = i > ENABLED && i < LAST + length;
            standing = moves && rows[i].set == rows[i - 1].set ? standing + 1 : 0;
            most = standing > most ? standing : most;
        }
        MUST(&bench, most == length, "the set position stands for %d cycles", most);
    }
}
END_TEST

START_TEST(test_a_pause_shows_as_missing_times_and_a_velocity_from_0)
{
    paused = true;
    length = 3 + _i;
    for (begin = FIRST; begin < LAST; begin += sweep_stride(23, 151)) {
        run();
        int gaps = 0;
        for (int i = 1; i < row_count; i++) {
            judge_row(&rows[i]);
            if (missing(&rows[i]) == 0)
                continue;
            gaps++;
            /* The cycle that lasted so long is there, with the set-point that it made after that. */
            MUST(&bench, missing(&rows[i]) == length, "%d times are missing", missing(&rows[i]));
            MUST(&bench, fabs(rows[i - 1].velocity) <= acceleration_u * cycle_s + digits,
                 "%.4f s: the set velocity is %.6f u/s", rows[i - 1].time_s, rows[i - 1].velocity);
        }
        MUST(&bench, gaps == 1, "%d gaps", gaps);
    }
}
END_TEST

int main(void)
{
    return bench_main("a trace of silence", 120,
                      (bench_test_t[]){{test_silence_shows_as_a_set_position_that_stands, LOST_LIMIT - 3},
                                       {test_a_pause_shows_as_missing_times_and_a_velocity_from_0, 5}, {0}});
}
