#include "st_embedded.h"

#define PARTS(X) \
    X(types, "") X(motion, "") X(multi_axis, "") X(group, "") X(administrative, "") X(homing, "") X(cm_bridge, "") \
    X(standard, "iec_") X(tc2_mc2, "")
#define DECLARE(name, symbol) extern const char cm1e_st_##name##_begin[], cm1e_st_##name##_end[];
PARTS(DECLARE)

#define ROW(name, symbol) {"fb/interface/" #name ".st", cm1e_st_##name##_begin, cm1e_st_##name##_end, symbol},
const embedded_t cm1e_st_interface_parts[] = {PARTS(ROW){0}};
