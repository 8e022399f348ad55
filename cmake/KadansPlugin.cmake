# kadans_plugin(NAME SOURCES file... [LINKS target...]): a shared library NAME.so of control objects, to be named under
# "plugins" in a robot's configuration. It has its own copy of what it uses of Kadans, and exports nothing but its entry.
# So it fits every program with the same version of the seam (kadans/control/plugin.h).
function(kadans_plugin name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  add_library(${name} MODULE ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE kadans::control ${arg_LINKS})
  target_link_options(${name} PRIVATE -Wl,-Bsymbolic -Wl,--exclude-libs,ALL -Wl,-z,now)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()
