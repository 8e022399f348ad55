// Models of how threads use the templates, each run through many interleavings; and what becomes of them when an order
// is weakened.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model_memory.h"

namespace kadans::interleavings {

// Threads that use the templates as the runtime does, and say what must hold.
struct Model {
  const char* name;
  bool holds;      // false: it uses them wrongly, which must be found
  unsigned bound;  // all interleavings with so many preemptions are few enough for a test
  void (*run)(rl::test_params&);
};

struct Outcome {
  std::uint64_t iterations = 0;
  std::string broke{};  // what, as Relacy says it; empty: nothing
  std::string history{};
};

// Interleavings drawn at random, always the same ones: the number of the iteration is the seed. A load finds the newest
// value or one of the two before it, as far as the memory model lets it.
Outcome explore(const Model& model, std::uint64_t iterations);
// All interleavings with at most `bound` preemptions; a load finds the newest value or the last but one.
Outcome explore_all(const Model& model, unsigned bound);

struct Trial {
  Site site;
  std::memory_order to{};
  const Model* found_by = nullptr;
  Outcome outcome;
};
// Weakens each order that the models touched, one step of one of them at a time.
std::vector<Trial> weaken_each(const std::vector<Model>& models, std::uint64_t iterations);

// The files of the sites that have other orders than these, not relaxed: "latest.h: 3 of 4 orders were reached".
std::vector<std::string> unreached(const std::vector<Site>& sites);

const char* name_of(std::memory_order order) noexcept;
std::string name_of(const Site& site);  // "latest.h publish exchange"

template <typename Suite>
Model model(const char* name, unsigned bound) {
  return {name, true, bound, [](rl::test_params& params) { (void)rl::simulate<Suite>(params); }};
}
template <typename Suite>
Model misuse(const char* name) {
  return {name, false, 2, [](rl::test_params& params) { (void)rl::simulate<Suite>(params); }};
}

// Of latest_models.cpp and its neighbours.
void add_latest_models(std::vector<Model>& models);
void add_queue_models(std::vector<Model>& models);
void add_turn_models(std::vector<Model>& models);
void add_order_models(std::vector<Model>& models);
void add_stop_models(std::vector<Model>& models);

}  // namespace kadans::interleavings
