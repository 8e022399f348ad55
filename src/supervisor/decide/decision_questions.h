// What people ask of the decisions in a run: why their transitions wait, and to read their files again. The behavior
// thread asks for them, the supervisor's thread answers in its next tick; neither waits for the other.
#pragma once

#include <cstdint>
#include <string>

#include "exchange/owned_ring.h"
#include "script/host/behavior_tables.h"

namespace kadans {

struct DecisionQuestion {
  std::uint32_t number = 0;  // by which the asking side knows it
  BehaviorQuestion question{};
  BehaviorReply reply{};
};

struct DecisionQuestions {
  using Cases = OwnedRing<DecisionQuestion, 16>;

  std::string name{};  // of what decides; "": nothing does. Set before the loop
  Cases asked{};       // from the behavior thread to the supervisor's
  Cases answered{};    // and back; a reply that finds no room is lost: nobody has waited for it
};

}  // namespace kadans
