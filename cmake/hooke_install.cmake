# What `cmake --install` puts where, and the package that find_package(Hooke) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(HOOKE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Hooke)
set(HOOKE_IO_HEADERS model_io.h scene_io.h)

# The engine.
install(TARGETS hooke EXPORT HookeTargets)
install(EXPORT HookeTargets NAMESPACE hooke:: DESTINATION ${HOOKE_PACKAGE_DIR})
file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/hooke/*.h)
set(io_headers ${HOOKE_IO_HEADERS})
list(TRANSFORM io_headers PREPEND ${PROJECT_SOURCE_DIR}/include/hooke/)
set(lab_header ${PROJECT_SOURCE_DIR}/include/hooke/lab.h)
list(REMOVE_ITEM headers ${io_headers} ${lab_header})
install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hooke)

# Scene and model files, and the importer that reads models (installed where it is built). The program `hooke`
# follows its own rules in apps/.
if(TARGET hooke_io)
  set_target_properties(hooke_io PROPERTIES EXPORT_NAME io)
  install(TARGETS hooke_io hooke_process EXPORT HookeIoTargets)
  install(EXPORT HookeIoTargets NAMESPACE hooke:: DESTINATION ${HOOKE_PACKAGE_DIR})
  install(FILES ${io_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hooke)
endif()

# The integrator laboratory.
if(TARGET hooke_lab)
  set_target_properties(hooke_lab PROPERTIES EXPORT_NAME lab)
  install(TARGETS hooke_lab EXPORT HookeLabTargets)
  install(EXPORT HookeLabTargets NAMESPACE hooke:: DESTINATION ${HOOKE_PACKAGE_DIR})
  install(FILES ${lab_header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hooke)
endif()

get_target_property(hooke_type hooke TYPE)
string(COMPARE EQUAL ${hooke_type} STATIC_LIBRARY HOOKE_IS_STATIC)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/HookeConfig.cmake.in ${PROJECT_BINARY_DIR}/HookeConfig.cmake
                              INSTALL_DESTINATION ${HOOKE_PACKAGE_DIR} PATH_VARS CMAKE_INSTALL_BINDIR)
# Before 1.0 a minor version may break what was there.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/HookeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/HookeConfig.cmake ${PROJECT_BINARY_DIR}/HookeConfigVersion.cmake
        DESTINATION ${HOOKE_PACKAGE_DIR})
