// Commands of behaviors that are lost, late or not finite for a while.
#include <cmath>

#include <doctest/doctest.h>

#include "engine/transaction.h"
#include "scenario/disturb/planned_faults.h"

using namespace kadans;

namespace {

constexpr std::int64_t tick_ns = 10'000'000;

// Sends the number of its tick, each tick.
class Counting final : public BehaviorHost {
 public:
  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override {
    commands.begin(snapshot.time_ns);
    (void)commands.add({.kind = CommandKind::set_parameter, .value = tick_++});
    (void)commands.commit();
  }

 private:
  double tick_ = 0;
};

// What comes out of each of so many ticks; -1: nothing.
std::vector<double> sent(const PlannedFault& fault, int ticks) {
  Counting host;
  FaultyHost faulty(host);
  faulty.add(fault);
  const auto queue = std::make_unique<CommandQueue>();
  CommandSender sender(*queue);
  const auto snapshot = std::make_unique<Snapshot>();
  std::vector<double> values;
  for (int i = 0; i < ticks; ++i) {
    snapshot->time_ns = i * tick_ns;
    faulty.tick(*snapshot, sender);
    values.push_back(-1);
    for (Command command; queue->try_pop(command);) {
      if (command.kind != CommandKind::transaction) values.back() = command.value;
    }
  }
  return values;
}

}  // namespace

TEST_CASE("Late commands come so many ticks later, once, however long the fault lasts") {
  const PlannedFault late{
      .kind = ScenarioFault::Kind::commands_late, .from_ns = 2 * tick_ns, .until_ns = 8 * tick_ns, .size = 2};
  CHECK(sent(late, 8) == std::vector<double>{0, 1, -1, -1, 2, 3, 4, 5});
}

TEST_CASE("Lost commands leave their transaction empty, and values that are not finite reach the control engine") {
  CHECK(sent({.kind = ScenarioFault::Kind::commands_lost, .from_ns = tick_ns, .until_ns = 3 * tick_ns}, 4) ==
        std::vector<double>{0, -1, -1, 3});
  const std::vector<double> spoiled =
      sent({.kind = ScenarioFault::Kind::commands_not_finite, .from_ns = tick_ns, .until_ns = 2 * tick_ns}, 3);
  CHECK(std::isnan(spoiled[1]));
  CHECK(spoiled[2] == 2);
}
