// How long a robot that stands needs at least for a way from one posture to another, so that it neither topples nor
// slips on it, and no joint is too fast.
//
// The way is given as postures at equal distances of time, as a motion that takes the time 1 has them. In the time T
// all velocities are those times 1 / T, and what the ground must give is the wrench of rest plus one that goes with
// 1 / T^2. So in each posture the time in which the zero moment point (Vukobratovic and Borovac 2004, IJHR 1(1)) comes
// to an edge of the soles follows from two wrenches: no search, and no simulation in small steps.
//
// Any thread. Only the constructor allocates or throws.
#pragma once

#include "body_geometry.h"
#include "body_support.h"

namespace kadans {

class BodyWay {
 public:
  struct Time {
    double least_s = 0;                 // for the whole way; 0: any time will do
    double fails_after_s = 0;           // in the time that was asked for, it topples, slips or is too fast from here on
    std::size_t joint = no_body_joint;  // the one that would be too fast: it needs longest
    std::size_t jumps = no_body_joint;  // the one that jumps from one posture to the next, as near a stretched limb
    double smooth_share = 1;            // of the way, until then
  };
  explicit BodyWay(const BodyLayout& layout);

  // `steps`: into which the time is cut. All must outlive the way.
  void begin(const BodySettings& settings, const BodySupport& support, int steps, double time_s) noexcept;
  // The posture number 0, 1, ... and its step to the next one, a generalised velocity times a time.
  void add(BodyGeometry& posture, const Eigen::VectorXd& step) noexcept;
  Time time() const noexcept;

 private:
  struct Steps {  // of a joint, in all
    double sum_rad = 0, largest_rad = 0;
    int at = 0;  // the largest
  };
  void need(double least_s, std::size_t joint) noexcept;

  const BodyLayout* layout_;
  const BodySettings* settings_ = nullptr;
  const BodySupport* support_ = nullptr;
  Eigen::VectorXd before_, velocity_, acceleration_;
  int steps_ = 1, number_ = 0;
  double time_s_ = 0;
  bool fails_ = false;
  std::array<Steps, max_joints> joints_{};
  Time result_;
};

}  // namespace kadans
