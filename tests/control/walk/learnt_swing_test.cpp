#include "control/walk/learnt_swing.h"

#include <cmath>

#include <doctest/doctest.h>

namespace learnt_swing_test {

using namespace kadans;

namespace {

constexpr double dt_s = 0.001, swing_s = 0.3, share = 0.3;
using Efforts = LearntSwing::Efforts;

// Springs that lead joints against this load, as far as nothing is given ahead; one swing after the other.
template <typename Load>
double most_of_springs_Nm(LearntSwing& learnt, LegJoint joint, int swings, const Efforts& most_Nm,
                          const Load& load_Nm) {
  double most = 0;
  for (int swing = 0; swing < swings; ++swing) {
    most = 0;
    for (double time_s = 0; time_s < swing_s; time_s += dt_s) {
      Efforts spring_Nm{};
      spring_Nm[joint] = load_Nm(time_s) - learnt.at(time_s)[joint];
      learnt.see(time_s, spring_Nm);
      if (time_s < swing_s - 0.03) most = std::max(most, std::abs(spring_Nm[joint]));
    }
    learnt.learn(share, most_Nm);
  }
  return most;
}

constexpr Efforts much_Nm{50, 50, 50, 50, 50};
double changing_Nm(double time_s) { return 4 + 3 * std::sin(20 * time_s); }

}  // namespace

TEST_CASE("LearntSwing takes most of a load that each swing has from the springs of hip roll, hip pitch and knee") {
  for (const LegJoint joint : {hip_roll, hip_pitch, knee}) {
    LearntSwing learnt;
    CHECK(most_of_springs_Nm(learnt, joint, 1, much_Nm, changing_Nm) > 6.9);
    CHECK(most_of_springs_Nm(learnt, joint, 20, much_Nm, changing_Nm) < 2.5);
  }
  for (const LegJoint joint : {hip_yaw, ankle_pitch}) {
    LearntSwing learnt;
    CHECK(most_of_springs_Nm(learnt, joint, 20, much_Nm, changing_Nm) > 6.9);
  }
}

TEST_CASE("LearntSwing forgets a load that is there no more") {
  LearntSwing learnt;
  (void)most_of_springs_Nm(learnt, knee, 20, much_Nm, changing_Nm);
  CHECK(most_of_springs_Nm(learnt, knee, 1, much_Nm, [](double) { return 0.0; }) > 3);
  CHECK(most_of_springs_Nm(learnt, knee, 20, much_Nm, [](double) { return 0.0; }) < 0.05);
}

TEST_CASE("LearntSwing gives no more ahead than it may, and nothing beyond the time that it learns for") {
  LearntSwing learnt;
  const Efforts most_Nm{0, 0, 2, 2, 0};
  (void)most_of_springs_Nm(learnt, hip_pitch, 20, most_Nm, changing_Nm);
  CHECK(learnt.at(0.1)[hip_pitch] == doctest::Approx(2));
  for (const double time_s : {0.48, 1.0, 1e9, std::nan("")}) CHECK(learnt.at(time_s)[hip_pitch] == 0);
  CHECK(learnt.at(0)[hip_pitch] == doctest::Approx(2));
}

TEST_CASE("LearntSwing learns nothing of a swing that it was not shown, and keeps what it knew") {
  LearntSwing learnt;
  (void)most_of_springs_Nm(learnt, knee, 5, much_Nm, changing_Nm);
  const double known_Nm = learnt.at(0.1)[knee];
  learnt.learn(share, much_Nm);
  CHECK(learnt.at(0.1)[knee] == known_Nm);
}

}  // namespace learnt_swing_test
