// A whole leg on soft springs: ankle, knee and hip pitch together, each with its rotor, spring, torque loop and PD, as
// config/tulip/soft.json has them. One joint alone bears gains that the leg does not: the light shank and thigh
// between a heavy torso and the ground, or a bare foot in the air, swing against all three springs.
#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "control/drive/spring_torque.h"
#include "kadans/estimate/velocity_filter.h"

namespace spring_leg_test {

using namespace kadans;

namespace {

constexpr double dt_s = 0.001, spring = 300, spring_damping = 0.1, rotor = 0.02, viscous = 0.2;
constexpr int ankle = 0, knee = 1, hip = 2, steps = 4;
using Three = std::array<double, 3>;

struct Gains {
  double kp, kd, bandwidth_Hz, damping_ratio, observer_Hz;
};
using LegGains = std::array<Gains, 3>;
constexpr LegGains soft{{{226, 2.02, 19.5, 0.18, 2.66}, {157, 3.25, 19.5, 0.73, 0}, {219, 3.1, 25.6, 0.44, 1}}};
constexpr LegGains stiff{{{300, 4, 22, 0.7, 3}, {300, 4, 22, 0.7, 3}, {300, 4, 22, 0.7, 3}}};
constexpr double velocity_Hz = 400, rate_Hz = 204;

// Standing the chain hangs on the ground, in the air on the torso. Segments: shank, thigh, torso; or foot, shank,
// thigh. Their angles to the upright are small motions about `pose`; half of the torso's mass is on this leg. SI.
struct Leg {
  bool stands;
  Three pose;
  std::array<Three, 3> mass{};
  Three gravity{};

  Leg(bool standing, const Three& angles) : stands(standing), pose(angles) {
    constexpr double shin = 0.85, thigh = 1.35, torso = 4.3, foot = 0.5, l = 0.275, up = 0.155, down = 0.12,
                     high = 0.205;
    if (stands) {
      mass[0] = {0.00514 + shin * up * up + (thigh + torso) * l * l, (thigh * up + torso * l) * l, torso * l * high};
      mass[1] = {0, 0.00833 + thigh * up * up + torso * l * l, torso * l * high};
      mass[2] = {0, 0, 0.113 + torso * high * high};
      gravity = {shin * up + (thigh + torso) * l, thigh * up + torso * l, torso * high};
      for (std::size_t i = 0; i < 3; ++i) gravity[i] *= 9.81 * std::cos(pose[i]);
    } else {
      constexpr double off = 0.4 * l * 0.046 * 0.75;  // the foot's centre of mass, in front of and below its joint
      mass[0] = {0.0025, off, off};
      mass[1] = {0, 0.00514 + shin * down * down + foot * l * l, (shin * down + foot * l) * l};
      mass[2] = {0, 0, 0.00833 + thigh * down * down + (shin + foot) * l * l};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i; j < 3; ++j) mass[i][j] = mass[j][i] = mass[i][j] * std::cos(pose[i] - pose[j]);
    }
  }
  // Of joint i, from what its segments do.
  double joint(const Three& x, std::size_t i) const {
    if (stands) return i == ankle ? x[0] : x[i] - x[i - 1];
    return i == hip ? x[2] : x[i] - x[i + 1];
  }
  Three accelerations(const Three& x, const Three& torque) const {
    std::array<std::array<double, 4>, 3> m{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double other = stands ? (i < 2 ? torque[i + 1] : 0) : (i > 0 ? torque[i - 1] : 0);
      std::copy(mass[i].begin(), mass[i].end(), m[i].begin());
      m[i][3] = torque[i] - other + gravity[i] * x[i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t r = 0; r < 3; ++r) {
        const double share = r == i ? 0 : m[r][i] / m[i][i];
        for (std::size_t c = 0; c < 4; ++c) m[r][c] -= share * m[i][c];
      }
    }
    return {m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
  }
};

// One drive: what the 1 kHz side makes of its encoders, and its rotor.
struct Drive {
  explicit Drive(const Gains& g) : gains(g), filter({.cutoff_Hz = velocity_Hz, .dt_s = dt_s}) {
    loop.config() = {.bandwidth_Hz = g.bandwidth_Hz,
                     .damping_ratio = g.damping_ratio,
                     .observer_Hz = g.observer_Hz,
                     .rate_cutoff_Hz = rate_Hz,
                     .effort_max_Nm = 25};
    loop.retune();
  }
  // What is wanted was computed in the last tick; what the motor gives was asked `delay` ticks ago.
  void control(double position_rad, double scale, std::size_t delay) {
    const JointState joint{position_rad, filter.update(position_rad, dt_s), spring * (rotor_rad - position_rad)};
    std::rotate(asked_Nm.rbegin(), asked_Nm.rbegin() + 1, asked_Nm.rend());
    asked_Nm[0] = loop.step(wanted_Nm, joint, dt_s);
    motor_Nm = asked_Nm[delay];
    wanted_Nm = -scale * (gains.kp * joint.position_rad + gains.kd * joint.velocity_rad_s);
  }
  double turn(double position_rad, double velocity_rad_s) {
    const double step_s = dt_s / steps;
    const double torque_Nm = spring * (rotor_rad - position_rad) + spring_damping * (rotor_rad_s - velocity_rad_s);
    rotor_rad_s += step_s * (motor_Nm - viscous * rotor_rad_s - torque_Nm) / rotor;
    rotor_rad += step_s * rotor_rad_s;
    return torque_Nm;
  }

  Gains gains;
  SpringTorqueLoop loop;
  VelocityFilter filter;
  std::array<double, 5> asked_Nm{};
  double wanted_Nm = 0, motor_Nm = 0, rotor_rad = 0, rotor_rad_s = 0;
};

// The fastest of its joints between 2 and 2.5 s after a knock that made them turn at up to 1 rad/s.
double left_rad_s(const Leg& leg, const LegGains& gains, double scale, std::size_t delay) {
  std::array<Drive, 3> drives{Drive(gains[0]), Drive(gains[1]), Drive(gains[2])};
  Three x{}, v{0.2, -0.4, 0.1}, torque{};
  double fastest = 0;
  for (int i = 0; i < 2500; ++i) {
    for (std::size_t j = 0; j < 3; ++j) drives[j].control(leg.joint(x, j), scale, delay);
    for (int part = 0; part < steps; ++part) {
      for (std::size_t j = 0; j < 3; ++j) torque[j] = drives[j].turn(leg.joint(x, j), leg.joint(v, j));
      const Three a = leg.accelerations(x, torque);
      for (std::size_t j = 0; j < 3; ++j) x[j] += dt_s / steps * (v[j] += dt_s / steps * a[j]);
    }
    for (std::size_t j = 0; i > 2000 && j < 3; ++j) fastest = std::max(fastest, std::abs(leg.joint(v, j)));
  }
  return fastest;
}

double worst_rad_s(const LegGains& gains) {
  double worst = 0;
  for (const Leg& leg : {Leg(true, {0.15, -0.15, 0}), Leg(true, {0.63, -0.63, 0}), Leg(true, {0, -0.15, 2.15}),
                         Leg(false, {0, 0, 0}), Leg(false, {1.2, 1.2, -0.3}), Leg(false, {0.5, 0.5, -2})}) {
    for (const double scale : {0.85, 1.15}) {
      for (const std::size_t delay : {0U, 2U, 4U}) worst = std::max(worst, left_rad_s(leg, gains, scale, delay));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("A leg on soft springs comes to rest, standing, squatting, folded and in the air, 4 ms late too") {
  CHECK(worst_rad_s(soft) < 0.2);
}

TEST_CASE("With the gains of stiff drives a leg on soft springs swings on") { CHECK(worst_rad_s(stiff) > 2); }

TEST_CASE("A knee held a half stiffer is more than the leg bears") {
  LegGains gains = soft;
  gains[knee].kp *= 1.5;
  CHECK(worst_rad_s(gains) > 2);
}

}  // namespace spring_leg_test
