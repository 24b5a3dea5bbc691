# Lexer and parser of the translator of Structured Text, made by flex and bison, and the files that are a part of it.
find_package(FLEX 2.6 REQUIRED)
find_package(BISON 3.8 REQUIRED)
set(made ${CMAKE_BINARY_DIR}/made/st)
file(MAKE_DIRECTORY ${made})
bison_target(st_parser ${PROJECT_SOURCE_DIR}/src/st/st_parser.y ${made}/st_parser.c COMPILE_FLAGS -Wall
             DEFINES_FILE ${made}/st_parser.h)
flex_target(st_lexer ${PROJECT_SOURCE_DIR}/src/st/st_lexer.l ${made}/st_lexer.c)
add_flex_bison_dependency(st_lexer st_parser)
set(parts ${PROJECT_SOURCE_DIR}/src/st/st_embedded_files.S)
file(GLOB interface CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fb/interface/*.st
     ${PROJECT_SOURCE_DIR}/src/st/*.st)
set_property(SOURCE ${parts} PROPERTY COMPILE_OPTIONS -Wa,-I,${PROJECT_SOURCE_DIR})
set_property(SOURCE ${parts} PROPERTY OBJECT_DEPENDS ${interface};${PROJECT_SOURCE_DIR}/src/st/st_program.h
             ${PROJECT_SOURCE_DIR}/src/st/st_runtime.h)
# What flex writes compares an int with a size, and both put numbers into smaller types.
set_property(SOURCE ${made}/st_lexer.c PROPERTY COMPILE_OPTIONS -Wno-sign-compare -Wno-conversion -Wno-sign-conversion)
set_property(SOURCE ${made}/st_parser.c PROPERTY COMPILE_OPTIONS -Wno-conversion -Wno-sign-conversion)
target_sources(cm1e_st PRIVATE ${made}/st_parser.c ${made}/st_lexer.c ${parts})
target_include_directories(cm1e_st PRIVATE ${made})
