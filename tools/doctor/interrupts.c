/* The interrupts of the network card, and the processors that serve them: others than that of the cycle. */
#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "doctor/doctor.h"

static const char group[] = "interface";
enum { PROCESSORS = 1024, INTERRUPTS = 64, LIST_TEXT = 200 };

/** A list of the kernel, "0-2,5": whether a processor is in it. */
static bool is_in(const char *list, long processor)
{
    while (isdigit((unsigned char)*list)) {
        char *end;
        const long first = strtol(list, &end, 10), last = *end == '-' ? strtol(end + 1, &end, 10) : first;
        if (processor >= first && processor <= last)
            return true;
        list = *end == ',' ? end + 1 : end;
    }
    return false;
}

static bool have_common(const char *left, const char *right)
{
    for (long processor = 0; processor < PROCESSORS; processor++)
        if (is_in(left, processor) && is_in(right, processor))
            return true;
    return false;
}

static long first_outside(const char *list)
{
    long processor = 0;
    while (is_in(list, processor))
        processor++;
    return processor;
}

/** The numbers of the card's interrupts; behind virtio the card is the parent of the device. */
static int interrupts_of(const doctor_t *doctor, const char *name, long *numbers)
{
    static const char *const folders[] = {"device/msi_irqs", "device/../msi_irqs"};
    int count = 0;
    for (size_t i = 0; i < sizeof folders / sizeof folders[0] && count == 0; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/sys/class/net/%s/%s", doctor->root, name, folders[i]);
        DIR *folder = opendir(path);
        for (struct dirent *entry; folder && (entry = readdir(folder)) && count < INTERRUPTS;)
            if (isdigit((unsigned char)entry->d_name[0]))
                numbers[count++] = strtol(entry->d_name, NULL, 10);
        if (folder)
            closedir(folder);
    }
    char line[32];
    if (count == 0 && doctor_line(doctor, line, sizeof line, "/sys/class/net/%s/device/irq", name)
        && strtol(line, NULL, 10) > 0)
        numbers[count++] = strtol(line, NULL, 10);
    return count;
}

/** Where an interrupt goes now, else where it may go. */
static bool processors_of(const doctor_t *doctor, long interrupt, char *list, size_t size)
{
    return (doctor_line(doctor, list, size, "/proc/irq/%ld/effective_affinity_list", interrupt) && list[0])
           || (doctor_line(doctor, list, size, "/proc/irq/%ld/smp_affinity_list", interrupt) && list[0]);
}

void doctor_look_at_interrupts(doctor_t *doctor, const char *name)
{
    long numbers[INTERRUPTS];
    char isolated[LIST_TEXT], list[LIST_TEXT], wrong[LIST_TEXT] = "", places[LIST_TEXT] = "";
    const int count = interrupts_of(doctor, name, numbers);
    doctor_line(doctor, isolated, sizeof isolated, "/sys/devices/system/cpu/isolated");
    for (int i = 0; i < count; i++) {
        if (!processors_of(doctor, numbers[i], list, sizeof list))
            continue;
        size_t used = strlen(places);
        snprintf(places + used, sizeof places - used, "%s%ld at processor %.40s", used ? ", " : "", numbers[i], list);
        used = strlen(wrong);
        if (have_common(list, isolated))
            snprintf(wrong + used, sizeof wrong - used, "%s%ld", used ? " " : "", numbers[i]);
    }
    if (!wrong[0] && places[0])
        doctor_find(doctor, FINDING_GOOD, group, "interrupts", "%s", places);
    else if (wrong[0])
        doctor_advise(doctor_find(doctor, FINDING_ADVICE, group, "interrupts",
                                  "%s; the processors %s are isolated for the cycle", places, isolated),
                      "The interrupts of the card break into the cycle.", "Give them to another processor.",
                      "for i in %s; do echo %ld > /proc/irq/$i/smp_affinity_list; done", wrong,
                      first_outside(isolated));
}
