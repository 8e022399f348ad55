// A bench on the wall clock: a robot's drives, or a model of the robot, without the rights for real time.
//
// One owner, one thread. When this program dies, the drives' own watchdog lets go.
#pragma once

#include <memory>
#include <string>

#include "app/assembly/robot.h"
#include "bench.h"
#include "kadans/plant/plant_type.h"

namespace kadans {

class DriveBench final : public Bench {
 public:
  // `plant`: the type of plant; `peer`: where its drives are, `imu`: the serial port of its IMU, "" where the
  // configuration says. The robot must outlive the bench. Throws InputError.
  DriveBench(const Robot& robot, const std::string& plant, const std::string& peer, const std::string& imu);
  ~DriveBench() override;  // asks for nothing, and closes

  // False: somebody wants the program to end. Throws InputError that says what is in the way.
  bool open();
  void read(SensorFrame& sensors) override;
  void write(const ActuationFrame& actuation) override;
  std::int64_t now_ns() const noexcept override;
  DriveWords words() const noexcept { return words_; }  // of the codes of drives' faults

 private:
  Plant& plant() noexcept { return world_ ? static_cast<Plant&>(world_->robot(0)) : *plant_; }

  std::int64_t period_ns_, due_ns_ = 0;
  DriveWords words_ = nullptr;
  std::unique_ptr<World> world_;
  std::unique_ptr<Plant> plant_;
  std::uint32_t joint_count_;
  bool open_ = false;
};

}  // namespace kadans
