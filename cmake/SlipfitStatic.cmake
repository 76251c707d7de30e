# slipfit_link_statically(target): links the program against the static form of the libraries beneath slipfit. A process
# that maps 12 shared libraries in place of 31 starts in half the time. The names are Debian's; where a trial does not
# link, the shared forms stay. METIS, libunwind, fmt and the C and C++ libraries stay shared in any case: there is no
# static form, or none for position-independent programs.
set(slipfit_static_libraries
  -Wl,--as-needed  # leaves out the shared forms, which come later on the command line
  -Wl,--start-group -l:libceres.a -l:libglog.a -l:libgflags.a -l:libcholmod.a -l:libspqr.a -l:libamd.a -l:libcamd.a
  -l:libccolamd.a -l:libcolamd.a -l:libsuitesparseconfig.a -l:libcxsparse.a -l:liblapack.a -l:libf77blas.a -l:libblas.a
  -l:libatlas.a -l:libfftw3.a -l:libgomp.a -l:libgfortran.a -l:libquadmath.a -Wl,--end-group
  -l:libmetis.so.5 -lgcc_s -lunwind -lm)  # libgcc_s first: exceptions are its business, not that of libunwind

set(CMAKE_REQUIRED_INCLUDES "${CERES_INCLUDE_DIRS}")
set(CMAKE_REQUIRED_LIBRARIES ${slipfit_static_libraries} Threads::Threads)
check_cxx_source_compiles("#include <ceres/c_api.h>
  int main() { ceres_init(); ceres_solve(ceres_create_problem()); }" SLIPFIT_LINKS_STATICALLY)
unset(CMAKE_REQUIRED_INCLUDES)
unset(CMAKE_REQUIRED_LIBRARIES)

function(slipfit_link_statically target)
  if(NOT SLIPFIT_LINKS_STATICALLY)
    return()
  endif()
  target_link_libraries(${target} PRIVATE ${slipfit_static_libraries})
endfunction()
