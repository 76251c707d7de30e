# Man pages and completion by --help, where there is a Python to make them.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_Interpreter_FOUND)
  set(manual "${PROJECT_BINARY_DIR}/manual")
  add_custom_command(OUTPUT "${manual}/slipfit.bash"
    COMMAND "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/scripts/manual.py" "$<TARGET_FILE:slipfit_cli>" "${manual}"
    DEPENDS slipfit_cli "${PROJECT_SOURCE_DIR}/scripts/manual.py" "${PROJECT_SOURCE_DIR}/CHANGELOG.md" VERBATIM)
  add_custom_target(slipfit_manual ALL DEPENDS "${manual}/slipfit.bash")
  # Without its target there is none, and nothing to install.
  install(DIRECTORY "${manual}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" OPTIONAL)
  install(FILES "${manual}/slipfit.bash" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME slipfit
    OPTIONAL)
  install(FILES "${manual}/_slipfit" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions" OPTIONAL)
  install(FILES "${manual}/slipfit.fish" DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" OPTIONAL)
  install(FILES "${manual}/changelog.gz" DESTINATION "${CMAKE_INSTALL_DOCDIR}" OPTIONAL)
  install(CODE "if(NOT EXISTS \"${manual}/slipfit.bash\")
    message(STATUS \"Left out: man pages and completion, which the target slipfit_manual makes\")
  endif()")
else()
  add_custom_target(slipfit_manual
    COMMAND "${CMAKE_COMMAND}" -E echo "No man pages and no completion: they need Python 3, which CMake did not find")
  install(CODE "message(STATUS \"Left out: man pages and completion, which need Python 3 when slipfit is built\")")
endif()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright)
