#include "cm1e/scan_time.h"

static _Thread_local TIME scan_time_ns;

void cm1e_scan_time_set(TIME time_ns) { scan_time_ns = time_ns; }

TIME cm1e_scan_time(void) { return scan_time_ns; }
