// A 64-bit hash that names contents: files or lists of texts with the same hash count as the same. It does not
// withstand somebody who makes hashes collide on purpose. It is the same on every machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "kadans/signal/state_hash.h"

namespace kadans {

class ContentHash {
 public:
  // Texts are kept apart: "ab", "c" gives another hash than "a", "bc".
  void add(std::string_view text) noexcept;
  void add(std::uint64_t value) noexcept { hash_.add(value); }
  // add_file adds the bytes of a file; a file that does not exist changes the hash too. add_folder adds the names and
  // bytes of all files in the folder and below it whose names end with `ending` ("": all files), sorted, but for what
  // is in the folder `leave_out`. Both throw InputError when a file cannot be read.
  void add_file(const std::filesystem::path& file);
  void add_folder(const std::filesystem::path& folder, std::string_view ending = "",
                  const std::filesystem::path& leave_out = {});

  std::uint64_t value() const noexcept { return hash_.value(); }
  std::string hex() const;  // 16 digits

 private:
  StateHash hash_;
};

}  // namespace kadans
