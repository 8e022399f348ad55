# Language, warnings and floating point, the same for every target of ours.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options("SHELL:--param ggc-min-heapsize=1000000")  # kB; it seldom looks for garbage, which took 6 to 17 % of a unit
endif()
add_compile_options(-fno-semantic-interposition)  # no other library replaces a function of ours: the compiler may inline it
set(KADANS_OPTIMISATION "" CACHE STRING "How builds are optimised (default: -O2, with debug information -O1)")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 ${KADANS_OPTIMISATION}")  # asserts stay: they guard what a release robot must not do either
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1 ${KADANS_OPTIMISATION}")
if(KADANS_FUZZ)  # clang inlines nothing at -O1
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")
  add_compile_options(-fsanitize-coverage-ignorelist=${PROJECT_SOURCE_DIR}/tests/fuzz/libraries.txt)
endif()
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
# If a compiler fused multiplications with additions, the same seed would run differently with another compiler.
target_compile_options(kadans_flags INTERFACE -ffp-contract=off)
# The functions of src/signal/portable_math.cpp. A compiler that knew them would replace a call with a constant argument by
# its own result. Every program exports them to the libraries that it loads, plug-ins too.
set(KADANS_PORTABLE_MATH sin cos sincos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2 log10
                         log1p pow cbrt hypot erf erfc tgamma lgamma)
foreach(function IN LISTS KADANS_PORTABLE_MATH)
  target_compile_options(kadans_flags INTERFACE -fno-builtin-${function} -fno-builtin-${function}f)
  target_link_options(kadans_flags INTERFACE LINKER:--export-dynamic-symbol=${function},--export-dynamic-symbol=${function}f)
endforeach()
# Eigen would split large products by the sizes of the caches; so it may not ask for these sizes.
target_compile_definitions(kadans_flags INTERFACE EIGEN_NO_CPUID)
target_compile_features(kadans_flags INTERFACE cxx_std_20)
# On i386 doubles are computed by SSE2, in 64 bits as everywhere, not in the 80 of the x87; src/app/processor_check.cpp says
# so at the start of the program. Debian's libraries there are compiled without SSE, so Eigen must align as it does in them.
include(CheckCXXSymbolExists)
check_cxx_symbol_exists(__i386__ cstddef KADANS_I386)
if(KADANS_I386)
  target_compile_options(kadans_flags INTERFACE -msse2 -mfpmath=sse)
  target_compile_definitions(kadans_flags INTERFACE EIGEN_MAX_ALIGN_BYTES=0)
endif()

# With a sanitizer's calls in the code, gcc gives false warnings; so there a warning is no error.
if(KADANS_WERROR AND NOT (KADANS_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"))
  set(warnings_are_errors -Werror)
endif()

# gcc warns of fields that a designated initializer leaves out; but leaving fields out is its purpose.
add_library(kadans_warnings INTERFACE)
target_compile_options(kadans_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor
                                                 -Wno-missing-field-initializers
                                                 ${warnings_are_errors})
# In a unity build clang warns of names that another file of the same batch uses, too; file by file it still warns rightly.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  target_compile_options(kadans_warnings INTERFACE -Wno-shadow)
endif()
if(CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(kadans_warnings INTERFACE -fpch-preprocess)
endif()

if(KADANS_SANITIZE)
  add_compile_options(-fsanitize=${KADANS_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${KADANS_SANITIZE})
  add_compile_options(-fno-sanitize-recover=all)
  add_compile_definitions(KADANS_SANITIZED)
endif()
