# What `cmake --install` lays down: the command, the libraries, the public headers, the licences, and a package that
# find_package(cm1e) finds. A consumer links cm1e::fb and cm1e::scheduler.
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY CM1E_ROOMS)
set_target_properties(soem PROPERTIES EXPORT_NAME soem OUTPUT_NAME cm1e_soem)
install(TARGETS ${rooms} soem soem_headers EXPORT cm1e-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT cm1e-targets NAMESPACE cm1e:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cm1e)
install(DIRECTORY include/cm1e DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

configure_package_config_file(cmake/cm1e-config.cmake.in ${CMAKE_BINARY_DIR}/cm1e-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cm1e)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cm1e-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cm1e-config.cmake ${CMAKE_BINARY_DIR}/cm1e-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/cm1e)

install(FILES LICENSE docs/THIRD-PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES docs/licenses/SOEM.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}/licenses)
