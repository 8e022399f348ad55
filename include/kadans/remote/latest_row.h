// The newest row of numbers from one writer to one reader: as exchange/latest.h, for a length that is known only when
// the storage is made, and with a wish: nothing is copied unless the reader asked for it.
//
// Three rows, of which the writer holds one, the reader holds one, and the third is in the middle; each side swaps its
// own with the middle in one atomic exchange. Wait-free on both sides; what nobody read is overwritten.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace kadans {

class LatestRow {
 public:
  struct View {
    std::uint64_t tick = 0;
    std::int64_t time_ns = 0;
    std::span<const double> values;  // empty: nothing came yet
  };
  // The row that the reader looks at, for as long as this lives: who reads again meanwhile finds the same one.
  class Reading {
   public:
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;
    ~Reading() { --row_.readings_; }
    const View& operator*() const& noexcept { return view_; }
    const View* operator->() const& noexcept { return &view_; }
    const View& operator*() const&& = delete;
    const View* operator->() const&& = delete;

   private:
    friend class LatestRow;
    Reading(LatestRow& row, const View& view) noexcept : row_(row), view_(view) { ++row_.readings_; }
    LatestRow& row_;
    View view_;
  };

  explicit LatestRow(std::size_t size) {
    for (Slot& slot : slots_) slot.values.resize(size);
  }

  // Reader. Every n-th row from now on; 0: none.
  void want(std::uint32_t every) noexcept { every_.store(every, std::memory_order_relaxed); }

  // Writer. A row of another length is left out.
  void publish(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept {
    const std::uint32_t every = every_.load(std::memory_order_relaxed);
    Slot& slot = slots_[write_slot_];
    if (every == 0 || tick % every != 0 || row.size() != slot.values.size()) return;
    slot.tick = tick;
    slot.time_ns = time_ns;
    std::copy(row.begin(), row.end(), slot.values.begin());
    write_slot_ = middle_.exchange(write_slot_ | fresh, std::memory_order_acq_rel) & slot_mask;
  }

  // Reader.
  Reading read() noexcept {
    if (readings_ == 0 && (middle_.load(std::memory_order_acquire) & fresh) != 0) {
      read_slot_ = middle_.exchange(read_slot_, std::memory_order_acq_rel) & slot_mask;
      any_ = true;
    }
    const Slot& slot = slots_[read_slot_];
    return {*this, any_ ? View{slot.tick, slot.time_ns, slot.values} : View{}};
  }

 private:
  static constexpr std::uint32_t slot_mask = 3, fresh = 4;

  struct alignas(64) Slot {
    std::uint64_t tick = 0;
    std::int64_t time_ns = 0;
    std::vector<double> values;
  };
  std::array<Slot, 3> slots_;
  std::atomic<std::uint32_t> every_{0};
  alignas(64) std::uint32_t write_slot_ = 0;
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t read_slot_ = 2;
  std::uint32_t readings_ = 0;  // that live
  bool any_ = false;
};

}  // namespace kadans
