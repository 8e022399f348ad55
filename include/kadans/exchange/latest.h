// The newest value of something, from one writer to a fixed number of readers.
//
// Each reader owns a triple buffer: three slots of which the writer holds one, the reader holds one, and the third is
// in the middle. Writing fills the writer's slot and swaps it with the middle; reading swaps the middle, if it is
// newer, with the reader's slot. One atomic exchange each, no loop, so both sides are wait-free and a reader that
// stops forever disturbs nobody. A write costs one copy per reader. A value that nobody has read is overwritten: this
// is not a queue.
//
// Memory order: every exchange both releases the slot that is given away (the writer's new value, or the reader's end
// of reading) and acquires the one that comes back, so a slot has one owner at any time and its bytes need no atomics.
// The check whether there is news orders nothing, because nothing is read relying on it: read() does an exchange after
// it and finds that value or a newer one. Each of these orders is needed: tests/interleavings weakens one after the
// other and finds what breaks.
//
// Latest is trivially copyable and holds no pointer, so it may live in memory shared between two processes. Copy it
// only while nobody reads or writes. If there is a function copy_used(from, to) for T, publish() copies with it. A
// process that is killed inside publish() or read() may leave two parties with the same slot: when a party has died,
// construct the storage anew before the next one takes its place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kadans/exchange/memory.h"

namespace kadans {

template <typename T, std::size_t Readers = 1, typename Memory = MachineMemory>
class Latest {
  static_assert(Memory::template can_cross<T>, "T crosses threads by plain copy");
  static_assert(Readers >= 1);

  static constexpr std::size_t cache_line = 64;
  static constexpr std::uint32_t slot_mask = 3;
  static constexpr std::uint32_t fresh = 4;
  using Word = typename Memory::template Word<std::uint32_t>;

  // Slots share no cache line, so writing one does not slow down reading another.
  struct alignas(cache_line) Slot {
    T value;
  };
  struct Channel {
    std::array<Slot, 3> slots;
    alignas(cache_line) std::uint32_t write_slot = 0;  // writer
    alignas(cache_line) Word middle{1};                // both
    alignas(cache_line) std::uint32_t read_slot = 2;   // reader
    std::uint32_t readings = 0;                        // reader: the Readings that live
  };

 public:
  // Before any thread reads or writes. Until the first publish() every reader finds `first`, and it is not news.
  explicit Latest(const T& first = T{}) noexcept {
    for (Channel& channel : channels_) channel.slots.fill(Slot{first});
  }

  // Writer thread only. Wait-free.
  void publish(const T& value) noexcept {
    for (Channel& channel : channels_) {
      put(value, channel.slots[channel.write_slot].value);
      const std::uint32_t previous =
          Memory::at(channel.middle).exchange(channel.write_slot | fresh, std::memory_order_acq_rel);
      channel.write_slot = previous & slot_mask;
    }
  }

  // The value that a reader looks at, for as long as the Reading lives. If the same reader reads again meanwhile,
  // however deep the call, it finds the same value: the slot is not given back to the writer. Give the Reading a name:
  // a temporary gives no access to the value.
  class Reading {
   public:
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;
    ~Reading() { --channel_.readings; }
    const T& operator*() const& noexcept { return channel_.slots[channel_.read_slot].value; }
    const T* operator->() const& noexcept { return &**this; }
    const T& operator*() const&& = delete;
    const T* operator->() const&& = delete;

   private:
    friend class Latest;
    explicit Reading(Channel& channel) noexcept : channel_(channel) { ++channel_.readings; }
    Channel& channel_;
  };

  // Thread of reader `reader` only; a reader index belongs to one thread, reader < readers(). Wait-free.
  Reading read(std::size_t reader = 0) noexcept {
    Channel& channel = channels_[reader];
    if (channel.readings == 0 && has_news(reader)) {
      const std::uint32_t newest = Memory::at(channel.middle).exchange(channel.read_slot, std::memory_order_acq_rel);
      channel.read_slot = newest & slot_mask;
    }
    return Reading(channel);
  }
  // What read() finds, as a copy.
  T newest(std::size_t reader = 0) noexcept {
    const Reading reading = read(reader);
    return *reading;
  }

  // Thread of reader `reader` only: what the last read() found, or `first`; nothing newer is fetched. Wait-free.
  const T& held(std::size_t reader = 0) const noexcept {
    return channels_[reader].slots[channels_[reader].read_slot].value;
  }

  // Thread of reader `reader` only, while it has no Reading: read() finds this value until a newer one is published.
  // Wait-free.
  void replace(const T& value, std::size_t reader = 0) noexcept {
    (void)read(reader);
    put(value, channels_[reader].slots[channels_[reader].read_slot].value);
  }

  // Thread of reader `reader` only: whether read() would bring a value that this reader has not seen. Wait-free.
  bool has_news(std::size_t reader = 0) noexcept {
    return (Memory::at(channels_[reader].middle).load(std::memory_order_relaxed) & fresh) != 0;
  }

  static constexpr std::size_t readers() noexcept { return Readers; }

 private:
  static void put(const T& from, T& to) noexcept {
    if constexpr (requires { copy_used(from, to); })
      copy_used(from, to);
    else
      to = from;
  }

  std::array<Channel, Readers> channels_;
};

}  // namespace kadans
