# The library as others link it, made of the objects of the rooms and of SOEM: one library of the rooms that every program
# needs, and one beside it for each room that is APART, static and shared. The package has a target per room either way,
# cm1e::fb, cm1e::scheduler and so on.

# cm1e_package_target(<target> <name in the package>)
function(cm1e_package_target target name)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib
                                             LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                 $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()

# Below 1.0 a new minor version may be another interface, so the soname has it too.
set(soversion ${PROJECT_VERSION_MAJOR})
if(soversion EQUAL 0)
  set(soversion 0.${PROJECT_VERSION_MINOR})
endif()

# cm1e_shared_properties(<target> <name of the file>)
function(cm1e_shared_properties target name)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} LINKER_LANGUAGE C VERSION ${PROJECT_VERSION}
                                             SOVERSION ${soversion})
  target_link_options(${target} PRIVATE LINKER:-Bsymbolic-functions)
  if(NOT CM1E_SANITIZE) # whose symbols only the program brings
    target_link_options(${target} PRIVATE LINKER:-z,defs)
  endif()
endfunction()

# cm1e_shared_guest(<room>): the shared library of a room that is APART. What has a state (the clock, the table of
# backends ...) is in libcm1e.so, which exports it for guests (CM1E_GUEST_API). What has none (tables, descriptions,
# frames) the linker takes from the rooms' archives once more, hidden.
function(cm1e_shared_guest room)
  add_library(cm1e_shared_${room} SHARED $<TARGET_OBJECTS:cm1e_${room}>)
  cm1e_shared_properties(cm1e_shared_${room} cm1e_${room})
  set(guests)
  foreach(lower ${DEPENDS})
    get_property(apart GLOBAL PROPERTY CM1E_ROOM_${lower}_APART)
    if(apart)
      list(APPEND guests cm1e_shared_${lower})
    endif()
  endforeach()
  set(stateless)
  foreach(lower description config device cia402 nic core)
    list(APPEND stateless $<TARGET_FILE:cm1e_${lower}>)
  endforeach()
  target_link_libraries(cm1e_shared_${room} PUBLIC ${guests} cm1e_shared PRIVATE ${stateless} ${LINKS} m)
  add_dependencies(cm1e_shared_${room} cm1e_description cm1e_device cm1e_cia402 cm1e_config cm1e_nic cm1e_core)
  target_link_options(cm1e_shared_${room} PRIVATE LINKER:--exclude-libs,ALL)
endfunction()

add_library(cm1e_static STATIC $<TARGET_OBJECTS:soem>)
add_library(cm1e_shared SHARED $<TARGET_OBJECTS:soem>)
foreach(kind static shared)
  cm1e_package_target(cm1e_${kind} library)
endforeach()
set_target_properties(cm1e_static PROPERTIES OUTPUT_NAME cm1e LINKER_LANGUAGE C)
cm1e_shared_properties(cm1e_shared cm1e)
set(CM1E_PACKAGE_static cm1e_static)
set(CM1E_PACKAGE_shared cm1e_shared)

get_property(rooms GLOBAL PROPERTY CM1E_ROOMS)
foreach(room ${rooms})
  foreach(fact DEPENDS LINKS APART ASKS)
    get_property(${fact} GLOBAL PROPERTY CM1E_ROOM_${room}_${fact})
  endforeach()
  list(REMOVE_ITEM LINKS soem soem_headers)
  if(APART)
    add_library(cm1e_static_${room} STATIC $<TARGET_OBJECTS:cm1e_${room}>)
    set_target_properties(cm1e_static_${room} PROPERTIES OUTPUT_NAME cm1e_${room} LINKER_LANGUAGE C)
    list(TRANSFORM DEPENDS PREPEND cm1e_static_ OUTPUT_VARIABLE lower)
    target_link_libraries(cm1e_static_${room} INTERFACE ${lower} ${LINKS})
    cm1e_shared_guest(${room})
  else()
    add_library(cm1e_static_${room} INTERFACE)
    target_sources(cm1e_static PRIVATE $<TARGET_OBJECTS:cm1e_${room}>)
    target_link_libraries(cm1e_static INTERFACE ${LINKS})
    target_link_libraries(cm1e_static_${room} INTERFACE cm1e_static)
    add_library(cm1e_shared_${room} INTERFACE)
    target_sources(cm1e_shared PRIVATE $<TARGET_OBJECTS:cm1e_${room}>)
    target_link_libraries(cm1e_shared PRIVATE ${LINKS})
    target_link_libraries(cm1e_shared_${room} INTERFACE cm1e_shared)
  endif()
  foreach(kind static shared)
    cm1e_package_target(cm1e_${kind}_${room} ${room})
    list(APPEND CM1E_PACKAGE_${kind} cm1e_${kind}_${room})
  endforeach()
  if(ASKS) # an archive gives the object, a shared library is needed, though the program names nothing of it
    target_link_options(cm1e_static_${room} INTERFACE LINKER:--undefined=${ASKS})
    target_link_options(cm1e_shared_${room} INTERFACE LINKER:--no-as-needed)
  endif()
endforeach()

# Objects of link-time optimisation carry the code of the compiler beside that of the machine. gcc links such an archive by
# compiling all of it again: 20 s after a change of one line in somebody's program. Installed is the machine's code only.
if(CM1E_LINK_TIME_OPTIMIZATION AND CMAKE_OBJCOPY)
  foreach(target ${CM1E_PACKAGE_static})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL STATIC_LIBRARY)
      add_custom_command(TARGET ${target} POST_BUILD VERBATIM
        COMMAND ${CMAKE_OBJCOPY} --remove-section=.gnu.lto_* --remove-section=.gnu.debuglto_* $<TARGET_FILE:${target}>)
    endif()
  endforeach()
endif()

# Tests look at both kinds. Without them the kind that is installed is enough.
set(CM1E_KIND static)
set(other shared)
if(BUILD_SHARED_LIBS)
  set(CM1E_KIND shared)
  set(other static)
endif()
if(CM1E_SANITIZE OR NOT (CM1E_BUILD_TESTS OR CM1E_PACKAGES))
  set(spared ${CM1E_PACKAGE_${other}})
  set_target_properties(${spared} PROPERTIES EXCLUDE_FROM_ALL ON)
endif()
