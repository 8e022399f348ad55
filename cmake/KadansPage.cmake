# kadans_embed_page(DIST SOURCE): the built page as a source file that defines kadans::page_files(). Each file is in DIST
# twice: as it is, and compressed by the page's own build (FILE.gz). The compressed files go into the program.
function(kadans_embed_page dist source)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE "${dist}" "${dist}/*.gz")
  set(arrays "")
  set(entries "")
  set(number 0)
  foreach(file IN LISTS files)
    file(READ "${dist}/${file}" hex HEX)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${dist}/${file}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(REGEX REPLACE "\\.gz$" "" name "${file}")
    string(APPEND arrays "constexpr unsigned char file_${number}[] = {${bytes}};\n")
    string(APPEND entries "    {\"/${name}\", {file_${number}, sizeof file_${number}}},\n")
    math(EXPR number "${number} + 1")
  endforeach()
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT [[// Made by cmake/KadansPage.cmake of the built page.
#include "remote/page/page_files.h"

namespace kadans {
namespace {

@arrays@
const std::vector<PageFile> files{
@entries@};

}  // namespace

const std::vector<PageFile>& page_files() noexcept { return files; }

}  // namespace kadans
]])
endfunction()
