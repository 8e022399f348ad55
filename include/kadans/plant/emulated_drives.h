// What moves a modelled robot on the other side of a bus, and the faults that may befall it.
//
// One owner, one thread at a time.
#pragma once

#include <cstdint>
#include <span>
#include <string>
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

// "KIND:OF@FROM+FOR=SIZE", such as "drive_hot:tilt@3+1=85". Throws std::invalid_argument.
EmulatedFault emulated_fault(const std::string& text);

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

// The faults that are to befall some drives, each at its time.
class FaultPlan {
 public:
  // Throws std::invalid_argument when the drives cannot have one of them.
  void add(const std::vector<EmulatedFault>& faults, const EmulatedDrives& drives);
  void happen(EmulatedDrives& drives, std::int64_t time_ns) noexcept;
  void end(EmulatedDrives& drives) noexcept;  // those that last; all may happen again

 private:
  struct Planned {
    EmulatedFault is;
    bool begun = false, ended = false;
  };
  std::vector<Planned> faults_;
};

}  // namespace kadans
