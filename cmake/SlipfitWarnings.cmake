# Warnings for our own code only: linked privately, never exported.
# -Wno-restrict: g++ 12 sees an overlap in "literal" + std::string that is not there (GCC bug 105651).
# -Wno-maybe-uninitialized: g++ sees the destructor of an empty std::optional read its value (GCC bug 80635).
add_library(slipfit_warnings INTERFACE)
target_compile_options(slipfit_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast -Wnon-virtual-dtor
  -Woverloaded-virtual -Wcast-align -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>
  $<$<BOOL:${SLIPFIT_WARNINGS_AS_ERRORS}>:-Werror>)
