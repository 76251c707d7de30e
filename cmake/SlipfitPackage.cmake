# cpack -G DEB: the tool, the library and its headers as a Debian package; with SLIPFIT_PYTHON the module as a second one.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME slipfit)
set(CPACK_PACKAGE_VENDOR "the slipfit authors")
set(CPACK_PACKAGE_CONTACT "the slipfit authors <slipfit@example.org>")  # Debian wants an address; nobody publishes this package
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The library is static: who links it needs what it is made of. The tool alone does not.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
  "libceres-dev, libeigen3-dev, libfftw3-dev, libfmt-dev, zlib1g-dev, libminizip-dev, libpugixml-dev")
set(CPACK_PACKAGE_DESCRIPTION "Finds the slips in a recording of a tribometer (force over time),
fits stiffness, friction, natural frequency and damping of a slider on a
spring, and gives each number with a 95 % interval or the reason why it
cannot be told.")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME slipfit)
set(CPACK_COMPONENT_UNSPECIFIED_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION}")
if(SLIPFIT_PYTHON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-slipfit)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Python module of slipfit\n${CPACK_PACKAGE_DESCRIPTION}")
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy, slipfit (= ${PROJECT_VERSION})")
  # What Python compiles comes and goes with the package.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    "${CMAKE_CURRENT_LIST_DIR}/python3-slipfit/postinst" "${CMAKE_CURRENT_LIST_DIR}/python3-slipfit/prerm")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-pandas, python3-matplotlib")
endif()
include(CPack)
