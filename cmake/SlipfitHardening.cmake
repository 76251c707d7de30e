# What Debian builds its packages with, for release builds: checked copies, canaries on the stack, and addresses of functions
# that are read-only once the program runs. Costs less than 1 % of a fit (benchmarks/results/robustness.md).
if(SLIPFIT_HARDENING)
  add_compile_options($<$<CONFIG:Release>:-U_FORTIFY_SOURCE> $<$<CONFIG:Release>:-D_FORTIFY_SOURCE=2>
    $<$<CONFIG:Release>:-fstack-protector-strong>)
  add_link_options($<$<CONFIG:Release>:LINKER:-z,relro,-z,now>)
endif()
