# The Python package for Debian's own Python, as a component of the Debian packages. pip has the same package with the
# library in it; this one uses the shared libraries of libcm1e.
if(CMAKE_CROSSCOMPILING) # the modules of the building machine's Python are not those of the other one
  message(STATUS "Cross-building: there is no package python3-cm1e.")
  return()
endif()
set(CM1E_PYTHON /usr/bin/python3 CACHE FILEPATH "Debian's Python, for which the package python3-cm1e is made")
set(CM1E_PYTHON_PACKAGES lib/python3/dist-packages)
execute_process(COMMAND ${CM1E_PYTHON} -c
  "import sys, cffi, sysconfig, os; assert os.path.exists(sysconfig.get_path('include') + '/Python.h'); print(*sys.version_info[:2])"
  OUTPUT_VARIABLE python_version OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  message(WARNING "${CM1E_PYTHON} has no cffi or no headers (python3-cffi, python3-dev): there will be no package "
    "python3-cm1e.")
  return()
endif()
set(CM1E_PYTHON_VERSION ${python_version})
set(Python_EXECUTABLE ${CM1E_PYTHON})
add_subdirectory(bindings/python)
set(python bindings/python/cm1e)
install(DIRECTORY ${python} DESTINATION ${CM1E_PYTHON_PACKAGES} COMPONENT python PATTERN __pycache__ EXCLUDE)

# What Python and pip ask who is installed: version and the plug-in of pytest, from pyproject.toml.
set(facts ${CMAKE_BINARY_DIR}/made/cm1e-${PROJECT_VERSION}.dist-info)
add_custom_command(OUTPUT ${facts}/METADATA VERBATIM
  COMMAND ${CM1E_PYTHON} ${PROJECT_SOURCE_DIR}/cmake/debian/python_facts.py ${PROJECT_SOURCE_DIR}/bindings/python
          ${PROJECT_VERSION} ${facts}
  DEPENDS cmake/debian/python_facts.py bindings/python/pyproject.toml bindings/python/README.md)
add_custom_target(python_facts ALL DEPENDS ${facts}/METADATA)
install(DIRECTORY ${facts} DESTINATION ${CM1E_PYTHON_PACKAGES} COMPONENT python)
