// The answers to orders. order_queue.h says how orders and answers cross threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "order.h"
#include "order_queue.h"
#include "script/behavior/behavior_why.h"
#include "script/host/script_parameter.h"

namespace kadans {

struct BehaviorReport {
  std::string name, outcome, error;
  std::string result{};             // with the outcome
  std::vector<std::string> active;  // all innermost active states, by path
  std::uint32_t lane = 0;
  bool over = false;
  std::uint64_t chart = 0;  // a number that changes when the chart's states or transitions change
  std::vector<ScriptParameter> parameters;
};

struct Answer {
  std::uint64_t number = 0;  // of the order
  bool done = false;
  std::string text;  // when not done: the reason; else a message
  std::vector<BehaviorReport> behaviors{};
  std::vector<BehaviorReasons> reasons{};
  bool paused = false;
  std::vector<ParameterChange> changes{};
  std::vector<ParameterChange> set{};  // for the order `changes`: also those that are already saved
  std::vector<std::string> words{};    // of a completion; they replace the text from `begin` on
  std::size_t begin = 0;
  bool incomplete = false, writes = false, leaves = false;  // of a console
};

using OrderCase = BasicOrderCase<Order, Answer>;
using OrderQueue = BasicOrderQueue<OrderCase>;

}  // namespace kadans
