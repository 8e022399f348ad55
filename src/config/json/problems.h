// The mistakes in a file from outside. They are collected while the file is read and thrown as one InputError, in the
// order of the file. All that is read from a file keeps its place. So a mistake that is found only later (an undeclared
// parameter, a signal that is not recorded) is still reported at the place where it was written.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/input_error.h"
#include "signal/utf8.h"

namespace kadans {

struct PlacedName {
  std::string name;
  TextPlace place;
};

class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  void add(TextPlace place, std::string message);
  void add(const InputError& error);  // mistakes of another file; they are listed after those of this file
  // Adds "unknown joint 'l_kne', did you mean 'l_knee'?". When no known name is near, the message lists the first known
  // names.
  void add_unknown(TextPlace place, std::string_view what, std::string_view wrong, std::span<const std::string> known,
                   std::string_view where = "");
  // Which of `known` it is; when it is none, adds that.
  std::optional<std::size_t> known(const PlacedName& name, std::string_view what, std::span<const std::string> known,
                                   std::string_view where = "");
  void throw_if_any() const;  // throws InputError, sorted by place, without duplicates

  bool empty() const noexcept { return problems_.empty() && others_.empty(); }
  const std::string& file() const noexcept { return file_; }

 private:
  std::string file_;
  std::vector<InputProblem> problems_;
  std::vector<InputProblem> others_;
};

// "unknown WHAT 'WRONG' WHERE, did you mean 'NAME'?"
std::string unknown_name(std::string_view what, std::string_view wrong, std::span<const std::string> known,
                         std::string_view where = "");

// A name from outside, made safe for a message: in single quotes, shortened when too long, control characters replaced
// by '?'.
std::string in_quotes(std::string_view name);

// Throws one mistake at a place at once.
[[noreturn]] void refuse(const std::string& file, TextPlace place, const std::string& message);
[[noreturn]] void refuse_unknown(const std::string& file, const PlacedName& wrong, std::string_view what,
                                 std::span<const std::string> known);

}  // namespace kadans
