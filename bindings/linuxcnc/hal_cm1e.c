/*
 * HAL component cm1e for LinuxCNC (uspace): the axes and signals of a cm1e bus file as pins. It starts cm1e-linuxcnc,
 * which owns the bus, and exchanges a command and a state with it in every servo period. The functions never wait.
 */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "hal.h"
#include "rtapi.h"
#include "rtapi_app.h"

#include "stream_link.h"

MODULE_AUTHOR("cm1e");
MODULE_DESCRIPTION("Myostat CM1-E servo motors and other EtherCAT slaves, by a cm1e bus file");
MODULE_LICENSE("GPL");

static char *bus = "";
RTAPI_MP_STRING(bus, "bus file");
static char *interface = "";
RTAPI_MP_STRING(interface, "network interface; default: that of the bus file");
static char *program = "cm1e-linuxcnc";
RTAPI_MP_STRING(program, "program that owns the bus");
static char *delay = "4";
RTAPI_MP_STRING(delay, "servo periods that the axes are behind LinuxCNC");
static char *tolerance = "0";
RTAPI_MP_STRING(tolerance, "largest distance between LinuxCNC and an axis at machine-on; 0: 1000 counts");
static char *timeout = "0";
RTAPI_MP_STRING(timeout, "ms of silence of LinuxCNC that stop all axes; 0: 20");
static int period = 1000000;
RTAPI_MP_INT(period, "ns; the period of the servo thread");

int rtapi_app_main(void);
void rtapi_app_exit(void);

enum { START_MS = 60000, END_MS = 15000, STALE_MS = 50 };

typedef struct axis_pins {
    hal_float_t *pos_cmd, *pos_fb, *vel_fb, *pos_set, *following_error, *torque;
    hal_bit_t *enable, *reset, *home, *enabled, *fault, *homing, *homed, *powered, *online;
    hal_bit_t *inputs[STREAM_INPUTS], *outputs[STREAM_OUTPUTS];
    hal_s32_t *error;
} axis_pins_t;

typedef union signal_pin {
    hal_bit_t *bit;
    hal_float_t *number;
} signal_pin_t;

typedef struct pins {
    hal_bit_t *enable_in, *ok;
    hal_u32_t *lost_frames;
    hal_float_t *delay_ms;
    axis_pins_t axes[STREAM_AXES];
    signal_pin_t inputs[STREAM_SIGNALS], outputs[STREAM_SIGNALS];
} pins_t;

static int component = -1, link_fd = -1;
static pid_t child = -1;
static stream_link_t *shared = MAP_FAILED;
static pins_t *pins;
static stream_command_t command;
static stream_state_t state;
static int64_t age_ns;
static bool wrong_period;

/* ---- in the servo thread ----------------------------------------------------------------------------------------- */

static void show_axis(const axis_pins_t *p, const stream_axis_state_t *axis)
{
    *p->pos_fb = axis->position;
    *p->vel_fb = axis->velocity;
    *p->pos_set = axis->set_position;
    *p->following_error = axis->lag;
    *p->torque = axis->torque;
    *p->enabled = (axis->flags & STREAM_ENABLED) != 0;
    *p->fault = (axis->flags & STREAM_FAULT) != 0;
    *p->homing = (axis->flags & STREAM_HOMING) != 0;
    *p->homed = (axis->flags & STREAM_HOMED) != 0;
    *p->powered = (axis->flags & STREAM_POWERED) != 0;
    *p->online = (axis->flags & STREAM_ONLINE) != 0;
    *p->error = axis->error;
    for (int i = 0; i < STREAM_INPUTS; i++)
        *p->inputs[i] = (axis->inputs >> i & 1) != 0;
}

static void read_state(void *unused, long period_ns)
{
    (void)unused;
    age_ns += period_ns;
    if (stream_take_state(shared, &state))
        age_ns = 0;
    const bool runs = atomic_load_explicit(&shared->phase, memory_order_relaxed) == STREAM_RUNNING;
    *pins->ok = runs && age_ns < STALE_MS * 1000000LL && !state.lost && !wrong_period;
    *pins->lost_frames = (hal_u32_t)state.lost_frames;
    *pins->delay_ms = state.delay * (double)period_ns * 1e-6;
    for (uint32_t i = 0; i < shared->axis_count; i++) {
        show_axis(&pins->axes[i], &state.axes[i]);
        if (!*pins->ok) /* nothing else would tell LinuxCNC that the bus is gone */
            *pins->axes[i].fault = 1;
    }
    for (uint32_t i = 0; i < shared->input_count; i++) {
        if (shared->inputs[i].bit)
            *pins->inputs[i].bit = state.inputs[i] != 0.0;
        else
            *pins->inputs[i].number = state.inputs[i];
    }
}

static void write_command(void *unused, long period_ns)
{
    (void)unused;
    if (period_ns != period && !wrong_period) {
        wrong_period = true;
        rtapi_print_msg(RTAPI_MSG_ERR, "cm1e: the servo period is %ld ns; loadrt cm1e needs period=%ld\n", period_ns,
                        period_ns);
    }
    command.enable = command.reset = command.home = 0;
    command.stop = !*pins->enable_in || wrong_period;
    for (uint32_t i = 0; i < shared->axis_count; i++) {
        const axis_pins_t *p = &pins->axes[i];
        command.positions[i] = *p->pos_cmd;
        command.enable |= (uint32_t)(*p->enable != 0) << i;
        command.reset |= (uint32_t)(*p->reset != 0) << i;
        command.home |= (uint32_t)(*p->home != 0) << i; /* the end of an emergency stop is no edge */
        command.digital[i] = 0;
        for (uint32_t n = 0; n < shared->digital_outputs[i]; n++)
            command.digital[i] |= (uint32_t)(*p->outputs[n] != 0) << n;
    }
    for (uint32_t i = 0; i < shared->output_count; i++)
        command.outputs[i] = shared->outputs[i].bit ? *pins->outputs[i].bit != 0 : *pins->outputs[i].number;
    (void)stream_put_command(shared, &command);
}

/* ---- pins -------------------------------------------------------------------------------------------------------- */

static int bit(hal_pin_dir_t direction, hal_bit_t **pin, const char *name, const char *what)
{
    return hal_pin_bit_newf(direction, pin, component, "cm1e.%s.%s", name, what);
}

static int number(hal_pin_dir_t direction, hal_float_t **pin, const char *name, const char *what)
{
    return hal_pin_float_newf(direction, pin, component, "cm1e.%s.%s", name, what);
}

static int make_axis(axis_pins_t *p, const char *name, uint32_t outputs)
{
    int error = number(HAL_IN, &p->pos_cmd, name, "pos-cmd") | number(HAL_OUT, &p->pos_fb, name, "pos-fb") |
                number(HAL_OUT, &p->vel_fb, name, "vel-fb") | number(HAL_OUT, &p->pos_set, name, "pos-set") |
                number(HAL_OUT, &p->following_error, name, "following-error") |
                number(HAL_OUT, &p->torque, name, "torque") | bit(HAL_IN, &p->enable, name, "enable") |
                bit(HAL_IN, &p->reset, name, "reset") | bit(HAL_IN, &p->home, name, "home") |
                bit(HAL_OUT, &p->enabled, name, "enabled") | bit(HAL_OUT, &p->fault, name, "fault") |
                bit(HAL_OUT, &p->homing, name, "homing") | bit(HAL_OUT, &p->homed, name, "homed") |
                bit(HAL_OUT, &p->powered, name, "powered") | bit(HAL_OUT, &p->online, name, "online") |
                hal_pin_s32_newf(HAL_OUT, &p->error, component, "cm1e.%s.error", name);
    for (int n = 0; n < STREAM_INPUTS && !error; n++)
        error = hal_pin_bit_newf(HAL_OUT, &p->inputs[n], component, "cm1e.%s.in-%d", name, n + 1);
    for (uint32_t n = 0; n < outputs && !error; n++)
        error = hal_pin_bit_newf(HAL_IN, &p->outputs[n], component, "cm1e.%s.out-%u", name, n + 1);
    return error;
}

static int make_signal(signal_pin_t *pin, const stream_signal_t *signal, hal_pin_dir_t direction)
{
    return signal->bit ? bit(direction, &pin->bit, "io", signal->name)
                       : number(direction, &pin->number, "io", signal->name);
}

static int make_pins(void)
{
    pins = hal_malloc(sizeof *pins);
    if (!pins)
        return -ENOMEM;
    memset(pins, 0, sizeof *pins);
    int error = hal_pin_bit_newf(HAL_IN, &pins->enable_in, component, "cm1e.enable-in") |
                hal_pin_bit_newf(HAL_OUT, &pins->ok, component, "cm1e.ok") |
                hal_pin_u32_newf(HAL_OUT, &pins->lost_frames, component, "cm1e.lost-frames") |
                hal_pin_float_newf(HAL_OUT, &pins->delay_ms, component, "cm1e.delay-ms");
    for (uint32_t i = 0; i < shared->axis_count && !error; i++)
        error = make_axis(&pins->axes[i], shared->axis_names[i], shared->digital_outputs[i]);
    for (uint32_t i = 0; i < shared->input_count && !error; i++)
        error = make_signal(&pins->inputs[i], &shared->inputs[i], HAL_OUT);
    for (uint32_t i = 0; i < shared->output_count && !error; i++)
        error = make_signal(&pins->outputs[i], &shared->outputs[i], HAL_IN);
    if (!error)
        error = hal_export_funct("cm1e.read", read_state, NULL, 1, 0, component) |
                hal_export_funct("cm1e.write", write_command, NULL, 1, 0, component);
    return error;
}

/* ---- the process of the bus -------------------------------------------------------------------------------------- */

static void rest_ms(long ms) { nanosleep(&(struct timespec){.tv_nsec = ms * 1000000}, NULL); }

static bool has_ended(void) { return child < 0 || waitpid(child, NULL, WNOHANG) != 0; }

/* In the child: as the user, and not with the rights of rtapi_app. */
static void become(void)
{
    char number_text[16];
    snprintf(number_text, sizeof number_text, "%d", link_fd);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    if (setresgid(getgid(), getgid(), getgid()) == 0 && setresuid(getuid(), getuid(), getuid()) == 0) {
        char *arguments[] = {program, "-b", bus, "--link", number_text, "--delay", delay, "--tolerance", tolerance,
                             "--timeout", timeout, interface[0] ? "-i" : NULL, interface, NULL};
        execvp(program, arguments);
    }
    _exit(127);
}

static int start_bus(void)
{
    link_fd = memfd_create("cm1e", 0);
    if (link_fd < 0 || ftruncate(link_fd, sizeof *shared) != 0)
        return -errno;
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, link_fd, 0);
    if (shared == MAP_FAILED)
        return -errno;
    stream_link_init(shared, period);
    child = fork();
    if (child == 0)
        become();
    for (int ms = 0; ms < START_MS && child > 0; ms += 10) {
        if (atomic_load_explicit(&shared->phase, memory_order_acquire) == STREAM_RUNNING)
            return 0;
        if (has_ended()) {
            child = -1;
            break;
        }
        rest_ms(10);
    }
    rtapi_print_msg(RTAPI_MSG_ERR, "cm1e: %s does not run the bus of %s. %s\n", program, bus,
                    shared->text[0] ? shared->text : "Is it on PATH?");
    return -EIO;
}

static void end_bus(void)
{
    if (child > 0) {
        atomic_store(&shared->quit, 1);
        for (int ms = 0; ms < END_MS && !has_ended(); ms += 10)
            rest_ms(10);
        child = -1;
    }
    if (shared != MAP_FAILED)
        munmap(shared, sizeof *shared);
    if (link_fd >= 0)
        close(link_fd);
}

int rtapi_app_main(void)
{
    component = hal_init("cm1e");
    if (component < 0)
        return component;
    int error = bus[0] ? start_bus() : -EINVAL;
    if (!bus[0])
        rtapi_print_msg(RTAPI_MSG_ERR, "cm1e: loadrt cm1e needs bus=FILE\n");
    if (!error && make_pins() != 0)
        error = -EINVAL;
    if (!error)
        return hal_ready(component);
    end_bus();
    hal_exit(component);
    return error;
}

void rtapi_app_exit(void)
{
    hal_exit(component);
    end_bus();
}
