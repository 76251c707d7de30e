# Files that the HTML report carries inside: ours from src/report/html, and the chart library dygraphs where Debian's
# libjs-dygraphs (or SLIPFIT_DYGRAPHS_DIR) provides it. Without it reports have pictures in place of the interactive trace.
find_path(SLIPFIT_DYGRAPHS_DIR dygraph.min.js
  PATHS "${CMAKE_INSTALL_PREFIX}/share/javascript/dygraphs" /usr/share/javascript/dygraphs
  DOC "Folder with dygraph.min.js and dygraph.min.css")
if(SLIPFIT_DYGRAPHS_DIR)
  set(dygraphs_js "${SLIPFIT_DYGRAPHS_DIR}/dygraph.min.js")
  set(dygraphs_css "${SLIPFIT_DYGRAPHS_DIR}/dygraph.min.css")
else()
  message(STATUS "dygraphs not found: HTML reports will have no interactive trace (Debian: libjs-dygraphs)")
endif()

# slipfit_embed(TARGET FUNCTION FILE): FILE's bytes as slipfit::assets::FUNCTION() in TARGET; an empty FILE is empty text.
function(slipfit_embed target name file)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/assets/${name}.cpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/embed_file.cmake")
  add_custom_command(OUTPUT "${source}"
    COMMAND "${CMAKE_COMMAND}" "-DINPUT=${file}" "-DOUTPUT=${source}" "-DFUNCTION=${name}" -P "${script}"
    DEPENDS "${script}" ${file} VERBATIM)
  target_sources(${target} PRIVATE "${source}")
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
