# slipfit_unity_by_folder(TARGET): with SLIPFIT_UNITY_BUILD the sources of one folder are one translation unit, because most
# of a file's compile time goes into headers. Names local to a file must then be unique in its folder.
function(slipfit_unity_by_folder target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME group)
    if(NOT group)
      set(group "${target}")
    endif()
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${group}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${SLIPFIT_UNITY_BUILD} UNITY_BUILD_MODE GROUP)
endfunction()

# slipfit_writes_text(TARGET): its code takes no time worth a third longer compilation, or a larger page.
function(slipfit_writes_text target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:$<IF:$<PLATFORM_ID:Emscripten>,-Oz,-O1>>)
endfunction()
