# Leptonica::leptonica (Debian: libleptonica-dev), readers of PNG, TIFF and JPEG.
find_path(Leptonica_INCLUDE_DIR leptonica/allheaders.h)
find_library(Leptonica_LIBRARY NAMES lept leptonica)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Leptonica REQUIRED_VARS Leptonica_LIBRARY Leptonica_INCLUDE_DIR)
if(Leptonica_FOUND AND NOT TARGET Leptonica::leptonica)
  add_library(Leptonica::leptonica UNKNOWN IMPORTED)
  set_target_properties(Leptonica::leptonica PROPERTIES
    IMPORTED_LOCATION "${Leptonica_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Leptonica_INCLUDE_DIR}")
endif()
mark_as_advanced(Leptonica_INCLUDE_DIR Leptonica_LIBRARY)
