#include "kadans/control/control_sets.h"

#include <doctest/doctest.h>

#include "made_objects.h"
#include "two_joint_robot.h"

namespace control_sets_test {

using namespace kadans;

namespace {

// Writes a constant and counts how often it was started, stepped and updated.
class Constant final : public ControlObject {
 public:
  Constant(std::size_t joint, double effort_Nm) : joint_(joint), effort_Nm_(effort_Nm) {}
  void declare(Declaration&) override {}
  void start(const ControlInput& input) noexcept override {
    ++starts;
    taken_over_Nm = input.last.joints[joint_].effort_Nm;
    measured_Nm = input.joints.joints[joint_].effort_Nm;
  }
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override {
    ++steps;
    dt_s = input.dt_s;
    actuation.joints[joint_] = {.effort_Nm = effort_Nm_, .mode = ActuationMode::effort};
  }
  void set_point(std::uint32_t, double, double) noexcept override {}
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }
  void update(const Snapshot&) override { ++updates; }

  int starts = 0, steps = 0, updates = 0;
  double dt_s = 0, taken_over_Nm = 0, measured_Nm = 0;

 private:
  std::size_t joint_;
  double effort_Nm_;
};

struct Bench {
  RobotModel model = two_joint_robot();
  Catalog catalog;
  Constant* hip = new Constant(0, 1);
  Constant* knee = new Constant(1, 2);
  Constant* other_knee = new Constant(1, 3);
  std::unique_ptr<ControlSets> sets;
  JointStates joints;
  RobotStatus status;
  ActuationFrame written, computed;
  std::uint64_t tick = 0;

  explicit Bench(std::uint32_t knee_divisor = 1) {
    catalog.model = &model;
    catalog.objects = {{.name = "hip", .joints = {0}},
                       {.name = "knee", .joints = {1}, .divisor = knee_divisor, .high_level_divisor = 2},
                       {.name = "other_knee", .joints = {1}}};
    catalog.sets = {{"both", {0, 1}}, {"other", {0, 2}}, {"hip_alone", {0}}};
    std::vector<std::unique_ptr<ControlObject>> objects;
    for (Constant* object : {hip, knee, other_knee}) objects.emplace_back(object);
    sets = std::make_unique<ControlSets>(catalog, std::move(objects));
    written.joint_count = computed.joint_count = 3;
  }
  void step() { sets->step(tick++, {joints, status, written, 0, 0.001}, computed); }
};

std::string refusal(Catalog& catalog, std::vector<std::unique_ptr<ControlObject>> objects) {
  try {
    const ControlSets sets(catalog, std::move(objects));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("The initial set computes, each object started once") {
  Bench bench;
  bench.step();
  bench.step();
  CHECK(bench.hip->starts == 1);
  CHECK(bench.knee->steps == 2);
  CHECK(bench.other_knee->steps == 0);
  CHECK(bench.computed.joints[1].effort_Nm == 2);
}

TEST_CASE("Switching starts the objects that come in and leaves those that stay alone") {
  Bench bench;
  bench.step();
  bench.sets->switch_to(1);
  bench.step();
  CHECK(bench.hip->starts == 1);
  CHECK(bench.other_knee->starts == 1);
  CHECK(bench.computed.joints[1].effort_Nm == 3);
  bench.sets->switch_to(0);
  bench.step();
  CHECK(bench.knee->starts == 2);
}

TEST_CASE("An object at the drives makes motors of what is wanted of the joints, but of those that are not measured") {
  struct Doubles final : ControlObject {
    void declare(Declaration&) override {}
    void start(const ControlInput&) noexcept override {}
    void step(const ControlInput&, ActuationFrame& actuation) noexcept override {
      for (JointActuation& joint : actuation.joints) joint.effort_Nm *= 2;
    }
    void set_point(std::uint32_t, double, double) noexcept override {}
    void cancel_motion(std::uint32_t) noexcept override {}
    double motion_remaining_s() const noexcept override { return 0; }
  };
  RobotModel model = two_joint_robot();
  Catalog catalog;
  catalog.model = &model;
  catalog.objects = {{.name = "first", .joints = {1}}, {.name = "drives", .joints = {0, 1}}};
  catalog.sets = {{.name = "all", .objects = {0}}};
  catalog.at_drives = {1};
  const auto objects = [] {
    std::vector<std::unique_ptr<ControlObject>> made;
    made.push_back(std::make_unique<Constant>(1, 4.0));
    made.push_back(std::make_unique<Doubles>());
    return made;
  };
  Catalog given = catalog;
  ControlSets sets(given, objects());
  ActuationFrame written, computed;
  written.joint_count = computed.joint_count = 3;
  const ControlInput input{{}, {}, written, 0, 0.001};
  sets.step(0, input, computed);
  CHECK(computed.joints[1].effort_Nm == 4);  // not in the sets
  for (JointActuation& joint : computed.joints) joint.effort_Nm = 3;
  sets.drive(input, joint_bit(0), computed);
  CHECK(computed.joints[0].effort_Nm == 3);  // blind
  CHECK(computed.joints[1].effort_Nm == 6);
  CHECK(computed.joints[2].effort_Nm == 3);  // not its own
  CHECK(sets.runs(1));

  catalog.sets[0].objects = {0, 1};
  catalog.objects[1].joints = {0};
  CHECK(refusal(catalog, objects()) == "control object drives stands at the drives and in control set all");
  catalog.sets[0].objects = {0};
  catalog.at_drives = {1, 1};
  CHECK(refusal(catalog, objects()) == "two control objects stand at the drive of joint hip");
}

TEST_CASE("A joint that no object of the new set drives goes off") {
  Bench bench;
  bench.step();
  bench.sets->switch_to(2);
  bench.step();
  CHECK(bench.computed.joints[1].mode == ActuationMode::off);
  CHECK(bench.computed.joints[1].effort_Nm == 0);
}

TEST_CASE("Objects compose in the order of the set, and who has a share in a joint is a signal") {
  RobotModel model = two_joint_robot();
  Catalog catalog;
  catalog.model = &model;
  catalog.objects = {
      {.name = "first", .joints = {1}}, {.name = "added", .joints = {1}}, {.name = "mixed", .joints = {1}}};
  const auto torque_and_writers = [&](std::vector<std::uint32_t> order, std::vector<Composition> compositions) {
    Catalog mine = catalog;
    mine.sets = {{"all", std::move(order), std::move(compositions)}};
    std::vector<std::unique_ptr<ControlObject>> objects;
    for (const double effort_Nm : {4.0, 1.0, 10.0}) objects.push_back(std::make_unique<Constant>(1, effort_Nm));
    ControlSets sets(mine, std::move(objects));
    if (const auto weight = mine.parameters.find("all.mixed.weight")) REQUIRE(mine.parameters.set(*weight, 0.25));
    ActuationFrame written, computed;
    written.joint_count = computed.joint_count = 3;
    sets.step(0, {{}, {}, written, 0, 0.001}, computed);
    std::vector<double> row(mine.signals.size());
    mine.signals.gather(row);
    CHECK(row[mine.signals.find("composition.hip.writers").value()] == 0);
    return std::pair{computed.joints[1].effort_Nm, row[mine.signals.find("composition.knee.writers").value()]};
  };
  using enum Composition;
  CHECK(torque_and_writers({0, 1, 2}, {set, sum, blend}) == std::pair{0.75 * 5 + 0.25 * 10, 7.0});
  CHECK(torque_and_writers({0, 2, 1}, {set, blend, sum}) == std::pair{0.75 * 4 + 0.25 * 10 + 1, 7.0});
  CHECK(torque_and_writers({0, 1, 2}, {set, sum, priority}) == std::pair{10.0, 4.0});
  CHECK(torque_and_writers({1, 0}, {set, sum}) == std::pair{5.0, 3.0});
}

TEST_CASE("An object that takes a joint over below a sum that goes on gets the torque without what is added to it") {
  RobotModel model = two_joint_robot();
  Catalog catalog;
  catalog.model = &model;
  catalog.objects = {
      {.name = "first", .joints = {0, 1}}, {.name = "second", .joints = {0, 1}}, {.name = "weight", .joints = {1}}};
  using enum Composition;
  catalog.sets = {{"one", {0, 2}, {set, sum}}, {"other", {1, 2}, {set, sum}}, {"alone", {0}, {set}}};
  std::vector<std::unique_ptr<ControlObject>> objects;
  std::vector<Constant*> made;
  for (const double effort_Nm : {4.0, 7.0, 3.0}) {
    made.push_back(new Constant(1, effort_Nm));
    objects.emplace_back(made.back());
  }
  ControlSets sets(catalog, std::move(objects));
  JointStates joints;
  joints.joints[1].effort_Nm = 6.5;
  ActuationFrame written, computed;
  written.joint_count = computed.joint_count = 3;
  written.joints[1] = {.effort_Nm = 7, .mode = ActuationMode::effort};
  const auto step = [&](std::uint64_t tick) { sets.step(tick, {joints, {}, written, 0, 0.001}, computed); };
  step(0);
  CHECK(made[0]->taken_over_Nm == 7);  // the weight begins, too: nothing of it was there before
  sets.switch_to(1);
  step(1);
  CHECK(made[2]->starts == 1);
  CHECK(made[1]->taken_over_Nm == 4);
  CHECK(made[1]->measured_Nm == 3.5);
  sets.switch_to(2);
  step(2);
  CHECK(made[0]->taken_over_Nm == 7);  // what was added ends
}

TEST_CASE("A slower object computes every n-th tick with its own dt, and its actuation stands meanwhile") {
  Bench bench(4);
  for (int i = 0; i < 8; ++i) bench.step();
  CHECK(bench.hip->steps == 8);
  CHECK(bench.knee->steps == 2);
  CHECK(bench.knee->dt_s == doctest::Approx(0.004));
  CHECK(bench.computed.joints[1].effort_Nm == 2);
}

TEST_CASE("The high level runs every n-th behavior tick, for the active set alone") {
  Bench bench;
  Snapshot snapshot;
  bench.sets->fill(snapshot);
  for (std::uint64_t tick = 0; tick < 4; ++tick) bench.sets->update(tick, snapshot);
  CHECK(bench.hip->updates == 4);
  CHECK(bench.knee->updates == 2);
  CHECK(bench.other_knee->updates == 0);
}

TEST_CASE("Sets that cannot work are refused before the loop, by name") {
  const RobotModel model = two_joint_robot();
  Catalog catalog;
  catalog.model = &model;
  catalog.objects = {{.name = "a", .joints = {1}}, {.name = "b", .joints = {1}}};
  const auto objects = [] {
    std::vector<std::unique_ptr<ControlObject>> two;
    two.push_back(std::make_unique<Constant>(1, 0));
    two.push_back(std::make_unique<Constant>(1, 0));
    return two;
  };
  catalog.sets = {{"clash", {0, 1}}};
  CHECK(refusal(catalog, objects()) == "control set clash: more than one object sets joint knee");
  catalog.sets = {{"twice", {0, 0}}};
  CHECK(refusal(catalog, objects()) == "control set twice lists a twice");
  catalog.sets = {{"empty", {}}};
  CHECK(refusal(catalog, objects()) == "control set empty has no control object");
  catalog.sets = {};
  CHECK(refusal(catalog, objects()) == "there is no initial control set");
  catalog.sets = {{"one", {0}}};
  CHECK(refusal(catalog, objects()) == "accepted");
}

}  // namespace control_sets_test
