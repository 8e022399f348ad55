// Wiggles a joint about which nothing is known, blindly: torque forth, back twice and forth again, for the same time
// each. So a joint without friction ends where it began, at rest. It moves by reach_rad at most where its inertia is
// what the model says; slow and weak at first, then faster and stronger, until some encoder answers in time with it.
//
// A turn in which the joint's readings came later than a quarter of it lasts, or a tick did, says nothing: it is made
// once more. When no turn is better, the joint is let go.
//
// With friction that holds the joint, the torque grows by half from one turn to the next. So what moves it when it
// breaks loose is at most a third of the torque.
#pragma once

#include "push.h"

namespace kadans {

class Wiggle final : public Push {
 public:
  struct Settings {
    std::size_t joint = 0;
    double inertia_kg_m2 = 1;        // of this joint: what it gets at most
    double least_inertia_kg_m2 = 1;  // of those that it may be: what it gets first
    double effort_max_Nm = 0;
    double reach_rad = 0.0105;  // at a stop it goes up to 3.5 times as far
    double seen_rad = 0.0045;   // an encoder's answer
    std::size_t joints = 0;
  };
  explicit Wiggle(const Settings& settings);

  void begin(const BenchSight& sight) override;
  double step(const BenchSight& sight) override;
  std::string_view aborted() const override {
    return late_turns_ > late_turns_max ? "its readings come too late to see whether it moves" : "";
  }
  bool complete() const override { return seen_turns_ >= seen_turns_min || (last_ && seen_turns_ == 0 && ended_); }

  double effort_Nm() const noexcept { return effort_Nm_; }  // of the last turn
  double told_Nm() const noexcept { return told_Nm_; }      // most that its drive told of
  // How far each encoder went with a positive torque; the mean of the last turns in which one was seen. All 0 when none
  // was.
  const std::array<double, max_joints>& answers_rad() const noexcept { return answers_rad_; }
  bool seen() const noexcept { return seen_turns_ >= 2; }

 private:
  static constexpr int seen_turns_min = 4, late_turns_max = 20;
  static constexpr double rest_s = 0.15, slowest_s = 0.3, fastest_s = 0.02, growth = 1.5;

  void set_turn();
  void end_turn();

  Settings settings_;
  double quarter_s_ = slowest_s, first_ = -1, effort_Nm_ = 0, since_s_ = 0, told_Nm_ = 0;
  int phase_ = 0;                                                          // quarters 0..3, then rest
  bool last_ = false, ended_ = false, turn_begun_ = false, late_ = false;  // late: something in this turn was
  int seen_turns_ = 0, late_turns_ = 0;                                    // one after the other
  double read_at_s_ = 0;                                                   // when its last reading came
  std::array<std::array<double, max_joints>, 5> at_rad_{};  // at the beginning of each quarter, and of the rest
  std::array<double, max_joints> answers_rad_{}, last_answers_rad_{};
};

}  // namespace kadans
