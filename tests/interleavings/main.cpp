// interleaving_models [ITERATIONS]: explores each model so often at random, and all its interleavings up to a bound;
// then weakens one memory order after the other and says what that breaks. Exit code 1: a model breaks, or nothing
// finds a weakened order. KADANS_SOAK=1: 400 times as often.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "checker.h"

using namespace kadans::interleavings;

namespace {

void tell(const Model& model, const char* how, const Outcome& outcome) {
  std::printf("%-52s %-17s %10llu  %s%s\n", model.name, how, static_cast<unsigned long long>(outcome.iterations),
              outcome.broke.empty() ? "nothing" : outcome.broke.c_str(), model.holds ? "" : ", as it must");
  if (model.holds) std::fputs(outcome.history.c_str(), stdout);
  std::fflush(stdout);
}

bool hold(const std::vector<Model>& models, std::uint64_t iterations) {
  bool all = true;
  std::printf("%-52s %-17s %10s  %s\n", "model", "interleavings", "iterations", "broke");
  for (const Model& model : models) {
    const Outcome drawn = explore(model, iterations);
    tell(model, "drawn", drawn);
    const Outcome searched = explore_all(model, model.bound);
    tell(model, ("all, " + std::to_string(model.bound) + " preempted").c_str(), searched);
    all = all && drawn.broke.empty() == model.holds && searched.broke.empty() == model.holds;
  }
  return all;
}

bool all_found(const std::vector<Trial>& trials) {
  bool all = true;
  std::printf("\n%-42s %-8s %-10s %10s  %s\n", "site", "order", "weakened", "iterations", "broke");
  for (const Trial& trial : trials) {
    const bool found = trial.found_by != nullptr;
    std::printf("%-42s %-8s %-10s %10llu  %s\n", name_of(trial.site).c_str(), name_of(trial.site.order),
                name_of(trial.to), static_cast<unsigned long long>(trial.outcome.iterations),
                found ? (trial.outcome.broke + ", " + trial.found_by->name).c_str() : "NOTHING: is it needed?");
    all = all && found;
  }
  return all && !trials.empty();
}

bool all_reached(const std::vector<Trial>& trials) {
  std::vector<Site> sites;
  for (const Trial& trial : trials) {
    if (std::ranges::find(sites, trial.site) == sites.end()) sites.push_back(trial.site);
  }
  const std::vector<std::string> findings = unreached(sites);
  for (const std::string& finding : findings) std::printf("%s\n", finding.c_str());
  return findings.empty();
}

}  // namespace

int main(int count, char** arguments) {
  const char* environment = std::getenv("KADANS_SOAK");
  const bool soak = environment != nullptr && *environment == '1';
  const std::uint64_t iterations = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : soak ? 20'000'000 : 50'000;

  std::vector<Model> models;
  add_latest_models(models);
  add_queue_models(models);
  add_turn_models(models);
  add_order_models(models);
  add_stop_models(models);
  const bool held = hold(models, iterations);
  const std::vector<Trial> trials = weaken_each(models, iterations);
  const bool found = all_found(trials), reached = all_reached(trials);
  return held && found && reached ? EXIT_SUCCESS : EXIT_FAILURE;
}
