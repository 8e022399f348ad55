// What is wrong in a file from outside: file:line:column, what is wrong, what was meant. Thrown before anything moves.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kadans {

struct InputProblem {
  std::string file;
  int line = 0;    // 1-based; 0 when the problem has no place in the file
  int column = 0;  // 1-based; 0 when unknown
  std::string message;
  std::string text() const;  // "file:line:column: message", without the parts that are 0
  InputProblem with(std::string other) const { return {file, line, column, std::move(other)}; }  // at the same place
};

class InputError : public std::runtime_error {
 public:
  explicit InputError(InputProblem problem);
  explicit InputError(std::vector<InputProblem> problems);  // at least one
  const std::vector<InputProblem>& problems() const noexcept { return problems_; }

 private:
  std::vector<InputProblem> problems_;
};

}  // namespace kadans
