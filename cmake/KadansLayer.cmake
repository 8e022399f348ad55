# The standard headers that half of the sources include. They are read once for all layers, and once more, with doctest,
# for all tests. Reading them again for each file would take a third of the time of a build.
set(KADANS_STANDARD_HEADERS <algorithm> <array> <charconv> <cmath> <cstdint> <cstdio> <cstring> <filesystem> <fstream> <functional>
    <limits> <map> <memory> <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <system_error> <unordered_map>
    <utility> <variant> <vector>)

# How many files are compiled at once in a unity build where speed does not matter: half of the time is that of headers and
# of templates that each unit makes again. In a unit so large the compiler inlines less, so fast code keeps the presets' 16.
set(KADANS_LARGE_BATCH 64)

# kadans_layer(NAME [SMALL] [SOURCES file...] [LINKS target...] [PRIVATE_LINKS target...] [PRECOMPILE header...])
# A static library kadans_NAME, known as kadans::NAME; "/" in a name becomes "_" (plant/bullet -> kadans_plant_bullet).
# SOURCES are, unless given, all files of its folder and of those below that have no CMakeLists.txt, but no main.cpp and
# none that another layer of the folder has. So a new file needs no entry anywhere.
# SMALL: compiled for size, not for speed.
# PRECOMPILE names headers that nearly all of its files include, beside the standard ones.
function(kadans_layer name)
  cmake_parse_arguments(arg "SMALL" "" "SOURCES;LINKS;PRIVATE_LINKS;PRECOMPILE" ${ARGN})
  string(REPLACE "/" "_" target "kadans_${name}")
  string(REPLACE "/" "_" export "${name}")
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" *.cpp */*.cpp)
    file(GLOB others RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" */CMakeLists.txt)
    foreach(other IN LISTS others)
      cmake_path(GET other PARENT_PATH folder)
      list(FILTER arg_SOURCES EXCLUDE REGEX "^${folder}/")
    endforeach()
    get_property(taken DIRECTORY PROPERTY KADANS_TAKEN)
    list(REMOVE_ITEM arg_SOURCES main.cpp ${taken})
  endif()
  set_property(DIRECTORY APPEND PROPERTY KADANS_TAKEN ${arg_SOURCES})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(kadans::${export} ALIAS ${target})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                              $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} PUBLIC kadans_flags ${arg_LINKS}
                                  PRIVATE ${arg_PRIVATE_LINKS} $<BUILD_INTERFACE:kadans_warnings>)
  if(arg_SMALL)
    target_compile_options(${target} PRIVATE ${KADANS_SMALL})
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${KADANS_LARGE_BATCH})
    set(precompiled kadans_precompiled_small)
  else()
    set(precompiled kadans_precompiled)
  endif()
  if(arg_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${KADANS_STANDARD_HEADERS} ${arg_PRECOMPILE})
  else()
    target_precompile_headers(${target} REUSE_FROM ${precompiled})
  endif()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${export})
  set_property(GLOBAL APPEND PROPERTY KADANS_LAYERS ${target})
endfunction()

# kadans_test(LAYER SOURCES file... [LINKS target...] [LONG case...])
# Makes one program of doctest cases; each case is a ctest test. Sources are compiled together: a test whose names another
# source may have, too, stands in a namespace of its own. LONG names cases that take more than ten seconds: ctest begins with
# them, so that no core waits for the last one.
function(kadans_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS;LONG" ${ARGN})
  string(REPLACE "/" "_" target "${name}_test")
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE kadans_test_main ${arg_LINKS} kadans_warnings)
  target_precompile_headers(${target} REUSE_FROM kadans_test_main)
  target_compile_definitions(${target} PRIVATE KADANS_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                               KADANS_BINARY_DIR="${PROJECT_BINARY_DIR}")
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests"
                                             UNITY_BUILD_BATCH_SIZE ${KADANS_LARGE_BATCH}
                                             POSITION_INDEPENDENT_CODE OFF)  # as kadans_test_main, for its precompiled header
  include(doctest)
  doctest_discover_tests(${target} TEST_PREFIX "${name}: ")
  set(costs "")
  foreach(case IN LISTS arg_LONG)
    string(APPEND costs "set_tests_properties([==[${name}:${case}]==] PROPERTIES COST 20)\n")
  endforeach()
  file(CONFIGURE OUTPUT "${target}_costs.cmake" CONTENT "${costs}" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${CMAKE_CURRENT_BINARY_DIR}/${target}_costs.cmake")
endfunction()
