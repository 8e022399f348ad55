// The newest row of numbers, from one writer thread to one reader thread. It works as exchange/latest.h, but the length
// is given at run time, and nothing is copied unless the reader has asked for it by want().
//
// There are three rows: the writer holds one, the reader holds one, and the third is in the middle. Each side swaps its
// own row with the middle one in one atomic exchange. It is wait-free on both sides, and a row that was not read is
// overwritten. The memory order is that of Latest. want() is relaxed, because a row that is no longer wanted does no
// harm.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kadans/exchange/memory.h"

namespace kadans {

template <typename Memory = MachineMemory, typename Number = double>
class BasicLatestRow {
 public:
  struct View {
    std::uint64_t tick = 0;
    std::int64_t time_ns = 0;
    std::span<const Number> values;  // empty: no row has come yet
  };
  // Holds the row that the reader uses. While it lives, further calls of read() return the same row.
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
    friend class BasicLatestRow;
    Reading(BasicLatestRow& row, const View& view) noexcept : row_(row), view_(view) { ++row_.readings_; }
    BasicLatestRow& row_;
    View view_;
  };

  explicit BasicLatestRow(std::size_t size) {
    for (Slot& slot : slots_) slot.values.resize(size);
  }

  // Reader: asks for every n-th row from now on; 0: none.
  void want(std::uint32_t every) noexcept { Memory::at(every_).store(every, std::memory_order_relaxed); }

  // Writer. A row of another length is ignored.
  void publish(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept {
    const std::uint32_t every = Memory::at(every_).load(std::memory_order_relaxed);
    Slot& slot = slots_[write_slot_];
    if (every == 0 || tick % every != 0 || row.size() != slot.values.size()) return;
    slot.tick = tick;
    slot.time_ns = time_ns;
    std::copy(row.begin(), row.end(), slot.values.begin());
    write_slot_ = Memory::at(middle_).exchange(write_slot_ | fresh, std::memory_order_acq_rel) & slot_mask;
  }

  // Reader.
  Reading read() noexcept {
    if (readings_ == 0 && (Memory::at(middle_).load(std::memory_order_relaxed) & fresh) != 0) {
      read_slot_ = Memory::at(middle_).exchange(read_slot_, std::memory_order_acq_rel) & slot_mask;
      any_ = true;
    }
    const Slot& slot = slots_[read_slot_];
    return {*this, any_ ? View{slot.tick, slot.time_ns, slot.values} : View{}};
  }

 private:
  static constexpr std::uint32_t slot_mask = 3, fresh = 4;
  using Word = typename Memory::template Word<std::uint32_t>;

  struct alignas(64) Slot {
    std::uint64_t tick = 0;
    std::int64_t time_ns = 0;
    std::vector<Number> values;
  };
  std::array<Slot, 3> slots_;
  Word every_{0};
  alignas(64) std::uint32_t write_slot_ = 0;
  alignas(64) Word middle_{1};
  alignas(64) std::uint32_t read_slot_ = 2;
  std::uint32_t readings_ = 0;  // Readings that are alive
  bool any_ = false;
};
using LatestRow = BasicLatestRow<>;

}  // namespace kadans
