# What lets other compilers of Structured Text call the blocks (docs/STRUCTURED-TEXT.md, "Other compilers"): made in the
# build from fb/interface/, and installed with what bindings/st/ has, in share/cm1e/st.
find_package(Python3 COMPONENTS Interpreter)
if(NOT Python3_Interpreter_FOUND)
  message(STATUS "Python 3 not found: no adapters for other compilers of Structured Text")
  return()
endif()
set(adapters ${CMAKE_BINARY_DIR}/made/adapters)
file(GLOB adapter_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/fb/interface/*.py ${PROJECT_SOURCE_DIR}/fb/interface/*.st
     ${PROJECT_SOURCE_DIR}/src/st/*.st)
file(GLOB_RECURSE adapter_hosts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/bindings/st/*)
add_custom_command(OUTPUT ${adapters}.stamp VERBATIM DEPENDS ${adapter_sources} ${adapter_hosts}
                   ${PROJECT_SOURCE_DIR}/src/st/st_program.h
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${adapters}
  COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/bindings/st ${adapters}
  COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/src/st/st_program.h ${adapters}
  COMMAND ${CMAKE_COMMAND} -E rm ${adapters}/README.md
  COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/fb/interface/adapters.py ${adapters}
  COMMAND ${CMAKE_COMMAND} -E touch ${adapters}.stamp)
add_custom_target(st_adapters ALL DEPENDS ${adapters}.stamp)
install(DIRECTORY ${adapters}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/cm1e/st ${in_development})
