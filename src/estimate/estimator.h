// Second step of the tick: from what the sensors say to what the robot does.
//
// Each joint's position is the encoder's. Its velocity is the filtered difference quotient (velocity_filter.h). Its
// effort is the spring's deflection times its stiffness, or the motor's own effort where there is no spring; of coupled
// joints what their drives' springs and motors give together. The base's
// orientation comes from the IMU (orientation_filter.h). Contact and centre of pressure come from the soles
// (contact_detector.h). The legs that bear give the base's height over the lowest sole, the centre of pressure of the
// whole robot, and the way of the base over the ground (odometry.h).
//
// Sensors fail. A reading counts as new when its `sequence` changed (0: none yet). Without a new reading everything
// that depends on it keeps its value, and the next reading is used with the time that truly passed. A value that is not
// finite is not used. Both are reported in health(), for the safety layer. A joint with a sample_divisor of n is looked
// at only in every n-th tick (tick % n == 0), and in the first.
//
// A copy carries the whole state: it goes on as the original would.
//
// One owner, the control thread. update neither allocates nor throws.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact_detector.h"
#include "kadans/estimate/velocity_filter.h"
#include "kadans/model/robot_model.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"
#include "leg_chain.h"
#include "odometry.h"
#include "orientation_filter.h"
#include "sensor_health.h"
#include "settings.h"

namespace kadans {

class Estimator {
 public:
  // dt_s: the nominal period of the tick. Keeps no reference to the model. Throws std::invalid_argument naming the key,
  // the joint or foot, the value and the range.
  Estimator(const RobotModel& model, const EstimateSettings& settings, double dt_s);

  // dt_s: since the last update. Fills joints, and status except its safety part.
  void update(const SensorFrame& sensors, double dt_s, std::uint64_t tick, JointStates& joints,
              RobotStatus& status) noexcept;

  // From the next update on.
  void reset_odometry() noexcept { odometry_.reset(); }

  // All that changes from tick to tick (kadans/control/state_bytes.h).
  void pass_state(auto& bytes) noexcept {
    for (JointTrack& joint : joints_)
      bytes(joint.velocity, joint.last_time_ns, joint.last_sequence, joint.elapsed_s, joint.state);
    for (FootTrack& foot : feet_) bytes(foot.detector, foot.leg, foot.bore, foot.last_sequence, foot.force_N);
    for (std::size_t i = 0; i < health_.joint_count; ++i) bytes(health_.joints[i]);
    for (std::size_t i = 0; i < health_.foot_count; ++i) bytes(health_.feet[i]);
    for (std::size_t i = 0; i < health_.channel_count; ++i)
      bytes(health_.channels[i], last_channel_sequences_[i], channels_[i]);
    bytes(orientation_, health_.imu, started_, last_imu_sequence_, imu_elapsed_s_, last_imu_time_ns_, height_m_,
          heading_x_, heading_y_, support_, odometry_);
  }

  const SensorHealth& health() const noexcept { return health_; }  // as of the last update
  const EstimateSettings& settings() const noexcept { return settings_; }
  const OrientationFilter::State& orientation() const noexcept { return orientation_.state(); }

 private:
  struct JointTrack {
    VelocityFilter velocity;
    double spring_Nm_per_rad = 0;
    bool paired = false;            // an ElasticPair has its torque
    std::int64_t last_time_ns = 0;  // of the last reading, where the bus tells it
    std::uint32_t last_sequence = 0;
    double elapsed_s = 0;  // since the last position that was used
    JointState state;
  };
  struct FootTrack {
    ContactDetector detector;
    LegChain leg;
    bool bore = false;  // in the last tick: `leg` is as of then
    std::uint32_t last_sequence = 0;
    std::array<double, sensors_per_foot> force_N{};  // the last finite ones
  };

  // Two joints that two drives move through a coupling, one of them or both by a spring.
  struct ElasticPair {
    Transmission transmission;
    Transmission::Pair spring_Nm_per_rad;  // of the drives
  };

  void add_joints(const RobotModel& model, const EstimateSettings& settings, double dt_s);
  void add_feet(const RobotModel& model, const EstimateSettings& settings);
  [[gnu::always_inline]] void update_joint(std::size_t joint, const JointSample& sample, bool look,
                                           double dt_s) noexcept;
  void update_pair(const ElasticPair& pair, const SensorFrame& sensors, JointStates& joints) noexcept;
  Axes update_base(const ImuSample& sample, std::int64_t now_ns, double dt_s, BaseStatus& base) noexcept;
  void update_foot(std::size_t foot, const FootSample& sample, FootStatus& status) noexcept;
  void update_channels(const SensorFrame& sensors, RobotStatus& status) noexcept;
  void update_support(const JointStates& joints, const Axes& base, double dt_s, RobotStatus& status) noexcept;

  EstimateSettings settings_;
  OrientationFilter orientation_;
  std::vector<JointTrack> joints_;
  std::vector<ElasticPair> pairs_;
  std::vector<FootTrack> feet_;
  std::array<std::uint32_t, max_channels> last_channel_sequences_{};
  std::array<double, max_channels> channels_{};  // the last finite readings
  SensorHealth health_;
  double dt_s_;
  bool started_ = false;
  std::uint32_t last_imu_sequence_ = 0;
  double imu_elapsed_s_ = 0;
  std::int64_t last_imu_time_ns_ = 0;  // of the last reading, where the bus tells it
  double height_m_ = 0;
  double heading_x_ = 1, heading_y_ = 0;  // the base's x axis on the ground, a unit vector; holds while x is upright
  SupportStatus support_;
  Odometry odometry_;
};

// The signals of joint states and robot status, under the names by which recorder, checks, viewers and scripts know
// them: the fields of signal/status_fields.h under joint.NAME, base, foot.LINK and support.
//
// Before the loop. The snapshot is what Estimator::update fills; it must outlive the table's use. Throws
// std::invalid_argument on a name that is taken.
void declare_signals(SignalTable& table, const RobotModel& model, const EstimateSettings& settings,
                     const Snapshot& snapshot);

}  // namespace kadans
