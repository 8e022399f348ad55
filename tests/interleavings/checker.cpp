#include "checker.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string_view>

namespace kadans::interleavings {
namespace {

bool can_be_weaker(const Site& site) { return site.order != std::memory_order_relaxed; }

std::vector<std::memory_order> one_step_weaker(const Site& site) {
  const std::string_view operation = site.operation;
  switch (site.order) {
    case std::memory_order_seq_cst:
      if (operation == "load") return {std::memory_order_acquire};
      return {operation == "store" ? std::memory_order_release : std::memory_order_acq_rel};
    case std::memory_order_acq_rel:
      return {std::memory_order_acquire, std::memory_order_release};
    default:
      return {std::memory_order_relaxed};
  }
}

// Of each model: the orders that it touches.
std::vector<std::vector<Site>> sites_of(const std::vector<Model>& models) {
  constexpr std::uint64_t enough = 200;
  std::vector<std::vector<Site>> all;
  for (const Model& model : models) {
    orders().forget();
    (void)explore(model, enough);
    all.emplace_back(orders().sites().begin(), orders().sites().end());
  }
  return all;
}

Outcome run(const Model& model, rl::test_params& params) {
  rl::ostringstream said;  // grows while Relacy minds the heap
  params.output_stream = params.progress_stream = &said;
  model.run(params);
  Outcome outcome{.iterations = params.stop_iteration};
  if (params.test_result == rl::test_result_success) return outcome;
  const rl::string told = said.str();
  outcome.history.assign(told.begin(), told.end());
  for (char& c : outcome.history) c = c >= 0 && c < '\t' ? static_cast<char>('0' + c) : c;  // small enumerators
  std::istringstream lines(outcome.history);
  std::getline(lines, outcome.broke);  // the suite's name
  std::getline(lines, outcome.broke);
  return outcome;
}

}  // namespace

Outcome explore(const Model& model, std::uint64_t iterations) {
  rl::test_params params;
  params.iteration_count = iterations;
  return run(model, params);
}

Outcome explore_all(const Model& model, unsigned bound) {
  rl::test_params params;
  params.search_type = rl::sched_bound;
  params.context_bound = bound;
  return run(model, params);
}

std::vector<Trial> weaken_each(const std::vector<Model>& models, std::uint64_t iterations) {
  const auto touched = sites_of(models);
  std::vector<Trial> trials;
  for (const auto& sites : touched) {
    for (const Site& site : sites) {
      const bool tried = std::ranges::any_of(trials, [&site](const Trial& trial) { return trial.site == site; });
      if (tried || !can_be_weaker(site)) continue;
      for (const std::memory_order to : one_step_weaker(site))
        trials.push_back({.site = site, .to = to, .outcome = {}});
    }
  }
  for (Trial& trial : trials) {
    orders().weaken(trial.site, trial.to);
    for (std::size_t i = 0; i < models.size() && trial.found_by == nullptr; ++i) {
      if (!models[i].holds || std::ranges::find(touched[i], trial.site) == touched[i].end()) continue;
      trial.outcome = explore(models[i], iterations);
      if (!trial.outcome.broke.empty()) trial.found_by = &models[i];
    }
  }
  orders().weaken_none();
  return trials;
}

std::vector<std::string> unreached(const std::vector<Site>& sites) {
  std::map<std::string, std::size_t> reached;
  for (const Site& site : sites) reached[site.place.file] += can_be_weaker(site) ? 1 : 0;
  std::vector<std::string> findings;
  for (const auto& [file, count] : reached) {
    std::ifstream in(file);
    std::size_t written = 0;
    for (std::string line; std::getline(in, line);) {
      for (const char* order : {"memory_order_acquire", "memory_order_release", "memory_order_acq_rel",
                                "memory_order_seq_cst", "memory_order_consume"}) {
        for (auto at = line.find(order); at != std::string::npos; at = line.find(order, at + 1)) ++written;
      }
    }
    if (written == count) continue;
    findings.push_back(file + ": " + std::to_string(count) + " of " + std::to_string(written) +
                       " orders are reached by a model");
  }
  return findings;
}

const char* name_of(std::memory_order order) noexcept {
  constexpr std::array names{"relaxed", "consume", "acquire", "release", "acq_rel", "seq_cst"};
  return names[static_cast<std::size_t>(order)];
}

std::string name_of(const Site& site) {
  const std::string_view function = site.place.function;  // clang and gcc differ in what they add behind it
  return std::filesystem::path(site.place.file).filename().string() + ' ' +
         std::string(function.substr(0, function.find('<'))) + ' ' + site.operation;
}

}  // namespace kadans::interleavings
