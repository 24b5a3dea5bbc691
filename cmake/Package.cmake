# Debian packages, which `cpack -G DEB` writes in the build folder: the library, what is needed to compile with it, the
# command, the Python package, and the documents with the examples and the reference. A build folder with CM1E_PACKAGES serves for this only; preset: package.
set(debian ${PROJECT_SOURCE_DIR}/cmake/debian)
set(staged ${CMAKE_BINARY_DIR}/debian)
set(CM1E_PACKAGE_CONTACT "The cm1e authors <maintainers@cm1e.invalid>" CACHE STRING
    "Who made the Debian packages: name and mail address")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME cm1e)
set(CPACK_PACKAGE_CONTACT ${CM1E_PACKAGE_CONTACT})
# CPack puts any summary but this one, its own, above that of each package.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${CMAKE_PROJECT_NAME} built using CMake")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_CM1E_STRIP ${CMAKE_STRIP}) # for compress.cmake
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL library development tools documents)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/compress.cmake)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
if(CMAKE_CROSSCOMPILING)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${CM1E_PACKAGE_ARCHITECTURE})
endif()

# A text as a field of a control file: each line indented, a dot for an empty one.
function(cm1e_debian_text file variable)
  file(READ ${file} text)
  string(REGEX REPLACE "[ \n]+$" "" text "${text}")
  string(REPLACE "\n\n" "\n.\n" text "${text}")
  string(REPLACE "\n" "\n " text " ${text}")
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()
cm1e_debian_text(LICENSE license_mit)
cm1e_debian_text(docs/licenses/SOEM.txt license_soem)

# cm1e_debian_package(<component> <name> <section> <summary> <text>)
function(cm1e_debian_package component name section summary text)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
  foreach(file copyright changelog.Debian)
    configure_file(${debian}/${file}.in ${staged}/${name}/${file} @ONLY)
    install(FILES ${staged}/${name}/${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
  endforeach()
  if(EXISTS ${debian}/${name}.lintian-overrides)
    install(FILES ${debian}/${name}.lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
            RENAME ${name} COMPONENT ${component})
  endif()
endfunction()

string(TIMESTAMP package_date "%a, %d %b %Y %H:%M:%S +0000" UTC) # SOURCE_DATE_EPOCH, where that is set
set(library libcm1e${soversion})
set(same "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
cm1e_debian_package(library ${library} libs "EtherCAT servo motors CM1-E, with PLCopen function blocks"
  "cm1e drives Myostat CM1-E servo motors, and Cool Muscle motors behind a bridge,\nover EtherCAT from a real-time cycle, by the function blocks of PLCopen.\nThis package has the shared libraries.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${debian}/triggers)
cm1e_debian_package(development libcm1e-dev libdevel "EtherCAT servo motors CM1-E - files to compile with"
  "Headers, static libraries, files for CMake and pkg-config of cm1e, a library\nthat drives Myostat CM1-E servo motors over EtherCAT by PLCopen blocks.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library} ${same}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS
    "libcyaml-dev, libyaml-dev, libxml2-dev, libjansson-dev, pkgconf")
cm1e_debian_package(tools cm1e electronics "EtherCAT servo motors CM1-E - commands"
  "The command cm1e: finds, moves, watches and tests Myostat CM1-E servo motors,\nsimulates a network of them, and writes files for other EtherCAT masters.\nMembers of the group cm1e use network interfaces without being root.")
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "libcap2-bin, passwd")
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "libcm1e-dev, gcc")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS libcm1e-doc)
set(CPACK_DEBIAN_TOOLS_PACKAGE_CONTROL_EXTRA ${debian}/postinst ${debian}/postrm)
cm1e_debian_package(documents libcm1e-doc doc "EtherCAT servo motors CM1-E - documents and examples"
  "The documents, the pages of all function blocks, and the example programs of\ncm1e, a library that drives Myostat CM1-E servo motors over EtherCAT.")
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_ARCHITECTURE all)
if(TARGET cm1e_python)
  string(REPLACE " " ";" python_version "${CM1E_PYTHON_VERSION}")
  list(GET python_version 1 minor)
  math(EXPR next "${minor} + 1")
  list(APPEND CPACK_COMPONENTS_ALL python)
  cm1e_debian_package(python python3-cm1e python "EtherCAT servo motors CM1-E - package for Python"
    "The package cm1e for Python: axes that move and wait, all function blocks of\nPLCopen, a simulator on virtual time, traces as NumPy arrays, and a plug-in for\npytest. The cycle stays in the library, in C.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${library} ${same}, python3 (>= 3.${minor}), python3 (<< 3.${next}), python3-cffi-backend, python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "libcm1e-doc, python3-pytest")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${debian}/python/postinst ${debian}/python/prerm)
endif()

# SOEM's licence asks that its source comes with the binary: what is compiled is unmodified.
install(DIRECTORY ${soem_dir}/soem ${soem_dir}/osal DESTINATION ${CMAKE_INSTALL_DOCDIR}/soem COMPONENT documents)

# The command once more, with its privileges, for members of the group: main.c starts it.
install(PROGRAMS $<TARGET_FILE:cm1e> DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/cm1e COMPONENT tools)
install(FILES ${debian}/cm1e.sysusers DESTINATION lib/sysusers.d RENAME cm1e.conf COMPONENT tools)
install(FILES ${debian}/cm1e.rules DESTINATION lib/udev/rules.d RENAME 60-cm1e.rules COMPONENT tools)
install(FILES ${debian}/cm1e@.service DESTINATION lib/systemd/system COMPONENT tools)
include(CPack)
