"""For tests of programs in real time: real_time.h says what is done on a busy machine, and why."""
import concurrent.futures
import os
import sys

PRIORITY = 10
SKIPPED = 77
AT_A_TIME = 3


def run_above_others():
    """This process, and what it starts, where that is allowed."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    except PermissionError:
        return False
    return True


def together(*checks):
    """Checks that mostly wait, and share nothing, a few at a time. Each runs to its end; the first that raised an
    exception, or exits, ends the test."""
    with concurrent.futures.ThreadPoolExecutor(AT_A_TIME) as threads:
        running = [threads.submit(check) for check in checks]
    for check in running:
        check.result()


def no_processor_is_free():
    try:
        with open("/proc/pressure/cpu", encoding="ascii") as file:
            return float(file.readline().split("avg60=")[1].split()[0]) > 80
    except OSError:
        return False


def skip_on_a_busy_machine(faults):
    """Faults are none on a machine without a free processor."""
    if os.sched_getscheduler(0) != os.SCHED_FIFO and no_processor_is_free():
        print("SKIPPED: this machine has no free processor, and SCHED_FIFO is not allowed:", *faults)
        sys.exit(SKIPPED)


def end(faults, done):
    """Prints the faults, or what was done, and ends the program."""
    if faults:
        skip_on_a_busy_machine(faults)
    print("\n".join(faults) or done)
    sys.exit(1 if faults else 0)
