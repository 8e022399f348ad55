// The driver's side of the low level: takes the robot's states as they come, and makes the command of each period.
//
// Nothing is commanded before a joint is asked for something. From then on this driver must be the only one: two that
// write commands in turn make the motors jump between both. So when somebody else writes a command, this one stops, and
// the motors' drives are in fault until they are reset, which is refused while the other goes on. The same holds when
// the robot restarted: its own controller may drive it again.
//
// One owner: the thread of the bus, or who steps virtual time. run() and take() neither allocate nor throw.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "driver_link.h"
#include "kadans/signal/frames.h"
#include "settings.h"

namespace unitree {

// Codes of a drive in fault, beside the robot's own.
inline constexpr std::uint32_t second_writer_code = 0xFFFF0001, restarted_code = 0xFFFF0002;
std::string_view drive_code_words(std::uint32_t code) noexcept;

struct Counts {
  std::uint32_t states = 0;      // that were used
  std::uint32_t corrupt = 0;     // with a wrong checksum or length
  std::uint32_t stale = 0;       // that were not newer than the one before
  std::uint32_t not_finite = 0;  // with a number that is none
  std::uint32_t commands = 0;
  std::uint32_t unsent = 0;    // commands that the wire did not take
  std::uint32_t refused = 0;   // actuations of a joint that no message can hold
  std::uint32_t foreign = 0;   // commands of somebody else
  std::uint32_t restarts = 0;  // of the robot
  std::uint32_t lost = 0;      // what the robot's motors tell of messages that they missed
};

// What the bus tells the control thread: the newest state, by joint.
struct LowSample {
  std::uint32_t count = 0;
  std::array<kadans::JointSample, kadans::max_joints> joints{};
  kadans::ImuSample imu;
  std::array<double, 4> foot_N{};
  double supply_V = 0;
  Counts counts;
};
inline void copy_used(const LowSample& from, LowSample& to) noexcept {
  to.count = from.count;
  kadans::copy_first(from.joints, from.count, to.joints);
  to.imu = from.imu;
  to.foot_N = from.foot_N;
  to.supply_V = from.supply_V;
  to.counts = from.counts;
}

class LowDriver {
 public:
  // Keeps a reference. The motors are in the order of the joints.
  LowDriver(DriverLink& link, const Settings& settings, std::vector<MotorSettings> motors);

  // Takes the states that wait. True: there was a new one.
  bool take() noexcept;
  // A period of the bus: looks for others, and sends what the drives are asked for.
  void run(const kadans::ActuationFrame& drives) noexcept;
  // At the end: the motors damp, then have no torque. It takes damping_s and a few periods.
  void release() noexcept;
  const LowSample& sample() const noexcept { return sample_; }

 private:
  struct Drive {
    bool enabled = true;
    std::uint8_t order_seen = 0;
  };

  void use(const State& state) noexcept;
  bool is_new(std::uint32_t tick) noexcept;
  void look_for_others() noexcept;
  void obey(const kadans::DriveRequest& request, Drive& drive) noexcept;
  MotorCommand command_of(const kadans::JointActuation& asked, const MotorSettings& motor) noexcept;
  void send() noexcept;
  void tell_drives() noexcept;

  DriverLink& link_;
  const Settings settings_;
  const Family family_;
  std::vector<MotorSettings> motors_;
  std::vector<Drive> drives_;
  std::vector<std::uint32_t> codes_;  // of the robot's motors, by joint
  Command command_;
  Packet packet_;
  State state_;
  std::uint32_t tick_ = 0;
  bool began_ = false;           // there was a state
  bool drives_robot_ = false;    // something was asked of a joint
  std::uint32_t latched_ = 0;    // a code of ours, of all drives
  std::int64_t foreign_ns_ = 0;  // when somebody else last wrote
  bool foreign_seen_ = false;
  LowSample sample_;
};

}  // namespace unitree
