# What others build with: find_package(acstudy) gives acstudy::solver, acstudy::orders, acstudy::mms, acstudy::studies
# and acstudy::main, a main program for schemes of one's own. find_package(acstudy COMPONENTS solver) gives the first
# alone, which is under the Apache license; all others link the GNU Scientific Library, which is under the GPL.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

foreach(name solver orders mms studies main)
  set_target_properties(acstudy_${name} PROPERTIES EXPORT_NAME ${name})
endforeach()
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/acstudy)
install(TARGETS acstudy_solver EXPORT acstudySolverTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS acstudy_orders acstudy_mms acstudy_studies acstudy_main EXPORT acstudyTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(set acstudySolverTargets acstudyTargets)
  install(EXPORT ${set} NAMESPACE acstudy:: DESTINATION ${package_folder})
endforeach()

configure_package_config_file(cmake/acstudyConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/acstudyConfig.cmake
                              INSTALL_DESTINATION ${package_folder} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/acstudyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/acstudyConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/acstudyConfigVersion.cmake
        DESTINATION ${package_folder})

install(DIRECTORY solver mms studies DESTINATION include/acstudy FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY reports/judging DESTINATION include/acstudy/reports FILES_MATCHING PATTERN "*.hpp")

install(TARGETS acstudy RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY studies DESTINATION ${CMAKE_INSTALL_DATADIR}/acstudy FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/acstudy PATTERN "out" EXCLUDE PATTERN "build" EXCLUDE
        PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY reports DESTINATION ${CMAKE_INSTALL_DATADIR}/acstudy PATTERN "out" EXCLUDE PATTERN "judging" EXCLUDE
        PATTERN "__pycache__" EXCLUDE)
