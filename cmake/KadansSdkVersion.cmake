# kadans_sdk_version(OUT HEADER): defines KADANS_SDK in the file OUT, "kadans 0.2.0, headers 3f2c...": the version, and a hash
# of the header HEADER of include/ with all of ours that it includes. A plug-in and a program of the same hash mean the same
# by each type that crosses between them (kadans/control/plugin.h).
function(kadans_sdk_version out header)
  set(open "${header}")
  set(seen "")
  set(hashes "")
  while(open)
    list(POP_FRONT open name)
    set(file "${PROJECT_SOURCE_DIR}/include/${name}")
    if(name IN_LIST seen OR out MATCHES "/${name}$")  # OUT itself does not count
      continue()
    endif()
    list(APPEND seen "${name}")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
    file(SHA256 "${file}" hash)
    string(APPEND hashes "${name} ${hash}\n")
    file(STRINGS "${file}" includes REGEX "^#include \"kadans/")
    list(TRANSFORM includes REPLACE "^#include \"(.+)\".*" "\\1")
    list(APPEND open ${includes})
  endwhile()
  string(SHA256 hash "${hashes}")
  string(SUBSTRING "${hash}" 0 16 hash)
  file(CONFIGURE OUTPUT "${out}" @ONLY CONTENT [[// Made by cmake/KadansSdkVersion.cmake of the headers that plug-ins share with the program.
#pragma once

#define KADANS_SDK "kadans @PROJECT_VERSION@, headers @hash@"
]])
endfunction()
