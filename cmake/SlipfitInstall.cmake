# cmake --install, find_package(slipfit), and the tests of both.
include(CMakePackageConfigHelpers)

set(SLIPFIT_CMAKE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/slipfit")

install(TARGETS slipfit EXPORT slipfit_targets
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(TARGETS slipfit_cli RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
if(TARGET slipfit_hdf5)
  install(TARGETS slipfit_hdf5 RUNTIME DESTINATION "${CMAKE_INSTALL_LIBEXECDIR}/slipfit")
endif()
if(TARGET slipfit_image)
  install(TARGETS slipfit_image RUNTIME DESTINATION "${CMAKE_INSTALL_LIBEXECDIR}/slipfit")
endif()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/slipfit" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(EXPORT slipfit_targets NAMESPACE slipfit:: FILE slipfit-targets.cmake DESTINATION "${SLIPFIT_CMAKE_DIR}")

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/slipfit-config.cmake.in"
  "${PROJECT_BINARY_DIR}/slipfit-config.cmake" INSTALL_DESTINATION "${SLIPFIT_CMAKE_DIR}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/slipfit-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/slipfit-config.cmake"
  "${PROJECT_BINARY_DIR}/slipfit-config-version.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/FindFFTW3.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/FindMinizip.cmake"
  DESTINATION "${SLIPFIT_CMAKE_DIR}")
install(FILES "${PROJECT_SOURCE_DIR}/docs/fit.schema.json" "${PROJECT_SOURCE_DIR}/docs/predict.schema.json"
  "${PROJECT_SOURCE_DIR}/docs/info.schema.json" "${PROJECT_SOURCE_DIR}/docs/compare.schema.json"
  "${PROJECT_SOURCE_DIR}/docs/surface.schema.json" "${PROJECT_SOURCE_DIR}/LICENSE"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/slipfit")

if(SLIPFIT_BUILD_TESTS)
  set(consumer_settings
    "-DSLIPFIT_BUILD_DIR=${PROJECT_BINARY_DIR}" "-DCONSUMER_SOURCE_DIR=${PROJECT_SOURCE_DIR}/tests/consumer"
    "-DCXX_COMPILER=${CMAKE_CXX_COMPILER}" "-DCXX_FLAGS=${CMAKE_CXX_FLAGS}" "-DBUILD_TYPE=${CMAKE_BUILD_TYPE}"
    "-DGENERATOR=${CMAKE_GENERATOR}" "-DCMAKE_CPACK_COMMAND=${CMAKE_CPACK_COMMAND}")
  set(consumer_script "${PROJECT_SOURCE_DIR}/tests/consumer/run.cmake")
  add_test(NAME consumer/find_package
    COMMAND "${CMAKE_COMMAND}" ${consumer_settings} "-DWORK_DIR=${PROJECT_BINARY_DIR}/consumer" -P "${consumer_script}")
  add_test(NAME consumer/subproject
    COMMAND "${CMAKE_COMMAND}" -S "${PROJECT_SOURCE_DIR}/tests/consumer/subproject" -B "${PROJECT_BINARY_DIR}/consumer-subproject"
      -G "${CMAKE_GENERATOR}" "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}" "-DSLIPFIT_SOURCE_DIR=${PROJECT_SOURCE_DIR}")
  find_program(SLIPFIT_SHLIBDEPS dpkg-shlibdeps)
  if(SLIPFIT_SHLIBDEPS)
    add_test(NAME consumer/debian_package
      COMMAND "${CMAKE_COMMAND}" ${consumer_settings} "-DWORK_DIR=${PROJECT_BINARY_DIR}/consumer-package" -DFROM_PACKAGE=ON
        -P "${consumer_script}")
  endif()
endif()
