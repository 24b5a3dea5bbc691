/*
 * A program that has functions of its own with short names, and a SOEM of its own: neither of them may meet the
 * library's. It scans the simulated segment and says so if anybody but itself called them.
 */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cm1e/plcopen.h>
#include <cm1e/scheduler.h>

static unsigned calls;

/* Names that sources of the library once had. */
void trace_init(void);
void tasks_run(void);
void pcap_open(void);
void pcap_close(void);
void frame_order(void);
void fb_execute(void);
void trace_init(void) { calls++; }
void tasks_run(void) { calls++; }
void pcap_open(void) { calls++; }
void pcap_close(void) { calls++; }
void frame_order(void) { calls++; }
void fb_execute(void) { calls++; }

/* Names of SOEM and of its port. */
int ecx_init(void *context, const char *name);
int ecx_outframe(void *port, uint8_t index, int stack);
int ecx_setupnic(void *port, const char *name, int secondary);
int osal_usleep(uint32_t us);
int ecx_init(void *context, const char *name) { return calls++, context && name; }
int ecx_outframe(void *port, uint8_t index, int stack) { return calls++, port && index && stack; }
int ecx_setupnic(void *port, const char *name, int secondary) { return calls++, port && name && secondary; }
int osal_usleep(uint32_t us) { return calls++, (int)us; }
char estring[8] = "mine";
const uint16_t priMAC[3] = {1, 2, 3};

static cm1e_scheduler_t *scheduler;
static AXIS_REF_t axis;
static MC_Power_t power = {.Axis = &axis, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE};

static void program(void *context)
{
    (void)context;
    MC_Power(&power);
    if (power.Status || power.Error)
        cm1e_scheduler_stop(scheduler);
}

int main(void)
{
    cm1e_bus_config_t config;
    const cm1e_task_config_t task = {.program = program};
    cm1e_scheduler_config_t traced = {.trace_capacity = 100};
    cm1e_diag_t why = {0};
    cm1e_bus_t *bus = NULL;
    cm1e_bus_config_init(&config, "sim", 1);
    snprintf(config.pcap_file, sizeof config.pcap_file, "own_names.pcap");
    if (cm1e_bus_open(&bus, &config, &why) != CM1E_OK || cm1e_bus_start(bus, &why) != CM1E_OK
        || cm1e_scheduler_create(&scheduler, bus, &traced, &why) != CM1E_OK
        || cm1e_scheduler_add_task(scheduler, &task, &why) != CM1E_OK
        || (axis = cm1e_scheduler_axis(scheduler, 0), cm1e_scheduler_run(scheduler, 0, &why) != CM1E_OK))
        fprintf(stderr, "%s\n", why.text);
    const bool powered = power.Status;
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
    if (calls || strcmp(estring, "mine") != 0)
        fprintf(stderr, "the library called %u functions of the program\n", calls);
    printf("own names: %s\n", powered && !calls ? "no collision" : "FAILED");
    return powered && !calls && priMAC[0] == 1 ? 0 : 1;
}
