// Faults of drives that couple two joints: they act on the drive that they name, and so on both joints.
#include <doctest/doctest.h>

#include "kadans/plant/ideal_world.h"
#include "scenario/disturb/planned_faults.h"

using namespace kadans;

namespace {

// left = tilt + pan, right = tilt - pan.
PlantVariant neck() {
  PlantVariant neck;
  neck.model.links.resize(4);
  for (const char* name : {"tilt", "pan", "roll"}) {
    Joint& joint = neck.model.joints.emplace_back();
    joint.name = name;
    joint.type = JointType::continuous;
  }
  neck.model.transmissions.emplace_back(
      Transmission::Settings{.kind = Transmission::Kind::differential, .joints = {0, 1}, .drives = {"left", "right"}});
  neck.plant.position_rad = {0, 0, 0};
  return neck;
}

struct Bench {
  explicit Bench(const ScenarioFault& fault) {
    ScenarioConfig scenario;
    scenario.faults = {fault};
    faulty = make_faulty_plant(scenario, variant, {}, 1, world);
  }
  // Asks all joints for the same in one tick; the torque on tilt and pan.
  void tick(const JointActuation& asked) {
    SensorFrame sensors;
    faulty->read(sensors);
    ActuationFrame frame;
    frame.joint_count = 3;
    for (std::size_t i = 0; i < 3; ++i) frame.joints[i] = asked;
    faulty->write(frame);
    faulty->step(1'000'000);
  }
  double torque_Nm(std::size_t joint) const { return faulty->truth().drive_torque_Nm[joint]; }

  PlantVariant variant = neck();
  IdealWorld world{variant.model, variant.plant};
  std::unique_ptr<FaultyPlant> faulty;
};

ScenarioFault fault(ScenarioFault::Kind kind, const char* drive, double size = 0) {
  return {.kind = kind, .of = {drive, {}}, .from_s = 0.001, .size = size};
}

constexpr JointActuation effort{.effort_Nm = 2, .mode = ActuationMode::effort};

}  // namespace

TEST_CASE("A dead drive of a coupling takes its torque from both joints, and nothing from others") {
  Bench bench(fault(ScenarioFault::Kind::drive_dead, "left"));
  bench.tick(effort);  // left: 2 Nm, right: 0
  CHECK(bench.torque_Nm(0) == doctest::Approx(2));
  CHECK(bench.torque_Nm(1) == doctest::Approx(2));
  bench.tick(effort);
  for (const std::size_t joint : {0U, 1U}) CHECK(bench.torque_Nm(joint) == 0);
  CHECK(bench.torque_Nm(2) == 2);
  Bench other(fault(ScenarioFault::Kind::drive_dead, "right"));
  for (int i = 0; i < 2; ++i) other.tick(effort);
  CHECK(other.torque_Nm(0) == doctest::Approx(2));  // the right drive had nothing to do
}

TEST_CASE("A weak drive, one with an offset and one that is stuck act on both joints by the coupling") {
  Bench weak(fault(ScenarioFault::Kind::drive_weak, "left", 0.25));
  Bench offset(fault(ScenarioFault::Kind::drive_offset, "right", 1));
  Bench stuck(fault(ScenarioFault::Kind::drive_stuck, "left"));
  for (Bench* bench : {&weak, &offset, &stuck}) {
    bench->tick(effort);
    bench->tick({.effort_Nm = 4, .mode = ActuationMode::effort});
  }
  CHECK(weak.torque_Nm(0) == doctest::Approx(1));
  CHECK(weak.torque_Nm(1) == doctest::Approx(1));
  CHECK(offset.torque_Nm(0) == doctest::Approx(5));
  CHECK(offset.torque_Nm(1) == doctest::Approx(3));
  CHECK(stuck.torque_Nm(0) == doctest::Approx(2));
  CHECK(stuck.torque_Nm(1) == doctest::Approx(2));
}

TEST_CASE("When a drive of a coupling is dead in position mode, the other one still goes where it is told") {
  Bench bench(fault(ScenarioFault::Kind::drive_dead, "left"));
  bench.tick({});
  bench.tick({.position_rad = 0.2, .mode = ActuationMode::position});  // left: 0.4, right: 0
  CHECK(bench.faulty->truth().position_rad[0] == 0);
  Bench other(fault(ScenarioFault::Kind::drive_dead, "right"));
  other.tick({});
  other.tick({.position_rad = 0.2, .mode = ActuationMode::position});
  CHECK(other.faulty->truth().position_rad[0] == doctest::Approx(0.2));
  CHECK(other.faulty->truth().position_rad[1] == doctest::Approx(0.2));
}

TEST_CASE("Faults of drives name drives: a coupled joint is none") {
  CHECK_NOTHROW(Bench(fault(ScenarioFault::Kind::drive_dead, "roll")));
  CHECK_THROWS_WITH_AS(Bench(fault(ScenarioFault::Kind::drive_dead, "tilt")), doctest::Contains("drive 'tilt'"),
                       InputError);
}

TEST_CASE(
    "Two states that differ in what is under way to a late drive, or in what a fault holds, differ in their hash") {
  const auto hash_after = [](const ScenarioFault& planned, const std::vector<double>& efforts_Nm) {
    Bench bench(planned);
    for (const double effort_Nm : efforts_Nm) bench.tick({.effort_Nm = effort_Nm, .mode = ActuationMode::effort});
    StateHash hash;
    bench.faulty->hash_held_back(hash);
    return hash.value();
  };
  ScenarioFault late = fault(ScenarioFault::Kind::drive_late, "left", 2);
  late.from_s = 0;
  CHECK(hash_after(late, {0, 0, 1}) != hash_after(late, {0, 0, 2}));
  CHECK(hash_after(late, {0, 1, 0}) != hash_after(late, {0, 2, 0}));
  CHECK(hash_after(late, {1, 0, 0}) == hash_after(late, {2, 0, 0}));  // it has come to the drive
  const ScenarioFault stuck = fault(ScenarioFault::Kind::drive_stuck, "left");
  CHECK(hash_after(stuck, {1, 0}) != hash_after(stuck, {2, 0}));
}
