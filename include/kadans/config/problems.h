// Mistakes in a file from outside, collected while it is read and thrown as one InputError, in the order of the file.
// Everything read from a file keeps its place, so that what is only found wrong later (a parameter nobody declares, a
// signal nobody records) can still be refused where it was written.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/input_error.h"
#include "kadans/signal/text_place.h"

namespace kadans {

struct PlacedName {
  std::string name;
  TextPlace place;
};

class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  void add(TextPlace place, std::string message);
  void add(const InputError& error);  // what another file got wrong, behind the problems of this one
  // "unknown joint 'l_kne', did you mean 'l_knee'?"; with nothing near, the first known names.
  void add_unknown(TextPlace place, std::string_view what, std::string_view wrong, std::span<const std::string> known,
                   std::string_view where = "");
  void throw_if_any() const;  // InputError, sorted by place, nothing said twice

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

// A name from outside in a message: in single quotes, not too long, control characters escaped.
std::string in_quotes(std::string_view name);

// One mistake at a place, thrown at once.
[[noreturn]] void refuse(const std::string& file, TextPlace place, const std::string& message);
[[noreturn]] void refuse_unknown(const std::string& file, const PlacedName& wrong, std::string_view what,
                                 std::span<const std::string> known);

}  // namespace kadans
