# The reference of the public headers for a browser: `cmake --build build --target reference`. Debian packages have it
# where Doxygen is there.
find_program(CM1E_DOXYGEN doxygen)
if(CM1E_DOXYGEN)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  set(made ${CMAKE_BINARY_DIR}/made)
  file(GLOB read CONFIGURE_DEPENDS include/cm1e/*.h cmake/reference/* fb/interface/* docs/blocks/*.svg)
  add_custom_command(OUTPUT ${made}/reference/index.html VERBATIM
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${made}/reference
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/reference/make.py ${made} DEPENDS ${read})
  set(always)
  if(CM1E_PACKAGES)
    set(always ALL)
    install(DIRECTORY ${made}/reference DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documents)
  endif()
  add_custom_target(reference ${always} DEPENDS ${made}/reference/index.html)
elseif(CM1E_PACKAGES)
  message(WARNING "There is no doxygen: the package libcm1e-doc is made without the reference of the headers.")
endif()
