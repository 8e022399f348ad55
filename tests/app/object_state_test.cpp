// Every shipped control object gives its state away as bytes, and another object of the same configuration continues
// from them bit for bit.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "app/assembly/robot.h"
#include "control/body/gaze_bench.h"
#include "control/joint/trajectory_list.h"
#include "control/walk/leg_robot.h"
#include "kadans/testing/allocation_count.h"

namespace object_state_test {

using namespace kadans;

namespace {

struct Row {
  const char* type;
  RobotModel (*model)();
  std::vector<std::size_t> joints;
  ObjectOptions options{};
};

std::vector<Row> rows() {
  using test::head;
  using test::leg_robot;
  const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const ObjectOptions feet{{{"left_foot", "l_foot"}, {"right_foot", "r_foot"}}};
  std::vector<Row> rows{{"computed_torque", leg_robot, {2, 3, 4}},
                        {"dcm_balance", leg_robot, {1, 2, 4, 6, 7, 9}, feet},
                        {"dcm_walk", leg_robot, all, feet},
                        {"stance", leg_robot, all, feet},
                        {"stance_leg", leg_robot, {1, 2, 3, 4}, {{{"foot", "l_foot"}}}},
                        {"support_forces", leg_robot, all, {{{"feet", "l_foot r_foot l_shank"}}}},
                        {"gravity_compensation", leg_robot, {2, 3, 4}},
                        {"gaze", head, {0, 1, 2, 3, 4, 5, 6}, test::eyes()},
                        {"task_impedance", leg_robot, {2, 3, 4}, {{{"link", "l_foot"}}}},
                        {"whole_body", leg_robot, all, feet}};
  for (const char* type : {"joint_pid", "joint_cascade", "joint_impedance", "joint_integrator", "joint_velocity",
                           "trajectory_list", "profile_position", "feedforward_player", "spring_torque"})
    rows.push_back({type, leg_robot, {2, 3}});
  return rows;
}

// An object in an engine that shows it a robot which stands, sways and steps: always the same for the same tick.
struct Played {
  static constexpr int tuned = 44;

  Played(const Row& row, const ControlObjectTypes& types)
      : model(row.model()), steps(std::string(row.type) == "dcm_walk") {
    const std::vector<DriveLaw> drives(model.joints.size(),
                                       DriveLaw{.spring_Nm_per_rad = 300, .rotor_inertia_kg_m2 = 0.02});
    object = (*types.find(row.type))(ObjectSetup{model, row.joints, row.options, drives});
    Declaration declaration("it", 0, catalog.parameters, catalog.setpoints, catalog.signals);
    object->declare(declaration);
    signals.resize(catalog.signals.size());
    actuation.joint_count = static_cast<std::uint32_t>(model.joints.size());
    for (ParameterId id = 0; id < catalog.parameters.size(); ++id) {
      const Parameter& parameter = catalog.parameters.info(id);
      const bool off = parameter.initial == 0 && parameter.max > 0 && parameter.name != "it.l_knee.ki_Nm_per_rad";
      if (off) REQUIRE(catalog.parameters.set(id, parameter.name == "it.enabled" ? 1 : std::min(parameter.max, 5.0)));
    }
    if (const auto id = catalog.parameters.find("it.force_max_N")) REQUIRE(catalog.parameters.set(*id, 0.3));
    object->parameters_changed();
  }
  // In the run, by somebody.
  void tune() {
    if (const auto id = catalog.parameters.find("it.effort_share")) REQUIRE(catalog.parameters.set(*id, 0.1));
    if (const auto id = catalog.parameters.find("it.gain")) REQUIRE(catalog.parameters.set(*id, 0.5));
    object->parameters_changed();
  }

  void sense(int tick) {
    time_ns = std::int64_t{1'000'000} * (100 + tick);
    joints.count = status.foot_count = 0;
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      const bool leg = model.joints.size() == 10;
      const std::array<double, 5> stance{0, 0, -0.3, 0.6, -0.3};
      const double phase = 0.02 * tick + static_cast<double>(i);
      joints.joints[joints.count++] = {.position_rad = (leg ? stance[i % 5] : 0) + 0.02 * std::sin(phase),
                                       .velocity_rad_s = 0.4 * std::cos(phase),
                                       .effort_Nm = 2 * std::sin(3 * phase)};
    }
    if (const int blind = steps ? 400 : 150; tick > blind && tick < blind + 3)
      joints.joints[2].position_rad = std::numeric_limits<double>::quiet_NaN();
    status.foot_count = 2;
    status.base.yaw_rad = 0.1 * std::sin(0.01 * tick);
    status.base.pitch_rad = 0.03 * std::sin(0.02 * tick);
    status.base.angular_velocity_rad_s = {0, tick > 20 && tick < 140 ? 1.5 : 0, 0};  // so that it steps
    status.feet[0].force_N = 70 + 65 * std::sin(0.02 * tick);
    status.feet[1].force_N = 140 - status.feet[0].force_N;
  }
  void update() {
    snapshot.time_ns = time_ns;
    snapshot.joints = joints;
    snapshot.status = status;
    object->update(snapshot);
  }
  // What the high level saw before is older than the start.
  void start() {
    sense(-20);
    update();
    sense(0);
    for (JointActuation& joint : actuation.joints) joint = {.effort_Nm = 1, .mode = ActuationMode::effort};
    object->start({joints, status, actuation, time_ns, 0.001});
  }
  void tick(int tick) {
    sense(tick);
    const ActuationFrame last = actuation;
    const ControlInput input{joints, status, last, time_ns, 0.001};
    if (tick == tuned) tune();
    if (auto* const list = dynamic_cast<TrajectoryList*>(object.get()); list != nullptr && tick % 100 == 50) {
      for (const double to_rad : {0.3, 0.1, 0.2}) CHECK(list->append(0, {.position_rad = to_rad, .duration_s = 0.02}));
    }
    if (tick % 100 == 5) {
      for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) {
        const Setpoint& setpoint = catalog.setpoints[id];
        const double most = std::min(setpoint.max, 0.4);
        const double value = setpoint.name == "it.go" ? 1 : most * std::sin(0.1 * tick + id + 1);
        object->set_point(setpoint.channel, value, 0.06);
        if (!setpoint.own_motion) object->follow(setpoint.channel, {.value = value, .velocity = 0.1});
      }
    }
    if (tick == 120 && catalog.setpoints.size() > 0) object->cancel_motion(catalog.setpoints[0].channel);
    for (JointActuation& joint : actuation.joints) joint = {.effort_Nm = 1, .mode = ActuationMode::effort};
    object->step(input, actuation);
    if (tick % 10 == 9) update();
  }

  RobotModel model;
  bool steps;  // it gives up when a joint is not measured
  std::unique_ptr<ControlObject> object;
  Catalog catalog;
  JointStates joints;
  RobotStatus status;
  Snapshot snapshot;
  ActuationFrame actuation;
  std::int64_t time_ns = 0;
  std::vector<double> signals;
};

std::vector<std::byte> saved(ControlObject& object) {
  StateBytes measure;
  object.pass_state(measure);
  std::vector<std::byte> bytes(measure.size());
  StateBytes save = StateBytes::saving(bytes);
  object.pass_state(save);
  CHECK(save.ok());
  CHECK(save.size() == bytes.size());
  return bytes;
}

std::uint64_t hashed(ControlObject& object) {
  StateHash hash;
  StateBytes bytes = StateBytes::hashing(hash);
  object.pass_state(bytes);
  return hash.value();
}

bool alike(double one, double other) { return std::memcmp(&one, &other, sizeof one) == 0; }

// "", or what differs first.
std::string difference(Played& one, Played& other) {
  for (Played* played : {&one, &other}) played->catalog.signals.gather(played->signals);
  for (std::size_t i = 0; i < one.signals.size(); ++i) {
    if (!alike(one.signals[i], other.signals[i]))
      return "signal " + one.catalog.signals.info(static_cast<SignalId>(i)).name;
  }
  for (std::size_t i = 0; i < one.model.joints.size(); ++i) {
    const JointActuation &a = one.actuation.joints[i], &b = other.actuation.joints[i];
    if (!alike(a.effort_Nm, b.effort_Nm) || !alike(a.position_rad, b.position_rad) ||
        !alike(a.velocity_rad_s, b.velocity_rad_s) || a.mode != b.mode)
      return "actuation of " + one.model.joints[i].name;
  }
  for (SetpointId id = 0; id < one.catalog.setpoints.size(); ++id) {
    SetpointState a, b;
    (void)one.object->setpoint_state(one.catalog.setpoints[id].channel, a);
    (void)other.object->setpoint_state(one.catalog.setpoints[id].channel, b);
    if (!alike(a.value, b.value) || !alike(a.velocity, b.velocity))
      return "set-point " + one.catalog.setpoints[id].name;
  }
  return alike(one.object->motion_remaining_s(), other.object->motion_remaining_s()) ? "" : "time that is left";
}

}  // namespace

TEST_CASE("each shipped control object continues bit for bit from the bytes of its state, at any tick") {
  ControlObjectTypes types;
  add_shipped_types(types);
  const std::vector<Row> known = rows();
  for (const std::string& name : types.names()) {
    CAPTURE(name);
    const auto row = std::ranges::find_if(known, [&](const Row& one) { return one.type == name; });
    REQUIRE_MESSAGE(row != known.end(), "a new type needs a row");
    for (int at = -1; at < 480; at += 8) {
      CAPTURE(at);
      Played first(*row, types), second(*row, types);
      first.start();
      for (int tick = 0; tick <= at; ++tick) first.tick(tick);
      const std::vector<std::byte> bytes = saved(*first.object);
      CHECK(bytes.size() > 0);
      if (at >= Played::tuned) second.tune();
      StateBytes restore = StateBytes::restoring(bytes);
      second.object->pass_state(restore);
      CHECK(restore.ok());
      CHECK(hashed(*second.object) == hashed(*first.object));
      second.actuation = first.actuation;
      std::string differs = difference(first, second);
      int tick = at + 1;
      for (; tick <= at + 150 && differs.empty(); ++tick) {
        first.tick(tick);
        second.tick(tick);
        differs = difference(first, second);
      }
      CHECK_MESSAGE(differs.empty(), differs, " differs after tick ", tick - 1);
    }
  }
}

TEST_CASE("the hash of an object's state changes with the state") {
  ControlObjectTypes types;
  add_shipped_types(types);
  for (const Row& row : rows()) {
    CAPTURE(row.type);
    Played played(row, types);
    played.start();
    const std::uint64_t before = hashed(*played.object);
    CHECK(hashed(*played.object) == before);
    for (int tick = 0; tick < 120; ++tick) played.tick(tick);
    CHECK(hashed(*played.object) != before);
  }
}

namespace {

struct Padded {
  enum class Kind : std::uint8_t { one, two };
  bool flag = false;
  double value = 1;
  Kind kind = Kind::two;
  struct Inner {
    std::uint16_t count = 3;
    std::array<std::int64_t, 2> times{5, 6};
  } inner;
};

struct Found {
  std::vector<std::byte> bytes;
  std::uint64_t hash;
  bool operator==(const Found&) const = default;
};

// What StateBytes sees in a value that lies in memory of these bytes.
template <typename Change>
Found found_in(int memory, Change change) {
  alignas(Padded) std::byte place[sizeof(Padded)];
  std::memset(place, memory, sizeof place);
  auto* const padded = new (place) Padded;
  change(*padded);
  Found found{std::vector<std::byte>(64), 0};
  StateBytes save = StateBytes::saving(found.bytes);
  save(*padded);
  found.bytes.resize(save.size());
  StateHash hash;
  StateBytes::hashing(hash)(*padded);
  found.hash = hash.value();
  return found;
}

}  // namespace

TEST_CASE("of a struct its members count, each of them, and no padding") {
  const auto nothing = [](Padded&) {};
  const Found plain = found_in(0, nothing);
  CHECK(plain.bytes.size() == 1 + 8 + 1 + 2 + 16);
  CHECK(found_in(0xff, nothing) == plain);
  const auto differs = [&](auto change) {
    const Found changed = found_in(0, change);
    CHECK(changed.bytes != plain.bytes);
    CHECK(changed.hash != plain.hash);
  };
  differs([](Padded& padded) { padded.flag = true; });
  differs([](Padded& padded) { padded.value = 2; });
  differs([](Padded& padded) { padded.kind = Padded::Kind::one; });
  differs([](Padded& padded) { padded.inner.count = 4; });
  differs([](Padded& padded) { padded.inner.times[1] = 7; });
}

TEST_CASE("bytes that are too few change nothing beyond them, and it is told") {
  ControlObjectTypes types;
  add_shipped_types(types);
  const Row row = rows().back();
  Played played(row, types);
  played.start();
  std::vector<std::byte> bytes = saved(*played.object);
  StateBytes save = StateBytes::saving(std::span(bytes).first(bytes.size() - 1));
  played.object->pass_state(save);
  CHECK_FALSE(save.ok());
  StateBytes restore = StateBytes::restoring(std::span(bytes).first(bytes.size() - 1));
  played.object->pass_state(restore);
  CHECK_FALSE(restore.ok());
}

TEST_CASE("saving and restoring allocate nothing") {
  ControlObjectTypes types;
  add_shipped_types(types);
  for (const Row& row : rows()) {
    Played played(row, types);
    played.start();
    std::vector<std::byte> bytes = saved(*played.object);
    const kadans::testing::AllocationCount heap;
    StateBytes save = StateBytes::saving(bytes, StateBytes::Levels::low);
    played.object->pass_state(save);
    StateBytes restore = StateBytes::restoring(bytes, StateBytes::Levels::low);
    played.object->pass_state(restore);
    const long allocations = heap.count();
    CAPTURE(row.type);
    CHECK(allocations == 0);
    CHECK(restore.ok());
  }
}

}  // namespace object_state_test
