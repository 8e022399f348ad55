// How the two levels of a control object hand values to each other, so that a recorded run can be repeated.
//
// Both are a Latest<>: the reader finds the newest value, nobody waits. Which value is the newest at a moment is up to
// the threads. So a record notes what the reader found, and a repeated run gives it the same. A value therefore carries
// a number: Handed<T>.
//
//   HandDown<T>  from the high level to the low level: the number counts the values, and the record of a tick says
//                which one its low level found (taken())
//   HandUp<T>    from the low level to the high level: the number is the time of the tick that gave it. The behavior
//                tick sees a snapshot; only what is newer than that snapshot has to be in the record, as bytes.
//
// An object names its storages in ControlObject::hand_overs(). One that uses a bare Latest<> works, but its runs on
// threads are not repeated bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kadans/exchange/latest.h"
#include "kadans/signal/members.h"

namespace kadans {

// A value with the number by which a record knows it. The number is no state of the object.
template <typename T>
struct Handed : T {
  using Plain = T;
  std::int64_t handed = 0;
};

// Behavior thread: gets each value that a high level hands down, as bytes.
class HandedDownSink {
 public:
  virtual void handed_down(std::uint32_t storage, std::int64_t number, std::span<const std::byte> value) noexcept = 0;

 protected:
  HandedDownSink() = default;
  ~HandedDownSink() = default;
  HandedDownSink(const HandedDownSink&) = default;
  HandedDownSink& operator=(const HandedDownSink&) = default;
};

class DownStorage {
 public:
  virtual ~DownStorage() = default;
  // Before the loop: all values that are published go there, too, under this number of the storage.
  void tell(HandedDownSink* sink, std::uint32_t storage) noexcept {
    sink_ = sink;
    storage_ = storage;
  }
  // Control thread: the number of the value that was read last.
  virtual std::int64_t taken() const noexcept = 0;
  // In a repeated run, where all is one thread: from now on values wait until they are let through by their number.
  virtual void hold() = 0;
  virtual void let_through(std::int64_t number) = 0;
  // There, in a run that is repeated from a saved state and without its high levels: the value that was restored has
  // this number; and another value comes down, to wait for let_through(). One that is older than the restored one is
  // ignored. False: wrong size.
  virtual void resume(std::int64_t number) noexcept = 0;
  [[nodiscard]] virtual bool feed(std::int64_t number, std::span<const std::byte> value) = 0;

 protected:
  DownStorage() = default;
  DownStorage(const DownStorage&) = default;
  DownStorage& operator=(const DownStorage&) = default;
  void told(std::int64_t number, std::span<const std::byte> value) const noexcept {
    if (sink_ != nullptr) sink_->handed_down(storage_, number, value);
  }

 private:
  HandedDownSink* sink_ = nullptr;
  std::uint32_t storage_ = 0;
};

class UpStorage {
 public:
  virtual ~UpStorage() = default;
  // Behavior thread: until unpin() the high level finds the value that is the newest now. True when it came after
  // `seen_ns`, the time of a snapshot; then pinned() are its bytes.
  virtual bool pin(std::int64_t seen_ns) noexcept = 0;
  virtual std::span<const std::byte> pinned() const noexcept = 0;
  virtual void unpin() noexcept = 0;
  // In a repeated run: the high level finds this value until a newer one is given. False: wrong size.
  [[nodiscard]] virtual bool feed(std::span<const std::byte> bytes) noexcept = 0;

 protected:
  UpStorage() = default;
  UpStorage(const UpStorage&) = default;
  UpStorage& operator=(const UpStorage&) = default;
};

// Of all control objects, in their order.
struct HandOvers {
  std::vector<DownStorage*> down;
  std::vector<UpStorage*> up;
};

template <typename T>
class HandDown final : public DownStorage {
 public:
  using Reading = typename Latest<Handed<T>>::Reading;

  explicit HandDown(const T& first = T{}) noexcept : latest_(Handed<T>{first}) {}

  void publish(Handed<T>& value) noexcept {  // behavior thread
    value.handed = ++published_;
    told(value.handed, std::as_bytes(std::span(&value, 1)));
    if (waiting_ == nullptr)
      latest_.publish(value);
    else
      waiting_->push_back(value);
  }
  Reading read() noexcept { return latest_.read(); }  // control thread
  std::int64_t taken() const noexcept override { return latest_.held().handed; }
  T newest() noexcept { return latest_.newest(); }
  void replace(const T& value) noexcept { latest_.replace(Handed<T>{value, taken()}); }

  void hold() override { waiting_ = std::make_unique<std::deque<Handed<T>>>(); }
  void let_through(std::int64_t number) override {
    while (waiting_ != nullptr && !waiting_->empty() && waiting_->front().handed <= number) {
      latest_.publish(waiting_->front());
      waiting_->pop_front();
    }
  }
  void resume(std::int64_t number) noexcept override {
    Handed<T> value = latest_.newest();
    value.handed = number;
    latest_.replace(value);
  }
  bool feed(std::int64_t number, std::span<const std::byte> bytes) override {
    if (bytes.size() != sizeof(Handed<T>)) return false;
    if (waiting_ == nullptr || number <= taken()) return true;
    Handed<T>& value = waiting_->emplace_back();
    take_members(static_cast<T&>(value), bytes.data());
    value.handed = number;
    return true;
  }

 private:
  Latest<Handed<T>> latest_;
  std::int64_t published_ = 0;
  std::unique_ptr<std::deque<Handed<T>>> waiting_;  // nullptr: nothing waits, as in every run but a repeated one
};

template <typename T>
class HandUp final : public UpStorage {
 public:
  using Reading = typename Latest<Handed<T>>::Reading;
  // A value that is given outside of a tick counts as newer than any snapshot.
  static constexpr std::int64_t out_of_tick = std::numeric_limits<std::int64_t>::max();

  explicit HandUp(const T& first = T{}) noexcept : latest_(Handed<T>{first}) {}

  void publish(Handed<T>& value, std::int64_t time_ns) noexcept {  // control thread
    value.handed = time_ns;
    latest_.publish(value);
  }
  Reading read() noexcept { return latest_.read(); }  // behavior thread
  T newest() noexcept { return latest_.newest(); }

  bool pin(std::int64_t seen_ns) noexcept override {
    const bool news = latest_.has_news();
    pin_.emplace(latest_);
    return news && (*pin_->reading).handed > seen_ns;
  }
  std::span<const std::byte> pinned() const noexcept override {
    const Handed<T>& value = *pin_->reading;
    return std::as_bytes(std::span(&value, 1));
  }
  void unpin() noexcept override { pin_.reset(); }
  bool feed(std::span<const std::byte> bytes) noexcept override {
    if (bytes.size() != sizeof(Handed<T>)) return false;
    Handed<T> value{};  // its number counts in the recorded run alone
    take_members(static_cast<T&>(value), bytes.data());
    latest_.replace(value);
    return true;
  }

 private:
  struct Pin {
    explicit Pin(Latest<Handed<T>>& latest) : reading(latest.read()) {}
    Reading reading;
  };
  Latest<Handed<T>> latest_;
  std::optional<Pin> pin_;
};

}  // namespace kadans
