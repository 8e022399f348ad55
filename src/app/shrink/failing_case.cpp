#include "failing_case.h"

#include <algorithm>
#include <filesystem>

#include "app/author/file_checks.h"
#include "campaign/sweep/sweep_results.h"
#include "kadans/signal/shell_word.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "telemetry/record/record_folder.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// "kadans sim FILE --seed N --set NAME=NUMBER ..."
RunChoices choices_of_line(const std::string& line, const std::string& file) {
  const std::vector<std::string> words = shell_words(line);
  RunChoices choices;
  bool known = words.size() >= 5 && words.size() % 2 == 1 && words[1] == "sim";
  if (known) choices.scenario = words[2];
  for (std::size_t i = 3; known && i < words.size(); i += 2) {
    if (words[i] == "--set") {
      choices.set.push_back(words[i + 1]);
    } else {
      choices.seed = number_of<std::uint64_t>(words[i + 1]);
      known = words[i] == "--seed" && choices.seed.has_value();
    }
  }
  if (!known) refuse(file, "does not say in 'repeat' how the case is run again");
  if (!fs::exists(choices.scenario))
    refuse(file, "is a case of " + choices.scenario +
                     ", which is not here: run this in the folder in which the sweep was run");
  return choices;
}

RunChoices case_of_sweep(const ShrinkOptions& options) {
  const fs::path named = options.scenario;
  const bool one = !fs::is_directory(named);
  if (one && options.number) refuse("--case", "the file is a case already");
  if (options.seed || !options.set.empty() || !options.play.empty())
    refuse(options.scenario, "has its own seed and quantities: --seed, --set and --play go with a scenario");
  const std::string file = named.filename().string();  // "000003-0123456789abcdef.json"
  const std::string number = one ? file.substr(0, file.find('-')) : std::to_string(options.number.value_or(0));
  const bool chosen = one || options.number.has_value();
  const std::size_t index = one ? number_of<std::size_t>(number).value_or(SIZE_MAX) : options.number.value_or(0);
  const std::vector<CaseRow> rows = SweepResults(one ? named.parent_path().parent_path() : named).rows();
  const auto found = std::ranges::find_if(
      rows, [&](const CaseRow& row) { return chosen ? row.index == index : row.status != RunStatus::passed; });
  if (found == rows.end())
    refuse(options.scenario,
           chosen ? "has no result of case " + number : "none of its " + std::to_string(rows.size()) + " cases failed");
  if (found->status == RunStatus::passed)
    refuse(options.scenario, "case " + std::to_string(found->index) + " passed: there is nothing to shrink");
  return choices_of_line(found->repeat, options.scenario);
}

}  // namespace

RunChoices failing_case(const ShrinkOptions& options) {
  const fs::path named = options.scenario;
  if (fs::is_directory(named) || named.parent_path().filename() == "cases") return case_of_sweep(options);
  if (options.number) refuse("--case", "goes with the results of a sweep: " + options.scenario + " is a file");
  if (is_record(named))
    refuse(options.scenario,
           "is a record: its run cannot be changed. Shrink the scenario that it is of; a run on the wall clock is "
           "repeated by 'kadans replay " +
               shell_word(options.scenario) + "'");
  require_kind(options.scenario, JsonKind::scenario);
  return options;
}

}  // namespace kadans
