#include "engine/transaction.h"

#include <memory>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

constexpr Command switch_to_1{.kind = CommandKind::switch_set, .index = 1};

}  // namespace

TEST_CASE("A transaction goes into the queue with its header, all at once at the commit") {
  const auto queue = std::make_unique<CommandQueue>();
  CommandSender sender(*queue);
  sender.begin(42);
  REQUIRE(sender.add(switch_to_1));
  REQUIRE(sender.add({.kind = CommandKind::clear_faults}));
  CHECK(queue->size() == 0);
  CHECK(sender.commit() == 1);
  REQUIRE(queue->size() == 3);
  CHECK(queue->peek(0).kind == CommandKind::transaction);
  CHECK(queue->peek(0).count == 2);
  CHECK(queue->peek(0).sequence == 1);
  CHECK(queue->peek(0).time_ns == 42);
  CHECK(queue->peek(2).kind == CommandKind::clear_faults);
  CHECK(sender.sent() == 2);
}

TEST_CASE("A transaction that does not fit into one tick is refused whole and counted") {
  const auto queue = std::make_unique<CommandQueue>();
  CommandSender sender(*queue);
  sender.begin(0);
  for (std::size_t i = 1; i < max_transaction; ++i) REQUIRE(sender.add(switch_to_1));
  CHECK_FALSE(sender.add(switch_to_1));
  CHECK(sender.commit() == 0);
  CHECK(queue->size() == 0);
  CHECK(sender.refused() == max_transaction);
  CHECK(sender.sent() == 0);
}

TEST_CASE("A full queue refuses at the command that does not fit, and takes the next transaction when it is drained") {
  const auto queue = std::make_unique<CommandQueue>();
  CommandSender sender(*queue);
  while (queue->free() >= 64) {
    sender.begin(0);
    for (int i = 0; i < 63; ++i) REQUIRE(sender.add(switch_to_1));
    REQUIRE(sender.commit() > 0);
  }
  const std::uint32_t last = sender.last_sequence();
  sender.begin(0);
  bool fits = true;
  for (int i = 0; i < 64 && fits; ++i) fits = sender.add(switch_to_1);
  CHECK_FALSE(fits);
  CHECK(sender.commit() == 0);
  queue->drop(queue->size());
  sender.begin(0);
  REQUIRE(sender.add(switch_to_1));
  CHECK(sender.commit() == last + 1);
}

TEST_CASE("What was discarded is not sent, and an empty commit sends nothing") {
  const auto queue = std::make_unique<CommandQueue>();
  CommandSender sender(*queue);
  sender.begin(0);
  REQUIRE(sender.add(switch_to_1));
  sender.discard();
  CHECK(sender.commit() == 0);
  CHECK(queue->size() == 0);
  CHECK(sender.sent() == 0);
}

TEST_CASE(
    "A sender at the far end of a queue numbers as it is told, and sends no more than there is room for elsewhere") {
  const auto queue = std::make_unique<CommandQueue>();
  CommandSender sender(*queue);
  sender.follow(41, 5);
  sender.begin(0);
  REQUIRE(sender.add(switch_to_1));
  REQUIRE(sender.add(switch_to_1));
  CHECK(sender.commit() == 42);
  CHECK(sender.room() == 2);
  sender.begin(0);
  REQUIRE(sender.add(switch_to_1));
  CHECK_FALSE(sender.add(switch_to_1));
  CHECK(sender.commit() == 0);
  CHECK(queue->size() == 3);
  sender.follow(42, 1000);
  sender.begin(0);
  REQUIRE(sender.add(switch_to_1));
  CHECK(sender.commit() == 43);
}
