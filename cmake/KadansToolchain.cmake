# Language, warnings and floating point, the same for every target of ours.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O2")  # asserts stay: they guard what a release robot must not do either
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}")

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE}")
endif()

add_library(kadans_flags INTERFACE)
add_library(kadans::flags ALIAS kadans_flags)
set_target_properties(kadans_flags PROPERTIES EXPORT_NAME flags)
# A fused multiply-add where the compiler finds one would make the same seed run differently on another compiler.
target_compile_options(kadans_flags INTERFACE -ffp-contract=off)
target_compile_features(kadans_flags INTERFACE cxx_std_20)

# With a sanitizer's calls between the lines gcc warns of what cannot be; there a warning is no error.
if(KADANS_WERROR AND NOT KADANS_SANITIZE)
  set(warnings_are_errors -Werror)
endif()

# gcc counts what a designated initializer leaves out as missing; leaving out is its point.
add_library(kadans_warnings INTERFACE)
target_compile_options(kadans_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor
                                                 -Wno-missing-field-initializers
                                                 ${warnings_are_errors})
# To clang a name that a neighbour in the same compilation happens to use is shadowed; file by file it still tells.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(kadans_warnings INTERFACE -Wno-shadow)
endif()
if(CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(kadans_warnings INTERFACE -fpch-preprocess)
endif()

if(KADANS_SANITIZE)
  add_compile_options(-fsanitize=${KADANS_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${KADANS_SANITIZE})
  if(KADANS_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()
