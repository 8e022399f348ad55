// The rules of the source tree as functions over text: which layer may include and link what, how long a file may be,
// what nothing is called. A rule broken is a line for people; an empty list is a clean file. The list of layers comes
// from src/CMakeLists.txt, so that adding a layer there is all it takes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kadans::layout {

inline constexpr std::size_t max_lines = 400;
inline constexpr std::size_t max_source_lines = 700;  // of a .cpp in src/, which may hold a class whole

using Findings = std::vector<std::string>;

// The layers in their order, from the text of src/CMakeLists.txt: `set(layers exchange signal ...)`.
std::vector<std::string> read_layers(std::string_view cmake_text);
// The same from Markdown: the first column of the table whose first column is headed "layer".
std::vector<std::string> read_table_layers(std::string_view markdown);

// "plant/bullet/world.h" -> "plant"; "" when the first folder is no layer.
std::string layer_of(std::string_view path, const std::vector<std::string>& layers);

// `path` is the file's, below src/ or include/kadans/: its first folder is its layer.
Findings check_includes(std::string_view path, std::string_view text, const std::vector<std::string>& layers);
// A header that is installed may include others that are, and libraries.
Findings check_public(std::string_view path, std::string_view text);
// A CMakeLists.txt below src/: the targets kadans_<layer> that it names.
Findings check_links(std::string_view path, std::string_view cmake_text, const std::vector<std::string>& layers);
Findings check_length(std::string_view path, std::string_view text);
// No word in the names of the folders and of the file is utils, common, helpers, misc or manager, nor their kin.
Findings check_name(std::string_view path);
// Results are written by write_durably, which tells when they were not, and JSON by json_text, which leaves no byte
// that readers refuse; foreign JSON is read by foreign_json.h, which bounds it. `path` is below src/ or
// include/kadans/.
Findings check_writing(std::string_view path, std::string_view text);
// The types that a file defines for all files to see: those whose line begins in the first column, outside of unnamed
// namespaces, with their namespace in front: "kadans::TextPlace". Two files with the same one are two programs.
std::vector<std::string> types_defined_in(std::string_view text);
// The words of docs/architecture.md in the names of types: Live, Place, Tune and Tuning each mean one thing.
Findings check_words(std::string_view path, std::string_view text);
// CTest takes the names of test cases as a list: ';', '[' and ']' would tear them apart and the case would never run.
Findings check_test_names(std::string_view path, std::string_view text);

}  // namespace kadans::layout
