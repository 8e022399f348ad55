// Serves the emulated drives of a modelled robot on a bus of this machine, in real time, to whatever program speaks
// their protocol.
//
// A session begins with the first bytes that somebody sends, and ends after a second without any that were understood.
// Between two sessions the drives' power is off. The model's time begins when the first drive gets torque, so that the
// robot does not fall while its drives are found and set up.
//
// Faults of the bus and the drives may be planned; they happen by the model's time in each session anew.
//
// Threads: await and beat by one thread at a time; a thread of its own serves the bus during a session. What a type
// brings is called by one of them at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "kadans/plant/plant_type.h"

namespace kadans {

// A kind of fault that a bus or its drives may have.
struct EmulatedFaultKind {
  enum class Of : std::uint8_t { nothing, line, drive };  // line: a port or a board; none named: all
  const char* name;
  Of of;
  const char* size;  // what it means; "" when it means nothing
};
// Throws std::invalid_argument that says what is wrong with the fault.
void check_fault(const EmulatedFault& fault, std::span<const EmulatedFaultKind> kinds,
                 const std::vector<std::string>& drives, const std::vector<std::string>& lines);

// What moves the robot on the other side of the bus. Called by one thread at a time.
class EmulatedDrives {
 public:
  EmulatedDrives() = default;
  EmulatedDrives(const EmulatedDrives&) = delete;
  EmulatedDrives& operator=(const EmulatedDrives&) = delete;

  virtual void look(WorldRobot& robot) = 0;   // the drives stand where the robot's joints are
  virtual void drive(WorldRobot& robot) = 0;  // the robot's drives do what these do
  virtual void pass(std::int64_t dt_ns) noexcept = 0;
  virtual void switch_power() noexcept = 0;  // off and on again
  virtual bool any_torque() const noexcept = 0;
  virtual bool any_watchdog_tripped() const noexcept = 0;
  // Throws std::invalid_argument when they cannot have this fault.
  virtual void check(const EmulatedFault& fault) const = 0;
  virtual void befall(const EmulatedFault& fault, bool begins) noexcept = 0;  // or ends

 protected:
  ~EmulatedDrives() = default;
};

class DriveServer : public PlantEmulator {
 public:
  bool await(int milliseconds) noexcept final;
  bool beat(World& world, std::uint32_t periods) final;
  const Session& session() const noexcept final { return session_; }
  void plan_faults(const std::vector<EmulatedFault>& faults) final;

 protected:
  explicit DriveServer(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}
  // A destructor of a type calls it first.
  bool end_session() noexcept;

  // What becomes readable when somebody speaks.
  virtual std::vector<int> descriptors() const = 0;
  // Takes what came and answers it; returns when it is to be called again at the latest, on CLOCK_MONOTONIC.
  virtual std::int64_t serve_bus(std::int64_t now_ns) noexcept = 0;
  virtual std::uint64_t heard() const noexcept = 0;  // messages that were understood, ever
  virtual EmulatedDrives& drives() noexcept = 0;

 private:
  void serve() noexcept;
  void let_faults_happen() noexcept;

  struct Planned {
    EmulatedFault is;
    bool begun = false, ended = false;
  };
  std::int64_t period_ns_;
  std::vector<Planned> faults_;
  std::int64_t time_ns_ = 0;  // of the model, in this session
  std::mutex mutex_;          // of what the type brings
  std::thread thread_;
  std::atomic<bool> stop_{false};
  Session session_;
  std::uint64_t heard_ = 0;
  std::int64_t silent_ns_ = 0;
  bool time_runs_ = false, tripped_ = false;
};

}  // namespace kadans
