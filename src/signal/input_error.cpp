#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

std::string joined(const std::vector<InputProblem>& problems) {
  std::string text;
  for (const InputProblem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

}  // namespace

std::string InputProblem::text() const {
  std::string place = file;
  if (line > 0) place += ':' + std::to_string(line);
  if (line > 0 && column > 0) place += ':' + std::to_string(column);
  return place.empty() ? message : place + ": " + message;
}

InputError::InputError(InputProblem problem) : InputError(std::vector<InputProblem>{std::move(problem)}) {}

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

}  // namespace kadans
