// Charts at random, as a table for the reference interpreter and as Lua for the runner.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "reference_chart.h"

namespace kadans::script_test {

// Nested states, parallels, histories, finals; transitions to one state or several, to none, internal and external, for
// names and patterns of events, with conditions and times.
class RandomChart {
 public:
  explicit RandomChart(std::uint32_t seed) : random_(seed) { make(); }

  const std::vector<RefState>& states() const { return states_; }
  std::string lua() const;
  std::vector<std::string> events_of_a_tick();

 private:
  int below(int bound) { return static_cast<int>(random_() % static_cast<std::uint32_t>(bound)); }
  bool chance(int percent) { return below(100) < percent; }
  RefState& at(int state) { return states_[static_cast<std::size_t>(state)]; }
  const RefState& at(int state) const { return states_[static_cast<std::size_t>(state)]; }

  void make();
  void fill(int state, int depth);
  int add(RefState::Kind kind, int parent);
  void choose_initials();
  void choose_history(int history);
  void add_transitions();
  void add_transition(int source, bool always);
  void add_emits();
  bool inside(int state, int ancestor) const;
  bool together(int one, int other) const;
  std::vector<int> candidates(int around, bool histories) const;
  std::vector<int> targets(int around, bool histories);
  std::string path(int state) const;
  std::string names(const std::vector<int>& targets, int from) const;
  void write(int state, std::string& text) const;
  void write(const RefTransition& transition, std::string& text) const;

  std::mt19937 random_;
  std::vector<RefState> states_;
  std::vector<bool> written_initial_;
  int transitions_ = 0;
};

}  // namespace kadans::script_test
