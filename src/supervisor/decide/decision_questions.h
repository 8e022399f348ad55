// What people ask of the decisions in a run: why their transitions wait, and to read their files again. The behavior
// thread asks for them, the supervisor's thread answers in its next tick; neither waits for the other.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "kadans/exchange/ring.h"
#include "script/host/behavior_tables.h"

namespace kadans {

struct DecisionQuestion {
  std::uint32_t number = 0;  // by which the asking side knows it
  BehaviorQuestion question{};
  BehaviorReply reply{};
};

class DecisionQuestions {
 public:
  using Case = std::unique_ptr<DecisionQuestion>;
  static constexpr std::size_t room = 16;

  DecisionQuestions() = default;
  ~DecisionQuestions() {
    while (take()) {
    }
    while (reply()) {
    }
  }
  DecisionQuestions(const DecisionQuestions&) = delete;
  DecisionQuestions& operator=(const DecisionQuestions&) = delete;

  std::string name;  // of what decides; "": nothing does. Set before the loop

  // Behavior thread. False: there is no room.
  [[nodiscard]] bool ask(Case question) { return push(asked_, std::move(question)); }
  Case reply() noexcept { return pop(answered_); }  // nullptr: none

  // Supervisor thread. A reply that finds no room is lost: nobody has waited for it.
  Case take() noexcept { return pop(asked_); }
  void answer(Case question) { (void)push(answered_, std::move(question)); }

 private:
  using Cases = Ring<DecisionQuestion*, room>;

  static bool push(Cases& ring, Case question) {
    DecisionQuestion* one = question.get();
    if (!ring.try_push(one)) return false;
    (void)question.release();
    return true;
  }
  static Case pop(Cases& ring) noexcept {
    DecisionQuestion* one = nullptr;
    (void)ring.try_pop(one);
    return Case(one);
  }

  Cases asked_, answered_;
};

}  // namespace kadans
