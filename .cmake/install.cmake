# SPDX-License-Identifier: GPL-3.0-or-later
# What `cmake --install` puts where: programs, library, its modules, headers as they lie in lib/ and fibers/,
# data, a CMake package and a pkg-config file. Everything may be moved together to another prefix.
include(CMakePackageConfigHelpers)

install(TARGETS viscera EXPORT viscera-targets)
install(TARGETS viscera_cholmod viscera_hdf5 DESTINATION ${CMAKE_INSTALL_LIBDIR}/viscera)
install(DIRECTORY lib/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/viscera FILES_MATCHING PATTERN "*.h")
install(DIRECTORY fibers/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/viscera/fibers
        FILES_MATCHING PATTERN "*.h")
install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/viscera)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/viscera)
install(EXPORT viscera-targets NAMESPACE viscera:: DESTINATION ${package})
configure_package_config_file(.cmake/viscera-config.cmake.in ${CMAKE_BINARY_DIR}/viscera-config.cmake
                              INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/viscera-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/viscera-config.cmake
              ${CMAKE_BINARY_DIR}/viscera-config-version.cmake DESTINATION ${package})

file(RELATIVE_PATH VISCERA_PC_UP ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(.cmake/viscera.pc.in ${CMAKE_BINARY_DIR}/viscera.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/viscera.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The installed programs find the library beside them.
file(RELATIVE_PATH to_library ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
foreach(program viscera_program viscera_plot)
  if(TARGET ${program})
    set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/${to_library}")
    install(TARGETS ${program})
  endif()
endforeach()
