#include "check_behavior.h"

#include <algorithm>
#include <tuple>

#include "check_chart.h"
#include "check_source.h"
#include "check_vars.h"
#include "known_names.h"
#include "script/behavior/behavior_parts.h"
#include "script/host/silent_log.h"

namespace kadans {

std::vector<InputProblem> check_behavior(const std::filesystem::path& root, const std::filesystem::path& file,
                                         const Catalog& catalog) {
  SilentLog silence;
  const Behavior::Settings settings{.root = root, .file = file.is_absolute() ? file : root / file};
  Behavior::Parts parts(settings, catalog, silence);
  std::vector<InputProblem> problems;
  try {
    load_behavior(parts, settings.limits.load_instructions);
    check_chart(parts.chart, problems);
    check_vars(parts, problems);
    KnownNames known = read_known_names(parts);
    check_sources(parts, known, problems);
  } catch (const InputError& error) {
    return error.problems();
  }
  tell_once(problems);  // a behavior that is called twice
  return problems;
}

void tell_once(std::vector<InputProblem>& problems) {
  const auto key = [](const InputProblem& problem) { return std::tie(problem.file, problem.line, problem.message); };
  std::ranges::stable_sort(problems, {}, key);
  const auto same = [&](const InputProblem& a, const InputProblem& b) { return key(a) == key(b); };
  problems.erase(std::unique(problems.begin(), problems.end(), same), problems.end());
}

}  // namespace kadans
