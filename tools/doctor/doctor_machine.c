/* Kernel, processors, clock, privileges. docs/REALTIME.md explains each at length. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "cm1e/scheduler.h"
#include "core/program.h"
#include "doctor/doctor.h"

static const char group[] = "machine";

static void look_at_kernel(doctor_t *doctor)
{
    char version[256] = "", realtime[16] = "";
    doctor_line(doctor, version, sizeof version, "/proc/version");
    if (doctor_line(doctor, realtime, sizeof realtime, "/sys/kernel/realtime") && realtime[0] == '1') {
        doctor_find(doctor, FINDING_GOOD, group, "kernel", "PREEMPT_RT");
        return;
    }
    finding_t *finding = doctor_find(doctor, FINDING_ADVICE, group, "kernel", "not PREEMPT_RT: %s",
                                     strstr(version, "PREEMPT_DYNAMIC") ? "PREEMPT_DYNAMIC"
                                     : strstr(version, "PREEMPT")       ? "PREEMPT"
                                                                        : "no full preemption");
    doctor_advise(finding, "Without PREEMPT_RT a driver or the kernel can delay a cycle by milliseconds.",
                  "Install a real-time kernel and start it.",
                  "apt-get install linux-image-rt-$(dpkg --print-architecture) # then restart");
}

static void look_at_virtual_machine(doctor_t *doctor)
{
    char path[512], line[4096];
    bool hypervisor = false;
    snprintf(path, sizeof path, "%s/proc/cpuinfo", doctor->root);
    FILE *file = fopen(path, "r");
    while (file && !hypervisor && fgets(line, sizeof line, file))
        hypervisor = strncmp(line, "flags", 5) == 0 && strstr(line, " hypervisor");
    if (file)
        fclose(file);
    if (hypervisor)
        doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, "virtual machine", "this is a virtual machine"),
                      "The host can take the processor away in the middle of a cycle, and no setting here prevents it.",
                      "Run motors from a machine of their own.", "%s", "");
}

static void look_at_isolation(doctor_t *doctor)
{
    char isolated[256];
    if (doctor_line(doctor, isolated, sizeof isolated, "/sys/devices/system/cpu/isolated") && isolated[0]) {
        doctor_find(doctor, FINDING_GOOD, group, "isolated processors", "%s", isolated);
        return;
    }
    doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, "isolated processors", "none"),
                  "Other programs and interrupts share the processor of the cycle.",
                  "Isolate a processor at boot and give it to the scheduler (`cpu` of its configuration).",
                  "sed -i 's/^GRUB_CMDLINE_LINUX=\"/&isolcpus=1 nohz_full=1 rcu_nocbs=1 /' /etc/default/grub && "
                  "update-grub # then restart");
}

static void look_at_governor(doctor_t *doctor)
{
    char governor[64];
    for (int cpu = 0; doctor_exists(doctor, "/sys/devices/system/cpu/cpu%d", cpu); cpu++) {
        if (!doctor_line(doctor, governor, sizeof governor, "/sys/devices/system/cpu/cpu%d/cpufreq/scaling_governor",
                         cpu))
            continue;
        if (strcmp(governor, "performance") == 0)
            continue;
        doctor_advise(
            doctor_find(doctor, FINDING_ADVICE, group, "frequency governor", "\"%s\" at processor %d", governor, cpu),
            "A processor that changes its frequency needs longer for some cycles than for others.",
            "Keep the frequency at its maximum.",
            "echo performance | tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor");
        return;
    }
}

/** Deep sleep costs its exit latency at every wake-up. A run in real time forbids it, where it may. */
static void look_at_sleep_states(doctor_t *doctor)
{
    enum { LATENCY_US = 20 };
    char latency[32], disabled[8], name[64];
    if (doctor_may_write(doctor, "/dev/cpu_dma_latency"))
        return;
    for (int state = 0;
         doctor_line(doctor, latency, sizeof latency, "/sys/devices/system/cpu/cpu0/cpuidle/state%d/latency", state);
         state++) {
        doctor_line(doctor, disabled, sizeof disabled, "/sys/devices/system/cpu/cpu0/cpuidle/state%d/disable", state);
        doctor_line(doctor, name, sizeof name, "/sys/devices/system/cpu/cpu0/cpuidle/state%d/name", state);
        if (disabled[0] == '1' || strtol(latency, NULL, 10) <= LATENCY_US)
            continue;
        doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, "sleep states",
                                  "state %s of the processors takes %s us "
                                  "to wake up",
                                  name, latency),
                      "A processor that sleeps deeply between two cycles wakes up late.",
                      "Let members of the group cm1e forbid sleep states for the time of a run.",
                      "echo 'KERNEL==\"cpu_dma_latency\", GROUP=\"cm1e\", MODE=\"0660\"' > "
                      "/etc/udev/rules.d/60-cm1e-latency.rules && udevadm control --reload && "
                      "udevadm trigger --name-match=cpu_dma_latency");
        return;
    }
}

static void look_at_clock(doctor_t *doctor)
{
    char source[64];
    if (!doctor_line(doctor, source, sizeof source, "/sys/devices/system/clocksource/clocksource0/current_clocksource"))
        return;
    if (strcmp(source, "hpet") != 0 && strcmp(source, "acpi_pm") != 0 && strcmp(source, "jiffies") != 0) {
        doctor_find(doctor, FINDING_GOOD, group, "clock source", "%s", source);
        return;
    }
    doctor_advise(doctor_find(doctor, FINDING_PROBLEM, group, "clock source", "%s", source),
                  "Reading this clock takes microseconds, and it is read several times in a cycle.",
                  "Use tsc: look in the kernel log for why it was refused (dmesg | grep -i tsc).",
                  "echo tsc > /sys/devices/system/clocksource/clocksource0/current_clocksource");
}

/* ---- privileges ------------------------------------------------------------------------------------------------ */

/** A set of capabilities of this program, "CapEff:" or "CapBnd:"; `unknown` where the file does not say. */
static uint64_t capabilities(const doctor_t *doctor, const char *set, uint64_t unknown)
{
    char path[512], line[256];
    uint64_t mask = unknown;
    snprintf(path, sizeof path, "%s/proc/self/status", doctor->root);
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, set, strlen(set)) == 0)
            mask = strtoull(line + strlen(set), NULL, 16);
    if (file)
        fclose(file);
    return mask;
}

static bool limit_reached(__rlimit_resource_t resource, rlim_t wanted)
{
    struct rlimit limit;
    return getrlimit(resource, &limit) == 0 && (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= wanted);
}

static void look_at_privileges(doctor_t *doctor)
{
    const uint64_t mask = capabilities(doctor, "CapEff:", 0), permitted = capabilities(doctor, "CapBnd:", UINT64_MAX);
    const bool raw = mask & CM1E_PRIVILEGE_RAW;
    const bool priority = mask & CM1E_PRIVILEGE_PRIORITY || limit_reached(RLIMIT_RTPRIO, 80);
    const bool memory = mask & CM1E_PRIVILEGE_LOCK || limit_reached(RLIMIT_MEMLOCK, RLIM_INFINITY);
    const uint64_t missing = (raw ? 0 : CM1E_PRIVILEGE_RAW) | (priority ? 0 : CM1E_PRIVILEGE_PRIORITY) |
                             (memory ? 0 : CM1E_PRIVILEGE_LOCK);
    char program[PATH_MAX], names[CM1E_PRIVILEGES_TEXT], fix[400] = "";
    char action[256] = "Give the rights to this program, and do it again after every build.";
    cm1e_program_path(program, sizeof program);
    if (raw && priority && memory) {
        doctor_find(doctor, FINDING_GOOD, group, "privileges", "raw sockets, real-time priority, locked memory");
        return;
    }
    static const char why[] =
        "Raw sockets are the network; without real-time priority and locked memory any program delays a cycle.";
    finding_t *finding =
        doctor_find(doctor, raw ? FINDING_ADVICE : FINDING_PROBLEM, group, "privileges", "this program may not%s%s%s",
                    raw ? "" : " open raw sockets;", priority ? "" : " take a real-time priority;",
                    memory ? "" : " lock its memory;");
    cm1e_program_privileges(names, permitted);
    if (missing & permitted) /* a file with a privilege that is not permitted does not start at all */
        snprintf(fix, sizeof fix, "setcap %s+ep '%.300s'", names, program);
    cm1e_program_privileges(names, missing & ~permitted);
    if (names[0])
        snprintf(action, sizeof action, "Not even root has %s in this container or service: start that with it (docker "
                 "run --network host --cap-add NET_RAW --cap-add SYS_NICE --cap-add IPC_LOCK).", names);
    doctor_advise(finding, why, action, "%s", fix);
}

void doctor_look_at_machine(doctor_t *doctor)
{
    look_at_kernel(doctor);
    look_at_virtual_machine(doctor);
    look_at_isolation(doctor);
    look_at_governor(doctor);
    look_at_sleep_states(doctor);
    look_at_clock(doctor);
    look_at_privileges(doctor);
}

/* ---- latency --------------------------------------------------------------------------------------------------- */

/** Share of cycles, in per cent, whose wake-up was later than `limit_ns`; by whole buckets, so never too small. */
static double share_later(const cm1e_distribution_t *distribution, int64_t limit_ns)
{
    uint64_t later = 0;
    for (int bucket = 1; bucket < CM1E_HISTOGRAM_BUCKETS; bucket++)
        if ((INT64_C(1000) << bucket) > limit_ns)
            later += distribution->histogram[bucket];
    return distribution->count ? 100.0 * (double)later / (double)distribution->count : 0;
}

static void judge_latency(doctor_t *doctor, const cm1e_scheduler_statistics_t *s, int64_t cycle_time_ns)
{
    const cm1e_distribution_t *late = &s->wake_up_latency;
    const double average_us = late->count ? (double)late->sum_ns / (double)late->count * 1e-3 : 0;
    const double worst_us = (double)late->maximum_ns * 1e-3, cycle_us = (double)cycle_time_ns * 1e-3;
    const finding_level_t level = worst_us > cycle_us / 2   ? FINDING_PROBLEM
                                  : worst_us > cycle_us / 5 ? FINDING_ADVICE
                                                            : FINDING_GOOD;
    finding_t *finding =
        doctor_find(doctor, level, group, "wake-up latency",
                    "%.0f us on average, %.0f us at worst of a cycle of %.0f us (%llu cycles, %.2f %% later "
                    "than a fifth, %llu overruns%s)",
                    average_us, worst_us, cycle_us, (unsigned long long)s->cycles, share_later(late, cycle_time_ns / 5),
                    (unsigned long long)s->overruns, s->realtime ? "" : "; without real-time priority");
    if (level != FINDING_GOOD)
        doctor_advise(finding, "A late cycle is a late target for the motors: they run uneven, and in CSV too far.",
                      "Follow the advice above, end other programs, or choose a longer cycle time.", "%s", "");
}

void doctor_measure_latency(doctor_t *doctor, int64_t cycle_time_ns, double seconds)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus = NULL;
    cm1e_scheduler_t *scheduler = NULL;
    cm1e_diag_t diag = {0};
    cm1e_error_t error = cm1e_bus_config_init(&config, "sim", 1);
    config.cycle_time_ns = cycle_time_ns;
    if (error == CM1E_OK)
        error = cm1e_bus_open(&bus, &config, &diag);
    if (error == CM1E_OK)
        error = cm1e_bus_start(bus, &diag);
    if (error == CM1E_OK)
        error = cm1e_scheduler_create(&scheduler, bus, NULL, &diag);
    if (error == CM1E_OK)
        error = cm1e_scheduler_run(scheduler, (int64_t)(seconds * 1e9), &diag);
    if (error == CM1E_OK) {
        cm1e_scheduler_statistics_t statistics;
        cm1e_scheduler_statistics(scheduler, &statistics);
        judge_latency(doctor, &statistics, cycle_time_ns);
    } else {
        doctor_find(doctor, FINDING_NOTE, group, "wake-up latency", "not measured: %.300s", diag.text);
    }
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
}
