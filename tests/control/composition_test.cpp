#include "kadans/control/composition.h"

#include <doctest/doctest.h>

namespace composition_test {

using namespace kadans;

namespace {

constexpr JointActuation effort(double effort_Nm) { return {.effort_Nm = effort_Nm, .mode = ActuationMode::effort}; }
constexpr JointActuation position(double position_rad) {
  return {.effort_Nm = 1, .position_rad = position_rad, .mode = ActuationMode::position};
}

}  // namespace

TEST_CASE("set replaces what was there") {
  JointActuation joint = effort(3);
  CHECK(compose(Composition::set, 0, position(0.5), joint));
  CHECK(joint.mode == ActuationMode::position);
  CHECK(joint.effort_Nm == 1);
}

TEST_CASE("sum adds effort and keeps the mode, a joint that is off takes the proposal's") {
  JointActuation joint = position(0.5);
  CHECK(compose(Composition::sum, 1, effort(4), joint));
  CHECK(joint.mode == ActuationMode::position);
  CHECK(joint.position_rad == 0.5);
  CHECK(joint.effort_Nm == 5);
  JointActuation off;
  CHECK(compose(Composition::sum, 1, effort(4), off));
  CHECK(off.mode == ActuationMode::effort);
  CHECK_FALSE(compose(Composition::sum, 1, {}, off));
  CHECK(off.effort_Nm == 4);
}

TEST_CASE("blend is the weighted mean in one mode, and the heavier one across modes") {
  JointActuation joint = effort(4);
  CHECK(compose(Composition::blend, 0.25, effort(8), joint));
  CHECK(joint.effort_Nm == 5);
  CHECK_FALSE(compose(Composition::blend, 0.4, position(1), joint));
  CHECK(joint.mode == ActuationMode::effort);
  CHECK(compose(Composition::blend, 0.6, position(1), joint));
  CHECK(joint.mode == ActuationMode::position);
}

TEST_CASE("priority replaces while the object claims the joint") {
  JointActuation joint = effort(4);
  CHECK_FALSE(compose(Composition::priority, 1, {}, joint));
  CHECK(joint.effort_Nm == 4);
  CHECK(compose(Composition::priority, 1, effort(-2), joint));
  CHECK(joint.effort_Nm == -2);
}

}  // namespace composition_test
