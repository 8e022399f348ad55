#include "played_behaviors.h"

#include "app/assembly/assembly.h"
#include "config/robot/project_root.h"
#include "script/check/check_behavior.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

void add_files(const std::vector<PlayItem>& items, std::set<fs::path>& files) {
  for (const PlayItem& item : items) files.insert(item.file);
}

std::set<fs::path> played_files(const ScenarioConfig& scenario) {
  std::set<fs::path> files;
  add_files(scenario.behaviors, files);
  for (const ScenarioEvent& event : scenario.events) add_files(event.order.list, files);
  return files;
}

}  // namespace

std::vector<InputProblem> problems_in(const std::set<fs::path>& files, const fs::path& root, const Catalog& catalog) {
  std::vector<InputProblem> problems;
  for (const fs::path& file : files) {
    for (InputProblem& problem : check_behavior(root, file, catalog)) problems.push_back(std::move(problem));
  }
  tell_once(problems);
  return problems;
}

std::vector<InputProblem> problems_of_played(const ScenarioConfig& scenario, const Catalog& catalog) {
  return problems_in(played_files(scenario), project_root(scenario.file), catalog);
}

std::vector<InputProblem> problems_of_named(const ScenarioConfig& scenario, const Catalog& catalog) {
  std::set<fs::path> files = played_files(scenario);
  for (const ScenarioEvent& event : scenario.events) {
    if (!event.order.file.empty()) files.insert(event.order.file);
  }
  return problems_in(files, project_root(scenario.file), catalog);
}

void refuse_faulty_behaviors(const ScenarioConfig& scenario, const Catalog& catalog) {
  const std::vector<InputProblem> problems = problems_of_played(scenario, catalog);
  if (!problems.empty()) throw InputError(problems);
}

void refuse_faulty_behaviors(const Assembly& assembly) {
  refuse_faulty_behaviors(assembly.scenario(), assembly.catalog());
  for (const auto& robot : assembly.others()) refuse_faulty_behaviors(robot->scenario(), robot->catalog());
}

}  // namespace kadans
