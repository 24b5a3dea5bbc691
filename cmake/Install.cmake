# What `cmake --install` lays down: the command, the library, the public headers, the licences, a package that
# find_package(cm1e) finds, and files for pkg-config: cm1e, and cm1e-<room> for each room that is APART. A consumer links
# cm1e::fb and cm1e::scheduler. BUILD_SHARED_LIBS chooses the kind of library. The other kind is installed by
# `cmake --install . --component shared` (or static), where it was built too.
include(CMakePackageConfigHelpers)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/cm1e)
foreach(kind static shared)
  set(component_${kind} COMPONENT ${kind})
  if(CM1E_PACKAGES) # what programs load is a package of its own
    set(component_${kind} COMPONENT development)
    set(loaded_${kind} COMPONENT library NAMELINK_COMPONENT development)
  elseif(NOT kind STREQUAL CM1E_KIND)
    list(APPEND component_${kind} EXCLUDE_FROM_ALL)
  endif()
  if(NOT loaded_${kind})
    set(loaded_${kind} ${component_${kind}})
  endif()
  install(TARGETS ${CM1E_PACKAGE_${kind}} EXPORT cm1e-${kind}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${component_${kind}}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${loaded_${kind}})
  install(EXPORT cm1e-${kind} NAMESPACE cm1e:: DESTINATION ${package} ${component_${kind}})
endforeach()

# cm1e_pc_file(<kind> <name> <libs> <requires...>)
file(RELATIVE_PATH pc_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
function(cm1e_pc_file kind name libs)
  list(JOIN ARGN " " requires)
  configure_file(cmake/cm1e.pc.in ${CMAKE_BINARY_DIR}/pkgconfig/${kind}/${name}.pc @ONLY)
  if(CM1E_PACKAGES AND NOT kind STREQUAL shared)
    return() # both have one name
  endif()
  install(FILES ${CMAKE_BINARY_DIR}/pkgconfig/${kind}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
          ${component_${kind}})
endfunction()

set(all_need)
foreach(room ${rooms})
  foreach(fact DEPENDS LINKS APART ASKS)
    get_property(${fact} GLOBAL PROPERTY CM1E_ROOM_${room}_${fact})
  endforeach()
  list(FILTER LINKS INCLUDE REGEX PkgConfig::)
  list(TRANSFORM LINKS REPLACE PkgConfig::CYAML libcyaml)
  list(TRANSFORM LINKS REPLACE PkgConfig::YAML yaml-0.1)
  list(TRANSFORM LINKS REPLACE PkgConfig::JANSSON jansson)
  list(TRANSFORM LINKS REPLACE PkgConfig::XML libxml-2.0)
  if(NOT APART)
    list(APPEND all_need ${LINKS})
    continue()
  endif()
  set(guests)
  foreach(lower ${DEPENDS})
    get_property(apart GLOBAL PROPERTY CM1E_ROOM_${lower}_APART)
    if(apart)
      list(APPEND guests cm1e-${lower})
    endif()
  endforeach()
  set(libs -lcm1e_${room})
  set(libs_shared ${libs})
  if(ASKS)
    set(libs "-Wl,--undefined=${ASKS} ${libs}")
    # One word, which no other library has: pkgconf keeps only the last of equal words.
    set(libs_shared "-Wl,--push-state,--no-as-needed,${libs_shared},--pop-state ${libs_shared}")
  endif()
  cm1e_pc_file(static cm1e-${room} "${libs}" ${guests} cm1e ${LINKS})
  cm1e_pc_file(shared cm1e-${room} "${libs_shared}" ${guests} cm1e)
endforeach()
cm1e_pc_file(static cm1e "-lcm1e -pthread -lm" ${all_need})
cm1e_pc_file(shared cm1e -lcm1e)

install(DIRECTORY include/cm1e DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${in_development})
configure_package_config_file(cmake/cm1e-config.cmake.in ${CMAKE_BINARY_DIR}/cm1e-config.cmake
                              INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cm1e-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cm1e-config.cmake ${CMAKE_BINARY_DIR}/cm1e-config-version.cmake
        DESTINATION ${package} ${in_development})

install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} ${in_documents} PATTERN licenses EXCLUDE)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} ${in_documents})
install(FILES LICENSE docs/THIRD-PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR} ${in_documents})
install(FILES docs/licenses/SOEM.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}/licenses ${in_documents})
