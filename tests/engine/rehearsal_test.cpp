#include <cmath>
#include <cstring>

#include <doctest/doctest.h>

#include "bench.h"
#include "control/drive/spring_torque.h"
#include "engine/tick/control_engine.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;

namespace {

struct Rows final : RecordSink {
  std::vector<double> all;
  void record(std::uint64_t, std::int64_t, std::span<const double> row) noexcept override {
    all.insert(all.end(), row.begin(), row.end());
  }
};

// Stands at the drives, hands on what is wanted of the joints, and counts.
class Counted final : public ControlObject {
 public:
  explicit Counted(int& rehearsals) : rehearsals_(&rehearsals) {}
  void declare(Declaration&) override {}
  void start(const ControlInput&) noexcept override {}
  void step(const ControlInput&, ActuationFrame&) noexcept override {}
  void rehearse(const ControlInput&) const noexcept override { ++*rehearsals_; }
  void set_point(std::uint32_t, double, double) noexcept override {}
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }

 private:
  int* rehearsals_;
};

// Loops around springs that the plant has not: they remember what was measured, and move the joints by it.
std::unique_ptr<ControlObject> springs() {
  const RobotModel model = bench::robot();
  const DriveLaw drive{.spring_Nm_per_rad = 300, .rotor_inertia_kg_m2 = 0.02};
  return make_spring_torque({.model = model, .joints = {0, 1}, .drives = {drive, drive}});
}

// Moves, switches its control set, is asked for nonsense, is asked for too much, and gives way: all that changes state.
std::vector<double> run(std::unique_ptr<ControlObject> at_drives, int rehearsals_a_tick) {
  bench::Robot robot(std::move(at_drives));
  Rows rows;
  robot.control.record_to(&rows);
  const SetpointId hip = robot.catalog.setpoints.find("posture.hip.position_rad").value();
  CommandSender sender(robot.exchange->commands);
  const auto send = [&](std::int64_t tick, const Command& command) {
    sender.begin(tick * 1'000'000);
    (void)(sender.add(command) && sender.commit() > 0);
  };
  for (std::int64_t tick = 0; tick < 600; ++tick) {
    if (tick == 10) send(tick, {.kind = CommandKind::set_point, .index = hip, .value = 0.8, .duration_s = 0.2});
    if (tick == 100) send(tick, {.kind = CommandKind::switch_set, .index = 1});
    if (tick == 300) send(tick, {.kind = CommandKind::switch_set, .index = 0});
    if (tick == 350) send(tick, {.kind = CommandKind::set_point, .index = hip, .value = -1.9});  // as hard as it can
    if (tick == 450) robot.safety.emergency_stop().leave();
    if (tick == 500) send(tick, {.kind = CommandKind::clear_faults});
    for (int i = 0; i < rehearsals_a_tick; ++i) robot.control.rehearse();
    robot.lockstep.step();
  }
  rows.all.push_back(static_cast<double>(robot.exchange->snapshot.newest(1).status.safety.fault_count));
  Fault fault;
  while (robot.safety.log().try_pop(fault)) rows.all.push_back(static_cast<double>(fault.tick) + fault.value);
  return rows.all;
}

}  // namespace

TEST_CASE("A run with rehearsals computes bit for bit what a run without them does") {
  std::unique_ptr<ControlObject> (*at_drives)() = [] { return std::unique_ptr<ControlObject>(); };
  SUBCASE("with rigid drives") {}
  SUBCASE("with control objects at the drives") { at_drives = springs; }
  const std::vector<double> plain = run(at_drives(), 0), rehearsed = run(at_drives(), 1), twice = run(at_drives(), 2);
  REQUIRE(plain.size() == rehearsed.size());
  CHECK(plain.size() > 600 * 20);
  CHECK(std::memcmp(plain.data(), rehearsed.data(), plain.size() * sizeof(double)) == 0);
  REQUIRE(plain.size() == twice.size());
  CHECK(std::memcmp(plain.data(), twice.data(), plain.size() * sizeof(double)) == 0);
}

TEST_CASE("A rehearsal goes through the objects at the drives, too") {
  int rehearsals = 0;
  bench::Robot robot(std::make_unique<Counted>(rehearsals));
  robot.run(10);
  CHECK(rehearsals == 0);
  robot.control.rehearse();
  CHECK(rehearsals == 1);
}

TEST_CASE("A rehearsal neither allocates, publishes, writes to the plant nor takes a command") {
  bench::Robot robot(springs());
  robot.run(50);
  CommandSender sender(robot.exchange->commands);
  sender.begin(50'000'000);
  REQUIRE(sender.add({.kind = CommandKind::switch_set, .index = 1}));
  REQUIRE(sender.commit() > 0);
  (void)robot.exchange->snapshot.newest(1);
  const std::vector<double> before(robot.control.row().begin(), robot.control.row().end());
  const testing::AllocationCount heap;
  for (int i = 0; i < 10; ++i) robot.control.rehearse();
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK_FALSE(robot.exchange->snapshot.has_news(1));
  CHECK(robot.exchange->commands.size() > 0);
  CHECK(std::equal(before.begin(), before.end(), robot.control.row().begin()));
  robot.run(2);
  CHECK(robot.sets.active() == 2);
}
