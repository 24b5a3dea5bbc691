/* The interface of the function blocks and the run-time part, as they are in their files; CMakeLists.txt says where. */
#define PART(name, file) \
    .globl cm1e_st_##name##_begin, cm1e_st_##name##_end; .hidden cm1e_st_##name##_begin, cm1e_st_##name##_end; \
cm1e_st_##name##_begin: \
    .incbin file; \
cm1e_st_##name##_end: \
    .byte 0

    .section .rodata
PART(types, "fb/interface/types.st")
PART(motion, "fb/interface/motion.st")
PART(multi_axis, "fb/interface/multi_axis.st")
PART(group, "fb/interface/group.st")
PART(administrative, "fb/interface/administrative.st")
PART(homing, "fb/interface/homing.st")
PART(cm_bridge, "fb/interface/cm_bridge.st")
PART(standard, "fb/interface/standard.st")
PART(tc2_mc2, "src/st/tc2_mc2.st")
PART(tc2_blocks, "src/st/tc2_blocks.st")
PART(program, "src/st/st_program.h")
PART(runtime, "src/st/st_runtime.h")
    .section .note.GNU-stack, "", %progbits
