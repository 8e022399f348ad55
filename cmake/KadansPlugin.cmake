# kadans_plugin(NAME SOURCES file... [LINKS target...]): a shared library NAME.so of control objects and types of plants, to
# be named under "plugins" in a robot's configuration. It has its own copy of what it uses of Kadans, and exports nothing but
# its descriptor. kadans/control/plugin.h says why, and which programs it fits. LINKS may name only layers that have no
# state of which a process has one.
function(kadans_plugin name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  set(layers exchange signal model plant plant_ideal plant_udp estimate safety control engine realtime)
  foreach(target IN LISTS arg_LINKS)
    string(REGEX REPLACE "^kadans(::|_)" "" layer "${target}")
    if(NOT layer STREQUAL target AND NOT layer IN_LIST layers AND NOT layer MATCHES "^(flags|warnings)$")
      message(FATAL_ERROR "plug-in ${name} links ${target}, which a process has once; it may link these of Kadans: ${layers}")
    endif()
  endforeach()
  add_library(${name} MODULE ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE kadans::control ${arg_LINKS})
  target_link_options(${name} PRIVATE -Wl,-Bsymbolic -Wl,--exclude-libs,ALL -Wl,-z,now)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
