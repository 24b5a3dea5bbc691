# SOEM's core, unmodified, from the first of:
#   1. CM1E_SOEM_SOURCE_DIR: a folder that holds soem/, osal/ and oshw/ (SOEM 1.4 line);
#   2. the pinned source distribution of the PyPI package pysoem, which carries such a folder.
# Its port (nicdrv.h, oshw.h and the osal time functions) is ours: src/nic/port.

set(CM1E_SOEM_SOURCE_DIR "" CACHE PATH "SOEM 1.4 source folder (holds soem/ and osal/); empty: pinned download")
set(SOEM_PYSOEM_VERSION 1.1.13)
set(SOEM_PYSOEM_SHA256 4be98d8531e492f2ee5d21f6ef51e51493a10ee1322ed22e909c91a8bcfff950)

if(CM1E_SOEM_SOURCE_DIR)
  set(soem_dir ${CM1E_SOEM_SOURCE_DIR})
else()
  set(deps ${PROJECT_SOURCE_DIR}/.deps)
  set(archive ${deps}/pysoem-${SOEM_PYSOEM_VERSION}.tar.gz)
  set(soem_dir ${deps}/pysoem-${SOEM_PYSOEM_VERSION}/soem)
  if(NOT EXISTS ${archive})
    find_package(Python3 REQUIRED COMPONENTS Interpreter)
    message(STATUS "Downloading SOEM (source distribution of pysoem ${SOEM_PYSOEM_VERSION})")
    execute_process(
      COMMAND ${Python3_EXECUTABLE} -m pip download --quiet --no-deps --no-binary pysoem
              --dest ${deps} pysoem==${SOEM_PYSOEM_VERSION}
      RESULT_VARIABLE failed ERROR_VARIABLE why)
    if(failed)
      message(FATAL_ERROR "pip could not download pysoem ${SOEM_PYSOEM_VERSION}: ${why}\n"
        "Set CM1E_SOEM_SOURCE_DIR to a SOEM 1.4 source folder to build without a download.")
    endif()
  endif()
  file(SHA256 ${archive} sum)
  if(NOT sum STREQUAL SOEM_PYSOEM_SHA256)
    message(FATAL_ERROR "${archive} has SHA-256 ${sum}, expected ${SOEM_PYSOEM_SHA256}: delete it and configure again.")
  endif()
  if(NOT EXISTS ${soem_dir}/soem/ethercatmain.c)
    file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${deps})
  endif()
endif()
foreach(file soem/ethercatmain.c soem/ethercat.h osal/osal.h osal/linux/osal_defs.h)
  if(NOT EXISTS ${soem_dir}/${file})
    message(FATAL_ERROR "SOEM source folder ${soem_dir} lacks ${file}: it must be of the 1.4 line.")
  endif()
endforeach()
set(CM1E_SOEM_DIR ${soem_dir})

add_library(soem_headers INTERFACE)
target_compile_definitions(soem_headers INTERFACE EC_VER2)
target_include_directories(soem_headers SYSTEM INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src/nic/port>
  $<BUILD_INTERFACE:${soem_dir}/soem>
  $<BUILD_INTERFACE:${soem_dir}/osal>
  $<BUILD_INTERFACE:${soem_dir}/osal/linux>)

add_library(soem STATIC
  ${soem_dir}/soem/ethercatbase.c ${soem_dir}/soem/ethercatcoe.c ${soem_dir}/soem/ethercatconfig.c
  ${soem_dir}/soem/ethercatdc.c ${soem_dir}/soem/ethercatfoe.c ${soem_dir}/soem/ethercatmain.c
  ${soem_dir}/soem/ethercatprint.c ${soem_dir}/soem/ethercatsoe.c ${soem_dir}/soem/ethercateoe.c)
target_link_libraries(soem PUBLIC soem_headers PRIVATE cm1e_nic)
