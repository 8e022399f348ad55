// A number that one thread changes and any thread may read. Access is relaxed, so it orders nothing else; on the
// machines we know it costs no more than a plain number. Trivially copyable, like all that crosses threads here.
#pragma once

#include <cstdint>
#include <type_traits>

#include "kadans/exchange/memory.h"

namespace kadans {

template <typename T, typename Memory = MachineMemory>
class OneWriter {
 public:
  OneWriter() noexcept = default;
  explicit OneWriter(T first) noexcept : value_(first) {}

  // Writer thread only.
  void set(T value) noexcept { Memory::at(value_).store(value, std::memory_order_relaxed); }
  void add(T more) noexcept { set(get() + more); }
  // Any thread.
  T get() const noexcept { return Memory::at(value_).load(std::memory_order_relaxed); }

 private:
  alignas(sizeof(T)) typename Memory::template Word<T> value_{};
};

using Count = OneWriter<std::uint64_t>;
static_assert(std::is_trivially_copyable_v<Count>);

}  // namespace kadans
