# SOEM's core, unmodified, from the first of:
#   1. CM1E_SOEM_SOURCE_DIR: a folder that holds soem/ and osal/ (SOEM 1.4 line, newer than release 1.4.0);
#   2. the pinned source distribution of the PyPI package pysoem, which carries such a folder.
# Its port (nicdrv.h, oshw.h and the osal time functions) is ours: src/nic/port.

set(CM1E_SOEM_SOURCE_DIR "" CACHE PATH "SOEM 1.4 source folder (holds soem/ and osal/); empty: pinned download")
set(SOEM_PYSOEM_VERSION 1.1.13)
set(SOEM_PYSOEM_SHA256 4be98d8531e492f2ee5d21f6ef51e51493a10ee1322ed22e909c91a8bcfff950)

set(SOEM_FILES soem/ethercatbase.c soem/ethercatcoe.c soem/ethercatconfig.c soem/ethercatdc.c soem/ethercateoe.c
  soem/ethercatfoe.c soem/ethercatmain.c soem/ethercatprint.c soem/ethercatsoe.c)

# Brings the archive. pip looks at its checksum before it runs the archive's setup.py for the metadata; first with the
# setuptools of this machine, which need nothing else from the network.
function(soem_download archive)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  message(STATUS "Downloading SOEM (source distribution of pysoem ${SOEM_PYSOEM_VERSION})")
  get_filename_component(folder ${archive} DIRECTORY)
  set(requirements ${CMAKE_BINARY_DIR}/soem-requirements.txt)
  file(WRITE ${requirements} "pysoem==${SOEM_PYSOEM_VERSION} --hash=sha256:${SOEM_PYSOEM_SHA256}\n")
  foreach(isolation --no-build-isolation "")
    execute_process(
      COMMAND ${Python3_EXECUTABLE} -m pip download --quiet --disable-pip-version-check --no-deps --no-binary pysoem
              ${isolation} --require-hashes --requirement ${requirements} --dest ${folder}
      RESULT_VARIABLE failed OUTPUT_VARIABLE why ERROR_VARIABLE why)
    if(NOT failed)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "pip could not download pysoem ${SOEM_PYSOEM_VERSION}, which carries SOEM:\n${why}\n"
    "Without a network: bring pysoem-${SOEM_PYSOEM_VERSION}.tar.gz from another machine to ${folder}, or set "
    "CM1E_SOEM_SOURCE_DIR to a SOEM source folder.")
endfunction()

if(CM1E_SOEM_SOURCE_DIR)
  set(soem_dir ${CM1E_SOEM_SOURCE_DIR})
else()
  set(deps ${PROJECT_SOURCE_DIR}/.deps)
  set(archive ${deps}/pysoem-${SOEM_PYSOEM_VERSION}.tar.gz)
  set(soem_dir ${deps}/pysoem-${SOEM_PYSOEM_VERSION}/soem)
  if(NOT EXISTS ${archive})
    soem_download(${archive})
  endif()
  file(SHA256 ${archive} sum)
  if(NOT sum STREQUAL SOEM_PYSOEM_SHA256)
    message(FATAL_ERROR "${archive} is damaged: its SHA-256 is ${sum}, expected ${SOEM_PYSOEM_SHA256}. "
      "Delete it and configure again: it is downloaded anew.")
  endif()
  if(NOT EXISTS ${deps}/pysoem-${SOEM_PYSOEM_VERSION})
    file(REMOVE_RECURSE ${deps}/extracting)
    file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${deps}/extracting)
    file(RENAME ${deps}/extracting/pysoem-${SOEM_PYSOEM_VERSION} ${deps}/pysoem-${SOEM_PYSOEM_VERSION}) # when whole
    file(REMOVE_RECURSE ${deps}/extracting)
  endif()
endif()
string(CONCAT soem_needed "Needed is the folder with soem/ and osal/ of SOEM's 1.4 line, newer than release 1.4.0 (for "
  "instance commit 76863fe of https://github.com/OpenEtherCATsociety/SOEM), not 2.0.")
foreach(file ${SOEM_FILES} soem/ethercat.h osal/osal.h osal/linux/osal_defs.h)
  if(NOT EXISTS ${soem_dir}/${file})
    message(FATAL_ERROR "The SOEM source folder \"${soem_dir}\" lacks ${file}. ${soem_needed}")
  endif()
endforeach()
file(STRINGS ${soem_dir}/soem/ethercatmain.h newer_than_1_4_0 REGEX eep_sn)
if(NOT newer_than_1_4_0)
  message(FATAL_ERROR "The SOEM in \"${soem_dir}\" has no ec_slavet.eep_sn: too old or too new. ${soem_needed}")
endif()
set(CM1E_SOEM_DIR ${soem_dir})

add_library(soem_headers INTERFACE)
target_compile_definitions(soem_headers INTERFACE EC_VER2)
# SOEM's external symbols get our prefix by macros, the way BoringSSL and LibreSSL rename theirs: a program may link a
# SOEM of its own beside this one. (objcopy on finished archives would need the same list and breaks -flto.)
target_compile_options(soem_headers INTERFACE
  $<BUILD_INTERFACE:-include$<SEMICOLON>${PROJECT_SOURCE_DIR}/src/nic/port/soem_names.h>)
target_include_directories(soem_headers SYSTEM INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src/nic/port>
  $<BUILD_INTERFACE:${soem_dir}/soem>
  $<BUILD_INTERFACE:${soem_dir}/osal>
  $<BUILD_INTERFACE:${soem_dir}/osal/linux>)

list(TRANSFORM SOEM_FILES PREPEND ${soem_dir}/ OUTPUT_VARIABLE soem_sources)
add_library(soem STATIC ${soem_sources})
target_link_libraries(soem PUBLIC soem_headers PRIVATE cm1e_nic)
