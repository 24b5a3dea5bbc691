#include "st_embedded.h"

#define PARTS(X) \
    X(types, "", 0) X(motion, "", 0) X(multi_axis, "", 0) X(group, "", 0) X(administrative, "", 0) X(homing, "", 0) \
    X(cm_bridge, "", 0) X(standard, "iec_", 0) X(tc2_mc2, "", 0) X(tc2_blocks, "", 1)
#define DECLARE(name, symbol, library) extern const char cm1e_st_##name##_begin[], cm1e_st_##name##_end[];
PARTS(DECLARE)

#define ROW(name, symbol, library)                                                                                   \
    {"fb/interface/" #name ".st", cm1e_st_##name##_begin, cm1e_st_##name##_end, symbol, library},
const embedded_t cm1e_st_interface_parts[] = {PARTS(ROW){0}};
