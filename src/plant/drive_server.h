// Serves the emulated drives of a modelled robot on a bus of this machine, in real time, to whatever program speaks
// their protocol.
//
// A session begins with the first bytes that somebody sends, and ends after a second without any that were understood.
// They are answered at once; where the drives stand then, look() has shown them. Between two sessions the drives' power
// is off, and what is sent before look() waits. The model's time begins when the first drive gets torque, so that the
// robot does not fall while its drives are found and set up.
//
// In step with its peer, whose clock may be slow or stand still, the model's time, and with it that of the drives'
// watchdogs, passes with the cycles of the peer's bus. The server is then patient for in_step_timeout_ns.
//
// Faults of the bus and the drives may be planned; they happen by the model's time in each session anew.
//
// Threads: look, await and beat by one thread at a time; a thread of its own serves the bus from the first await on.
// What a type brings is called by one of them at a time. link_counts by any.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "kadans/plant/emulated_drives.h"

namespace kadans {

class DriveServer : public PlantEmulator {
 public:
  void look(World& world) final;
  bool await(int milliseconds) noexcept final;
  bool beat(World& world, std::uint32_t periods) final;
  bool step_with_peer() noexcept final { return in_step_ = true; }
  const Session& session() const noexcept final { return session_; }
  void plan_faults(const std::vector<EmulatedFault>& faults) final;
  std::vector<PlantCount> link_counts() const final;

 protected:
  // A cycle of the peer's bus is a tick of its control in every `divisor`.
  DriveServer(std::int64_t period_ns, std::uint32_t divisor) noexcept : period_ns_(period_ns), divisor_(divisor) {}
  void end() noexcept;  // a destructor of a type calls it first

  // What becomes readable when somebody speaks.
  virtual std::vector<int> descriptors() const = 0;
  // Takes what came and answers it; returns when it is to be called again at the latest, on CLOCK_MONOTONIC.
  virtual std::int64_t serve_bus(std::int64_t now_ns) noexcept = 0;
  virtual std::uint64_t heard() const noexcept = 0;   // messages that were understood, ever
  virtual std::uint64_t cycles() const noexcept = 0;  // of the peer's bus, ever
  virtual std::vector<PlantCount> counts() const = 0;
  virtual EmulatedDrives& drives() noexcept = 0;

 private:
  static constexpr std::int64_t in_step_timeout_ns = 60'000'000'000;
  static constexpr std::uint64_t in_step_ahead_max = 10;  // cycles in a beat; beyond that they are lost

  void serve(const std::stop_token& stop) noexcept;
  bool end_session() noexcept;  // false
  std::uint32_t due(std::uint32_t periods) noexcept;

  std::int64_t period_ns_;
  std::uint32_t divisor_;
  bool in_step_ = false;
  std::uint64_t stepped_ = 0;  // for that many cycles of the peer's bus
  FaultPlan faults_;
  std::int64_t time_ns_ = 0;  // of the model, in this session
  mutable std::mutex mutex_;  // of what the type brings, and of the two below
  bool look_true_ = false;    // the drives know where they stand
  bool spoken_to_ = false;    // since the last session was over
  std::condition_variable changed_;
  bool in_session_ = false;
  std::jthread thread_;
  Session session_;
  std::uint64_t heard_ = 0;
  std::int64_t silent_ns_ = 0;
  bool time_runs_ = false, tripped_ = false;
};

}  // namespace kadans
