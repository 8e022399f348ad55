// The state of the control engine every few seconds, for the flight recorder: from there its last ticks are repeated.
//
// Threads: save_if_due() the control thread, in the record of a tick, and it never waits: while another thread is still
// at the state before, there is none. take() any other thread.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "control_engine.h"

namespace kadans {

class EngineStates {
 public:
  // Measures the engine and allocates; before the loop. It must outlive this object. `down`: the storages from high to
  // low levels, in the order of the objects.
  EngineStates(ControlEngine& engine, std::vector<const DownStorage*> down, std::uint64_t every_ticks);

  void save_if_due(std::uint64_t tick) noexcept {
    if (tick % every_ticks_ == 0) save(tick);
  }

  // A state that waits: of the engine after this tick, and which values its low levels had found. False: none waits.
  // Valid until done().
  struct Saved {
    std::uint64_t tick = 0;
    std::span<const std::int64_t> found;
    std::span<const std::byte> bytes;
  };
  [[nodiscard]] bool take(Saved& saved) const noexcept;
  void done() noexcept { waits_.store(false, std::memory_order_release); }

  std::size_t bytes_max() const noexcept { return bytes_.size(); }

 private:
  void save(std::uint64_t tick) noexcept;

  ControlEngine& engine_;
  std::vector<const DownStorage*> down_;
  std::uint64_t every_ticks_;
  std::vector<std::int64_t> found_;
  std::vector<std::byte> bytes_;
  std::size_t size_ = 0;
  std::uint64_t tick_ = 0;
  std::atomic<bool> waits_{false};  // what is saved belongs to the other thread
};

}  // namespace kadans
