# Hardening of release builds: what Debian builds its packages with (checked copies, canaries on the stack, addresses of functions
# that are read-only once the program runs), and checked access to containers of the standard library, so that an index out of range ends the
# program instead of reading foreign memory. Cost: benchmarks/results/robustness.md.
if(SLIPFIT_HARDENING)
  add_compile_options($<$<CONFIG:Release>:-U_FORTIFY_SOURCE> $<$<CONFIG:Release>:-D_FORTIFY_SOURCE=2>
    $<$<CONFIG:Release>:-fstack-protector-strong> $<$<CONFIG:Release>:-D_GLIBCXX_ASSERTIONS>)
  if(NOT APPLE)
    add_link_options($<$<CONFIG:Release>:LINKER:-z,relro,-z,now>)
  endif()
endif()
