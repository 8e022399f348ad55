// A short name for contents: two files, or lists of texts, with the same hash are the same. 64 bits, not against
// somebody who wants them to collide; the same on every machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "kadans/signal/state_hash.h"

namespace kadans {

class ContentHash {
 public:
  // Texts are kept apart: "ab", "c" is not "a", "bc".
  void add(std::string_view text) noexcept;
  void add(std::uint64_t value) noexcept { hash_.add(value); }
  // A file's bytes; of a folder the names and bytes of all files in it and below whose name ends so ("" = all), sorted.
  // What is not there is something too. Throws InputError when a file cannot be read.
  void add_file(const std::filesystem::path& file);
  void add_folder(const std::filesystem::path& folder, std::string_view ending = "");

  std::uint64_t value() const noexcept { return hash_.value(); }
  std::string hex() const;  // 16 digits

 private:
  StateHash hash_;
};

}  // namespace kadans
