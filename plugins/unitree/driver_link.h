// What the driver has of the wire: the robot's states come, its commands go. The wire is DDS (dds_link.h), or on
// virtual time a place in memory (unitree_world.h).
//
// One thread at a time. All are bounded, apart from wait.
#pragma once

#include <cstdint>
#include <string>

#include "message.h"

namespace unitree {

class DriverLink {
 public:
  virtual ~DriverLink() = default;
  DriverLink() = default;
  DriverLink(const DriverLink&) = delete;
  DriverLink& operator=(const DriverLink&) = delete;

  // False: it was not taken.
  virtual bool send(const Packet& command) noexcept = 0;
  // The oldest state that waits. False: there is none.
  virtual bool take(Packet& state) noexcept = 0;
  // How many commands somebody else has sent since the last call.
  virtual std::uint32_t foreign_commands() noexcept = 0;
  // Until a state waits, or until then on the clock of now_ns().
  virtual void wait(std::int64_t until_ns) noexcept = 0;
  virtual std::int64_t now_ns() const noexcept = 0;
  // Where states are written as another type than the robot's: which. "": nowhere.
  virtual std::string other_kind() { return ""; }
  // Whether somebody is there who could write states.
  virtual bool has_peer() { return true; }
};

}  // namespace unitree
