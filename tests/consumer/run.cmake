# Puts slipfit into an empty folder, from the build tree or out of its Debian package (FROM_PACKAGE), builds the consumer against
# it and runs both programs; any failing step fails the test.
file(REMOVE_RECURSE "${WORK_DIR}")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(FROM_PACKAGE)
  set(prefix "${WORK_DIR}/root/usr")
  run("${CMAKE_CPACK_COMMAND}" -G DEB --config "${SLIPFIT_BUILD_DIR}/CPackConfig.cmake" -B "${WORK_DIR}")
  file(GLOB package "${WORK_DIR}/slipfit_*.deb")
  run(dpkg-deb --field "${package}" Package Version Depends)
  run(dpkg-deb --extract "${package}" "${WORK_DIR}/root")
else()
  set(prefix "${WORK_DIR}/prefix")
  run("${CMAKE_COMMAND}" --install "${SLIPFIT_BUILD_DIR}" --prefix "${prefix}")
endif()
run("${CMAKE_COMMAND}" -S "${CONSUMER_SOURCE_DIR}" -B "${WORK_DIR}/build" -G "${GENERATOR}"
  "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
  "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}")
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build")
run("${WORK_DIR}/build/consumer")
run("${prefix}/bin/slipfit" --version)
