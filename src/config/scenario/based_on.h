// A file may say only what differs from another file, its base. The key "based_on" names the base by its path from the
// project root.
//
//   an object      keys of the file replace those of the base, new keys come last
//   a list whose items all have a "name"    items of the same name are merged, new items come last
//   anything else  the file's value replaces the base's
// A base may have a base itself, up to based_on_depth_max. Values that come from a base get the place at which the file
// names the base. So a reader of such files first reads the base alone, so that the base's own mistakes are reported at
// their own places.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/json/fields.h"

namespace kadans {

inline constexpr std::size_t based_on_depth_max = 8;

// The merged text, and all files that it is based on, the nearest first.
struct BasedJson {
  JsonValue value;
  std::vector<std::filesystem::path> bases;
};

// Throws InputError with the first mistake: invalid JSON, a base that does not exist, or files based on each other.
BasedJson parse_based_json(std::string_view text, const std::string& file);

// Reads such a file: read(Fields&) lists its fields, after read_base(path) has read the nearest base alone.
template <typename ReadBase, typename Read>
void read_based_fields(std::string_view text, const std::string& file, ReadBase&& read_base, Read&& read) {
  const BasedJson json = parse_based_json(text, file);
  if (!json.bases.empty()) (void)read_base(json.bases.front());
  Problems problems(file);
  read_fields(json.value, problems, read);
  problems.throw_if_any();
}

// The file and all files that it is based on. A file that cannot be read has no base.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& file);

}  // namespace kadans
