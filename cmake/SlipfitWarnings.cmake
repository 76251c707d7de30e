# Warnings for our own code only: linked privately, never exported.
add_library(slipfit_warnings INTERFACE)
target_compile_options(slipfit_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast -Wnon-virtual-dtor
  -Woverloaded-virtual -Wcast-align -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough
  $<$<BOOL:${SLIPFIT_WARNINGS_AS_ERRORS}>:-Werror>)
