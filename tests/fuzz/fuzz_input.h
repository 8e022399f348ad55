// What fuzz targets share: an input as what it is made of, files that are only in memory, and what must hold.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <sys/mman.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans::fuzz {

// Ends the program, which makes the input a failure.
inline void require(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

enum class Placed : std::uint8_t { nowhere, line, column };

// An error says what is wrong, in which file and how exactly where; "there may be more" is nowhere.
inline void require_told(const InputError& error, std::string_view file, Placed placed = Placed::column) {
  require(!error.problems().empty(), "an error tells of a problem");
  for (const InputProblem& problem : error.problems()) {
    require(!problem.message.empty(), "a problem says what is wrong");
    const bool has_place =
        (placed < Placed::line || problem.line > 0) && (placed < Placed::column || problem.column > 0);
    const bool more = problem.message.starts_with("there may be more");
    if (problem.file != file || !(has_place || more)) require(false, "a problem has a place: " + problem.text());
  }
}

// The bytes of an input, taken from its front; behind its end there are zeros and nothing.
class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size) : left_(reinterpret_cast<const char*>(data), size) {}

  bool empty() const noexcept { return left_.empty(); }
  std::uint8_t byte() {
    const std::string_view one = take(1);
    return one.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(one[0]);
  }
  std::size_t length() {  // low byte first
    const std::size_t low = byte();
    return low + 256U * byte();
  }
  std::string_view take(std::size_t count) {
    const std::string_view taken = left_.substr(0, count);
    left_.remove_prefix(taken.size());
    return taken;
  }
  // Without its end.
  std::string_view line() {
    const std::string_view taken = take(std::min(left_.find('\n'), left_.size()));
    (void)take(1);
    return taken;
  }
  std::string_view rest() { return take(left_.size()); }

 private:
  std::string_view left_;
};

inline std::span<const std::byte> bytes_in(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// A file that no disk has.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view content = {}) : number_(memfd_create("kadans-fuzz", MFD_CLOEXEC)) {
    const bool written = number_ >= 0 && write(number_, content.data(), content.size()) == std::ssize(content);
    if (!written) throw std::runtime_error("no file in memory can be made");
  }
  ~MemoryFile() { close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }

 private:
  int number_;
};

}  // namespace kadans::fuzz
