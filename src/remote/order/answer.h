// The answers to orders. order_queue.h says how orders and answers cross threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "order.h"
#include "order_queue.h"
#include "script/host/behavior_tables.h"

namespace kadans {

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
