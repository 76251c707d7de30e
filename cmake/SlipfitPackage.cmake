# cpack -G DEB: the tool, the library and its headers as a Debian package.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME slipfit)
set(CPACK_PACKAGE_VENDOR "the slipfit authors")
set(CPACK_PACKAGE_CONTACT "the slipfit authors <slipfit@localhost>")  # Debian wants an address; nobody publishes this package
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The library is static: who links it needs what it is made of. The tool alone does not.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
  "libceres-dev, libeigen3-dev, libfftw3-dev, libfmt-dev, zlib1g-dev, libminizip-dev, libpugixml-dev")
include(CPack)
