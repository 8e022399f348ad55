// Between drives and joints: the map there and back, the power, what is asked of drives, and what is refused.
#include "kadans/model/transmission.h"

#include <doctest/doctest.h>

#include "kadans/signal/random.h"

using namespace kadans;

namespace {

using Pair = Transmission::Pair;
using Kind = Transmission::Kind;

Transmission coupling(Kind kind) {
  return Transmission({.kind = kind,
                       .joints = {2, 1},
                       .drives = {"left", "right"},
                       .actuator_reduction = {3, -2},
                       .joint_reduction = {0.5, -4},
                       .joint_offset_rad = {0.1, -0.2}});
}

void check_near(const Pair& a, const Pair& b) {
  CHECK(a[0] == doctest::Approx(b[0]).epsilon(1e-12));
  CHECK(a[1] == doctest::Approx(b[1]).epsilon(1e-12));
}

std::string refusal(const Transmission::Settings& settings) {
  try {
    const Transmission made(settings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A differential and a linkage have the equations of ros2_control") {
  const Transmission neck({.kind = Kind::differential, .joints = {0, 1}});
  check_near(neck.joint_position_rad({0.5, 0.1}), {0.3, 0.2});
  check_near(neck.joint_effort_Nm({5, 3}), {8, 2});
  // x1 = (a1/na1 + a2/na2) / (2 nj1) + off1, x2 = (a1/na1 - a2/na2) / (2 nj2) + off2
  check_near(coupling(Kind::differential).joint_position_rad({0.6, 0.8}),
             {(0.2 - 0.4) / (2 * 0.5) + 0.1, (0.2 + 0.4) / (2 * -4) - 0.2});
  // x1 = a1 / (nj1 na1) + off1, x2 = (a2/na2 - a1/(nj1 na1)) / nj2 + off2
  check_near(coupling(Kind::four_bar_linkage).joint_position_rad({0.6, 0.8}), {0.4 + 0.1, (-0.4 - 0.4) / -4 - 0.2});
}

TEST_CASE("What goes through a coupling comes back, and its power is the same on both sides") {
  RandomStream random(1, "test/transmission");
  const auto draw = [&] { return Pair{random.normal(), random.normal()}; };
  for (const Kind kind : {Kind::differential, Kind::four_bar_linkage}) {
    const Transmission t = coupling(kind);
    for (int i = 0; i < 100; ++i) {
      const Pair position = draw(), velocity = draw(), effort = draw();
      check_near(t.joint_position_rad(t.drive_position_rad(position)), position);
      check_near(t.joint_velocity_rad_s(t.drive_velocity_rad_s(velocity)), velocity);
      check_near(t.joint_effort_Nm(t.drive_effort_Nm(effort)), effort);
      const Pair drive_effort = t.drive_effort_Nm(effort), drive_velocity = t.drive_velocity_rad_s(velocity);
      CHECK(drive_effort[0] * drive_velocity[0] + drive_effort[1] * drive_velocity[1] ==
            doctest::Approx(effort[0] * velocity[0] + effort[1] * velocity[1]));
    }
  }
}

TEST_CASE("A simple transmission is a gear with a sign and an offset") {
  const Transmission gear(
      {.joints = {0}, .drives = {}, .actuator_reduction = {-50}, .joint_reduction = {2}, .joint_offset_rad = {0.5}});
  ActuationFrame frame;
  frame.joint_count = 1;
  frame.joints[0] = {.effort_Nm = 20,
                     .position_rad = 0.7,
                     .velocity_rad_s = 1,
                     .stiffness_Nm_per_rad = 1e4,
                     .damping_Nms_per_rad = 200,
                     .mode = ActuationMode::impedance};
  gear.to_drives(frame);
  CHECK(frame.joints[0].mode == ActuationMode::impedance);
  CHECK(frame.joints[0].effort_Nm == doctest::Approx(-0.2));
  CHECK(frame.joints[0].position_rad == doctest::Approx(-20));
  CHECK(frame.joints[0].velocity_rad_s == doctest::Approx(-100));
  CHECK(frame.joints[0].stiffness_Nm_per_rad == doctest::Approx(1));
  CHECK(frame.joints[0].damping_Nms_per_rad == doctest::Approx(0.02));
}

TEST_CASE("Coupled drives run in one mode: that of both joints, else effort without what asks for something else") {
  const Transmission neck({.kind = Kind::differential, .joints = {0, 2}});
  const auto asked = [&](const JointActuation& first, const JointActuation& second) {
    ActuationFrame frame;
    frame.joint_count = 3;
    frame.joints[0] = first;
    frame.joints[1] = {.effort_Nm = 7, .mode = ActuationMode::effort};
    frame.joints[2] = second;
    neck.to_drives(frame);
    CHECK(frame.joints[1].effort_Nm == 7);
    return frame;
  };
  const JointActuation effort{.effort_Nm = 6, .mode = ActuationMode::effort};
  const JointActuation position{.effort_Nm = 2, .position_rad = 0.4, .mode = ActuationMode::position};
  const JointActuation off{.effort_Nm = 9};
  ActuationFrame frame = asked(position, position);
  CHECK(frame.joints[0].mode == ActuationMode::position);
  CHECK(frame.joints[0].position_rad == doctest::Approx(0.8));
  CHECK(frame.joints[2].position_rad == doctest::Approx(0));
  frame = asked(effort, off);
  CHECK(frame.joints[0].mode == ActuationMode::effort);
  CHECK(frame.joints[2].mode == ActuationMode::effort);
  CHECK(frame.joints[0].effort_Nm == doctest::Approx(3));
  CHECK(frame.joints[2].effort_Nm == doctest::Approx(3));
  frame = asked(effort, position);
  CHECK(frame.joints[2].mode == ActuationMode::effort);
  CHECK(frame.joints[2].effort_Nm == doctest::Approx(2));
  CHECK(asked(off, off).joints[0].mode == ActuationMode::off);
}

TEST_CASE("A coupling that cannot be turned round is refused with a sentence") {
  CHECK(refusal({.kind = Kind::differential, .joints = {0, 1}, .drives = {}, .actuator_reduction = {1, 0}}) ==
        "actuator_reduction must be 1e-6..1e6 or -1e6..-1e-6: with 0 a drive would move no joint");
  CHECK(refusal({.kind = Kind::differential, .joints = {0, 1}, .drives = {}, .joint_reduction = {NAN, 1}})
            .find("joint_reduction must be") == 0);
  CHECK(refusal({.kind = Kind::differential, .joints = {0}}) == "a coupling has 2 joints");
  CHECK(refusal({.kind = Kind::simple, .joints = {0, 1}}) == "a simple transmission has 1 joint");
  CHECK(refusal({.kind = Kind::differential, .joints = {3, 3}}) == "a coupling needs two different joints");
  CHECK(refusal({.kind = Kind::differential, .joints = {0, 1}, .drives = {"a", "a"}}) ==
        "the two drives need different names");
  CHECK(refusal({.kind = Kind::differential, .joints = {0, 1}, .drives = {}, .joint_offset_rad = {1}}) ==
        "joint_offset_rad must have 2 numbers");
}
