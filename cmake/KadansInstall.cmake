# cmake --install installs the program with its man pages and completion, the headers, the models, behaviors and
# configurations, and find_package(kadans).
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
  # Man pages, completion, editor stubs and pages of reference: the program itself writes them from its tables. When it was
  # compiled for another architecture, CMAKE_CROSSCOMPILING_EMULATOR runs it.
  set(reference "${PROJECT_BINARY_DIR}/reference")
  file(GLOB robots CONFIGURE_DEPENDS config/*/robot.json)
  add_custom_command(OUTPUT "${reference}/completion/kadans" "${reference}/stubs/kadans.lua"
                     COMMAND kadans reference "${reference}"
                     COMMAND kadans lua-stubs --robot config/tulip/robot.json --output "${reference}/stubs"
                     WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" DEPENDS kadans ${robots} VERBATIM
                     COMMENT "Writing man pages, completion and pages of reference")
  add_custom_target(kadans_reference ALL DEPENDS "${reference}/completion/kadans" "${reference}/stubs/kadans.lua")
  install(DIRECTORY "${reference}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" OPTIONAL)
  install(DIRECTORY "${reference}/stubs" DESTINATION "${CMAKE_INSTALL_DATADIR}/kadans" OPTIONAL)
  install(FILES "${reference}/completion/kadans" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" OPTIONAL)
  install(FILES "${reference}/completion/_kadans" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" OPTIONAL)
  if(TARGET kadans-tune)
    install(TARGETS kadans-tune)
  endif()
  if(TARGET kadans-hull)  # for kadans alone
    install(TARGETS kadans-hull DESTINATION "${CMAKE_INSTALL_LIBEXECDIR}")
  endif()
endif()
