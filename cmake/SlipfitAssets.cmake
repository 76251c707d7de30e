# Files that the HTML report carries inside, from src/report/html.
# slipfit_embed(TARGET FUNCTION FILE): FILE's bytes as slipfit::assets::FUNCTION() in TARGET; an empty FILE is empty text.
function(slipfit_embed target name file)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/assets/${name}.cpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/embed_file.cmake")
  add_custom_command(OUTPUT "${source}"
    COMMAND "${CMAKE_COMMAND}" "-DINPUT=${file}" "-DOUTPUT=${source}" "-DFUNCTION=${name}" -P "${script}"
    DEPENDS "${script}" ${file} VERBATIM)
  set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE "${source}")
endfunction()

# slipfit_build_identity(TARGET HEADER): compiler, options, libraries of numbers and digest of the sources, as a header of TARGET. It
# changes with every source, so that who includes it is best compiled alone.
function(slipfit_build_identity target header)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/${header}")
  set(script "${PROJECT_SOURCE_DIR}/cmake/build_identity.cmake")
  set(folders "${PROJECT_SOURCE_DIR}/src" "${PROJECT_SOURCE_DIR}/include")
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  string(SHA256 options "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} Ceres ${Ceres_VERSION} Eigen ${Eigen3_VERSION}")
  string(SUBSTRING "${options}" 0 8 options)
  set(compiler "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_SYSTEM_PROCESSOR}, options ${options}")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/*.[ch]pp" "${PROJECT_SOURCE_DIR}/include/*.[ch]pp")
  add_custom_command(OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DFOLDERS=${folders}" "-DCOMPILER=${compiler}" "-DOUTPUT=${output}" -P "${script}"
    DEPENDS "${script}" ${sources} VERBATIM)
  target_sources(${target} PRIVATE "${output}")
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
endfunction()

# slipfit_commit(TARGET HEADER): the commit of the sources as a header of TARGET, which changes with every commit: who includes it is best
# compiled alone.
function(slipfit_commit target header)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/${header}")
  set(script "${PROJECT_SOURCE_DIR}/cmake/commit.cmake")
  execute_process(COMMAND git -C "${PROJECT_SOURCE_DIR}" rev-parse --git-path logs/HEAD
    OUTPUT_VARIABLE log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  get_filename_component(log "${log}" ABSOLUTE BASE_DIR "${PROJECT_SOURCE_DIR}")
  if(NOT EXISTS "${log}" OR IS_DIRECTORY "${log}")
    set(log "")
  endif()
  add_custom_command(OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${PROJECT_SOURCE_DIR}" "-DOUTPUT=${output}" -P "${script}" DEPENDS "${script}" ${log} VERBATIM)
  target_sources(${target} PRIVATE "${output}")
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
endfunction()

# slipfit_remedies(TARGET HEADER): what docs/formats.md says to do about each error, as a header of TARGET.
function(slipfit_remedies target header)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/${header}")
  set(tables "${PROJECT_SOURCE_DIR}/docs/formats.md")
  set(script "${PROJECT_SOURCE_DIR}/cmake/remedies.cmake")
  add_custom_command(OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DINPUT=${tables}" "-DOUTPUT=${output}" -P "${script}" DEPENDS "${script}" "${tables}" VERBATIM)
  target_sources(${target} PRIVATE "${output}")
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
endfunction()
