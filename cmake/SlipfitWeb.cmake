# The program as a WebAssembly module: web/slipfit.js wraps what emscripten writes.
set_target_properties(slipfit_web PROPERTIES OUTPUT_NAME slipfit-core SUFFIX .js RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}")
# Memory grows as far as 32-bit addresses reach: 10^7 rows take about 1 GB.
target_link_options(slipfit_web PRIVATE --no-entry -fwasm-exceptions
  "SHELL:-s MODULARIZE=1" "SHELL:-s EXPORT_NAME=createSlipfit" "SHELL:-s ENVIRONMENT=web,worker" "SHELL:-s FORCE_FILESYSTEM=1"
  "SHELL:-s ALLOW_MEMORY_GROWTH=1" "SHELL:-s MAXIMUM_MEMORY=4GB" "SHELL:-s INITIAL_MEMORY=64MB"
  "SHELL:-s EXPORTED_RUNTIME_METHODS=ccall,FS" "SHELL:-s INCOMING_MODULE_JS_API=instantiateWasm,print,printErr")
