# slipfit_unity_build(TARGET): with SLIPFIT_UNITY_BUILD up to 32 sources are one translation unit, because most of a file's compile
# time goes into headers and templates. Names local to a file must then be unique in its layer.
function(slipfit_unity_build target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SLIPFIT_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 32)
endfunction()

# slipfit_writes_text(TARGET): its code takes no time worth a third longer compilation, or a larger page.
function(slipfit_writes_text target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:$<IF:$<PLATFORM_ID:Emscripten>,-Oz,-O1>>)
endfunction()
