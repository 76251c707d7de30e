# slipfit_link_statically(target): links the program against the static form of the libraries beneath slipfit. A process
# that maps 6 shared libraries in place of 31 starts in less than half the time. The names are Debian's; where a trial does not
# link, the shared forms stay. METIS, libunwind and the C library stay shared in any case: there is no static form, or
# none for position-independent programs.
foreach(name IN ITEMS pugixml minizip z)
  find_library(SLIPFIT_STATIC_${name} lib${name}.a)
  mark_as_advanced(SLIPFIT_STATIC_${name})
  if(SLIPFIT_STATIC_${name})
    list(APPEND slipfit_static_containers "${SLIPFIT_STATIC_${name}}")
  endif()
endforeach()
set(slipfit_static_libraries
  -Wl,--as-needed  # leaves out the shared forms, which come later on the command line
  -Wl,--start-group -l:libceres.a -l:libglog.a -l:libgflags.a -l:libcholmod.a -l:libspqr.a -l:libamd.a -l:libcamd.a
  -l:libccolamd.a -l:libcolamd.a -l:libsuitesparseconfig.a -l:libcxsparse.a -l:liblapack.a -l:libf77blas.a -l:libblas.a
  -l:libatlas.a -l:libfftw3.a -l:libgomp.a -l:libgfortran.a -l:libquadmath.a -Wl,--end-group ${slipfit_static_containers}
  -l:libmetis.so.5 -static-libstdc++ -static-libgcc
  -lgcc -lgcc_eh -lunwind -lm)  # libgcc_eh first: exceptions are its business, not that of libunwind

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
