# cmake --install installs the program, the headers, the models, behaviors and configurations, and find_package(kadans).
# That gives each layer as kadans::<layer>, and all of them but the testing kit as kadans::kadans. The installed tree has
# no absolute paths, so it may be moved as a whole.
include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kadans")

get_property(layers GLOBAL PROPERTY KADANS_LAYERS)
add_library(kadans_everything INTERFACE)
add_library(kadans::kadans ALIAS kadans_everything)
set_target_properties(kadans_everything PROPERTIES EXPORT_NAME kadans)
set(runtime_layers ${layers})
list(REMOVE_ITEM runtime_layers kadans_testing)
target_link_libraries(kadans_everything INTERFACE ${runtime_layers})

install(TARGETS ${layers} kadans_everything kadans_flags EXPORT kadansTargets)
install(EXPORT kadansTargets NAMESPACE kadans:: DESTINATION "${package_dir}")

configure_package_config_file(cmake/kadansConfig.cmake.in "${PROJECT_BINARY_DIR}/kadansConfig.cmake"
                              INSTALL_DESTINATION "${package_dir}" PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/kadansConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/kadansConfig.cmake" "${PROJECT_BINARY_DIR}/kadansConfigVersion.cmake"
              cmake/KadansDependencies.cmake cmake/KadansPlugin.cmake DESTINATION "${package_dir}")

install(DIRECTORY include/kadans "${PROJECT_BINARY_DIR}/include/kadans" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
foreach(folder IN ITEMS models behaviors config)
  if(EXISTS "${PROJECT_SOURCE_DIR}/${folder}")
    install(DIRECTORY ${folder} DESTINATION "${CMAKE_INSTALL_DATADIR}/kadans")
  endif()
endforeach()
install(FILES LICENSE third_party_notes.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")

if(TARGET kadans)
  install(TARGETS kadans)
  # The program itself writes what shells need to complete its command line.
  foreach(place IN ITEMS "bash|bash-completion/completions/kadans" "zsh|zsh/site-functions/_kadans")
    string(REPLACE "|" ";" place "${place}")
    list(GET place 0 shell)
    list(GET place 1 file)
    install(CODE "
      execute_process(COMMAND \"$<TARGET_FILE:kadans>\" completion ${shell} OUTPUT_VARIABLE script RESULT_VARIABLE failed)
      if(failed)
        message(WARNING \"no completion for ${shell}: \${failed}\")
      else()
        file(WRITE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/${file}\" \"\${script}\")
      endif()")
  endforeach()
  if(TARGET kadans-tune)
    install(TARGETS kadans-tune)
  endif()
endif()
